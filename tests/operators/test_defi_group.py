"""DEFI_GROUP alone, on a base made by hand, and what it refuses."""

import unittest

from lacon_test import OperatorTest, concept

NODES = [[0, 0], [1, 0], [1, 1], [0, 1]]
CELLS = [("SEG2", [0, 1]), ("SEG2", [1, 2]), ("QUAD4", [0, 1, 2, 3])]


class DefiGroup(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", NODES, CELLS, {"LOW": [0], "RIGHT": [1], "BODY": [2]}, {"END": [1]})

    def define(self, **keywords):
        run = self.run_command("DEFI_GROUP", {"MAILLAGE": concept("mesh_1"), **keywords}, "mesh_1", reuse=True)
        self.assertEqual(run.status, 0, run.stderr)
        return self.read_mesh("mesh_1"), run

    def refuse(self, identifier, *words, **keywords):
        self.assert_refuses(identifier, "DEFI_GROUP", {"MAILLAGE": concept("mesh_1"), **keywords}, *words, result="mesh_1", reuse=True)

    def test_groups_by_name_from_groups_and_removed(self):
        mesh, run = self.define(CREA_GROUP_MA=[{"NOM": "SKIN", "UNION": ["LOW", "RIGHT"]}, {"NOM": "ONE", "MAILLE": ["M3"]}],
                                CREA_GROUP_NO=[{"GROUP_MA": ["SKIN"]}, {"NOM": "A", "NOEUD": ["N4", "N1"]}])
        self.assertEqual({name: list(cells) for name, cells in mesh.cell_groups.items()},
                         {"LOW": [0], "RIGHT": [1], "BODY": [2], "SKIN": [0, 1], "ONE": [2]})
        self.assertEqual({name: list(nodes) for name, nodes in mesh.node_groups.items()}, {"END": [1], "SKIN": [0, 1, 2], "A": [3, 0]})
        self.assertRegex(run.stdout, r"cell group SKIN +2 cells")
        self.assertEqual(int(self.attributes("mesh_1")["version"]), 2)
        mesh, _ = self.define(DETR_GROUP_MA=[{"NOM": ["LOW", "ONE"]}], DETR_GROUP_NO=[{"NOM": ["END"]}])
        self.assertEqual((list(mesh.cell_groups), list(mesh.node_groups)), (["RIGHT", "BODY", "SKIN"], ["SKIN", "A"]))

    def test_an_empty_group_is_an_alarm_and_not_made(self):
        mesh, run = self.define(CREA_GROUP_MA=[{"NOM": "X", "INTERSEC": ["LOW", "RIGHT"]}])
        self.assertEqual(self.ids(run), ["GROUPE_3"])
        self.assertNotIn("X", mesh.cell_groups)

    def test_keeps_the_patches_of_a_cut_mesh(self):
        self.run_command("CREA_MAILLAGE", {"MAILLAGE": concept("mesh_1"), "DECOUPE_LAC": [{"GROUP_MA_ESCL": ["LOW"]}]}, "mesh_2")
        before = self.read_mesh("mesh_2")
        run = self.run_command("DEFI_GROUP", {"MAILLAGE": concept("mesh_2"), "CREA_GROUP_MA": [{"NOM": "SECOND", "MAILLE": ["M2"]}]},
                               "mesh_2", reuse=True)
        self.assertEqual(run.status, 0, run.stderr)
        after = self.read_mesh("mesh_2")
        self.assertEqual(after.patches.cells, before.patches.cells)
        self.assertEqual(list(after.cell_groups["SECOND"]), [after.patches.cells[0][1]])

    def test_refuses_unknown_and_taken_names_and_changes_nothing(self):
        good = {"NOM": "GOOD", "MAILLE": ["M1"]}
        self.refuse("GROUPE_2", "'M4'", CREA_GROUP_MA=[good, {"NOM": "X", "MAILLE": ["M1", "M4"]}])
        self.refuse("GROUPE_2", "'N5'", CREA_GROUP_NO=[{"NOM": "X", "NOEUD": ["N5"]}])
        self.refuse("GROUPE_1", "'LOW'", CREA_GROUP_MA=[good, {"NOM": "LOW", "MAILLE": ["M1"]}])
        self.refuse("GROUPE_1", "'END'", CREA_GROUP_NO=[{"NOM": "END", "NOEUD": ["N1"]}])
        self.refuse("MESH_1", "'LOWER'", CREA_GROUP_MA=[{"NOM": "X", "UNION": ["LOW", "LOWER"]}])
        self.refuse("MESH_1", "'TOP'", DETR_GROUP_MA=[{"NOM": ["TOP"]}])
        self.refuse("ORDER_2", CREA_GROUP_MA=[{"NOM": "X"}])


if __name__ == "__main__":
    unittest.main()
