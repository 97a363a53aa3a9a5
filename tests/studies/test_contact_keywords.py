"""A study with the words of other contact methods: its answers are known in closed form."""

import pathlib
import unittest

import numpy as np
from study_test import StudyTest, two_columns

from meshes import write_med

COMM = pathlib.Path(__file__).resolve().parent / "contact_keywords.comm"


class ContactKeywords(StudyTest):
    def test_every_answer_is_that_of_two_columns(self):
        mesh, low, _ = two_columns()
        ground = next(i for i, (x, y) in enumerate(low.points) if (x, y) == (0, 0))
        lines = mesh.cells["SEG2"]
        mesh.cell_groups["LINK"] = [("SEG2", len(lines))]
        mesh.cells["SEG2"] = np.vstack([lines, [ground, mesh.node_groups["EDGE"][0]]])
        write_med(self.folder / "mesh.med", mesh)
        run = self.run_study(COMM, "--unit", f"20={self.folder / 'mesh.med'}")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        # the first study: the whole force E d / 2 on two edges, a quarter of it on the corners and a half in the middle
        forces = [float(line.split()[-1]) for line in run.stdout.splitlines() if line.split()[:1] == ["REACTION"]]
        self.assertAlmostEqual(forces[2], -5.0 / 2, places=9)
        self.assertIn("EVOLUTION_35", run.stderr)
        self.assertIn("CHARGE_20", run.stderr)


if __name__ == "__main__":
    unittest.main()
