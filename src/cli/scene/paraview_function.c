/* paraview_function.c: ParaView's colour and opacity functions as a scene's: the colours as the text of a preset, the
 * opacity as points that lines join.
 *
 * A PVLookupTable holds RGBPoints (x, r, g, b), x in scalars; a PiecewiseFunction holds Points (x, opacity, midpoint,
 * sharpness). Where lines do not join them (midpoint, sharpness, logarithm) the library lays knots along the curve,
 * which keep to it within 1e-4. */
#include "cli/scene/paraview_parts.h"
#include "cli/options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Numbers of a property in rows. */
typedef struct tc_pv_rows {
    size_t n;
    double *x; /* [n][4] */
} tc_pv_rows;

/* All rows of four that are finite; how many are not is noted. */
static tc_pv_rows tc_rows_read(tc_pv_build *b, const tc_pv_proxy *proxy, const char *name, const char *what)
{
    const size_t all = tc_pv_values(b->pv, proxy, name) / 4;
    tc_pv_rows out = {0, all > 0 ? malloc(all * 4 * sizeof(double)) : NULL};
    for (size_t i = 0; i < all && out.x; i++) {
        double *row = out.x + 4 * out.n;
        size_t good = 0;
        while (good < 4 && tc_parse_real(&row[good], tc_pv_value(b->pv, proxy, name, 4 * i + good)))
            good++;
        out.n += good == 4;
    }
    if (out.n < all)
        tc_paraview_note(b->notes, "%zu of the %zu points of %s are no numbers and left out", all - out.n, all, what);
    return out;
}

