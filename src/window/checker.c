/* checker.c: compares a picture that rests with the reference. Each pixel of a draw is one ray of the driver
 * "reference", whose hierarchy stays for the mesh, so that it can be given up between any two. */
#define _GNU_SOURCE
#include "window/checker.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* Of DRAW pixels the WORST-th largest error is exceeded by 1 in 100 of all at most, at 95 % confidence: a draw in which
 * so few err by more has, with a larger share, a chance of sum_{i < WORST} C(DRAW, i) 0.01^i 0.99^(DRAW - i) < 0.05.
 * The largest ones may be of ill-posed rays, which jump with any rounding. */
enum { DRAW = 628, WORST = 3, TETS_MOST = 3000000 };

struct tc_checker {
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t more;
    void (*done)(void *user, unsigned id, double error);
    void *user;
    tc_check next; /* image NULL: none */
    bool quit;
    atomic_uint turn; /* goes on with each begin and stop */
    tc_renderer *reference;
};

void tc_check_finish(tc_check *check)
{
    tc_image_destroy(&check->image);
    tc_transfer_destroy(&check->tf);
    tc_held_drop(&check->held);
    memset(check, 0, sizeof *check);
}

static uint64_t next_random(uint64_t *state) /* splitmix64 (Steele, Lea, Flood 2014) */
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* The largest difference of a channel at one pixel; NAN: it failed. */
static double pixel_error(tc_checker *c, const tc_check *check, int x, int y)
{
    tc_render_options options = check->options;
    tc_image *truth = NULL;
    double worst = 0;
    options.whole_width = options.width;
    options.whole_height = options.height;
    options.part_x = x;
    options.part_y = y;
    options.width = options.height = 1;
    if (tc_render(&truth, NULL, c->reference, check->mesh, check->tf, &check->camera, &options, NULL, NULL) != TC_OK)
        return NAN;
    const float *is = check->image->rgba + 4 * ((size_t)y * (size_t)check->image->width + (size_t)x);
    for (int k = 0; k < 4; k++)
        worst = fmax(worst, fabs((double)is[k] - (double)truth->rgba[k]));
    tc_image_destroy(&truth);
    return worst;
}

/* The same of a picture with a look, in one go. Ill-posed rays are counted apart, so that the largest of fewer will do. */
static bool compare_looks(double *error, const tc_check *check)
{
    enum { FEW = 300 };
    tc_verify_result result;
    if (tc_verify(&result, check->image, FEW, 1, check->mesh, check->tf, &check->camera, &check->options, NULL, NULL) !=
            TC_OK ||
        !(result.unseen_share <= 0.01))
        return false;
    *error = result.max_abs_error;
    return true;
}

/* False: given up, or it cannot be told. */
static bool compare(double *error, tc_checker *c, const tc_check *check, unsigned turn)
{
    tc_mesh_report report;
    double worst[WORST] = {0};
    uint64_t random = 1;
    const uint64_t n = (uint64_t)check->image->width * (uint64_t)check->image->height;
    tc_mesh_get_report(&report, check->mesh);
    if (report.n_tet > TETS_MOST)
        return false;
    if (check->options.look) /* what it points to is prepared once for all pixels */
        return compare_looks(error, check);
    const tc_renderer_options make = {.driver = "reference"};
    if (!c->reference && tc_renderer_create(&c->reference, &make, NULL, NULL) != TC_OK)
        return false;
    for (int i = 0; i < DRAW; i++) {
        const uint64_t at = next_random(&random) % n;
        if (atomic_load(&c->turn) != turn)
            return false;
        double e =
            pixel_error(c, check, (int)(at % (uint64_t)check->image->width), (int)(at / (uint64_t)check->image->width));
        if (isnan(e))
            return false;
        for (int k = 0; k < WORST; k++)
            if (e > worst[k]) {
                const double rest = worst[k];
                worst[k] = e;
                e = rest;
            }
    }
    *error = worst[WORST - 1];
    return true;
}

static void *work(void *user)
{
    tc_checker *c = user;
    setpriority(PRIO_PROCESS, (id_t)gettid(), 19); /* of this thread and of those it starts */
    pthread_mutex_lock(&c->lock);
    while (!c->quit) {
        if (!c->next.image) {
            pthread_cond_wait(&c->more, &c->lock);
            continue;
        }
        tc_check now = c->next;
        const unsigned turn = atomic_load(&c->turn);
        double error = NAN;
        memset(&c->next, 0, sizeof c->next);
        pthread_mutex_unlock(&c->lock);
        compare(&error, c, &now, turn);
        if (atomic_load(&c->turn) == turn)
            c->done(c->user, now.id, error);
        tc_check_finish(&now);
        pthread_mutex_lock(&c->lock);
    }
    pthread_mutex_unlock(&c->lock);
    tc_renderer_destroy(&c->reference);
    return NULL;
}

tc_status tc_checker_create(tc_checker **out, void (*done)(void *user, unsigned id, double error), void *user,
                            tc_error *err)
{
    tc_checker *c = calloc(1, sizeof *c);
    *out = NULL;
    if (c) {
        pthread_mutex_init(&c->lock, NULL);
        pthread_cond_init(&c->more, NULL);
        atomic_init(&c->turn, 1);
        c->done = done;
        c->user = user;
        if (pthread_create(&c->thread, NULL, work, c) == 0) {
            *out = c;
            return TC_OK;
        }
        free(c);
    }
    if (err)
        *err = (tc_error){.code = TC_E_MEMORY, .text = "no thread could be started to check pictures: memory ran out"};
    return TC_E_MEMORY;
}

void tc_checker_stop(tc_checker *c)
{
    atomic_fetch_add(&c->turn, 1);
    pthread_mutex_lock(&c->lock);
    tc_check_finish(&c->next);
    pthread_mutex_unlock(&c->lock);
}

void tc_checker_begin(tc_checker *c, tc_check *check)
{
    tc_checker_stop(c);
    pthread_mutex_lock(&c->lock);
    c->next = *check;
    memset(check, 0, sizeof *check);
    pthread_cond_signal(&c->more);
    pthread_mutex_unlock(&c->lock);
}

void tc_checker_destroy(tc_checker **checker)
{
    tc_checker *c = *checker;
    if (!c)
        return;
    tc_checker_stop(c);
    pthread_mutex_lock(&c->lock);
    c->quit = true;
    pthread_cond_signal(&c->more);
    pthread_mutex_unlock(&c->lock);
    pthread_join(c->thread, NULL);
    pthread_mutex_destroy(&c->lock);
    pthread_cond_destroy(&c->more);
    free(c);
    *checker = NULL;
}
