/* test_gpu_program.c: assembling programs from the shader files, and that a program holds only what its scene needs. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "gpu/first_hit.h"
#include "gpu/job.h"
#include "tests/common/gl_program.h"

#include <stdlib.h>
#include <string.h>

static const char *file_text(const char *name)
{
    for (const tc_shader_file *f = tc_shader_files; f->name; f++)
        if (strcmp(f->name, name) == 0)
            return f->text;
    fail_msg("no shader %s", name);
    return NULL;
}

static int count(const char *text, const char *what)
{
    int n = 0;
    for (const char *p = text; (p = strstr(p, what)); p += strlen(what))
        n++;
    return n;
}

/* The line of a file, from 1, that holds the text. */
static int line_of(const char *file, const char *what)
{
    const char *text = file_text(file), *at = strstr(text, what);
    assert_non_null(at);
    int line = 1;
    for (const char *p = text; p < at; p++)
        line += *p == '\n';
    return line;
}

static void a_file_is_included_twice_or_not(void **state)
{
    (void)state;
    char *text = gl_shader_text("march.frag", "#define COUNT\n", "integrator.glsl=integrate_table.glsl");
    assert_int_equal(strncmp(text, "#version", 8), 0);
    assert_int_equal(count(text, "#define COUNT\n"), 1);
    assert_int_equal(count(text, "#include"), 0);
    assert_int_equal(count(text, "float sign_cross("), 1);
    assert_int_equal(count(text, "Ray ray_of_pixel("), 1);
    assert_int_equal(count(text, "Segment walk_step("), 1);
    assert_int_equal(count(text, "uniform sampler3D tf_table"), 1);
    assert_int_equal(count(text, "tf_nodes"), 0); /* the other integrator */
    free(text);
    text = gl_shader_text("march.frag", "", "integrator.glsl=integrate_integral.glsl");
    assert_true(count(text, "tf_nodes") > 0);
    assert_int_equal(count(text, "tf_table"), 0);
    free(text);
}

static void missing_files_are_not_named(void **state)
{
    (void)state;
    char *text;
    char expected[64];
    tc_error err = {0};
    assert_int_equal(tc_program_text(&text, "absent.frag", "", NULL, NULL, &err), TC_E_GL);
    assert_null(text);
    assert_non_null(strstr(err.text, "absent.frag"));
    static const char *const aliases[] = {NULL, "integrator.glsl=absent.glsl"};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(tc_program_text(&text, "march.frag", "", aliases[i], NULL, &err), TC_E_GL);
        assert_null(text);
        snprintf(expected, sizeof expected, "march.glsl:%d", line_of("march.glsl", "#include \"integrator.glsl\""));
        if (!strstr(err.text, expected))
            fail_msg("no %s in: %s", expected, err.text);
    }
}

typedef struct fixture {
    tc_context *context;
    tc_program_cache *cache;
} fixture;

/* False where the context is missing. */
static bool open_fixture(fixture *f, const char *name)
{
    tc_error err = {0};
    if (!gl_open(&f->context, name))
        return false;
    assert_int_equal(tc_program_cache_create(&f->cache, &f->context->gl, &err), TC_OK);
    return true;
}

/* In the first context that there is; the test is skipped where there is none. */
static fixture open_any(void)
{
    fixture f = {0};
    for (int c = 0; c < GL_CONTEXTS; c++)
        if (open_fixture(&f, gl_context_names[c]))
            return f;
    skip();
    return f;
}

static void close_fixture(fixture *f)
{
    tc_program_cache_destroy(&f->cache);
    tc_context_destroy(&f->context);
}

