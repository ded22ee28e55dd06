/* picture_job.h: the picture of a session as `render` writes it: at full accuracy, with its metadata, whole or not at
 * all. No GTK here. */
#ifndef TC_WINDOW_PICTURE_JOB_H
#define TC_WINDOW_PICTURE_JOB_H

#include "window/session.h"

typedef struct tc_picture_job tc_picture_job;

/* All that the picture is made of, as it is now; the session may change afterwards. path: .png, .exr, .tif or .jpg. On
 * the main thread. NULL, and the sentence in said: it cannot be. */
tc_picture_job *tc_picture_job_new(tc_session *session, const char *path);
/* Renders and writes it, in a renderer of its own; of any thread, which has to be the only one. False: why not in why
 * [1024]; nothing was written. */
bool tc_picture_job_run(tc_picture_job *job, char *why);
void tc_picture_job_free(tc_picture_job *job);

#endif
