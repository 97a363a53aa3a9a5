"""What came out: report.py BASE NAME prints the contact of every step beside Hertz' theory and draws NAME.png."""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from geometry import INNER, OUTER, ROLLER, hertz  # noqa: E402
from results import Result  # noqa: E402

#: slave skin -> (words, 1/R1 + 1/R2)
ZONES = {"ROLLER_TOP": ("roller against the hollow outer ring", 1 / ROLLER - 1 / OUTER),
         "INNER_SKIN": ("roller against the bulging inner ring", 1 / ROLLER + 1 / INNER)}


class Zone:
    """The patches of a slave skin from left to right: .middle, .length (n), the sub-cells of each."""

    def __init__(self, result, group):
        members = set(result.groups[group].tolist())
        self.result = result
        self.patches = [p for p in result.patches if p[0] in members]
        ends = np.array([[result.points[result.cells[c][1][:2]] for c in (p[0], p[-1])] for p in self.patches])
        ends = ends.reshape(len(self.patches), 4, 2)
        self.middle = (ends[..., 0].min(axis=1) + ends[..., 0].max(axis=1)) / 2
        self.width = np.ptp(ends[..., 0], axis=1)  # the pressure's vertical part acts on the length seen from above
        order = np.argsort(self.middle)
        self.patches = [self.patches[i] for i in order]
        self.middle, self.width = self.middle[order], self.width[order]

    def pressure(self, order):
        values = self.result.on_cells("CONT_ELEM", order, "PRES")
        return np.array([-values[p[0]] for p in self.patches])

    def active(self, order):
        values = self.result.on_cells("CONT_ELEM", order, "CONT")
        return np.array([values[p[0]] == 1 for p in self.patches])


def summary(result):
    for group, (words, curvature) in ZONES.items():
        zone = Zone(result, group)
        print(f"\n{group}, {words}: {len(zone.patches)} patches; Hertz for the force that was found")
        print("  instant  active     force   largest pressure, MPa      half-width, mm")
        print("          patches      N/mm    found   Hertz  differ     found          Hertz")
        for order in result.orders[1:]:
            pressure, active = zone.pressure(order), zone.active(order)
            if not active.any():
                print(f"  {result.instants[order]:7.3f} {0:7d}  open")
                continue
            force = float(pressure @ zone.width)
            half, largest = hertz(force, curvature)
            found = zone.width[active].sum() / 2
            print(f"  {result.instants[order]:7.3f} {active.sum():7d} {force:9.2f} {pressure.max():8.2f} {largest:7.2f} "
                  f"{100 * (pressure.max() / largest - 1):+6.2f}% {found:8.3f} +-{zone.width[active].max() / 2:5.3f} {half:8.3f}")


# ---------------------------------------------------------------------------------------------------- the picture

