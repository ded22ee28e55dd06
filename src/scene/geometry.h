/* geometry.h: triangles and lines in a picture: what may be wrong with them. Making them is in tetcast_look.h. */
#ifndef TC_SCENE_GEOMETRY_H
#define TC_SCENE_GEOMETRY_H

#include "core/status.h"

/* Why a geometry cannot be drawn: NULL, or a sentence in why [capacity] that names what is wrong and the remedy. Vertex
 * ids must be in their range and vertices finite, colours and opacity in 0 … 1, the width of lines above 0. Cost:
 * O(vertices + triangles + lines). */
const char *tc_geometry_wrong(char *why, size_t capacity, const tc_geometry *geometry);

#endif
