"""The chapter of the verification book: the table before and now, and a picture for each row.

    chapter.py [FIGURES.json]    puts it into docs/verification.md, from figures that run.py has kept; without them it runs the table
"""

import json
import pathlib
import re
import shutil
import sys
import tempfile

from run import HERE, LACON, ROOT, missed, run
from studies import ROWS, studies

TITLE = "## Difficult studies"

#: row -> (words of the names of studies that are drawn)
DRAWN = {
    "hertz": ("30 QUAD8 PETIT tool", "30 QUAD8 GREEN slab"), "ironing": ("10 width 2, QUAD8 GREEN slab", "40 width 3, QUAD4 PETIT slab"),
    "overhang": ("20 QUAD4 PETIT lower", "20 QUAD8 GREEN upper"), "arch": ("x10 QUAD4 GREEN arch", "x10 QUAD8 GREEN plate"),
    "polygon": ("QUAD4 slab", "QUAD8 wheel"), "plastic": ("round 5, QUAD4 PETIT, slab", "flat 5, QUAD8 PETIT, slab"),
    "tips": ("tip QUAD4 PETIT slab", "groove QUAD8 GREEN tool", "wedge QUAD4 GREEN tool"),
    "contrast": ("1e+06 QUAD4 PETIT tool", "1e-06 QUAD4 PETIT tool"),
    "space": ("sphere HEXA8 GREEN slab", "sphere HEXA20 GREEN tool", "half-cylinder TETRA10 GREEN slab"),
    "difficult": ("die QUAD4 PETIT_REAC block", "beams QUAD8 GREEN upper", "stack AXIS QUAD8 GREEN above"),
    "corner": ("QUAD4 GREEN tool", "QUAD8 GREEN plate"), "aligned": ("D_PLAN QUAD4 4 on 6 upper", "D_PLAN QUAD8 7 on 5 lower"),
    "faces": ("4 on 6 upper",), "skins": ("larger above QUAD4 GREEN upper", "smaller above QUAD8 GREEN upper"),
    "flush": ("1 steps QUAD8 PETIT lower",), "force": ("round AXIS QUAD8 GREEN tool",), "caps": ("270 plastic 3",), "cycle": ("10 QUAD4 lower",),
}


#: why a row misses what is asked of it
REASONS = {
    "tips": "a corner passes over coarse patches of a slope: the part of a patch that it covers, and with it the gap and the status that the patch has, changes from iterate "
            "to iterate where it goes over to the next one; neither a line search on the power of the forces nor one on the gaps helps",
    "polygon": "three iterations of quadratic convergence in each of 43 steps, four or five where a corner goes over to another patch: no motion before leads "
               "there, nor does a parabola through three states (172 to 173, 175 to 176)",
    "difficult": "sliding steps of a whole cell: the prediction, with the motion imposed at one end alone, flows where the solution does not",
    "corner": "patches of the plate hold the average height of what is above them, and this changes as the tool moves along: Fx/Fy is (height at "
              "one end - height at the other) / length of the patch (0.96 with the tool's upright side in that average); the tool as slave has no such force",
}


def figures_of_table():
    """Run every study. @return name -> figures"""
    found = {}
    for row in ROWS:
        for study in studies(row):
            folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_robustness_"))
            found[f"{row}/{study.name}"] = run(study, LACON, folder)
            shutil.rmtree(folder, ignore_errors=True)
    return found


def draw_row(row, path):
    """@return whether there was something to draw"""
    from pictures import draw

    folders, panels = [], []
    for words in DRAWN.get(row, ()):
        study = next(study for study in studies(row) if all(word in study.name for word in words.split()))
        folders.append(pathlib.Path(tempfile.mkdtemp(prefix="lacon_robustness_")))
        if run(study, LACON, folders[-1])["accepted"]:
            panels.append((study, folders[-1] / "study.base"))
    if panels:
        draw(panels, path)
    for folder in folders:
        shutil.rmtree(folder, ignore_errors=True)
    return bool(panels)


def spread(values, form="{:g}"):
    low, high = min(values), max(values)
    return form.format(low) if low == high else f"{form.format(low)} to {form.format(high)}"


