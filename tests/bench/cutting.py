#!/usr/bin/env python3
"""What cutting a large mesh costs, against plain HDF5 on the same files. No assertion: figures for people.

usage: cutting.py BUILD [millions] [runs]      BUILD: build/release

Makes a box of HEXA8 (a million of them, or so many) with a slave skin on its largest side and cuts it both ways: the tool
`crea_maillage IN OUT --slave SKIN` on MED files, and the operator of CREA_MAILLAGE on the base of a study. The tool cuts a box of as many
TETRA4 too. Each is compared with a bare h5py program that reads every array of its input and writes every array of its output. LIRE_MAILLAGE and IMPR_RESU of the study are there
too. Every run writes a new file. Prints the best wall and processor time of some runs, their ratio, and the peak memory. Times are of
the whole process, but of h5py without the start of Python; what starting the tool alone takes is a line of its own.
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
side, layers = map(int, sys.argv[3:5])
write_med(sys.argv[2], cubes((side, side, layers), "BODY", {(2, 1): "TOP", (2, 0): "BASE"}, kind=sys.argv[5]))
"""


STUDY = """
DEBUT()
WHOLE = LIRE_MAILLAGE(UNITE=20)
MESH = CREA_MAILLAGE(MAILLAGE=WHOLE, DECOUPE_LAC=_F(GROUP_MA_ESCL="TOP"))
IMPR_RESU(UNITE=80, RESU=_F(MAILLAGE=MESH))
FIN()
"""


def plain(source, out, copy):
    """(wall, processor) seconds of reading `source` and writing what is in `out` with h5py."""
    copy.unlink(missing_ok=True)
    done = subprocess.run([sys.executable, "-c", PLAIN, source, out, copy], capture_output=True, text=True, check=True)
    return tuple(map(float, done.stdout.split()))


def run(command, out, status, fails=False):
    """((wall, processor) seconds, peak memory in bytes, seconds of its phases) of a program that writes `out`."""
    out.unlink(missing_ok=True)
    start = time.perf_counter()
    process = subprocess.Popen([*command, "--status", status], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, code, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    if bool(code) != fails:
        raise SystemExit(f"{' '.join(map(str, command))} failed")
    return (wall, usage.ru_utime + usage.ru_stime), usage.ru_maxrss * 1024, json.loads(status.read_text())["seconds"]


def best(rows):
    """The least wall and the least processor time."""
    return tuple(min(times[k] for times in rows) for k in (0, 1))


def compare(name, command, source, out, folder, runs):
    """Print what a program takes beside h5py."""
    programs, bare = [], []
    for _ in range(runs):
        programs.append(run(command, out, folder / "status.json"))
        bare.append(plain(source, out, folder / "copy.h5"))
    sizes = [path.stat().st_size / 1e6 for path in (source, out)]
    ours, theirs = best([p[0] for p in programs]), best(bare)
    phases = min((p[2] for p in programs), key=lambda seconds: seconds["total"])
    print(f"{name:28s} {sizes[0]:7.0f} {sizes[1]:7.0f} {ours[0]:8.3f} {theirs[0]:8.3f} {ours[0] / theirs[0]:6.2f} {ours[1]:10.3f} {theirs[1]:8.3f}"
          f" {ours[1] / theirs[1]:6.2f} {max(p[1] for p in programs) / 1e6:7.0f}  "
          + ", ".join(f"{phase} {seconds:.3f}" for phase, seconds in phases.items()))


def make_box(file, cells, kind, in_a_cube):
    """Write a box of about `cells` cells, `in_a_cube` in each of its cubes. @return what is in it, for people"""
    side = round((cells / in_a_cube) ** (1 / 3))
    layers = round(cells / in_a_cube / side**2)
    # in a process of its own: a child's peak memory starts from its parent's
    subprocess.run([sys.executable, "-c", MAKE, SOURCE / "commands/studies", file, str(side), str(layers), kind], check=True)
    return f"{in_a_cube * side**2 * layers} {kind}, {side**2} squares of the slave skin"


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    millions = float(sys.argv[2]) if len(sys.argv) > 2 else 1.0
    runs = int(sys.argv[3]) if len(sys.argv) > 3 else 3
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        boxes = [make_box(folder / "in.med", millions * 1e6, "HEXA8", 1), make_box(folder / "tetra.med", millions * 1e6, "TETRA4", 6)]
        binaries, base = build / "bin", folder / "study.base"
        (folder / "study.comm").write_text(STUDY)
        subprocess.run([binaries / "lacon", folder / "study.comm", "--base", base, "--unit", f"20={folder / 'in.med'}", "--unit", f"80={folder / 'out.med'}"],
                       env={**os.environ, "LACON_ORDERS": str(folder)}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        orders = {path.name.split(".")[0][4:]: path for path in folder.glob("*.order.json")}
        print(f"{'; '.join(boxes)}\nbest of {runs} runs; MB, seconds; phases: wall")
        print(f"{'':28s} {'in':>7s} {'out':>7s} {'wall':>8s} {'h5py':>8s} {'ratio':>6s} {'processor':>10s} {'h5py':>8s} {'ratio':>6s} {'peak':>7s}")
        med, cut_med = folder / "in.med", folder / "out.med"
        meshes = [base / json.loads(orders[name].read_text())["result"]["id"] for name in ("lire_maillage", "crea_maillage")]
        whole, cut = (path.with_suffix(".h5") for path in meshes)
        compare("crea_maillage IN OUT", [binaries / "crea_maillage", med, cut_med, "--slave", "TOP"], med, cut_med, folder, runs)
        for name, source, out in (("lire_maillage", med, whole), ("crea_maillage", whole, cut), ("impr_resu", cut, cut_med)):
            compare(name.upper(), [binaries / name, orders[name]], source, out, folder, runs)
        compare("crea_maillage, TETRA4", [binaries / "crea_maillage", folder / "tetra.med", cut_med, "--slave", "TOP"], folder / "tetra.med",
                cut_med, folder, runs)
        starts = [run([binaries / "crea_maillage", folder / "none.med", cut_med, "--slave", "TOP"], cut_med, folder / "status.json", fails=True)[0]
                  for _ in range(runs)]
        print(f"{'start of the tool alone':28s} {'':15s} {best(starts)[0]:8.3f} {'':15s} {best(starts)[1]:10.3f}")


if __name__ == "__main__":
    main()
