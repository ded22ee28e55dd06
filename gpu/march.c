/* march.c: the march's program and what it reads, whichever driver runs it. */
#include "gpu/march.h"

#include "gpu/effect.h"
#include "gpu/kept.h"
#include "gpu/pass.h"

#include <stdio.h>
#include <string.h>

enum { UNIT_NODES = 2, UNIT_TABLE = 8 };
/* Of the paper's arithmetic, four each: as textures, and as images, of which there are fewer (stepper_planes.glsl). */
enum { UNIT_PLANES = 12, IMAGE_PLANES = 4, IMAGE_KEPT = 4 };
enum { UNIT_PIECES = 10, UNIT_PIECE_FLOATS = 11, IMAGE_PIECES = 3, IMAGE_PIECE_FLOATS = 13 }; /* 8 to 12: compute.c */

tc_status tc_march_program(GLuint *program, const tc_job *job, const char *vertex, const char *file, tc_error *err)
{
    const tc_effects *effects = job->effects;
    char defines[1024], alias[128];
    tc_job_defines(defines, sizeof defines, job);
    size_t n = strlen(defines);
    bool range = effects && (effects->needs & TC_NEEDS_RANGE);
    snprintf(defines + n, sizeof defines - n, "%s%s%s%s", vertex && job->software && !job->kept ? "#define RAYS_FLAT\n" : "",
             range && !job->frame->clip_near ? "#define CLIP_NEAR\n" : "",
             range && !job->frame->clip_far ? "#define CLIP_FAR\n" : "", effects ? effects->defines : "");
    snprintf(alias, sizeof alias, "integrator.glsl=%s%s",
             effects && effects->integrator           ? effects->integrator
             : job->drift                             ? "integrate_drift.glsl"
             : job->integrator == TC_INTEGRATOR_TABLE ? "integrate_table.glsl"
             : job->integrator == TC_INTEGRATOR_EXACT ? "integrate_exact.glsl"
                                                      : "integrate_integral.glsl",
             job->planes ? " stepper.glsl=stepper_planes.glsl"
             : job->kept ? " stepper.glsl=stepper_kept.glsl"
                         : "");
    const tc_program_source source = {vertex, file, defines, alias, effects ? effects->shaders : NULL};
    return tc_program_get(program, job->programs, &source, err);
}

void tc_march_bind_pieces(const tc_job *job, GLuint program)
{
    const tc_gl *gl = job->gl;
    int half = 1;
    while (2 * half < job->n_piece)
        half *= 2;
    tc_pass_fetch(gl, program, "tf_pieces", job->software ? IMAGE_PIECES : UNIT_PIECES, GL_RGBA32F,
                  job->transfer->pieces.texture, job->software);
    tc_pass_fetch(gl, program, "tf_piece_floats", job->software ? IMAGE_PIECE_FLOATS : UNIT_PIECE_FLOATS, GL_R32F,
                  job->transfer->piece_floats, job->software);
    tc_pass_int(gl, program, "tf_piece_count", job->n_piece);
    tc_pass_int(gl, program, "tf_piece_half", half);
}

static void bind_drift(const tc_job *job, GLuint program)
{
    const tc_gl *gl = job->gl;
    const double *o = job->octave, *m = job->tf_most;
    tc_pass_fetch(gl, program, "tf_cells", UNIT_NODES, GL_RGBA32F, job->transfer->nodes.texture, job->software);
    tc_pass_vec2(gl, program, "tf_grid", job->grid[0], job->grid[1]);
    gl->Uniform3f(gl->GetUniformLocation(program, "tf_octave"), (float)o[0], (float)o[1], (float)o[2]);
    gl->Uniform3f(gl->GetUniformLocation(program, "tf_most"), (float)m[0], (float)m[1], (float)m[2]);
}

