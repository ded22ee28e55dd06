/* tetcast_convexify.cpp: the helper program that fills what lies between a boundary and its convex hull with tets.
 * TetGen 1.5.0 (Si 2015) with the switches pcYQn makes the tets of the hull of a closed surface and keeps every point
 * and face of it; those that lie on the outer side of the surface are sent back.
 *
 * Request  {"do": "convexify"}: point f64 [n][3], face i32 [m][3] (seen from outside counter-clockwise)
 * Result   {"hull_volume": V, "n_tet": T}: point f64 [n + s][3] (the first n as TetGen has them; s points it added),
 *          tet i32 [k][4] (the exterior ones, positive orientation) */
#include "core/serve.h"

#ifndef TETLIBRARY
#define TETLIBRARY
#endif
#include <tetgen.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <new>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

namespace
{

/* Face f of a tet lies opposite corner f and is wound counter-clockwise seen from outside. */
const int tet_face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

struct face_key {
    std::array<int, 3> id; /* ascending */
    int parity;            /* of the permutation from the outward order */
};

face_key key_of(int a, int b, int c)
{
    face_key k{{a, b, c}, 0};
    if (k.id[0] > k.id[1])
        std::swap(k.id[0], k.id[1]), k.parity ^= 1;
    if (k.id[1] > k.id[2])
        std::swap(k.id[1], k.id[2]), k.parity ^= 1;
    if (k.id[0] > k.id[1])
        std::swap(k.id[0], k.id[1]), k.parity ^= 1;
    return k;
}

bool operator<(const face_key &p, const face_key &q)
{
    return p.id < q.id;
}

double six_volumes(const double *a, const double *b, const double *c, const double *d)
{
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++)
        u[k] = b[k] - a[k], v[k] = c[k] - a[k], w[k] = d[k] - a[k];
    return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2];
}

void fill_input(tetgenio &in, const double *point, size_t n_point, const int32_t *face, size_t n_face)
{
    in.firstnumber = 0;
    in.numberofpoints = (int)n_point;
    in.pointlist = new double[3 * n_point];
    std::copy(point, point + 3 * n_point, in.pointlist);
    in.facetlist = new tetgenio::facet[n_face];
    in.numberoffacets = (int)n_face;
    for (size_t i = 0; i < n_face; i++) {
        tetgenio::facet &f = in.facetlist[i];
        tetgenio::init(&f);
        f.polygonlist = new tetgenio::polygon[1];
        f.numberofpolygons = 1;
        tetgenio::polygon &p = f.polygonlist[0];
        tetgenio::init(&p);
        p.vertexlist = new int[3];
        p.numberofvertices = 3;
        std::copy(face + 3 * i, face + 3 * i + 3, p.vertexlist);
    }
}

const char *sentence(int code)
{
    switch (code) {
    case 1:
        return "TetGen ran out of memory on this boundary";
    case 2:
        return "TetGen met an internal error on this boundary";
    case 3:
        return "TetGen found that this boundary intersects itself";
    case 4:
        return "TetGen found features of this boundary that are too small for it";
    case 5:
        return "TetGen found two facets of this boundary too close to each other";
    case 10:
        return "TetGen does not accept this boundary as input";
    default:
        return nullptr;
    }
}

/* The tets of TetGen's result and which side of the boundary each lies on. */
class filling
{
  public:
    filling(const tetgenio &from, const int32_t *face, size_t n_face) : out(from)
    {
        orient();
        for (size_t i = 0; i < n_face; i++)
            boundary.push_back(key_of(face[3 * i], face[3 * i + 1], face[3 * i + 2]));
        std::sort(boundary.begin(), boundary.end());
        flood();
    }

