"""Keywords of the catalogue: each one that is taken has a reader among the sources of its command, and a test that gives it; docs/keywords.md
lists them all.

A keyword without a reader is either the only choice there is (one value), or says in its help that it is a word without effect ("accepted; ..."
or "accepted: ..."). The reader is looked for in what the command's program includes (C++), or its module imports (Python), transitively.
"""

import ast
import functools
import re
import sys
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
import exercised  # noqa: E402
from support import ROOT  # noqa: E402

sys.path.append(str(ROOT / "tests/keyword_walk"))
import walk  # noqa: E402

from lacon.commands import implementations  # noqa: E402
from lacon.core import catalog  # noqa: E402
from lacon.tools import keyword_table  # noqa: E402

#: commands that are read elsewhere than in their own module
ELSEWHERE = {"DEBUT": "run", "POURSUITE": "run", "FIN": "run"}

#: commands whose keywords stay with the concept, and what reads them there
LATER = {"AFFE_MATERIAU": "stat_non_line"}

#: taken keywords whose readers know no names: what reads them goes by the catalogue or by rows of elements
BY_ROWS = {
    "MECA_IMPO/PHI": "unknowns of elements", "MECA_IMPO/PSI": "unknowns of elements", "DDL_IMPO/PHI": "unknowns of elements",
    "DDL_IMPO/PSI": "unknowns of elements", "FACE_IMPO/PHI": "unknowns of elements", "FACE_IMPO/PSI": "unknowns of elements",
    "MACR_ADAP_MAIL/MAILLAGE_NP1": "makes: the concept's name", "DEFI_MATERIAU/ELAS": "materials: by KEYWORD/PARAMETER",
}


#: keywords of one reader: (what of a path differs, what stands for it); a test of one of them is a test of all
ONE_READER = (
    (r"^MECA_NON_LINE/|^MECA_STATIQUE/(?=SOLVEUR|EXCIT)", "STAT_NON_LINE/"),  # one operator; one function
    (r"^(AFFE_CHAR_\w+)_F/", r"\1/"),
    (r"^AFFE_CHAR_CINE/MECA_IMPO/", "AFFE_CHAR_MECA/DDL_IMPO/"),
    (r"^.*/(NUME_ORDRE|INST|LIST_INST|PRECISION|CRITERE)$", r"instants/\1"),
    (r"^.*/FILTRE/", "FILTRE/"),
    (r"^TEST_\w+/(?:\w+/)?(LEGENDE|VALE_ABS|ORDRE_GRANDEUR|TOLE_MACHINE|VALE_(?:CALC|REFE)_[IK])$", r"checks/\1"),
    (r"^.*/(SANS_(?:GROUP_MA|GROUP_NO|NOEUD|MAILLE)|MAILLE|NOEUD|NOEUD_[12])$", r"places/\1"),
    (r"/(OBSERVATION|SUIVI_DDL)/", "/OBSERVATION/"),
)

#: taken keywords that no test gives in words, and what tests them
OTHERWISE = {
    "AFFE_CHAR_MECA/DDL_IMPO/PSI": "an unknown by its row, as PHI", "AFFE_CHAR_MECA/FACE_IMPO/PSI": "the same",
}


def one_of(path):
    """What stands for all keywords that one function reads."""
    for pattern, stands in ONE_READER:
        path = re.sub(pattern, stands, path)
    return path


def default_of(path):
    """The ways to write the default of COMMAND/FACTOR/KEYWORD."""
    command, *names = path.split("/")
    row = catalog.command(command)
    for name in names:
        row = row["keyword"][name]
    default = row.get("default")
    return [default, tuple(default), *default] if isinstance(default, list) else [default]


@functools.cache
def cpp_sources(program):
    """Text of everything that an operator's sources include, and of the sources beside these headers."""
    seen, todo = set(), list((ROOT / "operators" / program).glob("*.?pp"))
    while todo:
        path = todo.pop()
        if path in seen or not path.exists():
            continue
        seen.add(path)
        for included in re.findall(r'#include "lacon/((?:operators|structures|elements|pairing|assembly)/[^"]+)"', path.read_text(encoding="utf-8")):
            todo += [ROOT / included, (ROOT / included).with_suffix(".cpp")]
        if path.name == "order.hpp":
            todo += (ROOT / "elements").glob("*.cpp")
    return "\n".join(path.read_text(encoding="utf-8") for path in sorted(seen))


@functools.cache
def python_sources(module):
    """Text of a module of commands/lacon and of all that it imports."""
    seen, todo = set(), [ROOT / "commands" / "lacon" / module]
    while todo:
        path = todo.pop()
        if path in seen or not path.exists():
            continue
        seen.add(path)
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.level:
                folder = path.parents[node.level - 1].joinpath(*(node.module or "").split("."))
                todo += [folder.with_suffix(".py"), *(folder / f"{alias.name}.py" for alias in node.names)]
    return "\n".join(path.read_text(encoding="utf-8") for path in sorted(seen))


