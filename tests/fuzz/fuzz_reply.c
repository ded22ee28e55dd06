/* fuzz_reply.c: what helper programs answer: meshes from tetcast-read, imaginary cells from tetcast-convexify.
 * Input: flags; the text of the answer up to a zero; the arrays. No process runs: this file takes worker.c's place.
 * Promises: a mesh that is accepted keeps what src/mesh/mesh.h says; otherwise there is one sentence, and the mesh
 * stays. */
#define _GNU_SOURCE
#include "fuzz.h"

#include "core/memory.h"
#include "core/worker.h"
#include "mesh/adjacency.h"
#include "mesh/mesh.h"
#include "mesh/predicate.h"

#include <math.h>
#include <sys/mman.h>

enum { FILL = 1, HONEST = 2, DETAIL = 4, WILD_IDS = 8, PLAIN_TEXT = 16, ROOM = 1 << 16 };

static tc_fuzz_input input;
static int flags;

tc_status tc_worker_start(tc_worker **out, const char *name, const tc_worker_limits *limits, tc_error *err)
{
    (void)name, (void)limits, (void)err;
    *out = NULL;
    return TC_OK;
}

void tc_worker_stop(tc_worker **worker)
{
    *worker = NULL;
}

size_t tc_worker_peak_bytes(void)
{
    return 0;
}

/* One array at *end of the reply's memory. */
static void *add(tc_reply *out, size_t *end, const char *name, tc_array_type type, size_t count, size_t size)
{
    void *data = (char *)out->map + *end;
    if (count * size > ROOM - *end)
        count = (ROOM - *end) / size;
    *end += (count * size + 63) & ~(size_t)63;
    *end = *end < ROOM ? *end : ROOM;
    out->array[out->n_array++] = (tc_array){name, type, count, data};
    return data;
}

static void answer_read(tc_reply *out)
{
    size_t end = 0, n_vertex = tc_fuzz_u8(&input), n_tet = tc_fuzz_u8(&input), n_scalar = tc_fuzz_u8(&input);
    if (flags & HONEST) {
        n_vertex = 3 * (n_vertex % 24), n_tet = 4 * (n_tet % 24);
        n_scalar = flags & DETAIL ? n_tet / 4 : n_vertex / 3;
    }
    double *vertex = add(out, &end, "vertex", TC_F64, n_vertex, 8);
    int32_t *tet = add(out, &end, "tet", flags & HONEST || n_tet % 8 ? TC_I32 : TC_I64, n_tet, 4);
    double *scalar = add(out, &end, n_scalar % 7 ? "scalar" : "scalars", TC_F64, n_scalar, 8);
    for (size_t i = 0; i < n_vertex; i++)
        vertex[i] = tc_fuzz_real(&input);
    for (size_t i = 0; i < n_tet; i++) {
        uint8_t b = tc_fuzz_u8(&input);
        tet[i] = n_vertex >= 3 && !(flags & WILD_IDS) ? (int32_t)(b % (n_vertex / 3)) : (int32_t)b - 8;
    }
    for (size_t i = 0; i < n_scalar; i++)
        scalar[i] = tc_fuzz_real(&input);
}

static void answer_convexify(tc_reply *out, const tc_array *asked)
{
    size_t end = 0, n = asked[0].count, more = 3 * (tc_fuzz_u8(&input) % 4u), n_tet = tc_fuzz_u8(&input) % 16u;
    double *point = add(out, &end, "point", TC_F64, n + more, 8);
    int32_t *tet = add(out, &end, "tet", TC_I32, 4 * n_tet + (flags & HONEST ? 0 : tc_fuzz_u8(&input) % 2u), 4);
    memcpy(point, asked[0].data, n * sizeof *point);
    for (size_t i = 0; i < more; i++)
        point[n + i] = tc_fuzz_real(&input);
    if (!(flags & HONEST) && n > 0)
        point[tc_fuzz_u8(&input) % n] += tc_fuzz_u8(&input) % 2;
    size_t n_point = (n + more) / 3;
    for (size_t i = 0; i < 4 * n_tet; i++) {
        uint8_t b = tc_fuzz_u8(&input);
        tet[i] = flags & WILD_IDS ? (int32_t)b - 8 : (int32_t)(b % n_point);
    }
}

