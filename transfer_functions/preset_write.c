/* preset_write.c: writing ParaView presets, JSON and XML; whole or not at all. */
#define _POSIX_C_SOURCE 200809L
#include "transfer_functions/preset.h"

#include "core/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static const char *const space_name[] = {"RGB", "HSV", "Lab", "Diverging", "Lab/CIEDE2000", "Step"};

static char *json_text(const tc_preset *preset)
{
    json_t *map = json_object(), *rgb = json_array(), *points = json_array(), *root = json_array();
    int failed = !map || !rgb || !points || !root;
    for (size_t i = 0; i < preset->n_color; i++) {
        const tc_color_point *p = &preset->color[i];
        failed |= json_array_append_new(rgb, json_real(p->x));
        for (int c = 0; c < 3; c++)
            failed |= json_array_append_new(rgb, json_real(p->rgb[c]));
    }
    for (size_t i = 0; i < preset->n_opacity; i++) {
        const tc_opacity_point *p = &preset->opacity[i];
        const double value[4] = {p->x, p->a, p->midpoint, p->sharpness};
        for (int k = 0; k < 4; k++)
            failed |= json_array_append_new(points, json_real(value[k]));
    }
    failed |= json_object_set_new(map, "Name", json_string(preset->name));
    failed |= json_object_set_new(map, "ColorSpace", json_string(space_name[preset->space]));
    if (preset->hsv_wrap)
        failed |= json_object_set_new(map, "HSVWrap", json_integer(1));
    if (preset->has_nan_color)
        failed |= json_object_set_new(
            map, "NanColor", json_pack("[fff]", preset->nan_color[0], preset->nan_color[1], preset->nan_color[2]));
    failed |= json_object_set(map, "RGBPoints", rgb);
    if (preset->n_opacity)
        failed |= json_object_set(map, "Points", points);
    failed |= json_array_append(root, map);
    char *text = failed ? NULL : json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    json_decref(root);
    json_decref(map);
    json_decref(rgb);
    json_decref(points);
    return text;
}

static void put_escaped(FILE *file, const char *text)
{
    for (; *text; text++)
        switch (*text) {
        case '&':
            fputs("&amp;", file);
            break;
        case '<':
            fputs("&lt;", file);
            break;
        case '>':
            fputs("&gt;", file);
            break;
        case '"':
            fputs("&quot;", file);
            break;
        default:
            fputc(*text, file);
            break;
        }
}

/* Opacity at a colour point: that of the opacity point at its place. Of several there, the k-th goes with the k-th. */
static bool opacity_at(double *a, const tc_preset *preset, size_t point)
{
    size_t nth = 0, found = 0;
    while (nth < point && preset->color[point - nth - 1].x == preset->color[point].x)
        nth++;
    for (size_t i = 0; i < preset->n_opacity; i++)
        if (preset->opacity[i].x == preset->color[point].x && found++ <= nth)
            *a = preset->opacity[i].a;
    return found > 0;
}

static char *xml_text(const tc_preset *preset)
{
    char *text = NULL;
    size_t length = 0;
    FILE *file = open_memstream(&text, &length);
    if (!file)
        return NULL;
    fputs("<ColorMaps>\n  <ColorMap name=\"", file);
    put_escaped(file, preset->name);
    fprintf(file, "\" space=\"%s\"%s>\n",
            preset->space == TC_SPACE_HSV && preset->hsv_wrap ? "Wrapped" : space_name[preset->space],
            preset->n_opacity ? " useOpacity=\"1\"" : "");
    for (size_t i = 0; i < preset->n_color; i++) {
        const tc_color_point *p = &preset->color[i];
        double a = 0;
        fprintf(file, "    <Point x=\"%.17g\"", p->x);
        if (opacity_at(&a, preset, i))
            fprintf(file, " o=\"%.17g\"", a);
        fprintf(file, " r=\"%.17g\" g=\"%.17g\" b=\"%.17g\"/>\n", p->rgb[0], p->rgb[1], p->rgb[2]);
    }
    if (preset->has_nan_color)
        fprintf(file, "    <NaN r=\"%.17g\" g=\"%.17g\" b=\"%.17g\"/>\n", preset->nan_color[0], preset->nan_color[1],
                preset->nan_color[2]);
    fputs("  </ColorMap>\n</ColorMaps>\n", file);
    const bool bad = ferror(file) != 0;
    if (fclose(file) != 0 || bad) {
        free(text);
        return NULL;
    }
    return text;
}

/* Beside, then renamed. */
static tc_status write_whole(const char *path, const char *text, tc_error *err)
{
    const size_t room = strlen(path) + 40;
    char *beside = tc_alloc(room, 1);
    if (!beside)
        return tc_fail_memory(err, path, room, 1);
    snprintf(beside, room, "%s.%ld.part", path, (long)getpid());
    const int descriptor = open(beside, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    FILE *file = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
    bool good = file && fputs(text, file) >= 0 && fputc('\n', file) != EOF;
    int reason = errno;
    if (file && fclose(file) != 0 && good) {
        good = false;
        reason = errno;
    } else if (!file && descriptor >= 0) {
        close(descriptor);
    }
    if (good && rename(beside, path) != 0) {
        good = false;
        reason = errno;
    }
    if (!good && descriptor >= 0)
        unlink(beside);
    free(beside);
    return good ? TC_OK
                : tc_fail(err, TC_E_FILE,
                          "%s cannot be written: %s; choose a folder that exists, is writable and has room", path,
                          strerror(reason));
}

/* Numbers have decimal points here, whatever the program's language. */
static char *text_of(const tc_preset *preset, bool xml)
{
    const locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    const locale_t before = plain ? uselocale(plain) : (locale_t)0;
    char *text = xml ? xml_text(preset) : json_text(preset);
    if (plain) {
        uselocale(before);
        freelocale(plain);
    }
    return text;
}

char *tc_preset_text(const tc_preset *preset)
{
    return text_of(preset, false);
}

tc_status tc_preset_write(const tc_preset *preset, const char *path, tc_error *err)
{
    const size_t length = strlen(path);
    const bool xml = length >= 4 && strcasecmp(path + length - 4, ".xml") == 0;
    char *text = text_of(preset, xml);
    if (!text)
        return tc_fail_memory(err, path, preset->n_color + preset->n_opacity, 100);
    const tc_status status = write_whole(path, text, err);
    free(text);
    return status;
}
