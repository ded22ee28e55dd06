// ray.glsl: the ray of a pixel and its frame (design: "Ray frame").
// Lengths are in half diagonals of the bounding box, whose centre is the origin.

#ifdef RAYS_FLAT // screen.vert hands them on
flat in uvec4 ray_flat[9];
flat in vec3 ray_flat_up;
flat in vec2 ray_flat_part;
dvec3 ray_flat_vector(int i)
{
    uvec4 a = ray_flat[3 * i / 2], b = ray_flat[3 * i / 2 + 1];
    return i % 2 == 0 ? dvec3(packDouble2x32(a.xy), packDouble2x32(a.zw), packDouble2x32(b.xy))
                      : dvec3(packDouble2x32(a.zw), packDouble2x32(b.xy), packDouble2x32(b.zw));
}
#define ray_point ray_flat_vector(0)
#define ray_point_dx ray_flat_vector(1)
#define ray_point_dy ray_flat_vector(2)
#define ray_direction ray_flat_vector(3)
#define ray_direction_dx ray_flat_vector(4)
#define ray_direction_dy ray_flat_vector(5)
#define ray_up ray_flat_up
#define ray_part ray_flat_part
#else
#include "ray_uniforms.glsl"
#endif
#if defined(CLIP_NEAR) || defined(ENTRY_AHEAD)
uniform float ray_near; // nothing is seen before the origin and this many (unnormalised) directions
#endif
#ifdef CLIP_FAR
uniform float ray_far; // … nor beyond the origin and this many
#endif

struct Ray {
    vec3 o;       // origin of the frame: the point in the plane through the mesh's centre, or the eye when it is near
#if defined(CLIP_NEAR) || defined(ENTRY_AHEAD)
    float near;   // depth of the near plane, or of the eye
#endif
#ifdef CLIP_FAR
    float far;    // depth of the far plane
#endif
    vec3 u, v, d; // orthonormal; d is the direction; cross(u, v) = -d, so that faces seen from outside run counter-clockwise
};

Ray ray_of_pixel(vec2 pixel)
{
    double x = double(pixel.x + ray_part.x), y = double(pixel.y + ray_part.y);
    Ray ray;
    precise vec3 o = vec3(ray_point + x * ray_point_dx + y * ray_point_dy);
    precise vec3 d = vec3(ray_direction + x * ray_direction_dx + y * ray_direction_dy);
    precise float length_d = sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    d /= length_d;
    precise vec3 u = vec3(d.y * ray_up.z - d.z * ray_up.y, d.z * ray_up.x - d.x * ray_up.z, d.x * ray_up.y - d.y * ray_up.x);
    precise float length_u = sqrt(u.x * u.x + u.y * u.y + u.z * u.z);
    u /= length_u;
    precise vec3 v = vec3(u.y * d.z - u.z * d.y, u.z * d.x - u.x * d.z, u.x * d.y - u.y * d.x);
    ray.o = o;
#if defined(CLIP_NEAR) || defined(ENTRY_AHEAD)
    ray.near = ray_near * length_d;
#endif
#ifdef CLIP_FAR
    ray.far = ray_far * length_d;
#endif
    ray.u = u;
    ray.v = v;
    ray.d = d;
    return ray;
}

// A vertex as the ray sees it: x, y across the ray, z along it. The same bits in every program: every cell around a
// vertex must see the same numbers.
vec3 ray_project(Ray ray, vec3 x)
{
    precise vec3 r = x - ray.o;
    precise vec3 p;
    p.x = r.x * ray.u.x + r.y * ray.u.y + r.z * ray.u.z;
    p.y = r.x * ray.v.x + r.y * ray.v.y + r.z * ray.v.z;
    p.z = r.x * ray.d.x + r.y * ray.d.y + r.z * ray.d.z;
    return p;
}
