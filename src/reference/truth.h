/* truth.h: the reference's colours of some pixels of one view, found once for many pictures of it. */
#ifndef TC_REFERENCE_TRUTH_H
#define TC_REFERENCE_TRUTH_H

#include "reference/reference.h"

typedef struct tc_truth tc_truth;

/* What a truth is of; zero-initialise. reference, tf and log are borrowed for its life, the rest is copied. */
typedef struct tc_truth_view {
    const tc_reference *reference; /* with its colour for values that are not finite */
    const tc_transfer *tf;
    double unit; /* the unit distance U */
    const tc_rays *rays;
    const uint32_t *pixel; /* [n] row * width + column, row 0 at the top, none twice; NULL: drawn from seed */
    size_t n;              /* drawn without repetition; as many as there are, or more: all */
    uint64_t seed;
    int samples;   /* rays a pixel, whose mean is its colour: a square number s*s up to 4096, through the middles of the
                      places of an s x s grid in it; 0: 1, through the middle. TC_SAMPLES_ADAPTIVE: 16, since which pixels
                      of a picture got 4 or 16 is not known here: the error of having had only 4 is in the result */
    bool no_judge; /* no pixel is asked whether it is ill-posed: all count */
    double doubt;  /* pixels that err by more are asked; 0: 1/1020 */
    int threads;   /* 0: all cores */
    const tc_log *log; /* progress only, of tc_truth_create and of judging in tc_truth_compare; may be NULL */
} tc_truth_view;

/* Traces the pixels. Errors: TC_E_MEMORY; TC_E_ARG (unit <= 0, samples, more than 2^32 - 1 pixels, a pixel outside).
 * Cost: samples * n reference rays; 37 bytes a pixel. */
tc_status tc_truth_create(tc_truth **out, const tc_truth_view *view, tc_error *err);
void tc_truth_destroy(tc_truth **truth);

/* How many pixels there are. */
size_t tc_truth_count(const tc_truth *truth);
/* The pixels [count], ascending where they were drawn: row * width + column, row 0 at the top. */
const uint32_t *tc_truth_pixels(const tc_truth *truth);
/* Colour k of the list, [4]: premultiplied r, g, b and alpha. */
const double *tc_truth_color(const tc_truth *truth, size_t k);

/* Compares a picture with the truth, as tc_reference_verify says. Whether a pixel is ill-posed is asked of the
 * reference the first time that a picture errs there by more than view->doubt, and then known. A pixel of several rays
 * is ill-posed when the mean over its rays of the largest change of each exceeds 1/1020. errors  of the picture's size,
 * or NULL: gets the error image (tc_verify_image) unseen_share is NAN where the pixels were listed by the caller, for
 * it holds for a random draw, unless they are all. Not for two threads at a time. Errors: TC_E_ARG (sizes differ),
 * TC_E_MEMORY. Cost: O(n) without the judging, 10 to 20 ns a channel; judging takes up to 19 rays for each ray of the
 * pixel. */
tc_status tc_truth_compare(tc_verify_result *out, tc_image *errors, tc_truth *truth, const tc_image *image,
                           tc_error *err);

/* Of n_all pixels n were drawn at random without repetition, and unusable of these say nothing. Gives the share of the
 * others of which at most, with this confidence (0 < confidence < 1), exceed the largest value drawn; 0 when n >=
 * n_all, 1 where nothing usable was drawn. If more than K pixels exceeded the largest value drawn, the K + 1 with the
 * largest values of all would have been missed, which happens with the probability C(W - K - 1, m) / C(W, m), where m =
 * n - unusable and W is the number of usable pixels. It grows with W, so W is taken to be n_all - unusable; K is the
 * least for which it is at most 1 - confidence. What is said is thus of the usable pixels among the others, and is
 * exact, with ties and for any distribution of the values. For n far below n_all it is 1 - (1 - confidence)^(1 / m).
 * Cost: O(sqrt(n_all) log n_all). */
double tc_truth_unseen_share(size_t n_all, size_t n, size_t unusable, double confidence);

#endif
