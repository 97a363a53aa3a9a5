"""Where and when a command looks at a result: INST, NUME_ORDRE, TOUT_ORDRE, LIST_INST; nodes and cells; values of fields there."""

from ..base import contents
from ..core.catalog import part
from ..core.concepts import listed
from ..core.late import numpy
from ..core.nearest import nearest
from ..tables.table import Table

# ---------------------------------------------------------------------------------------------------- instants


def order_of(call, test, path):
    """(order number, instant) that INST or NUME_ORDRE names."""
    instants = test["RESULTAT"].instants()
    if "NUME_ORDRE" in test:
        found = [(order, t) for order, t in instants if order == test["NUME_ORDRE"]]
        if not found:
            call.fail("TEST_RESU_1", f"{path}/NUME_ORDRE", what=part("order_number", number=test["NUME_ORDRE"]), label=test["RESULTAT"].label,
                      known=listed(instants))
        return found[0]
    wanted = test["INST"]
    found = _near(instants, test)
    if not found:
        call.fail("TEST_RESU_1", f"{path}/INST", what=part("value_at_instant", instant=f"{wanted:.9g}"), label=test["RESULTAT"].label,
                  known=listed(instants, wanted))
    if len(found) > 1:
        call.fail("TEST_RESU_2", f"{path}/INST", instant=f"{wanted:.9g}", found=", ".join(f"{t:.10g}" for _, t in found))
    return found[0]


def _near(instants, test):
    """[(order number, instant)] at INST, within the second values of TOLE_MACHINE and CRITERE."""
    wanted = test["INST"]
    tolerance = test["TOLE_MACHINE"][1] if len(test["TOLE_MACHINE"]) > 1 else 1e-6
    kind = test["CRITERE"][1] if len(test["CRITERE"]) > 1 else "RELATIF"
    scale = abs(wanted) if kind == "RELATIF" and wanted else 1.0
    return [(order, t) for order, t in instants if abs(t - wanted) <= tolerance * scale]


def orders(call, k, path):
    """[(order number, instant)] that the keywords name, increasing; all of them without any. Of LIST_INST those that are there, with an
    alarm FIELDS_5 for each of the others unless none is."""
    result = k["RESULTAT"]
    instants = result.instants()
    if "NUME_ORDRE" in k:
        wanted = [{"NUME_ORDRE": number} for number in _listed(k["NUME_ORDRE"])]
    elif "INST" in k or "LIST_INST" in k:
        wanted = [{"INST": t} for t in (k["LIST_INST"].getValues() if "LIST_INST" in k else _listed(k["INST"]))]
    else:
        return instants
    tolerance = {"RESULTAT": result, "TOLE_MACHINE": [0.0, k["PRECISION"]], "CRITERE": ["RELATIF", k["CRITERE"]]}
    if "LIST_INST" in k:
        missing = [one for one in wanted if not _near(instants, {**one, **tolerance})]
        if len(missing) < len(wanted):
            wanted = [one for one in wanted if one not in missing]
            for one in missing:
                call.study.inform("FIELDS_5", f"{call.command}, {call.where}", keyword=f"{path}/LIST_INST", label=result.label,
                                  instant=f"{one['INST']:.9g}", known=listed(instants, one["INST"]))
    return sorted({order_of(call, {**one, **tolerance}, path) for one in wanted})


def _listed(value):
    return value if isinstance(value, list) else [value]


def parameters(call, result, names, path):
    """NUME_ORDRE and the parameters `names` of every order number. ITER_GLOB is code_aster's name of newton_iterations."""
    with result.open() as file:
        there = contents.instants(file)
        available = {"NUME_ORDRE": ("I", [order for order, _ in there]), "INST": ("R", [t for _, t in there])}
        available.update((name, ("R", values.tolist())) for name, values in contents.parameters(file).items())
    if "newton_iterations" in available:
        available["ITER_GLOB"] = ("I", [int(n) for n in available["newton_iterations"][1]])
    for name in names:
        if name not in available:
            call.fail("TABLE_13", path, label=result.label, name=name, nearest=nearest(name, available), known=", ".join(available))
    return Table.of_columns({name: available[name] for name in ["NUME_ORDRE", *(n for n in names if n != "NUME_ORDRE")]})


