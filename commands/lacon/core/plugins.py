"""Where operators and plug-ins are, and what plug-ins bring to the catalogue."""

import functools
import os
import pathlib
import shutil
import sys

from . import catalog
from .catalog import part
from .messages import fail


@functools.cache
def _beside():
    """The folder of the launcher that runs; of `import lacon` the one that belongs to the package, or that is in PATH."""
    launcher = pathlib.Path(os.path.realpath(sys.argv[0])).parent
    package = pathlib.Path(__file__).resolve().parents[1]
    in_path = shutil.which("lacon")
    others = [package.parents[3] / "bin", *([pathlib.Path(os.path.realpath(in_path)).parent] if in_path else [])]
    return next((folder for folder in (launcher, *others) if (folder / "affe_modele").exists()), launcher)


def operator_folder():
    """Where the operators' executables are: LACON_BIN, or beside the launcher."""
    said = os.environ.get("LACON_BIN")
    return pathlib.Path(said) if said else _beside()


def operator(program):
    """Its executable. @throws AsterError COMMAND_22 where LACON_BIN is not what it has to be"""
    folder = operator_folder()
    if os.environ.get("LACON_BIN") and not any((folder / name).is_file() for name in (program, "affe_modele", "lire_maillage")):
        what = part("folder_without_programs") if folder.is_dir() else part("no_folder_at_all")
        fail("COMMAND_22", folder=folder, what=what)
    return folder / program


def plugin_folders():
    """Plug-in folders in the order in which operators look for them (elements/registry.cpp): LACON_PLUGIN_PATH, then beside the operators'
    own folder; each entry is a plug-in, or holds some."""
    program = pathlib.Path(os.path.realpath(operator_folder() / "affe_modele"))  # an operator goes by where its file is, links followed
    for entry in [*filter(None, os.environ.get("LACON_PLUGIN_PATH", "").split(":")), program.parents[1] / "lib" / "lacon" / "plugins"]:
        folder = pathlib.Path(os.path.realpath(entry))
        if _is_plugin(folder):
            yield folder
        elif folder.is_dir():
            yield from sorted(filter(_is_plugin, folder.iterdir()))


def _is_plugin(folder):
    return (folder / "plugin.toml").exists() or (folder / f"lib{folder.name}.so").exists()


@functools.cache
def brought():
    """What each plugin.toml says: [(path, tables)]."""
    found = []
    for path in filter(pathlib.Path.exists, (folder / "plugin.toml" for folder in plugin_folders())):
        try:
            found.append((path, catalog.toml(path)))
        except (ValueError, OSError) as error:  # tomllib's own is a ValueError
            fail("PLUGIN_1", file=path, reason=error)
    return found


def _names(built_in, kind, key):
    """What `key` says in the rows of the catalogue and in the [[kind]] tables of the plug-ins."""
    rows = [*built_in, *(row for _, tables in brought() for row in tables.get(kind, []))]
    return tuple(dict.fromkeys(row[key] for row in rows if key in row))


def modelisations():
    return _names(catalog.elements(), "element", "modelisation")


def relations():
    return _names(catalog.behaviours("relation"), "relation", "name")


def deformations():
    return _names(catalog.behaviours("deformation"), "deformation", "name")


#: `into_from` of a keyword row -> the allowed values: names of rows of the catalogue and of the plug-ins
lists = {"modelisations": modelisations, "relations": relations, "deformations": deformations}


def materials():
    """Keywords of DEFI_MATERIAU that plug-ins bring, [material.KEYWORD]: name -> row. @throws PLUGIN_2 for one that is there already"""
    known = catalog.command("DEFI_MATERIAU")["keyword"]
    found = {}
    for path, tables in brought():
        for name, row in tables.get("material", {}).items():
            if name in known or name in found:
                fail("PLUGIN_2", file=path, row=f"material {name}", reason=catalog.part("keyword_is_taken"))
            if not isinstance(row, dict) or row.get("type") != "factor" or "help" not in row or not isinstance(row.get("keyword"), dict):
                fail("PLUGIN_2", file=path, row=f"material {name}", reason=catalog.part("lacks_the_factor"))
            for keyword, own in row["keyword"].items():
                if not isinstance(own, dict) or "type" not in own or "help" not in own:
                    fail("PLUGIN_2", file=path, row=f"material {name}/{keyword}", reason=catalog.part("lacks_type_or_help"))
            found[name] = row
    return found


#: `keyword_from` of a command -> the keywords that plug-ins add to it
_keywords = {"materials": materials}


def command(name):
    """The rows of one command, with the keywords that plug-ins bring."""
    row = catalog.command(name)
    added = _keywords[row["keyword_from"]]() if "keyword_from" in row else {}
    return {**row, "keyword": {**row["keyword"], **added}} if added else row
