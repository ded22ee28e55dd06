/* layers.c: what the rays of one frame meet of a look's geometry, nearest first. */
#include "gpu/layers.h"

#include "gpu/effects/light.h"
#include "gpu/pass.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { UNIT_VERTICES, UNIT_ITEMS, UNIT_PLANES, UNIT_OPAQUE_Z, UNIT_OPAQUE_COLOR, UNIT_MASK };
enum { IMAGE_HEADS, IMAGE_NODES };
enum { LIST_MOST = 2500 }; /* nodes that are sorted within the rounds that software renderers make of a loop */
enum { NODE_TEXELS = 2, NODE_BYTES = 32, NODES_LEAST = 1 << 14 };

enum kind { TRIANGLES, LINES };

static bool is_opaque(const tc_geometry *g)
{
    return g->opacity >= 1;
}

bool tc_layers_seen(const tc_geometry *g)
{
    return g->opacity > 0 && (g->n_triangle > 0 || g->n_line > 0);
}

/* Does the scene have geometry that is opaque, or that is not? */
static bool has(const tc_layers_scene *scene, bool opaque)
{
    for (int i = 0; i < scene->buffers->n_part; i++)
        if (tc_layers_seen(&scene->geometry[i]) && is_opaque(&scene->geometry[i]) == opaque)
            return true;
    return false;
}

static bool is_lit(const tc_layers_scene *scene, const tc_geometry *g, enum kind kind)
{
    return kind == TRIANGLES && g->lit && scene->shade->gradient != TC_GRADIENT_NONE;
}

/* ------------------------------------------------------------------------------------------ programs */

static tc_status get_draw(GLuint *program, const tc_layers_scene *scene, const tc_geometry *g, enum kind kind,
                          const tc_job *job, tc_error *err)
{
    const bool lit = is_lit(scene, g, kind);
    char lights[128] = "", defines[384];
    if (lit)
        tc_light_define(lights, sizeof lights, scene->shade);
    snprintf(defines, sizeof defines, "#define CLIP_NEAR\n#define CLIP_FAR\n%s%s%s%s%s",
             job->software ? "#define SOFTWARE\n" : "", kind == LINES ? "#define LINES\n" : "",
             is_opaque(g) ? "#define OPAQUE\n" : "", !is_opaque(g) && has(scene, true) ? "#define BEFORE_OPAQUE\n" : "",
             lights);
    const tc_program_source source = {"effects/geometry.vert", "effects/geometry.frag", defines, NULL,
                                      lit ? "effects/light.glsl" : NULL};
    return tc_program_get(program, job->programs, &source, err);
}

static tc_status get_order(GLuint *program, const tc_layers_scene *scene, const tc_job *job, tc_error *err)
{
    char defines[96];
    snprintf(defines, sizeof defines, "%s%s%s%s", job->software ? "#define SOFTWARE\n" : "",
             has(scene, true) ? "#define OPAQUE\n" : "", has(scene, false) ? "#define LISTS\n" : "",
             job->masked ? "#define SAMPLE_MASK\n" : "");
    const tc_program_source source = {"screen.vert", "effects/geometry_order.frag", defines, NULL, NULL};
    return tc_program_get(program, job->programs, &source, err);
}

static GLint count_of(const tc_gpu_geometry_part *part, enum kind kind)
{
    return kind == LINES ? part->n_line : part->n_triangle;
}

tc_status tc_layers_compile(const tc_layers_scene *scene, const tc_job *job, tc_error *err)
{
    GLuint unused;
    tc_status status = get_order(&unused, scene, job, err);
    for (int i = 0; i < scene->buffers->n_part && status == TC_OK; i++)
        for (int kind = TRIANGLES; kind <= LINES && status == TC_OK; kind++)
            if (tc_layers_seen(&scene->geometry[i]) && count_of(&scene->buffers->part[i], kind) > 0)
                status = get_draw(&unused, scene, &scene->geometry[i], kind, job, err);
    return status;
}

/* ------------------------------------------------------------------------------------------ textures */

static GLuint screen_texture(const tc_layers *l, const tc_gl *gl, GLenum internal, GLenum format, GLenum type)
{
    return tc_pass_new_texture(gl, l->width, l->height, internal, format, type);
}

