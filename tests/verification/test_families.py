"""Studies like those that users of contact have, against theory."""

import math
import unittest

from load_study import StudyTest  # noqa: I001 (it says where meshes.py is)
import families


class Families(StudyTest):
    def test_a_pressed_ring_bends_as_thin_rings_do(self):
        ring = families.pressed_ring(self)
        self.assertGreater(ring.force, 0)
        # stretch and shear of the ring: (t / R)^2 times figures of the order of 1
        for found, theory in ((ring.lower, ring.lower_thin), (ring.wider, ring.wider_thin)):
            self.assertAlmostEqual(found / theory, 1, delta=3 * (families.THICKNESS / families.RADIUS) ** 2)
        # one patch h touches, and its average gap vanishes: the crown stands h^2 / 6 R behind the plate, at both ends
        outer = families.RADIUS + families.THICKNESS / 2
        h = outer * math.pi / 2 / 48
        self.assertAlmostEqual(ring.lower, families.CRUSH - 2 * h**2 / (6 * outer), delta=1e-3 * families.CRUSH)

    def test_a_flange_is_in_balance(self):
        tight, loaded, clamp, load = families.flange(self)
        self.assertAlmostEqual(loaded, clamp + load, delta=1e-6 * tight)
        self.assertLess(loaded - tight, 0.2 * load)


del StudyTest

if __name__ == "__main__":
    unittest.main()
