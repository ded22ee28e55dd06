// load_cases.cpp: formats of solvers: Exodus II, EnSight, OpenFOAM, CGNS.
#include "load.h"

#include "netcdf_extent.h"

#include <vtkCGNSReader.h>
#include <vtkExodusIIReader.h>
#include <vtkGenericEnSightReader.h>
#include <vtkOpenFOAMReader.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <sys/stat.h>

namespace tetcast
{

namespace
{

// Readers that list and choose arrays by name. Names says how.
template <class T, class Names> class NamedReader : public Reader
{
  public:
    vtkSmartPointer<T> reader = vtkSmartPointer<T>::New();

    std::vector<Offered> arrays() const override
    {
        std::vector<Offered> all;
        const auto add = [&](const char *name, tc_association association) {
            Offered o;
            o.name = name;
            o.association = association;
            all.push_back(o);
        };
        for (int i = 0; i < Names::points(reader); i++)
            add(Names::point(reader, i), TC_POINT_DATA);
        for (int i = 0; i < Names::cells(reader); i++)
            add(Names::cell(reader, i), TC_CELL_DATA);
        return all;
    }
    void select(const FieldWish &wish, bool everything) override
    {
        for (int i = 0; i < Names::points(reader); i++) {
            const std::string name = Names::point(reader, i);
            Names::choose_point(reader, name.c_str(), everything || may_be_wanted(wish, name, TC_POINT_DATA));
        }
        for (int i = 0; i < Names::cells(reader); i++) {
            const std::string name = Names::cell(reader, i);
            Names::choose_cell(reader, name.c_str(), everything || may_be_wanted(wish, name, TC_CELL_DATA));
        }
    }
};

template <class T> struct ArrayNames {
    static int points(T *r) { return r->GetNumberOfPointArrays(); }
    static int cells(T *r) { return r->GetNumberOfCellArrays(); }
    static const char *point(T *r, int i) { return r->GetPointArrayName(i); }
    static const char *cell(T *r, int i) { return r->GetCellArrayName(i); }
    static void choose_point(T *r, const char *name, bool on) { r->SetPointArrayStatus(name, on); }
    static void choose_cell(T *r, const char *name, bool on) { r->SetCellArrayStatus(name, on); }
};

struct ExodusNames {
    using T = vtkExodusIIReader;
    static int points(T *r) { return r->GetNumberOfPointResultArrays(); }
    static int cells(T *r) { return r->GetNumberOfElementResultArrays(); }
    static const char *point(T *r, int i) { return r->GetPointResultArrayName(i); }
    static const char *cell(T *r, int i) { return r->GetElementResultArrayName(i); }
    static void choose_point(T *r, const char *name, bool on) { r->SetPointResultArrayStatus(name, on); }
    static void choose_cell(T *r, const char *name, bool on) { r->SetElementResultArrayStatus(name, on); }
};

class ExodusReader : public NamedReader<vtkExodusIIReader, ExodusNames>
{
  public:
    void open(VtkTalk &talk) override
    {
        reader->GenerateObjectIdCellArrayOff(); // until it is asked for
        reader->GenerateGlobalElementIdArrayOff();
        reader->GenerateGlobalNodeIdArrayOff();
        Reader::open(talk);
        for (int i = 0; i < reader->GetNumberOfElementBlockArrays(); i++)
            reader->SetElementBlockArrayStatus(reader->GetElementBlockArrayName(i), 1);
        // VTK adds the nodal vector whose name starts with "dis" to the coordinates, as ParaView does.
        for (const Offered &o : arrays()) {
            std::string head = o.name.substr(0, 3);
            std::transform(head.begin(), head.end(), head.begin(), [](unsigned char c) { return std::tolower(c); });
            if (o.association == TC_POINT_DATA && head == "dis")
                notes.push_back("displacements \"" + o.name + "\" are added to the coordinates");
        }
    }
    // The block's id of each element, as VTK makes it, where there are several blocks and no variable of that name.
    std::vector<Offered> arrays() const override
    {
        std::vector<Offered> all = NamedReader::arrays();
        if (reader->GetNumberOfElementBlockArrays() > 1 && !has_own_ids(all)) {
            all.emplace_back();
            all.back().name = object_id;
            all.back().association = TC_CELL_DATA;
            all.back().block_numbers = true;
        }
        return all;
    }
    void select(const FieldWish &wish, bool everything) override
    {
        NamedReader::select(wish, everything);
        const bool wanted = everything || may_be_wanted(wish, object_id, TC_CELL_DATA);
        const std::vector<Offered> all = arrays();
        reader->SetGenerateObjectIdCellArray(wanted && !all.empty() && all.back().block_numbers);
    }
    std::vector<Block> blocks() const override
    {
        const std::vector<Offered> all = arrays();
        std::vector<Block> out;
        if (all.empty() || !all.back().block_numbers)
            return out;
        for (int i = 0; i < reader->GetNumberOfElementBlockArrays(); i++) {
            const char *name = reader->GetElementBlockArrayName(i);
            out.push_back({reader->GetObjectId(vtkExodusIIReader::ELEM_BLOCK, i), name ? name : ""});
        }
        return out;
    }

  private:
    static constexpr const char *object_id = "ObjectId";

