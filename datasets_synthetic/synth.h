/* synth.h: synthetic datasets whose shapes and fields are known in closed form.
 *
 * A generator fills a soup of vertices and tets; synth.c samples its field at the vertices and makes a tc_mesh of it.
 * What its mesh keeps to for every size and seed, and what is wrong with it on purpose, stands in its row. The names
 * are in names.h. */
#ifndef TC_DATASETS_SYNTHETIC_SYNTH_H
#define TC_DATASETS_SYNTHETIC_SYNTH_H

#include "core/status.h"
#include "names.h"

/* Vertices and tets on their way into a tc_mesh; free with tc_synth_soup_finish. */
typedef struct tc_synth_soup {
    size_t n_vertex, n_tet;
    double *vertex; /* [n_vertex][3], owned */
    int32_t *tet;   /* [n_tet][4], owned */
    double *scalar; /* values of its own, owned: [n_vertex] or [n_tet] by association; NULL: the generator's field */
    tc_association association;
} tc_synth_soup;

/* What a mesh keeps to, as the soup has it, for every size and seed. */
enum {
    TC_SYNTH_POSITIVE = 1,   /* every tet is positive (dot(cross(b-a, c-a), d-a) > 0), exactly */
    TC_SYNTH_SHAPELY = 2,    /* has six volumes of at least 5e-6 of its longest edge cubed; no gap is thinner than
                                 1e-4 of an edge */
    TC_SYNTH_CONFORMING = 4, /* a face belongs to one tet or to two, one on each side; others meet in no more than an
                                edge; vertices of their own are not told apart from shared ones */
    TC_SYNTH_CONVEX = 8,     /* the tets fill their convex hull, up to rounding (tc_mesh_report.convex) */
    TC_SYNTH_SIZED = 16,     /* n_cells from the default on is met within 15 % */
    TC_SYNTH_SEEDED = 32,    /* another seed moves vertices */
    TC_SYNTH_SOUND = 63 - 8  /* all but convex */
};

/* What is wrong with a mesh on purpose: the first group is what tc_mesh_prepare counts, by the report's names, from
 * 300 cells on. A row has no other defects than its own. */
enum {
    TC_SYNTH_DEGENERATE = 1,          /* dropped_degenerate */
    TC_SYNTH_NONFINITE_POINTS = 2,    /* dropped_nonfinite */
    TC_SYNTH_DUPLICATE_CELLS = 4,     /* dropped_duplicate */
    TC_SYNTH_INVERTED = 8,            /* reoriented */
    TC_SYNTH_FLAT = 16,               /* zero_volume */
    TC_SYNTH_DUPLICATE_POINTS = 32,   /* merged_vertices */
    TC_SYNTH_UNUSED_POINTS = 64,      /* unused_vertices */
    TC_SYNTH_SHARED_FACES = 128,      /* unlinked_faces */
    TC_SYNTH_NONFINITE_VALUES = 256,  /* nonfinite_scalars */
    TC_SYNTH_CONSTANT = 512,          /* all values are one */
    TC_SYNTH_NO_FIELD = 1024,         /* field and scalar are NULL */
    TC_SYNTH_NO_CELLS = 2048,         /* no tets */
    TC_SYNTH_BAD_INDEX = 4096,        /* a tet names a vertex that is not there: tc_mesh_create refuses it */
    TC_SYNTH_TOUCHING_FACES = 8192,   /* faces lie on each other that do not have the same vertices */
    TC_SYNTH_OVERLAPPING = 16384,     /* tets overlap */
    TC_SYNTH_ROUNDS_INVERTED = 32768, /* tets that are not inverted become so when vertices are rounded to float */
};

typedef struct tc_synth_generator {
    size_t default_cells;
    /* About n_cells tets into *out (zeroed by the caller, who frees it also after an error). n_cells is 1..2e9, seed
     * moves vertices and never the shape. Errors: TC_E_MEMORY; TC_E_ARG when 32-bit ids are too few. */
    tc_status (*build)(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err);
    /* The analytic field at point [3]; also what the mesh carries as point data unless the soup has values of its own.
     * NULL: there is none. */
    double (*field)(const double *point);
    /* Length of the whole line origin [3] + t direction [3] (unit length, t of either sign) within the very polyhedron
     * that build makes for n_cells: exact, not the smooth shape that a ball or a cylinder approximates. What two tets
     * cover counts twice, but a duplicate cell once. NAN when memory runs out. NULL: not known. A line that lies in a
     * face of the boundary is on no particular side. */
    double (*chord)(const double *origin, const double *direction, size_t n_cells);
    unsigned promises; /* TC_SYNTH_POSITIVE … */
    unsigned defects;  /* TC_SYNTH_DEGENERATE … */
} tc_synth_generator;

/* The generator of that name, or NULL. The name is one of tc_synth_list's. */
const tc_synth_generator *tc_synth_find(const char *name);

void tc_synth_soup_finish(tc_synth_soup *soup);
/* Room for the given counts; checks that ids fit in 32 bits. Errors: TC_E_ARG, TC_E_MEMORY. */
tc_status tc_synth_soup_reserve(tc_synth_soup *soup, size_t n_vertex, size_t n_tet, tc_error *err);

/* A number in [-1, 1) that depends on its arguments alone (splitmix64 of Steele, Lea and Flood 2014). */
double tc_synth_noise(uint64_t seed, uint64_t index);

/* The step h in (0, h_max] whose count(context, h) is nearest to n_cells; count must not grow with h. */
double tc_synth_fit(double (*count)(const void *context, double h), const void *context, size_t n_cells, double h_max);

#define ROW(id, name, what, field) extern const tc_synth_generator tc_synth_##id;
TC_SYNTH_ROWS(ROW)
#undef ROW

#endif
