"""IMPR_FONCTION, TEST_FONCTION, RECU_FONCTION, CALC_FONCTION, INFO_FONCTION."""

import collections
import math

from ..base.functions import Piecewise
from ..core.late import numpy
from ..tables import curves, filters, printing, storage
from ..tables.curves import Curve
from ..tables.table import Table
from . import checks, functions, places
from .drawing import draw
from .table_commands import save

# ------------------------------------------------------------------------------------------------- IMPR_FONCTION


def impr_fonction(call):
    k = call.keywords
    made = [curve for i, factor in enumerate(k["COURBE"], 1) for curve in _curves(call, factor, f"COURBE[{i}]")]
    if k["FORMAT"] == "TABLEAU":
        _print_columns(call, made)
    elif k["FORMAT"] == "NUMPY":
        save(call, curves.columns(made))
    else:
        draw(call, made)


def _print_columns(call, made):
    k = call.keywords
    try:
        real = printing.number_format(k["FORMAT_R"])
    except ValueError:
        call.fail("TABLE_11", "FORMAT_R", text=k["FORMAT_R"])
    table = curves.columns(made)
    table.titr = "\n".join([*k.get("TITRE", ()), *k.get("SOUS_TITRE", ())])
    text = printing.columns(table, real, k["SEPARATEUR"], k["COMMENTAIRE"], k["DEBUT_LIGNE"], k["FIN_LIGNE"].removesuffix("\n"))
    call.study.write_text(k["UNITE"], ".resu" if k["UNITE"] == 8 else ".table", f"IMPR_FONCTION/UNITE, {call.where}", text + "\n")


def _curves(call, factor, path):
    """The curve of an occurrence of COURBE; of a function of two parameters one for each of its functions."""
    concept = factor.get("FONCTION")
    surface = concept.surface() if concept is not None and concept.type == "formula" else None
    if surface is None:
        return [_curve(call, factor, path)]
    name = factor.get("LEGENDE", concept.label)
    return [_curve(call, {**factor, "FONCTION": curve, "LEGENDE": f"{name}_{at:g}"}, path)
            for at, curve in zip(*surface)]


def _curve(call, factor, path):
    x, y, names = _points(call, factor, path)
    return Curve(x, y, names, factor.get("LEGENDE", ""), factor.get("COULEUR"), factor.get("STYLE"), factor.get("MARQUEUR"),
                 factor["FREQ_MARQUEUR"], factor["TRI"])


def _points(call, factor, path):
    """(abscissae, ordinates, their names) of an occurrence of COURBE."""
    at = factor["LIST_PARA"].getValues() if "LIST_PARA" in factor else None
    if "FONCTION" in factor:
        concept = factor["FONCTION"]
        if concept.type == "formula":
            if at is None:
                call.fail("FUNCTION_11", f"{path}/LIST_PARA", label=concept.label)
            if len(concept.getVariables()) != 1:
                call.fail("FUNCTION_12", f"{path}/FONCTION", label=concept.label, parameters=", ".join(concept.getVariables()))
            return at, concept.on_arrays(at), (concept.getVariables()[0], concept.label)
        points = concept.points()
        if at is None:
            return points.x, points.y, (points.parameter, concept.label or points.component)
        return at, [concept(v) for v in at], (points.parameter, concept.label or points.component)
    if "FONC_X" in factor:
        first, second = factor["FONC_X"], factor["FONC_Y"]
        at = first.Absc() if at is None else at
        return [first(v) for v in at], [second(v) for v in at], (first.label, second.label)
    x, y = (at, factor["LIST_RESU"].getValues()) if "LIST_RESU" in factor else (factor["ABSCISSE"], factor["ORDONNEE"])
    if len(x) != len(y):
        call.fail("DEFI_FONCTION_5", path, parameters=len(x), values=len(y))
    return x, y, ("X", "Y")


# ------------------------------------------------------------------------------------------------- TEST_FONCTION


