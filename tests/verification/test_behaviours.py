"""Plasticity and large strains in whole studies: paths against the closed form, quadratic convergence of Newton's method."""

import json
import math
import os
import pathlib
import re
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from load_study import LoadTest, flat_block  # noqa: E402
from meshes import block, brick, write_med  # noqa: E402

COMM = pathlib.Path(__file__).resolve().parent / "behaviours.comm"
YOUNG, POISSON = 200.0, 0.3
LINEAR = [(0.0, 1.0), (1.0, 1.0 + 20 * YOUNG / (YOUNG - 20))]
PIECES = [(0.0, 1.0), (0.04 - 1.4 / YOUNG, 1.4), (0.1 - 1.8 / YOUNG, 1.8)]


class Path:
    """Stresses along one ray, sigma = -m (side, 1): cumulated plastic strain and flow along the ray, driven by m."""

    def __init__(self, curve, side):
        self.curve, self.side = curve, side
        self.q = math.sqrt(1 - side + side * side)
        self.p = self.flow = 0.0

    def strain(self, m):
        """@return strain across the loaded side, across the other one, and the plastic strain p"""
        stresses, strains = zip(*((r, p) for p, r in self.curve))
        p = float(np.interp(abs(m) * self.q, stresses, strains, left=0.0))
        if p > self.p:
            self.flow += math.copysign(p - self.p, -m)
            self.p = p
        main, side = -m, -m * self.side
        return ((main - POISSON * side) / YOUNG + self.flow * (1 - self.side / 2) / self.q,
                (side - POISSON * main) / YOUNG + self.flow * (self.side - 0.5) / self.q, self.p)


def mesh_of(model, kind):
    if model == "3D":
        lines = tuple(np.array([0, 0.6, 1.0]) for _ in range(3))
        return brick(kind, lines, None, "BODY", {(0, 0): "LEFT", (0, 1): "SIDE", (1, 0): "FRONT", (2, 0): "BASE", (2, 1): "LOAD"})
    s = np.array([0, 0.6, 1.0])
    return block(kind, s, s, None, "BODY", {"left": "LEFT", "right": "SIDE", "bottom": "BASE", "top": "LOAD"})


class Behaviours(StudyTest):
    def solve(self, cases):
        """@return for each case: instant -> component -> (smallest, largest); and what the run printed"""
        units = []
        for k, case in enumerate(cases):
            write_med(self.folder / f"{k}.med", mesh_of(case["model"], case.pop("kind")))
            units += ["--unit", f"{20 + k}={self.folder / f'{k}.med'}"]
        run = self.run_study(COMM, "--fresh", "--checks", "all", *units, STUDY_CASES=json.dumps(cases))
        self.assertEqual(run.status, 0, run.stdout[-4000:] + run.stderr[-4000:])
        checks, found = iter(run.checks), []
        for case in cases:
            components = (3 if case["model"] == "3D" else 2) + (case["relation"] != "ELAS")
            found.append([{low["component"]: (low["value"], high["value"]) for low, high in ((next(checks), next(checks)) for _ in range(components))}
                          for _ in case["path"][1:]])
        return found, run.stdout

    def test_loading_unloading_and_reloading_follow_the_closed_form(self):
        """One sense and two, hardening in a line and in pieces: strains to 1e-8 of the largest, p to 1e-10."""
        path = [0, 0.8, 1.3, 0.2, -1.2, -1.6, 0.1, 1.75]
        cases = [dict(model=model, kind=kind, relation=relation, deformation="PETIT", path=path, side=side, bend=False, criterion=1e-10)
                 for model, kind, side in (("3D", "HEXA8", 0), ("3D", "TETRA10", 0.4), ("C_PLAN", "QUAD4", 0), ("C_PLAN", "TRIA6", 0.4), ("AXIS", "QUAD8", 0))
                 for relation in ("VMIS_ISOT_LINE", "VMIS_ISOT_TRAC")]
        found, _ = self.solve(cases)
        for case, values in zip(cases, found):
            exact = Path(LINEAR if case["relation"] == "VMIS_ISOT_LINE" else PIECES, case["side"])
            for m, at in zip(path[1:], values):
                with self.subTest(**case, m=m):
                    main, side, p = exact.strain(m)
                    for component, value in (("DZ" if case["model"] == "3D" else "DY", main), ("DX", side)):
                        self.assertAlmostEqual(sum(at[component]), value, delta=1e-9)  # the other end does not move
                    for found_p in at["V1"]:
                        self.assertAlmostEqual(found_p, p, delta=1e-10)

    def test_a_dead_load_stretches_as_saint_venant_and_kirchhoff_say(self):
        """Nominal stress E l (l^2 - 1) / 2 = -m along the load, E_x = -nu E_y across."""
        path = [0, -20, -60, 10]
        cases = [dict(model=model, kind=kind, relation="ELAS", deformation="GREEN_LAGRANGE", path=path, side=0, bend=False, criterion=1e-10)
                 for model, kind in (("3D", "HEXA20"), ("C_PLAN", "QUAD8"), ("AXIS", "TRIA3"))]
        found, _ = self.solve(cases)
        for case, values in zip(cases, found):
            for m, at in zip(path[1:], values):
                with self.subTest(**case, m=m):
                    stretch = max(root.real for root in np.roots([YOUNG / 2, 0, -YOUNG / 2, m]) if abs(root.imag) < 1e-9)
                    across = math.sqrt(1 - POISSON * (stretch**2 - 1))
                    self.assertAlmostEqual(sum(at["DZ" if case["model"] == "3D" else "DY"]), stretch - 1, delta=1e-9)
                    self.assertAlmostEqual(sum(at["DX"]), across - 1, delta=1e-9)

    def test_newton_converges_quadratically(self):
        """A bent block, plastic or with large rotations: from one iteration to the next the residual's exponent doubles."""
        cases = [dict(model=model, kind=kind, relation=relation, deformation=deformation, path=[0, load], side=1, bend=True, criterion=1e-12)
                 for model, kind in (("D_PLAN", "QUAD8"), ("C_PLAN", "QUAD8"), ("3D", "HEXA20"))
                 for relation, deformation, load in (("VMIS_ISOT_LINE", "PETIT", 0.45), ("ELAS", "GREEN_LAGRANGE", 4.0))]
        _, printed = self.solve(cases)
        histories = []
        for iteration, residual in re.findall(r"\| +(\d+)[ X] \| +(\d\.\d+E[-+]\d+)", printed):
            if iteration == "0":
                histories.append([])
            histories[-1].append(float(residual))
        self.assertEqual(len(histories), len(cases), printed[:4000])
        for case, residuals in zip(cases, histories):
            with self.subTest(**case):
                print(case["model"], case["relation"], case["deformation"], " ".join(f"{r:.1e}" for r in residuals))
                # residuals are relative, and the constant of the quadratic term is less than 1 (0.05 to 0.42): every one counts that
                # is near the solution and above round-off
                near = [pair for pair in zip(residuals, residuals[1:]) if pair[0] < 0.05]
                self.assertGreaterEqual(len(near), 2, residuals)
                for before, after in near:
                    self.assertLess(after, before**2 + 1e-13, residuals)


