"""The rules of the house hold: floors, short mains, a page in every room, no path of a machine."""

import graphlib
import os
import pathlib
import re
import subprocess
import unittest

SOURCE = pathlib.Path(os.environ["LACON_SOURCE_DIR"])
FLOORS = {"catalog": 0, "structures": 1, "elements": 2, "pairing": 3, "assembly": 3, "operators": 4}
TOP = (*FLOORS, "commands", "tests", "docs", "cmake")
#: the folders that operators share, from the ground up
SHARED = ["program", "meshing", "fields", "contact", "evolution"]
#: the folders within two of them, likewise; "": the files beside them
WITHIN = {"contact": ["variation", ""], "evolution": ["problem", "newton", "", "observers"]}
#: lines of a C++ file of a room: what is longer is two things
LONGEST = 500


def sources():
    """Every C++ file below the rooms, with its room."""
    for room in FLOORS:
        for path in sorted((SOURCE / room).rglob("*")):
            if path.suffix in (".cpp", ".hpp", ".h"):
                yield room, path


class House(unittest.TestCase):
    def test_a_file_includes_only_from_its_own_room_or_lower_floors(self):
        wrong = []
        seen = 0
        for room, path in sources():
            for included in re.findall(r'#include [<"]lacon/(\w+)/', path.read_text()):
                seen += 1
                if included != room and FLOORS[included] >= FLOORS[room]:
                    wrong.append(f"{path.relative_to(SOURCE)} includes {included}")
        self.assertGreater(seen, 100)
        self.assertEqual(wrong, [])

    def test_headers_form_no_circle(self):
        included = {f"{path.relative_to(SOURCE)}": re.findall(r'#include "lacon/([^"]+)"', path.read_text())
                    for _, path in sources() if path.suffix != ".cpp"}
        graphlib.TopologicalSorter(included).prepare()  # raises CycleError, which names the files

    def test_operators_include_shared_folders_and_these_lower_ones(self):
        """No operator includes another; a shared folder includes only those below it, so that there is no circle."""
        wrong = []
        for path in sorted((SOURCE / "operators").rglob("*.[ch]pp")):
            own = path.relative_to(SOURCE / "operators").parts[0]
            lower = SHARED[: SHARED.index(own)] if own in SHARED else SHARED
            for included in re.findall(r'#include "lacon/operators/(\w+)/', path.read_text()):
                if included != own and included not in lower:
                    wrong.append(f"{path.relative_to(SOURCE)} includes {included}")
        self.assertEqual(wrong, [])

    def test_folders_within_a_shared_one_include_lower_ones(self):
        wrong = []
        seen = set()
        for shared, order in WITHIN.items():
            room = SOURCE / "operators" / shared
            for path in sorted(room.rglob("*.[ch]pp")):
                own = str(path.parent.relative_to(room)).strip(".")
                for included in re.findall(rf'#include "lacon/operators/{shared}/(?:(\w+)/)?\w+\.hpp"', path.read_text()):
                    seen.add((own, included))
                    if order.index(included) > order.index(own):
                        wrong.append(f"{path.relative_to(SOURCE)} includes of {included or shared}")
        self.assertIn(("newton", "problem"), seen)
        self.assertEqual(wrong, [])

    def test_a_folder_without_main_is_a_shared_one(self):
        folders = {path.name for path in (SOURCE / "operators").iterdir() if path.is_dir() and not (path / "main.cpp").exists()}
        self.assertEqual(folders - set(SHARED), set())

    def test_only_solving_operators_link_mumps(self):
        programs = [path for path in sorted(pathlib.Path(os.environ["LACON_BIN"]).iterdir()) if path.read_bytes()[:4] == b"\x7fELF"]
        self.assertGreater(len(programs), 5)
        linked = []
        for program in programs:
            needed = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
            if "mumps" in needed and not program.name.startswith("lacon_"):  # their processes: lacon_mumps, and lacon_petsc with another MUMPS
                linked.append(program.name)
        self.assertEqual(linked, ["meca_statique", "stat_non_line"])

    def test_mains_are_short(self):
        for main in (SOURCE / "operators").glob("*/main.cpp"):
            self.assertLess(len(main.read_text().splitlines()), 60, main)

    def test_no_file_of_a_room_is_long(self):
        long = [f"{path.relative_to(SOURCE)}: {n} lines" for _, path in sources() if (n := len(path.read_text().splitlines())) > LONGEST]
        self.assertEqual(long, [])

    def test_every_room_has_a_page(self):
        rooms = [*FLOORS, "commands", "tests", *(f"operators/{name}" for name in SHARED),
                 *(f"operators/{shared}/{name}" for shared, order in WITHIN.items() for name in order)]
        missing = [room for room in rooms if (SOURCE / room).is_dir() and not (SOURCE / room / "README.md").exists()]
        self.assertEqual(missing, [])

    def test_every_header_and_module_is_on_the_page_of_its_room(self):
        """Headers by the nearest page above them, modules of the launcher by that of commands; folders of one operator need none."""
        wrong = []
        for path in self.tracked():
            name = path.relative_to(SOURCE)
            is_header = name.parts[0] in FLOORS and path.suffix in (".hpp", ".h")
            if not is_header and not (name.parts[:2] == ("commands", "lacon") and path.suffix == ".py" and path.name != "__init__.py"):
                continue
            if name.parts[0] == "operators" and name.parts[1] not in SHARED:
                continue
            page = next(folder / "README.md" for folder in path.parents if (folder / "README.md").exists())
            if f"`{path.name}`" not in page.read_text():
                wrong.append(str(name))
        self.assertEqual(wrong, [])

    def test_files_that_are_named_exist(self):
        """In pages and comments: by their path from the top folder, in pages also by links and names alone."""
        tracked = self.tracked()
        names = {path.name for path in tracked}
        generated = pathlib.Path(os.environ["LACON_BINARY_DIR"]) / "generated/lacon"
        wrong = set()
        for path in tracked:
            text = path.read_text(errors="replace")
            told = re.findall(rf"(?<![\w./])((?:{'|'.join(TOP)})/[\w./-]*\.(?:cpp|hpp|h|py|toml|md|comm))\b", text)
            missing = [name for name in told if not (SOURCE / name).exists() and not (generated / name).exists()]
            if path.suffix == ".md":
                missing += [link for link in re.findall(r"\]\(([^)#:]+)[)#]", text) if not (path.parent / link).exists()]
                missing += [name for name in re.findall(r"`([\w-]+\.(?:cpp|hpp|h|py))`", text) if name not in names]
            wrong |= {f"{path.relative_to(SOURCE)}: {name}" for name in missing}
        self.assertEqual(sorted(wrong), [])

    def test_nothing_names_a_machine(self):
        wrong = []
        for path in self.tracked():
            if path != pathlib.Path(__file__):
                wrong += [f"{path.relative_to(SOURCE)}: {found}"
                          for found in re.findall(r"/(?:work|root|home)/\w+|/tmp/brief", path.read_text(errors="replace"))]
        self.assertEqual(wrong, [])

    def tracked(self):
        """The files of the project that are text."""
        listed = subprocess.run(["git", "ls-files"], cwd=SOURCE, capture_output=True, text=True, check=False)
        if listed.returncode:
            self.skipTest("not a git checkout")
        paths = [SOURCE / name for name in listed.stdout.splitlines()]
        return [path for path in paths if path.is_file() and path.suffix not in (".png", ".med", ".mmed")]


if __name__ == "__main__":
    unittest.main()
