/* test_gpu_exact.c: single segments as the integrators' shaders make them in float, against the reference in double,
 * for optical depths from 1e-12 to 1e3. Each pixel integrates one segment, whole and cut in two. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "gpu/job.h"
#include "gpu/pass.h"
#include "gpu/transfer_gpu.h"
#include "reference/reference.h"
#include "tests/common/gl_program.h"
#include "transfer_make.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 256, PAIRS = 96, PER_DECADE = 4, DEPTHS = 15 * PER_DECADE + 1, CASES = 2 * PAIRS * DEPTHS };
enum { HEIGHT = (CASES + WIDTH - 1) / WIDTH, UNIT_CASES = 1 };

typedef struct named_function {
    const char *name;
    bool narrow; /* most of a segment's extinction may lie in a small part of it */
    size_t n;
    tc_knot knot[12];
} named_function;

/* Knots stand where floats are, so that what is measured is the integration and not the place of a knot. */
static const named_function functions[] = {
    {"constant extinction", false, 2, {{0, 0.9, 0.2, 0, 3}, {1, 0.1, 0.4, 1, 3}}},
    {"ramp from 0", false, 2, {{0, 0.9, 0.2, 0, 0}, {1, 0.1, 0.4, 1, 5}}},
    {"ramp to 0", false, 2, {{0, 0, 0.2, 1, 5}, {1, 1, 0.7, 0.1, 0}}},
    {"ramp up", false, 2, {{0, 1, 0.2, 0, 0.25}, {1, 0.1, 0.4, 1, 4}}},
    {"ramp down", false, 2, {{0, 0, 1, 0.3, 4}, {1, 1, 0, 0.5, 0.25}}},
    {"12 knots",
     false,
     12,
     {{0, 0.1, 0.1, 0.9, 0},
      {0.0625, 0.9, 0.3, 0, 1.5},
      {0.1875, 0.2, 0.8, 0.4, 0.1},
      {0.25, 0.7, 0.2, 0.9, 2},
      {0.375, 1, 1, 0, 0},
      {0.40625, 0, 1, 1, 0},
      {0.5, 0.6, 0.1, 0.3, 4},
      {0.59375, 0.1, 0.5, 1, 0.5},
      {0.6875, 0.8, 0.6, 0.2, 3},
      {0.78125, 0.3, 0.9, 0.7, 0.02},
      {0.90625, 0.5, 0, 0.1, 6},
      {1, 1, 0.4, 0.8, 1}}},
    {"steps of 20",
     true,
     8,
     {{0, 1, 0, 0, 0},
      {0.25, 1, 0, 0, 0},
      {0.25, 0, 1, 0, 20},
      {0.5, 0, 1, 0, 20},
      {0.5, 0, 0, 1, 0},
      {0.75, 0, 0, 1, 0},
      {0.75, 1, 1, 0, 20},
      {1, 1, 1, 0, 20}}},
    {"spike 1/512",
     true,
     5,
     {{0, 1, 0, 0, 0},
      {0.4990234375, 1, 0.5, 0, 0},
      {0.5, 1, 1, 1, 30},
      {0.5009765625, 0, 0.5, 1, 0},
      {1, 0, 0, 1, 0}}},
};
enum { FUNCTIONS = sizeof functions / sizeof *functions };

typedef struct fixture {
    tc_context *context;
    GLuint cases, drawn[2]; /* drawn: whole, and in two parts */
    gl_target target;
    float (*in)[4];                 /* [HEIGHT * WIDTH]: scalars at both ends, length, the share of the first part */
    float (*out)[4], (*out_cut)[4]; /* r, g, b, optical depth: whole, and in two parts */
} fixture;

static GLuint make_texture(const tc_gl *gl)
{
    return gl_texture(gl, GL_RGBA32F, GL_RGBA, GL_FLOAT, WIDTH, HEIGHT);
}

