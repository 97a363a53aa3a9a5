"""The texts of the command files that a result was computed by, in its folder: for who looks at it later, or while it is computed."""

import contextlib
import json

from ..core.files import write_whole

_name = "commands.json"
_most = 20  #: of a result that several runs went on with


def keep(base, identifier, files):
    """@param files [(name, text)], behind those that are there"""
    told = [{"name": name, "text": text} for name, text in files]
    told = [one for one in known(base, identifier) if one not in told] + told
    with contextlib.suppress(OSError):  # no result hangs on it
        (base.folder / identifier).mkdir(exist_ok=True)
        write_whole(base.folder / identifier / _name, json.dumps(told[-_most:], ensure_ascii=False))


def known(base, identifier):
    """[{"name", "text"}] of the command files of a result."""
    try:
        return [{"name": str(one["name"]), "text": str(one["text"])}
                for one in json.loads((base.folder / identifier / _name).read_text(encoding="utf-8"))]
    except (OSError, ValueError, KeyError, TypeError):
        return []
