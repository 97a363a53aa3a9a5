"""AFFE_CARA_ELEM alone, on bases made by hand."""

import h5py
import numpy as np

from lacon_test import OperatorTest, concept

COORDINATES = [[0, 0, 0], [3, 4, 0], [1, 0, 0], [1, 0, 0]]
CELLS = [("POI1", [0]), ("SEG2", [0, 1]), ("SEG2", [2, 3]), ("TETRA4", [0, 1, 2, 3])]
GROUPS = {"POINT": [0], "LINK": [1], "SHORT": [2], "BODY": [3]}


class AffeCaraElem(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", COORDINATES, CELLS, cell_groups=GROUPS, dimension=3)
        self.write_model("model_2", "mesh_1", ["DIS_T/POI1", "DIS_T/SEG2", "3D/TETRA4"], [0, 1, 1, 2], dimension=3)

    def springs(self, *occurrences, keyword="DISCRET"):
        """(first, second, whole matrix) of each spring."""
        run = self.run_command("AFFE_CARA_ELEM", {"MODELE": concept("model_2"), keyword: list(occurrences)}, result="element_characteristics_3")
        self.assertEqual(run.status, 0, run.stderr)
        with h5py.File(self.path("element_characteristics_3")) as file:
            rows = zip(*(file[f"springs/{name}"][()].tolist() for name in ("first", "second", "stiffness")))
            return [(a, b, [[k[0], k[1], k[3]], [k[1], k[2], k[4]], [k[3], k[4], k[5]]]) for a, b, k in rows]

    def refuses(self, identifier, *words, keyword="DISCRET", **occurrence):
        self.assert_refuses(identifier, "AFFE_CARA_ELEM", {"MODELE": concept("model_2"), keyword: [occurrence]}, *words,
                            result="element_characteristics_3")

    def test_a_point_is_held_along_the_axes_or_by_a_whole_matrix(self):
        self.assertEqual(self.springs({"GROUP_MA": ["POINT"], "CARA": "K_T_D_N", "VALE": [1.0, 2.0, 3.0]}),
                         [(0, -1, [[1, 0, 0], [0, 2, 0], [0, 0, 3]])])
        self.assertEqual(self.springs({"GROUP_MA": ["POINT"], "CARA": "K_T_N", "VALE": [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]}),
                         [(0, -1, [[1, 2, 4], [2, 3, 5], [4, 5, 6]])])

    def test_a_line_joins_its_nodes(self):
        self.assertEqual(self.springs({"GROUP_MA": ["LINK"], "CARA": "K_T_D_L", "VALE": [1.0, 2.0, 3.0]}),
                         [(0, 1, [[1, 0, 0], [0, 2, 0], [0, 0, 3]])])

    def test_a_line_by_the_matrix_of_both_nodes(self):
        """S, -S, S are a spring between the nodes, in its own axes too; what holds a node beside, or joins otherwise, is none."""
        def triangle(first, between, second):
            whole = np.block([[first, between], [np.transpose(between), second]])
            return [whole[i, j] for j in range(6) for i in range(j + 1)]

        stiffness = np.array([[1.0, 2.0, 4.0], [2.0, 3.0, 5.0], [4.0, 5.0, 6.0]])
        link = {"GROUP_MA": ["LINK"], "CARA": "K_T_L"}
        self.assertEqual(self.springs({**link, "VALE": triangle(stiffness, -stiffness, stiffness)}), [(0, 1, stiffness.tolist())])
        along = np.diag([10.0, 2.0, 2.0])
        self.assertEqual(self.springs({**link, "VALE": triangle(along, -along, along), "REPERE": "LOCAL"}),
                         self.springs({"GROUP_MA": ["LINK"], "CARA": "K_T_D_L", "VALE": [10.0, 2.0, 2.0], "REPERE": "LOCAL"}))
        uneven = stiffness + np.triu(np.ones((3, 3)), 1)
        for blocks in ((stiffness, -2 * stiffness, stiffness), (stiffness, -stiffness, 2 * stiffness), (stiffness, -uneven, stiffness)):
            self.refuses("DISCRET_5", "VALE", **link, VALE=triangle(*blocks))
        self.refuses("DISCRET_4", **link, VALE=triangle(stiffness, -stiffness, stiffness), REPERE="LOCAL")
        self.refuses("DISCRET_3", "21", **link, VALE=[1.0, 2.0, 3.0])
        self.refuses("DISCRET_2", "K_T_L", GROUP_MA=["POINT"], CARA="K_T_L", VALE=triangle(along, -along, along))

    def test_along_the_cell(self):
        (_, _, matrix), = self.springs({"GROUP_MA": ["LINK"], "CARA": "K_T_D_L", "VALE": [10.0, 2.0, 2.0], "REPERE": "LOCAL"})
        along = np.array([0.6, 0.8, 0])
        np.testing.assert_allclose(matrix, 10 * np.outer(along, along) + 2 * (np.eye(3) - np.outer(along, along)), atol=1e-14)

    def test_the_later_occurrence_wins(self):
        (_, _, matrix), = self.springs(*({"GROUP_MA": ["POINT"], "CARA": "K_T_D_N", "VALE": [k, k, k]} for k in (1.0, 7.0)))
        self.assertEqual(matrix[0][0], 7)

    def test_what_does_not_fit_is_refused(self):
        self.refuses("DISCRET_1", "M4", "TETRA4", GROUP_MA=["BODY"], CARA="K_T_D_N", VALE=[1.0, 1.0, 1.0])
        self.refuses("DISCRET_1", "DIS_T/POI1", keyword="DISCRET_2D", GROUP_MA=["POINT"], CARA="K_T_D_N", VALE=[1.0, 1.0])
        self.refuses("DISCRET_2", "M2", GROUP_MA=["LINK"], CARA="K_T_D_N", VALE=[1.0, 1.0, 1.0])
        self.refuses("DISCRET_3", "2", "3", GROUP_MA=["POINT"], CARA="K_T_D_N", VALE=[1.0, 1.0])
        for group, values in (("SHORT", [1.0, 1.0, 1.0]), ("LINK", [1.0, 2.0, 3.0])):
            self.refuses("DISCRET_4", GROUP_MA=[group], CARA="K_T_D_L", VALE=values, REPERE="LOCAL")


if __name__ == "__main__":
    import unittest

    unittest.main()
