/* info_text.c: a mesh's report in words and as JSON. */
#include "cli/info_text.h"
#include "cli/input.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define TC_CELL_BYTES 16.0
#define TC_VERTEX_BYTES 16.0
#define TC_TIMES_SHOWN 6
#define TC_BLOCKS_SHOWN 8

double tc_info_gpu_bytes(const tc_mesh_report *report)
{
    return TC_CELL_BYTES * (double)(report->n_tet + report->n_imaginary) +
           TC_VERTEX_BYTES * (double)(report->n_vertex + report->n_steiner);
}

/* ------------------------------------------------------------------------------------------------------ defects */

/* A count of the report, its key, and what it means to a user. */
typedef struct tc_defect {
    const char *key, *words; /* words NULL: the rows below say it */
    size_t at;
} tc_defect;

#define AT(member) offsetof(tc_mesh_report, member)
static const tc_defect tc_defect_list[] = {
    {"dropped_degenerate", "cells repeat a point so that nothing is left of them, and were dropped",
     AT(dropped_degenerate)},
    {"dropped_nonfinite", "tets have a point that is not finite and were dropped", AT(dropped_nonfinite)},
    {"dropped_duplicate", "tets are there more than once; the copies were dropped", AT(dropped_duplicate)},
    {"reoriented", "cells were inverted (inside out) and have been turned", AT(reoriented)},
    {"zero_volume", "tets have no volume; they stay, since they keep their neighbours joined", AT(zero_volume)},
    {"merged_vertices", "points coincided with another and were merged with it", AT(merged_vertices)},
    {"unused_vertices", "points belong to no cell and were dropped", AT(unused_vertices)},
    {"unlinked_faces", NULL, AT(unlinked_faces)},
    {"faces_of_many", "faces have three cells or more; they are treated as boundaries, where rays leave and enter again",
     AT(faces_of_many)},
    {"faces_one_side", "faces lie between two cells on one side, which overlap; they are treated as boundaries, and the "
                       "cells composited in the order of entry",
     AT(faces_one_side)},
    {"nonfinite_scalars", "values of the field are NaN or infinite", AT(nonfinite_scalars)},
    {"nonfinite_cells", "tets have such a value and are transparent; render --nan-color shows them",
     AT(nonfinite_cells)},
};
#undef AT
#define TC_N_DEFECT (sizeof tc_defect_list / sizeof *tc_defect_list)

static size_t tc_defect_count(const tc_mesh_report *report, size_t i)
{
    size_t count;
    memcpy(&count, (const char *)report + tc_defect_list[i].at, sizeof count);
    return count;
}

/* ------------------------------------------------------------------------------------------------------- words */

static const char *tc_association_name(tc_association association)
{
    return association == TC_CELL_DATA ? "cell" : association == TC_POINT_DATA ? "point" : "any";
}

static void tc_source_print(const tc_source *source)
{
    printf("format      %s, read by %s\n", source->format, source->reader);
    printf("file        %zu points, %zu cells\n", source->n_point, source->n_cell);
    for (size_t i = 0; i < source->n_cell_type; i++) {
        const tc_cell_info *cell = &source->cell_type[i];
        printf("%-12s%zu × %s%s\n", i ? "" : "cells", cell->count, cell->type,
               cell->dimension < 3 ? " (left out: not three-dimensional)" : "");
    }
    if (source->dropped_cells)
        printf("            %zu cells left out\n", source->dropped_cells);
    if (source->linearised)
        printf("            quadratic cells became linear tets%s (see --refine)\n",
               source->refine ? " after refinement" : "");
    for (size_t i = 0; i < source->n_array; i++) {
        const tc_array_info *array = &source->array[i];
        printf("%-12s%s (%s, %d component%s) ", i ? "" : "arrays", array->name, tc_association_name(array->association),
               array->components, array->components == 1 ? "" : "s");
        if (array->lo <= array->hi)
            printf("%g … %g%s\n", array->lo, array->hi, array->components > 1 ? " (magnitude)" : "");
        else
            printf("no finite value\n");
    }
    if (!source->n_array)
        printf("arrays      none: the mesh is shown with the scalar 0\n");
    for (size_t i = 0; i < source->n_block && i < TC_BLOCKS_SHOWN; i++)
        printf("%-12s%" PRId64 "%s%s\n", i ? "" : "blocks", source->block[i].number, source->block[i].name ? " " : "",
               source->block[i].name ? source->block[i].name : "");
    if (source->n_block > TC_BLOCKS_SHOWN)
        printf("            … and %zu more (--json tells all)\n", source->n_block - TC_BLOCKS_SHOWN);
    if (source->n_time) {
        printf("steps       %zu: ", source->n_time);
        for (size_t i = 0; i < source->n_time && i < TC_TIMES_SHOWN - 1; i++)
            printf("%s%g", i ? " " : "", source->time[i]);
        if (source->n_time >= TC_TIMES_SHOWN)
            printf("%s %g", source->n_time > TC_TIMES_SHOWN ? " …" : "", source->time[source->n_time - 1]);
        printf("; this is step %d\n", source->step);
    }
}

