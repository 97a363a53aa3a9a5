"""Bodies in space that nothing but contact holds, and that come to rest where their load leads them, whichever side is the slave."""

import itertools
import re
import unittest

import numpy as np
from study_test import StudyTest

from meshes import brick, union, write_med
from results import Result

#: BODY on WALLS, which are held at BASE; other nodes of it by imposed displacements, a load
STUDY = """
DEBUT()
MESH = LIRE_MAILLAGE(UNITE=20, FORMAT="MED")
MESH = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL={slaves}))
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION="3D"))
MATTER = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=(_F(GROUP_MA="BODY", MATER=DEFI_MATERIAU(ELAS=_F(E={young}, NU=0.3))),
                                            _F(GROUP_MA="WALLS", MATER=DEFI_MATERIAU(ELAS=_F(E=2e5, NU=0.3)))))
CONTACT = DEFI_CONTACT(MODELE=MODEL, FORMULATION="CONTINUE", ALGO_RESO_GEOM="NEWTON", ALGO_RESO_CONT="NEWTON",
                       ZONE=[_F(GROUP_MA_ESCL=slave, GROUP_MA_MAIT=master, ALGO_CONT="LAC") for slave, master in {zones}])
HELD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA="BASE", DX=0.0, DY=0.0, DZ=0.0), {held}))
LOADED = AFFE_CHAR_MECA(MODELE=MODEL, {load})
RESULT = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, CONTACT=CONTACT, EXCIT=(_F(CHARGE=HELD), _F(CHARGE=LOADED)),
                       COMPORTEMENT=_F(TOUT="OUI", RELATION="ELAS", DEFORMATION="{strain}"),
                       INCREMENT=_F(LIST_INST=DEFI_LIST_REEL(VALE=(0.0, 1.0))), CONVERGENCE=_F(ITER_GLOB_MAXI=20))
CALC_CHAMP(reuse=RESULT, RESULTAT=RESULT, FORCE="REAC_NODA")
FIN()
"""


def lines(first, last, cells):
    return np.linspace(first, last, cells + 1)


class RestInSpace(StudyTest):
    def rests(self, mesh, expected, **study):
        """The body comes to rest within ten iterations, and its load goes into the base. @param expected the force on the base"""
        write_med(self.folder / "mesh.med", mesh)
        file = self.folder / "study.comm"
        file.write_text(STUDY.format(**study), encoding="utf-8")
        run = self.run_lacon(file, "--unit", "20=mesh.med", "--fresh")
        self.assertEqual(run.status, 0, run.stdout[-2000:] + run.stderr)
        self.assertLessEqual(int(re.search(r"Converged at the instant 1 with (\d+) iteration", run.stdout)[1]), 10)
        result = Result(self.folder / "study.base", "RESULT")
        base = sorted({node for cell in result.groups["BASE"] for node in result.cells[cell][1]})
        found = [result.at_nodes("REAC_NODA", result.orders[-1], name)[base].sum() for name in ("DX", "DY", "DZ")]
        np.testing.assert_allclose([found[axis] for axis in expected], list(expected.values()), rtol=1e-5, atol=1e-9)
        return run.stdout + run.stderr

    def test_a_plate_on_two_posts(self):
        """One post touches, the other one is lower. Rows of patches across the plate say the same of it but for its strains: it was flung off, with 9 or 10 cells."""
        for cells, gap, (slave, master) in itertools.product((8, 9, 10, 11), (0.005, 0.02), itertools.permutations(("BOTTOM", "TOPS"))):
            plate = brick("HEXA8", [lines(0, 11, cells), lines(0, 4, 5), lines(2, 2.5, 2)], None, "BODY", {(2, 0): "BOTTOM", (2, 1): "LOADED", (1, 0): "MIDDLE"})
            posts = [brick("HEXA8", [lines(*x, 2), lines(0, width, 2), lines(0, height, 3)], None, "WALLS", {(2, 1): "TOPS", (2, 0): "BASE", (1, 0): "MIDDLE"})
                     for x, width, height in (((1, 2), 1, 2), ((9.5, 10.5), 2.4, 2 - gap))]
            mesh = union([plate, *posts])
            mesh.node_groups["CORNER"] = mesh.nodes_where(lambda x, y, z: np.abs(x) + np.abs(y) + np.abs(z - 2) < 1e-9)
            with self.subTest(cells=cells, gap=gap, slave=slave):
                self.rests(mesh, {2: 0.02 * 11 * 4}, slaves=[slave], zones=[(slave, master)], young=2e5, strain="PETIT",
                           held='_F(GROUP_MA="MIDDLE", DY=0.0), _F(GROUP_NO="CORNER", DX=0.0)', load='FORCE_FACE=_F(GROUP_MA="LOADED", FZ=-0.02)')

    def test_a_block_that_nothing_presses_is_told(self):
        """Wherever it is nothing moves it, whichever side is the slave."""
        for slave, master in itertools.permutations(("BOTTOM", "FLOOR")):
            block = brick("HEXA8", [lines(0, 2, 3), lines(0, 2, 3), lines(0.1, 2.1, 3)], None, "BODY", {(0, 0): "SIDE", (1, 0): "MIDDLE", (2, 0): "BOTTOM"})
            floor = brick("HEXA8", [lines(-1, 3, 5), lines(-1, 3, 5), lines(-1, 0, 2)], None, "WALLS", {(2, 1): "FLOOR", (2, 0): "BASE"})
            for load, told in ((0.0, 1), (-0.1, 0)):
                said = self.rests(union([block, floor]), {2: -8 * load}, slaves=[slave], zones=[(slave, master)], young=1e3, strain="PETIT",
                                  held='_F(GROUP_MA="MIDDLE", DY=0.0), _F(GROUP_MA="SIDE", DX=0.0)', load=f'FORCE_INTERNE=_F(GROUP_MA="BODY", FZ={load})')
                self.assertEqual(said.count("<EVOLUTION_23>"), told, (slave, load))

    def test_a_block_in_a_corner(self):
        """Away from a floor and a wall, which are the slaves, and whose patches it covers in strips: these held it, and lost it again."""
        for (gap, strain), (n, m) in itertools.product(((0.1, "PETIT"), (0.1, "GREEN_LAGRANGE"), (0.5, "PETIT")), ((3, 4), (3, 8), (5, 8))):
            block = brick("HEXA8", [lines(gap, 10 + gap, n), lines(0, 10, n), lines(gap, 10 + gap, n)], None, "BODY", {(0, 0): "SIDE", (1, 0): "MIDDLE", (2, 0): "BOTTOM"})
            floor = brick("HEXA8", [lines(-2, 14, m), lines(-2, 14, m), lines(-4, 0, 2)], None, "WALLS", {(2, 1): "FLOOR", (2, 0): "BASE"})
            wall = brick("HEXA8", [lines(-4, 0, 2), lines(-2, 14, m), lines(0, 14, m)], None, "WALLS", {(0, 1): "WALL", (0, 0): "BASE"})
            with self.subTest(gap=gap, cells=n, patches=m, strain=strain):
                self.rests(union([block, floor, wall]), {0: 2.0, 2: 5.0}, slaves=["FLOOR", "WALL"], zones=[("FLOOR", "BOTTOM"), ("WALL", "SIDE")], young=1e3,
                           strain=strain, held='_F(GROUP_MA="MIDDLE", DY=0.0)', load='FORCE_INTERNE=_F(GROUP_MA="BODY", FX=-0.002, FZ=-0.005)')


if __name__ == "__main__":
    unittest.main()
