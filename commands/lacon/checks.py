"""TEST_RESU, TEST_TABLE: values of results, meshes and tables against references.

Every check has up to two judgements: against VALE_REFE, the reference, within PRECISION, and against VALE_CALC, another program's
digits, within TOLE_MACHINE. A missed reference is NOOK; a missed VALE_CALC alone is DIFF, or NOOK with --checks all.
"""

import math

from . import concepts

#: below it VALE_CALC is zero, and a relative judgement has no meaning
_zero = 1e-16


class Check:
    """One check with all its figures."""

    def __init__(self, where, label, field, component, place, instant, legend, value):
        self.where, self.label, self.field, self.component = where, label, field, component
        self.place, self.instant, self.legend, self.value = place, instant, legend, value
        self.calculated = self.reference = None
        self.source = ""
        self.status = ""

    def judge(self, calculated, reference, source, strict):
        """`calculated`, `reference`: Judgement; `reference` may be None."""
        self.calculated, self.reference, self.source = calculated, reference, source
        if reference is not None and not reference.met:
            self.status = "NOOK"
        elif not calculated.met:
            self.status = "NOOK" if strict else "DIFF"
        else:
            self.status = "OK"

    def decisive(self):
        """The judgement that its line shows: the one that was missed, else the reference where there is one."""
        if self.reference is not None and (not self.reference.met or self.calculated.met):
            return self.reference
        return self.calculated

    def data(self):
        return {"status": self.status, "where": self.where, "label": self.label, "field": self.field, "component": self.component,
                "place": self.place, "instant": self.instant, "legend": self.legend, "value": self.value,
                "vale_calc": self.calculated.data(), "reference": self.source or None,
                "vale_refe": self.reference.data() if self.reference else None}


class Judgement:
    """|value - target| against a tolerance, absolute or relative to the target. A value that is no number is never met."""

    def __init__(self, value, target, tolerance, criterion, judged=True):
        self.target, self.tolerance, self.criterion, self.judged = target, tolerance, criterion, judged
        difference = abs(value - target)
        scale = abs(target) if criterion == "RELATIF" else 1.0
        self.error = difference / scale if scale else (0.0 if difference == 0.0 else math.inf)
        # judged as the difference itself: with a relative criterion and the target 0 only 0 will do
        self.met = not judged or difference <= tolerance * scale

    def data(self):
        return {"value": self.target, "error": _finite(self.error), "tolerance": self.tolerance, "criterion": self.criterion,
                "judged": self.judged, "met": self.met}


class TextJudgement(Judgement):
    """A text against a text."""

    def __init__(self, value, target, tolerance, criterion):
        super().__init__(0 if value.strip() == target.strip() else 1, 0, tolerance, criterion)
        self.target = target


def _finite(x):
    return x if isinstance(x, (int, str)) or math.isfinite(x) else str(x)


def judge_calculated(value, target, tolerance, criterion, magnitude=None):
    """The judgement against VALE_CALC: where it is zero it needs an order of magnitude, else it is not judged."""
    if abs(target) <= _zero:
        if magnitude is None:
            return Judgement(value, target, tolerance, "ABSOLU", judged=False)
        return Judgement(value, target, tolerance * abs(magnitude), "ABSOLU")
    return Judgement(value, target, tolerance, criterion)


# ---------------------------------------------------------------------------------------------------- the command


def test_resu(call):
    made = []
    for i, test in enumerate(call.keywords.get("RESU", ()), 1):
        made.append(_result_check(call, test, f"RESU[{i}]"))
    for kind in ("CHAM_NO", "CHAM_ELEM"):
        for i, test in enumerate(call.keywords.get(kind, ()), 1):
            made.append(_field_check(call, test, kind, f"{kind}[{i}]"))
    for i, test in enumerate(call.keywords.get("MAILLAGE", ()), 1):
        made.append(_mesh_check(call, test, f"MAILLAGE[{i}]"))
    for check in made:
        call.study.progress(line(check))
    call.study.checks += made


def _mesh_check(call, test, path):
    mesh = test["MAILLAGE"]
    value = {"NB_MAILLE": mesh.getNumberOfCells, "NB_NOEUD": mesh.getNumberOfNodes,
             "NB_GROUP_MA": lambda: len(mesh.group_names("cells")), "NB_GROUP_NO": lambda: len(mesh.group_names("nodes")),
             "NB_MA_GROUP_MA": lambda: len(members_of(call, test, path, mesh, "NOM_GROUP_MA", "cells")),
             "NB_NO_GROUP_NO": lambda: len(members_of(call, test, path, mesh, "NOM_GROUP_NO", "nodes"))}
    check = Check(call.where, mesh.label, "", test["CARA"], test.get("NOM_GROUP_MA", test.get("NOM_GROUP_NO", "")), None,
                  test.get("LEGENDE", ""), value[test["CARA"]]())
    return conclude(call, check, test)


