/* picture_job.c: the picture of a session as `render` writes it. */
#define _POSIX_C_SOURCE 200809L
#include "window/picture_job.h"

#include "cli/picture/render_picture.h"
#include "window/held.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct tc_picture_job {
    tc_talk talk;
    tc_settings *settings;
    tc_held *held;
    tc_mesh *mesh; /* that held holds */
    char *path, **argv;
    int argc;
};

void tc_picture_job_free(tc_picture_job *job)
{
    if (!job)
        return;
    tc_settings_destroy(&job->settings);
    tc_held_drop(&job->held);
    free(job->path);
    free(job->argv);
    free(job);
}

tc_picture_job *tc_picture_job_new(tc_session *session, const char *path)
{
    static char render[] = "render", output[] = "-o";
    if (!session->run.mesh) {
        tc_session_say(session, "there are no data yet to make a picture of");
        return NULL;
    }
    tc_picture_job *job = calloc(1, sizeof *job);
    tc_settings *settings = job ? tc_session_settings(session) : NULL; /* says why not */
    if (!settings) {
        free(job);
        return NULL;
    }
    job->settings = settings;
    job->held = tc_held_take(session->mesh);
    job->mesh = session->run.mesh;
    job->path = strdup(path);
    job->argv = calloc(settings->n + 3, sizeof *job->argv);
    if (!job->path || !job->argv) {
        tc_picture_job_free(job);
        tc_session_say(session, "memory ran out");
        return NULL;
    }
    for (size_t i = 0; i < settings->n; i++)
        job->argv[i] = i ? settings->word[i] : render;
    job->argc = (int)settings->n;
    job->argv[job->argc++] = output;
    job->argv[job->argc++] = job->path;
    settings->options.output = job->path;
    return job;
}

bool tc_picture_job_run(tc_picture_job *job, char *why)
{
    const tc_render_command *options = &job->settings->options;
    tc_frames frames = {0};
    tc_render_run run = {.options = options, .mesh = job->mesh, .ms_read = NAN, .ms_write = NAN, .ms_total = NAN};
    tc_talk_init(&job->talk);
    job->talk.muted = true;
    int code = tc_output_kind_check(job->path, &job->talk);
    if (code < 0)
        code = tc_output_check(job->path, &job->talk);
    tc_mesh_get_report(&run.report, run.mesh);
    if (code < 0)
        code = tc_render_setup(&run, run.report.scalar_range, &job->talk);
    if (code < 0)
        code = tc_frames_make(&frames, options, &job->talk);
    if (code < 0)
        code = tc_render_ready(&frames, &job->talk);
    if (code < 0)
        code = tc_render_picture(&run, &frames, &job->talk, job->argc, job->argv);
    if (code < 0 && run.lost.code)
        code = tc_talk_status(&job->talk, run.lost.code, &run.lost);
    tc_frames_finish(&frames);
    run.mesh = NULL; /* others have it, too */
    tc_render_close(&run);
    snprintf(why, 1024, "%s", code < 0 ? "" : *job->talk.last ? job->talk.last : "the picture could not be made");
    return code < 0;
}
