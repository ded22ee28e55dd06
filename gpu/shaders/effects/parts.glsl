// parts.glsl: a segment is added in parts, cut where something lies within it: an isosurface, a knot of a second function,
// a layer of geometry. A part is one round of march.glsl's loop, or as many as its integrator takes, so that rays whose
// segments are cut keep no others waiting. Rows that cut, and rows that act on parts, have sections at the places below.

//@section march_declare
const int PART_END = 0, PART_ISO = 1, PART_COLOR = 2, PART_LAYER = 3; // what stands at the end of a part: the segment's, …

struct Parts {
    Segment whole;  // as the step and what cuts it at planes left it
    float from, to; // the part that is being added: shares of the whole
    int end;
    bool left;      // there are more
#ifdef NAN_COLOR
    bool constant;  // all of it has the colour of missing values
#endif
};
#ifdef NAN_COLOR
bool parts_constant = false; // of the segment that is being made
Parts parts = Parts(Segment(0.0, 0.0, 0.0, 0.0, false, -1), 0.0, 0.0, PART_END, false, false);
#else
Parts parts = Parts(Segment(0.0, 0.0, 0.0, 0.0, false, -1), 0.0, 0.0, PART_END, false);
#endif
const int PARTS_DECLARED = 1; //@then parts_declare

// Adds the next part.
void parts_next(inout Integral integral, Ray ray)
{
    float to = 1.0;
    int end = PART_END; //@then part_cut
    parts.from = parts.to;
    parts.to = max(to, parts.from);
    parts.end = end;
    float s = end == PART_END ? parts.whole.s1 : mix(parts.whole.s0, parts.whole.s1, parts.to); //@then part_scalar
    float length = (parts.whole.z1 - parts.whole.z0) * (parts.to - parts.from);
    integral_add(integral, s, parts.whole.real ? length * march_unit : 0.0); //@then part_added
#ifdef NAN_COLOR
    integral_add_constant(integral, march_nan_color, parts.constant ? length * march_unit : 0.0);
#endif
}

//@section march_add
    parts.whole = segment;
    parts.from = 0.0;
    parts.to = 0.0;
#ifdef NAN_COLOR
    parts.constant = parts_constant;
    parts_constant = false;
#endif
    parts.left = true; //@then part_begin

//@section march_constant
        parts_constant = segment.real;

//@section march_next
            if (!open) {
                if (!parts.left) {
                    march_step(w, ray, integral);
                    k++;
                }
                parts_next(integral, ray);
            }

//@section march_added
            if (!open) {
                parts.left = parts.end != PART_END; //@then part_done
                march_stop(w, integral);
                parts.left = parts.left && w.cell != MARCH_OPAQUE;
            }

//@section march_goes_on
#define GOES_ON (open || parts.left || w.cell >= 0 && k < most)
