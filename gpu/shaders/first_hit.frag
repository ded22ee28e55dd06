// first_hit.frag: does the ray of this pixel enter the mesh at this face? (design: "First hit", "Gaps")
// With PEEL: the entry with the smallest (depth, face id) above that of the ray's previous entry.

#include "stepper.glsl"
#include "state.glsl"

flat in int face_id;
uniform isamplerBuffer faces; // a, b, c counter-clockwise from outside, and the cell behind

#ifdef PEEL
uniform isampler2D peel_key;   // depth_key, and 1 + the face id, of the previous entry
uniform sampler2D state_color; // to leave out rays that ended by opacity
uniform float transmittance_stop;
layout(location = 1) out ivec2 out_key;
#endif
#ifndef PEEL
// All that survive, whether the first or not. Counters far enough apart that cores that work on other parts of the picture
// do not wait for one another.
const int COUNTERS = 16, COUNTER_APART = 16;
layout(std430, binding = 0) restrict buffer Entries {
    uint entries[COUNTERS * COUNTER_APART];
};
#endif
#ifdef SAMPLE_MASK
uniform usampler2D sample_mask; // 1 where a pixel has a ray
#endif
layout(location = 0) out ivec4 out_walk;

// Depths as integers that sort as they do, each its own from 2^-51 to 2^12 half diagonals on both sides of 0 (nearer to 0
// all are one): as many as fit between the smallest normal float and 1, so that the depth buffer holds them too.
int depth_key(float z)
{
    const uint least = 76u << 23, most = 139u << 23; // the bits of 2^-51 and 2^12
    int m = int(clamp(floatBitsToUint(abs(z)), least, most - 1u) - least);
    return (64 << 23) + (z < 0.0 ? -1 - m : m);
}

void main()
{
#ifdef SAMPLE_MASK
    if (texelFetch(sample_mask, ivec2(gl_FragCoord.xy), 0).x != 1u)
        discard;
#endif
    Ray ray = ray_of_pixel(gl_FragCoord.xy);
    ivec4 face = texelFetch(faces, face_id);
    Walk w;
    int facing;
    if (!walk_face(w, ray, face.w, face.xyz, facing) || facing < 0)
        discard;
#ifdef ENTRY_AHEAD
    if (w.z < ray.near)
        discard; // the signs hold for the whole line, the picture is what lies before the eye
#endif
#ifdef CLIP_FAR
    if (w.z >= ray.far)
        discard; // nothing behind it is seen
#endif
    int key = depth_key(w.z);
#ifdef PEEL
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 mine = ivec2(key, face_id + 1);
    ivec2 before = texelFetch(peel_key, pixel, 0).xy;
    if (mine.x < before.x || (mine.x == before.x && mine.y <= before.y))
        discard;
    if (before.y > 0 && state_transmittance(texelFetch(state_color, pixel, 0)) <= transmittance_stop)
        discard;
    out_key = mine;
#endif
#ifndef PEEL
    ivec2 part = ivec2(gl_FragCoord.xy) >> 6;
    atomicAdd(entries[((part.x + 5 * part.y) & (COUNTERS - 1)) * COUNTER_APART], 1u);
#endif
    gl_FragDepth = intBitsToFloat(key); // the bits of a positive float sort as it does
    out_walk = ivec4(w.cell, w.id);
}
