/* program.h: GL programs assembled from the real .glsl files that are embedded at build time. */
#ifndef TC_GPU_PROGRAM_H
#define TC_GPU_PROGRAM_H

#include "gpu/gl.h"

typedef struct tc_shader_file {
    const char *name, *text;
} tc_shader_file;

/* Every shader file; {NULL, NULL} ends the list. */
extern const tc_shader_file tc_shader_files[];

/* What a program is made of: a vertex and a fragment shader, or, with vertex NULL, a compute shader in the place of the
 * fragment shader. `defines` are lines such as "#define PEEL\n" (may be ""); `alias` is pairs of include
 * names, "integrator.glsl=integrate_table.glsl stepper.glsl=stepper_planes.glsl" (the first of each is read as the
 * second), or NULL. `effects` are names of shader files, each once, with spaces between them, or NULL: see below. */
typedef struct tc_program_source {
    const char *vertex, *fragment;
    const char *defines;
    const char *alias;
    const char *effects;
} tc_program_source;

typedef struct tc_program_cache tc_program_cache;

/* Programs live in the cache; equal final text gives the same program. */
tc_status tc_program_cache_create(tc_program_cache **out, const tc_gl *gl, tc_error *err);
/* Errors: TC_E_GL with the compiler's first message as file:line. The time it takes is added to tc_program_cache_ms. */
tc_status tc_program_get(GLuint *program, tc_program_cache *cache, const tc_program_source *source, tc_error *err);
/* All compiling and linking so far, in ms. */
double tc_program_cache_ms(const tc_program_cache *cache);
/* The texts that were asked for since tc_program_cache_mark: name (of the fragment or compute shader) and bytes of program k, the
 * stages together; false beyond the last. */
bool tc_program_cache_used(const char **name, size_t *bytes, const tc_program_cache *cache, size_t k);
void tc_program_cache_mark(tc_program_cache *cache);
void tc_program_cache_destroy(tc_program_cache **cache);

/* The text of one shader stage: version line, defines, the file with #include resolved once each. malloc'd. `alias`
 * replaces include names by others ("integrator.glsl=integrate_table.glsl", with a space between two such pairs).
 *
 * Places. A line of a shader may end in a place for effects: behind "CODE //@then PLACE" their sections of that name are
 * put, in the order of `effects`; lines "CODE //@or PLACE" give way to the section of one of them. A line may
 * have one of each, in this order: "CODE //@or PLACE //@then PLACE". A file of an effect
 * consists of sections, each from a line "//@section PLACE" to the next, and they hold includes and places in turn; what
 * stands before the first one is for readers. The marks themselves never reach the compiler: with no effects the text is
 * that of shaders without places, byte by byte.
 * Errors: TC_E_GL (also where two effects take one place), TC_E_MEMORY. */
tc_status tc_program_text(char **out, const char *file, const char *defines, const char *alias, const char *effects,
                          tc_error *err);

#endif
