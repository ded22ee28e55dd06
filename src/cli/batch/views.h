/* views.h: "views" of a scene file: from where its pictures are made.
 *
 *   [{"name": "front", "position": [0, -9, 0], …}, …]   cameras. Keys are those of the scene's "camera" section
 * (position, focal_point, view_up, view_angle, parallel, parallel_scale, azimuth, elevation, roll, zoom,
 * clipping_range, window_center) and lie over the scene's own camera: what a view leaves out is as there, and the turns
 * come on top. "direction": [x, y, z], from the focal point to the eye, first puts the whole mesh in view from there.
 *   {"orbit": 12, "elevation": 20, "from": 0, "to": 360, "names": […]}   12 views round the focal point, about the
 * view-up, from and to in degrees (defaults 0 and 360), raised by the elevation (0). The end belongs to it, unless it
 * is the beginning again after full turns.
 *   {"phi": …, "theta": …, "names": […]}   a grid, theta running faster: azimuth and elevation about the focal point in
 *       degrees, each a list of numbers, {"from": A, "to": B, "count": N} as an orbit's, or N: for phi a full turn from
 * 0, for theta from -90 to 90 (N = 1: 0). One may be left out: 0. The view-up turns along, so that ±90 are views from
 * the poles.
 *   {"path": [camera, camera, …], "count": N, "closed": false, "names": […]}   N views along key cameras (2 and more),
 * with keys as in a list, but for the name, and "time" from 0 to 1, ascending, in all or in none (then evenly spread).
 *       Positions, focal points and view-ups follow vtkCameraInterpolator's spline: through every key, at rest at both
 *       ends; view-ups are unit vectors; angles, parallel scales, clipping ranges and window centres are linear between
 *       keys. Closed: from the last key back to the first, without a rest; the first view is not made again.
 *
 * {"cameras": [camera, …]} is the same as the list alone.
 *
 * "along": "time" beside orbit, path (in place of their number: "orbit": true, no "count") or cameras: view i belongs
 * to step i of those that are chosen alone, instead of every step having all views. There must then be as many cameras
 * as steps.
 *
 * phi = 0, theta = 0 is the scene's own camera; phi grows as --azimuth, theta as --elevation. */
#ifndef TC_CLI_BATCH_VIEWS_H
#define TC_CLI_BATCH_VIEWS_H

#include "cli/talk.h"

#include <jansson.h>

/* Views in all, and keys of a path. */
enum { TC_VIEWS_MOST = 1000000 };

typedef enum tc_views_kind {
    TC_VIEWS_NONE = 0, /* the scene's camera alone */
    TC_VIEWS_LIST,
    TC_VIEWS_ORBIT,
    TC_VIEWS_GRID,
    TC_VIEWS_PATH
} tc_views_kind;

/* What a camera's keys say; has: bits of those that are there. */
enum {
    TC_VIEW_POSITION = 1 << 0,
    TC_VIEW_FOCAL_POINT = 1 << 1,
    TC_VIEW_UP = 1 << 2,
    TC_VIEW_ANGLE = 1 << 3,
    TC_VIEW_PARALLEL = 1 << 4,
    TC_VIEW_SCALE = 1 << 5,
    TC_VIEW_AZIMUTH = 1 << 6,
    TC_VIEW_ELEVATION = 1 << 7,
    TC_VIEW_ROLL = 1 << 8,
    TC_VIEW_ZOOM = 1 << 9,
    TC_VIEW_CLIPPING = 1 << 10,
    TC_VIEW_WINDOW = 1 << 11,
    TC_VIEW_DIRECTION = 1 << 12,
    TC_VIEW_TIME = 1 << 13
};
typedef struct tc_view_keys {
    unsigned has;
    double position[3], focal_point[3], view_up[3], view_angle, parallel_scale;
    double azimuth, elevation, roll, zoom, clipping_range[2], window_center[2], direction[3];
    double time; /* of a path's key */
    bool parallel;
} tc_view_keys;

/* Written by views_read.c and view_keys.c alone. */
typedef struct tc_views {
    tc_views_kind kind;
    char *called; /* how errors name it: "scene.json:12: views.path" */
    bool along;   /* view i belongs to step i alone */
    bool closed;
    size_t n;              /* views; not of an orbit and a path along time */
    size_t n_key;          /* cameras of a list or a path */
    tc_view_keys *key;     /* [n_key] */
    size_t n_phi, n_theta; /* of an orbit (n_theta 1) and a grid */
    double *phi, *theta;   /* degrees; of an orbit along time NULL: from … to, at the elevation */
    double from, to, elevation;
    size_t n_name;
    char **name; /* [n_name], NULL: none; n_name 0: none at all */
} tc_views;

/* Reads json, which is only borrowed; NULL or null: TC_VIEWS_NONE. called stands in errors, which go on with the key's
 * path: "views[2].position" where called ends in "views". -1, or the exit code of an error that was printed; whatever
 * it is, tc_views_finish frees what is in *out. */
int tc_views_read(tc_views *out, const json_t *json, const char *called, tc_talk *talk);
void tc_views_finish(tc_views *views);

/* Views of a step; along time: of all n_along steps. TC_VIEWS_NONE: 1. */
size_t tc_views_count(const tc_views *views, size_t n_along);

/* Have the views along time as many cameras as there are steps? -1, or the exit code of an error that was printed. */
int tc_views_check(const tc_views *views, size_t n_along, tc_talk *talk);

/* The view's name: what is given, else "0001" for view 0, and so on. out [capacity]: cut to fit. */
void tc_view_name(char *out, size_t capacity, const tc_views *views, size_t i);
/* Is it one that is given? */
bool tc_view_is_named(const tc_views *views, size_t i);

/* Does nothing of view i say how large the mesh is in the picture and where? Then it makes room for title and bar. */
bool tc_view_is_free(const tc_views *views, size_t i);

/* The camera of view i, below tc_views_count(views, n_along).
 *   phi, theta  degrees, of an orbit or a grid; else NAN; may be NULL
 *   base        what the scene's "camera" options give
 *   bounds [6], aspect  of the mesh and the picture: for "direction"
 * -1, or the exit code of an error that was printed: the eye on the focal point, keys that do not go together. */
int tc_view_camera(tc_camera *out, double *phi, double *theta, const tc_views *views, size_t i, size_t n_along,
                   const tc_camera *base, const double bounds[6], double aspect, tc_talk *talk);

#endif
