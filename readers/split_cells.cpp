// split_cells.cpp: linear cells into conforming tets.
// Dompierre, Labbe, Vallet, Camarero 1999, "How to subdivide pyramids, prisms and hexahedra into tetrahedra":
// each quadrilateral is cut from its lowest vertex; then the cell is coned from its lowest vertex to the triangles that
// do not touch it. A hexahedron none of whose cuts meets the opposite vertex has five tets (their case 0), else six.
#include "split_cells.h"

#include "split_polyhedron.h"

#include <algorithm>
#include <cmath>

namespace tetcast
{

namespace
{

constexpr double fold_tolerance = 1e-6; // of the largest tet of the cell: below it a negative volume is rounding
constexpr int max_corner = 12;
constexpr int max_tet = 24;

struct Piece {
    int v[4];
    double volume;
};

// Order of the corners: by rank, ties by place in the cell (a collapsed edge: either cut gives the same tets).
int lowest(const int *rank, const int *corner, int n)
{
    int best = 0;
    for (int i = 1; i < n; i++)
        if (rank[corner[i]] < rank[corner[best]])
            best = i;
    return best;
}

int cone(Piece *piece, const int *rank, int n, const std::vector<std::vector<int>> &faces)
{
    int all[max_corner];
    for (int i = 0; i < n; i++)
        all[i] = i;
    const int top = lowest(rank, all, n);
    int made = 0;
    for (const std::vector<int> &face : faces) {
        const int m = (int)face.size();
        if (std::find(face.begin(), face.end(), top) != face.end())
            continue;
        const int start = lowest(rank, face.data(), m);
        for (int i = 1; i + 1 < m; i++)
            piece[made++] = {{top, face[start], face[(start + i) % m], face[(start + i + 1) % m]}, 0};
    }
    return made;
}

// Case 0: three of the six tets hold the corner opposite the top; two replace them.
int five_of_six(Piece *piece, int made)
{
    int count[8] = {0};
    for (int i = 0; i < made; i++)
        for (int k = 1; k < 4; k++)
            count[piece[i].v[k]]++;
    int opposite = -1;
    const int top = piece[0].v[0];
    for (int c = 0; c < 8; c++) {
        // Only the opposite corner lies in all three far faces; uncut it is in exactly three triangles and its three
        // neighbours are each in four.
        if (c == top || count[c] != 3)
            continue;
        int neighbours = 0;
        for (int k = 0; k < 8; k++)
            neighbours += count[k] == 4;
        if (neighbours == 3)
            opposite = c;
    }
    if (opposite < 0)
        return made;
    Piece kept[6];
    int n_kept = 0, next[3][2], n_next = 0;
    for (int i = 0; i < made; i++) {
        const int *v = piece[i].v;
        const int at = v[1] == opposite ? 1 : v[2] == opposite ? 2 : v[3] == opposite ? 3 : 0;
        if (at == 0) {
            if (n_kept < 3)
                kept[n_kept] = piece[i];
            n_kept++;
        } else if (n_next < 3) {
            next[n_next][0] = v[1 + at % 3];
            next[n_next][1] = v[1 + (at + 1) % 3];
            n_next++;
        }
    }
    if (n_kept != 3 || n_next != 3)
        return made;
    // The triangles (opposite, p, q) go around the opposite corner: p0 q0 and the one that follows q0.
    const int p = next[0][0], q = next[0][1];
    const int r = next[1][0] == q ? next[1][1] : next[2][1];
    for (int i = 0; i < 3; i++)
        piece[i] = kept[i];
    piece[3] = {{top, p, q, r}, 0};
    piece[4] = {{opposite, p, r, q}, 0};
    return 5;
}

void add_filled(Tets &out, int64_t cell_id, const PolyhedronTets &filled, const std::vector<int32_t> &id)
{
    // Added points interpolate the corners so that linear data stay linear: w = 1/n + (x - c)' M^-1 (p - c).
    const size_t n = id.size();
    std::vector<int32_t> added;
    for (const std::array<double, 3> &x : filled.added) {
        double c[3] = {0, 0, 0}, m[3][3] = {{0}}, scale = 0;
        for (int32_t corner : id)
            for (int k = 0; k < 3; k++)
                c[k] += out.at(corner)[k] / (double)n;
        for (int32_t corner : id) {
            const double *y = out.at(corner);
            for (int a = 0; a < 3; a++)
                for (int b = 0; b < 3; b++)
                    m[a][b] += (y[a] - c[a]) * (y[b] - c[b]);
        }
        for (int a = 0; a < 3; a++)
            scale += m[a][a];
        const double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
        double g[3] = {0, 0, 0};
        if (det > 1e-18 * scale * scale * scale) {
            const double d[3] = {x[0] - c[0], x[1] - c[1], x[2] - c[2]};
            for (int a = 0; a < 3; a++) {
                const int b = (a + 1) % 3, e = (a + 2) % 3;
                // Row a of the adjugate of a symmetric matrix.
                g[a] =
                    ((m[b][b] * m[e][e] - m[b][e] * m[e][b]) * d[a] + (m[b][e] * m[e][a] - m[b][a] * m[e][e]) * d[b] +
                     (m[b][a] * m[e][b] - m[b][b] * m[e][a]) * d[e]) /
                    det;
            }
        }
        std::vector<double> weight(n);
        for (size_t i = 0; i < n; i++) {
            const double *y = out.at(id[i]);
            weight[i] = 1.0 / (double)n + (y[0] - c[0]) * g[0] + (y[1] - c[1]) * g[1] + (y[2] - c[2]) * g[2];
        }
        added.push_back(out.add_point(x.data(), id.data(), weight.data(), n));
    }
    for (const std::array<int, 4> &t : filled.tet) {
        int32_t v[4];
        for (int k = 0; k < 4; k++)
            v[k] = t[k] < (int)n ? id[t[k]] : added[t[k] - n];
        out.add_tet(cell_id, v[0], v[1], v[2], v[3]);
    }
    out.centred_cells += !filled.added.empty();
}

// The cell's points once each, coincident ones joined so that collapsed faces close; ranks 0, 1, … in rank order.
PolyhedronResult fill(Tets &out, int64_t cell_id, const std::vector<std::vector<int32_t>> &face)
{
    std::vector<std::pair<int32_t, int32_t>> point; // (rank, id)
    for (const std::vector<int32_t> &f : face)
        for (int32_t id : f)
            point.emplace_back(out.rank[id], id);
    std::sort(point.begin(), point.end());
    point.erase(
        std::unique(point.begin(), point.end(), [](const auto &a, const auto &b) { return a.first == b.first; }),
        point.end());
    Polyhedron poly;
    std::vector<int32_t> id;
    for (const auto &p : point) {
        const double *x = out.at(p.second);
        poly.rank.push_back((int)poly.point.size());
        poly.point.push_back({x[0], x[1], x[2]});
        id.push_back(p.second);
    }
    for (const std::vector<int32_t> &f : face) {
        std::vector<int> local;
        for (int32_t corner : f) {
            const auto at = std::lower_bound(point.begin(), point.end(), std::make_pair(out.rank[corner], INT32_MIN));
            const int k = (int)(at - point.begin());
            if (local.empty() || local.back() != k)
                local.push_back(k);
        }
        while (local.size() > 1 && local.front() == local.back())
            local.pop_back();
        if (local.size() >= 3)
            poly.face.push_back(local);
    }
    // A mesh full of broken cells must not cost minutes.
    if (out.folded_cells + out.refused_cells > 256)
        poly.attempts = 1;
    PolyhedronTets filled;
    const PolyhedronResult result = split_polyhedron(filled, poly);
    if (result == PolyhedronResult::ok)
        add_filled(out, cell_id, filled, id);
    return result;
}

} // namespace

void split_cell(Tets &out, int64_t cell_id, Shape shape, const int32_t *id)
{
    const int n = corner_count(shape);
    if (shape == Shape::tetra) {
        const double v = tet_volume6(out.at(id[0]), out.at(id[1]), out.at(id[2]), out.at(id[3]));
        out.turned_cells += v < 0;
        out.add_tet(cell_id, id[0], id[1], id[2], id[3]);
        return;
    }
    int rank[max_corner];
    for (int i = 0; i < n; i++)
        rank[i] = out.rank[id[i]];
    const std::vector<std::vector<int>> &faces = shape_faces(shape);
    Piece piece[max_tet];
    int made = cone(piece, rank, n, faces);
    if ((shape == Shape::hexahedron || shape == Shape::voxel) && made == 6)
        made = five_of_six(piece, made);
    double low = 0, high = 0, sum = 0;
    for (int i = 0; i < made; i++) {
        const int *v = piece[i].v;
        piece[i].volume = tet_volume6(out.at(id[v[0]]), out.at(id[v[1]]), out.at(id[v[2]]), out.at(id[v[3]]));
        low = std::min(low, piece[i].volume);
        high = std::max(high, piece[i].volume);
        sum += piece[i].volume;
    }
    const double least = std::min(-low, high), most = std::max(-low, high);
    if (least > fold_tolerance * most) {
        std::vector<std::vector<int32_t>> face;
        for (const std::vector<int> &f : faces) {
            face.emplace_back();
            for (int k : f)
                face.back().push_back(id[k]);
        }
        if (fill(out, cell_id, face) == PolyhedronResult::ok)
            return;
        out.folded_cells++;
    }
    out.turned_cells += sum < 0 && shape != Shape::wedge;
    for (int i = 0; i < made; i++) {
        const int *v = piece[i].v;
        out.add_tet(cell_id, id[v[0]], id[v[1]], id[v[2]], id[v[3]]);
    }
}

void split_polyhedral_cell(Tets &out, int64_t cell_id, const std::vector<std::vector<int32_t>> &face)
{
    switch (fill(out, cell_id, face)) {
    case PolyhedronResult::ok:
        break;
    case PolyhedronResult::open:
        out.open_cells++;
        break;
    case PolyhedronResult::failed:
        out.refused_cells++;
        break;
    }
}

} // namespace tetcast