def test_fonction(call):
    for test in call.keywords["VALEUR"]:
        concept, at = test["FONCTION"], test["VALE_PARA"]
        names = concept.getVariables() if concept.type == "formula" else [concept.points().parameter]
        named = dict(zip(test.get("NOM_PARA", names), at))
        if len(at) != len(names) or set(named) != set(names) or len(test.get("NOM_PARA", names)) != len(names):
            call.fail("FUNCTION_12", "VALEUR/VALE_PARA", label=concept.label, parameters=", ".join(names))
        at = [named[name] for name in names]
        value = float(concept(*at))
        place = ", ".join(f"{name} {v:g}" for name, v in zip(names, at))
        check = checks.conclude(call, checks.Check(call.where, concept.label, "", "", place, None, test.get("LEGENDE", ""), value), test)
        call.study.progress(checks.line(check))
        call.study.checks.append(check)


# ------------------------------------------------------------------------------------------------- RECU_FONCTION


def recu_fonction(call):
    k = call.keywords
    if "TABLE" in k:
        table = filters.filtered(call, k["TABLE"].EXTR_TABLE(), k.get("FILTRE", ()))
        for keyword in ("PARA_X", "PARA_Y"):
            filters.numeric(call, table, k[keyword], keyword)
        points = [(row[k["PARA_X"]], row[k["PARA_Y"]]) for row in table if None not in (row.get(k["PARA_X"]), row.get(k["PARA_Y"]))]
        path, names = "PARA_X", (k["PARA_X"], k["PARA_Y"])
        seen = collections.Counter(x for x, _ in points)
        if points and seen.most_common(1)[0][1] > 1:
            x, count = seen.most_common(1)[0]
            call.fail("FUNCTION_23", path, count=count, name=k["PARA_X"], value=f"{x:.12g}")
    else:
        points, path, names = _in_time(call), "RESULTAT", ("INST", k.get("NOM_CMP", k.get("NOM_PARA_RESU")))
    if not points:
        call.fail("FUNCTION_13", path)
    x, y = functions.increasing(call, *map(list, zip(*points)), k["VERIF"], path)
    return functions.make(call, functions.described(call, x, y, Piecewise(x, y, parameter=names[0], component=names[1])), path)


def _in_time(call):
    """[(instant, value)] of a field's component at a place, or of a parameter of the result."""
    k = call.keywords
    result = k["RESULTAT"]
    wanted = places.orders(call, k, "RESULTAT")
    if "NOM_PARA_RESU" in k:
        table = places.parameters(call, result, [k["NOM_PARA_RESU"]], "NOM_PARA_RESU")
        values = dict(zip(table.NUME_ORDRE, table[k["NOM_PARA_RESU"]]))
        return [(instant, values[order]) for order, instant in wanted]
    points = []
    for order, instant in wanted:
        field = result.field(k["NOM_CHAM"], order)
        if field is None and ("INST" in k or "NUME_ORDRE" in k or "LIST_INST" in k):
            places.field_at(call, result, k["NOM_CHAM"], order, instant, "RESULTAT")
        if field is not None:  # of all instants those that have the field
            places.component(call, field, k["NOM_CMP"], "NOM_CMP")
            values, _ = places.select(call, k, "RESULTAT", field)
            points.append((instant, float(values[0])))
    return points


# ------------------------------------------------------------------------------------------------- CALC_FONCTION


def calc_fonction(call):
    operation = next(name for name in _operations if name in call.keywords)
    factors = call.keywords[operation]
    return _operations[operation](call, factors if operation in ("COMB", "MULT", "COMPOSE", "ASSE") else factors[0])


def _made(call, x, y, like):
    return functions.make(call, functions.described(call, list(map(float, x)), list(map(float, y)), like), "")


def _abscissae(call, concepts):
    """LIST_PARA, or every abscissa of the functions."""
    if "LIST_PARA" in call.keywords:
        return call.keywords["LIST_PARA"].getValues()
    return sorted({x for concept in concepts for x in concept.Absc()})


def _comb(call, factors):
    x = _abscissae(call, [f["FONCTION"] for f in factors])
    y = [sum(f["COEF"] * f["FONCTION"](v) for f in factors) for v in x]
    return _made(call, x, y, factors[0]["FONCTION"].points())


