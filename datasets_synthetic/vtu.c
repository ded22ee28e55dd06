/* vtu.c: writes a mesh as a VTK XML unstructured grid with raw appended data.
 * Format: "VTK File Formats", VTK User's Guide, section 19.3: blocks after "_", each preceded by its size in bytes. */
#define _GNU_SOURCE
#include "synth.h"

#include "core/memory.h"
#include "mesh/mesh.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { VTK_TETRA = 10, CHUNK = 4096 };

/* The file in the making. */
typedef struct vtu {
    FILE *file;
    uint64_t offset; /* of the next block, from "_" */
} vtu;

/* Text as the value of an XML attribute; control characters, which XML forbids, become '_'. */
static void put_attribute(FILE *file, const char *text)
{
    for (; *text; text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '&')
            fputs("&amp;", file);
        else if (c == '<')
            fputs("&lt;", file);
        else if (c == '>')
            fputs("&gt;", file);
        else if (c == '"')
            fputs("&quot;", file);
        else
            fputc(c < 32 || c == 127 ? '_' : c, file);
    }
}

static void put_array(vtu *v, const char *type, const char *name, int components, uint64_t bytes)
{
    fprintf(v->file, "<DataArray type=\"%s\" Name=\"", type);
    put_attribute(v->file, name);
    fprintf(v->file, "\" NumberOfComponents=\"%d\" format=\"appended\" offset=\"%llu\"/>\n", components,
            (unsigned long long)v->offset);
    v->offset += sizeof bytes + bytes;
}

/* Is there a field? A mesh made without one has zeros and no name. */
static bool has_field(const tc_mesh *mesh)
{
    const tc_mesh_report *r = &mesh->report;
    bool zero = r->scalar_range[0] == 0 && r->scalar_range[1] == 0 && r->nonfinite_scalars == 0;
    return mesh->scalar && (mesh->field_name || !zero);
}

static void put_field(vtu *v, const tc_mesh *mesh, const char *tag, tc_association association, size_t n)
{
    bool here = has_field(mesh) && mesh->association == association;
    const char *name = mesh->field_name ? mesh->field_name : "field";
    if (!here) {
        fprintf(v->file, "<%s/>\n", tag);
        return;
    }
    fprintf(v->file, "<%s Scalars=\"", tag);
    put_attribute(v->file, name);
    fputs("\">\n", v->file);
    put_array(v, "Float64", name, 1, n * sizeof(double));
    fprintf(v->file, "</%s>\n", tag);
}

static void put_block(FILE *file, const void *data, uint64_t bytes)
{
    fwrite(&bytes, sizeof bytes, 1, file);
    fwrite(data, 1, bytes, file);
}

/* Ends of the cells: 4, 8, 12, … */
static void put_offsets(FILE *file, size_t n_tet)
{
    uint64_t bytes = n_tet * sizeof(int64_t);
    int64_t chunk[CHUNK];
    fwrite(&bytes, sizeof bytes, 1, file);
    for (size_t i = 0; i < n_tet;) {
        size_t n = 0;
        for (; n < CHUNK && i < n_tet; n++, i++)
            chunk[n] = 4 * ((int64_t)i + 1);
        fwrite(chunk, sizeof *chunk, n, file);
    }
}

static void put_types(FILE *file, size_t n_tet)
{
    uint64_t bytes = n_tet;
    unsigned char chunk[CHUNK];
    memset(chunk, VTK_TETRA, sizeof chunk);
    fwrite(&bytes, sizeof bytes, 1, file);
    for (size_t left = n_tet; left > 0;) {
        size_t n = left < CHUNK ? left : CHUNK;
        fwrite(chunk, 1, n, file);
        left -= n;
    }
}

static void put_mesh(FILE *file, const tc_mesh *mesh)
{
    const char *order = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? "BigEndian" : "LittleEndian";
    size_t n_tet = mesh->n_tet, n_vertex = mesh->n_vertex - mesh->report.n_steiner;
    vtu v = {file, 0};
    fprintf(file,
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"%s\" header_type=\"UInt64\">\n"
            "<UnstructuredGrid>\n<Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n",
            order, n_vertex, n_tet);
    put_field(&v, mesh, "PointData", TC_POINT_DATA, n_vertex);
    put_field(&v, mesh, "CellData", TC_CELL_DATA, n_tet);
    fputs("<Points>\n", file);
    put_array(&v, "Float64", "Points", 3, n_vertex * 3 * sizeof(double));
    fputs("</Points>\n<Cells>\n", file);
    put_array(&v, "Int32", "connectivity", 1, n_tet * 4 * sizeof(int32_t));
    put_array(&v, "Int64", "offsets", 1, n_tet * sizeof(int64_t));
    put_array(&v, "UInt8", "types", 1, n_tet);
    fputs("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_", file);

    if (has_field(mesh))
        put_block(file, mesh->scalar, (mesh->association == TC_CELL_DATA ? n_tet : n_vertex) * sizeof(double));
    put_block(file, mesh->vertex, n_vertex * 3 * sizeof(double));
    put_block(file, mesh->tet, n_tet * 4 * sizeof(int32_t));
    put_offsets(file, n_tet);
    put_types(file, n_tet);
    fputs("\n</AppendedData>\n</VTKFile>\n", file);
}

/* Where to write: beside the target, whose name it gets at the end; the target itself when that is a device or a pipe,
 * which must not be replaced. A link is followed. */
static tc_status open_beside(FILE **file, char **target, char **beside, const char *path, tc_error *err)
{
    struct stat s;
    bool exists = stat(path, &s) == 0;
    if (exists && S_ISDIR(s.st_mode))
        return tc_fail(err, TC_E_FILE, "%s is a folder; give the name of a file in it", path);
    *target = exists ? realpath(path, NULL) : tc_strdup(path);
    if (!*target)
        return tc_fail(err, TC_E_FILE, "%s cannot be written: %s", path, strerror(errno));
    int fd;
    if (exists && !S_ISREG(s.st_mode)) {
        fd = open(*target, O_WRONLY | O_CLOEXEC);
    } else {
        size_t n = strlen(*target) + 48;
        *beside = tc_alloc(n, 1);
        if (!*beside)
            return tc_fail_memory(err, "a file name", n, 1);
        snprintf(*beside, n, "%s.%ld.part", *target, (long)getpid());
        fd = open(*beside, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    }
    *file = fd < 0 ? NULL : fdopen(fd, "wb");
    if (*file)
        return TC_OK;
    int why = errno;
    if (fd >= 0)
        close(fd);
    return tc_fail(err, TC_E_FILE, "%s cannot be written: %s", path, strerror(why));
}

tc_status tc_mesh_write_vtu(const tc_mesh *mesh, const char *path, tc_error *err)
{
    if (!mesh || !path || !*path)
        return tc_fail(err, TC_E_ARG, "writing a VTU file needs a mesh and a file name");
    FILE *file = NULL;
    char *target = NULL, *beside = NULL;
    tc_status status = open_beside(&file, &target, &beside, path, err);
    if (!status) {
        errno = 0;
        put_mesh(file, mesh);
        bool failed = ferror(file) != 0;
        int why = errno;
        if (fclose(file) != 0 && !failed) {
            failed = true;
            why = errno;
        }
        if (!failed && beside && rename(beside, target) != 0) {
            failed = true;
            why = errno;
        }
        if (failed) {
            status = tc_fail(err, TC_E_FILE, "%s could not be written whole: %s", path, strerror(why ? why : EIO));
            if (beside)
                unlink(beside);
        }
    }
    free(beside);
    free(target);
    return status;
}
