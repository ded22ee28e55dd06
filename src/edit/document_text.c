/* document_text.c: documents from presets and knots, and as presets. Presets are read by the library, which knows what
 * ParaView's own reader takes; what it gives is plain JSON. */
#include "edit/document.h"

#include "edit/fail.h"

#include <ctype.h>
#include <jansson.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* As ParaView writes them; by tc_edit_space. */
static const char *const space_name[TC_EDIT_SPACES] = {"RGB", "HSV", "Lab", "Diverging", "Lab/CIEDE2000", "Step"};

/* (x - first) / (last - first), of huge numbers too; 0 unless first < last. */
static double laid(double x, double first, double last)
{
    const double width = last - first;
    if (!(width > 0))
        return 0;
    return isfinite(width) ? (x - first) / width : (0.5 * x - 0.5 * first) / (0.5 * last - 0.5 * first);
}

/* ------------------------------------------------------------------------------------------------------- reading */

static double at(const json_t *array, size_t i)
{
    return json_number_value(json_array_get(array, i));
}

/* n points of four numbers, x laid over the unit interval; where they do not reach 1 (they are at one place), the last
 * comes again there. */
static tc_edit_color *read_colors(size_t *n, const json_t *array)
{
    const size_t count = json_array_size(array) / 4;
    tc_edit_color *color = tc_edit_room(NULL, count + 1, sizeof *color);
    if (!color || count == 0)
        return color;
    const double first = at(array, 0), last = at(array, 4 * (count - 1));
    for (size_t i = 0; i < count; i++)
        color[i] = (tc_edit_color){.x = laid(at(array, 4 * i), first, last),
                                   .rgb = {at(array, 4 * i + 1), at(array, 4 * i + 2), at(array, 4 * i + 3)}};
    *n = count;
    if (color[count - 1].x < 1) {
        color[count] = color[count - 1];
        color[(*n)++].x = 1;
    }
    return color;
}

static tc_edit_point *read_points(size_t *n, const json_t *array)
{
    const size_t count = json_array_size(array) / 4;
    tc_edit_point *point = tc_edit_room(NULL, count + 1, sizeof *point);
    if (!point || count == 0)
        return point;
    const double first = at(array, 0), last = at(array, 4 * (count - 1));
    for (size_t i = 0; i < count; i++)
        point[i] = (tc_edit_point){.x = laid(at(array, 4 * i), first, last),
                                   .a = at(array, 4 * i + 1),
                                   .midpoint = at(array, 4 * i + 2),
                                   .sharpness = at(array, 4 * i + 3)};
    *n = count;
    if (point[count - 1].x < 1) {
        point[count] = point[count - 1];
        point[(*n)++].x = 1;
    }
    return point;
}

static tc_edit_space space_of(const char *name)
{
    for (int i = 0; name && i < TC_EDIT_SPACES; i++)
        if (strcmp(name, space_name[i]) == 0)
            return (tc_edit_space)i;
    return TC_EDIT_RGB;
}

/* What is in the map takes its place in the document, all or nothing. */
static tc_status take_map(tc_document *document, const json_t *map, const char *name, tc_error *err)
{
    size_t n_color = 0, n_point = 0;
    const json_t *rgb = json_object_get(map, "RGBPoints"), *points = json_object_get(map, "Points");
    const json_t *nan = json_object_get(map, "NanColor");
    tc_edit_color *color = read_colors(&n_color, rgb);
    tc_edit_point *point = read_points(&n_point, points);
    const size_t length = strlen(name) + 1;
    char *copy = tc_edit_room(NULL, length, 1);
    if (!color || !point || !copy || n_color == 0) {
        free(color);
        free(point);
        free(copy);
        return tc_edit_no_room(err, "points of a preset", (json_array_size(rgb) + json_array_size(points)) / 4);
    }
    memcpy(copy, name, length);
    free(document->name);
    document->name = copy;
    free(document->color);
    document->color = color;
    document->n_color = n_color;
    if (n_point > 0) {
        free(document->point);
        document->point = point;
        document->n_point = n_point;
    } else {
        free(point);
    }
    document->space = space_of(json_string_value(json_object_get(map, "ColorSpace")));
    document->hsv_wrap = json_number_value(json_object_get(map, "HSVWrap")) != 0;
    for (size_t c = 0; c < 3 && json_array_size(nan) == 3; c++)
        document->nan_color[c] = at(nan, c);
    return TC_OK;
}

