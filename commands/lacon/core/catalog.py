"""The catalogue at run time: one installed JSON, or the TOML rows of the source tree where there is none.

Both give the same dictionaries; catalog/generate.py makes the one from the other.
"""

import functools
import json
import os
import pathlib
import re
import shutil
import sys

_home = pathlib.Path(__file__).resolve().parent


def _candidates():
    """Where a catalogue may be: what the user says, then beside the launcher (installed, build tree), then the source tree."""
    said = os.environ.get("LACON_CATALOG")
    if said:
        yield pathlib.Path(said)
        return
    launcher = pathlib.Path(os.path.realpath(sys.argv[0])).parent.parent
    yield launcher / "share" / "lacon" / "catalog.json"
    yield launcher / "generated" / "catalog.json"
    yield _home.parents[2] / "catalog.json"
    in_path = shutil.which("lacon")  # `import lacon` from the sources
    if in_path:
        built = pathlib.Path(os.path.realpath(in_path)).parent.parent
        yield built / "share" / "lacon" / "catalog.json"
        yield built / "generated" / "catalog.json"
    yield _home.parents[2] / "catalog"


@functools.cache
def location():
    """Path of the JSON file or of the folder of TOML rows. @throws FileNotFoundError"""
    tried = list(_candidates())
    for path in tried:
        if path.exists():
            return path
    raise FileNotFoundError("no catalogue at " + ", ".join(map(str, tried)))


@functools.cache
def _json():
    with open(location(), encoding="utf-8") as file:
        return json.load(file)


@functools.cache
def toml(path):
    """The rows of a file."""
    import tomllib  # start-up: installed and in the build tree the catalogue is one JSON

    with open(path, "rb") as file:
        return tomllib.load(file)


def _is_json():
    return location().is_file()


@functools.cache
def command_names():
    """Every command of the catalogue, in alphabetical order."""
    if _is_json():
        return tuple(sorted(_json()["commands"]))
    return tuple(sorted(path.stem.upper() for path in (location() / "commands").glob("*.toml")))


def command(name):
    """The rows of one command."""
    if _is_json():
        return _json()["commands"][name]
    row = toml(location() / "commands" / f"{name.lower()}.toml")
    return {**command(row["like"]), **row} if "like" in row else row


def _messages_of(folder):
    """(messages by identifier, parts by name) in a folder of rows"""
    rows = {}
    for path in sorted(folder.glob("*.toml")):
        rows.update(toml(path) if path.name != "parts.toml" else {})
    return rows, toml(folder / "parts.toml")


def in_french():
    """Whether the user reads French: what catalog/wording.hpp says of the environment."""
    said = (os.environ.get(name) for name in ("LC_ALL", "LC_MESSAGES", "LANG"))
    return next(filter(None, said), "").startswith("fr")


@functools.cache
def _wording(french):
    """(messages, parts) in a language."""
    if _is_json():
        rows, parts = _json()["messages"], _json()["parts"]
        other = (_json()["french"]["messages"], _json()["french"]["parts"]) if french else ({}, {})
    else:
        rows, parts = _messages_of(location() / "messages")
        other = _messages_of(location() / "messages/fr") if french else ({}, {})
    return {identifier: {**row, **other[0].get(identifier, {})} for identifier, row in rows.items()}, {**parts, **other[1]}


def messages():
    """identifier -> {severity, text, do} in the user's language"""
    return _wording(in_french())[0]


def part(name, /, **values):
    """What a text is made of that is no message by itself: a row of messages/parts.toml with its gaps filled."""
    return _wording(in_french())[1][name].format(**values)


@functools.cache
def _instead():
    return _json()["instead"] if _is_json() else toml(location() / "instead.toml")


@functools.cache
def _instead_in_french():
    """A text of instead.toml -> the same in French."""
    return _json()["instead_in_french"] if _is_json() else toml(location() / "instead.fr.toml")


@functools.cache
def _help_in_french():
    """A help line of commands/ -> the same in French."""
    return _json()["help_in_french"] if _is_json() else toml(location() / "help.fr.toml")


def help_of(row):
    """The help line of a command or a keyword in the user's language; what plug-ins say is as they say it."""
    return _help_in_french().get(row["help"], row["help"]) if in_french() else row["help"]


@functools.cache
def _options_in_french():
    """A text of a command line -> the same in French."""
    return _json()["options_in_french"] if _is_json() else toml(location() / "options.fr.toml")


def option_words(text):
    """A text of a command line in the user's language: a description, what an option does, or what argparse says by itself."""
    return _options_in_french().get(text, text) if in_french() else text


def instead(kind, path, otherwise):
    """What to use instead of a command, keyword or value (`kind`) of code_aster's that is not here.

    @param path  "DEFI_CONTACT/ZONE[1]/COEF_CONT"; of a value with "=VALUE" behind it
    """
    path = re.sub(r"\[\d+\]", "", path)
    head, slash, rest = path.partition("/")
    if slash and head in command_names():
        path = f"{command(head).get('like', head)}/{rest}"
    rows = _instead()[kind]
    found = rows.get(path) or rows.get(path.rpartition("/")[2])
    if not found:
        return otherwise
    words = _instead_in_french().get(found, found) if in_french() else found
    return words if found.startswith("leave ") else part("use_instead", what=words)


@functools.cache
def cells():
    """name of a cell type -> its row, with what catalog/generate.py derives. @throws FileNotFoundError where the catalogue is not built"""
    if not _is_json():
        raise FileNotFoundError(f"{location()} holds the rows alone: put the folder of a built `lacon` into PATH, or let LACON_CATALOG name its catalog.json")
    return {row["name"]: row for row in _json()["cells"]}


@functools.cache
def edges(cell):
    """Pairs of vertices, from 0, of the edges of a cell type."""
    if _is_json():
        return [pair[:2] for pair in next(row["edges"] for row in _json()["cells"] if row["name"] == cell)]
    rows = {row["name"]: row for row in toml(location() / "cells.toml")["cell"]}
    return [[a - 1, b - 1] for a, b in rows[rows[cell].get("linear", cell)].get("edges", ())]


def elements():
    """Rows of the finite elements that come with Lacon."""
    if _is_json():
        return list(_json()["elements"])
    return [row for path in sorted((location() / "elements").glob("*.toml")) for row in toml(path)["element"]]


def behaviours(kind):
    """Rows of behaviours.toml. @param kind "relation" or "deformation" """
    return _json()[kind] if _is_json() else toml(location() / "behaviours.toml")[kind]


@functools.cache
def peer_commands():
    """Names of code_aster's commands that Lacon does not have."""
    with open(_home / "peer_commands.txt", encoding="utf-8") as file:
        names = {word for line in file if not line.startswith("#") for word in line.split()}
    return frozenset(names - set(command_names()))
