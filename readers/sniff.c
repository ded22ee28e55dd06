/* sniff.c: what format a file is in, by its content first, then by its name. */
#define _GNU_SOURCE
#include "sniff.h"

#include "core/memory.h"
#include "plot3d_layout.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { HEAD_BYTES = 4 << 20, TEXT_BYTES = 4096 };

bool tc_sniff_has(const unsigned char *head, size_t n, const char *text)
{
    const size_t length = strlen(text);
    if (length == 0 || length > n)
        return false;
    for (const unsigned char *p = head, *end = head + (n - length); p <= end; p++) {
        p = memchr(p, text[0], (size_t)(end - p) + 1);
        if (!p)
            return false;
        if (memcmp(p, text, length) == 0)
            return true;
    }
    return false;
}

static bool starts(const unsigned char *head, size_t n, const char *text)
{
    return n >= strlen(text) && memcmp(head, text, strlen(text)) == 0;
}

bool tc_sniff_ends(const char *path, const char *extension)
{
    const size_t n = strlen(path), m = strlen(extension);
    if (n < m)
        return false;
    for (size_t i = 0; i < m; i++)
        if (tolower((unsigned char)path[n - m + i]) != tolower((unsigned char)extension[i]))
            return false;
    return true;
}

static tc_status found(tc_sniffed *out, tc_format format, const char *kind)
{
    out->format = format;
    snprintf(out->kind, sizeof out->kind, "%s", kind);
    return TC_OK;
}

/* The value of type="…" in the VTKFile tag. */
static tc_status sniff_vtk_xml(tc_sniffed *out, const char *path, const char *text, bool surface, tc_error *err)
{
    const char *tag = strstr(text, "<VTKFile");
    const char *end = strchr(tag, '>');
    const char *type = strstr(tag, "type");
    if (!type || (end && type > end))
        return tc_fail(err, TC_E_FILE,
                       "%s is a VTK XML file that ends or breaks in its first tag; write or fetch it again", path);
    type += 4;
    while (isspace((unsigned char)*type) || *type == '=')
        type++;
    char kind[64] = "";
    if (*type == '"' || *type == '\'') {
        const char *stop = strchr(type + 1, *type);
        if (stop && (size_t)(stop - type) < sizeof kind) {
            memcpy(kind, type + 1, (size_t)(stop - type) - 1);
            kind[stop - type - 1] = 0;
        }
    }
    static const char *const known[] = {"UnstructuredGrid",
                                        "PUnstructuredGrid",
                                        "StructuredGrid",
                                        "PStructuredGrid",
                                        "RectilinearGrid",
                                        "PRectilinearGrid",
                                        "ImageData",
                                        "PImageData",
                                        "vtkMultiBlockDataSet",
                                        "vtkPartitionedDataSet",
                                        "vtkPartitionedDataSetCollection"};
    if (strcmp(kind, "Collection") == 0)
        return found(out, TC_FORMAT_PVD, kind);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(kind, known[i]) == 0)
            return found(out, TC_FORMAT_VTK_XML, kind);
    if (!kind[0])
        return tc_fail(err, TC_E_FILE,
                       "%s is a VTK XML file that ends or breaks in its first tag; write or fetch it again", path);
    const bool poly = strcmp(kind, "PolyData") == 0 || strcmp(kind, "PPolyData") == 0;
    if (poly && surface)
        return found(out, TC_FORMAT_VTK_XML, kind);
    if (poly)
        return tc_fail(err, TC_E_FILE, "%s holds a surface (VTK PolyData), not a volume: it has no 3-D cells to render",
                       path);
    return tc_fail(err, TC_E_FILE,
                   "%s is a VTK XML file of type \"%s\", which is not read; save it as UnstructuredGrid (.vtu)", path,
                   kind);
}

static tc_status sniff_vtk_legacy(tc_sniffed *out, const char *path, const char *text, bool surface, tc_error *err)
{
    const char *at = strstr(text, "DATASET");
    char kind[64] = "";
    if (!at)
        at = strstr(text, "dataset");
    if (at)
        sscanf(at + 7, " %63s", kind);
    for (char *p = kind; *p; p++)
        *p = (char)toupper((unsigned char)*p);
    if (strcmp(kind, "POLYDATA") == 0 && !surface)
        return tc_fail(err, TC_E_FILE, "%s holds a surface (VTK POLYDATA), not a volume: it has no 3-D cells to render",
                       path);
    if (!at && !tc_sniff_has((const unsigned char *)text, strlen(text), "FIELD"))
        return tc_fail(err, TC_E_FILE, "%s is a legacy VTK file without a DATASET line; it is cut short or damaged",
                       path);
    return found(out, TC_FORMAT_VTK_LEGACY, kind);
}