static bool open_fixture(fixture *f, const char *name)
{
    memset(f, 0, sizeof *f);
    if (!gl_open(&f->context, name))
        return false;
    const tc_gl *gl = &f->context->gl;
    f->in = calloc(HEIGHT * WIDTH, sizeof *f->in);
    f->out = calloc(HEIGHT * WIDTH, sizeof *f->out);
    f->out_cut = calloc(HEIGHT * WIDTH, sizeof *f->out_cut);
    assert_true(f->in && f->out && f->out_cut);
    f->cases = make_texture(gl);
    f->drawn[0] = make_texture(gl);
    f->drawn[1] = make_texture(gl);
    f->target = gl_target_of(gl, f->drawn, 2, WIDTH, HEIGHT);
    return true;
}

static void close_fixture(fixture *f)
{
    const tc_gl *gl = &f->context->gl;
    gl_target_finish(&f->target, gl);
    gl->DeleteTextures(1, &f->cases);
    gl->DeleteTextures(2, f->drawn);
    free(f->in);
    free(f->out);
    free(f->out_cut);
    tc_context_destroy(&f->context);
}

static const char fragment_text[] = "uniform sampler2D cases;\n"
                                    "layout(location = 0) out vec4 whole;\n"
                                    "layout(location = 1) out vec4 parts;\n"
                                    "void add(inout Integral i, float s, float l)\n"
                                    "{\n"
                                    "    integral_add(i, s, l);\n"
                                    "    while (integral_round(i))\n"
                                    "        ;\n"
                                    "#ifdef TF_HARD\n"
                                    "    integral_settle(i);\n"
                                    "#endif\n"
                                    "}\n"
                                    "void main()\n"
                                    "{\n"
                                    "    vec4 c = texelFetch(cases, ivec2(gl_FragCoord.xy), 0);\n"
                                    "    Integral i = integral_begin(vec4(0.0), c.x);\n"
                                    "    add(i, c.y, c.z);\n"
                                    "    whole = integral_end(i);\n"
                                    "    i = integral_begin(vec4(0.0), c.x);\n"
                                    "    add(i, c.x + (c.y - c.x) * c.w, c.z * c.w);\n"
                                    "    add(i, c.y, c.z - c.z * c.w);\n"
                                    "    parts = integral_end(i);\n"
                                    "}\n";

/* The integrator's file, and the text above. */
static GLuint make_program(const tc_gl *gl, const char *file, const char *defines)
{
    char *body = gl_shader_text(file, defines, NULL);
    const char *const text[] = {body, fragment_text};
    GLuint program = gl_screen_program(gl, text, 2);
    free(body);
    return program;
}

/* As pingpong.c does. */
static void bind(const tc_job *job, GLuint program)
{
    const tc_gl *gl = job->gl;
    tc_pass_vec2(gl, program, "tf_map", job->map[0], job->map[1]);
    if (job->n_piece > 0) {
        int half = 1;
        while (2 * half < job->n_piece)
            half *= 2;
        tc_pass_fetch(gl, program, "tf_pieces", job->software ? 3 : 10, GL_RGBA32F, job->transfer->pieces.texture,
                      job->software);
        tc_pass_fetch(gl, program, "tf_piece_floats", job->software ? 13 : 11, GL_R32F, job->transfer->piece_floats,
                      job->software);
        tc_pass_int(gl, program, "tf_piece_count", job->n_piece);
        tc_pass_int(gl, program, "tf_piece_half", half);
    }
    if (job->integrator == TC_INTEGRATOR_INTEGRAL) {
        tc_pass_fetch(gl, program, "tf_nodes", 2, GL_RGBA32F, job->transfer->nodes.texture, job->software);
        tc_pass_vec2(gl, program, "tf_grid", job->grid[0], job->grid[1]);
        tc_pass_float(gl, program, "tf_near", job->near);
        tc_pass_vec4(gl, program, "tf_mean", job->mean);
        const double hard[4] = {job->hard, job->hard / job->hard_depth, job->hard / job->hard_slope,
                                job->hard / job->hard_slope * job->hard_relative};
        if (job->hard > 0)
            tc_pass_vec4(gl, program, "tf_hard", hard);
        if (job->split > 0)
            tc_pass_float(gl, program, "tf_split", job->split);
    }
}

