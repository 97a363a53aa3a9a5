"""`lacon inspect BASE`: what sees what in a contact, at an instant or before any, as VTU and MED files and as a few lines.

Reads the base, and never changes it.
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from ..base import contents
from ..base.base import ReadBase, once
from ..core import catalog, checker, plugins
from ..core.command_line import CommandLine
from ..core.concepts import to_json
from ..core.messages import AsterError, fail
from ..objects.kinds import kinds

_files = (("VTU", "pairing.vtu"), ("MED", "pairing.med"))
_layer = re.compile(r"pairing_(pairs|skins|points|rejected)(_\d+\.vtu|\.pvd)")


def parser():
    """Of its command line."""
    made = CommandLine(
        prog="lacon inspect", description="Writes the pairing of a contact: polygons of the contact cells, skins with the covered "
        "fraction of their patches, integration points with their gap, rejected couples with the reason.")
    made.add("base", metavar="BASE", help="folder of the base, STUDY.base")
    made.add("--result", metavar="LABEL", help="a result with contact, or a contact (then before any instant); otherwise the only one")
    made.add("--instant", metavar="T", help="an instant of the result, 'last' (default) or 'all'")
    made.add("--out", metavar="FOLDER", help="where the files go; otherwise BASE without its suffix and with _pairing")
    return made


def run(arguments):
    """@return exit status"""
    asked = parser()
    options = asked.parse_args(arguments)
    if options.instant not in (None, "last", "all"):
        try:
            options.instant = float(options.instant)
        except ValueError:
            asked.wrong("give_instant", option=f"--instant {options.instant}")
    shelf = ReadBase(options.base, "lacon inspect", kinds)
    folder = pathlib.Path(options.out or shelf.folder.with_name(shelf.folder.stem + "_pairing").name)
    if any(map(shelf.needs, (folder, *(folder / name for _, name in _files)))):
        fail("STUDY_41", "lacon inspect", option="--out", file=folder)
    chosen = choose(shelf, options.result)
    if chosen.type == "contact" and options.instant is not None:
        fail("INSPECT_3", "lacon inspect --instant", label=chosen.label)
    return write(shelf, resu(chosen, "last" if options.instant is None else options.instant), folder)


def choose(shelf, label):
    """The result or contact that is meant."""
    results = {name: item for name, item in shelf.labelled("result").items() if contact_of(item)}
    contacts = shelf.labelled("contact")
    known = {**contacts, **results}
    if not known:
        fail("INSPECT_4", "lacon inspect")
    if label:
        if label not in known:
            fail("INSPECT_1", f"lacon inspect --result {label}", label=label, known=", ".join(known))
        return known[label]
    candidates = once(results or contacts)
    if len(candidates) != 1:
        fail("INSPECT_2", "lacon inspect", count=len(candidates), known=", ".join(once(known)))
    return next(iter(candidates.values()))


def contact_of(result):
    with result.open() as file:
        return contents.contacts(file)


def resu(chosen, instant):
    """The occurrence of RESU that is meant."""
    if chosen.type == "contact":
        return {"CONTACT": chosen}
    if instant == "all":
        return {"RESULTAT": chosen, "PAIRING": "OUI"}
    if instant == "last":
        with chosen.open() as file:
            return {"RESULTAT": chosen, "PAIRING": "OUI", "NUME_ORDRE": [contents.orders_with_contact(file)[-1]]}
    return {"RESULTAT": chosen, "PAIRING": "OUI", "INST": [instant]}


def write(shelf, occurrence, folder):
    """Both files, by two orders of IMPR_RESU; what an earlier look left in the folder goes. @return exit status"""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        fail("STUDY_50", "lacon inspect --out", option="--out", file=folder, reason=error.strerror)
    earlier = {path: path.stat().st_ino for path in folder.iterdir() if _layer.fullmatch(path.name)}
    for number, (form, name) in enumerate(_files):
        keywords, problems, _ = checker.complete("IMPR_RESU", catalog.command("IMPR_RESU"),
                                                 {"FORMAT": form, "UNITE": 80, "RESU": occurrence}, "lacon inspect")
        if problems:
            raise AsterError(problems)
        made = {"format": 1, "command": "IMPR_RESU", "base": str(shelf.folder), "units": {"80": os.path.abspath(folder / name)},
                "source": "lacon inspect", "keywords": to_json(keywords)}
        with tempfile.TemporaryDirectory(prefix="lacon_inspect_") as scratch:
            order = pathlib.Path(scratch) / "order.json"
            order.write_text(json.dumps(made, ensure_ascii=False), encoding="utf-8")
            done = subprocess.run([plugins.operator("impr_resu"), order], stdout=subprocess.PIPE, stdin=subprocess.DEVNULL,
                                  stderr=subprocess.PIPE if number else None, text=True, check=False)
        if done.returncode:
            sys.stderr.write(done.stderr or "")
            if not any(folder.iterdir()):
                folder.rmdir()
            return done.returncode if done.returncode > 0 else 4
        for line in done.stdout.splitlines():  # the second file has the same to say
            if number == 0 or not line.startswith(("Pairing of", "  ")):
                print(os.path.relpath(line) if os.path.isabs(line) else line)
    for path, inode in earlier.items():
        if path.stat().st_ino == inode:  # not replaced: a layer or an instant that there is no more
            path.unlink()
    sys.stdout.flush()
    return 0
