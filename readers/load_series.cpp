// load_series.cpp: files that list other files over time: ParaView's PVD collections and .series.
#include "load.h"

#include <jansson.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <cstring>
#include <map>

namespace tetcast
{

// A file named in list: relative names count from the list's folder.
static std::string beside(const std::string &list, const std::string &file)
{
    const size_t slash = list.rfind('/');
    if (!file.empty() && file[0] == '/')
        return file;
    return slash == std::string::npos ? file : list.substr(0, slash + 1) + file;
}

static Series sorted(const std::string &path, const char *format,
                     const std::map<double, std::vector<std::string>> &steps)
{
    if (steps.empty())
        throw Refusal(path + " lists no files");
    Series out;
    out.format = format;
    for (const auto &step : steps) {
        out.time.push_back(step.first);
        out.files.push_back(step.second);
    }
    return out;
}

Series read_pvd(const std::string &path, VtkTalk &talk)
{
    vtkSmartPointer<vtkXMLDataElement> root;
    root.TakeReference(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
    talk.check(path, "ParaView collection");
    vtkXMLDataElement *collection = root ? root->FindNestedElementWithName("Collection") : nullptr;
    if (!collection)
        throw Refusal(path + " could not be read as ParaView collection: it has no Collection element; it is damaged");
    std::map<double, std::vector<std::string>> steps;
    for (int i = 0; i < collection->GetNumberOfNestedElements(); i++) {
        vtkXMLDataElement *item = collection->GetNestedElement(i);
        if (!item->GetName() || strcmp(item->GetName(), "DataSet") != 0)
            continue;
        const char *file = item->GetAttribute("file");
        if (!file)
            throw Refusal(path + ": DataSet " + std::to_string(i) + " names no file");
        double time = 0;
        item->GetScalarAttribute("timestep", time);
        steps[time].push_back(beside(path, file));
    }
    return sorted(path, "ParaView collection (PVD)", steps);
}

Series read_series(const std::string &path)
{
    json_error_t why;
    std::unique_ptr<json_t, void (*)(json_t *)> root(json_load_file(path.c_str(), 0, &why),
                                                     [](json_t *j) { json_decref(j); });
    if (!root)
        throw Refusal(path + " could not be read as file series: line " + std::to_string(why.line) + ": " + why.text);
    json_t *files = json_object_get(root.get(), "files");
    std::map<double, std::vector<std::string>> steps;
    size_t i;
    json_t *item;
    json_array_foreach(files, i, item)
    {
        const char *name = json_string_value(json_object_get(item, "name"));
        if (!name)
            throw Refusal(path + ": entry " + std::to_string(i) + " of \"files\" has no name");
        json_t *time = json_object_get(item, "time");
        steps[time ? json_number_value(time) : (double)i].push_back(beside(path, name));
    }
    return sorted(path, "file series", steps);
}

} // namespace tetcast
