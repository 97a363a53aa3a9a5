"""Export files: which command files, data files and results a study has.

`F type name D|R unit` (D a datum, R a result, DR both); `comm` files run in order, first comm, then com1, com2, ...; type `nom`, or unit 0,
is a file that must lie in the working folder under its own name; type `base` is the folder of the base. `P name value` are parameters.
"""

import pathlib
import re

from .messages import fail


class Export:
    def __init__(self):
        self.commands = []
        self.units = {}
        self.named = []  #: files that the command file reads under their own name
        self.base = None
        self.parameters = {}


def read_export(path):
    """@throws AsterError STUDY_13 where a line is not of the format"""
    path = pathlib.Path(path)
    export = Export()
    commands = []
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        fail("STUDY_14", str(path), file=path, reason=error.strerror)
    for number, line in enumerate(lines, 1):
        words = line.split()
        if not words or words[0].startswith("#") or words[0] in ("A", "N"):
            continue
        if words[0] == "P" and len(words) >= 2:
            export.parameters[words[1]] = " ".join(words[2:])
            continue
        if words[0] not in ("F", "R") or len(words) < 5 or not words[-1].isdigit() or set(words[3]) - set("DRC"):
            fail("STUDY_13", f"{path}:{number}", line=line.strip())
        kind, name, use, unit = words[1], path.parent / words[2], words[3], int(words[4])
        if kind == "comm" or re.fullmatch(r"com\d+", kind):
            commands.append(name)
        elif kind in ("base", "bhdf"):
            export.base = name
        elif kind == "nom" or (unit == 0 and "D" in use):
            export.named.append(name)
        elif unit:
            export.units[unit] = name
    export.commands = sorted(commands, key=_rank)
    if not commands:
        fail("STUDY_15", str(path), file=path)
    return export


def _rank(path):
    """.comm first, then .com1, .com2, ... in the order of their numbers; others stay where they are (sorted() is stable)."""
    match = re.fullmatch(r"\.com(\d+)", path.suffix)
    return int(match[1]) if match else 0
