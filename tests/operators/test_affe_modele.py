"""AFFE_MODELE alone, on bases made by hand."""

import h5py
import numpy as np

from lacon_test import OperatorTest, concept, text

# a quadrangle, a triangle on its right, their lower skin; a point
COORDINATES = [[0, 0], [1, 0], [1, 1], [0, 1], [2, 0]]
CELLS = [("QUAD4", [0, 1, 2, 3]), ("TRIA3", [1, 4, 2]), ("SEG2", [0, 1]), ("SEG2", [1, 4]), ("POI1", [4])]
GROUPS = {"LEFT": [0], "RIGHT": [1], "SKIN": [2, 3], "POINT": [4], "EMPTY": []}


def affe(**more):
    return {"PHENOMENE": "MECANIQUE", "MODELISATION": "D_PLAN", **more}


class AffeModele(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", COORDINATES, CELLS, cell_groups=GROUPS)

    def model(self, *occurrences, mesh="mesh_1", **more):
        return self.run_command("AFFE_MODELE", {"MAILLAGE": concept(mesh), "AFFE": list(occurrences)}, result="model_2", **more)

    def elements(self):
        """Name of each cell's element, or None."""
        with h5py.File(self.path("model_2")) as file:
            names = [text(n) for n in file["elements"][()]]
            return [names[i] if i >= 0 else None for i in file["cells/element"][()]]

    def refuses(self, identifier, occurrences, *words, mesh="mesh_1"):
        return self.assert_refuses(identifier, "AFFE_MODELE", {"MAILLAGE": concept(mesh), "AFFE": occurrences}, *words, result="model_2")

    def test_every_cell_that_has_a_row_gets_its_element(self):
        run = self.model(affe(TOUT="OUI"))
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(self.elements(), ["D_PLAN/QUAD4", "D_PLAN/TRIA3", "D_PLAN/SEG2", "D_PLAN/SEG2", None])
        head = self.attributes("model_2")
        self.assertEqual((head["mesh"], head["phenomenon"], head["dimension"]), ("mesh_1", "MECANIQUE", 2))

    def test_cells_without_element_are_told_and_raise_no_alarm(self):
        run = self.model(affe(TOUT="OUI"))
        self.assertEqual(self.ids(run), ["MODELE_5"])
        self.assertIn("1 POI1", run.messages[0]["text"])
        self.assertEqual(self.ids(run, "A"), [])

    def test_only_the_groups_that_are_named_get_elements(self):
        self.model(affe(GROUP_MA=["LEFT"]), affe(GROUP_MA=["SKIN"]))
        self.assertEqual(self.elements(), ["D_PLAN/QUAD4", None, "D_PLAN/SEG2", "D_PLAN/SEG2", None])

    def test_a_model_without_body_raises_an_alarm(self):
        for case in (affe(GROUP_MA=["SKIN"]), affe(GROUP_MA=["LEFT", "RIGHT"], MODELISATION="3D")):  # faces of no body
            self.assertEqual(self.ids(self.model(case), "A"), ["MODELE_7"])
            self.path("model_2").unlink()

    def test_a_plug_in_brings_a_modelisation_and_the_later_occurrence_wins(self):
        folder = self.folder / "plugins" / "stiff"
        folder.mkdir(parents=True)
        (folder / "plugin.toml").write_text(
            '[[element]]\nmodelisation = "RIGIDE"\nphenomenon = "MECANIQUE"\nrole = "solid"\n'
            'geometry = "plane"\nstress_state = "plane_strain"\npoints = { QUAD4 = 4 }\n'
            'dofs = ["DX", "DY"]\nstress = ["SIXX", "SIYY", "SIZZ", "SIXY"]\n'
            'kernels = { "ELAS/PETIT" = "solid/plane_strain_small_elastic" }\n', encoding="utf-8")
        self.model(affe(TOUT="OUI"), affe(GROUP_MA=["LEFT"], MODELISATION="RIGIDE"), plugins=[folder.parent])
        self.assertEqual(self.elements()[:2], ["RIGIDE/QUAD4", "D_PLAN/TRIA3"])
        self.path("model_2").unlink()
        self.model(affe(GROUP_MA=["LEFT"], MODELISATION="RIGIDE"), affe(TOUT="OUI"), environment={"LACON_PLUGIN_PATH": str(folder)})
        self.assertEqual(self.elements()[:2], ["D_PLAN/QUAD4", "D_PLAN/TRIA3"])

    def test_an_unknown_modelisation_is_refused_with_the_known_ones(self):
        run = self.refuses("MODELE_1", [affe(TOUT="OUI", MODELISATION="COQUE_3D")], "'COQUE_3D'", "AFFE/MODELISATION")
        self.assertIn("D_PLAN", run.messages[0]["do"])

    def test_an_occurrence_that_gives_nothing_is_refused(self):
        run = self.refuses("MODELE_2", [affe(TOUT="OUI"), affe(GROUP_MA=["POINT"])], "AFFE[2]", "1 POI1")
        self.assertIn("QUAD4", run.messages[0]["do"])

    def test_a_body_cell_that_the_modelisation_has_no_element_for_is_refused_unless_another_serves_it(self):
        """D_PLAN_SI: a linear quadrangle would have one point."""
        self.refuses("MODELE_8", [affe(TOUT="OUI", MODELISATION="D_PLAN_SI")], "D_PLAN_SI", "QUAD4", "M1")
        run = self.model(affe(TOUT="OUI", MODELISATION="D_PLAN_SI"), affe(GROUP_MA=["LEFT"]))
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(self.elements()[:3], ["D_PLAN/QUAD4", "D_PLAN_SI/TRIA3", "D_PLAN_SI/SEG2"])

    def test_a_mesh_beyond_the_axis_of_revolution_is_refused(self):
        for shift, refused in ((0, False), (-1e-8, False), (-0.25, True)):  # round-off is no side of the axis
            self.write_mesh("mesh_3", np.array(COORDINATES) + [shift, 0], CELLS, cell_groups=GROUPS)
            occurrences = [affe(TOUT="OUI", MODELISATION="AXIS")]
            if refused:
                self.refuses("MODELE_9", occurrences, "AXIS", "N1", "M1", "X = -0.25", mesh="mesh_3")
            else:
                run = self.run_command("AFFE_MODELE", {"MAILLAGE": concept("mesh_3"), "AFFE": occurrences}, result="model_2")
                self.assertEqual(run.status, 0, run.stderr)
                self.path("model_2").unlink()

    def test_a_mesh_of_space_is_refused_under_plane_strain(self):
        lifted = np.column_stack([COORDINATES, [0, 0, 0, 0, 0.1]])
        self.write_mesh("mesh_3", lifted, CELLS, cell_groups=GROUPS)
        self.refuses("MODELE_3", [affe(TOUT="OUI")], "N5", "M2", "0.1", mesh="mesh_3")

    def test_a_flat_mesh_in_space_is_welcome(self):
        self.write_mesh("mesh_3", np.column_stack([COORDINATES, np.zeros(5)]), CELLS, cell_groups=GROUPS)
        self.assertEqual(self.model(affe(TOUT="OUI"), mesh="mesh_3").status, 0)

    def misfit(self, coordinates, cells, modelisation="D_PLAN", **groups):
        """The one message of a model on this mesh about cells that do not fit their neighbours: (severity, identifier, text)."""
        self.write_mesh("mesh_3", coordinates, cells, cell_groups=groups)
        run = self.model(affe(GROUP_MA=list(groups), MODELISATION=modelisation), mesh="mesh_3")
        self.assertEqual(run.status, 0, run.stderr)
        said, = [m for m in run.messages if m["id"] != "MODELE_5"]
        return said["severity"], said["id"], said["text"]

    def test_a_vertex_that_hangs_on_an_edge_is_told_with_its_place(self):
        points = [[0, 0], [2, 0], [2, 1], [0, 1], [1, 1], [0, 2], [1, 2], [2, 2]]
        said = self.misfit(points, [("QUAD4", [0, 1, 2, 3]), ("QUAD4", [3, 4, 6, 5]), ("QUAD4", [4, 2, 7, 6])], ALL=[0, 1, 2])
        self.assertEqual(said[:2], ("A", "MODELE_12"))
        self.assertIn("1 edges or faces", said[2])
        self.assertIn("QUAD4 M1 on the nodes N3 (2, 1), N4 (0, 1) has the node N5 (1, 1)", said[2])

    def test_only_cells_of_the_model_are_looked_at(self):
        points = [[0, 0], [2, 0], [2, 1], [0, 1], [1, 1], [0, 2], [1, 2], [2, 2]]
        self.write_mesh("mesh_3", points, [("QUAD4", [0, 1, 2, 3]), ("QUAD4", [3, 4, 6, 5]), ("QUAD4", [4, 2, 7, 6])],
                        cell_groups={"UP": [1, 2]})
        self.assertEqual(self.ids(self.model(affe(GROUP_MA=["UP"]), mesh="mesh_3")), ["MODELE_5"])

    def test_linear_beside_quadratic_cells_are_told(self):
        points = [[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1], [0.5, 0], [1, 0.5], [0.5, 1], [0, 0.5]]
        said = self.misfit(points, [("QUAD8", [0, 1, 2, 3, 6, 7, 8, 9]), ("QUAD4", [1, 4, 5, 2])], ALL=[0, 1])
        self.assertEqual(said[:2], ("A", "MODELE_10"))
        self.assertIn("between QUAD8 M1 and QUAD4 M2 on the nodes N2 (1, 0), N3 (1, 1)", said[2])

    def test_tetrahedra_on_a_hexahedron_are_told(self):
        points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [0.5, 0.5, 2]]
        said = self.misfit(points, [("HEXA8", range(8)), ("TETRA4", [4, 5, 6, 8]), ("TETRA4", [4, 6, 7, 8])], "3D", ALL=[0, 1, 2])
        self.assertEqual(said[:2], ("A", "MODELE_11"))
        self.assertIn("HEXA8 M1 on the nodes N5 (0, 0, 1)", said[2])

    def test_nodes_that_are_not_merged_are_told_without_alarm(self):
        points = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1], [1, 0]]
        said = self.misfit(points, [("QUAD4", [0, 1, 4, 3]), ("QUAD4", [6, 2, 5, 4])], ALL=[0, 1])
        self.assertEqual(said[:2], ("I", "MODELE_13"))
        self.assertIn("QUAD4 M1 and QUAD4 M2 at the nodes", said[2])

    def test_groups_must_exist_and_have_cells(self):
        self.refuses("MESH_1", [affe(GROUP_MA=["LEFF"])], "LEFF", "LEFT")
        self.refuses("MESH_2", [affe(GROUP_MA=["EMPTY"])], "EMPTY")

    def test_the_mesh_must_be_one(self):
        self.write_material("mater_4", ELAS={"E": 1.0, "NU": 0.3})
        self.refuses("BASE_4", [affe(TOUT="OUI")], "mater", mesh="mater_4")
        self.refuses("BASE_1", [affe(TOUT="OUI")], "mesh_9", mesh="mesh_9")


del OperatorTest  # it has no tests of its own

if __name__ == "__main__":
    import unittest

    unittest.main()
