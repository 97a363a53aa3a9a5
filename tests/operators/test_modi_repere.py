"""modi_repere alone: fields by hand in, and fields whose components are known in closed form out."""

import unittest

import h5py
import numpy as np
from lacon_test import OperatorTest, concept, text

#: a square off the origin, and a tetrahedron with one node on the axis through (1, 0, 0) along Z
SQUARE = np.array([(1, 0, 0), (3, 0, 0), (3, 2, 0), (1, 2, 0)], float)
TETRAHEDRON = np.array([(1, 0, 0), (3, 0, 0), (1, 2, 1), (0, -1, 2)], float)
VECTOR = ["DX", "DY", "DZ", "LAGS_C"]
TENSOR = ["SIXX", "SIYY", "SIZZ", "SIXY", "SIXZ", "SIYZ"]
TURNED = ["MODIREPERE_6"]  # a result whose displacements turn places
AXES = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]


def components(tensor, count=6):
    return [tensor[i, j] for i, j in AXES[:count]]


class ModiRepere(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", SQUARE[:, :2], [("QUAD4", [0, 1, 2, 3])], {"BODY": [0]}, {"ENDS": [0, 2]})
        self.write_model("model_2", "mesh_1", ["D_PLAN/QUAD4"], [0])
        self.write_mesh("mesh_3", TETRAHEDRON, [("TETRA4", [0, 1, 2, 3])], {"BODY": [0]})
        self.write_model("model_4", "mesh_3", ["3D/TETRA4"], [0])

    def field(self, location, names, values, **more):
        owners = {"NOEU": range(4), "ELNO": [0], "ELGA": [0]}[location]
        offset = {} if location == "NOEU" else {"offset": np.array([0, len(values)], np.int64)}
        quantity = {"D": "DEPL_R", "S": "SIEF_R"}[names[0][0]]
        return {"quantity": quantity, "location": location, "components": names, "support": owners, "values": np.asarray(values, float), **offset, **more}

    def write(self, mesh, fields):
        self.write_result("result_5", mesh, [0.0, 1.0], {name: {1: field} for name, field in fields.items()}, label="RES",
                          model="model_2" if mesh == "mesh_1" else "model_4")

    def turn(self, name, kind, repere, affe, messages=(), **more):
        """@return the values of the field in the new axes"""
        affe = affe if isinstance(affe, list) else [affe]
        run = self.run_command("MODI_REPERE", {"RESULTAT": concept("result_5"), "REPERE": repere, "AFFE": affe,
                                               "MODI_CHAM": [{"NOM_CHAM": name, "TYPE_CHAM": kind, **more}]}, result="result_9")
        self.assertEqual((run.status, self.ids(run)), (0, list(messages)), run.stderr)
        with h5py.File(self.path("result_9")) as file:
            self.assertEqual((list(file["fields"]), file["fields"][name]["order"][()].tolist()), ([name], [1]))
            path = text(file["fields"][name]["file"][0])
        with h5py.File(self.base / path) as file:
            return file["values"][()]

    def test_cylindrical_axes_of_the_plane(self):
        """r e_r + 2 e_t, and the tensor e_r e_r + 3 e_t e_t + 5 e_z e_z + 7 (e_r e_t + e_t e_r), about (0, 1)."""
        arm = SQUARE[:, :2] - (0, 1)
        r = np.linalg.norm(arm, axis=1)
        e_r = arm / r[:, None]
        e_t = np.stack([-e_r[:, 1], e_r[:, 0]], axis=1)
        tensors = []
        for a, b in zip(e_r, e_t):
            tensor = np.zeros((3, 3))
            tensor[:2, :2] = np.outer(a, a) + 3 * np.outer(b, b) + 7 * (np.outer(a, b) + np.outer(b, a))
            tensor[2, 2] = 5
            tensors.append(components(tensor, 4))
        vectors = np.column_stack([r[:, None] * e_r + 2 * e_t, np.full(4, 9.0)])
        self.write("mesh_1", {"DEPL": self.field("NOEU", ["DX", "DY", "LAGS_C"], vectors), "SIEF_ELNO": self.field("ELNO", TENSOR[:4], tensors)})
        about = {"ORIGINE": [0.0, 1.0]}
        np.testing.assert_allclose(self.turn("DEPL", "VECT_2D", "CYLINDRIQUE", about, TURNED), [(x, 2, 9) for x in r], atol=1e-14)
        np.testing.assert_allclose(self.turn("SIEF_ELNO", "TENS_2D", "CYLINDRIQUE", about, TURNED), [(1, 3, 5, 7)] * 4, atol=1e-14)
        part = self.turn("DEPL", "VECT_2D", "CYLINDRIQUE", {"GROUP_NO": "ENDS", **about}, TURNED, NOM_CMP=["DX", "DY"])
        np.testing.assert_array_equal(part[[1, 3]], vectors[[1, 3]])
        np.testing.assert_allclose(part[[0, 2], :2], [(x, 2) for x in r[[0, 2]]], atol=1e-14)

    def test_cylindrical_axes_of_space_are_radial_axial_and_tangential(self):
        """About the line through (1, 0, 0) along (0, 0, 2), on which node 1 lies."""
        arm = (TETRAHEDRON - (1, 0, 0)) * (1, 1, 0)
        r = np.linalg.norm(arm, axis=1)
        e_r = arm[1:] / r[1:, None]
        e_z = np.array([0.0, 0, 1])
        e_t = np.cross(e_z, e_r)
        vectors = np.zeros((4, 4))
        vectors[1:, :3] = 4 * e_r + 5 * e_z + 6 * e_t
        vectors[0, :3] = 1, 2, 3
        self.write("mesh_3", {"DEPL": self.field("NOEU", VECTOR, vectors)})
        about = {"ORIGINE": [1.0, 0.0, 0.0], "AXE_Z": [0.0, 0.0, 2.0]}
        found = self.turn("DEPL", "VECT_3D", "CYLINDRIQUE", about, messages=["MODIREPERE_4", *TURNED])
        np.testing.assert_allclose(found[1:], [(4, 5, 6, 0)] * 3, atol=1e-14)
        self.assertEqual(found[0, 1], 3)
        np.testing.assert_allclose(np.linalg.norm(found[0]), np.sqrt(14))

    def test_tensors_at_integration_points_turn_at_their_own_place(self):
        """At the centre of the tetrahedron: hoop stress alone about an axis through none of the points."""
        centre = TETRAHEDRON.mean(axis=0)
        axis = np.array([1.0, 2, 2]) / 3
        arm = centre - (5, 5, 5)
        e_r = arm - arm @ axis * axis
        e_r /= np.linalg.norm(e_r)
        e_t = np.cross(axis, e_r)
        self.write("mesh_3", {"SIEF_ELGA": self.field("ELGA", TENSOR, [components(np.outer(e_t, e_t) - 4 * np.outer(axis, axis))])})
        found = self.turn("SIEF_ELGA", "TENS_3D", "CYLINDRIQUE", {"ORIGINE": [5.0, 5.0, 5.0], "AXE_Z": [1.0, 2.0, 2.0]})
        np.testing.assert_allclose(found, [(0, -4, 1, 0, 0, 0)], atol=1e-13)

    def test_axes_of_angles_and_of_vectors(self):
        turned = np.array([(0, 0, -1), (0, 1, 0), (1, 0, 0)], float)  # X to -Z: 90 degrees about Y
        self.write("mesh_3", {"DEPL": self.field("NOEU", VECTOR, [(1, 2, 3, 4)] * 4)})
        for affe, axes in (({"ANGL_NAUT": [90.0]}, [(0, 1, 0), (-1, 0, 0), (0, 0, 1)]), ({"ANGL_NAUT": [0.0, 90.0]}, turned),
                           ({"ANGL_NAUT": [0.0, 0.0, 90.0]}, [(1, 0, 0), (0, 0, 1), (0, -1, 0)]),
                           ({"ANGL_NAUT": [90.0, 90.0]}, [(0, 0, -1), (-1, 0, 0), (0, 1, 0)]),
                           ({"VECT_X": [0.0, 0.0, -2.0], "VECT_Y": [0.0, 1.0, 5.0]}, turned),
                           ([{"ANGL_NAUT": [10.0]}, {"TOUT": "OUI", "ANGL_NAUT": [0.0, 90.0]}], turned)):
            with self.subTest(affe=affe):
                expected = [(*(np.array(axes) @ (1, 2, 3)), 4)] * 4
                np.testing.assert_allclose(self.turn("DEPL", "VECT_3D", "UTILISATEUR", affe), expected, atol=1e-14)

    def test_places_that_have_turned_are_told(self):
        """By 30 degrees about the axis: radial directions are those of the mesh, and nothing said so. Not of what goes along them, nor of other axes."""
        about = {"ORIGINE": [0.0, 0.0]}
        for angle, stretch, deformed, told in ((30, 1, False, True), (2, 1, False, False), (0, 1.5, False, False), (30, 1, True, False)):
            c, s = np.cos(np.radians(angle)) * stretch, np.sin(np.radians(angle)) * stretch
            x = SQUARE[:, :2]
            tensors = [components(np.eye(3), 4)] * 4
            self.write("mesh_1", {"DEPL": self.field("NOEU", ["DX", "DY"], x @ np.array([(c, s), (-s, c)]) - x), "SIEF_ELNO": self.field("ELNO", TENSOR[:4], tensors)})
            if deformed:
                with h5py.File(self.path("mesh_1"), "a") as file:
                    file["first_place"] = np.zeros(7)
            self.turn("SIEF_ELNO", "TENS_2D", "CYLINDRIQUE", about, TURNED if told else ())
            self.turn("SIEF_ELNO", "TENS_2D", "UTILISATEUR", {"ANGL_NAUT": [10.0]})

    def test_refuses(self):
        cells = {**self.field("ELGA", ["SIXX"], [[1.0]]), "location": "ELEM", "components": TENSOR, "values": np.zeros((1, 6))}
        del cells["offset"]
        partly = self.field("NOEU", VECTOR, np.zeros((4, 4)), present=np.array([(1, 1, 0, 1)] * 4, np.uint8))
        self.write("mesh_3", {"DEPL": self.field("NOEU", VECTOR, np.zeros((4, 4))), "SIEF_ELEM": cells, "PART": partly})
        axis = {"ORIGINE": [0.0, 0.0, 0.0], "AXE_Z": [0.0, 0.0, 1.0]}
        for identifier, word, name, kind, repere, affe, more in (
                ("MODIREPERE_5", "VECT_3D", "DEPL", "VECT_2D", "CYLINDRIQUE", axis, {}), ("MODIREPERE_5", "ORIGINE", "DEPL", "VECT_3D", "CYLINDRIQUE", {"ANGL_NAUT": [1.0]}, {}),
                ("MODIREPERE_5", "AXE_Z", "DEPL", "VECT_3D", "CYLINDRIQUE", {"ORIGINE": [0.0, 0.0, 0.0]}, {}),
                ("MODIREPERE_5", "VECT_Y", "DEPL", "VECT_3D", "UTILISATEUR", {"VECT_X": [1.0, 0.0, 0.0], "VECT_Y": [2.0, 0.0, 0.0]}, {}),
                ("MODIREPERE_1", "TENS_3D", "DEPL", "TENS_3D", "CYLINDRIQUE", axis, {}), ("CREACHAMP_14", "DW", "DEPL", "VECT_3D", "CYLINDRIQUE", axis, {"NOM_CMP": ["DX", "DY", "DW"]}),
                ("MODIREPERE_2", "SIEF_ELEM", "SIEF_ELEM", "TENS_3D", "CYLINDRIQUE", axis, {}), ("MODIREPERE_3", "PART", "PART", "VECT_3D", "CYLINDRIQUE", axis, {}),
                ("CREACHAMP_7", "SIEF_ELEM", "SIEF_ELEM", "TENS_3D", "UTILISATEUR", {"ANGL_NAUT": [1.0], "GROUP_NO": "ENDS"}, {}),
                ("RESULT_1", "VITE", "VITE", "VECT_3D", "CYLINDRIQUE", axis, {})):
            with self.subTest(identifier=identifier, word=word):
                self.assert_refuses(identifier, "MODI_REPERE", {"RESULTAT": concept("result_5"), "REPERE": repere, "AFFE": [affe], "INST": [1.0],
                                                                "MODI_CHAM": [{"NOM_CHAM": name, "TYPE_CHAM": kind, **more}]}, word, result="result_9")


if __name__ == "__main__":
    unittest.main()
