"""What a residual is measured against (RESI_GLOB_RELA): the present equilibrium, whatever happened before it."""

import re
import unittest

import numpy as np
from load_study import SIDES_2D, LoadTest, flat_block

from meshes import block, brick, union  # noqa: I001 (load_study says where it is)
from results import Result

LENGTH, PRESSURE = 100.0, 0.0833
#: of a line of the Newton table: iteration, RESI_GLOB_RELA, RESI_GLOB_MAXI; X behind what is not converged
LINE = re.compile(r"^ \|\s*(\d+)(X?) +\|\s*([-+.\dE]+|inf|nan) [X ] \|\s*([-+.\dE]+|inf|nan) [X ] \|", re.MULTILINE)
#: forces of the strip of any thickness below 1: the load, and the tension that carries it as a membrane
LARGEST_FORCE = 20.0


def strip(thickness):
    lines = np.linspace(0, LENGTH, 21), np.linspace(0, thickness, 2)
    return block("QUAD8", *lines, None, "BODY", {"left": "LEFT", "right": "RIGHT", "bottom": "BASE", "top": "TOP"})


#: a strip clamped at both ends under a following pressure: far too soft for a step of Newton's method from its straight form
STRIP = """
MATTER = DEFI_MATERIAU(ELAS=_F(E=1000.0, NU=0.3))
model(20, "C_PLAN", MATTER)
CLAMP = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA=("LEFT", "RIGHT"), DX=0.0, DY=0.0))
PUSH = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA="BASE", PRES=%r))
STEPS = DEFI_LIST_REEL(VALE=(0.0, 1.0))
CUTS = DEFI_LIST_INST(DEFI_LIST=_F(LIST_INST=STEPS), ECHEC=_F(EVENEMENT="ERREUR", %%s))
R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=CLAMP), _F(CHARGE=PUSH, FONC_MULT=RAMP, TYPE_CHARGE="SUIV")),
                       COMPORTEMENT=_F(RELATION="ELAS", DEFORMATION="GREEN_LAGRANGE"), INCREMENT=_F(LIST_INST=CUTS),
                       CONVERGENCE=_F(RESI_GLOB_RELA=%%r, ITER_GLOB_MAXI=%%d)))
""" % PRESSURE


def lines(run):
    """(iteration, converged, RESI_GLOB_RELA, RESI_GLOB_MAXI) of each line of the Newton tables"""
    return [(int(number), not unmet, float(rela), float(maxi)) for number, unmet, rela, maxi in LINE.findall(run.stdout)]


