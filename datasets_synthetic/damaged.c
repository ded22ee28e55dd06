/* damaged.c: a unit cube whose lists of cells and points are not in order: cells turned inside out, cells twice, cells
 * that repeat a vertex, points of no cell, an index out of range, no cells at all. */
#include "box.h"
#include "chord.h"
#include "soup.h"

static void swap(int32_t *v, int i, int j)
{
    int32_t id = v[i];
    v[i] = v[j], v[j] = id;
}

static void invert(tc_synth_soup *s, size_t every)
{
    for (size_t t = 0; t < s->n_tet; t += every)
        swap(s->tet + 4 * t, (int)(t % 3), 3);
}

/* Every seventh cell once more, its vertices in another order. */
static tc_status repeat_cells(tc_synth_soup *s, tc_error *err)
{
    tc_builder b = {.soup = s};
    size_t n = s->n_tet;
    for (size_t t = 0; t < n; t += 7) {
        int32_t v[4] = {s->tet[4 * t + 1], s->tet[4 * t + 2], s->tet[4 * t], s->tet[4 * t + 3]};
        tc_builder_tet(&b, v[0], v[1], v[2], v[3]);
    }
    return tc_builder_done(&b, err);
}

/* After every fifth cell one that has shrunk to a face, an edge or a vertex of it. */
static tc_status repeat_vertices(tc_synth_soup *s, tc_error *err)
{
    tc_builder b = {.soup = s};
    size_t n = s->n_tet;
    for (size_t t = 0; t < n; t += 5) {
        int32_t v[4] = {s->tet[4 * t], s->tet[4 * t + 1], s->tet[4 * t + 2], s->tet[4 * t + 3]};
        switch (t / 5 % 4) {
        case 0:
            tc_builder_tet(&b, v[0], v[1], v[2], v[0]);
            break;
        case 1:
            tc_builder_tet(&b, v[3], v[1], v[1], v[2]);
            break;
        case 2:
            tc_builder_tet(&b, v[0], v[1], v[0], v[1]);
            break;
        default:
            tc_builder_tet(&b, v[2], v[2], v[2], v[2]);
        }
    }
    return tc_builder_done(&b, err);
}

/* Points far away, between the ones in use and at the end. */
static tc_status strew_points(tc_synth_soup *s, tc_error *err)
{
    tc_synth_soup old = *s;
    *s = (tc_synth_soup){0};
    tc_builder b = {.soup = s};
    for (size_t v = 0; v < old.n_vertex; v++) {
        if (v % 4 == 0)
            tc_builder_vertex(&b, 1e6 + (double)v, -1e6, 1e6);
        tc_builder_vertex(&b, old.vertex[3 * v], old.vertex[3 * v + 1], old.vertex[3 * v + 2]);
    }
    tc_builder_vertex(&b, -1e6, 0, 0);
    for (size_t t = 0; t < old.n_tet; t++) {
        int32_t v[4];
        for (size_t i = 0; i < 4; i++)
            v[i] = old.tet[4 * t + i] + old.tet[4 * t + i] / 4 + 1;
        tc_builder_tet(&b, v[0], v[1], v[2], v[3]);
    }
    tc_synth_soup_finish(&old);
    return tc_builder_done(&b, err);
}

static tc_status invert_some(tc_synth_soup *s, tc_error *err)
{
    (void)err;
    invert(s, 3);
    return TC_OK;
}

static tc_status invert_all(tc_synth_soup *s, tc_error *err)
{
    (void)err;
    invert(s, 1);
    return TC_OK;
}

static tc_status break_index(tc_synth_soup *s, tc_error *err)
{
    (void)err;
    s->tet[4 * (s->n_tet / 2) + 2] = (int32_t)s->n_vertex;
    return TC_OK;
}

static tc_status take_cells(tc_synth_soup *s, tc_error *err)
{
    (void)err;
    s->n_tet = 0;
    return TC_OK;
}

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed,
                       tc_status (*damage)(tc_synth_soup *soup, tc_error *err), tc_error *err)
{
    tc_box box = tc_box_unit(n_cells, 1, seed);
    tc_status status = tc_box_build(out, &box, err);
    return status ? status : damage(out, err);
}

enum {
    sound = TC_SYNTH_SOUND | TC_SYNTH_CONVEX,
    turned = sound & ~TC_SYNTH_POSITIVE & ~TC_SYNTH_SHAPELY & ~TC_SYNTH_CONFORMING,
    extra = turned & ~TC_SYNTH_SIZED
};

#define DAMAGED(id, damage, chord, promises, defects)                                                                  \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        return build(out, n_cells, seed, damage, err);                                                                 \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {6000, build_##id, tc_field_linear, chord, promises, defects};

DAMAGED(inverted_some, invert_some, tc_chord_unit_cube, turned, TC_SYNTH_INVERTED)
DAMAGED(inverted_all, invert_all, tc_chord_unit_cube, turned, TC_SYNTH_INVERTED)
DAMAGED(duplicate_cells, repeat_cells, tc_chord_unit_cube, extra, TC_SYNTH_DUPLICATE_CELLS)
DAMAGED(repeated_vertex, repeat_vertices, tc_chord_unit_cube, extra, TC_SYNTH_DEGENERATE)
DAMAGED(unused_points, strew_points, tc_chord_unit_cube, sound, TC_SYNTH_UNUSED_POINTS)
DAMAGED(bad_index, break_index, NULL, 0, TC_SYNTH_BAD_INDEX)
DAMAGED(no_cells, take_cells, NULL, 0, TC_SYNTH_NO_CELLS)