static tc_status check_framebuffer(const tc_layers *l, const tc_gl *gl, tc_error *err)
{
    const GLenum complete = gl->CheckFramebufferStatus(GL_FRAMEBUFFER);
    if (complete == GL_FRAMEBUFFER_COMPLETE)
        return TC_OK;
    return tc_fail(err, TC_E_GL,
                   "%s cannot draw geometry into %dx%d pixels (framebuffer status 0x%04X); use a smaller --size",
                   gl->renderer, l->width, l->height, complete);
}

/* Of the size of the picture. */
static tc_status ensure_textures(tc_layers *l, bool opaque, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const int width = job->state->width, height = job->state->height;
    const GLenum buffers[2] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    if (l->width == width && l->height == height && (l->opaque_framebuffer != 0) == opaque)
        return TC_OK;
    tc_layers_finish(l, gl);
    l->width = width;
    l->height = height;
    gl->GenBuffers(1, &l->used);
    l->heads = screen_texture(l, gl, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT);
    l->bytes = 4 * (size_t)width * (size_t)height;
    gl->GenFramebuffers(1, &l->heads_framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, l->heads_framebuffer);
    gl->FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, l->heads, 0);
    gl->DrawBuffers(1, buffers);
    tc_status status = check_framebuffer(l, gl, err);
    if (status != TC_OK || !opaque)
        return status;
    l->color = screen_texture(l, gl, GL_RGBA32F, GL_RGBA, GL_FLOAT);
    l->z = screen_texture(l, gl, GL_R32F, GL_RED, GL_FLOAT);
    gl->GenRenderbuffers(1, &l->depth);
    gl->BindRenderbuffer(GL_RENDERBUFFER, l->depth);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
    l->bytes += 24 * (size_t)width * (size_t)height;
    gl->GenFramebuffers(1, &l->opaque_framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, l->opaque_framebuffer);
    gl->FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, l->color, 0);
    gl->FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, l->z, 0);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, l->depth);
    gl->DrawBuffers(2, buffers);
    return check_framebuffer(l, gl, err);
}

/* Room for n nodes beside node 0. What is in them is lost. */
static tc_status ensure_nodes(tc_layers *l, size_t n, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    if (l->nodes.buffer && n < (size_t)l->n_node)
        return TC_OK;
    const size_t most = (size_t)gl->max_texture_buffer / NODE_TEXELS;
    size_t room = n + n / 4 + NODES_LEAST;
    room = room > most ? most : room;
    if (n >= room)
        return tc_fail(
            err, TC_E_MEMORY,
            "the geometry has %zu fragments in the picture, %s holds %zu; show less of it, make it opaque or use a "
            "smaller --size",
            n, gl->renderer, most);
    l->bytes -= l->nodes.bytes;
    tc_texture_buffer_finish(&l->nodes, gl);
    tc_status status = tc_texture_buffer_upload(&l->nodes, gl, NULL, NODE_TEXELS * room, NODE_BYTES / NODE_TEXELS,
                                                GL_RGBA32I, "making room for the geometry's fragments", err);
    l->bytes += l->nodes.bytes;
    l->n_node = status == TC_OK ? (GLint)room : 0;
    return status;
}

void tc_layers_finish(tc_layers *l, const tc_gl *gl)
{
    const GLuint textures[3] = {l->heads, l->color, l->z},
                 framebuffers[2] = {l->heads_framebuffer, l->opaque_framebuffer};
    gl->DeleteTextures(3, textures); /* 0 is ignored */
    gl->DeleteFramebuffers(2, framebuffers);
    gl->DeleteRenderbuffers(1, &l->depth);
    gl->DeleteBuffers(1, &l->used);
    tc_texture_buffer_finish(&l->nodes, gl);
    memset(l, 0, sizeof *l);
}

/* ------------------------------------------------------------------------------------------ drawing */

