/* read_files.h: small files that the reader's tests write, and reading them back. */
#ifndef TC_TESTS_READ_FILES_H
#define TC_TESTS_READ_FILES_H

#include "mesh/mesh.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A grid in the making. */
typedef struct grid {
    double point[4096][3];
    int n_point;
    int type[2048], first[2049], id[32768]; /* point numbers of cell c: id[first[c]] … */
    int n_cell, n_id;
    int face[32768], face_first[2048], face_end[2048], n_face_int; /* VTK face streams; -1: none */
    bool polyhedra;
} grid;

static inline int add_point(grid *g, double x, double y, double z)
{
    g->point[g->n_point][0] = x;
    g->point[g->n_point][1] = y;
    g->point[g->n_point][2] = z;
    return g->n_point++;
}

static inline void add_cell(grid *g, int type, int n, const int *id)
{
    g->type[g->n_cell] = type;
    g->first[g->n_cell] = g->n_id;
    memcpy(g->id + g->n_id, id, (size_t)n * sizeof *id);
    g->n_id += n;
    g->face_first[g->n_cell] = g->face_end[g->n_cell] = -1;
    g->first[++g->n_cell] = g->n_id;
}

/* stream: number of faces, then of each its size and point numbers. */
static inline void add_polyhedron(grid *g, const int *stream)
{
    int id[256], n = 0, length = 1;
    for (int f = 0; f < stream[0]; f++) {
        const int size = stream[length++];
        for (int i = 0; i < size; i++, length++) {
            bool known = false;
            for (int k = 0; k < n; k++)
                known = known || id[k] == stream[length];
            if (!known)
                id[n++] = stream[length];
        }
    }
    add_cell(g, 42, n, id);
    g->polyhedra = true;
    g->face_first[g->n_cell - 1] = g->n_face_int;
    memcpy(g->face + g->n_face_int, stream, (size_t)length * sizeof *stream);
    g->n_face_int += length;
    g->face_end[g->n_cell - 1] = g->n_face_int;
}

/* A path of this process in the build folder. */
static inline const char *scratch(const char *name)
{
    static char path[4][512];
    static int turn;
    turn = (turn + 1) % 4;
    snprintf(path[turn], sizeof path[turn], "%s/read_%ld_%s", TC_BUILD_DIR, (long)getpid(), name);
    return path[turn];
}

static inline void write_text(const char *path, const char *text)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_true(fputs(text, f) >= 0);
    assert_int_equal(fclose(f), 0);
}

/* Writes g as a VTU in text. point_data, cell_data: DataArray elements, or "". */
static inline void write_vtu(const char *path, const grid *g, const char *point_data, const char *cell_data)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fprintf(f,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"2.2\" byte_order=\"LittleEndian\">\n"
            "<UnstructuredGrid><Piece NumberOfPoints=\"%d\" NumberOfCells=\"%d\">\n<PointData>%s</PointData>\n"
            "<CellData>%s</CellData>\n<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n",
            g->n_point, g->n_cell, point_data, cell_data);
    for (int i = 0; i < g->n_point; i++)
        fprintf(f, "%.17g %.17g %.17g\n", g->point[i][0], g->point[i][1], g->point[i][2]);
    fprintf(f, "</DataArray></Points>\n<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n");
    for (int i = 0; i < g->n_id; i++)
        fprintf(f, "%d ", g->id[i]);
    fprintf(f, "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n");
    for (int c = 0; c < g->n_cell; c++)
        fprintf(f, "%d ", g->first[c + 1]);
    fprintf(f, "</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n");
    for (int c = 0; c < g->n_cell; c++)
        fprintf(f, "%d ", g->type[c]);
    fprintf(f, "</DataArray>\n");
    if (g->polyhedra) {
        fprintf(f, "<DataArray type=\"Int64\" Name=\"faces\" format=\"ascii\">\n");
        for (int i = 0; i < g->n_face_int; i++)
            fprintf(f, "%d ", g->face[i]);
        fprintf(f, "</DataArray>\n<DataArray type=\"Int64\" Name=\"faceoffsets\" format=\"ascii\">\n");
        for (int c = 0; c < g->n_cell; c++)
            fprintf(f, "%d ", g->face_end[c]);
        fprintf(f, "</DataArray>\n");
    }
    fprintf(f, "</Cells></Piece></UnstructuredGrid></VTKFile>\n");
    assert_int_equal(fclose(f), 0);
}

/* Reads path; fails the test with the reader's sentence. */
static inline tc_mesh *read_path(const char *path, const tc_read_options *options)
{
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    if (tc_mesh_read(&mesh, path, options, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    return mesh;
}

static inline tc_mesh *read_grid(const grid *g, const tc_read_options *options)
{
    const char *path = scratch("grid.vtu");
    write_vtu(path, g, "", "");
    tc_mesh *mesh = read_path(path, options);
    unlink(path);
    return mesh;
}

/* The reader's refusal of path, which must be a sentence of code TC_E_FILE. */
static inline const char *refusal_of(const char *path, const tc_read_options *options)
{
    static tc_error err;
    tc_mesh *mesh = NULL;
    memset(&err, 0, sizeof err);
    assert_int_equal(tc_mesh_read(&mesh, path, options, NULL, &err), TC_E_FILE);
    assert_null(mesh);
    assert_true(strlen(err.text) > 10);
    return err.text;
}

static inline double tet_volume(const tc_mesh *m, size_t t)
{
    const double *p[4];
    double u[3][3];
    for (int k = 0; k < 4; k++)
        p[k] = m->vertex + 3 * (size_t)m->tet[4 * t + (size_t)k];
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++)
            u[k][c] = p[k + 1][c] - p[0][c];
    return ((u[0][1] * u[1][2] - u[0][2] * u[1][1]) * u[2][0] + (u[0][2] * u[1][0] - u[0][0] * u[1][2]) * u[2][1] +
            (u[0][0] * u[1][1] - u[0][1] * u[1][0]) * u[2][2]) /
           6;
}

/* Sum over the tets, none of which may be negative. */
static inline double mesh_volume(const tc_mesh *m)
{
    double sum = 0;
    for (size_t t = 0; t < m->n_tet; t++) {
        const double v = tet_volume(m, t);
        assert_true(v >= 0);
        sum += v;
    }
    return sum;
}

static inline bool has_note(const tc_mesh *m, const char *part)
{
    for (size_t i = 0; i < m->source->n_note; i++)
        if (strstr(m->source->note[i], part))
            return true;
    return false;
}

/* Prepares with depth peeling (no convexification) and gives the report. */
static inline tc_mesh_report prepared(tc_mesh *m)
{
    const tc_prepare_options options = {.reentry = TC_REENTRY_PEEL, .threads = 1};
    tc_error err = {0};
    if (tc_mesh_prepare(m, &options, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_mesh_report report;
    tc_mesh_get_report(&report, m);
    return report;
}

#endif
