"""calc_champ alone: a result by hand, fields at nodes out."""

import json
import unittest

import h5py
import numpy as np
from lacon_test import OperatorTest, concept

#: two squares side by side and their lower skin
POINTS = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)]
CELLS = [("SEG2", [0, 1]), ("SEG2", [1, 2]), ("QUAD4", [0, 1, 4, 3]), ("QUAD4", [1, 2, 5, 4])]
COMPONENTS = ["SIXX", "SIYY", "SIZZ", "SIXY"]
GAUSS = [(i, j) for j in (-1 / np.sqrt(3), 1 / np.sqrt(3)) for i in (-1 / np.sqrt(3), 1 / np.sqrt(3))]


def stress(x, y, instant):
    """A field that is linear in space: extrapolation is exact."""
    return [instant * (1 + 2 * x - y), instant * 3 * y, -instant, instant * x]


def at_gauss_points(instant):
    values = [stress(0.5 + cell + 0.5 * x, 0.5 + 0.5 * y, instant) for cell in (0, 1) for x, y in GAUSS]
    return {"quantity": "SIEF_R", "location": "ELGA", "components": COMPONENTS, "support": [2, 3], "offset": [0, 4, 8], "values": values}


class CalcChamp(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", POINTS, CELLS, cell_groups={"SKIN": [0, 1], "LEFT": [2], "NONE": []})
        self.write_result("result_2", "mesh_1", [0.0, 0.5, 1.0], {"SIEF_ELGA": {k: at_gauss_points(t) for k, t in enumerate((0.0, 0.5, 1.0))}},
                          label="RESU")

    def run_on(self, keywords, result="result_2", reuse=True):
        return self.run_command("CALC_CHAMP", {"RESULTAT": concept("result_2"), **keywords}, result=result, reuse=reuse, label="RESU")

    def test_a_linear_stress_is_exact_at_nodes_at_every_instant(self):
        run = self.run_on({"CONTRAINTE": "SIEF_NOEU"})
        self.assertEqual((run.status, run.messages), (0, []), run.stderr)
        for order, instant in enumerate((0.0, 0.5, 1.0)):
            field = self.read_field("result_2", "SIEF_NOEU", order)
            self.assertEqual(field.components, COMPONENTS)
            self.assertEqual(field.attributes["location"], "NOEU")
            self.assertEqual(field.attributes["instant"], instant)
            np.testing.assert_array_equal(field.support, range(6))
            np.testing.assert_allclose(field.values, [stress(x, y, instant) for x, y in POINTS], atol=1e-14)

    def test_the_result_is_enriched_and_keeps_what_it_had(self):
        before = self.read_field("result_2", "SIEF_ELGA", 2).values
        self.run_on({"CONTRAINTE": ["SIEF_ELNO", "SIEF_NOEU"]})
        self.assertEqual(self.attributes("result_2")["version"], 2)
        np.testing.assert_array_equal(self.read_field("result_2", "SIEF_ELGA", 2).values, before)
        field = self.read_field("result_2", "SIEF_ELNO", 2)
        np.testing.assert_array_equal(field.support, [2, 3])
        np.testing.assert_array_equal(field.offset, [0, 4, 8])
        nodes = [n for kind, members in CELLS[2:] for n in members]
        np.testing.assert_allclose(field.values, [stress(*POINTS[n], 1.0) for n in nodes], atol=1e-14)

    def test_what_is_archived_stays_whole_where_a_group_alone_is_asked_for(self):
        """A result of elastic laws, which has no internal variables."""
        run = self.run_on({"CONTRAINTE": ["SIEF_ELGA", "SIEF_NOEU"], "GROUP_MA": "LEFT"})
        self.assertEqual(run.status, 0, run.stderr)
        np.testing.assert_array_equal(self.read_field("result_2", "SIEF_ELGA", 2).support, [2, 3])

    def test_only_what_is_asked_for_is_stored(self):
        self.run_on({"CONTRAINTE": "SIEF_NOEU", "INST": [1.0]})
        with self.assertRaises(KeyError):
            self.read_field("result_2", "SIEF_ELNO", 2)
        with self.assertRaises(ValueError):
            self.read_field("result_2", "SIEF_NOEU", 1)

    def test_a_group_of_cells_is_all_that_counts(self):
        self.run_on({"CONTRAINTE": "SIEF_NOEU", "GROUP_MA": "LEFT", "NUME_ORDRE": [2]})
        np.testing.assert_array_equal(self.read_field("result_2", "SIEF_NOEU", 2).support, [0, 1, 3, 4])

    def test_without_reuse_a_new_result_has_the_fields_asked_for(self):
        before = self.snapshot()
        run = self.run_on({"CONTRAINTE": ["SIEF_ELGA", "SIEF_NOEU"], "INST": [0.5]}, result="result_3", reuse=False)
        self.assertEqual(run.status, 0, run.stderr)
        after = self.snapshot()
        self.assertEqual({name: after[name] for name in before}, before)
        np.testing.assert_allclose(self.read_field("result_3", "SIEF_NOEU", 1).values, [stress(x, y, 0.5) for x, y in POINTS], atol=1e-14)
        with self.assertRaises(ValueError):
            self.read_field("result_3", "SIEF_ELGA", 2)

    def test_instants_without_stresses_are_left_alone_unless_named(self):
        self.write_result("result_2", "mesh_1", [0.0, 1.0], {"SIEF_ELGA": {1: at_gauss_points(1.0)}}, label="RESU")
        run = self.run_on({"CONTRAINTE": "SIEF_NOEU"})
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(len(self.read_field("result_2", "SIEF_NOEU", 1).support), 6)
        self.write_result("result_2", "mesh_1", [0.0, 1.0], {"SIEF_ELGA": {1: at_gauss_points(1.0)}}, label="RESU")
        self.refuses("CALCCHAMP_1", {"CONTRAINTE": "SIEF_NOEU", "NUME_ORDRE": [0]}, "RESU", "order 0")

    def refuses(self, identifier, keywords, *words):
        self.assert_refuses(identifier, "CALC_CHAMP", {"RESULTAT": concept("result_2"), **keywords}, *words, result="result_2", reuse=True)

    def test_a_result_without_stresses_is_refused(self):
        self.write_result("result_2", "mesh_1", [0.0, 1.0], {}, label="RESU")
        self.refuses("CALCCHAMP_1", {"CONTRAINTE": "SIEF_NOEU"}, "RESU", "SIEF_NOEU")
        self.refuses("CALCCHAMP_1", {"DEFORMATION": "EPSI_NOEU"}, "DEPL", "EPSI_NOEU")
        self.refuses("CALCCHAMP_1", {"VARI_INTERNE": "VARI_NOEU"}, "SIEF_ELGA", "VARI_NOEU")

    def test_internal_variables_go_to_nodes_as_stresses_do(self):
        variables = {**at_gauss_points(1.0), "quantity": "VARI_R", "components": ["V1", "V2", "V3", "V4"]}
        self.write_result("result_2", "mesh_1", [0.0, 1.0], {"VARI_ELGA": {1: variables}}, label="RESU")
        run = self.run_on({"VARI_INTERNE": ["VARI_ELNO", "VARI_NOEU"]})
        self.assertEqual(run.status, 0, run.stderr)
        np.testing.assert_allclose(self.read_field("result_2", "VARI_NOEU", 1).values, [stress(x, y, 1.0) for x, y in POINTS], atol=1e-14)

    def test_a_result_whose_laws_have_no_internal_variables_has_zeros(self):
        run = self.run_on({"VARI_INTERNE": ["VARI_ELGA", "VARI_ELNO", "VARI_NOEU"], "NUME_ORDRE": [1]})
        self.assertEqual(run.status, 0, run.stderr)
        for name, like in (("VARI_ELGA", "SIEF_ELGA"), ("VARI_ELNO", ""), ("VARI_NOEU", "")):
            field = self.read_field("result_2", name, 1)
            self.assertEqual((field.components, field.quantity if hasattr(field, "quantity") else "VARI_R"), (["V1"], "VARI_R"))
            self.assertTrue(len(field.values) and (field.values == 0).all())
            if like:
                np.testing.assert_array_equal(field.support, self.read_field("result_2", like, 1).support)

    def test_internal_variables_that_were_not_kept_are_no_zeros(self):
        """ARCHIVAGE/CHAM_EXCLU='VARI_ELGA' of a plastic computation."""
        self.write_model("model_3", "mesh_1", ["D_PLAN/SEG2", "D_PLAN/QUAD4"], [0, 0, 1, 1])
        for relation, zero in (("ELAS", True), ("VMIS_ISOT_LINE", False)):
            self.write_result("result_2", "mesh_1", [0.0, 1.0], {"SIEF_ELGA": {1: at_gauss_points(1.0)}}, label="RESU", model="model_3",
                              behaviour=json.dumps([{"RELATION": relation, "DEFORMATION": "PETIT", "GROUP_MA": ["LEFT"]}]))
            if zero:
                run = self.run_on({"VARI_INTERNE": "VARI_ELNO"})
                self.assertEqual(run.status, 0, run.stderr)
            else:
                self.refuses("CALCCHAMP_1", {"VARI_INTERNE": "VARI_ELNO"}, "VARI_ELGA", "VARI_ELNO")

    def test_cells_without_stresses_are_refused(self):
        self.refuses("CALCCHAMP_2", {"CONTRAINTE": "SIEF_NOEU", "GROUP_MA": "SKIN"}, "SKIN")

    def test_unknown_and_empty_groups_are_refused(self):
        self.refuses("MESH_1", {"CONTRAINTE": "SIEF_NOEU", "GROUP_MA": "RIGHT"}, "RIGHT")
        self.refuses("MESH_2", {"CONTRAINTE": "SIEF_NOEU", "GROUP_MA": "NONE"}, "NONE")

    def test_instants_that_are_not_there_are_refused(self):
        self.refuses("FIELDS_1", {"CONTRAINTE": "SIEF_NOEU", "NUME_ORDRE": [7]}, "order 7")
        self.refuses("FIELDS_2", {"CONTRAINTE": "SIEF_NOEU", "INST": [0.7]}, "0.7")
        self.refuses("FIELDS_3", {"CONTRAINTE": "SIEF_NOEU", "INST": [0.5], "PRECISION": 0.6, "CRITERE": "ABSOLU"}, "0.5")

    def test_a_list_of_instants_is_a_concept(self):
        with self.create("list_of_reals_4", "list_of_reals") as file:
            file["values"] = np.array([0.5, 1.0])
        self.run_on({"CONTRAINTE": "SIEF_NOEU", "LIST_INST": concept("list_of_reals_4")})
        self.assertEqual(len(self.read_field("result_2", "SIEF_NOEU", 1).support), 6)


#: a distorted cell of each modelisation: points, cell, gradient of a linear displacement u = H x
SHAPES = {
    "D_PLAN": ([(0, 0), (1.2, 0.1), (1.0, 1.1), (-0.1, 0.9)], "QUAD4", [[0.02, 0.05], [-0.03, 0.04]]),
    "C_PLAN": ([(0, 0), (1.2, 0.1), (1.0, 1.1), (-0.1, 0.9)], "QUAD4", [[0.02, 0.05], [-0.03, 0.04]]),
    "AXIS": ([(1, 0), (2.2, 0.1), (2.0, 1.1), (0.9, 0.9)], "QUAD4", [[0.02, 0.0], [-0.03, 0.04]]),
    "3D": ([(0, 0, 0), (1.1, 0, 0.1), (0, 0.9, 0), (0.1, 0.2, 1.3)], "TETRA4", [[0.02, 0.05, 0.01], [-0.03, 0.04, 0.02], [0.06, 0, -0.01]]),
}
NU = 0.3


class Strains(OperatorTest):
    """A linear displacement has a constant gradient: strains are exact at every point."""

    def calculate(self, modelisation, keywords):
        points, kind, gradient = SHAPES[modelisation]
        points, gradient = np.array(points, float), np.array(gradient)
        dimension = points.shape[1]
        self.write_mesh("mesh_1", points, [(kind, list(range(4)))])
        self.write_model("model_2", "mesh_1", [f"{modelisation}/{kind}"], [0], dimension)
        self.write_material("material_3", ELAS={"E": 1.0, "NU": NU})
        self.write_material_field("material_field_4", "mesh_1", ["material_3"], [0])
        displacement = {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX", "DY", "DZ"][:dimension], "support": range(4),
                        "values": points @ gradient.T}
        self.write_result("result_5", "mesh_1", [1.0], {"DEPL": {0: displacement}}, model="model_2", material_field="material_field_4")
        run = self.run_command("CALC_CHAMP", {"RESULTAT": concept("result_5"), **keywords}, result="result_5", reuse=True)
        self.assertEqual(run.status, 0, run.stderr)
        h = np.zeros((3, 3))
        h[:dimension, :dimension] = gradient
        if modelisation == "AXIS":
            h[2, 2] = gradient[0, 0]  # u_r = h r
        small, green = (h + h.T) / 2, (h + h.T + h.T @ h) / 2
        if modelisation == "C_PLAN":
            for strain in (small, green):
                strain[2, 2] = -NU / (1 - NU) * (strain[0, 0] + strain[1, 1])
        return small, green

    def test_strains_are_exact_in_every_modelisation(self):
        for modelisation in SHAPES:
            with self.subTest(modelisation):
                small, green = self.calculate(modelisation, {"DEFORMATION": ["EPSI_ELGA", "EPSI_NOEU", "EPSG_ELNO", "EPSG_NOEU"]})
                for name, tensor in (("EPSI_ELGA", small), ("EPSI_NOEU", small), ("EPSG_ELNO", green), ("EPSG_NOEU", green)):
                    field = self.read_field("result_5", name, 0)
                    for component, values in zip(field.components, field.values.T):
                        axes = ["XYZ".index(letter) for letter in component[2:]]
                        np.testing.assert_allclose(values, tensor[axes[0], axes[1]], rtol=0, atol=1e-15, err_msg=f"{name} {component}")

    def test_invariants_of_strains(self):
        small, green = self.calculate("3D", {"CRITERES": ["EPEQ_ELGA", "EPGQ_NOEU"]})
        for name, tensor in (("EPEQ_ELGA", small), ("EPGQ_NOEU", green)):
            field = self.read_field("result_5", name, 0)
            got = dict(zip(field.components, field.values[0]))
            deviator = tensor - np.trace(tensor) / 3 * np.eye(3)
            self.assertAlmostEqual(got["INVA_2"], np.sqrt(2 / 3 * (deviator**2).sum()), 14)
            np.testing.assert_allclose([got[f"PRIN_{k}"] for k in (1, 2, 3)], np.linalg.eigvalsh(tensor), atol=1e-15)

    def test_plane_stress_with_plasticity_takes_the_volume_from_the_stresses(self):
        """Uniaxial tension s: e_zz = -nu s / E - p / 2 with the plastic strain p along x."""
        young, s, p = 1.0, 0.004, 0.03
        across = -NU * s / young - p / 2
        points = np.array(SHAPES["C_PLAN"][0], float)
        self.write_mesh("mesh_1", points, [("QUAD4", list(range(4)))])
        self.write_model("model_2", "mesh_1", ["C_PLAN/QUAD4"], [0])
        self.write_material("material_3", ELAS={"E": young, "NU": NU})
        self.write_material_field("material_field_4", "mesh_1", ["material_3"], [0])
        displacement = {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX", "DY"], "support": range(4), "values": points * [s / young + p, across]}
        stress = {"quantity": "SIEF_R", "location": "ELGA", "components": COMPONENTS, "support": [0], "offset": [0, 4], "values": [(s, 0, 0, 0)] * 4}
        self.write_result("result_5", "mesh_1", [1.0], {"DEPL": {0: displacement}, "SIEF_ELGA": {0: stress}}, model="model_2", material_field="material_field_4")
        with h5py.File(self.path("result_5"), "a") as file:
            file.attrs["behaviour"] = json.dumps([{"RELATION": "VMIS_ISOT_LINE", "DEFORMATION": "PETIT"}])
        run = self.run_command("CALC_CHAMP", {"RESULTAT": concept("result_5"), "DEFORMATION": ["EPSI_ELGA"]}, result="result_5", reuse=True)
        self.assertEqual(run.status, 0, run.stderr)
        np.testing.assert_allclose(self.read_field("result_5", "EPSI_ELGA", 0).values, [(s / young + p, across, across, 0)] * 4, atol=1e-16)
        self.assert_refuses("CALCCHAMP_3", "CALC_CHAMP", {"RESULTAT": concept("result_5"), "DEFORMATION": ["EPSG_NOEU"]}, "M1", result="result_5", reuse=True)

    def test_a_cell_turned_inside_out_by_its_displacements_is_refused_where_forces_are_wanted(self):
        points = np.array(SHAPES["D_PLAN"][0], float)
        self.write_mesh("mesh_1", points, [("QUAD4", list(range(4)))])
        self.write_model("model_2", "mesh_1", ["D_PLAN/QUAD4"], [0])
        displacement = {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX", "DY"], "support": range(4),
                        "values": points * [-2.0, 0.0]}
        stress = {"quantity": "SIEF_R", "location": "ELGA", "components": COMPONENTS, "support": [0], "offset": [0, 4], "values": np.ones((4, 4))}
        self.write_result("result_5", "mesh_1", [1.0], {"DEPL": {0: displacement}, "SIEF_ELGA": {0: stress}}, model="model_2")
        run = self.run_command("CALC_CHAMP", {"RESULTAT": concept("result_5"), "FORCE": ["FORC_NODA"]}, result="result_5", reuse=True)
        self.assertEqual(run.status, 0, run.stderr)  # small strains: forces on the initial geometry
        with h5py.File(self.path("result_5"), "a") as file:
            stages = json.loads(file.attrs["stages"])
            stages[0]["behaviour"] = [{"RELATION": "ELAS", "DEFORMATION": "GREEN_LAGRANGE"}]
            file.attrs["stages"] = json.dumps(stages)
        self.assert_refuses("FIELDS_4", "CALC_CHAMP", {"RESULTAT": concept("result_5"), "FORCE": ["FORC_NODA"]}, "M1", result="result_5", reuse=True)


class Invariants(OperatorTest):
    def test_invariants_of_stresses_are_those_of_numpy(self):
        rng = np.random.default_rng(7)
        tensors = rng.normal(size=(4, 3, 3))
        tensors = tensors + tensors.transpose(0, 2, 1)
        tensors[3] = -2.5 * np.eye(3)  # no deviator
        components = ["SIXX", "SIYY", "SIZZ", "SIXY", "SIXZ", "SIYZ"]
        values = [[t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[0, 2], t[1, 2]] for t in tensors]
        self.write_mesh("mesh_1", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [("TETRA4", [k, (k + 1) % 4, (k + 2) % 4, (k + 3) % 4]) for k in range(4)])
        stress = {"quantity": "SIEF_R", "location": "ELGA", "components": components, "support": range(4), "offset": range(5), "values": values}
        self.write_result("result_2", "mesh_1", [0.0], {"SIEF_ELGA": {0: stress}})
        run = self.run_command("CALC_CHAMP", {"RESULTAT": concept("result_2"), "CRITERES": ["SIEQ_ELGA", "SIEQ_ELNO", "SIEQ_NOEU"],
                                              "CONTRAINTE": ["SIGM_NOEU"]}, result="result_2", reuse=True)
        self.assertEqual(run.status, 0, run.stderr)
        field = self.read_field("result_2", "SIEQ_ELGA", 0)
        for tensor, row in zip(tensors, field.values):
            got = dict(zip(field.components, row))
            principal, deviator = np.linalg.eigvalsh(tensor), tensor - np.trace(tensor) / 3 * np.eye(3)
            mises = np.sqrt(1.5 * (deviator**2).sum())
            np.testing.assert_allclose([got["PRIN_1"], got["PRIN_2"], got["PRIN_3"]], principal, atol=1e-14)
            self.assertAlmostEqual(got["VMIS"], mises, 13)
            self.assertAlmostEqual(got["TRESCA"], principal[2] - principal[0], 13)
            self.assertAlmostEqual(got["VMIS_SG"], mises * np.sign(np.trace(tensor)), 13)
            self.assertAlmostEqual(got["TRSIG"], np.trace(tensor), 13)
            self.assertAlmostEqual(got["TRIAX"], np.trace(tensor) / 3 / mises if mises > 0 else 0, 12)
            for k, value in enumerate(principal, 1):
                vector = np.array([got[f"VECT_{k}_{axis}"] for axis in "XYZ"])
                np.testing.assert_allclose(tensor @ vector, value * vector, atol=1e-13)
                self.assertAlmostEqual(np.linalg.norm(vector), 1, 14)
                self.assertGreater(vector[np.argmax(abs(vector))], 0)
        # one point a cell: at its nodes the same, at nodes the mean over the four cells (of VMIS, not VMIS of the mean)
        nodes = self.read_field("result_2", "SIEQ_NOEU", 0)
        np.testing.assert_allclose(nodes.values, np.tile(field.values.mean(0), (4, 1)), atol=1e-13)
        np.testing.assert_allclose(self.read_field("result_2", "SIGM_NOEU", 0).values, np.tile(np.mean(values, 0), (4, 1)), atol=1e-14)


if __name__ == "__main__":
    unittest.main()
