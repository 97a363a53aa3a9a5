"""The mesh of an indentation: a hard round punch above a ductile block, seen from their common axis. Sizes and fineness are here."""

import numpy as np
from meshes import block, graded, union, write_med

RADIUS = 10.0  # of the punch, mm
SIZE = 12.0  # of the block, mm
PUNCH = 3.0  # half width and height of the punch, mm
STEP = 0.1  # of the cells near the contact, mm


def write(path):
    ground = block("QUAD8", graded(SIZE, STEP, 2.0, 1.3), -graded(SIZE, STEP, 8 * STEP, 1.3)[::-1], name="GROUND",
                   sides={"left": "AXIS_G", "bottom": "BASE", "top": "PLANE"})

    def round_below(r, height):
        return r, height + (1.0 - height / PUNCH) * (RADIUS - np.sqrt(RADIUS**2 - r * r))

    punch = block("QUAD8", graded(PUNCH, 1.3 * STEP, 2.0, 1.3), graded(PUNCH, 3 * STEP, 3 * STEP, 1.4), round_below, name="PUNCH",
                  sides={"left": "AXIS_P", "bottom": "TIP", "top": "TOP"})
    write_med(path, union([ground, punch]))
