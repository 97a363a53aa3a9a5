"""Tables as text: IMPR_TABLE's formats, and what print() shows."""

import datetime
import re


def number_format(text):
    """A Fortran-like FORMAT_R ("E12.5", "1PE16.9", "F8.3") as a Python format. @throws ValueError"""
    match = re.fullmatch(r"(?:\d*P)?([DEFG])\s*(\d+)\.(\d+)(?:E\d+)?", text.strip().upper())
    if not match:
        raise ValueError(text)
    return f"{int(match[2])}.{int(match[3])}{'E' if match[1] == 'D' else match[1]}"


def cell(value, real, missing="-"):
    """A cell as text; `real`: Python's format for real numbers."""
    if value is None:
        return missing
    if isinstance(value, float):
        return format(value, real)
    return str(value)


def columns(table, real="12.5E", separator=" ", comment="#", start="", end="", names=None):
    """Every row on a line, cells of a column below each other and below its name."""
    names = table.para if names is None else names
    texts = [[cell(row.get(name), real) for row in table.rows] for name in names]
    left = [table.kind(name)[0] == "K" for name in names]
    widths = [max(map(len, [name, *column])) for name, column in zip(names, texts)]

    def line(cells, first=start):
        padded = (c.ljust(w) if l else c.rjust(w) for c, w, l in zip(cells, widths, left))
        return (first + separator + separator.join(padded)).rstrip(" ") + end

    head = [f"{comment}{part}" for part in table.titr.split("\n") if table.titr]
    return "\n".join([*head, line(names), *(line(cells) for cells in zip(*texts))])


def banner(label, comment="#"):
    """What stands above a table in a file."""
    rule = comment + "-" * 80
    stamp = datetime.datetime.now().strftime("%d/%m/%Y %H:%M:%S")
    return f"{comment}\n{rule}\n{comment}\n{comment}LACON CONCEPT {label} {stamp} TYPE TABLE\n"


def aster(table):
    """FORMAT='ASTER': as LIRE_TABLE of code_aster reads it."""
    kinds = ["".join(kind) for kind in table.type]
    body = columns(table, real="18.11E").split("\n")[-len(table.rows) - 1:]
    lines = ["#DEBUT_TABLE", *(f"#TITRE {part}" for part in table.titr.split("\n") if table.titr), body[0], " " + " ".join(kinds), *body[1:],
             "#FIN_TABLE"]
    return "\n".join(lines)
