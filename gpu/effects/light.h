/* light.h: the lights of a look, for whatever they fall on. */
#ifndef TC_GPU_LIGHT_H
#define TC_GPU_LIGHT_H

#include "gpu/effect.h"

/* Lines "#define …" that light.glsl goes by. */
void tc_light_define(char *out, size_t capacity, const tc_shade *shade);
/* Sets its uniforms; one that the compiler removed is skipped. The program must be in use. */
void tc_light_bind(const tc_gl *gl, GLuint program, const tc_shade *shade);
/* The largest r, g, b that they make of colours up to most. */
void tc_light_brighten(double most[3], const tc_shade *shade);

#endif