/* Is any value finite, so that there is a range? */
static bool tc_has_range(const tc_mesh_report *report)
{
    return report->nonfinite_scalars < (report->association == TC_CELL_DATA ? report->n_tet : report->n_vertex);
}

static void tc_mesh_print(const tc_info *info)
{
    const tc_mesh_report *report = &info->report;
    const double *b = report->bounds;
    printf("mesh        %zu vertices, %zu tets, longest edge %g, volume %g\n", report->n_vertex, report->n_tet,
           report->longest_edge, report->volume);
    printf("bounds      %g … %g, %g … %g, %g … %g\n", b[0], b[1], b[2], b[3], b[4], b[5]);
    if (info->source && info->source->field)
        printf("field       %s (%s)", info->source->field, tc_association_name(report->association));
    else
        printf("field       %s", info->source ? "none" : "field");
    if (tc_has_range(report))
        printf(" %g … %g\n", report->scalar_range[0], report->scalar_range[1]);
    else
        printf(", no finite value\n");
    printf("unit        %g: the length over which opacity acts, unless --unit-distance says otherwise\n",
           info->unit_distance);
    if (!info->prepared)
        return;
    printf("parts       %zu, with %zu boundary faces\n", report->n_component, report->n_boundary_face);
    if (report->convex)
        printf("convex      yes\n");
    else if (report->reentry == TC_REENTRY_PEEL)
        printf("convex      no; rays cross gaps by peeling%s%s%s\n", *report->reentry_why ? " (" : "",
               report->reentry_why, *report->reentry_why ? ")" : "");
    else
        printf("convex      no; gaps are filled by %zu imaginary tets and %zu extra points\n", report->n_imaginary,
               report->n_steiner);
    printf("GPU         %.0f bytes of cells and vertices, %.1f a tet\n", tc_info_gpu_bytes(report),
           tc_info_gpu_bytes(report) / (double)(report->n_tet + report->n_imaginary));
}

void tc_info_print(const tc_info *info)
{
    bool clean = true;
    printf("input       %s\n", info->input);
    if (info->source)
        tc_source_print(info->source);
    else
        printf("format      synthetic\n");
    tc_mesh_print(info);
    if (!info->prepared)
        return;
    for (size_t i = 0; i < TC_N_DEFECT; i++) {
        size_t count = tc_defect_count(&info->report, i);
        if (count && tc_defect_list[i].words) {
            printf("%-12s%zu %s\n", clean ? "defects" : "", count, tc_defect_list[i].words);
            clean = false;
        }
    }
    if (clean)
        printf("defects     none found\n");
    for (size_t i = 0; info->source && i < info->source->n_note; i++)
        printf("%-12s%s\n", i ? "" : "notes", info->source->note[i]);
}

/* -------------------------------------------------------------------------------------------------------- JSON */

/* [lo, hi], or null when nothing is finite */
static json_t *tc_range_json(double lo, double hi)
{
    double range[2] = {lo, hi};
    return lo <= hi ? tc_json_reals(range, 2) : json_null();
}

