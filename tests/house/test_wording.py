"""Messages are rows of the catalogue, in English and in French: none lacks a language, and no program puts one together from words of its own."""

import argparse
import ast
import importlib
import inspect
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest

SOURCE = pathlib.Path(os.environ["LACON_SOURCE_DIR"])
BIN = pathlib.Path(os.environ["LACON_BIN"])
ROOMS = ("structures", "elements", "pairing", "assembly", "operators")
#: statements whose words no user of a study reads (defects, names of phases and counts, command lines), or that print tables
OTHERWISE = r"static_assert|--status|logic_error|invalid_argument|runtime_error|Phase |add_to_count|CLI|add_option|add_flag|fmt::print|run_operator|run_program|\"expected\""
#: what argparse says to who writes a program, and of what no command line of ours has
OF_PROGRAMS = r"conflict|subparser|unknown parser|not defined|'required' is|must be optional|callable|can't open|cannot merge|must start with|dest=|with mode"


def rows(folder):
    """identifier or name -> row, of the files in a folder."""
    found = {}
    for path in sorted((SOURCE / "catalog/messages" / folder).glob("*.toml")):
        found.update(tomllib.loads(path.read_text(encoding="utf-8")))
    return found


def statements(path):
    """(line, text) of the statements of a C++ file, without comments."""
    text = re.sub(r"//[^\n]*", "", path.read_text(encoding="utf-8"))
    start = 0
    for match in re.finditer(r"[;{}]\s*\n", text):
        yield text.count("\n", 0, start) + 1, text[start:match.end()]
        start = match.end()


def prose(statement):
    """The words of its literals that are a text for people: three or more one behind the other."""
    literals = re.findall(r'"((?:[^"\\\n]|\\.)*)"', re.sub(r'"\s*\n\s*"', "", statement))
    return [text for text in literals if re.search(r"(?:\b[a-z]+ ){2}[a-z]+\b", text)]


def choices(statement):
    """Words of a message that are chosen between in place, but those that part() is asked for."""
    if not re.search(r"\b(?:fail|inform|message|refuse|part)\(", statement):
        return []
    return re.findall(r"""[?:]\s*"([a-z]+(?: [a-z]+)*)"(?!\s*,\s*\{)""", re.sub(r"\bpart\([^()]*\)", "", statement))


def name_of(call):
    """The function that a call of Python's is of."""
    return call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")


def literals(node):
    """The texts below a node of Python's, but those that part() is asked for."""
    if isinstance(node, ast.Call) and name_of(node) in ("part", "message"):
        return
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    for child in ast.iter_child_nodes(node):
        yield from literals(child)


def argparse_texts():
    """What argparse has translated."""
    for call in ast.walk(ast.parse(inspect.getsource(argparse))):
        if isinstance(call, ast.Call) and getattr(call.func, "id", "") in ("_", "ngettext"):
            yield from (argument.value for argument in call.args if isinstance(argument, ast.Constant))


