/* held.h: meshes and looks that several threads use: counted, and freed when the last one lets go. No GTK here. */
#ifndef TC_WINDOW_HELD_H
#define TC_WINDOW_HELD_H

#include "cli/picture/look_build.h"

/* A mesh, or a look together with the mesh that it is of. */
typedef struct tc_held tc_held;

/* Takes mesh or look, on success alone; NULL when memory is out. mesh of a look: is held along with it. */
tc_held *tc_held_mesh(tc_mesh *mesh);
tc_held *tc_held_look(tc_look_parts *look, tc_held *mesh);
/* From any thread. NULL is accepted. */
tc_held *tc_held_take(tc_held *held);
void tc_held_drop(tc_held **held);

#endif
