"""Patch test in space: every slave kind on every master kind, stacked along a direction that is no axis."""

import os
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import StudyTest  # noqa: E402
import patch_space  # noqa: E402, I001 (study_test says where meshes.py is)
from patch_space import study  # noqa: E402


class SpaceTest(StudyTest):
    def assert_exact(self, studies):
        for one, found in zip(studies, patch_space.run(self, studies)):
            with self.subTest(slave=one.slave, master=one.master, shaking=one.shaking, scale=one.scale, jacobian=one.jacobian):
                tolerance = patch_space.tolerance(one)
                self.assertLessEqual(found.pressure, tolerance)
                self.assertLessEqual(found.stress, tolerance)
                self.assertLessEqual(found.displacement, tolerance)
                self.assertLessEqual(found.gap, 1e-10)
                self.assertLessEqual(found.cover, 1e-3 * tolerance)
                self.assertEqual(found.active, 0)


class PatchInSpace(SpaceTest):
    def test_every_kind_of_facet_on_every_other_side(self):
        """Each kind of slave facet, each cut and each kind of master once; on distorted meshes too, small and large."""
        self.assert_exact([study("TETRA4", "QUAD8", shaking=True, scale=1e-3), study("TETRA10", "QUAD4", scale=1e3),
                           study("PENTA15 quadrangle", "TRIA3", shaking=True), study("PYRAM13 triangle", "TRIA6", shaking=True, scale=1e3),
                           study("HEXA8 in PYRA", "QUAD9", scale=1e-3), study("HEXA8 in HEXA", "TRIA6", shaking=True),
                           study("HEXA20 in PYRA", "TRIA3", shaking=True, scale=1e-3), study("HEXA20 in HEXA", "QUAD4", shaking=True, scale=1e3),
                           study("HEXA27", "QUAD8", shaking=True)])

    def test_on_the_current_area_the_pressure_is_less_by_the_stretch(self):
        """ACTUALISE: -p A0 / A with A / A0 = (1 + nu p / E)^2."""
        studies = [study(slave, master, shaking=slave != "HEXA20 in HEXA", jacobian="ACTUALISE")
                   for slave, master in (("TETRA4", "TRIA6"), ("HEXA8 in PYRA", "QUAD4"), ("HEXA20 in HEXA", "QUAD8"), ("HEXA27", "QUAD9"))]
        self.assert_exact(studies)
        self.assertGreater((1 + patch_space.POISSON * patch_space.PRESSURE / patch_space.YOUNG) ** 2 - 1, 5e-5)  # above every tolerance

    def test_mid_nodes_may_be_anywhere_on_straight_edges(self):
        """Off the middle by up to a tenth of the edge, on skins that are cut and on masters; nothing is left to iterate."""
        studies = [study(slave, master, sliding=0.1) for slave, master in (("HEXA20 in HEXA", "QUAD8"), ("HEXA20 in PYRA", "TRIA6"),
                                                                          ("PENTA15 quadrangle", "QUAD9"), ("HEXA27", "QUAD8"))]
        self.assert_exact(studies)

    def test_coinciding_edges_of_trapezoids_leave_nothing_to_iterate(self):
        """Borders of both skins coincide to round-off: polygons win and lose vertices there, but no couple jumps by the error of quadrature."""
        for found in patch_space.run(self, [study("HEXA8 in HEXA", "TRIA3", shaking=True), study("HEXA20 in HEXA", "TRIA6", shaking=True)]):
            self.assertLessEqual(found.iterations, 2)


class Matrix(SpaceTest):
    """All pairs: minutes, label `long`."""

    def test_every_pair(self):
        self.assert_exact(patch_space.matrix())

    def test_every_pair_on_distorted_meshes(self):
        self.assert_exact(patch_space.matrix(shaking=True))

    def test_every_pair_on_small_distorted_meshes(self):
        self.assert_exact(patch_space.matrix(shaking=True, scale=1e-3))

    def test_every_pair_on_large_meshes(self):
        self.assert_exact(patch_space.matrix(shaking=True, scale=1e3))

    def test_every_pair_on_the_current_area(self):
        self.assert_exact(patch_space.matrix(shaking=True, jacobian="ACTUALISE"))


if __name__ == "__main__":
    unittest.main()
