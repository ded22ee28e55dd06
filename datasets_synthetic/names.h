/* names.h: one row a synthetic dataset: identifier, name, what it is, its field. */
#ifndef TC_DATASETS_SYNTHETIC_NAMES_H
#define TC_DATASETS_SYNTHETIC_NAMES_H

#define TC_SYNTH_LINEAR "linear: (x + 2 y + 3 z) / 6"

/* Shapes to look at. */
#define TC_SYNTH_PLAIN_ROWS(ROW)                                                                                       \
    ROW(kuhn, "kuhn", "unit cube, Kuhn lattice with jittered vertices; convex", TC_SYNTH_LINEAR)                       \
    ROW(ball, "ball", "ball of radius 1, octahedral lattice; convex", "r + 0.15 sin(6 z)")                             \
    ROW(heatsink, "heatsink", "base plate with 48 fins, many re-entries",                                              \
        "temperature: cosh decay along the fins, warm spot")                                                           \
    ROW(cylinder, "cylinder", "upright cylinder with a hole through it", "wave winding around the axis")               \
    ROW(bluntfin, "bluntfin", "channel around a blunt fin, C-shaped grid",                                             \
        "density: bow shock, compression at the nose, wake")                                                           \
    ROW(comb, "comb", "spine with 40 teeth, 39 re-entries along it", "sin(3 x) cos(2 z) + y")                          \
    ROW(shells, "shells", "three nested shells around a cavity", "r + 0.3 x y")                                        \
    ROW(spiral, "spiral", "rolled sheet of three turns", "r + 0.25 sin(4 z)")                                          \
    ROW(torusknot, "torusknot", "square tube along a trefoil knot", "sin(3 angle) + z")                                \
    ROW(tet, "tet", "one tet", "linear")                                                                               \
    ROW(two, "two", "two tets that share a face", "linear")

