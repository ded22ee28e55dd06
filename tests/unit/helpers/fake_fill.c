/* fake_fill.c: a helper tetcast-convexify that answers what a test wrote into the file $TETCAST_FAKE_ANSWER
 * (fake_fill.h), or goes wrong in the way that it names. */
#include "fake_fill.h"

#include "core/serve.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *read_items(FILE *file, size_t n, size_t size)
{
    void *items = malloc(n * size + 1);
    if (!items || (n > 0 && fread(items, size, n, file) != n))
        exit(9);
    return items;
}

static void spin(void)
{
    for (volatile unsigned i = 0;; i++) {
    }
}

/* Takes memory until there is none. */
static void swallow(tc_serve *serve)
{
    for (int i = 0; i < 64; i++) {
        void *volatile block = malloc((size_t)1 << 27);
        if (!block) {
            tc_serve_error(serve, "the fake helper ran out of memory");
            return;
        }
    }
    tc_serve_error(serve, "the fake helper was given 8 GiB of memory");
}

static void handle(void *context, tc_serve *serve, json_t *request, const tc_array *array, size_t n_array)
{
    (void)context, (void)request;
    const char *path = getenv("TETCAST_FAKE_ANSWER");
    FILE *file = path ? fopen(path, "rb") : NULL;
    if (!file || n_array != 2)
        exit(8);
    fake_answer *a = read_items(file, 1, sizeof *a);
    double *extra = read_items(file, (size_t)a->n_extra, sizeof *extra);
    int32_t *tet = read_items(file, (size_t)a->n_tet, sizeof *tet);
    fclose(file);
    size_t n = array[0].count;
    double *point = malloc((n + (size_t)a->n_extra) * sizeof *point);
    if (!point)
        exit(9);
    memcpy(point, array[0].data, n * sizeof *point);
    memcpy(point + n, extra, (size_t)a->n_extra * sizeof *point);
    n += (size_t)a->n_extra;
    switch (a->way) {
    case FAKE_CRASH:
        signal(SIGSEGV, SIG_DFL); /* sanitizers catch it otherwise */
        raise(SIGSEGV);
        break;
    case FAKE_ABORT:
        fprintf(stderr, "Error: the program stops here\n");
        signal(SIGABRT, SIG_DFL);
        raise(SIGABRT);
        break;
    case FAKE_EXIT:
        exit(3);
    case FAKE_THROW:
        tc_serve_error(serve, "TetGen met an internal error on this boundary");
        goto done;
    case FAKE_SPIN:
        spin();
        break;
    case FAKE_SWALLOW:
        swallow(serve);
        goto done;
    case FAKE_SILENT:
        goto done;
    case FAKE_MOVE:
        point[1] = nextafter(point[1], 1e9);
        break;
    case FAKE_NAN:
        point[0] = NAN;
        break;
    case FAKE_SHORT:
        n -= 3;
        break;
    case FAKE_CROOKED:
        n -= 1;
        break;
    default:
        break;
    }
    tc_array result[2] = {{"point", TC_F64, n, point}, {"tet", TC_I32, (size_t)a->n_tet, tet}};
    if (a->way == FAKE_TYPES)
        result[1].type = TC_F32;
    json_t *json = a->way == FAKE_NO_VOLUME ? json_object() : json_pack("{s:f}", "hull_volume", a->hull_volume);
    tc_serve_result(serve, json, result, a->way == FAKE_NO_TETS ? 1 : 2);
    json_decref(json);
done:
    free(point);
    free(extra);
    free(tet);
    free(a);
}

int main(int argc, char **argv)
{
    return tc_serve_main(argc, argv, "tetcast-convexify", handle, NULL);
}
