#!/usr/bin/python3
"""Do the shader variants of `parts` and `integration` still fit the sources, compile, and send the rays the same way?

  check_variants.py BUILD SHADERS WORK    exit code 1, and why, where one does not
"""

import json
import os
import sys

sys.dont_write_bytecode = True
import common  # noqa: E402
import shaders  # noqa: E402


def main():
    build, sources, work = (os.path.abspath(path) for path in sys.argv[1:4])
    variants = {"bare": ([], True)}
    variants.update({name: ([name], name in shaders.ON_BARE) for name in shaders.EDITS})
    listing = ["default,integrator=integral,opacity-stop=1"]
    for name, (edits, bare) in variants.items():
        try:
            folder = shaders.make(sources, os.path.join(work, name), edits, bare)
        except shaders.Misfit as misfit:
            sys.exit(f"{misfit}; let EDITS in tests/bench/shaders.py follow")
        listing.append(f"{name},shaders={folder},integrator=integral,opacity-stop=1")
    out = common.run([os.path.join(build, "bench_frames"), "synth:kuhn:500", "--size", "24", "--frames", "1", "--azimuths", "35",
                      "--elevation", "25", "--apart", *listing])
    found = common.by_name(json.loads(out))
    for name, variant in found.items():
        if "failed" in variant:
            sys.exit(f"{name}: {variant['failed']}")
    steps = found["default"]["views"][0]["steps"]
    if steps <= 0:
        sys.exit("the default makes no steps")
    for name, variant in found.items():
        view = variant["views"][0]
        if name != "float-signs" and (view["steps"] != steps or view["rays_lost"] != 0):
            sys.exit(f"{name}: {view['steps']:.0f} steps and {view['rays_lost']:.0f} rays lost, where the default makes {steps:.0f}")
    print(f"{len(found)} variants, {steps:.0f} steps each")


if __name__ == "__main__":
    main()
