/* reference_scene.h: a cube of tets, a function of two knots, a view of it and a picture, for the reference caster. */
#ifndef TC_TESTS_UNIT_REFERENCE_SCENE_H
#define TC_TESTS_UNIT_REFERENCE_SCENE_H

#include "test_reference_fixture.h"

/* What tests choose. */
typedef struct scene_choice {
    int width, height;
    int cells;          /* the cube is cells^3 little cubes */
    double gradient[3]; /* of the scalar, which is 0 at the origin */
    tc_knot knot[2];
    double front[3]; /* the view comes from there, 30 degrees or parallel */
    bool parallel;
    double zoom; /* 1: the whole cube is in view */
} scene_choice;

typedef struct scene {
    struct tc_mesh mesh;
    tc_reference *reference;
    tc_knot knot[2];
    struct tc_transfer tf;
    tc_rays rays;
    tc_image image;
    float *pixels; /* the image's */
} scene;

/* tf borrows s->knot: a scene does not move. */
static inline void scene_of(scene *s, const scene_choice *choice)
{
    const int w = choice->width, h = choice->height;
    const double *g = choice->gradient;
    memset(s, 0, sizeof *s);
    s->mesh = kuhn_cube(choice->cells);
    linear_field(&s->mesh, 0, g[0], g[1], g[2]);
    s->reference = reference_of(&s->mesh);
    memcpy(s->knot, choice->knot, sizeof s->knot);
    s->tf.n = 2, s->tf.knot = s->knot;
    const double bounds[6] = {0, 1, 0, 1, 0, 1}, up[3] = {0, 1, 0};
    tc_camera camera = {.parallel = choice->parallel};
    tc_camera_reset(&camera, bounds, choice->front, up, 30, (double)w / h);
    tc_camera_zoom(&camera, choice->zoom);
    assert_int_equal(tc_rays_from_camera(&s->rays, &camera, w, h, NULL), TC_OK);
    s->pixels = calloc((size_t)w * (size_t)h, 4 * sizeof *s->pixels);
    assert_non_null(s->pixels);
    s->image = (tc_image){w, h, s->pixels};
}

static inline void scene_finish(scene *s)
{
    tc_reference_destroy(&s->reference);
    assert_null(s->reference);
    tc_reference_destroy(&s->reference);
    mesh_free(&s->mesh);
    free(s->pixels);
}

/* The caster's picture, of as many rays a pixel as it is set to. */
static inline void scene_draw(scene *s, int threads)
{
    tc_error err;
    if (tc_reference_render(&s->image, s->reference, &s->tf, 1, &s->rays, threads, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
}

static inline tc_verify_result scene_verify(const scene *s, size_t n, uint64_t seed, int threads)
{
    tc_verify_result v;
    tc_error err;
    memset(&v, 0x55, sizeof v);
    if (tc_reference_verify(&v, NULL, &s->image, n, seed, s->reference, &s->tf, 1, &s->rays, threads, NULL, &err) !=
        TC_OK)
        fail_msg("%s", err.text);
    return v;
}

#endif
