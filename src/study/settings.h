/* settings.h: the knobs of a study as a constant table of named settings. */
#ifndef TC_STUDY_SETTINGS_H
#define TC_STUDY_SETTINGS_H

#include "core/status.h"

/* What a setting changes; 0 leaves what the study was asked for. */
typedef struct tc_study_change {
    tc_integrator integrator;
    int order;
    double split;
    int table_size[3];
    tc_table_format format;
    double stop;
    int steps_per_pass, z_update_every;
    tc_state_format state;
    int samples;
    tc_stepper stepper;
    tc_reentry reentry;
    bool reference; /* the driver "reference" */
    int figure;     /* no setting of a render: TC_FIGURE_… */
} tc_study_change;

enum { TC_FIGURE_ROTATION = 1, TC_FIGURE_FRAGMENTS = 2 };
enum { TC_STUDY_SETTINGS = 54 };

extern const tc_study_change tc_study_changes[TC_STUDY_SETTINGS]; /* by the index of tc_study_settings */

/* options with the change of setting k; reentry and driver are not among them. */
void tc_study_apply(tc_render_options *options, size_t k);
/* Index of a setting by its name, -1: there is none. */
int tc_study_find(const char *name);
/* Which settings a list of knobs and settings asks for; NULL: all. Errors: TC_E_ARG naming the word and the knobs. */
tc_status tc_study_select(bool on[TC_STUDY_SETTINGS], const char *list, tc_error *err);

#endif