/* Integrates f->in into f->out and f->out_cut; edge: the longest segment, by which the integrator is chosen. */
static void integrate(fixture *f, const tc_transfer *tf, tc_integrator integrator, double edge)
{
    const tc_gl *gl = &f->context->gl;
    tc_error err = {0};
    tc_frame frame = {0};
    tc_pack_extent extent;
    for (int b = 0; b < TC_PACK_BINS; b++)
        extent.edge[b] = extent.edge_range[b] = (float)edge, extent.held[b] = 1;
    const tc_render_options options = {.integrator = integrator};
    tc_transfer_gpu transfer = {0};
    tc_render_stats stats = {0};
    tc_job job = {.gl = gl, .frame = &frame, .software = f->context->software, .transfer = &transfer.textures};
    const tc_transfer_gpu_request request = {.transfer = tf,
                                             .options = &options,
                                             .scalar = {0, 1},
                                             .length_max = edge,
                                             .extent = &extent,
                                             .length_unit = 1,
                                             .threads = 1};
    if (tc_transfer_gpu_ensure(&transfer, &job, &request, gl, &stats, &err) != TC_OK)
        fail_msg("%s", err.text);
    char defines[512];
    tc_job_defines(defines, sizeof defines, &job);
    GLuint program = make_program(
        gl, job.integrator == TC_INTEGRATOR_EXACT ? "integrate_exact.glsl" : "integrate_integral.glsl", defines);
    gl->UseProgram(program);
    bind(&job, program);
    tc_pass_texture(gl, program, "cases", UNIT_CASES, GL_TEXTURE_2D, f->cases);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, WIDTH, HEIGHT, 0, GL_RGBA, GL_FLOAT, f->in);
    tc_pass_screen(gl);
    gl_target_read(f->out, &f->target, gl, 0, GL_RGBA, GL_FLOAT);
    gl_target_read(f->out_cut, &f->target, gl, 1, GL_RGBA, GL_FLOAT);
    gl->DeleteProgram(program);
    tc_transfer_gpu_finish(&transfer, gl);
}

static uint32_t random32(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(*state >> 33);
}

/* A pair of scalars and the share of the first part, all such that the place of the cut is a float: both ends anywhere,
 * or around 1/2, or close together, or one scalar. */
static void choose_pair(float pair[3], int k, uint64_t *random)
{
    uint32_t a = random32(random) % 1025, b = random32(random) % 1025;
    if (k % 4 == 2) { /* around the spike, or into it */
        a = 508 + a % 9;
        b = k % 8 == 2 ? 508 + b % 9 : b;
    }
    pair[0] = (float)a / 1024;
    pair[1] = (float)b / 1024;
    pair[2] = (float)(1 + random32(random) % 255) / 256;
    if (k % 8 == 5) { /* some 1e-4 apart */
        pair[0] = (float)(a < 1024 ? a : 1023) / 1024;
        pair[1] = pair[0] + (float)(1 + random32(random) % 7) / 32768;
        pair[2] = (float)(1 + random32(random) % 7) / 8;
    }
    if (k % 8 == 7 || pair[0] == pair[1]) /* not on a step, where either side's value is right */
        pair[0] = pair[1] = ((float)(a % 1024) + 0.5F) / 1024;
}

/* The function's mean extinction over a pair, by a length that is optically thin. */
static double mean_extinction(const tc_transfer *tf, const float pair[2])
{
    double c[4];
    tc_reference_segment(c, tf, (double)pair[0], (double)pair[1], 1e-9);
    return -log1p(-c[3]) / 1e-9;
}

/* Fills f->in: case (pair * DEPTHS + d) * 2, and, its ends exchanged, the one behind it. Lengths are at most longest.
 * Where a pair has no extinction the length is the depth. */
