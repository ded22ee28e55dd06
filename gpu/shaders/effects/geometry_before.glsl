// geometry_before.glsl: all layers of geometry (gpu/layers.h) over the colour that a model makes of the whole ray.

//@section resolved_declare
uniform usampler2D layer_heads;
uniform isamplerBuffer layer_nodes;

vec4 layers_before(vec4 color, ivec2 pixel)
{
    vec4 sum = vec4(0.0);
    for (int node = int(texelFetch(layer_heads, pixel, 0).x); node != 0; node = texelFetch(layer_nodes, 2 * node + 1).y) {
        vec4 layer = intBitsToFloat(texelFetch(layer_nodes, 2 * node));
        sum += (1.0 - sum.a) * layer.a * vec4(layer.rgb, 1.0);
    }
    return sum + (1.0 - sum.a) * color;
}

//@section resolve_behind
    out_rgba = layers_before(out_rgba, ivec2(gl_FragCoord.xy));

//@section spread_behind
    color = layers_before(color, ivec2(gl_FragCoord.xy));