    static bool has_own_ids(const std::vector<Offered> &all)
    {
        return std::any_of(all.begin(), all.end(),
                           [](const Offered &o) { return o.association == TC_CELL_DATA && o.name == object_id; });
    }
};

// OpenFOAM keeps one folder per time; data live in cells, VTK averages them to points as ParaView does.
class FoamReader : public NamedReader<vtkOpenFOAMReader, ArrayNames<vtkOpenFOAMReader>>
{
  public:
    void open(VtkTalk &talk) override
    {
        reader->DecomposePolyhedraOff();
        reader->CreateCellToPointOn();
        reader->ReadZonesOff();
        Reader::open(talk);
        for (int i = 0; i < reader->GetNumberOfPatchArrays(); i++) {
            const std::string name = reader->GetPatchArrayName(i);
            reader->SetPatchArrayStatus(name.c_str(), name.find("internalMesh") != std::string::npos);
        }
        notes.push_back("point data are averaged from the cell data of the case");
    }
    // Averaged point arrays are named like the cell arrays, of which the reader knows beforehand.
    std::vector<Offered> arrays() const override
    {
        std::vector<Offered> all = NamedReader::arrays();
        const size_t n = all.size();
        for (size_t i = 0; i < n; i++) {
            Offered o = all[i];
            if (o.association == TC_CELL_DATA) {
                o.association = TC_POINT_DATA;
                all.push_back(o);
            }
        }
        return all;
    }
    void select(const FieldWish &wish, bool everything) override
    {
        FieldWish either = wish;
        either.association = TC_ANY_DATA;
        NamedReader::select(either, everything);
    }
};

class CgnsReader : public NamedReader<vtkCGNSReader, ArrayNames<vtkCGNSReader>>
{
  public:
    void open(VtkTalk &talk) override
    {
        Reader::open(talk);
        reader->EnableAllBases();
        reader->EnableAllFamilies();
        reader->LoadBndPatchOff();
        reader->UpdateInformation();
        talk.check(path, format);
    }
};

class EnsightReader : public NamedReader<vtkGenericEnSightReader, ArrayNames<vtkGenericEnSightReader>>
{
  public:
    // A complex vector is chosen by its name, but comes as two arrays, NAME_r and NAME_i.
    std::vector<Offered> arrays() const override
    {
        std::vector<Offered> all;
        for (const Offered &o : NamedReader::arrays()) {
            if (!is_complex_vector(o.name)) {
                all.push_back(o);
                continue;
            }
            for (const char *part : {"_r", "_i"}) {
                all.push_back(o);
                all.back().name += part;
            }
        }
        return all;
    }
    void select(const FieldWish &wish, bool everything) override
    {
        NamedReader::select(wish, everything);
        for (const Offered &o : NamedReader::arrays())
            if (is_complex_vector(o.name) && (may_be_wanted(wish, o.name + "_r", o.association) ||
                                              may_be_wanted(wish, o.name + "_i", o.association))) {
                if (o.association == TC_POINT_DATA)
                    reader->SetPointArrayStatus(o.name.c_str(), 1);
                else
                    reader->SetCellArrayStatus(o.name.c_str(), 1);
            }
    }
    bool is_complex_vector(const std::string &name) const
    {
        return std::find(complex_vectors.begin(), complex_vectors.end(), name) != complex_vectors.end();
    }
    // VTK asks for the files one by one and does not say which is missing: look first.
    void open(VtkTalk &talk) override
    {
        const size_t slash = path.rfind('/');
        const std::string folder = slash == std::string::npos ? "" : path.substr(0, slash + 1);
        std::ifstream file(path);
        std::string line;
        while (std::getline(file, line)) {
            if (line.compare(0, 18, "complex vector per") == 0)
                note_complex(line);
            if (line.compare(0, 6, "model:") != 0)
                continue;
            std::istringstream words(line.substr(6));
            std::string word, last;
            while (words >> word)
                if (word != "change_coords_only")
                    last = word;
            struct stat st;
            if (last.size() > 1 && last.front() == '"')
                last = last.substr(1, last.size() - 2);
            if (!last.empty() && last.find('*') == std::string::npos && stat((folder + last).c_str(), &st) != 0)
                throw Refusal(path + " names the geometry file " + last + ", which is not beside it");
        }
        Reader::open(talk);
    }

  private:
    std::vector<std::string> complex_vectors;

    // "complex vector per node: [time set] [file set] NAME real-file imaginary-file frequency"
    void note_complex(const std::string &line)
    {
        std::istringstream words(line.substr(std::min(line.size(), line.find(':') + 1)));
        std::vector<std::string> word;
        for (std::string w; words >> w;)
            word.push_back(w);
        if (word.size() >= 4)
            complex_vectors.push_back(word[word.size() - 4]);
    }
};

} // namespace

std::unique_ptr<Reader> make_case_reader(const std::string &path, const tc_sniffed &sniffed)
{
    const auto finish = [&](auto made, const char *format) -> std::unique_ptr<Reader> {
        made->algorithm = made->reader;
        made->format = format;
        made->path = path;
        return made;
    };
    switch (sniffed.format) {
    case TC_FORMAT_EXODUS: {
        tc_error err;
        if (tc_netcdf_check_extent(path.c_str(), &err) != TC_OK)
            throw Refusal(err.text);
        auto made = std::make_unique<ExodusReader>();
        made->reader->SetFileName(path.c_str());
        return finish(std::move(made), "Exodus II");
    }
    case TC_FORMAT_ENSIGHT: {
        auto made = std::make_unique<EnsightReader>();
        made->reader->SetCaseFileName(path.c_str());
        return finish(std::move(made), "EnSight");
    }
    case TC_FORMAT_OPENFOAM: {
        // Only the folder part of the name counts for VTK.
        struct stat st;
        std::string file = path;
        if (stat(path.c_str(), &st) == 0 && S_ISDIR(st.st_mode))
            file += "/case.foam";
        auto made = std::make_unique<FoamReader>();
        made->reader->SetFileName(file.c_str());
        return finish(std::move(made), "OpenFOAM");
    }
    default: {
        auto made = std::make_unique<CgnsReader>();
        made->reader->SetFileName(path.c_str());
        return finish(std::move(made), "CGNS");
    }
    }
}

} // namespace tetcast