def _result_check(call, test, path):
    result = test["RESULTAT"]
    order, instant = order_of(call, test, path)
    if "PARA" in test:
        from .table_commands import parameters

        name = test["PARA"]
        value = next(row[name] for row in parameters(call, result, [name], f"{path}/PARA").rows if row["NUME_ORDRE"] == order)
        return conclude(call, Check(call.where, result.label, "", name, "", instant, test.get("LEGENDE", ""), value), test)
    field = result.field(test["NOM_CHAM"], order)
    if field is None:
        call.fail("TEST_RESU_3", f"{path}/NOM_CHAM", field=test["NOM_CHAM"], label=result.label, instant=f"{instant:g}",
                  known=", ".join(result.field_names()))
    return _value_check(call, test, path, field, result.label, test["NOM_CHAM"], instant)


def _field_check(call, test, kind, path):
    concept = test["CHAM_GD"]
    field = concept.content()
    if (field.location == "NOEU") != (kind == "CHAM_NO") or field.functions:
        call.fail("TEST_RESU_10", f"{path}/CHAM_GD", label=concept.label, type=field.type(), wanted=kind)
    return _value_check(call, test, path, field, concept.label, field.type(), None)


def _value_check(call, test, path, field, label, name, instant):
    """A value of a field, wherever the field is from."""
    if test["NOM_CMP"] not in field.components:
        call.fail("TEST_RESU_4", f"{path}/NOM_CMP", component=test["NOM_CMP"], field=name, known=", ".join(field.components))
    values, place = select(call, test, path, field)
    value = reduce(values, test.get("TYPE_TEST"))
    return conclude(call, Check(call.where, label, name, test["NOM_CMP"], place, instant, test.get("LEGENDE", ""), value), test)


def conclude(call, check, test):
    """Judge the value of a check as its keywords say: VALE_ABS, then VALE_CALC and VALE_REFE, for integers and texts VALE_CALC_I, VALE_CALC_K.

    Of several references the nearest one counts. @return the check
    """
    if test.get("VALE_ABS") == "OUI":
        check.value = abs(check.value)
    suffix = next(s for s in ("", "_I", "_K") if "VALE_CALC" + s in test)
    criterion, tolerance = test["CRITERE"][0], test["TOLE_MACHINE"][0]
    targets = {name: _nearest_target(check.value, test[name + suffix]) for name in ("VALE_CALC", "VALE_REFE") if name + suffix in test}
    if suffix == "":
        calculated = judge_calculated(check.value, targets["VALE_CALC"], tolerance, criterion, test.get("ORDRE_GRANDEUR"))
        reference = Judgement(check.value, targets["VALE_REFE"], test["PRECISION"], criterion) if "VALE_REFE" in targets else None
    else:
        kind = Judgement if suffix == "_I" else TextJudgement
        calculated, reference = (kind(check.value, targets[n], 0, "ABSOLU") if n in targets else None for n in ("VALE_CALC", "VALE_REFE"))
    check.judge(calculated, reference, test.get("REFERENCE", ""), call.study.strict_checks)
    return check


def _nearest_target(value, targets):
    if not isinstance(targets, list):
        return targets
    if isinstance(value, str):
        return value if value in targets else targets[0]
    return min(targets, key=lambda target: abs(value - target))


def order_of(call, test, path):
    """(order number, instant) that INST or NUME_ORDRE names."""
    instants = test["RESULTAT"].instants()
    known = concepts.listed(instants)
    if "NUME_ORDRE" in test:
        found = [(order, t) for order, t in instants if order == test["NUME_ORDRE"]]
        if not found:
            call.fail("TEST_RESU_1", f"{path}/NUME_ORDRE", what=f"order number {test['NUME_ORDRE']}", label=test["RESULTAT"].label, known=known)
        return found[0]
    wanted = test["INST"]
    tolerance = test["TOLE_MACHINE"][1] if len(test["TOLE_MACHINE"]) > 1 else 1e-6
    kind = test["CRITERE"][1] if len(test["CRITERE"]) > 1 else "RELATIF"
    scale = abs(wanted) if kind == "RELATIF" and wanted else 1.0
    found = [(order, t) for order, t in instants if abs(t - wanted) <= tolerance * scale]
    if not found:
        call.fail("TEST_RESU_1", f"{path}/INST", what=f"instant {wanted:g}", label=test["RESULTAT"].label, known=known)
    if len(found) > 1:
        call.fail("TEST_RESU_2", f"{path}/INST", instant=f"{wanted:g}", found=", ".join(f"{t:.10g}" for _, t in found))
    return found[0]


