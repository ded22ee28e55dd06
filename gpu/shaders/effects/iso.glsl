// iso.glsl: isosurfaces, each where the scalar, linear along the segment, has its value: a value is crossed if (s0 < value) !=
// (s1 < value), so that cells which follow each other cross it once.

//@section parts_declare
uniform float iso_value[ISO]; // ascending
uniform vec4 iso_color[ISO];  // r, g, b, opacity
int iso_at = 0, iso_to = 0; // how many values are at or below the scalar: where the ray is, and where its segment ends

int iso_below(float s)
{
    int n = 0;
    for (int i = 0; i < ISO; i++)
        n += iso_value[i] <= s ? 1 : 0;
    return n;
}

// The surface that is crossed next.
int iso_next()
{
    return clamp(iso_at < iso_to ? iso_at : iso_at - 1, 0, ISO - 1);
}

//@section part_begin
    iso_at = iso_below(segment.s0);
    iso_to = segment.real ? iso_below(segment.s1) : iso_at;
#ifdef CLIP_NEAR
    iso_to = segment.z1 > ray.near ? iso_to : iso_at; // nothing before it is seen
#endif

//@section part_cut
    float iso_share = (iso_value[iso_next()] - parts.whole.s0) / (parts.whole.s1 - parts.whole.s0);
    bool iso_cuts = iso_at != iso_to && !(iso_share >= to);
    iso_cuts = iso_cuts || (iso_at != iso_to && end == PART_END); // rounding may put it at the end, or beyond
    to = iso_cuts ? clamp(iso_share, 0.0, 1.0) : to;
    end = iso_cuts ? PART_ISO : end;

//@section part_scalar
    s = end == PART_ISO ? iso_value[iso_next()] : s;

//@section part_done
                if (parts.end == PART_ISO) {
                    int surface = iso_next();
                    vec4 iso = iso_color[surface]; //@then iso_color
                    gathered_surface(integral.sum, iso.rgb, iso.a); //@then iso_added
                    iso_at += iso_at < iso_to ? 1 : -1;
                }
