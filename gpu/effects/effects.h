/* effects.h: the rows of tc_effect_table, each in the file of its name; those that differ in a value share one. */
#ifndef TC_GPU_EFFECTS_H
#define TC_GPU_EFFECTS_H

#include "gpu/effect.h"

extern const tc_effect tc_effect_density_emitter, tc_effect_emission, tc_effect_absorption, tc_effect_xray;
extern const tc_effect tc_effect_maximum, tc_effect_minimum, tc_effect_average, tc_effect_surfaces;
extern const tc_effect tc_effect_depth;
extern const tc_effect tc_effect_empty_space, tc_effect_select, tc_effect_clip, tc_effect_iso, tc_effect_color_field;
extern const tc_effect tc_effect_light, tc_effect_gradient, tc_effect_shade, tc_effect_shade_iso;
extern const tc_effect tc_effect_geometry, tc_effect_geometry_before;

#endif