tc_status tc_worker_call(tc_reply *out, tc_worker *worker, json_t *request, const tc_array *array, size_t n_array,
                         const tc_log *log, tc_error *err)
{
    (void)worker, (void)request, (void)log, (void)err;
    *out = (tc_reply){0};
    char *text = tc_fuzz_text(&input, 0);
    out->json = json_loads(text, 0, NULL);
    free(text);
    if (!json_is_object(out->json)) {
        json_decref(out->json);
        out->json = json_pack("{s:s,s:s,s:i,s:i,s:f}", "format", "f", "reader", "r", "association", 1, "points", 3,
                              "hull_volume", 1.0);
    }
    out->array = tc_calloc(4, sizeof *out->array);
    out->map = mmap(NULL, ROOM, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    out->map_bytes = ROOM;
    if (!out->json || !out->array || out->map == MAP_FAILED)
        abort();
    if (n_array == 2)
        answer_convexify(out, array);
    else
        answer_read(out);
    return TC_OK;
}

static void check_links(const tc_mesh *m)
{
    size_t n = m->n_tet + m->n_imaginary;
    for (size_t t = 0; t < n; t++) {
        const int32_t *v = m->tet + 4 * t;
        const double *x = m->vertex;
        for (int i = 0; i < 4; i++)
            TC_FUZZ_CHECK(v[i] >= 0 && (size_t)v[i] < m->n_vertex);
        TC_FUZZ_CHECK(
            tc_orient3d(x + 3 * (size_t)v[0], x + 3 * (size_t)v[1], x + 3 * (size_t)v[2], x + 3 * (size_t)v[3]) >= 0);
        for (size_t f = 0; f < 4; f++) {
            int32_t other = m->neighbour[4 * t + f];
            int back = 0;
            TC_FUZZ_CHECK(other >= -1 && other < (int32_t)n);
            for (size_t g = 0; other >= 0 && g < 4; g++)
                back += m->neighbour[4 * (size_t)other + g] == (int32_t)t;
            TC_FUZZ_CHECK(other < 0 || back == 1);
        }
    }
}

static void check_source(const tc_source *s)
{
    size_t length = s->path ? strlen(s->path) : 0;
    for (size_t i = 0; i < s->n_array; i++)
        length += s->array[i].name ? strlen(s->array[i].name) : 0;
    for (size_t i = 0; i < s->n_block; i++)
        length += (s->block[i].name ? strlen(s->block[i].name) : 0) + (s->block[i].number > 0);
    for (size_t i = 0; i < s->n_cell_type; i++)
        length += s->cell_type[i].type ? strlen(s->cell_type[i].type) : 0;
    for (size_t i = 0; i < s->n_note; i++)
        length += s->note[i] ? strlen(s->note[i]) : 0;
    for (size_t i = 0; i < s->n_time; i++)
        length += s->time[i] > 0;
    TC_FUZZ_CHECK(length > 0 && s->format != (const char *)s);
}

/* A dented mesh: cubes of a row, of which the middle one is missing, or two tets that touch in an edge. */
static tc_mesh *dented(void)
{
    static const double vertex[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0, 0, 1, 1, 1, 1, 1};
    static const int32_t tet[] = {0, 1, 2, 3, 0, 2, 4, 3, 2, 4, 5, 6, 3, 5, 1, 6};
    static const double field[] = {0, 1, 2, 3, 4, 5, 6};
    tc_mesh_arrays in = {7, vertex, (size_t)(2 + 2 * !(flags & DETAIL)), tet, field, TC_POINT_DATA, "f"};
    tc_mesh *m = NULL;
    if (tc_mesh_create(&m, &in, NULL) != TC_OK)
        abort();
    return m;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tc_error err = {0};
    tc_mesh *m = NULL;
    tc_prepare_options options = {.reentry = TC_REENTRY_PEEL, .threads = 1};
    input = (tc_fuzz_input){data, size};
    flags = tc_fuzz_u8(&input);
    if (flags & FILL) {
        m = dented();
        options.reentry = TC_REENTRY_AUTO;
    } else {
        tc_read_options read = {.field = flags & DETAIL ? "f" : NULL};
        tc_status status = tc_mesh_read(&m, "file", &read, NULL, &err);
        TC_FUZZ_CHECK((status == TC_OK) == (m != NULL));
        TC_FUZZ_CHECK(m || (err.text[0] && !strchr(err.text, '\n')));
        if (m)
            check_source(tc_mesh_source(m));
    }
    if (m && tc_mesh_prepare(m, &options, NULL, &err) == TC_OK)
        check_links(m);
    else
        TC_FUZZ_CHECK(err.text[0]);
    tc_mesh_destroy(&m);
    return 0;
}
