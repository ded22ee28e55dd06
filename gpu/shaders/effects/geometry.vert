// geometry.vert: corners of a look's triangles, or, with LINES, of polygons that hold every pixel of a line. Only what lies
// behind the eye is clipped by GL: depth is the fragment's own.
uniform samplerBuffer geometry_vertices;
uniform vec4 geometry_clip[4]; // columns: mesh space → clip space
uniform vec2 picture_size;     // pixels

vec4 to_clip(vec3 x)
{
    vec4 p = geometry_clip[0] * x.x + geometry_clip[1] * x.y + geometry_clip[2] * x.z + geometry_clip[3];
    return vec4(p.xy, 0.0, p.w);
}

flat out int item;
#ifdef LINES
uniform isamplerBuffer geometry_lines;
uniform float line_width; // pixels
uniform vec4 whole_clip[4]; // of the whole picture: what a line is must not depend on its parts
uniform vec2 whole_size;    // pixels
uniform vec2 ray_part;      // the part's left lower pixel in it
flat out vec4 line_ends;    // in pixels of the whole picture
flat out vec3 line_from, line_to; // the same ends in mesh space
flat out vec2 line_w;             // and their distances along the view
const float LINE_NEAREST = 1.0e-6; // of the farther end's distance: nearer to the eye is not drawn
const float LINE_MORE = 0.5;       // pixels: the fragment decides which belong to the line

vec4 to_whole_clip(vec3 x)
{
    vec4 p = whole_clip[0] * x.x + whole_clip[1] * x.y + whole_clip[2] * x.z + whole_clip[3];
    return vec4(p.xy, 0.0, p.w);
}

// The part t.x … t.y of a line on which a plane's function, f.x at one end and f.y at the other, is not below 0.
vec2 line_cut(vec2 t, vec2 f)
{
    float at = f.x / (f.x - f.y == 0.0 ? 1.0 : f.x - f.y);
    return f.x < 0.0 && f.y < 0.0 ? vec2(1.0, 0.0) : vec2(f.x < 0.0 ? max(t.x, at) : t.x, f.y < 0.0 ? min(t.y, at) : t.y);
}

void main()
{
    item = gl_VertexID / 6;
    int corner = gl_VertexID % 6;
    ivec2 id = texelFetch(geometry_lines, item).xy;
    vec3 from = texelFetch(geometry_vertices, id.x).xyz, to = texelFetch(geometry_vertices, id.y).xyz;
    vec4 a = to_whole_clip(from), b = to_whole_clip(to);
    // Cut to the picture and a margin: places far outside of it would be coarse.
    vec2 margin = 1.0 + 2.0 * (line_width + 2.0) / whole_size;
    vec2 t = line_cut(vec2(0.0, 1.0), vec2(a.w, b.w) - LINE_NEAREST * max(a.w, b.w));
    for (int k = 0; k < 2; k++) {
        t = line_cut(t, vec2(a.w, b.w) * margin[k] - vec2(a[k], b[k]));
        t = line_cut(t, vec2(a.w, b.w) * margin[k] + vec2(a[k], b[k]));
    }
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0); // nowhere
    if (t.x > t.y || max(a.w, b.w) <= 0.0)
        return;
    line_from = mix(from, to, t.x);
    line_to = mix(from, to, t.y);
    vec4 p = mix(a, b, t.x), q = mix(a, b, t.y);
    line_w = vec2(p.w, q.w);
    vec2 p_at = (p.xy / p.w * 0.5 + 0.5) * whole_size, q_at = (q.xy / q.w * 0.5 + 0.5) * whole_size;
    line_ends = vec4(p_at, q_at);
    float reach = 0.5 * line_width + LINE_MORE, l = length(q_at - p_at);
    vec2 along = l > 1.0e-6 ? (q_at - p_at) / l : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    bool first = corner == 0 || corner == 1 || corner == 4, left = corner == 0 || corner == 2 || corner == 3;
    vec2 at = (first ? p_at - along * reach : q_at + along * reach) + across * (left ? reach : -reach);
    gl_Position = vec4((at - ray_part) / picture_size * 2.0 - 1.0, 0.0, 1.0);
}
#else
uniform isamplerBuffer geometry_triangles;
const float MORE = 1.0 / 64.0; // pixels: GL rounds corners to 1/256 of one, the fragment decides exactly
const float MITRE = 12.0;      // at most that many times as far at a corner: sharper ones are GL's own
const float MORE_NEAREST = 1.0e-4; // of the farthest corner's distance: nearer to the eye GL cuts it

// How far a corner p is to be moved so that the edges to a and b move outwards by MORE.
vec2 outwards(vec2 p, vec2 a, vec2 b)
{
    float la = length(a - p), lb = length(b - p);
    if (!(la > 1.0e-4 && lb > 1.0e-4 && la < 1.0e6 && lb < 1.0e6))
        return vec2(0.0);
    vec2 u = (p - a) / la, v = (p - b) / lb;
    float sine = abs(u.x * v.y - u.y * v.x);
    return (u + v) * MORE / max(sine, 2.0 / MITRE); // (u + v) / sine meets both edges, a unit outside
}

void main()
{
    item = gl_VertexID / 3;
    ivec3 id = texelFetch(geometry_triangles, item).xyz;
    int k = gl_VertexID % 3;
    vec4 p = to_clip(texelFetch(geometry_vertices, id[k]).xyz);
    vec4 a = to_clip(texelFetch(geometry_vertices, id[(k + 1) % 3]).xyz);
    vec4 b = to_clip(texelFetch(geometry_vertices, id[(k + 2) % 3]).xyz);
    gl_Position = p;
    if (min(p.w, min(a.w, b.w)) > MORE_NEAREST * max(p.w, max(a.w, b.w))) {
        vec2 half_size = 0.5 * picture_size;
        vec2 more = outwards(p.xy / p.w * half_size, a.xy / a.w * half_size, b.xy / b.w * half_size);
        gl_Position.xy += more / half_size * p.w;
    }
}
#endif
