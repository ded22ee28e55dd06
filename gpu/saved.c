/* saved.c: the GL state of a host that the renderer touches, kept and put back. */
#include "gpu/saved.h"

/* All off while the renderer works. */
static const GLenum switches[] = {GL_DEPTH_TEST,         GL_BLEND,
                                  GL_SCISSOR_TEST,       GL_CULL_FACE,
                                  GL_STENCIL_TEST,       GL_COLOR_LOGIC_OP,
                                  GL_RASTERIZER_DISCARD, GL_DEPTH_CLAMP,
                                  GL_PRIMITIVE_RESTART,  GL_POLYGON_OFFSET_FILL,
                                  GL_CLIP_DISTANCE0,     GL_CLIP_DISTANCE1,
                                  GL_CLIP_DISTANCE2,     GL_CLIP_DISTANCE3,
                                  GL_CLIP_DISTANCE4,     GL_CLIP_DISTANCE5,
                                  GL_CLIP_DISTANCE6,     GL_CLIP_DISTANCE7,
                                  GL_FRAMEBUFFER_SRGB,   GL_SAMPLE_MASK,
                                  GL_SAMPLE_COVERAGE,    GL_SAMPLE_ALPHA_TO_COVERAGE,
                                  GL_SAMPLE_ALPHA_TO_ONE};
_Static_assert(sizeof switches / sizeof *switches == TC_SAVED_SWITCHES, "saved.h counts the switches");

/* How pixels lie in memory, and as a new context has it. */
static const struct {
    GLenum name;
    GLint initial;
} stores[] = {{GL_PACK_ALIGNMENT, 4},     {GL_PACK_ROW_LENGTH, 0},     {GL_PACK_SKIP_ROWS, 0},
              {GL_PACK_SKIP_PIXELS, 0},   {GL_PACK_SWAP_BYTES, 0},     {GL_UNPACK_ALIGNMENT, 4},
              {GL_UNPACK_ROW_LENGTH, 0},  {GL_UNPACK_SKIP_ROWS, 0},    {GL_UNPACK_SKIP_PIXELS, 0},
              {GL_UNPACK_SKIP_IMAGES, 0}, {GL_UNPACK_IMAGE_HEIGHT, 0}, {GL_UNPACK_SWAP_BYTES, 0}};
_Static_assert(sizeof stores / sizeof *stores == TC_SAVED_STORES, "saved.h counts the stores");

/* Buffers at numbered bindings, of which the renderer takes the first. */
static const struct {
    GLenum target, binding, start, size;
} indexed[] = {{GL_ATOMIC_COUNTER_BUFFER, GL_ATOMIC_COUNTER_BUFFER_BINDING, GL_ATOMIC_COUNTER_BUFFER_START,
                GL_ATOMIC_COUNTER_BUFFER_SIZE},
               {GL_SHADER_STORAGE_BUFFER, GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                GL_SHADER_STORAGE_BUFFER_SIZE}};
_Static_assert(sizeof indexed / sizeof *indexed == TC_SAVED_INDEXED, "saved.h counts them");

enum { MAX_ERRORS = 64 }; /* a lost context gives errors without end */

/* At least 8 are offered. */
static GLuint image_units(const tc_gl *gl)
{
    return gl->max_image_units < TC_SAVED_IMAGES ? (GLuint)gl->max_image_units : TC_SAVED_IMAGES;
}

