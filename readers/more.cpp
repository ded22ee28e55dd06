// more.cpp: the module tetcast-read-more.so: readers whose libraries take long to load. What it shares with
// tetcast-read (Reader, VtkTalk, may_be_wanted) is taken from there.
#include "more.h"

#include <vtkHDFReader.h>

namespace tetcast
{

std::unique_ptr<Reader> make_hdf_reader(const std::string &path)
{
    auto reader = std::make_unique<Reader>();
    auto hdf = vtkSmartPointer<vtkHDFReader>::New();
    hdf->SetFileName(path.c_str());
    reader->path = path;
    reader->algorithm = hdf;
    reader->format = "VTKHDF";
    reader->point_selection = hdf->GetPointDataArraySelection();
    reader->cell_selection = hdf->GetCellDataArraySelection();
    return reader;
}

} // namespace tetcast

extern "C" tetcast::Reader *tetcast_more_reader(const std::string &path, const tc_sniffed &sniffed)
{
    switch (sniffed.format) {
    case TC_FORMAT_VTKHDF:
        return tetcast::make_hdf_reader(path).release();
    case TC_FORMAT_PLOT3D:
        return tetcast::make_plot3d_reader(path).release();
    case TC_FORMAT_STL:
    case TC_FORMAT_OBJ:
    case TC_FORMAT_PLY:
        return tetcast::make_surface_reader(path, sniffed).release();
    default:
        return tetcast::make_case_reader(path, sniffed).release();
    }
}
