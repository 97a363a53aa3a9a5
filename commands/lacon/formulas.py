"""FORMULE: Python expressions of named parameters.

Beside its parameters an expression may use mathematics, Python's built-in functions, constants and functions given as further
keywords, and names that the study has when the formula is defined: their values are kept with it.
"""

import ast
import builtins
import json
import math
import numbers

from .concepts import Concept

_mathematics = {k: v for k, v in vars(math).items() if not k.startswith("_")}


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
        tree = ast.parse(self.text, mode="eval")
        bound = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)}
        bound |= {node.arg for node in ast.walk(tree) if isinstance(node, ast.arg)}
        used = dict.fromkeys(node.id for node in ast.walk(tree) if isinstance(node, ast.Name))
        return [n for n in used if n not in self.parameters and n not in bound and n not in _mathematics and not hasattr(builtins, n)]

    def value(self, point, name):
        """@param point parameter -> value. @throws AsterError FORMULE_2 with the point"""
        from .messages import AsterError, fail

        try:
            return eval(self._code, {**_mathematics, **self.values, **point})
        except AsterError:
            raise
        except Exception as error:
            missing = getattr(error, "name", None)
            reason = f"{missing} was not saved: {self.lost[missing]}" if missing in self.lost else f"{type(error).__name__}: {error}"
            fail("FORMULE_2", name=name, point=", ".join(f"{k} = {v!r}" for k, v in point.items()), reason=reason)


def formule(call):
    k = call.keywords
    parameters, text = k["NOM_PARA"], k["VALE"].strip().replace("\n", " ")
    for parameter in parameters:
        if not parameter.isidentifier():
            call.fail("FORMULE_3", "NOM_PARA", name=parameter)
    values = {name: value for name, value in k.items() if name not in ("NOM_PARA", "VALE")}
    try:
        expression = Expression(text, parameters, values)
    except (SyntaxError, ValueError) as error:
        call.fail("FORMULE_1", "VALE", reason=error.msg if isinstance(error, SyntaxError) else error)
    study = call.study.names.values
    for name in expression.names():
        if name in values:
            continue
        if name not in study:
            from .checker import nearest

            call.fail("FORMULE_4", "VALE", name=name, nearest=nearest(name, [*parameters, *call.study.names.user()]))
        expression.values[name] = study[name]
    saved, lost = {}, {}
    for name, value in expression.values.items():
        if isinstance(value, Concept):
            saved[name] = {"concept": value.id}
        elif isinstance(value, numbers.Real):
            saved[name] = float(value) if not isinstance(value, (int, bool)) else value
        elif not callable(value):
            call.fail("FORMULE_5", name, name=name, kind=type(value).__name__)
        else:
            lost[name] = "it is a function of the command file, and functions are not saved"
    call.keywords = {"NOM_PARA": parameters, "VALE": text, **{n: v for n, v in expression.values.items() if n in saved}}

    def fill(file):
        from .hdf5 import text_type

        file.attrs.create("parameters", parameters, dtype=text_type())
        file.attrs["expression"] = text
        file.attrs["constants"] = json.dumps(saved)
        file.attrs["lost"] = json.dumps(lost)

    formula = call.write("formula", fill)
    formula._expression = expression
    return formula


def read_formula(concept):
    with concept.open() as file:
        a = file.attrs
        constants = json.loads(a["constants"])
        values = {k: concept.base.concept(v["concept"]) if isinstance(v, dict) else v for k, v in constants.items()}
        return Expression(a["expression"], list(a["parameters"]), values, json.loads(a["lost"]))
