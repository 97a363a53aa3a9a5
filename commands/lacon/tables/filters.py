"""FILTRE, and columns that keywords name."""

import re

from ..core.catalog import part
from ..core.nearest import nearest

_most = 6  #: values of a column that a message names


def filtered(call, table, factors, path="FILTRE"):
    """The rows that every FILTRE lets pass, one filter after the other. @throws AsterError TABLE_1, TABLE_2, TABLE_3"""
    for i, factor in enumerate(factors, 1):
        place = f"{path}[{i}]"
        name, criterion = factor["NOM_PARA"], factor["CRIT_COMP"]
        column = column_of(call, table, name, f"{place}/NOM_PARA")
        key = next((k for k in ("VALE", "VALE_I", "VALE_K") if k in factor), None)
        if key is None:
            if criterion.endswith("_ABS") or criterion in ("MAXI", "MINI"):
                numeric(call, table, name, f"{place}/NOM_PARA")
                if not column.values():
                    table = column.NON_VIDE()
                    continue
            table = getattr(column, criterion)()
            continue
        if (key == "VALE_K") != (table.kind(name)[0] == "K"):
            call.fail("TABLE_2", f"{place}/{key}", keyword=key, column=name, kind=table.kind(name),
                      wanted="VALE_K" if table.kind(name)[0] == "K" else "VALE or VALE_I")
        targets = factor[key]
        if criterion in ("EQ", "NE"):
            tolerance = factor["PRECISION"] if key == "VALE" else 0.0
            compare = column.equal if criterion == "EQ" else column.different
            table = compare(targets, tolerance, factor["CRITERE"] == "RELATIF")
            continue
        if len(targets) > 1:
            call.fail("TABLE_3", f"{place}/{key}", criterion=criterion)
        if criterion == "REGEXP":
            try:
                table = column.REGEXP(targets[0])
            except re.error as error:
                call.fail("TABLE_18", f"{place}/{key}", pattern=targets[0], reason=error)
        else:
            table = {"LT": column.__lt__, "LE": column.__le__, "GT": column.__gt__, "GE": column.__ge__}[criterion](targets[0])
    return table


def refuse_nothing_left(call, table, factors, name):
    """No row that the filters let pass has a cell in the column `name`: which of them stops all. @throws AsterError TABLE_20, TABLE_21"""
    for i, factor in enumerate(factors, 1):
        passed = filtered(call, table, [factor])
        if len(table) and not len(passed):
            call.fail("TABLE_20", f"FILTRE[{i}]", column=factor["NOM_PARA"], values=_some(table[factor["NOM_PARA"]], factor))
        table = passed
    call.fail("TABLE_21", "NOM_PARA", name=name)


def _some(column, factor):
    """A few values of a column: of numbers those nearest to the one that the filter asks for."""
    values = list(dict.fromkeys(column.values()))
    targets = factor.get("VALE", factor.get("VALE_I"))
    chosen = sorted(sorted(values, key=lambda value: abs(value - targets[0]))[:_most]) if targets else values[:_most]
    said = [f"{value:.10g}" if isinstance(value, float) else repr(value.strip()) if isinstance(value, str) else str(value) for value in chosen]
    return ", ".join(said + ["..."] * (len(chosen) < len(values))) or part("none")


def column_of(call, table, name, path):
    """@throws AsterError TABLE_1"""
    if name not in table.para:
        call.fail("TABLE_1", path, name=name, nearest=nearest(name, table.para), known=", ".join(table.para) or part("none"))
    return table[name]


def numeric(call, table, name, path):
    """A column of numbers. @throws AsterError TABLE_1, TABLE_4"""
    column = column_of(call, table, name, path)
    if table.kind(name)[0] == "K":
        call.fail("TABLE_4", path, name=name)
    return column
