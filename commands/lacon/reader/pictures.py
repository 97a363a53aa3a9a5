"""Pictures with matplotlib, of arrays alone: bodies, contact pressure, convergence. Each function returns a figure; PNG and SVG are its savefig's."""

import functools
import math

from ..core.catalog import part
from ..core.late import numpy
from ..core.messages import fail

_ink, _pale, _line = "#1d2733", "#8c98a5", "#3b4753"
_colours = "viridis"  # its order survives printing in grey and every kind of colour blindness
_contact = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")  # Okabe and Ito's, told apart by everyone
_light = (0.35, -0.45, 0.82)  # where light comes from, seen by who looks
_uniform = 1e-6  # differences below this part of the values are round-off, and no colours
_vectors = 20000  # faces beyond which an SVG holds them as an image


def _styled(draw):
    """In the house's look. @throws AsterError READER_6 where matplotlib is not installed"""
    @functools.wraps(draw)
    def drawn(*arguments, **named):
        try:
            import matplotlib  # start-up, and optional
        except ImportError:
            fail("READER_6", "lacon")
        with matplotlib.rc_context({"font.size": 9, "axes.edgecolor": _pale, "text.color": _ink, "axes.labelcolor": _ink, "axes.titlesize": 10,
                                    "xtick.color": _ink, "ytick.color": _ink, "axes.axisbelow": True, "svg.fonttype": "none"}):
            return draw(*arguments, **named)

    return drawn


def _new_figure(width, height):
    from matplotlib.figure import Figure  # optional; without pyplot no window system is asked for

    return Figure(figsize=(width, height), facecolor="white", layout="constrained")


def view(points):
    """Points of space as who looks sees them: to the right, up, towards them; y goes back, z up."""
    turn, tilt = math.radians(-35.0), math.radians(25.0)
    x, y, z = points.T
    right, back = x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)
    return numpy.column_stack([right, z * math.cos(tilt) + back * math.sin(tilt), z * math.sin(tilt) - back * math.cos(tilt)])


@_styled
def bodies(points, dimension, boundary, values=None, name="", title=""):
    """Deformed bodies with the edges of their cells. @param boundary size -> (cells, vertices) of polygons  @param values one a node, nan where none"""
    seen = points if dimension == 2 else view(points)
    polygons, colours, depth, shade = [], [], [], []
    for _, facets in boundary.values():
        corners = seen[facets]
        if dimension == 3:
            normal = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, -1] - corners[:, 0])
            front = normal[:, 2] > 0.0
            corners, facets, normal = corners[front], facets[front], normal[front]
            normal /= numpy.linalg.norm(normal, axis=1)[:, None]
            shade.append(0.72 + 0.28 * numpy.clip(normal @ numpy.array(_light), 0.0, 1.0))
            depth.append(corners[:, :, 2].mean(axis=1))
        polygons += list(corners[:, :, :2])
        if values is not None:
            with numpy.errstate(invalid="ignore"):
                colours.append(values[facets].mean(axis=1))
    order = numpy.argsort(numpy.concatenate(depth), kind="stable") if depth else numpy.arange(len(polygons))
    figure, axes = _frame(seen, title, dimension)
    collection = _collection([polygons[i] for i in order], 0.35 if len(polygons) < 4000 else 0.12)
    if values is None:
        tones = (numpy.concatenate(shade) if shade else numpy.ones(len(polygons)))[order]
        collection.set_facecolor(numpy.outer(tones, (0.84, 0.87, 0.90)))
    else:
        _colour(figure, axes, collection, numpy.concatenate(colours)[order], name, numpy.concatenate(shade)[order] if shade else None)
    axes.add_collection(collection)
    return figure


def _frame(seen, title, dimension):
    """(figure, axes) that hold these points."""
    low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
    size = numpy.maximum(high - low, 1e-3 * max((high - low).max(), 1e-300))
    figure = _new_figure(*(7.2 * numpy.clip(size / size.max(), 0.35, 1.0) + (1.2, 0.4)))
    axes = figure.add_subplot()
    axes.set_xlim(low[0] - 0.02 * size.max(), high[0] + 0.02 * size.max())
    axes.set_ylim(low[1] - 0.02 * size.max(), high[1] + 0.02 * size.max())
    axes.set_aspect("equal")
    axes.set_title(title, loc="left")
    if dimension == 3:
        axes.axis("off")
    return figure, axes


