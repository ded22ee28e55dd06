/* writers.c: threads that write pictures. One lock guards the frames that wait, are at work and are done. */
#define _GNU_SOURCE
#include "cli/batch/writers.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct tc_frame_node {
    struct tc_frame_node *next;
    tc_frame_files files;
    tc_written result;
} tc_frame_node;

typedef struct tc_frame_list {
    tc_frame_node *first, *last;
} tc_frame_list;

struct tc_writers {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    tc_frame_list waiting, done;
    size_t room, under_way; /* waiting or at work */
    bool ending;
    int n;
    pthread_t *thread; /* [n] */
};

void tc_frame_files_finish(tc_frame_files *files)
{
    for (int i = 0; i < files->n; i++)
        tc_picture_file_finish(&files->file[i]);
    files->n = 0;
}

static void tc_list_push(tc_frame_list *list, tc_frame_node *node)
{
    node->next = NULL;
    if (list->last)
        list->last->next = node;
    else
        list->first = node;
    list->last = node;
}

static tc_frame_node *tc_list_pop(tc_frame_list *list)
{
    tc_frame_node *node = list->first;
    if (node) {
        list->first = node->next;
        if (!list->first)
            list->last = NULL;
    }
    return node;
}

static void tc_warning_keep(void *user, tc_level level, const char *text)
{
    tc_written *result = user;
    if (level == TC_WARNING && !*result->warning)
        snprintf(result->warning, sizeof result->warning, "%s", text);
}

static void tc_node_write(tc_frame_node *node, tc_image_writer *writer)
{
    tc_written *result = &node->result;
    const tc_log log = {.message = tc_warning_keep, .user = result};
    const double start = tc_talk_clock_s();
    *result = (tc_written){.frame = node->files.frame};
    for (int i = 0; i < node->files.n && result->status == TC_OK; i++) {
        struct stat info;
        result->status = tc_picture_file_write(&node->files.file[i], writer, &log, &result->err);
        if (result->status == TC_OK && stat(node->files.file[i].path, &info) == 0)
            result->bytes += (size_t)info.st_size;
    }
    tc_frame_files_finish(&node->files);
    result->ms = 1e3 * (tc_talk_clock_s() - start);
}

static void *tc_writer_run(void *argument)
{
    tc_writers *w = argument;
    tc_image_writer *writer = NULL;
    tc_image_writer_create(&writer, NULL); /* without one each file starts its own */
    pthread_mutex_lock(&w->lock);
    for (;;) {
        tc_frame_node *node = tc_list_pop(&w->waiting);
        if (!node && w->ending)
            break;
        if (!node) {
            pthread_cond_wait(&w->changed, &w->lock);
            continue;
        }
        pthread_mutex_unlock(&w->lock);
        tc_node_write(node, writer);
        pthread_mutex_lock(&w->lock);
        tc_list_push(&w->done, node);
        w->under_way--;
        pthread_cond_broadcast(&w->changed);
    }
    pthread_mutex_unlock(&w->lock);
    tc_image_writer_destroy(&writer);
    return NULL;
}

tc_writers *tc_writers_start(int n, size_t room)
{
    tc_writers *w = calloc(1, sizeof *w);
    if (!w)
        return NULL;
    w->thread = calloc((size_t)n, sizeof *w->thread);
    w->room = room > 0 ? room : 1;
    pthread_mutex_init(&w->lock, NULL);
    pthread_cond_init(&w->changed, NULL);
    sigset_t all, before; /* signals are for the thread that renders */
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    while (w->thread && w->n < n && pthread_create(&w->thread[w->n], NULL, tc_writer_run, w) == 0)
        w->n++;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (w->n == 0)
        tc_writers_stop(&w);
    return w;
}

bool tc_writers_put(tc_writers *w, tc_frame_files *files)
{
    tc_frame_node *node = calloc(1, sizeof *node);
    if (!node)
        return false;
    node->files = *files;
    files->n = 0;
    pthread_mutex_lock(&w->lock);
    while (w->under_way >= w->room)
        pthread_cond_wait(&w->changed, &w->lock);
    tc_list_push(&w->waiting, node);
    w->under_way++;
    pthread_cond_broadcast(&w->changed);
    pthread_mutex_unlock(&w->lock);
    return true;
}

bool tc_writers_take(tc_written *out, tc_writers *w, bool wait)
{
    pthread_mutex_lock(&w->lock);
    while (wait && !w->done.first && w->under_way > 0)
        pthread_cond_wait(&w->changed, &w->lock);
    tc_frame_node *node = tc_list_pop(&w->done);
    pthread_mutex_unlock(&w->lock);
    if (node)
        *out = node->result;
    free(node);
    return node != NULL;
}

void tc_writers_set_room(tc_writers *w, size_t room)
{
    pthread_mutex_lock(&w->lock);
    w->room = room > 0 ? room : 1;
    pthread_cond_broadcast(&w->changed);
    pthread_mutex_unlock(&w->lock);
}

void tc_writers_stop(tc_writers **writers)
{
    tc_writers *w = *writers;
    if (!w)
        return;
    pthread_mutex_lock(&w->lock);
    w->ending = true;
    pthread_cond_broadcast(&w->changed);
    pthread_mutex_unlock(&w->lock);
    for (int i = 0; i < w->n; i++)
        pthread_join(w->thread[i], NULL);
    for (tc_frame_node *node; (node = tc_list_pop(&w->done));)
        free(node);
    pthread_mutex_destroy(&w->lock);
    pthread_cond_destroy(&w->changed);
    free(w->thread);
    free(w);
    *writers = NULL;
}
