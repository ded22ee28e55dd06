// tetcast_read.cpp: the helper program: reads one time step of a file with VTK, splits every cell into tets and hands
// arrays back, or the triangles and lines alone (protocol: src/core/serve.h; requests and results: readers/read.c,
// readers/read_geometry.c).
#include "cell_types.h"
#include "core/serve.h"
#include "fields.h"
#include "gather.h"
#include "kept.h"
#include "load.h"
#include "surface.h"
#include "vtk_talk.h"

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <memory>

namespace tetcast
{

namespace
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

json_t *text(const std::string &s)
{
    json_t *j = json_stringn(s.data(), s.size());
    return j ? j : json_string("(a name that is not UTF-8)");
}

json_t *describe_arrays(const std::vector<Offered> &offered)
{
    json_t *list = json_array();
    for (const Offered &o : offered) {
        json_t *row = json_object();
        json_object_set_new(row, "name", text(o.name));
        json_object_set_new(row, "association", json_integer(o.association));
        json_object_set_new(row, "components", json_integer(o.components));
        json_object_set_new(row, "ranged", json_boolean(o.ranged));
        if (o.ranged && o.lo <= o.hi) {
            json_object_set_new(row, "lo", json_real(o.lo));
            json_object_set_new(row, "hi", json_real(o.hi));
        }
        json_array_append_new(list, row);
    }
    return list;
}

json_t *describe_cells(const Gathered &data)
{
    json_t *list = json_array();
    for (const auto &entry : data.by_type) {
        const CellType &type = cell_type(entry.first);
        json_t *row = json_object();
        const std::string name = type.vtk < 0 ? "type_" + std::to_string(entry.first) : type.name;
        json_object_set_new(row, "type", text(name));
        json_object_set_new(row, "dimension", json_integer(type.dimension < 0 ? 0 : type.dimension));
        json_object_set_new(row, "count", json_integer((json_int_t)entry.second));
        json_array_append_new(list, row);
    }
    return list;
}

json_t *describe_blocks(const std::vector<Block> &blocks)
{
    json_t *list = json_array();
    for (const Block &block : blocks) {
        json_t *row = json_object();
        json_object_set_new(row, "number", json_integer((json_int_t)block.number));
        if (!block.name.empty())
            json_object_set_new(row, "name", text(block.name));
        json_array_append_new(list, row);
    }
    return list;
}

json_t *describe_texts(const std::vector<std::string> &lines)
{
    json_t *list = json_array();
    for (const std::string &line : lines)
        json_array_append_new(list, text(line));
    return list;
}

std::string counted(size_t n, const char *one, const char *many)
{
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

void require_solid(const std::string &path, const Gathered &data)
{
    if (data.n_solid > 0)
        return;
    std::string kinds;
    for (const auto &entry : data.by_type)
        kinds += (kinds.empty() ? "" : ", ") + std::to_string(entry.second) + " " + cell_type(entry.first).name;
    throw Refusal(path + " has no 3-D cells to render; it holds " +
                  (kinds.empty() ? "no cells at all (is it cut short?)" : kinds));
}

void note_split(std::vector<std::string> &notes, const Gathered &data, const Tets &tets, int refine)
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

// The tets of data: those of the last request where its points and cells were the same.
const SplitFile &split_file(Kept &kept, SplitFile &fresh, const ReadRequest &request, const Gathered &data,
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

std::string hex(uint64_t hash)
{
    char text[17];
    snprintf(text, sizeof text, "%016" PRIx64, hash);
    return text;
}

void read(tc_serve *serve, Kept &kept, json_t *json)
{
    const ReadRequest request = parse_request(json);
    VtkTalk talk(serve);
    talk.progress("reading", -1);
    Loaded loaded = load_file(request, talk);
    Gathered data;
    gather_leaves(data, loaded.data);
    count_cells(data, request.path);
    require_solid(request.path, data);
    list_read_arrays(loaded.offered, data);
    list_block_numbers(loaded.offered, loaded.blocks, data);
    const Chosen chosen = choose_field(request.path, request.field, loaded.offered);
    find_ranges(loaded.offered, data, [&](const Offered &o) {
        return request.all_ranges || (o.name == chosen.name && o.association == chosen.association);
    });

    SplitFile fresh;
    const SplitFile &split = split_file(kept, fresh, request, data, talk);
    const Tets &tets = split.tets;
    const std::vector<int32_t> &used = split.used;
    loaded.notes.insert(loaded.notes.end(), split.notes.begin(), split.notes.end());
    for (const Offered &o : loaded.offered)
        if (!chosen.none && o.name == chosen.name && o.association == chosen.association && o.blocks_without > 0)
            loaded.notes.push_back("array \"" + o.name + "\" is missing in " + std::to_string(o.blocks_without) +
                                   " of " + std::to_string(data.leaf.size()) + " blocks; there it is NaN");

    talk.progress("field", -1);
    const bool same = request.mesh == hex(split.hash);
    const std::vector<double> vertex = same ? std::vector<double>() : split.vertices();
    std::vector<double> scalar;
    if (!chosen.none && chosen.association == TC_POINT_DATA) {
        scalar.resize(used.size());
        point_values(scalar.data(), chosen, data, tets, used.data(), used.size());
    } else if (!chosen.none) {
        scalar.resize(tets.cell.size());
        cell_values(scalar.data(), chosen, data, tets.cell.data(), tets.cell.size());
    }

    std::unique_ptr<json_t, void (*)(json_t *)> result(json_object(), [](json_t *j) { json_decref(j); });
    json_object_set_new(result.get(), "mesh_hash", text(hex(split.hash)));
    json_object_set_new(result.get(), "same_mesh", json_boolean(same));
    json_object_set_new(result.get(), "format", text(loaded.format));
    json_object_set_new(result.get(), "reader", text(loaded.reader));
    if (!chosen.none) {
        json_object_set_new(result.get(), "field", text(chosen.label));
        json_object_set_new(result.get(), "association", json_integer(chosen.association));
    }
    json_object_set_new(result.get(), "points", json_integer((json_int_t)data.n_point));
    json_object_set_new(result.get(), "cells", json_integer((json_int_t)data.n_cell));
    json_object_set_new(result.get(), "solid_cells", json_integer((json_int_t)data.n_solid));
    json_object_set_new(result.get(), "dropped_cells",
                        json_integer((json_int_t)(data.n_cell - data.n_solid + tets.refused_cells + tets.open_cells)));
    json_object_set_new(result.get(), "degenerate", json_integer((json_int_t)tets.empty_cells));
    json_object_set_new(result.get(), "turned", json_integer((json_int_t)tets.turned_cells));
    json_object_set_new(result.get(), "unused_points", json_integer((json_int_t)split.lost.unused));
    json_object_set_new(result.get(), "merged_points", json_integer((json_int_t)split.lost.merged));
    json_object_set_new(result.get(), "linearised", json_boolean(data.n_curved > 0));
    json_object_set_new(result.get(), "refine", json_integer(split.refined));
    json_object_set_new(result.get(), "step", json_integer(loaded.step));
    json_t *times = json_array();
    for (double t : loaded.times)
        json_array_append_new(times, json_real(std::isfinite(t) ? t : 0));
    json_object_set_new(result.get(), "times", times);
    json_object_set_new(result.get(), "offered", describe_arrays(loaded.offered));
    json_object_set_new(result.get(), "blocks", describe_blocks(loaded.blocks));
    json_object_set_new(result.get(), "cell_types", describe_cells(data));
    json_object_set_new(result.get(), "notes", describe_texts(loaded.notes));

    std::vector<tc_array> array;
    if (!same)
        array = {{"vertex", TC_F64, vertex.size(), vertex.data()},
                 {"tet", TC_I32, tets.tet.size(), tets.tet.data()},
                 {"cell", TC_I64, tets.cell.size(), tets.cell.data()}};
    if (!chosen.none)
        array.push_back({"scalar", TC_F64, scalar.size(), scalar.data()});
    tc_serve_result(serve, result.get(), array.data(), array.size());
}

void read_surface(tc_serve *serve, json_t *json)
{
    ReadRequest request = parse_request(json);
    request.surface = true;
    request.field.any = false; // no array is called ""
    VtkTalk talk(serve);
    talk.progress("reading", -1);
    Loaded loaded = load_file(request, talk);
    Gathered data;
    gather_leaves(data, loaded.data);
    for (const Leaf &leaf : data.leaf)
        check_surface_cells(leaf, request.path);
    count_cells(data, request.path);
    Surface surface;
    make_surface(surface, data, request.path);
    loaded.notes.insert(loaded.notes.end(), surface.notes.begin(), surface.notes.end());
    std::unique_ptr<json_t, void (*)(json_t *)> result(json_object(), [](json_t *j) { json_decref(j); });
    json_object_set_new(result.get(), "notes", describe_texts(loaded.notes));
    const tc_array array[] = {{"vertex", TC_F64, surface.vertex.size(), surface.vertex.data()},
                              {"triangle", TC_I32, surface.triangle.size(), surface.triangle.data()},
                              {"line", TC_I32, surface.line.size(), surface.line.data()}};
    tc_serve_result(serve, result.get(), array, 3);
}

void handle(void *context, tc_serve *serve, json_t *request, const tc_array *, size_t)
{
    const char *what = json_string_value(json_object_get(request, "do"));
    const char *path = json_string_value(json_object_get(request, "path"));
    const std::string name = path ? path : "the file";
    try {
        if (what && std::string(what) == "read")
            read(serve, *static_cast<Kept *>(context), request);
        else if (what && std::string(what) == "surface")
            read_surface(serve, request);
        else
            tc_serve_error(serve, "tetcast-read only knows the requests \"read\" and \"surface\"");
    } catch (const Refusal &refusal) {
        tc_serve_error(serve, refusal.what());
    } catch (const std::bad_alloc &) {
        tc_serve_error(serve, (name + " needs more memory than there is").c_str());
    } catch (const std::exception &e) {
        tc_serve_error(serve, (name + " could not be read: " + e.what()).c_str());
    } catch (...) {
        tc_serve_error(serve, (name + " could not be read: VTK gave up without saying why").c_str());
    }
}

} // namespace
} // namespace tetcast

int main(int argc, char **argv)
{
    tetcast::Kept kept;
    return tc_serve_main(argc, argv, "tetcast-read", tetcast::handle, &kept);
}
