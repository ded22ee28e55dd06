#!/usr/bin/python3
"""Does a benchmark tell what was left out from what failed, and do both from a bar that is met?"""

import argparse
import contextlib
import io
import sys

sys.dont_write_bytecode = True
import bench  # noqa: E402
import growth  # noqa: E402
from common import Absent, Failure, bar  # noqa: E402

MET, MISSED = {"data": {}, "bars": [bar("a", 1, 2)]}, {"data": {}, "bars": [bar("a", 3, 2)]}
PART = {"data": {"left_out": ["a mesh"]}, "bars": [bar("a", 1, 2)]}
NO_BARS, LEFT_OUT, FAILED = {"data": {}, "bars": []}, {"left_out": "it is not there"}, {"failed": "it crashed"}

# --check, --quick, entries by section, the exit code
CODES = [
    (True, False, {"peers": MET, "passes": NO_BARS}, 0),
    (True, False, {"peers": MET, "bytes": MISSED}, 3),
    (True, False, {"peers": MET, "bytes": LEFT_OUT}, 3),
    (True, False, {"peers": PART}, 3),
    (True, False, {"cold": NO_BARS}, 3),
    (True, True, {"growth": NO_BARS}, 0),
    (True, True, {"growth": LEFT_OUT}, 3),
    (True, False, {"counts": LEFT_OUT, "values": MET}, 0),
    (True, False, {"counts": FAILED, "bytes": LEFT_OUT}, 1),
    (False, False, {"peers": MISSED, "bytes": LEFT_OUT}, 0),
    (False, False, {"peers": MET, "growth": FAILED}, 1),
]


def outcome(answers):
    """The class of what growth raises where its sizes give these answers in turn."""
    def one(*_):
        raise answers.pop(0) if len(answers) > 1 else answers[0]
    growth.one, growth.shader_folder = one, lambda *_, **__: "none"
    options = argparse.Namespace(quick=True, most_cells=10**6, threads=1, size="96x96")
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            growth.measure(options)
    except Failure as failure:
        return type(failure)
    return None


def main():
    if not bench.HAVE_BARS <= set(bench.SECTIONS):
        sys.exit("HAVE_BARS names a section that is not there")
    for check, quick, sections, code in CODES:
        options = argparse.Namespace(check=check, quick=quick, sections=list(sections))
        got = bench.exit_code(options, dict(sections, tables=FAILED))  # of an earlier run
        if got != code:
            sys.exit(f"check {check}, quick {quick}, {sections}: exit code {got} instead of {code}")
    for answers, kind in (([Absent("no memory")], Absent), ([Failure("it crashed"), Absent("no memory")], Failure)):
        got = outcome(answers)
        if got is not kind:
            sys.exit(f"growth, where a size gives {kind.__name__}: {got}")
    print(f"{len(CODES)} exit codes")


if __name__ == "__main__":
    main()
