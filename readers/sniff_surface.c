/* sniff_surface.c: which file of triangles it is: STL, Wavefront OBJ, PLY. (VTK's own are told in sniff.c.) */
#include "sniff.h"

#include <ctype.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>

enum { STL_HEAD = 84, STL_FACET = 50, NEAR_BYTES = 4096 };

static bool starts(const unsigned char *head, size_t n, const char *text)
{
    return n >= strlen(text) && memcmp(head, text, strlen(text)) == 0;
}

/* 80 bytes of anything, the number of facets, 50 bytes each. */
static bool is_binary_stl(const char *path, const unsigned char *head, size_t n)
{
    struct stat st;
    if (n < STL_HEAD || stat(path, &st) != 0)
        return false;
    const uint32_t facets =
        (uint32_t)head[80] | (uint32_t)head[81] << 8 | (uint32_t)head[82] << 16 | (uint32_t)head[83] << 24;
    return facets > 0 && (int64_t)st.st_size == STL_HEAD + (int64_t)STL_FACET * facets;
}

/* Is there a line "v X …"? */
static bool has_obj_vertex(const unsigned char *head, size_t n)
{
    for (size_t i = 0; i + 2 < n; i++)
        if ((i == 0 || head[i - 1] == '\n' || head[i - 1] == '\r') && head[i] == 'v' && isspace(head[i + 1]))
            return true;
    return false;
}

tc_status tc_sniff_triangles(tc_sniffed *out, const char *path, const unsigned char *head, size_t n, tc_error *err)
{
    const size_t near = n < NEAR_BYTES ? n : NEAR_BYTES;
    size_t blank = 0;
    while (blank < near && isspace(head[blank]))
        blank++;
    const bool stl = tc_sniff_ends(path, ".stl");
    memset(out, 0, sizeof *out);
    if (starts(head, n, "ply\n") || starts(head, n, "ply\r"))
        out->format = TC_FORMAT_PLY;
    else if (stl && is_binary_stl(path, head, n))
        out->format = TC_FORMAT_STL;
    else if (starts(head + blank, near - blank, "solid") && tc_sniff_has(head, near, "facet"))
        out->format = TC_FORMAT_STL;
    else if (tc_sniff_ends(path, ".obj") && has_obj_vertex(head, n))
        out->format = TC_FORMAT_OBJ;
    else if (starts(head, n, "OFF") || tc_sniff_ends(path, ".off"))
        return tc_fail(err, TC_E_FILE, "%s is an OFF surface, which is not read; convert it: meshio convert %s out.ply",
                       path, path);
    else if (tc_sniff_ends(path, ".g"))
        return tc_fail(err, TC_E_FILE,
                       "%s is a BYU surface, which is not read; open it in ParaView and save it as .ply or .vtp", path);
    else if (n > 0 && (stl || tc_sniff_ends(path, ".obj") || tc_sniff_ends(path, ".ply")))
        return tc_fail(err, TC_E_FILE,
                       "%s is named like a surface (STL, OBJ or PLY), but its content is not; it is cut short, damaged "
                       "or misnamed",
                       path);
    return TC_OK;
}
