/* sniff_foreign.c: formats that are known but not read, each with what to do instead. */
#include "sniff.h"

#include <ctype.h>
#include <string.h>

typedef struct foreign_format {
    const char *name;
    const char *magic;        /* how the file starts, after white space; NULL: told by name alone */
    const char *inside;       /* or a text within its first bytes; NULL */
    const char *extension[6]; /* trusted when nothing else is known */
    const char *remedy;       /* a whole clause; NULL: meshio */
} foreign_format;

#define SURFACE "it holds a surface, not a volume, and has no 3-D cells to render"
#define COLOUR_MAP "give it with --color-map, and a mesh as the input"
#define UNPACK "unpack it first"
#define EXPORT "export the result as .vtu, EnSight, CGNS or Exodus from the program that wrote it"

static const foreign_format foreign[] = {
    {"a git-lfs pointer", "version https://git-lfs", NULL, {NULL}, "fetch the data itself: git lfs pull"},
    {"a web page", "<!DOCTYPE html", NULL, {NULL}, "the download failed; fetch the file again"},
    {"a web page", "<html", NULL, {NULL}, "the download failed; fetch the file again"},
    {"a gzip archive", "\x1f\x8b", NULL, {NULL}, UNPACK},
    {"a zip archive", "PK\003\004", NULL, {NULL}, UNPACK},
    {"a bzip2 archive", "BZh", NULL, {NULL}, UNPACK},
    {"an xz archive",
     "\xfd"
     "7zXZ",
     NULL,
     {NULL},
     UNPACK},
    {"a zstd archive", "\x28\xb5\x2f\xfd", NULL, {NULL}, UNPACK},
    {"a ParaView colour map", NULL, "<ColorMap", {NULL}, COLOUR_MAP},
    {"a ParaView colour map", NULL, "\"RGBPoints\"", {NULL}, COLOUR_MAP},
    {"an XDMF file", NULL, "<Xdmf", {".xdmf", ".xmf", ".xdmf2", ".xdmf3"}, NULL},
    {"a Gmsh mesh", "$MeshFormat", NULL, {NULL}, NULL},
    {"a Gmsh mesh", "$NOD", NULL, {NULL}, NULL},
    {"a Gmsh script", NULL, NULL, {".geo"}, "mesh it (gmsh -3 X.geo -o X.msh), then meshio convert X.msh out.vtu"},
    {"an Abaqus input file", "*HEADING", NULL, {".inp"}, NULL},
    {"an Abaqus input file", "*Heading", NULL, {NULL}, NULL},
    {"an Abaqus input file", "*NODE", NULL, {NULL}, NULL},
    {"an Abaqus result database", NULL, NULL, {".odb", ".fil"}, EXPORT},
    {"a Nastran bulk data file", "BEGIN BULK", "BEGIN BULK", {".bdf", ".nas", ".fem"}, NULL},
    {"a Nastran result file", NULL, NULL, {".op2", ".f06"}, EXPORT},
    {"an ANSYS input or result file", "/PREP7", NULL, {".cdb", ".rst", ".rth"}, EXPORT},
    {"an LS-DYNA keyword file", "*KEYWORD", NULL, {".k", ".key"}, EXPORT},
    {"an LS-DYNA result file", NULL, NULL, {".d3plot"}, EXPORT},
    {"a Fluent file", "(0 \"", NULL, {".cas"}, EXPORT},
    {"a MED file", NULL, NULL, {".med"}, NULL},
    {"a MEDIT mesh", "MeshVersionFormatted", NULL, {".mesh", ".meshb"}, NULL},
    {"an MFEM mesh", "MFEM mesh", NULL, {NULL}, "save it as .vtu with MFEM's ParaViewDataCollection"},
    {"a Netgen mesh", "mesh3d", NULL, {".vol"}, NULL},
    {"a TetGen mesh", NULL, NULL, {".ele", ".node"}, NULL},
    {"a Tecplot file", "#!TDV", NULL, {".plt", ".szplt"}, EXPORT},
    {"a Tecplot file", NULL, "VARIABLES", {".tec", ".dat"}, NULL},
    {"an SU2 mesh", "NDIME=", NULL, {".su2"}, NULL},
    {"an FLAC3D grid", "* FLAC3D", NULL, {".f3grid"}, NULL},
    {"a COMSOL mesh", NULL, NULL, {".mphtxt", ".mph"}, EXPORT},
    {"an I-DEAS universal file", NULL, NULL, {".unv"}, NULL},
    {"an MSC Marc or Patran file", NULL, NULL, {".t16", ".t19", ".neu"}, EXPORT},
    {"a PLY file", "ply\n", NULL, {".ply"}, SURFACE},
    {"a PLY file", "ply\r", NULL, {NULL}, SURFACE},
    {"an OFF file", "OFF", NULL, {".off"}, SURFACE},
    {"an STL file", "solid ", NULL, {".stl"}, SURFACE},
    {"a Wavefront OBJ file", NULL, NULL, {".obj"}, SURFACE},
    {"a BYU file", NULL, NULL, {".g"}, SURFACE},
    {"a raw or medical image",
     "NRRD",
     NULL,
     {".nrrd", ".nhdr", ".mha", ".mhd", ".nii", ".raw"},
     "save it as VTK ImageData (.vti)"},
    {"a picture", "\x89PNG", NULL, {".png", ".jpg", ".tif", ".tiff", ".exr"}, "it is no mesh"},
};

static bool starts_after_space(const unsigned char *head, size_t n, const char *magic)
{
    size_t at = 0;
    while (at < n && at < 512 && isspace(head[at]))
        at++;
    return n - at >= strlen(magic) && memcmp(head + at, magic, strlen(magic)) == 0;
}

static tc_status refuse(const foreign_format *f, const char *path, tc_error *err)
{
    if (!f->remedy)
        return tc_fail(err, TC_E_FILE, "%s is %s, which is not read; convert it: meshio convert %s out.vtu", path,
                       f->name, path);
    return tc_fail(err, TC_E_FILE, "%s is %s, which is not read; %s", path, f->name, f->remedy);
}

tc_status tc_sniff_foreign(const char *path, const unsigned char *head, size_t n, bool by_name, tc_error *err)
{
    const size_t n_foreign = sizeof foreign / sizeof *foreign;
    const size_t near = n < 4096 ? n : 4096;
    for (size_t i = 0; i < n_foreign; i++) {
        const foreign_format *f = &foreign[i];
        /* A text inside alone may be anywhere in any file: it counts with the name, or where it is XML. */
        const bool inside = f->inside && (by_name || f->inside[0] == '<') && tc_sniff_has(head, near, f->inside);
        if ((f->magic && starts_after_space(head, n, f->magic)) || inside)
            return refuse(f, path, err);
    }
    for (size_t i = 0; by_name && i < n_foreign; i++)
        for (size_t k = 0; k < 6 && foreign[i].extension[k]; k++)
            if (tc_sniff_ends(path, foreign[i].extension[k]))
                return refuse(&foreign[i], path, err);
    return TC_OK;
}
