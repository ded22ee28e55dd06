/* export.h: cases for other programs: mesh, camera, function and pictures as files (tests/hard/peers.py). */
#ifndef TC_TESTS_HARD_EXPORT_H
#define TC_TESTS_HARD_EXPORT_H

#include "catalogue.h"

/* Writes one case of mesh number index, if there is one that other programs can be asked for and its name holds filter
 * (NULL: any): DIR/NAME.vtu, NAME.json (name, size, camera, knots, unit_distance,
 * eye_inside, ill_posed: how many of our pixels), NAME.reference.rgba and
 * NAME.tetcast.rgba (float32 [height][width][4], premultiplied, row 0 at the top). dir must exist. Errors: TC_E_FILE,
 * TC_E_MEMORY, as tc_render. */
tc_status hard_export_mesh(const char *dir, size_t index, const char *filter, tc_renderer *renderer, tc_error *err);

#endif
