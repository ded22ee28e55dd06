/* settings.c: the settings of a study: a name, what it is, and what it changes. A new one is a row in both tables. */
#include "study/settings.h"

#include <stdio.h>
#include <string.h>

/* clang-format off */
static const tc_study_setting settings[TC_STUDY_SETTINGS] = {
    {"default", "default", "as render does without options"},
    {"integrator", "table8", "table of 8 bits, 128x128x256: the 2003 paper"},
    {"integrator", "table16f", "table of half floats, 128x128x256"},
    {"integrator", "table32f", "table of floats, 128x128x256"},
    {"integrator", "integral1", "running integrals, one colour a segment"},
    {"integrator", "integral2", "running integrals, with the drift of colour"},
    {"integrator", "exact", "piece by piece of the function"},
    {"split", "split-0.05", "running integrals of second order, cut to an optical depth of 0.05"},
    {"split", "split-0.1", "running integrals of second order, cut to an optical depth of 0.1"},
    {"split", "split-0.25", "running integrals of second order, cut to an optical depth of 0.25"},
    {"split", "split-0.5", "running integrals of second order, cut to an optical depth of 0.5"},
    {"split", "split-1", "running integrals of second order, cut to an optical depth of 1"},
    {"table", "table8-32x32", "table of 8 bits, 32x32x32"},
    {"table", "table8-64x64", "table of 8 bits, 64x64x64"},
    {"table", "table8-128x64", "table of 8 bits, 128x128x64"},
    {"table", "table8-128x128", "table of 8 bits, 128x128x128"},
    {"table", "table8-128x256", "table of 8 bits, 128x128x256: the 2003 paper"},
    {"table", "table8-256x128", "table of 8 bits, 256x256x128"},
    {"table", "table8-512x128", "table of 8 bits, 512x512x128"},
    {"table", "table16f-32x32", "table of half floats, 32x32x32"},
    {"table", "table16f-64x64", "table of half floats, 64x64x64"},
    {"table", "table16f-128x64", "table of half floats, 128x128x64"},
    {"table", "table16f-128x128", "table of half floats, 128x128x128"},
    {"table", "table16f-128x256", "table of half floats, 128x128x256"},
    {"table", "table16f-256x128", "table of half floats, 256x256x128"},
    {"table", "table16f-512x128", "table of half floats, 512x512x128"},
    {"stop", "stop-0.99", "rays end at an opacity of 0.99"},
    {"stop", "stop-0.995", "rays end at an opacity of 0.995"},
    {"stop", "stop-0.999", "rays end at an opacity of 0.999"},
    {"stop", "stop-0.9995", "rays end at an opacity of 0.9995"},
    {"stop", "stop-0.9999", "rays end at an opacity of 0.9999"},
    {"stop", "stop-1", "rays never end early"},
    {"pass", "pass-1", "at most 1 cell a pass: the 2003 paper"},
    {"pass", "pass-8", "at most 8 cells a pass"},
    {"pass", "pass-64", "at most 64 cells a pass"},
    {"pass", "pass-512", "at most 512 cells a pass"},
    {"lock", "lock-never", "finished rays are never locked"},
    {"lock", "lock-2", "finished rays are locked every 2 passes"},
    {"lock", "lock-4", "finished rays are locked every 4 passes"},
    {"lock", "lock-14", "finished rays are locked every 14 passes"},
    {"state", "state-16f", "half floats between passes"},
    {"state", "state-32f", "floats between passes"},
    {"samples", "samples-1", "one ray a pixel"},
    {"samples", "samples-4", "four rays a pixel"},
    {"samples", "samples-16", "16 rays a pixel"},
    {"samples", "samples-adaptive", "4 rays a pixel, and 16 where these differ"},
    {"stepper", "signs", "out of a cell by exact signs"},
    {"stepper", "planes", "out of a cell by plane equations in float, as the 2003 paper; loses rays"},
    {"reentry", "convexify", "gaps are filled with imaginary cells"},
    {"reentry", "peel", "rays enter again by peeling"},
    {"driver", "pingpong", "multi-pass fragment shader"},
    {"driver", "reference", "double precision on the CPU"},
    {"figure", "rotation", "frame time over a full turn (2003 paper, figure 7)"},
    {"figure", "fragments", "fragments in each pass, one cell a pass (2003 paper, figure 8)"},
};

