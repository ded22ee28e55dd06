/* plot3d_layout.c: how a PLOT3D file is laid out, found by arithmetic on its size.
 * Walatka, Buning, Pierce, Elson 1990, "PLOT3D User's Manual" (NASA TM 101067), chapter 8: an XYZ file holds the grid
 * sizes, then all x, all y, all z (and IBLANK) of each grid; a Q file the sizes, then four numbers and five functions
 * of each. FORTRAN unformatted files put a byte count before and behind each record. */
#define _GNU_SOURCE

#include "plot3d_layout.h"

#include "core/memory.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_GRID = 4096 };

static uint32_t word(const unsigned char *p, bool big)
{
    return big ? (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3]
               : (uint32_t)p[3] << 24 | (uint32_t)p[2] << 16 | (uint32_t)p[1] << 8 | p[0];
}

/* Bytes of a file of this layout with these grids, or -1 when a size cannot be. */
static int64_t expected_bytes(const tc_plot3d_layout *layout, const unsigned char *dims, int64_t *n_point)
{
    const int64_t count = layout->byte_counts ? 8 : 0;
    const int64_t real = layout->double_precision ? 8 : 4;
    int64_t total = (layout->multi_grid ? 4 + count : 0) + 12 * (int64_t)layout->n_grid + count;
    *n_point = 0;
    for (size_t g = 0; g < layout->n_grid; g++) {
        int64_t n = 1;
        for (int k = 0; k < 3; k++) {
            const int64_t d = word(dims + 12 * g + 4 * (size_t)k, layout->big_endian);
            if (d < 1 || d > 100000000 || n > INT64_C(1000000000000) / d)
                return -1;
            n *= d;
        }
        *n_point += n;
        total += layout->kind == TC_PLOT3D_XYZ ? 3 * n * real + (layout->iblank ? 4 * n : 0) + count
                                               : 4 * real + count + 5 * n * real + count;
    }
    return total;
}

static bool fits(tc_plot3d_layout *layout, const unsigned char *head, size_t n_head, int64_t size, bool padded)
{
    size_t at = layout->byte_counts ? 4 : 0;
    layout->n_grid = 1;
    if (layout->multi_grid) {
        if (at + 4 > n_head)
            return false;
        const uint32_t n = word(head + at, layout->big_endian);
        if (n < 1 || n > MAX_GRID)
            return false;
        if (layout->byte_counts && word(head, layout->big_endian) != 4)
            return false;
        layout->n_grid = n;
        at += layout->byte_counts ? 12 : 4;
    } else if (layout->byte_counts && (n_head < 4 || word(head, layout->big_endian) != 12)) {
        return false;
    }
    if (at + 12 * layout->n_grid > n_head)
        return false;
    const int64_t expected = expected_bytes(layout, head + at, &layout->n_point);
    /* Some files are filled up to whole blocks of 512 bytes. */
    return expected == size || (padded && expected > 0 && size % 512 == 0 && (expected + 511) / 512 * 512 == size);
}

tc_status tc_plot3d_layout_of(tc_plot3d_layout *out, const char *path, tc_error *err)
{
    memset(out, 0, sizeof *out);
    FILE *file = fopen(path, "rb");
    if (!file)
        return tc_fail(err, TC_E_FILE, "%s cannot be opened: %s", path, strerror(errno));
    struct stat st;
    const size_t capacity = 24 + 12 * (size_t)MAX_GRID;
    unsigned char *head = tc_calloc(capacity, 1);
    if (!head || fstat(fileno(file), &st) != 0) {
        const int why = errno;
        fclose(file);
        if (!head)
            return tc_fail_memory(err, "the head of a file", capacity, 1);
        free(head);
        return tc_fail(err, TC_E_FILE, "%s cannot be examined: %s", path, strerror(why));
    }
    const size_t n_head = fread(head, 1, capacity, file);
    fclose(file);
    for (unsigned code = 0; code < 128; code++) {
        tc_plot3d_layout layout = {.kind = code & 32 ? TC_PLOT3D_Q : TC_PLOT3D_XYZ,
                                   .big_endian = !(code & 1),
                                   .byte_counts = code & 2,
                                   .multi_grid = code & 4,
                                   .iblank = code & 8,
                                   .double_precision = code & 16};
        if (layout.kind == TC_PLOT3D_Q && layout.iblank)
            continue;
        if (fits(&layout, head, n_head, (int64_t)st.st_size, code & 64)) {
            *out = layout;
            break;
        }
    }
    free(head);
    return TC_OK;
}

/* Is there a file of the wanted kind with the same grid? */
static bool is_partner(const char *path, const tc_plot3d_layout *layout)
{
    tc_plot3d_layout other;
    struct stat st;
    return stat(path, &st) == 0 && S_ISREG(st.st_mode) && tc_plot3d_layout_of(&other, path, NULL) == TC_OK &&
           other.kind != TC_PLOT3D_NONE && other.kind != layout->kind && other.n_grid == layout->n_grid &&
           other.n_point == layout->n_point;
}

/* path with [at, at + n) replaced; false when it does not fit. */
static bool replaced(char *out, size_t capacity, const char *path, size_t at, size_t n, const char *with)
{
    const int length = snprintf(out, capacity, "%.*s%s%s", (int)at, path, with, path + at + n);
    return length > 0 && (size_t)length < capacity;
}

bool tc_plot3d_partner(char *out, size_t capacity, const char *path, const tc_plot3d_layout *layout)
{
    const char *slash = strrchr(path, '/');
    const size_t base = slash ? (size_t)(slash + 1 - path) : 0;
    const char *from_all[] = {"xyz", "XYZ", "grid", "x", "g"};
    const char *to_all[] = {"q", "Q", "soln", "sol"};
    const bool xyz = layout->kind == TC_PLOT3D_XYZ;
    const char **from = xyz ? from_all : to_all, **to = xyz ? to_all : from_all;
    const size_t n_from = xyz ? 5 : 4, n_to = xyz ? 4 : 5;
    const size_t length = strlen(path);
    for (size_t f = 0; f < n_from; f++) {
        const size_t n = strlen(from[f]);
        /* The last place first: of "boxq/inq.bin" the q before ".bin". */
        for (size_t at = length; at-- > base;) {
            if (strncmp(path + at, from[f], n) != 0)
                continue;
            for (size_t t = 0; t < n_to; t++)
                if (replaced(out, capacity, path, at, n, to[t]) && is_partner(out, layout))
                    return true;
        }
    }
    return false;
}
