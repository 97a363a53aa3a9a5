"""Fields of their own: CREA_CHAMP, TEST_RESU of CHAM_NO and CHAM_ELEM, IMPR_RESU of CHAM_GD, their Python objects."""

import pathlib
import sys
import unittest

import h5py
import numpy as np
from study_test import StudyTest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from meshes import block, write_med  # noqa: E402 (study_test.py says where it is)

COMM = pathlib.Path(__file__).resolve().parent / "fields.comm"


class Fields(StudyTest):
    def test_fields_of_their_own(self):
        mesh = block("QUAD4", np.array([0, 1.0, 2.0]), np.array([0, 1.0]), None, "BODY", {"bottom": "BASE"})
        mesh.cell_groups["FIRST"] = [mesh.cell_groups["BODY"][0]]
        mesh.node_groups["FAR"] = mesh.nodes_where(lambda x, y: x == 2 and y == 0)
        write_med(self.folder / "mesh.med", mesh)
        outputs = [f"--unit={unit}={self.folder / name}" for unit, name in ((20, "mesh.med"), (80, "out.med"), (81, "out.pvd"), (8, "out.resu"))]
        run = self.run_study(COMM, "--checks", "all", *outputs)
        self.assert_all_ok(run, 6)
        with h5py.File(self.folder / "out.med") as file:
            self.assertEqual(sorted(file["CHA"]), ["NODES", "POINTS", "XY"])
            step = next(iter(file["CHA/XY"].values()))["NOE"]
            profile = next(iter(step.values()))
            np.testing.assert_array_equal(profile["CO"][()], [0, 0, 0])  # Y on the base
        self.assertIn("NODES", (self.folder / "out.resu").read_text())
        with h5py.File(self.folder / "twice.med") as file:
            self.assertEqual(list(file["CHA"]), ["NEUT_R"])


if __name__ == "__main__":
    unittest.main()