static void compilers_errors_name_another_line(void **state)
{
    (void)state;
    /* A define breaks one line of one file. */
    static const struct {
        const char *define, *file, *at;
    } breaks[] = {
        {"#define mesh_record 3 3\n", "mesh.glsl", "ivec4 mesh_record("},
        {"#define SIGN_TINY 3 3\n", "signs.glsl", "const float SIGN_TINY"},
        {"#define tf_table 3 3\n", "integrate_table.glsl", "uniform sampler3D tf_table"},
        {"#define out_at 3 3\n", "march.frag", "out ivec4 out_at"},
        {"#define place_in_tile 3 3\n", "march.comp", "ivec2 place_in_tile("},
    };
    bool any = false;
    for (int c = 0; c < GL_CONTEXTS; c++) {
        fixture one;
        if (!open_fixture(&one, gl_context_names[c]))
            continue;
        any = true;
        for (size_t i = 0; i < sizeof breaks / sizeof *breaks; i++) {
            const bool compute = strcmp(breaks[i].file, "march.comp") == 0;
            const tc_program_source source = {compute ? NULL : "screen.vert", compute ? "march.comp" : "march.frag",
                                              breaks[i].define, "integrator.glsl=integrate_table.glsl", NULL};
            GLuint program;
            tc_error err = {0};
            assert_int_equal(tc_program_get(&program, one.cache, &source, &err), TC_E_GL);
            char expected[96];
            snprintf(expected, sizeof expected, "shader %s:%d:", breaks[i].file, line_of(breaks[i].file, breaks[i].at));
            if (!strstr(err.text, expected))
                fail_msg("no \"%s\" in: %s", expected, err.text);
        }
        close_fixture(&one);
    }
    if (!any)
        skip();
}

/* A job's features as bits. */
enum {
    IMAGINARY = 1,
    PEEL = 2,
    CELLS = 4,
    INSIDE = 8,
    COUNT = 16,
    TABLE = 32,
    EXTEND = 64,
    FAR = 128,
    MISSING = 256,
    N_FEATURES = 512
};

static tc_frame frame_of(int features)
{
    return (tc_frame){.clip_near = features & INSIDE, .clip_far = features & FAR, .ahead = !(features & INSIDE)};
}

static tc_job job_of(int features, const tc_frame *frame)
{
    return (tc_job){.frame = frame,
                    .integrator = features & TABLE ? TC_INTEGRATOR_TABLE : TC_INTEGRATOR_INTEGRAL,
                    .has_imaginary = features & IMAGINARY,
                    .peel = features & PEEL,
                    .cell_data = features & CELLS,
                    .extend = features & EXTEND,
                    .nonfinite = features & MISSING,
                    .has_nan_color = (features & MISSING) && (features & CELLS), /* asked for, too */
                    .count = features & COUNT};
}

static GLuint get_source(tc_program_cache *cache, const tc_program_source *source)
{
    GLuint program;
    tc_error err = {0};
    if (tc_program_get(&program, cache, source, &err) != TC_OK)
        fail_msg("%s with\n%s: %s", source->fragment, source->defines, err.text);
    return program;
}

static GLuint get(tc_program_cache *cache, const char *vertex, const char *fragment, const tc_job *job)
{
    char defines[512], alias[128];
    tc_job_defines(defines, sizeof defines, job);
    snprintf(alias, sizeof alias, "integrator.glsl=integrate_%s.glsl%s",
             job->drift                               ? "drift"
             : job->integrator == TC_INTEGRATOR_TABLE ? "table"
             : job->integrator == TC_INTEGRATOR_EXACT ? "exact"
                                                      : "integral",
             job->planes ? " stepper.glsl=stepper_planes.glsl" : "");
    return get_source(cache, &(tc_program_source){vertex, fragment, defines, alias, NULL});
}

static void expect_uniform(const tc_gl *gl, GLuint program, const char *name, bool expected, int features)
{
    bool there = gl->GetUniformLocation(program, name) >= 0;
    if (there != expected)
        fail_msg("%s is %s a program with features %d", name, there ? "in" : "missing from", features);
}