static void choose_cases(fixture *f, const tc_transfer *tf, const double *depths, int n, double longest)
{
    uint64_t random = 7;
    for (int p = 0; p < PAIRS; p++) {
        float pair[3];
        choose_pair(pair, p, &random);
        double mean = mean_extinction(tf, pair);
        for (int d = 0; d < n; d++) {
            float *in = f->in[(p * DEPTHS + d) * 2];
            float l = (float)fmin(depths[d] / (mean > 0 ? mean : 1), longest);
            memcpy(in, (float[8]){pair[0], pair[1], l, pair[2], pair[1], pair[0], l, 1 - pair[2]}, 8 * sizeof *in);
        }
    }
}

/* The largest errors. Relative ones are shares of the segment's opacity. */
typedef struct worst {
    double alpha, color, exchange, fall, cut, cut_color, outside; /* relative */
    double alpha_difference, color_difference;                    /* absolute */
    double color_at;                                              /* optical depth at which `color` was met */
} worst;

static void enlarge(double *most, double value)
{
    *most = value <= *most ? *most : value; /* a NaN enlarges */
}

static double alpha_of(const float out[4])
{
    return -expm1(-(double)out[3]);
}

/* A length's parts are found to 2^-23 of the whole (a quotient, a product), so that the relative error of a small part
 * with most of the extinction is larger. */
static double rounding_of(const named_function *function, const double truth[4], double l)
{
    double most = 0;
    for (size_t k = 0; k < function->n; k++)
        most = fmax(most, function->knot[k].a);
    return function->narrow ? 0x1p-23 * most * l / fmax(truth[3], -log1p(-fmin(truth[3], 0.999))) : 0;
}

static void judge_case(worst *w, const fixture *f, const named_function *function, const tc_transfer *tf, int i,
                       int before, double most_color)
{
    const float *in = f->in[i], *out = f->out[i], *cut = f->out_cut[i];
    double truth[4], alpha = alpha_of(out), color = w->color;
    tc_reference_segment(truth, tf, (double)in[0], (double)in[1], (double)in[2]);
    for (int c = 0; c < 4; c++)
        if (!isfinite(out[c]) || !isfinite(cut[c]))
            fail_msg("%s: %g … %g, length %g: channel %d is %g, cut in two %g", function->name, (double)in[0],
                     (double)in[1], (double)in[2], c, (double)out[c], (double)cut[c]);
    if (truth[3] == 0) {
        for (int c = 0; c < 4; c++)
            if (out[c] != 0 || cut[c] != 0)
                fail_msg("%s: %g … %g, length %g: channel %d is %g, cut in two %g, not 0", function->name,
                         (double)in[0], (double)in[1], (double)in[2], c, (double)out[c], (double)cut[c]);
        return;
    }
    double rounding = rounding_of(function, truth, (double)in[2]);
    enlarge(&w->alpha, fabs(alpha - truth[3]) / truth[3] - rounding);
    enlarge(&w->alpha_difference, fabs(alpha - truth[3]));
    enlarge(&w->exchange, fabs(alpha - alpha_of(f->out[i ^ 1])) / truth[3] - 2 * rounding);
    enlarge(&w->cut, fabs(alpha_of(cut) - alpha) / truth[3] - 2 * rounding);
    if (before >= 0)
        enlarge(&w->fall, (alpha_of(f->out[before]) - alpha) / truth[3]);
    for (int c = 0; c < 3; c++) {
        enlarge(&w->color, fabs((double)out[c] - truth[c]) / truth[3] - rounding);
        enlarge(&w->color_difference, fabs((double)out[c] - truth[c]));
        enlarge(&w->cut_color, fabs((double)cut[c] - (double)out[c]) / truth[3] - 2 * rounding);
        enlarge(&w->outside, fmax((double)out[c] - alpha * most_color, -(double)out[c]) / truth[3]);
    }
    if (w->color != color)
        w->color_at = -log1p(-fmin(truth[3], 1));
}

