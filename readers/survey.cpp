// survey.cpp: what the mesh of a step will be like, without a mesh: what readers/read.c and src/mesh make of it counts,
// to the bit.
#include "survey.h"

#include "cell_types.h"

#include <cmath>
#include <limits>
#include <memory>

namespace tetcast
{

namespace
{

struct Range {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;

    void add(double v)
    {
        v += 0.0; // -0 becomes 0
        if (std::isfinite(v)) {
            lo = v < lo ? v : lo;
            hi = v > hi ? v : hi;
        }
    }
};

struct Found {
    Range value;
    double bounds[6];
};

void add_bounds(Range *axis, const double *x)
{
    for (int k = 0; k < 3; k++)
        axis[k].add(x[k]);
}

void take_bounds(double *out, const Range *axis)
{
    for (int k = 0; k < 3; k++) {
        out[2 * k] = axis[k].lo;
        out[2 * k + 1] = axis[k].hi;
    }
}

// The numbers of the cells of dimension 3.
std::vector<int64_t> solid_cells(const Gathered &data)
{
    std::vector<int64_t> out;
    out.reserve(data.n_solid);
    for (const Leaf &leaf : data.leaf) {
        const size_t n = (size_t)leaf.data->GetNumberOfCells();
        for (size_t c = 0; c < n; c++)
            if (cell_type(leaf.data->GetCellType((vtkIdType)c)).dimension == 3 && !is_ghost(leaf, c))
                out.push_back((int64_t)(leaf.first_cell + c));
    }
    return out;
}

// Of cells that are cut into tets of their own corners: *surveyed has the points. False: they may not be.
bool look_at_cells(Found &out, Surveyed &surveyed, const Step &step, const ReadRequest &request)
{
    const Gathered &data = step.data;
    uint64_t input = 0;
    const bool hashed = hash_input(input, data);
    Tets points;
    points.n_file_point = data.n_point;
    if (!hashed || !surveyed.there || surveyed.input != input) {
        surveyed.there = false;
        gather_points(points, data);
        if (!find_used(surveyed.used, points, data, request.refine))
            return false;
        Range axis[3];
        for (int32_t v : surveyed.used)
            add_bounds(axis, points.at(v));
        take_bounds(surveyed.bounds, axis);
        surveyed.there = hashed;
        surveyed.input = input;
    }
    std::copy(surveyed.bounds, surveyed.bounds + 6, out.bounds);
    std::vector<double> value;
    if (step.chosen.none) {
        value = {0};
    } else if (step.chosen.association == TC_POINT_DATA) {
        value.resize(surveyed.used.size());
        point_values(value.data(), step.chosen, data, points, surveyed.used.data(), value.size());
    } else {
        const std::vector<int64_t> cell = solid_cells(data);
        value.resize(cell.size());
        cell_values(value.data(), step.chosen, data, cell.data(), cell.size());
    }
    for (double v : value)
        out.value.add(v);
    return true;
}

bool same_value(double a, double b)
{
    return a == b || (std::isnan(a) && std::isnan(b));
}

// Will tc_mesh_repair keep the tet? value: of its corners, or NULL.
bool is_kept(const Tets &tets, const std::vector<int32_t> &used, const int32_t *v, const double *value)
{
    for (int i = 0; i < 4; i++) {
        const double *a = tets.at(used[(size_t)v[i]]);
        if (!std::isfinite(a[0]) || !std::isfinite(a[1]) || !std::isfinite(a[2]))
            return false;
        for (int j = 0; j < i; j++) {
            const double *b = tets.at(used[(size_t)v[j]]);
            if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && (!value || same_value(value[v[i]], value[v[j]])))
                return false; // these points will be merged
        }
    }
    return true;
}

// Of cells of any kind, by their tets.
void look_at_tets(Found &out, const SplitFile &split, const Step &step, const ReadRequest &request)
{
    const Tets &tets = split.tets;
    const bool of_points = !step.chosen.none && step.chosen.association == TC_POINT_DATA;
    const bool of_cells = !step.chosen.none && !of_points;
    std::vector<double> value(of_cells ? tets.cell.size() : of_points ? split.used.size() : 0);
    if (of_points)
        point_values(value.data(), step.chosen, step.data, tets, split.used.data(), value.size());
    else if (of_cells)
        cell_values(value.data(), step.chosen, step.data, tets.cell.data(), value.size());
    Range axis[3];
    bool any = false;
    for (size_t t = 0; t < tets.cell.size(); t++) {
        const int32_t *v = &tets.tet[4 * t];
        if (!is_kept(tets, split.used, v, of_points ? value.data() : nullptr))
            continue;
        any = true;
        for (int k = 0; k < 4; k++) {
            add_bounds(axis, tets.at(split.used[(size_t)v[k]]));
            if (of_points)
                out.value.add(value[(size_t)v[k]]);
        }
        if (of_cells)
            out.value.add(value[t]);
    }
    if (!any)
        throw Refusal(request.path + ": none of its tetrahedra can be rendered: they have points that are not finite, "
                                     "or several at one place; check the coordinates");
    if (step.chosen.none)
        out.value.add(0);
    take_bounds(out.bounds, axis);
}

json_t *numbers(const double *value, size_t n)
{
    json_t *list = json_array();
    for (size_t i = 0; i < n; i++)
        json_array_append_new(list, json_real(value[i]));
    return list;
}

} // namespace

void survey(tc_serve *serve, Surveyed &surveyed, Kept &kept, json_t *json)
{
    const ReadRequest request = parse_request(json);
    VtkTalk talk(serve);
    talk.progress("reading", -1);
    Step step;
    Found found;
    load_step(step, request, &surveyed.file, talk);
    if (!look_at_cells(found, surveyed, step, request)) {
        SplitFile fresh;
        look_at_tets(found, split_step(kept, fresh, request, step.data, talk), step, request);
    }
    std::unique_ptr<json_t, void (*)(json_t *)> result(json_object(), [](json_t *j) { json_decref(j); });
    if (found.value.lo <= found.value.hi) {
        const double range[2] = {found.value.lo, found.value.hi};
        json_object_set_new(result.get(), "range", numbers(range, 2));
    }
    json_object_set_new(result.get(), "bounds", numbers(found.bounds, 6));
    json_object_set_new(result.get(), "solid_cells", json_integer((json_int_t)step.data.n_solid));
    if (step.loaded.step >= 0) {
        const double time = step.loaded.times[(size_t)step.loaded.step];
        json_object_set_new(result.get(), "time", json_real(std::isfinite(time) ? time : 0));
    }
    tc_serve_result(serve, result.get(), nullptr, 0);
}

} // namespace tetcast
