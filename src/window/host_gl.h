/* host_gl.h: addresses of OpenGL's functions in the context that GTK made, by EGL or GLX. */
#ifndef TC_WINDOW_HOST_GL_H
#define TC_WINDOW_HOST_GL_H

#include <stdbool.h>

/* With a context current: finds out by which of both it was made. From any thread, first from one alone. */
bool tc_host_gl_ready(void);
/* For tc_renderer_options.get_proc_address. */
void *tc_host_proc_address(const char *name);

#endif
