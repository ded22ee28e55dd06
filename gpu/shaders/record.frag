// record.frag: walks a ray once to its end and writes down where it goes, for stepper_kept.glsl to walk there again with other
// values, another function. A record (tc_kept_face) holds a face's three vertices, the ray's weights in it and the length since
// the record before. A record stands for
//   each real cell, at the face where the ray leaves it;
//   the first imaginary cell of a gap, likewise, of no length;
//   the face where a ray enters a real cell otherwise than from the last record's face, of no length;
//   the face where a ray that has records leaves the mesh, of no length, if it is not the last record's: rays that became opaque
//   before are told from those that go out.
// Between them lie imaginary cells alone, which add nothing: what is summed along the records is what march.glsl sums, term by
// term. (integrate_exact.glsl comes from a gap with the rounding of each cell in it, so it does not go along records.)

#include "stepper.glsl"

uniform isampler2D state_walk; // entries: cell, a, b, c
#ifdef RECORD
uniform isampler2D kept_first; // the ray's first record
layout(std430, binding = 0) writeonly restrict buffer Records {
    int records[]; // three of ids, four of bits of floats
};
#endif
layout(location = 0) out ivec2 out_count; // 1 + the number of records (0: the ray misses the mesh; -1: it does not come to its end), cells

int record_first = 0, record_count = 0;

// on: the ray is under way. Behind a loop llvmpipe may have what the last lane that left it counted, so that a ray that is not
// must count nothing.
void record_put(bool on, ivec3 id, vec3 weight, float l)
{
#ifdef RECORD
    int at = 7 * (record_first + record_count);
    ivec3 bits = floatBitsToInt(weight);
    records[at] = id.x;
    records[at + 1] = id.y;
    records[at + 2] = id.z;
    records[at + 3] = bits.x;
    records[at + 4] = bits.y;
    records[at + 5] = bits.z;
    records[at + 6] = floatBitsToInt(l);
#endif
    record_count += on ? 1 : 0;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec4 walk = texelFetch(state_walk, pixel, 0);
    out_count = ivec2(0);
    if (walk.x >= 0) {
#ifdef RECORD
        record_first = texelFetch(kept_first, pixel, 0).x - 1;
#endif
        mesh_begin();
        Ray ray = ray_of_pixel(gl_FragCoord.xy);
        Walk w;
        int facing;
        walk_face(w, ray, walk.x, walk.yzw, facing);
        walk_look_ahead(w, -1);
        ivec3 id = w.id; // the face whose scalar is the walk's
        vec3 weight = w.weight;
        bool there = false; // it is that of the last record
        bool real = false;  // the cell before it was
        int cells = 0;
        do {
            walk_exact(w, ray);
            do {
                float z = w.z;
                bool on = w.cell >= 0;
                cells += on ? 1 : 0;
                ivec3 from = id;
                vec3 from_weight = weight;
                Segment segment = walk_step(w, ray);
                bool taken = walk_face_point(w).x > z - WALK_DEPTH_ROUNDING || !segment.real; // as walk_step has it
                id = taken ? w.id : id;
                weight = taken ? w.weight : weight;
                if (segment.real && !there)
                    record_put(on, from, from_weight, 0.0);
                bool behind = w.cell < 0 && record_count > 0;
                if (segment.real || real || behind)
                    record_put(on, id, weight, segment.real ? segment.z1 - segment.z0 : 0.0);
                there = segment.real || real;
                real = segment.real;
            } while (w.cell >= 0 && walk_fast(w, ray));
        } while (w.cell >= 0);
        out_count = ivec2(w.cell >= 0 ? -1 : 1 + record_count, cells);
    }
}
