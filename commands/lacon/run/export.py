"""Export files: which command files, data files and results a study has.

`F type name D|R unit` (D a datum, R a result, DR both; a name may hold spaces); `comm` files run in order, first comm, then com1,
com2, ...; type `nom`, or unit 0, is a file that must lie in the working folder under its own name; type `base` is the folder of the
base. `P name value` are parameters.
"""

import math
import pathlib
import re

from ..core.messages import fail


#: type, name, use and unit of a file; the name is all that lies between
FILE = re.compile(r"[FR]\s+(\S+)\s+(\S.*?)\s+([DRC]+)\s+(\d+)")

#: parameters that are numbers of threads and of processes
COUNTS = ("ncpus", "mpi_nbcpu")
SECONDS = "time_limit"


class Export:
    def __init__(self):
        self.commands = []  #: in their order
        self.ranked = []  #: (rank, name) of command files, as they come
        self.units = {}
        self.data = []  #: files of units that are not to be written
        self.named = []  #: files that the command file reads under their own name
        self.base = None
        self.parameters = {}

    def count(self, name):
        """A parameter of COUNTS, 0 as 1; nothing where it is not given"""
        return max(1, int(self.parameters[name])) if name in self.parameters else None

    def seconds(self):
        """The time limit; 0: there is none"""
        return _seconds(self.parameters.get(SECONDS, "0").split())

    def enter_file(self, where, kind, name, use, unit):
        """Of an F or R line: its type, path, use (D, R, DR; C: compressed) and unit. @throws AsterError STUDY_44 where the unit has another file"""
        if kind == "comm" or re.fullmatch(r"com\d+", kind):
            self.ranked.append((_rank(kind, name), name))
        elif kind in ("base", "bhdf"):
            self.base = name
        elif kind == "nom" or (unit == 0 and "D" in use):
            self.named.append(name)
        elif unit:
            if self.units.setdefault(unit, name) != name:
                fail("STUDY_44", where, unit=unit, first=self.units[unit], file=name)
            if "R" not in use:
                self.data.append(name)


def read_export(path):
    """@throws AsterError STUDY_13 where a line is not of the format, STUDY_14 where there is no such file, STUDY_15 where it names no command file,
    STUDY_43 and STUDY_45 where a parameter is no number, STUDY_44 where a unit has two files"""
    path = pathlib.Path(path)
    export = Export()
    try:
        lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    except OSError as error:
        fail("STUDY_14", str(path), file=path, reason=error.strerror)
    for number, line in enumerate(lines, 1):
        words = line.split()
        if not words or words[0].startswith("#") or words[0] in ("A", "N"):
            continue
        if words[0] == "P" and len(words) >= 2:
            export.parameters[words[1]] = " ".join(words[2:])
            if words[1] in COUNTS and not (len(words) == 3 and words[2].isdecimal()):
                fail("STUDY_43", f"{path}:{number}", name=words[1], value=" ".join(words[2:]))
            if words[1] == SECONDS and not _seconds(words[2:]) >= 0:
                fail("STUDY_45", f"{path}:{number}", value=" ".join(words[2:]))
            continue
        match = FILE.fullmatch(line.strip())
        if not match:
            fail("STUDY_13", f"{path}:{number}", line=line.strip())
        export.enter_file(f"{path}:{number}", match[1], path.parent / match[2], match[3], int(match[4]))
    if not export.ranked:
        fail("STUDY_15", str(path), file=path)
    export.commands = [name for _, name in sorted(export.ranked, key=lambda ranked: ranked[0])]
    return export


def _seconds(words):
    """A number of seconds, NaN where the words are none"""
    try:
        return float(*words) if len(words) == 1 else math.nan
    except ValueError:
        return math.nan


def _rank(kind, path):
    """comm first, then com1, com2, ... in the order of their numbers, which the type says, or else the suffix; others stay where they are
    (sorted() is stable)."""
    match = re.fullmatch(r"com(\d+)", kind) or re.fullmatch(r"\.com(\d+)", path.suffix)
    return int(match[1]) if match else 0