static tc_status sniff_hdf5(tc_sniffed *out, const char *path, const unsigned char *head, size_t n, tc_error *err)
{
    if (tc_sniff_has(head, n, "VTKHDF"))
        return found(out, TC_FORMAT_VTKHDF, "");
    if (tc_sniff_has(head, n, "CGNSLibraryVersion"))
        return found(out, TC_FORMAT_CGNS, "HDF5");
    if (tc_sniff_has(head, n, "num_el_blk") ||
        (tc_sniff_has(head, n, "api_version") && tc_sniff_has(head, n, "num_nodes")))
        return found(out, TC_FORMAT_EXODUS, "netCDF-4");
    if (tc_sniff_has(head, n, "ENS_MAA") || tc_sniff_ends(path, ".med"))
        return tc_fail(err, TC_E_FILE, "%s is a MED file, which is not read; convert it: meshio convert %s out.vtu",
                       path, path);
    if (tc_sniff_ends(path, ".cgns"))
        return found(out, TC_FORMAT_CGNS, "HDF5");
    if (tc_sniff_ends(path, ".e") || tc_sniff_ends(path, ".exo") || tc_sniff_ends(path, ".ex2"))
        return found(out, TC_FORMAT_EXODUS, "netCDF-4");
    if (tc_sniff_ends(path, ".vtkhdf"))
        return found(out, TC_FORMAT_VTKHDF, "");
    return tc_fail(err, TC_E_FILE,
                   "%s is an HDF5 file but not VTKHDF, CGNS or Exodus; if an .xdmf file belongs to it, convert that: "
                   "meshio convert X.xdmf out.vtu",
                   path);
}

static bool all_text(const unsigned char *head, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (head[i] == 0)
            return false;
    return n > 0;
}

/* Is there a file or folder of this name in folder? */
static bool holds(const char *folder, const char *name)
{
    struct stat st;
    char path[4096];
    const int n = snprintf(path, sizeof path, "%s/%s", folder, name);
    return n > 0 && (size_t)n < sizeof path && stat(path, &st) == 0;
}

/* The folder that holds path. */
static void folder_of(char *out, size_t capacity, const char *path)
{
    const char *slash = strrchr(path, '/');
    if (slash)
        snprintf(out, capacity, "%.*s", (int)(slash == path ? 1 : slash - path), path);
    else
        snprintf(out, capacity, ".");
}

/* The folder of the OpenFOAM case that path lies in; false when none of the folders above it is one. */
static bool foam_case_above(char *out, size_t capacity, const char *path)
{
    char *real = realpath(path, NULL); /* the way up may lead out of what was typed: 0/U */
    char folder[4096] = "", above[4096];
    bool is_case = false;
    snprintf(folder, sizeof folder, "%s", real ? real : path);
    free(real);
    while (!is_case && strchr(folder, '/') && strcmp(folder, "/") != 0) {
        folder_of(above, sizeof above, folder);
        memcpy(folder, above, sizeof folder);
        is_case = holds(folder, "constant/polyMesh");
    }
    if (is_case)
        snprintf(out, capacity, "%s", folder);
    return is_case;
}

static tc_status refuse_foam_part(const char *path, tc_error *err)
{
    char folder[4096];
    if (foam_case_above(folder, sizeof folder, path))
        return tc_fail(err, TC_E_FILE, "%s is one part of an OpenFOAM case; give the folder of the case: %s", path,
                       folder);
    return tc_fail(err, TC_E_FILE,
                   "%s is one part of an OpenFOAM case; give the folder of the case, with constant/polyMesh in it",
                   path);
}

/* The .case file beside path that has its name, else false. */
static bool case_beside(char *out, size_t capacity, const char *path)
{
    struct stat st;
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    const int stem = (int)(dot ? dot - path : (ptrdiff_t)strlen(path));
    const int n = snprintf(out, capacity, "%.*s.case", stem, path);
    return n > 0 && (size_t)n < capacity && strcmp(out, path) != 0 && stat(out, &st) == 0;
}

