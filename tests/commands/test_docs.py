"""The documentation holds together: links lead somewhere, what it says of command lines is there."""

import importlib
import re
import shlex
import unittest

import support
from lacon import main as launcher
from lacon.core import catalog
from lacon.tools.completion import options_of

DOCS = support.ROOT / "docs"
#: pages of the repository, and those that only the site has
PAGES = sorted([support.ROOT / "README.md", *DOCS.glob("*.md")])


def prose(path):
    """A page without its blocks of code."""
    return re.sub(r"^```.*?^```$", "", path.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)


def anchors(path):
    """What headings can be linked as, by GitHub's rule, which MyST follows."""
    headings = re.findall(r"^#+ +(.*)$", prose(path), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def command_lines(path):
    """[(line of the page, words)] of every `lacon ...` in a block or between backticks."""
    found = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        texts = re.findall(r"`([^`]+)`", line) if "`" in line else [line.strip()]
        for text in texts:
            match = re.match(r"(?:build/release/bin/)?lacon ((?:[a-z-]\S*|\S+\.(?:comm|export)).*)", text)
            if match and (line.startswith("    ") or "`" in line or "```" not in line):
                command = re.split(r" {3,}| && | \| |; ", match[1])[0]
                found.append((number, shlex.split(command.replace("'", ""))))
    return found


class Docs(unittest.TestCase):
    def test_every_link_leads_to_a_page_and_a_heading_of_it(self):
        wrong, seen = [], 0
        for page in PAGES:
            for link in re.findall(r"\]\(([^)\s]+)\)", prose(page)):
                if link.startswith(("http://", "https://")):
                    continue
                seen += 1
                name, _, anchor = link.partition("#")
                target = page.parent / name if name else page
                if not target.exists() or (anchor and anchor not in anchors(target)):
                    wrong.append(f"{page.name}: {link}")
        self.assertGreater(seen, 40)
        self.assertEqual(wrong, [])

    def test_the_site_holds_every_page(self):
        index = (DOCS / "site/index.md").read_text(encoding="utf-8")
        trees = re.findall(r"^```\{toctree\}(.*?)^```$", index, re.MULTILINE | re.DOTALL)
        listed = {word for tree in trees for word in tree.split() if not word.startswith(":")}
        self.assertEqual({path.stem for path in DOCS.glob("*.md")} - listed, set())

    def test_tools_and_options_of_shell_examples_exist(self):
        modules = {name: importlib.import_module(f"lacon.tools.{name}") for name in launcher.tools if name != "help"}
        known = {name: {option for names, *_ in options_of(module.parser()) for option in names} for name, module in modules.items()}
        known[""] = {option for names, *_ in options_of(launcher.parser()) for option in names}
        wrong, seen = [], 0
        for page in PAGES:
            if page.name == "clean-machine.md":  # what was printed, no examples
                continue
            for number, words in command_lines(page):
                tool = words[0] if words[0] in launcher.tools else ""
                if not tool and not re.search(r"\.(comm|export)$|^--|^FILE|^NAME|^study", words[0]):
                    wrong.append(f"{page.name}:{number}: lacon {words[0]}")
                    continue
                seen += 1
                if tool == "help":
                    wrong += [f"{page.name}:{number}: {name}" for name in words[1:2] if name.isupper() and name != "COMMAND" and name not in catalog.command_names()]
                    continue
                options = {word.partition("=")[0] for word in words if word.startswith("--")}
                wrong += [f"{page.name}:{number}: lacon {tool} {option}" for option in options - known[tool]]
        self.assertGreater(seen, 30)
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    support.main()