/* Hard cases: valid meshes that are hard on arithmetic. */
#define TC_SYNTH_HARD_ROWS(ROW)                                                                                        \
    ROW(grid_kuhn, "grid-kuhn", "hard: Kuhn lattice of spacing 1/16, not jittered", TC_SYNTH_LINEAR)                   \
    ROW(grid_kuhn_tenth, "grid-kuhn-tenth", "hard: Kuhn lattice of spacing 1/10, not jittered", TC_SYNTH_LINEAR)       \
    ROW(grid_five, "grid-five", "hard: cubes of spacing 1/16, five tets each, alternating", TC_SYNTH_LINEAR)           \
    ROW(grid_five_tenth, "grid-five-tenth", "hard: the same, of spacing 1/10", TC_SYNTH_LINEAR)                        \
    ROW(grid_bcc, "grid-bcc", "hard: body-centred cubic lattice of spacing 1/16", TC_SYNTH_LINEAR)                     \
    ROW(grid_bcc_tenth, "grid-bcc-tenth", "hard: the same, of spacing 1/10", TC_SYNTH_LINEAR)                          \
    ROW(grid_octahedral, "grid-octahedral", "hard: octahedral lattice of spacing 1/16", TC_SYNTH_LINEAR)               \
    ROW(grid_octahedral_tenth, "grid-octahedral-tenth", "hard: the same, of spacing 1/10", TC_SYNTH_LINEAR)            \
    ROW(needle_1e3, "needle-1e3", "hard: needles 1e3 times longer than thick, between wedges", TC_SYNTH_LINEAR)        \
    ROW(needle_1e5, "needle-1e5", "hard: the same, 1e5 times", TC_SYNTH_LINEAR)                                        \
    ROW(needle_1e8, "needle-1e8", "hard: the same, 1e8 times", TC_SYNTH_LINEAR)                                        \
    ROW(wedge_1e3, "wedge-1e3", "hard: wedges: two vertices 1e3 times closer than the rest", TC_SYNTH_LINEAR)          \
    ROW(wedge_1e5, "wedge-1e5", "hard: the same, 1e5 times", TC_SYNTH_LINEAR)                                          \
    ROW(wedge_1e8, "wedge-1e8", "hard: the same, 1e8 times", TC_SYNTH_LINEAR)                                          \
    ROW(cap_1e3, "cap-1e3", "hard: caps: a vertex 1e3 times closer to the opposite face", TC_SYNTH_LINEAR)             \
    ROW(cap_1e5, "cap-1e5", "hard: the same, 1e5 times", TC_SYNTH_LINEAR)                                              \
    ROW(cap_1e8, "cap-1e8", "hard: the same, 1e8 times", TC_SYNTH_LINEAR)                                              \
    ROW(sliver_1e3, "sliver-1e3", "hard: slivers: squares bent by 1e-3 of their side", TC_SYNTH_LINEAR)                \
    ROW(sliver_1e5, "sliver-1e5", "hard: the same, by 1e-5", TC_SYNTH_LINEAR)                                          \
    ROW(sliver_1e8, "sliver-1e8", "hard: the same, by 1e-8", TC_SYNTH_LINEAR)                                          \
    ROW(sliver_folded, "sliver-folded", "hard: slivers that rounding to float turns inside out", TC_SYNTH_LINEAR)      \
    ROW(flat_cells, "flat-cells", "hard: cells of zero volume that keep the mesh conforming", TC_SYNTH_LINEAR)         \
    ROW(graded, "graded", "hard: cell sizes from 1e-6 to 1, all of good shape", TC_SYNTH_LINEAR)                       \
    ROW(graded_planes, "graded-planes", "hard: plane distances from 1e-6 to 1, of all shapes", TC_SYNTH_LINEAR)        \
    ROW(vertex_fan, "vertex-fan", "hard: 10 000 tets around one vertex", TC_SYNTH_LINEAR)                              \
    ROW(edge_fan, "edge-fan", "hard: 10 000 tets around one edge", TC_SYNTH_LINEAR)                                    \
    ROW(size_1e_30, "size-1e-30", "hard: kuhn, 1e-30 in size", "linear, as kuhn's")                                    \
    ROW(size_1e_20, "size-1e-20", "hard: kuhn, 1e-20 in size", "linear, as kuhn's")                                    \
    ROW(size_1e20, "size-1e20", "hard: kuhn, 1e20 in size", "linear, as kuhn's")                                       \
    ROW(size_1e30, "size-1e30", "hard: kuhn, 1e30 in size", "linear, as kuhn's")                                       \
    ROW(offset_1e7, "offset-1e7", "hard: kuhn, moved by 1e7 along each axis", "linear, as kuhn's")                     \
    ROW(comb_size_1e_30, "comb-size-1e-30", "hard: comb, 1e-30 in size", "comb's")                                     \
    ROW(comb_size_1e30, "comb-size-1e30", "hard: comb, 1e30 in size", "comb's")                                        \
    ROW(comb_offset_1e7, "comb-offset-1e7", "hard: comb, moved by 1e7 along each axis", "comb's")                      \
    ROW(rod_1e_4, "rod-1e-4", "hard: box of 1 x 1e-4 x 1e-4", "linear over the box")                                   \
    ROW(plate_1e_4, "plate-1e-4", "hard: box of 1 x 1 x 1e-4", "linear over the box")                                  \
    ROW(turned_cube, "turned-cube", "hard: cube turned by 1 radian: faces flat up to rounding", TC_SYNTH_LINEAR)       \
    ROW(uneven_ulp, "uneven-ulp", "hard: cube, a face uneven by a unit in the last place", TC_SYNTH_LINEAR)            \
    ROW(uneven_1e_10, "uneven-1e-10", "hard: the same, by 1e-10", TC_SYNTH_LINEAR)                                     \
    ROW(uneven_1e_7, "uneven-1e-7", "hard: the same, by 1e-7", TC_SYNTH_LINEAR)                                        \
    ROW(cycle, "cycle", "hard: three tets, each before the next one", TC_SYNTH_LINEAR)                                 \
    ROW(cycle_ring, "cycle-ring", "hard: a ring of such tets", TC_SYNTH_LINEAR)                                        \
    ROW(touch_vertex, "touch-vertex", "hard: two boxes that share a vertex", TC_SYNTH_LINEAR)                          \
    ROW(touch_edge, "touch-edge", "hard: two boxes that share an edge", TC_SYNTH_LINEAR)                               \
    ROW(touch_edge_apart, "touch-edge-apart", "hard: the same, with points and values of their own",                   \
        "linear, higher in one")                                                                                       \
    ROW(checkerboard, "checkerboard", "hard: cubes that share edges and vertices only", TC_SYNTH_LINEAR)               \
    ROW(disjoint, "disjoint", "hard: 27 boxes apart from each other", TC_SYNTH_LINEAR)                                 \
    ROW(cavities, "cavities", "hard: box with eight cavities", TC_SYNTH_LINEAR)                                        \
    ROW(cavity_nested, "cavity-nested", "hard: box in a cavity of a box in a cavity of a box", TC_SYNTH_LINEAR)        \
    ROW(notch_5e_2, "notch-5e-2", "hard: box with a cut whose sides are at 0.05 degrees", TC_SYNTH_LINEAR)             \
    ROW(notch_1e_3, "notch-1e-3", "hard: the same, at 1e-3 degrees", TC_SYNTH_LINEAR)                                  \
    ROW(notch_1e_6, "notch-1e-6", "hard: the same, at 1e-6 degrees", TC_SYNTH_LINEAR)                                  \
    ROW(hinge_5e_2, "hinge-5e-2", "hard: blocks hinged at an edge, faces at 0.05 degrees", TC_SYNTH_LINEAR)            \
    ROW(hinge_apart, "hinge-apart", "hard: the same at 1e-3 degrees, the edge there twice, 1e-16 apart",               \
        TC_SYNTH_LINEAR)                                                                                               \
    ROW(gap_1e_4, "gap-1e-4", "hard: two boxes 1e-4 apart", TC_SYNTH_LINEAR)                                           \
    ROW(gap_1e_7, "gap-1e-7", "hard: two boxes 1e-7 apart", TC_SYNTH_LINEAR)                                           \
    ROW(gap_1e_12, "gap-1e-12", "hard: two boxes 1e-12 apart", TC_SYNTH_LINEAR)                                        \
    ROW(blades, "blades", "hard: blades around an edge, 0.05 degrees between them", TC_SYNTH_LINEAR)

