/* state.c: the textures that carry rays from pass to pass. */
#include "gpu/state.h"

#include "gpu/pass.h"

#include <string.h>

static GLuint screen_texture(const tc_state *s, const tc_gl *gl, GLenum internal, GLenum format, GLenum type)
{
    return tc_pass_new_texture(gl, s->width, s->height, internal, format, type);
}

static GLuint depth_buffer(const tc_state *s, const tc_gl *gl)
{
    GLuint buffer;
    gl->GenRenderbuffers(1, &buffer);
    gl->BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, s->width, s->height);
    return buffer;
}

static tc_status framebuffer(GLuint *out, const tc_state *s, const tc_gl *gl, const GLuint *color, int n, GLuint depth,
                             tc_error *err)
{
    GLenum buffers[TC_STATE_TEXTURES];
    gl->GenFramebuffers(1, out);
    gl->BindFramebuffer(GL_FRAMEBUFFER, *out);
    for (int i = 0; i < n; i++) {
        gl->FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + (GLenum)i, color[i], 0);
        buffers[i] = GL_COLOR_ATTACHMENT0 + (GLenum)i;
    }
    if (depth)
        gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    gl->DrawBuffers(n, buffers);
    GLenum complete = gl->CheckFramebufferStatus(GL_FRAMEBUFFER);
    if (complete != GL_FRAMEBUFFER_COMPLETE)
        return tc_fail(
            err, TC_E_GL,
            "%s cannot render to float textures of %dx%d pixels (framebuffer status 0x%04X); use a smaller --size",
            gl->renderer, s->width, s->height, complete);
    return TC_OK;
}

/* Of a state set: all, or those before what is only counted or audited. */
static int attachments(const tc_state *s)
{
    return s->auditing ? TC_STATE_TEXTURES : s->counting ? TC_STATE_AUDIT : TC_STATE_STEPS;
}

/* NaN as float, and nothing meant as an integer. */
static void poison_color(const tc_gl *gl, GLuint framebuffer_name, GLint buffer, GLenum type)
{
    const GLuint bits[4] = {0x7fc00000u, 0x7fc00000u, 0x7fc00000u, 0x7fc00000u};
    GLfloat floats[4];
    GLint ints[4];
    memcpy(floats, bits, sizeof floats);
    memcpy(ints, bits, sizeof ints);
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_name);
    if (type == GL_FLOAT)
        gl->ClearBufferfv(GL_COLOR, buffer, floats);
    else if (type == GL_INT)
        gl->ClearBufferiv(GL_COLOR, buffer, ints);
    else
        gl->ClearBufferuiv(GL_COLOR, buffer, bits);
}

static void poison_depth(const tc_gl *gl, GLuint framebuffer_name)
{
    const GLfloat near_depth = 0;
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_name);
    gl->DepthMask(GL_TRUE);
    gl->ClearBufferfv(GL_DEPTH, 0, &near_depth);
    gl->DepthMask(GL_FALSE);
}

static int bits_of(const tc_render_options *options)
{
    return options->state_format == TC_STATE_16F ? 16 : 32;
}

bool tc_state_fits(const tc_state *s, const tc_render_options *options, bool peeling)
{
    return s->width == options->width && s->height == options->height && s->peeling == peeling &&
           s->counting == (options->count || options->audit) && s->auditing == options->audit &&
           s->adaptive == (options->samples == TC_SAMPLES_ADAPTIVE) && s->color_bits == bits_of(options);
}

/* What adaptive sampling needs besides. */
static tc_status create_mask(tc_state *s, const tc_gl *gl, tc_error *err)
{
    for (int i = 0; i < 2; i++)
        s->spread[i] = screen_texture(s, gl, GL_RGBA32F, GL_RGBA, GL_FLOAT);
    s->mask = screen_texture(s, gl, GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE);
    s->bytes += (size_t)s->width * (size_t)s->height * 33;
    const GLuint textures[2] = {s->result, s->mask};
    tc_status status = framebuffer(&s->spread_framebuffer, s, gl, s->spread, 2, 0, err);
    return status == TC_OK ? framebuffer(&s->mask_framebuffer, s, gl, textures, 2, 0, err) : status;
}