/* Which of the maps has the name, as the library's option would take it. */
static tc_status choose(size_t *index, const tc_text_pair *map, size_t n, const char *text, const char *name,
                        tc_error *err)
{
    *index = 0;
    for (size_t i = 0; i < n && name; i++)
        if (strcmp(map[i].key, name) == 0) {
            *index = i;
            return TC_OK;
        }
    if (!name)
        return TC_OK;
    const tc_transfer_options options = {.color_map = text, .preset = name, .data_range = {0, 1}};
    tc_transfer *chosen = NULL;
    tc_status status = tc_transfer_create(&chosen, &options, err);
    if (status != TC_OK)
        return status;
    status = choose(index, map, n, text, tc_transfer_name(chosen), err);
    tc_transfer_destroy(&chosen);
    return status;
}

tc_status tc_document_take_preset(tc_document *document, const char *text, const char *name, tc_error *err)
{
    if (strncmp(text, "\xEF\xBB\xBF", 3) == 0)
        text += 3;
    while (isspace((unsigned char)*text))
        text++;
    if (!*text)
        return tc_edit_fail(err, TC_E_ARG, "the colour map's text is empty; give a ParaView preset or a map's name");
    tc_text_pair *map = NULL;
    size_t n = 0, index = 0;
    tc_status status = tc_transfer_presets(&map, &n, text, err);
    if (status == TC_OK)
        status = choose(&index, map, n, text, name, err);
    if (status != TC_OK) {
        free(map);
        return status;
    }
    json_error_t where;
    json_t *root = json_loads(map[index].value, 0, &where);
    if (root)
        status = take_map(document, json_array_get(root, 0), map[index].key, err);
    else
        status = tc_edit_no_room(err, "numbers of a preset", strlen(map[index].value));
    json_decref(root);
    free(map);
    return status;
}

/* -------------------------------------------------------------------------------------------------------- knots */

/* Colours or opacity of knots, as four numbers: x and three values. */
typedef struct corner {
    double x, v[3];
} corner;

/* Is b on the line from a to c? */
static bool is_between(const corner *a, const corner *b, const corner *c)
{
    const double t = laid(b->x, a->x, c->x);
    if (!(a->x < b->x && b->x < c->x))
        return a->x == b->x && b->x == c->x; /* of several at one place the outer two are seen */
    for (int k = 0; k < 3; k++) {
        const double on = a->v[k] * (1 - t) + c->v[k] * t;
        if (fabs(on - b->v[k]) > 1e-9 * fmax(fabs(on), fabs(b->v[k])))
            return false;
    }
    return true;
}

static bool is_equal(const corner *a, const corner *b)
{
    return a->x == b->x && a->v[0] == b->v[0] && a->v[1] == b->v[1] && a->v[2] == b->v[2];
}

/* Leaves out what is on a line, in place; gives how many stay. One line stands for 256 at most: what is looked at stays
 * linear in n. */
static size_t thin(corner *c, size_t n)
{
    enum { SPAN = 256 };
    size_t kept = 1;
    for (size_t from = 0, i = 1; i < n; i++) { /* from: the last that stays, as it was */
        bool on_line = i + 1 < n && i - from < SPAN;
        for (size_t k = from + 1; on_line && k <= i; k++)
            on_line = is_between(&c[kept - 1], &c[k], &c[i + 1]);
        if (!on_line && !is_equal(&c[kept - 1], &c[i]))
            c[kept++] = c[from = i];
    }
    if (c[kept - 1].x < 1) { /* one knot, or all at one place, or the last ones equal */
        c[kept] = c[kept - 1];
        c[kept++].x = 1;
    }
    return kept;
}

tc_status tc_document_take_knots(tc_document *document, const tc_transfer *tf, tc_error *err)
{
    size_t n;
    const tc_knot *knot = tc_transfer_knots(tf, &n);
    const bool logs = document->log && knot[0].s > 0;
    const double first = logs ? log(knot[0].s) : knot[0].s, last = logs ? log(knot[n - 1].s) : knot[n - 1].s;
    const char *from = tc_transfer_name(tf);
    const size_t length = strlen(from) + 1;
    corner *shade = tc_edit_room(NULL, n + 1, sizeof *shade), *height = tc_edit_room(NULL, n + 1, sizeof *height);
    tc_edit_color *color = tc_edit_room(NULL, n + 1, sizeof *color);
    tc_edit_point *point = tc_edit_room(NULL, n + 1, sizeof *point);
    char *name = tc_edit_room(NULL, length, 1);
    if (!shade || !height || !color || !point || !name) {
        free(shade);
        free(height);
        free(color);
        free(point);
        free(name);
        return tc_edit_no_room(err, "knots of a transfer function", n);
    }
    for (size_t i = 0; i < n; i++) {
        const double x = laid(logs ? log(knot[i].s) : knot[i].s, first, last);
        shade[i] = (corner){x, {knot[i].r, knot[i].g, knot[i].b}};
        height[i] = (corner){x, {knot[i].a, 0, 0}};
    }
    document->n_color = thin(shade, n);
    document->n_point = thin(height, n);
    for (size_t i = 0; i < document->n_color; i++)
        color[i] = (tc_edit_color){.x = shade[i].x, .rgb = {shade[i].v[0], shade[i].v[1], shade[i].v[2]}};
    for (size_t i = 0; i < document->n_point; i++)
        point[i] = (tc_edit_point){.x = height[i].x, .a = height[i].v[0], .midpoint = 0.5};
    memcpy(name, from, length);
    free(shade);
    free(height);
    free(document->color);
    free(document->point);
    free(document->name);
    document->color = color;
    document->point = point;
    document->name = name;
    document->space = TC_EDIT_RGB;
    document->hsv_wrap = false;
    return TC_OK;
}

