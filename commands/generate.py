#!/usr/bin/env python3
"""What is made of the command lines and the catalogue: completion of shells, man pages, pages of commands and messages of the documentation.

usage: LACON_CATALOG=catalog.json generate.py OUTPUT

Writes OUTPUT/completion/lacon (bash) and _lacon (zsh), OUTPUT/man/man1 and man7, the same in French in OUTPUT/man/fr, OUTPUT/reference (Markdown).
"""

import importlib
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from lacon import main as launcher  # noqa: E402
from lacon import version  # noqa: E402
from lacon.core import catalog  # noqa: E402
from lacon.tools import completion, manual, templates  # noqa: E402


def command_lines():
    """tool -> the parser of its command line, "" that of a study"""
    modules = {name: importlib.import_module(f"lacon.tools.{name}") for name in launcher.tools}
    return {"": launcher.parser(), **{name: module.parser() for name, module in modules.items()}}


def main(output):
    texts = {}
    for language, pages in (("fr", "man/fr"), ("C", "man")):
        os.environ["LC_ALL"] = language
        lines = command_lines()
        texts |= {f"{pages}/man1/lacon{'-' * bool(tool)}{tool}.1": manual.tool_page(tool, parser, version) for tool, parser in lines.items()}
        texts |= {f"{pages}/man7/lacon-{name}.7": manual.command_page(name, version) for name in catalog.command_names()}
    lines.pop("help")  # which has words of its own to complete
    names = list(templates.known())
    texts |= {"completion/lacon": completion.bash(lines, names), "completion/_lacon": completion.zsh(lines, names),
              "reference/commands.md": manual.commands_markdown(), "reference/messages.md": manual.messages_markdown()}
    texts |= {f"reference/{name.lower()}.md": manual.command_markdown(name) for name in catalog.command_names()}
    for path, text in texts.items():
        target = output / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")


main(pathlib.Path(sys.argv[1]))
