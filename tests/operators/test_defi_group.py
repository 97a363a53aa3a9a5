"""DEFI_GROUP alone, on a base made by hand, and what it refuses."""

import math
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

    def test_groups_of_nodes_take_a_name_each(self):
        mesh, _ = self.define(CREA_GROUP_NO=[{"NOM": ["A", "B"], "GROUP_MA": ["LOW", "RIGHT"]}])
        both, _ = self.define(CREA_GROUP_NO=[{"GROUP_MA": ["LOW", "RIGHT"]}])
        for name, group in (("A", "LOW"), ("B", "RIGHT")):
            self.assertEqual(list(mesh.node_groups[name]), list(both.node_groups[group]))
        self.refuse("GROUPE_4", "2 name(s)", "1 group(s)", CREA_GROUP_NO=[{"NOM": ["C", "D"], "GROUP_MA": ["LOW"]}])
        self.refuse("KEYWORD_18", "one name", CREA_GROUP_NO=[{"NOM": ["C", "D"], "NOEUD": ["N1"]}])

    def place(self, kind="CREA_GROUP_MA", **keywords):
        """Members of a group made by its place on a strip of four squares, nodes 0 to 4 below and 5 to 9 above, cells 0 to 3."""
        nodes = [[x, y] for y in (0, 1) for x in range(5)]
        self.write_mesh("mesh_1", nodes, [("QUAD4", [i, i + 1, i + 6, i + 5]) for i in range(4)], {"ROW": [3, 2, 1, 0]}, {"ENDS": [9, 4, 0, 5]})
        mesh, _ = self.define(**{kind: [{"NOM": "NEW", **keywords}]})
        return list((mesh.cell_groups if kind == "CREA_GROUP_MA" else mesh.node_groups)["NEW"])

    def test_cells_by_their_place(self):
        self.assertEqual(self.place(OPTION="SPHERE", POINT=[0.0, 0.0], RAYON=1.1), [0, 1])
        self.assertEqual(self.place(OPTION="SPHERE", POINT=[0.0, 0.0], RAYON=1.5, CRIT_NOEUD="TOUS"), [0])
        self.assertEqual(self.place(OPTION="SPHERE", POINT=[0.0, 0.0], RAYON=1.1, CRIT_NOEUD="MAJORITE"), [0])
        self.assertEqual(self.place(OPTION="BANDE", POINT=[2.0, 5.0], VECT_NORMALE=[3.0, 0.0], DIST=0.1), [1, 2])
        self.assertEqual(self.place(OPTION="BANDE", POINT=[2.0, 5.0], VECT_NORMALE=[3.0, 0.0], DIST=1.1, CRIT_NOEUD="TOUS"), [1, 2])
        self.assertEqual(self.place(OPTION="CYLINDRE", POINT=[4.0, 0.0], VECT_NORMALE=[0.0, 1.0], RAYON=0.5), [3])

    def test_skin_cells_by_their_normal(self):
        """Of a hexagon run round with the body to its left, sides whose normals point down, at 60 degrees from there, and up; of a cube one face."""
        corners = [(math.cos(math.radians(a)), math.sin(math.radians(a))) for a in range(-120, 240, 60)]  # the first side lies below
        cells = [("SEG2", [i, (i + 1) % 6]) for i in range(6)] + [("TRIA3", [0, 1, 2])]
        for keywords, wanted in (({}, [0]), ({"ANGL_PREC": 61.0}, [0, 1, 5]), ({"VERI_SIGNE": "NON"}, [0, 3]), ({"ANGL_PREC": 59.0}, [0])):
            self.write_mesh("mesh_1", corners, cells)
            mesh, _ = self.define(CREA_GROUP_MA=[{"NOM": "NEW", "OPTION": "FACE_NORMALE", "VECT_NORMALE": [0.0, -3.0], **keywords}])
            self.assertEqual(list(mesh.cell_groups["NEW"]), wanted, keywords)
        cube = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        self.write_mesh("mesh_1", cube, [("QUAD4", [4, 5, 7, 6]), ("QUAD4", [0, 2, 3, 1]), ("TRIA3", [1, 3, 7]), ("HEXA8", [0, 1, 3, 2, 4, 5, 7, 6])])
        mesh, _ = self.define(CREA_GROUP_MA=[{"NOM": "UP", "OPTION": "FACE_NORMALE", "VECT_NORMALE": [0.0, 0.0, 1.0]},
                                             {"NOM": "SIDE", "OPTION": "FACE_NORMALE", "VECT_NORMALE": [1.0, 0.0, 0.0]}])
        self.assertEqual([list(mesh.cell_groups[name]) for name in ("UP", "SIDE")], [[0], [2]])

    def test_cells_on_the_nodes_of_a_group(self):
        self.assertEqual(self.place(OPTION="APPUI", GROUP_NO=["ENDS"], TYPE_APPUI="AU_MOINS_UN"), [0, 3])
        self.assertEqual(self.place(OPTION="APPUI", GROUP_NO=["ENDS"], TYPE_APPUI="MAJORITE"), [0, 3])

    def test_nodes_on_surfaces(self):
        self.assertEqual(self.place("CREA_GROUP_NO", OPTION="PLAN", POINT=[7.0, 1.0], VECT_NORMALE=[0.0, 2.0], PRECISION=1e-6), [5, 6, 7, 8, 9])
        self.assertEqual(self.place("CREA_GROUP_NO", OPTION="ENV_SPHERE", POINT=[2.0, 0.0], RAYON=2.0, PRECISION=1e-6), [0, 4])
        self.assertEqual(self.place("CREA_GROUP_NO", OPTION="ENV_CYLINDRE", POINT=[1.0, 9.0], VECT_NORMALE=[0.0, 1.0], RAYON=1.0, PRECISION=0.01),
                         [0, 2, 5, 7])

    def line(self, **keywords):
        """Nodes of a group made on a line of SEG3 from (0, 0) over (2, 0) to (2, 2), whose cells do not follow each other in the mesh, and
        on a closed one about (10, 0)."""
        nodes = [[2, 2], [0, 0], [2, 0], [1, 0], [2, 1], [10, 1], [9, 0], [10, -1], [11, 0]]
        self.write_mesh("mesh_1", nodes, [("SEG3", [2, 0, 4]), ("SEG3", [2, 1, 3]), *(("SEG2", [5 + i, 5 + (i + 1) % 4]) for i in range(4))],
                        {"BENT": [0, 1], "LEG": [1], "RING": [2, 3, 4, 5], "ONE": [2]}, {"START": [1], "CORNER": [2], "END": [0], "LEGS": [0, 1]})
        return {"CREA_GROUP_NO": [{"NOM": "NEW", **keywords}]}

    def along(self, **keywords):
        return list(self.define(**self.line(**keywords))[0].node_groups["NEW"])

    def test_nodes_in_the_order_of_a_line_of_cells(self):
        self.assertEqual(self.along(OPTION="NOEUD_ORDO", GROUP_MA=["BENT"]), [1, 3, 2, 4, 0])
        self.assertEqual(self.along(OPTION="NOEUD_ORDO", GROUP_MA=["BENT"], GROUP_NO_ORIG="END"), [0, 4, 2, 3, 1])
        self.assertEqual(self.along(OPTION="NOEUD_ORDO", GROUP_MA=["BENT"], NOEUD_EXTR="N2"), [0, 4, 2, 3, 1])
        self.assertEqual(self.along(OPTION="NOEUD_ORDO", GROUP_MA=["BENT"], NOEUD_ORIG="N2", GROUP_NO_EXTR="END"), [1, 3, 2, 4, 0])
        for direction, order in (([-1.0, 0.5], [7, 6, 5, 8]), ([1.0, 0.5], [7, 8, 5, 6])):
            self.assertEqual(self.along(OPTION="NOEUD_ORDO", GROUP_MA=["RING"], NOEUD_ORIG="N8", NOEUD_EXTR="N8", VECT_ORIE=direction), order)
        for identifier, words, keywords in (("GROUPE_7", ("NOEUD_ORIG", "N3", "BENT"), {"GROUP_MA": ["BENT"], "NOEUD_ORIG": "N3"}),
                                            ("GROUPE_7", ("NOEUD_ORIG", "N1"), {"GROUP_MA": ["RING"], "NOEUD_ORIG": "N1", "NOEUD_EXTR": "N8"}),
                                            ("GROUPE_7", ("GROUP_NO_EXTR", "N1"), {"GROUP_MA": ["BENT"], "NOEUD_ORIG": "N1", "GROUP_NO_EXTR": "END"}),
                                            ("KEYWORD_18", ("GROUP_NO_ORIG", "one node"), {"GROUP_MA": ["BENT"], "GROUP_NO_ORIG": "LEGS"}),
                                            ("KEYWORD_18", ("GROUP_MA", "one group"), {"NOEUD": ["N1"]}),
                                            ("LIGNCOUPE_4", ("M3",), {"GROUP_MA": ["SPLIT"]})):
            keywords = self.line(OPTION="NOEUD_ORDO", **keywords)
            self.define(CREA_GROUP_MA=[{"NOM": "SPLIT", "UNION": ["LEG", "ONE"]}])
            self.refuse(identifier, *words, **keywords)

    def test_nodes_in_the_order_of_a_segment(self):
        self.assertEqual(self.along(OPTION="SEGM_DROI_ORDO", NOEUD=["N3", "N2", "N4"], GROUP_NO_ORIG="START", GROUP_NO_EXTR="CORNER", PRECISION=1e-9),
                         [1, 3, 2])
        self.assertEqual(self.along(OPTION="SEGM_DROI_ORDO", GROUP_MA=["LEG"], NOEUD_ORIG="N3", NOEUD_EXTR="N2", PRECISION=1e-9), [2, 3, 1])
        bent = {"OPTION": "SEGM_DROI_ORDO", "GROUP_MA": ["BENT"], "NOEUD_ORIG": "N2", "NOEUD_EXTR": "N1"}  # N3 is 2^(1/2) away, half the length
        self.assertEqual(self.along(PRECISION=0.51, **bent), [1, 3, 2, 4, 0])
        self.assertEqual(self.along(PRECISION=1.42, CRITERE="ABSOLU", **bent), [1, 3, 2, 4, 0])
        self.refuse("GROUPE_8", "1 nodes", "N3", "1.41421", **self.line(PRECISION=0.49, **bent))
        self.refuse("GROUPE_8", "3 nodes", "N3", **self.line(PRECISION=0.1, CRITERE="ABSOLU", **bent))
        self.refuse("GROUPE_8", "N1", **self.line(PRECISION=1e-6, **{**bent, "NOEUD_EXTR": "N3"}))
        self.refuse("KEYWORD_18", "NOEUD_EXTR", "another place", **self.line(PRECISION=0.1, **{**bent, "NOEUD_EXTR": "N2"}))
        ends = {name: value for name, value in bent.items() if name != "NOEUD_EXTR"}
        self.refuse("KEYWORD_18", "GROUP_NO_EXTR", "one node", **self.line(PRECISION=0.1, **ends))

    def test_vertices_middles_and_centres_of_cells(self):
        nodes = [[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1], [1, 1], [4, 0], [3, 0]]
        self.write_mesh("mesh_1", nodes, [("QUAD9", [0, 1, 2, 3, 4, 5, 6, 7, 8]), ("SEG3", [1, 9, 10]), ("SEG2", [9, 2])],
                        {"ALL": [0, 1, 2], "LINES": [1, 2]})
        wanted = {"SOMMET": [0, 1, 2, 3, 9], "MILIEU": [4, 5, 6, 7, 10], "CENTRE": [8], "TOUS": list(range(11))}
        mesh, _ = self.define(CREA_GROUP_NO=[{"NOM": which, "GROUP_MA": ["ALL"], "CRIT_NOEUD": which} for which in wanted])
        self.assertEqual({name: list(members) for name, members in mesh.node_groups.items()}, wanted)
        _, run = self.define(CREA_GROUP_NO=[{"NOM": "NONE", "GROUP_MA": ["LINES"], "CRIT_NOEUD": "CENTRE"}])
        self.assertEqual(self.ids(run), ["GROUPE_3"])

    def test_parts_of_a_group_by_position(self):
        self.assertEqual(self.place(GROUP_MA="ROW", POSITION="INIT"), [3])
        self.assertEqual(self.place(GROUP_MA="ROW", POSITION="MILIEU"), [2])
        self.assertEqual(self.place("CREA_GROUP_NO", GROUP_NO="ENDS", POSITION="FIN"), [5])
        self.assertEqual(self.place(GROUP_MA="ROW", NUME_INIT=2, NUME_FIN=3), [2, 1])
        self.assertEqual(self.place("CREA_GROUP_NO", GROUP_NO="ENDS", NUME_INIT=3), [0, 5])

    def test_refuses_places_that_are_none(self):
        for keywords, word in (({"OPTION": "SPHERE", "POINT": [0.0, 0.0, 0.0], "RAYON": 1.0}, "POINT"),
                               ({"OPTION": "BANDE", "POINT": [0.0, 0.0], "VECT_NORMALE": [0.0, 0.0], "DIST": 1.0}, "VECT_NORMALE"),
                               ({"GROUP_MA": "LOW", "NUME_INIT": 2}, "NUME_INIT"), ({"GROUP_MA": "LOW", "NUME_FIN": 2}, "NUME_FIN")):
            with self.subTest(keywords=keywords):
                self.refuse("KEYWORD_18", word, CREA_GROUP_MA=[{"NOM": "X", **keywords}])

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
