/* run.c: the frames of a batch: while one is rendered the step after it is read and those before it are written. A mesh that
 * stays the same is set up once; of each step and field the values are put onto it, of each transfer function it is looked at
 * from all views in turn. */
#define _POSIX_C_SOURCE 200809L
#include "cli/batch/run.h"
#include "cli/batch/digest.h"
#include "cli/batch/frame.h"
#include "cli/batch/stop.h"
#include "cli/batch/writers.h"
#include "cli/picture/render_setup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TC_KEEP_LEAST = 4, TC_KEEP_MOST = 1 << 29, TC_FAILED_MOST = 3, TC_WRITERS_MOST = 4, TC_SAID = 64 };

typedef struct tc_run {
    tc_batch_frames *frames;
    tc_batch_base *base;
    tc_catalogue *catalogue;
    const tc_batch_scene *scene;
    tc_report *report;
    tc_talk *talk;
    tc_frame_kit kit;
    tc_writers *writers;
    size_t room;
    tc_render_run *kept; /* [looks] function and look of each */
    uint64_t said[TC_SAID]; /* warnings that were printed lately */
    size_t n_said;
    char data_ahead[TC_IDENTITY]; /* of the file that is read ahead, from before */
    size_t ahead_position, ahead_field;
    bool is_ahead;
    int failed_in_a_row;  /* writes */
    bool bounded;         /* --memory was looked at */
    bool alone;           /* a picture is written before another one is made */
    bool ended;           /* nothing more is made: by it, or by pictures that cannot be written */
    tc_log log;           /* of talk, before */
} tc_run;

static int tc_no_memory(tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}

/* --------------------------------------------------------------------------------------------------------- writing */

/* What the library says; a warning of thousands of pictures once. As tc_log's message. */
static void tc_run_message(void *user, tc_level level, const char *text)
{
    tc_run *r = user;
    uint64_t hash = 0xcbf29ce484222325u;
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        hash = (hash ^ *c) * 0x100000001b3u;
    for (size_t i = 0; level == TC_WARNING && i < r->n_said && i < TC_SAID; i++)
        if (r->said[i] == hash)
            return;
    if (level == TC_WARNING)
        r->said[r->n_said++ % TC_SAID] = hash;
    r->log.message(r->log.user, level, text);
}

static void tc_run_progress(void *user, const char *what, double fraction)
{
    tc_run *r = user;
    if (!r->talk->terminal) /* there the bar is on the line */
        r->log.progress(r->log.user, what, fraction);
}

/* What became of a frame that was written. -1, or the exit code that ends the run. */
static int tc_frame_note(tc_run *r, const tc_written *w)
{
    tc_batch_frame *frame = &r->frames->frame[w->frame];
    const tc_name_values values = tc_batch_values(r->frames, r->base, r->scene, w->frame);
    if (*w->warning)
        tc_run_message(r, TC_WARNING, w->warning);
    frame->state = w->status == TC_OK ? TC_STATE_DONE : TC_STATE_FAILED;
    tc_report_frame(r->report, w->status == TC_OK ? TC_FRAME_DONE : TC_FRAME_FAILED, w->frame, frame->file, values.step,
                    values.time, w->status == TC_OK ? NULL : w->err.text, w->ms, w->bytes);
    if (w->status == TC_OK) {
        r->failed_in_a_row = 0;
        return tc_catalogue_add(r->catalogue, r->frames, r->base, r->scene, w->frame, r->talk);
    }
    tc_talk_error(r->talk, "%s", w->err.text);
    if (++r->failed_in_a_row != TC_FAILED_MOST)
        return r->failed_in_a_row < TC_FAILED_MOST ? -1 : TC_EXIT_FAILED;
    tc_talk_error(r->talk, "%d pictures in a row could not be written: the batch ends; with --resume it goes on",
                  r->failed_in_a_row);
    return TC_EXIT_FAILED;
}

/* The same, said without the step at hand, which may be another than that of the frame. */
static int tc_written_note(tc_run *r, const tc_written *w)
{
    char about[sizeof r->talk->about];
    memcpy(about, r->talk->about, sizeof about);
    *r->talk->about = 0;
    const int code = tc_frame_note(r, w);
    memcpy(r->talk->about, about, sizeof about);
    return code;
}

/* Those that are done; wait: all that are under way. */
static int tc_written_take(tc_run *r, bool wait)
{
    tc_written written;
    int code = -1;
    while (tc_writers_take(&written, r->writers, wait)) {
        int ends = tc_written_note(r, &written);
        code = code < 0 ? ends : code;
    }
    return code;
}

/* ---------------------------------------------------------------------------------------------------------- memory */

/* To encode images takes half of them at most; what else comes later; a helper program that writes images. */
enum { TC_ENCODING = 2, TC_SLACK = 8 << 20, TC_HELPER = 120 << 20 };

