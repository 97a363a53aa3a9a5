"""calc_champ alone: a result by hand, fields at nodes out."""

import unittest

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


if __name__ == "__main__":
    unittest.main()
