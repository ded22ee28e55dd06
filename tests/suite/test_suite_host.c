/* test_suite_host.c: rendering into a GL context that the host owns: an OSMesa context made here, with state that a
 * careless renderer would trip over or leave changed. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "tetcast.h"

#include <GL/glcorearb.h>
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 96, HEIGHT = 64, SKIPPED = 77 };

/* The part of OSMesa's interface that is needed. */
typedef struct osmesa_context *OSMesaContext;
enum { FORMAT = 0x22, PROFILE = 0x33, CORE_PROFILE = 0x34, MAJOR = 0x36, MINOR = 0x37 };

static OSMesaContext (*create_context)(const int *attributes, OSMesaContext share);
static GLboolean (*make_current)(OSMesaContext context, void *buffer, GLenum type, GLsizei width, GLsizei height);
static void (*destroy_context)(OSMesaContext context);
static void *(*get_proc)(const char *name);

#define FUNCTIONS(X)                                                                                                   \
    X(PFNGLGENTEXTURESPROC, GenTextures)                                                                               \
    X(PFNGLDELETETEXTURESPROC, DeleteTextures)                                                                         \
    X(PFNGLBINDTEXTUREPROC, BindTexture)                                                                               \
    X(PFNGLTEXIMAGE2DPROC, TexImage2D)                                                                                 \
    X(PFNGLACTIVETEXTUREPROC, ActiveTexture)                                                                           \
    X(PFNGLGENSAMPLERSPROC, GenSamplers)                                                                               \
    X(PFNGLDELETESAMPLERSPROC, DeleteSamplers)                                                                         \
    X(PFNGLBINDSAMPLERPROC, BindSampler)                                                                               \
    X(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers)                                                                       \
    X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)                                                                 \
    X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                                                                       \
    X(PFNGLFRAMEBUFFERTEXTUREPROC, FramebufferTexture)                                                                 \
    X(PFNGLCLEARBUFFERFVPROC, ClearBufferfv)                                                                           \
    X(PFNGLREADPIXELSPROC, ReadPixels)                                                                                 \
    X(PFNGLPIXELSTOREIPROC, PixelStorei)                                                                               \
    X(PFNGLGENBUFFERSPROC, GenBuffers)                                                                                 \
    X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                                                                           \
    X(PFNGLBINDBUFFERBASEPROC, BindBufferBase)                                                                         \
    X(PFNGLBINDBUFFERRANGEPROC, BindBufferRange)                                                                       \
    X(PFNGLGETINTEGER64I_VPROC, GetInteger64i_v)                                                                       \
    X(PFNGLBINDBUFFERPROC, BindBuffer)                                                                                 \
    X(PFNGLBUFFERDATAPROC, BufferData)                                                                                 \
    X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)                                                                       \
    X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)                                                                 \
    X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                                                                       \
    X(PFNGLVIEWPORTPROC, Viewport)                                                                                     \
    X(PFNGLSCISSORPROC, Scissor)                                                                                       \
    X(PFNGLENABLEPROC, Enable)                                                                                         \
    X(PFNGLDISABLEPROC, Disable)                                                                                       \
    X(PFNGLISENABLEDPROC, IsEnabled)                                                                                   \
    X(PFNGLBLENDFUNCSEPARATEPROC, BlendFuncSeparate)                                                                   \
    X(PFNGLBLENDEQUATIONSEPARATEPROC, BlendEquationSeparate)                                                           \
    X(PFNGLDEPTHFUNCPROC, DepthFunc)                                                                                   \
    X(PFNGLDEPTHMASKPROC, DepthMask)                                                                                   \
    X(PFNGLDEPTHRANGEPROC, DepthRange)                                                                                 \
    X(PFNGLCOLORMASKPROC, ColorMask)                                                                                   \
    X(PFNGLPOLYGONMODEPROC, PolygonMode)                                                                               \
    X(PFNGLCULLFACEPROC, CullFace)                                                                                     \
    X(PFNGLGETINTEGERVPROC, GetIntegerv)                                                                               \
    X(PFNGLGETBOOLEANVPROC, GetBooleanv)                                                                               \
    X(PFNGLGETFLOATVPROC, GetFloatv)                                                                                   \
    X(PFNGLBINDIMAGETEXTUREPROC, BindImageTexture)                                                                     \
    X(PFNGLGETINTEGERI_VPROC, GetIntegeri_v)                                                                           \
    X(PFNGLGETERRORPROC, GetError)

