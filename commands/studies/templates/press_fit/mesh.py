"""The mesh of a press fit: quarters of two rings, the hub a little smaller inside than the shaft is outside. Sizes and fineness are here."""

import math

import numpy as np
from meshes import block, union, write_med

INNER, JOINT, OUTER = 20.0, 40.0, 70.0  # radii, mm
INTERFERENCE = 0.05  # of radii, mm: the shaft is that much larger than the hub
FINENESS = 1  # 2: cells of half the size


def ring(name, first, last, around, across, sides):
    """A quarter of a ring of QUAD8; its parameters are the angle from the y axis, clockwise, and the radius."""
    def place(angle, radius):
        return radius * math.sin(angle), radius * math.cos(angle)

    lines = np.linspace(0.0, math.pi / 2, around * FINENESS + 1), np.linspace(first, last, across * FINENESS + 1)
    return block("QUAD8", *lines, place, name=name, sides={"left": "AXIS_X", "right": "AXIS_Y", **sides})


def write(path):
    shaft = ring("SHAFT", INNER, JOINT + INTERFERENCE / 2, 14, 5, {"top": "SHAFT_SKIN"})
    hub = ring("HUB", JOINT - INTERFERENCE / 2, OUTER, 11, 6, {"bottom": "HUB_SKIN"})
    write_med(path, union([shaft, hub]))
