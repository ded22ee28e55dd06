/* png_text.h: text chunks of PNG files, exactly as given: OpenImageIO renames some keys and knows no UTF-8 chunk. */
#ifndef TC_IMAGE_PNG_TEXT_H
#define TC_IMAGE_PNG_TEXT_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

using text_pairs = std::vector<std::pair<std::string, std::string>>;

/* The tEXt and uncompressed iTXt chunks of a file as UTF-8; stops quietly where the file is broken. */
text_pairs png_text_read(const uint8_t *file, size_t n);

#endif
