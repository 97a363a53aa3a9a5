"""Orders of convergence of the manufactured solutions (the peer's ssnp150 and ssnv219), on one mesh more than the peer computes."""

import re

import numpy as np
import peer_checks
from study_test import PEER_MESHES

#: case -> (cells, number of meshes)
CASES = {"ssnp150c": ("TRIA3", 7), "ssnp150f": ("QUAD8", 7), "ssnv219e": ("TETRA4", 6), "ssnv219g": ("HEXA8 cut in HEXA8", 6),
         "ssnv219i": ("HEXA27", 5), "ssnv219k": ("HEXA20 cut in PYRAM13", 5), "ssnv219l": ("PENTA6", 6)}


def errors_of(output, case):
    """L2 norms of the errors of displacement and pressure of each mesh, from what the command file printed."""
    found = re.search(rf"^ERRORS {case} (\[.*?\]) (\[.*?\])$", output, re.MULTILINE)
    return [[float(value) for value in text.strip("[]").split(",")] for text in found.groups()]


def run(runner, case, comms_folder):
    """The errors of a case."""
    comms, meshes = peer_checks.files(case)
    units = {**{unit: PEER_MESHES / mesh for unit, mesh in meshes.items()}, **{unit: runner.folder / f"out.{unit}" for unit in (29, 33, 40, 80)}}
    done = runner.run_lacon(*(comms_folder / comm for comm in comms), "--fresh", "--base", runner.folder / "orders.base",
                            *(word for unit, path in units.items() for word in ("--unit", f"{unit}={path}")), CASE=case, MESHES=str(CASES[case][1]))
    return errors_of(done.stdout, case)


def orders(errors):
    return [float(np.log2(a / b)) for a, b in zip(errors, errors[1:])]


def plot(results, path):
    """Errors against the width of the meshes, both on logarithmic axes. @param results case -> (errors of displacement, of pressure)"""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(11, 4.5), constrained_layout=True)
    for place, title, slopes in ((0, "displacement", (2, 3)), (1, "pressure", (1, 2))):
        for case, errors in results.items():
            width = 0.5 ** np.arange(len(errors[place]))
            axes[place].loglog(width, errors[place], "o-", markersize=3, label=f"{case}, {CASES[case][0]}")
        for slope in slopes:
            width = np.array([1 / 64, 1 / 4])
            axes[place].loglog(width, 0.3 * min(e[place][2] for e in results.values()) * (width / width[1]) ** slope, "k:", linewidth=1)
            axes[place].annotate(f"{slope}", (width[0], 0.3 * min(e[place][2] for e in results.values()) * (width[0] / width[1]) ** slope))
        axes[place].set(xlabel="h", ylabel=f"error of the {title}, L2")
    axes[0].legend(fontsize=7)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def rows(results):
    """Lines of a table: the orders between successive meshes, and between the peer's last two what it finds and accepts."""
    lines = []
    for case, errors in results.items():
        for parameter, name, found in zip(("PU", "PP"), ("U", "pressure"), errors):
            check = next(row for row in peer_checks.rows(case) if row["component"] == parameter)
            reference, share = float(check["vale_refe"]), float(check["precision"])
            own = orders(found)[CASES[case][1] - 3]
            low, high = max(0.0, reference * (1 - share)), reference * (1 + share)
            lines.append([case, CASES[case][0], name, ", ".join(f"{order:.2f}" for order in orders(found)), f"{own:.4f}",
                          f"{float(check['vale_calc']):.4f}", f"{low:.3f} to {high:.3f}", "yes" if low <= own <= high else "no"])
    return lines
