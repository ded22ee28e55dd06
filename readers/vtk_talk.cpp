// vtk_talk.cpp: what VTK says while a file is read.
#include "vtk_talk.h"

#include "tets.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

#include <cstring>

namespace tetcast
{

namespace
{

// "ERROR: In /x/vtkFoo.cxx, line 12\nvtkFoo (0x55): Cannot open\n\n" -> "Cannot open".
std::string bare(const std::string &text)
{
    std::string s = text;
    size_t at = s.find(", line ");
    if (at != std::string::npos && (at = s.find('\n', at)) != std::string::npos)
        s.erase(0, at + 1);
    at = s.find("): ");
    if (at != std::string::npos && s.compare(0, 3, "vtk") == 0)
        s.erase(0, at + 3);
    for (char &c : s)
        if (c == '\n' || c == '\r' || c == '\t')
            c = ' ';
    std::string squeezed;
    for (char c : s)
        if (c != ' ' || (!squeezed.empty() && squeezed.back() != ' '))
            squeezed += c;
    while (!squeezed.empty() && (squeezed.back() == ' ' || squeezed.back() == '.'))
        squeezed.pop_back();
    return squeezed.substr(0, 400);
}

class Window : public vtkOutputWindow
{
  public:
    static Window *New();
    vtkTypeMacro(Window, vtkOutputWindow);
    VtkTalk *talk = nullptr;

    void DisplayText(const char *) override {}
    void DisplayErrorText(const char *text) override
    {
        if (talk && text && talk->errors.size() < 16)
            talk->errors.push_back(bare(text));
    }
    void DisplayWarningText(const char *) override {}
    // The legacy reader goes on with whatever the memory held when an array ends early, and only warns.
    void DisplayGenericWarningText(const char *text) override
    {
        if (text && strstr(text, "Error reading "))
            DisplayErrorText(text);
    }
    void DisplayDebugText(const char *) override {}
};
vtkStandardNewMacro(Window);

void on_progress(vtkObject *caller, unsigned long, void *talk, void *)
{
    vtkAlgorithm *algorithm = vtkAlgorithm::SafeDownCast(caller);
    static_cast<VtkTalk *>(talk)->progress("reading", algorithm ? algorithm->GetProgress() : -1);
}

} // namespace

VtkTalk::VtkTalk(tc_serve *to) : serve(to)
{
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    vtkNew<Window> window;
    window->talk = this;
    vtkOutputWindow::SetInstance(window);
}

VtkTalk::~VtkTalk()
{
    if (Window *window = Window::SafeDownCast(vtkOutputWindow::GetInstance()))
        window->talk = nullptr;
}

void VtkTalk::watch(vtkAlgorithm *algorithm)
{
    vtkNew<vtkCallbackCommand> command;
    command->SetCallback(on_progress);
    command->SetClientData(this);
    algorithm->RemoveObservers(vtkCommand::ProgressEvent); // of an earlier request
    algorithm->AddObserver(vtkCommand::ProgressEvent, command);
}

void VtkTalk::progress(const char *what, double fraction)
{
    tc_serve_progress(serve, what, fraction);
}

void VtkTalk::check(const std::string &path, const std::string &format)
{
    if (errors.empty())
        return;
    // The pipeline's "Algorithm … returned failure" only repeats that something failed.
    std::string first = "the reader gave up without saying why";
    for (size_t i = errors.size(); i-- > 0;)
        if (errors[i].compare(0, 10, "Algorithm ") != 0)
            first = errors[i];
    errors.clear();
    if (first.find("may be too short") != std::string::npos || first.find("ascii data") != std::string::npos)
        first += " (or holds nan or inf as text, which VTK does not read)";
    throw Refusal(path + " could not be read as " + format + ": " + first +
                  "; the file is damaged or cut short, write or fetch it again");
}

} // namespace tetcast
