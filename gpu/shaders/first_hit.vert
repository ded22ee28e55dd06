// first_hit.vert: a boundary face, enlarged by a pixel: the triangle and a quad about each edge (21 vertices a face).
// What is enlarged only proposes; first_hit.frag decides by exact signs.
uniform isamplerBuffer faces;        // a, b, c counter-clockwise from outside, and the cell behind
uniform samplerBuffer mesh_vertices;
uniform mat4 clip;                   // mesh space → clip space
uniform vec2 viewport;               // pixels
flat out ivec4 face;
flat out int face_id;

vec2 to_pixel(vec4 p) { return (p.xy / p.w * 0.5 + 0.5) * viewport; }
vec4 from_pixel(vec2 p) { return vec4(p / viewport * 2.0 - 1.0, 0.0, 1.0); }

void main()
{
    const vec4 nowhere = vec4(2.0, 2.0, 2.0, 1.0);
    face_id = gl_VertexID / 21;
    int corner = gl_VertexID - face_id * 21;
    face = texelFetch(faces, face_id);
    vec4 p0 = clip * vec4(texelFetch(mesh_vertices, face.x).xyz, 1.0);
    vec4 p1 = clip * vec4(texelFetch(mesh_vertices, face.y).xyz, 1.0);
    vec4 p2 = clip * vec4(texelFetch(mesh_vertices, face.z).xyz, 1.0);
    float nearest = min(p0.w, min(p1.w, p2.w)), farthest = max(p0.w, max(p1.w, p2.w));
    const float w_min = 1.0e-4;
    if (nearest < w_min) {
#ifdef EYE_CLIP
        // Behind the eye the ray's line goes on: a face there is seen through the eye. A face that crosses the eye's
        // plane may be anywhere: every pixel is asked.
        if (farthest > -w_min) {
            gl_Position = corner < 3 ? vec4(corner == 1 ? 3.0 : -1.0, corner == 2 ? 3.0 : -1.0, 0.0, 1.0) : nowhere;
            return;
        }
#else
        if (farthest < w_min) {
            gl_Position = nowhere;
            return;
        }
        gl_Position = corner < 3 ? vec4(corner == 1 ? 3.0 : -1.0, corner == 2 ? 3.0 : -1.0, 0.0, 1.0) : nowhere;
        return;
#endif
    }
    vec2 a = to_pixel(p0), b = to_pixel(p1), c = to_pixel(p2);
    // Faces that clearly look away cannot be entries.
    vec2 e = b - a, f = c - a;
    float area = e.x * f.y - e.y * f.x;
    float extent = max(max(abs(e.x), abs(e.y)), max(abs(f.x), abs(f.y)));
    if (area < -(1.0 + 0.02 * extent) && farthest > 0.0) {
        gl_Position = nowhere;
        return;
    }
    if (corner < 3) {
        gl_Position = from_pixel(corner == 0 ? a : corner == 1 ? b : c);
        return;
    }
    int edge = (corner - 3) / 6, k = (corner - 3) - edge * 6;
    vec2 from = edge == 0 ? a : edge == 1 ? b : c;
    vec2 to = edge == 0 ? b : edge == 1 ? c : a;
    vec2 along = to - from;
    float l = length(along);
    along = l > 0.0 ? along / l : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    bool far_end = k == 1 || k == 2 || k == 4, left = k == 2 || k == 4 || k == 5;
    vec2 at = far_end ? to + along : from - along;
    gl_Position = from_pixel(at + (left ? across : -across));
}
