/* pass.c: small tools for drawing a pass. */
#include "gpu/pass.h"

void tc_pass_int(const tc_gl *gl, GLuint program, const char *name, int value)
{
    gl->Uniform1i(gl->GetUniformLocation(program, name), value);
}

void tc_pass_float(const tc_gl *gl, GLuint program, const char *name, double value)
{
    gl->Uniform1f(gl->GetUniformLocation(program, name), (float)value);
}

void tc_pass_vec2(const tc_gl *gl, GLuint program, const char *name, double x, double y)
{
    gl->Uniform2f(gl->GetUniformLocation(program, name), (float)x, (float)y);
}

void tc_pass_vec4(const tc_gl *gl, GLuint program, const char *name, const double *value)
{
    float v[4] = {(float)value[0], (float)value[1], (float)value[2], (float)value[3]};
    gl->Uniform4fv(gl->GetUniformLocation(program, name), 1, v);
}

static void set_dvec3(const tc_gl *gl, GLuint program, const char *name, const double *v)
{
    gl->Uniform3d(gl->GetUniformLocation(program, name), v[0], v[1], v[2]);
}

void tc_pass_frame(const tc_gl *gl, GLuint program, const tc_frame *frame)
{
    set_dvec3(gl, program, "ray_point", frame->point);
    set_dvec3(gl, program, "ray_point_dx", frame->point_dx);
    set_dvec3(gl, program, "ray_point_dy", frame->point_dy);
    set_dvec3(gl, program, "ray_direction", frame->direction);
    set_dvec3(gl, program, "ray_direction_dx", frame->direction_dx);
    set_dvec3(gl, program, "ray_direction_dy", frame->direction_dy);
    tc_pass_float(gl, program, "ray_near", frame->near_t);
    tc_pass_float(gl, program, "ray_far", frame->far_t);
    gl->Uniform3f(gl->GetUniformLocation(program, "ray_up"), (float)frame->up[0], (float)frame->up[1],
                  (float)frame->up[2]);
    tc_pass_vec2(gl, program, "ray_part", frame->part[0], frame->part[1]);
}

void tc_pass_texture(const tc_gl *gl, GLuint program, const char *name, GLuint unit, GLenum target, GLuint texture)
{
    gl->ActiveTexture(GL_TEXTURE0 + unit);
    gl->BindTexture(target, texture);
    gl->Uniform1i(gl->GetUniformLocation(program, name), (GLint)unit);
}

void tc_pass_fetch(const tc_gl *gl, GLuint program, const char *name, GLuint unit, GLenum format, GLuint texture,
                   bool images)
{
    if (images)
        gl->BindImageTexture(unit, texture, 0, GL_FALSE, 0, GL_READ_ONLY, format);
    else
        tc_pass_texture(gl, program, name, unit, GL_TEXTURE_BUFFER, texture);
}

GLuint tc_pass_new_texture(const tc_gl *gl, int width, int height, GLenum internal, GLenum format, GLenum type)
{
    GLuint texture;
    gl->GenTextures(1, &texture);
    gl->BindTexture(GL_TEXTURE_2D, texture);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    gl->TexImage2D(GL_TEXTURE_2D, 0, (GLint)internal, width, height, 0, format, type, NULL);
    return texture;
}

void tc_pass_screen(const tc_gl *gl)
{
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
}
