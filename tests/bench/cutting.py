#!/usr/bin/env python3
"""What cutting a large mesh costs, against plain HDF5 on the same files. No assertion: figures for people.

usage: cutting.py BUILD [millions] [runs]      BUILD: build/release

Makes a box of HEXA8 (a million of them, or so many) with a slave skin on its largest side, runs `crea_maillage IN OUT --slave SKIN`, and
compares with a bare h5py program that reads every array of IN and writes every array of OUT. Prints the best wall and processor time of
some runs, their ratio, and the tool's peak memory.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]

PLAIN = """
import sys, time, h5py

def arrays(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.__setitem__(name, item[()]) if isinstance(item, h5py.Dataset) else None)
    return found

output = arrays(sys.argv[2])
wall, processor = time.perf_counter(), time.process_time()
arrays(sys.argv[1])
with h5py.File(sys.argv[3], "w") as file:
    for name, values in output.items():
        file[name] = values
print(time.perf_counter() - wall, time.process_time() - processor)
"""


MAKE = """
import sys
sys.path.insert(0, sys.argv[1])
from meshes import cubes, write_med
side, layers = map(int, sys.argv[3:])
write_med(sys.argv[2], cubes((side, side, layers), "BODY", {(2, 1): "TOP", (2, 0): "BASE"}))
"""


def plain(source, out, copy):
    """(wall, processor) seconds of reading and writing with h5py."""
    done = subprocess.run([sys.executable, "-c", PLAIN, source, out, copy], capture_output=True, text=True, check=True)
    return tuple(map(float, done.stdout.split()))


def tool(program, source, out, status):
    """(wall, processor) seconds of the tool, its peak memory in bytes, seconds of its phases."""
    start = time.perf_counter()
    process = subprocess.Popen([program, source, out, "--slave", "TOP", "--status", status], stdout=subprocess.DEVNULL)
    _, code, usage = os.wait4(process.pid, 0)
    if code:
        raise SystemExit(f"{program} failed")
    return (time.perf_counter() - start, usage.ru_utime + usage.ru_stime), usage.ru_maxrss * 1024, json.loads(status.read_text())["seconds"]


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    millions = float(sys.argv[2]) if len(sys.argv) > 2 else 1.0
    runs = int(sys.argv[3]) if len(sys.argv) > 3 else 3
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        side = round((millions * 1e6) ** (1 / 3))
        layers = round(millions * 1e6 / side**2)
        # in a process of its own: a child's peak memory starts from its parent's
        subprocess.run([sys.executable, "-c", MAKE, SOURCE / "commands/studies", folder / "in.med", str(side), str(layers)], check=True)
        tools = [tool(build / "bin/crea_maillage", folder / "in.med", folder / "out.med", folder / "status.json") for _ in range(runs)]
        bare = [plain(folder / "in.med", folder / "out.med", folder / "copy.h5") for _ in range(runs)]
        size = [(folder / name).stat().st_size / 1e6 for name in ("in.med", "out.med")]
        print(f"{side**2 * layers} HEXA8, {side**2} slave QUAD4; {size[0]:.0f} MB in, {size[1]:.0f} MB out; best of {runs} runs")
        print(f"{'seconds':24s} {'wall':>8s} {'processor':>10s}")
        best = [[min(times[k] for times in rows) for k in (0, 1)] for rows in ([t[0] for t in tools], bare)]
        for name, (wall, processor) in zip(("crea_maillage", "h5py, read and write"), best):
            print(f"{name:24s} {wall:8.2f} {processor:10.2f}")
        print(f"{'ratio':24s} {best[0][0] / best[1][0]:8.2f} {best[0][1] / best[1][1]:10.2f}")
        phases = min((t[2] for t in tools), key=lambda seconds: seconds["total"])
        print("phases, wall: " + ", ".join(f"{name} {seconds:.2f}" for name, seconds in phases.items()))
        print(f"peak memory {max(t[1] for t in tools) / 1e6:.0f} MB")


if __name__ == "__main__":
    main()
