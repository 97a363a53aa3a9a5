"""asse_maillage alone: nodes, cells and groups of two meshes, one after the other."""

import unittest

import numpy as np
from lacon_test import OperatorTest, concept

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
ABOVE = [(0, 1), (1, 1), (0, 2)]


class AsseMaillage(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", SQUARE, [("SEG2", [2, 3]), ("QUAD4", [0, 1, 2, 3])], cell_groups={"TOP": [0], "LOW": [1]}, node_groups={"A": [2, 3]})
        self.write_mesh("mesh_2", ABOVE, [("TRIA3", [0, 1, 2]), ("SEG2", [0, 1])], cell_groups={"BASE": [1], "UP": [0]}, node_groups={"TOP": [2]})

    def keywords(self, first="mesh_1", second="mesh_2"):
        return {"MAILLAGE_1": concept(first), "MAILLAGE_2": concept(second), "OPERATION": "SUPERPOSE"}

    def test_nodes_cells_and_groups_follow_each_other(self):
        run = self.run_command("ASSE_MAILLAGE", self.keywords(), result="mesh_3", label="BOTH")
        self.assertEqual((run.status, run.messages), (0, []), run.stderr)
        mesh = self.read_mesh("mesh_3")
        np.testing.assert_array_equal(mesh.coordinates[:, :2], SQUARE + ABOVE)
        self.assertEqual([(kind, list(nodes)) for kind, nodes in zip(mesh.types, mesh.cells)],
                         [("SEG2", [2, 3]), ("QUAD4", [0, 1, 2, 3]), ("TRIA3", [4, 5, 6]), ("SEG2", [4, 5])])
        self.assertEqual({name: list(cells) for name, cells in mesh.cell_groups.items()}, {"TOP": [0], "LOW": [1], "BASE": [3], "UP": [2]})
        self.assertEqual({name: list(nodes) for name, nodes in mesh.node_groups.items()}, {"A": [2, 3], "TOP": [6]})
        self.assertEqual((mesh.dimension, mesh.patches), (2, None))

    def test_groups_of_one_name_are_refused(self):
        self.assert_refuses("ASSEMAIL_1", "ASSE_MAILLAGE", self.keywords(second="mesh_1"), "GROUP_MA", "'TOP'", result="mesh_3")
        self.write_mesh("mesh_4", ABOVE, [("TRIA3", [0, 1, 2])], node_groups={"A": [0]})
        self.assert_refuses("ASSEMAIL_1", "ASSE_MAILLAGE", self.keywords(second="mesh_4"), "GROUP_NO", "'A'", result="mesh_3")

    def test_a_mesh_that_is_cut_is_refused(self):
        run = self.run_command("CREA_MAILLAGE", {"MAILLAGE": concept("mesh_1"), "DECOUPE_LAC": {"GROUP_MA_ESCL": "TOP"}}, result="mesh_5", label="CUT")
        self.assertEqual(run.status, 0, run.stderr)
        for first, second in (("mesh_5", "mesh_2"), ("mesh_2", "mesh_5")):
            self.assert_refuses("MESH1_12", "ASSE_MAILLAGE", self.keywords(first, second), "ASSE_MAILLAGE", "'CUT'", result="mesh_3")


if __name__ == "__main__":
    unittest.main()