# ---------------------------------------------------------------------------------------------------- nodes and cells


def group_that_was_meant(kind, name, known):
    """In words, behind a name that no group has. @param known "nodes" and "cells" -> the groups that are there"""
    other, word, give = {"nodes": ("cells", "cell", "GROUP_MA"), "cells": ("nodes", "node", "GROUP_NO")}[kind]
    return part("other_kind_of_group", other=part(word), keyword=give) if name in known[other] else nearest(name, known[kind])


def members_of(call, test, path, mesh, keyword, kind):
    """0-based numbers of nodes or cells that a keyword names."""
    name = test[keyword]
    if keyword in ("NOEUD", "MAILLE"):
        number = mesh.number_of(kind, name)
        if number is not None:
            return [number]
        count, letter = (mesh.getNumberOfNodes(), "N") if kind == "nodes" else (mesh.getNumberOfCells(), "M")
        call.fail("TEST_RESU_8", f"{path}/{keyword}", name=name, what=part("one_node" if kind == "nodes" else "one_cell"), letter=letter, count=count)
    members = mesh.group(kind, name)
    if members is None:
        known = {each: mesh.group_names(each) for each in ("nodes", "cells")}
        call.fail("TEST_RESU_9", f"{path}/{keyword}", name=name, what=part(kind), known=", ".join(known[kind]) or part("none"),
                  nearest=group_that_was_meant(kind, name, known))
    return members


def nodes(call, k, mesh, path):
    """0-based numbers of the nodes that NOEUD, GROUP_NO, MAILLE and GROUP_MA name, in their order, each once; of cells that form one open
    chain of lines along it, since nodes that a cut made, and middles, have the last numbers."""
    found = {}
    for keyword in ("NOEUD", "GROUP_NO"):
        for name in _listed(k.get(keyword, [])):
            found.update(dict.fromkeys(map(int, members_of(call, {keyword: name}, path, mesh, keyword, "nodes"))))
    chain = mesh.chain_of(list(dict.fromkeys(cells(call, k, mesh, path))))
    if chain:
        return list({**found, **dict.fromkeys(chain)})
    for keyword in ("MAILLE", "GROUP_MA"):
        for name in _listed(k.get(keyword, [])):
            found.update(dict.fromkeys(map(int, sorted(set(mesh.nodes_of(members_of(call, {keyword: name}, path, mesh, keyword, "cells")))))))
    return list(found)


def cells(call, k, mesh, path):
    """0-based numbers of the cells that MAILLE and GROUP_MA name."""
    return [int(c) for keyword in ("MAILLE", "GROUP_MA") for name in _listed(k.get(keyword, []))
            for c in members_of(call, {keyword: name}, path, mesh, keyword, "cells")]


# ---------------------------------------------------------------------------------------------------- fields


def field_at(call, result, name, order, instant, path):
    """The field of a result at an order number. @throws AsterError TEST_RESU_3"""
    field = result.field(name, order)
    if field is None:
        call.fail("TEST_RESU_3", f"{path}/NOM_CHAM", field=name, label=result.label, instant=f"{instant:g}",
                  known=", ".join(result.field_names()))
    return field


def fields(call, k, path, column):
    """(cells that say which one it is, field) of CHAM_GD, or of NOM_CHAM of RESULTAT at each instant that is named.

    @param column name of the cell that holds the result's name. @throws AsterError POST_6 for a field of functions
    """
    if "CHAM_GD" in k:
        field = k["CHAM_GD"].content()
        if field.functions:
            call.fail("POST_6", f"{path}/CHAM_GD", label=k["CHAM_GD"].label)
        yield {"CHAM_GD": ("K8", k["CHAM_GD"].label)}, field
        return
    for order, instant in orders(call, k, path):
        yield ({column: ("K8", k["RESULTAT"].label), "NOM_CHAM": ("K16", k["NOM_CHAM"]), "NUME_ORDRE": ("I", order), "INST": ("R", instant)},
               field_at(call, k["RESULTAT"], k["NOM_CHAM"], order, instant, path))


