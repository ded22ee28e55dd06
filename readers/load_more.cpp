// load_more.cpp: the module with the readers that few files call for, loaded when one does.
#include "load.h"
#include "more.h"

#include <climits>
#include <dlfcn.h>
#include <unistd.h>

namespace tetcast
{

// The module's entry; it lies beside this program and stays loaded. path: of the file that calls for it.
static decltype(&tetcast_more_reader) load_module(const std::string &path)
{
    char own[PATH_MAX];
    const ssize_t n = readlink("/proc/self/exe", own, sizeof own);
    std::string file(own, n > 0 && n < (ssize_t)sizeof own ? (size_t)n : 0);
    file.resize(file.rfind('/') + 1); // npos + 1 is 0
    file += TETCAST_MORE;
    void *module = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
    void *entry = module ? dlsym(module, "tetcast_more_reader") : nullptr;
    if (!entry) {
        const char *why = dlerror();
        throw Refusal("the format of " + path + " needs a part of tetcast that cannot be loaded (" +
                      (why ? why : file) + "); install tetcast anew");
    }
    return reinterpret_cast<decltype(&tetcast_more_reader)>(entry);
}

std::unique_ptr<Reader> make_more_reader(const std::string &path, const tc_sniffed &sniffed)
{
    static decltype(&tetcast_more_reader) entry = load_module(path); // tried again after a Refusal
    return std::unique_ptr<Reader>(entry(path, sniffed));
}

} // namespace tetcast