static struct {
#define X(type, name) type name;
    FUNCTIONS(X)
#undef X
} gl;

typedef struct scene {
    OSMesaContext context;
    tc_mesh *mesh;
    tc_transfer *tf;
    tc_camera camera;
    tc_render_options options;
    tc_image *picture, *table; /* by tc_render in a context of the library's own, by either integrator */
    GLuint target, framebuffer;
    unsigned char window[4];
} scene;

static bool load(void *library, const char *name, void *function)
{
    void *p = dlsym(library, name);
    memcpy(function, &p, sizeof p);
    return p != NULL;
}

static bool find_osmesa(void)
{
    void *library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    return library && load(library, "OSMesaCreateContextAttribs", &create_context) &&
           load(library, "OSMesaMakeCurrent", &make_current) &&
           load(library, "OSMesaDestroyContext", &destroy_context) && load(library, "OSMesaGetProcAddress", &get_proc);
}

static void enter(scene *s)
{
    assert_true(make_current(s->context, s->window, GL_UNSIGNED_BYTE, 1, 1));
}

static tc_render_options table_options(const scene *s)
{
    tc_render_options options = s->options;
    options.integrator = TC_INTEGRATOR_TABLE;
    for (int k = 0; k < 3; k++)
        options.table_size[k] = 30 + k; /* the images of a 3-D texture are no square */
    return options;
}