def _collection(polygons, width):
    from matplotlib.collections import PolyCollection  # optional, as matplotlib

    return PolyCollection(polygons, edgecolors=_line, linewidths=width, rasterized=len(polygons) > _vectors)


def _colour(figure, axes, collection, values, name, shade):
    """Colours with their scale; `shade` darkens faces that are turned away from the light."""
    import matplotlib  # optional

    finite = values[numpy.isfinite(values)]
    low, high = (finite.min(), finite.max()) if len(finite) else (0.0, 1.0)
    if high - low <= _uniform * max(abs(low), abs(high)):  # one value and round-off
        low, high = (min(0.0, low), max(0.0, high)) if low or high else (0.0, 1.0)
    norm = matplotlib.colors.Normalize(low, high)
    mapped = matplotlib.colormaps[_colours]
    colours = mapped(norm(values))
    colours[~numpy.isfinite(values)] = (0.85, 0.85, 0.85, 1.0)
    if shade is not None:
        colours[:, :3] *= shade[:, None]
    collection.set_facecolor(colours)
    bar = figure.colorbar(matplotlib.cm.ScalarMappable(norm, mapped), ax=axes, shrink=0.8, aspect=30, pad=0.02)
    bar.set_label(name)
    bar.formatter.set_useOffset(False)
    bar.outline.set_visible(False)


@_styled
def pressure(points, dimension, outlines, patches, title):
    """Contact pressure of the patches: in the plane steps over the length along each zone, in space the slave skins, seen against their normals.

    @param outlines vertices of the skin cells of each patch  @param patches a reader.result.Patches
    """
    zones = range(len(patches.groups))
    if dimension == 2:
        figure = _new_figure(7.2, 0.6 + 2.4 * len(zones))
        for number, zone in enumerate(zones):
            _steps(figure.add_subplot(len(zones), 1, number + 1), points, outlines, patches, zone)
    else:
        figure = _new_figure(0.8 + 4.4 * len(zones), 4.4)
        for number, zone in enumerate(zones):
            _skin(figure, figure.add_subplot(1, len(zones), number + 1), points, outlines, patches, zone)
    figure.suptitle(title, fontsize=10, x=0.01, ha="left")
    return figure


def _words(patches, zone):
    members = patches.zone == zone
    return part("zone_in_contact", zone=patches.groups[zone], count=(patches.status[members] == 1).sum(), all=members.sum())


def _steps(axes, points, outlines, patches, zone):
    members = numpy.flatnonzero(patches.zone == zone)
    ends = numpy.array([[points[side][:, :2] for side in outlines[p]] for p in members], dtype=object)
    middle = numpy.array([numpy.concatenate(list(sides)).mean(axis=0) for sides in ends], float)
    spread = middle - middle.mean(axis=0)
    along = numpy.linalg.svd(spread, full_matrices=False)[2][0] if len(members) > 1 else numpy.array((1.0, 0.0))
    along = along * (1.0 if along[numpy.argmax(abs(along))] > 0 else -1.0)
    order = numpy.argsort(middle @ along)
    width = numpy.array([sum(numpy.linalg.norm(side[1] - side[0]) for side in sides) for sides in ends], float)[order]
    edges = numpy.concatenate([[0.0], numpy.cumsum(width)])
    values, status = patches.pressure[members][order], patches.status[members][order]
    axes.stairs(values, edges, color=_contact[zone % len(_contact)], fill=True, alpha=0.25)
    axes.stairs(values, edges, color=_contact[zone % len(_contact)], linewidth=1.2)
    lost = status < 0
    if lost.any():
        axes.plot((edges[:-1] + width / 2)[lost], numpy.zeros(lost.sum()), "x", color=_pale, markersize=3, label=part("without_master"), clip_on=False)
        axes.legend(frameon=False)
    axes.set_xlim(edges[0], edges[-1])
    axes.set_title(_words(patches, zone), loc="left")
    axes.set_xlabel(part("length_along_skin"))
    axes.set_ylabel(part("contact_pressure"))
    axes.grid(color="#e3e7eb", linewidth=0.6)


