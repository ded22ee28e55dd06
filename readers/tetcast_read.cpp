// tetcast_read.cpp: the helper program: reads one time step of a file with VTK, splits every cell into tets and hands
// arrays back, or only what they will be like, or the triangles and lines alone (protocol: src/core/serve.h; requests and
// results: readers/read.c, readers/survey.c, readers/read_geometry.c).
#include "cell_types.h"
#include "core/serve.h"
#include "step.h"
#include "surface.h"
#include "survey.h"

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <memory>

namespace tetcast
{

namespace
{

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
    Step step;
    load_step(step, request, nullptr, talk);
    Loaded &loaded = step.loaded;
    const Gathered &data = step.data;
    const Chosen &chosen = step.chosen;
    find_ranges(loaded.offered, data, [&](const Offered &o) {
        return request.all_ranges || (o.name == chosen.name && o.association == chosen.association);
    });

    SplitFile fresh;
    const SplitFile &split = split_step(kept, fresh, request, data, talk);
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
    Loaded loaded = load_file(request, nullptr, talk);
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

// What is kept from one request to the next.
struct State {
    Kept kept;
    Surveyed surveyed;
};

void handle(void *context, tc_serve *serve, json_t *request, const tc_array *, size_t)
{
    const char *what = json_string_value(json_object_get(request, "do"));
    const char *path = json_string_value(json_object_get(request, "path"));
    const std::string name = path ? path : "the file";
    State *state = static_cast<State *>(context);
    try {
        if (what && std::string(what) == "read")
            read(serve, state->kept, request);
        else if (what && std::string(what) == "survey")
            survey(serve, state->surveyed, state->kept, request);
        else if (what && std::string(what) == "surface")
            read_surface(serve, request);
        else
            tc_serve_error(serve, "tetcast-read only knows the requests \"read\", \"survey\" and \"surface\"");
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
    tetcast::State state;
    return tc_serve_main(argc, argv, "tetcast-read", tetcast::handle, &state);
}
