// screen.vert: one triangle over the whole screen, at the depth of rays that are not locked.
// RAYS_FLAT: it hands on what all rays have in common, for where llvmpipe reads a uniform it gathers it lane by lane.
#ifdef RAYS_FLAT
#include "ray_uniforms.glsl"
flat out uvec4 ray_flat[9]; // six vectors of three doubles
flat out vec3 ray_flat_up;
flat out vec2 ray_flat_part;
#endif

void main()
{
#ifdef RAYS_FLAT
    double number[18] = double[](ray_point.x, ray_point.y, ray_point.z,                               //
                                 ray_point_dx.x, ray_point_dx.y, ray_point_dx.z,                      //
                                 ray_point_dy.x, ray_point_dy.y, ray_point_dy.z,                      //
                                 ray_direction.x, ray_direction.y, ray_direction.z,                   //
                                 ray_direction_dx.x, ray_direction_dx.y, ray_direction_dx.z,          //
                                 ray_direction_dy.x, ray_direction_dy.y, ray_direction_dy.z);
    for (int i = 0; i < 9; i++)
        ray_flat[i] = uvec4(unpackDouble2x32(number[2 * i]), unpackDouble2x32(number[2 * i + 1]));
    ray_flat_up = ray_up;
    ray_flat_part = ray_part;
#endif
    vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(p, 0.0, 1.0);
}
