/* common.h: what encoding and decoding by OpenImageIO share. */
#ifndef TC_IMAGE_HELPER_COMMON_H
#define TC_IMAGE_HELPER_COMMON_H

#include <jansson.h>

#include <new>
#include <stdexcept>
#include <string>

/* What marks the texts of EXR files as ours. */
constexpr const char *EXR_PREFIX = "tetcast:";

/* An open file; it has no name of its own here, and OpenImageIO gets at it by way of /proc/self/fd. */
struct open_file {
    int fd;
    /* A new one without a name. */
    open_file();
    /* One of the library's, by a path that it gave; flags as open's. */
    open_file(const char *path, int flags);
    open_file(const open_file &) = delete;
    open_file &operator=(const open_file &) = delete;
    ~open_file();
    std::string path() const { return "/proc/self/fd/" + std::to_string(fd); }
};

struct json_owner {
    json_t *json;
    explicit json_owner(json_t *j) : json(j)
    {
        if (!j)
            throw std::bad_alloc();
    }
    json_owner(const json_owner &) = delete;
    json_owner &operator=(const json_owner &) = delete;
    ~json_owner() { json_decref(json); }
};

/* One line of OpenImageIO's report, without the path by which it knows the file. */
std::runtime_error failure(std::string text);

#endif
