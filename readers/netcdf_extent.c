/* netcdf_extent.c: how long a classic netCDF file must be, from its header.
 * Source: "The NetCDF Classic Format Specification" (Unidata): versions 1, 2 and 5; big-endian; names and values are
 * padded to 4 bytes; record variables repeat together, each padded, unless there is only one. */
#define _GNU_SOURCE

#include "netcdf_extent.h"

#include "core/memory.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { TAG_DIMENSION = 10, TAG_VARIABLE = 11, TAG_ATTRIBUTE = 12, MAX_ITEMS = 1 << 20 };

typedef struct cursor {
    FILE *file;
    int version;
    bool bad; /* the header itself ends early or makes no sense */
} cursor;

static uint64_t get(cursor *c, int bytes)
{
    unsigned char b[8];
    uint64_t v = 0;
    if (c->bad || fread(b, 1, (size_t)bytes, c->file) != (size_t)bytes) {
        c->bad = true;
        return 0;
    }
    for (int i = 0; i < bytes; i++)
        v = v << 8 | b[i];
    return v;
}

/* A count: 4 bytes, 8 in version 5. */
static uint64_t get_count(cursor *c)
{
    return get(c, c->version == 5 ? 8 : 4);
}

static void skip(cursor *c, uint64_t bytes)
{
    bytes = (bytes + 3) & ~UINT64_C(3);
    if (c->bad || bytes > INT64_C(1) << 40 || fseeko(c->file, (off_t)bytes, SEEK_CUR) != 0)
        c->bad = true;
}

static uint64_t type_size(uint64_t type)
{
    static const uint64_t size[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    return type < sizeof size / sizeof *size ? size[type] : 0;
}

/* Number of items of a list that starts here. */
static uint64_t list_length(cursor *c, uint64_t tag)
{
    const uint64_t found = get(c, 4), n = get_count(c);
    if ((found != tag && !(found == 0 && n == 0)) || n > MAX_ITEMS)
        c->bad = true;
    return c->bad ? 0 : n;
}

static void skip_attributes(cursor *c)
{
    const uint64_t n = list_length(c, TAG_ATTRIBUTE);
    for (uint64_t i = 0; i < n && !c->bad; i++) {
        skip(c, get_count(c));
        const uint64_t size = type_size(get(c, 4));
        const uint64_t count = get_count(c);
        if (size == 0 || count > UINT64_C(1) << 40)
            c->bad = true;
        else
            skip(c, size * count);
    }
}

/* Bytes the file must have; 0 when the header is broken. */
static uint64_t required_bytes(cursor *c, tc_error *err, tc_status *status)
{
    const uint64_t n_record = get_count(c);
    const bool streaming = n_record == (c->version == 5 ? UINT64_MAX : UINT32_MAX);
    const uint64_t n_dim = list_length(c, TAG_DIMENSION);
    uint64_t *dim = tc_calloc((size_t)n_dim, sizeof *dim);
    if (!dim) {
        *status = tc_fail_memory(err, "the dimensions of a netCDF file", (size_t)n_dim, sizeof *dim);
        return 0;
    }
    for (uint64_t i = 0; i < n_dim && !c->bad; i++) {
        skip(c, get_count(c));
        dim[i] = get_count(c);
    }
    skip_attributes(c);
    const uint64_t n_var = list_length(c, TAG_VARIABLE);
    uint64_t end = 0, record_bytes = 0, record_last = 0, n_record_var = 0, lone = 0;
    for (uint64_t v = 0; v < n_var && !c->bad; v++) {
        skip(c, get_count(c));
        const uint64_t rank = get_count(c);
        uint64_t n = 1;
        bool record = false;
        if (rank > n_dim)
            c->bad = true;
        for (uint64_t k = 0; k < rank && !c->bad; k++) {
            const uint64_t id = get_count(c);
            if (id >= n_dim)
                c->bad = true;
            else if (dim[id] == 0 && k == 0)
                record = true;
            else if (dim[id] > 0 && n > (UINT64_C(1) << 44) / dim[id])
                c->bad = true;
            else
                n *= dim[id];
        }
        skip_attributes(c);
        const uint64_t bytes = n * type_size(get(c, 4));
        get_count(c); /* vsize: overflows in large files, so it is not used */
        const uint64_t begin = get(c, c->version == 1 ? 4 : 8);
        if (!record) {
            end = begin + bytes > end ? begin + bytes : end;
            continue;
        }
        n_record_var++;
        lone = bytes;
        record_bytes += (bytes + 3) & ~UINT64_C(3);
        record_last = begin + bytes > record_last ? begin + bytes : record_last;
    }
    free(dim);
    if (n_record_var > 0 && n_record > 0 && !streaming && !c->bad) {
        const uint64_t each = n_record_var == 1 ? lone : record_bytes;
        if (n_record > (UINT64_C(1) << 32))
            c->bad = true;
        else if (record_last + (n_record - 1) * each > end)
            end = record_last + (n_record - 1) * each;
    }
    return c->bad ? 0 : end;
}

tc_status tc_netcdf_check_extent(const char *path, tc_error *err)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return tc_fail(err, TC_E_FILE, "%s cannot be opened: %s", path, strerror(errno));
    char magic[4] = "";
    struct stat st;
    tc_status status = TC_OK;
    if (fstat(fileno(file), &st) == 0 && fread(magic, 1, 4, file) == 4 && memcmp(magic, "CDF", 3) == 0 &&
        (magic[3] == 1 || magic[3] == 2 || magic[3] == 5)) {
        cursor c = {file, magic[3], false};
        const uint64_t need = required_bytes(&c, err, &status);
        if (!status && c.bad)
            status =
                tc_fail(err, TC_E_FILE, "%s is a netCDF file with a damaged header; write or fetch it again", path);
        else if (!status && need > (uint64_t)st.st_size)
            status = tc_fail(err, TC_E_FILE,
                             "%s is cut short: it has %lld bytes, its header calls for %llu; write or fetch it again",
                             path, (long long)st.st_size, (unsigned long long)need);
    }
    fclose(file);
    return status;
}