static worst judge(const fixture *f, const named_function *function, const tc_transfer *tf, int n)
{
    worst w = {0};
    double most = 0;
    for (size_t k = 0; k < function->n; k++)
        most = fmax(fmax(most, function->knot[k].r), fmax(function->knot[k].g, function->knot[k].b));
    for (int p = 0; p < PAIRS; p++)
        for (int d = 0; d < n; d++)
            for (int side = 0; side < 2; side++) {
                int i = (p * DEPTHS + d) * 2 + side;
                judge_case(&w, f, function, tf, i, d > 0 ? i - 2 : -1, most);
            }
    return w;
}

/* ------------------------------------------------------------------------------------------------------ tests */

typedef struct result {
    bool any[GL_CONTEXTS];
    worst exact[GL_CONTEXTS][FUNCTIONS], thin[GL_CONTEXTS][FUNCTIONS], running[GL_CONTEXTS][FUNCTIONS];
} result;

static void spread_depths(double depths[DEPTHS])
{
    for (int d = 0; d < DEPTHS; d++)
        depths[d] = pow(10, -12 + d / (double)PER_DECADE);
}

static worst measure(fixture *f, const named_function *function, tc_integrator integrator, const double *depths, int n,
                     double longest)
{
    tc_transfer *tf = make(function->knot, function->n);
    choose_cases(f, tf, depths, n, longest);
    integrate(f, tf, integrator, fmin(longest, 50));
    worst w = judge(f, function, tf, n);
    tc_transfer_destroy(&tf);
    return w;
}

static void print_worst(const char *context, const char *what, const named_function *function, const worst *w)
{
    printf("    %s, %s, %s: opacity %.1e, color %.1e (at %.1e); ends exchanged %.1e, longer %.1e, cut %.1e and %.1e, "
           "outside %.1e; absolute %.1e and %.1e\n",
           context, what, function->name, w->alpha, w->color, w->color_at, w->exchange, w->fall, w->cut, w->cut_color,
           w->outside, w->alpha_difference, w->color_difference);
}

/* Below this length no segment of the function needs the part of the shader for dense ones. */
static double thin_length(const named_function *function)
{
    double most = 0;
    for (size_t k = 0; k < function->n; k++)
        most = fmax(most, function->knot[k].a);
    return 0.98 / most;
}

static int measure_all(void **state)
{
    double depths[DEPTHS];
    result *r = calloc(1, sizeof *r);
    if (!r)
        return -1;
    *state = r;
    spread_depths(depths);
    for (int c = 0; c < GL_CONTEXTS; c++) {
        fixture f;
        r->any[c] = open_fixture(&f, gl_context_names[c]);
        for (int k = 0; r->any[c] && k < FUNCTIONS; k++) {
            const named_function *function = &functions[k];
            r->exact[c][k] = measure(&f, function, TC_INTEGRATOR_EXACT, depths, DEPTHS, 1e30);
            r->thin[c][k] = measure(&f, function, TC_INTEGRATOR_EXACT, depths, DEPTHS, thin_length(function));
            r->running[c][k] = measure(&f, function, TC_INTEGRATOR_AUTO, depths, DEPTHS, 30);
            print_worst(gl_context_names[c], "exact", function, &r->exact[c][k]);
            print_worst(gl_context_names[c], "thin", function, &r->thin[c][k]);
            print_worst(gl_context_names[c], "auto", function, &r->running[c][k]);
        }
        if (r->any[c])
            close_fixture(&f);
    }
    return 0;
}

static int free_all(void **state)
{
    free(*state);
    return 0;
}

/* Is the figure `offset` bytes into a worst at most `bound`, everywhere with `exact`? */
static void check_exact(const result *r, size_t offset, double bound)
{
    bool any = false;
    for (int c = 0; c < GL_CONTEXTS; c++)
        for (int k = 0; r->any[c] && k < FUNCTIONS; k++)
            for (int thin = 0; thin < 2; thin++) {
                double value;
                any = true;
                memcpy(&value, (const char *)(thin ? &r->thin[c][k] : &r->exact[c][k]) + offset, sizeof value);
                if (!(value <= bound))
                    fail_msg("%s, %s: %g, more than %g", gl_context_names[c], functions[k].name, value, bound);
            }
    if (!any)
        skip();
}

