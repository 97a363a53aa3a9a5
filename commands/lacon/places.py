"""Where and when a post-processing command looks: TOUT_ORDRE, NUME_ORDRE, INST, LIST_INST; nodes; values of a field at nodes."""

from . import checks
from .checks import members_of, nodes_of


def orders(call, k, path):
    """[(order number, instant)] that the keywords name, increasing; all of them without any."""
    result = k["RESULTAT"]
    instants = result.instants()
    if "NUME_ORDRE" in k:
        wanted = [{"NUME_ORDRE": number} for number in _listed(k["NUME_ORDRE"])]
    elif "INST" in k or "LIST_INST" in k:
        wanted = [{"INST": t} for t in (k["LIST_INST"].getValues() if "LIST_INST" in k else _listed(k["INST"]))]
    else:
        return instants
    tolerance = {"RESULTAT": result, "TOLE_MACHINE": [0.0, k["PRECISION"]], "CRITERE": ["RELATIF", k["CRITERE"]]}
    return sorted({checks.order_of(call, {**one, **tolerance}, path) for one in wanted})


def _listed(value):
    return value if isinstance(value, list) else [value]


def nodes(call, k, mesh, path):
    """0-based numbers of the nodes that NOEUD, GROUP_NO, MAILLE and GROUP_MA name, in their order, each once."""
    found = {}
    for keyword, kind in (("NOEUD", "nodes"), ("GROUP_NO", "nodes"), ("MAILLE", "cells"), ("GROUP_MA", "cells")):
        for name in _listed(k.get(keyword, [])):
            members = members_of(call, {keyword: name}, path, mesh, keyword, kind)
            found.update(dict.fromkeys(int(n) for n in (members if kind == "nodes" else sorted(set(nodes_of(mesh, members))))))
    return list(found)


def cells(call, k, mesh, path):
    """0-based numbers of the cells that MAILLE and GROUP_MA name."""
    return [int(c) for keyword in ("MAILLE", "GROUP_MA") for name in _listed(k.get(keyword, []))
            for c in members_of(call, {keyword: name}, path, mesh, keyword, "cells")]


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
    """(values, mask) of a field over all nodes of its mesh, (nodes, components); of a field at cells' nodes the mean over the cells.

    @throws AsterError POST_1 where the field does not live on nodes
    """
    import numpy

    if field.location == "NOEU":
        return field.toSimpleFieldOnNodes().getValues()
    if field.location != "ELNO":
        call.fail("POST_1", f"{path}/NOM_CHAM", field=field.name, location=field.location)
    mesh = field.mesh()
    owner = nodes_of(mesh, field.support)
    sums = numpy.zeros((mesh.getNumberOfNodes(), len(field.components)))
    counts = numpy.zeros(sums.shape, int)
    numpy.add.at(sums, owner, numpy.where(field.present, field.values, 0.0))
    numpy.add.at(counts, owner, field.present)
    return sums / numpy.maximum(counts, 1), counts > 0


def component(call, field, name, path):
    """Index of a component. @throws AsterError TEST_RESU_4"""
    if name not in field.components:
        call.fail("TEST_RESU_4", path, component=name, field=field.name, known=", ".join(field.components))
    return field.components.index(name)


def curved_abscissa(points):
    """Length along the points, one after the other, from the first; points (n, 3)."""
    import numpy

    return numpy.concatenate([[0.0], numpy.cumsum(numpy.linalg.norm(numpy.diff(points, axis=0), axis=1))]) if len(points) else points[:, 0]
