"""CREA_TABLE, IMPR_TABLE, TEST_TABLE, RECU_TABLE, EXTR_TABLE."""

from ..base.names import concepts_of
from ..core import labels
from ..core.catalog import part
from ..core.concepts import Concept
from ..core.files import whole
from ..core.late import numpy
from ..tables import filters, printing, storage
from ..tables.curves import Curve
from ..tables.table import Table, crossed, hidden_by_crossing, type_of
from . import checks, information, places
from .drawing import draw


def title(call):
    return "\n".join(call.keywords.get("TITRE", []))


# ---------------------------------------------------------------------------------------------------- CREA_TABLE


def crea_table(call):
    if "RESU" in call.keywords:
        return storage.make(call, _of_field(call, call.keywords["RESU"][0], "RESU"))
    columns = _listed(call) if "LISTE" in call.keywords else _points(call.keywords["FONCTION"][0])
    return storage.make(call, Table.of_columns(columns, title(call)))


def _listed(call):
    """column -> (type, values) of LISTE"""
    columns, lengths = {}, []
    for i, factor in enumerate(call.keywords["LISTE"], 1):
        key = next(k for k in ("LISTE_I", "LISTE_R", "LISTE_K") if k in factor)
        name, values, path = factor["PARA"], factor[key], f"LISTE[{i}]"
        if name in columns:
            call.fail("TABLE_7", f"{path}/PARA", name=name)
        kind = key[-1] if key != "LISTE_K" else factor.get("TYPE_K", type_of(values))
        if key == "LISTE_K":
            long = [v for v in values if len(v) > int(kind[1:])]
            if long:
                call.fail("TABLE_8", f"{path}/LISTE_K", value=long[0] if len(long[0]) <= 60 else long[0][:57] + "...", length=len(long[0]), kind=kind)
        if "NUME_LIGN" in factor:
            rows = factor["NUME_LIGN"]
            if len(rows) != len(values):
                call.fail("TABLE_6", f"{path}/NUME_LIGN", rows=len(rows), values=len(values))
            placed = dict(zip(rows, values))
            values = [placed.get(row) for row in range(1, max(rows) + 1)]
        else:
            lengths.append(len(values))
        columns[name] = (kind, values)
    if len(set(lengths)) > 1:
        call.fail("TABLE_5", "LISTE", lengths=", ".join(map(str, lengths)))
    return columns


def _points(factor):
    concept = factor["FONCTION"]
    names = factor.get("PARA", [concept.points().parameter, concept.points().component])
    return {name: ("R", values) for name, values in zip(names, concept.Valeurs())}


def _of_field(call, k, path):
    """A row for each node, cell, point or node of a cell that has one of the components."""
    table = Table(titr=title(call))
    for head, field in places.fields(call, k, path, "RESULTAT"):
        names = k.get("NOM_CMP", field.components)
        columns = [places.component(call, field, name, f"{path}/NOM_CMP") for name in names]
        mesh = field.mesh()
        owner, place = field.rows()
        node = owner if field.location == "NOEU" else mesh.nodes_of(field.support) if field.location == "ELNO" else None
        chosen = field.present[:, columns].any(axis=1)
        if "TOUT" not in k:
            chosen &= _chosen_rows(call, k, path, mesh, field, owner, node)
        points = mesh.getCoordinates().toNumpy()
        for i in numpy.flatnonzero(chosen):
            row = dict(head)
            if field.location != "NOEU":
                row["MAILLE"] = ("K8", f"M{owner[i] + 1}")
            if field.location == "ELGA":
                row["POINT"] = ("I", int(place[i]) + 1)
            if node is not None:
                row["NOEUD"] = ("K8", f"N{node[i] + 1}")
                row.update((f"COOR_{axis}", ("R", float(x))) for axis, x in zip("XYZ", points[node[i]]))
            row.update((name, ("R", float(field.values[i, c]) if field.present[i, c] else None)) for name, c in zip(names, columns))
            table.add_row(row)
    if not len(table):
        call.fail("POST_3", path, field=k.get("NOM_CHAM", "CHAM_GD"), components=", ".join(k.get("NOM_CMP", [part("any_component")])))
    return table


def _chosen_rows(call, k, path, mesh, field, owner, node):
    """Which rows of a field NOEUD, GROUP_NO, MAILLE and GROUP_MA mean."""
    if field.location == "NOEU":
        return numpy.isin(owner, places.nodes(call, k, mesh, path))
    rows = numpy.isin(owner, places.cells(call, k, mesh, path)) if {"MAILLE", "GROUP_MA"} & set(k) else numpy.ones(len(owner), bool)
    at = {keyword: k[keyword] for keyword in ("NOEUD", "GROUP_NO") if keyword in k}
    if at and node is None:
        call.fail("TEST_RESU_5", f"{path}/{next(iter(at))}", keyword=next(iter(at)), field=field.name)
    return rows & numpy.isin(node, places.nodes(call, at, mesh, path)) if at else rows


