/* relations.c: invariants 4 to 7 and 9: what must not change a picture. */
#include "relations.h"

#include "core/vec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *hard_relation_name(int relation)
{
    return relation == HARD_REVERSED        ? "reversed"
           : relation == HARD_OTHER_CONTEXT ? "other context"
                                            : hard_kind_name[relation];
}

bool hard_relation_fits(int relation, const hard_mesh *mesh)
{
    const unsigned bad = TC_SYNTH_DEGENERATE | TC_SYNTH_NONFINITE_POINTS | TC_SYNTH_NONFINITE_VALUES;
    const double largest = 1e15; /* an audit's lengths are floats */
    if (relation == HARD_SMALL || relation == HARD_LARGE)
        return mesh->diagonal < largest && mesh->diagonal > 1 / largest;
    if (relation == HARD_REFINED4 || relation == HARD_REFINED8)
        return !(mesh->generator->defects & bad);
    return true;
}

/* The same rays from the other side: columns run the other way. Only for parallel views of whole lines. */
static hard_view reverse(const hard_view *view)
{
    hard_view other = *view;
    for (int k = 0; k < 3; k++)
        other.camera.position[k] = 2 * view->camera.focal_point[k] - view->camera.position[k];
    return other;
}

/* The walk took the same cells along every ray, or a number of rays did not (invariant 9). */
static void compare_walks(hard_result *r, const hard_picture *a, const hard_picture *b)
{
    size_t n = (size_t)a->image->width * (size_t)a->image->height, other = 0;
    for (size_t i = 0; i < n; i++)
        other += a->audit[i].cells != b->audit[i].cells || a->audit[i].hash != b->audit[i].hash;
    if (other)
        hard_fail(r, "%zu rays visit other cells than on the other context", other);
}

void hard_judge_relation(hard_result *r, const hard_bench *bench, int relation, const hard_mesh *mesh,
                         const hard_mesh *relative, const hard_view *view, const hard_function *function)
{
    hard_picture plain, other;
    hard_result first = {.rays = 0};
    hard_view seen = relation == HARD_REVERSED ? reverse(view) : *view;
    if (relative)
        seen.camera = hard_mesh_camera(relative, &view->camera);
    snprintf(r->relation, sizeof r->relation, "%s", hard_relation_name(relation));
    hard_judge_case(&plain, &first, bench, bench->renderer, mesh, view, function, TC_INTEGRATOR_INTEGRAL);
    hard_judge_case(&other, r, bench, relation == HARD_OTHER_CONTEXT ? bench->other : bench->renderer,
                    relative ? relative : mesh, &seen, function, TC_INTEGRATOR_INTEGRAL);
    snprintf(r->mesh, sizeof r->mesh, "%s", mesh->name);
    r->rays += first.rays;
    r->lost += first.lost;
    r->broken += first.broken;
    if (first.failure[0])
        hard_fail(r, "before the change: %s", first.failure);
    if (!plain.image || !other.image)
        hard_fail(r, "there is no picture %s the change", plain.image ? "after" : "before");
    else
        hard_compare(r, &plain, &other, relation == HARD_REVERSED, mesh, function);
    if (plain.audit && other.audit && relation == HARD_OTHER_CONTEXT && bench->exact)
        compare_walks(r, &plain, &other);
    hard_picture_finish(&plain);
    hard_picture_finish(&other);
}