/* The images of a frame, which are there until they are written. */
static double tc_files_bytes(const tc_frame_files *files)
{
    double sum = 0;
    for (int i = 0; i < files->n; i++) {
        const tc_picture_file *file = &files->file[i];
        sum += (16.0 + (file->depth ? 4.0 : 0.0)) * file->image->width * file->image->height;
    }
    return sum;
}

/* What a helper program takes that writes the largest of them: PNG needs none. */
static double tc_files_helper(const tc_frame_files *files)
{
    double most = 0;
    for (int i = 0; i < files->n; i++) {
        const tc_picture_file *file = &files->file[i];
        const char *dot = strrchr(file->path, '.');
        if (!dot || strcmp(dot, ".png") != 0)
            most = fmax(most, TC_HELPER + 16.0 * file->image->width * file->image->height);
    }
    return most;
}

/* The figure that is told is enough for another run, too, whose threads take turns otherwise. */
static int tc_memory_end(tc_run *r, const char *what, double used)
{
    const double most = (double)r->scene->look[0].memory;
    r->ended = true;
    tc_talk_error(r->talk, "%s %.0f MiB of memory, and --memory is %.0f MiB: allow more, or make --size smaller", what,
                  ceil(used * 1.01 / 1048576), most / 1048576);
    return TC_EXIT_FAILED;
}

/* Was --memory enough so far? */
static int tc_memory_check(tc_run *r)
{
    size_t self, helper;
    tc_memory_peak(&self, &helper);
    const double used = (double)self + (double)helper;
    return r->bounded && used > (double)r->scene->look[0].memory ? tc_memory_end(r, "the batch takes", used) : -1;
}

/* --memory, once a first picture shows what one takes: how many may wait while others are made, whether a step may be read
 * ahead. */
static int tc_memory_bound(tc_run *r, const tc_render_run *run, const tc_frame_files *files)
{
    const double most = (double)r->scene->look[0].memory;
    size_t self, helper;
    if (most == 0 || r->bounded)
        return -1;
    r->bounded = true;
    tc_memory_peak(&self, &helper);
    const double frame = tc_files_bytes(files);
    const double mesh = 220.0 * (double)run->report.n_tet; /* that moves: another one beside it while it is set up */
    const double used = (double)self + fmax((double)helper, tc_files_helper(files)) + frame / TC_ENCODING + TC_SLACK;
    if (used > most)
        return tc_memory_end(r, "making a picture and writing it take", used);
    const double left = most - used, each = frame + frame / TC_ENCODING;
    r->base->loader.never_ahead = left < mesh + each;
    const double waiting = frame > 0 ? floor((left - (r->base->loader.never_ahead ? 0 : mesh)) / each) : 0;
    r->alone = waiting < 1;
    r->room = waiting < (double)r->room ? (waiting > 1 ? (size_t)waiting : 1) : r->room;
    tc_writers_set_room(r->writers, r->room);
    return -1;
}

/* ---------------------------------------------------------------------------------------------------------- frames */

/* Makes a frame and hands it to be written. -1, or the exit code of an error that was printed. */
static int tc_frame_put(tc_run *r, const tc_render_run *base, size_t number)
{
    tc_frame_files files;
    tc_written written;
    int code = tc_frame_make(&files, &written, &r->kit, base, number);
    if (code < 0)
        code = tc_memory_bound(r, base, &files);
    if (code < 0 && files.n == 0) {
        code = tc_written_note(r, &written);
        r->ended = code >= 0;
    } else if (code < 0 && !tc_writers_put(r->writers, &files))
        code = tc_no_memory(r->talk);
    tc_frame_files_finish(&files);
    return code;
}

/* A frame that could not be made: the others may. */
static void tc_frame_fail(tc_run *r, size_t number, const char *why)
{
    const tc_name_values values = tc_batch_values(r->frames, r->base, r->scene, number);
    r->frames->frame[number].state = TC_STATE_FAILED;
    tc_report_frame(r->report, TC_FRAME_FAILED, number, r->frames->frame[number].file, values.step, values.time, why, NAN,
                    0);
}

/* ----------------------------------------------------------------------------------------------------------- loads */

/* The next step and field, from a position and field on, that has frames to do. False: none has. */
static bool tc_next_load(const tc_run *r, size_t *position, size_t *field)
{
    const tc_plan *plan = &r->frames->plan;
    for (; *position < plan->n_step; (*position)++, *field = 0) {
        const tc_plan_span span = tc_plan_span_of(plan, *position);
        for (; *field < plan->n_field && span.n > 0; (*field)++)
            for (size_t i = span.first; i < span.first + span.n; i++)
                if (r->frames->frame[i].state == TC_STATE_TO_DO && tc_plan_frame_at(plan, i).field == *field)
                    return true;
    }
    return false;
}

