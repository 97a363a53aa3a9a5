"""A row of catalog/cuts.toml or refinements.toml that contradicts cells.toml, contact.toml or itself stops the build, with its name."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
from fractions import Fraction

import numpy as np

CATALOG = pathlib.Path(os.environ.get("LACON_SOURCE_DIR", pathlib.Path(__file__).parents[3])) / "catalog"

#: METHOD.md 1.5: (body, vertices of the slave face, DECOUPE_HEXA) -> the sub-cells, the inner mid nodes of the quadratic cut.
#: 1 to 8 are the vertices l1, l2, ... of the body as renumbered(), others the new nodes on the skin (C, c) and inside (d).
METHOD = {
    ("TETRA4", 3, ""): ("4 1 2 C; 4 2 3 C; 4 3 1 C", "4-C"),
    ("HEXA8", 4, "HEXA"): ("c1 c2 2 1 d1 d2 6 5; c2 c3 3 2 d2 d3 7 6; c3 c4 4 3 d3 d4 8 7; c4 c1 1 4 d4 d1 5 8; d4 d3 d2 d1 8 7 6 5; "
                           "c4 c3 c2 c1 d4 d3 d2 d1",
                           "d1-d2 d2-d3 d3-d4 d4-d1 c1-d1 c2-d2 c3-d3 c4-d4 d1-5 d2-6 d3-7 d4-8"),
    ("HEXA8", 4, "PYRA"): ("4 1 5 8 C; 1 2 6 5 C; 2 3 7 6 C; 3 4 8 7 C; 5 6 7 8 C", "C-5 C-6 C-7 C-8"),
    ("PENTA6", 3, ""): ("1 4 5 2 C; 1 3 6 4 C; 3 2 5 6 C; 6 5 4 C", "C-4 C-5 C-6"),
    ("PENTA6", 4, ""): ("1 4 5 2 C; 2 5 6 3 C; 6 5 4 C; 1 2 3 C", "C-2 C-5"),
    ("PYRAM5", 3, ""): ("1 2 3 4 C; 5 3 2 C; 5 4 3 C; 5 1 4 C", "C-3 C-4"),
    ("PYRAM5", 4, ""): ("1 2 C 5; 2 3 C 5; 3 4 C 5; 4 1 C 5", "C-5"),
}
PENTA = {frozenset(text.split()[0]): text.split()[1] for text in (
    "123 123456", "456 654321", "1254 231564", "1364 123456", "3256 312645")}


def renumbered(body, face, edges):
    """The numberings l1, l2, ... of the body's vertices for a slave face, 1-based: several where METHOD.md leaves the first open.
    @param face its vertices seen from outside"""
    if body == "PENTA6":
        return [[int(v) for v in PENTA[frozenset(map(str, face))]]]
    turns = [face[i:] + face[:i] for i in range(len(face))]
    if body == "TETRA4":
        return [turn + [v for v in (1, 2, 3, 4) if v not in face] for turn in turns]
    if body == "HEXA8":
        below = {a: b for e in edges for a, b in (e, e[::-1]) if a in face and b not in face}
        return [turn + [below[v] for v in turn] for turn in turns]
    first = 1 if len(face) == 4 else next(v for v in face if v < 5 and v % 4 + 1 in face)
    return [[(first - 1 + i) % 4 + 1 for i in range(4)] + [5]]


class TableTest(unittest.TestCase):
    table = "cuts.toml"

    def generate(self, old, new):
        """Run the generator on a catalogue whose table has `new` instead of `old`, in every place. @return the finished process"""
        folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_test_"))
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        shutil.copytree(CATALOG, folder / "catalog")
        table = folder / "catalog" / self.table
        text = table.read_text(encoding="utf-8")
        self.assertIn(old, text)
        table.write_text(text.replace(old, new), encoding="utf-8")
        self.made = folder / "made"
        return subprocess.run([sys.executable, "-B", folder / "catalog" / "generate.py", folder / "catalog", self.made],
                              capture_output=True, text=True)

    def refuses(self, old, new, *words):
        done = self.generate(old, new)
        self.assertNotEqual(done.returncode, 0)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertNotIn("Traceback", done.stderr)


class CutsTable(TableTest):
    def test_the_table_as_it_is_passes(self):
        self.assertEqual(self.generate("kind", "kind").returncode, 0)

    def test_a_facet_seen_from_inside(self):
        self.refuses("facet = [5, 6, 7, 8]", "facet = [5, 8, 7, 6]", "QUAD4 on HEXA8", "not a facet seen from outside")

    def test_new_nodes_that_depend_on_where_the_skin_begins(self):
        self.refuses('C = ["1/3", "1/3"]', 'C = ["1/4", "1/3"]', "TRIA3 on TETRA4", "when the skin cell is turned")

    def test_carriers_that_contact_toml_does_not_have(self):
        self.refuses('carriers = ["c1", "c2"]', 'carriers = ["c1"]', "SEG2 on QUAD4", "carriers")

    def test_a_kind_whose_sub_cells_are_others(self):
        self.refuses("kind = 7", "kind = 12", "SEG2 on TRIA3", "patch 12")

    def test_a_new_skin_node_that_quadratic_nodes_forgets(self):
        self.refuses('"n1-C", "n2-C", "n3-C", "C"]', '"n1-C", "n2-C", "C"]', "TRIA6 on TETRA10")

    def test_a_turn_that_is_none(self):
        self.refuses("turns = [[6, 5, 4, 3, 2, 1]]", "turns = [[4, 5, 6, 1, 2, 3]]", "TRIA3 on PENTA6", "turns")

    def test_an_inner_node_that_is_there_twice(self):
        self.refuses('["C-b3", "C-b4"]', '["C-b3", "C-b3"]', "TRIA6 on PYRAM13", "C-b3 is there twice")

    def test_every_row_in_space_is_that_of_the_method(self):
        """On every facet: the sub-cells in order, each vertex in its place, and the order in which the inner nodes are made."""
        self.assertEqual(self.generate("kind", "kind").returncode, 0)
        data = json.loads((self.made / "catalog.json").read_text(encoding="utf-8"))
        cells = {cell["name"]: cell for cell in data["cells"]}
        checked = set()
        for row in data["cuts"]:
            if len(row["facet"]) == 2 or not row["body_cells"]:
                continue
            body, n_vertices = cells[row["body"]], cells[row["body"]]["vertices"]
            nodes = np.array([[float(Fraction(x)) for x in node] for node in body["nodes"]])
            key = (body["linear"], len(row["facet"]), row["option"])
            for facet, order in row["placements"]:
                # the row's nodes where the turned body has them: turning a reference cell is affine
                turn = np.linalg.lstsq(np.column_stack([nodes, np.ones(len(nodes))]), nodes[order], rcond=None)[0]
                xi = np.array(row["skin_nodes"])
                if len(row["facet"]) == 3:
                    weights = np.column_stack([1 - xi.sum(axis=1), xi])
                else:
                    square = ((-1, -1), (1, -1), (1, 1), (-1, 1))
                    weights = np.column_stack([(1 + a * xi[:, 0]) * (1 + b * xi[:, 1]) / 4 for a, b in square])
                inner = np.array(row["body_nodes"]).reshape(-1, 3)
                own = np.concatenate([nodes, weights @ nodes[row["facet"]], inner])
                own = np.column_stack([own, np.ones(len(own))]) @ turn
                face = [v + 1 for v in body["facets"][facet][1] if v < n_vertices]

                def wanted(way):
                    """Vertices of the sub-cells and new inner nodes, as the method has them under a numbering of the body."""
                    at = {str(i + 1): nodes[v - 1] for i, v in enumerate(way)}
                    at["C"] = np.mean([nodes[v - 1] for v in face], axis=0)
                    if key[2] == "HEXA":
                        for i in range(4):
                            weights = np.roll([4, 2, 1, 2], i) / 9
                            at[f"c{i + 1}"] = weights @ [at[j] for j in "1234"]
                            at[f"d{i + 1}"] = (at[f"c{i + 1}"] + weights @ [at[j] for j in "5678"]) / 2
                    sub_cells, middles = METHOD[key]
                    new = [at[f"d{i + 1}"] for i in range(4)] if key[2] == "HEXA" else []
                    if body["order"] == 2:
                        new += [np.mean([at[end] for end in pair.split("-")], axis=0) for pair in middles.split()]
                    return [[at[v] for v in cell.split()] for cell in sub_cells.split("; ")], new

                found = [own[numbers[:cells[kind]["vertices"]]] for kind, numbers in row["body_cells"]]
                inner = own[len(own) - len(inner):]
                ways = [wanted(way) for way in renumbered(body["linear"], face, [(a + 1, b + 1) for a, b in body["edges"]])]
                same = [all(len(a) == len(b) and np.allclose(a, b, atol=1e-12)
                            for a, b in zip([*found, inner], [*sub_cells, np.reshape(new, (-1, 3))], strict=True)) for sub_cells, new in ways]
                self.assertEqual(sum(same), 1, f"{row['skin']} on facet {face} of {row['body']} {row['option']}")
                checked.add(key)
        self.assertEqual(checked, set(METHOD))

    def test_a_cell_that_does_not_exist(self):
        self.refuses('body = "QUAD9"', 'body = "QUAD7"', "SEG3 on QUAD7", "no such cell")


class RefinementsTable(TableTest):
    table = "refinements.toml"

    def test_a_sub_cell_inside_out(self):
        self.refuses('["TRIA3", "1", "1-2", "1-3"]', '["TRIA3", "1", "1-3", "1-2"]', "TRIA3", "inside out")

    def test_sub_cells_that_leave_a_hole(self):
        self.refuses(', ["TRIA3", "1-2", "2-3", "1-3"]', "", "TRIA3", "do not fill")

    def test_a_choice_that_overlaps(self):
        self.refuses('["TETRA4", "1-2", "3-4", "1-3", "1-4"]', '["TETRA4", "1-2", "3-4", "2-3", "1-3"], ["TETRA4", "1-2", "3-4", "1-3", "1-4"]',
                     "TETRA4", "do not fill")

    def test_a_facet_that_is_cut_otherwise_than_its_own_row_says(self):
        self.refuses('[["QUAD4", "1", "1-2", "1-2-3-4", "1-4"], ["QUAD4", "2", "2-3", "1-2-3-4", "1-2"],\n'
                     '  ["QUAD4", "3", "3-4", "1-2-3-4", "2-3"], ["QUAD4", "4", "1-4", "1-2-3-4", "3-4"]]',
                     '[["QUAD4", "1", "1-2", "3-4", "4"], ["QUAD4", "1-2", "2", "3", "3-4"]]', "cuts a facet SEG2 otherwise")

    def test_a_point_that_is_not_there(self):
        self.refuses('"3-7"', '"3-9"', "HEXA8", "3-9")


if __name__ == "__main__":
    unittest.main()
