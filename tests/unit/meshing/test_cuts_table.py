"""A row of catalog/cuts.toml or refinements.toml that contradicts cells.toml, contact.toml or itself stops the build, with its name."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

CATALOG = pathlib.Path(os.environ.get("LACON_SOURCE_DIR", pathlib.Path(__file__).parents[3])) / "catalog"


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
        return subprocess.run([sys.executable, "-B", folder / "catalog" / "generate.py", folder / "catalog", folder / "made"],
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
