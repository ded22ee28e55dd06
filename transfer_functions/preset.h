/* preset.h: a colour map with its opacity curve as ParaView stores it, before it becomes knots.
 *
 * The formats: a JSON array of objects (ParaView 4.2 and later) and <ColorMap> XML (before that). Read leniently:
 * trailing commas, comments, NaN, Infinity, a byte-order mark and broken UTF-8 in JSON are taken. */
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
    tc_color_point *color; /* [n_color], x non-decreasing; 0 only with a problem */
    size_t n_opacity;
    tc_opacity_point *opacity; /* [n_opacity], x non-decreasing; 0: the map has none */
    bool indexed;              /* made from IndexedColors: equal bands, one a colour */
    bool sorted;               /* the file's points were not in ascending order */
    bool has_nan_color;
    double nan_color[3];
    char *problem; /* why this map cannot be used; NULL: it can */
} tc_preset;

typedef struct tc_preset_list {
    size_t n;
    tc_preset **preset;
} tc_preset_list;

/* An empty preset of that name with room for so many points (zeroed, midpoint 0.5), or NULL when memory is out. */
tc_preset *tc_preset_create(const char *name, size_t n_color, size_t n_opacity);
void tc_preset_destroy(tc_preset **preset);
/* Sorts points stably by x. */
void tc_preset_sort(tc_preset *preset);

/* All maps of a file (at most 64 MiB). A map that cannot be used is in the list with its problem.
 * Errors: TC_E_FILE (unreadable, neither JSON nor XML, no map in it), TC_E_MEMORY. */
tc_status tc_preset_read(tc_preset_list *out, const char *path, tc_error *err);
/* The same from text; `path` is only named in errors. */
tc_status tc_preset_parse(tc_preset_list *out, const char *text, size_t length, const char *path, tc_error *err);
void tc_preset_list_finish(tc_preset_list *list);

/* The map of that name (NULL: the first), borrowed. Errors: TC_E_ARG naming the nearest names, TC_E_FILE for a map with
 * a problem. */
tc_status tc_preset_choose(const tc_preset **out, const tc_preset_list *list, const char *name, const char *path,
                           tc_error *err);

/* Equal but for letter case, spaces, '-', '_' and "(matplotlib)". */
bool tc_preset_name_equal(const char *a, const char *b);
/* The (up to) three of `name` [n] nearest to `wanted` as "\"A\", \"B\"". */
void tc_preset_nearest(char *out, size_t capacity, const char *const *name, size_t n, const char *wanted);

/* As JSON, an array of this one map, from malloc; NULL: memory ran out. */
char *tc_preset_text(const tc_preset *preset);
/* Writes one map: .xml by extension (any case), JSON otherwise. XML keeps opacity only where a colour point is.
 * Whole or not at all. Errors: TC_E_FILE, TC_E_MEMORY. */
tc_status tc_preset_write(const tc_preset *preset, const char *path, tc_error *err);

#endif
