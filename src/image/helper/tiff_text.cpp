/* tiff_text.cpp: the description of a TIFF file.
 * TIFF revision 6.0 (Adobe 1992): 2 TIFF structure; BigTIFF (libtiff, 2007): the same with 64-bit counts and offsets.
 */
#include "image/helper/tiff_text.h"

#include <cstring>

namespace
{

enum { IMAGE_DESCRIPTION = 270, TYPE_ASCII = 2 };

struct tiff_bytes {
    const uint8_t *file;
    size_t n;
    bool big_endian;

    bool holds(uint64_t at, uint64_t length) const { return at <= n && length <= n - at; }
    /* A whole number of so many bytes, which the file holds. */
    uint64_t get(uint64_t at, unsigned bytes) const
    {
        uint64_t value = 0;
        for (unsigned i = 0; i < bytes; i++)
            value = value << 8 | file[at + (big_endian ? i : bytes - 1 - i)];
        return value;
    }
};

} // namespace

std::string tiff_description_read(const uint8_t *file, size_t n)
{
    if (n < 16)
        return "";
    const tiff_bytes in = {file, n, file[0] == 'M'};
    const bool big = in.get(2, 2) == 43;
    const unsigned wide = big ? 8 : 4, count_bytes = big ? 8 : 2, entry = 4 + 2 * wide;
    const uint64_t start = in.get(big ? 8 : 4, wide);
    if (!in.holds(start, count_bytes))
        return "";
    const uint64_t entries = in.get(start, count_bytes), first = start + count_bytes;
    for (uint64_t i = 0; i < entries && in.holds(first, (i + 1) * entry); i++) {
        const uint64_t at = first + i * entry, length = in.get(at + 4, wide);
        if (in.get(at, 2) != IMAGE_DESCRIPTION || in.get(at + 2, 2) != TYPE_ASCII)
            continue;
        const uint64_t text =
            length <= wide ? at + 4 + wide : in.get(at + 4 + wide, wide); /* a short one is in place */
        if (!in.holds(text, length))
            return "";
        const char *from = reinterpret_cast<const char *>(file + text);
        return std::string(from, strnlen(from, static_cast<size_t>(length)));
    }
    return "";
}
