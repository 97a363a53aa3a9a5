"""The mesh of a stack: three blocks of different cells whose skins lie on each other without matching. Sizes and fineness are here."""

import numpy as np
from meshes import brick, union, write_med

SIZE = 2.0  # of the blocks, across; they are 1 high
CELLS = ("HEXA8", "TETRA10", "HEXA20")  # of the blocks, from below
STEPS = (4, 3, 5)  # cells across


def write(path):
    blocks = []
    for number, (kind, n) in enumerate(zip(CELLS, STEPS), 1):
        across = np.linspace(0.0, SIZE, n + 1)
        blocks.append(brick(kind, [across, across, np.linspace(number - 1.0, number, max(n // 2, 1) + 1)], name=f"BLOCK_{number}",
                            sides={(0, 0): "SIDE_X", (1, 0): "SIDE_Y", (2, 0): f"BELOW_{number}", (2, 1): f"ABOVE_{number}"}))
    write_med(path, union(blocks))