class Prediction(LoadTest):
    """A bar in tension, with linear hardening: while the load goes on, the tangent of flow leads to the next instant at once, and
    where it turns back, that of elasticity."""

    def corrected(self, path):
        """At which instants Newton's method needs more than its first iteration. @param path VALE of the strain's course"""
        run = self.run_text([flat_block("QUAD8", size=(1.0, 1.0))], f"""
model(20, 'AXIS', DEFI_MATERIAU(ELAS=_F(E=2000.0, NU=0.3), ECRO_LINE=_F(SY=9.0, D_SIGM_EPSI=100.0)))
PATH = DEFI_FONCTION(NOM_PARA='INST', VALE={path})
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='LEFT', DX=0), _F(GROUP_MA='BASE', DY=0)))
PULL = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='TOP', DY=1.0))
LIST = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=_F(JUSQU_A=10.0, NOMBRE=10))
R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PULL, FONC_MULT=PATH)), INCREMENT=_F(LIST_INST=LIST),
                       COMPORTEMENT=_F(RELATION='VMIS_ISOT_LINE'), CONVERGENCE=_F(RESI_GLOB_RELA=1e-9)))
""")
        self.assertEqual(run.status, 0, run.stdout + run.stderr)
        iterations = re.findall(r"Converged at the instant \S+ with (\d+) iteration", run.stdout)
        self.assertEqual(len(iterations), 10)
        return [k for k, count in enumerate(iterations, 1) if int(count) > 0]

    def test_only_instants_in_which_flow_begins_are_corrected(self):
        # flow begins at the strain 0.0045: on the way to the instants 1 and 7
        self.assertEqual(self.corrected((0, 0, 4, 0.02, 6, 0.018, 10, 0.03)), [1, 7])

    def test_a_load_without_a_value_before_the_first_instant(self):
        self.assertEqual(self.corrected((1, 0.005, 4, 0.02, 6, 0.018, 10, 0.03)), [1, 2, 7])  # whether it went on to 2 nobody knows


class Softening(LoadTest):
    def test_a_bar_that_has_softened_to_nothing_carries_no_more(self):
        """E = 2000, E_T = -20: R = 9 - 19.8 p is nothing at p = 1 / 2.2, where the bar has no stress and that strain; what is beyond has no yield stress."""
        run = self.run_text([flat_block("QUAD8", size=(1.0, 1.0))], """
model(20, 'AXIS', DEFI_MATERIAU(ELAS=_F(E=2000.0, NU=0.3), ECRO_LINE=_F(SY=9.0, D_SIGM_EPSI=-20.0)))
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='LEFT', DX=0), _F(GROUP_MA='BASE', DY=0)))
PULL = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='TOP', DY=1.0))
LIST = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=_F(JUSQU_A=1.0, NOMBRE=10))
R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PULL, FONC_MULT=RAMP)), INCREMENT=_F(LIST_INST=LIST),
                       COMPORTEMENT=_F(RELATION='VMIS_ISOT_LINE')))
""")
        self.assertEqual(run.status, 3, run.stdout[-2000:])
        self.assertIn("a yield stress that softening has brought to nothing", run.stderr)
        reached = [float(instant) for instant in re.findall(r"Converged at the instant (\S+) with", run.stdout)]
        self.assertGreater(max(reached), 0.4 - 1e-9)
        self.assertLess(max(reached), 1 / 2.2)


if __name__ == "__main__":
    unittest.main()
