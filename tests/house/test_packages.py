"""The packages of the launcher, commands/lacon: imports run downward only, in no circle, and inside a function for a reason that is said."""

import ast
import graphlib
import os
import pathlib
import unittest

LAUNCHER = pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "commands" / "lacon"
#: from the ground up; below them is the package itself, above them main.py
PACKAGES = ("core", "base", "reader", "tables", "objects", "commands", "peer", "run", "report", "tools")


def module_name(path):
    """"core.messages" of commands/lacon/core/messages.py, "core" of its __init__.py, "" of the package's own."""
    parts = path.relative_to(LAUNCHER).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def launcher():
    """module of commands/lacon -> its path"""
    return {module_name(path): path for path in sorted(LAUNCHER.rglob("*.py"))}


def imports(path):
    """(import statement, whether it is inside a function) of a module."""
    def visit(node, inside):
        for child in ast.iter_child_nodes(node):
            if isinstance(child, (ast.Import, ast.ImportFrom)):
                yield child, inside
            yield from visit(child, inside or isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)))

    return list(visit(ast.parse(path.read_text()), False))


def imported_modules(name, path, modules):
    """The launcher's modules that one of them imports, anywhere in it."""
    found = set()
    home = name.split(".") if path.name == "__init__.py" else name.split(".")[:-1]
    for node, _ in imports(path):
        if isinstance(node, ast.ImportFrom) and node.level:
            start = ".".join([*home[:len(home) - node.level + 1], *filter(None, [node.module])]).strip(".")
        elif isinstance(node, ast.ImportFrom) and node.module.partition(".")[0] == "lacon":
            start = node.module.removeprefix("lacon").lstrip(".")
        else:
            found |= {alias.name.removeprefix("lacon").lstrip(".") for alias in getattr(node, "names", ())
                      if isinstance(node, ast.Import) and alias.name.partition(".")[0] == "lacon"}
            continue
        below = {".".join(filter(None, [start, alias.name])) for alias in node.names}
        found |= (below & set(modules)) or {start}
    return found - {name}


class Packages(unittest.TestCase):
    def test_imports_run_downward_only(self):
        modules = launcher()
        floor = {package: level for level, package in enumerate(PACKAGES)}
        self.assertEqual({name.partition(".")[0] for name in modules} - set(PACKAGES), {"", "main", "__main__"})
        self.assertEqual({name for name in modules if name in PACKAGES}, set(PACKAGES))
        wrong, seen = [], 0
        for name, path in modules.items():
            own = floor.get(name.partition(".")[0], -1 if name == "" else len(PACKAGES))
            for other in imported_modules(name, path, modules) - {""}:
                seen += 1
                if floor.get(other.partition(".")[0], len(PACKAGES)) > own:
                    wrong.append(f"{name} imports {other}")
        self.assertGreater(seen, 100)
        self.assertEqual(wrong, [])

    def test_no_circle_of_imports(self):
        modules = launcher()
        graph = {name: imported_modules(name, path, modules) for name, path in modules.items()}
        try:
            graphlib.TopologicalSorter(graph).prepare()
        except graphlib.CycleError as circle:
            self.fail(" -> ".join(circle.args[1]))

    def test_an_import_inside_a_function_says_why(self):
        wrong = []
        for name, path in launcher().items():
            lines = path.read_text().splitlines()
            wrong += [f"{name}:{node.lineno}: {lines[node.lineno - 1].strip()}" for node, inside in imports(path)
                      if inside and "  # " not in lines[node.lineno - 1]]
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    unittest.main()
