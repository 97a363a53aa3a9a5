"""Curved contact: the error of the pressure falls as theory says, for spheres in axisymmetry and in space and for rings."""

import os
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import StudyTest  # noqa: E402
import convergence  # noqa: E402, I001 (study_test says where meshes.py is)


class OrderTest(StudyTest):
    def assert_orders(self, cases, quadratic):
        """Order of the mean error between the last two meshes: 1 for linear cells (0.1 for being far from the limit)."""
        for name, found in convergence.errors(self, cases).items():
            with self.subTest(name):
                values = [error.mean for error in found]
                order = convergence.orders(values, cases[name][1])[-1]
                print(f"{name}: {', '.join(f'{value:.1e}' for value in values)}, order {order:.2f}")
                self.assertGreaterEqual(order, 0.9 if name.endswith(convergence.LINEAR) else quadratic)


class Convergence(OrderTest):
    def test_spheres_and_rings(self):
        self.assert_orders({name: case for name, case in convergence.CASES.items() if name.endswith(("QUAD4", "TRIA6"))}, 1.5)

    def test_the_closed_form_of_the_rings_is_the_published_one(self):
        """-9394977.169 at 0, -9259259.259 at 45, -9123541.350 at 90 degrees."""
        mean, wave = convergence.ring_pressure()
        for found, published in ((mean + wave, -9394977.169), (mean, -9259259.259), (mean - wave, -9123541.350)):
            self.assertAlmostEqual(found, published, delta=1e-3)


class EveryConvergence(OrderTest):
    """Label `long`."""

    def test_spheres_and_rings_of_every_cell(self):
        self.assert_orders(convergence.CASES, 1.5)

    def test_spheres_in_space(self):
        """The meshes are coarse: order 1 is asked of quadratic cells too."""
        self.assert_orders(convergence.SPACE_CASES, 1.0)


if __name__ == "__main__":
    unittest.main()
