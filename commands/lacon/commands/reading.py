"""LIRE_TABLE, LIRE_FONCTION: tables and functions from text files."""

import itertools
import math
import re

from ..base.functions import Piecewise
from ..core.catalog import part
from ..core.late import numpy
from ..tables import storage
from ..tables.table import Table, type_of
from . import functions
from .call import Call

_missing = "-"


def _lines(call):
    """(the file of UNITE, its lines)"""
    path = call.study.input_unit(call.keywords["UNITE"], f"{call.command}/UNITE, {call.where}")
    try:
        with open(path, encoding="utf-8-sig", errors="replace") as file:
            lines = file.read().splitlines()
    except OSError:
        call.fail("COMMAND_5", "UNITE", unit=call.keywords["UNITE"], file=path)
    call.study.has_read(path)
    return path, lines


def _number(text):
    """A number as Fortran or anyone writes it; None for any other text."""
    try:
        return float(re.sub("[dD]", "e", text))
    except ValueError:
        return None


def _words(line, separator, first=""):
    """Cells of a line; blanks count as one separator. @param first what stands before the first cell"""
    return line.split() if separator is None else [cell.strip() for cell in line.strip().removeprefix(first).removesuffix(separator).split(separator)]


def _before(lines, separator):
    """The separator, where each of these lines begins with it: so IMPR_TABLE and IMPR_FONCTION write them."""
    return separator if separator and all(line.strip().startswith(separator) for line in lines) else ""


# ---------------------------------------------------------------------------------------------------- LIRE_TABLE


def lire_table(call):
    k = call.keywords
    path, lines = _lines(call)
    numbered = list(enumerate(lines, 1))
    blocks = _between_marks(call, path, numbered) if k["FORMAT"] == "ASTER" else _paragraphs(numbered)
    if k["NUME_TABLE"] > len(blocks):
        call.fail("TABLE_15", "NUME_TABLE", file=path, count=len(blocks), format=k["FORMAT"])
    table = _table(call, path, blocks[k["NUME_TABLE"] - 1])
    if "TITRE" in k:
        table.titr = "\n".join(k["TITRE"])
    return storage.make(call, table)


def _between_marks(call, path, lines):
    """Lines between #DEBUT_TABLE and #FIN_TABLE, table by table."""
    blocks, block = [], None
    for number, line in lines:
        word = line.strip()
        if word == "#DEBUT_TABLE":
            block = []
        elif word == "#FIN_TABLE" and block is not None:
            blocks.append(block)
            block = None
        elif block is not None:
            block.append((number, line))
    if block is not None:
        call.fail("TABLE_14", "UNITE", file=path, line=len(lines), reason=part("table_ends_early"))
    return blocks


def _paragraphs(lines):
    """Lines between empty lines; comments alone are no table."""
    blocks = [[]]
    for number, line in lines:
        if line.strip().strip("#"):
            blocks[-1].append((number, line))
        elif not line.strip() and blocks[-1]:
            blocks.append([])
    return [block for block in blocks if any(not line.strip().startswith("#") for _, line in block)]


def _table(call, path, lines):
    """A line of names, in FORMAT='ASTER' one of types, rows."""
    k = call.keywords
    separator = k["SEPARATEUR"].strip() or None
    marked = k["FORMAT"] == "ASTER"
    title = [line.strip()[len("#TITRE "):] for _, line in lines if line.strip().startswith("#TITRE ")]
    lines_of_cells = [(number, line) for number, line in lines if line.strip() and not line.strip().startswith("#")]
    first = _before([line for _, line in lines_of_cells], separator)
    rows = [(number, _words(line, separator, first)) for number, line in lines_of_cells]
    if len(rows) < (2 if marked else 1):
        call.fail("TABLE_14", "UNITE", file=path, line=lines[-1][0] if lines else 1, reason=part("table_begins_with_types" if marked else "table_begins_with_names"))
    names = _unique(call, rows[0][1])
    kinds = rows[1][1] if marked else []
    body = rows[2 if marked else 1:]
    for number, cells in ([rows[1]] if marked else []) + body:
        if len(cells) != len(names):
            call.fail("TABLE_14", "UNITE", file=path, line=number, reason=part("cells_for_columns", cells=len(cells), columns=len(names)))
    for kind in kinds:
        if kind not in ("I", "R") and not re.fullmatch("K(8|16|24|32|80)", kind):
            call.fail("TABLE_14", "UNITE", file=path, line=rows[1][0], reason=part("no_type_of_column", kind=kind))
    columns = {}
    for c, name in enumerate(names):
        texts = [(number, cells[c]) for number, cells in body]
        columns[name] = _column(call, path, texts, kinds[c] if marked else None)
    return Table.of_columns(columns, "\n".join(title))


def _column(call, path, texts, kind):
    """(type, values); the type follows from the texts where it is not given."""
    there = [text for _, text in texts if text != _missing]
    if kind is None:
        if not all(_number(text) is not None for text in there):
            kind = type_of(there)
        else:
            kind = "I" if there and all(re.fullmatch("[+-]?[0-9]+", text) for text in there) else "R"
    values = []
    for number, text in texts:
        if text == _missing:
            values.append(None)
        elif kind[0] == "K":
            values.append(text)
        elif _number(text) is None or (kind == "I" and not _number(text).is_integer()):
            call.fail("TABLE_14", "UNITE", file=path, line=number, reason=part("text_is_no_integer" if kind == "I" else "text_is_no_number", text=text))
        else:
            values.append(int(_number(text)) if kind == "I" else _number(text))
    return kind, values


