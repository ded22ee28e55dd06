// stepper.glsl: moves a ray through one tetrahedron. Every driver and every kind of cell uses this step and no other.
//
// Garrity 1990; Weiler et al. 2003, 3.4, with the exit face chosen by the signs of two-dimensional cross products instead of
// by intersection points (after Aman et al. 2022). The ray is the origin of its own frame (ray.glsl). A face holds the
// ray iff the crosses of its projected vertices, taken around, agree in sign. Signs are exact and ties broken consistently
// (signs.glsl), so a cell has 0 or 2 faces that hold the ray, and a walk from a boundary face ends at a boundary face.
//
// Use:  walk_face, then until the ray is finished
//           walk_exact, then walk_step, and after it walk_step again for as long as walk_fast says yes.
// Ties are rare, but a group of lanes that runs in step pays for their rules whenever these stand in its loop. So they
// stand outside of it: walk_fast looks at the next cell, and gives up where a sign is in doubt.

#include "ray.glsl"
#include "signs.glsl"
#include "mesh.glsl"

// Rounding of a depth within the mesh: half diagonals, of which it reaches over 2.
const float WALK_DEPTH_ROUNDING = 4.0e-7;

// A ray at a face that holds it, about to enter `cell` through it.
struct Walk {
    int cell;      // -1: outside
    ivec3 id;      // the face's vertices, counter-clockwise around the ray
    vec4 a, b, c;  // projected: x, y across, z along the ray, and the scalar
    vec3 weight;   // crosses (b,c), (c,a), (a,b), all positive: the ray's barycentric coordinates in the face
    float z, s;    // depth and scalar where the ray meets the face
    int n3;        // the cell's neighbour n3 (mesh.glsl)
    int ahead;     // the cell's fourth vertex
    // Fetched before they are needed, for memory is slow. Behind a loop in which they were fetched they are to be fetched again:
    // llvmpipe then has what the last lane that left it fetched.
    ivec4 record;      // the cell's
    vec4 ahead_vertex; // the fourth vertex'; from a step to walk_fast alone
    vec4 d;        // the fourth vertex, projected
    vec3 cross_d;  // crosses (d,a), (d,b), (d,c)
};

struct Segment {
    float z0, z1; // depths of entry and exit, z0 <= z1
    float s0, s1; // scalars there
    bool real;
    int cell;
};

vec4 walk_vertex(Ray ray, int id)
{
    vec4 x = fetch(mesh_vertices, id);
    return vec4(ray_project(ray, x.xyz), x.w);
}

// Fetches what the next step will look at, coming `from` the cell behind the face (-1: from outside); outside the mesh
// something that is there and never used.
void walk_look_ahead(inout Walk w, int from)
{
    w.record = mesh_record(max(w.cell, 0));
    int id = w.record.x ^ w.id.x ^ w.id.y ^ w.id.z;
    w.n3 = from ^ mesh_other(w.record, id, w.id);
    w.ahead = w.cell < 0 ? w.id.x : id;
    w.ahead_vertex = fetch(mesh_vertices, w.ahead);
}

// The cell that a walk inside the mesh comes from.
int walk_from(Walk w)
{
    return w.n3 ^ mesh_other(mesh_record(max(w.cell, 0)), w.ahead, w.id);
}

// Depth and scalar at the walk's face: a convex combination, so both stay within the face's own values.
vec2 walk_face_point(Walk w)
{
    vec2 sum = w.weight.x * w.a.zw + w.weight.y * w.b.zw + w.weight.z * w.c.zw;
    return sum * (1.0 / (w.weight.x + w.weight.y + w.weight.z));
}

// Sets up the face (id) that the ray meets; false when the signs say that it does not. `facing` gets +1 when the
// vertices run counter-clockwise around the ray, -1 when clockwise (they are then swapped).
bool walk_face(out Walk w, Ray ray, int cell, ivec3 id, out int facing)
{
    w.cell = cell;
    w.id = id;
    w.a = walk_vertex(ray, id.x);
    w.b = walk_vertex(ray, id.y);
    w.c = walk_vertex(ray, id.z);
    w.weight = vec3(sign_cross(w.b.xy, w.c.xy, id.y, id.z), sign_cross(w.c.xy, w.a.xy, id.z, id.x),
                    sign_cross(w.a.xy, w.b.xy, id.x, id.y));
    facing = w.weight.x > 0.0 ? 1 : -1;
    if (facing < 0) {
        w.id = id.xzy;
        vec4 t = w.b;
        w.b = w.c;
        w.c = t;
        w.weight = -w.weight.xzy;
    }
    vec2 at = walk_face_point(w);
    w.z = at.x;
    w.s = at.y;
    return w.weight.y > 0.0 && w.weight.z > 0.0;
}

