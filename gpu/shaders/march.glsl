// march.glsl: up to K cell steps of a ray, whatever carries its state from pass to pass: march.frag, march.comp.
// Weiler et al. 2003, 3.4.

#include "stepper.glsl"
#include "integrator.glsl"

uniform int steps_per_pass;
uniform float length_unit;         // half diagonals → unit distances
uniform float transmittance_stop;  // a ray ends at or below
#ifdef NAN_COLOR
uniform vec4 nan_color; // of cells with a value that is not finite: r, g, b, attenuation per unit distance
vec4 march_nan_color = vec4(0.0);
#endif
const int MARCH_ENDED = -2, MARCH_OPAQUE = -4; // in place of a cell: the ray ends within the mesh; for it is opaque
float march_unit = 0.0, march_least = 0.0; // length_unit, transmittance_stop //@then march_declare
#ifdef AUDIT
struct Audit {
    float length, real;
    uint hash, broken;
};

uint audit_hash(uint cell) // tc_audit_hash
{
    uint h = cell + 1u;
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    return h ^ (h >> 16);
}

void audit_add(inout Audit audit, Segment segment)
{
    audit.length += segment.z1 - segment.z0;
    audit.real += segment.real ? segment.z1 - segment.z0 : 0.0;
    audit.hash += audit_hash(uint(segment.cell));
}

Audit audit;

void audit_begin(uvec4 before) // length, length in real cells (bits), hash of the cells, broken cells
{
    audit = Audit(uintBitsToFloat(before.x), uintBitsToFloat(before.y), before.z, before.w);
}

uvec4 audit_end()
{
    return uvec4(floatBitsToUint(audit.length), floatBitsToUint(audit.real), audit.hash, audit.broken);
}
#endif //@then march_functions

// One step, and its share of the picture, which integral_round may still have to add.
void march_step(inout Walk w, Ray ray, inout Integral integral)
{ //@then march_before
#ifdef AUDIT
    audit.broken += walk_holding_faces(w) == 2u ? 0u : 1u;
#endif
    Segment segment = walk_step(w, ray); //@or march_walk //@then march_segment
#ifdef CLIP_NEAR
    if (segment.z0 < ray.near) {
        if (segment.z1 > ray.near) {
            segment.s0 = mix(segment.s0, segment.s1, (ray.near - segment.z0) / (segment.z1 - segment.z0));
            segment.z0 = ray.near;
            integral_enter(integral, segment.s0);
        } else {
            segment.z0 = segment.z1; // nothing of it is seen
        }
    }
#endif
#ifdef CLIP_FAR
    if (segment.z1 > ray.far) {
        float f = clamp((ray.far - segment.z0) / (segment.z1 - segment.z0), 0.0, 1.0);
        segment.s1 = mix(segment.s0, segment.s1, f);
        segment.z1 = max(segment.z0, ray.far);
        w.cell = MARCH_ENDED; // the rest is not seen
    }
#endif
#ifdef AUDIT
    audit_add(audit, segment);
#endif
#ifdef CELL_DATA
    segment.s0 = segment.s1 = segment.real ? mesh_cell_value(segment.cell) : 0.0;
    integral_enter(integral, segment.s0);
#endif
#ifdef NONFINITE
    // A cell with a value that is not finite has no colour of the function's: its entry and exit face together hold all
    // its vertices. //@then march_value
    if (isnan(segment.s0) || isnan(segment.s1)) {
#ifdef NAN_COLOR
        integral_add_constant(integral, march_nan_color, segment.real ? (segment.z1 - segment.z0) * march_unit : 0.0); //@or march_constant
#endif
        segment.real = false;
        segment.s1 = isnan(segment.s1) ? 0.0 : segment.s1;
        integral_enter(integral, segment.s1);
    }
#endif
    integral_add(integral, segment.s1, segment.real ? (segment.z1 - segment.z0) * march_unit : 0.0); //@or march_add //@then march_taken
}

// Ends the ray where it is opaque.
void march_stop(inout Walk w, Integral integral)
{
    w.cell = w.cell >= 0 && integral_transmittance(integral) <= march_least ? MARCH_OPAQUE : w.cell;
}

// Up to steps_per_pass steps of the ray through `pixel`, which is not finished. walk: its cell, negative once it is
// finished, and a, b, c; color: the integrator's; at: depth and scalar (bits of floats), the cell it comes from, 1; where it
// enters, 0, 0, -1, 0. Gives the number of steps.
int march(inout ivec4 walk, inout vec4 color, inout ivec4 at, vec2 pixel)
{
    int most = keep(steps_per_pass);
    march_unit = keep(length_unit);
    march_least = keep(transmittance_stop);
#ifdef NAN_COLOR
    march_nan_color = keep(nan_color);
#endif
    mesh_begin();
    Ray ray = ray_of_pixel(pixel); //@then march_ray
    Walk w;
    int facing;
    walk_face(w, ray, walk.x, walk.yzw, facing);
    if (at.w != 0) {
        w.z = intBitsToFloat(at.x);
        w.s = intBitsToFloat(at.y);
    }
    walk_look_ahead(w, at.z);
    Integral integral = integral_begin(color, w.s); //@then march_begin
    int k = 0;
    bool open = false;     // the last step's segment is not all added yet
#define GOES_ON (open || w.cell >= 0 && k < most) //@or march_goes_on
    // Loops in one another: what is rare waits in the outer ones until all lanes of a group need it or are done.
#ifdef TF_HARD
    do {
#endif
    do {
        walk_exact(w, ray);
        do {
            if (!open) { //@or march_next
                march_step(w, ray, integral); //@or march_next
                k++; //@or march_next
            } //@or march_next
            open = integral_round(integral);
#ifdef PIECES_TWICE
            if (open)
                open = integral_round(integral);
#endif //@then march_round
            if (!open) //@or march_added
                march_stop(w, integral); //@or march_added
        } while (GOES_ON && !integral_waits(integral) && walk_fast(w, ray)); //@or march_again
    } while (GOES_ON && !integral_waits(integral));
#ifdef TF_HARD
    integral_settle(integral); // where this makes the ray opaque it ends after its next step //@then march_settled
    } while (GOES_ON);
#endif
    // What is left may be absorbed behind, or not: half of it is taken to be, in the colour that the ray is in. //@then march_rest
    if (w.cell == MARCH_OPAQUE) {
        integral_stop(integral, w.s);
        w.cell = MARCH_ENDED;
    } //@then march_end
    color = integral_end(integral);
    walk = ivec4(w.cell, w.id);
    at = ivec4(floatBitsToInt(w.z), floatBitsToInt(w.s), walk_from(w), 1); //@then march_at
    return k;
}
