"""Bodies that contact and weak springs hold: they start where they are near, and do not go through each other."""

import re
import unittest

import numpy as np
from study_test import StudyTest

from meshes import block, union, write_med
from results import Result

#: a body BODY on what is held at BASE, under a pressure on TOP
STUDY = """
DEBUT()
MESH = LIRE_MAILLAGE(UNITE=20, FORMAT="MED")
MESH = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL="SKIN"))
MESH = CREA_MAILLAGE(MAILLAGE=MESH, CREA_POI1=_F(NOM_GROUP_MA="HOOKS", GROUP_MA="BODY"))
MODEL = AFFE_MODELE(
    MAILLAGE=MESH,
    AFFE=(
        _F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION="D_PLAN"),
        _F(GROUP_MA="HOOKS", PHENOMENE="MECANIQUE", MODELISATION="2D_DIS_T"),
    ),
)
SPRINGS = AFFE_CARA_ELEM(MODELE=MODEL, DISCRET_2D=_F(GROUP_MA="HOOKS", CARA="K_T_D_N", VALE=({spring}, {spring})))
MATTER = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", MATER=DEFI_MATERIAU(ELAS=_F(E=210e3, NU=0.3))))
CONTACT = DEFI_CONTACT(
    MODELE=MODEL,
    FORMULATION="CONTINUE",
    ALGO_RESO_GEOM="NEWTON",
    ALGO_RESO_CONT="NEWTON",
    ZONE=_F(GROUP_MA_ESCL="SKIN", GROUP_MA_MAIT="WALL", ALGO_CONT="LAC"),
)
HELD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=({held}))
PRESSED = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA="TOP", PRES={pressure}){more})
RESULT = STAT_NON_LINE(
    MODELE=MODEL,
    CHAM_MATER=MATTER,
    CARA_ELEM=SPRINGS,
    CONTACT=CONTACT,
    EXCIT=(_F(CHARGE=HELD), _F(CHARGE=PRESSED)),
    INCREMENT=_F(LIST_INST=DEFI_LIST_REEL(VALE=(0.0, 1.0))),
    CONVERGENCE=_F(ITER_GLOB_MAXI={iterations}),
)
CALC_CHAMP(reuse=RESULT, RESULTAT=RESULT, FORCE="REAC_NODA")
FIN()
"""
FIXED = '_F(GROUP_MA="BASE", DX=0.0, DY=0.0),'


