/* host_gl.h: addresses of OpenGL's functions in the context that GTK made, by EGL or GLX. */
#ifndef TC_WINDOW_HOST_GL_H
#define TC_WINDOW_HOST_GL_H

#include <gtk/gtk.h>
#include <stdbool.h>

/* Does the display give contexts of OpenGL 4.3? Else false, and why in a sentence without an end. *software: a CPU does the
 * work of the GPU. */
bool tc_host_gl_try(GdkDisplay *display, bool *software, char why[512]);

/* With a context current: finds out by which of both it was made. From any thread, first from one alone. */
bool tc_host_gl_ready(void);
/* For tc_renderer_options.get_proc_address. */
void *tc_host_proc_address(const char *name);

#endif
