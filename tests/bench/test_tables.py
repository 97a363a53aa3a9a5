"""What turns measurements into docs/performance.md, and the deck of CalculiX; nothing is timed."""

import json
import pathlib
import sys
import tempfile
import types
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/bench"), str(ROOT / "commands/studies")]

import calculix  # noqa: E402
import end_to_end  # noqa: E402
import tables  # noqa: E402

YARDSTICKS = {"factorisation_seconds": 7.0, "dgemm_gflops": 50.0, "copy_gbytes": 20.0}


def study(name, equations, threads=1):
    """A row whose wall time is 1e-6 N^1.5, factorisation 1e-9 N^2, memory (MB) 1e-3 N."""
    factorisation = 1e-9 * equations**2
    return {"name": name, "threads": threads, "equations": equations, "wall": 1e-6 * equations**1.5, "memory": 1e-3 * equations, "yardsticks": YARDSTICKS,
            "phases": {"launcher": 0.1, "factorisation": factorisation}, "io": {"bytes": 4e9, "seconds": 2.0}, "force": 0.5, "pressures": [0.0, 2.5],
            "counts": {"solutions": 7, "factorisations": 1, "Gflop of factorisations": 25 * factorisation, "columns of the inverse": 3, "iterations of GMRES": 9}}


def measured(*studies):
    machine = {**YARDSTICKS, "processor": "one", "cores": 2, "memory_gbytes": 25.0, "factorisation_gflops": 30.0}
    return {"machine": machine, "studies": list(studies), "calculix": [], "parts": [], "texts": {}}


def cells_of(text, line):
    return [cell.strip() for cell in text.splitlines()[line].split("|")[1:-1]]


class Tables(unittest.TestCase):
    def test_numbers(self):
        self.assertEqual([tables.number(v) for v in (310965, 42.23, 0.6612, 0.0)], ["310 965", "42.2", "0.661", "0"])

    def test_growth_of_a_power_law(self):
        made = tables.growth_section(measured(*(study(f"H{k}", n) for k, n in enumerate((10000, 50000, 150000, 300000), 1))))
        limit = 25.0 * 1000 / 1e-3  # MB over MB an equation
        self.assertEqual(cells_of(made, 2), ["H2 to H4", "1.50", "2.00", "1.00", "25.0 million", tables.number(1e-6 * limit**1.5 / 60, 2)])

    def test_multiples_and_rates_are_against_the_yardsticks_of_the_row(self):
        made = measured(study("H2", 53445), study("H2", 53445, threads=2))
        row = cells_of(tables.studies_section(made), 2)
        self.assertEqual(row[:4], ["H2", "53 445", "12.4", "12.4"])
        self.assertEqual(float(row[4]), round(12.355 / 7, 2))
        self.assertEqual(row[6], f"**{13.2 / 7.4 / (12.3556 / 7):.1f}**")
        profile = tables.profile_section(made)
        self.assertIn("| factorisation, GF/s (of dgemm) | 25.0 (50 %) |", profile)
        self.assertIn("| files, GB/s (of a copy of memory) | 2.00 (10.0 %) |", profile)

    def test_a_peer_that_does_not_end(self):
        made = measured(study("H2c", 53445))
        made["calculix"] = [{"name": "H2c", "seconds": 123.556, "memory": 500.0, "failure": "out of time"}]
        self.assertIn("more than 10.0", tables.calculix_section(made))

    def test_new_figures_take_the_place_of_old_ones(self):
        old, new = measured(study("H1", 10), study("H2c", 20)), measured(study("H2c", 30), study("H2", 40), study("H1", 50, threads=2))
        found = [(row["name"], row["threads"], row["equations"]) for row in tables.merged(old, new)["studies"]]
        self.assertEqual(found, [("H1", 1, 10), ("H1", 2, 50), ("H2", 1, 40), ("H2c", 1, 30)])

    def test_the_json_is_what_was_measured(self):
        made = measured(study("H1", 10), study("H2", 20))
        made["texts"] = {"start-up": "two\nlines"}
        self.assertEqual(json.loads(tables.as_json(made)), made)

    def test_sections_fit_the_page(self):
        """Every section has its markers in docs/performance.md."""
        made = measured(*(study(f"H{k}{c}", n) for c in ("", "c") for k, n in enumerate((10000, 50000), 1)))
        made["calculix"] = [{"name": "H1", "seconds": 10.0, "memory": 500.0, "failure": "exit status 1"}]
        made["texts"] = {"start-up": "0.1 s", "cutting": "0.5 s"}
        made["parts"] = [{"name": "clip/3", "program": "pairing", "items/s": 2e6, "GF/s": 25.0, "of_dgemm": 0.5},
                         {"name": "stiffness 3D/HEXA8 ELAS/PETIT", "program": "stiffness", "items/s": 4e6, "GF/s": 20.0, "of_dgemm": 0.4,
                          "GB/s": 8.0, "of_copy": 0.4}]
        with tempfile.TemporaryDirectory() as folder:
            docs = pathlib.Path(folder)
            (docs / "performance.md").write_text((ROOT / "docs/performance.md").read_text())
            tables.write_docs(docs, made)
            text = (docs / "performance.md").read_text()
            self.assertGreater((docs / "performance.png").stat().st_size, 10000)
            tables.write_docs(docs, measured(study("H3", 155000)))  # what is not measured anew stays
            self.assertIn("clip/3", (docs / "performance.md").read_text())
        self.assertIn("| clip/3 | 2.00 M | 25.0 (50 %) |", text)
        self.assertIn("| 3D/HEXA8 | 4.00 M, 20.0 (40 %), 8.00 (40 %) |", text)
        for content in tables.sections(made).values():
            self.assertIn(content, text)
        with self.assertRaises(ValueError):
            tables.fill("no markers", "studies", "")


