/* job.c: what the programs of one job share. */
#include "gpu/job.h"

#include "gpu/pass.h"

#include <stdio.h>

bool tc_job_holds_depth(const tc_job *job)
{
    return job->integrator != TC_INTEGRATOR_TABLE || job->drift;
}

void tc_job_defines(char *out, size_t capacity, const tc_job *job)
{
    bool running = job->integrator == TC_INTEGRATOR_INTEGRAL;
    snprintf(out, capacity, "%s%s%s%s%s%s%s%s%s%s%s%s%s%s%s%s%s%s%s",
             job->has_imaginary ? "#define HAS_IMAGINARY\n" : "", job->peel ? "#define PEEL\n" : "",
             job->cell_data ? "#define CELL_DATA\n" : "", job->extend ? "#define TF_EXTEND\n" : "",
             job->frame->clip_near ? "#define CLIP_NEAR\n" : "", job->frame->clip_far ? "#define CLIP_FAR\n" : "",
             job->frame->ahead ? "#define ENTRY_AHEAD\n" : "",
             tc_job_holds_depth(job) ? "#define COLOR_HOLDS_DEPTH\n" : "", job->count ? "#define COUNT\n" : "",
             job->audit ? "#define AUDIT\n" : "", job->nonfinite ? "#define NONFINITE\n" : "",
             job->steps ? "#define TF_STEPS\n" : "", job->has_nan_color ? "#define NAN_COLOR\n" : "",
             job->software ? "#define SOFTWARE\n" : "", running && job->order == 1 ? "#define TF_FIRST_ORDER\n" : "",
             running && job->split > 0 ? "#define TF_SPLIT\n" : "", running && job->hard > 0 ? "#define TF_HARD\n" : "",
             job->dense ? "#define PIECES_DENSE\n" : "", job->twice ? "#define PIECES_TWICE\n" : "");
}

void tc_job_bind_mesh(const tc_job *job, GLuint program)
{
    const tc_gl *gl = job->gl;
    tc_pass_frame(gl, program, job->frame);
    if (!job->planes)
        tc_pass_fetch(gl, program, "mesh_cells", 0, GL_RGBA32I, job->mesh->cells.texture, job->software);
    tc_pass_fetch(gl, program, "mesh_vertices", 1, GL_RGBA32F, job->mesh->vertices.texture, job->software);
    if (job->cell_data)
        tc_pass_texture(gl, program, "mesh_cell_scalar", 3, GL_TEXTURE_BUFFER, job->mesh->cell_scalar.texture);
    if (job->has_imaginary && !job->planes)
        tc_pass_int(gl, program, "mesh_real", (int)job->mesh->n_real);
}
