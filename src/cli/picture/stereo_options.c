/* stereo_options.c: pictures for two eyes: what is asked for, what it cannot go with, and names. */
#include "cli/picture/stereo_options.h"
#include "cli/json_out.h"

#include <stdio.h>
#include <string.h>

const tc_choice tc_stereo_choice[] = {{"none", TC_STEREO_NONE, false},
                                      {"pair", TC_STEREO_PAIR, false},
                                      {"side-by-side", TC_STEREO_SIDE_BY_SIDE, false},
                                      {"top-bottom", TC_STEREO_TOP_BOTTOM, false},
                                      {"anaglyph", TC_STEREO_ANAGLYPH, false},
                                      {NULL, 0, false}};

enum { TC_SIDE_MOST = 32768 };

bool tc_stereo_name(char *out, size_t capacity, const char *pattern, int eye)
{
    static const char *const name[] = {"left", "right"};
    const char *place = strstr(pattern, "{eye}");
    const char *dot = strrchr(pattern, '.'), *slash = strrchr(pattern, '/');
    const char *at = place ? place : dot && (!slash || dot > slash) ? dot : pattern + strlen(pattern);
    const int n = snprintf(out, capacity, "%.*s%s%s%s", (int)(at - pattern), pattern, place ? "" : "_", name[eye],
                           at + (place ? 5 : 0));
    return n > 0 && (size_t)n < capacity;
}

/* Each picture of the pair its own file, none the input. */
static int tc_pair_check(const tc_render_command *o, tc_talk *talk)
{
    const char *const other[] = {o->input, o->scene_path, o->stats};
    char name[8192];
    if (!strcmp(o->output, "-"))
        return tc_given_refuse(&o->given, talk, "--output", "--stereo",
                               "--output - takes one picture, --stereo pair makes two: give a name");
    for (int eye = 0; eye < 2; eye++) {
        if (!tc_stereo_name(name, sizeof name, o->output, eye))
            return tc_given_refuse(&o->given, talk, "--output", NULL, "--output: a name of more than %zu characters",
                                   sizeof name - 1);
        for (size_t i = 0; i < sizeof other / sizeof *other; i++)
            if (other[i] && tc_same_file(other[i], name))
                return tc_given_refuse(&o->given, talk, "--output", "--stereo", "%s is %s: give --output another name",
                                       name, i < 2 ? "the input and would be written over" : "the file of --stats");
    }
    return -1;
}

int tc_stereo_check(const tc_render_command *o, tc_talk *talk)
{
    const char *one = o->error_image      ? "--error-image"
                      : o->has_verify     ? "--verify"
                      : o->has_repeat     ? "--repeat"
                      : o->error > 0      ? "--error"
                      : o->frame_time > 0 ? "--frame-time"
                      : o->out.depth      ? "--depth"
                      : o->out.value      ? "--value"
                                          : NULL;
    if (o->out.stereo == TC_STEREO_NONE)
        return -1;
    if (one)
        return tc_given_refuse(&o->given, talk, one, "--stereo",
                               "%s is of one picture, --stereo makes two: leave one of them out", one);
    const int width = o->size.width * (o->out.stereo == TC_STEREO_SIDE_BY_SIDE ? 2 : 1);
    const int height = o->size.height * (o->out.stereo == TC_STEREO_TOP_BOTTOM ? 2 : 1);
    if (width > TC_SIDE_MOST || height > TC_SIDE_MOST)
        return tc_given_refuse(
            &o->given, talk, "--size", "--stereo",
            "--stereo %s makes a picture of %dx%d pixels of --size %dx%d; at most %d each way can be",
            tc_stereo_choice[o->out.stereo].name, width, height, o->size.width, o->size.height, TC_SIDE_MOST);
    return o->out.stereo == TC_STEREO_PAIR && o->output ? tc_pair_check(o, talk) : -1;
}

int tc_stereo_output_check(const tc_render_command *o, tc_talk *talk)
{
    char name[8192];
    int code = -1;
    if (o->out.stereo != TC_STEREO_PAIR)
        return tc_output_check(o->output, talk);
    for (int eye = 0; eye < 2 && code < 0; eye++)
        code =
            tc_stereo_name(name, sizeof name, o->output, eye) ? tc_output_check(name, talk) : -1; /* tc_stereo_check */
    return code;
}
