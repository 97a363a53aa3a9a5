"""What stat_non_line says where DEFORMATION='PETIT' meets displacements that are not small: the two squares, turned or stretched as a whole."""

import math
import re
import unittest

import numpy as np
from test_stat_non_line import TwoSquares, square


class MotionNotices(TwoSquares):
    def move(self, degrees=0.0, stretch=0.0, deformation="PETIT"):
        """Turn both squares, and pull them along y, by all displacements, in two steps. @return alarms: (instant, what is said)"""
        turn = math.radians(degrees)
        gradient = np.array([[math.cos(turn) - 1, -math.sin(turn)], [math.sin(turn), math.cos(turn) - 1 + stretch]])
        moved = np.array(square(-1) + square(0)) @ gradient.T
        self.write_load("load_5", imposed=[(n, name, value) for n, row in enumerate(moved) for name, value in zip(("DX", "DY"), row)])
        self.write_function("function_10", [0.0, 2.0], [0.0, 1.0])
        self.write_list("list_of_reals_8", [0.0, 1.0, 2.0])
        run = self.solve(CONTACT=None, loads=[{"CHARGE": {"concept": "load_5"}, "FONC_MULT": {"concept": "function_10"}}],
                         COMPORTEMENT={"RELATION": "ELAS", "DEFORMATION": deformation, "TOUT": "OUI"})
        self.assertEqual(run.status, 0, run.stderr)
        self.said = run.stderr
        return re.findall(r"<EVOLUTION_59> .* at the instant (\S+) a tenth of the cells of .*, M[45] among them, (.*?): (?:forces|gaps) ", run.stderr)

    def test_turns_are_told_once_a_body(self):
        self.assertEqual(self.move(degrees=4), [("2", "have turned by 4 degrees or more, which it takes for a strain of 0.24 %")] * 2)
        self.assertIn("several times over where it is held tightly", self.said)
        self.assertEqual([instant for instant, _ in self.move(degrees=20)], ["1", "1"])

    def test_strains_are_told(self):
        self.assertEqual(self.move(stretch=0.25), [("2", "are strained by 25 % or more")] * 2)

    def test_what_is_small_or_meant_to_be_large_is_not(self):
        for quiet in ({"degrees": 2.5, "stretch": 0.1}, {"degrees": 20, "deformation": "GROT_GDEP"}):
            self.move(**quiet)
            self.assertNotIn("EVOLUTION_59", self.said)

    def test_compression_beyond_what_green_lagrange_strains_resist_is_told(self):
        """E (l^3 - l) / 2 is largest in compression at l = 1 / sqrt(3): 42 %."""
        for stretch, deformation, told in ((-0.45, "GROT_GDEP", 2), (-0.45, "GREEN_LAGRANGE", 2), (-0.4, "GROT_GDEP", 0), (-0.45, "GDEF_LOG", 0)):
            self.assertEqual(self.move(stretch=stretch, deformation=deformation), [])
            self.assertEqual(len(re.findall(r"<EVOLUTION_61> at the instant 2 a tenth of the cells of .* are compressed by 45 % or more", self.said)), told, deformation)


if __name__ == "__main__":
    unittest.main()
