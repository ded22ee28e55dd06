/* render_figure.c: what a run asks for around its picture, and the room that the picture leaves for it. */
#include "cli/picture/render_figure.h"
#include "cli/picture/look_build.h"

/* Why no colour of the picture is the function's, which a colour bar would tell; NULL: some are. */
static const char *tc_bar_untrue(const tc_look *look)
{
    const bool white = look->model == TC_MODEL_XRAY, black = look->model == TC_MODEL_ABSORPTION;
    if (!white && !black && look->model != TC_MODEL_SURFACES)
        return NULL;
    for (int i = 0; i < look->n_iso; i++)
        if (!look->iso[i].has_color)
            return NULL;
    return white   ? "with --model xray all matter is white"
           : black ? "with --model absorption all matter is black"
                   : "each isosurface has a colour of --iso-color";
}

bool tc_render_figure(tc_figure *out, const tc_render_run *run)
{
    const tc_look_options *o = &run->options->look;
    const tc_look_parts *parts = run->look;
    const bool second = parts->color_function != NULL;
    const int place = o->bar_place == TC_BAR_NONE ? TC_BAR_RIGHT : o->bar_place;
    const char *name = NULL;
    if (second)
        tc_field_info(NULL, NULL, &name, parts->look.color_field);
    *out = (tc_figure){
        .title = o->title,
        .ink = run->ink,
        .text_size = o->text_size,
        .bar = o->color_bar && !tc_bar_untrue(&parts->look) ? (tc_bar)place : TC_BAR_NONE,
        .function = second ? parts->color_function : run->tf,
        .bar_title = second ? (name ? name : o->color_field) : tc_run_field(run),
        .has_range = !o->categories,
        .range = {second ? parts->color_range[0] : run->range[0], second ? parts->color_range[1] : run->range[1]},
        .log = run->options->log && !second,
        .n_category = parts->categories.n,
        .category = parts->categories.value,
        .category_name = parts->categories.name,
        .bar_opacity = o->bar_opacity && !second,
        .triad = o->triad,
        .axes = o->axes,
        .bounds = run->report.bounds,
        .camera = &run->camera,
    };
    return o->title || out->bar || o->axes || o->triad;
}

int tc_render_figure_fit(tc_render_run *run, tc_talk *talk)
{
    static const char *const own[] = {"--camera-position", "--focal-point", "--parallel-scale", "--zoom",
                                      "--clipping-range"};
    const tc_render_command *options = run->options;
    tc_figure figure;
    tc_error err = {0};
    const char *untrue = options->look.color_bar ? tc_bar_untrue(&run->look->look) : NULL;
    if (untrue)
        tc_talk_warning(talk, "--color-bar is left out: %s, so that no colour stands for a value", untrue);
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (tc_is_given(&options->given, own[i]))
            return -1;
    if (!tc_render_figure(&figure, run) || (!figure.title && !figure.bar && !figure.axes))
        return -1;
    tc_status status =
        tc_figure_fit(&run->camera, &figure, run->report.bounds, options->size.width, options->size.height, &err);
    return status ? tc_talk_status(talk, status, &err) : -1;
}
