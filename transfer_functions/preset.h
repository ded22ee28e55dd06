/* preset.h: a colour map with its opacity curve as ParaView stores it, before it becomes knots.
 *
 * The formats: a JSON array of objects (ParaView 4.2 and later) and <ColorMap> XML (before that). */
#ifndef TC_TRANSFER_FUNCTIONS_PRESET_H
#define TC_TRANSFER_FUNCTIONS_PRESET_H

#include "core/status.h"

/* ParaView's names: "RGB", "HSV", "Lab" (or "CIELAB"), "Diverging", "Lab/CIEDE2000", "Step". */
typedef enum tc_color_space {
    TC_SPACE_RGB = 0,
    TC_SPACE_HSV,
    TC_SPACE_LAB,
    TC_SPACE_DIVERGING,
    TC_SPACE_CIEDE2000,
    TC_SPACE_STEP
} tc_color_space;

typedef struct tc_color_point {
    double x, rgb[3], midpoint, sharpness;
} tc_color_point;

typedef struct tc_opacity_point {
    double x, a, midpoint, sharpness;
} tc_opacity_point;

typedef struct tc_preset {
    char *name;
    tc_color_space space;
    bool hsv_wrap; /* hue takes the short way over red; ParaView's presets: false */
    size_t n_color;
    tc_color_point *color; /* [n_color], x non-decreasing, n_color >= 1 */
    size_t n_opacity;
    tc_opacity_point *opacity; /* [n_opacity], x non-decreasing; 0: the map has none */
    bool indexed;              /* colours of categories: point i spans [i, i+1] in steps */
    bool sorted;               /* points came unordered and were sorted */
    bool has_nan_color;
    double nan_color[3];
} tc_preset;

void tc_preset_destroy(tc_preset **preset);

#endif
