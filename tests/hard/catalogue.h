/* catalogue.h: which meshes, views and functions are put together. */
#ifndef TC_TESTS_HARD_CATALOGUE_H
#define TC_TESTS_HARD_CATALOGUE_H

#include "relations.h"

/* One case: a view and a function of one mesh; relation 0: by itself, else HARD_PERMUTED … */
typedef struct hard_case {
    size_t view, function;
    int relation;
    tc_integrator integrator;
} hard_case;

enum { HARD_CASES_MOST = 256 };

/* The meshes: every name of tc_synth_list, and in a long run one of ten million cells. Names are static. */
const char *hard_catalogue_mesh(size_t index);
size_t hard_catalogue_meshes(bool long_run);
/* Cells to ask that mesh for. */
size_t hard_catalogue_cells(size_t index, bool long_run);

/* The cases of mesh number index: out [HARD_CASES_MOST]; gives their number. A short run takes a few of each mesh so
 * that every view, function and relation has its turn on several meshes; a long one every view and every function with
 * every mesh. */
size_t hard_catalogue_cases(hard_case *out, size_t index, bool long_run, bool gpu);

/* "mesh; view; function[; relation][; table]" */
void hard_case_name(char *out, size_t capacity, size_t index, const hard_case *c);

#endif
