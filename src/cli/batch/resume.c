/* resume.c: what a frame's pixels depend on, and which frames are finished and valid. */
#define _POSIX_C_SOURCE 200809L
#include "cli/batch/digest.h"
#include "cli/batch/frames.h"
#include "cli/picture/numbers.h"
#include "cli/picture/stereo_options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What is found over all steps or the first is a number, what is found from the step itself follows from its data. */
static json_t *tc_found(tc_over over, const double *value, size_t n)
{
    return over == TC_OVER_STEP ? json_string("step") : tc_json_reals(value, n);
}

static json_t *tc_camera_json(const tc_camera *c)
{
    double all[15];
    memcpy(all, c->position, sizeof c->position);
    memcpy(all + 3, c->focal_point, sizeof c->focal_point);
    memcpy(all + 6, c->view_up, sizeof c->view_up);
    all[9] = c->view_angle;
    all[10] = c->parallel_scale;
    all[11] = c->clip_near;
    all[12] = c->clip_far;
    memcpy(all + 13, c->window_center, sizeof c->window_center);
    json_t *json = tc_json_reals(all, 15);
    json_array_append_new(json, json_boolean(c->parallel));
    return json;
}

/* A camera that each step's box gives anew is known by what it makes of two boxes, which are always the same. */
static json_t *tc_camera_rule_json(const tc_batch_frames *f, const tc_batch_scene *scene, size_t view)
{
    static const double box[2][6] = {{-0.731, 1.377, -1.113, 0.859, -0.271, 2.903}, {3.19, 11.7, -5.33, -0.71, 2.41, 4.07}};
    tc_talk silent = {.muted = true};
    json_t *json = json_array();
    for (int i = 0; i < 2; i++) {
        tc_camera camera;
        const bool good = tc_batch_view_camera(&camera, f, scene, view, box[i], &silent) < 0;
        json_array_append_new(json, good ? tc_camera_json(&camera) : json_null());
    }
    return json;
}

/* The title, where it tells of more than the text that was given: of the frame's number, say. */
static void tc_title_add(json_t *json, const char *pattern, const tc_name_values *values)
{
    char title[1024], why[256];
    if (pattern && tc_name_uses(pattern, why, sizeof why) &&
        tc_name_make(title, sizeof title, pattern, values, why, sizeof why))
        tc_json_text(json, "title", title);
}

static void tc_digest_of(char out[17], const tc_batch_frames *f, const tc_batch_base *base,
                         const tc_batch_scene *scene, const tc_plan_frame *place, const tc_name_values *values,
                         const char *data)
{
    const tc_batch_command *look = &scene->look[place->field * scene->n_function + place->function];
    const tc_render_command *o = &look->picture;
    const double unit = o->unit_distance > 0 ? o->unit_distance : tc_base_unit(base, look);
    const size_t view = tc_batch_view_of(f, place);
    json_t *json = tc_digest_options(o);
    tc_json_text(json, "tetcast", tc_version());
    tc_json_text(json, "data", data);
    json_object_set_new(json, "step", json_integer(place->step));
    json_object_set_new(json, "time", tc_json_reals(&values->time, 1));
    tc_json_text(json, "field", values->field);
    json_object_set_new(json, "camera",
                        tc_camera_over(look) == TC_OVER_STEP ? tc_camera_rule_json(f, scene, view)
                                                             : tc_camera_json(&f->view[view].camera));
    json_object_set_new(json, "free", json_boolean(tc_view_is_free(&scene->views, view)));
    tc_title_add(json, o->look.title, values);
    json_object_set_new(json, "range",
                        o->has_range ? json_null()
                                     : tc_found(tc_range_over(look), tc_base_range(base, look, place->field), 2));
    json_object_set_new(json, "unit", tc_found(tc_unit_over(look), &unit, 1));
    json_object_set_new(json, "depth", json_boolean(o->out.depth && !tc_depth_is_apart(f->pattern)));
    json_object_set_new(json, "error", tc_json_reals(&o->error, 1));
    json_object_set_new(json, "verify", json_integer(o->has_verify ? (json_int_t)o->verify : 0));
    tc_digest_make(out, json);
}

