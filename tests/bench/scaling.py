#!/usr/bin/env python3
"""Counts what processes of PETSc do and say to each other on two stacked blocks, as they become more: figures for people, and a model of
many from them.

usage: scaling.py BUILD
       --ranks 1 2 4 8 16   processes, more than there are cores too: what is counted does not depend on the time that they take
       --strong H2          the study that all of them share
       --json FILE          everything that was counted

Weak scaling: some 11 000 equations a process. Counts are those of PETSc's -log_view, of the whole study; memory is the largest share
(PSS) of a process, looked at while it runs.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "commands/studies"), str(SOURCE / "commands")]

import end_to_end  # noqa: E402
from end_to_end import PUSH, two_blocks  # noqa: E402
from meshes import write_med  # noqa: E402
from results import Result  # noqa: E402

#: processes -> cells of the two blocks (as SIZES of end_to_end.py): 11 thousand equations each
WEAK = {1: (15, 8, 12, 6), 2: (19, 10, 15, 8), 4: (24, 13, 19, 10), 8: (30, 16, 24, 13), 16: (38, 20, 31, 17)}
#: stages of lacon_petsc: a preconditioner is made, iterations are done
STAGES = ("set up", "solve")


def counted(text, ranks):
    """What a summary of -log_view says of each of STAGES, average of a process: name -> {"flops", "messages", "bytes", "reductions"}; and "ratio", of
    the most operations of a process over the fewest."""
    number = r"([\d.eE+-]+)"
    rows = {"ratio": float(re.search(rf"^Flops:\s+{number}\s+{number}", text, re.MULTILINE)[2])}
    for stage in STAGES:
        line = re.search(rf"^\s*\d+:\s+{stage}: (.*)$", text, re.MULTILINE)
        # seconds, operations, messages of all, length of a message, reductions of one; shares behind each
        _, flops, messages, length, reductions = (float(value) for value in re.findall(rf"{number}\s+[\d.]+%", line[1]))
        rows[stage] = {"flops": flops / ranks, "messages": messages / ranks, "bytes": messages * length / ranks, "reductions": reductions}
    return rows


def share_of(pid):
    """Memory of a process, and its share of what it has with others (PSS), MB; 0 where it has ended."""
    try:
        return int(re.search(r"^Pss:\s+(\d+)", pathlib.Path(f"/proc/{pid}/smaps_rollup").read_text(), re.MULTILINE)[1]) / 1024
    except (OSError, TypeError):
        return 0.0


class Watch(threading.Thread):
    """Looks twice a second at the memory of the programs of one run, which have `mark` in their environment."""

    def __init__(self, mark):
        super().__init__(daemon=True)
        self.mark, self.done, self.largest = mark.encode(), threading.Event(), {"lacon_petsc": 0.0, "stat_non_line": 0.0}

    def run(self):
        while not self.done.wait(0.5):
            for folder in pathlib.Path("/proc").glob("[0-9]*"):
                try:
                    name = (folder / "comm").read_text().strip()
                    if name in self.largest and self.mark in (folder / "environ").read_bytes():
                        self.largest[name] = max(self.largest[name], share_of(folder.name))
                except OSError:
                    continue


def run(build, folder, cells, ranks):
    """One study. @param cells as SIZES of end_to_end.py @return what was counted"""
    end_to_end.SIZES["scaled"] = cells
    mesh, log, report = folder / "scaled.med", folder / "log", folder / "run.json"
    write_med(mesh, two_blocks("scaled"))
    log.unlink(missing_ok=True)
    mark = f"LACON_SCALING_MARK={os.getpid()}_{ranks}"
    environment = {**os.environ, "BLOCKS_FLAT": "1", "BLOCKS_DZ": str(PUSH), "BLOCKS_ENGINE": "PETSC", "LACON_PETSC_OPTIONS": f"-log_view :{log}",
                   **dict([mark.split("=")])}
    watch = Watch(mark)
    watch.start()
    start = time.perf_counter()
    done = subprocess.run([build / "bin/lacon", SOURCE / "tests/bench/two_blocks.comm", "--fresh", "--unit", f"20={mesh}", "--base",
                           folder / "base", "--json", report, "--threads", "1", "--mpi", str(ranks)],
                          env=environment, capture_output=True, text=True, check=False)
    wall = time.perf_counter() - start
    watch.done.set()
    watch.join()
    if done.returncode:
        sys.exit(f"{ranks} processes: exit status {done.returncode}\n{done.stdout[-3000:]}")
    solved = next(c for c in json.loads(report.read_text())["timings"]["commands"] if c["command"] == "STAT_NON_LINE")
    counts = solved["counts"]
    result = Result(folder / "base", "RESULT")
    return {"ranks": ranks, "equations": 3 * len(result.points) + len(result.patches), "wall": wall, "iterations": counts["iterations of PETSc"],
            "solutions": counts["solutions"], "preconditioners": counts["preconditioners of PETSc"], "phases": solved["phases"], "memory": watch.largest,
            **counted(log.read_text(), ranks)}


def table(rows):
    """@return lines of Markdown: what a process does and says in an iteration, and while a preconditioner is made"""
    lines = ["| processes | equations of one | iterations | Mflop | messages | kB | reductions | most over fewest Mflop | set up: Mflop | messages | kB | MB of a process | of the operator |",
             "|" + "---|" * 13]
    for row in rows:
        cells = [row["ranks"], f"{row['equations'] / row['ranks']:.0f}", f"{row['iterations'] / row['solutions']:.1f}"]
        for stage, times in (("solve", row["iterations"]), ("set up", row["preconditioners"])):
            each = {name: value / times for name, value in row[stage].items()}
            cells += [f"{each['flops'] / 1e6:.1f}", f"{each['messages']:.0f}", f"{each['bytes'] / 1024:.0f}"]
            cells += [f"{each['reductions']:.1f}", f"{row['ratio']:.2f}"] if stage == "solve" else []
        cells += [f"{row['memory'][name]:.0f}" for name in ("lacon_petsc", "stat_non_line")]
        lines.append("| " + " | ".join(map(str, cells)) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--ranks", type=int, nargs="+", default=sorted(WEAK))
    parser.add_argument("--strong", choices=sorted(end_to_end.SIZES), default="H2")
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    if unknown := [n for n in options.ranks if n not in WEAK]:
        parser.error(f"--ranks {unknown[0]}: there are studies for {', '.join(map(str, sorted(WEAK)))} processes")
    build, found = options.build.resolve(), {}
    with tempfile.TemporaryDirectory() as folder:
        for kind, cells in (("strong", None), ("weak", WEAK)):
            found[kind] = []
            for ranks in options.ranks:
                found[kind].append(run(build, pathlib.Path(folder), cells[ranks] if cells else end_to_end.SIZES[options.strong], ranks))
                print(f"{kind}, {ranks} process(es): {found[kind][-1]['wall']:.0f} s", flush=True)
    if options.json:
        options.json.write_text(json.dumps(found, indent=1), encoding="utf-8")
    for kind, rows in found.items():
        print(f"\n{kind}, in an iteration\n\n{table(rows)}")


if __name__ == "__main__":
    main()