def _enveloppe(call, factor):
    x = _abscissae(call, factor["FONCTION"])
    choose = max if factor["CRITERE"] == "SUP" else min
    return _made(call, x, [choose(f(v) for f in factor["FONCTION"]) for v in x], factor["FONCTION"][0].points())


def _derive(call, factor):
    """Central differences, second order on any steps; of two points their slope."""
    points = factor["FONCTION"].points()
    if len(points.x) < 2:
        call.fail("FUNCTION_14", "DERIVE", label=factor["FONCTION"].label)
    return _made(call, points.x, numpy.gradient(points.y, points.x, edge_order=min(2, len(points.x) - 1)), points)


def _integre(call, factor):
    """The trapezoidal rule, exact for a piecewise linear function, or Simpson's."""
    points = factor["FONCTION"].points()
    x, y = numpy.array(points.x), numpy.array(points.y)
    steps = numpy.diff(x)
    areas = steps * (y[1:] + y[:-1]) / 2
    if factor["METHODE"] == "SIMPSON" and len(x) > 2:
        areas -= _second_differences(x, y) * steps**3 / 6
    return _made(call, x, numpy.cumsum([factor["COEF"], *areas]), points)


def _second_differences(x, y):
    """Of each interval that of the parabola through three points which it belongs to: those of intervals in pairs, of a last one alone the last three."""
    slopes = numpy.diff(y) / numpy.diff(x)
    found = numpy.diff(slopes) / (x[2:] - x[:-2])
    return found[[min(i - i % 2, len(found) - 1) for i in range(len(slopes))]]


def _pointwise(change):
    """An operation on the ordinates of one function."""

    def operation(call, factor):
        points = factor["FONCTION"].points()
        try:
            y = [change(factor, v) for v in points.y]
        except (ZeroDivisionError, OverflowError, TypeError):
            y = [complex()]
        if any(isinstance(v, complex) for v in y):
            call.fail("FUNCTION_15", "", label=factor["FONCTION"].label)
        return _made(call, points.x, y, points)

    return operation


def _inverse(call, factor):
    """The function that takes values back to abscissae: points with x and y exchanged, and with them names and interpolations."""
    points = factor["FONCTION"].points()
    x, y = (points.y, points.x) if points.y[0] <= points.y[-1] else (points.y[::-1], points.x[::-1])
    if any(not a < b for a, b in zip(x, x[1:])):
        call.fail("FUNCTION_22", "INVERSE/FONCTION", label=factor["FONCTION"].label)
    ends = ["LINEAIRE" if end == "LINEAIRE" else "EXCLU" for end in (points.left, points.right)]
    left, right = ends if x is points.y else ends[::-1]
    return _made(call, x, y, Piecewise(x, y, points.interpolation[::-1], left, right, points.component, points.parameter))


def _mult(call, factors):
    concepts = [f for factor in factors for f in factor["FONCTION"]]
    x = _abscissae(call, concepts)
    return _made(call, x, [math.prod(f(v) for f in concepts) for v in x], concepts[0].points())


def _moyenne(call, factor):
    x, concepts = _abscissae(call, factor["FONCTION"]), factor["FONCTION"]
    return _made(call, x, [sum(f(v) for f in concepts) / len(concepts) for v in x], concepts[0].points())


def _fractile(call, factor):
    x = _abscissae(call, factor["FONCTION"])
    values = numpy.array([[f(v) for v in x] for f in factor["FONCTION"]])
    return _made(call, x, numpy.quantile(values, factor["FRACT"], axis=0), factor["FONCTION"][0].points())


def _regr_polynomiale(call, factor):
    points, degree = factor["FONCTION"].points(), factor["DEGRE"]
    if len(points.x) <= degree:
        call.fail("FUNCTION_18", "REGR_POLYNOMIALE/DEGRE", label=factor["FONCTION"].label, degree=degree, count=len(points.x))
    fit = numpy.polynomial.Polynomial.fit(points.x, points.y, degree)
    return _made(call, points.x, fit(numpy.array(points.x)), points)


