#!/usr/bin/env python3
"""Times whole studies of two stacked blocks: H1 to H4 flat, H1c to H4c curved. No assertion: figures for people.

usage: end_to_end.py BUILD [NAME ...] [--threads N] [--json FILE]      BUILD: build/release; NAME: H1 H1c ..., by default up to H2c

Prints wall time, largest memory of a process, phases of STAT_NON_LINE, and the ratio to the factorisation of a cube of 32^3 HEXA8 by
MUMPS and to a copy of memory, both measured in the same run (bench_machine).
"""

import argparse
import json
import os
import pathlib
import re
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


def study(lacon, name, folder, threads):
    """One study: wall seconds, largest memory of a process (MB), seconds by phase of STAT_NON_LINE, Newton iterations, factorisations."""
    mesh = folder / f"{name}.med"
    if not mesh.exists():
        write_med(mesh, two_blocks(name))
    environment = {**os.environ, "BLOCKS_FLAT": "0" if name.endswith("c") else "1", "BLOCKS_DZ": str(PUSH),
                   "OPENBLAS_NUM_THREADS": str(threads), "OMP_NUM_THREADS": str(threads)}
    command = [lacon, SOURCE / "tests/bench/two_blocks.comm", "--fresh", "--unit", f"20={mesh}", "--base", folder / f"{name}.base",
               "--timings"]
    start = time.perf_counter()
    with open(folder / "output", "w+", encoding="utf-8") as output:
        process = subprocess.Popen([str(word) for word in command], env=environment, stdout=output, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)  # with the largest memory of the operators that it waited for
        wall = time.perf_counter() - start
        output.seek(0)
        said = output.read()
    if status:
        sys.exit(f"{name}: exit status {os.waitstatus_to_exitcode(status)}\n{said[-3000:]}")
    lines = re.findall(r"^ \|\s+\d+X?\s*\|.*$", said, re.MULTILINE)
    table = said[said.index("  STAT_NON_LINE  "):]
    phases = dict(re.findall(r"^ {6}(\w[\w ]*?)\s+([0-9.]+)$", table.split("  TEST_RESU")[0].split("  FIN ")[0], re.MULTILINE))
    return {"name": name, "wall": wall, "memory": usage.ru_maxrss / 1024,
            "iterations": len(lines), "factorisations": sum("TANGENTE" in line for line in lines),
            "phases": {phase: float(seconds) for phase, seconds in phases.items()}}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("names", nargs="*", default=["H1", "H2", "H1c", "H2c"])
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    build = options.build.resolve()
    machine = json.loads(subprocess.run([str(build / "tests/bench_machine")], check=True, capture_output=True, text=True,
                                        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"}).stdout)
    print(f"cube of 32^3 HEXA8: factorised in {machine['factorisation_seconds']:.2f} s at {machine['factorisation_gflops']:.1f} GF/s; "
          f"dgemm {machine['dgemm_gflops']:.1f} GF/s, copy of memory {machine['copy_gbytes']:.1f} GB/s")
    head = ["read", "elements", "pairing", "contact", "analysis", "factorisation", "solution", "archive"]
    print(f"{'':5s} {'wall s':>8s} {'/ cube':>7s} {'MB':>6s} {'Newton':>6s} {'factor':>6s} " + " ".join(f"{phase:>13s}" for phase in head))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name in options.names:
            row = study(build / "bin/lacon", name, pathlib.Path(folder), options.threads)
            row["ratio"] = row["wall"] / machine["factorisation_seconds"]
            rows.append(row)
            print(f"{name:5s} {row['wall']:8.2f} {row['ratio']:7.2f} {row['memory']:6.0f} {row['iterations']:6d} {row['factorisations']:6d} " +
                  " ".join(f"{row['phases'].get(phase, 0.0):13.2f}" for phase in head), flush=True)
    if options.json:
        options.json.write_text(json.dumps({"machine": machine, "threads": options.threads, "studies": rows}, indent=1))


if __name__ == "__main__":
    main()