static tc_status refuse_ensight_part(const char *path, const char *what, tc_error *err)
{
    char beside[4096];
    if (case_beside(beside, sizeof beside, path))
        return tc_fail(err, TC_E_FILE, "%s is %s of an EnSight case; give the case file: %s", path, what, beside);
    return tc_fail(err, TC_E_FILE, "%s is %s of an EnSight case; give the .case file that names it", path, what);
}

static tc_status sniff_head(tc_sniffed *out, const char *path, const unsigned char *head, size_t n, bool surface,
                            tc_error *err)
{
    memset(out, 0, sizeof *out);
    char text[TEXT_BYTES + 1];
    const size_t n_text = n < TEXT_BYTES ? n : TEXT_BYTES;
    for (size_t i = 0; i < n_text; i++)
        text[i] = head[i] ? (char)head[i] : ' ';
    text[n_text] = 0;

    if (starts(head, n, "# vtk DataFile"))
        return sniff_vtk_legacy(out, path, text, surface, err);
    if (strstr(text, "<VTKFile"))
        return sniff_vtk_xml(out, path, text, surface, err);
    if (starts(head, n, "\x89HDF\r\n\x1a\n"))
        return sniff_hdf5(out, path, head, n, err);
    if (starts(head, n, "CDF\001") || starts(head, n, "CDF\002") || starts(head, n, "CDF\005")) {
        if (tc_sniff_has(head, n, "num_el_blk") || tc_sniff_has(head, n, "num_nodes"))
            return found(out, TC_FORMAT_EXODUS, "netCDF-3");
        return tc_fail(err, TC_E_FILE,
                       "%s is a netCDF file but not Exodus II (it has no element blocks); convert it to .vtu with the "
                       "program that wrote it",
                       path);
    }
    if (tc_sniff_has(head, n_text, "ADF Database Version"))
        return found(out, TC_FORMAT_CGNS, "ADF");
    if (strstr(text, "file-series-version"))
        return found(out, TC_FORMAT_SERIES, "");
    if (all_text(head, n_text) && strstr(text, "FORMAT") && strstr(text, "type:") &&
        (strstr(text, "ensight") || strstr(text, "ENSIGHT") || strstr(text, "EnSight"))) {
        if (strstr(text, "SERVERS") || strstr(text, "master_server"))
            return tc_fail(
                err, TC_E_FILE,
                "%s is an EnSight server-of-servers file, which is not read; give one of the .case files that it "
                "names",
                path);
        return found(out, TC_FORMAT_ENSIGHT, "");
    }
    if (strstr(text, "FoamFile")) {
        if (tc_sniff_ends(path, "controlDict"))
            return found(out, TC_FORMAT_OPENFOAM, "");
        return refuse_foam_part(path, err);
    }
    if (strstr(text, "node id ") && strstr(text, "element id "))
        return refuse_ensight_part(path, "the geometry", err);
    const tc_status status = surface ? tc_sniff_triangles(out, path, head, n, err) : TC_OK;
    if (status || out->format != TC_FORMAT_UNKNOWN)
        return status;
    return tc_sniff_foreign(path, head, n, false, err);
}

tc_status tc_sniff_head(tc_sniffed *out, const char *path, const unsigned char *head, size_t n, tc_error *err)
{
    return sniff_head(out, path, head, n, false, err);
}

static tc_status sniff_case_folder(tc_sniffed *out, const char *path, const char *folder, tc_error *err)
{
    if (holds(folder, "constant/polyMesh"))
        return found(out, TC_FORMAT_OPENFOAM, "");
    if (holds(folder, "processor0"))
        return tc_fail(
            err, TC_E_FILE,
            "%s is an OpenFOAM case that was decomposed for parallel runs, which is not read; put it together "
            "first: reconstructPar",
            path);
    if (holds(folder, "system/controlDict"))
        return tc_fail(err, TC_E_FILE,
                       "%s is an OpenFOAM case without a mesh (constant/polyMesh); make it first: blockMesh", path);
    char above[4096];
    if (foam_case_above(above, sizeof above, path))
        return refuse_foam_part(path, err);
    if (strcmp(path, folder) == 0)
        return tc_fail(err, TC_E_FILE,
                       "%s is a folder, but not of an OpenFOAM case (it has no constant/polyMesh); give a file", path);
    return tc_fail(err, TC_E_FILE, "%s is not in an OpenFOAM case: there is no constant/polyMesh in %s; give a file",
                   path, folder);
}

