"""CALC_TABLE: a table from another, one ACTION after the other."""

import statistics

from ..core.catalog import part
from ..tables import filters, printing, storage
from ..tables.table import Table, joined_type, type_of

_reductions = {"MAXI": max, "MINI": min, "SOMM": sum, "MOY": lambda v: sum(v) / len(v), "MAXI_ABS": lambda v: max(map(abs, v)),
               "MINI_ABS": lambda v: min(map(abs, v)), "SOMM_ABS": lambda v: sum(map(abs, v))}
_statistics = {"NOMBRE": len, "MOY": statistics.fmean, "ECART_TYPE": statistics.pstdev, "MEDIANE": statistics.median, "MAXI": max, "MINI": min, "SOMM": sum}


def calc_table(call):
    table = call.keywords["TABLE"].EXTR_TABLE()
    for i, action in enumerate(call.keywords["ACTION"], 1):
        path = f"ACTION[{i}]"
        for name in action.get("NOM_PARA", ()) if action["OPERATION"] in _existing else ():
            filters.column_of(call, table, name, f"{path}/NOM_PARA")
        table = _operations[action["OPERATION"]](call, table, action, path)
    if "TITRE" in call.keywords:
        table.titr = "\n".join(call.keywords["TITRE"])
    return storage.make(call, table)


def _filter(call, table, action, path):
    if len(action["NOM_PARA"]) > 1:
        call.fail("CALC_TABLE_1", f"{path}/NOM_PARA", operation="FILTRE", wanted=part("one_column"), count=len(action["NOM_PARA"]))
    return filters.filtered(call, table, [{**action, "NOM_PARA": action["NOM_PARA"][0]}], path)


def _rename(call, table, action, path):
    names = action["NOM_PARA"]
    if len(names) != 2:
        call.fail("CALC_TABLE_1", f"{path}/NOM_PARA", operation="RENOMME", wanted=part("old_and_new_name"), count=len(names))
    filters.column_of(call, table, names[0], f"{path}/NOM_PARA")
    _new(call, table, names[1], path)
    table.Renomme(*names)
    return table


def _new(call, table, name, path):
    if name in table.para:
        call.fail("TABLE_7", f"{path}/NOM_PARA", name=name)


def _sort(call, table, action, path):
    table.sort(action["NOM_PARA"], action["ORDRE"])
    return table


def _drop(call, table, action, path):
    for name in action["NOM_PARA"]:
        del table[name]
    return table


def _add_row(call, table, action, path):
    names, values = action["NOM_PARA"], action["VALE"]
    if len(names) != len(values):
        call.fail("CALC_TABLE_2", path, columns=len(names), values=len(values))
    for name, value in zip(names, values):
        if name in table.para and (table.kind(name)[0] == "K") != isinstance(value, str):
            call.fail("TABLE_2", f"{path}/VALE", keyword="VALE", column=name, kind=table.kind(name), wanted=part("cell_of_that_type"))
    table.append({name: float(value) if name in table.para and table.kind(name) == "R" else value for name, value in zip(names, values)})
    return table


def _add_columns(call, table, action, path):
    names = action["NOM_PARA"]
    for name in names:
        _new(call, table, name, path)
    if "VALE_COLONNE" in action:
        if len(names) > 1:
            call.fail("CALC_TABLE_1", f"{path}/NOM_PARA", operation=part("with_keyword", name="AJOUT_COLONNE", keyword="VALE_COLONNE"), wanted=part("one_column"), count=len(names))
        table[names[0]] = action["VALE_COLONNE"]
        return table
    if len(names) != len(action["VALE"]):
        call.fail("CALC_TABLE_2", path, columns=len(names), values=len(action["VALE"]))
    for name, value in zip(names, action["VALE"]):
        table.add_column(name, type_of([value]), [value] * len(table))
    return table


def _compute(call, table, action, path):
    """OPER: a column of values of a formula, where its parameters have cells."""
    formula, names = action["FORMULE"], action["NOM_PARA"]
    if len(names) != 1:
        call.fail("CALC_TABLE_1", f"{path}/NOM_PARA", operation="OPER", wanted=part("one_new_column"), count=len(names))
    columns = action.get("NOM_COLONNE", formula.getVariables())
    if len(columns) != len(formula.getVariables()):
        call.fail("FUNCTION_12", f"{path}/NOM_COLONNE", label=formula.label, parameters=", ".join(formula.getVariables()))
    for name in columns:
        filters.column_of(call, table, name, f"{path}/FORMULE")
    _new(call, table, names[0], path)
    table.fromfunction(names[0], formula, columns)
    return table


