"""The catalogue at run time: one installed JSON, or the TOML rows of the source tree where there is none.

Both give the same dictionaries; catalog/generate.py makes the one from the other.
"""

import functools
import json
import os
import pathlib
import re
import sys

_package = pathlib.Path(__file__).resolve().parent


def _candidates():
    """Where a catalogue may be: what the user says, then beside the launcher (installed, build tree), then the source tree."""
    said = os.environ.get("LACON_CATALOG")
    if said:
        yield pathlib.Path(said)
        return
    launcher = pathlib.Path(os.path.realpath(sys.argv[0])).parent.parent
    yield launcher / "share" / "lacon" / "catalog.json"
    yield launcher / "generated" / "catalog.json"
    yield _package.parent.parent / "catalog.json"
    yield _package.parent.parent / "catalog"


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
def _toml(path):
    import tomllib

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
    return _toml(location() / "commands" / f"{name.lower()}.toml")


@functools.cache
def messages():
    """identifier -> {severity, text, do}"""
    if _is_json():
        return _json()["messages"]
    rows = {}
    for path in sorted((location() / "messages").glob("*.toml")):
        rows.update(_toml(path))
    return rows


@functools.cache
def _instead():
    return _json()["instead"] if _is_json() else _toml(location() / "instead.toml")


def instead(kind, path, otherwise):
    """What to use instead of a command, keyword or value (`kind`) of code_aster's that is not here.

    @param path  "DEFI_CONTACT/ZONE[1]/COEF_CONT"; of a value with "=VALUE" behind it
    """
    path = re.sub(r"\[\d+\]", "", path)
    rows = _instead()[kind]
    found = rows.get(path) or rows.get(path.rpartition("/")[2])
    if not found:
        return otherwise
    return found if found.startswith("leave it out") else f"use {found}"


def plugin_folders():
    """Plug-in folders of LACON_PLUGIN_PATH and of the installation: each entry is one, or holds some."""
    installed = pathlib.Path(os.path.realpath(sys.argv[0])).parent.parent / "lib" / "lacon" / "plugins"
    for entry in [*filter(None, os.environ.get("LACON_PLUGIN_PATH", "").split(os.pathsep)), installed]:
        folder = pathlib.Path(entry)
        if (folder / "plugin.toml").is_file():
            yield folder
        elif folder.is_dir():
            yield from sorted(path.parent for path in folder.glob("*/plugin.toml"))


@functools.cache
def modelisations():
    """Names of the modelisations that the element catalogue and the plug-ins bring."""
    if _is_json():
        rows = list(_json()["elements"])
    else:
        rows = [row for path in sorted((location() / "elements").glob("*.toml")) for row in _toml(path)["element"]]
    for folder in plugin_folders():
        rows += _plugin_rows(folder / "plugin.toml")
    return tuple(dict.fromkeys(row["modelisation"] for row in rows))


def _plugin_rows(path):
    import tomllib

    from .messages import fail

    try:
        return _toml(path).get("element", [])
    except (tomllib.TOMLDecodeError, OSError) as error:
        fail("PLUGIN_1", file=path, reason=error)


#: `into_from` of a keyword row -> the allowed values
lists = {"modelisations": modelisations}


@functools.cache
def peer_commands():
    """Names of code_aster's commands that Lacon does not have."""
    with open(_package / "peer_commands.txt", encoding="utf-8") as file:
        names = {word for line in file if not line.startswith("#") for word in line.split()}
    return frozenset(names - set(command_names()))
