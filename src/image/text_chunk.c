/* text_chunk.c: texts of PNG files' chunks.
 * PNG specification, second edition (W3C 2003): 11.3.4 textual information. */
#include "image/text_chunk.h"
#include "core/memory.h"

#include <string.h>

const char *tc_image_plain_key(const char *key)
{
    return strncmp(key, "tetcast:", 8) == 0 ? key + 8 : key;
}

bool tc_png_is_text(const uint8_t *type)
{
    return memcmp(type, "tEXt", 4) == 0 || memcmp(type, "iTXt", 4) == 0;
}

/* Where the text of a chunk's body begins: behind the key of tEXt; of iTXt behind the key, two flags, language and
 * translated key. NULL: its key is another one, it is compressed or broken. */
static const uint8_t *text_of(const uint8_t *body, size_t n, bool international, const char *key)
{
    const uint8_t *end = body + n, *at = memchr(body, 0, n);
    if (!at || strcmp((const char *)body, key) != 0)
        return NULL;
    at++;
    if (!international)
        return at;
    if (end - at < 2 || at[0] != 0)
        return NULL;
    at += 2;
    for (int skip = 0; skip < 2; skip++) {
        at = memchr(at, 0, (size_t)(end - at));
        if (!at)
            return NULL;
        at++;
    }
    return at;
}

tc_status tc_png_text(char **out, const uint8_t *type, const uint8_t *body, size_t n, const char *key, const char *path,
                      tc_error *err)
{
    const uint8_t *text = text_of(body, n, memcmp(type, "iTXt", 4) == 0, key);
    if (!text)
        return TC_OK;
    const size_t size = (size_t)(body + n - text);
    *out = tc_calloc(size + 1, 1);
    if (!*out)
        return tc_fail_memory(err, path, size, 1);
    memcpy(*out, text, size);
    return TC_OK;
}