#: triangles of a cell, by its nodes
TRIANGLES = {"TRIA3": [(0, 1, 2)], "QUAD4": [(0, 1, 2), (0, 2, 3)],
             "TRIA6": [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
             "QUAD8": [(0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 7), (5, 6, 7)]}
BODIES = ("OUTER", "ROLLER", "INNER")
INK, PALE = "#1d2733", "#8c98a5"


def von_mises(result, order):
    xx, yy, zz, xy = (result.at_nodes("SIEF_NOEU", order, c) for c in ("SIXX", "SIYY", "SIZZ", "SIXY"))
    return np.sqrt(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * xy**2)


def draw_bodies(axes, result, points, stress, largest, lines):
    """The deformed bodies, coloured by stress. @param lines width of the cells' outlines"""
    from matplotlib.collections import PolyCollection

    for body in BODIES:
        triangles, outlines = [], []
        for c in result.groups[body]:
            kind, nodes = result.cells[c]
            if kind in TRIANGLES:
                triangles += [[nodes[i] for i in t] for t in TRIANGLES[kind]]
                n = 3 if kind.startswith("TRIA") else 4
                outlines.append(nodes[:n])
        image = axes.tripcolor(points[:, 0], points[:, 1], np.array(triangles), stress, shading="gouraud", cmap="turbo", vmin=0,
                               vmax=largest, rasterized=True)
        if lines:
            axes.add_collection(PolyCollection([points[o] for o in outlines], facecolor="none", edgecolor="k", linewidth=lines, alpha=0.35))
    axes.set_aspect("equal")
    return image


def draw(result, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.patches import Rectangle

    plt.rcParams.update({"font.size": 9, "axes.edgecolor": PALE, "text.color": INK, "axes.labelcolor": INK, "xtick.color": INK,
                         "ytick.color": INK, "axes.titlesize": 10})
    last = result.orders[-1]
    points = result.points + np.column_stack([result.at_nodes("DEPL", last, c) for c in ("DX", "DY")])
    stress = von_mises(result, last)
    largest = float(np.ceil(stress.max() / 20) * 20)
    figure = plt.figure(figsize=(12, 8.4), facecolor="white")
    grid = figure.add_gridspec(2, 3, width_ratios=(1.25, 1, 1.05), left=0.04, right=0.98, top=0.885, bottom=0.075, wspace=0.22, hspace=0.24)
    whole = figure.add_subplot(grid[:, 0])
    image = draw_bodies(whole, result, points, stress, largest, 0.08)
    whole.set_xlim(-15.2, 15.2)
    whole.set_ylim(-25, 23)
    whole.axis("off")
    bar = figure.colorbar(image, ax=whole, orientation="horizontal", fraction=0.03, pad=0.01, aspect=34)
    bar.set_label("von Mises stress, MPa")
    bar.outline.set_visible(False)
    for text, x, y in (("outer ring\nsteel, TRIA6", -11, 16), ("roller\npolymer, QUAD8", 5.2, 0), ("inner ring\nsteel, QUAD4", -8.5, -18)):
        whole.text(x, y, text, color="white", ha="center", va="center", fontsize=8, weight="bold")
    for row, (group, (words, curvature)) in enumerate(ZONES.items()):
        zone = Zone(result, group)
        centre = points[[n for p in zone.patches for c in p for n in result.cells[c][1]], 1].max()
        near = figure.add_subplot(grid[row, 1])
        draw_bodies(near, result, points, stress, largest, 0.25)
        near.set_xlim(-2.1, 2.1)
        near.set_ylim(centre - 1.9, centre + 1.9)
        near.set_title(words)
        near.set_xticks([-2, -1, 0, 1, 2])
        near.set_yticks([])
        near.set_xlabel("x, mm" if row else "")
        whole.add_patch(Rectangle((-2.1, centre - 1.9), 4.2, 3.8, fill=False, edgecolor="white", linewidth=1.2))
        draw_pressure(figure.add_subplot(grid[row, 2]), result, zone, curvature, row == 1)
    figure.text(0.04, 0.955, "A polymer roller squeezed between the rings of a bearing", fontsize=15, weight="bold")
    figure.text(0.04, 0.922, "plane strain, three bodies whose meshes do not match, two contacts by the LAC method: "
                "one pressure for each patch of the slave skin", fontsize=10, color="#55616e")
    figure.savefig(path, dpi=110)


def draw_pressure(axes, result, zone, curvature, last_row):
    """Pressure of patches as steps, Hertz' ellipse for the same force as a line, for every second step."""
    import matplotlib.pyplot as plt

    shown = result.orders[2::2]
    edges = np.append(zone.middle - zone.width / 2, zone.middle[-1] + zone.width[-1] / 2)
    for order, colour in zip(shown, plt.cm.viridis(np.linspace(0.8, 0.1, len(shown)))):
        pressure = zone.pressure(order)
        if not pressure.any():
            continue
        force = float(pressure @ zone.width)
        half, largest = hertz(force, curvature)
        x = np.linspace(-half, half, 400)
        axes.stairs(pressure, edges, color=colour, linewidth=1.4, label=f"{force:.0f} N/mm")
        axes.plot(x, largest * np.sqrt(np.maximum(0, 1 - (x / half) ** 2)), color=INK, linewidth=0.9, linestyle=(0, (4, 2)))
    axes.plot([], [], color=INK, linewidth=0.9, linestyle=(0, (4, 2)), label="Hertz")
    axes.set_xlim(-1.05, 1.75)
    axes.set_xticks([-1, -0.5, 0, 0.5, 1])
    axes.set_ylim(0, None)
    axes.set_title("contact pressure, MPa")
    axes.set_xlabel("x, mm" if last_row else "")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=8.5, loc="upper right", handlelength=1.4)


if __name__ == "__main__":
    study = Result(sys.argv[1], "RESU")
    summary(study)
    draw(study, f"{sys.argv[2]}.png")
