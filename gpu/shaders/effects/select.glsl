// select.glsl: cells that are not kept are none that is seen: as imaginary ones they are stepped through.

//@section march_declare
FETCH_INTS(4, r32i) select_mask; // a bit a cell

//@section march_segment
    segment.real = segment.real && (fetch(select_mask, segment.cell >> 5).x >> (segment.cell & 31) & 1) != 0;
