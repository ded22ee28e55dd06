/* pass.h: small tools for drawing a pass: uniforms, textures and the full screen. */
#ifndef TC_GPU_PASS_H
#define TC_GPU_PASS_H

#include "gpu/frame.h"
#include "gpu/gl.h"

/* Sets a uniform of the program in use; one the compiler removed is skipped. */
void tc_pass_int(const tc_gl *gl, GLuint program, const char *name, int value);
void tc_pass_float(const tc_gl *gl, GLuint program, const char *name, double value);
void tc_pass_vec2(const tc_gl *gl, GLuint program, const char *name, double x, double y);
void tc_pass_vec4(const tc_gl *gl, GLuint program, const char *name, const double *value);
/* The ray uniforms of ray.glsl. */
void tc_pass_frame(const tc_gl *gl, GLuint program, const tc_frame *frame);
/* Binds a texture to a unit and the sampler `name` to it. */
void tc_pass_texture(const tc_gl *gl, GLuint program, const char *name, GLuint unit, GLenum target, GLuint texture);
/* The same for a buffer texture that fetch.glsl declares: as a texture of that unit, or, with images, as image `unit`.
 */
void tc_pass_fetch(const tc_gl *gl, GLuint program, const char *name, GLuint unit, GLenum format, GLuint texture,
                   bool images);
/* A new texture of one texel a pixel, left bound; what is in it is anything. */
GLuint tc_pass_new_texture(const tc_gl *gl, int width, int height, GLenum internal, GLenum format, GLenum type);
/* One triangle over the viewport (screen.vert). */
void tc_pass_screen(const tc_gl *gl);

#endif
