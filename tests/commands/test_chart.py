"""Curves on a terminal."""

import math
import unittest

import support
from lacon.tools.chart import chart


#: bits of a Braille pattern by row and column
DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))


class Charts(unittest.TestCase):
    def test_a_dot_stands_where_its_value_is(self):
        """Two dots across and four down in a character; the scale names its ends."""
        top, bottom = chart([[(0, 1.0)], [(3, 0.0)]], width=13, height=2, lower=0.0, upper=1.0)
        self.assertEqual(top, "        1┤⠁⠀")
        self.assertEqual(bottom, "        0┤⠀⢀")

    def test_decades_are_equally_far_apart(self):
        rows = chart([[(0, 1.0)], [(2, 1e-2)], [(4, 1e-4)]], width=14, height=3, lower=1e-4, upper=1.0, log=True)
        self.assertEqual([row[0:10] for row in rows], ["    1e+00┤", "          ", "    1e-04┤"])
        self.assertEqual([[column for column, c in enumerate(row[10:]) if ord(c) > 0x2800] for row in rows], [[0], [1], [2]])

    def test_neighbours_are_joined(self):
        """A curve that falls by the whole scale from one dot to the next leaves no gap."""
        rows = chart([[(0, 1.0), (1, 0.0)]], width=12, height=2, lower=0.0, upper=1.0)
        self.assertEqual("".join(row[10] for row in rows), "⡇⢸".replace("⡇", chr(0x2800 | 0x47)).replace("⢸", chr(0x2800 | 0xb8)))

    def test_points_that_are_apart_are_joined_by_a_straight_line(self):
        (row,) = chart([[(0, 0.0), (6, 1.0)]], width=15, height=1, lower=0.0, upper=1.0)
        dots = [(2 * c + x, y) for c, sign in enumerate(row[10:]) for y in range(4) for x in range(2) if (ord(sign) - 0x2800) & DOTS[y][x]]
        self.assertEqual(sorted(dots), [(0, 3), (1, 3), (2, 2), (3, 2), (4, 1), (5, 1), (6, 0)])

    def test_what_is_not_a_number_is_left_out(self):
        rows = chart([[(0, math.nan), (1, math.inf), (2, 0.5)]], width=13, height=1, lower=0.0, upper=1.0)
        self.assertEqual(sum(bin(ord(c) - 0x2800).count("1") for row in rows for c in row[10:]), 1)

    def test_values_beyond_the_scale_lie_on_its_edge(self):
        self.assertEqual(chart([[(0, 9.0)]], 12, 1, 0.0, 1.0), ["        0┤⠁"])


if __name__ == "__main__":
    support.main()
