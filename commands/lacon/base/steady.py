"""Formulae whose values depend on their parameters and on the values of their names alone: not on files, chance or time. Any other is taken for changed."""

import ast
import builtins
import functools
import re

from ..core.late import numpy

#: what an expression may use without becoming one whose value may change from run to run
_builtins = frozenset("abs bool complex divmod float int len max min pow round sum".split())
_modules = frozenset("math cmath numpy numpy.linalg numpy.fft numpy.polynomial".split())
#: of numpy beside its functions of arrays, its numbers and the types of them; what is not known to compute alone may read a file (loadtxt, lib.npyio)
_of_numpy = frozenset("""arange array asanyarray asarray ascontiguousarray asfortranarray asmatrix bartlett blackman c_ dtype errstate eye fft finfo frombuffer
    fromfunction fromiter frompyfunc fromstring full hamming hanning identity iinfo index_exp indices isscalar kaiser linalg mgrid ndarray ndindex newaxis
    ogrid ones poly1d polynomial r_ s_ tri vectorize zeros""".split())


@functools.cache
def is_expression(text):
    """Whether the text of an expression uses nothing of Python that may change by itself."""
    names = {node.id for node in ast.walk(ast.parse(text, mode="eval")) if isinstance(node, ast.Name)}
    return "random" not in text and names.isdisjoint(set(vars(builtins)) - _builtins)


def are_values(text, encoded):
    """Whether that holds for the modules among the values of an expression's names, for what it takes from them, and for what was imported from any.
    @param encoded  the values as names.encode() makes them, in JSON"""
    modules = set(re.findall(r'\{"module": "([^"]*)"', encoded))
    imports = re.findall(r'\{"import": \["([^"]*)", "([^"]*)"', encoded)
    homes = modules | {module for module, _ in imports}
    taken = {name for module, name in imports if module == "numpy"}
    if "numpy" in modules:
        taken |= _attributes(text)
    return all(home in _modules or home.startswith("numpy.polynomial.") for home in homes) and all(map(_computes, taken))


@functools.cache
def _attributes(text):
    return frozenset(node.attr for node in ast.walk(ast.parse(text, mode="eval")) if isinstance(node, ast.Attribute))


def _computes(name):
    """Whether what numpy has by this name computes, and does no more. What it does not have is of arrays."""
    value = getattr(numpy, name, None)
    if value is None or name in _of_numpy:
        return not name.startswith("__")
    if isinstance(value, type):
        return value in (int, float, complex, bool) or issubclass(value, numpy.generic) and not issubclass(value, (numpy.datetime64, numpy.timedelta64))
    # functions of arrays, which other kinds of arrays may replace, hold what they wrap
    return isinstance(value, (int, float, numpy.ufunc)) or (hasattr(value, "__wrapped__") and not name.startswith("save"))