class LooseBodies(StudyTest):
    def solve(self, mesh, spring, pressure, held="", more="", status=0, iterations=10):
        """@return (displacement of the highest node, force on the base, what was said), of a run that stops what was said alone"""
        write_med(self.folder / "mesh.med", mesh)
        study = self.folder / "study.comm"
        study.write_text(STUDY.format(spring=spring, pressure=pressure, held=FIXED + held, more=more, iterations=iterations), encoding="utf-8")
        run = self.run_lacon(study, "--unit", "20=mesh.med", "--fresh")
        self.assertEqual(run.status, status, run.stdout[-2000:] + run.stderr)
        if status:
            return None, None, run.stdout + run.stderr
        result = Result(self.folder / "study.base", "RESULT")
        moved = result.at_nodes("DEPL", result.orders[-1], "DY")
        forces = result.at_nodes("REAC_NODA", result.orders[-1], "DY")
        return moved[np.argmax(result.points[:, 1])], np.nansum(forces), run.stdout + run.stderr

    def rocker(self, cells, gap):
        """A block with a round underside, of radius 25 and a load at the height of 5: it stands."""
        up = block("QUAD8", np.linspace(-5, 5, cells + 1), np.linspace(0, 1, 4), lambda x, t: (x, (gap + 0.02 * x * x) * (1 - t) + (5 + gap) * t), "BODY",
                   {"bottom": "SKIN", "top": "TOP"})
        low = block("QUAD8", np.linspace(-8, 8, cells + 7), np.linspace(-6, 0, 5), None, "LOW", {"top": "WALL", "bottom": "BASE"})
        return union([up, low])

    def test_a_body_that_tips_on_one_patch_does_not_go_through_the_other(self):
        """Iterations left the equilibrium on one patch, which is not stable, for one 16 metres below the slab."""
        moved, force, said = self.solve(self.rocker(5, 0.05), 1e-3, 100.0)
        self.assertLess(abs(moved), 0.2)
        self.assertAlmostEqual(force, 1000, delta=1)  # springs have 1e-3 a node
        self.assertIn("EVOLUTION_54", said)
        self.assertIn("the bodies have gone through each other", said)

    def test_covers_that_iterates_far_away_ask_for_are_not_told(self):
        _, force, said = self.solve(self.rocker(20, 0.5), 1e-3, 100.0, '_F(GROUP_MA="TOP", DX=0.0),', ', LIAISON_UNIF=_F(GROUP_MA="TOP", DDL="DY")')
        self.assertAlmostEqual(force, 1000, delta=1)
        self.assertNotIn("<A>", said)

    def test_a_body_that_falls_on_weak_springs_ends_on_the_other(self):
        """Its first increment leads thousands of patches deep: 10 iterations, with all patches pressing there or one, where 3 are enough."""
        for gap in (0.5, 1.5):
            _, force, said = self.solve(self.rocker(20, gap), 1e-3, 100.0, '_F(GROUP_MA="TOP", DX=0.0),', ', LIAISON_UNIF=_F(GROUP_MA="TOP", DDL="DY")')
            self.assertAlmostEqual(force, 1000, delta=1)
            self.assertLessEqual(int(re.search(r"Converged at the instant 1 with (\d+) iteration", said)[1]), 4)

    def test_bodies_that_a_step_flings_apart_are_told(self):
        """Pushed away from the other body by thousands of metres, which weak springs allow; stiff ones leave nothing to tell."""
        for spring, told in ((1e-3, 1), (1e3, 0)):
            _, _, said = self.solve(self.rocker(20, 0.0), spring, 0.0, more=', FORCE_CONTOUR=_F(GROUP_MA="TOP", FX=100.0, FY=200.0)')
            self.assertEqual(said.count("<EVOLUTION_66>"), told)

    def test_a_body_that_a_step_flings_through_the_other_stops(self):
        """Pushed along it at the top: it tips, and weak springs let it swing through the slab."""
        _, _, said = self.solve(self.rocker(20, 0.0), 1e-3, 0.0, more=', FORCE_CONTOUR=_F(GROUP_MA="TOP", FX=100.0)', status=3)
        self.assertRegex(said, r"<EVOLUTION_63> .* at slave cell [MS]?\w+ by [\d.e+]+ sizes of a patch")

    def test_loads_near_round_off_are_told(self):
        """Statuses are not told apart below 1e-14 of the coordinates times the stiffness; the same in proportion is right at a larger load."""
        for pressure, told in ((1e-6, 1), (1e-2, 0)):
            _, force, said = self.solve(self.rocker(20, 0.0), pressure * 1e-5, pressure, '_F(GROUP_MA="TOP", DX=0.0),')
            self.assertAlmostEqual(force / pressure, 10, delta=0.1)
            self.assertEqual(said.count("<EVOLUTION_65>"), told)

    def slot(self, gap, under=0.0):
        """A block above the floor of a slot, between walls."""
        box = block("QUAD8", np.linspace(0, 2, 4), np.linspace(0, 2, 4), None, "BODY", {"bottom": "SKIN", "left": "LEFT", "right": "RIGHT", "top": "TOP"})
        floor = block("QUAD8", np.linspace(-1, 3, 6), np.linspace(-1, -under, 3), None, "FLOOR", {"top": "WALL", "bottom": "BASE"})
        walls = [block("QUAD8", np.linspace(*ends, 2), np.linspace(0, 2, 3), None, name, {face: f"{name}_FACE", back: f"{name}_BACK"})
                 for name, ends, face, back in (("W1", (-1 - gap, -gap), "right", "left"), ("W2", (2 + gap, 3 + gap), "left", "right"))]
        mesh = union([box, floor, *walls])
        groups = mesh.cell_groups
        groups["SKIN"] = groups["SKIN"] + groups.pop("LEFT") + groups.pop("RIGHT")
        groups["WALL"] = groups["WALL"] + groups.pop("W1_FACE") + groups.pop("W2_FACE")
        groups["BASE"] = groups["BASE"] + groups.pop("W1_BACK") + groups.pop("W2_BACK")
        return mesh

    def test_one_zone_holds_in_all_directions(self):
        """The floor holds the block upright in the zone; what is near it on the sides holds it too."""
        moved, force, said = self.solve(self.slot(0.002), 0.0, 1000.0)
        self.assertAlmostEqual(force, 2000, delta=1e-6)
        self.assertRegex(said, re.compile(r"EVOLUTION_20> nothing holds BODY: 6 patch\(es\) of SKIN, .* with the gap 0.002"))

    def cell(self, kind, cells, gap):
        """A block between four walls."""
        body = block(kind, np.linspace(0, 2, cells + 1), np.linspace(0, 2, cells + 1), None, "BODY", {side: "SKIN" for side in ("bottom", "top", "left", "right")})
        walls = [block(kind, np.linspace(*x, 4), np.linspace(*y, 3), None, f"WALL{k}", {face: "WALL", back: "BASE"})
                 for k, (x, y, face, back) in enumerate((((-1, 3), (-1 - gap, -gap), "top", "bottom"), ((-1, 3), (2 + gap, 3 + gap), "bottom", "top"),
                                                         ((-1 - gap, -gap), (0, 2), "right", "left"), ((2 + gap, 3 + gap), (0, 2), "left", "right")))]
        mesh = union([body, *walls])
        mesh.cell_groups["TOP"] = mesh.cell_groups["SKIN"][-1:]
        return mesh

    def test_a_block_comes_to_rest_where_its_load_leads_it(self):
        """With contact on all walls, which are as near, it has no equilibrium; without that on the others, there is nothing to find."""
        for kind, cells in (("QUAD4", 3), ("TRIA3", 4), ("QUAD8", 4), ("TRIA6", 6)):
            _, force, said = self.solve(self.cell(kind, cells, 0.002), 0.0, 0.0, more=', FORCE_INTERNE=_F(GROUP_MA="BODY", FX=500.0, FY=10.0)')
            self.assertAlmostEqual(force, -40, delta=1e-6)
            self.assertIn("<EVOLUTION_20>", said)
            self.assertLessEqual(int(re.search(r"Converged at the instant 1 with (\d+) iteration", said)[1]), 3)

    def test_a_block_that_nothing_presses_is_told_where_it_touches_nothing(self):
        """Springs in the matrix alone keep it where it is, in the middle of the cell."""
        for kind, cells, gap in (("QUAD4", 3, 0.002), ("QUAD8", 4, 0.002), ("TRIA6", 3, 1e-4)):
            _, _, said = self.solve(self.cell(kind, cells, gap), 0.0, 0.0)
            self.assertEqual(said.count("<EVOLUTION_23>"), 1)
            self.assertNotIn("EVOLUTION_72", said)  # of round-off alone

    def test_a_block_that_springs_of_the_matrix_carry_to_a_wall_gets_there(self):
        """Each iteration moves it by as much, against the same force, and there are enough of them: it does not hang on nothing."""
        walls = [block("QUAD4", np.linspace(start, start + 1, 3), np.linspace(-1, 2, n), None, "LOW", {near: "WALL", far: "BASE"})
                 for start, n, near, far in ((-1, 6, "right", "left"), (1.201, 7, "left", "right"))]
        body = block("QUAD4", np.linspace(0.001, 1.001, 4), np.linspace(0, 1, 4), None, "BODY", {"left": "SKIN", "right": "SKIN", "top": "TOP", "bottom": "FOOT"})
        _, _, said = self.solve(union([body, *walls]), 0.0, 0.0, '_F(GROUP_MA="FOOT", DY=0.0),', ', FORCE_INTERNE=_F(GROUP_MA="BODY", FX=3000.0)', iterations=40)
        self.assertGreater(int(re.search(r"Converged at the instant 1 with (\d+) iteration", said)[1]), 7)

    def test_a_pile_falls_together(self):
        """Three blocks above a slab, of which the middle one has no slave of its own."""
        sides = ({"bottom": "SKIN", "top": "TOP"}, {"bottom": "WALL", "top": "WALL"}, {"bottom": "SKIN", "top": "SKIN"}, {"bottom": "BASE", "top": "WALL"})
        blocks = [block("QUAD4", np.linspace(0, 2, 4 + k), np.linspace(0, 1, 3) - 1.01 * k, None, name, {**of, "left": "AXIS"})
                  for k, (name, of) in enumerate(zip(("BODY", "SECOND", "THIRD", "LOW"), sides))]
        moved, force, said = self.solve(union(blocks), 0.0, 100.0, '_F(GROUP_MA="AXIS", DX=0.0),')
        self.assertAlmostEqual(force, 200, delta=1e-6)
        self.assertAlmostEqual(moved, -0.03 - 4 * 100 / 210e3, delta=4e-4)
        self.assertLessEqual(int(re.search(r"Converged at the instant 1 with (\d+) iteration", said)[1]), 2)

    def test_plates_in_one_zone_do_not_touch_themselves(self):
        """Both sides of the middle plate are in the zone, and three cells thick: shifts of 1e-4 coupled them through it, and no step was short enough."""
        sides = ({"bottom": "SKIN", "top": "TOP"}, {"bottom": "SKIN", "top": "WALL"}, {"bottom": "BASE", "top": "WALL"})
        plates = [block("QUAD8", np.linspace(0, 50, 51), np.linspace(*ends, 4), None, name, {**of, "left": "AXIS"})
                  for name, ends, of in zip(("BODY", "SECOND", "LOW"), ((3, 8), (0, 3), (-5, 0)), sides)]
        moved, force, said = self.solve(union(plates), 0.0, 1.0, '_F(GROUP_MA="AXIS", DX=0.0),')
        self.assertAlmostEqual(force, 50, delta=1e-9)
        self.assertAlmostEqual(moved, -13 / (210e3 / (1 - 0.3**2)), delta=5e-6)
        self.assertNotIn("<A>", said)

    def test_a_needle_that_covers_too_little_of_a_patch_is_told(self):
        """By 0.8 % of one, where contact is taken from 2 % on; a wider one stands."""
        low = block("QUAD4", np.linspace(-1, 2, 4), np.linspace(-1, 0, 2), None, "LOW", {"top": "SKIN", "bottom": "BASE"})
        for width, status in ((0.008, 3), (0.08, 0)):
            needle = block("QUAD4", np.linspace(0.3, 0.3 + width, 3), np.linspace(0, 0.1, 3), None, "BODY", {"bottom": "WALL", "top": "TOP"})
            _, _, said = self.solve(union([needle, low]), 0.0, 1.0, '_F(GROUP_MA="BODY", DX=0.0),', status=status)
            told = re.search(r"<SOLVER_3> .*slave cells (\w+) of SKIN\) see their master on ([\d.]+) % of their size", said)
            self.assertEqual(told and told[2], "0.8" if status else None, said[-2000:])

    def table(self, gaps):
        """A plate over two feet, each lower than the other one's gap would have it."""
        plate = block("QUAD8", np.linspace(0, 10, 11), np.linspace(0, 1, 3), None, "BODY", {"bottom": "SKIN", "top": "TOP"})
        feet = [block("QUAD8", np.linspace(x, x + 1, 4), np.linspace(-1, -gap, 3), None, f"FOOT{x}", {"top": f"TOP{x}", "bottom": f"BASE{x}"})
                for x, gap in zip((1, 8), gaps)]
        mesh = union([plate, *feet])
        groups = mesh.cell_groups
        groups["WALL"] = groups.pop("TOP1") + groups.pop("TOP8")
        groups["BASE"] = groups.pop("BASE1") + groups.pop("BASE8")
        return mesh

    def test_a_plate_that_stands_on_two_feet_tips_onto_the_second(self):
        """The nearest patch is on one foot, and the plate is loose on it."""
        for gaps in ((0.0, 0.0), (0.01, 0.03), (0.2, 0.1)):
            moved, force, said = self.solve(self.table(gaps), 0.0, 1.0, '_F(GROUP_MA="TOP", DX=0.0),')
            self.assertAlmostEqual(force, 10, delta=1e-9)
            tilt = (gaps[1] - gaps[0]) / 7
            self.assertAlmostEqual(moved, -(gaps[0] - 1.5 * tilt), delta=abs(tilt) + 0.005)  # either edge of a foot; it bends by 2e-3

    def test_walls_that_are_grazed_beside_a_corner_pierce_nothing(self):
        _, force, said = self.solve(self.slot(0.0), 0.0, 1000.0)
        self.assertAlmostEqual(force, 2000, delta=1e-6)
        self.assertNotIn("EVOLUTION_16", said)


if __name__ == "__main__":
    unittest.main()
