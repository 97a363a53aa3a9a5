"""TEST_RESU: values of results, fields and meshes against references."""

from . import checks, places


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
        call.study.progress(checks.line(check))
    call.study.checks += made


def _mesh_check(call, test, path):
    mesh = test["MAILLAGE"]
    value = {"NB_MAILLE": mesh.getNumberOfCells, "NB_NOEUD": mesh.getNumberOfNodes,
             "NB_GROUP_MA": lambda: len(mesh.group_names("cells")), "NB_GROUP_NO": lambda: len(mesh.group_names("nodes")),
             "NB_MA_GROUP_MA": lambda: len(places.members_of(call, test, path, mesh, "NOM_GROUP_MA", "cells")),
             "NB_NO_GROUP_NO": lambda: len(places.members_of(call, test, path, mesh, "NOM_GROUP_NO", "nodes"))}
    check = checks.Check(call.where, mesh.label, "", test["CARA"], test.get("NOM_GROUP_MA", test.get("NOM_GROUP_NO", "")), None,
                  test.get("LEGENDE", ""), value[test["CARA"]]())
    return checks.conclude(call, check, test)


def _result_check(call, test, path):
    result = test["RESULTAT"]
    order, instant = places.order_of(call, test, path)
    if "PARA" in test:
        name = test["PARA"]
        value = next(row[name] for row in places.parameters(call, result, [name], f"{path}/PARA").rows if row["NUME_ORDRE"] == order)
        return checks.conclude(call, checks.Check(call.where, result.label, "", name, "", instant, test.get("LEGENDE", ""), value), test)
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
    if test.get("NOM_CMP", field.components[0]) not in field.components:
        call.fail("TEST_RESU_4", f"{path}/NOM_CMP", component=test["NOM_CMP"], field=name, known=", ".join(field.components))
    values, place = places.select(call, test, path, field)
    value = places.reduce(values, test.get("TYPE_TEST"))
    return checks.conclude(call, checks.Check(call.where, label, name, test.get("NOM_CMP", ""), place, instant, test.get("LEGENDE", ""), value), test)
