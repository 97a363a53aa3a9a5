"""FORCE_NODALE of AFFE_CHAR_MECA_F in axes of its own (ANGL_NAUT): formulae of the forces along the axes of the mesh."""

import math

from ..base.expressions import Expression
from ..core.catalog import part
from . import formulas
from .call import Call

_forces = ("FX", "FY", "FZ")


def along_the_mesh(call):
    """The keywords of the command without ANGL_NAUT. @throws AsterError MODIREPERE_5"""
    if not any("ANGL_NAUT" in factor for factor in call.keywords.get("FORCE_NODALE", ())):
        return call.keywords
    dimension = call.keywords["MODELE"].getMesh().getDimension()
    return {**call.keywords, "FORCE_NODALE": [_turned(call, dimension, factor, k) for k, factor in enumerate(call.keywords["FORCE_NODALE"], 1)]}


def _turned(call, dimension, factor, number):
    """An occurrence with a formula for each axis of the mesh."""
    if "ANGL_NAUT" not in factor:
        return factor
    angles, forces = list(factor["ANGL_NAUT"]), {name: factor[name] for name in _forces if name in factor}
    if dimension == 2 and (len(angles) > 1 or "FZ" in forces):
        call.fail("MODIREPERE_5", f"FORCE_NODALE[{number}]", keyword="FORCE_NODALE/ANGL_NAUT", expected=part("one_angle_in_the_plane"))
    made = {name: value for name, value in factor.items() if name not in ("ANGL_NAUT", *_forces)}
    needs = [parameters_of(function) for function in (*forces.values(), *angles)]
    parameters = list(dict.fromkeys(name for names in needs for name in names)) or ["INST"]
    values = {"turned": turned, "forces": list(forces.values()), "axes": [_forces.index(name) for name in forces], "angles": angles, "needs": needs}
    for axis, name in enumerate(_forces[:dimension]):
        text = f"turned({axis}, forces, axes, angles, needs, dict({', '.join(f'{p}={p}' for p in parameters)}))"
        own = Call(call.study, "FORMULE", {}, call.where, f"{call.label}_{name}_{number}" if call.label else "")
        made[name] = formulas.make(own, Expression(text, parameters, values))
    return made


def parameters_of(function):
    """Names of a function's or a formula's parameters; none of what is a function of anything (DEFI_CONSTANTE)."""
    names = function.Parametres()["NOM_PARA"]
    return [name for name in ([names] if isinstance(names, str) else names) if name != "TOUTPARA"]


def turned(axis, forces, axes, angles, needs, at):
    """The force along an axis of the mesh, of forces along `axes` that ANGL_NAUT turns: about Z, the new Y, the new X, in degrees.
    @param needs names of the parameters of each of forces and angles @param at parameter -> value"""
    values = [function(*(at[name] for name in names)) if names else function(0.0) for function, names in zip((*forces, *angles), needs)]
    along, (a, b, c) = values[:len(forces)], [math.radians(degrees) for degrees in (*values[len(forces):], 0.0, 0.0)[:3]]
    ca, sa, cb, sb, cc, sc = math.cos(a), math.sin(a), math.cos(b), math.sin(b), math.cos(c), math.sin(c)
    matrix = ((ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc), (sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc), (-sb, cb * sc, cb * cc))
    return sum(matrix[axis][k] * force for k, force in zip(axes, along))
