// empty.glsl: cells deep in empty space are stepped through, and no more, in a loop of their own, from the end of which on all
// goes as ever. Such cells and those beside them are transparent: the first cell behind a run of them that is added is
// transparent, too, and so is all between the scalar before the run and that behind this cell; the integrator, which takes the
// scalar to run straight from the one to the other, need not be told where it went meanwhile.

//@section march_declare
FETCH_INTS(14, r32i) empty_mask;     // a bit a cell
int empty_most = 0, empty_steps = 0; // steps that a walk may make, and has made
bool empty_sure = true;              // the answer of walk_fast, which looks at the cell behind

//@section march_functions
// One step, or as many as lead through such cells.
Segment empty_walk(inout Walk w, Ray ray)
{
    Segment segment = Segment(0.0, 0.0, 0.0, 0.0, false, 0);
    bool through = true;
    empty_steps = 0;
    while (through) { // what is fetched in a loop that asks at its end is, behind it, not each lane's own: so it asks first
#ifdef AUDIT
        if (empty_steps > 0) {
#ifdef CLIP_NEAR
            segment.z0 = clamp(ray.near, segment.z0, segment.z1);
#endif
            audit_add(audit, segment);
            audit.broken += walk_holding_faces(w) == 2u ? 0u : 1u;
        }
#endif
        segment = walk_step(w, ray);
        empty_steps++;
        empty_sure = walk_fast(w, ray);
        through = (fetch(empty_mask, segment.cell >> 5).x >> (segment.cell & 31) & 1) != 0;
        through = through && empty_sure && w.cell >= 0 && empty_steps < empty_most;
#ifdef CLIP_FAR
        through = through && segment.z1 <= ray.far;
#endif
    }
    return segment;
}

//@section march_walk
    Segment segment = empty_walk(w, ray);

//@section march_next
            if (!open) {
                empty_most = most - k;
                march_step(w, ray, integral);
                k += empty_steps;
            }

//@section march_again
        } while (GOES_ON && !integral_waits(integral) && empty_sure);
