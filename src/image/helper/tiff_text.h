/* tiff_text.h: the description of a TIFF file: OpenImageIO drops one of 64 KiB and more without a word. */
#ifndef TC_IMAGE_TIFF_TEXT_H
#define TC_IMAGE_TIFF_TEXT_H

#include <cstddef>
#include <cstdint>
#include <string>

/* ImageDescription of the first image, up to its first zero byte; "" where there is none or the file is broken. Classic
 * TIFF and BigTIFF, either order of bytes. */
std::string tiff_description_read(const uint8_t *file, size_t n);

#endif
