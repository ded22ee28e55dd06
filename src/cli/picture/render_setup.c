/* render_setup.c: from the command line of `render` to all that a picture is made of. */
#include "cli/picture/render_setup.h"
#include "cli/picture/render_figure.h"
#include "cli/picture/render_view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void tc_source_notes_say(const tc_mesh *mesh, const char *input, tc_talk *talk)
{
    const tc_source *source = tc_mesh_source(mesh);
    for (size_t i = 0; source && i < source->n_note; i++)
        tc_talk_say(talk, "%s: %s", input, source->note[i]);
}

void tc_nonfinite_say(const tc_render_run *run, tc_talk *talk)
{
    const tc_mesh_report *report = &run->report;
    if (report->nonfinite_cells)
        tc_talk_say(talk, "%zu of %zu cells have a value that is not finite and are %s", report->nonfinite_cells,
                    report->n_tet,
                    run->options->nan_color.there ? "shown with --nan-color" : "transparent; --nan-color shows them");
    if (report->dropped_nonfinite)
        tc_talk_say(talk, "%zu cells have a point that is not finite and were dropped", report->dropped_nonfinite);
}

static int tc_transfer_make(tc_render_run *run, const double range[2], tc_talk *talk)
{
    const tc_render_command *options = run->options;
    tc_error err = {0};
    tc_transfer_options make = {
        .color_map = options->color_map,
        .preset = options->preset,
        .opacity = options->opacity,
        .has_range = options->has_range,
        .range = {options->range[0], options->range[1]},
        .data_range = {range[0], range[1]},
        .log = options->log,
    };
    if (!(range[0] <= range[1])) { /* nothing is finite: any function does, the picture is empty and says so */
        make.data_range[0] = 0;
        make.data_range[1] = 1;
    }
    memcpy(run->range, options->has_range ? make.range : make.data_range, sizeof run->range);
    if (options->look.categories && !options->look.color_field)
        return tc_categories_make(&run->tf, &run->look->categories, options->look.categories, make.data_range, talk);
    tc_status status = tc_transfer_create(&run->tf, &make, &err);
    return status ? tc_talk_status(talk, status, &err) : -1;
}

int tc_render_function_check(const tc_render_command *options, tc_talk *talk)
{
    static const double any[2] = {1, 2}; /* above 0, for --log */
    tc_render_run run = {.options = options};
    if (options->look.categories)
        return -1; /* they are of the values */
    int code = tc_transfer_make(&run, any, talk);
    tc_transfer_destroy(&run.tf);
    return code;
}

static void tc_render_set(tc_render_options *out, const tc_render_command *options)
{
    tc_render_defaults(out);
    out->width = options->size.width;
    out->height = options->size.height;
    out->integrator = (tc_integrator)options->integrator;
    if (options->table_size[0] > 0)
        memcpy(out->table_size, options->table_size, sizeof out->table_size);
    out->table_format = (tc_table_format)options->table_format;
    out->unit_distance = options->unit_distance;
    out->integral_order = options->integral_order;
    out->integral_split = options->integral_split;
    out->opacity_stop = options->opacity_stop;
    out->samples = options->samples;
    out->state_format = (tc_state_format)options->state_format;
    out->has_nan_color = options->nan_color.there;
    memcpy(out->nan_color, options->nan_color.rgba, sizeof out->nan_color);
    out->stepper = (tc_stepper)options->stepper;
    out->steps_per_pass = options->steps_per_pass;
    out->z_update_every = options->z_update_every;
    out->count = false;
}

int tc_render_setup(tc_render_run *run, const double range[2], tc_talk *talk)
{
    int code = -1;
    if (!run->look && !(run->look = calloc(1, sizeof *run->look))) {
        tc_talk_error(talk, "memory ran out");
        return TC_EXIT_FAILED;
    }
    const bool first = !run->tf; /* steps that follow keep function and camera */
    if (first) {
        code = tc_transfer_make(run, range, talk);
        if (code < 0)
            code = tc_render_camera(&run->camera, run->options, run->report.bounds, talk);
    }
    if (code >= 0)
        return code;
    tc_render_set(&run->render, run->options);
    code = tc_look_build(run->look, run->mesh, run->options, talk);
    run->render.look = run->look->there ? &run->look->look : NULL;
    return code < 0 && first ? tc_render_figure_fit(run, talk) : code;
}

int tc_render_open(tc_render_run *run, const tc_render_command *options, tc_talk *talk)
{
    *run = (tc_render_run){.options = options, .ms_read = NAN, .ms_write = NAN, .ms_total = NAN};
    int code = tc_input_open(&run->mesh, &run->seen, &options->source, options->input, talk);
    run->ms_read = run->seen.ms_read;
    if (run->mesh)
        tc_source_notes_say(run->mesh, options->input, talk);
    if (code >= 0)
        return code;
    tc_mesh_get_report(&run->report, run->mesh);
    tc_nonfinite_say(run, talk);
    return tc_render_setup(run, run->report.scalar_range, talk);
}

void tc_render_close(tc_render_run *run)
{
    tc_image_destroy(&run->image);
    tc_image_destroy(&run->errors);
    if (run->look)
        tc_look_parts_finish(run->look);
    free(run->look);
    run->look = NULL;
    tc_transfer_destroy(&run->tf);
    tc_mesh_destroy(&run->mesh);
}
