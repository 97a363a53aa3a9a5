"""CREA_MAILLAGE alone: DECOUPE_LAC, LINE_QUAD and QUAD_LINE on a base made by hand, and what it refuses."""

import unittest

import numpy as np

from lacon_test import OperatorTest, concept

SQUARE = [[0, 0], [3, 0], [3, 3], [0, 3]]
CELLS = [("SEG2", [0, 1]), ("SEG2", [1, 2]), ("SEG2", [3, 2]), ("QUAD4", [0, 1, 2, 3])]
GROUPS = {"LOW": [0], "RIGHT": [1], "TOP": [2], "ALL": [0, 1, 2], "BODY": [3], "NOTHING": []}


class CreaMaillage(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", SQUARE, CELLS, GROUPS, {"CORNERS": [0, 2]})

    def cut(self, groups, mesh="mesh_1", **more):
        return {"MAILLAGE": concept(mesh), "DECOUPE_LAC": [{"GROUP_MA_ESCL": groups, "DECOUPE_HEXA": "PYRA", **more}]}

    def test_cuts_a_square_node_by_node(self):
        before = self.snapshot()
        run = self.run_command("CREA_MAILLAGE", self.cut(["LOW"]), "mesh_2")
        self.assertEqual(run.status, 0, run.stderr)
        mesh = self.read_mesh("mesh_2")
        np.testing.assert_allclose(mesh.coordinates[4:], [[1, 0, 0], [2, 0, 0], [1, 1.5, 0], [2, 1.5, 0]], atol=1e-15)
        self.assertEqual(mesh.types, ["SEG2"] * 5 + ["QUAD4"] * 4)
        self.assertEqual(mesh.cells, [[0, 4], [4, 5], [5, 1], [1, 2], [3, 2], [0, 4, 6, 3], [4, 5, 7, 6], [5, 1, 2, 7], [2, 3, 6, 7]])
        self.assertEqual({name: list(cells) for name, cells in mesh.cell_groups.items()},
                         {"LOW": [0, 1, 2], "RIGHT": [3], "TOP": [4], "ALL": [0, 1, 2, 3, 4], "BODY": [5, 6, 7, 8], "NOTHING": []})
        self.assertEqual(list(mesh.node_groups["CORNERS"]), [0, 2])
        patches = mesh.patches
        self.assertEqual((patches.zone_group, list(patches.zone_offset)), (["LOW"], [0, 1]))
        self.assertEqual((list(patches.kind), list(patches.parent)), ([12], [0]))
        self.assertEqual((patches.cells, patches.carriers), ([[0, 1, 2]], [[4, 5]]))
        self.assertEqual({name: digest for name, digest in self.snapshot().items() if name in before}, before)
        self.assertEqual(int(self.attributes("mesh_2")["version"]), 1)

    def test_says_what_it_made(self):
        run = self.run_command("CREA_MAILLAGE", self.cut(["LOW", "TOP"]), "mesh_2")
        self.assertEqual(self.ids(run), ["DECOUPE_7", "MESH1_3"])  # TOP looks into the body
        self.assertIn("'TOP'", run.messages[0]["text"])
        self.assertIn("8 nodes and 10 cells", run.messages[1]["text"])
        self.assertRegex(run.stdout, r"zone LOW +1 macro-elements")
        self.assertRegex(run.stdout, r"cells +4 -> +14")
        self.assertEqual(self.read_mesh("mesh_2").patches.zone_group, ["LOW", "TOP"])

    def test_says_that_nothing_had_to_be_cut(self):
        """A SEG3 is a macro-element as it is: that no node and no cell is new is no failure."""
        self.run_command("CREA_MAILLAGE", {"MAILLAGE": concept("mesh_1"), "LINE_QUAD": [{"TOUT": "OUI"}]}, "mesh_2")
        run = self.run_command("CREA_MAILLAGE", {**self.cut(["LOW"]), "MAILLAGE": concept("mesh_2")}, "mesh_3")
        self.assertEqual(self.ids(run), ["DECOUPE_10"])
        self.assertIn("nothing had to be cut: the 1 slave cell(s) (SEG3) are macro-elements as they are", run.messages[0]["text"])
        self.assertEqual(self.read_mesh("mesh_3").patches.cells, [[0]])

    def test_groups_of_nodes_are_completed_on_demand_only(self):
        self.write_mesh("mesh_1", SQUARE, CELLS, GROUPS, {"CORNERS": [0, 2], "LOW": [1, 0], "WHOLE": [0, 1, 2, 3], "TOP": [2, 3]})
        run = self.run_command("CREA_MAILLAGE", self.cut(["LOW"]), "mesh_2")
        self.assertEqual(self.ids(run), ["MESH1_3", "DECOUPE_11"])  # sums over such groups miss what the new nodes carry
        self.assertIn("'LOW', 'WHOLE';", run.messages[1]["text"])
        self.assertEqual(self.ids(self.run_command("CREA_MAILLAGE", self.cut(["LOW"], GROUP_NO_COMPLET="NON"), "mesh_4")), ["MESH1_3"])
        self.assertEqual({name: list(nodes) for name, nodes in self.read_mesh("mesh_2").node_groups.items()},
                         {"CORNERS": [0, 2], "LOW": [1, 0], "WHOLE": [0, 1, 2, 3], "TOP": [2, 3]})
        run = self.run_command("CREA_MAILLAGE", self.cut(["LOW"], GROUP_NO_COMPLET="OUI"), "mesh_3")
        # the skin's nodes are 4 and 5, those inside the body cell 6 and 7
        self.assertEqual({name: list(nodes) for name, nodes in self.read_mesh("mesh_3").node_groups.items()},
                         {"CORNERS": [0, 2], "LOW": [1, 0, 4, 5], "WHOLE": [0, 1, 2, 3, 4, 5, 6, 7], "TOP": [2, 3]})
        self.assertEqual(self.ids(run), ["DECOUPE_8", "DECOUPE_8", "MESH1_3"])

    def test_a_part_of_a_mesh_keeps_the_named_groups_or_all_that_are_left(self):
        self.write_mesh("mesh_1", SQUARE, CELLS, GROUPS, {"CORNERS": [2, 0], "LEFT": [3, 0], "LAST": [3]})
        part = {"MAILLAGE": concept("mesh_1"), "RESTREINT": {"GROUP_MA": ["TOP", "RIGHT"]}}
        for more, cell_groups, node_groups in (
                ({}, {"RIGHT": [0], "TOP": [1]}, {}),
                ({"TOUT_GROUP_MA": "OUI", "GROUP_NO": ["LAST"]}, {"RIGHT": [0], "TOP": [1], "ALL": [0, 1]}, {"LAST": [2]}),
                ({"TOUT_GROUP_NO": "OUI"}, {"RIGHT": [0], "TOP": [1]}, {"CORNERS": [1], "LEFT": [2], "LAST": [2]})):
            run = self.run_command("CREA_MAILLAGE", {**part, "RESTREINT": [{**part["RESTREINT"], **more}]}, "mesh_2")
            self.assertEqual((run.status, run.messages), (0, []), run.stderr)
            mesh = self.read_mesh("mesh_2")
            np.testing.assert_array_equal(mesh.coordinates[:, :2], SQUARE[1:])
            self.assertEqual((mesh.types, mesh.cells), (["SEG2", "SEG2"], [[0, 1], [2, 1]]))
            self.assertEqual({name: list(cells) for name, cells in mesh.cell_groups.items()}, cell_groups)
            self.assertEqual({name: list(nodes) for name, nodes in mesh.node_groups.items()}, node_groups)
        self.assert_refuses("MESH_1", "CREA_MAILLAGE", {**part, "RESTREINT": [{"GROUP_MA": ["TOPP"]}]}, "TOPP", result="mesh_3")
        self.assert_refuses("MESH_1", "CREA_MAILLAGE", {**part, "RESTREINT": [{"GROUP_MA": ["TOP"], "GROUP_NO": ["X"]}]}, "X", result="mesh_3")

    def test_quality_is_a_line_and_with_info_2_a_table(self):
        run = self.run_command("CREA_MAILLAGE", self.cut(["LOW"]), "mesh_2")
        # M6 and M8 have a corner between (0, 1.5) and (1, 1.5)
        least = 1 / np.hypot(1, 1.5)
        self.assertRegex(run.stdout, rf"scaled Jacobian .*: 1.000 to 1.000 before the cut, {least:.3f} to 1.000 after it")
        self.assertNotIn("the worst", run.stdout)
        run = self.run_command("CREA_MAILLAGE", {**self.cut(["LOW"]), "INFO": 2}, "mesh_3")
        self.assertRegex(run.stdout, rf"(?s)the worst after the cut:\n +{least:.4f}  QUAD4 M[68] \(BODY\)")

    def test_a_badly_shaped_cell_is_named(self):
        self.write_mesh("mesh_1", [[0, 0], [300, 0], [300, 3], [0, 3]], CELLS, GROUPS)
        run = self.run_command("CREA_MAILLAGE", self.cut(["LOW"]), "mesh_2")
        self.assertEqual(self.ids(run), ["MESH1_3", "DECOUPE_9"])
        self.assertIn("(BODY), has a scaled Jacobian of 0.015;", run.messages[1]["text"])

    def test_line_quad_and_back(self):
        run = self.run_command("CREA_MAILLAGE", {"MAILLAGE": concept("mesh_1"), "LINE_QUAD": [{"TOUT": "OUI"}]}, "mesh_2")
        self.assertEqual(run.status, 0, run.stderr)
        quadratic = self.read_mesh("mesh_2")
        self.assertEqual(quadratic.types, ["SEG3", "SEG3", "SEG3", "QUAD8"])
        self.assertEqual(len(quadratic.coordinates), 8)
        np.testing.assert_array_equal(quadratic.coordinates[quadratic.cells[3][4:], :2], [[1.5, 0], [3, 1.5], [1.5, 3], [0, 1.5]])
        run = self.run_command("CREA_MAILLAGE", {"MAILLAGE": concept("mesh_2"), "QUAD_LINE": [{"GROUP_MA": ["ALL"]}]}, "mesh_3")
        self.assertEqual(self.read_mesh("mesh_3").types, ["SEG2", "SEG2", "SEG2", "QUAD8"])
        run = self.run_command("CREA_MAILLAGE", {"MAILLAGE": concept("mesh_2"), "QUAD_LINE": [{"TOUT": "OUI"}]}, "mesh_4")
        self.assertEqual(self.read_mesh("mesh_4").cells, [nodes for _, nodes in CELLS])

    def test_quadratic_skins_are_patches_as_they_are(self):
        self.run_command("CREA_MAILLAGE", {"MAILLAGE": concept("mesh_1"), "LINE_QUAD": [{"TOUT": "OUI"}]}, "mesh_2")
        run = self.run_command("CREA_MAILLAGE", self.cut(["LOW"], "mesh_2"), "mesh_3")
        self.assertEqual(run.status, 0, run.stderr)
        before, after = self.read_mesh("mesh_2"), self.read_mesh("mesh_3")
        self.assertEqual(after.cells, before.cells)
        self.assertEqual((list(after.patches.kind), after.patches.carriers), ([14], [[before.cells[0][2]]]))

    def test_refuses_bad_groups(self):
        for groups, identifier, word in ((["LOWER"], "MESH_1", "'LOWER'"), (["NOTHING"], "MESH_2", "'NOTHING'"),
                                         (["LOW", "LOW"], "DECOUPE_1", "'LOW'"), (["LOW", "ALL"], "DECOUPE_2", "M1"),
                                         (["BODY"], "DECOUPE_4", "M4")):
            with self.subTest(groups=groups):
                self.assert_refuses(identifier, "CREA_MAILLAGE", self.cut(groups), word, result="mesh_2")

    def test_refuses_a_skin_without_body(self):
        self.write_mesh("mesh_5", [*SQUARE, [5, 0], [6, 0]], [*CELLS, ("SEG2", [4, 5])], {"LONE": [4]})
        self.assert_refuses("MESH1_2", "CREA_MAILLAGE", self.cut(["LONE"], "mesh_5"), "M5", "'LONE'", result="mesh_6")

    def test_refuses_a_pair_without_cut(self):
        nodes = [*SQUARE, [1.5, 0], [3, 1.5], [1.5, 3], [0, 1.5]]
        self.write_mesh("mesh_5", nodes, [("SEG2", [0, 1]), ("QUAD8", list(range(8)))], {"LOW": [0]})
        self.assert_refuses("CREALAC_1", "CREA_MAILLAGE", self.cut(["LOW"], "mesh_5"), "SEG2", "QUAD8", result="mesh_6")

    def test_refuses_an_internal_face(self):
        self.write_mesh("mesh_5", [*SQUARE, [6, 0], [6, 3]], [("SEG2", [1, 2]), ("QUAD4", [0, 1, 2, 3]), ("QUAD4", [1, 4, 5, 2])], {"IN": [0]})
        self.assert_refuses("DECOUPE_3", "CREA_MAILLAGE", self.cut(["IN"], "mesh_5"), "M2", "M3", result="mesh_6")

    def test_refuses_a_bad_body_cell(self):
        self.write_mesh("mesh_5", [[0, 0], [3, 0], [0.5, 0.5], [0, 3]], [("SEG2", [0, 1]), ("QUAD4", [0, 1, 2, 3])], {"LOW": [0]})
        self.assert_refuses("DECOUPE_6", "CREA_MAILLAGE", self.cut(["LOW"], "mesh_5"), "M2 under the slave cell M1, a QUAD4, has", result="mesh_6")

    def test_refuses_a_skin_without_length_or_area(self):
        """Newton's method found no normal there, as if it had not converged; a hexahedron whose top is drawn to a line is sound but for its corners."""
        self.write_mesh("mesh_5", [[0, 0], [3, 0], [3, 0], [0, 3]], [("SEG2", [1, 2]), ("QUAD4", [0, 1, 2, 3])], {"AT": [0]})
        self.assert_refuses("SKIN_1", "CREA_MAILLAGE", self.cut(["AT"], "mesh_5"), "SEG2 M1", "'AT'", "no length", "N2, N3", result="mesh_6")
        wedge = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0.5, 1], [1, 0.5, 1], [1, 0.5, 1], [0, 0.5, 1]]
        self.write_mesh("mesh_7", wedge, [("QUAD4", [4, 5, 6, 7]), ("HEXA8", list(range(8)))], {"ROOF": [0]})
        self.assert_refuses("SKIN_1", "CREA_MAILLAGE", self.cut(["ROOF"], "mesh_7"), "QUAD4 M1", "'ROOF'", "no area", "N5, N6, N7, N8", result="mesh_8")

    def test_refuses_a_mesh_that_is_cut(self):
        self.run_command("CREA_MAILLAGE", self.cut(["LOW"]), "mesh_2", label="CUT")
        self.assert_refuses("MESH1_12", "CREA_MAILLAGE", self.cut(["TOP"], "mesh_2"), "'CUT'", result="mesh_3")
        for keyword in ("LINE_QUAD", "QUAD_LINE"):
            self.assert_refuses("MESH1_12", "CREA_MAILLAGE", {"MAILLAGE": concept("mesh_2"), keyword: [{"TOUT": "OUI"}]}, keyword, "'CUT'", result="mesh_3")

    def test_refuses_incomplete_orders(self):
        self.assert_refuses("ORDER_2", "CREA_MAILLAGE", {"MAILLAGE": concept("mesh_1")}, "DECOUPE_LAC", result="mesh_2")
        self.assert_refuses("ORDER_2", "CREA_MAILLAGE", {"MAILLAGE": concept("mesh_1"), "LINE_QUAD": [{}]}, "TOUT", result="mesh_2")
        self.assert_refuses("KEYWORD_18", "CREA_MAILLAGE", self.cut(["LOW"], DECOUPE_HEXA="TETRA"), "DECOUPE_HEXA", result="mesh_2")
        self.assert_refuses("ORDER_3", "CREA_MAILLAGE", self.cut(["LOW"], GROUP_NO="A"), "GROUP_NO", result="mesh_2")
        self.assert_refuses("BASE_1", "CREA_MAILLAGE", self.cut(["LOW"], "mesh_9"), "mesh_9", result="mesh_2")


if __name__ == "__main__":
    unittest.main()