static int tc_row_compare(const void *a, const void *b)
{
    double x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

/* Least and largest x. */
static void tc_rows_span(double span[2], const tc_pv_rows *rows)
{
    span[0] = INFINITY;
    span[1] = -INFINITY;
    for (size_t i = 0; i < rows->n; i++) {
        span[0] = fmin(span[0], rows->x[4 * i]);
        span[1] = fmax(span[1], rows->x[4 * i]);
    }
}

static json_t *tc_row_list(const tc_pv_rows *rows, bool log)
{
    json_t *list = json_array();
    for (size_t i = 0; i < rows->n; i++)
        for (size_t k = 0; k < 4; k++) {
            const double x = rows->x[4 * i + k];
            json_array_append_new(list, json_real(log && k == 0 ? log10(x) : x));
        }
    return list;
}

/* ---------------------------------------------------------------------------------------------------------- colours */

static const char *tc_space_name(tc_pv_build *b, const tc_pv_proxy *table)
{
    static const char *const name[] = {"RGB", "HSV", "Lab", "Diverging", "Lab/CIEDE2000", "Step"};
    const size_t n = sizeof name / sizeof *name;
    const char *text = tc_pv_value(b->pv, table, "ColorSpace", 0);
    double value;
    if (!*text)
        return name[0];
    for (size_t i = 0; i < n; i++)
        if ((tc_parse_real(&value, text) && value == (double)i) || !strcmp(text, name[i]))
            return name[i];
    tc_paraview_note(b->notes, "the colour space %.40s is not known: RGB is taken", text);
    return name[0];
}

/* What a table says that a colour map here does not hold. */
static void tc_table_note(tc_pv_build *b, const tc_pv_proxy *table)
{
    double bands = 256;
    if (tc_pv_is_on(b->pv, table, "IndexedLookup"))
        tc_paraview_note(b->notes, "the colours of categories are left out, those of the table's points are taken "
                                   "(--categories)");
    tc_pv_reals(&bands, 1, b->pv, table, "NumberOfTableValues");
    if (tc_pv_is_on(b->pv, table, "Discretize") && bands < 256)
        tc_paraview_note(b->notes, "the colours are %g bands there and continuous here", bands);
    if (tc_pv_is_on(b->pv, table, "UseBelowRangeColor") || tc_pv_is_on(b->pv, table, "UseAboveRangeColor"))
        tc_paraview_note(b->notes, "the colours below and above the range are left out: those of its ends hold");
}

/* The inline preset, range and log of a colour table; whether it is laid over the logarithm. */
static void tc_colors_put(tc_pv_build *b, const tc_pv_proxy *table)
{
    static const char suffix[] = ".PVLookupTable";
    tc_pv_rows rows = tc_rows_read(b, table, "RGBPoints", "the colour table");
    double span[2], nan_color[3];
    bool log = tc_pv_is_on(b->pv, table, "UseLogScale");
    tc_rows_span(span, &rows);
    if (rows.n == 0) {
        tc_paraview_note(b->notes, "there is no colour table: the default colour map is taken");
        free(rows.x);
        return;
    }
    if (log && !(span[0] > 0)) {
        tc_paraview_note(b->notes,
                         "the colour table is logarithmic but begins at %g: it is laid over the scalars "
                         "themselves",
                         span[0]);
        log = false;
    }
    json_t *map = json_object();
    const char *name = tc_pv_name(b->pv, table, "lookup_tables");
    size_t length = strlen(name);
    if (length > sizeof suffix - 1 && !strcmp(name + length - (sizeof suffix - 1), suffix))
        length -= sizeof suffix - 1;
    json_object_set_new(map, "Name", json_stringn(name, length));
    json_object_set_new(map, "ColorSpace", json_string(tc_space_name(b, table)));
    if (tc_pv_is_on(b->pv, table, "HSVWrap"))
        json_object_set_new(map, "HSVWrap", json_true());
    if (tc_pv_reals(nan_color, 3, b->pv, table, "NanColor"))
        json_object_set_new(map, "NanColor", json_pack("[fff]", nan_color[0], nan_color[1], nan_color[2]));
    json_object_set_new(map, "RGBPoints", tc_row_list(&rows, log));
    tc_pv_put(b, "transfer_function", "color_map", map);
    if (span[0] < span[1])
        tc_pv_put(b, "transfer_function", "range", json_pack("[ff]", span[0], span[1]));
    else
        tc_paraview_note(b->notes, "the colour table lies at one scalar, %g: it is laid over the field's range",
                         span[0]);
    if (log)
        tc_pv_put(b, "transfer_function", "log", json_true());
    tc_table_note(b, table);
    free(rows.x);
}

/* ---------------------------------------------------------------------------------------------------------- opacity */

static json_t *tc_points_of_rows(const tc_pv_rows *rows)
{
    json_t *list = json_array();
    for (size_t i = 0; i < rows->n; i++)
        json_array_append_new(list, json_pack("[ff]", rows->x[4 * i], rows->x[4 * i + 1]));
    return list;
}

/* Knots along the curve, by the library: a map of one colour has none of its own. NULL: why is noted. */
static json_t *tc_points_of_curve(tc_pv_build *b, const tc_pv_rows *rows, const double span[2], bool log)
{
    json_t *map = json_pack("{s:s, s:s, s:[f,f,f,f,f,f,f,f]}", "Name", "opacity", "ColorSpace", "RGB", "RGBPoints", 0.0,
                            0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
    json_object_set_new(map, "Points", tc_row_list(rows, log));
    char *text = json_dumps(map, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_t *list = NULL;
    tc_transfer *tf = NULL;
    tc_error err = {0};
    const tc_transfer_options options = {.color_map = text, .has_range = true, .range = {span[0], span[1]}, .log = log};
    json_decref(map);
    if (text && !tc_transfer_create(&tf, &options, &err)) {
        size_t n = 0;
        const tc_knot *knot = tc_transfer_knots(tf, &n);
        list = json_array();
        for (size_t i = 0; i < n; i++)
            json_array_append_new(list, json_pack("[ff]", knot[i].s, knot[i].a));
    } else {
        tc_paraview_note(b->notes, "the opacity's midpoints and sharpness are left out, lines join its points: %s",
                         err.text);
    }
    tc_transfer_destroy(&tf);
    free(text);
    return list;
}

/* The points of an opacity function; *first gets the opacity below all of them. */
static void tc_opacity_put(tc_pv_build *b, const tc_pv_proxy *function, double *first)
{
    tc_pv_rows rows = tc_rows_read(b, function, "Points", "the opacity function");
    double span[2];
    bool log = tc_pv_is_on(b->pv, function, "UseLogScale"), bent = false, below = false;
    *first = 0;
    if (rows.n == 0) {
        tc_paraview_note(b->notes, "there is no opacity function: the default opacity is taken (--opacity)");
        free(rows.x);
        return;
    }
    qsort(rows.x, rows.n, 4 * sizeof *rows.x, tc_row_compare);
    tc_rows_span(span, &rows);
    if (log && !(span[0] > 0)) {
        tc_paraview_note(b->notes, "the opacity function is logarithmic but begins at %g: lines join its points",
                         span[0]);
        log = false;
    }
    for (size_t i = 0; i < rows.n; i++) {
        double *row = rows.x + 4 * i;
        below = below || row[1] < 0;
        row[1] = fmax(row[1], 0);
        bent = bent || (i + 1 < rows.n && (log || row[2] != 0.5 || row[3] != 0));
    }
    if (below)
        tc_paraview_note(b->notes, "opacities below 0 are taken as 0");
    json_t *list = bent && span[0] < span[1] ? tc_points_of_curve(b, &rows, span, log) : NULL;
    tc_pv_put(b, "transfer_function", "opacity", list ? list : tc_points_of_rows(&rows));
    *first = rows.x[1];
    free(rows.x);
}

/* ------------------------------------------------------------------------------------------------------------ whole */

void tc_pv_function(tc_pv_build *b, const tc_pv_proxy *representation)
{
    const tc_pv_proxy *table = tc_pv_link(b->pv, representation, "LookupTable", 0);
    const tc_pv_proxy *opacity = tc_pv_link(b->pv, representation, "ScalarOpacityFunction", 0);
    double unit, first, nan_color[3];
    if (!opacity)
        opacity = tc_pv_link(b->pv, table, "ScalarOpacityFunction", 0);
    tc_colors_put(b, table);
    tc_opacity_put(b, opacity, &first);
    /* VTK looks the opacity of what is no number up in the function, where it comes before all points. */
    if (first > 0 && tc_pv_reals(nan_color, 3, b->pv, table, "NanColor"))
        tc_pv_put(b, "transfer_function", "nan_color",
                  json_pack("[ffff]", nan_color[0], nan_color[1], nan_color[2], first));
    if (tc_pv_reals(&unit, 1, b->pv, representation, "ScalarOpacityUnitDistance") && unit > 0)
        tc_pv_put(b, "transfer_function", "unit_distance", json_real(unit));
}
