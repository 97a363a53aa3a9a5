"""Hertz in axisymmetry: the pressure at the nodes of the skin."""

import unittest

import hertz_axis
from load_study import LoadTest


class HertzInAxisymmetry(LoadTest):
    def test_pressures_at_nodes_are_those_of_hertz(self):
        found = hertz_axis.run(self)
        # the nodal forces of contact carry the load: equilibrium of the sphere, RESI_GLOB_RELA 1e-6
        self.assertAlmostEqual(found.force / found.reaction, 1, delta=1e-5)
        # patches are h = 0.079 wide: the mean of two means at the node between them is h^2 p'' / 6 off, 0.4 % of the largest pressure at 0.8
        # of the radius, 1.117; the rest is for bodies of eleven radii in the place of half-spaces
        self.assertLess(found.worst_inside(0.8), 0.01)
        for radius, pressure, gap, normal in found.rows:
            if radius > 1.3 * found.radius:
                self.assertEqual(pressure, 0)
                self.assertGreater(gap, 0)
            self.assertLess(normal, -0.9)  # down, off the sphere


if __name__ == "__main__":
    unittest.main()
