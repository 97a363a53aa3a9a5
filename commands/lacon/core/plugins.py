"""Where operators and plug-ins are, and what plug-ins bring to the catalogue."""

import functools
import os
import pathlib
import sys

from . import catalog
from .messages import fail


def operator_folder():
    """Where the operators' executables are: LACON_BIN, or beside the launcher."""
    said = os.environ.get("LACON_BIN")
    return pathlib.Path(said) if said else pathlib.Path(os.path.realpath(sys.argv[0])).parent


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
    rows = catalog.elements()
    for folder in plugin_folders():
        rows += _rows(folder / "plugin.toml")
    return tuple(dict.fromkeys(row["modelisation"] for row in rows))


def _rows(path):
    try:
        return catalog.toml(path).get("element", [])
    except (ValueError, OSError) as error:  # tomllib's own is a ValueError
        fail("PLUGIN_1", file=path, reason=error)


#: `into_from` of a keyword row -> the allowed values
lists = {"modelisations": modelisations}