def _compose(call, factors):
    inner, outer = factors[0]["FONC_PARA"], factors[0]["FONC_RESU"]
    points = inner.points()
    return _made(call, points.x, [outer(v) for v in points.y], points)


def _asse(call, factors):
    """Two functions one behind the other; SURCHARGE says which one holds where both do."""
    first, second = factors[0]["FONCTION"]
    low, high = sorted((first.points(), second.points()), key=lambda p: p.x[0])
    if factors[0]["SURCHARGE"] == "DROITE":
        joined = [*((x, y) for x, y in zip(low.x, low.y) if x < high.x[0]), *zip(high.x, high.y)]
    else:
        joined = [*zip(low.x, low.y), *((x, y) for x, y in zip(high.x, high.y) if x > low.x[-1])]
    return _made(call, *zip(*joined), first.points())


def _max(call, factor):
    """A table with the extremes of each function, or in each interval of it."""
    rows = []
    for concept in factor["FONCTION"]:
        points = concept.points()
        for head, x, y in _parts(call, concept, factor.get("INTERVALLE")):
            for what, choose in (("MAX", max), ("MIN", min)):
                value = choose(y)
                rows += [{"FONCTION": concept.label, **head, "TYPE": what, points.parameter: a, points.component: b} for a, b in zip(x, y) if b == value]
    return storage.make(call, Table(rows))


def _parts(call, concept, ends):
    """[(cells of the table, abscissae, ordinates)] of a function: as a whole, or with its values at the ends of each interval."""
    points = concept.points()
    if ends is None:
        return [({}, points.x, points.y)]
    if len(ends) % 2 or any(not first < last for first, last in zip(ends[::2], ends[1::2])):
        call.fail("FUNCTION_21", "MAX/INTERVALLE", ends=", ".join(f"{v:g}" for v in ends))
    parts = []
    for number, (first, last) in enumerate(zip(ends[::2], ends[1::2]), 1):
        x = [first, *(v for v in points.x if first < v < last), last]
        parts.append(({"INTERVALLE": number}, x, [concept(v) for v in x]))
    return parts


_operations = {
    "COMB": _comb, "ENVELOPPE": _enveloppe, "DERIVE": _derive, "INTEGRE": _integre, "MULT": _mult, "COMPOSE": _compose, "ASSE": _asse,
    "MOYENNE": _moyenne, "FRACTILE": _fractile, "REGR_POLYNOMIALE": _regr_polynomiale, "MAX": _max, "ABS": _pointwise(lambda factor, y: abs(y)), "INVERSE": _inverse,
    "PUISSANCE": _pointwise(lambda factor, y: y ** factor["EXPOSANT"]),
}


# ------------------------------------------------------------------------------------------------- INFO_FONCTION


def info_fonction(call):
    k = call.keywords
    if "MAX" in k:
        return _max(call, k["MAX"][0])
    name = "RMS" if "RMS" in k else "ECART_TYPE"
    return storage.make(call, Table([_mean_square(call, factor, name, f"{name}[{i}]") for i, factor in enumerate(k[name], 1)]))


def _mean_square(call, factor, name, path):
    """A row: the root of the mean over [INST_INIT, INST_FIN] of the square, of ECART_TYPE of what differs from the mean; by trapezes over the points."""
    concept = factor["FONCTION"]
    points = concept.points()
    first, last = factor.get("INST_INIT", points.x[0]), factor.get("INST_FIN", points.x[-1])
    if not first < last:
        call.fail("FUNCTION_19", path, label=concept.label, first=f"{first:g}", last=f"{last:g}")
    x = numpy.array([first, *(v for v in points.x if first < v < last), last])
    y = numpy.array([concept(v) for v in x])

    def mean(values):
        return float(numpy.sum((values[1:] + values[:-1]) * numpy.diff(x)) / 2 / (last - first))

    square = mean(y**2 if name == "RMS" else (y - mean(y)) ** 2)
    return {"FONCTION": concept.label, "METHODE": factor["METHODE"], "INST_INIT": first, "INST_FIN": last, name: math.sqrt(square)}
