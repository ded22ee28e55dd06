#!/bin/sh
# variant.sh NAME SHADERS OUT: copies of shader files with one thing broken on purpose, for TETCAST_SHADERS (gpu/program.h).
# Each breaks a rule that docs/stability.md calls necessary; the catalogue must notice (broken.sh).
#
#   float-signs    the crosses are plain floats: neither exact signs nor a rule for ties
#   no-ties        exact signs, but a true zero counts as negative
#   ids-only       exact signs, a true zero is decided by vertex ids without moving the ray first
#   float-weights  exact signs, but the weights of the exit point come from float
#   eye-origin     the eye is the origin of the ray's frame, however far away
#   peel-exit      the next entry is looked for behind the last exit, not behind the last entry
#
# Exit 0: OUT holds what differs. 2: no such variant, or it no longer applies to the sources.
set -eu
name=$1 shaders=$2 out=$3
mkdir -p "$out"

# edit FILE SED-SCRIPT COUNT: COUNT lines must change.
edit() {
    sed "$2" "$shaders/$1" >"$out/$1"
    changed=$(diff "$shaders/$1" "$out/$1" | grep -c '^[<>]' || true)
    [ "$changed" -eq "$3" ] || {
        echo "variant.sh: $name changes $changed lines of $1 where it should change $3: it has to follow the sources" >&2
        exit 2
    }
}

case $name in
float-signs)
    # As plain floats, nothing is ever unsure: neither doubles nor ties are reached. Both branches, for CPUs and GPUs.
    edit signs.glsl 's/^    precise double e = double(p.x) \* double(q.y) - double(p.y) \* double(q.x);$/    precise float m = p.x * q.y, n = p.y * q.x, e = m - n;/
        s/^    sure = sure \&\& abs(c) > SIGN_TINY;/    sure = sure;/
        /^    precise float rest = /d
        s/^    precise float c = fma(p.x, q.y, -n) + rest;/    precise float m = p.x * q.y, c = m - n;/
        s/^    sure = sure \&\& abs(c) > max(SIGN_ROUNDING.*/    sure = sure;/' 9
    ;;
no-ties)
    edit signs.glsl '/^        if (e == 0.0LF)$/d; /^            positive = p.y != q.y/d' 2
    ;;
ids-only)
    edit signs.glsl 's/^            positive = p.y != q.y.*/            positive = i < j;/' 2
    ;;
float-weights)
    # The cross is plain float wherever that has the right sign.
    edit signs.glsl 's/^    precise double e = double(p.x) \* double(q.y) - double(p.y) \* double(q.x);$/    precise float m = p.x * q.y, n = p.y * q.x, e = m - n;/
        s/^    sure = sure \&\& abs(c) > SIGN_TINY;/    sure = sure \&\& abs(c) > 4.8e-7 * (abs(m) + abs(n));/
        /^    precise float rest = /d
        s/^    precise float c = fma(p.x, q.y, -n) + rest;/    precise float m = p.x * q.y, c = m - n;/' 7
    ;;
eye-origin)
    # The origin lies t directions beyond the eye, and moves over the image as much as the direction does.
    edit ray.glsl 's/^    precise vec3 o = vec3(ray_point + x \* ray_point_dx + y \* ray_point_dy);/    double across = length(ray_direction_dx);\
    double t = across > 0.0LF ? length(ray_point_dx) \/ across : 0.0LF;\
    precise vec3 o = vec3(ray_point + x * ray_point_dx + y * ray_point_dy -\
                          t * (ray_direction + x * ray_direction_dx + y * ray_direction_dy));/
        s/^    ray.near = ray_near \* length_d;/    ray.near = (ray_near + float(t)) * length_d;/
        s/^    ray.far = ray_far \* length_d;/    ray.far = (ray_far + float(t)) * length_d;/' 9
    ;;
peel-exit)
    # The first hit walks on to the exit, and keeps that as the place to go on from.
    edit first_hit.frag 's/^    out_key = mine;/    walk_look_ahead(w, -1);\
    Walk on = w;\
    for (int n = 0; n < 100000 \&\& on.cell >= 0; n++) {\
        walk_exact(on, ray);\
        walk_step(on, ray);\
    }\
    out_key = depth_key(on.z) > key ? ivec2(depth_key(on.z), 1) : mine;/' 8
    ;;
*)
    echo "variant.sh: there is no variant $name" >&2
    exit 2
    ;;
esac
