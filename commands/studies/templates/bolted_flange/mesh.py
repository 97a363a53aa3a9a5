"""The mesh of a bolted joint, seen from the bolt's axis: head and shank of the bolt, two plates under the head. Sizes and fineness are here."""

import numpy as np
from meshes import block, union, weld, write_med

SHANK, HEAD, HOLE, PLATE = 5.0, 9.0, 5.5, 22.0  # radii, mm
THICK, HIGH = 12.0, 6.0  # a plate, the head, mm
PRELOAD = 0.02  # the shank is that much shorter than the plates are thick, mm
STEP = 0.75  # of the cells, mm


def lines(first, last, step=STEP):
    return np.linspace(first, last, max(2, round((last - first) / step)) + 1)


def write(path):
    under = 2 * THICK - PRELOAD
    shank = block("QUAD8", lines(0.0, SHANK), lines(0.0, under), name="BOLT", sides={"left": "AXIS", "bottom": "FOOT"})
    core = block("QUAD8", lines(0.0, SHANK), lines(under, under + HIGH), name="BOLT", sides={"left": "AXIS"})
    rim = block("QUAD8", lines(SHANK, HEAD), lines(under, under + HIGH), name="BOLT", sides={"bottom": "HEAD_SKIN"})
    lower = block("QUAD8", lines(HOLE, PLATE, 0.9 * STEP), lines(0.0, THICK, 1.2 * STEP), name="LOWER", sides={"bottom": "BASE", "top": "JOINT_BELOW"})
    upper = block("QUAD8", lines(HOLE, PLATE, 1.1 * STEP), lines(THICK, 2 * THICK, 1.2 * STEP), name="UPPER",
                  sides={"bottom": "JOINT_ABOVE", "top": "SEAT", "right": "RIM"})
    write_med(path, union([weld(union([shank, core, rim])), lower, upper]))
