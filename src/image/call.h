/* call.h: the helper program tetcast-image as the files of this room call it. */
#ifndef TC_IMAGE_CALL_H
#define TC_IMAGE_CALL_H

#include "core/worker.h"

struct tc_image_writer {
    tc_worker *worker; /* NULL before there is need of it, and after it died */
};

/* Starts the helper if it is not there; returns at once. Errors: TC_E_WORKER. */
tc_status tc_image_helper_start(tc_image_writer *writer, tc_error *err);

/* tc_worker_call; starts the helper if it is not there, and drops it when it failed. *reply is to be finished. */
tc_status tc_image_helper_call(tc_reply *reply, tc_image_writer *writer, json_t *request, const tc_array *array,
                               size_t n_array, const tc_log *log, tc_error *err);

/* A path by which the helper can open one of this process's files, [64]. */
void tc_image_helper_path(char *out, int fd);

#endif