static json_t *tc_source_json(const tc_source *source)
{
    json_t *json = json_object(), *cells = json_array(), *arrays = json_array(), *blocks = json_array();
    json_t *notes = json_array();
    tc_json_text(json, "format", source->format);
    tc_json_text(json, "reader", source->reader);
    tc_json_count(json, "points", source->n_point);
    tc_json_count(json, "cells", source->n_cell);
    for (size_t i = 0; i < source->n_cell_type; i++) {
        json_t *row = json_object();
        tc_json_text(row, "type", source->cell_type[i].type);
        tc_json_count(row, "dimension", (uint64_t)source->cell_type[i].dimension);
        tc_json_count(row, "count", source->cell_type[i].count);
        json_array_append_new(cells, row);
    }
    json_object_set_new(json, "cell_types", cells);
    for (size_t i = 0; i < source->n_array; i++) {
        json_t *row = json_object();
        tc_json_text(row, "name", source->array[i].name);
        tc_json_text(row, "association", tc_association_name(source->array[i].association));
        tc_json_count(row, "components", (uint64_t)source->array[i].components);
        json_object_set_new(row, "range", tc_range_json(source->array[i].lo, source->array[i].hi));
        json_array_append_new(arrays, row);
    }
    json_object_set_new(json, "arrays", arrays);
    for (size_t i = 0; i < source->n_block; i++) {
        json_t *row = json_object();
        json_object_set_new(row, "number", json_integer((json_int_t)source->block[i].number));
        tc_json_text(row, "name", source->block[i].name);
        json_array_append_new(blocks, row);
    }
    json_object_set_new(json, "blocks", blocks);
    tc_json_text(json, "field", source->field);
    json_object_set_new(json, "times", tc_json_reals(source->time, source->n_time));
    if (source->step >= 0)
        tc_json_count(json, "step", (uint64_t)source->step);
    tc_json_count(json, "dropped_cells", source->dropped_cells);
    json_object_set_new(json, "linearised", json_boolean(source->linearised));
    tc_json_count(json, "refine", (uint64_t)source->refine);
    for (size_t i = 0; i < source->n_note; i++)
        json_array_append_new(notes, json_string(source->note[i]));
    json_object_set_new(json, "notes", notes);
    if (source->helper_peak_bytes)
        tc_json_count(json, "helper_peak_bytes", source->helper_peak_bytes);
    return json;
}

static json_t *tc_report_json(const tc_info *info)
{
    const tc_mesh_report *report = &info->report;
    json_t *json = json_object(), *defects = json_object();
    tc_json_count(json, "points", report->n_vertex);
    tc_json_count(json, "tets", report->n_tet);
    tc_json_count(json, "source_cells", report->source_cells);
    json_object_set_new(json, "bounds", tc_json_reals(report->bounds, 6));
    json_object_set_new(json, "range",
                        tc_has_range(report) ? tc_range_json(report->scalar_range[0], report->scalar_range[1])
                                             : json_null());
    tc_json_text(json, "field", info->source ? info->source->field : "field");
    tc_json_text(json, "association", tc_association_name(report->association));
    tc_json_real(json, "longest_edge", report->longest_edge);
    tc_json_real(json, "volume", report->volume);
    tc_json_real(json, "unit_distance", info->unit_distance);
    if (!info->prepared) {
        json_decref(defects);
        return json;
    }
    tc_json_count(json, "imaginary_tets", report->n_imaginary);
    tc_json_count(json, "steiner_points", report->n_steiner);
    tc_json_count(json, "boundary_faces", report->n_boundary_face);
    tc_json_count(json, "parts", report->n_component);
    json_object_set_new(json, "convex", json_boolean(report->convex));
    tc_json_text(json, "reentry", tc_reentry_name(report->reentry));
    tc_json_text(json, "reentry_why", report->reentry_why);
    tc_json_count(json, "gpu_bytes", (uint64_t)tc_info_gpu_bytes(report));
    for (size_t i = 0; i < TC_N_DEFECT; i++)
        tc_json_count(defects, tc_defect_list[i].key, tc_defect_count(report, i));
    json_object_set_new(json, "defects", defects);
    return json;
}

json_t *tc_info_json(const tc_info *info)
{
    json_t *json = json_object(), *time = json_object();
    tc_json_text(json, "tetcast", tc_version());
    tc_json_text(json, "input", info->input);
    if (info->source)
        json_object_set_new(json, "source", tc_source_json(info->source));
    json_object_set_new(json, "mesh", tc_report_json(info));
    tc_json_measured(time, "read", info->seen.ms_read);
    if (info->prepared) {
        tc_json_measured(time, "check", info->report.ms_check);
        tc_json_measured(time, "adjacency", info->report.ms_adjacency);
        tc_json_measured(time, "order", info->report.ms_order);
        tc_json_measured(time, "convexify", info->report.ms_convexify);
    }
    json_object_set_new(json, "time_ms", time);
    json_t *cache = tc_input_cache_json(&info->seen);
    if (cache)
        json_object_set_new(json, "cache", cache);
    return json;
}
