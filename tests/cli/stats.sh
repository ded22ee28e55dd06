#!/bin/sh
# --stats: the names that scripts rely on, and nothing that was not measured.
. "$TC_SOURCE/tests/cli/lib.sh"
sink="synth:heatsink:4000 --size 48x48 -o a.png"

run 0 render $sink --stats s.json --verify 200
stdout_empty
version=$(sed -n 's/^#define TC_VERSION_STRING "\(.*\)"/\1/p' "$TC_SOURCE/src/tetcast.h")
json s.json eq tetcast "$version" eq field field ge unit_distance 0.001 has gl.context has gl.renderer has gl.version \
    ge mesh.points 100 ge mesh.tets 1000 ge mesh.imaginary_tets 1 eq mesh.dropped_cells 0 eq mesh.convex false \
    eq mesh.reentry convexify ge mesh.gpu_bytes 1 ge mesh.gpu_bytes_per_tet 16 le mesh.gpu_bytes_per_tet 32
json s.json lacks time_ms.read has time_ms.check has time_ms.adjacency has time_ms.order has time_ms.convexify \
    has time_ms.pack has time_ms.upload has time_ms.compile has time_ms.first_hit has time_ms.march has time_ms.frame \
    has time_ms.readback has time_ms.write has time_ms.total lacks time_ms.frame_min lacks time_ms.frame_max
json s.json eq march.driver pingpong has march.stepper ge march.steps_per_pass 1 ge march.passes 1 has march.z_updates \
    ge march.rays 100 eq march.rays_lost 0 ge march.steps 1000 ge march.steps_max 5 ge march.steps_per_ray 2 \
    ge march.steps_per_second 1 type march.fragments_per_pass array ge march.fragments_per_pass.0 1
json s.json size effects 1 eq effects.0 density-emitter
json s.json eq verify.pixels 200 has verify.ill_posed le verify.max_abs_error 0.00196 le verify.mean_abs_error 0.0001 \
    has verify.p999_abs_error has verify.p9999_abs_error eq verify.rays_lost 0 eq verify.pixels_all 2304 \
    eq verify.confidence 0.95 ge verify.unseen_share 0.012 le verify.unseen_share 0.016

json s.json eq march.samples 1 eq march.state_bits 32 lacks march.pixels_refined ge march.opacity_stop 0.99

# Several rays a pixel: sums over all of them.
rays=$(sed -n 's/.*"rays": \([0-9]*\).*/\1/p' s.json)
run 0 render $sink --stats m.json --samples adaptive --state-format 16f
json m.json eq march.samples adaptive ge march.pixels_refined 10 le march.pixels_refined 2304 eq march.state_bits 16 \
    eq march.rays_lost 0 ge march.rays $((4 * rays)) ge march.steps 4000
run 0 render $sink --stats m.json --samples 4
json m.json eq march.samples 4 lacks march.pixels_refined eq march.state_bits 32 ge march.rays $((3 * rays))

# Where rounding folds the hull (here entries count twice) a picture is made again by peeling, with all of its rays.
run 0 render $sink --samples adaptive -o once.exr
sed 's/\(atomicAdd(entries.*\), 1u);/\1, 2u);/' "$TC_SOURCE/gpu/shaders/first_hit.frag" >first_hit.frag
for driver in pingpong compute; do
    TETCAST_SHADERS=.
    export TETCAST_SHADERS
    run 0 render $sink --samples adaptive -o twice.exr --verbose --stats twice.json --driver $driver
    unset TETCAST_SHADERS
    says "the frame is peeled"
    json twice.json eq march.driver $driver eq march.rays_lost 0 ge march.pixels_refined 10
    run 0 compare once.exr twice.exr
done
rm first_hit.frag