def _key(row, names, real, mixed=()):
    """What rows are compared by. @param mixed columns that hold integers in one table and reals in the other"""
    cells = (float(row[name]) if name in mixed and row.get(name) is not None else row.get(name) for name in names)
    return tuple(printing.cell(cell, real).strip() for cell in cells)


def _real(call, action, path):
    try:
        return printing.number_format(action["FORMAT_R"])
    except ValueError:
        call.fail("TABLE_11", f"{path}/FORMAT_R", text=action["FORMAT_R"])


def _combine(call, table, action, path):
    """COMB: cells of the other table go to the rows that agree in NOM_PARA; other rows are added, or with RESTREINT left out of both."""
    other, real = action["TABLE"].EXTR_TABLE(), _real(call, action, path)
    names = action.get("NOM_PARA") or [name for name in table.para if name in other.para]
    if not names:
        call.fail("CALC_TABLE_3", f"{path}/TABLE", first=", ".join(table.para), second=", ".join(other.para))
    for name in names:
        filters.column_of(call, table, name, f"{path}/NOM_PARA")
        filters.column_of(call, other, name, f"{path}/NOM_PARA")
    kinds = {name: joined_type(kind, other.kind(name)) if name in other.para else kind for name, kind in zip(table.para, table.type)}
    for name in (n for n, kind in kinds.items() if kind is None):
        call.fail("CALC_TABLE_5", f"{path}/TABLE", name=name, first=table.kind(name), second=other.kind(name))
    mixed = [name for name in names if {table.kind(name), other.kind(name)} == {"I", "R"}]
    for which in (table, other):
        keys = [_key(row, names, real, mixed) for row in which]
        twice = next((key for key in keys if keys.count(key) > 1), None) if len(set(keys)) < len(keys) else None
        if twice:
            call.fail("CALC_TABLE_4", path, label=which.nom, key=", ".join(f"{n} {v}" for n, v in zip(names, twice)))
    from_other = {_key(row, names, real, mixed): row for row in other}
    rows = []
    for row in table:
        match = from_other.pop(_key(row, names, real, mixed), None)
        if match is not None or action["RESTREINT"] == "NON":
            rows.append({**row, **{k: v for k, v in (match or {}).items() if k not in names}})
    if action["RESTREINT"] == "NON":
        rows += from_other.values()
    added = [name for name in other.para if name not in table.para]
    return Table(rows, table.para + added, list(kinds.values()) + [other.kind(name) for name in added], table.titr)


def _unique(call, table, action, path):
    """The first row of each set of equal cells."""
    real, rows = _real(call, action, path), {}
    for row in table:
        rows.setdefault(_key(row, action["NOM_PARA"], real), row)
    return Table(rows.values(), table.para, table.type, table.titr)


def _reduce(call, table, action, path):
    """CALCUL: a row for each TYPE_CALCUL."""
    return _reduced(call, table, action["NOM_PARA"], {what: _reductions[what] for what in action["TYPE_CALCUL"]}, path)


def _reduced(call, table, names, reductions, path):
    """A row for each reduction of the columns. @param reductions name -> function of the cells that there are"""
    columns = {"TYPE_CALCUL": ("K16", list(reductions))}
    for name in names:
        values = filters.numeric(call, table, name, f"{path}/NOM_PARA").values()
        if not values:
            call.fail("TABLE_9", f"{path}/NOM_PARA", name=name, count=0)
        columns[name] = ("R", [float(reduction(values)) for reduction in reductions.values()])
    return Table.of_columns(columns, table.titr)


def _describe(call, table, action, path):
    """STATISTIQUES: what describes every column of numbers, or those of NOM_PARA."""
    names = action.get("NOM_PARA") or [name for name in table.para if table.kind(name) in ("I", "R") and table[name].values()]
    for name in names:
        filters.column_of(call, table, name, f"{path}/NOM_PARA")
    return _reduced(call, table, names, _statistics, path)


#: operations whose NOM_PARA are columns that must be there
_existing = {"FILTRE", "EXTR", "TRI", "SUPPRIME", "UNIQUE", "CALCUL"}
_operations = {"FILTRE": _filter, "EXTR": lambda call, table, action, path: table[action["NOM_PARA"]], "RENOMME": _rename, "TRI": _sort,
               "COMB": _combine, "AJOUT_LIGNE": _add_row, "AJOUT_COLONNE": _add_columns, "OPER": _compute, "SUPPRIME": _drop, "UNIQUE": _unique,
               "CALCUL": _reduce, "STATISTIQUES": _describe}
