// step.cpp: one step of a file as VTK's data, and its cells as tets.
#include "step.h"

#include "cell_types.h"

namespace tetcast
{

ReadRequest parse_request(json_t *request)
{
    ReadRequest out;
    const char *path = json_string_value(json_object_get(request, "path"));
    const char *field = json_string_value(json_object_get(request, "field"));
    out.path = path ? path : "";
    out.field.any = !field;
    out.field.text = field ? field : "";
    out.field.association = (tc_association)json_integer_value(json_object_get(request, "association"));
    json_t *time = json_object_get(request, "time"), *step = json_object_get(request, "step");
    out.has_time = time != nullptr;
    out.time = json_number_value(time);
    out.has_step = step != nullptr;
    out.step = (int)json_integer_value(step);
    out.refine = (int)json_integer_value(json_object_get(request, "refine"));
    out.all_ranges = json_is_true(json_object_get(request, "all_ranges"));
    out.keep = json_is_true(json_object_get(request, "keep"));
    const char *mesh = json_string_value(json_object_get(request, "mesh"));
    out.mesh = mesh ? mesh : "";
    if (out.path.empty())
        throw Refusal("no file was named");
    return out;
}

static std::string counted(size_t n, const char *one, const char *many)
{
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

static void require_solid(const std::string &path, const Gathered &data)
{
    if (data.n_solid > 0)
        return;
    std::string kinds;
    for (const auto &entry : data.by_type)
        kinds += (kinds.empty() ? "" : ", ") + std::to_string(entry.second) + " " + cell_type(entry.first).name;
    throw Refusal(path + " has no 3-D cells to render; it holds " +
                  (kinds.empty() ? "no cells at all (is it cut short?)" : kinds));
}

static void note_split(std::vector<std::string> &notes, const Gathered &data, const Tets &tets, int refine)
{
    if (data.n_ghost)
        notes.push_back(counted(data.n_ghost, "ghost or blanked cell was", "ghost or blanked cells were") +
                        " left out");
    if (data.n_curved && refine == 0)
        notes.push_back(counted(data.n_curved, "cell of higher order was", "cells of higher order were") +
                        " made linear by their corners (--refine N keeps more of the curve)");
    if (tets.folded_cells)
        notes.push_back(counted(tets.folded_cells, "cell is", "cells are") + " folded over; the tets overlap there");
    if (tets.centred_cells)
        notes.push_back(counted(tets.centred_cells, "cell got a point", "cells got points") +
                        " inside, with interpolated data");
    if (tets.open_cells)
        notes.push_back(counted(tets.open_cells, "polyhedron is", "polyhedra are") + " not closed and left out");
    if (tets.refused_cells)
        notes.push_back(counted(tets.refused_cells, "polyhedron", "polyhedra") + " could not be filled and left out");
}

void load_step(Step &out, const ReadRequest &request, OpenFile *open, VtkTalk &talk)
{
    out.loaded = load_file(request, open, talk);
    gather_leaves(out.data, out.loaded.data);
    count_cells(out.data, request.path);
    require_solid(request.path, out.data);
    list_read_arrays(out.loaded.offered, out.data);
    list_block_numbers(out.loaded.offered, out.loaded.blocks, out.data);
    out.chosen = choose_field(request.path, request.field, out.loaded.offered);
}

const SplitFile &split_step(Kept &kept, SplitFile &fresh, const ReadRequest &request, const Gathered &data,
                            VtkTalk &talk)
{
    uint64_t input = 0;
    const bool hashed = request.keep && hash_input(input, data);
    if (hashed && kept.there && kept.input == input && kept.refine == request.refine)
        return kept.split;
    kept = Kept();
    fresh.refined = split_mesh(fresh.tets, data, request.refine, fresh.notes, talk);
    note_split(fresh.notes, data, fresh.tets, fresh.refined);
    if (fresh.tets.tet.empty())
        throw Refusal(request.path + ": none of its " + std::to_string(data.n_solid) +
                      " 3-D cells has a volume: they are collapsed, or polyhedra that are not closed");
    fresh.used = compact_points(fresh.tets);
    fresh.lost = count_lost_points(fresh.tets, data, fresh.used);
    hash_split(fresh, fresh.vertices(), data.n_solid);
    if (!hashed)
        return fresh;
    kept.there = true;
    kept.input = input;
    kept.refine = request.refine;
    kept.split = std::move(fresh);
    return kept.split;
}

} // namespace tetcast
