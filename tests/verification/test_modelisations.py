"""Constant stress is exact on distorted meshes of every cell of 3D, AXIS and C_PLAN, with reduced integration too; a ring under inner pressure converges."""

import math
import os
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from meshes import VOLUMES, block, brick, write_med  # noqa: E402
from patch import KINDS, straight  # noqa: E402

COMM = pathlib.Path(__file__).resolve().parent / "modelisations.comm"
PRESSURE, YOUNG, POISSON = 20.0, 2000.0, 0.3
REDUCED = {"TETRA10": 4, "PENTA15": 6, "HEXA20": 8}  #: cells of 3D_SI with fewer points than in 3D


class Modelisations(StudyTest):
    def run_models(self, meshes, models, hold):
        """@return for each study: component -> (smallest, largest value)"""
        units = []
        for k, mesh in enumerate(meshes):
            write_med(self.folder / f"{k}.med", mesh)
            units += ["--unit", f"{20 + k}={self.folder / f'{k}.med'}"]
        run = self.run_study(COMM, "--fresh", "--checks", "all", *units, STUDY_MODELS=",".join(models), STUDY_HOLD=hold)
        self.assertEqual(run.status, 0, run.stdout[-4000:] + run.stderr[-4000:])
        each = len(run.checks) // len(meshes)
        return [{low["component"]: (low["value"], high["value"]) for low, high in zip(part[::2], part[1::2])}
                for part in (run.checks[k * each:(k + 1) * each] for k in range(len(meshes)))]

    def assert_is(self, found, scale, **expected):
        """The (smallest, largest) value of each component, to 1e-12 of a scale."""
        for component, values in expected.items():
            for value, exact in zip(found[component], values):
                self.assertLessEqual(abs(value - exact), 1e-12 * scale, component)

    def test_every_volume_carries_a_constant_stress(self):
        """Uniaxial pressure along z: stresses to 1e-12 p, displacements to 1e-12 of the largest."""

        def place(r, s, t):  # faces stay plane, inner vertices move: no parallelepiped, warped facets inside
            bubble = [0.8 * q * (2 - q) for q in (r, s, t)]
            return (r + 0.3 * bubble[0] * (s - 0.4 * t), s + 0.25 * bubble[1] * (t - 0.6 * r), t + 0.2 * bubble[2] * (r - 0.7 * s * t))

        lines = (np.array([0, 0.9, 2.0]), np.array([0, 1.1, 2.0]), np.array([0, 0.8, 2.0]))
        sides = {(0, 0): "LEFT", (1, 0): "FRONT", (2, 0): "BASE", (2, 1): "LOAD"}
        cases = [(kind, "3D") for kind in VOLUMES] + [(kind, "3D_SI") for kind in REDUCED]
        found = self.run_models([brick(kind, lines, place, "BODY", sides) for kind, _ in cases], [model for _, model in cases],
                                "DX LEFT,DY FRONT,DZ BASE")
        strain = PRESSURE / YOUNG
        for (kind, model), values in zip(cases, found):
            with self.subTest(cell=kind, modelisation=model):
                self.assert_is(values, PRESSURE, SIZZ=(-PRESSURE, -PRESSURE), **dict.fromkeys(("SIXX", "SIYY", "SIXY", "SIXZ", "SIYZ"), (0, 0)))
                self.assert_is(values, 2 * strain, DX=(0, 2 * POISSON * strain), DY=(0, 2 * POISSON * strain), DZ=(-2 * strain, 0))

    def test_plane_stress_and_axisymmetry_carry_a_constant_stress(self):
        """Pressure along y, free sideways: the hoop stress and SIZZ are zero in both, DX = nu p x / E."""

        def place(s, t):
            return 2 * (s + 0.3 * s * (1 - s) * t * (1 - t)), 2 * (t - 0.3 * t * (1 - t) * s)

        s, t = np.array([0, 0.3, 0.62, 1.0]), np.array([0, 0.45, 1.0])
        meshes = [block(kind, s, t, straight(kind, place, s, t), "BODY", {"left": "LEFT", "bottom": "BASE", "top": "LOAD"}) for kind in KINDS]
        models = ["C_PLAN"] * len(KINDS) + ["AXIS"] * len(KINDS) + ["C_PLAN_SI", "AXIS_SI"]
        found = self.run_models(meshes * 2 + [meshes[KINDS.index("QUAD8")]] * 2, models, "DX LEFT,DY BASE")
        strain = PRESSURE / YOUNG
        for name, values in zip(models, found):
            with self.subTest(modelisation=name):
                self.assert_is(values, PRESSURE, SIYY=(-PRESSURE, -PRESSURE), SIXX=(0, 0), SIZZ=(0, 0), SIXY=(0, 0))
                self.assert_is(values, 2 * strain, DX=(0, 2 * POISSON * strain), DY=(-2 * strain, 0))

    def test_a_thick_ring_under_inner_pressure_converges(self):
        """Lame: u(a) = p a / E' ((b2 + a2) / (b2 - a2) + nu'), plane strain along the axis. Order p + 1; 4 at the
        nodes of quadratic cells on a rectangular grid, which are exact with two points along the radius."""
        young, poisson = YOUNG / (1 - POISSON**2), POISSON / (1 - POISSON)
        exact = PRESSURE / young * (5 / 3 + poisson)  # a = 1, b = 2
        for kind, model, order in (("TRIA3", "AXIS", 2), ("QUAD4", "AXIS", 2), ("TRIA6", "AXIS", 3), ("QUAD8", "AXIS", 4), ("QUAD9", "AXIS", 4),
                                   ("QUAD8", "AXIS_SI", None)):
            meshes = [block(kind, np.linspace(1, 2, n + 1), np.linspace(0, 0.5, n // 2 + 1), None, "BODY",
                            {"left": "LOAD", "bottom": "ENDS", "top": "ENDS"}) for n in (4, 8, 16)]
            found = self.run_models(meshes, [model] * 3, "DY ENDS")
            with self.subTest(cell=kind, modelisation=model):
                errors = [abs(values["DX"][1] - exact) for values in found]
                print(f"{model}, {kind}: errors of u(a) {', '.join(f'{e / exact:.2e}' for e in errors)}, order {math.log2(errors[1] / errors[2]):.2f}")
                if order:
                    self.assertGreater(math.log2(errors[1] / errors[2]), order - 0.3)
                else:
                    self.assertLess(max(errors), 1e-11 * exact)


if __name__ == "__main__":
    unittest.main()
