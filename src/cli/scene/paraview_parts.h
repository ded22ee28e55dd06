/* paraview_parts.h: the parts of which a scene is made from a ParaView state; each of them puts its own section. */
#ifndef TC_CLI_PARAVIEW_PARTS_H
#define TC_CLI_PARAVIEW_PARTS_H

#include "cli/scene/paraview.h"

typedef struct tc_pv_build {
    const tc_pv *pv;
    const char *path;
    bool wants_data;
    json_t *scene;
    tc_paraview_notes *notes;
    tc_talk *talk;
} tc_pv_build;

/* Sets a key of a section ("": of the scene itself), which is made when it is needed; takes value over. */
void tc_pv_put(tc_pv_build *b, const char *section, const char *key, json_t *value);

/* paraview_camera.c: "camera" of a view's properties; "views" where an animation moves it. */
void tc_pv_camera(tc_pv_build *b, const tc_pv_proxy *view);
void tc_pv_camera_path(tc_pv_build *b, const tc_pv_proxy *view);

/* paraview_function.c: "transfer_function" of a representation. */
void tc_pv_function(tc_pv_build *b, const tc_pv_proxy *representation);

/* paraview_source.c: "data" and "time" of what a representation shows; its filters are noted. -1, or an exit code. */
int tc_pv_source(tc_pv_build *b, const tc_pv_proxy *representation, const tc_pv_proxy *view);

#endif
