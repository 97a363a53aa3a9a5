"""AFFE_MATERIAU alone, on bases made by hand."""

import h5py

from lacon_test import OperatorTest, concept, text

COORDINATES = [[0, 0], [1, 0], [1, 1], [0, 1], [2, 0]]
CELLS = [("QUAD4", [0, 1, 2, 3]), ("TRIA3", [1, 4, 2]), ("SEG2", [0, 1])]
GROUPS = {"LEFT": [0], "RIGHT": [1], "EMPTY": []}


class AffeMateriau(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", COORDINATES, CELLS, cell_groups=GROUPS)
        self.write_model("model_2", "mesh_1", ["D_PLAN/QUAD4", "D_PLAN/TRIA3"], [0, 1, -1])
        self.write_material("mater_3", ELAS={"E": 1.0, "NU": 0.3})
        self.write_material("mater_4", ELAS={"E": 2.0, "NU": 0.3})

    def run_affe(self, **keywords):
        return self.run_command("AFFE_MATERIAU", keywords, result="field_5")

    def materials(self):
        with h5py.File(self.path("field_5")) as file:
            names = [text(n) for n in file["materials"][()]]
            return [names[i] if i >= 0 else None for i in file["cells/material"][()]]

    def test_the_later_occurrence_wins(self):
        run = self.run_affe(MAILLAGE=concept("mesh_1"), AFFE=[{"TOUT": "OUI", "MATER": concept("mater_3")},
                                                              {"GROUP_MA": ["RIGHT"], "MATER": concept("mater_4")}])
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(self.materials(), ["mater_3", "mater_4", "mater_3"])
        self.assertEqual((self.attributes("field_5")["mesh"], self.attributes("field_5")["model"]), ("mesh_1", ""))

    def test_cells_that_no_occurrence_names_have_no_material(self):
        self.run_affe(MAILLAGE=concept("mesh_1"), AFFE=[{"GROUP_MA": ["LEFT"], "MATER": concept("mater_4")}])
        self.assertEqual(self.materials(), ["mater_4", None, None])

    def test_the_model_alone_tells_the_mesh(self):
        self.assertEqual(self.run_affe(MODELE=concept("model_2"), AFFE=[{"TOUT": "OUI", "MATER": concept("mater_3")}]).status, 0)
        self.assertEqual((self.attributes("field_5")["mesh"], self.attributes("field_5")["model"]), ("mesh_1", "model_2"))

    def refuses(self, identifier, *words, **keywords):
        self.assert_refuses(identifier, "AFFE_MATERIAU", keywords, *words, result="field_5")

    def test_a_model_on_another_mesh_is_refused(self):
        self.write_mesh("mesh_6", COORDINATES, CELLS, cell_groups=GROUPS)
        self.refuses("MATERIAU_1", "MESH_1", "MESH_6", MAILLAGE=concept("mesh_6"), MODELE=concept("model_2"),
                     AFFE=[{"TOUT": "OUI", "MATER": concept("mater_3")}])

    def test_groups_must_exist_and_have_cells(self):
        for identifier, group in (("MESH_1", "LEFF"), ("MESH_2", "EMPTY")):
            self.refuses(identifier, group, MAILLAGE=concept("mesh_1"), AFFE=[{"GROUP_MA": [group], "MATER": concept("mater_3")}])

    def test_the_material_must_be_one(self):
        self.refuses("BASE_4", "model_2", MAILLAGE=concept("mesh_1"), AFFE=[{"TOUT": "OUI", "MATER": concept("model_2")}])


del OperatorTest

if __name__ == "__main__":
    import unittest

    unittest.main()
