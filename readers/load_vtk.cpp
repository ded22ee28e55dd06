// load_vtk.cpp: VTK's own formats: XML, legacy.
#include "load.h"

#include <vtkDataSetReader.h>
#include <vtkNew.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPImageDataReader.h>
#include <vtkXMLPPolyDataReader.h>
#include <vtkXMLPRectilinearGridReader.h>
#include <vtkXMLPStructuredGridReader.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLPartitionedDataSetCollectionReader.h>
#include <vtkXMLPartitionedDataSetReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace tetcast
{

namespace
{

template <class T> vtkSmartPointer<vtkXMLReader> make()
{
    return vtkSmartPointer<T>::New();
}

struct XmlRow {
    const char *kind, *format;
    vtkSmartPointer<vtkXMLReader> (*make)();
};

const XmlRow xml_rows[] = {
    {"UnstructuredGrid", "VTK XML unstructured grid", make<vtkXMLUnstructuredGridReader>},
    {"PUnstructuredGrid", "VTK XML unstructured grid in pieces", make<vtkXMLPUnstructuredGridReader>},
    {"StructuredGrid", "VTK XML structured grid", make<vtkXMLStructuredGridReader>},
    {"PStructuredGrid", "VTK XML structured grid in pieces", make<vtkXMLPStructuredGridReader>},
    {"RectilinearGrid", "VTK XML rectilinear grid", make<vtkXMLRectilinearGridReader>},
    {"PRectilinearGrid", "VTK XML rectilinear grid in pieces", make<vtkXMLPRectilinearGridReader>},
    {"ImageData", "VTK XML image data", make<vtkXMLImageDataReader>},
    {"PImageData", "VTK XML image data in pieces", make<vtkXMLPImageDataReader>},
    {"PolyData", "VTK XML polygonal data", make<vtkXMLPolyDataReader>}, // of surfaces alone: sniff.c refuses them else
    {"PPolyData", "VTK XML polygonal data in pieces", make<vtkXMLPPolyDataReader>},
    {"vtkMultiBlockDataSet", "VTK XML multi-block data set", make<vtkXMLMultiBlockDataReader>},
    {"vtkPartitionedDataSet", "VTK XML partitioned data set", make<vtkXMLPartitionedDataSetReader>},
    {"vtkPartitionedDataSetCollection", "VTK XML collection of partitioned data sets",
     make<vtkXMLPartitionedDataSetCollectionReader>},
};

class LegacyReader : public Reader
{
  public:
    vtkSmartPointer<vtkDataSetReader> legacy;

    void open(VtkTalk &talk) override
    {
        talk.watch(algorithm);
        legacy->ReadAllScalarsOn();
        legacy->ReadAllVectorsOn();
        legacy->ReadAllNormalsOn();
        legacy->ReadAllTensorsOn();
        legacy->ReadAllColorScalarsOn();
        legacy->ReadAllTCoordsOn();
        legacy->ReadAllFieldsOn();
    }
    std::vector<double> times() const override { return {}; }
};

} // namespace

static std::unique_ptr<Reader> make_xml(const std::string &path, const std::string &kind)
{
    for (const XmlRow &row : xml_rows) {
        if (kind != row.kind)
            continue;
        auto reader = std::make_unique<Reader>();
        vtkSmartPointer<vtkXMLReader> xml = row.make();
        xml->SetFileName(path.c_str());
        reader->algorithm = xml;
        reader->format = row.format;
        reader->point_selection = xml->GetPointDataArraySelection();
        reader->cell_selection = xml->GetCellDataArraySelection();
        return reader;
    }
    throw Refusal(path + " is a VTK XML file of type " + kind +
                  ", which is not read; save it as UnstructuredGrid (.vtu)");
}

std::unique_ptr<Reader> make_vtk_reader(const std::string &path, const tc_sniffed &sniffed)
{
    std::unique_ptr<Reader> reader;
    if (sniffed.format == TC_FORMAT_VTK_XML) {
        reader = make_xml(path, sniffed.kind);
    } else {
        auto legacy = std::make_unique<LegacyReader>();
        legacy->legacy = vtkSmartPointer<vtkDataSetReader>::New();
        legacy->legacy->SetFileName(path.c_str());
        legacy->algorithm = legacy->legacy;
        legacy->format = "legacy VTK";
        reader = std::move(legacy);
    }
    reader->path = path;
    return reader;
}

} // namespace tetcast
