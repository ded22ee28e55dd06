// projection.glsl: a ray gathered x / y, where y is above 0: a packed scalar. The picture is the function's colour there.

//@section resolved_declare
#include "pieces.glsl"

vec4 projected(vec2 gathered)
{
    pieces_begin();
    bool met = gathered.y > 0.0;
    Place at = place_at(met ? gathered.x / gathered.y : 0.0);
    return met ? vec4(max(at.front.rgb, vec3(0.0)), 1.0) : vec4(0.0);
}

//@section resolved
    return projected(color.xy);
