// first_hit.frag: does the ray of this pixel enter the mesh at this face? (design: "First hit", "Gaps")
// With PEEL: the entry with the smallest (depth, face id) above that of the ray's previous entry.

#include "stepper.glsl"
#include "state.glsl"

flat in int face_id;
uniform isamplerBuffer faces; // a, b, c counter-clockwise from outside, and the cell behind

#ifdef PEEL
uniform isampler2D peel_key;   // bits of the depth, and 1 + the face id, of the previous entry
uniform sampler2D state_color; // to leave out rays that ended by opacity
uniform float transmittance_stop;
layout(location = 2) out ivec2 out_key;
#endif
layout(location = 0) out ivec4 out_walk;
layout(location = 1) out vec2 out_at;

void main()
{
    Ray ray = ray_of_pixel(gl_FragCoord.xy);
    ivec4 face = texelFetch(faces, face_id);
    Walk w;
    int facing;
    if (!walk_face(w, ray, face.w, face.xyz, facing) || facing < 0)
        discard;
    if (w.z < ray.eye)
        discard; // the signs hold for the whole line, the picture is what lies before the eye
    float key = 0.5 + 0.5 * w.z / (1.0 + abs(w.z));
#ifdef PEEL
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 mine = ivec2(floatBitsToInt(key), face_id + 1); // the bits of a positive float sort as it does
    ivec2 before = texelFetch(peel_key, pixel, 0).xy;
    if (mine.x < before.x || (mine.x == before.x && mine.y <= before.y))
        discard;
    if (before.y > 0 && state_transmittance(texelFetch(state_color, pixel, 0)) <= transmittance_stop)
        discard;
    out_key = mine;
#endif
    gl_FragDepth = key;
    out_walk = ivec4(w.cell, w.id);
    out_at = vec2(w.z, w.s);
}
