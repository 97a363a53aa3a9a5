"""MODI_MAILLAGE alone: ORIE_PEAU on a base made by hand, and what it refuses."""

import unittest

from lacon_test import OperatorTest, concept

NODES = [[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1], [5, 0], [6, 0]]
CELLS = [("SEG2", [1, 0]), ("SEG2", [1, 4]), ("SEG2", [2, 3]), ("SEG2", [1, 2]), ("SEG2", [7, 6]),
         ("QUAD4", [0, 1, 2, 3]), ("QUAD4", [1, 2, 5, 4])]  # the second quadrangle runs clockwise
GROUPS = {"LOW": [0, 1], "TOP": [2], "IN": [3], "LONE": [4], "LEFT_BODY": [5], "RIGHT_BODY": [6]}


class ModiMaillage(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", NODES, CELLS, GROUPS)

    def orient(self, *occurrences):
        return {"MAILLAGE": concept("mesh_1"), "ORIE_PEAU": list(occurrences)}

    def run_orient(self, *occurrences):
        run = self.run_command("MODI_MAILLAGE", self.orient(*occurrences), "mesh_1", reuse=True)
        self.assertEqual(run.status, 0, run.stderr)
        return run

    def test_turns_inward_cells_of_every_occurrence(self):
        run = self.run_orient({"GROUP_MA_PEAU": ["LOW"]}, {"GROUP_MA_PEAU": ["TOP"]})
        mesh = self.read_mesh("mesh_1")
        self.assertEqual(mesh.cells[:3], [[0, 1], [1, 4], [2, 3]])  # by geometry, not by the order of the body's nodes
        self.assertEqual(mesh.cells[3:], [nodes for _, nodes in CELLS[3:]])
        self.assertEqual(int(self.attributes("mesh_1")["version"]), 2)
        self.assertRegex(run.stdout, r"LOW +1 cells turned")
        self.assertRegex(run.stdout, r"TOP +0 cells turned")

    def test_leaves_a_lone_cell(self):
        run = self.run_orient({"GROUP_MA_PEAU": ["LONE"]})
        self.assertEqual(self.ids(run), ["ORIE_4"])
        self.assertIn("M5", run.messages[0]["text"])
        self.assertEqual(self.read_mesh("mesh_1").cells[4], [7, 6])

    def test_an_internal_cell_needs_its_body(self):
        self.assert_refuses("ORIE_2", "MODI_MAILLAGE", self.orient({"GROUP_MA_PEAU": ["IN"]}), "M4", "M6", "M7", result="mesh_1", reuse=True)
        self.run_orient({"GROUP_MA_PEAU": ["IN"], "GROUP_MA_INTERNE": ["RIGHT_BODY"]})
        self.assertEqual(self.read_mesh("mesh_1").cells[3], [2, 1])
        self.run_orient({"GROUP_MA_PEAU": ["IN"], "GROUP_MA_INTERNE": ["LEFT_BODY"]})
        self.assertEqual(self.read_mesh("mesh_1").cells[3], [1, 2])

    def test_refuses_bad_groups_and_changes_nothing(self):
        # the first occurrence would turn a cell: nothing of it may stay
        self.assert_refuses("MESH_1", "MODI_MAILLAGE", self.orient({"GROUP_MA_PEAU": ["LOW"]}, {"GROUP_MA_PEAU": ["TIP"]}), "'TOP'",
                            result="mesh_1", reuse=True)
        self.assert_refuses("ORIE_1", "MODI_MAILLAGE", self.orient({"GROUP_MA_PEAU": ["LEFT_BODY"]}), "M6", "QUAD4",
                            result="mesh_1", reuse=True)

    def test_refuses_a_mesh_that_is_cut(self):
        made = self.run_command("CREA_MAILLAGE", {"MAILLAGE": concept("mesh_1"), "DECOUPE_LAC": [{"GROUP_MA_ESCL": ["TOP"]}]}, "mesh_2")
        self.assertEqual(made.status, 0, made.stderr)
        self.assert_refuses("MESH1_12", "MODI_MAILLAGE", {"MAILLAGE": concept("mesh_2"), "ORIE_PEAU": [{"GROUP_MA_PEAU": ["LOW"]}]},
                            result="mesh_2", reuse=True)


if __name__ == "__main__":
    unittest.main()