static void opacity_loses_digits_as_optical_depth_tends_to_0(void **state)
{
    check_exact(*state, offsetof(worst, alpha), 3e-6);
}

static void color_loses_digits_as_optical_depth_tends_to_0_or_beyond_1(void **state)
{
    check_exact(*state, offsetof(worst, color), 5e-5);
}

static void opacity_differs_from_back_to_front(void **state)
{
    check_exact(*state, offsetof(worst, exchange), 2e-6);
}

/* By more than what is left out behind a transmittance of 1e-6. */
static void opacity_falls_where_a_segment_is_longer(void **state)
{
    check_exact(*state, offsetof(worst, fall), 2e-6);
}

static void opacity_changes_where_a_segment_is_cut(void **state)
{
    check_exact(*state, offsetof(worst, cut), 4e-6);
}

static void color_changes_where_a_segment_is_cut(void **state)
{
    check_exact(*state, offsetof(worst, cut_color), 5e-5);
}

static void color_is_negative_or_exceeds_opacity_times_the_largest(void **state)
{
    check_exact(*state, offsetof(worst, outside), 2e-6);
}

/* Depths at which squares and exponentials leave the range of floats, and length 0. */
static void a_dense_segment_or_none_is_not_a_number(void **state)
{
    static const double depths[] = {0, 1e-30, 1e6, 1e10, 1e20};
    static const tc_integrator integrators[] = {TC_INTEGRATOR_EXACT, TC_INTEGRATOR_AUTO};
    const result *r = *state;
    bool any = false;
    for (int c = 0; c < GL_CONTEXTS; c++) {
        fixture f;
        if (!r->any[c])
            continue;
        any = true;
        assert_true(open_fixture(&f, gl_context_names[c]));
        for (int k = 0; k < FUNCTIONS; k++)
            for (int way = 0; way < 2; way++) {
                worst w = measure(&f, &functions[k], integrators[way], depths, 5, 1e30);
                if (!(w.alpha_difference <= 2e-6 && w.color_difference <= 5e-5 && w.fall <= 2e-6))
                    fail_msg("%s, %s, way %d: opacity errs by %g, color by %g", gl_context_names[c], functions[k].name,
                             way, w.alpha_difference, w.color_difference);
            }
        close_fixture(&f);
    }
    if (!any)
        skip();
}

static void running_integrals_err_by_more_than_they_may(void **state)
{
    const result *r = *state;
    bool any = false;
    for (int c = 0; c < GL_CONTEXTS; c++)
        for (int k = 0; r->any[c] && k < FUNCTIONS; k++) {
            const worst *w = &r->running[c][k];
            any = true;
            double bound = functions[k].narrow ? 8e-3 : 1.5e-3; /* of a spike between two ends no sample tells */
            if (!(w->alpha_difference <= 1.5e-4 && w->color_difference <= bound))
                fail_msg("%s, %s: opacity errs by %g, color by %g", gl_context_names[c], functions[k].name,
                         w->alpha_difference, w->color_difference);
        }
    if (!any)
        skip();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(opacity_loses_digits_as_optical_depth_tends_to_0),
        cmocka_unit_test(color_loses_digits_as_optical_depth_tends_to_0_or_beyond_1),
        cmocka_unit_test(opacity_differs_from_back_to_front),
        cmocka_unit_test(opacity_falls_where_a_segment_is_longer),
        cmocka_unit_test(opacity_changes_where_a_segment_is_cut),
        cmocka_unit_test(color_changes_where_a_segment_is_cut),
        cmocka_unit_test(color_is_negative_or_exceeds_opacity_times_the_largest),
        cmocka_unit_test(a_dense_segment_or_none_is_not_a_number),
        cmocka_unit_test(running_integrals_err_by_more_than_they_may),
    };
    return cmocka_run_group_tests(tests, measure_all, free_all);
}