def summary(row, figures):
    """Cells of a table: finished of all, cuts, iterations a step and lost ones, the row's own measure."""
    found = [figures[f"{row}/{study.name}"] for study in studies(row) if f"{row}/{study.name}" in figures]
    done = [one for one in found if one["status"] == "finished"]
    measures = [key for key in ("Fx/Fy", "ripple", "lost work") if any(key in one for one in done)]
    told = "; ".join(f"{key} {spread([one[key] for one in done if key in one], '{:.1e}')}" for key in measures)
    return [f"{len(done)} of {len(found)}", sum(one["cuts"] for one in found), spread([one["iterations"] for one in done]) if done else "-",
            spread([one["per step"] for one in done], "{:.1f}") if done else "-", sum(one["lost"] for one in found), told or "-"]


def asked_of(row):
    """In words."""
    words = {"; ".join(f"{key} <= {most:g}" for key, most in study.asked.items()) for study in studies(row)}
    return " / ".join(sorted(words, key=lambda text: [float(number) for number in re.findall(r"<= ([\d.e-]+)", text)]))


def misses(row, figures):
    """A line for the studies of a row that are not as asked, none where there are none."""
    found = {name: missed(study, figures[name]) for study in studies(row) for name in [f"{row}/{study.name}"] if name in figures}
    told = [f"{name.partition('/')[2]}: {faults[0].partition(',')[0].partition(' within')[0]}" for name, faults in found.items() if faults]
    shown = "; ".join(told[:2]) + (f"; and {len(told) - 2} more" if told[2:] else "")
    return [f"* {ROWS[row][0]} ({shown}): {REASONS.get(row, 'not known')}."] if told else []


def section(figures=None):
    """The chapter's text; draws its pictures into docs/."""
    figures, before = figures or figures_of_table(), json.loads((HERE / "before.json").read_text())
    lines, pictures, missing = [], [], []
    for row, (what, _) in ROWS.items():
        if not any(name.startswith(f"{row}/") for name in figures):
            continue
        for when, known in (("before", before), ("now", figures)):
            if when == "now" and summary(row, known) == summary(row, before):
                continue
            kept = [f"{row}/{study.name}" for study in studies(row) if not missed(study, known[f"{row}/{study.name}"])]
            lines.append([what if when == "before" else "", when, *summary(row, known), len(kept), asked_of(row) if when == "before" else ""])
        missing += misses(row, figures)
        if draw_row(row, ROOT / f"docs/robustness_{row}.png"):
            pictures.append(f"![{what}](robustness_{row}.png)")
    head = ["studies", "", "finished", "cuts", "iterations of those that did", "of a step", "lost", "measured", "as asked", "asked of each"]
    table = "\n".join("| " + " | ".join(map(str, line)) + " |" for line in [head, ["---"] * len(head), *lines])
    return f"""{TITLE}

`tests/studies/robustness`: bodies that penetrate deeply, slide, have edges, flow, differ greatly in stiffness, or are held by contact alone; plane ones with both orders,
PETIT and GREEN_LAGRANGE (plastic ones PETIT and PETIT_REAC), with either side as the slave. ITER_GLOB_MAXI is 60 (the default, 10, where a force drives); all other
criteria and keywords of Newton's method are defaults. With 10 iterations for all and steps that are cut, as by default (`run.py --defaults`), all of them finish too, in 26 136 iterations and 191 lost.
An iteration is a line of the Newton table; lost ones belong to steps that were cut, restarted or
never solved, and count towards the limits. "Before": contact forces along the slave's normal, frozen; where a force drives, statuses alone move the edge of a
contact, by one patch an iteration, and a factorisation's pivots alone say what is loose; where ends are
aligned, forces jump when they pass each other, where side walls are in the zone, when these come upright, and
where ends are flush, increments are halved where residuals go round, and where curved bodies come down, more wrong statuses than
columns of the inverse are worth change once an iteration. Rows listed once have not changed since.

{table}

Not as asked, and why:

{chr(10).join(missing)}

Pictures: deformed, without magnification; red: contact pressure of the slave's patches at the instant of the largest force.

{chr(10).join(pictures)}
"""


def main():
    figures = json.loads(pathlib.Path(sys.argv[1]).read_text()) if len(sys.argv) > 1 else None
    book = ROOT / "docs/verification.md"
    text = book.read_text(encoding="utf-8")
    chapter = section(figures)
    old = re.search(rf"^{TITLE}\n.*?(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    book.write_text(text[:old.start()] + chapter + text[old.end():] if old else text.rstrip("\n") + "\n\n" + chapter, encoding="utf-8")


if __name__ == "__main__":
    main()