class References(LoadTest):
    def assert_residuals(self, run, tolerance, largest):
        """What counts as converged has residuals below `tolerance` of the largest force."""
        solved = [line for line in lines(run) if line[1]]
        for number, _, rela, maxi in solved:
            self.assertLessEqual(maxi, tolerance * largest, (number, rela))
        return solved

    def test_after_one_huge_iterate_a_residual_is_as_large_as_before(self):
        """An iterate of forces above 1e17 is followed by residuals of 1e6, a millionth of it; forces in equilibrium are below 20."""
        run = self.run_text([strip(0.05)], STRIP % ("ACTION='ARRET'", 1e-5, 60))
        self.assertGreater(max(maxi for *_, maxi in lines(run)), 1e15)  # the way in
        self.assert_residuals(run, 1e-5, LARGEST_FORCE)
        self.assertIn(run.status, (0, 3), run.stderr[-2000:])

    def test_after_a_step_that_failed_and_was_cut_the_next_ones_are_judged_as_any(self):
        """Cut until it converges: half the load on each clamp, by equilibrium."""
        run = self.run_text([strip(0.2)], STRIP % ("ACTION='DECOUPE', SUBD_PAS=10, SUBD_NIVEAU=4", 1e-6, 25))
        self.assertGreater(max(maxi for *_, maxi in lines(run)), 1e9)  # the way in
        self.assertEqual(run.status, 0, run.stderr[-2000:])
        self.assertGreater(len(self.assert_residuals(run, 1e-6, LARGEST_FORCE)), 1)

    def test_unloaded_to_nothing_an_elastic_body_converges(self):
        """Forces that all vanish have no size of their own: round-off of those before them is no residual."""
        linear = None
        for kind, strain in (("ELAS", "PETIT"), ("ELAS", "GREEN_LAGRANGE"), ("VMIS_ISOT_LINE", "PETIT")):
            with self.subTest(law=kind, strain=strain):
                run = self.run_text([flat_block("QUAD8")], f"""
MATTER = DEFI_MATERIAU(ELAS=_F(E=2000.0, NU=0.3), ECRO_LINE=_F(SY=1.0e3, D_SIGM_EPSI=100.0))
model(20, "D_PLAN", MATTER)
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA="LEFT", DX=0.0, DY=0.0))
PULL = AFFE_CHAR_MECA(MODELE=MODEL, FORCE_CONTOUR=_F(GROUP_MA="RIGHT", FY=30.0))
GO = DEFI_FONCTION(NOM_PARA="INST", VALE=(0, 0, 1, 1, 2, 1.0e-8, 3, 0, 4, 1))
R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PULL, FONC_MULT=GO)),
                       COMPORTEMENT=_F(RELATION="{kind}", DEFORMATION="{strain}"),
                       INCREMENT=_F(LIST_INST=DEFI_LIST_REEL(VALE=(0.0, 1.0, 2.0, 3.0, 4.0))),
                       CONVERGENCE=_F(RESI_GLOB_RELA=1e-6, ITER_GLOB_MAXI=20)))
""")
                self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-2000:])
                result = Result(self.folder / "loads.base", "R[0]")
                moved = [self.displacement(result, order, 2) for order in range(5)]
                largest = np.abs(moved[1]).max()
                self.assertLessEqual(np.abs(moved[3]).max(), 1e-12 * largest)
                self.assertLessEqual(np.abs(moved[4] - moved[1]).max(), 1e-6 * largest)
                # a load of a hundred millionth is solved to its own digits; to so small a load every law answers linearly
                linear = 1e8 * moved[2] if linear is None else linear
                self.assert_near(1e8 * moved[2], linear, 1e-5)

    def test_a_body_that_turns_without_strain_converges(self):
        """All forces are round-off, of rows of stiff thin cells too: HEXA20 that are nearly incompressible.

        A rotation of quadratic strains needs some iterations (8 at 0.2 radians a step), and none for round-off.
        """
        lines = np.linspace(0, 1, 4), np.linspace(0, 0.1, 3), np.array([0, 0.001, 0.5])
        run = self.run_text([brick("HEXA20", lines, None, "BODY", {(0, 0): "LEFT"})], """
model(20, "3D", DEFI_MATERIAU(ELAS=_F(E=2.0e11, NU=0.499)))
FX = FORMULE(NOM_PARA=("X", "Y", "INST"), VALE="(cos(INST) - 1) * X - sin(INST) * Y")
FY = FORMULE(NOM_PARA=("X", "Y", "INST"), VALE="sin(INST) * X + (cos(INST) - 1) * Y")
TURN = AFFE_CHAR_CINE_F(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA="LEFT", DX=FX, DY=FY))
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA="LEFT", DZ=0.0))
R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=TURN), _F(CHARGE=HOLD)),
                       COMPORTEMENT=_F(RELATION="ELAS", DEFORMATION="GREEN_LAGRANGE"),
                       INCREMENT=_F(LIST_INST=DEFI_LIST_REEL(VALE=(0.0, 0.001, 0.002, 0.1, 0.2, 0.4))),
                       CONVERGENCE=_F(RESI_GLOB_RELA=1e-6, ITER_GLOB_MAXI=10)))
""")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-2000:])

    def test_a_reference_stress_measures_each_node_by_what_it_would_make_there(self):
        """RESI_REFE_RELA: one square of side h gives each corner SIGM_REFE h / 4; springs at the free corners EFFORT_REFE besides."""
        side, stress, effort = 2.0, 50.0, 15.0
        lines = np.linspace(0, side, 2)
        text = f"""
model(20, "D_PLAN")
{{springs}}
PULL = AFFE_CHAR_MECA(MODELE=MODEL, FORCE_CONTOUR=_F(GROUP_MA="RIGHT", FX=300.0, FY=200.0))
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA="LEFT", DX=0.0, DY=0.0))
R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PULL, FONC_MULT=RAMP)),
                       COMPORTEMENT=_F(RELATION="ELAS", DEFORMATION="GREEN_LAGRANGE"), INCREMENT=_F(LIST_INST=DEFI_LIST_REEL(VALE=(0.0, 1.0))),
                       CONVERGENCE=_F(RESI_REFE_RELA=1e-4, SIGM_REFE={stress}, ITER_GLOB_MAXI=20, **LIMIT), **SPRINGS))
"""
        without = "LIMIT = SPRINGS = {}"
        springs = f"""
MESH = CREA_MAILLAGE(MAILLAGE=MESH, CREA_POI1=_F(NOM_GROUP_MA="HOOK", GROUP_MA="RIGHT"))
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=(_F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION="D_PLAN"),
                                         _F(GROUP_MA="HOOK", PHENOMENE="MECANIQUE", MODELISATION="2D_DIS_T")))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", MATER=MATTER))
SOFT = AFFE_CARA_ELEM(MODELE=MODEL, DISCRET_2D=_F(GROUP_MA="HOOK", CARA="K_T_D_N", VALE=(20.0, 20.0)))
SPRINGS, LIMIT = dict(CARA_ELEM=SOFT), dict(EFFORT_REFE={effort})
"""
        for case, reference in ((without, stress * side / 4), (springs, stress * side / 4 + effort)):
            run = self.run_text([block("QUAD4", lines, lines, None, "BODY", SIDES_2D)], text.format(springs=case))
            self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-2000:])
            rows = [[word.strip(" X") for word in line.split("|")] for line in run.stdout.splitlines() if re.match(r"^ \|\s*\d+X? +\|", line)]
            self.assertGreater(len(rows), 3)
            for number, row in enumerate(rows):
                self.assertAlmostEqual(float(row[4]) * reference / float(row[3]), 1, delta=2e-5)
                self.assertEqual(float(row[4]) <= 1e-4, number == len(rows) - 1)
        run = self.run_text([block("QUAD4", lines, lines, None, "BODY", SIDES_2D)], text.format(springs=springs + "LIMIT = {}"))
        self.assertEqual(run.status, 2)
        self.assertIn("<EVOLUTION_41>", run.stderr)

    def test_an_isostatic_press_fit_is_measured_against_its_contact_forces(self):
        """Two rings, one pressed into the other, held by nothing that reacts: the forces between them are the only ones.

        Without Poisson's effect no ring moves along the axis. The pressure is Lame's; the problem is linear but for statuses.
        """
        heights = np.linspace(0, 1, 5)
        inner = block("QUAD8", np.linspace(1, 2.05, 9), heights, None, "INNER", {"right": "SLAVE", "bottom": "BASE_1"})
        outer = block("QUAD8", np.linspace(2, 3, 7), heights, None, "OUTER", {"left": "MASTER", "bottom": "BASE_2"})
        run = self.run_text([union([inner, outer])], """
MATTER = DEFI_MATERIAU(ELAS=_F(E=2000.0, NU=0.0))
CUT = CREA_MAILLAGE(MAILLAGE=LIRE_MAILLAGE(UNITE=20), DECOUPE_LAC=_F(GROUP_MA_ESCL="SLAVE"))
MODEL = AFFE_MODELE(MAILLAGE=CUT, AFFE=_F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION="AXIS"))
FIELD = AFFE_MATERIAU(MAILLAGE=CUT, AFFE=_F(TOUT="OUI", MATER=MATTER))
FIT = DEFI_CONTACT(MODELE=MODEL, FORMULATION="CONTINUE", ALGO_RESO_GEOM="NEWTON", ALGO_RESO_CONT="NEWTON",
                   ZONE=_F(GROUP_MA_MAIT="MASTER", GROUP_MA_ESCL="SLAVE", ALGO_CONT="LAC", CONTACT_INIT="INTERPENETRE"))
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA=("BASE_1", "BASE_2"), DY=0.0))
R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=_F(CHARGE=HOLD), CONTACT=FIT,
                       COMPORTEMENT=_F(RELATION="ELAS", DEFORMATION="GREEN_LAGRANGE"),
                       INCREMENT=_F(LIST_INST=DEFI_LIST_REEL(VALE=(0.0, 1.0))), CONVERGENCE=_F(RESI_GLOB_RELA=1e-6, ITER_GLOB_MAXI=20)))
""")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-2000:])
        result = Result(self.folder / "loads.base", "R[0]")
        pressure = max(map(abs, result.on_cells("CONT_ELEM", 1, "PRES").values()))
        # what the pressure on an edge of length 1/4 gives the node in its middle, for one radian
        largest = pressure * 2 / 3 / 4 * 2.025
        for _, _, rela, maxi in lines(run)[-2:]:  # while the rings overlap the gap's derivative has more than the pressure
            self.assertAlmostEqual(maxi / rela / largest, 1, delta=0.02)


del LoadTest


if __name__ == "__main__":
    unittest.main()
