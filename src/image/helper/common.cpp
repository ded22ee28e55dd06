/* common.cpp: what encoding and decoding by OpenImageIO share. */
#include "image/helper/common.h"
#include "core/wire.h"

#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

open_file::open_file() : fd(tc_wire_file())
{
    if (fd < 0)
        throw std::runtime_error(std::string("no shared memory: ") + std::strerror(errno));
}

open_file::open_file(const char *file, int flags) : fd(open(file, flags | O_CLOEXEC))
{
    if (fd < 0)
        throw std::runtime_error(std::string("tetcast-image cannot open it: ") + std::strerror(errno));
}

open_file::~open_file()
{
    close(fd);
}

/* Takes out every /proc/self/fd/N, with the space, parenthesis and quotes around it. */
static void drop_own_path(std::string &text)
{
    static const std::string own = "/proc/self/fd/";
    for (size_t at = text.find(own); at != std::string::npos; at = text.find(own, at)) {
        size_t end = at + own.size();
        while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])))
            end++;
        for (const char *mark = "\")"; *mark; mark++)
            if (end < text.size() && text[end] == *mark)
                end++;
        for (const char *mark = "\"( "; *mark; mark++)
            if (at > 0 && text[at - 1] == *mark)
                at--;
        text.erase(at, end - at);
    }
}

std::runtime_error failure(std::string text)
{
    drop_own_path(text);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())))
        text.pop_back();
    for (char &c : text)
        if (c == '\n')
            c = ' ';
    return std::runtime_error(text.empty() ? "OpenImageIO gives no reason" : text);
}
