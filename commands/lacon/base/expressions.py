"""Expressions of FORMULE: Python of named parameters, for command files and, over a pipe, for operators.

Beside its parameters an expression may use mathematics, Python's built-in functions, constants and functions given as further
keywords, and names that the study has when the formula is defined: their values are kept with it.
"""

import ast
import builtins
import functools
import json
import math
import numbers
import sys
import types

from ..core.concepts import Concept
from ..core.late import numpy
from ..core.messages import AsterError, fail
from . import names

_mathematics = {k: v for k, v in vars(math).items() if not k.startswith("_")}

#: mathematics that numpy computes on whole arrays, with numpy's name where it is another
_on_arrays = {**{n: n for n in ("sin cos tan sinh cosh tanh exp expm1 log1p log2 log10 sqrt fabs degrees radians copysign fmod hypot "
                                "floor ceil").split()},
              "asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2", "asinh": "arcsinh", "acosh": "arccosh",
              "atanh": "arctanh", "pow": "power"}
_operators = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow, ast.Mod, ast.FloorDiv, ast.UAdd, ast.USub)
_samples = 16  # points at which values of arrays are compared with those of single points
_round_off = 1e-9


class Expression:
    """A compiled expression with what its names stand for. `lost`: names whose values were not saved, with the reason."""

    def __init__(self, text, parameters, values, lost=None):
        self.text = text
        self.parameters = list(parameters)
        self.values = dict(values)
        self.lost = dict(lost or {})
        self._code = compile(text, "<formula>", "eval")

    def names(self):
        """Names that are neither parameters nor mathematics nor Python's own."""
        return [name for name in self.used() if not _is_provided(name)]

    def used(self):
        """Names that are not parameters."""
        tree = ast.parse(self.text, mode="eval")
        bound = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)}
        bound |= {node.arg for node in ast.walk(tree) if isinstance(node, ast.arg)}
        used = dict.fromkeys(node.id for node in ast.walk(tree) if isinstance(node, ast.Name))
        return [name for name in used if name not in self.parameters and name not in bound]

    def value(self, point, name):
        """@param point parameter -> value. @throws AsterError FORMULE_2 with the point"""
        try:
            return eval(self._code, {**_mathematics, **self.values, **point})
        except AsterError:
            raise
        except (Exception, SystemExit, GeneratorExit) as error:  # exit() ends no computation as if that had come to its end
            missing = getattr(error, "name", None)
            self._refuse(name, point, f"{missing} was not saved: {self.lost[missing]}" if missing in self.lost
                         else f"{type(error).__name__}: {error}")

    def values_at(self, columns, count, name):
        """An array of the values at `count` points. @param columns parameter -> array (count)

        Expressions that are elementwise by their form are computed on whole arrays and compared with single points; any other,
        and whatever numpy warns of, point by point. @throws AsterError FORMULE_2 with the first point that has no finite real value
        """
        result = self._on_arrays(columns, count, name)
        if result is not None:
            return result
        columns = {k: numpy.asarray(v, float).tolist() for k, v in columns.items()}
        result = numpy.empty(count)
        for i in range(count):
            result[i] = self._real({k: v[i] for k, v in columns.items()}, name)
        return result

    def _real(self, point, name):
        value = self.value(point, name)
        try:
            real = None if isinstance(value, (complex, str, bytes)) else float(value)
        except (TypeError, ValueError, OverflowError):
            real = None
        if real is None or not math.isfinite(real):
            self._refuse(name, point, f"the result is {value!r}, not a finite real number")
        return real

    def _refuse(self, name, point, reason):
        fail("FORMULE_2", name=name, point=", ".join(f"{k} = {v!r}" for k, v in point.items()), reason=reason)

    # ------------------------------------------------------------------------------------------- whole arrays

    def _on_arrays(self, columns, count, name):
        """The values, or nothing where they have to be computed point by point."""
        if count < 2 or not self._scope_of_arrays:
            return None
        try:
            with numpy.errstate(all="raise", under="ignore"):
                result = eval(self._code, {**self._scope_of_arrays, **columns})
            result = numpy.array(numpy.broadcast_to(numpy.asarray(result, float), count))
        except Exception:
            return None  # point by point it will be known where
        if not numpy.isfinite(result).all():
            return None
        chosen = {round(i * (count - 1) / (_samples - 1)) for i in range(_samples)} | {int(result.argmin()), int(result.argmax())}
        scale = _round_off * float(abs(result).max())
        for i in chosen:
            if abs(self._real({k: float(v[i]) for k, v in columns.items()}, name) - result[i]) > scale:
                return None
        return result

    @functools.cached_property
    def _scope_of_arrays(self):
        """What the expression's names stand for on whole arrays; empty where it is not elementwise by its form."""
        functions = {n: getattr(numpy, other) for n, other in _on_arrays.items()}
        functions["log"] = lambda x, *base: numpy.log(x) / numpy.log(base[0]) if base else numpy.log(x)
        functions.update(abs=numpy.abs, min=lambda *a: functools.reduce(numpy.minimum, a), max=lambda *a: functools.reduce(numpy.maximum, a))
        modules = {math: types.SimpleNamespace(**functions, pi=math.pi, e=math.e, tau=math.tau), sys.modules["numpy"]: numpy}
        scope = {}

        def resolve(name):
            """(what it stands for on arrays, whether it may be called); nothing where that is not known"""
            known = {**{k: v for k, v in _mathematics.items() if isinstance(v, float)}, **self.values}
            if name in known:
                value = known[name]
                if isinstance(value, numbers.Real):
                    return value, False
                if isinstance(value, Concept) and value.type in ("function", "formula"):
                    return value.on_arrays, True
                plain = getattr(value, "__name__", None)
                return (functions[plain], True) if plain in functions and vars(math).get(plain) is value else None
            return (functions[name], True) if name in functions else None

        def visit(node):
            if isinstance(node, ast.Expression):
                return visit(node.body)
            if isinstance(node, ast.Constant):
                return type(node.value) in (int, float)
            if isinstance(node, ast.BinOp):
                return isinstance(node.op, _operators) and visit(node.left) and visit(node.right)
            if isinstance(node, ast.UnaryOp):
                return isinstance(node.op, _operators) and visit(node.operand)
            if isinstance(node, ast.Name):
                if node.id in self.parameters:
                    return True
                found = resolve(node.id)
                if not found or found[1]:
                    return False
                scope[node.id] = found[0]
                return True
            if isinstance(node, ast.Call) and not node.keywords and not any(isinstance(a, ast.Starred) for a in node.args):
                return callable_node(node.func, len(node.args)) and all(map(visit, node.args))
            return False

        def callable_node(node, count):
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id not in self.parameters:
                holder = self.values.get(node.value.id)
                if not isinstance(holder, types.ModuleType) or holder not in modules or node.attr not in (
                        functions if holder is math else {*_on_arrays.values(), "log", "abs", "minimum", "maximum"}):
                    return False
                scope[node.value.id] = modules[holder]
                return True
            if not isinstance(node, ast.Name) or node.id in self.parameters:
                return False
            found = resolve(node.id)
            if not found or not found[1] or (node.id in ("min", "max") and count < 2):
                return False
            scope[node.id] = found[0]
            return True

        try:
            elementwise = visit(ast.parse(self.text, mode="eval"))
        except RecursionError:
            elementwise = False
        return {**scope, "__builtins__": {}} if elementwise else {}


