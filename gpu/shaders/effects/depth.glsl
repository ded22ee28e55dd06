// depth.glsl: the place where a ray has a given opacity: how far before the eye's plane, and the scalar there. Of the
// density emitter's ray optical depth alone is summed, in two floats: the sum, and in b what it was rounded by. Once the place is
// found, r is its distance, g the scalar, and the sum DEPTH_FOUND, which nothing else reaches.

//@section gathered_declare
const float DEPTH_FOUND = 1.0e30, DEPTH_DEEPEST = 1.0e20; // the latter of a part

void depth_add(inout Gathered g, float t)
{
    precise float sum = g.depth + t;
    precise float back = sum - g.depth;
    precise float rest = (g.depth - (sum - back)) + (t - back); // Knuth's two-sum
    g.rgb.b += rest;
    g.depth = sum;
}

//@section gathered_light
    depth_add(g, min(t, DEPTH_DEEPEST));

//@section piece_light
    depth_add(g, min(0.5 * part * p.front.a + 0.5 * part * back.a, DEPTH_DEEPEST));

//@section surface_light
    depth_add(g, -log(clear));

//@section exact_rest
    // Nothing is left.

//@section march_declare
uniform vec2 depth_wanted; // optical depth: a float, and what that was rounded by
uniform vec4 depth_view;   // of x at depth z on a ray: distance dot(xyz, ray.d) z + w from the eye's plane, in the mesh's unit
uniform vec2 depth_range;  // of the scalars

// A surface that comes so near to what is wanted is taken to reach it: the rounding of its logarithm, of what is wanted.
const float DEPTH_NEAR = 1.0e-6;

vec2 depth_wants = vec2(0.0), depth_from = vec2(0.0), depth_scalar = vec2(0.0);
float depth_along = 0.0, depth_start = 0.0;
vec4 depth_part = vec4(0.0); // z and scalar of its ends
bool depth_known = false;    // it has a scalar

void depth_take(vec2 z, vec2 s, bool known)
{
    depth_part = vec4(z, s);
    depth_known = known;
}

// By how much optical depth the ray has passed what is wanted.
float depth_beyond(Gathered g)
{
    precise float beyond = (g.depth - depth_wants.x) + (g.rgb.b - depth_wants.y);
    return beyond;
}

void depth_put(inout Gathered g, inout int cell, bool found, float z, float s, bool known)
{
    float value = known ? mix(depth_scalar.x, depth_scalar.y, s) : 0.0;
    g.rgb.r = found ? depth_start + depth_along * z : g.rgb.r;
    g.rgb.g = found ? value : g.rgb.g;
    g.depth = found ? DEPTH_FOUND : g.depth;
    cell = found ? MARCH_OPAQUE : cell;
}

// Behind a part: all of it is summed.
void depth_passed(inout Gathered g, inout int cell)
{
    precise float gathered = (g.depth - depth_from.x) + (g.rgb.b - depth_from.y);
    precise float wanted = (depth_wants.x - depth_from.x) + (depth_wants.y - depth_from.y);
    bool found = depth_beyond(g) >= 0.0;
    float share = found ? clamp(wanted / max(gathered, 1.0e-37), 0.0, 1.0) : 0.0;
    vec2 at = mix(depth_part.xz, depth_part.yw, share);
    depth_from = vec2(g.depth, g.rgb.b);
    depth_put(g, cell, found, at.x, at.y, depth_known);
}

// Behind a surface at depth z.
void depth_surface(inout Gathered g, inout int cell, float z, float s, bool known)
{
    bool found = g.depth < DEPTH_FOUND && depth_beyond(g) >= -DEPTH_NEAR * max(depth_wants.x, 1.0);
    depth_from = vec2(g.depth, g.rgb.b);
    depth_put(g, cell, found, z, s, known);
}

//@section march_ray
    vec4 depth_kept = keep(depth_view);
    depth_wants = keep(depth_wanted);
    depth_scalar = keep(depth_range);
    depth_along = dot(depth_kept.xyz, ray.d);
    depth_start = depth_kept.w;

//@section march_begin
    integral.sum.transmittance = 1.0; // no piece is left out
    depth_from = vec2(integral.sum.depth, integral.sum.rgb.b);

//@section march_taken
    depth_take(vec2(segment.z0, segment.z1), vec2(segment.s0, segment.s1), segment.real);

//@section part_added
    depth_take(mix(vec2(parts.whole.z0), vec2(parts.whole.z1), vec2(parts.from, parts.to)),
               vec2(mix(parts.whole.s0, parts.whole.s1, parts.from), s), parts.whole.real);

//@section march_round
            if (!open)
                depth_passed(integral.sum, w.cell);

//@section iso_added
                    depth_surface(integral.sum, w.cell, mix(parts.whole.z0, parts.whole.z1, parts.to), iso_value[surface], true);

//@section layer_added
                    depth_surface(integral.sum, w.cell, layer_z, 0.0, false);

//@section resolved_declare
const float DEPTH_FOUND = 1.0e30;
#ifdef DEPTH_LAYERS
#include "ray.glsl"
uniform vec2 depth_wanted;
uniform vec4 depth_view;
const float DEPTH_NEAR = 1.0e-6;
float depth_sum = 0.0; // less what is wanted

// A layer that the ray meets behind the mesh, or without having met it.
vec4 depth_behind(vec4 color, float opacity, float z)
{
    depth_sum -= log(max(1.0 - opacity, 1.0e-30));
    bool found = color.a == 0.0 && depth_sum >= -DEPTH_NEAR * max(depth_wanted.x, 1.0);
    float along = dot(depth_view.xyz, ray_of_pixel(gl_FragCoord.xy).d);
    return found ? vec4(depth_view.w + along * z, 0.0, 0.0, 1.0) : color;
}
#endif

//@section resolved
#ifdef DEPTH_LAYERS
    depth_sum = (color.a - depth_wanted.x) + (color.b - depth_wanted.y);
#endif
    return color.a >= DEPTH_FOUND ? vec4(color.rg, 0.0, 1.0) : vec4(0.0);

//@section layer_behind
        color = depth_behind(color, layer.a, intBitsToFloat(texelFetch(layer_nodes, 2 * node + 1).x));
