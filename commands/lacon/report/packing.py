"""Arrays as texts in a page: numbers in few bytes, deflated."""

import base64
import zlib

from ..core.late import numpy

absent = 65535  #: of quantised numbers: there is none
_level = 5


class Packing:
    """Arrays that the page unpacks when it needs them, by their number."""

    def __init__(self):
        self.texts = []

    def add(self, values, kind):
        """@param kind "u1", "u2", "i4", "u4" or "f4"  @return the reference by which the page finds it"""
        values = numpy.ascontiguousarray(values, dtype="<" + kind).ravel()
        shuffled = values.view(numpy.uint8).reshape(-1, values.itemsize).T.tobytes()  # first bytes of all first: they deflate better
        self.texts.append(base64.b64encode(zlib.compress(shuffled, _level)).decode("ascii"))
        return {"id": len(self.texts) - 1, "type": kind}

    def add_quantised(self, columns):
        """Numbers in 16 bits between the least and the largest of their column, nan as absent. @param columns (n, c)  @return (reference, ranges)"""
        low, high = (numpy.zeros(columns.shape[1]) for _ in range(2))
        known = numpy.isfinite(columns)
        for c in range(columns.shape[1]):
            if known[:, c].any():
                low[c], high[c] = columns[known[:, c], c].min(), columns[known[:, c], c].max()
        with numpy.errstate(invalid="ignore", divide="ignore"):
            step = numpy.where(high > low, (absent - 1) / (high - low), 0.0)
            whole = numpy.where(known, numpy.rint((columns - low) * step), absent)
        return self.add(whole.T, "u2"), numpy.column_stack([low, high]).tolist()

    def elements(self):
        """The arrays as elements of the page."""
        return "\n".join(f'<script type="text/plain" id="array-{number}">{text}</script>' for number, text in enumerate(self.texts))