# ---------------------------------------------------------------------------------------------------- IMPR_TABLE


def chosen(call, table):
    """What FILTRE, TRI and NOM_PARA leave of a table."""
    k = call.keywords
    table = filters.filtered(call, table, k.get("FILTRE", ()))
    for factor in k.get("TRI", ()):
        for name in factor["NOM_PARA"]:
            filters.column_of(call, table, name, "TRI/NOM_PARA")
        table.sort(factor["NOM_PARA"], factor["ORDRE"])
    if "NOM_PARA" in k:
        for name in k["NOM_PARA"]:
            filters.column_of(call, table, name, "NOM_PARA")
        table = table[k["NOM_PARA"]]
    return table


def impr_table(call):
    k = call.keywords
    try:
        real = printing.number_format(k["FORMAT_R"])
    except ValueError:
        call.fail("TABLE_11", "FORMAT_R", text=k["FORMAT_R"])
    concept = k["TABLE"]
    table = chosen(call, concept.EXTR_TABLE())
    if k["FORMAT"] in ("XMGRACE", "PNG"):
        _draw(call, concept, table)
        return
    if k["FORMAT"] == "NUMPY":
        save(call, table)
        return
    if "TITRE" in k:
        table.titr = title(call)
    pages = _pages(call, table, k.get("PAGINATION", ()))
    text = "".join(_page(call, concept.label, page, real) for page in pages)
    call.study.write_text(k["UNITE"], ".resu" if k["UNITE"] == 8 else ".table", f"IMPR_TABLE/UNITE, {call.where}", text)


def _draw(call, concept, table):
    """A curve of each column by the first one."""
    if len(table.para) < 2:
        call.fail("TABLE_12", "NOM_PARA", format=call.keywords["FORMAT"], needed=part("two_or_more"), count=len(table.para))
    for name in table.para:
        filters.numeric(call, table, name, "NOM_PARA")
    k, made = call.keywords, []
    legend = k.get("LEGENDE")
    for name in table.para[1:]:
        points = table.Array(table.para[0], name).reshape(-1, 2)
        called = legend if legend is not None and len(table.para) == 2 else f"{legend or concept.label} {name}"
        made.append(Curve(points[:, 0], points[:, 1], (table.para[0], name), called, k.get("COULEUR"), k.get("STYLE"), k.get("MARQUEUR"),
                          k.get("FREQ_MARQUEUR", 0)))
    draw(call, made)


def save(call, table):
    """FORMAT='NUMPY': the numbers of a table as the array of numpy.save, a row a row; nan where a cell has none."""
    for name in table.para:
        filters.numeric(call, table, name, "NOM_PARA")
    unit, where = call.keywords["UNITE"], f"{call.command}/UNITE, {call.where}"
    path = call.study.announced_output(unit, ".npy", where)
    array = numpy.array([[row.get(name) for name in table.para] for row in table.rows], float)
    try:
        with whole(path) as partial, open(partial, "wb") as file:
            numpy.save(file, array)
    except OSError:
        call.fail("COMMAND_8", "UNITE", unit=unit, file=path)
    call.study.written_units[unit] = path


def _pages(call, table, names):
    """One table for each set of values of the columns `names`."""
    for name in names:
        filters.column_of(call, table, name, "PAGINATION")
    pages = [table]
    for name in names:
        pages = [page[name].VIDE() if value is None else page[name] == value
                 for page in pages for value in dict.fromkeys(page[name])]
    return pages


def _page(call, label, table, real):
    k = call.keywords
    comment = k["COMMENTAIRE"]
    head = printing.banner(label, comment)
    if k["FORMAT"] == "ASTER":
        return printing.aster(table) + "\n"
    if k["FORMAT"] == "TABLEAU_CROISE":
        if len(table.para) != 3:
            call.fail("TABLE_12", "NOM_PARA", format="TABLEAU_CROISE", needed="3", count=len(table.para))
        lost = hidden_by_crossing(table, table.para, real)
        if lost:
            call.study.inform("TABLE_19", f"{call.command}/NOM_PARA, {call.where}", count=lost, down=table.para[0], across=table.para[1], format=k["FORMAT_R"])
        return head + printing.columns(crossed(table, table.para, real), real, k["SEPARATEUR"], comment) + "\n"
    end = k["FIN_LIGNE"].removesuffix("\n")
    return head + printing.columns(table, real, k["SEPARATEUR"], comment, k["DEBUT_LIGNE"], end) + "\n"


# ---------------------------------------------------------------------------------------------------- TEST_TABLE


