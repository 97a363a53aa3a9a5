"""`lacon help --table`: docs/keywords.md, every command with its keywords beside code_aster's, made from the catalogue."""

from ..core import catalog

#: what the help of a keyword begins with that is read and changes nothing
word = "accepted"

_head = """# Keywords of the commands, beside code_aster's

Made by `lacon help --table > docs/keywords.md` from `catalog/commands/*.toml` and `catalog/instead.toml`. `lacon help COMMAND` says more: types,
defaults, bounds, rules.

* *taken*: it does what code_aster's documentation says, and `tests/commands/test_keywords.py` finds who reads it, and a test that gives it;
  `tests/keyword_walk` does commands of studies again without it: for each keyword that is taken, `shown.json` there names the study in which
  the concept, what is printed or written, or the refusal is another one then, or a reason why none can be (`EXCUSED` in `walk.py`);
* *only choice*: taken with the one value that there is; any other value is refused;
* *word*: accepted for what it says, with no effect here, and why;
* *refused*: code_aster has it and Lacon has not; what to use instead, where there is something.
"""


def text():
    """The whole file."""
    parts = [_head]
    for name in catalog.command_names():
        row = catalog.command(name)
        parts.append(f"\n## {name}\n\n{row['help']}.\n\n| keyword | | |\n|---|---|---|\n")
        parts.extend(f"| `{path}` | {kind} | {_cell(what)} |\n" for path, kind, what in rows(name, row))
    parts.append("\n## Commands of code_aster that are not here\n\n| command | use |\n|---|---|\n")
    parts.extend(f"| `{name}` | {_cell(catalog.instead('command', name, '').removeprefix('use '))} |\n" for name in sorted(catalog.peer_commands()))
    return "".join(parts)


def rows(name, row):
    """(path of a keyword in its command, "taken", "only choice", "word" or "refused", what it is or what to use) of every keyword."""
    yield from _rows(name, "", row)


def kind_of(keyword):
    """ "word" where it changes nothing, "only choice" where it has one value, else "taken"."""
    if keyword["help"].startswith(word):
        return "word"
    return "only choice" if len(keyword.get("into", "  ")) == 1 and keyword["type"] != "factor" else "taken"


def _rows(command, path, row):
    for name, keyword in row.get("keyword", {}).items():
        here = path + name
        yield here, kind_of(keyword), "; ".join([keyword["help"], *_values(f"{command}/{here}", keyword)])
        yield from _rows(command, f"{here}/", keyword)
    for name in sorted(row.get("elsewhere", ()) if row.get("type", "factor") == "factor" else ()):
        yield path + name, "refused", catalog.instead("keyword", f"{command}/{path}{name}", "")


def _values(path, keyword):
    """What its values are, and those that are refused."""
    if "into" in keyword:
        yield ", ".join(f"`{value}`" for value in keyword["into"])
    if keyword["type"] == "factor":
        return
    for value in keyword.get("elsewhere", ()):
        instead = catalog.instead("value", f"{path}={value}", "")
        yield f"`{value}` refused" + (f": {instead}" if instead else "")


def _cell(text):
    return text.replace("|", "\\|").replace("\n", " ")
