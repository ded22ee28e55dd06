/* test_gpu_signs.c: the numbers on which the walk stands: exact signs, ties, and the same bits in every program. The
 * shaders' own functions are run on numbers that each pixel makes for itself, and judged by integers. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "gpu/frame.h"
#include "gpu/pass.h"
#include "tests/common/gl_program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 640 };

typedef struct fixture {
    tc_context *context;
    GLuint texture;
    gl_target target;
    int32_t *pixel; /* [SIDE][SIDE][4] */
} fixture;

static bool open_fixture(fixture *f, const char *name)
{
    memset(f, 0, sizeof *f);
    if (!gl_open(&f->context, name))
        return false;
    const tc_gl *gl = &f->context->gl;
    f->pixel = malloc(sizeof(int32_t) * 4 * SIDE * SIDE);
    assert_non_null(f->pixel);
    f->texture = gl_texture(gl, GL_RGBA32I, GL_RGBA_INTEGER, GL_INT, SIDE, SIDE);
    f->target = gl_target_of(gl, &f->texture, 1, SIDE, SIDE);
    return true;
}

static void close_fixture(fixture *f)
{
    const tc_gl *gl = &f->context->gl;
    gl_target_finish(&f->target, gl);
    gl->DeleteTextures(1, &f->texture);
    free(f->pixel);
    tc_context_destroy(&f->context);
}

/* A program of a shader file's whole text followed by `more`. */
static GLuint make_program(const tc_gl *gl, const char *file, const char *defines, const char *alias, const char *more)
{
    char *head = gl_shader_text(file, defines, alias);
    const char *const text[] = {head, more};
    GLuint program = gl_screen_program(gl, text, 2);
    free(head);
    return program;
}

/* Draws and reads back; the program goes. */
static void run(fixture *f, GLuint program)
{
    const tc_gl *gl = &f->context->gl;
    const GLint nothing[4] = {-77, -77, -77, -77};
    gl->ClearBufferiv(GL_COLOR, 0, nothing);
    gl->UseProgram(program);
    tc_pass_screen(gl);
    gl_target_read(f->pixel, &f->target, gl, 0, GL_RGBA_INTEGER, GL_INT);
    gl->DeleteProgram(program);
}

/* ----------------------------------------------------------------------------------------------------- signs */

/* Numbers of a pixel, in GLSL and in C: integers of 24 bits that floats hold exactly. kind 0: any; 1: a grid of 4 x 4
 * (ties abound); 2: q is p, stretched and nudged by a unit in the last place (nearly parallel); 3: 12 bits. */
static const char numbers[] =
    "uint hash(uint x) { x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; x ^= x >> 16; return x; }\n"
    "ivec4 points(uint i)\n"
    "{\n"
    "    uint h = hash(4u * i), g = hash(4u * i + 1u), k = hash(4u * i + 2u), l = hash(4u * i + 3u);\n"
    "    ivec4 r = ivec4(int(h & 0x1ffffffu), int(g & 0x1ffffffu), int(k & 0x1ffffffu), int(l & 0x1ffffffu)) - (1 << "
    "24);\n"
    "    uint kind = i & 3u;\n"
    "    if (kind == 1u) r = ((r & 3) - 1) * (1 << 20);\n"
    "    if (kind == 2u) r = ivec4((r.xy >> 2) * 2, (r.xy >> 2) * 3 + ivec2(int(k % 3u) - 1, int(l % 3u) - 1));\n"
    "    if (kind == 3u) r >>= 13;\n"
    "    return r;\n"
    "}\n";

