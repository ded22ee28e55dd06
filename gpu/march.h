/* march.h: what the drivers share: the program that walks rays (shaders/march.glsl), what it reads, and the state it
 * begins with. */
#ifndef TC_GPU_MARCH_H
#define TC_GPU_MARCH_H

#include "gpu/job.h"

/* Texture units of the state it reads. */
enum { TC_UNIT_WALK = 4, TC_UNIT_COLOR, TC_UNIT_AT, TC_UNIT_STEPS, TC_UNIT_AUDIT = 9 };

/* The program of the shader `file`, which includes march.glsl, with the job's integrator and stepper; compiled if need
 * be. vertex: the vertex shader, which in software hands the rays on (RAYS_FLAT); NULL where `file` is a compute shader.
 * Errors: TC_E_GL. */
tc_status tc_march_program(GLuint *program, const tc_job *job, const char *vertex, const char *file, tc_error *err);
/* Binds the pieces of the function, which pieces.glsl reads, to the program in use. */
void tc_march_bind_pieces(const tc_job *job, GLuint program);
/* Puts the program in use and binds all that it reads but the state. */
void tc_march_bind(const tc_job *job, GLuint program);
/* Binds the state to read. The program must be in use. */
void tc_march_bind_state(const tc_job *job, GLuint program, const tc_state_set *set);
/* Empties what rays have gathered, in a state set: its colour, steps and audit. Binds its framebuffer. */
void tc_march_clear(const tc_job *job, int set);

#endif
