/* output_options.c: how a picture's files hold what was rendered, by their extension. */
#include "cli/picture/output_options.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

const tc_choice tc_bits_choice[] = {{"auto", 0, false}, {"8", 8, false}, {"16", 16, false}, {"32", 32, false}, {NULL, 0, false}};

/* Does path end in one of these extensions, each with a blank behind? */
static bool tc_is_kind(const char *path, const char *const *known)
{
    const char *dot = strrchr(path, '.');
    if (!strcmp(path, "-"))
        return !strcmp(known[0], ".png");
    for (size_t i = 0; dot && known[i]; i++)
        if (!strcasecmp(dot, known[i]))
            return true;
    return false;
}

static bool tc_is_png(const char *path)
{
    static const char *const known[] = {".png", NULL};
    return tc_is_kind(path, known);
}

static bool tc_is_jpeg(const char *path)
{
    static const char *const known[] = {".jpg", ".jpeg", NULL};
    return tc_is_kind(path, known);
}

static bool tc_is_exr(const char *path)
{
    static const char *const known[] = {".exr", NULL};
    return tc_is_kind(path, known);
}

tc_image_encoding tc_output_encoding(const tc_output_options *options, const char *path)
{
    tc_image_encoding out = {.bits = options->bits};
    if (tc_is_png(path))
        out.level = options->png_level < 0 ? 0 : options->png_level == 0 ? -1 : options->png_level;
    if (tc_is_jpeg(path))
        out.quality = options->jpeg_quality;
    return out;
}

void tc_output_wrong(char *why, const tc_output_options *options, const char *path)
{
    const int bits = options->bits;
    const bool fits = tc_is_png(path)    ? bits == 8 || bits == 16
                      : tc_is_exr(path)  ? bits == 16 || bits == 32
                      : tc_is_jpeg(path) ? bits == 8
                                         : bits == 32;
    *why = 0;
    if (bits && !fits)
        snprintf(why, 160, "--bits %d: png has 8 or 16 bits a channel, exr 16 or 32, jpg 8, tif 32", bits);
    else if ((options->depth || options->value) && !strcmp(path, "-"))
        snprintf(why, 160, "--%s is a file beside the picture: give --output a name, not -",
                 options->depth ? "depth" : "value");
}
