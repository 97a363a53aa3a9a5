"""Functions of one parameter by points, and between such functions."""

import bisect
import math

from ..core.late import numpy
from ..core.messages import fail


class Piecewise:
    """Points with x increasing, interpolation of x and y (LIN or LOG), extension on either side, names of x and y."""

    def __init__(self, x, y, interpolation=("LIN", "LIN"), left="EXCLU", right="EXCLU", parameter="INST", component="TOUTRESU"):
        self.x, self.y = list(x), list(y)
        self.interpolation = tuple(interpolation)
        self.left, self.right = left, right
        self.parameter, self.component = parameter, component

    def value(self, x, name="function"):
        """@throws AsterError DEFI_FONCTION_3 where x lies outside and the function is not prolonged there, DEFI_FONCTION_9 where a logarithm ends"""
        if hasattr(x, "__len__") and not isinstance(x, (str, bytes)):
            return numpy.array([self.value(v, name) for v in x])
        if isinstance(x, (str, bytes)):
            raise TypeError(f"{name} takes numbers, and {x!r} is a text")
        x = float(x)
        if len(self.x) == 1:
            return self._alone(x, name)
        low, high = self.x[0], self.x[-1]
        # an instant reached by adding steps misses the last point by round-off
        slack = 1e-12 * max(abs(low), abs(high))
        if low - slack <= x < low:
            x = low
        if high < x <= high + slack:
            x = high
        if x < low or x > high:
            side = self.left if x < low else self.right
            if side == "EXCLU":
                fail("DEFI_FONCTION_3", name=name, x=f"{x:g}", low=f"{low:g}", high=f"{high:g}")
            if side == "CONSTANT":
                return self.y[0] if x < low else self.y[-1]
        i = min(max(bisect.bisect_right(self.x, x) - 1, 0), len(self.x) - 2)
        if self.interpolation[0] == "LOG" and x <= 0.0:
            fail("DEFI_FONCTION_9", name=name, x=f"{x:g}")
        return self._between(i, x)

    def _alone(self, x, name):
        side = self.left if x < self.x[0] else self.right
        if x != self.x[0] and side == "EXCLU":
            fail("DEFI_FONCTION_3", name=name, x=f"{x:g}", low=f"{self.x[0]:g}", high=f"{self.x[0]:g}")
        return self.y[0]

    def _between(self, i, x):
        """On the line through points i and i + 1, in the scales of `interpolation`."""
        x0, x1, y0, y1 = self.x[i], self.x[i + 1], self.y[i], self.y[i + 1]
        if x == x0:
            return y0
        if x == x1:
            return y1
        if self.interpolation[0] == "LOG":
            t = math.log(x / x0) / math.log(x1 / x0)
        else:
            t = (x - x0) / (x1 - x0)
        if self.interpolation[1] == "LOG":
            return y0 * (y1 / y0) ** t
        return y0 + t * (y1 - y0)


def read_function(concept):
    """The Piecewise of a function's concept."""
    with concept.open() as file:
        a = file.attrs
        return Piecewise(file["x"][:].tolist(), file["y"][:].tolist(), list(a["interpolation"]), a["extension_left"], a["extension_right"],
                         a["parameter"], a["component"])


def between(point, parameters, curves, interpolation, sides):
    """The value at (parameter, abscissa) between the curves at `parameters`. @throws AsterError DEFI_FONCTION_3 outside"""
    parameter, x = point
    if len(curves) == 1:
        return Piecewise(parameters, [curves[0](x)], interpolation, *sides).value(parameter, "PARA")
    i = min(max(bisect.bisect_right(parameters, parameter) - 1, 0), len(curves) - 2)
    ends = [curve(x) for curve in curves[i:i + 2]]
    local = Piecewise(parameters[i:i + 2], ends, interpolation, sides[0] if i == 0 else "EXCLU",
                      sides[1] if i == len(curves) - 2 else "EXCLU")
    return local.value(parameter, "PARA")
