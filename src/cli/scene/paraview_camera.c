/* paraview_camera.c: ParaView's cameras as a scene's: of a view, of a camera file, of an animation's key frames. */
#include "cli/scene/paraview_parts.h"
#include "cli/options.h"

#include <stdio.h>

static json_t *tc_vector(const double *v)
{
    return json_pack("[fff]", v[0], v[1], v[2]);
}

/* A camera from properties whose names begin with prefix: "Camera" of a view, "" of a key frame. parallel: 1, 0; -1:
 * the properties tell. */
static json_t *tc_camera_of(const tc_pv *pv, const tc_pv_proxy *proxy, const char *prefix, int parallel)
{
    static const struct {
        const char *property, *key;
    } vector[] = {{"Position", "position"}, {"FocalPoint", "focal_point"}, {"ViewUp", "view_up"}};
    json_t *camera = json_object();
    double value[3];
    char name[64];
    for (size_t i = 0; i < sizeof vector / sizeof *vector; i++) {
        snprintf(name, sizeof name, "%s%s", prefix, vector[i].property);
        if (tc_pv_reals(value, 3, pv, proxy, name))
            json_object_set_new(camera, vector[i].key, tc_vector(value));
    }
    snprintf(name, sizeof name, "%sParallelProjection", prefix);
    const bool flat = parallel < 0 ? tc_pv_is_on(pv, proxy, name) : parallel > 0;
    snprintf(name, sizeof name, "%s%s", prefix, flat ? "ParallelScale" : "ViewAngle");
    if (tc_pv_reals(value, 1, pv, proxy, name))
        json_object_set_new(camera, flat ? "parallel_scale" : "view_angle", json_real(value[0]));
    return camera;
}

void tc_pv_camera(tc_pv_build *b, const tc_pv_proxy *view)
{
    json_t *camera = tc_camera_of(b->pv, view, "Camera", -1);
    if (!json_object_get(camera, "position") || !json_object_get(camera, "focal_point"))
        tc_paraview_note(b->notes, "%s has no whole camera: what it has of one is taken",
                         tc_pv_name(b->pv, view, "views"));
    if (json_object_size(camera) > 0)
        json_object_set_new(b->scene, "camera", camera);
    else
        json_decref(camera);
}

/* ------------------------------------------------------------------------------------------------------- animations */

/* Point i of a list of them; false: it is none. */
static bool tc_point(double out[3], const tc_pv *pv, const tc_pv_proxy *key, const char *name, size_t i)
{
    for (size_t c = 0; c < 3; c++)
        if (!tc_parse_real(&out[c], tc_pv_value(pv, key, name, 3 * i + c)))
            return false;
    return true;
}

/* Points of a key frame's own path: each a camera that looks at the one focal point, or at its own. false: it has none
 * of these. */
static bool tc_path_of_points(json_t *path, const tc_pv *pv, const tc_pv_proxy *key, const tc_pv_proxy *view)
{
    const size_t n = tc_pv_values(pv, key, "PositionPathPoints") / 3, m = tc_pv_values(pv, key, "FocalPathPoints") / 3;
    json_t *common = tc_camera_of(pv, key, "", tc_pv_is_on(pv, view, "CameraParallelProjection"));
    bool good = n > 1 && (m == 1 || m == n || (m == 0 && json_object_get(common, "focal_point")));
    for (size_t i = 0; i < n && good; i++) {
        double position[3], focal_point[3];
        json_t *camera = json_copy(common);
        good = tc_point(position, pv, key, "PositionPathPoints", i) &&
               (m == 0 || tc_point(focal_point, pv, key, "FocalPathPoints", m == 1 ? 0 : i));
        if (good)
            json_object_set_new(camera, "position", tc_vector(position));
        if (good && m > 0)
            json_object_set_new(camera, "focal_point", tc_vector(focal_point));
        json_array_append_new(path, camera);
    }
    json_decref(common);
    return good;
}

/* The path of a cue that is animated; NULL: it is none that is known. */
static json_t *tc_path_of_cue(const tc_pv *pv, const tc_pv_proxy *cue, const tc_pv_proxy *view)
{
    const size_t n = tc_pv_links(pv, cue, "KeyFrames");
    const int parallel = tc_pv_is_on(pv, view, "CameraParallelProjection");
    double mode = 0, time;
    json_t *path = json_array();
    bool good = n > 0, closed = false;
    tc_pv_reals(&mode, 1, pv, cue, "Mode");
    if (mode == 1) { /* the first key frame holds a path of points; the last says where in time it ends */
        const tc_pv_proxy *key = tc_pv_link(pv, cue, "KeyFrames", 0);
        good = good && n <= 2 && tc_path_of_points(path, pv, key, view);
        closed = tc_pv_is_on(pv, key, "ClosedPositionPath");
    } else {
        good = good && mode == 0 && n > 1;
        for (size_t i = 0; i < n && good; i++) {
            const tc_pv_proxy *key = tc_pv_link(pv, cue, "KeyFrames", i);
            json_t *camera = tc_camera_of(pv, key, "", parallel);
            good = json_object_get(camera, "position") && json_object_get(camera, "focal_point");
            if (tc_pv_reals(&time, 1, pv, key, "KeyTime"))
                json_object_set_new(camera, "time", json_real(time));
            json_array_append_new(path, camera);
        }
    }
    if (!good) {
        json_decref(path);
        return NULL;
    }
    json_t *views = json_pack("{s:o, s:s}", "path", path, "along", "time");
    if (closed)
        json_object_set_new(views, "closed", json_true());
    return views;
}

void tc_pv_camera_path(tc_pv_build *b, const tc_pv_proxy *view)
{
    const tc_pv *pv = b->pv;
    for (size_t i = 0; i < pv->n_proxy; i++) {
        const tc_pv_proxy *cue = &pv->proxy[i];
        const tc_pv_proxy *what = tc_pv_link(pv, cue, "AnimatedProxy", 0);
        if (!tc_pv_is(pv, cue->group, "animation") || !what || tc_pv_links(pv, cue, "KeyFrames") == 0 ||
            !tc_pv_is_on(pv, cue, "Enabled"))
            continue;
        if (!tc_pv_is(pv, cue->type, "CameraAnimationCue")) {
            const char *property = tc_pv_value(pv, cue, "AnimatedPropertyName", 0);
            tc_paraview_note(b->notes, "the animation of %.80s of %.80s is left out",
                             *property ? property : "a property", tc_pv_name(pv, what, NULL));
        } else if (what == view) {
            json_t *views = tc_path_of_cue(pv, cue, view);
            if (views)
                json_object_set_new(b->scene, "views", views);
            else
                tc_paraview_note(b->notes, "the camera's animation is of a kind that is not known, and left out: key "
                                           "frames and one path are taken");
        }
    }
}
