// load_surface.cpp: surfaces in formats of their own: STL, Wavefront OBJ, PLY. Part of tetcast-read-more.so.
#include "load.h"

#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkSTLReader.h>

namespace tetcast
{

template <class T> static vtkSmartPointer<vtkAlgorithm> make(const std::string &path)
{
    auto algorithm = vtkSmartPointer<T>::New();
    algorithm->SetFileName(path.c_str());
    return algorithm;
}

std::unique_ptr<Reader> make_surface_reader(const std::string &path, const tc_sniffed &sniffed)
{
    auto reader = std::make_unique<Reader>();
    reader->path = path;
    switch (sniffed.format) {
    case TC_FORMAT_STL:
        reader->algorithm = make<vtkSTLReader>(path);
        reader->format = "STL";
        break;
    case TC_FORMAT_OBJ:
        reader->algorithm = make<vtkOBJReader>(path);
        reader->format = "Wavefront OBJ";
        break;
    default:
        reader->algorithm = make<vtkPLYReader>(path);
        reader->format = "PLY";
        break;
    }
    return reader;
}

} // namespace tetcast
