/* png_pixels.c: PNG files of ours without a decoder.
 *   png_pixels FILE      the checksums of its IHDR and IDAT chunks: the same where size and pixels are, whatever
 * metadata png_pixels FILE KEY  the text that it carries under KEY Exit 1 where the file is no PNG, or carries no such
 * text. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv)
{
    uint8_t head[8], crc[4];
    const char *key = argc > 2 ? argv[2] : NULL;
    FILE *stream = argc > 1 ? fopen(argv[1], "rb") : NULL;
    int found = 0;
    if (!stream || fread(head, 1, 8, stream) != 8 || memcmp(head, "\x89PNG", 4) != 0)
        return 1;
    while (fread(head, 1, 8, stream) == 8) {
        const size_t n = (size_t)head[0] << 24 | (size_t)head[1] << 16 | (size_t)head[2] << 8 | head[3];
        uint8_t *body = calloc(n + 1, 1);
        if (!body || fread(body, 1, n, stream) != n || fread(crc, 1, 4, stream) != 4)
            return 1;
        if (!key && (!memcmp(head + 4, "IHDR", 4) || !memcmp(head + 4, "IDAT", 4))) {
            printf("%02x%02x%02x%02x ", crc[0], crc[1], crc[2], crc[3]);
            found++;
        }
        if (key && (!memcmp(head + 4, "tEXt", 4) || !memcmp(head + 4, "iTXt", 4)) && !strcmp((const char *)body, key)) {
            const size_t gap = head[4] == 'i' ? 5 : 1; /* as we write it: no language, no translated key */
            puts((const char *)body + strlen(key) + gap);
            found = 2;
        }
        free(body);
    }
    if (!key)
        putchar('\n');
    fclose(stream);
    return found >= 2 ? 0 : 1;
}
