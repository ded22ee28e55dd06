"""Meshes for the Python module's tests, and what they run with."""

import itertools
import os
import resource
import subprocess

import numpy as np

SOURCE = os.environ["TC_SOURCE"]
TETCAST = os.environ["TETCAST"]


def cube(n=1):
    """Points and cells of the unit cube, cut into 6 n^3 tetrahedra."""
    side = n + 1
    points = np.stack(np.meshgrid(*3 * [np.linspace(0, 1, side)], indexing="ij"), -1).reshape(-1, 3)
    first = np.arange(side**3).reshape(side, side, side)[:-1, :-1, :-1].reshape(-1, 1)
    steps = itertools.permutations((side * side, side, 1))
    cells = np.concatenate([first + np.cumsum((0, *step)) for step in steps]).astype(np.int32)
    return np.ascontiguousarray(points), cells


def resident():
    """Bytes of memory that this process holds now."""
    with open("/proc/self/statm") as statm:
        return int(statm.read().split()[1]) * resource.getpagesize()


def run(*arguments):
    """The program's standard output."""
    return subprocess.run([TETCAST, *arguments], check=True, capture_output=True, text=True).stdout
