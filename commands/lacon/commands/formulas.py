"""FORMULE."""

import json
import keyword

from ..base import names
from ..base.expressions import Expression, hides
from ..core.catalog import part
from ..core.hdf5 import text_type
from ..core.nearest import nearest


def formule(call):
    k = call.keywords
    parameters, text = k["NOM_PARA"], k["VALE"].strip().replace("\n", " ")
    for parameter in parameters:
        if not parameter.isidentifier() or keyword.iskeyword(parameter):
            call.fail("FORMULE_3", "NOM_PARA", name=parameter)
    values = {name: value for name, value in k.items() if name not in ("NOM_PARA", "VALE")}
    try:
        expression = Expression(text, parameters, values)
        used = expression.used()
    except (RecursionError, MemoryError):
        call.fail("FORMULE_1", "VALE", reason=part("too_nested"))
    except (SyntaxError, ValueError) as error:
        call.fail("FORMULE_1", "VALE", reason=error.msg if isinstance(error, SyntaxError) else error)
    study, own = call.study.names.values, call.study.names.user()
    for name in used:
        if name in own and name not in values and hides(name, own[name]):
            expression.values[name] = own[name]
    for name in expression.names():
        if name in values:
            continue
        if name not in study:
            call.fail("FORMULE_4", "VALE", name=name, nearest=nearest(name, [*parameters, *own]))
        expression.values[name] = study[name]
    return make(call, expression)


def make(call, expression):
    """The formula concept of an expression. What its names stand for is saved with it as far as it can be."""
    saved, lost = {}, {}
    for name, value in expression.values.items():
        try:
            saved[name] = names.encode(value)
        except (names.NotKept, RecursionError) as reason:
            lost[name] = str(reason)
    call.keywords = {"NOM_PARA": expression.parameters, "VALE": expression.text, **saved}

    def fill(file):
        file.attrs.create("parameters", expression.parameters, dtype=text_type())
        file.attrs["expression"] = expression.text
        file.attrs["constants"] = json.dumps(saved)
        file.attrs["lost"] = json.dumps(lost)

    formula = call.write("formula", fill)
    formula._expression = expression
    return formula
