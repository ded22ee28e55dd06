/* shade.h: light on a colour; inside the room. */
#ifndef TC_REFERENCE_SHADE_H
#define TC_REFERENCE_SHADE_H

#include "core/status.h"

/* What light makes of a colour c, channel by channel: gain c + glow. */
typedef struct tc_lit {
    double gain[3], glow[3];
} tc_lit;

/* The colour as it is. */
tc_lit tc_lit_none(void);
/* weight of a and 1 - weight of b. */
tc_lit tc_lit_mix(const tc_lit *a, const tc_lit *b, double weight);
void tc_lit_color(double out[3], const tc_lit *lit, const double color[3]);

/* tc_shade's formula.
 *   normal [3] of any length above 0; eye [3] unit, against the ray; one_sided: the normal is not turned */
tc_lit tc_lit_by(const tc_shade *shade, const double normal[3], const double eye[3], bool one_sided);

#endif
