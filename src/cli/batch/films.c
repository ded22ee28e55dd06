/* films.c: the pictures of a batch, step after step, as videos. */
#define _POSIX_C_SOURCE 200809L
#include "cli/batch/films.h"
#include "cli/batch/folder.h"
#include "cli/batch/stop.h"
#include "cli/batch/video.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

enum { TC_FILM_NAME = 4096 };

static const tc_batch_command *tc_look_of(const tc_batch_scene *scene)
{
    return &scene->look[0];
}

/* The first step's frame of a film; there is one of each frame of a step. */
static bool tc_film_name(char *out, char *why, size_t capacity, const tc_batch_frames *f, const tc_batch_base *base,
                         const tc_batch_scene *scene, size_t film)
{
    const tc_name_values values = tc_batch_values(f, base, scene, film);
    return tc_name_make(out, TC_FILM_NAME, tc_look_of(scene)->video, &values, why, capacity);
}

int tc_films_check(const tc_batch_frames *f, const tc_batch_base *base, const tc_batch_scene *scene, tc_talk *talk)
{
    char name[TC_FILM_NAME], why[256] = "";
    const char *video = tc_look_of(scene)->video, *dot = strrchr(f->pattern, '.');
    if (!video)
        return -1;
    const unsigned uses = tc_name_uses(video, why, sizeof why);
    if (!*why && !tc_video_is_name(video))
        snprintf(why, sizeof why, "the extension tells the format; use .mp4, .mov, .webm or .gif");
    else if (!*why && (uses & (TC_NAME_STEP | TC_NAME_TIME | TC_NAME_NUMBER | TC_NAME_FRAME)))
        snprintf(why, sizeof why, "one video shows all steps: leave {step}, {time} and the like out");
    else if (!*why && f->plan.n_field > 1 && !(uses & TC_NAME_FIELD))
        snprintf(why, sizeof why, "there is one video of each field: put {field} into the name");
    else if (!*why && f->plan.n_function > 1 && !(uses & TC_NAME_TF))
        snprintf(why, sizeof why, "there is one video of each transfer function: put {tf} into the name");
    else if (!*why && f->plan.n_view > 1 && !(uses & (TC_NAME_VIEW | TC_NAME_PHI | TC_NAME_THETA)))
        snprintf(why, sizeof why, "there is one video of each view: put {view} into the name");
    else if (!*why && dot && strcasecmp(dot, ".png") != 0 && strcasecmp(dot, ".jpg") != 0 && strcasecmp(dot, ".jpeg") != 0)
        snprintf(why, sizeof why, "ffmpeg takes .png and .jpg pictures: give --output such a name");
    if (!*why)
        tc_film_name(name, why, sizeof why, f, base, scene, 0);
    if (*why) {
        tc_talk_error(talk, "--video %s: %s", video, why);
        return TC_EXIT_USAGE;
    }
    if (!tc_video_is_possible(why, sizeof why))
        tc_talk_always(talk, "no video will be made: %s", why);
    return -1;
}

static bool tc_go_on(void *user, size_t frame, size_t n)
{
    (void)user, (void)frame, (void)n;
    return !tc_stop_asked();
}

/* The pictures of a film that are not there. */
static size_t tc_film_missing(const tc_batch_frames *f, size_t film)
{
    size_t missing = 0;
    for (size_t p = 0; p < f->plan.n_step; p++) {
        const tc_batch_frame *frame = &f->frame[p * f->plan.n_of_step + film];
        const bool ours = frame->state == TC_STATE_DONE || frame->state == TC_STATE_KEPT;
        missing += !ours && (frame->state != TC_STATE_OTHER || access(frame->file, R_OK) != 0);
    }
    return missing;
}

static int tc_film_make(const tc_batch_frames *f, const tc_batch_base *base, const tc_batch_scene *scene, size_t film,
                        const char **picture, tc_report *report, tc_talk *talk)
{
    char name[TC_FILM_NAME], why[256];
    tc_error err = {0};
    const tc_video_options options = {.fps = tc_look_of(scene)->fps, .go_on = tc_go_on};
    if (!tc_film_name(name, why, sizeof why, f, base, scene, film)) {
        tc_talk_error(talk, "--video: %s", why);
        return TC_EXIT_USAGE;
    }
    const size_t missing = tc_film_missing(f, film);
    if (missing > 0) {
        tc_talk_warning(talk, "%s is not made: %zu of its %zu pictures are missing; with --resume the batch goes on", name,
                        missing, f->plan.n_step);
        return -1;
    }
    for (size_t p = 0; p < f->plan.n_step; p++)
        picture[p] = f->frame[p * f->plan.n_of_step + film].file;
    int code = tc_folders_make(name, talk);
    tc_status status = code < 0 ? tc_video_make(name, picture, f->plan.n_step, &options, &err) : TC_OK;
    if (status || code >= 0)
        return status ? tc_talk_status(talk, status, &err) : code;
    tc_talk_say(talk, "wrote %s, of %zu pictures", name, f->plan.n_step);
    json_t *event = json_object();
    tc_json_text(event, "file", name);
    tc_report_event(report, "video", event);
    return -1;
}

int tc_films_make(const tc_batch_frames *f, const tc_batch_base *base, const tc_batch_scene *scene, tc_report *report,
                  tc_talk *talk)
{
    char why[256];
    int code = -1;
    if (!tc_look_of(scene)->video || tc_stop_asked())
        return -1;
    if (!tc_video_is_possible(why, sizeof why)) {
        tc_talk_error(talk, "no video was made: %s", why);
        return TC_EXIT_FAILED;
    }
    const char **picture = malloc(f->plan.n_step * sizeof *picture);
    if (!picture) {
        tc_talk_error(talk, "memory ran out");
        return TC_EXIT_FAILED;
    }
    for (size_t film = 0; film < f->plan.n_of_step && !tc_stop_asked(); film++) {
        int ends = tc_film_make(f, base, scene, film, picture, report, talk);
        code = code < 0 ? ends : code; /* the others are made all the same */
    }
    free(picture);
    return code;
}