def _skin(figure, axes, points, outlines, patches, zone):
    members = numpy.flatnonzero(patches.zone == zone)
    cells = [points[corners] for p in members for corners in outlines[p]]
    values = numpy.array([patches.pressure[p] for p in members for _ in outlines[p]])
    middle = numpy.concatenate(cells)
    centre = middle.mean(axis=0)
    normal = sum(numpy.cross(corners[1] - corners[0], corners[-1] - corners[0]) for corners in cells)
    size = numpy.linalg.norm(normal)
    away = normal / size if size > 1e-6 * sum(patches.area[members]) else numpy.array((0.0, 0.0, 1.0))  # a closed skin is seen from above
    first = numpy.eye(3)[numpy.argmin(abs(away))]
    first = first - (first @ away) * away
    first /= numpy.linalg.norm(first)
    plane = numpy.column_stack([first, numpy.cross(away, first)])
    collection = _collection([(corners - centre) @ plane for corners in cells], 0.2)
    _colour(figure, axes, collection, values, part("contact_pressure"), None)
    axes.add_collection(collection)
    seen = (middle - centre) @ plane
    axes.set_xlim(seen[:, 0].min(), seen[:, 0].max())
    axes.set_ylim(seen[:, 1].min(), seen[:, 1].max())
    axes.set_aspect("equal")
    axes.axis("off")
    axes.set_title(_words(patches, zone), loc="left")


@_styled
def convergence(journal, title):
    """Residuals of all iterations on a logarithmic scale with their criteria, and changes of contact below. @param journal a base.journal.Journal"""
    rows = journal.iterations()
    figure = _new_figure(7.6, 4.8 if journal.patches else 3.4)
    panels = figure.subplots(2 if journal.patches else 1, 1, sharex=True, squeeze=False, height_ratios=(2.2, 1) if journal.patches else (1,))[:, 0]
    kinds = (("rela", "RESI_GLOB_RELA", "o"), ("maxi", "RESI_GLOB_MAXI", "s"), ("refe", "RESI_REFE_RELA", "D"),
             ("geometry", "RESI_GEOM", "^"), ("constraint", part("gap_over_size"), "v"))
    number = numpy.arange(len(rows))
    begins = [i for i in number if i == 0 or rows[i][0] is not rows[i - 1][0]]
    pieces = list(zip(begins, [*begins[1:], len(rows)]))
    for (key, words, mark), colour in zip(kinds, _contact):
        limit = journal.limits.get(key)
        if limit is None:
            continue
        values = numpy.array([line.get(key, math.nan) for _, line in rows], float)
        values[values <= 0.0] = math.nan  # exactly met: nothing on a logarithmic scale
        for first, last in pieces:  # an instant is a curve of its own
            panels[0].plot(number[first:last], values[first:last], color=colour, marker=mark, markersize=3, linewidth=1.0, label=words if not first else None)
        panels[0].axhline(limit, color=colour, linestyle=":", linewidth=0.9)
    panels[0].set_yscale("log")
    panels[0].set_ylabel(part("residual_dotted"))
    panels[0].legend(frameon=False, fontsize=8, ncols=4, loc="lower left", bbox_to_anchor=(0.0, 1.0))
    for panel in panels:
        panel.grid(color="#e3e7eb", linewidth=0.6)
        for first, last in pieces[::2]:
            panel.axvspan(first - 0.5, last - 0.5, color="#f2f4f7", zorder=0)
    if journal.patches:
        panels[1].bar(number, [line.get("changes", 0) for _, line in rows], color=_contact[0], width=0.7, label=part("patches_that_change"))
        other = panels[1].twinx()
        other.plot(number, [line.get("active", 0) for _, line in rows], color=_contact[1], linewidth=1.0, drawstyle="steps-mid")
        panels[1].set_ylabel(part("patches_that_change"), color=_contact[0])
        other.set_ylabel(part("in_contact"), color=_contact[1])
        other.set_ylim(bottom=0)
    panels[-1].set_xlabel(part("bands_are_instants", count=len(pieces)))
    panels[-1].set_xlim(-0.5, max(len(rows), 1) - 0.5)
    figure.suptitle(title, fontsize=10, x=0.01, ha="left")
    return figure