const tc_study_change tc_study_changes[TC_STUDY_SETTINGS] = {
    /* default */ {0},
    /* table8 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_8},
    /* table16f */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_16F},
    /* table32f */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_32F},
    /* integral1 */ {.integrator = TC_INTEGRATOR_INTEGRAL, .order = 1},
    /* integral2 */ {.integrator = TC_INTEGRATOR_INTEGRAL, .order = 2},
    /* exact */ {.integrator = TC_INTEGRATOR_EXACT},
    /* split-0.05 */ {.integrator = TC_INTEGRATOR_INTEGRAL, .order = 2, .split = 0.05},
    /* split-0.1 */ {.integrator = TC_INTEGRATOR_INTEGRAL, .order = 2, .split = 0.1},
    /* split-0.25 */ {.integrator = TC_INTEGRATOR_INTEGRAL, .order = 2, .split = 0.25},
    /* split-0.5 */ {.integrator = TC_INTEGRATOR_INTEGRAL, .order = 2, .split = 0.5},
    /* split-1 */ {.integrator = TC_INTEGRATOR_INTEGRAL, .order = 2, .split = 1},
    /* table8-32x32 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_8, .table_size = {32, 32, 32}},
    /* table8-64x64 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_8, .table_size = {64, 64, 64}},
    /* table8-128x64 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_8, .table_size = {128, 128, 64}},
    /* table8-128x128 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_8, .table_size = {128, 128, 128}},
    /* table8-128x256 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_8, .table_size = {128, 128, 256}},
    /* table8-256x128 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_8, .table_size = {256, 256, 128}},
    /* table8-512x128 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_8, .table_size = {512, 512, 128}},
    /* table16f-32x32 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_16F, .table_size = {32, 32, 32}},
    /* table16f-64x64 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_16F, .table_size = {64, 64, 64}},
    /* table16f-128x64 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_16F, .table_size = {128, 128, 64}},
    /* table16f-128x128 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_16F, .table_size = {128, 128, 128}},
    /* table16f-128x256 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_16F, .table_size = {128, 128, 256}},
    /* table16f-256x128 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_16F, .table_size = {256, 256, 128}},
    /* table16f-512x128 */ {.integrator = TC_INTEGRATOR_TABLE, .format = TC_TABLE_16F, .table_size = {512, 512, 128}},
    /* stop-0.99 */ {.stop = 0.99},
    /* stop-0.995 */ {.stop = 0.995},
    /* stop-0.999 */ {.stop = 0.999},
    /* stop-0.9995 */ {.stop = 0.9995},
    /* stop-0.9999 */ {.stop = 0.9999},
    /* stop-1 */ {.stop = 1},
    /* pass-1 */ {.steps_per_pass = 1},
    /* pass-8 */ {.steps_per_pass = 8},
    /* pass-64 */ {.steps_per_pass = 64},
    /* pass-512 */ {.steps_per_pass = 512},
    /* lock-never */ {.z_update_every = -1},
    /* lock-2 */ {.z_update_every = 2},
    /* lock-4 */ {.z_update_every = 4},
    /* lock-14 */ {.z_update_every = 14},
    /* state-16f */ {.state = TC_STATE_16F},
    /* state-32f */ {.state = TC_STATE_32F},
    /* samples-1 */ {.samples = 1},
    /* samples-4 */ {.samples = 4},
    /* samples-16 */ {.samples = 16},
    /* samples-adaptive */ {.samples = TC_SAMPLES_ADAPTIVE},
    /* signs */ {.stepper = TC_STEPPER_SIGNS},
    /* planes */ {.stepper = TC_STEPPER_PLANES},
    /* convexify */ {.reentry = TC_REENTRY_CONVEXIFY},
    /* peel */ {.reentry = TC_REENTRY_PEEL},
    /* pingpong */ {0},
    /* reference */ {.reference = true},
    /* rotation */ {.figure = TC_FIGURE_ROTATION},
    /* fragments */ {.figure = TC_FIGURE_FRAGMENTS},
};
/* clang-format on */

const tc_study_setting *tc_study_settings(size_t *n)
{
    *n = TC_STUDY_SETTINGS;
    return settings;
}

void tc_study_apply(tc_render_options *options, size_t k)
{
    const tc_study_change *c = &tc_study_changes[k];
    if (c->integrator)
        options->integrator = c->integrator;
    if (c->order)
        options->integral_order = c->order;
    if (c->split > 0)
        options->integral_split = c->split;
    if (c->table_size[0])
        memcpy(options->table_size, c->table_size, sizeof options->table_size);
    if (c->format)
        options->table_format = c->format;
    if (c->stop > 0)
        options->opacity_stop = c->stop;
    if (c->steps_per_pass)
        options->steps_per_pass = c->steps_per_pass;
    if (c->z_update_every)
        options->z_update_every = c->z_update_every;
    if (c->state)
        options->state_format = c->state;
    if (c->samples)
        options->samples = c->samples;
    options->stepper = c->stepper;
}

int tc_study_find(const char *name)
{
    for (int k = 0; k < TC_STUDY_SETTINGS; k++)
        if (!strcmp(settings[k].name, name))
            return k;
    return -1;
}

static tc_status fail_unknown(tc_error *err, const char *word)
{
    char knobs[256] = "";
    size_t used = 0;
    for (size_t k = 0; k < TC_STUDY_SETTINGS; k++)
        if (k == 0 || strcmp(settings[k].knob, settings[k - 1].knob) != 0)
            used += (size_t)snprintf(knobs + used, sizeof knobs - used, "%s%s", used ? ", " : "", settings[k].knob);
    return tc_fail(err, TC_E_ARG, "a study has no knob or setting '%s'; the knobs are %s", word, knobs);
}

tc_status tc_study_select(bool on[TC_STUDY_SETTINGS], const char *list, tc_error *err)
{
    for (size_t k = 0; k < TC_STUDY_SETTINGS; k++)
        on[k] = !list;
    on[0] = true; /* "default" */
    for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        char word[64];
        bool found = false;
        snprintf(word, sizeof word, "%.*s", (int)strcspn(at, ","), at);
        for (size_t k = 0; k < TC_STUDY_SETTINGS; k++)
            if (!strcmp(settings[k].knob, word) || !strcmp(settings[k].name, word))
                on[k] = found = true;
        if (!found)
            return fail_unknown(err, word);
    }
    return TC_OK;
}
