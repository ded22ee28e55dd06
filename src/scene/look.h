/* look.h: what may be wrong with a look (tetcast_look.h), and whether it asks for anything. */
#ifndef TC_SCENE_LOOK_H
#define TC_SCENE_LOOK_H

#include "core/status.h"

enum { TC_LOOK_ISOS = 64, TC_LOOK_LIGHTS = 16 }; /* at most, of a look that tc_look_wrong lets pass */

/* NULL, or nothing beyond the plain density emitter: a picture without it is the same. Of looks that tc_look_wrong lets
 * pass. Light that falls on nothing, and geometry without triangles and lines, ask for nothing. */
bool tc_look_is_plain(const tc_look *look);

/* Is the volume lit, or the isosurfaces: is there light, is it meant for them, and are they there? Geometry is not
 * asked about: it has no gradient. */
bool tc_look_lights_volume(const tc_look *look);
bool tc_look_lights_surfaces(const tc_look *look);

#endif
