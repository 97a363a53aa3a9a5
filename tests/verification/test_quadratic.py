"""Newton's method in space converges quadratically once statuses have settled: on a curved master, on warped facets."""

import math
import os
import pathlib
import re
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from meshes import brick, union, write_med  # noqa: E402

COMM = pathlib.Path(__file__).resolve().parent / "quadratic.comm"
NUMBER = r"\s*([-+.\dEe]+)[X ]*\s*\|"
LINE = re.compile(rf"^ \|\s*\d+[X ]*\s*\|{NUMBER}{NUMBER}", re.MULTILINE)


def hill(x, y):
    return 0.25 * math.cos(0.9 * x) + 0.1 * math.sin(1.1 * y)


def saddle(x, y):
    return 0.2 * (x - 1) * (y - 0.8) + 0.05 * x * x


class Quadratic(StudyTest):
    def blocks(self, kind, skin):
        """A block, whose lower face follows the skin, over a larger one with this skin: where they start they touch."""

        def place(bottom, top):
            def at(x, y, t):
                low, high = bottom(x, y), top(x, y)
                return x, y, low + (high - low) * t
            return at

        curved = kind != "HEXA8"
        upper = brick(kind, [np.linspace(0.6, 1.4, 3), np.linspace(0.5, 1.2, 3), np.linspace(0, 1, 3)],
                      place(skin, lambda x, y: 0.9), "UPPER", {(2, 0): "SLAVE", (2, 1): "LOAD"}, curved=curved)
        lower = brick(kind, [np.linspace(0, 2.6, 6), np.linspace(0, 2, 5), np.linspace(0, 1, 3)],
                      place(lambda x, y: -1.0, skin), "LOWER", {(2, 0): "BASE", (2, 1): "MASTER"}, curved=curved)
        path = self.folder / "blocks.med"
        write_med(path, union([upper, lower]))
        return path

    def residuals(self, mesh, gap):
        """RESI_GLOB_MAXI of the iterations of the last instant, in which the block is drawn over more than a facet."""
        path = "0 0 0,0 0 -0.1,0.1 0.05 -0.12,0.4 0.25 -0.12"
        run = self.run_study(COMM, "--fresh", "--unit", f"20={mesh}", QUADRATIC_GAP=gap, QUADRATIC_PATH=path)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        last = run.stdout[run.stdout.rindex("Instant de calcul"):]
        return [float(maxi) for rela, maxi in LINE.findall(last)]

    def order(self, mesh, gap):
        """Observed, from the last three residuals; or from the three before the last one, which may be round-off."""
        logs = np.log(self.residuals(mesh, gap))
        self.assertGreaterEqual(len(logs), 4)
        falls = np.diff(logs[-4:])
        return max(falls[1:] / falls[:-1])

    def test_with_second_derivatives_of_gaps(self):
        for kind, skin in (("HEXA8", hill), ("HEXA20", hill), ("TETRA10", hill), ("HEXA8", saddle)):
            with self.subTest(cells=kind, skin=skin.__name__):
                self.assertGreaterEqual(self.order(self.blocks(kind, skin), "EXACTE"), 1.8)

    def test_without_them_convergence_is_linear(self):
        for skin in (hill, saddle):
            with self.subTest(skin=skin.__name__):
                self.assertLess(self.order(self.blocks("HEXA8", skin), "FIGEE"), 1.3)


if __name__ == "__main__":
    unittest.main()
