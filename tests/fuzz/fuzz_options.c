/* fuzz_options.c: command lines from any bytes: words end with a line feed. A scene file from any bytes.
 * The first byte chooses the command, or the scene. Promises: it is accepted or refused as a wrong command line; what
 * is accepted lies within the bounds that the table states. */
#define _GNU_SOURCE
#include "fuzz.h"

#include "cli/commands.h"
#include "cli/picture/render_options.h"

#include <math.h>

static void check_value(const tc_option *option, const char *values)
{
    const void *field = values + option->at;
    if (option->has && !*(const bool *)(values + option->has - 1))
        return;
    if (option->kind == TC_OPTION_REAL && option->has)
        TC_FUZZ_CHECK(isfinite(*(const double *)field) &&
                      (option->low == option->high ||
                       (*(const double *)field >= option->low && *(const double *)field <= option->high)));
    if (option->kind == TC_OPTION_REALS && option->has)
        for (int i = 0; i < option->n; i++)
            TC_FUZZ_CHECK(isfinite(((const double *)field)[i]));
    if (option->kind == TC_OPTION_CHOICE) {
        bool known = *(const int *)field == 0;
        for (const tc_choice *c = option->choice; c->name; c++)
            known = known || c->value == *(const int *)field;
        TC_FUZZ_CHECK(known);
    }
}

static void check_render(const tc_render_command *r)
{
    TC_FUZZ_CHECK(r->input && *r->input && r->output && *r->output);
    TC_FUZZ_CHECK(r->size.width >= 1 && r->size.height >= 1 && (long long)r->size.width * r->size.height <= 1 << 28);
    TC_FUZZ_CHECK(r->view_angle > 0 && r->view_angle < 180 && r->zoom > 0 && isfinite(r->zoom));
    TC_FUZZ_CHECK(r->opacity_stop >= 0 && r->opacity_stop <= 1 && r->repeat >= 1);
    TC_FUZZ_CHECK(!r->has_range || r->range[0] < r->range[1]);
    TC_FUZZ_CHECK(r->gl && r->driver && r->unit_distance >= 0);
    const tc_look_options *look = &r->look;
    TC_FUZZ_CHECK(look->iso.n <= TC_LOOK_MANY && look->light.n <= TC_LIGHTS_MANY && look->clip.n <= TC_LOOK_MANY);
    for (int i = 0; i < look->select.n; i++)
        TC_FUZZ_CHECK(look->select.range[i].name.length > 0 && look->select.range[i].lo <= look->select.range[i].hi);
    for (int i = 0; i < look->geometry.n; i++)
        TC_FUZZ_CHECK(look->geometry.file[i].file.length > 0 && look->geometry.file[i].opacity <= 1);
    for (int i = 0; r->background.there && i < 4; i++)
        TC_FUZZ_CHECK(r->background.rgba[i] >= 0 && r->background.rgba[i] <= 1);
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc, (void)argv;
    FILE *nowhere = fopen("/dev/null", "w");
    if (nowhere)
        stdout = stderr = nowhere;
    return 0;
}

/* The bytes as a scene file: each of its options is taken or refused as the command line's would be. */
static void check_scene(tc_fuzz_input *in)
{
    static tc_render_command values;
    tc_scene scene;
    tc_talk talk;
    tc_talk_init(&talk);
    memset(&values, 0, sizeof values);
    char *text = tc_fuzz_text(in, 0);
    int code = tc_scene_parse(&scene, text, "scene.json", "", &tc_command_render, &talk);
    TC_FUZZ_CHECK(code == -1 || (code == TC_EXIT_FAILED && !scene.n && !scene.data));
    for (size_t i = 0; i < scene.n && code < 0; i++)
        code = tc_option_set(&values, &talk, &tc_command_render, scene.item[i].option, scene.item[i].called,
                             scene.item[i].text);
    TC_FUZZ_CHECK(code == -1 || code == TC_EXIT_FAILED || code == TC_EXIT_USAGE);
    tc_given_finish(&values.given);
    tc_scene_finish(&scene);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const tc_command *const command[] = {&tc_command_render, &tc_command_info, &tc_command_compare,
                                                &tc_command_synth};
    enum { WORDS = 24 };
    static union {
        tc_render_command render;
        double align;
        char bytes[8192];
    } values;
    tc_fuzz_input in = {data, size};
    const uint8_t which = tc_fuzz_u8(&in);
    if (which == '{') { /* the scene's own first byte, so that a scene file is an input as it is */
        in = (tc_fuzz_input){data, size};
        check_scene(&in);
        return 0;
    }
    const tc_command *c = command[which % 4];
    char *word[WORDS + 1] = {NULL};
    const char *argument[8];
    int n = 0, n_argument = 0, code;
    tc_talk talk;
    tc_talk_init(&talk);
    word[n++] = strdup(c->name);
    while (in.n > 0 && n < WORDS)
        word[n++] = tc_fuzz_text(&in, '\n');
    memset(&values, 0, sizeof values);
    if (c == &tc_command_render) {
        code = tc_render_command_read(&values.render, &talk, c, n, word);
        if (code < 0)
            check_render(&values.render);
    } else {
        code = tc_options_parse(&values, argument, &n_argument, &talk, c, n, word);
        TC_FUZZ_CHECK(code >= 0 || (n_argument >= c->least && n_argument <= c->most));
    }
    TC_FUZZ_CHECK(code == -1 || code == TC_EXIT_DONE || code == TC_EXIT_USAGE || code == TC_EXIT_FAILED);
    for (size_t i = 0; code < 0 && i < c->n_option; i++)
        check_value(&c->option[i], values.bytes);
    for (size_t i = 0; code < 0 && i < c->n_also; i++)
        check_value(&c->also[i], values.bytes + c->also_at);
    if (c == &tc_command_render)
        tc_render_command_finish(&values.render);
    for (int i = 0; i < n; i++)
        free(word[i]);
    return 0;
}
