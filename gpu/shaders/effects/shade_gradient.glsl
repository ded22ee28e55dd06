// shade_gradient.glsl: the scalar's gradient at both ends of the ray's part in a cell: the cell's own, or that of vertices,
// linear in the cell. Then the gradients at the three vertices of the walk's face go with the ray, as their places do: a step
// fetches that of the fourth vertex.

//@section parts_declare
FETCH_BUFFER(5) gradients; // of cells or vertices: x, y, z, length
#ifdef GRADIENT_VERTEX
vec3 gradient_a = vec3(0.0), gradient_b = vec3(0.0), gradient_c = vec3(0.0);
vec3 gradient_from = vec3(0.0), gradient_to = vec3(0.0); // at the ends of the part
vec3 gradient_face = vec3(0.0);                          // where the ray meets the walk's face

vec3 gradient_at_face(Walk w)
{
    vec3 sum = w.weight.x * gradient_a + w.weight.y * gradient_b + w.weight.z * gradient_c;
    return sum * (1.0 / (w.weight.x + w.weight.y + w.weight.z));
}
#else
vec4 gradient_cell = vec4(0.0);
#endif

//@section march_begin
#ifdef GRADIENT_VERTEX
    gradient_a = fetch(gradients, w.id.x).xyz;
    gradient_b = fetch(gradients, w.id.y).xyz;
    gradient_c = fetch(gradients, w.id.z).xyz;
    gradient_face = gradient_at_face(w);
#endif

//@section march_before
#ifdef GRADIENT_VERTEX
    int gradient_new = w.ahead;
#endif

//@section march_segment
#ifdef GRADIENT_VERTEX
    vec3 gradient_d = fetch(gradients, gradient_new).xyz;
    gradient_a = w.id.x == gradient_new ? gradient_d : gradient_a;
    gradient_b = w.id.y == gradient_new ? gradient_d : gradient_b;
    gradient_c = w.id.z == gradient_new ? gradient_d : gradient_c;
    gradient_from = gradient_face;
    gradient_face = gradient_at_face(w);
    gradient_to = gradient_face;
    float gradient_z0 = segment.z0, gradient_z1 = segment.z1;
#else
    gradient_cell = fetch(gradients, segment.real ? segment.cell : 0);
#endif

//@section part_begin
#ifdef GRADIENT_VERTEX
#if defined(CLIP_NEAR) || defined(CLIP_FAR)
    // Planes cut the part: its ends lie within the cell.
    float gradient_share = 1.0 / max(gradient_z1 - gradient_z0, 1.0e-30);
    vec3 gradient_step = gradient_to - gradient_from;
#ifdef CLIP_FAR
    gradient_to = mix(gradient_from, gradient_to, clamp((segment.z1 - gradient_z0) * gradient_share, 0.0, 1.0));
#endif
#ifdef CLIP_NEAR
    gradient_from += gradient_step * clamp((segment.z0 - gradient_z0) * gradient_share, 0.0, 1.0);
#endif
#endif
#endif