/* Of a program that walks rays. */
static void expect_march(const tc_gl *gl, GLuint march, int f)
{
    expect_uniform(gl, march, "mesh_real", f & IMAGINARY, f);
    expect_uniform(gl, march, "mesh_cell_scalar", f & CELLS, f);
    expect_uniform(gl, march, "state_steps", f & COUNT, f);
    expect_uniform(gl, march, "tf_table", f & TABLE, f);
    expect_uniform(gl, march, "tf_nodes", !(f & TABLE), f);
    expect_uniform(gl, march, "peel_key", false, f);
    expect_uniform(gl, march, "nan_color", (f & MISSING) && (f & CELLS), f);
    expect_uniform(gl, march, "ray_near", f & INSIDE, f);
    expect_uniform(gl, march, "ray_far", f & FAR, f);
    expect_uniform(gl, march, "sample_mask", false, f);
}

static void a_program_holds_what_its_scene_does_not_need(void **state)
{
    (void)state;
    fixture o = open_any();
    const tc_gl *gl = &o.context->gl;
    static const int each[] = {0,
                               IMAGINARY,
                               PEEL,
                               CELLS,
                               INSIDE,
                               FAR,
                               INSIDE | FAR,
                               MISSING,
                               MISSING | CELLS,
                               MISSING | CELLS | TABLE,
                               COUNT,
                               TABLE,
                               TABLE | EXTEND,
                               EXTEND,
                               IMAGINARY | CELLS | INSIDE | COUNT,
                               PEEL | CELLS | TABLE | COUNT,
                               N_FEATURES - 1};
    for (size_t i = 0; i < sizeof each / sizeof *each; i++) {
        int f = each[i];
        tc_frame frame = frame_of(f);
        tc_job job = job_of(f, &frame);
        GLuint march = get(o.cache, "screen.vert", "march.frag", &job);
        GLuint compute = get(o.cache, NULL, "march.comp", &job);
        expect_march(gl, march, f);
        expect_march(gl, compute, f);
        expect_uniform(gl, compute, "out_steps", f & COUNT, f);
        assert_int_equal(get(o.cache, NULL, "march.comp", &job), compute);
        GLuint first = get(o.cache, "first_hit.vert", "first_hit.frag", &job);
        expect_uniform(gl, first, "sample_mask", false, f);
        expect_uniform(gl, first, "peel_key", f & PEEL, f);
        expect_uniform(gl, first, "ray_near", !(f & INSIDE), f); /* entries behind an eye outside */
        expect_uniform(gl, first, "ray_far", f & FAR, f);
        expect_uniform(gl, first, "mesh_real", false, f);
        expect_uniform(gl, first, "tf_table", false, f);
        expect_uniform(gl, first, "tf_nodes", false, f);
        assert_int_equal(get(o.cache, "screen.vert", "march.frag", &job), march); /* equal text, the same program */
        get(o.cache, "screen.vert", "resolve.frag", &job);
    }
    close_fixture(&o);
}

/* The paper's table needs no means of the function, that of the colour's drift needs them, and steps only where there
 * are some. */
static void a_table_fetches_what_the_other_kind_has(void **state)
{
    (void)state;
    fixture o = open_any();
    const tc_gl *gl = &o.context->gl;
    for (int f = 0; f < N_FEATURES; f += 13) {
        tc_frame frame = frame_of(f);
        tc_job job = job_of(f | TABLE, &frame);
        char defines[512];
        GLuint paper = get(o.cache, "screen.vert", "march.frag", &job);
        expect_uniform(gl, paper, "tf_table", true, f);
        expect_uniform(gl, paper, "tf_cells", false, f);
        job.drift = true;
        tc_job_defines(defines, sizeof defines, &job);
        assert_int_equal(count(defines, "COLOR_HOLDS_DEPTH"), 1);
        assert_int_equal(count(defines, "TF_STEPS"), 0);
        GLuint drift = get(o.cache, "screen.vert", "march.frag", &job);
        expect_uniform(gl, drift, "tf_table", true, f);
        expect_uniform(gl, drift, "tf_cells", true, f);
        expect_uniform(gl, drift, "tf_nodes", false, f);
        job.steps = job.software = true;
        tc_job_defines(defines, sizeof defines, &job);
        assert_int_equal(count(defines, "TF_STEPS"), 1);
        assert_int_not_equal(get(o.cache, "screen.vert", "march.frag", &job), drift);
    }
    close_fixture(&o);
}

