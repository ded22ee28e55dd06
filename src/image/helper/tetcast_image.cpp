/* tetcast_image.cpp: the helper program tetcast-image: encodes (all but PNG) and decodes images with OpenImageIO.
 * It chooses and names no file: what it writes is a file that the library has open, and gives a name when it is whole.
 */
#include "core/serve.h"
#include "image/helper/common.h"
#include "image/helper/decode.h"
#include "image/helper/encode.h"

#include <csignal>
#include <cstring>
#include <memory>

namespace
{

/* One request; under_way: the file between "begin" and "end". */
void answer(std::unique_ptr<encoder> &under_way, tc_serve *serve, json_t *request, const tc_array *array,
            size_t n_array)
{
    const char *text = json_string_value(json_object_get(request, "do"));
    const std::string what = text ? text : "";
    if (what == "decode") {
        decode(serve, request, array, n_array);
        return;
    }
    if (what == "check") {
        check(serve, request);
        return;
    }
    if (what == "begin") {
        under_way.reset();
        under_way = std::make_unique<encoder>(serve, request);
    } else if (what == "drop") {
        under_way.reset();
    } else if ((what == "rows" || what == "end") && under_way) {
        if (what == "rows")
            under_way->rows(array, n_array);
        else
            under_way->end();
        if (what == "end")
            under_way.reset();
    } else {
        throw std::runtime_error("tetcast-image can only encode, decode and check");
    }
    json_owner result(json_object());
    tc_serve_result(serve, result.json, nullptr, 0);
}

void handle(void *context, tc_serve *serve, json_t *request, const tc_array *array, size_t n_array)
{
    std::unique_ptr<encoder> &under_way = *static_cast<std::unique_ptr<encoder> *>(context);
    try {
        answer(under_way, serve, request, array, n_array);
        return;
    } catch (const std::bad_alloc &) {
        tc_serve_error(serve, "memory ran out for this image");
    } catch (const std::exception &e) {
        tc_serve_error(serve, e.what());
    } catch (...) {
        tc_serve_error(serve, "an unknown failure in OpenImageIO");
    }
    under_way.reset();
}

} // namespace

int main(int argc, char **argv)
{
    std::unique_ptr<encoder> under_way;
    signal(SIGXFSZ, SIG_IGN); /* a file that is too large is an error of write */
    return tc_serve_main(argc, argv, "tetcast-image", handle, &under_way);
}
