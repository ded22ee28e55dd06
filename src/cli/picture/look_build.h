/* look_build.h: from the options of a look, a mesh and its file to a tc_look. */
#ifndef TC_CLI_LOOK_BUILD_H
#define TC_CLI_LOOK_BUILD_H

#include "cli/picture/categories.h"
#include "cli/json_out.h"
#include "cli/picture/render_options.h"

/* A look with all that it points to. */
typedef struct tc_look_parts {
    tc_look look;
    bool there; /* something is asked for: look is to be rendered with */
    tc_iso iso[TC_LOOK_MANY];
    tc_select select[TC_LOOK_MANY + 1];
    double range[4 * TC_LOOK_MANY][2]; /* of select, then of blocks, of which one name may stand for several */
    int n_field;
    tc_field *field[TC_LOOK_MANY + 2]; /* that select and color_field point to */
    double color_range[2];             /* that the colours of color_field are laid over */
    tc_transfer *color_function;
    tc_category_list categories; /* of the function that gives the colours; none: it has none */
    int n_file;                  /* geometry of files, the first ones of geometry; what the mesh gives follows */
    tc_geometry geometry[TC_LOOK_MANY + 3];
} tc_look_parts;

/* Makes the look for a prepared mesh, into parts that are all zeros. Called again with another step's mesh or values it
 * makes anew what depends on them; geometry of files and the colours of the second field stay. why a mesh or function
 * will not do is said. -1, or the exit code of an error that was printed. */
int tc_look_build(tc_look_parts *parts, tc_mesh *mesh, const tc_render_command *options, tc_talk *talk);
void tc_look_parts_finish(tc_look_parts *parts);

#endif