static void bind_transfer(const tc_job *job, GLuint program)
{
    const tc_gl *gl = job->gl;
    tc_pass_vec2(gl, program, "tf_map", job->map[0], job->map[1]);
    if (job->integrator == TC_INTEGRATOR_TABLE) {
        tc_pass_texture(gl, program, "tf_table", UNIT_TABLE, GL_TEXTURE_3D, job->transfer->table);
        tc_pass_vec2(gl, program, "tf_texel[0]", job->texel[0][0], job->texel[0][1]);
        tc_pass_vec2(gl, program, "tf_texel[1]", job->texel[1][0], job->texel[1][1]);
        if (job->drift)
            bind_drift(job, program);
        else
            tc_pass_vec2(gl, program, "tf_texel[2]", job->texel[2][0], job->texel[2][1]);
    } else if (job->integrator == TC_INTEGRATOR_EXACT) {
        tc_march_bind_pieces(job, program);
    } else {
        tc_pass_fetch(gl, program, "tf_nodes", UNIT_NODES, GL_RGBA32F, job->transfer->nodes.texture, job->software);
        tc_pass_vec2(gl, program, "tf_grid", job->grid[0], job->grid[1]);
        tc_pass_float(gl, program, "tf_near", job->near);
        tc_pass_vec4(gl, program, "tf_mean", job->mean);
        if (job->hard > 0) {
            tc_march_bind_pieces(job, program);
            const double hard[4] = {job->hard, job->hard / job->hard_depth, job->hard / job->hard_slope,
                                    job->hard / job->hard_slope * job->hard_relative};
            tc_pass_vec4(gl, program, "tf_hard", hard);
        }
        if (job->split > 0)
            tc_pass_float(gl, program, "tf_split", job->split);
    }
}

static void bind_planes(const tc_job *job, GLuint program)
{
    const tc_gl *gl = job->gl;
    const tc_gpu_mesh *mesh = job->mesh;
    bool software = job->software;
    GLuint unit = software ? IMAGE_PLANES : UNIT_PLANES;
    tc_pass_fetch(gl, program, "planes_vertices", unit, GL_RGBA32F, mesh->planes_vertices.texture, software);
    tc_pass_fetch(gl, program, "planes_normals", unit + 1, GL_RGBA32F, mesh->planes_normals.texture, software);
    tc_pass_fetch(gl, program, "planes_neighbours", unit + 2, GL_R32I, mesh->planes_neighbours.texture, software);
    tc_pass_fetch(gl, program, "planes_scalars", unit + 3, GL_RGBA32F, mesh->planes_scalars.texture, software);
    tc_pass_float(gl, program, "planes_longest", job->longest);
}

void tc_march_bind(const tc_job *job, GLuint program)
{
    const tc_gl *gl = job->gl;
    gl->UseProgram(program);
    tc_job_bind_mesh(job, program);
    if (job->planes)
        bind_planes(job, program);
    if (job->kept)
        tc_pass_fetch(gl, program, "kept_pairs", IMAGE_KEPT, GL_RG32F, job->kept->pairs.texture, job->software);
    if (!job->effects || !(job->effects->needs & TC_NEEDS_NO_FUNCTION))
        bind_transfer(job, program);
    tc_pass_int(gl, program, "steps_per_pass", job->steps_per_pass);
    tc_pass_float(gl, program, "length_unit", job->length_unit);
    tc_pass_float(gl, program, "transmittance_stop", job->transmittance_stop);
    if (job->has_nan_color)
        tc_pass_vec4(gl, program, "nan_color", job->nan_color);
    if (job->effects)
        tc_effects_bind(job->effects, job, program);
}

void tc_march_bind_state(const tc_job *job, GLuint program, const tc_state_set *set)
{
    const tc_gl *gl = job->gl;
    tc_pass_texture(gl, program, "state_walk", TC_UNIT_WALK, GL_TEXTURE_2D, set->walk);
    tc_pass_texture(gl, program, "state_color", TC_UNIT_COLOR, GL_TEXTURE_2D, set->color);
    tc_pass_texture(gl, program, "state_at", TC_UNIT_AT, GL_TEXTURE_2D, set->at);
    if (job->count)
        tc_pass_texture(gl, program, "state_steps", TC_UNIT_STEPS, GL_TEXTURE_2D, set->steps);
    if (job->audit)
        tc_pass_texture(gl, program, "state_audit", TC_UNIT_AUDIT, GL_TEXTURE_2D, set->audit);
}

void tc_march_clear(const tc_job *job, int set)
{
    const tc_gl *gl = job->gl;
    /* An empty ray: no colour, no optical depth, or full transmittance. */
    const GLfloat empty[4] = {0, 0, 0, tc_job_holds_depth(job) ? 0.0f : 1.0f};
    const GLuint none[4] = {0, 0, 0, 0};
    gl->BindFramebuffer(GL_FRAMEBUFFER, job->state->set[set].framebuffer);
    gl->ClearBufferfv(GL_COLOR, TC_STATE_COLOR, empty);
    if (job->count)
        gl->ClearBufferuiv(GL_COLOR, TC_STATE_STEPS, none);
    if (job->audit)
        gl->ClearBufferuiv(GL_COLOR, TC_STATE_AUDIT, none);
}
