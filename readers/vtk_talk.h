// vtk_talk.h: what VTK says while a file is read: errors are kept, progress is passed on as a sign of life.
#ifndef TC_READERS_VTK_TALK_H
#define TC_READERS_VTK_TALK_H

#include "core/serve.h"

#include <string>
#include <vector>

class vtkAlgorithm;

namespace tetcast
{

class VtkTalk
{
  public:
    // Takes over VTK's output window for its life time; one at a time.
    explicit VtkTalk(tc_serve *serve);
    ~VtkTalk();
    VtkTalk(const VtkTalk &) = delete;
    VtkTalk &operator=(const VtkTalk &) = delete;

    void watch(vtkAlgorithm *algorithm); // passes its progress on
    void progress(const char *what, double fraction);

    // Throws a Refusal that names path, format and VTK's first error, if there was one since the last call.
    void check(const std::string &path, const std::string &format);
    bool failed() const { return !errors.empty(); }
    void forget() { errors.clear(); }

    std::vector<std::string> errors; // VTK's messages, without their source lines and addresses

  private:
    tc_serve *serve;
};

} // namespace tetcast
#endif