    /* The hull's volume from its own faces (divergence theorem about the first point). */
    double hull_volume() const
    {
        double sum = 0;
        for (int t = 0; t < out.numberoftetrahedra; t++)
            for (int f = 0; f < 4; f++)
                if (out.neighborlist[4 * t + f] < 0)
                    sum +=
                        six_volumes(out.pointlist, at(t, tet_face[f][0]), at(t, tet_face[f][1]), at(t, tet_face[f][2]));
        return sum * sign / 6;
    }

    /* Outer tets, and the points they use beyond the first n numbered after those. */
    void outer(std::vector<int32_t> &tet, std::vector<double> &point, size_t n) const
    {
        std::vector<int32_t> number((size_t)out.numberofpoints, -1);
        point.assign(out.pointlist, out.pointlist + 3 * n);
        for (size_t v = 0; v < n; v++)
            number[v] = (int32_t)v;
        for (int t = 0; t < out.numberoftetrahedra; t++) {
            if (side[(size_t)t] != OUTER)
                continue;
            int32_t id[4];
            for (int i = 0; i < 4; i++) {
                size_t v = (size_t)out.tetrahedronlist[4 * t + i];
                if (number[v] < 0) {
                    number[v] = (int32_t)(point.size() / 3);
                    point.insert(point.end(), out.pointlist + 3 * v, out.pointlist + 3 * v + 3);
                }
                id[i] = number[v];
            }
            if (sign < 0)
                std::swap(id[2], id[3]);
            tet.insert(tet.end(), id, id + 4);
        }
    }

  private:
    enum : signed char { UNKNOWN, INNER, OUTER };

    const tetgenio &out;
    int sign = 1; /* TetGen winds all its tets alike: which way? */
    std::vector<face_key> boundary;
    std::vector<signed char> side;
    std::vector<int> stack;

    const double *at(int t, int corner) const
    {
        return out.pointlist + 3 * (size_t)out.tetrahedronlist[4 * t + corner];
    }

    void orient()
    {
        double sum = 0;
        for (int t = 0; t < out.numberoftetrahedra; t++)
            sum += six_volumes(at(t, 0), at(t, 1), at(t, 2), at(t, 3));
        sign = sum < 0 ? -1 : 1;
    }

    /* The boundary's face that is face f of tet t, or null; same: the tet lies on its inner side. */
    const face_key *find(int t, int f, bool &inner) const
    {
        const int *v = out.tetrahedronlist + 4 * (size_t)t;
        face_key k = key_of(v[tet_face[f][0]], v[tet_face[f][1]], v[tet_face[f][2]]);
        auto hit = std::lower_bound(boundary.begin(), boundary.end(), k);
        if (hit == boundary.end() || hit->id != k.id)
            return nullptr;
        inner = (hit->parity == k.parity) == (sign > 0);
        return &*hit;
    }

    void mark(int t, signed char as)
    {
        signed char &s = side[(size_t)t];
        if (s == UNKNOWN) {
            s = as;
            stack.push_back(t);
        } else if (s != as) {
            throw std::runtime_error("the boundary does not separate inside from outside");
        }
    }

    void flood()
    {
        size_t n = (size_t)out.numberoftetrahedra;
        std::vector<char> wall(4 * n, 0), seen(boundary.size(), 0);
        side.assign(n, UNKNOWN);
        for (int t = 0; t < out.numberoftetrahedra; t++)
            for (int f = 0; f < 4; f++) {
                bool inner = false;
                const face_key *k = find(t, f, inner);
                if (!k)
                    continue;
                wall[4 * (size_t)t + (size_t)f] = 1;
                seen[(size_t)(k - boundary.data())] = 1;
                mark(t, inner ? INNER : OUTER);
            }
        size_t missing = (size_t)std::count(seen.begin(), seen.end(), 0);
        if (missing > 0)
            throw std::runtime_error(std::to_string(missing) + " of " + std::to_string(boundary.size()) +
                                     " boundary faces are missing from TetGen's result");
        while (!stack.empty()) {
            int t = stack.back();
            stack.pop_back();
            for (int f = 0; f < 4; f++) {
                int u = out.neighborlist[4 * t + f];
                if (u >= 0 && !wall[4 * (size_t)t + (size_t)f])
                    mark(u, side[(size_t)t]);
            }
        }
        if (std::count(side.begin(), side.end(), (signed char)UNKNOWN) > 0)
            throw std::runtime_error("TetGen's result holds cells that no boundary face leads to");
    }
};

