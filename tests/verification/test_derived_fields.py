"""Nodal forces, reactions and pressures of a body under load: equilibrium to round-off, on every kind of cell."""

import json
import math
import os
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from meshes import block, brick, write_med  # noqa: E402

COMM = pathlib.Path(__file__).resolve().parent / "derived_fields.comm"
PRESSURE = 20.0


class DerivedFields(StudyTest):
    def figures(self, meshes, models, hold, deformation="PETIT"):
        units = []
        for k, mesh in enumerate(meshes):
            write_med(self.folder / f"{k}.med", mesh)
            units += ["--unit", f"{20 + k}={self.folder / f'{k}.med'}"]
        run = self.run_study(COMM, *units, STUDY_MODELS=",".join(models), STUDY_HOLD=hold, STUDY_DEFORMATION=deformation)
        self.assertEqual(run.status, 0, run.stdout[-4000:] + run.stderr[-4000:])
        return json.loads((self.folder / "derived_fields.json").read_text())

    def check(self, found, area, axis):
        """Two instants a study: half and all of the pressure."""
        for figures, factor in zip(found, [0.5, 1.0] * (len(found) // 2)):
            size = PRESSURE * area
            self.assertLess(figures["free"], 1e-11 * size)  # in the body and on free sides nothing is left
            balance = np.array(figures["balance"])
            self.assertLess(abs(figures["resultant"][axis] - factor * size), 1e-11 * size)
            self.assertLess(abs(balance[axis]), 1e-11 * size)
            for value in figures["pressure"]:
                self.assertLess(abs(value + factor * PRESSURE), 1e-10 * PRESSURE)
            self.assertLess(figures["shear"], 1e-10 * PRESSURE)
            for value in figures["mises"]:
                self.assertLess(abs(value - factor * PRESSURE), 1e-10 * PRESSURE)

    def test_space(self):
        def place(r, s, t):  # inner vertices move, faces stay plane
            bubble = [0.8 * q * (2 - q) for q in (r, s, t)]
            return (r + 0.3 * bubble[0] * (s - 0.4 * t), s + 0.25 * bubble[1] * (t - 0.6 * r), t + 0.2 * bubble[2] * (r - 0.7 * s * t))

        lines = (np.array([0, 0.9, 2.0]), np.array([0, 1.1, 2.0]), np.array([0, 0.8, 2.0]))
        sides = {(0, 0): "LEFT", (1, 0): "FRONT", (2, 0): "BASE", (2, 1): "LOAD"}
        kinds = ["TETRA4", "HEXA8", "PENTA15", "HEXA27"]
        found = self.figures([brick(kind, lines, place, "BODY", sides) for kind in kinds], ["3D"] * 4, "DX LEFT,DY FRONT,DZ BASE")
        self.check(found, area=4.0, axis=2)

    def test_the_plane(self):
        """In the plane a load is that of a unit of thickness. Plane strain: VMIS is sqrt(1 - nu + nu2) p."""
        s = np.array([0, 0.3, 0.62, 1.0])
        meshes = [block(kind, s, s, lambda a, b: (a + 0.3 * a * (1 - a) * b * (1 - b), b - 0.3 * b * (1 - b) * a * (1 - a)), "BODY",
                        {"left": "LEFT", "bottom": "BASE", "top": "LOAD"}) for kind in ("TRIA3", "QUAD4")]
        found = self.figures(meshes * 2, ["C_PLAN", "C_PLAN", "D_PLAN", "D_PLAN"], "DX LEFT,DY BASE")
        for figures in found[4:]:
            figures["mises"] = [value / math.sqrt(1 - 0.3 + 0.09) for value in figures["mises"]]
        self.check(found, area=1.0, axis=1)

    def test_axisymmetry(self):
        """Forces of one radian: a disc of radius 1 has the area 1/2."""
        s = np.array([0, 0.3, 0.62, 1.0])
        meshes = [block(kind, s, s, None, "BODY", {"left": "LEFT", "bottom": "BASE", "top": "LOAD"}) for kind in ("TRIA3", "QUAD8")]
        self.check(self.figures(meshes, ["AXIS"] * 2, "DX LEFT,DY BASE"), area=0.5, axis=1)

    def test_large_strains(self):
        """Dead pressure of one hundredth of E: forces of Cauchy's stresses on the current geometry balance it, in plane stress with
        the thickness as it is now, in axisymmetry on the current radius."""
        s = np.array([0, 0.4, 1.0])
        sides = {"left": "LEFT", "bottom": "BASE", "top": "LOAD"}
        flat = [block("QUAD8", s, s, lambda a, b: (a + 0.3 * a * (1 - a) * b * (1 - b), b - 0.3 * b * (1 - b) * a * (1 - a)), "BODY", sides)] * 3
        models = ["D_PLAN", "C_PLAN", "AXIS"]
        found = self.figures(flat, models, "DX LEFT,DY BASE", "GREEN_LAGRANGE")
        found += self.figures([brick("HEXA8", (s, s, s), None, "BODY", {(0, 0): "LEFT", (1, 0): "FRONT", (2, 0): "BASE", (2, 1): "LOAD"})],
                              ["3D"], "DX LEFT,DY FRONT,DZ BASE", "GREEN_LAGRANGE")
        for k, (area, axis) in enumerate(((1, 1), (1, 1), (0.5, 1), (1, 2))):
            for figures, factor in zip(found[2 * k:2 * k + 2], (0.5, 1.0)):
                with self.subTest(k=k, factor=factor):
                    size = PRESSURE * area
                    self.assertLess(figures["free"], 1e-9 * size)
                    self.assertLess(abs(figures["resultant"][axis] - factor * size), 1e-8 * size)


if __name__ == "__main__":
    unittest.main()