/* ------------------------------------------------------------------------------------------------------- writing */

/* The scalar of a place, of the doubles about it one that is read as the same place, so that what is saved stays as it
 * is however often it is opened. Scales that are logarithmic are read by their logarithms: left as they are. */
static double scalar_in_text(const tc_document *document, double x)
{
    const double first = document->range[0], last = document->range[1], value = tc_document_scalar(document, x);
    if (document->log || laid(value, first, last) == x || !isfinite(last - first))
        return value;
    const double middle = value + (x - laid(value, first, last)) * (last - first);
    double below = middle, above = middle;
    for (int step = 0; step < 4; step++) {
        if (laid(below, first, last) == x)
            return below;
        if (laid(above, first, last) == x)
            return above;
        below = nextafter(below, first);
        above = nextafter(above, last);
    }
    return value;
}

/* x of the text; never before the one before it, as rounding might have it. */
static double x_in_text(const tc_document *document, double x, bool unit, double before)
{
    return fmax(before, unit ? x : scalar_in_text(document, x));
}

static json_t *json_colors(const tc_document *document, bool unit)
{
    json_t *array = json_array();
    double x = -INFINITY;
    bool failed = !array;
    for (size_t i = 0; i < document->n_color; i++) {
        const tc_edit_color *p = &document->color[i];
        x = x_in_text(document, p->x, unit, x);
        failed |= json_array_append_new(array, json_real(x)) != 0;
        for (int c = 0; c < 3; c++)
            failed |= json_array_append_new(array, json_real(p->rgb[c])) != 0;
    }
    if (failed) {
        json_decref(array);
        return NULL;
    }
    return array;
}

static json_t *json_points(const tc_document *document, bool unit)
{
    json_t *array = json_array();
    double x = -INFINITY;
    bool failed = !array;
    for (size_t i = 0; i < document->n_point; i++) {
        const tc_edit_point *p = &document->point[i];
        x = x_in_text(document, p->x, unit, x);
        failed |= json_array_append_new(array, json_real(x)) != 0;
        failed |= json_array_append_new(array, json_real(p->a)) != 0;
        failed |= json_array_append_new(array, json_real(p->midpoint)) != 0;
        failed |= json_array_append_new(array, json_real(p->sharpness)) != 0;
    }
    if (failed) {
        json_decref(array);
        return NULL;
    }
    return array;
}

char *tc_document_text(const tc_document *document, bool unit)
{
    json_t *map = json_object(), *root = json_array();
    const double *nan = document->nan_color;
    json_t *name = json_string(document->name ? document->name : "");
    if (!name) /* broken UTF-8 */
        name = json_string("map");
    bool failed = json_object_set_new(map, "Name", name) != 0;
    failed |= json_object_set_new(map, "ColorSpace", json_string(space_name[document->space])) != 0;
    if (document->hsv_wrap)
        failed |= json_object_set_new(map, "HSVWrap", json_integer(1)) != 0;
    failed |= json_object_set_new(map, "NanColor", json_pack("[fff]", nan[0], nan[1], nan[2])) != 0;
    if (document->log && !unit)
        failed |= json_object_set_new(map, "UseLogScale", json_integer(1)) != 0;
    failed |= json_object_set_new(map, "RGBPoints", json_colors(document, unit)) != 0;
    failed |= json_object_set_new(map, "Points", json_points(document, unit)) != 0;
    failed |= json_array_append_new(root, map) != 0; /* map is root's now, or gone */
    char *text = failed ? NULL : json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    json_decref(root);
    return text;
}

tc_status tc_document_function(tc_transfer **out, const tc_document *document, tc_error *err)
{
    *out = NULL;
    char *text = tc_document_text(document, false);
    if (!text)
        return tc_edit_no_room(err, "points of a transfer function", document->n_point + document->n_color);
    const tc_transfer_options options = {
        .color_map = text, .has_range = true, .range = {document->range[0], document->range[1]}, .log = document->log};
    const tc_status status = tc_transfer_create(out, &options, err);
    free(text);
    return status;
}
