"""`import lacon`: the examples of its page, and its types."""

import ast
import doctest
import importlib
import inspect
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

from study_test import SOURCE, StudyTest

sys.path.insert(0, str(SOURCE / "commands"))

import lacon  # noqa: E402

try:
    import matplotlib  # noqa: F401
    import meshio  # noqa: F401
    drawn = True
except ImportError:
    drawn = False

STUB = SOURCE / "commands/lacon/__init__.pyi"


class Examples(StudyTest):
    @unittest.skipUnless(drawn, "no matplotlib or no meshio")
    def test_the_examples_of_the_page_do_what_it_says(self):
        self.run_tool("new", "--template", "press_fit")
        before = os.getcwd()
        os.chdir(self.folder / "press_fit")
        self.addCleanup(os.chdir, before)
        found = doctest.testfile(str(SOURCE / "docs/python.md"), module_relative=False, optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
        self.assertGreater(found.attempted, 30)
        self.assertEqual(found.failed, 0)

    def test_a_run_that_fails_is_an_exception_with_what_was_said(self):
        (self.folder / "bad.comm").write_text("DEBUT()\nM = LIRE_MAILLAGE(UNITES=20)\n", encoding="utf-8")
        with self.assertRaises(lacon.RunFailed) as failure:
            lacon.run_study(self.folder / "bad.comm")
        self.assertEqual(failure.exception.run.status, 2)
        self.assertIn("<KEYWORD_1>", str(failure.exception))
        self.assertEqual(lacon.run_study(self.folder / "bad.comm", check=False).status, 2)


class Types(unittest.TestCase):
    """The stub says what there is, no more and no less."""

    def setUp(self):
        self.tree = ast.parse(STUB.read_text(encoding="utf-8"))

    def test_it_declares_every_name_that_is_offered(self):
        declared = {node.name for node in self.tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(lacon.__all__) - declared, {"version"})
        self.assertEqual(declared - set(lacon.__all__), {"Attempt", "Journal"}, "what others return")

    def test_arguments_are_those_of_the_code(self):
        others = {name: getattr(importlib.import_module("lacon.base.journal"), name) for name in ("Attempt", "Journal")}
        for node in self.tree.body:
            if not isinstance(node, (ast.ClassDef, ast.FunctionDef)):
                continue
            found = others.get(node.name) or getattr(lacon, node.name)
            for function in [node] if isinstance(node, ast.FunctionDef) else [n for n in node.body if isinstance(n, ast.FunctionDef)]:
                real = found if function is node else inspect.getattr_static(found, function.name)
                if isinstance(real, (property,)) or not callable(real):
                    continue
                names = [a.arg for a in (*function.args.args, *function.args.kwonlyargs)]
                own = [p.name for p in inspect.signature(real).parameters.values() if p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)]
                if function.args.vararg is None or function is node:
                    self.assertEqual(names, own, f"{node.name}.{function.name}")

    @unittest.skipUnless(shutil.which("mypy"), "no mypy")
    def test_a_type_checker_reads_it(self):
        done = subprocess.run(["mypy", "--ignore-missing-imports", "--no-error-summary", "--cache-dir", os.devnull, str(STUB)], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.stdout, "")


class Homes(StudyTest):
    def test_the_package_finds_operators_and_catalogue_through_the_launcher_in_path(self):
        """As of the sources, without any variable but PYTHONPATH and PATH."""
        launcher = pathlib.Path(os.environ["LACON_BIN"])
        environment = {k: v for k, v in os.environ.items() if not k.startswith("LACON_")}
        environment |= {"PYTHONPATH": str(SOURCE / "commands"), "PATH": f"{launcher}:{os.environ['PATH']}"}
        said = subprocess.run([sys.executable, "-B", "-c", "from lacon.core import catalog, plugins; print(plugins.operator_folder(), catalog.location())"],
                              capture_output=True, text=True, env=environment, cwd=self.folder, check=True).stdout.split()
        self.assertEqual(said, [str(launcher), str(launcher.parent / "generated/catalog.json")])


if __name__ == "__main__":
    unittest.main()
