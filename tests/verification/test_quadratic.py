"""Newton's method converges quadratically once statuses have settled: on a curved master, on warped facets, with plasticity, in AXIS."""

import itertools
import math
import os
import pathlib
import re
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from meshes import block, brick, union, write_med  # noqa: E402

COMM = pathlib.Path(__file__).resolve().parent / "quadratic.comm"
NUMBER = r"\s*([-+.\dEe]+)[X ]*\s*\|"
LINE = re.compile(rf"^ \|\s*\d+[X ]*\s*\|{NUMBER}{NUMBER}", re.MULTILINE)


def hill(x, y):
    return 0.25 * math.cos(0.9 * x) + 0.1 * math.sin(1.1 * y)


def saddle(x, y):
    return 0.2 * (x - 1) * (y - 0.8) + 0.05 * x * x


ROUND_OFF = 1e-13  # of the largest force, of sums at nodes


def observed_order(residuals):
    """From the last three residuals, over the largest force; or from the three before the last one, which may be round-off: where one of the second order would be
    as well, it is taken for that."""
    before, last = residuals[-3:-1], residuals[-1]
    if last <= ROUND_OFF and before[1] * (before[1] / before[0]) ** 2 <= ROUND_OFF:
        return 2
    falls = np.diff(np.log(residuals[-4:]))
    return max(falls[1:] / falls[:-1])


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

    def plane_blocks(self, kind, radius):
        """The same in a plane, over an arc; in axisymmetry far from the axis, so that a ring can be drawn."""

        def arc(x):
            return math.sqrt(9 - (x - 1.6) ** 2) - 3

        upper = block(kind, np.linspace(0.6, 1.4, 5), np.linspace(0, 1, 5), lambda x, t: (radius + x, arc(x) + (0.9 - arc(x)) * t), "UPPER",
                      {"bottom": "SLAVE", "top": "LOAD"})
        lower = block(kind, np.linspace(0.1, 3, 13), np.linspace(0, 1, 6), lambda x, t: (radius + x, -1 + (arc(x) + 1) * t), "LOWER",
                      {"bottom": "BASE", "top": "MASTER"})
        path = self.folder / "plane_blocks.med"
        write_med(path, union([upper, lower]))
        return path

    def residuals(self, mesh, gap, path="0 0 0,0 0 -0.1,0.1 0.05 -0.12,0.4 0.25 -0.12", **environment):
        """RESI_GLOB_RELA of the iterations of the last instant, in which the block is drawn over more than a facet."""
        run = self.run_study(COMM, "--fresh", "--unit", f"20={mesh}", QUADRATIC_GAP=gap, QUADRATIC_PATH=path, **environment)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        last = run.stdout[run.stdout.rindex("Instant de calcul"):]
        return [float(rela) for rela, maxi in LINE.findall(last)]

    def order(self, mesh, gap):
        return observed_order(self.residuals(mesh, gap))

    def test_with_second_derivatives_of_gaps(self):
        for kind, skin in (("HEXA8", hill), ("HEXA20", hill), ("TETRA10", hill), ("HEXA8", saddle)):
            with self.subTest(cells=kind, skin=skin.__name__):
                self.assertGreaterEqual(self.order(self.blocks(kind, skin), "EXACTE"), 1.8)

    def test_without_them_convergence_is_linear(self):
        for skin in (hill, saddle):
            with self.subTest(skin=skin.__name__):
                self.assertLess(self.order(self.blocks("HEXA8", skin), "FIGEE"), 1.3)

    def test_in_the_plane_and_in_axisymmetry(self):
        """Few iterations of any law; their order where more than two falls lie between the last change of a status, or of what flows, and
        round-off. With frozen gaps there are 13 to 21."""
        at_once = {*itertools.product(("D_PLAN", "AXIS"), ("VMIS_ISOT_LINE/PETIT",), ("QUAD4", "QUAD8")), ("AXIS", "VMIS_ISOT_LINE/PETIT_REAC", "QUAD8"),
                   ("AXIS", "ELAS/PETIT", "QUAD4"), ("AXIS", "ELAS/PETIT", "QUAD8")}
        laws = ("ELAS/PETIT", "ELAS/PETIT_REAC", "VMIS_ISOT_LINE/PETIT", "VMIS_ISOT_LINE/PETIT_REAC")
        for model, law, kind in itertools.product(("D_PLAN", "AXIS"), laws, ("QUAD4", "QUAD8")):
            study = {"path": "0 0,0 -0.04,0.1 -0.06,0.35 -0.06", "QUADRATIC_MODEL": model, "QUADRATIC_LAW": law}
            with self.subTest(model=model, law=law, cells=kind):
                mesh = self.plane_blocks(kind, radius=20 if model == "AXIS" else 0)
                exact = self.residuals(mesh, "EXACTE", **study)
                self.assertLessEqual(len(exact), 9 if law.startswith("VMIS") else 8)
                if (model, law, kind) not in at_once:
                    self.assertGreaterEqual(observed_order(exact), 1.8)
                self.assertGreaterEqual(len(self.residuals(mesh, "FIGEE", **study)), 12)

    def test_plasticity_at_large_strains(self):
        study = {"path": "0 0,0 -0.04,0.1 -0.06,0.35 -0.06", "QUADRATIC_MODEL": "D_PLAN"}
        for law, kind in itertools.product(("GDEF_LOG", "SIMO_MIEHE", "GROT_GDEP"), ("QUAD4", "QUAD8")):
            with self.subTest(law=law, cells=kind):
                exact = self.residuals(self.plane_blocks(kind, radius=0), "EXACTE", QUADRATIC_LAW=f"VMIS_ISOT_LINE/{law}", **study)
                self.assertLessEqual(len(exact), 9)
                self.assertGreaterEqual(observed_order(exact), 1.8)


if __name__ == "__main__":
    unittest.main()
