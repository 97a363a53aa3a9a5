"""Pictures of studies: the deformed bodies and the contact pressure of the slave's patches, at the instant that is pressed most."""

import numpy as np
from results import Result

BODIES = ("#dfe6ee", "#efe6d8", "#e3ecdf", "#ece1ea")
INK, PRESSURE = "#55616e", "#b3202c"


def pressures(result, order):
    """Cell -> LAGS_C of its patch, as a pressure."""
    return {cell: max(0.0, -value) for cell, value in result.on_cells("CONT_ELEM", order, "PRES").items() if np.isfinite(value)}


def pressed_most(result):
    """The order of the largest sum of pressures of patches in contact."""
    return max(result.orders[1:] or result.orders, key=lambda order: sum(pressures(result, order).values()))


def deformed(result, order):
    axes = "XYZ"[:result.points.shape[1]]
    return result.points + np.stack([result.at_nodes("DEPL", order, "D" + axis) for axis in axes], axis=1)


def vertices(kind):
    """Of a plane cell."""
    return 3 if kind.startswith("TRIA") else 4


def draw_plane(axes, study, result):
    """Bodies, and a diagram of the pressure inside the slave."""
    from matplotlib.collections import PolyCollection

    order = pressed_most(result)
    points, pressure = deformed(result, order), pressures(result, order)
    for body, colour in zip(study.materials, BODIES):
        outlines = [points[result.cells[c][1][:vertices(result.cells[c][0])]] for c in result.groups[body]]
        axes.add_collection(PolyCollection(outlines, facecolor=colour, edgecolor=INK, linewidth=0.25))
    axes.autoscale_view()
    if study.view:
        axes.set_xlim(*study.view[0])
        axes.set_ylim(*study.view[1])
    largest = max(pressure.values(), default=0.0)
    height = 0.16 * min(abs(np.diff(axes.get_xlim())[0]), abs(np.diff(axes.get_ylim())[0])) / (largest or 1.0)
    bands = []
    for cell, value in pressure.items():
        first, last = points[result.cells[cell][1][:2]]
        along = (last - first) / np.linalg.norm(last - first)
        inward = height * value * np.array([-along[1], along[0]])  # skins are oriented outward
        bands.append([first, last, last + inward, first + inward])
    axes.add_collection(PolyCollection(bands, facecolor=PRESSURE, edgecolor=PRESSURE, linewidth=0.4, alpha=0.75))
    return order, largest


def draw_space(axes, study, result):
    """The slave's skin coloured by pressure, the master's as a net over it; seen from above."""
    from matplotlib import colormaps
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    order = pressed_most(result)
    points, pressure = deformed(result, order), pressures(result, order)
    largest = max(pressure.values(), default=0.0)
    axes.computed_zorder = False
    low, high = points.max(axis=0), points.min(axis=0)
    for side, layer in (("GROUP_MA_ESCL", 1), ("GROUP_MA_MAIT", 2)):
        cells = [cell for zone in study.zones for cell in result.groups[zone[side]]]
        faces = [points[result.cells[c][1][:vertices(result.cells[c][0])]] for c in cells]
        colours = [colormaps["Reds"](pressure.get(c, 0.0) / (largest or 1.0)) for c in cells] if layer == 1 else (1, 1, 1, 0)
        axes.add_collection3d(Poly3DCollection(faces, facecolor=colours, edgecolor=INK, linewidth=0.2 if layer == 1 else 0.6, zorder=layer))
        low, high = np.minimum(low, np.min([f.min(axis=0) for f in faces], axis=0)), np.maximum(high, np.max([f.max(axis=0) for f in faces], axis=0))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    across = np.sort(high - low)[-2:]
    axes.set_box_aspect(high - low, zoom=1.3 if across[1] < 2 * across[0] else 0.9)  # a long box is cut off at its ends
    axes.view_init(40, -65)
    return order, largest


def draw(panels, path):
    """One picture of several studies side by side. @param panels (study, base folder)"""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(4.2 * len(panels), 3.6), constrained_layout=True)
    for k, (study, base) in enumerate(panels):
        result = Result(base, study.result)
        space = result.points.shape[1] == 3
        axes = figure.add_subplot(1, len(panels), k + 1, **({"projection": "3d"} if space else {"aspect": "equal"}))
        order, largest = (draw_space if space else draw_plane)(axes, study, result)
        axes.axis("off")
        axes.set_title(f"{study.name}\nstep {result.instants[order]:g}, largest pressure {largest:.4g}", fontsize=7, color=INK)
    figure.savefig(path, dpi=90)
    plt.close(figure)
