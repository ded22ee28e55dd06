/* table.c: all effects. Their sections stand in the programs in this order. */
#include "gpu/effects/effects.h"

const tc_effect *const tc_effect_table[] = {
    &tc_effect_density_emitter,
    &tc_effect_emission,
    &tc_effect_absorption,
    &tc_effect_xray,
    &tc_effect_maximum,
    &tc_effect_minimum,
    &tc_effect_average,
    &tc_effect_surfaces,
    &tc_effect_depth,
    &tc_effect_empty_space,
    &tc_effect_select, /* before what asks whether a cell is real */
    &tc_effect_clip,
    &tc_effect_light,
    &tc_effect_gradient,
    &tc_effect_shade, /* before what stands at the ends of parts */
    &tc_effect_iso,
    &tc_effect_color_field,
    &tc_effect_shade_iso, /* behind what colours them */
    &tc_effect_geometry,
    &tc_effect_geometry_before,
    NULL,
};
