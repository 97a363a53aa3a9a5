#!/usr/bin/env python3
"""Times whole studies of two stacked blocks: H1 to H4 flat, H1c to H4c curved. No assertion: figures for people.

usage: end_to_end.py BUILD [NAME ...] [--json FILE]      BUILD: build/release; NAME: H1 H1c ... (all by default up to H2)
"""

import argparse
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "commands/studies"))

from meshes import brick, union, write_med  # noqa: E402

#: cells along the sides of the bottom block, its height, the same of the top block
SIZES = {"H1": (15, 8, 12, 6), "H2": (26, 14, 21, 12), "H3": (38, 20, 31, 17), "H4": (48, 26, 39, 22)}
CURVATURE, PUSH = 0.002, 0.0011


def two_blocks(name, kind="HEXA8"):
    """The mesh of a name of SIZES, with a `c` behind it for the curved skin."""
    nb, mb, nt, mt = SIZES[name.rstrip("c")]
    curvature = CURVATURE if name.endswith("c") else 0.0

    def above(x, y, z):
        return x, y, z + (1.0 - z) / 0.5 * curvature * (x * x + y * y)

    def lines(n, m, z0):
        return [np.linspace(0.0, 1.0, n + 1)] * 2 + [np.linspace(z0, z0 + 0.5, m + 1)]

    bottom = brick(kind, lines(nb, mb, 0.0), name="VBOT",
                   sides={(0, 0): "XB", (1, 0): "YB", (2, 0): "BASE", (2, 1): "CBOT"})
    top = brick(kind, lines(nt, mt, 0.5), place=above, name="VTOP",
                sides={(0, 0): "XT", (1, 0): "YT", (2, 0): "CTOP", (2, 1): "TOP"})
    return union([bottom, top])


def run(lacon, name, folder, threads):
    """One study: wall seconds, peak memory of its largest process in MB, output."""
    mesh = folder / f"{name}.med"
    if not mesh.exists():
        write_med(mesh, two_blocks(name))
    environment = {**os.environ, "BLOCKS_FLAT": "0" if name.endswith("c") else "1", "BLOCKS_DZ": str(PUSH),
                   "OPENBLAS_NUM_THREADS": str(threads), "OMP_NUM_THREADS": str(threads)}
    before = time.perf_counter()
    done = subprocess.run([str(lacon), str(SOURCE / "tests/bench/two_blocks.comm"), "--fresh", "--unit", f"20={mesh}",
                           "--base", str(folder / f"{name}.base"), "--timings"],
                          env=environment, capture_output=True, text=True)
    seconds = time.perf_counter() - before
    return seconds, done
