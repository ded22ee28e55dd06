/* batch_options.c: the command line of `batch`. */
#include "cli/batch/batch_options.h"
#include "cli/commands.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define AT(member) .at = offsetof(tc_batch_command, member)

static const tc_choice tc_range_over_choice[] = {
    {"all", TC_OVER_ALL, false}, {"first", TC_OVER_FIRST, false}, {"step", TC_OVER_STEP, false}, {NULL, 0, false}};

/* 800M, 4G, 4GiB: bytes, with binary prefixes. */
static bool tc_bytes_parse(void *field, const char *text, char *why)
{
    static const char unit[] = "KMGT";
    char *end;
    double value = strtod(text, &end);
    const char *prefix = *end ? strchr(unit, *end >= 'a' ? *end - 'a' + 'A' : *end) : NULL;
    if (end == text || !(value > 0) || !isfinite(value))
        return false;
    if (prefix) {
        value *= pow(1024, (double)(prefix - unit + 1));
        end++;
    }
    if (*end && strcmp(end, "B") != 0 && strcmp(end, "iB") != 0)
        return false;
    if (value < 1e6 || value > 1e18) {
        snprintf(why, 64, "bytes, or 800M, 4G");
        return false;
    }
    *(uint64_t *)field = (uint64_t)value;
    return true;
}

/* clang-format off */
static const tc_option tc_batch_option[] = {
    {.help = "Frames"},
    {"--frames", 0, "FROM:TO[:STRIDE]|N,…", "the steps to show, from 0, both ends too; negative from the end; lists with commas; default all", TC_OPTION_CUSTOM, AT(frames), .parse = tc_plan_ranges_parse},
    {"--shard", 0, "I/N", "the I-th of N parts, from 1 to N, as for the jobs of an array; all N together make what one run makes", TC_OPTION_CUSTOM, AT(shard), .parse = tc_plan_shard_parse},
    {"--range-over", 0, "all|first|step", "where no --range is given: one range of all steps, found by a fast first pass (the default), the first step's, or each step's own", TC_OPTION_CHOICE, AT(range_over), .choice = tc_range_over_choice},
    {"--unit-over", 0, "first|all|step", "where no --unit-distance is given: that of the first step (the default), the largest of all, or each step's own", TC_OPTION_CHOICE, AT(unit_over), .choice = tc_range_over_choice},
    {"--camera-over", 0, "first|all|step", "where the camera is not given: the first step in view (the default), the box around all, or each step by itself", TC_OPTION_CHOICE, AT(camera_over), .choice = tc_range_over_choice},
    {.help = "Run"},
    {"--resume", 0, NULL, "keep frames that are finished and valid, make the others", TC_OPTION_FLAG, AT(resume)},
    {"--dry-run", 0, NULL, "list frames and bytes, make none", TC_OPTION_FLAG, AT(dry_run)},
    {"--memory", 0, "SIZE", "stay below, as 4G: fewer pictures wait, steps are not read ahead; a first picture that takes more is refused, a later one ends the batch", TC_OPTION_CUSTOM, AT(memory), .parse = tc_bytes_parse},
    {"--json", 0, NULL, "an event a line on stdout, as JSON", TC_OPTION_FLAG, AT(json)},
    {.help = "Databases and films"},
    {"--cinema", 0, NULL, "a Cinema database (Spec D): pictures and data.csv in NAME.cdb", TC_OPTION_FLAG, AT(cinema)},
    {"--video", 0, "FILE", "hand the pictures, step after step, to ffmpeg: .mp4 or .webm; {view}, {tf} and {field} where there are several", TC_OPTION_TEXT, AT(video)},
    {"--fps", 0, "N", "pictures a second of it; default 25", TC_OPTION_REAL, AT(fps), .low = 0, .high = 1000, .open = true},
};
/* clang-format on */

const tc_command tc_command_batch = {
    .name = "batch",
    .arguments = "SCENE",
    .what = "All pictures of a scene: time steps, fields, transfer functions, views.",
    .about =
        "SCENE is a scene file (.json) whose keys are these options; with lists of data files, fields, transfer "
        "functions and views it stands for a picture of each combination. It may be a dataset, too: all its steps "
        "are shown. Names of pictures have placeholders: {step:06d}, {time}, {phi}, {theta}, {view}, {tf}, {field}, "
        "{frame}, or %04d; -o takes such a name here, and no -. --error-image, --repeat, --stats and --frame-time are of "
        "one picture, and refused.",
    .own = tc_batch_option,
    .n_own = sizeof tc_batch_option / sizeof *tc_batch_option,
    .option = tc_render_option,
    .n_option = TC_N_RENDER_OPTION,
    .also = tc_look_option,
    .n_also = TC_N_LOOK_OPTION,
    .also_at = offsetof(tc_batch_command, picture) + offsetof(tc_render_command, look),
    .given = offsetof(tc_batch_command, picture) + offsetof(tc_render_command, given) + 1,
    .least = 1,
    .most = 1,
    .run = tc_batch_run_command,
};

/* Options of one picture that a batch has no use for. */
static int tc_batch_check(const tc_batch_command *out, tc_talk *talk)
{
    static const struct {
        const char *option, *why;
    } other[] = {
        {"--error-image", "an image of errors is of one picture: use tetcast render"},
        {"--repeat", "frames are repeated to measure one picture: use tetcast render"},
        {"--stats", "statistics are of one picture: use --json for what a batch does"},
        {"--frame-time", "a frame time is kept for one view: use --error, or tetcast render"},
    };
    const tc_given_list *given = &out->picture.given;
    for (size_t i = 0; i < sizeof other / sizeof *other; i++)
        if (tc_is_given(given, other[i].option))
            return tc_given_refuse(given, talk, other[i].option, NULL, "%s: %s", other[i].option, other[i].why);
    if (out->frames.n > 0 && (out->picture.source.has_step || out->picture.source.has_time))
        return tc_given_refuse(given, talk, "--frames", out->picture.source.has_step ? "--step" : "--time",
                               "--frames and --%s both choose steps: leave one out",
                               out->picture.source.has_step ? "step" : "time");
    if (out->picture.output && !strcmp(out->picture.output, "-"))
        return tc_given_refuse(given, talk, "--output", NULL, "a batch makes files: give --output a name, not -");
    return -1;
}

int tc_batch_command_take(tc_batch_command *out, const tc_scene_at *at, tc_talk *talk, int argc, char **argv)
{
    *out = (tc_batch_command){.fps = 25};
    int code = tc_picture_command_take(&out->picture, at, talk, &tc_command_batch, argc, argv);
    if (code >= 0)
        return code;
    const char *from = talk->from;
    talk->from = NULL; /* each refusal says by itself where it is from */
    code = tc_batch_check(out, talk);
    if (code < 0)
        talk->from = from;
    return code;
}

void tc_batch_command_finish(tc_batch_command *command)
{
    tc_render_command_finish(&command->picture);
}