const tc_array *find_array(const tc_array *array, size_t n, const char *name, tc_array_type type)
{
    for (size_t i = 0; i < n; i++)
        if (std::strcmp(array[i].name, name) == 0 && array[i].type == type && array[i].count % 3 == 0)
            return array + i;
    return nullptr;
}

void convexify(tc_serve *serve, const tc_array *array, size_t n_array)
{
    const tc_array *point = find_array(array, n_array, "point", TC_F64);
    const tc_array *face = find_array(array, n_array, "face", TC_I32);
    if (!point || !face || point->count == 0 || face->count == 0 || point->count > INT32_MAX || face->count > INT32_MAX)
        throw std::runtime_error("the request has no points and faces that TetGen could take");
    const double *x = static_cast<const double *>(point->data);
    const int32_t *v = static_cast<const int32_t *>(face->data);
    size_t n_point = point->count / 3, n_face = face->count / 3;
    for (size_t i = 0; i < face->count; i++)
        if (v[i] < 0 || (size_t)v[i] >= n_point)
            throw std::runtime_error("the request names a point that it does not hold");

    tetgenio in, out;
    fill_input(in, x, n_point, v, n_face);
    char switches[] = "pcYQn";
    tc_serve_progress(serve, "filling gaps", -1);
    tetrahedralize(switches, &in, &out);
    if (out.numberoftetrahedra <= 0 || out.numberofcorners != 4 || !out.tetrahedronlist || !out.neighborlist)
        throw std::runtime_error("TetGen made no tetrahedra from this boundary");
    if ((size_t)out.numberofpoints < n_point)
        throw std::runtime_error("TetGen lost points of this boundary");

    filling fill(out, v, n_face);
    std::vector<int32_t> tet;
    std::vector<double> all;
    fill.outer(tet, all, n_point);
    tc_array result[2] = {{"point", TC_F64, all.size(), all.data()}, {"tet", TC_I32, tet.size(), tet.data()}};
    json_t *json = json_pack("{s:f,s:I}", "hull_volume", fill.hull_volume(), "n_tet",
                             static_cast<json_int_t>(out.numberoftetrahedra));
    tc_serve_result(serve, json, result, 2);
    json_decref(json);
}

void handle(void *, tc_serve *serve, json_t *request, const tc_array *array, size_t n_array)
{
    const char *what = json_string_value(json_object_get(request, "do"));
    if (!what || std::strcmp(what, "convexify") != 0) {
        tc_serve_error(serve, "tetcast-convexify knows the request \"convexify\" only");
        return;
    }
    try {
        convexify(serve, array, n_array);
    } catch (int code) { /* TetGen's own way */
        const char *text = sentence(code);
        tc_serve_error(serve,
                       text ? text : ("TetGen gave up on this boundary with code " + std::to_string(code)).c_str());
    } catch (const std::bad_alloc &) {
        tc_serve_error(serve, sentence(1));
    } catch (const std::exception &e) {
        tc_serve_error(serve, e.what());
    } catch (...) {
        tc_serve_error(serve, "TetGen gave up on this boundary");
    }
}

} // namespace

int main(int argc, char **argv)
{
    int null = open("/dev/null", O_WRONLY | O_CLOEXEC); /* TetGen prints; stdout is the main program's */
    if (null >= 0) {
        dup2(null, STDOUT_FILENO);
        close(null);
    }
    return tc_serve_main(argc, argv, "tetcast-convexify", handle, nullptr);
}
