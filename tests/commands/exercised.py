"""Which keywords the tests give, and with which values: read from their sources, command files and Python with command files in its texts.

A set of keywords that stand together, in a call, _F(...) or a dictionary, or a keyword's name with a value behind it, is one of each factor keyword that takes them all, of the
commands that its file names. So a helper of a test that passes keywords on is understood, and now and then a set counts for a second
command; what no test gives at all is found.
"""

import ast
import re
import textwrap

from support import ROOT

from lacon.core import catalog

_name = re.compile(r"[A-Z][A-Z0-9_]*")
_folders = ("tests", "commands/studies")


def levels(path, row):
    """(path, keywords) of a command and of each of its factor keywords."""
    yield path, set(row.get("keyword", ())) | set(row.get("formerly", ()))
    for name, keyword in row.get("keyword", {}).items():
        if keyword["type"] == "factor":
            yield from levels(f"{path}/{name}", keyword)


def _value(node):
    """A constant; Ellipsis for what is only known when it runs."""
    try:
        return ast.literal_eval(node)
    except (ValueError, TypeError):
        return ...


def _named(nodes):
    """Texts that are names, each with what stands behind it."""
    for name, value in zip(nodes, nodes[1:]):
        if isinstance(name, ast.Constant) and isinstance(name.value, str) and _name.fullmatch(name.value):
            yield {name.value: _value(value)}


def _sets(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            pairs = [(keyword.arg, keyword.value) for keyword in node.keywords]
            yield from _named(node.args)
        elif isinstance(node, ast.Dict):
            pairs = [(getattr(key, "value", None), value) for key, value in zip(node.keys, node.values)]
        elif isinstance(node, ast.Tuple):
            yield from _named(node.elts)
            continue
        else:
            continue
        given = {key: _value(value) for key, value in pairs if isinstance(key, str) and _name.fullmatch(key)}
        if given:
            yield given


def _text(node):
    """A text in a source, formatted values replaced by a name."""
    if isinstance(node, ast.JoinedStr):
        return "".join(part.value if isinstance(part, ast.Constant) else "X" for part in node.values)
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""


def _parsed(text):
    """The whole text, or every call in it that stands by itself."""
    try:
        yield ast.parse(textwrap.dedent(text))
    except (SyntaxError, ValueError):  # the latter of null bytes
        for start in re.finditer(r"\b(?:_F|[A-Z]+_[A-Z_]+)\(", text):
            depth = 0
            for end in range(start.end() - 1, len(text)):
                depth += {"(": 1, ")": -1}.get(text[end], 0)
                if depth == 0:
                    try:
                        yield ast.parse(text[start.start():end + 1])
                    except SyntaxError:
                        pass
                    break


def _trees(source):
    tree = ast.parse(source)
    yield tree
    for node in ast.walk(tree):
        if "=" in (text := _text(node)):
            yield from _parsed(text)


def given():
    """COMMAND/FACTOR/KEYWORD -> its values in the tests."""
    known = {command: list(levels(command, catalog.command(command))) for command in catalog.command_names()}
    found = {}
    for folder in _folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix not in (".py", ".comm", ".com1"):
                continue
            source = path.read_text(encoding="utf-8")
            named = [level for command, own in known.items() if re.search(rf"\b{command}\b", source) for level in own]
            for keywords in (one for tree in _trees(source) for one in _sets(tree)):
                for level, names in named:
                    if keywords.keys() <= names:
                        for name, value in keywords.items():
                            found.setdefault(f"{level}/{name}", []).append(value)
    return found
