// load.h: from a path to VTK data of one time step.
#ifndef TC_READERS_LOAD_H
#define TC_READERS_LOAD_H

#include "fields.h"
#include "sniff.h"
#include "vtk_talk.h"

#include <vtkAlgorithm.h>
#include <vtkDataArraySelection.h>

#include <memory>

namespace tetcast
{

struct ReadRequest {
    std::string path;
    FieldWish field;
    bool has_time = false, has_step = false;
    double time = 0;
    int step = 0;
    int refine = 0;
    bool all_ranges = false; // read every array, not only the wanted one
    bool keep = false;       // more requests follow
    bool surface = false;    // triangles and lines alone: no array is read
    std::string mesh;        // hash of the mesh that need not be sent; "": none
};

// One file being read. The default methods serve any VTK reader with array selections and time steps.
class Reader
{
  public:
    std::string path, format;
    std::vector<std::string> notes;
    vtkSmartPointer<vtkAlgorithm> algorithm;
    vtkDataArraySelection *point_selection = nullptr, *cell_selection = nullptr; // NULL: no choice, all is read

    virtual ~Reader() = default;
    virtual void open(VtkTalk &talk); // reads what is needed to list arrays and times
    virtual std::vector<Offered> arrays() const;
    virtual std::vector<Block> blocks() const { return {}; } // where arrays() has their numbers
    virtual std::vector<double> times() const;
    virtual void select(const FieldWish &wish, bool all);
    virtual vtkSmartPointer<vtkDataObject> read(VtkTalk &talk, bool has_time, double time);
};

std::unique_ptr<Reader> make_vtk_reader(const std::string &path, const tc_sniffed &sniffed);  // load_vtk.cpp

// In the module tetcast-read-more.so, with the libraries that these formats need: it is loaded when one is called for,
// since to load them takes 20 ms. Throws a Refusal when it is missing.
std::unique_ptr<Reader> make_more_reader(const std::string &path, const tc_sniffed &sniffed); // load_more.cpp
std::unique_ptr<Reader> make_case_reader(const std::string &path, const tc_sniffed &sniffed); // load_cases.cpp
std::unique_ptr<Reader> make_plot3d_reader(const std::string &path);                          // load_plot3d.cpp
std::unique_ptr<Reader> make_hdf_reader(const std::string &path);                             // more.cpp

std::unique_ptr<Reader> make_surface_reader(const std::string &path, const tc_sniffed &sniffed); // load_surface.cpp

// A list of files over time: PVD collection or .series.
struct Series {
    std::string format;
    std::vector<double> time;                    // ascending, each once
    std::vector<std::vector<std::string>> files; // per time
};
Series read_pvd(const std::string &path, VtkTalk &talk); // load_series.cpp
Series read_series(const std::string &path);

struct Loaded {
    std::string format, reader;
    std::vector<vtkSmartPointer<vtkDataObject>> data; // one per file
    std::vector<Offered> offered;                     // known before reading; complete them with list_read_arrays
    std::vector<Block> blocks;                        // as those of each reader
    std::vector<double> times;
    int step = -1;
    std::vector<std::string> notes;
};

// A file that stays open for its next step.
struct OpenFile {
    std::string path;
    std::unique_ptr<Reader> reader; // NULL: there is none
};

// open: NULL, or a file that goes on to be read where it is the same, and else is replaced; lists over time open each of
// their files anew. Throws Refusal; then open holds none.
Loaded load_file(const ReadRequest &request, OpenFile *open, VtkTalk &talk);

// The step that is wanted: by number (negative from the end), by time (nearest at or before), else the first.
// Throws a Refusal for a step that is not there.
int choose_step(const ReadRequest &request, const std::vector<double> &times, std::vector<std::string> &notes);

} // namespace tetcast
#endif
