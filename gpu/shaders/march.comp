// march.comp: the compute driver: an invocation walks the ray of its pixel on from its state, all of it in registers, until
// the ray ends or has made steps_per_pass steps. Weiler et al. 2003, 3.4, without its passes.

#include "march.glsl"

// A group is 8 x 8 pixels in Morton order (G. M. Morton 1966): however many run in step, they are neighbours, 4 x 2 of
// llvmpipe's 8, 8 x 4 of a GPU's 32.
layout(local_size_x = 64) in;
const int TILE = 8;

uniform ivec4 rect; // x, y, width, height of the pixels that may have a ray

uniform isampler2D state_walk; // cell, a, b, c
uniform sampler2D state_color; // what the ray gathered so far
uniform isampler2D state_at;   // state.h
writeonly restrict uniform iimage2D out_walk;
writeonly restrict uniform image2D out_color;
writeonly restrict uniform iimage2D out_at;
#ifdef COUNT
uniform usampler2D state_steps;
writeonly restrict uniform uimage2D out_steps;
#endif
#ifdef AUDIT
uniform usampler2D state_audit;
writeonly restrict uniform uimage2D out_audit;
#endif
// Rays that this dispatch walked; of them, those not finished, and those that the stepper gave up.
layout(binding = 0, offset = 0) uniform atomic_uint rays_walked;
layout(binding = 0, offset = 4) uniform atomic_uint rays_open;
layout(binding = 0, offset = 8) uniform atomic_uint rays_given_up;
const int GIVEN_UP = -3; // WALK_LOST of stepper_planes.glsl

ivec2 place_in_tile(int i) // the even bits, and the odd ones
{
    return ivec2((i & 1) | ((i >> 1) & 2) | ((i >> 2) & 4), ((i >> 1) & 1) | ((i >> 2) & 2) | ((i >> 3) & 4));
}

void main()
{
    ivec2 place = TILE * ivec2(gl_WorkGroupID.xy) + place_in_tile(int(gl_LocalInvocationIndex));
    ivec2 pixel = rect.xy + place;
    bool inside = place.x < rect.z && place.y < rect.w;
    ivec4 walk = inside ? texelFetch(state_walk, pixel, 0) : ivec4(-1);
    if (walk.x >= 0) {
        vec4 color = texelFetch(state_color, pixel, 0);
        ivec4 at = texelFetch(state_at, pixel, 0);
#ifdef AUDIT
        audit_begin(texelFetch(state_audit, pixel, 0));
#endif
        int k = march(walk, color, at, vec2(pixel) + 0.5);
#ifdef COUNT
        imageStore(out_steps, pixel, uvec4(texelFetch(state_steps, pixel, 0).x + uint(k)));
#endif
#ifdef AUDIT
        imageStore(out_audit, pixel, audit_end());
#endif
        imageStore(out_color, pixel, color);
        imageStore(out_walk, pixel, walk); //@then march_store
        atomicCounterIncrement(rays_walked);
        if (walk.x >= 0) {
            imageStore(out_at, pixel, at);
            atomicCounterIncrement(rays_open);
        }
        if (walk.x == GIVEN_UP)
            atomicCounterIncrement(rays_given_up);
    }
}