void tc_gl_save(tc_gl_saved *s, const tc_gl *gl)
{
    for (int i = 0; i < MAX_ERRORS && gl->GetError() != GL_NO_ERROR; i++)
        ;
    gl->GetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &s->draw_framebuffer);
    gl->GetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &s->read_framebuffer);
    gl->GetIntegerv(GL_CURRENT_PROGRAM, &s->program);
    gl->GetIntegerv(GL_VERTEX_ARRAY_BINDING, &s->vertex_array);
    gl->GetIntegerv(GL_ACTIVE_TEXTURE, &s->active_texture);
    gl->GetIntegerv(GL_RENDERBUFFER_BINDING, &s->renderbuffer);
    gl->GetIntegerv(GL_TEXTURE_BUFFER_BINDING, &s->texture_buffer);
    gl->GetIntegerv(GL_VIEWPORT, s->viewport);
    gl->GetIntegerv(GL_SCISSOR_BOX, s->scissor_box);
    gl->GetIntegerv(GL_DEPTH_FUNC, &s->depth_func);
    gl->GetIntegerv(GL_BLEND_SRC_RGB, &s->blend_src_rgb);
    gl->GetIntegerv(GL_BLEND_DST_RGB, &s->blend_dst_rgb);
    gl->GetIntegerv(GL_BLEND_SRC_ALPHA, &s->blend_src_alpha);
    gl->GetIntegerv(GL_BLEND_DST_ALPHA, &s->blend_dst_alpha);
    gl->GetIntegerv(GL_BLEND_EQUATION_RGB, &s->blend_equation_rgb);
    gl->GetIntegerv(GL_BLEND_EQUATION_ALPHA, &s->blend_equation_alpha);
    gl->GetIntegerv(GL_ARRAY_BUFFER_BINDING, &s->array_buffer);
    gl->GetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &s->pack_buffer);
    for (int i = 0; i < TC_SAVED_INDEXED; i++) {
        gl->GetIntegerv(indexed[i].binding, &s->indexed[i].buffer);
        gl->GetIntegeri_v(indexed[i].binding, 0, &s->indexed[i].bound);
        gl->GetInteger64i_v(indexed[i].start, 0, &s->indexed[i].start);
        gl->GetInteger64i_v(indexed[i].size, 0, &s->indexed[i].size);
    }
    gl->GetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &s->unpack_buffer);
    gl->GetIntegerv(GL_POLYGON_MODE, s->polygon_mode);
    gl->GetFloatv(GL_DEPTH_RANGE, s->depth_range);
    for (int i = 0; i < TC_SAVED_STORES; i++) {
        gl->GetIntegerv(stores[i].name, &s->store[i]);
        gl->PixelStorei(stores[i].name, stores[i].initial);
    }
    gl->GetBooleanv(GL_DEPTH_WRITEMASK, &s->depth_mask);
    gl->GetBooleanv(GL_COLOR_WRITEMASK, s->color_mask);
    for (int i = 0; i < TC_SAVED_SWITCHES; i++) {
        s->enabled[i] = gl->IsEnabled(switches[i]);
        gl->Disable(switches[i]);
    }
    for (GLuint i = 0; i < image_units(gl); i++) {
        gl->GetIntegeri_v(GL_IMAGE_BINDING_NAME, i, &s->image[i]);
        gl->GetIntegeri_v(GL_IMAGE_BINDING_LEVEL, i, &s->image_level[i]);
        gl->GetBooleani_v(GL_IMAGE_BINDING_LAYERED, i, &s->image_layered[i]);
        gl->GetIntegeri_v(GL_IMAGE_BINDING_LAYER, i, &s->image_layer[i]);
        gl->GetIntegeri_v(GL_IMAGE_BINDING_ACCESS, i, &s->image_access[i]);
        gl->GetIntegeri_v(GL_IMAGE_BINDING_FORMAT, i, &s->image_format[i]);
    }
    for (GLuint i = 0; i < TC_SAVED_UNITS; i++) {
        gl->ActiveTexture(GL_TEXTURE0 + i);
        gl->GetIntegerv(GL_TEXTURE_BINDING_1D, &s->unit_1d[i]);
        gl->GetIntegerv(GL_TEXTURE_BINDING_2D, &s->unit_2d[i]);
        gl->GetIntegerv(GL_TEXTURE_BINDING_3D, &s->unit_3d[i]);
        gl->GetIntegerv(GL_TEXTURE_BINDING_BUFFER, &s->unit_buffer[i]);
        gl->GetIntegerv(GL_SAMPLER_BINDING, &s->unit_sampler[i]);
        gl->BindSampler(i, 0);
    }
    gl->BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    gl->BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    gl->PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

