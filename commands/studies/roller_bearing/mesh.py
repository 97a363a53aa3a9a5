"""Makes the mesh of the study: mesh.py FILE. Three curved bodies of three kinds of cells; no line of one meets one of another."""

import pathlib
import sys

import numpy as np
from numpy import cos, pi, sin

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from geometry import CENTRE, INNER, OUTER, PRELOAD, REACH, RING, ROLLER  # noqa: E402
from meshes import block, graded, union, weld, write_med  # noqa: E402


def two_sided(length, fine, until, growth):
    """Grid lines from -length to length, fine in the middle."""
    half = graded(length, fine, until, growth)
    return np.concatenate([-half[:0:-1], half])


def keep_near(mesh, group, distance):
    """Leave out the cells of a group that are farther than `distance` from the middle line."""
    mesh.cell_groups[group] = [(kind, c) for kind, c in mesh.cell_groups[group]
                               if abs(mesh.points[mesh.cells[kind][c], 0].mean()) < distance]


def ring(kind, radius, outside, fine, name, skin, far):
    """A sector of a ring whose contact face has this radius; the ring lies outside or inside of it."""
    depth = graded(RING, fine, 4 * fine, 1.3)
    levels = radius + depth if outside else radius - depth[::-1]

    def place(arc, r):
        return r * sin(arc / radius), CENTRE + r * cos(arc / radius)

    sides = {"bottom": skin, "top": far} if outside else {"top": skin, "bottom": far}
    mesh = block(kind, two_sided(REACH, fine, 1.1, 1.3), levels, place, name, sides)
    keep_near(mesh, skin, 6.0)
    return mesh


def roller(kind, fine):
    """A disc: a square in the middle, rounded a little, and four sectors around it."""
    half, bulge, radius = 0.45 * ROLLER, 0.2, ROLLER + PRELOAD
    around = two_sided(1.0, fine / (ROLLER * pi / 4), 1.1 / (ROLLER * pi / 4), 1.3)  # fine at the top and at the bottom
    beside = np.linspace(-1, 1, 13)
    depth = graded(1.0, fine / (ROLLER - half), 4 * fine / (ROLLER - half), 1.3)

    def centre(a, b):
        return half * a * (1 + bulge * (1 - b * b)), half * b * (1 + bulge * (1 - a * a))

    def sector(turn):
        def place(a, t):
            """a from -1 to 1 along the arc, t from 0 at the square to 1 at the surface."""
            x, y = centre(-a, -1)
            angle = -a * pi / 4
            x, y = (1 - t) * x + t * radius * sin(angle), (1 - t) * y - t * radius * cos(angle)
            # so far the sector at the bottom, seen from the surface: turn it
            return x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn)
        return place

    levels = 1 - depth[::-1]
    parts = [block(kind, around, beside, centre, "ROLLER")]
    for turn, lines, sides in ((0, around, {"top": "ROLLER_BOTTOM"}), (pi / 2, beside, None), (pi, around, {"top": "ROLLER_TOP"}),
                               (3 * pi / 2, beside, None)):
        parts.append(block(kind, lines, levels, sector(turn), "ROLLER", sides))
    mesh = weld(union(parts), 1e-8)
    mesh.node_groups["ROLLER_AXIS"] = mesh.nodes_where(lambda x, y: abs(x) < 1e-9)
    keep_near(mesh, "ROLLER_TOP", 4.0)
    keep_near(mesh, "ROLLER_BOTTOM", 6.0)
    return mesh


def make():
    inner = ring("QUAD4", INNER, False, 0.07, "INNER", "INNER_SKIN", "INNER_FAR")
    keep_near(inner, "INNER_SKIN", 4.0)
    return union([inner, roller("QUAD8", 0.085), ring("TRIA6", OUTER, True, 0.095, "OUTER", "OUTER_SKIN", "OUTER_FAR")])


if __name__ == "__main__":
    made = make()
    write_med(sys.argv[1], made, "BEARING")
    print(f"{len(made.points)} nodes, " + ", ".join(f"{len(rows)} {kind}" for kind, rows in made.cells.items()))