def _unique(call, names):
    """Names of columns; with RENOMME_PARA='UNIQUE' a name that was there gets a number."""
    found = []
    for name in names:
        if name in found and call.keywords.get("RENOMME_PARA") != "UNIQUE":
            call.fail("TABLE_7", "RENOMME_PARA", name=name)
        number = 1
        given = name
        while name in found:
            name, number = f"{given}_{number}", number + 1
        found.append(name)
    return found


# ---------------------------------------------------------------------------------------------------- LIRE_FONCTION


def lire_fonction(call):
    k = call.keywords
    if k["FORMAT"] == "NUMPY":
        path, blocks = _array(call)
    else:
        path, lines = _lines(call)
        blocks = _blocks(call, path, lines, {"None": None}.get(k["SEPAR"], k["SEPAR"]))
    if k["TYPE"] == "NAPPE":
        return _nappe(call, path, blocks)
    x, y = (_of_block(call, path, blocks, k[keyword], keyword) for keyword in ("INDIC_PARA", "INDIC_RESU"))
    if len(x) != len(y):
        call.fail("DEFI_FONCTION_5", "INDIC_RESU", parameters=len(x), values=len(y))
    x, y = functions.increasing(call, x, y, k["VERIF"], "INDIC_PARA")
    like = Piecewise(x, y, parameter=k["NOM_PARA"], component=k["NOM_RESU"])
    return functions.make(call, functions.described(call, x, y, like), "UNITE")


def _nappe(call, path, blocks):
    """A function of two parameters: their first one, abscissae that all its functions have, and the values of each."""
    k = call.keywords
    abscissae = _of_block(call, path, blocks, k["INDIC_ABSCISSE"], "INDIC_ABSCISSE")
    curves = []
    for i, factor in enumerate(k["DEFI_FONCTION"], 1):
        values = _of_block(call, path, blocks, factor["INDIC_RESU"], f"DEFI_FONCTION[{i}]/INDIC_RESU")
        curves.append({"ABSCISSE": abscissae, "ORDONNEE": values, **{name: factor[name] for name in ("INTERPOL", "PROL_GAUCHE", "PROL_DROITE")}})
    keywords = {**{name: k[name] for name in ("NOM_PARA", "NOM_PARA_FONC", "NOM_RESU", "INTERPOL", "PROL_GAUCHE", "PROL_DROITE", "VERIF")},
                "PARA": _of_block(call, path, blocks, k["INDIC_PARA"], "INDIC_PARA"), "DEFI_FONCTION": curves}
    return functions.defi_nappe(Call(call.study, call.command, keywords, call.where, call.label))


def _array(call):
    """(the file of UNITE, its array as one block)"""
    path = call.study.input_unit(call.keywords["UNITE"], f"{call.command}/UNITE, {call.where}")
    try:
        array = numpy.load(path, allow_pickle=False)
        block = numpy.atleast_2d(numpy.asarray(array, float)).tolist()
        if array.ndim != 2:
            raise ValueError(f"it has {array.ndim} dimensions")
        if not all(map(math.isfinite, itertools.chain.from_iterable(block))):
            raise ValueError("it has numbers that are not finite")
    except (ValueError, TypeError, OSError, EOFError) as error:
        call.fail("FUNCTION_20", "UNITE", file=path, reason=error)
    call.study.has_read(path)
    return path, [block]


def _blocks(call, path, lines, separator):
    """Lines of numbers one behind the other are a block, of as many columns as its first line; any line that begins otherwise separates blocks.
    @throws AsterError FUNCTION_24"""
    blocks, open_block = [], False
    first = _before([line for line in lines if line.strip() and not line.strip().startswith("#")], separator)
    for number, line in enumerate(lines, 1):
        words = _words(line, separator, first)
        row = [_number(word) for word in words]
        is_row = bool(row) and row[0] is not None
        if is_row:
            bad = next((word for word, value in zip(words, row) if value is None or not math.isfinite(value)), None)
            if bad is not None:
                call.fail("FUNCTION_24", "UNITE", file=path, line=number, reason=part("text_is_no_number", text=bad))
            if not open_block:
                blocks.append([])
            elif len(row) != len(blocks[-1][0]):
                call.fail("FUNCTION_24", "UNITE", file=path, line=number, reason=part("cells_for_columns", cells=len(row), columns=len(blocks[-1][0])))
            blocks[-1].append(row)
        open_block = is_row
    return blocks


def _of_block(call, path, blocks, place, keyword):
    """A column of numbers that `place`, (block, column) from 1, names."""
    block, column = place
    if block > len(blocks) or any(column > len(row) for row in blocks[block - 1]):
        sizes = "; ".join(f"block {i}: {min(map(len, b))} columns, {len(b)} lines" for i, b in enumerate(blocks, 1)) or "no numbers"
        call.fail("FUNCTION_16", keyword, file=path, block=block, column=column, known=sizes)
    return [row[column - 1] for row in blocks[block - 1]]
