/* export.c: writes cases of the catalogue for other programs. */
#include "export.h"

#include "core/file.h"
#include "core/memory.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 128, FUNCTION_SMOOTH = 2 };

/* Views that VTK knows: it has no clipping of volumes by distance, and square pictures are asked for. */
static bool is_common(const hard_view *view)
{
    return view->camera.clip_near == 0 && view->camera.clip_far == 0 && view->width == view->height &&
           view->width > 1 && view->width < 2 * SIZE && !view->grazing;
}

static json_t *json_point(const double *p)
{
    return json_pack("[f,f,f]", p[0], p[1], p[2]);
}

static json_t *json_case(const char *name, const hard_mesh *mesh, const hard_view *view, const hard_function *f,
                         size_t ill_posed)
{
    size_t n;
    const tc_knot *knot = tc_transfer_knots(f->tf, &n);
    const tc_camera *c = &view->camera;
    json_t *knots = json_array();
    for (size_t i = 0; i < n; i++)
        json_array_append_new(knots, json_pack("[f,f,f,f,f]", knot[i].s, knot[i].r, knot[i].g, knot[i].b, knot[i].a));
    json_t *camera =
        json_pack("{s:o s:o s:o s:f}", "position", json_point(c->position), "focal_point", json_point(c->focal_point),
                  "view_up", json_point(c->view_up), "view_angle", c->view_angle);
    if (c->parallel)
        json_object_set_new(camera, "parallel_scale", json_real(c->parallel_scale));
    return json_pack("{s:s s:[i,i] s:f s:b s:I s:o s:o}", "name", name, "size", view->width, view->height,
                     "unit_distance", mesh->unit, "eye_inside", !view->whole, "ill_posed", (json_int_t)ill_posed,
                     "camera", camera, "knots", knots);
}

static tc_status write_pixels(const char *path, const tc_image *image, tc_error *err)
{
    return tc_file_replace(path, image->rgba, (size_t)image->width * (size_t)image->height * 4 * sizeof *image->rgba,
                           err);
}

static tc_status export_case(const char *stem, const char *name, const hard_mesh *mesh, const hard_view *view,
                             const hard_function *f, tc_renderer *renderer, tc_error *err)
{
    char path[1200];
    tc_rays rays;
    tc_render_options options;
    tc_verify_result judged = {0};
    tc_image *truth = NULL, *ours = NULL;
    tc_render_defaults(&options);
    options.width = view->width;
    options.height = view->height;
    options.unit_distance = mesh->unit;
    tc_status status = tc_rays_from_camera(&rays, &view->camera, view->width, view->height, err);
    if (status == TC_OK)
        status = tc_image_create(&truth, view->width, view->height, err);
    if (status == TC_OK)
        status = tc_reference_render(truth, mesh->reference, f->tf, mesh->unit, &rays, 0, NULL, err);
    if (status == TC_OK)
        status = tc_render(&ours, NULL, renderer, mesh->mesh, f->tf, &view->camera, &options, NULL, err);
    if (status == TC_OK)
        status =
            tc_reference_verify(&judged, NULL, ours, SIZE_MAX, 1, mesh->reference, f->tf, mesh->unit, &rays, 0, NULL, err);
    if (status == TC_OK) {
        snprintf(path, sizeof path, "%s.reference.rgba", stem);
        status = write_pixels(path, truth, err);
    }
    if (status == TC_OK) {
        snprintf(path, sizeof path, "%s.tetcast.rgba", stem);
        status = write_pixels(path, ours, err);
    }
    if (status == TC_OK) {
        tc_mesh *as_made = NULL; /* not repaired: others are to see what we were given */
        snprintf(path, sizeof path, "%s.vtu", stem);
        status = tc_mesh_create(&as_made, &mesh->source.arrays, err);
        if (status == TC_OK)
            status = tc_mesh_write_vtu(as_made, path, err);
        tc_mesh_destroy(&as_made);
    }
    if (status == TC_OK) {
        json_t *o = json_case(name, mesh, view, f, judged.ill_posed);
        char *text = o ? json_dumps(o, JSON_INDENT(1)) : NULL;
        snprintf(path, sizeof path, "%s.json", stem);
        status = text ? tc_file_replace(path, text, strlen(text), err) : tc_fail_memory(err, path, 1, 1);
        free(text);
        json_decref(o);
    }
    tc_image_destroy(&truth);
    tc_image_destroy(&ours);
    return status;
}

tc_status hard_export_mesh(const char *dir, size_t index, const char *filter, tc_renderer *renderer, tc_error *err)
{
    const char *name = hard_catalogue_mesh(index);
    hard_mesh mesh;
    hard_view view;
    hard_function function = {0};
    hard_case c = {.function = FUNCTION_SMOOTH};
    char what[256], stem[1000];
    tc_status status = hard_mesh_open(&mesh, name, hard_catalogue_cells(index, false), 1, err);
    bool found = false;
    for (size_t k = 0; k < hard_view_count() && status == TC_OK && mesh.mesh && !found; k++) {
        c.view = (index + k) % hard_view_count();
        found = !hard_view_is_large(c.view) && hard_view_make(&view, c.view, &mesh, SIZE) && is_common(&view);
    }
    hard_case_name(what, sizeof what, index, &c);
    if (status == TC_OK && found && (!filter || strstr(what, filter))) {
        status = hard_function_make(&function, c.function, &mesh, err);
        snprintf(stem, sizeof stem, "%s/%s", dir, name);
        if (status == TC_OK)
            status = export_case(stem, what, &mesh, &view, &function, renderer, err);
    }
    hard_function_close(&function);
    hard_mesh_close(&mesh);
    return status;
}