static uint32_t hash(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

static void points(int64_t r[4], uint32_t i)
{
    uint32_t h[4];
    for (uint32_t k = 0; k < 4; k++) {
        h[k] = hash(4 * i + k);
        r[k] = (int64_t)(h[k] & 0x1ffffffu) - (1 << 24);
    }
    uint32_t kind = i & 3;
    if (kind == 2) {
        int64_t x = r[0] >> 2, y = r[1] >> 2;
        r[0] = x * 2, r[1] = y * 2;
        r[2] = x * 3 + (int64_t)(h[2] % 3) - 1, r[3] = y * 3 + (int64_t)(h[3] % 3) - 1;
    }
    for (int k = 0; k < 4; k++)
        r[k] = kind == 1 ? ((r[k] & 3) - 1) * (1 << 20) : kind == 3 ? r[k] >> 13 : r[k];
}

/* The sign's definition: the ray moved by (e, e^2), then by id. */
static int sign_of(const int64_t *p, const int64_t *q, int i, int j)
{
    int64_t cross = p[0] * q[1] - p[1] * q[0]; /* at most 2^49 */
    if (cross == 0)
        cross = p[1] - q[1];
    if (cross == 0)
        cross = q[0] - p[0];
    if (cross == 0)
        cross = j - i;
    return cross > 0 ? 1 : -1;
}

static void a_sign_is_not_that_of_the_exact_cross(void **state)
{
    (void)state;
    static const char body[] = "layout(location = 0) out ivec4 bits;\n"
                               "void main()\n"
                               "{\n"
                               "    uint i = uint(gl_FragCoord.x) + 640u * uint(gl_FragCoord.y);\n"
                               "    ivec4 r = points(i);\n"
                               "    vec4 f = vec4(r) * (1.0 / 16777216.0);\n"
                               "    int a = int(i % 7u), b = int(i % 7u) + (((i >> 8) & 1u) == 0u ? 1 : -1);\n"
                               "    bits = ivec4(floatBitsToInt(sign_cross(f.xy, f.zw, a, b)),\n"
                               "                 floatBitsToInt(sign_cross(f.zw, f.xy, b, a)), r.x, r.w);\n"
                               "}\n";
    static const char *const defines[] = {"", "#define SOFTWARE\n"};
    char more[sizeof numbers + sizeof body];
    snprintf(more, sizeof more, "%s%s", numbers, body);
    bool any = false;
    for (int c = 0; c < GL_CONTEXTS; c++) {
        fixture f;
        if (!open_fixture(&f, gl_context_names[c]))
            continue;
        any = true;
        for (int way = 0; way < 2; way++) {
            run(&f, make_program(&f.context->gl, "signs.glsl", defines[way], NULL, more));
            size_t ties = 0;
            for (uint32_t i = 0; i < SIDE * SIDE; i++) {
                int64_t r[4];
                float value[2];
                points(r, i);
                assert_int_equal(f.pixel[4 * i + 2], r[0]);
                assert_int_equal(f.pixel[4 * i + 3], r[3]);
                memcpy(value, &f.pixel[4 * i], sizeof value);
                int a = (int)(i % 7), b = a + ((i >> 8 & 1) == 0 ? 1 : -1);
                int expected = sign_of(r, r + 2, a, b);
                ties += r[0] * r[3] == r[1] * r[2];
                if ((value[0] > 0) - (value[0] < 0) != expected)
                    fail_msg("%s: cross of (%lld, %lld) and (%lld, %lld) is %g, its sign should be %d",
                             gl_context_names[c], (long long)r[0], (long long)r[1], (long long)r[2], (long long)r[3],
                             (double)value[0], expected);
                if (value[1] != -value[0])
                    fail_msg("cross is not antisymmetric: %g and %g", (double)value[0], (double)value[1]);
            }
            assert_true(ties > 10000);
        }
        close_fixture(&f);
    }
    if (!any)
        skip();
}

static void a_cell_has_one_three_or_four_faces_that_hold_the_ray(void **state)
{
    (void)state;
    /* All sets of four points on a grid of 5 x 5 around the ray: 390 625. */
    static const char body[] =
        "layout(location = 0) out ivec4 bits;\n"
        "vec2 at(int k) { return vec2(k % 5 - 2, k / 5 - 2) * 0.25; }\n"
        "int same(float a, float b, float c) { return int((a > 0.0) == (b > 0.0) && (b > 0.0) == (c > 0.0)); }\n"
        "void main()\n"
        "{\n"
        "    int i = int(gl_FragCoord.x) + 640 * int(gl_FragCoord.y);\n"
        "    vec2 p0 = at(i % 25), p1 = at(i / 25 % 25), p2 = at(i / 625 % 25), p3 = at(i / 15625 % 25);\n"
        "    float c01 = sign_cross(p0, p1, 0, 1), c12 = sign_cross(p1, p2, 1, 2), c20 = sign_cross(p2, p0, 2, 0);\n"
        "    float c03 = sign_cross(p0, p3, 0, 3), c13 = sign_cross(p1, p3, 1, 3), c23 = sign_cross(p2, p3, 2, 3);\n"
        "    int n = same(c01, c12, c20) + same(c01, c13, -c03) + same(c12, c23, -c13) + same(-c20, c23, -c03);\n"
        "    bits = ivec4(n, 0, 0, 0);\n"
        "}\n";
    bool any = false;
    for (int c = 0; c < GL_CONTEXTS; c++) {
        fixture f;
        if (!open_fixture(&f, gl_context_names[c]))
            continue;
        any = true;
        run(&f, make_program(&f.context->gl, "signs.glsl", "", NULL, body));
        size_t two = 0;
        for (size_t i = 0; i < 390625; i++) {
            if (f.pixel[4 * i] != 0 && f.pixel[4 * i] != 2)
                fail_msg("%s: set %zu: %d faces hold the ray", gl_context_names[c], i, f.pixel[4 * i]);
            two += f.pixel[4 * i] == 2;
        }
        assert_true(two > 50000 && two < 350000);
        close_fixture(&f);
    }
    if (!any)
        skip();
}

/* ------------------------------------------------------------------------------------------------ projection */

static tc_frame frame_of(double distance, bool parallel)
{
    const double center[3] = {0.2, -0.1, 0.3};
    tc_camera camera = {.position = {0.2 + 0.36 * distance, -0.1 + 0.48 * distance, 0.3 + 0.8 * distance},
                        .focal_point = {0.2, -0.1, 0.3},
                        .view_up = {0.1, 1, 0.2},
                        .view_angle = distance < 2 ? 70 : 100 / distance,
                        .parallel = parallel,
                        .parallel_scale = 1.1};
    tc_rays rays;
    tc_frame frame;
    assert_int_equal(tc_rays_from_camera(&rays, &camera, SIDE, SIDE, NULL), TC_OK);
    tc_frame_build(&frame, &rays, center, 0.9);
    return frame;
}

/* The programs' own text with another main(): what a vertex and a cross look like there. Their own main stays, reached
 * by a test that never holds, so that the compiler sees their work around the projection. */
static void programs_see_a_vertex_at_different_places(void **state)
{
    (void)state;
    static const struct {
        const char *file, *defines, *alias;
    } variants[] = {
        {"ray.glsl", "", NULL},
        {"first_hit.frag", "", NULL},
        {"first_hit.frag", "#define PEEL\n", NULL},
        {"first_hit.frag",
         "#define PEEL\n#define CLIP_NEAR\n#define CLIP_FAR\n#define HAS_IMAGINARY\n#define COLOR_HOLDS_DEPTH\n", NULL},
        {"first_hit.frag", "#define SOFTWARE\n", NULL},
        {"march.frag", "", "integrator.glsl=integrate_table.glsl"},
        {"march.frag", "#define HAS_IMAGINARY\n#define COUNT\n", "integrator.glsl=integrate_table.glsl"},
        {"march.frag", "#define COLOR_HOLDS_DEPTH\n", "integrator.glsl=integrate_integral.glsl"},
        {"march.frag",
         "#define COLOR_HOLDS_DEPTH\n#define CLIP_NEAR\n#define CLIP_FAR\n#define CELL_DATA\n#define TF_EXTEND\n",
         "integrator.glsl=integrate_integral.glsl"},
        {"march.frag", "#define COLOR_HOLDS_DEPTH\n#define HAS_IMAGINARY\n#define SOFTWARE\n",
         "integrator.glsl=integrate_exact.glsl"},
    };
    static const char common[] = "#undef main\n"
                                 "uniform int never;\n"
                                 "ivec4 seen(Ray ray, ivec4 r)\n"
                                 "{\n"
                                 "    vec3 x = vec3(r.xyz) * (1.0 / 16777216.0);\n"
                                 "    vec3 p = ray_project(ray, x);\n"
                                 "    vec3 q = ray_project(ray, x.zxy);\n"
                                 "    return floatBitsToInt(vec4(p, q.x));\n"
                                 "}\n";
    static const char plain[] = "layout(location = 0) out ivec4 out_walk;\n"
                                "void main()\n"
                                "{\n"
                                "    uint i = uint(gl_FragCoord.x) + 640u * uint(gl_FragCoord.y);\n"
                                "    out_walk = seen(ray_of_pixel(gl_FragCoord.xy), points(i));\n"
                                "}\n";
    static const char whole[] = "void main()\n"
                                "{\n"
                                "    uint i = uint(gl_FragCoord.x) + 640u * uint(gl_FragCoord.y);\n"
                                "    Ray ray = ray_of_pixel(gl_FragCoord.xy);\n"
                                "    ivec4 r = seen(ray, points(i));\n"
                                "    if (never != 0)\n"
                                "        own_main();\n"
                                "    else\n"
                                "        out_walk = r;\n"
                                "}\n";
    static const struct {
        double distance;
        bool parallel;
    } cameras[] = {{0.3, false}, {1.9, false}, {4, false}, {1e6, false}, {4, true}};
    /* One unit may not have samplers of two kinds. */
    static const char *const samplers[] = {"mesh_cells", "mesh_vertices", "tf_nodes",    "mesh_cell_scalar",
                                           "faces",      "peel_key",      "state_color", "state_walk",
                                           "state_at",   "tf_table",      "state_steps"};
    bool any = false;
    int32_t *first = malloc(sizeof(int32_t) * 4 * SIDE * SIDE);
    assert_non_null(first);
    for (int c = 0; c < GL_CONTEXTS; c++) {
        fixture f;
        if (!open_fixture(&f, gl_context_names[c]))
            continue;
        any = true;
        const tc_gl *gl = &f.context->gl;
        for (size_t k = 0; k < sizeof cameras / sizeof *cameras; k++) {
            tc_frame frame = frame_of(cameras[k].distance, cameras[k].parallel);
            for (size_t v = 0; v < sizeof variants / sizeof *variants; v++) {
                char defines[512], more[sizeof numbers + sizeof common + sizeof whole + sizeof plain];
                snprintf(defines, sizeof defines, "#define main own_main\n%s", variants[v].defines);
                snprintf(more, sizeof more, "%s%s%s", numbers, common, v == 0 ? plain : whole);
                GLuint program = make_program(gl, variants[v].file, defines, variants[v].alias, more);
                gl->UseProgram(program);
                tc_pass_frame(gl, program, &frame);
                for (int unit = 0; unit < (int)(sizeof samplers / sizeof *samplers); unit++)
                    tc_pass_int(gl, program, samplers[unit], unit);
                run(&f, program);
                if (v == 0) {
                    memcpy(first, f.pixel, sizeof(int32_t) * 4 * SIDE * SIDE);
                    float p;
                    memcpy(&p, first, sizeof p);
                    assert_true(first[0] != -77 && p > -1e7f && p < 1e7f);
                    continue;
                }
                for (size_t i = 0; i < 4 * SIDE * SIDE; i++)
                    if (f.pixel[i] != first[i])
                        fail_msg(
                            "%s: %s with %s sees other bits than ray.glsl alone, camera %zu, pixel %zu: %08x, %08x",
                            gl_context_names[c], variants[v].file, variants[v].defines, k, i / 4, (unsigned)f.pixel[i],
                            (unsigned)first[i]);
            }
        }
        close_fixture(&f);
    }
    free(first);
    if (!any)
        skip();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sign_is_not_that_of_the_exact_cross),
        cmocka_unit_test(a_cell_has_one_three_or_four_faces_that_hold_the_ray),
        cmocka_unit_test(programs_see_a_vertex_at_different_places),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
