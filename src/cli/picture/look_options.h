/* look_options.h: the options of `render` that say what a picture shows beside the plain volume (tetcast_look.h). */
#ifndef TC_CLI_LOOK_OPTIONS_H
#define TC_CLI_LOOK_OPTIONS_H

#include "cli/options.h"

enum { TC_LOOK_MANY = 64, TC_LIGHTS_MANY = 16 };

/* A part of an option's value, borrowed from it. */
typedef struct tc_part {
    const char *at;
    size_t length;
} tc_part;

/* Cells whose values of an array lie in [lo, hi]. */
typedef struct tc_range_choice {
    tc_part name; /* of the array, or of a block; at NULL: blocks by their numbers */
    double lo, hi;
} tc_range_choice;

typedef struct tc_geometry_choice {
    tc_part file;
    double opacity;
} tc_geometry_choice;

typedef struct tc_color_list {
    int n;
    double rgb[TC_LOOK_MANY][3];
} tc_color_list;

typedef struct tc_look_options {
    int model; /* tc_model */
    struct {
        int n;
        double value[TC_LOOK_MANY];
    } iso, iso_opacity;
    tc_color_list iso_color;
    tc_shade shade; /* its lights are light */
    int gradient;   /* tc_gradient */
    struct {
        int n;
        tc_light light[TC_LIGHTS_MANY];
    } light;
    const char *color_field, *categories;
    double color_range[2];
    bool has_color_range;
    struct {
        int n;
        tc_plane plane[TC_LOOK_MANY];
    } clip;
    double clip_box[6];
    bool has_clip_box;
    struct {
        int n;
        tc_range_choice range[TC_LOOK_MANY];
    } select, blocks;
    bool outline, wireframe, has_surface;
    double surface; /* opacity */
    double line_color[3], surface_color[3];
    bool has_line_color, has_surface_color;
    struct {
        int n;
        tc_geometry_choice file[TC_LOOK_MANY];
    } geometry;
    tc_color_list geometry_color;
    const char *title;
    bool color_bar, bar_opacity, axes, triad;
    int bar_place; /* tc_bar; NONE: its default */
    double text_size;
} tc_look_options;

enum { TC_N_LOOK_OPTION = 38 };
extern const tc_option tc_look_option[TC_N_LOOK_OPTION];

void tc_look_options_defaults(tc_look_options *out);
/* What no mesh is needed for: lists that belong together, coefficients without light. given: all that was given. -1 to
 * go on, else the exit code. */
int tc_look_options_check(const tc_look_options *options, const tc_given_list *given, tc_talk *talk);
/* Is the part this text? */
bool tc_part_is(const tc_part *part, const char *text);
/* A copy of the part; NULL: memory ran out. */
char *tc_part_text(const tc_part *part);

/* The name of a tc_model on the command line. */
const char *tc_model_name(int model);

#endif