@functools.cache
def sources(command):
    row = catalog.command(command)
    if "operator" in row:
        program = row["operator"]
        own = cpp_sources(program if (ROOT / "operators" / program).is_dir() else program.removesuffix("_cine").removesuffix("_meca"))
        return own + (cpp_sources(LATER[command]) if command in LATER else "")
    family = ELSEWHERE.get(command)
    if family:
        return "\n".join(python_sources(f"{family}/{path.name}") for path in sorted((ROOT / "commands/lacon" / family).glob("*.py")))
    return python_sources(f"commands/{implementations.home(command)}.py")


def read_in(text, name):
    """Whether sources name a keyword, whole, in a text, or as a beginning and an ending that are put together."""
    if re.search(rf'''["'/]{name}["'/]''', text):
        return True
    return any(re.search(f'''["']{name[:k]}_?["']''', text) and re.search(f'''["']_?{name[k:].lstrip("_")}["']''', text)
               for k in range(2, len(name)) if name[k] == "_" or name[k - 1] == "_")


def of_defaults(row):
    """Names of keywords on which the default of another one depends: a row of the catalogue reads them."""
    found = {name for when in row.get("when", ()) if "default" in when for name in when.get("if", ())}
    return found.union(*(of_defaults(keyword) for keyword in row.get("keyword", {}).values()))


def material(name):
    """Parameters of materials are read by the rows of elements and laws."""
    return any(re.search(rf'["/]{name}"', path.read_text(encoding="utf-8"))
               for folder in ("elements", "catalog", "operators") for path in (ROOT / folder).rglob("*") if path.suffix in (".cpp", ".toml") and "commands" not in path.parts)


class Keywords(unittest.TestCase):
    maxDiff = None

    def test_each_keyword_that_is_taken_has_a_reader(self):
        orphans = []
        for command in catalog.command_names():
            for path, kind, _ in keyword_table.rows(command, catalog.command(command)):
                if kind != "taken" or path in BY_ROWS or f"{command}/{path}" in BY_ROWS:
                    continue
                name = path.rpartition("/")[2]
                row = catalog.command(command)
                if name in of_defaults(row) or path == row.get("reuse"):  # the launcher reads the concept that reuse= enriches
                    continue
                if not (material(name) if command == "DEFI_MATERIAU" else read_in(sources(command), name)):
                    orphans.append(f"{command}/{path}")
        self.assertEqual(orphans, [], "nobody reads these: let a source read them, or say in their help \"accepted; ...\" why they change nothing")

    def test_each_keyword_that_is_taken_is_given_by_a_test(self):
        """With another value than its default."""
        given = {}
        for path, values in exercised.given().items():
            given.setdefault(one_of(path), []).extend(values)
        idle = set()
        for command in catalog.command_names():
            for path, kind, _ in keyword_table.rows(command, catalog.command(command)):
                key = one_of(f"{command}/{path}")
                if kind == "taken" and all(value in default_of(f"{command}/{path}") for value in given.get(key, ())):
                    idle.add(key)
        self.assertEqual(sorted(idle - set(OTHERWISE)), [], "no test gives these: write one that sees what they change")
        self.assertLessEqual(set(OTHERWISE), idle, "tests give these now")

    def test_each_keyword_that_is_taken_is_seen_to_change_something(self):
        """tests/keyword_walk did commands again without it, and found another concept, print, file or refusal; studies/long_keyword_walk repeats it."""
        taken, shown = walk.taken(), [path for paths in walk.shown().values() for path in paths]
        seen = {one_of(path) for path in shown}
        unseen = sorted({one_of(path) for path in taken} - seen)
        self.assertEqual([path for path in unseen if not walk.excuse(path)], [],
                         "no study shows what these change: give them in tests/studies/walk, and call tests/keyword_walk/run and run --record")
        self.assertEqual(sorted(set(shown) - taken), [], "these are taken no more: tests/keyword_walk/run --record")
        self.assertEqual([study for study in walk.shown() if not any((ROOT / "tests" / f"{study}{end}").exists() for end in ("", ".py"))], [])
        self.assertLess(len(unseen), 40, "reasons are for few")

    def test_the_walk_finds_what_nobody_reads(self):
        """The words: of those that say that they change nothing most have indeed no reader."""
        for command, name in (("STAT_NON_LINE", "RENUM"), ("MACR_ADAP_MAIL", "QUALITE"), ("DEFI_FONCTION", "TITRE"), ("AFFE_MODELE", "VERI_JACOBIEN")):
            self.assertFalse(read_in(sources(command), name), f"{command}/{name}")
        self.assertTrue(read_in(sources("STAT_NON_LINE"), "RESI_GLOB_RELA"))
        self.assertTrue(read_in(sources("POST_RELEVE_T"), "INVARIANT"))

    def test_the_page_of_the_keywords_is_that_of_the_catalogue(self):
        page = (ROOT / "docs" / "keywords.md").read_text(encoding="utf-8")
        self.assertTrue(page == keyword_table.text(), "make it anew: lacon help --table > docs/keywords.md")


if __name__ == "__main__":
    unittest.main()
