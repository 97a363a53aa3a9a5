"""L2 norms of interpolation errors converge as theory says, on every way a field takes from functions to a norm."""

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

COMM = pathlib.Path(__file__).resolve().parent / "norms.comm"


class Norms(StudyTest):
    def slopes(self, meshes, models, refinements):
        """@return for each mesh: group -> log2 of the ratio of the last two errors"""
        units = []
        for k, mesh in enumerate(meshes):
            write_med(self.folder / f"{k}.med", mesh)
            units += ["--unit", f"{20 + k}={self.folder / f'{k}.med'}"]
        run = self.run_study(COMM, *units, STUDY_MODELS=",".join(models), STUDY_REFINEMENTS=str(refinements))
        self.assertEqual(run.status, 0, run.stdout[-4000:] + run.stderr[-4000:])
        found = json.loads((self.folder / "norms.json").read_text())
        return [{group: math.log2(errors[-2] / errors[-1]) for group, errors in one.items()} for one in found]

    def test_the_plane(self):
        """Order p + 1. Errors at the points alone: linear triangles and segments have no point where the error is small."""
        s, t = np.array([0, 0.3, 0.62, 1.0]), np.array([0, 0.45, 1.0])
        kinds = {"TRIA3": (2, 2), "QUAD8": (3, 3)}
        found = self.slopes([block(kind, s, t, None, "BODY", {"top": "LOAD"}) for kind in kinds], ["D_PLAN"] * len(kinds), 2)
        for (kind, orders), slopes in zip(kinds.items(), found):
            with self.subTest(cell=kind):
                print(kind, {group: round(slope, 3) for group, slope in slopes.items()})
                for group, order in zip(("BODY", "LOAD"), orders):
                    self.assertLess(abs(slopes[group] - order), 0.1)

    def test_space(self):
        lines = (np.array([0, 0.45, 1.0]),) * 3
        kinds = {"TETRA4": 2, "HEXA8": 2}
        found = self.slopes([brick(kind, lines, None, "BODY", {(2, 1): "LOAD"}) for kind in kinds], ["3D"] * len(kinds), 2)
        for (kind, order), slopes in zip(kinds.items(), found):
            with self.subTest(cell=kind):
                print(kind, {group: round(slope, 3) for group, slope in slopes.items()})
                for slope in slopes.values():
                    self.assertLess(abs(slope - order), 0.15)


if __name__ == "__main__":
    unittest.main()
