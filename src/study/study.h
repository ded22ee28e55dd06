/* study.h: what the files of this room share. The functions for others are in tetcast.h. */
#ifndef TC_STUDY_STUDY_H
#define TC_STUDY_STUDY_H

#include "study/rows.h"
#include "study/settings.h"

enum { TC_STUDY_PLOTS = 64, TC_ROTATION_FRAMES = 36, TC_FRAGMENT_CURVES = 3 };

/* One frame of a full turn. */
typedef struct tc_turn {
    char scene[64], function[32];
    double angle, ms;
    int64_t steps;
} tc_turn;

/* Fragments of each pass under one rule. */
typedef struct tc_curve {
    char scene[64], function[32], rule[16]; /* "all", "locked", "stopped" */
    size_t n;
    int64_t *fragments; /* [n], owned */
} tc_curve;

struct tc_study {
    tc_study_options options; /* its texts are the study's */
    const tc_log *log;
    tc_log quiet; /* log without progress: for what a step of the study does inside */
    bool on[TC_STUDY_SETTINGS];
    char *folder, *knobs, *request, *gl;

    size_t n_row, room_row;
    tc_study_row *row;
    size_t n_turn, room_turn;
    tc_turn *turn;
    size_t n_curve, room_curve;
    tc_curve *curve;

    tc_renderer *renderer, *reference; /* made when first needed */
    int done;                          /* pairs of mesh and function given so far */
    size_t n_plot;
    char plot[TC_STUDY_PLOTS][128]; /* names of scripts */
};

/* A pair of mesh and function, being measured. */
typedef struct tc_study_pair {
    char scene[64], function[32];
    tc_mesh *mesh;
    const tc_transfer *tf;
} tc_study_pair;

/* Path of a file in the folder. Errors: TC_E_MEMORY. */
tc_status tc_study_path(char **out, const tc_study *study, const char *name, tc_error *err);
/* Keeps a row and writes it; asks the caller whether to go on. Errors: TC_E_CANCEL, TC_E_FILE, TC_E_MEMORY. */
tc_status tc_study_keep(tc_study *study, const tc_study_row *row, tc_error *err);
/* The same for what belongs to the paper's figures. curve's array passes to the study. */
tc_status tc_study_keep_turn(tc_study *study, const tc_turn *turn, tc_error *err);
tc_status tc_study_keep_curve(tc_study *study, tc_curve *curve, tc_error *err);
/* Room for one more at the end of an array of *n things of that size. Errors: TC_E_MEMORY. */
tc_status tc_study_grow(void **array, size_t *room, size_t n, size_t size, tc_error *err);
bool tc_study_has_row(const tc_study *study, const char *scene, const char *function, int view, size_t setting);

/* Azimuth and elevation in degrees of view i: oblique ones and ones next to an axis, the first eight from a list, then
 * evenly over the sphere. */
void tc_study_view(double *azimuth, double *elevation, int i);
/* The whole mesh in view from there. */
void tc_study_camera(tc_camera *out, const tc_mesh *mesh, const tc_study_options *options, double azimuth,
                     double elevation);
/* Options of a render before any setting. */
void tc_study_base(tc_render_options *out, const tc_study_options *options);

/* Measures what is missing of one view. Errors: of tc_study_scene. */
tc_status tc_study_measure(tc_study *study, const tc_study_pair *pair, int view, tc_error *err);
/* Measures what is missing of the paper's figures 7 and 8. */
tc_status tc_study_figures(tc_study *study, const tc_study_pair *pair, tc_error *err);
bool tc_study_has_figures(const tc_study *study, const char *scene, const char *function);
/* The study's renderer. Errors: TC_E_GL, TC_E_MEMORY. */
tc_status tc_study_renderer(tc_renderer **out, tc_study *study, bool reference, tc_error *err);

/* Writes the data and scripts of all plots. Errors: TC_E_FILE, TC_E_MEMORY. */
struct tc_summary;
tc_status tc_study_plots(tc_study *study, const struct tc_summary *summary, tc_error *err);

#endif
