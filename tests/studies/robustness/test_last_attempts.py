"""What is tried before an instant is given up: iterations that are nearly at their end go on, and others are searched along their increments."""

import dataclasses
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from study_test import LACON, StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from run import chosen, run  # noqa: E402
from unseen import study as unseen  # noqa: E402


class NearlyAtTheirEnd(StudyTest):
    """A cylinder that is pressed in by 30 % of its radius needs iterations 0 to 5, whose residuals fall quadratically."""
    NEEDS = 6

    def of(self, most):
        (_, study), = chosen(["hertz/30 % QUAD8 PETIT slab"])
        return run(dataclasses.replace(study, most=most), LACON, self.folder)

    def test_iterations_go_on_that_are_nearly_at_their_end(self):
        figures = self.of(4)
        self.assertEqual((figures["status"], figures["solutions"], figures["lost"]), ("finished", self.NEEDS, 0))

    def test_more_than_half_as_many_again_are_told(self):
        """To say that the step should be cut would be wrong."""
        self.assertIn("EVOLUTION_4", self.of(3)["status"])
        told = re.findall(r"the residual comes to its end within (\d+) \(CONVERGENCE/ITER_GLOB_MAXI\)", (self.folder / "err").read_text())
        self.assertTrue(told)
        for count in map(int, told):
            self.assertIn(count, range(self.NEEDS - 1, self.NEEDS + 3))
            self.assertEqual(self.of(count)["status"], "finished")


class Searched(StudyTest):
    """Drawn studies that stopped, and finished with RECH_LINEAIRE=_F(METHODE='MIXTE') in all their instants."""

    def test_a_step_that_no_cut_helps_is_searched(self):
        for number in (3112, 70008):
            study = unseen(number)
            with self.subTest(study.name):
                self.assertFalse(study.cut)
                self.assertEqual(run(study, LACON, self.folder)["status"], "finished")
                self.assertIn("<EVOLUTION_71>", (self.folder / "err").read_text())
