/* relations.h: pictures that must be the same: of variants of a mesh, along reversed rays, on another context. */
#ifndef TC_TESTS_HARD_RELATIONS_H
#define TC_TESTS_HARD_RELATIONS_H

#include "invariants.h"

/* Relations of a mesh: its variants (hard_kind, from HARD_PERMUTED on: invariants 4, 5 and 7), then these. */
enum { HARD_REVERSED = HARD_KINDS, HARD_OTHER_CONTEXT, HARD_RELATIONS };

const char *hard_relation_name(int relation);
/* Relations that mean something for this mesh (refining a cell with a bad corner makes other cells bad). */
bool hard_relation_fits(int relation, const hard_mesh *mesh);

/* Renders and judges the mesh and its relative, and compares them: r gets the relative's judgement. relative: of
 * hard_mesh_vary, or NULL where the relation is not a variant. */
void hard_judge_relation(hard_result *r, const hard_bench *bench, int relation, const hard_mesh *mesh,
                         const hard_mesh *relative, const hard_view *view, const hard_function *function);

#endif