/* Hard cases: meshes with something wrong. */
#define TC_SYNTH_BROKEN_ROWS(ROW)                                                                                      \
    ROW(inverted_some, "inverted-some", "broken: every third cell inside out", TC_SYNTH_LINEAR)                        \
    ROW(inverted_all, "inverted-all", "broken: all cells inside out", TC_SYNTH_LINEAR)                                 \
    ROW(tangled, "tangled", "broken: vertices moved so far that cells are inverted in place", TC_SYNTH_LINEAR)         \
    ROW(duplicate_cells, "duplicate-cells", "broken: every seventh cell is there twice", TC_SYNTH_LINEAR)              \
    ROW(repeated_vertex, "repeated-vertex", "broken: cells that repeat a vertex", TC_SYNTH_LINEAR)                     \
    ROW(collapsed_axis, "collapsed-axis", "broken: grid around an axis, cells on it collapsed", TC_SYNTH_LINEAR)       \
    ROW(unused_points, "unused-points", "broken: points of no cell, far away", TC_SYNTH_LINEAR)                        \
    ROW(one_side, "one-side", "broken: two cells on one side of a face", TC_SYNTH_LINEAR)                              \
    ROW(three_cells, "three-cells", "broken: faces of three cells", TC_SYNTH_LINEAR)                                   \
    ROW(seam, "seam", "broken: a seam of coincident points with equal values", TC_SYNTH_LINEAR)                        \
    ROW(seam_jump, "seam-jump", "broken: a seam where the values jump", "linear, higher on one side")                  \
    ROW(seam_mismatch, "seam-mismatch", "broken: squares of a seam cut along different diagonals", TC_SYNTH_LINEAR)    \
    ROW(crack, "crack", "broken: a crack inside: the boundary touches itself", "linear, higher in the crack")          \
    ROW(slit, "slit", "broken: a slit from the surface: the boundary touches itself", "linear, higher in the slit")    \
    ROW(slit_ring, "slit-ring", "broken: a ring cut open, its ends on each other", "angle + 0.3 z")                    \
    ROW(hanging_nodes, "hanging-nodes", "broken: cells half as large on one side of a plane", TC_SYNTH_LINEAR)         \
    ROW(hanging_patch, "hanging-patch", "broken: cells half as large in the middle", TC_SYNTH_LINEAR)                  \
    ROW(bricks, "bricks", "broken: boxes that lie on each other like bricks", TC_SYNTH_LINEAR)                         \
    ROW(overlap_grids, "overlap-grids", "broken: two grids through each other", TC_SYNTH_LINEAR)                       \
    ROW(overlap_coincident, "overlap-coincident", "broken: two grids of the same cube", TC_SYNTH_LINEAR)               \
    ROW(overlap_1e_7, "overlap-1e-7", "broken: two boxes that overlap by 1e-7", TC_SYNTH_LINEAR)                       \
    ROW(overlap_1e_12, "overlap-1e-12", "broken: two boxes that overlap by 1e-12", TC_SYNTH_LINEAR)                    \
    ROW(nan_region, "nan-region", "broken: NaN in a ball", "linear and NaN")                                           \
    ROW(nan_scattered, "nan-scattered", "broken: NaN at one point in forty", "linear and NaN")                         \
    ROW(nan_all, "nan-all", "broken: NaN at all points", "NaN")                                                        \
    ROW(nan_cells, "nan-cells", "broken: NaN in the cells of a ball; data of cells", "linear and NaN")                 \
    ROW(inf_region, "inf-region", "broken: Inf and -Inf in a ball", "linear, Inf, -Inf")                               \
    ROW(inf_scattered, "inf-scattered", "broken: NaN, Inf and -Inf at one point in forty", "linear, NaN, Inf, -Inf")   \
    ROW(nan_coordinates, "nan-coordinates", "broken: NaN in coordinates", TC_SYNTH_LINEAR)                             \
    ROW(inf_coordinates, "inf-coordinates", "broken: Inf in coordinates", TC_SYNTH_LINEAR)                             \
    ROW(no_field, "no-field", "broken: no array", "none")                                                              \
    ROW(constant, "constant", "broken: the same value everywhere", "0.7")                                              \
    ROW(values_1e300, "values-1e300", "broken: values beyond a float's range", "linear, times 1e300")                  \
    ROW(values_1e_300, "values-1e-300", "broken: values below a float's range", "linear, times 1e-300")                \
    ROW(values_offset_1e9, "values-offset-1e9", "broken: values that differ by less than a float resolves",            \
        "1e9 + linear")                                                                                                \
    ROW(no_cells, "no-cells", "broken: points without cells", TC_SYNTH_LINEAR)                                         \
    ROW(bad_index, "bad-index", "broken: a cell names a vertex that is not there", TC_SYNTH_LINEAR)

#define TC_SYNTH_ROWS(ROW) TC_SYNTH_PLAIN_ROWS(ROW) TC_SYNTH_HARD_ROWS(ROW) TC_SYNTH_BROKEN_ROWS(ROW)

#endif
