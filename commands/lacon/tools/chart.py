"""Curves on a terminal: dots of Unicode's Braille patterns, two by four in a character, with a scale on the left."""

import math

#: bits of a Braille pattern by (row, column) of its dot
_dots = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
_blank = 0x2800
_margin = 9  #: columns of the scale


def columns_of(width):
    """How many dots there are across, in so many columns of the terminal."""
    return 2 * max(width - _margin - 2, 1)


def chart(curves, width, height, lower, upper, log=False, level=None, marks=()):
    """Lines of text. @param curves lists of (x, y), x counts dots from 0; what is not finite is left out  @param lower, upper ends of the scale
    @param level a y at which a dashed line runs  @param marks x of dotted upright lines"""
    columns = columns_of(width) // 2
    scale = math.log10 if log else float
    low, high = scale(lower), scale(upper)

    def row(y):
        """The row of dots of a value, from the top; values beyond the scale lie on its edge."""
        part = (scale(y) - low) / (high - low) if high > low else 0.0
        return round((1.0 - min(max(part, 0.0), 1.0)) * (4 * height - 1))

    cells = [[0] * columns for _ in range(height)]

    def dot(x, at):
        if 0 <= x < 2 * columns:
            cells[at // 4][x // 2] |= _dots[at % 4][x % 2]

    for x in marks:
        for at in range(0, 4 * height, 4):
            dot(x, at)
    if level is not None:
        for x in range(0, 2 * columns, 4):
            dot(x, row(level))
            dot(x + 1, row(level))
    for curve in curves:
        before = None
        for x, y in curve:
            if not math.isfinite(y) or (log and y < 0):
                before = None
                continue
            at = row(max(y, lower))
            for between, across in _line(before or (x, at), (x, at)):
                dot(between, across)
            before = x, at
    ends = {0: upper, height - 1: lower}
    number = "{:>9.0e}" if log else "{:>9.6g}"
    return [(number.format(ends[i]) if i in ends else " " * _margin) + " ┤"[i in ends] + "".join(chr(_blank | bits) for bits in line)
            for i, line in enumerate(cells)]


def _line(first, last):
    """The dots of a straight line between two of them."""
    steps = max(abs(last[0] - first[0]), abs(last[1] - first[1]), 1)
    return [tuple(a + math.floor((b - a) * step / steps + 0.5) for a, b in zip(first, last)) for step in range(steps + 1)]
