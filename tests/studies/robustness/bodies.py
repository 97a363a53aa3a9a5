"""Bodies of the studies: small meshes whose skins, BODY_SKIN, meet, and whose other sides are held or driven: BODY_BASE."""

import math

import numpy as np
from meshes import block, brick, union, weld


def lines(first, last, cells):
    return np.linspace(first, last, cells + 1)


def slab(kind, name, x, y, cells, top=None, skin="top", sides=None):
    """A block whose skin is its top (or its bottom). @param x, y (first, last) @param cells (along x, along y)
    @param top the top's height (the bottom's, where that is the skin) as a function of x, in place of the end of y"""
    base = "bottom" if skin == "top" else "top"

    def place(a, b):
        low, high = y
        if top:
            low, high = (low, top(a)) if skin == "top" else (top(a), high)
        return a, low + b * (high - low)

    return block(kind, lines(*x, cells[0]), lines(0, 1, cells[1]), place, name, {skin: f"{name}_SKIN", base: f"{name}_BASE", **(sides or {})})


def round_tool(kind, name, radius, centre, cells, angle=75.0):
    """A body whose skin is an arc of this angle on both sides of its lowest point; its top is flat. @param cells (along the arc, through the body)"""
    most = math.radians(angle)

    def place(s, t):
        low = np.array([math.sin(most * s), -math.cos(most * s)])
        high = np.array([s * math.sin(most), 0.3])
        return tuple(np.asarray(centre) + radius * ((1 - t) * low + t * high))

    return block(kind, lines(-1, 1, cells[0]), lines(0, 1, cells[1]), place, name, {"bottom": f"{name}_SKIN", "top": f"{name}_BASE"})


def tip(kind, name, half_width, cells):
    """A body that ends below in a tip of two flanks of 45 degrees, at the origin."""
    return slab(kind, name, (-half_width, half_width), (0, 1.5 * half_width), cells, top=abs, skin="bottom")


def polygon(kind, name, sides, centre, cells, hub=0.4):
    """A regular polygon of circumradius 1, a side of it below, around a round hub that is its base. @param cells (a side, through the body)"""
    step = 2 * math.pi / sides

    def place(t, a):
        outer = math.cos(step / 2) / math.cos((a + math.pi / 2 + step / 2) % step - step / 2)
        radius = hub + t * (outer - hub)
        return centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)

    start = -math.pi / 2 - step / 2
    ring = block(kind, lines(0, 1, cells[1]), lines(start, start + 2 * math.pi, sides * cells[0]), place, name,
                 {"right": f"{name}_SKIN", "left": f"{name}_BASE"})
    return weld(ring)


def arch(kind, name, radii, cells):
    """Half a ring over the axis y = 0, its feet the base. @param cells (around, through)"""
    return block(kind, lines(*radii, cells[1]), lines(0, math.pi, cells[0]), lambda r, a: (r * math.cos(a), r * math.sin(a)), name,
                 {"right": f"{name}_SKIN", "bottom": f"{name}_BASE", "top": f"{name}_BASE"})


def half_disc(kind, name, radius, height, n):
    """The half x > 0 of a disc of centre (0, height): a square core, and three sectors around it of n cells each (n through the core's half).
    Groups BODY_LOW, BODY_HIGH (skins of 45 degrees from the axis), and AXIS."""
    core = 0.45 * radius

    def ring(edge, first, last):
        """From a side of the core to an arc. @param edge point of the core at the parameter 0..1; first, last degrees"""
        def place(r, s):
            angle = math.radians(first + s * (last - first))
            return tuple((1 - r) * np.asarray(edge(s)) + r * radius * np.array([math.cos(angle), math.sin(angle)]) + [0, height])
        return place

    through = lines(0, 1, n)
    parts = [
        block(kind, lines(0, core, n), lines(-core, core, 2 * n), lambda x, y: (x, y + height), name, {"left": "AXIS"}),
        block(kind, through, lines(0, 1, 2 * n), ring(lambda s: (core, core * (2 * s - 1)), -45, 45), name, {}),
        block(kind, through, through, ring(lambda s: (core * (1 - s), core), 45, 90), name, {"right": f"{name}_HIGH", "top": "AXIS"}),
        block(kind, through, through, ring(lambda s: (core * s, -core), -90, -45), name, {"right": f"{name}_LOW", "bottom": "AXIS"}),
    ]
    return weld(union(parts))


def turned(mesh, degrees):
    """The mesh turned about the origin."""
    a = math.radians(degrees)
    mesh.points = mesh.points @ np.array([[math.cos(a), math.sin(a)], [-math.sin(a), math.cos(a)]])
    return mesh


