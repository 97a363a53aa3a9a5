"""Runs the table of studies that are difficult for Newton's method, and says how many iterations they took.

    run.py [--only ROW[/WORD ...]] [--defaults] [--json FILE] [--before FILE] [--pictures FOLDER] [--list]

Programs are those of LACON_BIN, without it of build/release. A study is ROW/NAME; `--only "hertz/30 % QUAD8"` takes those of the row hertz
whose names hold all of these words. An iteration is a solution of the linear system; lost ones belong to steps that were cut, begun
again or never solved, and count in what is judged. What is asked of a study is in studies.py.
"""

import argparse
import dataclasses
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
for variable, folder in (("LACON_SOURCE_DIR", ROOT), ("LACON_BIN", ROOT / "build/release/bin"), ("LACON_SHARED_CASES", ROOT.parent / "shared/cases")):
    os.environ.setdefault(variable, str(folder))
sys.path[:0] = [str(HERE), str(HERE.parent)]

import numpy as np  # noqa: E402
from study_test import LACON, PATIENCE  # noqa: E402, I001 (it says where meshes.py is)
from results import Result  # noqa: E402
from studies import ROWS, Study, studies  # noqa: E402

SECONDS = 240 * PATIENCE  # of the clock, a study
SOLVED_TO_THE_END = (0, 5)  # exit status; 5: a peer's case has other digits than the peer, which is not asked here

INSTANT = re.compile(r"^ Instant de calcul:")
ITERATION = re.compile(r"^ \|\s*\d+\s*X?\s*\|")
SOLVED = re.compile(r"^ Converged at the instant")
CUT = re.compile(r"<EVOLUTION_7>")
MESSAGE = re.compile(r"<[FS]> <(\w+)> (.*)")


def count(stdout, stderr):
    """What the Newton tables of a run show. @return accepted steps, cuts, iterations, lost ones, and those of each accepted step"""
    of_steps, pending, lost = [], 0, 0
    for line in stdout.splitlines():
        if INSTANT.match(line):
            lost += pending
            pending = 0
        elif ITERATION.match(line):
            pending += 1
        elif SOLVED.match(line):
            of_steps.append(pending)
            pending = 0
    return {"accepted": len(of_steps), "cuts": len(CUT.findall(stdout + stderr)), "iterations": sum(of_steps), "lost": lost + pending,
            "of steps": of_steps}


def positions(result, group):
    """Places of the group's nodes among all nodes."""
    return sorted({node for cell in result.groups[group] for node in result.cells[cell][1]})


def measured(study, base):
    """The study's own measure of displacements and reactions of the driven group, (instants, nodes, axes) each."""
    result = Result(base, "RESU")
    at = positions(result, study.driven)
    axes = "XYZ"[:result.points.shape[1]]

    def of(name, component):
        return np.array([np.stack([result.at_nodes(name, order, component + axis)[at] for axis in axes], axis=1) for order in result.orders])

    return study.measure(list(result.instants.values()), of("DEPL", "D"), of("REAC_NODA", "D"))


def run(study, lacon, folder):
    """@return figures of a study; "status" is "finished", the message it stopped with, or "out of time" """
    arguments, environment = study.prepare(folder)
    base = folder / "study.base"
    start = time.monotonic()
    with open(folder / "out", "w") as out, open(folder / "err", "w") as err:
        process = subprocess.Popen([lacon, *arguments, "--fresh", "--base", base], cwd=folder, stdout=out, stderr=err,
                                   stdin=subprocess.DEVNULL, start_new_session=True, env={**os.environ, **environment})
        try:
            code = process.wait(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 15)
            process.wait()
            code = None
    stdout, stderr = (folder / "out").read_text(errors="replace"), (folder / "err").read_text(errors="replace")
    stopped = MESSAGE.search(stdout + stderr)
    status = "out of time" if code is None else "finished" if code in SOLVED_TO_THE_END else f"{stopped[1]}: {stopped[2]}" if stopped else f"exit status {code}"
    figures = {"status": status, "steps": study.steps, **count(stdout, stderr), "seconds": round(time.monotonic() - start, 1)}
    figures["solutions"] = figures["iterations"] + figures["lost"]
    figures["per step"] = round(figures["solutions"] / study.steps, 2)
    if code in SOLVED_TO_THE_END and study.measure:
        figures |= measured(study, base)
    alarms = sorted(set(re.findall(r"<A> <(\w+)>", stdout + stderr)))
    return {**figures, **({"alarms": alarms} if alarms else {})}


def missed(study, figures):
    """What the row asks for and the study does not give."""
    if figures["status"] != "finished":
        return [figures["status"]]
    return [f"{name} {figures[name]:.3g} > {most:g}" for name, most in study.asked.items() if figures[name] > most]


def line(name, figures, faults):
    extra = ", ".join(f"{key} {figures[key]:.2e}" for key in ("Fx/Fy", "ripple", "lost work") if key in figures)
    return (f"{name:<66} {figures['accepted']:>5} {figures['cuts']:>4} {figures['iterations']:>6} {figures['lost']:>6} {figures['per step']:>6.1f} "
            f"{figures['seconds']:>6.1f}s  {extra}{'  ' if extra else ''}{'ok' if not faults else '; '.join(faults)[:110]}")


def chosen(only):
    """(name, study) of the rows and words that were asked for; all without any."""
    wanted = [(row, words.split()) for row, _, words in (text.partition("/") for text in only)] or [(row, []) for row in ROWS]
    for row, words in wanted:
        for study in studies(row):
            if all(word in study.name for word in words):
                yield f"{row}/{study.name}", study


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", default=[], help="rows, or ROW/WORDS")
    parser.add_argument("--json", type=pathlib.Path, help="figures are added to this file, study by study")
    parser.add_argument("--before", type=pathlib.Path, default=HERE / "before.json", help="figures to compare with")
    parser.add_argument("--pictures", type=pathlib.Path, help="a folder for a picture of each study")
    parser.add_argument("--list", action="store_true", help="names alone")
    parser.add_argument("--defaults", action="store_true", help="with ITER_GLOB_MAXI=10 and steps that are cut, which are defaults, whatever the table has")
    asked = parser.parse_args()
    known = json.loads(asked.json.read_text()) if asked.json and asked.json.exists() else {}
    before = json.loads(asked.before.read_text()) if asked.before.exists() else {}
    missing = 0
    if not asked.list:
        print(f"{'study':<66} steps cuts iterat.  lost a step   time")
    for name, study in chosen(asked.only):
        if asked.list:
            print(name)
            continue
        if asked.defaults and isinstance(study, Study):
            study = dataclasses.replace(study, most=10, cut=True)
        folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_robustness_"))
        try:
            figures = run(study, LACON, folder)
            if asked.pictures and figures["accepted"]:
                from pictures import draw  # matplotlib is optional
                asked.pictures.mkdir(parents=True, exist_ok=True)
                draw([(study, folder / "study.base")], asked.pictures / (re.sub(r"[^\w.-]+", "_", name) + ".png"))
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        faults = missed(study, figures)
        missing += bool(faults)
        was = before.get(name)
        print(line(name, figures, faults) + (f"  (before: {was['iterations']} + {was['lost']})" if was else ""), flush=True)
        known[name] = figures
        if asked.json:
            asked.json.write_text("{\n" + ",\n".join(f"{json.dumps(k)}: {json.dumps(v)}" for k, v in known.items()) + "\n}\n")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
