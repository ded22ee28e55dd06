/* fuzz_sniff.c: telling file formats from any bytes, PLOT3D layouts and the length of netCDF files.
 * Input: a byte that chooses a name, then the file. Promises: a format is known, or one sentence names the file. */
#define _GNU_SOURCE
#include "fuzz.h"

#include "readers/netcdf_extent.h"
#include "readers/plot3d_layout.h"
#include "readers/sniff.h"

#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

static void remove_folder(void)
{
    rmdir(folder);
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc, (void)argv;
    snprintf(folder, sizeof folder, "%s/tetcast-fuzz-XXXXXX", access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp");
    if (!mkdtemp(folder))
        return 1;
    atexit(remove_folder);
    return 0;
}

static void check(tc_status status, const tc_sniffed *s, const tc_error *err, const char *path)
{
    if (status == TC_OK)
        TC_FUZZ_CHECK(s->format >= TC_FORMAT_UNKNOWN && s->format <= TC_FORMAT_SERIES &&
                      memchr(s->kind, 0, sizeof s->kind));
    else
        TC_FUZZ_CHECK(err->code == status && strstr(err->text, path) && !strchr(err->text, '\n'));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const name[] = {"a.vtu",  "a.vtk", "a.e",    "a.cgns", "a.case",      "a.foam", "axyz.bin",
                                       "aq.bin", "a.p3d", "a.pvd",  "a.hdf",  "a.obj",       "a.inp",  "controlDict",
                                       "a",      "a.geo", "a.xdmf", "a.med",  "a.vtk.series"};
    tc_fuzz_input in = {data, size};
    char path[256], partner[300];
    tc_sniffed sniffed;
    tc_error err = {0};
    tc_plot3d_layout layout;
    snprintf(path, sizeof path, "%s/%s", folder, name[tc_fuzz_u8(&in) % (sizeof name / sizeof *name)]);
    uint8_t *copy = malloc(in.n ? in.n : 1); /* exactly as long, so that reading past the end is seen */
    FILE *file = fopen(path, "wb");
    if (!copy || !file)
        abort();
    if (in.n)
        memcpy(copy, in.data, in.n);
    fwrite(copy, 1, in.n, file);
    fclose(file);
    check(tc_sniff_head(&sniffed, path, copy, in.n, &err), &sniffed, &err, path);
    check(tc_sniff_file(&sniffed, path, &err), &sniffed, &err, path);
    TC_FUZZ_CHECK(tc_plot3d_layout_of(&layout, path, &err) == TC_OK);
    TC_FUZZ_CHECK(layout.kind == TC_PLOT3D_NONE || (layout.n_grid >= 1 && layout.n_point >= 1));
    if (layout.kind != TC_PLOT3D_NONE)
        tc_plot3d_partner(partner, sizeof partner, path, &layout);
    if (tc_netcdf_check_extent(path, &err) != TC_OK)
        TC_FUZZ_CHECK(strstr(err.text, path) != NULL || err.code == TC_E_MEMORY);
    unlink(path);
    free(copy);
    return 0;
}