def select(call, test, path, field):
    """(values of the component where the keywords say and it exists, words for the place)."""
    import numpy

    mesh = field.mesh()
    rows = numpy.ones(len(field.values), bool)
    words = []
    owner, rank = field.rows()
    for keyword, kind in (("NOEUD", "nodes"), ("GROUP_NO", "nodes"), ("MAILLE", "cells"), ("GROUP_MA", "cells")):
        if keyword not in test:
            continue
        members = members_of(call, test, path, mesh, keyword, kind)
        words.append(test[keyword])
        if (field.location == "NOEU") == (kind == "nodes"):
            rows &= numpy.isin(owner, members)
        elif field.location == "NOEU":
            rows &= numpy.isin(owner, nodes_of(mesh, members))
        elif field.location == "ELNO":
            rows &= numpy.isin(nodes_of(mesh, field.support), members)
        else:
            call.fail("TEST_RESU_5", f"{path}/{keyword}", keyword=keyword, field=field.name)
    if "POINT" in test:
        if field.offset is None:
            call.fail("TEST_RESU_5", f"{path}/POINT", keyword="POINT", field=field.name)
        rows &= rank == test["POINT"] - 1
        words.append(f"point {test['POINT']}")
    column = field.components.index(test["NOM_CMP"])
    rows &= field.present[:, column]
    values = field.values[rows, column]
    place = " ".join(words)
    if len(values) == 0:
        call.fail("TEST_RESU_6", path, component=test["NOM_CMP"], field=field.name, place=place or "the whole mesh")
    if "TYPE_TEST" in test:
        place = f"{test['TYPE_TEST']} {place}".strip()
    elif len(values) > 1:
        call.fail("TEST_RESU_7", path, count=len(values), field=field.name, place=place)
    return values, place


def members_of(call, test, path, mesh, keyword, kind):
    """0-based numbers of nodes or cells that a keyword names."""
    name = test[keyword]
    if keyword in ("NOEUD", "MAILLE"):
        count = mesh.getNumberOfNodes() if kind == "nodes" else mesh.getNumberOfCells()
        letter = "N" if kind == "nodes" else "M"
        if name[:1] == letter and name[1:].isdigit() and 1 <= int(name[1:]) <= count:
            return [int(name[1:]) - 1]
        call.fail("TEST_RESU_8", f"{path}/{keyword}", name=name, what="node" if kind == "nodes" else "cell", letter=letter, count=count)
    members = mesh.group(kind, name)
    if members is None:
        from .checker import nearest

        known = mesh.group_names(kind)
        call.fail("TEST_RESU_9", f"{path}/{keyword}", name=name, what=kind, known=", ".join(known) or "none", nearest=nearest(name, known))
    return members


def nodes_of(mesh, cells):
    """Nodes of cells, one cell after the other."""
    import numpy

    with mesh.open() as file:
        offset, nodes = file["cells/offset"][:], file["cells/nodes"][:]
    parts = [nodes[offset[c]:offset[c + 1]] for c in cells]
    return numpy.concatenate(parts) if parts else nodes[:0]


def reduce(values, kind):
    import numpy

    if kind is None:
        return float(values[0])
    if kind in ("MAX", "MIN"):
        return float(numpy.max(values) if kind == "MAX" else numpy.min(values))
    magnitude = numpy.abs(values)
    return float({"SOMM": values.sum, "SOMM_ABS": magnitude.sum, "MAX_ABS": magnitude.max, "MIN_ABS": magnitude.min}[kind]())


# ---------------------------------------------------------------------------------------------------- printing


def line(check):
    """"OK   RES  DEPL  LAGS_C  MIN  INST 1  -25  reference -25  error ...": aligned, one line."""
    shown = check.decisive()
    against = "reference" if shown is check.reference else "VALE_CALC"
    instant = "" if check.instant is None else f"INST {check.instant:g}"
    error = f"{shown.error:.2e}" if shown.judged else "not judged"
    kind = {"RELATIF": "rel", "ABSOLU": "abs"}[shown.criterion]
    text = (f"{check.status:<5}{check.label:<10} {check.field:<10} {check.component:<9} {check.place:<14} {instant:<11} "
            f"{_number(check.value):>21}  {against} {_number(shown.target):>16}  error {error:>10}  tolerance {shown.tolerance:.1e} {kind}")
    if not shown.judged:
        text += "  (VALE_CALC is 0 and ORDRE_GRANDEUR is not given)"
    if check.legend:
        text += f"  {check.legend}"
    return text if check.status == "OK" else f"{text}  ({check.where})"


def _number(value):
    return f"{value:.14g}" if isinstance(value, float) else str(value)


def summary(checks):
    """"12 checks: 10 OK, 1 NOOK, 1 DIFF\""""
    count = {status: sum(c.status == status for c in checks) for status in ("OK", "NOOK", "DIFF")}
    return f"{len(checks)} checks: " + ", ".join(f"{n} {status}" for status, n in count.items())


def write_json(path, checks, diagnostic, status, timings):
    """Every check with all its figures, and where the time went."""
    import json
    import os

    data = {"format": 1, "diagnostic": diagnostic, "status": status, "checks": [c.data() for c in checks], "timings": timings}
    for check in data["checks"]:
        check["value"] = _finite(check["value"])
    is_device = os.path.exists(path) and not os.path.isfile(path)  # as /dev/stdout, which a renamed file would replace
    partial = path if is_device else f"{path}.partial"
    with open(partial, "w", encoding="utf-8") as file:
        json.dump(data, file, indent=1, ensure_ascii=False)
        file.write("\n")
    if not is_device:
        os.replace(partial, path)
