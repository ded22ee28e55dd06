/* functions.h: the transfer functions of the catalogue, laid over a mesh's scalars. */
#ifndef TC_TESTS_HARD_FUNCTIONS_H
#define TC_TESTS_HARD_FUNCTIONS_H

#include "meshes.h"

typedef struct hard_function {
    const char *name;
    tc_transfer *tf;  /* NULL: refused, as it must be */
    tc_error refused; /* why */
    double kappa;     /* constant extinction per unit distance; negative: not constant */
} hard_function;

size_t hard_function_count(void);
const char *hard_function_name(size_t index);
/* Function number index over the mesh's scalars. Where cells overlap by design colours have no order in depth, so all
 * knots get one colour: what is seen then depends on no order. Errors: TC_E_ARG when one is refused that must not be,
 * or one is taken that must be refused. hard_function_close frees what there is in any case. */
tc_status hard_function_make(hard_function *out, size_t index, const hard_mesh *mesh, tc_error *err);
void hard_function_close(hard_function *f);

#endif