static tc_status sniff_name(tc_sniffed *out, const char *path, const unsigned char *head, size_t n, tc_error *err)
{
    static const struct {
        const char *extension;
        tc_format format;
    } names[] = {{".ex2", TC_FORMAT_EXODUS},   {".exo", TC_FORMAT_EXODUS},     {".e", TC_FORMAT_EXODUS},
                 {".cgns", TC_FORMAT_CGNS},    {".vtk", TC_FORMAT_VTK_LEGACY}, {".vtu", TC_FORMAT_VTK_XML},
                 {".pvtu", TC_FORMAT_VTK_XML}, {".pvd", TC_FORMAT_PVD},        {".series", TC_FORMAT_SERIES},
                 {".case", TC_FORMAT_ENSIGHT}, {".hdf", TC_FORMAT_VTKHDF},     {".vtkhdf", TC_FORMAT_VTKHDF}};
    static const char *const format_name[] = {
        "?",    "VTK XML", "legacy VTK",          "VTKHDF",     "Exodus II", "EnSight case", "OpenFOAM",
        "CGNS", "PLOT3D",  "ParaView collection", "file series"};
    if (tc_sniff_ends(path, ".foam") || tc_sniff_ends(path, ".OpenFOAM")) {
        char folder[4096];
        folder_of(folder, sizeof folder, path);
        return sniff_case_folder(out, path, folder, err);
    }
    if (n == 0)
        return tc_fail(err, TC_E_FILE, "%s is empty; write or fetch it again", path);
    tc_plot3d_layout layout;
    if (tc_plot3d_layout_of(&layout, path, NULL) == TC_OK && layout.kind != TC_PLOT3D_NONE)
        return found(out, TC_FORMAT_PLOT3D, "");
    const char *slash = strrchr(path, '/');
    if (strstr(slash ? slash : path, "xyz") || tc_sniff_ends(path, ".p3d") || tc_sniff_ends(path, ".x") ||
        tc_sniff_ends(path, ".q"))
        return tc_fail(err, TC_E_FILE,
                       "%s is named like PLOT3D, but its size fits no binary 3-D layout; it is cut short, 2-D or text",
                       path);
    tc_status status = tc_sniff_foreign(path, head, n, true, err);
    if (status)
        return status;
    char beside[4096];
    if (!tc_sniff_ends(path, ".case") && case_beside(beside, sizeof beside, path))
        return refuse_ensight_part(path, "probably a part", err);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (tc_sniff_ends(path, names[i].extension))
            return tc_fail(err, TC_E_FILE, "%s is named like %s, but its content is not; it is damaged or misnamed",
                           path, format_name[names[i].format]);
    return tc_fail(
        err, TC_E_FILE,
        "%s is in no format that is known here; convert it to VTU: meshio convert %s out.vtu (or save it as .vtu "
        "with the program that wrote it)",
        path, path);
}

static tc_status sniff_file(tc_sniffed *out, const char *path, bool surface, tc_error *err)
{
    memset(out, 0, sizeof *out);
    struct stat st;
    if (stat(path, &st) != 0)
        return tc_fail(err, TC_E_FILE, "%s cannot be opened: %s", path, strerror(errno));
    if (S_ISDIR(st.st_mode))
        return sniff_case_folder(out, path, path, err);
    if (!S_ISREG(st.st_mode))
        return tc_fail(err, TC_E_FILE, "%s is not a file; save the data to a file first", path);
    FILE *file = fopen(path, "rb");
    if (!file)
        return tc_fail(err, TC_E_FILE, "%s cannot be opened: %s", path, strerror(errno));
    const size_t want = st.st_size < HEAD_BYTES ? (size_t)st.st_size : (size_t)HEAD_BYTES;
    unsigned char *head = tc_alloc(want, 1);
    if (!head) {
        fclose(file);
        return tc_fail_memory(err, "the head of a file", want, 1);
    }
    const size_t n = fread(head, 1, want, file);
    const bool broken = ferror(file);
    fclose(file);
    tc_status status;
    if (broken)
        status = tc_fail(err, TC_E_FILE, "%s cannot be read: %s", path, strerror(errno));
    else
        status = sniff_head(out, path, head, n, surface, err);
    if (!status && out->format == TC_FORMAT_UNKNOWN)
        status = sniff_name(out, path, head, n, err);
    free(head);
    return status;
}

tc_status tc_sniff_file(tc_sniffed *out, const char *path, tc_error *err)
{
    return sniff_file(out, path, false, err);
}

tc_status tc_sniff_surface(tc_sniffed *out, const char *path, tc_error *err)
{
    return sniff_file(out, path, true, err);
}