// Looks at the cell ahead, exactly.
void walk_exact(inout Walk w, Ray ray)
{
    w.record = mesh_record(max(w.cell, 0));
    w.ahead_vertex = fetch(mesh_vertices, w.ahead);
    w.d = vec4(ray_project(ray, w.ahead_vertex.xyz), w.ahead_vertex.w);
    w.cross_d = vec3(sign_cross(w.d.xy, w.a.xy, w.ahead, w.id.x), sign_cross(w.d.xy, w.b.xy, w.ahead, w.id.y),
                     sign_cross(w.d.xy, w.c.xy, w.ahead, w.id.z));
}

// The same without the rules for ties; false where a sign is in doubt, and walk_exact must be called.
bool walk_fast(inout Walk w, Ray ray)
{
    bool sure = true;
    w.d = vec4(ray_project(ray, w.ahead_vertex.xyz), w.ahead_vertex.w);
    w.cross_d.x = sign_cross_fast(w.d.xy, w.a.xy, sure);
    w.cross_d.y = sign_cross_fast(w.d.xy, w.b.xy, sure);
    w.cross_d.z = sign_cross_fast(w.d.xy, w.c.xy, sure);
    return sure;
}

#ifdef AUDIT
// How many of the coming cell's faces hold the ray: 2, by docs/stability.md. Asked afresh, of all four.
uint walk_holding_faces(Walk w)
{
    float ab = sign_cross(w.a.xy, w.b.xy, w.id.x, w.id.y), bc = sign_cross(w.b.xy, w.c.xy, w.id.y, w.id.z);
    float ca = sign_cross(w.c.xy, w.a.xy, w.id.z, w.id.x), ad = sign_cross(w.a.xy, w.d.xy, w.id.x, w.ahead);
    float bd = sign_cross(w.b.xy, w.d.xy, w.id.y, w.ahead), cd = sign_cross(w.c.xy, w.d.xy, w.id.z, w.ahead);
    bvec4 left = bvec4(ab > 0.0 && bc > 0.0 && ca > 0.0, ab > 0.0 && bd > 0.0 && ad < 0.0,
                       bc > 0.0 && cd > 0.0 && bd < 0.0, ca > 0.0 && ad > 0.0 && cd < 0.0);
    bvec4 right = bvec4(ab < 0.0 && bc < 0.0 && ca < 0.0, ab < 0.0 && bd < 0.0 && ad > 0.0,
                        bc < 0.0 && cd < 0.0 && bd > 0.0, ca < 0.0 && ad < 0.0 && cd > 0.0);
    uvec4 holds = uvec4(left) + uvec4(right);
    return holds.x + holds.y + holds.z + holds.w;
}
#endif

// One cell step: from the face into w.cell and out at the face that holds the ray there.
Segment walk_step(inout Walk w, Ray ray)
{
    int cell = w.cell;
    int id = w.ahead;
    vec4 d = w.d;
    float da = w.cross_d.x, db = w.cross_d.y, dc = w.cross_d.z;

    // The exit face keeps two entry vertices and d, which takes the dropped one's place: (a,b,d), (a,d,c), else (d,b,c).
    // Two signs choose. Selections, not branches: lanes of one group differ here.
    // None of the crosses is zero or NaN, so the signs are their first bits.
    int a = floatBitsToInt(da), b = floatBitsToInt(db), c = floatBitsToInt(dc);
    bool drop_c = (~a & b) < 0;
    bool drop_b = (a & ~c) < 0;
    bool drop_a = !drop_b && !drop_c;
    int dropped = drop_c ? w.id.z : drop_b ? w.id.y : w.id.x;
    w.weight = vec3(drop_c ? -db : drop_b ? dc : w.weight.x, drop_a ? -dc : drop_c ? da : w.weight.y,
                    drop_b ? -da : drop_a ? db : w.weight.z);
    w.id = ivec3(drop_a ? id : w.id.x, drop_b ? id : w.id.y, drop_c ? id : w.id.z);
    w.a = drop_a ? d : w.a;
    w.b = drop_b ? d : w.b;
    w.c = drop_c ? d : w.c;
    w.cell = w.n3 ^ mesh_other(w.record, dropped, w.id);
    walk_look_ahead(w, cell);

    Segment segment;
    segment.cell = cell;
    segment.real = mesh_is_real(cell);
    segment.z0 = w.z;
    segment.s0 = w.s;
    vec2 at = walk_face_point(w);
    // Depth never goes back. Where it stands still within rounding, as in a layer of no thickness, the scalar is that of the
    // face behind, which may be cut into other triangles than the one before; where a folded cell's exit lies further back,
    // that exit's scalar belongs elsewhere and is not taken. Behind an imaginary cell the scalar is always the face's own:
    // the one before it belonged to other vertices.
    bool here = at.x > w.z - WALK_DEPTH_ROUNDING;
#ifdef NONFINITE
    w.s = here || !segment.real || isnan(w.s) || isnan(at.y) ? at.y : w.s;
#else
    w.s = here || !segment.real ? at.y : w.s;
#endif
    w.z = max(w.z, at.x);
    segment.z1 = w.z;
    segment.s1 = w.s;
    return segment;
}