class Wording(unittest.TestCase):
    maxDiff = None

    def test_every_message_and_every_part_is_there_in_french(self):
        english, french = rows("."), rows("fr")
        self.assertEqual(sorted(set(english) - set(french)), [], "add them to catalog/messages/fr/")
        self.assertEqual(sorted(set(french) - set(english)), [])

    def test_what_to_use_instead_is_there_in_french(self):
        english, french = (tomllib.loads((SOURCE / f"catalog/instead{kind}.toml").read_text(encoding="utf-8")) for kind in ("", ".fr"))
        texts = {text for rows_of_kind in english.values() for text in rows_of_kind.values()}
        spoken = {text for text in texts if re.search(r"\b[a-z]{2,}\b", re.sub(r"'[^']*'|`[^`]*`", "", text))}  # others are names alone
        self.assertEqual(sorted(spoken - set(french)), [], "add them to catalog/instead.fr.toml")
        self.assertEqual(sorted(set(french) - texts), [])

    def test_every_help_line_is_there_in_french(self):
        def lines(row):
            yield row["help"]
            for keyword in row.get("keyword", {}).values():
                yield from lines(keyword)

        rows_of_commands = [tomllib.loads(path.read_text(encoding="utf-8")) for path in (SOURCE / "catalog/commands").glob("*.toml")]
        english = {line for row in rows_of_commands if "help" in row for line in lines(row)}
        french = tomllib.loads((SOURCE / "catalog/help.fr.toml").read_text(encoding="utf-8"))
        self.assertEqual(sorted(english - set(french)), [], "add them to catalog/help.fr.toml")
        self.assertEqual(sorted(set(french) - english), [])
        keywords = re.compile(r"\b[A-Z][A-Z0-9_]{2,}\b|\d+(?:\.\d+)?(?:e-\d+)?")  # names and numbers are the same in both
        self.assertEqual([line for line in french if set(keywords.findall(line)) != set(keywords.findall(french[line]))], [])

    def test_every_text_of_a_command_line_is_there_in_french(self):
        """What parsers are made with, and what argparse says by itself where a user is at fault, not a program."""
        french = tomllib.loads((SOURCE / "catalog/options.fr.toml").read_text(encoding="utf-8"))
        texts = {text for text in argparse_texts() if not re.search(OF_PROGRAMS, text)}
        for path in sorted((SOURCE / "commands/lacon").rglob("*.py")):
            text = path.read_text(encoding="utf-8")
            if "ArgumentParser" in text and path.name != "command_line.py":
                self.fail(f"{path}: CommandLine (core/command_line.py) speaks the language of the user")
            for call in ast.walk(ast.parse(text)):
                if isinstance(call, ast.Call) and name_of(call) in ("CommandLine", "add", "option_words"):
                    said = [keyword.value for keyword in call.keywords if keyword.arg in ("description", "help", "epilog")]
                    said += call.args[:1] if name_of(call) == "option_words" else []
                    texts |= {node.value for node in said if isinstance(node, ast.Constant) and isinstance(node.value, str)}
        sys.path.insert(0, str(SOURCE / "commands"))
        templates = importlib.import_module("lacon.tools.templates")  # the one list of texts that lies elsewhere
        texts |= set(templates.known().values())
        self.assertEqual(sorted(texts - set(french)), [], "add them to catalog/options.fr.toml")
        self.assertEqual(sorted(set(french) - texts), [])
        filled = re.compile(r"\{\w+\}|%(?:\(\w+\))?[a-z]")
        self.assertEqual([text for text in french if sorted(filled.findall(text)) != sorted(filled.findall(french[text]))], [])

    def test_command_lines_speak_the_language_of_the_environment(self):
        def said(*arguments, language="fr_FR.UTF-8"):
            done = subprocess.run([BIN / "lacon", *arguments], capture_output=True, text=True, check=False, env={**os.environ, "LC_ALL": language, "COLUMNS": "200"})
            return done.stdout + done.stderr

        for tool in ((), ("help",), ("inspect",), ("convert",), ("check",), ("new",), ("plot",), ("report",), ("watch",)):
            french, english = said(*tool, "--help"), said(*tool, "--help", language="C")
            self.assertIn("utilisation : lacon", french)
            self.assertIn("afficher cette aide et finir", french)
            self.assertIn("usage: lacon", english)
            shared = {line.strip() for line in french.splitlines() if len(line.split()) > 4} & {line.strip() for line in english.splitlines()}
            self.assertEqual({line for line in shared if re.search(r"\b[a-z]+ [a-z]+ [a-z]+\b", line)}, set())
        self.assertIn("lacon : erreur : --threads : donner un nombre d'au moins 1", said("study.comm", "--threads", "0"))
        self.assertIn("lacon plot : erreur : il manque les arguments : BASE", said("plot"))
        self.assertIn("lacon plot: error: the following arguments are required: BASE", said("plot", language="C"))

    def test_no_tool_prints_english_words(self):
        """Three words in a row in what print() or wrong() gets, but those that part() is asked for."""
        found = []
        for path in sorted((SOURCE / "commands/lacon").rglob("*.py")):
            for call in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(call, ast.Call) and name_of(call) in ("print", "error"):
                    found += [f"{path.relative_to(SOURCE)}:{call.lineno}: {text}" for argument in call.args for text in literals(argument)
                              if re.search(r"(?:\b[a-z]+ ){2}[a-z]+\b", text)]
        self.assertEqual([line for line in found if "most recent call last" not in line], [], "make them rows of catalog/messages/parts.toml and fr/parts.toml")

    def test_help_speaks_the_language_of_the_environment(self):
        def shown(*names, language="fr_FR.UTF-8"):
            return subprocess.run([BIN / "lacon", "help", *names], capture_output=True, text=True, check=False, env={**os.environ, "LC_ALL": language}).stdout

        self.assertIn("DEFI_CONTACT      Contact par moyennes locales (LAC) : zones de peaux esclaves et maîtres", shown())
        self.assertIn("peau esclave : un groupe donné à DECOUPE_LAC", shown("DEFI_CONTACT"))
        self.assertIn("slave skin: a group given to DECOUPE_LAC", shown("DEFI_CONTACT", language="C"))

    def test_parts_that_are_asked_for_exist_and_each_is_asked_for(self):
        names = set(tomllib.loads((SOURCE / "catalog/messages/parts.toml").read_text(encoding="utf-8")))
        text = "".join(path.read_text(encoding="utf-8") for room in (*ROOMS, "commands/lacon", "catalog") for path in (SOURCE / room).rglob("*")
                       if path.suffix in (".cpp", ".hpp", ".py"))
        self.assertEqual(set(re.findall(r"""\bpart\(\s*["'](\w+)["']""", text)) - names, set())
        quoted = set(re.findall(r"""["']([\w ]+)["']""", text))
        self.assertEqual({name for name in names if name not in quoted and name.replace("_", " ") not in quoted}, set())

    def test_no_cpp_composes_english_text(self):
        found = [f"{path.relative_to(SOURCE)}:{line}: {text}" for room in ROOMS for path in sorted((SOURCE / room).rglob("*.[ch]pp"))
                 if path.name not in ("main.cpp", "tool.cpp")
                 for line, statement in statements(path) if not re.search(OTHERWISE, statement) for text in prose(statement)]
        found += [f"{path.relative_to(SOURCE)}:{line}: {text}" for room in ROOMS for path in sorted((SOURCE / room).rglob("*.[ch]pp"))
                  for line, statement in statements(path) for text in choices(statement)]
        self.assertEqual(found, [], "make them rows of catalog/messages/parts.toml and fr/parts.toml, and take them with part()")

    def test_no_python_fills_messages_with_english_text(self):
        """Words in the arguments of fail(), message() and the like: two or more in a row, but those that part() is asked for."""
        found = []
        for path in sorted((SOURCE / "commands/lacon").rglob("*.py")):
            for call in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(call, ast.Call) and name_of(call) in ("fail", "inform", "message", "problem", "part"):
                    found += [f"{path.relative_to(SOURCE)}:{call.lineno}: {text}" for keyword in call.keywords for text in literals(keyword.value)
                              if re.search(r"\b[a-z]{2,} [a-z]{2,}", text) or text == "none"]
        self.assertEqual(found, [], "make them rows of catalog/messages/parts.toml and fr/parts.toml, and take them with part()")

    def test_launcher_and_operators_speak_the_language_of_the_environment(self):
        def said(*command, **language):
            plain = {name: value for name, value in os.environ.items() if name not in ("LC_ALL", "LC_MESSAGES", "LANG")}
            return subprocess.run([*map(str, command)], capture_output=True, text=True, check=False, env={**plain, **language}).stderr

        folder = tempfile.TemporaryDirectory(prefix="lacon_wording_")
        self.addCleanup(folder.cleanup)
        damaged = pathlib.Path(folder.name) / "damaged.mail"
        damaged.write_text("COOR_2D\n A 0. 0.\n B 1. x\nFINSF\nFIN\n", encoding="utf-8")
        convert = [BIN / "lacon", "convert", damaged, damaged.with_suffix(".med")]
        order = damaged.with_suffix(".json")
        order.write_text("no order", encoding="utf-8")
        launcher = [BIN / "lacon", "new", "--template", "nothing"]
        for command, french, english in ((launcher, "il n'y a pas de modèle d'étude", "there is no template"),
                                         ([BIN / "affe_modele", order], "ne peut pas être lu : ce n'est pas du JSON", "cannot be read: it is not JSON"),
                                         (convert, "il y a 'x' là où devrait être une coordonnée du nœud 'B'",
                                          "there is 'x' where a coordinate of the node 'B' should be")):
            self.assertIn(french, said(*command, LANG="fr_FR.UTF-8"))
            self.assertIn(french, said(*command, LANG="en_GB.UTF-8", LC_ALL="fr_BE"))
            self.assertIn(english, said(*command))
            self.assertIn(english, said(*command, LANG="fr_FR.UTF-8", LC_ALL="C"))


if __name__ == "__main__":
    unittest.main()