def at_nodes(call, field, path):
    """(values, mask) of a field over all nodes of its mesh, (nodes, components); of a field of cells, or at their nodes, the mean over the
    cells around a node.

    @throws AsterError POST_1 where the field has values at integration points alone
    """
    if field.location == "NOEU":
        return field.on_nodes(field.mesh().getNumberOfNodes())
    if field.location == "ELGA":
        call.fail("POST_1", f"{path}/NOM_CHAM", field=field.name, location=field.location)
    mesh = field.mesh()
    owner = mesh.nodes_of(field.support)
    rows = numpy.arange(len(field.values))
    if field.location == "ELEM":
        rows = numpy.repeat(rows, mesh.node_counts(field.support))
    sums = numpy.zeros((mesh.getNumberOfNodes(), len(field.components)))
    counts = numpy.zeros(sums.shape, int)
    numpy.add.at(sums, owner, numpy.where(field.counted, field.values, 0.0)[rows])
    numpy.add.at(counts, owner, field.counted[rows])
    return sums / numpy.maximum(counts, 1), counts > 0


def component(call, field, name, path):
    """Index of a component. @throws AsterError TEST_RESU_4"""
    if name not in field.components:
        call.fail("TEST_RESU_4", path, component=name, field=field.name, known=", ".join(field.components))
    return field.components.index(name)


def curved_abscissa(points):
    """Length along the points, one after the other, from the first; points (n, 3)."""
    return numpy.concatenate([[0.0], numpy.cumsum(numpy.linalg.norm(numpy.diff(points, axis=0), axis=1))]) if len(points) else points[:, 0]


def turns_back(points):
    """(how often, where first) the way from point to point goes back on itself, by more than 154 degrees; points (n, 3)."""
    step = numpy.diff(points, axis=0)
    length = numpy.linalg.norm(step, axis=1)
    back = (step[1:] * step[:-1]).sum(axis=1) < -0.9 * length[1:] * length[:-1]
    return int(back.sum()), int(back.argmax()) + 1 if back.any() else 0


# ---------------------------------------------------------------------------------------------------- one value


def select(call, test, path, field):
    """(values of the component, or without NOM_CMP of all, where the keywords say and they exist; words for the place)."""
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
            rows &= numpy.isin(owner, mesh.nodes_of(members))
        elif field.location == "ELNO":
            rows &= numpy.isin(mesh.nodes_of(field.support), members)
        else:
            call.fail("TEST_RESU_5", f"{path}/{keyword}", keyword=keyword, field=field.name)
    if "POINT" in test:
        if field.offset is None:
            call.fail("TEST_RESU_5", f"{path}/POINT", keyword="POINT", field=field.name)
        rows &= rank == test["POINT"] - 1
        words.append(f"point {test['POINT']}")
    columns = [field.components.index(test["NOM_CMP"])] if "NOM_CMP" in test else range(len(field.components))
    values = []
    for column in columns:
        there = rows & field.present[:, column]
        counted = there & field.counted[:, column]
        values.append(field.values[counted if "TYPE_TEST" in test and counted.any() else there, column])
    values = numpy.concatenate(values)
    place = " ".join(words)
    if len(values) == 0:
        call.fail("TEST_RESU_6", path, component=test.get("NOM_CMP", part("any_component")), field=field.name, place=place or part("the_whole_mesh"))
    if "TYPE_TEST" in test:
        place = f"{test['TYPE_TEST']} {place}".strip()
    elif len(values) > 1:
        otherwise = part("or_type_test") if call.command == "TEST_RESU" else ""
        call.fail("TEST_RESU_7", path, count=len(values), field=field.name, place=place, otherwise=otherwise)
    return values, place


def reduce(values, kind):
    if kind is None:
        return float(values[0])
    if kind in ("MAX", "MIN"):
        return float(numpy.max(values) if kind == "MAX" else numpy.min(values))
    magnitude = numpy.abs(values)
    return float({"SOMM": values.sum, "SOMM_ABS": magnitude.sum, "MAX_ABS": magnitude.max, "MIN_ABS": magnitude.min}[kind]())
