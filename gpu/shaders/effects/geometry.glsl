// geometry.glsl: layers of geometry (gpu/layers.h), in order with the volume: a segment is cut where the next one lies, and what
// the ray did not reach in the mesh is composited behind it. A ray keeps its next layer from pass to pass, and from one entry
// to the next, in its state: n + 1 for node n, 0 before the first was looked for, in `at.w` while it walks, else in `at.x`.

//@section parts_declare
uniform usampler2D layer_heads;
uniform isamplerBuffer layer_nodes;
const float LAYER_NONE = 3.0e38; // beyond all depths
int layer_node = 0, layer_behind = 0; // the next one (0: none), and that behind it
float layer_z = LAYER_NONE;
vec4 layer_color = vec4(0.0);

void layer_take(int node)
{
    ivec4 color = texelFetch(layer_nodes, 2 * node), place = texelFetch(layer_nodes, 2 * node + 1);
    layer_node = node;
    layer_behind = place.y;
    layer_z = node == 0 ? LAYER_NONE : intBitsToFloat(place.x);
    layer_color = intBitsToFloat(color);
}

//@section march_ray
    int layer_kept = at.w != 0 ? at.w : at.x;
    layer_take(layer_kept > 0 ? layer_kept - 1 : int(texelFetch(layer_heads, ivec2(pixel), 0).x));

//@section part_cut
    float layer_share = (layer_z - parts.whole.z0) / (parts.whole.z1 - parts.whole.z0);
    if (layer_z < parts.whole.z1 && layer_share <= to) { // also those that were passed outside of the mesh
        to = clamp(layer_share, 0.0, 1.0);
        end = PART_LAYER;
    }

//@section part_done
                if (parts.end == PART_LAYER) {
                    gathered_surface(integral.sum, layer_color.rgb, layer_color.a); //@then layer_added
                    layer_take(layer_behind);
                }

//@section march_at
    at = w.cell >= 0 ? ivec4(at.xyz, layer_node + 1) : ivec4(layer_node + 1, 0, -1, 0);

//@section march_store
        if (walk.x < 0)
            imageStore(out_at, pixel, at);

//@section resolved_declare
uniform usampler2D layer_heads;
uniform isamplerBuffer layer_nodes;
uniform isampler2D layer_at;

vec4 layers_behind(vec4 color, ivec2 pixel)
{
    ivec4 at = texelFetch(layer_at, pixel, 0);
    int kept = at.w != 0 ? at.w : at.x;
    int node = kept > 0 ? kept - 1 : int(texelFetch(layer_heads, pixel, 0).x);
    while (node != 0) {
        vec4 layer = intBitsToFloat(texelFetch(layer_nodes, 2 * node));
        float left = (1.0 - color.a) * layer.a; //@or layer_behind
        color += left * vec4(layer.rgb, 1.0); //@or layer_behind
        node = texelFetch(layer_nodes, 2 * node + 1).y;
    }
    return color;
}

//@section resolve_behind
    out_rgba = layers_behind(out_rgba, ivec2(gl_FragCoord.xy));

//@section spread_behind
    color = layers_behind(color, ivec2(gl_FragCoord.xy));