char *tc_batch_frame_text(const tc_batch_frames *frames, const tc_batch_base *base, const tc_batch_scene *scene,
                          size_t frame, const char *data)
{
    char digest[17];
    const tc_plan_frame place = tc_plan_frame_at(&frames->plan, frame);
    const tc_name_values values = tc_batch_values(frames, base, scene, frame);
    tc_digest_of(digest, frames, base, scene, &place, &values, data);
    json_t *json = json_object();
    tc_json_text(json, "digest", digest);
    json_object_set_new(json, "step", json_integer(place.step));
    tc_json_real(json, "time", values.time);
    tc_json_real(json, "phi", values.phi);
    tc_json_real(json, "theta", values.theta);
    if (tc_view_is_named(&scene->views, tc_batch_view_of(frames, &place))) /* else it is a number among those asked for */
        tc_json_text(json, "view", values.view);
    tc_json_text(json, "field", values.field);
    tc_json_text(json, "tf", values.tf);
    char *text = *digest ? json_dumps(json, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17)) : NULL;
    json_decref(json);
    return text;
}

/* Is the file whole, and does it carry this text? */
static bool tc_file_holds(const char *path, const char *text, tc_image_writer *writer)
{
    char *there = NULL;
    const bool whole = tc_image_check(&there, path, "tetcast:frame", writer, NULL) == TC_OK;
    const bool same = whole && there && !strcmp(there, text);
    free(there);
    return same;
}

/* The files beside a picture that this look makes. */
static bool tc_beside_hold(const char *path, const char *text, const tc_output_options *o, tc_image_writer *writer)
{
    bool good = true;
    const struct {
        const char *kind;
        bool there;
    } beside[] = {{"depth", o->depth && tc_depth_is_apart(path)}, {"value", o->value}};
    for (size_t i = 0; i < sizeof beside / sizeof *beside && good; i++) {
        char *name = beside[i].there ? tc_numbers_path(path, beside[i].kind) : NULL;
        good = !beside[i].there || (name && tc_file_holds(name, text, writer));
        free(name);
    }
    return good;
}

int tc_batch_resume(tc_batch_frames *f, size_t *stale, const tc_batch_base *base, const tc_batch_scene *scene,
                    tc_talk *talk)
{
    tc_image_writer *writer = NULL;
    tc_error err = {0};
    char data[TC_IDENTITY] = "";
    *stale = 0;
    tc_status status = tc_image_writer_create(&writer, &err);
    if (status)
        return tc_talk_status(talk, status, &err);
    for (size_t p = 0, n_seen = 0; p < f->plan.n_step; p++) {
        const tc_plan_span span = tc_plan_span_of(&f->plan, p);
        if (span.n == 0)
            continue;
        if (!*data || scene->series.of_files) /* one file's is the same for all steps */
            tc_identity_make(data, sizeof data, tc_batch_load(base, scene, f->plan.step[p], 0).path);
        for (size_t i = span.first; i < span.first + span.n; i++) {
            tc_batch_frame *frame = &f->frame[i];
            const tc_plan_frame place = tc_plan_frame_at(&f->plan, i);
            if (talk->log.progress && n_seen++ % 16 == 0)
                talk->log.progress(talk->log.user, "looking at what is finished", (double)i / (double)f->plan.n);
            if (access(frame->file, F_OK) != 0)
                continue;
            const tc_output_options *o = &scene->look[place.field * scene->n_function + place.function].picture.out;
            char *text = tc_batch_frame_text(f, base, scene, i, data);
            bool same = text && *data && tc_file_holds(frame->file, text, writer) &&
                        tc_beside_hold(frame->file, text, o, writer);
            if (same && o->stereo == TC_STEREO_PAIR) {
                char *right = tc_batch_eye_file(f, base, scene, i, 1);
                same = right && tc_file_holds(right, text, writer) && tc_beside_hold(right, text, o, writer);
                free(right);
            }
            free(text);
            frame->state = same ? TC_STATE_KEPT : TC_STATE_TO_DO;
            *stale += !same;
        }
    }
    tc_image_writer_destroy(&writer);
    return -1;
}
