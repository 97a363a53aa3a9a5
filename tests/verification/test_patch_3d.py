"""Patch test in space, on the peer's meshes: every kind of slave face and both cuts of a hexahedron are exact."""

import os
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import PEER_MESHES, StudyTest  # noqa: E402

COMM = pathlib.Path(__file__).resolve().parent / "patch_3d.comm"
#: minimum and maximum of each of LAGS_C, PRES, SIZZ, JEU, COEFSURF, CONT
CHECKS = 12


@unittest.skipUnless(PEER_MESHES.is_dir(), f"the peer's meshes are not in {PEER_MESHES} (set LACON_SHARED_CASES)")
class Patch3D(StudyTest):
    def run_patch(self, mesh, cut, slave, master, base, load, x, y, model="3D"):
        run = self.run_study(COMM, "--fresh", "--checks", "all", "--unit", f"20={PEER_MESHES / mesh}", PATCH_CUT=cut, PATCH_SLAVE=slave,
                             PATCH_MASTER=master, PATCH_BASE=base, PATCH_LOAD=load, PATCH_X=x, PATCH_Y=y, PATCH_MODEL=model)
        self.assert_all_ok(run, CHECKS)

    def run_both(self, name, cut):
        """Either block as the slave."""
        for slave, master in (("Group_1", "Group_2"), ("Group_2", "Group_1")):
            with self.subTest(mesh=name, cut=cut, slave=slave):
                self.run_patch(f"{name}.mmed", cut, slave, master, "Group_3", "Group_4", "Symx", "Symy")

    def test_tetrahedra(self):
        self.run_both("ssnp170k", "PYRA")
        self.run_both("ssnp170p", "PYRA")

    def test_hexahedra_cut_in_hexahedra(self):
        """Trapezoids: the degree of the rule follows their distortion."""
        self.run_both("ssnp170m", "HEXA")
        self.run_both("ssnp170w", "HEXA")

    def test_hexahedra_cut_in_pyramids(self):
        """Quadratic ones too, where the peer's rule for PYRAM13 is not exact."""
        self.run_both("ssnp170m", "PYRA")
        self.run_both("ssnp170w", "PYRA")
        self.run_both("ssnp170r", "PYRA")

    def test_hexahedra_of_eight_points(self):
        self.run_patch("ssnp170r.mmed", "PYRA", "Group_1", "Group_2", "Group_3", "Group_4", "Symx", "Symy", model="3D_SI")

    def test_prisms_and_pyramids_on_either_face(self):
        for unit in range(20, 28):
            with self.subTest(mesh=f"ssnp170z.{unit}"):
                self.run_patch(f"ssnp170z.{unit}", "PYRA", "cont_escl", "cont_mait", "base", "press", "symx", "symy")


if __name__ == "__main__":
    unittest.main()
