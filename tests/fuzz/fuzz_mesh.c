/* fuzz_mesh.c: repair, order and adjacency of meshes from any indices and coordinates.
 * Input: numbers of vertices and tets, flags, coordinates, ids, scalars. Promises (src/mesh/mesh.h): adjacency is an
 * involution of faces with equal vertices on opposite sides, no tet repeats a vertex, none is of negative volume, the
 * boundary is what has no neighbour, wound outwards, and its edges are linked both ways. */
#include "fuzz.h"

#include "mesh/adjacency.h"
#include "mesh/boundary.h"
#include "mesh/predicate.h"

#include <math.h>

enum { VERTICES = 40, TETS = 60, WILD_IDS = 4, PLAIN = 8, SET_AGAIN = 16 };

typedef struct arrays {
    double vertex[3 * VERTICES], scalar[TETS + VERTICES], again[TETS + VERTICES];
    int32_t tet[4 * TETS];
} arrays;

/* Corners of face f of tet t, as seen from outside. */
static void face_of(int32_t out[3], const tc_mesh *m, size_t t, int f)
{
    for (int i = 0; i < 3; i++)
        out[i] = m->tet[4 * t + tc_tet_face[f][i]];
}

/* The same three corners the other way round? */
static bool opposed(const int32_t a[3], const int32_t b[3])
{
    for (int i = 0; i < 3; i++)
        if (a[0] == b[i] && a[1] == b[(i + 2) % 3] && a[2] == b[(i + 1) % 3])
            return true;
    return false;
}

static void check_links(const tc_mesh *m)
{
    size_t open = 0;
    for (size_t t = 0; t < m->n_tet; t++) {
        const int32_t *v = m->tet + 4 * t;
        for (int i = 0; i < 4; i++) {
            TC_FUZZ_CHECK(v[i] >= 0 && (size_t)v[i] < m->n_vertex);
            for (int j = 0; j < i; j++)
                TC_FUZZ_CHECK(v[i] != v[j]);
            for (int k = 0; k < 3; k++)
                TC_FUZZ_CHECK(isfinite(m->vertex[3 * (size_t)v[i] + (size_t)k]));
        }
        const double *x = m->vertex;
        TC_FUZZ_CHECK(
            tc_orient3d(x + 3 * (size_t)v[0], x + 3 * (size_t)v[1], x + 3 * (size_t)v[2], x + 3 * (size_t)v[3]) >= 0);
        for (int f = 0; f < 4; f++) {
            int32_t other = m->neighbour[4 * t + (size_t)f], a[3], b[3];
            int back = 0;
            open += other < 0;
            if (other < 0)
                continue;
            TC_FUZZ_CHECK((size_t)other < m->n_tet && (size_t)other != t);
            face_of(a, m, t, f);
            for (int g = 0; g < 4; g++)
                if (m->neighbour[4 * (size_t)other + (size_t)g] == (int32_t)t) {
                    face_of(b, m, (size_t)other, g);
                    back += opposed(a, b);
                }
            TC_FUZZ_CHECK(back == 1);
        }
    }
    TC_FUZZ_CHECK(open == m->report.n_boundary_face);
}

/* What convexify would be handed. */
static void check_boundary(const tc_mesh *m)
{
    tc_boundary b;
    tc_error err = {0};
    if (tc_boundary_build(&b, m, m->n_tet, &err) != TC_OK)
        abort();
    size_t odd = 0;
    TC_FUZZ_CHECK(b.n_face == m->report.n_boundary_face);
    for (size_t i = 0; i < b.n_vertex; i++)
        TC_FUZZ_CHECK(b.vertex[i] >= 0 && (size_t)b.vertex[i] < m->n_vertex &&
                      (i == 0 || b.vertex[i] > b.vertex[i - 1]));
    for (size_t i = 0; i < b.n_face; i++) {
        int32_t want[3], have[3];
        size_t t = b.owner[i] / 4;
        TC_FUZZ_CHECK(t < m->n_tet && m->neighbour[b.owner[i]] < 0);
        face_of(want, m, t, (int)(b.owner[i] % 4));
        for (int k = 0; k < 3; k++) {
            TC_FUZZ_CHECK(b.face[3 * i + (size_t)k] >= 0 && (size_t)b.face[3 * i + (size_t)k] < b.n_vertex);
            have[k] = b.vertex[b.face[3 * i + (size_t)k]];
        }
        TC_FUZZ_CHECK((have[0] == want[0] && have[1] == want[1] && have[2] == want[2]) ||
                      (have[0] == want[1] && have[1] == want[2] && have[2] == want[0]) ||
                      (have[0] == want[2] && have[1] == want[0] && have[2] == want[1]));
        for (size_t e = 0; e < 3; e++) {
            int64_t across = b.across[3 * i + e];
            odd += across < 0;
            if (across < 0)
                continue;
            size_t g = (size_t)across / 3, d = (size_t)across % 3;
            TC_FUZZ_CHECK(g < b.n_face && b.across[across] == (int64_t)(3 * i + e));
            TC_FUZZ_CHECK(b.face[3 * g + d] == b.face[3 * i + (e + 1) % 3] &&
                          b.face[3 * g + (d + 1) % 3] == b.face[3 * i + e]);
        }
    }
    TC_FUZZ_CHECK(odd == b.n_odd_edge);
    TC_FUZZ_CHECK(tc_boundary_is_convex(&b, m->vertex, tc_boundary_rounding(m->report.bounds)) == m->report.convex);
    tc_boundary_finish(&b);
}