def slab_in_space(kind, name, x, y, z, cells, skin="top", sides=None):
    """A box whose skin is its top, or its bottom."""
    end = int(skin == "top")
    return brick(kind, [lines(*ends, n) for ends, n in zip((x, y, z), cells)], None, name,
                 {(2, end): f"{name}_SKIN", (2, 1 - end): f"{name}_BASE", **(sides or {})})


def cap(kind, name, x, y, z, cells, height, sides=None):
    """A box whose skin, its bottom, bulges by a paraboloid of that height at the middle of a side. Groups BODY_SKIN, BODY_BASE."""
    def place(at, across, up):
        r = (2 * (at - sum(x) / 2) / (x[1] - x[0])) ** 2 + (2 * (across - sum(y) / 2) / (y[1] - y[0])) ** 2
        return at, across, up + height * r * (z[1] - up) / (z[1] - z[0])

    return brick(kind, [lines(*ends, n) for ends, n in zip((x, y, z), cells)], place, name,
                 {(2, 0): f"{name}_SKIN", (2, 1): f"{name}_BASE", **(sides or {})}, curved=True)


def quarter_of_a_lens(kind, name, height, n, sides):
    """The part x, y > 0 of a body that ends below and above in spheres of radius 1 and centre (0, 0, height). Groups BODY_LOW, BODY_HIGH."""
    most = math.radians(35)

    def place(r, s, t):
        high = np.array([math.tan(most * r), math.tan(most * s), 1.0])
        high /= np.linalg.norm(high)
        return high * [1, 1, 2 * t - 1] + [0, 0, height]

    return brick(kind, [lines(0, 1, n)] * 3, place, name, {(2, 0): f"{name}_LOW", (2, 1): f"{name}_HIGH", **sides}, curved=True)


def quarter_of_a_ring(kind, name, radii, height, cells, sides):
    """The part x, y > 0 of a ring about the axis z, of round section. @param radii (of the ring, of its section) @param height of its middle
    @param cells (half a side of the section's square core, which is as many as around it, along the ring)
    @param sides (axis, end: 0 or 1) -> group, of the planes x = 0 and y = 0 alone. Groups BODY_LOW, BODY_HIGH."""
    core, (n, along) = 0.45 * radii[1], cells
    planes = {(1, 1 - axis): group for (axis, _), group in sides.items()}

    def sector(first):
        """Of 90 degrees of the section, from a side of the core outward; without an angle the core."""
        def place(r, turn, s):
            if first is None:
                x, z = core * (2 * r - 1), core * (2 * s - 1)
            else:
                a, (x, z) = math.radians(first + 90 * s), (1.0, 2 * s - 1)
                c, t = math.cos(math.radians(first + 45)), math.sin(math.radians(first + 45))
                x, z = (1 - r) * core * np.array([c * x - t * z, t * x + c * z]) + r * radii[1] * np.array([math.cos(a), math.sin(a)])
            turn *= math.pi / 2
            return (radii[0] + x) * math.cos(turn), (radii[0] + x) * math.sin(turn), height + z

        steps = [lines(0, 1, 2 * n if first is None else n), lines(0, 1, along), lines(0, 1, 2 * n)]
        return brick(kind, steps, place, name, planes if first is None else {**planes, (0, 1): f"{name}_SKIN"}, curved=True)

    ring = weld(union([sector(first) for first in (None, -45, 45, 135, 225)]))
    ring.cell_groups[f"{name}_LOW"], ring.cell_groups[f"{name}_HIGH"] = [], []
    for skin, cell in ring.cell_groups.pop(f"{name}_SKIN"):
        middle = ring.points[ring.cells[skin][cell]].mean(axis=0)
        ring.cell_groups[f"{name}_{'HIGH' if middle[2] > height else 'LOW'}"].append((skin, cell))
    return ring


def round_tool_in_space(kind, name, radius, centre, cells, ball):
    """A body whose skin is part of a sphere (`ball`), or of a cylinder along y of width 2 radius; its top is flat."""
    most = math.radians(40)

    def place(r, s, t):
        low = np.array([math.tan(most * r), math.tan(most * s) if ball else 0.0, -1.0])
        low /= np.linalg.norm(low)
        if not ball:
            low[1] = s
        high = np.array([0.8 * r, 0.8 * s if ball else s, 0.0])
        return np.asarray(centre) + radius * ((1 - t) * low + t * high)

    return brick(kind, [lines(-1, 1, cells[0]), lines(-1, 1, cells[1]), lines(0, 1, cells[2])], place, name,
                 {(2, 0): f"{name}_SKIN", (2, 1): f"{name}_BASE"}, curved=True)
