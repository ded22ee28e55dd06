// clip.glsl: the part of a ray within planes: found once a ray, since planes cut it but once. Cells are cut where it begins
// and ends, by what march.glsl has for the near and the far plane.

//@section march_declare
uniform vec4 clip_plane[CLIP_PLANES]; // kept: normal . x >= w, in mesh space

void clip_ray(inout Ray ray)
{
    for (int i = 0; i < CLIP_PLANES; i++) {
        vec3 normal = clip_plane[i].xyz;
        float slope = dot(normal, ray.d), short_by = clip_plane[i].w - dot(normal, ray.o);
        float at = short_by / (slope == 0.0 ? 1.0 : slope);
        ray.near = slope > 0.0 ? max(ray.near, at) : ray.near;
        ray.far = slope < 0.0 ? min(ray.far, at) : slope == 0.0 && short_by > 0.0 ? ray.near : ray.far;
    }
    ray.far = max(ray.far, ray.near); // nothing
}

//@section march_ray
    clip_ray(ray);
