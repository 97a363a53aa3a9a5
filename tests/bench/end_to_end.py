#!/usr/bin/env python3
"""Times whole studies of two stacked blocks, and their parts. No assertion: figures for people.

usage: end_to_end.py BUILD [NAME ...]      BUILD: build/release, with the target benches; NAME: H1 to H6 flat, H1c to H6c curved, T2, T3c
                                           (tetrahedra, from LACON_SHARED_BENCH); by default H1 H2 H1c H2c
       --all            every one but H5 and H6
       --threads 1 2    of Lacon, one run each; by default 1
       --engine PETSC   of SOLVEUR, in place of MUMPS
       --mpi N          processes that solve linear systems, by default those that a user gets; there is no --docs with it or PETSC. Where there
                        are several, memory is that of the largest process
       --parts          the Google Benchmarks, start_up.py and cutting.py as well (--all: 5 million cells too)
       --no-calculix    even where ccx is installed (Debian: calculix-ccx), leave it out
       --patience N     it gets N times the time of Lacon, by default 20; but at least two minutes, and at most ten
       --json FILE      everything that was measured
       --docs           put it into docs/performance.json, in place of older figures of the same studies, and write the tables and the chart of
                        docs/performance.md anew from there

Times are also given as multiples of the factorisation of a cube of 32^3 HEXA8 by MUMPS, and rates as parts of dgemm and of a copy of memory, all
measured in the same run (bench_machine).
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "commands/studies"), str(SOURCE / "commands")]

import calculix  # noqa: E402
import tables  # noqa: E402
from meshes import brick, union, write_med  # noqa: E402
from results import MeshOfBase, Result, identifier_of  # noqa: E402

#: cells along the sides of the bottom block, its height, the same of the top block
SIZES = {"H1": (15, 8, 12, 6), "H2": (26, 14, 21, 12), "H3": (38, 20, 31, 17), "H4": (48, 26, 39, 22),
         "H5": (71, 38, 58, 32), "H6": (103, 55, 84, 46)}
#: these and their curved ones belong to --all; H5 and H6 are for iterations: a million equations, and three
OF_ALL = ("H1", "H2", "H3", "H4")
CURVATURE, PUSH = 0.002, 0.0011
#: unstructured tetrahedra come from files
MESHES = pathlib.Path(os.environ.get("LACON_SHARED_BENCH", SOURCE.parent / "shared/bench")) / "meshes"
NAMES = (*SIZES, *(f"{name}c" for name in SIZES), "T2", "T3c")
ALL = (*OF_ALL, *(f"{name}c" for name in OF_ALL), "T2", "T3c")
PARTS = ("pairing", "cutting", "stiffness", "algebra")
#: CalculiX gets at least and at most so many seconds
SHORTEST, LONGEST = 120, 600
#: seconds after which the yardsticks are measured again
STALE = 300


def is_curved(name):
    return name.endswith("c")


def two_blocks(name, kind="HEXA8"):
    """The mesh of a name of SIZES, with a `c` behind it for the curved skin."""
    nb, mb, nt, mt = SIZES[name.rstrip("c")]
    curvature = CURVATURE if is_curved(name) else 0.0

    def above(x, y, z):
        return x, y, z + (1.0 - z) / 0.5 * curvature * (x * x + y * y)

    def lines(n, m, z0):
        return [np.linspace(0.0, 1.0, n + 1)] * 2 + [np.linspace(z0, z0 + 0.5, m + 1)]

    bottom = brick(kind, lines(nb, mb, 0.0), name="VBOT",
                   sides={(0, 0): "XB", (1, 0): "YB", (2, 0): "BASE", (2, 1): "CBOT"})
    top = brick(kind, lines(nt, mt, 0.5), place=above, name="VTOP",
                sides={(0, 0): "XT", (1, 0): "YT", (2, 0): "CTOP", (2, 1): "TOP"})
    return union([bottom, top])


def mesh_file(name, folder):
    """The MED file of a study, or None where it is not there."""
    if name.rstrip("c") not in SIZES:
        path = MESHES / f"{name.lower()}.med"
        return path if path.is_file() else None
    path = folder / f"{name}.med"
    if not path.exists():
        write_med(path, two_blocks(name))
    return path


def study(lacon, name, folder, threads, engine, ranks):
    """One run of a study; its base stays in the folder. @param engine METHODE of SOLVEUR @param ranks processes that solve, or None  @return what tables.py shows of it"""
    mesh, base, report = mesh_file(name, folder), folder / f"{name}.base", folder / "run.json"
    environment = {**os.environ, "BLOCKS_FLAT": "0" if is_curved(name) else "1", "BLOCKS_DZ": str(PUSH),
                   "BLOCKS_ENGINE": engine}
    command = [lacon, SOURCE / "tests/bench/two_blocks.comm", "--fresh", "--unit", f"20={mesh}", "--base", base, "--json", report,
               "--threads", threads, *(("--mpi", ranks) if ranks else ())]
    start = time.perf_counter()
    with open(folder / "output", "w+", encoding="utf-8") as output:
        process = subprocess.Popen([str(word) for word in command], env=environment, stdout=output, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)  # with the largest memory of the operators that it waited for
        wall = time.perf_counter() - start
        output.seek(0)
        said = output.read()
    process.returncode = os.waitstatus_to_exitcode(status)
    if status:
        sys.exit(f"{name}: exit status {process.returncode}\n{said[-3000:]}")
    commands = json.loads(report.read_text())["timings"]["commands"]
    solved = next(c for c in commands if c["command"] == "STAT_NON_LINE")
    result = Result(base, "RESULT")
    pressures = result.where_present("DEPL", result.orders[-1], "LAGS_C")
    return {"name": name, "threads": threads, "wall": wall, "memory": usage.ru_maxrss / 1024,
            "equations": 3 * len(result.points) + len(result.patches), "counts": solved["counts"], "phases": phases_of(commands, wall),
            "io": files_of(commands, base, mesh), "force": float(result.parameter("zone_1_slave_force_z")[-1]),
            "pressures": [-float(pressures.max()), -float(pressures.min())]}


def iterations_of(row):
    """In words, of the linear solver; nothing of one that makes factors."""
    counts = row["counts"]
    return f", {counts['iterations of PETSc']:.0f} iterations in {counts['solutions']:.0f} solutions" if "iterations of PETSc" in counts else ""


def phases_of(commands, wall):
    """Seconds of every phase of a run, which sum up to the whole."""
    meshing = ("LIRE_MAILLAGE", "MODI_MAILLAGE", "CREA_MAILLAGE")
    seconds = {"launcher": wall - sum(c["operator"] for c in commands), "mesh": 0.0, "other commands": 0.0}
    for command in commands:
        if command["command"] == "STAT_NON_LINE":
            own = {phase: value for phase, value in command["phases"].items() if phase != "total"}
            seconds |= own | {"rest": command["operator"] - sum(own.values())}
        else:
            seconds["mesh" if command["command"] in meshing else "other commands"] += command["operator"]
    return seconds


def files_of(commands, base, mesh):
    """Bytes that the commands of the mesh and the archive read and wrote, and the seconds that it took them."""
    start, cut = ((base / f"{identifier_of(base, label)}.h5").stat().st_size for label in ("START", "MESH"))
    fields = sum(path.stat().st_size for path in (base / identifier_of(base, "RESULT")).iterdir())
    moved = {("LIRE_MAILLAGE", "read"): mesh.stat().st_size, ("LIRE_MAILLAGE", "write"): start, ("CREA_MAILLAGE", "read"): start,
             ("CREA_MAILLAGE", "write"): cut, ("STAT_NON_LINE", "archive"): fields}
    seconds = sum(c["phases"].get(phase, 0.0) for c in commands for command, phase in moved if c["command"] == command)
    return {"bytes": sum(moved.values()), "seconds": seconds}


def best_study(*arguments):
    """The fastest of some runs: short ones are repeated."""
    rows = [study(*arguments)]
    while len(rows) < 3 and sum(row["wall"] for row in rows) < 15:
        rows.append(study(*arguments))
    return min(rows, key=lambda row: row["wall"])


def peer(name, folder, wall, patience):
    """CalculiX on the mesh of a study that was just run. @param wall of Lacon @param patience how many times that it may take"""
    base = folder / f"{name}.base"
    mesh = MeshOfBase(base / f"{identifier_of(base, 'START')}.h5")
    found = calculix.solve(mesh, folder, PUSH if is_curved(name) else None, min(max(patience * wall, SHORTEST), LONGEST))
    return {"name": name, "ratio": found["seconds"] / wall, **found}


def parts(build, folder):
    """Every case of the Google Benchmarks: {"program", "name", counters}, growth rates left out."""
    rows = []
    for program in PARTS:
        executable, out = build / f"tests/bench_{program}", folder / "parts.json"
        if not executable.exists():
            print(f"bench_{program} is not there: left out (libbenchmark-dev; cmake --build --preset release --target benches)")
            continue
        subprocess.run([executable, f"--benchmark_out={out}", "--benchmark_out_format=json", "--benchmark_min_time=0.2"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        data = json.loads(out.read_text())
        yardsticks = {name: float(data["context"][name]) for name in ("dgemm_gflops", "copy_gbytes")}
        rows += [{"program": program, **yardsticks, **{key: value for key, value in case.items() if key in tables.COUNTERS},
                  "name": case["name"].partition("/min_time")[0]} for case in data["benchmarks"] if case["run_type"] == "iteration"]
    return rows


def texts(build, large):
    """What start_up.py and cutting.py print: name -> text."""
    def said(script, *arguments):
        return subprocess.run([sys.executable, SOURCE / "tests/bench" / script, build, *arguments], check=True, capture_output=True, text=True).stdout

    return {"start-up": said("start_up.py").partition("\nWhere one run")[0].strip(),
            "cutting": "\n\n".join(said("cutting.py", millions).strip() for millions in (("1", "5") if large else ("1",)))}


def machine_of(build):
    """What the machine can do now (bench_machine), and what it is."""
    program = build / "tests/bench_machine"
    if not program.exists():
        sys.exit(f"{program} is not there: cmake --build --preset release --target benches")
    done = subprocess.run([program], check=True, capture_output=True, text=True)
    with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
        models = [line.partition(":")[2].strip() for line in file if line.startswith("model name")]
    return {**json.loads(done.stdout), "processor": models[0] if models else "unknown", "cores": os.cpu_count(),
            "memory_gbytes": os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"{' '.join(NAMES)}; by default H1 H2 H1c H2c")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--threads", type=int, nargs="+", default=[1])
    parser.add_argument("--engine", choices=("MUMPS", "PETSC"), default="MUMPS")
    parser.add_argument("--mpi", type=int)
    parser.add_argument("--parts", action="store_true")
    parser.add_argument("--no-calculix", action="store_true")
    parser.add_argument("--patience", type=float, default=20)
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--docs", action="store_true")
    options = parser.parse_args()
    names = ALL if options.all else options.names or ("H1", "H2", "H1c", "H2c")
    if unknown := [name for name in names if name not in NAMES]:
        parser.error(f"{unknown[0]}: the studies are {' '.join(NAMES)}")
    if options.docs and (options.engine != "MUMPS" or options.mpi):
        parser.error("--docs: its tables are those of MUMPS")
    build = options.build.resolve()
    measured, measured_at = {"machine": machine_of(build), "studies": [], "calculix": [], "parts": [], "texts": {}}, time.monotonic()
    with_calculix = not options.no_calculix and calculix.program()
    if not with_calculix:
        print("CalculiX is left out" + ("" if options.no_calculix else ": no ccx is installed (Debian: calculix-ccx)"))
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        if options.parts:
            measured["parts"] = parts(build, folder)
            measured["texts"] = texts(build, options.all)
        for name in names:
            if not mesh_file(name, folder):
                print(f"{name} is left out: no mesh {MESHES / (name.lower() + '.med')} (LACON_SHARED_BENCH)")
                continue
            if time.monotonic() - measured_at > STALE:
                measured["machine"], measured_at = machine_of(build), time.monotonic()
            yardsticks = {key: measured["machine"][key] for key in ("factorisation_seconds", "dgemm_gflops", "copy_gbytes")}
            rows = [best_study(build / "bin/lacon", name, folder, threads, options.engine, options.mpi) for threads in options.threads]
            measured["studies"] += [{**row, "yardsticks": yardsticks} for row in rows]
            print(*(f"{name}, {row['threads']} thread(s): {row['wall']:.2f} s" + iterations_of(row) for row in rows), sep="\n", flush=True)
            if with_calculix:
                measured["calculix"].append({**peer(name, folder, rows[0]["wall"], options.patience), "yardsticks": yardsticks})
                print(f"{name}, CalculiX: {measured['calculix'][-1]['failure'] or ''} {measured['calculix'][-1]['seconds']:.2f} s", flush=True)
    if options.json:
        options.json.write_text(tables.as_json(measured), encoding="utf-8")
    if options.docs:
        tables.write_docs(SOURCE / "docs", measured)
    for section in tables.sections(measured).values():
        print("\n" + section)


if __name__ == "__main__":
    main()
