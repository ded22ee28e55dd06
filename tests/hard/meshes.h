/* meshes.h: one mesh of the catalogue: as it was made, prepared, and with its judges. */
#ifndef TC_TESTS_HARD_MESHES_H
#define TC_TESTS_HARD_MESHES_H

#include "datasets_synthetic/synth.h"
#include "judge.h"
#include "reference/reference.h"
#include "tests/common/variants.h"

typedef enum hard_kind {
    HARD_PLAIN = 0,
    HARD_PERMUTED,
    HARD_REFINED4,
    HARD_REFINED8,
    HARD_TURNED,     /* about an axis that is none of the grid's */
    HARD_SMALL,      /* 1e-20 times */
    HARD_LARGE,      /* 1e20 times */
    HARD_OFFSET,     /* 1e7 diagonals away along every axis */
    HARD_OTHER_GAPS, /* peeled where the plain one is convexified */
    HARD_KINDS
} hard_kind;

/* "permuted", … */
extern const char *const hard_kind_name[HARD_KINDS];

typedef struct hard_mesh {
    char name[64];
    const tc_synth_generator *generator; /* of the name before the variant's */
    size_t n_cells;                      /* that were asked for */
    hard_kind kind;
    mesh_variant source; /* the arrays; empty where even they were refused */
    tc_mesh *mesh;       /* prepared; NULL: refused */
    tc_error refused;    /* why */
    tc_mesh_report report;
    hard_judge *judge;
    tc_reference *reference;
    double diagonal;                  /* of the bounds of finite vertices; above 0 */
    double unit;                      /* unit distance of the pictures: a variant has its base's, moved along */
    double turn[9], scale, offset[3]; /* from the base to this */
} hard_mesh;

/* Makes, prepares and gives judges. A mesh that the library refuses is no error: mesh is NULL and refused says why.
 * Errors: TC_E_MEMORY; TC_E_ARG where there is no such generator. hard_mesh_close frees what there is in any case. */
tc_status hard_mesh_open(hard_mesh *out, const char *name, size_t n_cells, uint64_t seed, tc_error *err);
/* A variant of a plain mesh that was not refused. HARD_OTHER_GAPS may have no mesh: there is but one way. */
tc_status hard_mesh_vary(hard_mesh *out, const hard_mesh *base, hard_kind kind, tc_error *err);
void hard_mesh_close(hard_mesh *m);

/* The base's camera, moved along. */
tc_camera hard_mesh_camera(const hard_mesh *m, const tc_camera *base);
/* What was repaired or refused, in a few words; "" if nothing. */
void hard_mesh_treatment(char *out, size_t capacity, const hard_mesh *m);
/* Defects that the generator promises and the report does not show, in words; "" if none is missing. */
void hard_mesh_missing(char *out, size_t capacity, const hard_mesh *m);

#endif
