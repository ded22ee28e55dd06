/* sniff.h: what format a file is in, by its content first, then by its name. */
#ifndef TC_READERS_SNIFF_H
#define TC_READERS_SNIFF_H

#include "core/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum tc_format {
    TC_FORMAT_UNKNOWN = 0,
    TC_FORMAT_VTK_XML,
    TC_FORMAT_VTK_LEGACY,
    TC_FORMAT_VTKHDF,
    TC_FORMAT_EXODUS,
    TC_FORMAT_ENSIGHT,
    TC_FORMAT_OPENFOAM,
    TC_FORMAT_CGNS,
    TC_FORMAT_PLOT3D,
    TC_FORMAT_PVD,
    TC_FORMAT_SERIES,
    TC_FORMAT_STL, /* these three by tc_sniff_surface alone */
    TC_FORMAT_OBJ,
    TC_FORMAT_PLY
} tc_format;

typedef struct tc_sniffed {
    tc_format format;
    char kind[64]; /* VTK XML: the type ("PUnstructuredGrid"); legacy VTK: the DATASET; else "" */
} tc_sniffed;

/* Opens path and says what it is. Errors: TC_E_FILE, one sentence with a remedy: not there, not readable, empty, a
 * format that is not read (names the converter), a surface, or not recognised. Reads at most 4 MiB of the file. */
tc_status tc_sniff_file(tc_sniffed *out, const char *path, tc_error *err);

/* The same for a file that is asked for its triangles and lines: surfaces are no error, STL, OBJ and PLY are known. */
tc_status tc_sniff_surface(tc_sniffed *out, const char *path, tc_error *err);

/* tc_sniff_file on a head of the file, without opening it: TC_FORMAT_UNKNOWN when the bytes do not tell.
 *   head [n] bytes; fails when the bytes are those of a format that is not read. */
tc_status tc_sniff_head(tc_sniffed *out, const char *path, const unsigned char *head, size_t n, tc_error *err);

/* sniff_foreign.c: fails with a sentence that names format and converter when head or name are those of a known format
 * that is not read; TC_OK otherwise. by_name: trust the extension too. */
tc_status tc_sniff_foreign(const char *path, const unsigned char *head, size_t n, bool by_name, tc_error *err);

/* sniff_surface.c: tells STL, OBJ and PLY; TC_FORMAT_UNKNOWN for all else. Fails when the name alone says that it is one. */
tc_status tc_sniff_triangles(tc_sniffed *out, const char *path, const unsigned char *head, size_t n, tc_error *err);

/* Is text in head [n]? Case matters. */
bool tc_sniff_has(const unsigned char *head, size_t n, const char *text);
/* Does path end in extension (".vtu"), whatever the case? */
bool tc_sniff_ends(const char *path, const char *extension);

#ifdef __cplusplus
}
#endif
#endif
