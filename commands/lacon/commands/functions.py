"""DEFI_FONCTION, DEFI_CONSTANTE: functions of one parameter by points; DEFI_NAPPE: of two; CALC_FONC_INTERP."""

import math

from ..base.expressions import Expression
from ..base.functions import Piecewise, between
from ..core.catalog import part
from ..core.hdf5 import text_type
from . import formulas
from .call import Call


def check_scales(call, path, interpolation, parameters, values):
    """@throws AsterError DEFI_FONCTION_4 where a logarithm would be of what is not positive, DEFI_FONCTION_8 where nothing can be between two points"""
    for numbers, scale, what in ((parameters, interpolation[0], "parameter"), (values, interpolation[1], "value")):
        for first, second in zip(numbers, numbers[1:]):
            if math.isinf(second - first):
                call.fail("DEFI_FONCTION_8", path, what=what, first=f"{first:g}", second=f"{second:g}")
        if scale == "LOG" and min(numbers) <= 0.0:
            call.fail("DEFI_FONCTION_4", path, what=what, value=f"{min(numbers):g}")


def make(call, function, path):
    """The function concept of a Piecewise that a command makes. @throws AsterError DEFI_FONCTION_4"""
    check_scales(call, path, function.interpolation, function.x, function.y)

    def fill(file):
        for name, value in (("parameter", function.parameter), ("component", function.component),
                            ("extension_left", function.left), ("extension_right", function.right)):
            file.attrs[name] = value
        file.attrs.create("interpolation", function.interpolation, dtype=text_type())
        file.create_dataset("x", data=function.x, dtype="f8")
        file.create_dataset("y", data=function.y, dtype="f8")

    return call.write("function", fill)


def described(call, x, y, like=None):
    """A Piecewise with the rules and names of NOM_PARA, NOM_RESU, INTERPOL, PROL_GAUCHE, PROL_DROITE; without them those of `like`."""
    k, like = call.keywords, like or Piecewise(x, y)
    interpolation = k.get("INTERPOL", like.interpolation)
    return Piecewise(x, y, tuple(interpolation) * 2 if len(interpolation) == 1 else interpolation, k.get("PROL_GAUCHE", like.left),
                     k.get("PROL_DROITE", like.right), k.get("NOM_PARA", like.parameter), k.get("NOM_RESU", like.component))


def defi_fonction(call):
    k = call.keywords
    x, y, path = _points(call)
    x, y = increasing(call, x, y, k["VERIF"], path)
    return make(call, described(call, x, y), path)


def increasing(call, x, y, check, path):
    """Points in increasing order: as they are, or sorted where VERIF is 'NON'. @throws AsterError DEFI_FONCTION_1, FUNCTION_25 (not finite)"""
    bad = next((i for i, point in enumerate(zip(x, y)) if not all(map(math.isfinite, point))), None)
    if bad is not None:
        call.fail("FUNCTION_25", path, number=bad + 1, x=f"{x[bad]:g}", y=f"{y[bad]:g}")
    if any(not a < b for a, b in zip(x, x[1:])):
        if check == "CROISSANT":
            bad = next(i for i in range(len(x) - 1) if not x[i] < x[i + 1])
            call.fail("DEFI_FONCTION_1", path, first=f"{x[bad]:g}", second=f"{x[bad + 1]:g}")
        order = sorted(range(len(x)), key=lambda i: x[i])
        x, y = [x[i] for i in order], [y[i] for i in order]
        if any(a == b for a, b in zip(x, x[1:])):
            bad = next(a for a, b in zip(x, x[1:]) if a == b)
            call.fail("DEFI_FONCTION_1", path, first=f"{bad:g}", second=f"{bad:g}")
    return x, y


def _points(call):
    """(x, y, keyword) as given in one of three ways."""
    k = call.keywords
    if "VALE" in k:
        if len(k["VALE"]) % 2:
            call.fail("DEFI_FONCTION_2", "VALE", count=len(k["VALE"]))
        return k["VALE"][0::2], k["VALE"][1::2], "VALE"
    if "ABSCISSE" in k:
        x, y, path = k["ABSCISSE"], k["ORDONNEE"], "ABSCISSE"
    else:
        x, y, path = k["VALE_PARA"].getValues(), k["VALE_FONC"].getValues(), "VALE_PARA"
    if len(x) != len(y):
        call.fail("DEFI_FONCTION_5", path, parameters=len(x), values=len(y))
    return x, y, path


#: what a constant is a function of
_any_parameter = "TOUTPARA"


def defi_constante(call):
    k = call.keywords
    constant = Piecewise([1.0], [k["VALE"]], left="CONSTANT", right="CONSTANT", parameter=_any_parameter, component=k["NOM_RESU"])
    return make(call, constant, "VALE")


def calc_fonc_interp(call):
    k = call.keywords
    x = k["LIST_PARA"].getValues() if "LIST_PARA" in k else k["VALE_PARA"]
    path = "LIST_PARA" if "LIST_PARA" in k else "VALE_PARA"
    increasing(call, x, x, "CROISSANT", path)
    function = k["FONCTION"]
    if function.type == "formula":
        if len(function.getVariables()) != 1:
            call.fail("DEFI_FONCTION_6", "FONCTION", label=function.label or function.id, parameters=", ".join(function.getVariables()))
        like = Piecewise(x, x, parameter=function.getVariables()[0])
    else:
        like = function.points()
    return make(call, described(call, x, [float(y) for y in function.on_arrays(x)], like), path)


# ------------------------------------------------------------------------------------------------------ DEFI_NAPPE


def defi_nappe(call):
    """A formula of (NOM_PARA, parameter of the functions) that interpolates between functions."""
    k = call.keywords
    increasing(call, k["PARA"], k["PARA"], k["VERIF"], "PARA")
    curves = k.get("FONCTION") or [_curve(call, factor, i) for i, factor in enumerate(k["DEFI_FONCTION"], 1)]
    if len(curves) != len(k["PARA"]):
        call.fail("DEFI_FONCTION_5", "PARA", parameters=len(k["PARA"]), values=len(curves))
    names = {curve.points().parameter for curve in curves} - {_any_parameter}
    if len(names) != 1 or k["NOM_PARA"] in names:
        call.fail("DEFI_FONCTION_7", "FONCTION" if "FONCTION" in k else "NOM_PARA_FONC", names=", ".join(sorted(names)) or part("none"), parameter=k["NOM_PARA"])
    other = names.pop()
    scales = (tuple(k["INTERPOL"]) * 2)[:2]
    check_scales(call, "PARA", scales, k["PARA"], [y for curve in curves for y in curve.points().y])
    text = f"between(({k['NOM_PARA']}, {other}), parameters, curves, interpolation, sides)"
    values = {"between": between, "parameters": list(k["PARA"]), "curves": list(curves), "interpolation": scales,
              "sides": (k["PROL_GAUCHE"], k["PROL_DROITE"])}
    return formulas.make(call, Expression(text, [k["NOM_PARA"], other], values))


def _curve(call, factor, number):
    """A function concept for one occurrence of DEFI_FONCTION."""
    keywords = {"NOM_PARA": call.keywords["NOM_PARA_FONC"], "NOM_RESU": call.keywords["NOM_RESU"], "VERIF": "CROISSANT", **factor}
    return defi_fonction(Call(call.study, call.command, keywords, call.where, f"{call.label}_{number}" if call.label else ""))
