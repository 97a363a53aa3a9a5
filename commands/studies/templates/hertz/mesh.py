"""The mesh of Hertz' contact: half of a round punch above half of a block, seen from their common axis. Sizes and fineness are here."""

import numpy as np
from meshes import block, graded, union, write_med

RADIUS = 50.0  # of the sphere, mm
SIZE = 12.0  # of both bodies, mm: large beside the radius of contact, about 1
STEP = 0.08  # of the cells near the contact, mm


def write(path):
    fine = graded(SIZE, STEP, 1.2, 1.25)
    coarse = graded(SIZE, 1.13 * STEP, 1.3, 1.25)
    ground = block("QUAD8", coarse, -graded(SIZE, STEP, 3 * STEP, 1.25)[::-1], name="GROUND", sides={"left": "AXIS_G", "bottom": "BASE", "top": "PLANE"})

    def round_below(r, height):
        """The lower side is r^2 / 2 R high, as Hertz has it."""
        return r, height + (1.0 - height / SIZE) * r * r / (2.0 * RADIUS)

    sphere = block("QUAD8", fine, graded(SIZE, STEP, 3 * STEP, 1.25), round_below, name="SPHERE",
                   sides={"left": "AXIS_S", "bottom": "SKIN", "top": "TOP"})
    write_med(path, union([ground, sphere]))