# A ray that never comes out (here of its first cell) is lost, and the walk ends.
sed 's/w.cell = w.n3 ^ mesh_other(w.record, dropped, w.id);/w.cell = cell;/' "$TC_SOURCE/gpu/shaders/stepper.glsl" >stepper.glsl
for driver in pingpong compute; do
    TETCAST_SHADERS=.
    export TETCAST_SHADERS
    run 1 render synth:tet --size 16x16 -o tet.png --stats tet.json --driver $driver
    unset TETCAST_SHADERS
    says "rays were lost; the picture is not to be trusted"
    rays=$(sed -n 's/.*"rays": \([0-9]*\).*/\1/p' tet.json)
    json tet.json eq march.driver $driver ge march.rays 20 eq march.rays_lost "$rays"
done
rm stepper.glsl

# What compute does not have is absent.
run 0 render $sink --stats compute.json --driver compute --z-update-every 4
json compute.json eq march.driver compute ge march.passes 1 lacks march.z_updates lacks march.z_update_every \
    ge march.fragments_per_pass.0 100 ge march.steps 1000 eq march.rays_lost 0

# Repeated: median with its extremes, in order.
run 0 render $sink --stats r.json --repeat 3
json r.json eq frames 3 has time_ms.frame has time_ms.frame_min has time_ms.frame_max lacks verify
frame=$(sed -n 's/.*"frame": \([0-9.e+-]*\).*/\1/p' r.json)
json r.json le time_ms.frame_min "$frame" ge time_ms.frame_max "$frame"

# The reference has no GPU: what belongs to one is absent.
run 0 render $sink --driver reference --stats c.json
json c.json lacks gl lacks march.state_bits eq march.samples 1 eq march.driver reference lacks mesh.gpu_bytes lacks time_ms.upload lacks time_ms.compile \
    lacks time_ms.table lacks march.passes lacks march.fragments_per_pass lacks march.steps_per_pass

# What the paper's arithmetic loses is said at the end, after picture and numbers; the exact signs lose nothing there.
run 0 render synth:cap-1e8 --size 48x48 -o cap.png --stats cap.json
json cap.json eq march.stepper signs eq march.rays_lost 0 le mesh.gpu_bytes_per_tet 36
run 1 render synth:cap-1e8 --size 48x48 -o planes.png --stats planes.json --stepper planes --verify 100 --repeat 2
there planes.png
says "wrote planes.png"
says "rays were lost by the stepper 'planes'"
json planes.json eq march.stepper planes ge march.rays_lost 1 ge verify.rays_lost 1 ge march.steps 100 eq frames 2 \
    has time_ms.frame ge mesh.gpu_bytes_per_tet 160 le mesh.gpu_bytes_per_tet 180

# Cells in which other than two faces hold the ray (here the count is broken) are said at the end, too.
run 0 render $sink --stats audit.json --audit
says "exactly two faces held the ray"
json audit.json eq march.cells_broken 0
sed 's/walk_holding_faces(w) == 2u/walk_holding_faces(w) == 7u/' "$TC_SOURCE/gpu/shaders/march.glsl" >march.glsl
rm -f a.png
TETCAST_SHADERS=.
export TETCAST_SHADERS
run 1 render $sink --stats broken.json --audit
unset TETCAST_SHADERS
rm march.glsl
there a.png
says "visited cells other than two faces held the ray"
says_not "exactly two faces"
json broken.json ge march.cells_broken 1000

# A file is read, so reading is timed; peeling makes no imaginary cells.
run 0 synth heatsink --cells 4000 -o sink.vtu
run 0 render sink.vtu --size 48x48 -o b.png --stats f.json --reentry peel
json f.json has time_ms.read eq mesh.reentry peel eq mesh.imaginary_tets 0 eq march.rays_lost 0 lacks time_ms.convexify

# --stats - is JSON on stdout and nothing else.
run 0 render $sink --driver reference --stats -
cp out stdout.json
json stdout.json has tetcast

# A convex mesh has no gaps to fill.
run 0 render synth:kuhn:3000 --size 16x16 -o k.png --stats k.json
json k.json eq mesh.convex true eq mesh.imaginary_tets 0 lacks time_ms.convexify
finish
