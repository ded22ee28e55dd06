/* gl.c: fills the table of GL functions. */
#include "gpu/gl.h"

#include "gpu/watch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool tc_gl_setting(const char *name)
{
    const char *value = getenv(name);
    return value && *value && strcmp(value, "0") != 0;
}

tc_status tc_gl_load(tc_gl *gl, tc_get_proc get_proc, tc_error *err)
{
    memset(gl, 0, sizeof *gl);
    void *p;
#define X(type, name)                                                                                                  \
    p = get_proc("gl" #name);                                                                                          \
    if (!p)                                                                                                            \
        return tc_fail(err, TC_E_GL, "the GL context has no function gl" #name "; OpenGL 4.3 is needed");              \
    memcpy(&gl->name, &p, sizeof p);
    TC_GL_FUNCTIONS(X)
#undef X
    const char *renderer = (const char *)gl->GetString(GL_RENDERER);
    const char *version = (const char *)gl->GetString(GL_VERSION);
    if (!renderer || !version)
        return tc_fail(err, TC_E_GL, "no GL context is current");
    snprintf(gl->renderer, sizeof gl->renderer, "%s", renderer);
    snprintf(gl->version, sizeof gl->version, "%s", version);
    gl->GetIntegerv(GL_MAJOR_VERSION, &gl->major);
    gl->GetIntegerv(GL_MINOR_VERSION, &gl->minor);
    if (gl->major * 10 + gl->minor < 43)
        return tc_fail(err, TC_E_GL, "the GL context offers version %d.%d; 4.3 or later is needed", gl->major,
                       gl->minor);
    gl->GetIntegerv(GL_MAX_TEXTURE_SIZE, &gl->max_texture_size);
    gl->GetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &gl->max_texture_3d);
    gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &gl->max_texture_buffer);
    const char *fewer = getenv("TETCAST_GL_TEXELS"); /* with which tests make a large mesh of a small one */
    if (fewer && atoi(fewer) > 0 && atoi(fewer) < gl->max_texture_buffer)
        gl->max_texture_buffer = atoi(fewer);
    gl->GetIntegerv(GL_MAX_IMAGE_UNITS, &gl->max_image_units);
    gl->poison = tc_gl_setting("TETCAST_GL_POISON");
    return TC_OK;
}

tc_status tc_gl_check(const tc_gl *gl, const char *what, tc_error *err)
{
    GLenum first = gl->GetError();
    if (first == GL_NO_ERROR)
        return gl->watch ? tc_gl_watch_check(gl, what, err) : TC_OK;
    for (int i = 0; i < 16 && gl->GetError() != GL_NO_ERROR; i++)
        ;
    tc_status status = gl->watch ? tc_gl_watch_check(gl, what, err) : TC_OK; /* says more than the error's number */
    if (first == GL_OUT_OF_MEMORY)
        return tc_fail(err, TC_E_MEMORY, "GPU memory ran out while %s; use a smaller mesh, image or table", what);
    return status != TC_OK ? status : tc_fail(err, TC_E_GL, "GL error 0x%04X while %s", first, what);
}