tc_status tc_state_create(tc_state *s, const tc_gl *gl, const tc_render_options *options, bool peeling, tc_error *err)
{
    int width = options->width, height = options->height;
    bool counting = options->count || options->audit;
    memset(s, 0, sizeof *s);
    if (width > gl->max_texture_size || height > gl->max_texture_size)
        return tc_fail(err, TC_E_ARG, "an image of %dx%d exceeds what %s can render (%d); use a smaller --size", width,
                       height, gl->renderer, gl->max_texture_size);
    s->width = width;
    s->height = height;
    s->counting = counting;
    s->auditing = options->audit;
    s->peeling = peeling;
    s->adaptive = options->samples == TC_SAMPLES_ADAPTIVE;
    s->color_bits = bits_of(options);
    size_t pixels = (size_t)width * (size_t)height;
    s->lock = depth_buffer(s, gl);
    s->hit_depth = depth_buffer(s, gl);
    s->bytes = pixels * 8;
    tc_status status = TC_OK;
    for (int i = 0; i < 2 && status == TC_OK; i++) {
        tc_state_set *set = &s->set[i];
        set->walk = screen_texture(s, gl, GL_RGBA32I, GL_RGBA_INTEGER, GL_INT);
        set->color = screen_texture(s, gl, s->color_bits == 16 ? GL_RGBA16F : GL_RGBA32F, GL_RGBA, GL_FLOAT);
        set->at = screen_texture(s, gl, GL_RGBA32I, GL_RGBA_INTEGER, GL_INT);
        if (counting)
            set->steps = screen_texture(s, gl, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT);
        if (s->auditing)
            set->audit = screen_texture(s, gl, GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT);
        GLuint textures[TC_STATE_TEXTURES] = {set->walk, set->color, set->at, set->steps, set->audit};
        int n = attachments(s);
        status = framebuffer(&set->framebuffer, s, gl, textures, n, s->lock, err);
        s->bytes += pixels * (size_t)(32 + s->color_bits / 2 + (counting ? 4 : 0) + (s->auditing ? 16 : 0));
    }
    for (int i = 0; i < (peeling ? 2 : 1) && status == TC_OK; i++) {
        if (peeling) {
            s->key[i] = screen_texture(s, gl, GL_RG32I, GL_RG_INTEGER, GL_INT);
            s->bytes += pixels * 8;
        }
        GLuint textures[2] = {s->set[0].walk, s->key[i]};
        status = framebuffer(&s->hit_framebuffer[i], s, gl, textures, peeling ? 2 : 1, s->hit_depth, err);
    }
    if (status == TC_OK)
        status = framebuffer(&s->lock_framebuffer, s, gl, NULL, 0, s->lock, err);
    if (status == TC_OK) {
        s->result = screen_texture(s, gl, GL_RGBA32F, GL_RGBA, GL_FLOAT);
        s->bytes += pixels * 16;
        status = framebuffer(&s->result_framebuffer, s, gl, &s->result, 1, 0, err);
    }
    if (status == TC_OK && s->adaptive)
        status = create_mask(s, gl, err);
    if (status == TC_OK && gl->poison)
        poison_color(gl, s->result_framebuffer, 0, GL_FLOAT);
    if (status == TC_OK)
        status = tc_gl_check(gl, "making the ray state", err);
    if (status != TC_OK)
        tc_state_finish(s, gl);
    return status;
}

void tc_state_finish(tc_state *s, const tc_gl *gl)
{
    for (int i = 0; i < 2; i++) {
        GLuint textures[6] = {s->set[i].walk,  s->set[i].color, s->set[i].at,
                              s->set[i].steps, s->set[i].audit, s->key[i]};
        gl->DeleteTextures(6, textures); /* 0 is ignored */
        gl->DeleteFramebuffers(1, &s->set[i].framebuffer);
        gl->DeleteFramebuffers(1, &s->hit_framebuffer[i]);
    }
    gl->DeleteFramebuffers(1, &s->lock_framebuffer);
    gl->DeleteRenderbuffers(1, &s->lock);
    gl->DeleteRenderbuffers(1, &s->hit_depth);
    const GLuint textures[4] = {s->result, s->spread[0], s->spread[1], s->mask};
    const GLuint framebuffers[3] = {s->result_framebuffer, s->spread_framebuffer, s->mask_framebuffer};
    gl->DeleteTextures(4, textures);
    gl->DeleteFramebuffers(3, framebuffers);
    memset(s, 0, sizeof *s);
}

void tc_state_poison(const tc_state *s, const tc_gl *gl)
{
    static const GLenum types[TC_STATE_TEXTURES] = {GL_INT, GL_FLOAT, GL_INT, GL_UNSIGNED_INT, GL_UNSIGNED_INT};
    int n = attachments(s);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < n; k++)
            poison_color(gl, s->set[i].framebuffer, k, types[k]);
    for (int i = 0; i < 2 && s->peeling; i++)
        poison_color(gl, s->hit_framebuffer[i], 1, GL_INT);
    for (int i = 0; i < 2 && s->adaptive; i++)
        poison_color(gl, s->spread_framebuffer, i, GL_FLOAT);
    if (s->adaptive)
        poison_color(gl, s->mask_framebuffer, 1, GL_UNSIGNED_INT);
    poison_depth(gl, s->hit_framebuffer[0]);
    poison_depth(gl, s->lock_framebuffer);
}