static void bind_draw(const tc_layers *l, const tc_layers_scene *scene, const tc_geometry *g, enum kind kind,
                      const tc_job *job, GLuint program)
{
    const tc_gl *gl = job->gl;
    const tc_gpu_geometry *b = scene->buffers;
    const double color[4] = {g->color[0], g->color[1], g->color[2], g->opacity};
    gl->UseProgram(program);
    tc_pass_frame(gl, program, job->frame);
    for (int k = 0; k < 4; k++) {
        char name[24];
        snprintf(name, sizeof name, "geometry_clip[%d]", k);
        gl->Uniform4fv(gl->GetUniformLocation(program, name), 1, job->frame->clip + 4 * k);
        snprintf(name, sizeof name, "whole_clip[%d]", k);
        gl->Uniform4fv(gl->GetUniformLocation(program, name), 1, job->frame->whole_clip + 4 * k);
    }
    tc_pass_vec2(gl, program, "whole_size", job->frame->whole_size[0], job->frame->whole_size[1]);
    tc_pass_vec4(gl, program, "geometry_color", color);
    tc_pass_vec2(gl, program, "picture_size", l->width, l->height);
    tc_pass_texture(gl, program, "geometry_vertices", UNIT_VERTICES, GL_TEXTURE_BUFFER, b->vertices.texture);
    if (kind == LINES) {
        tc_pass_texture(gl, program, "geometry_lines", UNIT_ITEMS, GL_TEXTURE_BUFFER, b->lines.texture);
        tc_pass_float(gl, program, "line_width", g->width);
    } else {
        tc_pass_texture(gl, program, "geometry_triangles", UNIT_ITEMS, GL_TEXTURE_BUFFER, b->triangles.texture);
        tc_pass_texture(gl, program, "geometry_planes", UNIT_PLANES, GL_TEXTURE_BUFFER, b->planes.texture);
    }
    if (is_lit(scene, g, kind))
        tc_light_bind(gl, program, scene->shade);
    if (!is_opaque(g) && l->z)
        tc_pass_texture(gl, program, "opaque_z", UNIT_OPAQUE_Z, GL_TEXTURE_2D, l->z);
}

/* All geometry that is opaque, or that is not. Of two fragments at one depth that of the earlier geometry counts as
 * nearer, and its triangles before its lines. */
static tc_status draw(const tc_layers *l, const tc_layers_scene *scene, bool opaque, GLint node_first,
                      const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    GLint before = 0; /* items of earlier geometries */
    for (int i = 0; i < scene->buffers->n_part; i++) {
        const tc_geometry *g = &scene->geometry[i];
        const tc_gpu_geometry_part *part = &scene->buffers->part[i];
        for (int kind = TRIANGLES; kind <= LINES; kind++) {
            const GLint n = count_of(part, kind), first = kind == LINES ? part->first_line : part->first_triangle;
            const GLint corners = kind == LINES ? 6 : 3;
            GLuint program;
            if (n > 0 && tc_layers_seen(g) && is_opaque(g) == opaque) {
                tc_status status = get_draw(&program, scene, g, kind, job, err);
                if (status != TC_OK)
                    return status;
                bind_draw(l, scene, g, kind, job, program);
                tc_pass_int(gl, program, "node_first", node_first);
                tc_pass_int(gl, program, "node_end", l->n_node);
                tc_pass_int(gl, program, "item_first", before - first);
                gl->DrawArrays(GL_TRIANGLES, corners * first, corners * n);
            }
            before += n;
        }
    }
    return TC_OK;
}

static tc_status draw_opaque(const tc_layers *l, const tc_layers_scene *scene, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const GLfloat none[4] = {0, 0, 0, 0}, beyond[4] = {INFINITY, 0, 0, 0}, far_depth = 1;
    gl->BindFramebuffer(GL_FRAMEBUFFER, l->opaque_framebuffer);
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthFunc(GL_LESS);
    gl->DepthMask(GL_TRUE);
    gl->ClearBufferfv(GL_COLOR, 0, none);
    gl->ClearBufferfv(GL_COLOR, 1, beyond);
    gl->ClearBufferfv(GL_DEPTH, 0, &far_depth);
    tc_status status = draw(l, scene, true, 0, job, err);
    gl->DepthMask(GL_FALSE);
    gl->Disable(GL_DEPTH_TEST);
    return status;
}

