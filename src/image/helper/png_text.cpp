/* png_text.cpp: text chunks of PNG files.
 * PNG specification, second edition (W3C 2003): 5.3 chunk layout, 11.3.4 textual information. */
#include "image/helper/png_text.h"

#include <cstring>

static uint32_t get_u32(const uint8_t *p)
{
    return uint32_t(p[0]) << 24 | uint32_t(p[1]) << 16 | uint32_t(p[2]) << 8 | p[3];
}

static std::string from_latin1(const char *p, size_t n)
{
    std::string out;
    for (size_t i = 0; i < n; i++) {
        unsigned char c = static_cast<unsigned char>(p[i]);
        if (c >= 0x80) {
            out += static_cast<char>(0xc0 | c >> 6);
            c = 0x80 | (c & 0x3f);
        }
        out += static_cast<char>(c);
    }
    return out;
}

/* Adds one chunk's text, if it holds one. */
static void read_chunk(text_pairs &out, const uint8_t *type, const char *body, size_t n)
{
    bool plain = std::memcmp(type, "tEXt", 4) == 0, international = std::memcmp(type, "iTXt", 4) == 0;
    const char *end = body + n, *nul = static_cast<const char *>(std::memchr(body, 0, n));
    if (!nul || !(plain || international))
        return;
    std::string key = from_latin1(body, static_cast<size_t>(nul - body));
    if (plain) {
        out.emplace_back(key, from_latin1(nul + 1, static_cast<size_t>(end - nul - 1)));
        return;
    }
    if (end - nul < 5 || nul[1] != 0)
        return;
    const char *p = nul + 3; /* language, translated key, text */
    for (int skip = 0; skip < 2; skip++) {
        p = static_cast<const char *>(std::memchr(p, 0, static_cast<size_t>(end - p)));
        if (!p)
            return;
        p++;
    }
    out.emplace_back(key, std::string(p, end));
}

text_pairs png_text_read(const uint8_t *file, size_t n)
{
    text_pairs out;
    for (size_t at = 8; at + 12 <= n;) {
        uint32_t length = get_u32(file + at);
        if (length > n - at - 12)
            break;
        read_chunk(out, file + at + 4, reinterpret_cast<const char *>(file + at + 8), length);
        at += size_t(12) + length;
    }
    return out;
}
