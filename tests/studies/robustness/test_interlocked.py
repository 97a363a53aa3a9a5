"""Bodies that fit into each other along teeth and steps: what a patch sees past the end of a flank is no part of its contact, and no round-off decides."""

import math
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from study_test import LACON, StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from bodies import lines, slab, turned  # noqa: E402
from meshes import block, brick, union, weld  # noqa: E402
from results import Result  # noqa: E402
from run import run  # noqa: E402
from studies import Study, elastic, zone  # noqa: E402

STRAIN, YOUNG, POISSON = 0.01, 2000.0, 0.3
PLACES = ((0, 0, 0), (100, -100, 0), (337.3, 911.9, 24.7), (-1e3, 1e3, 161))  # shift, and degrees by which it was turned before


def teeth(x, flank=60.0):
    """Height of a row of teeth, an odd function; corners at 0.5, 1.5 ..."""
    return math.tan(math.radians(flank)) * (abs((x + 0.5) % 2 - 1) - 0.5)


def row_of_teeth(kind, name, cells, top=teeth):
    return slab(kind, name, (-2.5, 2.5), (-3, 0), (5 * cells, 4), top=top, sides={"left": f"{name}_BASE", "right": f"{name}_BASE"})


def step(kind, name, cells):
    """A body with a step of height 1 in its skin."""
    skin, base = f"{name}_SKIN", f"{name}_BASE"
    parts = (((-2, 0), (-2, -0.5), {"left": base, "bottom": base}), ((0, 2), (-2, -0.5), {"right": base, "bottom": base, "top": skin}),
             ((-2, 0), (-0.5, 0.5), {"left": base, "top": skin, "right": skin}))
    return weld(union([block(kind, lines(*x, 2 * cells), lines(*y, cells), None, name, sides) for x, y, sides in parts]))


def row_in_space(kind, name, cells):
    def place(x, y, t):
        return x, y, t * (teeth(x) + 2)

    sides = {(axis, end): f"{name}_BASE" for axis, end in ((0, 0), (0, 1), (1, 0), (1, 1), (2, 0))}
    mesh = brick(kind, [lines(-1.5, 1.5, 3 * cells), lines(-0.5, 0.5, cells), lines(0, 1, 2)], place, name, {**sides, (2, 1): f"{name}_SKIN"})
    mesh.points = mesh.points - [0, 0, 2]
    return mesh


class Interlocked(StudyTest):
    """Two bodies of one material that are strained alike in all directions: the same pressure acts everywhere, whatever their skins are."""

    def pressures(self, mesh, side, moves, model="D_PLAN"):
        """@return pressures of the patches that press, and iterations"""
        study = Study(name="interlocked", mesh=mesh, model=model, steps=1, stops=True, moves=moves, zones=[zone("LOW", "UP", side)],
                      materials={"LOW": elastic(YOUNG, POISSON), "UP": elastic(YOUNG, POISSON)})
        figures = run(study, LACON, self.folder)
        self.assertEqual(figures["status"], "finished")
        result = Result(self.folder / "study.base", "RESU")
        return -result.where_present("DEPL", result.orders[-1], "LAGS_C"), figures["solutions"]

    def check(self, what, mesh, side, model="D_PLAN"):
        """All outer nodes go towards the middle by STRAIN."""
        middle = mesh.points.mean(axis=0)
        moves = [{"GROUP_MA": f"{body}_BASE", **{f"D{a}": f"-{STRAIN!r} * INST * ({a} - ({float(c)!r}))" for a, c in zip("XYZ", middle)}} for body in ("LOW", "UP")]
        found, solutions = self.pressures(mesh, side, moves, model)
        stress = YOUNG * STRAIN / (1 - 2 * POISSON) / (1 + POISSON if model == "D_PLAN" else 1)
        self.assertGreater(len(found), 4, what)
        np.testing.assert_allclose(found / stress, 1, atol=1e-6, err_msg=str(what))  # RESI_GLOB_RELA; round-off of coordinates of 1e3 is 2e-11 of the strain
        self.assertLessEqual(solutions, 2, what)

    def test_round_off_of_places_decides_nothing_in_the_plane(self):
        """Normals at the ends of flanks pass through corners of the master, and may see the flank of the next tooth: pressures were 0.1 to 1.7 of these."""
        for shape, kind, side in ((shape, kind, side) for shape in (row_of_teeth, step) for kind in ("QUAD4", "QUAD8") for side in (0, 1)):
            for *shift, degrees in PLACES:
                mesh = turned(union([shape(kind, "LOW", 2), turned(shape(kind, "UP", 3), 180)]), degrees)
                mesh.points = mesh.points + shift
                self.check((shape.__name__, kind, side, shift), mesh, side)

    def test_flanks_of_30_degrees_see_no_others(self):
        """Those beside them are 60 degrees from facing them, to round-off: where they counted, pressures differed by a tenth from place to place."""
        for kind, side in ((kind, side) for kind in ("QUAD4", "QUAD8") for side in (0, 1)):
            found = []
            for *shift, _ in PLACES:
                low, up = (row_of_teeth(kind, body, cells, top=lambda x: teeth(x, 30)) for body, cells in (("LOW", 2), ("UP", 3)))
                mesh = union([low, turned(up, 180)])
                mesh.points = mesh.points + shift
                moves = [{"GROUP_MA": "LOW_BASE", "DX": 0.0, "DY": 0.0}, {"GROUP_MA": "UP_BASE", "DX": 0.03, "DY": -0.01}]
                found.append(self.pressures(mesh, side, moves)[0])
            for other in found[1:]:
                np.testing.assert_allclose(other, found[0], atol=1e-6 * max(found[0]), err_msg=f"{kind} {side}")

    def test_nor_do_six_digits_of_coordinates(self):
        for degrees in (29, 41, 53):
            for side in (0, 1):
                mesh = turned(union([step("QUAD4", "LOW", 2), turned(step("QUAD4", "UP", 2), 180)]), degrees)
                mesh.points = np.round(2.5 * mesh.points + [31, 72], 5)
                self.check((degrees, side), mesh, side)

    def test_nor_does_it_in_space(self):
        for kind in ("HEXA8", "PENTA6", "TETRA10"):
            for side in (0, 1):
                upper = row_in_space(kind, "UP", 2)
                upper.points = upper.points * [-1, 1, -1]
                mesh = union([row_in_space(kind, "LOW", 1), upper])
                mesh.points = mesh.points + [100, -100, 50]
                self.check((kind, side), mesh, side, "3D")
