"""The patch test's meshes and runs; test_patch.py judges them, book.py writes docs/verification.md from them."""

import itertools

import numpy as np
from meshes import block, union, write_med

KINDS = ("TRIA3", "TRIA6", "QUAD4", "QUAD8", "QUAD9")
PAIRS = list(itertools.product(KINDS, KINDS))  #: (slave body, master body)
WIDTH = HEIGHT = 50.0
YOUNG, POISSON = 2000.0, 0.3
#: LAGS_C, PRES, SIYY, JEU, COEFSURF, CONT: smallest and largest value
CHECKS_A_PAIR = 12


def uneven(n, shift):
    """n steps on [0, 1] of lengths that differ: no line of one block meets one of the other."""
    lines = np.linspace(0, 1, n + 1)
    return lines + shift * lines * (1 - lines)


def patch_mesh(slave, master):
    """Upper (slave) block of 7 columns on a lower (master) one of 5; inner lines are skew, so that cells are no parallelograms."""

    def skew(bottom):
        def place(s, t):
            return WIDTH * (s + 0.3 * s * (1 - s) * t * (1 - t)), bottom + HEIGHT * (t - 0.3 * t * (1 - t) * s)
        return place

    upper = block(slave, uneven(7, 0.13), uneven(4, 0.2), straight(slave, skew(0.0), uneven(7, 0.13), uneven(4, 0.2)), "UPPER",
                  {"bottom": "SLAVE", "top": "LOAD", "left": "AXIS"})
    lower = block(master, uneven(5, -0.17), uneven(3, -0.2), straight(master, skew(-HEIGHT), uneven(5, -0.17), uneven(3, -0.2)),
                  "LOWER", {"top": "MASTER", "bottom": "BASE", "left": "AXIS"})
    return union([upper, lower])


def straight(kind, place, s, t):
    """`place` on grid lines, linear between them: quadratic cells with straight edges."""

    def between(line, value):
        k = min(max(int(np.searchsorted(line, value)) - 1, 0), len(line) - 2)
        return line[k], line[k + 1], (value - line[k]) / (line[k + 1] - line[k])

    def flat(a, b):
        a0, a1, u = between(s, a)
        b0, b1, v = between(t, b)
        corner = {(i, j): np.array(place(x, y)) for i, x in enumerate((a0, a1)) for j, y in enumerate((b0, b1))}
        if kind.startswith("TRIA") and abs(u - 0.5) < 1e-9 and abs(v - 0.5) < 1e-9:  # the middle of the diagonal in use
            i, j = int(np.searchsorted(s, a0)), int(np.searchsorted(t, b0))
            ends = ((0, 0), (1, 1)) if (i + j) % 2 else ((1, 0), (0, 1))
            return (corner[ends[0]] + corner[ends[1]]) / 2
        return ((1 - u) * (1 - v) * corner[0, 0] + u * (1 - v) * corner[1, 0] + (1 - u) * v * corner[0, 1] + u * v * corner[1, 1])

    return flat


def run_patches(test, comm, pairs, pressure=25.0, lower=(YOUNG, POISSON), jacobian="INITIAL", tolerance=1e-10, model="D_PLAN"):
    """One run of the launcher for all the pairs. @param test a StudyTest @return its run; .checks has CHECKS_A_PAIR a pair"""
    units = []
    for k, pair in enumerate(pairs):
        path = test.folder / f"{'-'.join(pair)}.med"
        if not path.exists():
            write_med(path, patch_mesh(*pair))
        units += ["--unit", f"{20 + k}={path}"]
    return test.run_study(comm, "--fresh", "--checks", "all", *units, PATCH_COUNT=str(len(pairs)), PATCH_PRESSURE=repr(pressure),
                          PATCH_LOWER=f"{lower[0]!r},{lower[1]!r}", PATCH_JACOBIAN=jacobian, PATCH_MODEL=model, PATCH_TOLERANCE=repr(tolerance))


def by_pair(run, count):
    """The checks of each pair: component -> (smallest, largest value)."""
    found = []
    for k in range(count):
        checks = run.checks[k * CHECKS_A_PAIR:(k + 1) * CHECKS_A_PAIR]
        found.append({low["component"]: (low["value"], high["value"]) for low, high in zip(checks[::2], checks[1::2])})
    return found


def worst(values, expected):
    """Largest distance of a (smallest, largest) value from what is expected."""
    return max(abs(v - expected) for v in values)


def strain(pressure, young, poisson):
    """Plane strain, free sideways, sigma_yy = -p: (eps_xx, eps_yy)."""
    return poisson * (1 + poisson) * pressure / young, -(1 - poisson**2) * pressure / young
