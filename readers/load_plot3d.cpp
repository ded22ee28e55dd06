// load_plot3d.cpp: PLOT3D grids with their solution file.
#include "load.h"

#include "plot3d_layout.h"

#include <vtkMultiBlockPLOT3DReader.h>

namespace tetcast
{

std::unique_ptr<Reader> make_plot3d_reader(const std::string &path)
{
    tc_plot3d_layout layout;
    tc_error err;
    if (tc_plot3d_layout_of(&layout, path.c_str(), &err) != TC_OK)
        throw Refusal(err.text);
    char partner[4096];
    const bool paired = tc_plot3d_partner(partner, sizeof partner, path.c_str(), &layout);
    if (layout.kind == TC_PLOT3D_Q && !paired)
        throw Refusal(path +
                      " is a PLOT3D solution without a grid: its grid file (named like it, with xyz for q) is not "
                      "beside it");
    const std::string xyz = layout.kind == TC_PLOT3D_XYZ ? path : partner;
    const std::string q = layout.kind == TC_PLOT3D_XYZ ? (paired ? partner : "") : path;
    if (tc_plot3d_layout_of(&layout, xyz.c_str(), &err) != TC_OK)
        throw Refusal(err.text);

    auto reader = std::make_unique<Reader>();
    auto plot3d = vtkSmartPointer<vtkMultiBlockPLOT3DReader>::New();
    plot3d->SetXYZFileName(xyz.c_str());
    plot3d->SetAutoDetectFormat(0);
    plot3d->SetBinaryFile(1);
    plot3d->SetMultiGrid(layout.multi_grid);
    plot3d->SetHasByteCount(layout.byte_counts);
    plot3d->SetIBlanking(layout.iblank);
    plot3d->SetDoublePrecision(layout.double_precision);
    plot3d->SetTwoDimensionalGeometry(0);
    if (layout.big_endian)
        plot3d->SetByteOrderToBigEndian();
    else
        plot3d->SetByteOrderToLittleEndian();
    plot3d->SetScalarFunctionNumber(-1);
    plot3d->SetVectorFunctionNumber(-1);
    if (q.empty())
        reader->notes.push_back("no whole solution file of the same grid (named like it, with q for xyz) lies beside "
                                "the PLOT3D grid; there "
                                "are no arrays");
    else
        plot3d->SetQFileName(q.c_str());
    reader->algorithm = plot3d;
    reader->format = "PLOT3D";
    reader->path = path;
    return reader;
}

} // namespace tetcast
