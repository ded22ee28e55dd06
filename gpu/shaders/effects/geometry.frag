// geometry.frag: where the ray of this pixel meets a triangle, or comes by a line, and in what colour. Depths are those of the
// walk: along the ray from its origin, in half diagonals. OPAQUE: the nearest is kept by the depth test. Otherwise all that
// lie before the nearest opaque one are kept in lists, one a pixel, which geometry_order.frag puts in order.
#include "ray.glsl"
#include "signs.glsl"
#include "fetch.glsl" //@then march_declare

flat in int item;
uniform vec4 geometry_color; // r, g, b, opacity
uniform samplerBuffer geometry_vertices;

#ifdef OPAQUE
layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_z;

// As first_hit.frag's: depths as integers that sort as they do.
int depth_key(float z)
{
    const uint least = 76u << 23, most = 139u << 23;
    int m = int(clamp(floatBitsToUint(abs(z)), least, most - 1u) - least);
    return (64 << 23) + (z < 0.0 ? -1 - m : m);
}
#else
layout(std430, binding = 0) restrict buffer Used {
    uint nodes_used;
};
layout(r32ui, binding = 0) restrict uniform uimage2D layer_heads;
layout(rgba32i, binding = 1) writeonly restrict uniform iimageBuffer layer_nodes;
uniform int node_first, node_end;
uniform int item_first; // number of item 0 among all of the look
#ifdef BEFORE_OPAQUE
uniform sampler2D opaque_z;
#endif
#endif

#ifdef LINES
uniform float line_width;
flat in vec4 line_ends; // in pixels of the whole picture
flat in vec3 line_from, line_to;
flat in vec2 line_w;

// False: the pixel is farther from the line than half its width. Depth is that of the nearest point on the screen, a line's
// width nearer to the eye, so that a line that is drawn on a surface is seen whole.
bool meets(out float z, Ray ray)
{
    vec2 pixel = gl_FragCoord.xy + ray_part;
    vec2 along = line_ends.zw - line_ends.xy, to = pixel - line_ends.xy;
    float t = clamp(dot(to, along) / max(dot(along, along), 1.0e-30), 0.0, 1.0);
    vec2 off = to - t * along;
    vec3 x = mix(line_from, line_to, t * line_w.x / mix(line_w.y, line_w.x, t)); // t is linear on the screen
    z = dot(x - ray.o, ray.d);
    vec3 d = vec3(ray_direction + double(pixel.x) * ray_direction_dx + double(pixel.y) * ray_direction_dy);
    z -= line_width * length(vec3(ray_point_dx) + z / length(d) * vec3(ray_direction_dx));
    return dot(off, off) <= 0.25 * line_width * line_width;
}
#else
uniform isamplerBuffer geometry_triangles;
uniform samplerBuffer geometry_planes;

// By exact signs, as the walk's (stepper.glsl): of triangles that share an edge one is met.
bool meets(out float z, Ray ray)
{
    ivec3 id = texelFetch(geometry_triangles, item).xyz;
    vec3 a = ray_project(ray, texelFetch(geometry_vertices, id.x).xyz);
    vec3 b = ray_project(ray, texelFetch(geometry_vertices, id.y).xyz);
    vec3 c = ray_project(ray, texelFetch(geometry_vertices, id.z).xyz);
    vec3 weight = vec3(sign_cross(b.xy, c.xy, id.y, id.z), sign_cross(c.xy, a.xy, id.z, id.x),
                       sign_cross(a.xy, b.xy, id.x, id.y));
    weight = weight.x < 0.0 ? -weight : weight;
    z = dot(weight, vec3(a.z, b.z, c.z)) / (weight.x + weight.y + weight.z);
    return weight.y > 0.0 && weight.z > 0.0;
}
#endif

void main()
{
    Ray ray = ray_of_pixel(gl_FragCoord.xy);
    float z;
    if (!meets(z, ray) || !(z >= ray.near && z <= ray.far))
        discard;
    vec3 color = geometry_color.rgb;
#ifdef LIGHTS
    vec3 normal = texelFetch(geometry_planes, item).xyz;
    if (normal != vec3(0.0)) {
        light_begin(ray);
        Light light = light_of(normal, ray, false);
        color = color * light.gain + light.glow;
    }
#endif
#ifdef OPAQUE
    out_color = vec4(color, 1.0);
    out_z = z;
    gl_FragDepth = intBitsToFloat(depth_key(z)); // the bits of a positive float sort as it does
#else
    ivec2 pixel = ivec2(gl_FragCoord.xy);
#ifdef BEFORE_OPAQUE
    if (z > texelFetch(opaque_z, pixel, 0).x)
        discard;
#endif
    int node = node_first + int(min(atomicAdd(nodes_used, 1u), uint(node_end)));
    if (node < node_end) { // else the list is made again with more room
        int next = int(imageAtomicExchange(layer_heads, pixel, uint(node)));
        imageStore(layer_nodes, 2 * node, floatBitsToInt(vec4(color, geometry_color.a)));
        imageStore(layer_nodes, 2 * node + 1, ivec4(floatBitsToInt(z), next, item_first + item, 0));
    }
#endif
}
