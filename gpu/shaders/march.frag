// march.frag: one pass of the ping-pong driver: K cell steps of every ray that is not finished.
// Weiler et al. 2003, 3.4 and 5.1 (K = 1 is the paper's loop). Reads one set of state textures, writes the other.

#include "march.glsl"

uniform isampler2D state_walk; // cell, a, b, c
uniform sampler2D state_color; // the integrator's accumulated colour and transmittance
uniform isampler2D state_at;   // state.h
#ifdef COUNT
uniform usampler2D state_steps;
layout(location = 3) out uint out_steps;
#endif
#ifdef AUDIT
uniform usampler2D state_audit;
layout(location = 4) out uvec4 out_audit;
#endif
layout(location = 0) out ivec4 out_walk;
layout(location = 1) out vec4 out_color;
layout(location = 2) out ivec4 out_at;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec4 walk = texelFetch(state_walk, pixel, 0);
    vec4 color = texelFetch(state_color, pixel, 0);
    ivec4 at = texelFetch(state_at, pixel, 0);
#ifdef COUNT
    uint steps = texelFetch(state_steps, pixel, 0).x;
#endif
#ifdef AUDIT
    audit_begin(texelFetch(state_audit, pixel, 0));
#endif
    if (walk.x >= 0) {
        int k = march(walk, color, at, gl_FragCoord.xy);
#ifdef COUNT
        steps += uint(k);
#endif
    }
    out_walk = walk;
    out_color = color;
    out_at = at;
#ifdef COUNT
    out_steps = steps;
#endif
#ifdef AUDIT
    out_audit = audit_end();
#endif
}
