// fuzz_split.cpp: cells of every shape into tets, from any points and ids that are in range, as readers/gather.cpp
// checks. Input: flags, numbers of points and cells, points, then shape and corners (for polyhedra: faces) of each
// cell. Promises: every tet names points that there are, repeats none, is not of negative volume, and comes from a
// cell.
#include "fuzz.h"

#include "readers/rank_points.h"
#include "readers/split_cells.h"

#include <cmath>

using namespace tetcast;

static void check(const Tets &tets, int64_t n_cell)
{
    TC_FUZZ_CHECK(tets.tet.size() == 4 * tets.cell.size() && tets.rank.size() == tets.n_point());
    TC_FUZZ_CHECK(tets.weight_first.size() == tets.n_point() - tets.n_file_point + 1);
    for (size_t t = 0; t < tets.cell.size(); t++) {
        const int32_t *v = &tets.tet[4 * t];
        TC_FUZZ_CHECK(tets.cell[t] >= 0 && tets.cell[t] < n_cell);
        for (int i = 0; i < 4; i++) {
            TC_FUZZ_CHECK(v[i] >= 0 && (size_t)v[i] < tets.n_point());
            for (int j = 0; j < i; j++)
                TC_FUZZ_CHECK(v[i] != v[j]);
        }
        TC_FUZZ_CHECK(!(tet_volume6(tets.at(v[0]), tets.at(v[1]), tets.at(v[2]), tets.at(v[3])) < 0));
    }
    for (int32_t id : tets.weight_id)
        TC_FUZZ_CHECK(id >= 0 && (size_t)id < tets.n_file_point);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const Shape shape[] = {Shape::tetra,      Shape::pyramid,          Shape::wedge,           Shape::hexahedron,
                                  Shape::voxel,      Shape::pentagonal_prism, Shape::hexagonal_prism, Shape::polyhedron,
                                  Shape::polyhedron, Shape::hexahedron};
    tc_fuzz_input in = {data, size};
    const int flags = tc_fuzz_u8(&in);
    const size_t n_point = 1 + tc_fuzz_u8(&in) % 24u, n_cell = tc_fuzz_u8(&in) % 6u;
    Tets tets;
    for (size_t i = 0; i < 3 * n_point; i++)
        tets.point.push_back(flags & 1 ? (double)(tc_fuzz_u8(&in) % 4) : tc_fuzz_real(&in));
    for (size_t i = 0; i < n_point; i++)
        tets.rank.push_back((int32_t)i);
    tets.n_file_point = n_point;
    if (flags & 2)
        rank_points(tets);
    for (size_t c = 0; c < n_cell; c++) {
        const Shape s = shape[tc_fuzz_u8(&in) % (sizeof shape / sizeof *shape)];
        if (s != Shape::polyhedron) {
            int32_t id[16];
            for (int i = 0; i < corner_count(s); i++)
                id[i] = (int32_t)(tc_fuzz_u8(&in) % n_point);
            if (flags & 4) {
                EdgeColours colours(tets);
                colours.add_cell(tets, s, id);
                colours.apply(tets);
            }
            split_cell(tets, (int64_t)c, s, id);
            continue;
        }
        std::vector<std::vector<int32_t>> face(tc_fuzz_u8(&in) % 13u);
        for (std::vector<int32_t> &f : face) {
            f.resize(tc_fuzz_u8(&in) % 7u);
            for (int32_t &id : f)
                id = (int32_t)(tc_fuzz_u8(&in) % n_point);
        }
        split_polyhedral_cell(tets, (int64_t)c, face);
    }
    check(tets, (int64_t)n_cell);
    return 0;
}
