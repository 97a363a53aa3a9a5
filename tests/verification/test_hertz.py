"""Contacts of Hertz on three meshes: pressure, radius and approach come to theory."""

import os
import pathlib
import sys

SOURCE = pathlib.Path(os.environ["LACON_SOURCE_DIR"])
sys.path[:0] = [str(SOURCE / "tests/studies"), str(SOURCE / "commands/studies/roller_bearing")]

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
import hertz  # noqa: E402


class Hertz(StudyTest):
    def test_pressure_radius_and_approach_come_to_theory(self):
        """Of the finest mesh 0.2 %; the approach no nearer than the size of the bodies lets it, half width / extent."""
        for model, rows in hertz.errors(self).items():
            error = {name: [abs(getattr(found, name) / getattr(theory, name) - 1) for found, theory in rows] for name in ("pressure", "radius", "approach")}
            with self.subTest(model):
                for name in ("pressure", "radius"):
                    self.assertLess(error[name][-1], 2e-3, name)
                    self.assertLess(error[name][-1], error[name][0] / 4, name)  # four times as fine, of the first order at least
                self.assertLess(max(error["approach"]), hertz.HALF_WIDTH / hertz.EXTENT)
