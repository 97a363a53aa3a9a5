"""Files and units in a command file: INCLUDE, DEFI_FICHIER, INFO_EXEC_ASTER."""

import math
import os
import signal

from ..core import current, labels
from ..core.catalog import part
from ..core.messages import fail
from ..tables import storage
from ..tables.table import Table


def include(call):
    """Run a file with the study's names, as if it stood here."""
    k, run = call.keywords, call.study
    place = f"INCLUDE, {call.where}"
    if "DONNEE" in k:
        path = os.path.join(os.path.dirname(call.where), k["DONNEE"])
        if not os.path.isfile(path):
            fail("STUDY_14", place, file=path, reason=part("file_not_there"))
    else:
        path = run.input_unit(k["UNITE"], place)
    including = labels.files_under_way()
    if os.path.realpath(path) in map(os.path.realpath, including):
        fail("STUDY_49", place, files=" -> ".join(map(os.path.relpath, [*including, path])))
    run.protect(path)
    with current.others_take_turns():
        run.include(path)


def defi_fichier(call):
    """@return the unit, of ASSOCIER and RESERVER"""
    k, run = call.keywords, call.study
    if k["ACTION"] == "LIBERER":
        run.release(k["UNITE"] if "UNITE" in k else _unit_of(call, k["FICHIER"]))
        return None
    number = k["UNITE"] if "UNITE" in k else run.free_unit()
    if number is None:
        call.fail("COMMAND_15", "UNITE")
    path = k.get("FICHIER", f"fort.{number}")
    if k["ACCES"] == "OLD" and not os.path.isfile(path):
        fail("COMMAND_5", f"DEFI_FICHIER/FICHIER, {call.where}", unit=number, file=path)
    run.associate(number, path, k["ACCES"] == "APPEND")
    return number


def pre_gmsh(call):
    """UNITE_MAILLAGE is gmsh's file from now on: LIRE_MAILLAGE, asked for code_aster's text, sees what it is."""
    k = call.keywords
    path = call.study.input_unit(k["UNITE_GMSH"], f"PRE_GMSH/UNITE_GMSH, {call.where}")
    call.study.protect(path)
    call.study.associate(k["UNITE_MAILLAGE"], path, append=False)


def _unit_of(call, path):
    """The unit that DEFI_FICHIER gave this file."""
    run = call.study
    for number in run.earlier_units:
        if os.path.abspath(run.units[number]) == os.path.abspath(path):
            return number
    known = ", ".join(run.units[number] for number in run.earlier_units) or part("none")
    call.fail("COMMAND_16", "FICHIER", file=path, known=known)


def info_exec_aster(call):
    """A table of one row. Time that remains is infinite where there is no limit."""
    k, run = call.keywords, call.study
    left = signal.getitimer(signal.ITIMER_REAL)[0] or math.inf
    row = {}
    for what in k["LISTE_INFO"]:
        if what == "UNITE_LIBRE":
            row[what] = "I", run.free_unit()
        elif what == "ETAT_UNITE":
            if "UNITE" not in k and "FICHIER" not in k:
                fail("KEYWORD_7", f"INFO_EXEC_ASTER, {call.where}", path="INFO_EXEC_ASTER", names="UNITE, FICHIER")
            number = k["UNITE"] if "UNITE" in k else _unit_of(call, k["FICHIER"])
            row[what] = "K16", "OUVERT" if number in run.earlier_units or number in run.written_units else "FERME"
        else:
            row[what] = "R", left
    table = Table(titr="\n".join(k.get("TITRE", ())))
    table.add_row(row)
    return storage.make(call, table)