static bool tc_to_do(const tc_run *r, size_t frame, size_t field, size_t function)
{
    const tc_plan_frame place = tc_plan_frame_at(&r->frames->plan, frame);
    return r->frames->frame[frame].state == TC_STATE_TO_DO && place.field == field && place.function == function;
}

/* Reads what comes after this load meanwhile. */
static void tc_next_begin(tc_run *r, size_t position, size_t field)
{
    field++;
    if (!tc_next_load(r, &position, &field))
        return;
    const tc_load load = tc_batch_load(r->base, r->scene, r->frames->plan.step[position], field);
    r->is_ahead = true;
    r->ahead_position = position;
    r->ahead_field = field;
    tc_identity_make(r->data_ahead, sizeof r->data_ahead, load.path);
    tc_loader_begin(&r->base->loader, &load);
}

/* The mesh of a load. What its file is was told before it was read, and must be so after. */
static int tc_load_get(tc_run *r, size_t position, size_t field, const tc_load *load)
{
    char after[TC_IDENTITY];
    bool fresh;
    const tc_batch_base *base = r->base;
    if (r->is_ahead && r->ahead_position == position && r->ahead_field == field)
        memcpy(r->kit.data, r->data_ahead, sizeof r->kit.data);
    else if (!r->is_ahead && load->number == base->first && field == 0) /* which is there already */
        memcpy(r->kit.data, base->identity, sizeof r->kit.data);
    else
        tc_identity_make(r->kit.data, sizeof r->kit.data, load->path);
    int code = tc_loader_get(&r->base->loader, &fresh, load, r->talk);
    tc_identity_make(after, sizeof after, load->path);
    if (strcmp(r->kit.data, after) != 0)
        *r->kit.data = 0;
    return code;
}

/* The range that the function is laid over. */
static const double *tc_range_of(const tc_run *r, const tc_render_run *run, const tc_batch_command *look, size_t field)
{
    const double *range = tc_base_range(r->base, look, field);
    return tc_range_over(look) == TC_OVER_STEP || !(range[0] <= range[1]) ? run->report.scalar_range : range;
}

/* All views of one function, of the load that the mesh holds. begin: the next load may be read once the look is there. */
static int tc_function_make(tc_run *r, size_t position, size_t field, size_t function, const tc_load *load, bool *begin)
{
    const tc_plan_span span = tc_plan_span_of(&r->frames->plan, position);
    const size_t at = field * r->scene->n_function + function;
    const tc_batch_command *look = &r->scene->look[at];
    tc_render_command options = look->picture;
    tc_render_run run = r->kept[at];
    size_t first = span.first;
    while (first < span.first + span.n && !tc_to_do(r, first, field, function))
        first++;
    if (first == span.first + span.n)
        return -1;
    options.input = load->path;
    options.source.has_time = options.steps.there = false;
    options.source.has_step = load->step >= 0;
    options.source.step = load->step >= 0 ? load->step : 0;
    run.options = &options;
    run.mesh = r->base->loader.mesh;
    run.ms_read = run.ms_write = run.ms_total = NAN;
    tc_mesh_get_report(&run.report, run.mesh);
    if (!(options.unit_distance > 0))
        options.unit_distance =
            tc_unit_over(look) == TC_OVER_STEP ? tc_default_unit_distance(run.mesh) : tc_base_unit(r->base, look);
    if (tc_range_over(look) == TC_OVER_STEP)
        tc_transfer_destroy(&run.tf);
    int code = tc_render_setup(&run, tc_range_of(r, &run, look, field), r->talk);
    r->kept[at].tf = run.tf;
    r->kept[at].look = run.look;
    memcpy(r->kept[at].range, run.range, sizeof run.range);
    if (*begin)
        tc_next_begin(r, position, field);
    *begin = false;
    if (code >= 0) { /* a look that this step's values do not allow */
        char why[sizeof r->talk->last];
        snprintf(why, sizeof why, "%s", r->talk->last);
        for (size_t i = first; i < span.first + span.n; i++)
            if (tc_to_do(r, i, field, function))
                tc_frame_fail(r, i, why);
        return -1;
    }
    for (size_t i = first; i < span.first + span.n && code < 0 && !tc_stop_asked(); i++) {
        if (!tc_to_do(r, i, field, function))
            continue;
        tc_report_bar(r->report, r->frames->frame[i].file);
        code = tc_frame_put(r, &run, i);
        if (r->ended)
            return code;
        if (code >= 0) {
            tc_frame_fail(r, i, r->talk->last);
            code = -1;
        } else if (r->frames->frame[i].state == TC_STATE_TO_DO) {
            r->frames->frame[i].state = TC_STATE_DONE; /* or, once it could not be written, failed */
        }
        int ends = tc_written_take(r, r->alone);
        code = code < 0 ? ends : code;
        code = code < 0 ? tc_memory_check(r) : code;
    }
    return code;
}