class Deck(unittest.TestCase):
    def mesh(self, name):
        """A study's mesh as the base has it, but for the sense of its cells, which MED mirrors: faces are the same."""
        made = end_to_end.two_blocks(name)
        cells, first = [], {}
        for kind, rows in made.cells.items():
            first[kind] = len(cells)
            cells += [(kind, row) for row in rows]
        groups = {group: [first[kind] + c for kind, c in members] for group, members in made.cell_groups.items()}
        return types.SimpleNamespace(points=made.points, cells=cells, groups=groups)

    def test_the_deck_is_the_study(self):
        mesh = self.mesh("H1")
        blocks = {}  # keyword line -> data lines
        for line in calculix.deck(mesh).splitlines():
            if line.startswith("*"):
                data = blocks.setdefault(line, [])
            else:
                data.append(line)
        self.assertEqual(len(blocks["*NODE, NSET=ALL"]), len(mesh.points))
        self.assertEqual(len(blocks["*ELEMENT, TYPE=C3D8, ELSET=SOLID"]), 15 * 15 * 8 + 12 * 12 * 6)
        slave = {int(line.split(",")[0]) for line in blocks["*NSET, NSET=TOP"]}
        self.assertEqual(len(slave), 13 * 13)
        # faces of the slave lie at z = 1/2, those under pressure at z = 1
        solids = [nodes for kind, nodes in mesh.cells if kind == "HEXA8"]
        for keyword, height, count in (("*SURFACE, NAME=CTOP", 0.5, 144), ("*DLOAD", 1.0, 144), ("*SURFACE, NAME=CBOT", 0.5, 225)):
            self.assertEqual(len(blocks[keyword]), count)
            for line in blocks[keyword]:
                cell, face = (int(word.strip(" SP")) for word in line.split(",")[:2])
                nodes = solids[cell - 1][list(calculix.CELLS["HEXA8"][1][face - 1])]
                np.testing.assert_allclose(mesh.points[nodes, 2], height, atol=1e-12)
        held = [tuple(map(int, line.split(",")))[:2] for line in blocks["*BOUNDARY"]]
        at = mesh.points[[node - 1 for node, _ in held]]
        self.assertTrue(all(place[component - 1] == 0 for place, (_, component) in zip(at, held)))
        # two planes of symmetry through both blocks and the base, but for the slave skin's edges
        self.assertEqual(len(held), 2 * (16 * 9 + 13 * 6) + 16 * 16)

    def test_a_pushed_block_has_no_pressure(self):
        text = calculix.deck(self.mesh("H1c"), 0.0011)
        self.assertNotIn("*DLOAD", text)
        self.assertIn("TOP, 3, 3, -0.0011", text)

    def test_pressures_of_a_result_file(self):
        values = (1e-5, 0.0, 0.0, 25.0, 0.0, 0.0)
        line = f" -1{7:10d}" + "".join(f"{v:12.5E}" for v in values)
        frd = "\n".join([" -4  CONTACT     6    1", *(f" -5  {name}" for name in ("COPEN", "CSLIP1", "CSLIP2", "CPRESS", "CSHEAR1", "CSHEAR2")), line, " -3", ""])
        self.assertEqual(calculix.contact_pressures(frd).tolist(), [25.0])


if __name__ == "__main__":
    unittest.main()
