// load.cpp: from a path to VTK data of one time step.
#include "load.h"

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tetcast
{

// ------------------------------------------------------------------------------------------------ any VTK reader

void Reader::open(VtkTalk &talk)
{
    talk.watch(algorithm);
    algorithm->UpdateInformation();
    talk.check(path, format);
}

std::vector<Offered> Reader::arrays() const
{
    std::vector<Offered> all;
    const auto add = [&](vtkDataArraySelection *selection, tc_association association) {
        for (int i = 0; selection && i < selection->GetNumberOfArrays(); i++) {
            Offered o;
            o.name = selection->GetArrayName(i);
            o.association = association;
            if (o.name != "vtkGhostType")
                all.push_back(o);
        }
    };
    add(point_selection, TC_POINT_DATA);
    add(cell_selection, TC_CELL_DATA);
    return all;
}

std::vector<double> Reader::times() const
{
    vtkInformation *information = algorithm->GetOutputInformation(0);
    std::vector<double> all;
    if (information && information->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS())) {
        const int n = information->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
        const double *t = information->Get(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
        all.assign(t, t + n);
    }
    return all;
}

void Reader::select(const FieldWish &wish, bool all)
{
    const auto choose = [&](vtkDataArraySelection *selection, tc_association association) {
        for (int i = 0; selection && i < selection->GetNumberOfArrays(); i++) {
            const std::string name = selection->GetArrayName(i);
            if (all || name == "vtkGhostType" || may_be_wanted(wish, name, association))
                selection->EnableArray(name.c_str());
            else
                selection->DisableArray(name.c_str());
        }
    };
    choose(point_selection, TC_POINT_DATA);
    choose(cell_selection, TC_CELL_DATA);
}

vtkSmartPointer<vtkDataObject> Reader::read(VtkTalk &talk, bool has_time, double time)
{
    if (has_time)
        algorithm->UpdateTimeStep(time);
    else
        algorithm->Update();
    talk.check(path, format);
    return algorithm->GetOutputDataObject(0);
}

// ------------------------------------------------------------------------------------------------ time

static std::string number(double v)
{
    char text[32];
    snprintf(text, sizeof text, "%.6g", v);
    return text;
}

int choose_step(const ReadRequest &request, const std::vector<double> &times, std::vector<std::string> &notes)
{
    const int n = (int)times.size();
    if (n == 0) {
        if (request.has_step && request.step != 0 && request.step != -1)
            throw Refusal(request.path + " has no time steps, so there is no step " + std::to_string(request.step));
        if (request.has_time)
            notes.push_back("the file has no time steps; the time asked for has no meaning");
        return -1;
    }
    if (request.has_step) {
        const int step = request.step < 0 ? n + request.step : request.step;
        if (step < 0 || step >= n)
            throw Refusal(request.path + " has " + std::to_string(n) + " time steps (0 to " + std::to_string(n - 1) +
                          "), so there is no step " + std::to_string(request.step));
        return step;
    }
    if (!request.has_time)
        return 0;
    if (std::isnan(request.time))
        throw Refusal("the time asked for is not a number");
    int best = -1;
    for (int i = 0; i < n; i++) // a little slack: 0.3 typed for a stored 0.30000000000000004
        if (times[(size_t)i] <= request.time + 1e-9 * std::fabs(request.time) &&
            (best < 0 || times[(size_t)i] >= times[(size_t)best]))
            best = i;
    if (best < 0) {
        best = (int)(std::min_element(times.begin(), times.end()) - times.begin());
        notes.push_back("time " + number(request.time) + " lies before the first step; the step at " +
                        number(times[(size_t)best]) + " was read");
    } else if (request.time > times[(size_t)best] &&
               times[(size_t)best] == *std::max_element(times.begin(), times.end())) {
        notes.push_back("time " + number(request.time) + " lies after the last step; the step at " +
                        number(times[(size_t)best]) + " was read");
    }
    return best;
}

// ------------------------------------------------------------------------------------------------ dispatch

static tc_sniffed sniff(const std::string &path, bool surface)
{
    tc_sniffed sniffed;
    tc_error err;
    if ((surface ? tc_sniff_surface : tc_sniff_file)(&sniffed, path.c_str(), &err) != TC_OK)
        throw Refusal(err.text);
    return sniffed;
}

static std::unique_ptr<Reader> make_reader(const std::string &path, const tc_sniffed &sniffed)
{
    switch (sniffed.format) {
    case TC_FORMAT_VTK_XML:
    case TC_FORMAT_VTK_LEGACY:
        return make_vtk_reader(path, sniffed);
    case TC_FORMAT_VTKHDF:
    case TC_FORMAT_EXODUS:
    case TC_FORMAT_ENSIGHT:
    case TC_FORMAT_OPENFOAM:
    case TC_FORMAT_CGNS:
    case TC_FORMAT_PLOT3D:
    case TC_FORMAT_STL:
    case TC_FORMAT_OBJ:
    case TC_FORMAT_PLY:
        return make_more_reader(path, sniffed);
    default:
        throw Refusal(path + " is a list of files inside a list of files, which is not read; give the inner one");
    }
}

// One step of the reader's file, which is open.
static void load_step_of(Loaded &out, Reader *reader, const ReadRequest &request, bool in_series, VtkTalk &talk)
{
    const std::string &path = reader->path;
    const std::vector<Offered> offered = reader->arrays();
    const bool of_blocks = !request.field.any && may_be_wanted(request.field, block_array, TC_CELL_DATA); // we make it
    if (!offered.empty() && !request.surface && !of_blocks)
        require_wanted(path, request.field, offered);
    reader->select(request.field, request.all_ranges);
    const std::vector<double> times = reader->times();
    const int step = in_series ? (times.empty() ? -1 : 0) : choose_step(request, times, out.notes);
    vtkSmartPointer<vtkDataObject> data = reader->read(talk, step >= 0, step >= 0 ? times[(size_t)step] : 0);
    if (!data)
        throw Refusal(path + " gave no data; the file is damaged or empty");
    out.data.push_back(data);
    for (const Offered &o : offered)
        if (std::none_of(out.offered.begin(), out.offered.end(),
                         [&](const Offered &p) { return p.name == o.name && p.association == o.association; }))
            out.offered.push_back(o);
    for (const Block &b : reader->blocks())
        if (std::none_of(out.blocks.begin(), out.blocks.end(),
                         [&](const Block &c) { return c.number == b.number && c.name == b.name; }))
            out.blocks.push_back(b);
    out.notes.insert(out.notes.end(), reader->notes.begin(), reader->notes.end());
    if (!in_series) {
        out.times = times;
        out.step = step;
        out.format = reader->format;
    }
    out.reader = reader->algorithm->GetClassName();
}

static void load_one(Loaded &out, const std::string &path, const tc_sniffed &sniffed, const ReadRequest &request,
                     bool in_series, VtkTalk &talk)
{
    std::unique_ptr<Reader> reader = make_reader(path, sniffed);
    reader->open(talk);
    load_step_of(out, reader.get(), request, in_series, talk);
}

// The same with a file that stays open.
static void load_on(Loaded &out, OpenFile *open, const tc_sniffed &sniffed, const ReadRequest &request, VtkTalk &talk)
{
    std::unique_ptr<Reader> reader;
    if (open->path == request.path)
        reader = std::move(open->reader);
    open->reader.reset();
    if (reader) {
        talk.watch(reader->algorithm);
    } else {
        reader = make_reader(request.path, sniffed);
        reader->open(talk);
    }
    load_step_of(out, reader.get(), request, false, talk);
    open->path = request.path;
    open->reader = std::move(reader);
}

Loaded load_file(const ReadRequest &request, OpenFile *open, VtkTalk &talk)
{
    Loaded out;
    const tc_sniffed sniffed = sniff(request.path, request.surface);
    if (sniffed.format != TC_FORMAT_PVD && sniffed.format != TC_FORMAT_SERIES) {
        if (open)
            load_on(out, open, sniffed, request, talk);
        else
            load_one(out, request.path, sniffed, request, false, talk);
        return out;
    }
    const Series series = sniffed.format == TC_FORMAT_PVD ? read_pvd(request.path, talk) : read_series(request.path);
    out.times = series.time;
    out.step = choose_step(request, series.time, out.notes);
    for (const std::string &file : series.files[(size_t)out.step]) {
        try {
            const tc_sniffed inner = sniff(file, request.surface);
            load_one(out, file, inner, request, true, talk);
        } catch (const Refusal &refusal) {
            throw Refusal(request.path + " lists a file that is not read: " + refusal.what());
        }
    }
    out.format = series.format;
    return out;
}

} // namespace tetcast
