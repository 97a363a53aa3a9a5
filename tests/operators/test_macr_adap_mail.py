"""MACR_ADAP_MAIL: uniform refinement, as an operator."""

import unittest

import numpy as np

from lacon_test import OperatorTest, concept

NODES = [[0, 0], [2, 0], [4, 0], [0, 2], [2, 2], [4, 2]]
CELLS = [("SEG2", [0, 1]), ("SEG2", [1, 2]), ("QUAD4", [0, 1, 4, 3]), ("QUAD4", [1, 2, 5, 4]), ("POI1", [0])]
GROUPS = {"LOW": [0, 1], "LEFT": [2], "RIGHT": [3], "BODY": [2, 3], "POINT": [4]}


class MacrAdapMail(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", NODES, CELLS, GROUPS, {"CORNERS": [0, 2], "ONE": [0]})

    def refine(self, mesh="mesh_1", **keywords):
        return {"MAILLAGE_N": concept(mesh), "MAILLAGE_NP1": concept("mesh_2"), "ADAPTATION": "RAFFINEMENT_UNIFORME", **keywords}

    def test_body_and_skin_are_refined_in_place(self):
        run = self.run_command("MACR_ADAP_MAIL", self.refine(GROUP_MA=["BODY"]), "mesh_2")
        self.assertEqual(run.status, 0, run.stderr)
        mesh = self.read_mesh("mesh_2")
        self.assertEqual(mesh.types, ["SEG2"] * 4 + ["QUAD4"] * 8 + ["POI1"])
        self.assertEqual({name: list(members) for name, members in mesh.cell_groups.items()},
                         {"LOW": [0, 1, 2, 3], "LEFT": [4, 5, 6, 7], "RIGHT": [8, 9, 10, 11], "BODY": list(range(4, 12)), "POINT": [12]})
        self.assertEqual(len(mesh.coordinates), 15)
        np.testing.assert_array_equal(sorted(map(tuple, mesh.coordinates[:, :2])), [(x, y) for x in range(5) for y in range(3)])
        self.assertEqual({name: list(members) for name, members in mesh.node_groups.items()}, {"CORNERS": [0, 2], "ONE": [0]})
        self.assertEqual(self.ids(run), ["RAFFINE_3"])
        self.assertIn("'CORNERS'", run.messages[0]["text"])
        self.assertRegex(run.stdout, r"cells +5 -> +13")

    def test_without_groups_everything_is_refined(self):
        self.run_command("MACR_ADAP_MAIL", self.refine(), "mesh_2")
        self.run_command("MACR_ADAP_MAIL", self.refine(GROUP_MA=["BODY", "LOW"]), "mesh_3")
        self.assertEqual(self.read_mesh("mesh_2").cells, self.read_mesh("mesh_3").cells)
        self.assertEqual(len(self.read_mesh("mesh_1").cells), 5)

    def test_refuses_a_hanging_node(self):
        self.assert_refuses("RAFFINE_1", "MACR_ADAP_MAIL", self.refine(GROUP_MA=["LEFT"]), "QUAD4 M4", "RIGHT", "N2-N5", result="mesh_2")

    def test_refuses_other_groups_meshes_and_adaptations(self):
        self.assert_refuses("MESH_1", "MACR_ADAP_MAIL", self.refine(GROUP_MA=["BDY"]), "'BDY'", "BODY", result="mesh_2")
        self.assert_refuses("KEYWORD_18", "MACR_ADAP_MAIL", {**self.refine(), "ADAPTATION": "RAFFINEMENT"}, "ADAPTATION", result="mesh_2")
        self.run_command("CREA_MAILLAGE", {"MAILLAGE": concept("mesh_1"), "DECOUPE_LAC": [{"GROUP_MA_ESCL": ["LOW"]}]}, "mesh_4", label="CUT")
        self.assert_refuses("MESH1_12", "MACR_ADAP_MAIL", self.refine("mesh_4"), "'CUT'", result="mesh_2")


if __name__ == "__main__":
    unittest.main()
