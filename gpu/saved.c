/* saved.c: the GL state of a host that the renderer touches, kept and put back. */
#include "gpu/saved.h"

void tc_gl_save(tc_gl_saved *s, const tc_gl *gl)
{
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
    gl->GetIntegerv(GL_BLEND_EQUATION_RGB, &s->blend_equation);
    gl->GetIntegerv(GL_PACK_ALIGNMENT, &s->pack_alignment);
    gl->GetBooleanv(GL_DEPTH_WRITEMASK, &s->depth_mask);
    gl->GetBooleanv(GL_COLOR_WRITEMASK, s->color_mask);
    s->depth_test = gl->IsEnabled(GL_DEPTH_TEST);
    s->blend = gl->IsEnabled(GL_BLEND);
    s->scissor = gl->IsEnabled(GL_SCISSOR_TEST);
    s->cull = gl->IsEnabled(GL_CULL_FACE);
    s->stencil = gl->IsEnabled(GL_STENCIL_TEST);
    for (GLuint i = 0; i < TC_SAVED_UNITS; i++) {
        gl->ActiveTexture(GL_TEXTURE0 + i);
        gl->GetIntegerv(GL_TEXTURE_BINDING_1D, &s->unit_1d[i]);
        gl->GetIntegerv(GL_TEXTURE_BINDING_2D, &s->unit_2d[i]);
        gl->GetIntegerv(GL_TEXTURE_BINDING_3D, &s->unit_3d[i]);
        gl->GetIntegerv(GL_TEXTURE_BINDING_BUFFER, &s->unit_buffer[i]);
        gl->GetIntegerv(GL_SAMPLER_BINDING, &s->unit_sampler[i]);
        gl->BindSampler(i, 0);
    }
    gl->Disable(GL_STENCIL_TEST);
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
    gl->BlendEquation((GLenum)s->blend_equation);
    gl->PixelStorei(GL_PACK_ALIGNMENT, s->pack_alignment);
    set_enabled(gl, GL_DEPTH_TEST, s->depth_test);
    set_enabled(gl, GL_BLEND, s->blend);
    set_enabled(gl, GL_SCISSOR_TEST, s->scissor);
    set_enabled(gl, GL_CULL_FACE, s->cull);
    set_enabled(gl, GL_STENCIL_TEST, s->stencil);
}
