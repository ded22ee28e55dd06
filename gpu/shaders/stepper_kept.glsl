// stepper_kept.glsl: walks along what record.frag wrote down, behind the functions of stepper.glsl: no cell is stepped through
// and no sign is asked, since where a ray goes depends on the mesh and the view alone. Lengths are as they were, scalars those of
// the vertices as they are now (kept.c).

#include "mesh.glsl"

layout(rg32f, binding = 4) readonly restrict uniform imageBuffer kept_pairs; // a record's scalar, and the length before it

struct Ray {
    float unused;
};

Ray ray_of_pixel(vec2 pixel)
{
    return Ray(0.0);
}

struct Walk {
    int cell; // the next record; negative: there is none
    ivec3 id; // x: the one behind the last
    float z, s;
};

struct Segment {
    float z0, z1;
    float s0, s1;
    bool real;
    int cell;
};

bool walk_face(out Walk w, Ray ray, int cell, ivec3 id, out int facing)
{
    w.cell = cell;
    w.id = id;
    w.z = 0.0;
    w.s = imageLoad(kept_pairs, max(cell, 0)).x;
    facing = -1;
    return true;
}

void walk_look_ahead(inout Walk w, int from)
{
}

int walk_from(Walk w)
{
    return 0;
}

void walk_exact(inout Walk w, Ray ray)
{
}

bool walk_fast(inout Walk w, Ray ray)
{
    return true;
}

Segment walk_step(inout Walk w, Ray ray)
{
    vec2 next = imageLoad(kept_pairs, w.cell).xy;
    Segment segment = Segment(0.0, next.y, w.s, next.x, true, w.cell);
    w.s = w.cell >= 0 ? next.x : w.s; // carried: behind a loop llvmpipe has what the last lane that left it fetched
    w.cell = w.cell >= 0 && w.cell + 1 < w.id.x ? w.cell + 1 : min(w.cell, -1);
    return segment;
}