static int set_up(void **state)
{
    scene *s = calloc(1, sizeof *s);
    assert_non_null(s);
    *state = s;
    const tc_prepare_options peel = {.reentry = TC_REENTRY_PEEL};
    tc_error err = {0};
    if (tc_synth_create(&s->mesh, "heatsink", 5000, 1, &err) != TC_OK ||
        tc_mesh_prepare(s->mesh, &peel, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_mesh_report report;
    tc_mesh_get_report(&report, s->mesh);
    const tc_transfer_options function = {.opacity = "linear",
                                          .data_range = {report.scalar_range[0], report.scalar_range[1]}};
    assert_int_equal(tc_transfer_create(&s->tf, &function, &err), TC_OK);
    const double direction[3] = {0.4, 0.5, 1}, up[3] = {0, 1, 0};
    tc_camera_reset(&s->camera, report.bounds, direction, up, 30, (double)WIDTH / HEIGHT);
    tc_render_defaults(&s->options);
    s->options.width = WIDTH;
    s->options.height = HEIGHT;
    tc_renderer *own;
    const tc_renderer_options osmesa = {.gl = "osmesa", .driver = "pingpong"};
    if (tc_renderer_create(&own, &osmesa, NULL, &err) != TC_OK ||
        tc_render(&s->picture, NULL, own, s->mesh, s->tf, &s->camera, &s->options, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_render_options table = table_options(s);
    if (tc_render(&s->table, NULL, own, s->mesh, s->tf, &s->camera, &table, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_renderer_destroy(&own);

    const int attributes[] = {FORMAT, GL_RGBA, PROFILE, CORE_PROFILE, MAJOR, 4, MINOR, 5, 0};
    s->context = create_context(attributes, NULL);
    assert_non_null(s->context);
    enter(s);
#define X(type, name)                                                                                                  \
    {                                                                                                                  \
        void *p = get_proc("gl" #name);                                                                                \
        assert_non_null(p);                                                                                            \
        memcpy(&gl.name, &p, sizeof p);                                                                                \
    }
    FUNCTIONS(X)
#undef X
    gl.GenTextures(1, &s->target);
    gl.BindTexture(GL_TEXTURE_2D, s->target);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, WIDTH, HEIGHT, 0, GL_RGBA, GL_FLOAT, NULL);
    gl.BindTexture(GL_TEXTURE_2D, 0);
    gl.GenFramebuffers(1, &s->framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, s->framebuffer);
    gl.FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, s->target, 0);
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    assert_int_equal(gl.GetError(), GL_NO_ERROR);
    return 0;
}

static int tear_down(void **state)
{
    scene *s = *state;
    gl.DeleteFramebuffers(1, &s->framebuffer);
    gl.DeleteTextures(1, &s->target);
    destroy_context(s->context);
    tc_image_destroy(&s->picture);
    tc_image_destroy(&s->table);
    tc_transfer_destroy(&s->tf);
    tc_mesh_destroy(&s->mesh);
    free(s);
    return 0;
}

static const float background[4] = {0.2f, 0.4f, 0.1f, 0.5f};

static void clear_target(const scene *s)
{
    gl.BindFramebuffer(GL_FRAMEBUFFER, s->framebuffer);
    gl.ClearBufferfv(GL_COLOR, 0, background);
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
}

static const char *driver; /* of host_renderer */

static tc_renderer *host_renderer(void)
{
    tc_renderer *renderer;
    const tc_renderer_options options = {.driver = driver, .get_proc_address = get_proc};
    tc_error err = {0};
    if (tc_renderer_create(&renderer, &options, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    return renderer;
}

static void draw(scene *s, tc_renderer *renderer)
{
    tc_render_stats stats;
    tc_error err = {0};
    if (tc_render_gl(s->framebuffer, &stats, renderer, s->mesh, s->tf, &s->camera, &s->options, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    assert_string_equal(stats.context, "host");
    assert_int_equal(stats.rays_lost, 0);
}

/* The largest difference between the target and the picture over the background. */
static double measure_error(const scene *s, const tc_image *picture)
{
    static float rgba[HEIGHT][WIDTH][4];
    double worst = 0;
    gl.BindFramebuffer(GL_FRAMEBUFFER, s->framebuffer);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.ReadPixels(0, 0, WIDTH, HEIGHT, GL_RGBA, GL_FLOAT, rgba);
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    assert_int_equal(gl.GetError(), GL_NO_ERROR);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const float *p = picture->rgba + 4 * ((HEIGHT - 1 - y) * WIDTH + x); /* GL's row 0 is at the bottom */
            for (int c = 0; c < 4; c++) {
                double expected = (double)p[c] + (1 - (double)p[3]) * (double)background[c];
                double error = fabs((double)rgba[y][x][c] - expected);
                worst = error <= worst ? worst : isfinite(error) ? error : HUGE_VAL;
            }
        }
    return worst;
}

static void picture_in_the_hosts_framebuffer_is_another(void **state)
{
    scene *s = *state;
    enter(s);
    tc_renderer *renderer = host_renderer();
    for (int frame = 0; frame < 2; frame++) {
        clear_target(s);
        draw(s, renderer);
        assert_true(measure_error(s, s->picture) <= 1e-6);
    }
    tc_renderer_destroy(&renderer);
}

/* Several rays a pixel are added up in the library's own textures, not in the host's. */
static void several_rays_in_the_hosts_framebuffer_make_another_picture(void **state)
{
    static const int samples[] = {4, TC_SAMPLES_ADAPTIVE, 16};
    scene *s = *state;
    tc_renderer *own;
    const tc_renderer_options osmesa = {.gl = "osmesa", .driver = "pingpong"};
    tc_error err = {0};
    if (tc_renderer_create(&own, &osmesa, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_image *picture[3];
    tc_render_options options = s->options;
    for (int i = 0; i < 3; i++) {
        options.samples = samples[i];
        if (tc_render(&picture[i], NULL, own, s->mesh, s->tf, &s->camera, &options, NULL, &err) != TC_OK)
            fail_msg("%s", err.text);
    }
    tc_renderer_destroy(&own);
    enter(s);
    tc_renderer *renderer = host_renderer();
    for (int i = 0; i < 3; i++) {
        tc_render_stats stats;
        options.samples = samples[i];
        clear_target(s);
        if (tc_render_gl(s->framebuffer, &stats, renderer, s->mesh, s->tf, &s->camera, &options, NULL, &err) != TC_OK)
            fail_msg("%s", err.text);
        assert_int_equal(stats.samples, samples[i]);
        assert_true(measure_error(s, picture[i]) <= 1e-6);
        assert_true(measure_error(s, s->picture) > 0.01);
    }
    tc_renderer_destroy(&renderer);
    for (int i = 0; i < 3; i++)
        tc_image_destroy(&picture[i]);
}

/* State of a host that a renderer may have to keep; each query's values one after another. */
static const struct {
    GLenum name;
    int n;
    const char *text;
} queries[] = {
#define Q(name, n)                                                                                                     \
    {                                                                                                                  \
        name, n, #name                                                                                                 \
    }
    Q(GL_DRAW_FRAMEBUFFER_BINDING, 1),
    Q(GL_READ_FRAMEBUFFER_BINDING, 1),
    Q(GL_CURRENT_PROGRAM, 1),
    Q(GL_VERTEX_ARRAY_BINDING, 1),
    Q(GL_ARRAY_BUFFER_BINDING, 1),
    Q(GL_TEXTURE_BUFFER_BINDING, 1),
    Q(GL_RENDERBUFFER_BINDING, 1),
    Q(GL_PIXEL_PACK_BUFFER_BINDING, 1),
    Q(GL_PIXEL_UNPACK_BUFFER_BINDING, 1),
    Q(GL_ACTIVE_TEXTURE, 1),
    Q(GL_VIEWPORT, 4),
    Q(GL_SCISSOR_BOX, 4),
    Q(GL_DEPTH_FUNC, 1),
    Q(GL_DEPTH_WRITEMASK, 1),
    Q(GL_COLOR_WRITEMASK, 4),
    Q(GL_BLEND_SRC_RGB, 1),
    Q(GL_BLEND_DST_RGB, 1),
    Q(GL_BLEND_SRC_ALPHA, 1),
    Q(GL_BLEND_DST_ALPHA, 1),
    Q(GL_BLEND_EQUATION_RGB, 1),
    Q(GL_BLEND_EQUATION_ALPHA, 1),
    Q(GL_POLYGON_MODE, 2),
    Q(GL_CULL_FACE_MODE, 1),
    Q(GL_PACK_ALIGNMENT, 1),
    Q(GL_PACK_ROW_LENGTH, 1),
    Q(GL_PACK_SKIP_ROWS, 1),
    Q(GL_PACK_SKIP_PIXELS, 1),
    Q(GL_PACK_SWAP_BYTES, 1),
    Q(GL_UNPACK_ALIGNMENT, 1),
    Q(GL_UNPACK_ROW_LENGTH, 1),
    Q(GL_UNPACK_SKIP_PIXELS, 1),
    Q(GL_UNPACK_SKIP_ROWS, 1),
    Q(GL_UNPACK_SKIP_IMAGES, 1),
    Q(GL_UNPACK_IMAGE_HEIGHT, 1),
    Q(GL_UNPACK_SWAP_BYTES, 1),
#undef Q
};
enum { N_QUERY = sizeof queries / sizeof *queries, N_UNIT = 20, N_IMAGE = 16 };

static const struct {
    GLenum name;
    const char *text;
} switches[] = {
#define S(name)                                                                                                        \
    {                                                                                                                  \
        name, #name                                                                                                    \
    }
    S(GL_BLEND),
    S(GL_DEPTH_TEST),
    S(GL_SCISSOR_TEST),
    S(GL_CULL_FACE),
    S(GL_STENCIL_TEST),
    S(GL_COLOR_LOGIC_OP),
    S(GL_RASTERIZER_DISCARD),
    S(GL_FRAMEBUFFER_SRGB),
    S(GL_DEPTH_CLAMP),
    S(GL_PRIMITIVE_RESTART),
    S(GL_POLYGON_OFFSET_FILL),
    S(GL_CLIP_DISTANCE0),
    S(GL_CLIP_DISTANCE6),
    S(GL_CLIP_DISTANCE7),
    S(GL_SAMPLE_MASK),
    S(GL_SAMPLE_COVERAGE),
    S(GL_SAMPLE_ALPHA_TO_COVERAGE),
    S(GL_SAMPLE_ALPHA_TO_ONE),
#undef S
};
enum { N_SWITCH = sizeof switches / sizeof *switches };

/* Buffers at numbered bindings. */
static const struct {
    GLenum target, general, start, size;
} indexed[] = {{GL_ATOMIC_COUNTER_BUFFER, GL_ATOMIC_COUNTER_BUFFER_BINDING, GL_ATOMIC_COUNTER_BUFFER_START,
                GL_ATOMIC_COUNTER_BUFFER_SIZE},
               {GL_SHADER_STORAGE_BUFFER, GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                GL_SHADER_STORAGE_BUFFER_SIZE}};
enum { N_INDEXED = sizeof indexed / sizeof *indexed };

typedef struct state_of_gl {
    GLint64 bound[N_INDEXED][4]; /* in general; at 0, from where, how much */
    GLint value[N_QUERY][4], texture[N_UNIT][4], sampler[N_UNIT], image[N_IMAGE][2];
    GLboolean on[N_SWITCH];
    GLfloat depth_range[2];
} state_of_gl;

static void take_state(state_of_gl *s)
{
    memset(s, 0, sizeof *s);
    for (int i = 0; i < N_QUERY; i++)
        gl.GetIntegerv(queries[i].name, s->value[i]);
    for (int i = 0; i < N_SWITCH; i++)
        s->on[i] = gl.IsEnabled(switches[i].name);
    gl.GetFloatv(GL_DEPTH_RANGE, s->depth_range);
    GLint active;
    gl.GetIntegerv(GL_ACTIVE_TEXTURE, &active);
    for (int i = 0; i < N_UNIT; i++) {
        gl.ActiveTexture(GL_TEXTURE0 + (GLenum)i);
        gl.GetIntegerv(GL_TEXTURE_BINDING_1D, &s->texture[i][0]);
        gl.GetIntegerv(GL_TEXTURE_BINDING_2D, &s->texture[i][1]);
        gl.GetIntegerv(GL_TEXTURE_BINDING_3D, &s->texture[i][2]);
        gl.GetIntegerv(GL_TEXTURE_BINDING_BUFFER, &s->texture[i][3]);
        gl.GetIntegerv(GL_SAMPLER_BINDING, &s->sampler[i]);
    }
    gl.ActiveTexture((GLenum)active);
    for (int i = 0; i < N_INDEXED; i++) {
        GLint general, first;
        gl.GetIntegerv(indexed[i].general, &general);
        gl.GetIntegeri_v(indexed[i].general, 0, &first);
        s->bound[i][0] = general;
        s->bound[i][1] = first;
        gl.GetInteger64i_v(indexed[i].start, 0, &s->bound[i][2]);
        gl.GetInteger64i_v(indexed[i].size, 0, &s->bound[i][3]);
    }
    for (GLuint i = 0; i < N_IMAGE; i++) {
        gl.GetIntegeri_v(GL_IMAGE_BINDING_NAME, i, &s->image[i][0]);
        gl.GetIntegeri_v(GL_IMAGE_BINDING_FORMAT, i, &s->image[i][1]);
    }
    assert_int_equal(gl.GetError(), GL_NO_ERROR);
}

/* Says everything that differs; how much that is. */
static int differences(const state_of_gl *before, const state_of_gl *after)
{
    int wrong = 0;
    for (int i = 0; i < N_QUERY; i++)
        if (memcmp(before->value[i], after->value[i], sizeof before->value[i]) != 0) {
            printf("    %s was %d and is %d\n", queries[i].text, before->value[i][0], after->value[i][0]);
            wrong++;
        }
    for (int i = 0; i < N_SWITCH; i++)
        if (before->on[i] != after->on[i]) {
            printf("    %s was %d and is %d\n", switches[i].text, before->on[i], after->on[i]);
            wrong++;
        }
    if (memcmp(before->depth_range, after->depth_range, sizeof before->depth_range) != 0) {
        printf("    the depth range was %g %g and is %g %g\n", (double)before->depth_range[0],
               (double)before->depth_range[1], (double)after->depth_range[0], (double)after->depth_range[1]);
        wrong++;
    }
    for (int i = 0; i < N_INDEXED; i++)
        if (memcmp(before->bound[i], after->bound[i], sizeof before->bound[i]) != 0) {
            printf("    the buffers of binding %d of target %#x are others\n", 0, indexed[i].target);
            wrong++;
        }
    for (int i = 0; i < N_UNIT; i++)
        if (memcmp(before->texture[i], after->texture[i], sizeof before->texture[i]) != 0 ||
            before->sampler[i] != after->sampler[i]) {
            printf("    texture unit %d holds other textures or another sampler\n", i);
            wrong++;
        }
    for (int i = 0; i < N_IMAGE; i++)
        if (memcmp(before->image[i], after->image[i], sizeof before->image[i]) != 0) {
            printf("    image unit %d was %d and is %d\n", i, before->image[i][0], after->image[i][0]);
            wrong++;
        }
    return wrong;
}

/* How pixels lie in memory, other than the default. */
static const struct {
    GLenum name;
    GLint upset, calm;
} stores[] = {
    {GL_PACK_ALIGNMENT, 8, 4},     {GL_PACK_ROW_LENGTH, 200, 0},    {GL_PACK_SKIP_ROWS, 1, 0},
    {GL_PACK_SKIP_PIXELS, 2, 0},   {GL_PACK_SWAP_BYTES, 1, 0},      {GL_UNPACK_ALIGNMENT, 1, 4},
    {GL_UNPACK_ROW_LENGTH, 71, 0}, {GL_UNPACK_SKIP_ROWS, 2, 0},     {GL_UNPACK_SKIP_PIXELS, 3, 0},
    {GL_UNPACK_SKIP_IMAGES, 1, 0}, {GL_UNPACK_IMAGE_HEIGHT, 50, 0}, {GL_UNPACK_SWAP_BYTES, 1, 0},
};
enum { N_STORE = sizeof stores / sizeof *stores };

static const GLenum odd_switches[] = {GL_CLIP_DISTANCE0,  GL_CLIP_DISTANCE6,           GL_CLIP_DISTANCE7,
                                      GL_SAMPLE_COVERAGE, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_ALPHA_TO_ONE};
enum { N_ODD = sizeof odd_switches / sizeof *odd_switches };

/* Sets about everything to other than the default, within what a host may reasonably do. */
static void upset(GLuint texture, GLuint sampler, GLuint buffer, GLuint vertex_array, GLuint framebuffer)
{
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.BindVertexArray(vertex_array);
    gl.BindBuffer(GL_ARRAY_BUFFER, buffer);
    for (int i = 0; i < N_UNIT; i++) {
        gl.ActiveTexture(GL_TEXTURE0 + (GLenum)i);
        gl.BindTexture(GL_TEXTURE_2D, texture);
        gl.BindSampler((GLuint)i, sampler);
    }
    for (GLuint i = 0; i < N_IMAGE; i++)
        gl.BindImageTexture(i, texture, 0, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA8);
    for (int i = 0; i < N_INDEXED; i++)
        gl.BindBufferRange(indexed[i].target, 0, buffer, 256, 1024);
    gl.ActiveTexture(GL_TEXTURE5);
    gl.Viewport(3, 4, 5, 6);
    gl.Scissor(10, 11, 12, 13);
    gl.Enable(GL_SCISSOR_TEST);
    gl.Enable(GL_BLEND);
    gl.BlendFuncSeparate(GL_DST_COLOR, GL_ONE, GL_ZERO, GL_DST_ALPHA);
    gl.BlendEquationSeparate(GL_FUNC_SUBTRACT, GL_MAX);
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_NEVER);
    gl.DepthMask(GL_FALSE);
    gl.DepthRange(0.25, 0.75);
    gl.ColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_FALSE);
    gl.Enable(GL_CULL_FACE);
    gl.CullFace(GL_FRONT_AND_BACK);
    for (int i = 0; i < N_STORE; i++)
        gl.PixelStorei(stores[i].name, stores[i].upset);
    for (int i = 0; i < N_ODD; i++)
        gl.Enable(odd_switches[i]);
}

static void calm(void)
{
    static const GLenum off[] = {GL_SCISSOR_TEST,       GL_BLEND,         GL_DEPTH_TEST, GL_CULL_FACE,
                                 GL_RASTERIZER_DISCARD, GL_COLOR_LOGIC_OP};
    for (size_t i = 0; i < sizeof off / sizeof *off; i++)
        gl.Disable(off[i]);
    gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl.DepthMask(GL_TRUE);
    gl.DepthFunc(GL_LESS);
    gl.DepthRange(0, 1);
    gl.BlendFuncSeparate(GL_ONE, GL_ZERO, GL_ONE, GL_ZERO);
    gl.BlendEquationSeparate(GL_FUNC_ADD, GL_FUNC_ADD);
    gl.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    gl.CullFace(GL_BACK);
    for (int i = 0; i < N_STORE; i++)
        gl.PixelStorei(stores[i].name, stores[i].calm);
    for (int i = 0; i < N_ODD; i++)
        gl.Disable(odd_switches[i]);
    gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    gl.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    gl.BindBuffer(GL_ARRAY_BUFFER, 0);
    for (int i = 0; i < N_INDEXED; i++)
        gl.BindBufferBase(indexed[i].target, 0, 0);
    gl.BindVertexArray(0);
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    for (int i = 0; i < N_UNIT; i++) {
        gl.ActiveTexture(GL_TEXTURE0 + (GLenum)i);
        gl.BindTexture(GL_TEXTURE_2D, 0);
        gl.BindSampler((GLuint)i, 0);
    }
}

typedef struct objects {
    GLuint texture, sampler, buffer, vertex_array, framebuffer;
} objects;

static objects make_objects(void)
{
    objects o;
    gl.GenTextures(1, &o.texture);
    gl.BindTexture(GL_TEXTURE_2D, o.texture);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    gl.GenSamplers(1, &o.sampler);
    gl.GenBuffers(1, &o.buffer);
    gl.BindBuffer(GL_ARRAY_BUFFER, o.buffer);
    gl.BufferData(GL_ARRAY_BUFFER, 65536, NULL, GL_STATIC_DRAW);
    gl.GenVertexArrays(1, &o.vertex_array);
    gl.GenFramebuffers(1, &o.framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, o.framebuffer);
    gl.FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, o.texture, 0);
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    return o;
}

static void delete_objects(objects *o)
{
    calm();
    gl.DeleteFramebuffers(1, &o->framebuffer);
    gl.DeleteVertexArrays(1, &o->vertex_array);
    gl.DeleteBuffers(1, &o->buffer);
    gl.DeleteSamplers(1, &o->sampler);
    gl.DeleteTextures(1, &o->texture);
}

/* An image of geometry, opaque and not, whose lists take textures, images and a buffer of their own. */
static void draw_geometry(const scene *s, tc_renderer *renderer)
{
    tc_geometry g[2];
    tc_error err = {0};
    tc_image *image;
    for (int i = 0; i < 2; i++)
        if (tc_geometry_from_mesh(&g[i], s->mesh, i ? TC_PART_SURFACE : TC_PART_OUTLINE, &err) != TC_OK)
            fail_msg("%s", err.text);
    g[1].opacity = 0.5;
    const tc_look look = {.n_geometry = 2, .geometry = g};
    tc_render_options options = s->options;
    options.look = &look;
    options.integrator = TC_INTEGRATOR_AUTO;
    if (tc_render(&image, NULL, renderer, s->mesh, s->tf, &s->camera, &options, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_image_destroy(&image);
    tc_geometry_finish(&g[0]);
    tc_geometry_finish(&g[1]);
}

static void the_hosts_state_is_changed(void **state)
{
    scene *s = *state;
    enter(s);
    clear_target(s);
    objects o = make_objects();
    state_of_gl before, after;
    int wrong = 0;
    upset(o.texture, o.sampler, o.buffer, o.vertex_array, o.framebuffer);
    take_state(&before);
    tc_renderer *renderer = host_renderer();
    take_state(&after);
    printf("    making a renderer:\n");
    wrong += differences(&before, &after);
    for (int frame = 0; frame < 2; frame++) { /* uploading, then with everything there */
        upset(o.texture, o.sampler, o.buffer, o.vertex_array, o.framebuffer);
        take_state(&before);
        draw(s, renderer);
        take_state(&after);
        printf("    frame %d:\n", frame);
        wrong += differences(&before, &after);
    }
    for (int frame = 0; frame < 2; frame++) { /* to an image, by each integrator */
        tc_render_options options = frame ? table_options(s) : s->options;
        upset(o.texture, o.sampler, o.buffer, o.vertex_array, o.framebuffer);
        take_state(&before);
        tc_image *image;
        tc_error err = {0};
        if (tc_render(&image, NULL, renderer, s->mesh, s->tf, &s->camera, &options, NULL, &err) != TC_OK)
            fail_msg("%s", err.text);
        take_state(&after);
        printf("    image %d:\n", frame);
        wrong += differences(&before, &after);
        tc_compare_result compared;
        assert_int_equal(tc_image_compare(&compared, image, frame ? s->table : s->picture, NULL), TC_OK);
        if (!(compared.max_abs <= 1e-6)) {
            printf("    image %d differs by %.1e\n", frame, compared.max_abs);
            wrong++;
        }
        tc_image_destroy(&image);
    }
    upset(o.texture, o.sampler, o.buffer, o.vertex_array, o.framebuffer);
    take_state(&before);
    draw_geometry(s, renderer);
    take_state(&after);
    printf("    geometry:\n");
    wrong += differences(&before, &after);
    upset(o.texture, o.sampler, o.buffer, o.vertex_array, o.framebuffer);
    take_state(&before);
    tc_renderer_destroy(&renderer);
    take_state(&after);
    printf("    destroying it:\n");
    fflush(stdout);
    wrong += differences(&before, &after);
    assert_int_equal(wrong, 0);
    delete_objects(&o);
}

/* Each trap alone: what a host may have left switched on, and its name. */
static void set_trap(int trap, const objects *o)
{
    switch (trap) {
    case 0:
        upset(o->texture, o->sampler, o->buffer, o->vertex_array, o->framebuffer);
        break;
    case 1:
        gl.PolygonMode(GL_FRONT_AND_BACK, GL_LINE);
        break;
    case 2:
        gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, o->buffer);
        break;
    case 3:
        for (int i = 0; i < N_STORE; i++)
            gl.PixelStorei(stores[i].name, stores[i].upset);
        break;
    case 4:
        gl.Enable(GL_RASTERIZER_DISCARD);
        break;
    case 5:
        gl.Enable((GLenum)-1); /* an error that the host has not asked for yet */
        gl.BindTexture((GLenum)-1, 0);
        break;
    default:
        gl.Enable(GL_COLOR_LOGIC_OP);
        break;
    }
}

static void the_hosts_state_changes_the_picture(void **state)
{
    static const char *const traps[] = {"about everything",      "lines for polygons", "a pixel buffer",
                                        "how pixels are stored", "no rasterization",   "a pending error",
                                        "a logic operation"};
    scene *s = *state;
    enter(s);
    objects o = make_objects();
    int wrong = 0;
    for (int trial = 0; trial < 2 * 7; trial++) { /* by the default integrator, then by the table */
        const int trap = trial % 7;
        const bool table = trial >= 7;
        const tc_render_options options = table ? table_options(s) : s->options;
        calm();
        clear_target(s);
        tc_renderer *renderer = host_renderer();
        set_trap(trap, &o);
        tc_error err = {0};
        tc_status status =
            tc_render_gl(s->framebuffer, NULL, renderer, s->mesh, s->tf, &s->camera, &options, NULL, &err);
        calm();
        while (gl.GetError() != GL_NO_ERROR)
            ;
        double error = measure_error(s, table ? s->table : s->picture);
        printf("    %s%s: error %.1e %s\n", traps[trap], table ? ", table" : "", error, err.text);
        fflush(stdout);
        wrong += status != TC_OK || !(error <= 1e-6);
        tc_renderer_destroy(&renderer);
    }
    delete_objects(&o);
    assert_int_equal(wrong, 0);
}

static void a_renderer_without_gl_draws_into_a_host(void **state)
{
    scene *s = *state;
    tc_renderer *renderer = NULL;
    tc_error err = {0};
    const tc_renderer_options reference = {.driver = "reference", .get_proc_address = get_proc};
    assert_int_equal(tc_renderer_create(&renderer, &reference, NULL, &err), TC_E_ARG);
    assert_null(renderer);
    const tc_renderer_options cpu = {.driver = "reference"};
    assert_int_equal(tc_renderer_create(&renderer, &cpu, NULL, &err), TC_OK);
    assert_int_equal(tc_render_gl(s->framebuffer, NULL, renderer, s->mesh, s->tf, &s->camera, &s->options, NULL, &err),
                     TC_E_ARG);
    assert_non_null(strstr(err.text, "reference"));
    tc_renderer_destroy(&renderer);
}

static void *no_function(const char *name)
{
    (void)name;
    return NULL;
}

static void a_host_without_functions_is_believed(void **state)
{
    (void)state;
    tc_renderer *renderer = NULL;
    tc_error err = {0};
    const tc_renderer_options options = {.driver = "pingpong", .get_proc_address = no_function};
    assert_int_equal(tc_renderer_create(&renderer, &options, NULL, &err), TC_E_GL);
    assert_null(renderer);
    assert_non_null(strstr(err.text, "gl"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(picture_in_the_hosts_framebuffer_is_another),
        cmocka_unit_test(several_rays_in_the_hosts_framebuffer_make_another_picture),
        cmocka_unit_test(the_hosts_state_is_changed),
        cmocka_unit_test(the_hosts_state_changes_the_picture),
        cmocka_unit_test(a_renderer_without_gl_draws_into_a_host),
        cmocka_unit_test(a_host_without_functions_is_believed),
    };
    if (!find_osmesa()) {
        printf("libOSMesa.so.8 is not installed; skipped\n");
        return SKIPPED;
    }
    const struct CMUnitTest by_compute[] = {
        cmocka_unit_test(picture_in_the_hosts_framebuffer_is_another),
        cmocka_unit_test(the_hosts_state_is_changed),
    };
    driver = "pingpong";
    int failed = cmocka_run_group_tests(tests, set_up, tear_down);
    driver = "compute";
    return failed + cmocka_run_group_tests(by_compute, set_up, tear_down);
}