static void bind_lists(const tc_layers *l, const tc_gl *gl, GLenum nodes)
{
    gl->BindImageTexture(IMAGE_HEADS, l->heads, 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
    gl->BindImageTexture(IMAGE_NODES, l->nodes.texture, 0, GL_FALSE, 0, nodes, GL_RGBA32I);
}

/* Fills the lists; *used gets how many nodes they need, from node_first on. */
static tc_status fill_lists(GLuint *used, const tc_layers *l, const tc_layers_scene *scene, GLint node_first,
                            const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const GLuint none[4] = {0, 0, 0, 0};
    gl->BindFramebuffer(GL_FRAMEBUFFER, l->heads_framebuffer);
    gl->ClearBufferuiv(GL_COLOR, 0, none);
    gl->MemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    gl->BindFramebuffer(GL_FRAMEBUFFER, job->state->lock_framebuffer); /* nothing is written but lists */
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, l->used);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, sizeof none, none, GL_DYNAMIC_READ);
    bind_lists(l, gl, GL_WRITE_ONLY);
    tc_status status = draw(l, scene, false, node_first, job, err);
    gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof *used, used);
    return status;
}

static tc_status order(const tc_layers *l, const tc_layers_scene *scene, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    GLuint program;
    tc_status status = get_order(&program, scene, job, err);
    if (status != TC_OK)
        return status;
    gl->BindFramebuffer(GL_FRAMEBUFFER, job->state->lock_framebuffer);
    gl->UseProgram(program);
    bind_lists(l, gl, GL_READ_WRITE);
    if (l->opaque_framebuffer) {
        tc_pass_texture(gl, program, "opaque_color", UNIT_OPAQUE_COLOR, GL_TEXTURE_2D, l->color);
        tc_pass_texture(gl, program, "opaque_z", UNIT_OPAQUE_Z, GL_TEXTURE_2D, l->z);
        tc_pass_int(gl, program, "picture_width", l->width);
    }
    if (job->masked)
        tc_pass_texture(gl, program, "sample_mask", UNIT_MASK, GL_TEXTURE_2D, job->state->mask);
    tc_pass_screen(gl);
    gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    GLuint longest = 0;
    if (job->software && has(scene, false))
        gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, sizeof longest, sizeof longest, &longest);
    if (longest > LIST_MOST)
        return tc_fail(
            err, TC_E_MEMORY,
            "%u triangles or lines that are not opaque lie behind one another in a pixel, %s sorts %d; show less of "
            "them or make them opaque",
            longest, gl->renderer, LIST_MOST);
    return TC_OK;
}

/* What rays keep of their way: they have none yet. */
static void clear_ways(const tc_job *job)
{
    const GLint none[4] = {0, 0, -1, 0};
    for (int i = 0; i < 2; i++) {
        job->gl->BindFramebuffer(GL_FRAMEBUFFER, job->state->set[i].framebuffer);
        job->gl->ClearBufferiv(GL_COLOR, TC_STATE_AT, none);
    }
}

tc_status tc_layers_draw(tc_layers *l, const tc_layers_scene *scene, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const bool opaque = has(scene, true), lists = has(scene, false);
    const size_t opaque_nodes = opaque ? (size_t)job->state->width * (size_t)job->state->height : 0;
    clear_ways(job);
    tc_status status = ensure_textures(l, opaque, job, err);
    if (status == TC_OK)
        status = ensure_nodes(l, opaque_nodes, job, err);
    else
        tc_layers_finish(l, gl);
    gl->Viewport(0, 0, job->state->width, job->state->height);
    gl->Disable(GL_DEPTH_TEST);
    gl->DepthMask(GL_FALSE);
    if (status == TC_OK && opaque)
        status = draw_opaque(l, scene, job, err);
    for (bool again = lists; again && status == TC_OK;) {
        GLuint used = 0;
        status = fill_lists(&used, l, scene, 1 + (GLint)opaque_nodes, job, err);
        again = status == TC_OK && opaque_nodes + used >= (size_t)l->n_node;
        if (again)
            status = ensure_nodes(l, opaque_nodes + used, job, err);
    }
    if (status == TC_OK)
        status = order(l, scene, job, err);
    return status == TC_OK ? tc_gl_check(gl, "drawing the geometry", err) : status;
}