static void check_report(const tc_mesh *m, const tc_mesh_arrays *in)
{
    const tc_mesh_report *r = &m->report;
    size_t kept = 0, used = 0;
    TC_FUZZ_CHECK(r->n_tet == m->n_tet && m->n_tet > 0 && r->n_imaginary == 0 && r->reentry == TC_REENTRY_PEEL);
    TC_FUZZ_CHECK(r->dropped_degenerate + r->dropped_nonfinite + r->dropped_duplicate + m->n_tet == in->n_tet);
    for (size_t t = 0; t < in->n_tet; t++) {
        kept += m->tet_of_source[t] >= 0;
        TC_FUZZ_CHECK(m->tet_of_source[t] < (int32_t)m->n_tet);
    }
    for (size_t v = 0; v < in->n_vertex; v++) {
        int32_t w = m->vertex_of_source[v];
        TC_FUZZ_CHECK(w < (int32_t)m->n_vertex);
        used += w >= 0;
        for (size_t k = 0; w >= 0 && k < 3; k++)
            TC_FUZZ_CHECK(m->vertex[3 * (size_t)w + k] == in->vertex[3 * v + k]);
    }
    TC_FUZZ_CHECK(kept == m->n_tet && used >= m->n_vertex);
    TC_FUZZ_CHECK(r->n_component >= 1 && r->n_component <= m->n_tet && r->zero_volume <= m->n_tet);
    TC_FUZZ_CHECK(r->scalar_range[0] <= r->scalar_range[1] && isfinite(r->scalar_range[0]));
    for (int k = 0; k < 3; k++)
        TC_FUZZ_CHECK(r->bounds[2 * k] <= r->bounds[2 * k + 1]);
}

static void fill(arrays *a, tc_mesh_arrays *in, tc_fuzz_input *bytes, int flags)
{
    size_t n_scalar = in->association == TC_CELL_DATA ? in->n_tet : in->n_vertex;
    for (size_t i = 0; i < 3 * in->n_vertex; i++)
        a->vertex[i] = flags & PLAIN ? (double)(tc_fuzz_u8(bytes) % 4) : tc_fuzz_real(bytes);
    for (size_t i = 0; i < 4 * in->n_tet; i++) {
        uint8_t b = tc_fuzz_u8(bytes);
        a->tet[i] = in->n_vertex ? (int32_t)(b % in->n_vertex) : b;
        if (flags & WILD_IDS && b == 255)
            tc_fuzz_take(&a->tet[i], bytes, sizeof a->tet[i]);
    }
    for (size_t i = 0; i < n_scalar; i++)
        a->scalar[i] = tc_fuzz_real(bytes);
    for (size_t i = 0; i < n_scalar; i++)
        a->again[i] = tc_fuzz_real(bytes);
    in->vertex = a->vertex;
    in->tet = a->tet;
    in->scalar = flags & 1 ? a->scalar : NULL;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tc_fuzz_input bytes = {data, size};
    static arrays a;
    tc_mesh_arrays in = {.n_vertex = tc_fuzz_u8(&bytes) % (VERTICES + 1), .n_tet = tc_fuzz_u8(&bytes) % (TETS + 1)};
    int flags = tc_fuzz_u8(&bytes);
    tc_error err = {0};
    tc_mesh *m = NULL;
    tc_prepare_options options = {.reentry = TC_REENTRY_PEEL, .threads = 1};
    in.association = flags & 2 ? TC_CELL_DATA : TC_POINT_DATA;
    in.field_name = flags & 32 ? "field" : NULL;
    fill(&a, &in, &bytes, flags);
    if (tc_mesh_create(&m, &in, &err) != TC_OK) {
        TC_FUZZ_CHECK(!m && err.code == TC_E_MESH && err.text[0]);
        return 0;
    }
    tc_status status = tc_mesh_prepare(m, &options, NULL, &err);
    if (status == TC_OK) {
        check_links(m);
        check_report(m, &in);
        check_boundary(m);
    } else {
        TC_FUZZ_CHECK(status == TC_E_MESH && err.text[0]);
    }
    if (flags & SET_AGAIN) {
        status = tc_mesh_set_scalar(m, a.again, in.association, &err);
        TC_FUZZ_CHECK(status == TC_OK || (status == TC_E_MESH && err.text[0]));
        tc_mesh_report r;
        tc_mesh_get_report(&r, m);
        TC_FUZZ_CHECK(r.scalar_range[0] <= r.scalar_range[1]);
    }
    tc_mesh_destroy(&m);
    return 0;
}
