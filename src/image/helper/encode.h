/* encode.h: pictures as EXR, TIFF and JPEG files, row by row. */
#ifndef TC_IMAGE_ENCODE_H
#define TC_IMAGE_ENCODE_H

#include "core/serve.h"

#include <memory>

/* A file that is being written. Each function throws std::exception with a sentence; then the file is not to be used.
 */
class encoder
{
  public:
    /* The library's request "begin"; its file is open already in the library. */
    encoder(tc_serve *serve, json_t *request);
    ~encoder();
    encoder(const encoder &) = delete;
    encoder &operator=(const encoder &) = delete;
    /* "rows": the next ones, "rgba" and, where it was said so, "depth". */
    void rows(const tc_array *array, size_t n_array);
    /* "end": all rows are there; returns when all bytes are written. */
    void end();

  private:
    struct state;
    std::unique_ptr<state> s;
};

#endif
