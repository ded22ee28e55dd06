// resolve.frag: the accumulated state as premultiplied colour; with SHARE, one of several rays of a pixel, which blending
// adds up.
#include "resolved.glsl"
#ifdef SHARE
uniform float share; // of a ray in its pixel
#endif
layout(location = 0) out vec4 out_rgba;
void main()
{
    out_rgba = resolved(ivec2(gl_FragCoord.xy)); //@then resolve_behind
#ifdef SHARE
    out_rgba *= share;
#endif
}
