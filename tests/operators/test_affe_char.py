"""AFFE_CHAR_CINE and AFFE_CHAR_MECA alone, on bases made by hand."""

import h5py

from lacon_test import OperatorTest, concept, text

# Two quadrangles side by side, 3 x 1 nodes a row; node 7 (N7) belongs to no element.
COORDINATES = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1], [5, 5]]
CELLS = [
    ("QUAD4", [0, 1, 4, 3]), ("QUAD4", [1, 2, 5, 4]),
    ("SEG2", [5, 4]), ("SEG2", [4, 3]),  # top, outward
    ("SEG2", [1, 0]),                    # bottom left, inward
    ("SEG2", [1, 4]),                    # between the two
    ("SEG2", [0, 6]),                    # of no body
    ("SEG2", [2, 5]),                    # right: no element in the model
]
GROUPS = {"BODY": [0, 1], "TOP": [2, 3], "INWARD": [4], "BETWEEN": [5], "LOOSE": [6], "RIGHT": [7], "EMPTY": []}
NODES = {"CORNER": [0], "ALONE": [6], "BOTTOM": [0, 1, 2]}


class Loads(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", COORDINATES, CELLS, cell_groups=GROUPS, node_groups=NODES)
        self.write_model("model_2", "mesh_1", ["D_PLAN/QUAD4", "D_PLAN/SEG2"], [0, 0, 1, 1, 1, 1, 1, -1])
        self.write_model("model_3", "mesh_1", ["D_PLAN/QUAD4", "D_PLAN/SEG2"], [0, 0, 1, 1, 1, 1, -1, -1])

    def cine(self, *occurrences, model="model_3"):
        return self.run_command("AFFE_CHAR_CINE", {"MODELE": concept(model), "MECA_IMPO": list(occurrences)}, result="load_4")

    def meca(self, model="model_3", **keywords):
        return self.run_command("AFFE_CHAR_MECA", {"MODELE": concept(model), **keywords}, result="load_4")

    def imposed(self):
        """(node, component) -> value, and the number of rows."""
        with h5py.File(self.path("load_4")) as file:
            group = file["imposed"]
            names = [text(n) for n in group["component"][()]]
            rows = [((int(n), names[c]), v) for n, c, v in zip(group["node"][()], group["component_index"][()], group["value"][()])]
            self.assertEqual(len(dict(rows)), len(rows))
            return dict(rows)

    def pressure(self):
        with h5py.File(self.path("load_4")) as file:
            return dict(zip(file["pressure/cell"][()].tolist(), file["pressure/value"][()].tolist()))

    # ------------------------------------------------------------------------------------------ imposed displacements

    def test_displacements_of_groups_of_cells_of_nodes_and_of_nodes_by_name(self):
        run = self.cine({"GROUP_MA": ["TOP"], "DY": -1.0}, {"GROUP_NO": ["CORNER"], "DX": 0.0, "DY": 0.0}, {"NOEUD": ["N3"], "DY": 2.5})
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(self.imposed(), {(5, "DY"): -1, (4, "DY"): -1, (3, "DY"): -1, (0, "DX"): 0, (0, "DY"): 0, (2, "DY"): 2.5})
        self.assertEqual((self.attributes("load_4")["kind"], self.attributes("load_4")["model"]), ("cine", "model_3"))

    def test_tout_means_the_nodes_that_have_elements(self):
        self.cine({"TOUT": "OUI", "DX": 0.0})
        self.assertEqual(set(self.imposed()), {(n, "DX") for n in range(6)})

    def test_the_same_value_twice_is_one_row(self):
        self.meca(DDL_IMPO=[{"GROUP_MA": ["TOP"], "DX": 0.0}, {"NOEUD": ["N5"], "DX": 0.0}])
        self.assertEqual(len(self.imposed()), 3)
        self.assertEqual(self.attributes("load_4")["kind"], "meca")

    def refuses_imposed(self, identifier, occurrences, *words):
        for command, factor in (("AFFE_CHAR_CINE", "MECA_IMPO"), ("AFFE_CHAR_MECA", "DDL_IMPO")):
            self.assert_refuses(identifier, command, {"MODELE": concept("model_3"), factor: occurrences}, *words, result="load_4")

    def test_two_values_for_one_degree_of_freedom_are_refused(self):
        self.refuses_imposed("CHARGE_4", [{"GROUP_NO": ["BOTTOM"], "DX": 0.0}, {"NOEUD": ["N2"], "DX": 1.0}], "DX", "N2", "BOTTOM")

    def test_nodes_without_element_are_refused(self):
        self.refuses_imposed("CHARGE_2", [{"GROUP_NO": ["ALONE"], "DX": 0.0}], "N7", "ALONE")

    def test_degrees_of_freedom_that_a_node_lacks_are_refused(self):
        self.refuses_imposed("CHARGE_3", [{"GROUP_NO": ["CORNER"], "DZ": 0.0}], "DZ", "N1", "DX, DY")

    def test_unknown_nodes_and_groups_are_refused(self):
        for name in ("N8", "N0", "N01", "N-1", "A1", "N1x", "N", "N99999999999999999999"):
            self.refuses_imposed("CHARGE_1", [{"NOEUD": [name], "DX": 0.0}], name)
        self.refuses_imposed("MESH_1", [{"GROUP_MA": ["TOPP"], "DX": 0.0}], "TOPP", "TOP")
        self.refuses_imposed("MESH_1", [{"GROUP_NO": ["TOP"], "DX": 0.0}], "node", "TOP")
        self.refuses_imposed("MESH_2", [{"GROUP_MA": ["EMPTY"], "DX": 0.0}], "EMPTY")

    # ------------------------------------------------------------------------------------------ pressures

    def test_pressure_on_a_group(self):
        run = self.meca(PRES_REP=[{"GROUP_MA": ["TOP"], "PRES": 25.0}])
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(self.pressure(), {2: 25, 3: 25})
        self.assertEqual(self.ids(run), [])

    def test_the_same_pressure_twice_counts_once(self):
        self.meca(PRES_REP=[{"GROUP_MA": ["TOP"], "PRES": 25.0}, {"GROUP_MA": ["TOP"], "PRES": 25.0}])
        self.assertEqual(self.pressure(), {2: 25, 3: 25})

    def test_tout_means_every_skin_cell_of_the_model(self):
        self.meca(PRES_REP=[{"TOUT": "OUI", "PRES": 1.0}], VERI_NORM="NON")
        self.assertEqual(set(self.pressure()), {2, 3, 4, 5})

    def refuses_pressure(self, identifier, occurrences, *words):
        self.assert_refuses(identifier, "AFFE_CHAR_MECA", {"MODELE": concept("model_3"), "PRES_REP": occurrences}, *words, result="load_4")

    def test_two_pressures_for_one_cell_are_refused(self):
        self.refuses_pressure("CHARGE_5", [{"GROUP_MA": ["TOP"], "PRES": 1.0}, {"GROUP_MA": ["TOP"], "PRES": 2.0}], "M3", "1", "2")

    def test_cells_that_are_no_skin_of_the_model_are_refused(self):
        self.refuses_pressure("CHARGE_6", [{"GROUP_MA": ["BODY"], "PRES": 1.0}], "QUAD4", "M1", "BODY")
        self.refuses_pressure("CHARGE_6", [{"GROUP_MA": ["RIGHT"], "PRES": 1.0}], "SEG2", "M8")

    def test_a_skin_that_looks_into_its_body_is_refused_unless_told_otherwise(self):
        self.refuses_pressure("CHARGE_7", [{"GROUP_MA": ["INWARD"], "PRES": 1.0}], "M5", "INWARD")
        run = self.meca(PRES_REP=[{"GROUP_MA": ["INWARD"], "PRES": 1.0}], VERI_NORM="NON")
        self.assertEqual((run.status, self.pressure(), self.ids(run)), (0, {4: 1}, []))

    def test_a_loaded_skin_without_body_alarms(self):
        run = self.meca(model="model_2", PRES_REP=[{"GROUP_MA": ["LOOSE"], "PRES": 1.0}])
        self.assertEqual((run.status, self.ids(run)), (0, ["CHARGE_8"]))

    def test_a_skin_between_two_bodies_has_no_wrong_side(self):
        self.assertEqual(self.ids(self.meca(PRES_REP=[{"GROUP_MA": ["BETWEEN"], "PRES": 1.0}])), [])

    def test_orientation_goes_by_geometry_not_by_the_order_of_body_nodes(self):
        cells = [("QUAD4", [0, 3, 4, 1]), *CELLS[1:]]  # the left quadrangle inside out
        self.write_mesh("mesh_1", COORDINATES, cells, cell_groups=GROUPS, node_groups=NODES)
        self.assertEqual(self.meca(PRES_REP=[{"GROUP_MA": ["TOP"], "PRES": 1.0}]).status, 0)
        self.path("load_4").unlink()
        self.refuses_pressure("CHARGE_7", [{"GROUP_MA": ["INWARD"], "PRES": 1.0}], "M5")

    def test_displacements_and_pressures_share_a_load(self):
        self.meca(DDL_IMPO=[{"GROUP_NO": ["BOTTOM"], "DY": 0.0}], PRES_REP=[{"GROUP_MA": ["TOP"], "PRES": -3.0}])
        self.assertEqual((len(self.imposed()), self.pressure()), (3, {2: -3, 3: -3}))


del OperatorTest

if __name__ == "__main__":
    import unittest

    unittest.main()