def test_table(call):
    k = call.keywords
    concept, name = k["TABLE"], k["NOM_PARA"]
    table = filters.filtered(call, concept.EXTR_TABLE(), k.get("FILTRE", ()))
    suffix = next(s for s in ("_I", "_K", "") if "VALE_CALC" + s in k)
    column = filters.column_of(call, table, name, "NOM_PARA")
    kind = table.kind(name)
    if (suffix == "_K") != (kind[0] == "K") or (suffix == "_I" and kind == "R"):
        call.fail("TABLE_2", f"VALE_CALC{suffix}", keyword=f"VALE_CALC{suffix}", column=name, kind=kind,
                  wanted={"I": "VALE_CALC_I", "R": "VALE_CALC", "K": "VALE_CALC_K"}[kind[0]])
    values = column.values()
    if "TYPE_TEST" in k:
        filters.numeric(call, table, name, "NOM_PARA")
    if not values:
        filters.refuse_nothing_left(call, concept.EXTR_TABLE(), k.get("FILTRE", ()), name)
    if "TYPE_TEST" not in k and len(values) > 1:
        call.fail("TABLE_9", "FILTRE" if "FILTRE" in k else "NOM_PARA", name=name, count=len(values))
    value = values[0]
    if "TYPE_TEST" in k or suffix == "":
        value = places.reduce(numpy.array(values, float), k.get("TYPE_TEST"))
        value = int(value) if suffix == "_I" else value
    place = k.get("TYPE_TEST", "")
    check = checks.conclude(call, checks.Check(call.where, concept.label, "", name, place, None, k.get("LEGENDE", ""), value), k)
    call.study.progress(checks.line(check))
    call.study.checks.append(check)


# ---------------------------------------------------------------------------------------------------- RECU_TABLE


def recu_table(call):
    k = call.keywords
    result = k["CO"]
    table = _kept(call, result, k["NOM_TABLE"]) if "NOM_TABLE" in k else places.parameters(call, result, k["NOM_PARA"], "NOM_PARA")
    if "TITRE" in k:
        table.titr = title(call)
    return storage.make(call, table)


def _kept(call, result, name):
    """A table that the computation kept with its result."""
    with result.open() as file:
        kept = file["tables"] if "tables" in file else {}
        if name not in kept:
            call.fail("TABLE_10", "NOM_TABLE", label=result.label, name=name, known=", ".join(kept) or part("none"))
        return storage.read_table(kept[name])


# ---------------------------------------------------------------------------------------------------- EXTR_TABLE

#: TYPE_RESU of concepts -> their types here
_concepts = {"CHAM_GD_SDASTER": ("field",), "CHAM_NO_SDASTER": ("field",), "CHAM_ELEM": ("field",), "CARTE_SDASTER": ("field",), "TABLE_SDASTER": ("table",),
             "FONCTION_SDASTER": ("function", "formula"), "NAPPE_SDASTER": ("function",), "EVOL_NOLI": ("result",), "EVOL_ELAS": ("result",),
             "EVOL_THER": ("result",)}


def _called(study, text):
    """What a text in a table names: a variable of the functions under way or of the study, a place in a list or a dictionary ("R[0]"), or, where no
    variable has it, the latest concept made under this name that something still holds."""
    frame = labels.user_frame()
    while frame is not None:
        there = None if labels.is_own(frame) else frame.f_locals.get(text)
        if isinstance(there, Concept):
            return there
        frame = frame.f_back
    for name, value in list(study.names.values.items()):
        for label, there in concepts_of(name, value):
            if label == text and not there.destroyed:
                return there
    held = [there for _, there in study.base.live_objects() if there.label == text and not there.destroyed]
    return max(held, key=lambda there: int(there.id.rpartition("_")[2]), default=None)


def extr_table(call):
    """@return a number of Python's, or a concept of its own with the content of the one that the cell names"""
    k = call.keywords
    table, name, kind = filters.filtered(call, k["TABLE"].EXTR_TABLE(), k.get("FILTRE", ())), k["NOM_PARA"], k["TYPE_RESU"]
    cells = filters.column_of(call, table, name, "NOM_PARA").values()
    if not cells:
        filters.refuse_nothing_left(call, k["TABLE"].EXTR_TABLE(), k.get("FILTRE", ()), name)
    if len(cells) > 1:
        call.fail("TABLE_16", "FILTRE" if "FILTRE" in k else "NOM_PARA", name=name, count=len(cells))
    is_number = not isinstance(cells[0], str)
    if is_number and (kind == "REEL" or (kind == "ENTIER" and isinstance(cells[0], int))):
        return float(cells[0]) if kind == "REEL" else cells[0]
    there = None if is_number else _called(call.study, cells[0].strip())
    if kind in ("REEL", "ENTIER") or not isinstance(there, Concept) or there.type not in _concepts[kind]:
        call.fail("TABLE_17", "TYPE_RESU", name=name, cell=cells[0], kind=kind)
    return information.copy_of(call, there)