/* Either stepper's program holds nothing of the other's. */
static void the_paper_s_stepper_is_where_it_is_not_asked_for(void **state)
{
    (void)state;
    static const char *const textures[] = {"planes_vertices", "planes_normals", "planes_neighbours", "planes_scalars"};
    static const char both[] = "integrator.glsl=integrate_table.glsl stepper.glsl=stepper_planes.glsl";
    char *text;
    assert_int_equal(tc_program_text(&text, "march.frag", "", both, NULL, NULL), TC_OK);
    assert_int_equal(count(text, "Segment walk_step("), 1);
    assert_int_equal(count(text, "uniform sampler3D tf_table"), 1);
    assert_int_equal(count(text, "sign_cross"), 0);
    assert_true(count(text, "planes_normals") > 0);
    free(text);
    assert_int_equal(tc_program_text(&text, "march.frag", "", "integrator.glsl=integrate_table.glsl", NULL, NULL), TC_OK);
    assert_int_equal(count(text, "planes_"), 0);
    free(text);

    fixture o = open_any();
    const tc_gl *gl = &o.context->gl;
    for (int f = 0; f < N_FEATURES; f += 13) {
        tc_frame frame = frame_of(f);
        tc_job job = job_of(f, &frame);
        GLuint signs = get(o.cache, "screen.vert", "march.frag", &job);
        GLuint first = get(o.cache, "first_hit.vert", "first_hit.frag", &job);
        job.planes = true;
        GLuint planes = get(o.cache, "screen.vert", "march.frag", &job);
        for (size_t i = 0; i < sizeof textures / sizeof *textures; i++) {
            expect_uniform(gl, signs, textures[i], false, f);
            expect_uniform(gl, first, textures[i], false, f);
            expect_uniform(gl, planes, textures[i], true, f);
        }
        expect_uniform(gl, signs, "mesh_cells", true, f);
        expect_uniform(gl, first, "mesh_cells", false, f); /* so that a scene with planes needs no records */
        expect_uniform(gl, planes, "mesh_cells", false, f);
        job.nonfinite = job.has_nan_color = job.audit = job.count = job.software = true;
        get(o.cache, "screen.vert", "march.frag", &job);
    }
    get(o.cache, "screen.vert", "lost.frag", &(tc_job){.frame = &(tc_frame){.ahead = true}});
    close_fixture(&o);
}

/* Only the first hits of marked pixels know of marks, and what geometry they see. */
static void marks_are_read_where_every_pixel_has_a_ray(void **state)
{
    (void)state;
    const tc_frame frame = {.clip_near = true, .clip_far = true};
    char defines[512];
    tc_job job = job_of(N_FEATURES - 1, &frame);
    for (int masked = 0; masked < 2; masked++) {
        job.masked = masked;
        tc_job_defines(defines, sizeof defines, &job);
        assert_int_equal(count(defines, "SAMPLE_MASK"), 0);
        tc_first_hit_defines(defines, sizeof defines, &job);
        assert_int_equal(count(defines, "#define SAMPLE_MASK\n"), masked);
    }
    for (const tc_shader_file *f = tc_shader_files; f->name; f++)
        if (strcmp(f->name, "first_hit.frag") != 0 && strcmp(f->name, "effects/geometry_order.frag") != 0 &&
            (strstr(f->text, "SAMPLE_MASK") || strstr(f->text, "sample_mask")))
            fail_msg("%s knows of marks", f->name);
    fixture o = open_any();
    for (int peel = 0; peel < 2; peel++) {
        const tc_program_source source = {"first_hit.vert", "first_hit.frag",
                                          peel ? "#define SAMPLE_MASK\n#define PEEL\n" : "#define SAMPLE_MASK\n", NULL, NULL};
        expect_uniform(&o.context->gl, get_source(o.cache, &source), "sample_mask", true, peel);
    }
    close_fixture(&o);
}