def _is_provided(name):
    return name in _mathematics or hasattr(builtins, name)


def hides(name, value):
    """Whether a value of the study, a number, a function of its own or a concept, stands in the place of mathematics or of what Python has by that name.
    What numpy and the like have by it does not."""
    return _is_provided(name) and (isinstance(value, (numbers.Number, Concept)) or isinstance(value, types.FunctionType) and value.__module__ == "__main__")


def read_formula(concept):
    with concept.open() as file:
        a = file.attrs
        values, lost = {}, json.loads(a["lost"])
        for name, data in json.loads(a["constants"]).items():
            try:
                values[name] = names.decode(data, concept.base)
            except names.NotKept as reason:
                lost[name] = str(reason)
        return Expression(a["expression"], list(a["parameters"]), values, lost)


# -------------------------------------------------------------------------------------------------- for operators


def serve(stream, base):
    """Answer an operator's questions until it closes its end: docs/structures.md, section 5.

    @param stream  buffered, for reading and writing
    """
    while line := stream.readline():
        question = json.loads(line)
        parameters, count = question["parameters"], question["count"]
        data = numpy.frombuffer(stream.read(8 * len(parameters) * count), "<f8").reshape(len(parameters), count)
        formula = base.concept(question["formula"])
        try:
            values = formula.expression().values_at(dict(zip(parameters, data)), count, formula.label or formula.id)
        except AsterError as error:
            first = error.messages[0]
            answer, values = {"error": {"id": first.id, "text": first.text, "do": first.do}}, None
        else:
            answer = {"count": count}
        stream.write(json.dumps(answer).encode() + b"\n")
        if values is not None:
            stream.write(values.astype("<f8").tobytes())
        stream.flush()