/* All frames of one step and field. */
static int tc_load_make(tc_run *r, size_t position, size_t field)
{
    const tc_plan *plan = &r->frames->plan;
    const tc_load load = tc_batch_load(r->base, r->scene, plan->step[position], field);
    bool begin = true;
    snprintf(r->talk->about, sizeof r->talk->about, "step %d", load.number);
    int code = tc_load_get(r, position, field, &load);
    if (code >= 0) { /* told; the others go on */
        const tc_plan_span span = tc_plan_span_of(plan, position);
        size_t n = 0;
        for (size_t i = span.first; i < span.first + span.n; i++)
            if (r->frames->frame[i].state == TC_STATE_TO_DO && tc_plan_frame_at(plan, i).field == field) {
                r->frames->frame[i].state = TC_STATE_FAILED;
                n++;
            }
        char what[64];
        snprintf(what, sizeof what, "step %d (%zu picture%s)", load.number, n, n == 1 ? "" : "s");
        tc_report_failed(r->report, what, r->talk->last, n);
        return -1;
    }
    for (size_t k = 0; k < plan->n_function && code < 0 && !tc_stop_asked(); k++)
        code = tc_function_make(r, position, field, k, &load, &begin);
    return code;
}

/* How much memory walks may take that are kept for the steps and functions to come (tc_renderer_options): none where too few of a
 * view come. */
static size_t tc_keep_bytes(const tc_run *r)
{
    const tc_plan *plan = &r->frames->plan;
    const uint64_t most = r->scene->look[0].memory;
    if (plan->along || plan->n_step * plan->n_field * plan->n_function < TC_KEEP_LEAST)
        return 0;
    return most == 0 ? (size_t)TC_KEEP_MOST : 0; /* with a bound: what it leaves, once that is known */
}

static int tc_run_open(tc_run *r)
{
    tc_render_command first_look = r->scene->look[0].picture;
    const tc_render_command *first = &first_look;
    first_look.keep_bytes = tc_keep_bytes(r);
    const size_t looks = r->scene->n_field * r->scene->n_function;
    const long cores = first->source.threads > 0 ? first->source.threads : sysconf(_SC_NPROCESSORS_ONLN);
    const int n = cores >= 2 * TC_WRITERS_MOST ? TC_WRITERS_MOST : cores > 2 ? (int)cores / 2 : 1;
    int code = tc_frames_make(&r->kit.renderer, first, r->talk);
    r->kept = calloc(looks, sizeof *r->kept);
    r->room = (size_t)n + 2;
    r->writers = code < 0 ? tc_writers_start(n, r->room) : NULL;
    if (code < 0 && (!r->kept || !r->writers))
        code = tc_no_memory(r->talk);
    if (code < 0)
        code = tc_frame_kit_make(&r->kit);
    return code < 0 ? tc_render_ready(&r->kit.renderer, r->talk) : code;
}

static void tc_run_close(tc_run *r)
{
    const size_t looks = r->scene->n_field * r->scene->n_function;
    for (size_t i = 0; r->kept && i < looks; i++) {
        r->kept[i].mesh = NULL;
        tc_render_close(&r->kept[i]);
    }
    free(r->kept);
    tc_frame_kit_finish(&r->kit);
    tc_writers_stop(&r->writers);
}

int tc_batch_run(tc_batch_frames *frames, tc_batch_base *base, tc_catalogue *catalogue, const tc_batch_scene *scene,
                 tc_report *report, tc_talk *talk)
{
    tc_run r = {.frames = frames, .base = base, .catalogue = catalogue, .scene = scene, .report = report, .talk = talk,
               .kit = {.frames = frames, .base = base, .scene = scene, .talk = talk}};
    size_t position = 0, field = 0;
    r.log = talk->log;
    talk->log = (tc_log){.message = tc_run_message, .progress = tc_run_progress, .user = &r};
    int code = tc_run_open(&r);
    while (code < 0 && !tc_stop_asked() && tc_next_load(&r, &position, &field)) {
        code = tc_load_make(&r, position, field);
        field++;
    }
    *talk->about = 0;
    if (r.writers) {
        int ends = tc_written_take(&r, true);
        code = code < 0 ? ends : code;
    }
    talk->log = r.log;
    if (r.kit.empty > 0)
        tc_talk_always(talk, "%zu %s: %s", r.kit.empty, r.kit.empty == 1 ? "picture is empty" : "pictures are empty, the first one",
                       r.kit.empty_why);
    tc_run_close(&r);
    return code;
}
