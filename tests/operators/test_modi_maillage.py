"""MODI_MAILLAGE alone: ORIE_PEAU on a base made by hand, and what it refuses."""

import unittest

import h5py
import numpy as np

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

    def moved(self, mesh="mesh_1", **keywords):
        run = self.run_command("MODI_MAILLAGE", {"MAILLAGE": concept(mesh), **keywords}, mesh, reuse=True)
        self.assertEqual(run.status, 0, run.stderr)
        return self.read_mesh(mesh)

    def test_translation_and_scale_in_the_plane(self):
        np.testing.assert_array_equal(self.moved(TRANSLATION=[3.0, -1.0]).coordinates[:, :2], np.add(NODES, (3, -1)))
        np.testing.assert_array_equal(self.moved(ECHELLE=2.0).coordinates[:, :2], 2 * np.add(NODES, (3, -1)))
        self.assertEqual(self.read_mesh("mesh_1").cells, [nodes for _, nodes in CELLS])

    def test_rotations_one_after_the_other(self):
        mesh = self.moved(ROTATION=[{"POIN_1": [1.0, 0.0], "ANGLE": 90.0}, {"POIN_1": [0.0, 0.0], "ANGLE": 180.0}])
        np.testing.assert_allclose(mesh.coordinates[:, :2], [(-1 + y, 1 - x) for x, y in NODES], atol=1e-15)

    def test_a_sheet_that_comes_to_lie_in_the_plane_is_a_mesh_of_the_plane(self):
        high, upright = [[x, y, 0.3] for x, y in NODES], [[x, 7.0, y] for x, y in NODES]
        self.write_mesh("mesh_2", high, CELLS, GROUPS)
        self.assertEqual(self.attributes("mesh_2")["dimension"], 3)
        self.moved("mesh_2", TRANSLATION=[0.0, 0.0, -0.1])
        self.assertEqual(self.attributes("mesh_2")["dimension"], 3)
        moved = self.moved("mesh_2", TRANSLATION=[0.0, 0.0, -0.2])  # 5.6e-17 is left
        self.assertEqual(self.attributes("mesh_2")["dimension"], 2)
        np.testing.assert_array_equal(moved.coordinates[:, 2], 0)
        self.write_mesh("mesh_3", upright, CELLS, GROUPS)
        self.moved("mesh_3", ROTATION=[{"POIN_1": [0.0, 7.0, 0.0], "DIR": [1.0, 0.0, 0.0], "ANGLE": -90.0}])
        moved = self.moved("mesh_3", TRANSLATION=[0.0, -7.0])
        self.assertEqual(self.attributes("mesh_3")["dimension"], 2)
        np.testing.assert_allclose(moved.coordinates[:, :2], NODES, atol=1e-14)
        moved = self.moved("mesh_3", TRANSLATION=[0.0, 0.0, 5.0])  # turned first, shifted afterwards
        self.assertEqual(self.attributes("mesh_3")["dimension"], 3)
        np.testing.assert_array_equal(moved.coordinates[:, 2], 5)

    def test_what_is_scaled_to_next_to_nothing_is_not_flat(self):
        self.write_mesh("mesh_2", [[x, y, x * y] for x, y in NODES], CELLS, GROUPS)
        self.moved("mesh_2", ECHELLE=1e-20)
        self.assertEqual(self.attributes("mesh_2")["dimension"], 3)

    def write_tetrahedron(self):
        points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        self.write_mesh("mesh_2", points, [("TRIA3", [0, 2, 1]), ("TETRA4", [0, 1, 2, 3])], {"LOW": [0]})
        return points

    def test_rotation_in_space_about_a_direction_or_through_two_points(self):
        points = self.write_tetrahedron()
        mesh = self.moved("mesh_2", ROTATION=[{"POIN_1": [0.0, 0.0, 0.0], "DIR": [2.0, 2.0, 2.0], "ANGLE": 120.0}])  # x to y to z to x
        np.testing.assert_allclose(mesh.coordinates, [(z, x, y) for x, y, z in points], atol=1e-15)
        mesh = self.moved("mesh_2", ROTATION=[{"POIN_1": [1.0, 1.0, 1.0], "POIN_2": [0.0, 0.0, 0.0], "ANGLE": 120.0}])
        np.testing.assert_allclose(mesh.coordinates, points, atol=1e-15)

    def test_a_mirror_keeps_volumes_positive_and_skins_outward(self):
        points = self.write_tetrahedron()
        mesh = self.moved("mesh_2", SYMETRIE=[{"POINT": [2.0, 0.0, 0.0], "AXE_1": [0.0, 1.0, 0.0], "AXE_2": [0.0, 0.0, 3.0]}])
        np.testing.assert_allclose(mesh.coordinates, [(4 - x, y, z) for x, y, z in points], atol=1e-15)
        a, b, c, d = mesh.coordinates[mesh.cells[1]]
        self.assertGreater(np.dot(np.cross(b - a, c - a), d - a), 0)
        a, b, c = mesh.coordinates[mesh.cells[0]]
        self.assertLess(np.cross(b - a, c - a)[2], 0)
        plane = self.moved(SYMETRIE=[{"POINT": [0.0, 1.0], "AXE_1": [1.0, 0.0]}])
        np.testing.assert_allclose(plane.coordinates[:, :2], [(x, 2 - y) for x, y in NODES], atol=1e-15)

    def test_refuses_vectors_of_another_dimension_and_directions_that_are_none(self):
        self.write_tetrahedron()
        for mesh, keywords, word in (("mesh_1", {"TRANSLATION": [1.0]}, "TRANSLATION"), ("mesh_2", {"TRANSLATION": [1.0, 2.0]}, "TRANSLATION"),
                                     ("mesh_2", {"ROTATION": [{"POIN_1": [0.0, 0.0, 0.0]}]}, "DIR"),
                                     ("mesh_2", {"ROTATION": [{"POIN_1": [0.0, 0.0, 0.0], "DIR": [0.0, 0.0, 0.0]}]}, "DIR"),
                                     ("mesh_2", {"SYMETRIE": [{"POINT": [0.0, 0.0, 0.0], "AXE_1": [1.0, 0.0, 0.0], "AXE_2": [2.0, 0.0, 0.0]}]}, "AXE_1")):
            with self.subTest(keywords=keywords):
                self.assert_refuses("KEYWORD_18", "MODI_MAILLAGE", {"MAILLAGE": concept(mesh), **keywords}, word, result=mesh, reuse=True)

    def test_nodes_move_by_their_displacements(self):
        def write(identifier, mesh="mesh_1", location="NOEU", quantity="DEPL_R", factor=1):
            with self.create(identifier, "field", references=[mesh], mesh=mesh, location=location, quantity=quantity, order=0, instant=0.0, name="U") as file:
                file.attrs["components"] = np.array(["DX", "DY", "LAGS_C"], h5py.string_dtype())
                file["support"], file["values"] = np.array([2, 6], np.int32), factor * np.array([(0.5, -0.25, 9), (1, 2, 9)])
                file["present"] = np.array([(1, 1, 1), (1, 0, 1)], np.uint8)

        write("field_4")
        expected = np.array(NODES, float)
        expected[2] += (0.5, -0.25)
        expected[6] += (1, 0)
        self.write_mesh("mesh_7", NODES, CELLS, GROUPS)  # a copy: its nodes are those of the field's mesh
        np.testing.assert_array_equal(self.moved("mesh_7", DEFORME={"OPTION": "TRAN", "DEPL": concept("field_4")}).coordinates[:, :2], expected)
        np.testing.assert_array_equal(self.moved(DEFORME={"OPTION": "TRAN", "DEPL": concept("field_4")}).coordinates[:, :2], expected)
        write("field_8", mesh="mesh_7", factor=-1)  # back, up to round-off: what looks at places (POST_13) can tell
        for field, is_there in (("field_8", False), ("field_8", True)):
            with h5py.File(self.path("mesh_7")) as file:
                self.assertIs("first_place" in file, not is_there)
            self.moved("mesh_7", DEFORME={"OPTION": "TRAN", "DEPL": concept(field)})
        with h5py.File(self.path("mesh_7")) as file:
            self.assertIn("first_place", file)
        self.write_tetrahedron()
        write("field_5", mesh="mesh_2")
        write("field_6", quantity="GEOM_R")
        for identifier, field in (("CREACHAMP_5", "field_5"), ("CREACHAMP_9", "field_6")):
            self.assert_refuses(identifier, "MODI_MAILLAGE", {"MAILLAGE": concept("mesh_1"), "DEFORME": {"OPTION": "TRAN", "DEPL": concept(field)}},
                                result="mesh_1", reuse=True)

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

    def test_says_of_a_plane_mesh_that_is_lifted_why_it_has_no_skin(self):
        self.write_mesh("mesh_1", [[*node, 1] for node in NODES], CELLS, GROUPS, dimension=3)
        run = self.assert_refuses("ORIE_1", "MODI_MAILLAGE", self.orient({"GROUP_MA_PEAU": ["TOP"]}), "SEG2", "M3", result="mesh_1", reuse=True)
        self.assertIn("only where every z is 0", run.messages[0]["do"])

    def test_turns_and_moves_a_mesh_that_is_cut(self):
        made = self.run_command("CREA_MAILLAGE", {"MAILLAGE": concept("mesh_1"), "DECOUPE_LAC": [{"GROUP_MA_ESCL": ["TOP"]}]}, "mesh_2")
        self.assertEqual(made.status, 0, made.stderr)
        run = self.run_command("MODI_MAILLAGE", {"MAILLAGE": concept("mesh_2"), "ORIE_PEAU": [{"GROUP_MA_PEAU": ["LOW", "TOP"]}]}, "mesh_2", reuse=True)
        self.assertEqual(run.status, 0, run.stderr)
        self.assertRegex(run.stdout, r"LOW +1 cells turned")
        self.assertRegex(run.stdout, r"TOP +0 cells turned")
        before = self.read_mesh("mesh_2").coordinates
        with self.create("field_4", "field", references=["mesh_2"], mesh="mesh_2", location="NOEU", quantity="DEPL_R", order=0, instant=0.0, name="U") as file:
            file.attrs["components"] = np.array(["DX", "DY"], h5py.string_dtype())
            file["support"], file["values"] = np.array([2], np.int32), np.array([(0.5, -0.25)], float)
            file["present"] = np.ones((1, 2), np.uint8)
        moved = self.moved("mesh_2", DEFORME={"OPTION": "TRAN", "DEPL": concept("field_4")}).coordinates - before
        np.testing.assert_allclose(moved[2], (0.5, -0.25, 0), atol=1e-15)
        self.assertEqual(np.count_nonzero(moved), 2)


if __name__ == "__main__":
    unittest.main()
