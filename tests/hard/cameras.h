/* cameras.h: the views of the catalogue, made from a mesh: eyes and rays where signs are zero. */
#ifndef TC_TESTS_HARD_CAMERAS_H
#define TC_TESTS_HARD_CAMERAS_H

#include "meshes.h"

typedef struct hard_view {
    const char *name;
    tc_camera camera;
    int width, height;
    bool grazing; /* rays pass faces so nearly in them that true lengths and colours say nothing: the walk is judged by
                     exact arithmetic on the floats it sees */
    bool whole;   /* rays are whole lines: the eye is outside and nothing is clipped */
} hard_view;

/* How many there are, and their names. */
size_t hard_view_count(void);
const char *hard_view_name(size_t index);
/* Only for long runs: the picture is large whatever size is asked for. */
bool hard_view_is_large(size_t index);
/* View number index of a mesh that was not refused, `size` pixels high and wide where the view does not say otherwise.
 * False: this mesh has no such place (an imaginary cell, a cavity). */
bool hard_view_make(hard_view *out, size_t index, const hard_mesh *mesh, int size);

#endif
