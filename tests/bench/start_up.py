#!/usr/bin/env python3
"""What a small study costs: wall time of whole runs of the launcher, and where it goes. No assertion: figures for people.

usage: start_up.py BUILD [runs]      BUILD: build/release

Prints, for ten Python-side commands and for a 2D contact study of a few hundred cells (read, cut, solve, checks), the best and the
median wall time, and their ratio to a bare `python3 -c "import numpy, h5py"` measured in the same run.
"""

import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "commands/studies"), str(SOURCE / "tests/verification")]


def wall(command, runs, **options):
    """Wall times of some runs of a command, seconds, ascending."""
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        subprocess.run([str(part) for part in command], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **options)
        times.append(time.perf_counter() - start)
    return sorted(times)


def main():
    import os

    import patch
    from meshes import write_med

    build = pathlib.Path(sys.argv[1]).resolve()
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 10
    lacon = build / "bin/lacon"
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        write_med(folder / "patch.med", patch.patch_mesh("TRIA3", "QUAD4"))
        ten = folder / "ten.comm"
        ten.write_text("DEBUT()\n" + "".join(f"M{i} = DEFI_MATERIAU(ELAS=_F(E=1.0, NU=0.0))\n" for i in range(8)) + "FIN()\n")
        parameters = {"PATCH_COUNT": "1", "PATCH_PRESSURE": "25.0", "PATCH_LOWER": "2000.0,0.3", "PATCH_JACOBIAN": "INITIAL", "PATCH_MODEL": "D_PLAN",
                      "PATCH_TOLERANCE": "1e-10"}
        study = [lacon, SOURCE / "tests/verification/patch_test.comm", "--unit", f"20={folder / 'patch.med'}", "--base", folder / "s.base",
                 "--fresh"]
        environment = {**os.environ, **parameters}
        interpreter = lacon.read_text().splitlines()[0].removeprefix("#!")
        rows = [("python3 with numpy and h5py", wall([interpreter, "-c", "import numpy, h5py"], runs)),
                ("ten Python-side commands", wall([lacon, ten, "--fresh"], runs)),
                ("contact study, 2D", wall(study, runs, env=environment))]
        reference = rows[0][1][0]
        print(f"{'wall time of ' + str(runs) + ' runs, seconds':34s} {'best':>8s} {'median':>8s} {'best / bare Python':>20s}")
        for name, times in rows:
            print(f"{name:34s} {times[0]:8.3f} {statistics.median(times):8.3f} {times[0] / reference:20.1f}")
        print("\nWhere one run of the study spends it:")
        done = subprocess.run([*map(str, study), "--timings"], env=environment, capture_output=True, text=True, check=True)
        print(done.stdout[done.stdout.index("Timings"):])


if __name__ == "__main__":
    main()
