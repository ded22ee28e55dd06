// color_field.glsl: colour by another field than the one that absorbs. Segments are cut where the second field has a knot of
// its function, so that within a part its colour is linear along the ray; pieces.glsl cuts parts at the knots of the first.

//@section pieces_declare
// Colours at the ends of the part that is being added, and its length.
vec3 color_from = vec3(0.0), color_to = vec3(0.0);
float color_length = 0.0;

vec3 color_after(float rest) // where so much of the part's length is left
{
    return mix(color_to, color_from, color_length > 0.0 ? clamp(rest / color_length, 0.0, 1.0) : 1.0);
}

//@section piece_light
    vec3 color_front = color_after(p.rest), color_back = color_after(p.rest - part);
    g.rgb += g.transmittance * (color_front * share + color_back * (opacity - share));
    g.depth += t;
    g.transmittance -= g.transmittance * opacity;

//@section exact_rest
    gathered_absorb_half(i.sum, color_to);

//@section parts_declare
FETCH_FLOATS(6) color_values; // of points, or of cells: 0 … 1 over the field's range
FETCH_BUFFER(7) color_pieces; // two a piece of the function: x and r, g, b where it begins, and where it ends
uniform vec2 color_map;       // value → x of the function
uniform int color_last, color_half; // the last piece; a power of two, at least half their number
vec2 kept_color_map = vec2(0.0);
ivec2 kept_color_last = ivec2(0);
float color_x0 = 0.0, color_x1 = 0.0; // x at the segment's ends; of points: at the faces of its cell
float color_z0 = 0.0, color_z1 = 0.0; // depths there
vec2 color_x = vec2(0.0);             // x at the ends of what planes left of the segment
int color_piece = 0;                  // that the ray is in,
float color_here = 0.0;               // … where x is this

#ifdef COLOR_POINTS
float color_face(Walk w)
{
    vec3 value = vec3(fetch(color_values, w.id.x).x, fetch(color_values, w.id.y).x, fetch(color_values, w.id.z).x);
    return dot(w.weight, value) / (w.weight.x + w.weight.y + w.weight.z) * kept_color_map.x + kept_color_map.y;
}
#endif

//@section march_begin
    kept_color_map = keep(color_map);
    kept_color_last = ivec2(keep(color_last), keep(color_half));
#ifdef COLOR_POINTS
    color_x1 = color_face(w);
#endif

//@section march_segment
#ifdef COLOR_POINTS
    color_x0 = color_x1;
    color_x1 = color_face(w);
#else
    color_x1 = (segment.real ? fetch(color_values, segment.cell).x : 0.0) * kept_color_map.x + kept_color_map.y;
    color_x0 = color_x1;
#endif
    color_z0 = segment.z0;
    color_z1 = segment.z1;

//@section march_value
    segment.s0 = isnan(color_x0 + color_x1) ? color_x0 + color_x1 : segment.s0; // a cell without a colour has no value

//@section part_begin
    // Planes may have cut the segment.
    float color_length_z = color_z1 - color_z0;
    float color_cut0 = color_length_z > 0.0 ? clamp((segment.z0 - color_z0) / color_length_z, 0.0, 1.0) : 0.0;
    float color_cut1 = color_length_z > 0.0 ? clamp((segment.z1 - color_z0) / color_length_z, 0.0, 1.0) : 1.0;
    color_x = mix(vec2(color_x0), vec2(color_x1), vec2(color_cut0, color_cut1));
    // A ray that goes on where it was knows its piece; else it is the last that begins at or before x.
    bool color_jumps = color_x.x != color_here;
    color_piece = color_jumps ? 0 : color_piece;
    for (int step = color_jumps ? kept_color_last.y : 0; step > 0; step /= 2) {
        int ahead = min(color_piece + step, kept_color_last.x);
        color_piece = ahead == color_piece + step && fetch(color_pieces, 2 * ahead).x <= color_x.x ? ahead : color_piece;
    }
    color_here = segment.real ? color_x.y : color_x.x;

//@section part_cut
    vec4 color_begin = fetch(color_pieces, 2 * color_piece), color_end = fetch(color_pieces, 2 * color_piece + 1);
    bool color_up = color_x.y > color_x.x;
    float color_next = color_up ? color_end.x : color_begin.x, color_width = color_x.y - color_x.x;
    bool color_cuts = parts.whole.real && (color_up ? color_next < color_x.y : color_next > color_x.y);
    float color_share = clamp((color_next - color_x.x) / (color_width == 0.0 ? 1.0 : color_width), 0.0, 1.0);
    color_cuts = color_cuts && color_share < to;
    to = color_cuts ? color_share : to;
    end = color_cuts ? PART_COLOR : end;

//@section part_added
    float color_scale = 1.0 / (color_end.x - color_begin.x);
    vec2 color_at = vec2(color_x.x) + color_width * vec2(parts.from, parts.to);
    color_at = clamp((color_at - color_begin.x) * color_scale, 0.0, 1.0);
    color_from = mix(color_begin.yzw, color_end.yzw, color_at.x);
    color_to = mix(color_begin.yzw, color_end.yzw, color_at.y);
    color_length = parts.whole.real ? length * march_unit : 0.0;

//@section part_done
                color_piece += parts.end == PART_COLOR ? (color_x.y > color_x.x ? 1 : -1) : 0;

//@section iso_color
                    iso.rgb = iso.r < 0.0 ? color_to : iso.rgb;
