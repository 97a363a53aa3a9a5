"""calc_pression alone: stresses at nodes by hand, what they exert on skins out."""

import unittest

import numpy as np
from lacon_test import OperatorTest, concept

#: a square, its four sides as skin oriented outward (body on the left), in two groups and as a whole
POINTS = [(0, 0), (1, 0), (1, 1), (0, 1)]
CELLS = [("SEG2", [0, 1]), ("SEG2", [1, 2]), ("SEG2", [2, 3]), ("SEG2", [3, 0]), ("QUAD4", [0, 1, 2, 3])]
STRESS = np.array([[-3.0, 1.5], [1.5, -7.0]])


def nodal_stress(n, components=("SIXX", "SIYY", "SIZZ", "SIXY"), tensor=STRESS):
    full = np.zeros((3, 3))
    full[:len(tensor), :len(tensor)] = tensor
    row = [full["XYZ".index(c[2]), "XYZ".index(c[3])] for c in components]
    return {"quantity": "SIEF_R", "location": "NOEU", "components": list(components), "support": range(n), "values": [row] * n}


def displacement(values):
    values = np.asarray(values, float)
    return {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX", "DY", "DZ"][:values.shape[1]], "support": range(len(values)), "values": values}


class CalcPression(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", POINTS, CELLS, cell_groups={"BOTTOM": [0], "RIGHT": [1], "ALL": [0, 1, 2, 3], "BODY": [4]})
        turned = np.array([(-p[1], p[0]) for p in np.array(POINTS, float)]) - POINTS  # by 90 degrees
        self.write_result("result_2", "mesh_1", [0.0, 0.5, 1.0], {
            "DEPL": {k: displacement(f * turned) for k, f in enumerate((0, 0, 1))},
            "SIEF_NOEU": {k: nodal_stress(4) for k in range(3)}}, label="RESU")

    def run_on(self, keywords, result="result_2", reuse=True):
        run = self.run_command("CALC_PRESSION", {"RESULTAT": concept("result_2"), **keywords}, result=result, reuse=reuse, label="RESU")
        self.assertEqual((run.status, run.messages), (0, []), run.stderr)

    def refuses(self, identifier, keywords, *words):
        self.assert_refuses(identifier, "CALC_PRESSION", {"RESULTAT": concept("result_2"), **keywords}, *words, result="result_2", reuse=True)

    def assert_exerts(self, field, normals):
        """Each row is that of STRESS on a unit normal."""
        for row, normal in zip(field.values, np.asarray(normals)):
            traction = STRESS @ normal
            pressure = normal @ traction
            shear = traction - pressure * normal
            np.testing.assert_allclose(row, [pressure, np.linalg.norm(shear), *shear], atol=1e-14)

    def test_the_components_are_normal_stress_and_tangential_traction(self):
        self.run_on({"GROUP_MA": "BOTTOM", "GEOMETRIE": "INITIALE"})
        field = self.read_field("result_2", "PRES_NOEU", 2)
        self.assertEqual((field.components, field.attributes["quantity"]), (["PRES", "CISA", "VX", "VY"], "PRES_R"))
        np.testing.assert_array_equal(field.support, [0, 1])
        self.assert_exerts(field, [(0, -1)] * 2)

    def test_normals_are_means_of_the_cells_around_a_node(self):
        self.run_on({"GROUP_MA": "ALL", "GEOMETRIE": "INITIALE", "INST": [1.0]})
        diagonal = np.sqrt(0.5)
        self.assert_exerts(self.read_field("result_2", "PRES_NOEU", 2), diagonal * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]))
        with self.assertRaises(ValueError):
            self.read_field("result_2", "PRES_NOEU", 0)

    def test_the_deformed_geometry_is_the_default(self):
        self.run_on({"GROUP_MA": "BOTTOM"})
        self.assert_exerts(self.read_field("result_2", "PRES_NOEU", 1), [(0, -1)] * 2)
        self.assert_exerts(self.read_field("result_2", "PRES_NOEU", 2), [(1, 0)] * 2)

    def test_without_reuse_a_new_result_has_this_field_alone(self):
        before = self.snapshot()
        self.run_on({"GROUP_MA": "RIGHT", "NUME_ORDRE": [1]}, result="result_3", reuse=False)
        after = self.snapshot()
        self.assertEqual({name: after[name] for name in before}, before)
        self.assertEqual(len(self.read_field("result_3", "PRES_NOEU", 1).support), 2)
        with self.assertRaises(KeyError):
            self.read_field("result_3", "SIEF_NOEU", 1)

    def test_stresses_at_points_do_where_there_are_none_at_nodes(self):
        stress = {**nodal_stress(4), "location": "ELGA", "support": [4], "offset": [0, 4]}
        self.write_result("result_2", "mesh_1", [1.0], {"DEPL": {0: displacement(np.zeros((4, 2)))}, "SIEF_ELGA": {0: stress}})
        self.run_on({"GROUP_MA": "BOTTOM"})
        self.assert_exerts(self.read_field("result_2", "PRES_NOEU", 0), [(0, -1)] * 2)

    def test_space(self):
        normal = np.array([1, 1, 1]) / np.sqrt(3)
        tensor = np.array([[-3.0, 1.5, 0.5], [1.5, -7.0, 2.0], [0.5, 2.0, 4.0]])
        self.write_mesh("mesh_1", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 0)], [("TRIA3", [0, 1, 2]), ("TETRA4", [3, 0, 1, 2])], cell_groups={"FACE": [0]})
        self.write_result("result_2", "mesh_1", [1.0], {
            "DEPL": {0: displacement(np.zeros((4, 3)))},
            "SIEF_NOEU": {0: nodal_stress(4, ("SIXX", "SIYY", "SIZZ", "SIXY", "SIXZ", "SIYZ"), tensor)}})
        self.run_on({"GROUP_MA": "FACE"})
        field = self.read_field("result_2", "PRES_NOEU", 0)
        shear = tensor @ normal - normal @ tensor @ normal * normal
        self.assertEqual(field.components, ["PRES", "CISA", "VX", "VY", "VZ"])
        np.testing.assert_allclose(field.values, [[normal @ tensor @ normal, np.linalg.norm(shear), *shear]] * 3, atol=1e-14)

    def test_what_has_no_pressure_is_refused(self):
        self.refuses("CALCPRES_1", {"GROUP_MA": ["BOTTOM", "BODY"]}, "M5", "QUAD4")
        self.refuses("FIELDS_2", {"GROUP_MA": "BOTTOM", "INST": [0.7]}, "0.7")
        self.write_mesh("mesh_3", POINTS, CELLS, label="OTHER")
        self.refuses("CALCPRES_3", {"GROUP_MA": "BOTTOM", "MAILLAGE": concept("mesh_3")}, "OTHER", "MESH_1")
        self.write_model("model_4", "mesh_3", ["D_PLAN/QUAD4"], [-1, -1, 0])
        self.refuses("CREACHAMP_5", {"GROUP_MA": "BOTTOM", "MODELE": concept("model_4")}, "OTHER", "MESH_1")
        self.write_model("model_5", "mesh_1", ["D_PLAN/QUAD4"], [-1, -1, -1, -1, 0])
        self.run_on({"GROUP_MA": "BOTTOM", "MODELE": concept("model_5")})
        self.write_mesh("mesh_1", POINTS, [("SEG2", [0, 1]), ("SEG2", [1, 0]), ("QUAD4", [0, 1, 2, 3])], cell_groups={"BOTH": [0, 1]})
        self.refuses("CALCPRES_2", {"GROUP_MA": "BOTH"}, "N1")
        self.write_result("result_2", "mesh_1", [1.0], {"DEPL": {0: displacement(np.zeros((4, 2)))}})
        self.refuses("CALCCHAMP_1", {"GROUP_MA": "BOTH"}, "PRES_NOEU")


if __name__ == "__main__":
    unittest.main()
