/* checker.h: compares a picture that rests with the double-precision reference, on a thread of low priority, and gives
 * it up when the picture goes. */
#ifndef TC_WINDOW_CHECKER_H
#define TC_WINDOW_CHECKER_H

#include "window/held.h"

typedef struct tc_checker tc_checker;

/* A picture and what it was made of. */
typedef struct tc_check {
    tc_held *held; /* keeps mesh and the look of options */
    const tc_mesh *mesh;
    tc_transfer *tf;
    tc_camera camera;
    tc_render_options options;
    tc_image *image;
    unsigned id;
} tc_check;
void tc_check_finish(tc_check *check);

/* done is called on the checker's thread: at most 1 in 100 of the pixels errs by more than error, at 95 % confidence;
 * NAN: it cannot be told. Errors: TC_E_MEMORY. */
tc_status tc_checker_create(tc_checker **out, void (*done)(void *user, unsigned id, double error), void *user,
                            tc_error *err);
void tc_checker_destroy(tc_checker **checker);
/* Begins with a picture, whose parts it takes; the one before is given up. */
void tc_checker_begin(tc_checker *checker, tc_check *check);
/* Gives up. Returns at once. */
void tc_checker_stop(tc_checker *checker);

#endif