static void a_plain_scene_defines_anything(void **state)
{
    (void)state;
    const tc_frame outside = {.clip_near = false}, inside = {.clip_near = true, .clip_far = true};
    char defines[512];
    tc_job job = job_of(TABLE, &outside);
    tc_job_defines(defines, sizeof defines, &job);
    assert_string_equal(defines, "");
    job = job_of(N_FEATURES - 1, &inside);
    tc_job_defines(defines, sizeof defines, &job);
    static const char *const all[] = {"HAS_IMAGINARY", "PEEL", "CELL_DATA", "CLIP_NEAR", "CLIP_FAR", "COUNT"};
    for (int i = 0; i < 6; i++)
        assert_int_equal(count(defines, all[i]), 1);
}

static void some_shader_does_not_compile(void **state)
{
    (void)state;
    fixture o = open_any();
    const tc_gl *gl = &o.context->gl;
    for (int f = 0; f < N_FEATURES; f += 13) { /* odd steps meet every pair of features */
        tc_frame frame = frame_of(f);
        for (int way = 0; way < 4; way++) {
            tc_job job = job_of(f, &frame);
            if (way & 1 && job.integrator == TC_INTEGRATOR_INTEGRAL)
                job.integrator = TC_INTEGRATOR_EXACT;
            job.order = 1 + f % 2;
            job.split = f % 3 ? 0.5 : 0;
            job.hard = f % 5 < 3 ? 1e-3 : 0;
            job.dense = f % 2;
            job.twice = f % 3 == 0 && job.integrator == TC_INTEGRATOR_EXACT;
            job.nonfinite = job.nonfinite || way & 1;
            job.software = way & 2;
            get(o.cache, "screen.vert", "march.frag", &job);
            get(o.cache, "first_hit.vert", "first_hit.frag", &job);
            if (f % 4 == way) { /* what it does not share with march.frag has one option */
                job.audit = job.count;
                get(o.cache, NULL, "march.comp", &job);
            }
        }
    }
    const tc_frame outside = {.clip_near = false};
    const tc_job none = {.frame = &outside};
    get(o.cache, "screen.vert", "lock.frag", &none);
    get(o.cache, "screen.vert", "copy.frag", &none);
    get(o.cache, "screen.vert", "mask.frag", &none);
    get(o.cache, "screen.vert", "spread.frag", &none);
    static const char *const shares[] = {"#define SHARE\n", "#define SHARE\n#define COLOR_HOLDS_DEPTH\n"};
    for (int i = 0; i < 2; i++) {
        const tc_program_source source = {"screen.vert", "resolve.frag", shares[i], NULL, NULL};
        expect_uniform(gl, get_source(o.cache, &source), "share", true, i);
    }
    close_fixture(&o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_is_included_twice_or_not),
        cmocka_unit_test(missing_files_are_not_named),
        cmocka_unit_test(compilers_errors_name_another_line),
        cmocka_unit_test(a_program_holds_what_its_scene_does_not_need),
        cmocka_unit_test(a_table_fetches_what_the_other_kind_has),
        cmocka_unit_test(the_paper_s_stepper_is_where_it_is_not_asked_for),
        cmocka_unit_test(marks_are_read_where_every_pixel_has_a_ray),
        cmocka_unit_test(a_plain_scene_defines_anything),
        cmocka_unit_test(some_shader_does_not_compile),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
