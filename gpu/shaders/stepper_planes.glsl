// stepper_planes.glsl: moves a ray through one tetrahedron by the arithmetic of Weiler et al. 2003: intersections with
// the planes of the faces (eq. 1), the nearest face that the ray leaves through, the scalar from the cell's gradient
// (eq. 2), all in float, from the textures of Table 1. It stands behind the functions of stepper.glsl to be compared
// with it: it loses rays, which stepper.glsl does not.
//
// Lost are: a ray that no face of its cell lets out, and one that comes to a face of a cell for the second time, since
// where it goes next depends on the two alone (R. P. Brent 1980: compare with a place kept, and keep another one after
// 1, 2, 4, 8, … steps). A ray that leaves the mesh through the wrong face looks like any other here.

#include "ray.glsl"
#include "mesh.glsl"

FETCH_BUFFER(4) planes_vertices;    // at 4*t + i: v(t,i)
FETCH_BUFFER(5) planes_normals;     // n(t,i), 1 + f(t,i) (negative: imaginary cell)
FETCH_INTS(6, r32i) planes_neighbours; // a(t,i), -1: outside
FETCH_BUFFER(7) planes_scalars;     // at t: g(t) and its offset
uniform float planes_longest;       // edge of the real cells
float planes_longest_kept = 0.0;

const int WALK_LOST = -3;           // in place of a cell
const float PLANES_LEAST = 1.0e-30;
const float PLANES_FAR = 1.0e6;     // "an appropriately large number" (3.3): nothing in the mesh is that far

// A ray about to enter `cell`.
struct Walk {
    int cell;   // as in stepper.glsl; -1: outside, WALK_LOST
    ivec3 id;   // -1 - j, with j the face it enters through; 4*t + j of a place kept; how many steps so far
    float z, s; // depth and scalar where the ray meets the face
    int t;      // the cell's index
};

struct Segment {
    float z0, z1; // depths of entry and exit, z0 <= z1
    float s0, s1; // scalars there
    bool real;
    int cell;
};

// Takes up a walk: from the first hit, as the vertices of a boundary face, or from the pass before, as id above.
bool walk_face(out Walk w, Ray ray, int cell, ivec3 id, out int facing)
{
    planes_longest_kept = keep(planes_longest);
    w.cell = cell;
    w.t = cell;
    w.id = id;
    w.z = w.s = 0.0;
    facing = 1;
    if (id.x < 0)
        return true;
    vec4 vertex_a = fetch(mesh_vertices, id.x), vertex_b = fetch(mesh_vertices, id.y), vertex_c = fetch(mesh_vertices, id.z);
    vec3 a = vertex_a.xyz, b = vertex_b.xyz, c = vertex_c.xyz;
    vec3 p = ray_project(ray, a), q = ray_project(ray, b), r = ray_project(ray, c);
    vec3 weight = vec3(q.x * r.y - q.y * r.x, r.x * p.y - r.y * p.x, p.x * q.y - p.y * q.x);
    weight = max(weight, PLANES_LEAST); // for the first hit has found the ray in the face
    float sum = weight.x + weight.y + weight.z;
    w.z = dot(weight, vec3(p.z, q.z, r.z)) / sum;
    w.s = dot(weight, vec3(vertex_a.w, vertex_b.w, vertex_c.w)) / sum;
    int entry = 0, best = -1;
    for (int i = 0; i < 4; i++) { // the face at the boundary whose opposite vertex is none of the three
        vec3 v = fetch(planes_vertices, 4 * w.t + i).xyz;
        int fits = fetch(planes_neighbours, 4 * w.t + i).x >= 0 ? -1 : v == a || v == b || v == c ? 0 : 1;
        entry = fits > best ? i : entry;
        best = max(fits, best);
    }
    w.id = ivec3(-1 - entry, 4 * w.t + entry, 0);
    return true;
}

// stepper.glsl looks ahead, and takes doubles where float is not enough; there is no such thing here.
void walk_look_ahead(inout Walk w, int from)
{
}

int walk_from(Walk w)
{
    return -1;
}

void walk_exact(inout Walk w, Ray ray)
{
}

bool walk_fast(inout Walk w, Ray ray)
{
    return true;
}

#ifdef AUDIT
uint walk_holding_faces(Walk w)
{
    return 2u; // no face is said to hold the ray
}
#endif

float planes_scalar(int t, vec3 x)
{
    vec4 g = fetch(planes_scalars, t);
    return dot(g.xyz, x) + g.w;
}

Segment walk_step(inout Walk w, Ray ray)
{
    int t = w.t, j = -1 - w.id.x, i = -1, f = 0;
    float lambda = PLANES_FAR, kind = 0.0;
    for (int k = 1; k < 4; k++) {
        int face = j ^ k;
        vec4 n = fetch(planes_normals, 4 * t + face);
        float down = dot(ray.d, n.xyz); // negative: the face is visible from the eye
        float at = dot(fetch(planes_vertices, 4 * t + 3 - face).xyz - ray.o, n.xyz) / down;
        kind = n.w;
        if (down > 0.0 && at < lambda) {
            lambda = at;
            i = face;
            f = int(abs(n.w)) - 1;
        }
    }
    int next = i < 0 ? WALK_LOST : fetch(planes_neighbours, 4 * t + i).x;
    Segment segment;
    segment.cell = w.cell;
    segment.real = kind > 0.0;
    segment.s0 = w.s;
    lambda = i < 0 ? w.z : lambda;
    vec3 x = ray.o + lambda * ray.d;
    // Behind an imaginary cell the scalar is that of the cell entered.
    float s = planes_scalar(segment.real || next < 0 ? t : next, x);
#ifdef NONFINITE
    float own = fetch(planes_scalars, t).w; // NaN: a vertex of this cell holds NaN
    segment.s0 = isnan(own) ? own : w.s;
    s = !isnan(own) ? s : next < 0 ? 0.0 : planes_scalar(next, x);
    s = isnan(s) ? s : clamp(s, 0.0, 1.0);
#else
    s = clamp(s, 0.0, 1.0); // as a texture's coordinates are
#endif
    // The length is the points' distance, even if the exit lies before the entry, and ends with the table of 3.3, whose
    // last entry is the longest edge.
    segment.z0 = min(w.z, lambda);
    segment.z1 = segment.real ? min(max(w.z, lambda), segment.z0 + planes_longest_kept) : max(w.z, lambda);
    segment.s1 = s;
    w.z = lambda;
    w.s = s;
    w.t = next;
    w.cell = next;
    if (next >= 0) {
        int place = 4 * next + f, n = w.id.z + 1;
        if (place == w.id.y)
            w.cell = WALK_LOST;
        w.id = ivec3(-1 - f, (n & (n - 1)) == 0 ? place : w.id.y, n);
    }
    return segment;
}
