/* gl_program.h: what unit tests of the shaders share: contexts to try, textures to draw to, and programs that run a
 * fragment shader once for every pixel. What GL refuses ends the test with GL's own words. Include after cmocka. */
#ifndef TC_TESTS_COMMON_GL_PROGRAM_H
#define TC_TESTS_COMMON_GL_PROGRAM_H

#include "gpu/context.h"
#include "gpu/program.h"

#include <stdio.h>

enum { GL_CONTEXTS = 2 };
static const char *const gl_context_names[GL_CONTEXTS] = {"osmesa", "egl"};

/* False where the context is missing; says why. */
static inline bool gl_open(tc_context **out, const char *name)
{
    tc_error err = {0};
    if (tc_context_create(out, name, NULL, &err) != TC_OK) {
        printf("    %s: %s\n", name, err.text);
        return false;
    }
    return true;
}

/* An empty texture that shaders may fetch from or draw to, e.g. GL_RGBA32F, GL_RGBA, GL_FLOAT. It stays bound. */
static inline GLuint gl_texture(const tc_gl *gl, GLint internal, GLenum format, GLenum type, int width, int height)
{
    GLuint texture;
    gl->GenTextures(1, &texture);
    gl->BindTexture(GL_TEXTURE_2D, texture);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl->TexImage2D(GL_TEXTURE_2D, 0, internal, width, height, 0, format, type, NULL);
    return texture;
}

/* Where programs draw: output i to the i-th texture. */
typedef struct gl_target {
    GLuint framebuffer, array;
    int width, height;
} gl_target;

enum { GL_TARGET_TEXTURES = 2 }; /* at most */

/* The textures stay the caller's, and have that size. */
static inline gl_target gl_target_of(const tc_gl *gl, const GLuint *texture, int n, int width, int height)
{
    gl_target t = {.width = width, .height = height};
    GLenum buffer[GL_TARGET_TEXTURES];
    assert_in_range(n, 1, GL_TARGET_TEXTURES);
    gl->GenFramebuffers(1, &t.framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, t.framebuffer);
    for (int i = 0; i < n; i++) {
        buffer[i] = GL_COLOR_ATTACHMENT0 + (GLenum)i;
        gl->FramebufferTexture(GL_FRAMEBUFFER, buffer[i], texture[i], 0);
    }
    gl->DrawBuffers(n, buffer);
    gl->GenVertexArrays(1, &t.array);
    gl->BindVertexArray(t.array);
    gl->Viewport(0, 0, width, height);
    gl->Disable(GL_DEPTH_TEST);
    return t;
}

static inline void gl_target_finish(gl_target *t, const tc_gl *gl)
{
    gl->DeleteFramebuffers(1, &t->framebuffer);
    gl->DeleteVertexArrays(1, &t->array);
}

/* Texture i's pixels to out [height][width]; fails the test where GL met an error by then. */
static inline void gl_target_read(void *out, const gl_target *t, const tc_gl *gl, int i, GLenum format, GLenum type)
{
    tc_error err = {0};
    gl->ReadBuffer(GL_COLOR_ATTACHMENT0 + (GLenum)i);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl->ReadPixels(0, 0, t->width, t->height, format, type, out);
    if (tc_gl_check(gl, "the test", &err) != TC_OK)
        fail_msg("%s", err.text);
}

/* tc_program_text, or the test fails. */
static inline char *gl_shader_text(const char *file, const char *defines, const char *alias)
{
    char *text;
    tc_error err = {0};
    if (tc_program_text(&text, file, defines, alias, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    return text;
}

/* One shader of n texts behind each other. */
static inline GLuint gl_shader(const tc_gl *gl, GLenum stage, const char *const *text, int n)
{
    GLuint shader = gl->CreateShader(stage);
    gl->ShaderSource(shader, n, text, NULL);
    gl->CompileShader(shader);
    GLint ok = 0;
    gl->GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (!ok) {
        char log[2048] = "";
        gl->GetShaderInfoLog(shader, sizeof log, NULL, log);
        fail_msg("%s", log);
    }
    return shader;
}

/* A program that draws every pixel (tc_pass_screen) by the fragment shader of n texts behind each other. */
static inline GLuint gl_screen_program(const tc_gl *gl, const char *const *fragment, int n)
{
    /* Not screen.vert: face_id is an input of first_hit.frag. */
    static const char *const vertex =
        "#version 430 core\n"
        "flat out int face_id;\n"
        "void main()\n"
        "{\n"
        "    face_id = 0;\n"
        "    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);\n"
        "}\n";
    GLuint v = gl_shader(gl, GL_VERTEX_SHADER, &vertex, 1), f = gl_shader(gl, GL_FRAGMENT_SHADER, fragment, n);
    GLuint program = gl->CreateProgram();
    gl->AttachShader(program, v);
    gl->AttachShader(program, f);
    gl->LinkProgram(program);
    GLint ok = 0;
    gl->GetProgramiv(program, GL_LINK_STATUS, &ok);
    assert_true(ok);
    gl->DeleteShader(v);
    gl->DeleteShader(f);
    return program;
}

#endif
