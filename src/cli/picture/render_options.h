/* render_options.h: the command line of `render`, read and checked. */
#ifndef TC_CLI_RENDER_OPTIONS_H
#define TC_CLI_RENDER_OPTIONS_H

#include "cli/input.h"
#include "cli/picture/look_options.h"
#include "cli/picture/output_options.h"
#include "cli/scene/scene_file.h"
#include "cli/picture/step_names.h"

typedef struct tc_size {
    int width, height;
} tc_size;

typedef struct tc_background {
    bool there;
    float rgba[4]; /* premultiplied */
} tc_background;

typedef struct tc_nan_color {
    bool there;
    double rgba[4]; /* r, g, b, attenuation per unit distance */
} tc_nan_color;

typedef struct tc_render_command {
    const char *input, *output;
    const char *scene_path; /* the scene file or picture that was given for INPUT; NULL: a mesh was */
    tc_scene scene;         /* from it; texts below point into it */
    const char *paraview;   /* a ParaView state or camera file; NULL: none */
    tc_scene state;         /* from one that lies under the scene; texts below point into it, too */
    tc_given_list given;    /* by the scene and, over it, by the command line */
    char default_output[512];
    tc_input_options source;
    tc_step_range steps; /* --step FROM:TO; source has the first of them then, if it was given */
    tc_size size;
    tc_background background;
    tc_output_options out;

    double position[3], focal_point[3], view_up[3], view_angle, parallel_scale;
    bool has_position, has_focal_point, has_view_up, has_parallel_scale, parallel;
    double azimuth, elevation, roll, zoom;
    double clipping_range[2];
    bool has_clipping_range;
    double window_center[2];

    const char *color_map, *preset, *opacity;
    double range[2];
    bool has_range, log;
    double unit_distance;
    tc_nan_color nan_color;
    tc_look_options look;
    bool explain_json, explain_measure; /* of `explain`, which has all options of render */

    int integrator; /* tc_integrator */
    int table_size[3];
    int table_format; /* tc_table_format */
    int integral_order;    /* 0: auto */
    double integral_split; /* 0: auto */
    double opacity_stop;   /* 0: auto */
    int samples;           /* as of tc_render_options */
    int state_format;      /* tc_state_format */

    const char *gl, *driver;
    int gl_choice, driver_choice;
    int stepper; /* tc_stepper */
    int steps_per_pass, z_update_every;

    uint64_t verify;
    bool has_verify;
    const char *error_image; /* NULL: none; else has_verify */
    int repeat;
    bool has_repeat, count, audit;
    const char *stats;
    uint64_t seed;

    size_t keep_bytes; /* as of tc_renderer_options, and at once; of a batch, where each view comes often */
    double error, frame_time; /* 0: not asked for */
    bool no_cache;
} tc_render_command;

/* Was an error or a frame time asked for? */
bool tc_choice_asked(const tc_render_command *options);

/* The options of everything that makes a picture: with tc_look_option behind them they are those of a command whose struct
 * is a tc_render_command, as tc_command_render is. */
enum { TC_N_RENDER_OPTION = 73 };
extern const tc_option tc_render_option[TC_N_RENDER_OPTION];

/* Defaults, parsing, the scene file where INPUT is one, checks that need no mesh. -1 to go on, else the exit code. Whatever
 * it is, tc_render_command_finish frees what the struct holds. */
int tc_render_command_read(tc_render_command *out, tc_talk *talk, const tc_command *command, int argc, char **argv);
/* The same for a command that writes no picture: output, error_image and stats are not looked at. */
int tc_picture_command_read(tc_render_command *out, tc_talk *talk, const tc_command *command, int argc, char **argv);
/* A scene that stands in memory, of the file that is INPUT; text is the whole file's. */
typedef struct tc_scene_at {
    json_t *json;
    int element; /* of the text's list of transfer functions; -1: it has none */
    const char *text, *folder;
    bool again; /* what is to be said of it was said before */
} tc_scene_at;
/* The same for a scene that is not read from its file; at NULL: it is. */
int tc_picture_command_take(tc_render_command *out, const tc_scene_at *at, tc_talk *talk, const tc_command *command,
                            int argc, char **argv);
void tc_render_command_finish(tc_render_command *command);

/* Do both names lead to one file, there or to be written? */
bool tc_same_file(const char *a, const char *b);

/* Does the name end in a picture's extension? -1, or the exit code of an error that was printed. */
int tc_output_kind_check(const char *path, tc_talk *talk);

/* --size WxH: a custom option whose field is a tc_size. */
bool tc_size_parse(void *field, const char *text, char *why);

/* Runs the command; in cmd_render.c, while the table of its options is in render_options.c. */
int tc_render_run_command(tc_talk *talk, const tc_command *command, int argc, char **argv);

#endif
