"""Copies of shader files with something left out or done twice, for TETCAST_SHADERS: what a step's parts cost.

  shaders.py SHADERS OUT    makes every variant in OUT/NAME; exit code 1, and which, where one no longer fits the sources

What is done twice is done elsewhere (another address, other numbers) and looked at by a comparison that never holds, so
that no compiler can leave it out; rays are the same in all variants but `float-signs`.
"""

import os
import re
import sys

NEVER = "1.2345e30"

BARE = """// No integration: the walk alone.
struct Integral {
    vec4 color;
};

Integral integral_begin(vec4 color, float s)
{
    return Integral(color);
}

void integral_enter(inout Integral i, float s)
{
}

void integral_add(inout Integral i, float s, float l)
{
}

bool integral_round(inout Integral i)
{
    return false;
}

bool integral_waits(Integral i)
{
    return false;
}

void integral_settle(inout Integral i)
{
}

void integral_stop(inout Integral i, float s)
{
}

void integral_add_constant(inout Integral i, vec4 color, float l)
{
}

float integral_transmittance(Integral i)
{
    return 1.0;
}

vec4 integral_end(Integral i)
{
    return i.color;
}
"""

INTEGRATORS = ["integrate_integral.glsl", "integrate_exact.glsl", "integrate_table.glsl", "integrate_drift.glsl"]


# name: {file: [(pattern, replacement)]}; each pattern must be found exactly once.
EDITS = {
    "no-interpolation": {"stepper.glsl": [
        (r"(segment\.s0 = w\.s;\s*vec2 at = )walk_face_point\(w\);", r"\1vec2(w.z, w.s);")]},
    "vertex-twice": {"stepper.glsl": [
        (r"(void walk_look_ahead\((?:(?!\n\})(?:.|\n))*?    w\.ahead_vertex = fetch\(mesh_vertices, w\.ahead\);)",
         r"\1\n    w.ahead_vertex.w += dot(fetch(mesh_vertices, w.ahead ^ 1), vec4(1.0)) == " + NEVER + " ? 1.0 : 0.0;")]},
    "record-twice": {"mesh.glsl": [
        (r"    return fetch\(mesh_cells, cell\);",
         r"    ivec4 other = fetch(mesh_cells, cell ^ 1);\n"
         r"    return fetch(mesh_cells, cell) + int(other.x + other.y + other.z + other.w == 0x7fffffff);")]},
    "projection-twice": {"stepper.glsl": [
        (r"(bool walk_fast\((?:.|\n)*?)(    return sure;)",
         r"\1    vec3 again = ray_project(ray, w.ahead_vertex.xyz * 1.5);\n"
         r"    sure = sure && again.x + again.y + again.z != " + NEVER + r";\n\2")]},
    "signs-twice": {"stepper.glsl": [
        (r"(bool walk_fast\((?:.|\n)*?)(    return sure;)",
         r"\1    bool other = true;\n    vec2 p = w.d.xy * 1.5;\n"
         r"    float again = sign_cross_fast(p, w.a.xy * 1.5, other) + sign_cross_fast(p, w.b.xy * 1.5, other) +\n"
         r"                  sign_cross_fast(p, w.c.xy * 1.5, other);\n"
         r"    sure = sure && again != " + NEVER + r";\n\2")]},
    "nodes-twice": {"integrate_integral.glsl": [
        (r"(    f\.point = fetch\(tf_nodes, 2 \* node\);)",
         r"\1\n    f.point.a += dot(fetch(tf_nodes, (2 * node) ^ 4) + fetch(tf_nodes, ((2 * node) ^ 4) + 1), vec4(1.0)) == "
         + NEVER + " ? 1.0 : 0.0;")]},
    # Both branches, for CPUs and GPUs; as tests/hard/variant.sh float-signs.
    "float-signs": {"signs.glsl": [
        (r"    precise double e = double\(p\.x\) \* double\(q\.y\) - double\(p\.y\) \* double\(q\.x\);\n(    float c = float\(e\);)",
         r"    precise float m = p.x * q.y, n = p.y * q.x, e = m - n;\n\1"),
        (r"    sure = sure && abs\(c\) > SIGN_TINY;", "    sure = sure;"),
        (r"    precise float rest = fma\(-p\.y, q\.x, n\);\n", ""),
        (r"    precise float c = fma\(p\.x, q\.y, -n\) \+ rest;", "    precise float m = p.x * q.y, c = m - n;"),
        (r"    sure = sure && abs\(c\) > max\(SIGN_ROUNDING[^\n]*", "    sure = sure;")]},
}
# Which of them go with the bare walk.
ON_BARE = ["no-interpolation", "vertex-twice", "record-twice", "projection-twice", "signs-twice"]

# The least instructions of a step for eight rays, counted from the sources with registers of eight floats or four doubles:
# what no compiler could leave out. (part, instructions, how they come about)
LEAST = [
    ("fetches", 8, "4 for the cell's record, 4 for x, y, z and the scalar"),
    ("projection", 18, "3 differences; 3 dot products of 5, not contracted"),
    ("signs", 43, "8 coordinates to double in halves, 3 crosses of 3 in halves, back to float"),
    ("choice of the exit face", 71, "comparisons, and selections of 3 weights, 3 numbers and 3 projected vertices; ranks of the "
     "vertex that is dropped and of the new one, what the record has for them; exclusive or"),
    ("interpolation", 21, "depth and scalar, one division, order of depths"),
    ("loop", 8, "mask of the rays that go on, count, comparison, doubts about signs"),
]


class Misfit(Exception):
    pass


def make(shaders, out, edits=(), bare=False):
    """Writes a folder of overriding files; returns it."""
    os.makedirs(out, exist_ok=True)
    for old in os.listdir(out):
        os.remove(os.path.join(out, old))
    texts = {}
    for name in edits:
        for file, patterns in EDITS[name].items():
            if file not in texts:
                with open(os.path.join(shaders, file), encoding="utf-8") as source:
                    texts[file] = source.read()
            for pattern, replacement in patterns:
                texts[file], n = re.subn(pattern, replacement, texts[file])
                if n != 1:
                    raise Misfit(f"{name} no longer fits {file}: /{pattern}/ is found {n} times")
    if bare:
        texts.update({file: BARE for file in INTEGRATORS})
    for file, text in texts.items():
        with open(os.path.join(out, file), "w", encoding="utf-8") as target:
            target.write(text)
    return out


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    code = 0
    make(sys.argv[1], os.path.join(sys.argv[2], "bare"), bare=True)
    for name in EDITS:
        try:
            make(sys.argv[1], os.path.join(sys.argv[2], name), [name])
            if name in ON_BARE:
                make(sys.argv[1], os.path.join(sys.argv[2], "bare-" + name), [name], bare=True)
        except Misfit as misfit:
            print(misfit)
            code = 1
    sys.exit(code)


if __name__ == "__main__":
    main()