static void set_enabled(const tc_gl *gl, GLenum what, GLboolean on)
{
    if (on)
        gl->Enable(what);
    else
        gl->Disable(what);
}

void tc_gl_restore(const tc_gl_saved *s, const tc_gl *gl)
{
    for (GLuint i = 0; i < TC_SAVED_UNITS; i++) {
        gl->ActiveTexture(GL_TEXTURE0 + i);
        gl->BindTexture(GL_TEXTURE_1D, (GLuint)s->unit_1d[i]);
        gl->BindTexture(GL_TEXTURE_2D, (GLuint)s->unit_2d[i]);
        gl->BindTexture(GL_TEXTURE_3D, (GLuint)s->unit_3d[i]);
        gl->BindTexture(GL_TEXTURE_BUFFER, (GLuint)s->unit_buffer[i]);
        gl->BindSampler(i, (GLuint)s->unit_sampler[i]);
    }
    gl->ActiveTexture((GLenum)s->active_texture);
    gl->BindFramebuffer(GL_DRAW_FRAMEBUFFER, (GLuint)s->draw_framebuffer);
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, (GLuint)s->read_framebuffer);
    gl->BindRenderbuffer(GL_RENDERBUFFER, (GLuint)s->renderbuffer);
    gl->BindBuffer(GL_TEXTURE_BUFFER, (GLuint)s->texture_buffer);
    gl->UseProgram((GLuint)s->program);
    gl->BindVertexArray((GLuint)s->vertex_array);
    gl->Viewport(s->viewport[0], s->viewport[1], s->viewport[2], s->viewport[3]);
    gl->Scissor(s->scissor_box[0], s->scissor_box[1], s->scissor_box[2], s->scissor_box[3]);
    gl->DepthFunc((GLenum)s->depth_func);
    gl->DepthMask(s->depth_mask);
    gl->ColorMask(s->color_mask[0], s->color_mask[1], s->color_mask[2], s->color_mask[3]);
    gl->BlendFuncSeparate((GLenum)s->blend_src_rgb, (GLenum)s->blend_dst_rgb, (GLenum)s->blend_src_alpha,
                          (GLenum)s->blend_dst_alpha);
    gl->BlendEquationSeparate((GLenum)s->blend_equation_rgb, (GLenum)s->blend_equation_alpha);
    for (int i = 0; i < TC_SAVED_STORES; i++)
        gl->PixelStorei(stores[i].name, s->store[i]);
    gl->BindBuffer(GL_ARRAY_BUFFER, (GLuint)s->array_buffer);
    for (int i = 0; i < TC_SAVED_INDEXED; i++) {
        if (s->indexed[i].size > 0) /* 0: as a whole, or nothing */
            gl->BindBufferRange(indexed[i].target, 0, (GLuint)s->indexed[i].bound, (GLintptr)s->indexed[i].start,
                                (GLsizeiptr)s->indexed[i].size);
        else
            gl->BindBufferBase(indexed[i].target, 0, (GLuint)s->indexed[i].bound);
        gl->BindBuffer(indexed[i].target, (GLuint)s->indexed[i].buffer);
    }
    gl->BindBuffer(GL_PIXEL_PACK_BUFFER, (GLuint)s->pack_buffer);
    gl->BindBuffer(GL_PIXEL_UNPACK_BUFFER, (GLuint)s->unpack_buffer);
    gl->PolygonMode(GL_FRONT_AND_BACK, (GLenum)s->polygon_mode[0]);
    gl->DepthRange((GLdouble)s->depth_range[0], (GLdouble)s->depth_range[1]);
    for (GLuint i = 0; i < image_units(gl); i++)
        gl->BindImageTexture(i, (GLuint)s->image[i], s->image_level[i], s->image_layered[i], s->image_layer[i],
                             (GLenum)s->image_access[i], (GLenum)s->image_format[i]);
    for (int i = 0; i < TC_SAVED_SWITCHES; i++)
        set_enabled(gl, switches[i], s->enabled[i]);
}
