/* job.h: everything one frame needs, resolved: what a GL driver is handed. */
#ifndef TC_GPU_JOB_H
#define TC_GPU_JOB_H

#include "gpu/frame.h"
#include "gpu/program.h"
#include "gpu/propose.h"
#include "gpu/state.h"
#include "gpu/upload.h"

typedef struct tc_gl_driver tc_gl_driver;

typedef struct tc_job {
    const tc_gl *gl;
    const tc_gl_driver *driver;
    tc_program_cache *programs;
    const tc_state *state;
    const tc_gpu_mesh *mesh;
    const tc_gpu_transfer *transfer;
    const tc_frame *frame;
    double view[4]; /* of the point at depth z on a ray of direction d: distance (view . d) z + view[3] from the eye's
                       plane, in the mesh's unit; of this frame */
    const tc_proposals *proposals; /* of this frame */
    GLuint hit_array, hit_buffer;  /* vertex array and buffer for them */
    GLuint entry_counter;          /* buffer of first_hit.frag's counters */
    GLuint march_counter;          /* … of march.comp's */
    GLuint screen_array;           /* an empty vertex array */

    tc_integrator integrator;                    /* TABLE, INTEGRAL or EXACT */
    bool has_imaginary, peel, cell_data, extend; /* extend: data reach beyond the transfer function's knots */
    double length_unit;                          /* half diagonals → unit distances */
    double transmittance_stop;                   /* 1 - opacity stop; negative: never */
    double map[2];                               /* packed scalar → x = s*map[0] + map[1] */
    double texel[3][2];                          /* table: coordinate → texture coordinate, by axis */
    double grid[2];                              /* running integrals: intervals between nodes, length of one */
    bool drift;                                  /* the table is one of drift.h, and below is what it needs: */
    double octave[3];  /* unit distances → octaves of its length axis; those → texture coordinate */
    double tf_most[3]; /* largest r, g, b of the function */
    double near;       /* running integrals: smallest difference */
    int order;         /* running integrals: 1 or 2 */
    double split;      /* … segments are cut to this optical depth; 0: never */
    double hard;       /* … segments whose drift adds more are integrated exactly; 0: none are; */
    double hard_depth; /* … and those of more optical depth, or */
    double hard_relative;
    double hard_slope;  /* … of a length that is more than that many times its difference of x */
    bool dense;         /* … a segment of one may have an optical depth above 1 */
    bool twice;         /* exact: two rounds of pieces a step */
    int n_piece;        /* exact, hard: pieces of the function */
    bool steps;         /* drift, exact, hard: the function has steps */
    bool nonfinite;     /* some scalars are NaN: their cells contribute nothing, */
    bool has_nan_color; /* … or nan_color: r, g, b, attenuation per unit distance */
    double nan_color[4];
    double most[3]; /* largest r, g, b that a ray may meet */
    double mean[4]; /* running integrals: mean slope */

    int steps_per_pass, z_update_every; /* z_update_every < 0: never lock */
    bool count, audit;                  /* audit counts as well */
    bool clear;                         /* the function shows none of the values: rays are counted, none is walked */
    bool planes;                        /* the stepper is the paper's arithmetic: stepper_planes.glsl, */
    double longest;                     /* … which needs to know the longest edge of the real cells, in mesh space */
    int last;                           /* as tc_job_result has it, for what comes behind the walk */
    bool masked;                        /* only the pixels that state->mask marks have a ray */
    bool software;                      /* the renderer runs on the CPU: fetch.glsl, signs.glsl */
    const struct tc_effects *effects;   /* effect.h; NULL: none */
    const struct tc_kept_view *kept;    /* kept.h: what the walks go along; NULL: rays are walked */
} tc_job;

typedef struct tc_job_result {
    double ms_first_hit, ms_march;
    int passes, z_updates, layers; /* passes: dispatches of compute */
    int64_t rays, rays_lost;
    int last;      /* the state set that holds the rays at their ends, walk and colour; counting: set 0 */
    int64_t twice; /* without peeling: entries beyond the first of their rays; if there are any, no picture was made */
    int64_t *fragments; /* [passes], only when counting; caller frees */
} tc_job_result;

/* A way to walk the rays of a frame. */
struct tc_gl_driver {
    const char *name;
    bool locks; /* finished rays, by z-updates between passes */
    /* Compiles what the frame will use, so that the frame's time holds no compiling. Errors: TC_E_GL. */
    tc_status (*compile)(const tc_job *job, tc_error *err);
    /* First hit and march of one frame; leaves what rays gathered in state set `last`, which is 0 where they were counted or audited. Binds
     * framebuffers. Errors: TC_E_GL, TC_E_MEMORY. Lost rays are counted, not an error here. */
    tc_status (*frame)(tc_job_result *out, const tc_job *job, tc_error *err);
};

/* Does the fourth channel of a ray's colour hold optical depth, or else transmittance? */
bool tc_job_holds_depth(const tc_job *job);
/* Program text options of a job: "#define …" lines into out. */
void tc_job_defines(char *out, size_t capacity, const tc_job *job);
/* Sets what march and first hit share: rays, mesh textures (units 0, 1, 3). The program must be in use. */
void tc_job_bind_mesh(const tc_job *job, GLuint program);

#endif
