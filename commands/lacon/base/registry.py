"""The registry of a base, base.json: its layout, and its seal. docs/structures.md section 1.

A byte that changes in it would give a variable another concept without a word: nothing is taken from one whose seal does not fit.
"""

import hashlib
import json
import operator
import re

from ..core.catalog import part
from ..core.files import write_whole

name = "base.json"
newest = 2  #: format that is written; format 1 had no seal

_id = re.compile(r"[a-z_]+_\d+").fullmatch
_texts = {}  #: id -> versions, and their text


class Unreadable(Exception):
    """Why a registry is not read. `origin`: "ours", one of Lacon's whose content is not what was written; "blank", no more than the first letters of one; "unknown",
    no JSON, so that it does not say whose it is; "other"."""

    def __init__(self, reason, origin="other"):
        super().__init__(reason)
        self.origin = origin


def empty():
    return {"format": newest, "next": 1, "labels": {}, "namespace": {}}


def sealed(content):
    """The text of a registry, with its seal."""
    text = "{" + ", ".join(f'"{key}": {_text_of_made(value) if key == "made" else json.dumps(value)}' for key, value in content.items()) + "}"
    return f'{text[:-1]}, "seal": "{_seal(text)}"}}'


def _text_of_made(made):
    """As json.dumps(made). Of thousands of concepts one or two change between two commands; what was entered for a version never does."""
    if len(_texts) > 2 * len(made) + 100:
        _texts.clear()
    for identifier, versions in made.items():
        known = _texts.get(identifier)
        if known is None or len(known[0]) != len(versions) or any(map(operator.is_not, known[0], versions)):
            _texts[identifier] = tuple(versions), f'"{identifier}": {json.dumps(versions)}'
    return "{" + ", ".join([_texts[identifier][1] for identifier in made]) + "}"


def _seal(text):
    return hashlib.blake2b(text.encode(), digest_size=20).hexdigest()


def write(folder, content):
    """Replace the registry of a base. @throws OSError"""
    write_whole(folder / name, sealed(content))


def read(folder):
    """The registry of a base, as this version writes it. @throws Unreadable"""
    try:
        text = (folder / name).read_bytes()
    except OSError as error:
        raise Unreadable(error.strerror) from None
    try:
        content = json.loads(text.decode())
    except (ValueError, RecursionError):
        raise Unreadable(part("registry_no_json"), _origin(text)) from None
    if not isinstance(content, dict):
        raise Unreadable(part("registry_of_another"))
    seal, written = content.pop("seal", None), content.get("format")
    if seal != _seal(json.dumps(content)) if seal is not None else written == newest:
        raise Unreadable(part("registry_changed"), "ours" if seal is not None and {"format", "next", "labels"} <= set(content) else "other")
    if not _is_count(written) or "labels" not in content:
        raise Unreadable(part("registry_of_another"))
    if written > newest:
        raise Unreadable(part("registry_format", format=written, known=newest))
    content.setdefault("namespace", {})
    content["format"] = newest
    wrong = next((key for key in {**_layout, **content} if not _fits(content, key)), None)
    if wrong is not None:
        raise Unreadable(part("registry_wrong", key=wrong))
    return content


def _origin(broken):
    """Whose a registry is that is no JSON: one of ours that was cut off begins as all of them do. A disk may leave zeros in its place."""
    if re.match(rb'\{"format": \d+, "next": \d+, "labels": \{', broken):
        return "ours"
    return "blank" if b'{"format": '.startswith(broken.strip(b"\0 \t\r\n")) else "unknown"


# ------------------------------------------------------------------------------------------- layout


def _is_count(value):
    return type(value) is int and value > 0


def _is_text(value):
    return isinstance(value, str)


def _all(check):
    return lambda value: isinstance(value, list) and all(map(check, value))


def _by_id(check):
    return lambda value: isinstance(value, dict) and all(_id(key) and check(item) for key, item in value.items())


def _entries(maybe=(), **checks):
    """A dictionary of these entries; those of `maybe` need not be there."""
    return lambda value: (isinstance(value, dict) and set(checks) - set(maybe) <= set(value) <= set(checks)
                          and all(checks[key](item) for key, item in value.items()))


def _is_running(value):
    return value is False or _entries(process=_is_count, since=_is_text)(value)


#: entry -> what it has to be
_layout = {
    "format": _is_count,
    "next": _is_count,
    "labels": lambda value: isinstance(value, dict) and all(_is_text(item) and _id(item) for item in value.values()),
    "namespace": _entries(("values", "lost"), values=lambda value: isinstance(value, dict),
                          lost=lambda value: isinstance(value, dict) and all(map(_is_text, value.values()))),
    "running": _is_running,
    "sources": _all(_is_text),
    "made": _by_id(_all(_entries(("fields",), key=_is_text, stat=_all(lambda item: type(item) is int), alarms=_all(_all(_is_text)),
                                 references=_all(_is_text), fields=lambda value: isinstance(value, dict)))),
    "unfinished": _by_id(_entries(("at",), label=_is_text, where=_is_text, key=lambda value: value is None or _is_text(value),
                                  at=lambda value: value is None or type(value) is int)),
    "begun": _entries(files=_all(_is_text), at=_by_id(lambda value: type(value) is int)),
    "unused_contacts": _by_id(_entries(label=_is_text, where=_is_text, model=_is_text, solved=_is_text)),
}
_always = ("format", "next", "labels", "namespace")


def _fits(content, key):
    return key in _layout and _layout[key](content[key]) if key in content else key not in _always
