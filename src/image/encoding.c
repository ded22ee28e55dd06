/* encoding.c: what formats image files have, and what each can hold. */
#include "image/encoding.h"

#include "image/png.h"

#include <string.h>
#include <strings.h>

static const struct {
    const char *name, *magic[4]; /* magic: as long as bytes says */
    size_t bytes;
    int bits[3]; /* the first is the default; 0 ends */
} formats[TC_N_IMAGE_FORMAT] = {
    [TC_PNG] = {"png", {"\x89PNG\r\n\x1a\n"}, 8, {8, 16}},
    [TC_EXR] = {"openexr", {"\x76\x2f\x31\x01"}, 4, {32, 16}},
    [TC_TIFF] = {"tiff", {"II*\0", "MM\0*", "II+\0", "MM\0+"}, 4, {32}},
    [TC_JPEG] = {"jpeg", {"\xff\xd8\xff"}, 3, {8}},
};

static const struct {
    const char *extension;
    tc_image_format format;
} extensions[] = {{"png", TC_PNG},   {"exr", TC_EXR},  {"tif", TC_TIFF},
                  {"tiff", TC_TIFF}, {"jpg", TC_JPEG}, {"jpeg", TC_JPEG}};

enum { DEFAULT_LEVEL = TC_PNG_RUNS, DEFAULT_QUALITY = 95 };

const char *tc_image_format_name(tc_image_format format)
{
    return formats[format].name;
}

tc_status tc_image_format_of(tc_image_format *out, const char *path, tc_error *err)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    *out = TC_PNG;
    if (strcmp(path, "-") == 0)
        return TC_OK;
    for (size_t i = 0; dot && i < sizeof extensions / sizeof *extensions; i++)
        if (strcasecmp(dot + 1, extensions[i].extension) == 0) {
            *out = extensions[i].format;
            return TC_OK;
        }
    return tc_fail(err, TC_E_ARG,
                   "%s has %s%s; images are written as .png, .exr, .tif, .tiff, .jpg or .jpeg, or as PNG to -", path,
                   dot ? "the unknown extension " : "no extension", dot ? dot : "");
}

bool tc_image_format_of_bytes(tc_image_format *out, const uint8_t *bytes, size_t n)
{
    for (int i = 0; i < TC_N_IMAGE_FORMAT; i++)
        for (int k = 0; k < 4 && formats[i].magic[k]; k++)
            if (n >= formats[i].bytes && memcmp(bytes, formats[i].magic[k], formats[i].bytes) == 0) {
                *out = (tc_image_format)i;
                return true;
            }
    return false;
}

tc_status tc_image_encoding_fill(tc_image_encoding *out, tc_image_format format, const tc_image_encoding *asked,
                                 const char *path, tc_error *err)
{
    *out = asked ? *asked : (tc_image_encoding){0};
    const char *name = formats[format].name;
    const int *bits = formats[format].bits;
    if (out->bits != 0 && out->bits != bits[0] && out->bits != bits[1])
        return tc_fail(err, TC_E_ARG, "%s cannot have %d bits a channel; %s has %d%s", path, out->bits, name, bits[0],
                       bits[1] ? " or 16" : "");
    if (out->quality < 0 || out->quality > 100)
        return tc_fail(err, TC_E_ARG, "a quality of %d is not possible; 1 to 100 are", out->quality);
    if (out->level < -1 || out->level > 9)
        return tc_fail(err, TC_E_ARG, "a level of %d is not possible; 1 to 9 are, and -1: not compressed", out->level);
    if (out->quality != 0 && format != TC_JPEG)
        return tc_fail(err, TC_E_ARG, "%s cannot have a quality; %s loses nothing: give one to JPEG only", path, name);
    if (out->level != 0 && format != TC_PNG)
        return tc_fail(err, TC_E_ARG, "%s cannot have a level of compression; give one to PNG only", path);
    if (out->depth && format != TC_EXR)
        return tc_fail(err, TC_E_ARG, "%s cannot hold depth; write an .exr file", path);
    out->bits = out->bits ? out->bits : bits[0];
    out->quality = out->quality ? out->quality : DEFAULT_QUALITY;
    out->level = out->level == 0 ? DEFAULT_LEVEL : out->level < 0 ? 0 : out->level;
    return TC_OK;
}

tc_status tc_image_meta_check(const tc_text_pair *meta, size_t n, tc_error *err)
{
    for (size_t i = 0; i < n; i++) {
        const char *key = meta[i].key;
        size_t length = key ? strlen(key) : 0;
        bool good = length >= 1 && length <= 79 && key[0] != ' ' && key[length - 1] != ' ' && meta[i].value;
        for (size_t j = 0; good && j < length; j++)
            good = key[j] >= ' ' && key[j] < 0x7f;
        if (!good)
            return tc_fail(err, TC_E_ARG,
                           "\"%s\" cannot name a text in an image; a key has 1 to 79 printable ASCII characters",
                           key ? key : "");
    }
    return TC_OK;
}
