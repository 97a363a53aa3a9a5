"""proj_champ alone: nodal fields by hand on one mesh in, on the nodes of another out. A field that is linear in space is exact inside."""

import unittest

import h5py
import numpy as np
from lacon_test import OperatorTest, concept

#: two squares [0, 1] and [1, 2] that touch, each with its own nodes, and points to go to: inside, on the seam, above
POINTS = [(0, 0), (1, 0), (1, 1), (0, 1), (1, 0), (2, 0), (2, 1), (1, 1)]
CELLS = [("QUAD4", [0, 1, 2, 3]), ("QUAD4", [4, 5, 6, 7])]
THERE = np.array([(0.25, 0.5), (1.5, 0.75), (1.0, 0.5), (0.5, 1.1)])


def linear(points):
    return 1 + 2 * points[:, 0] - 3 * points[:, 1]


class ProjChamp(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", POINTS, CELLS, cell_groups={"LEFT": [0], "RIGHT": [1]})
        self.write_mesh("mesh_2", THERE, [("POI1", [k]) for k in range(4)], cell_groups={"INSIDE": [0, 1], "SEAM": [2]}, node_groups={"ABOVE": [3]})
        values = linear(np.array(POINTS, float)) + 100 * np.repeat([0, 1], 4)  # the right square is 100 higher
        self.field = {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX"], "support": range(8)}
        self.write_result("result_3", "mesh_1", [0.0, 1.0], {"DEPL": {k: {**self.field, "values": k * values} for k in (0, 1)}}, label="RES")

    def project(self, **keywords):
        return self.run_command("PROJ_CHAMP", {"RESULTAT": concept("result_3"), "MAILLAGE_2": concept("mesh_2"), **keywords}, result="result_4")

    def values(self, run, order=1):
        """node -> value"""
        self.assertEqual(run.status, 0, run.stderr)
        field = self.read_field("result_4", "DEPL", order)
        return dict(zip(field.support.tolist(), field.values[:, 0].tolist()))

    def test_nodes_inside_have_the_value_and_outside_that_of_the_nearest_point(self):
        run = self.project()
        self.assertEqual(self.ids(run), ["PROJCHAMP_3"])
        found = self.values(run)
        exact = linear(THERE) + [0, 100, 0, 0]
        self.assertEqual(list(found), [0, 1, 2, 3])
        for node in (0, 1):
            self.assertAlmostEqual(found[node], exact[node], delta=1e-12)
        self.assertAlmostEqual(found[3], linear(np.array([(0.5, 1.0)]))[0], delta=1e-12)
        self.assertEqual(set(self.values(run, 0).values()), {0.0})

    def test_which_nodes_go_where(self):
        """The seam belongs to either square, as VIS_A_VIS says; nodes that it does not name, or that are too far away, get nothing."""
        for side, added in (("LEFT", 0), ("RIGHT", 100)):
            found = self.values(self.project(VIS_A_VIS=[{"GROUP_MA_1": side, "GROUP_MA_2": "SEAM"}]))
            self.assertEqual(list(found), [2])
            self.assertAlmostEqual(found[2], linear(THERE)[2] + added, delta=1e-12)
        self.assertEqual(list(self.values(self.project(DISTANCE_MAX=0.05))), [0, 1, 2])
        found = self.values(self.project(PROL_ZERO="OUI", VIS_A_VIS=[{"GROUP_MA_1": "RIGHT", "GROUP_MA_2": "SEAM"}]))
        self.assertEqual([found[node] for node in (0, 1, 3)], [0, 0, 0])
        self.assertAlmostEqual(found[2], linear(THERE)[2] + 100, delta=1e-12)
        run = self.project(DISTANCE_ALARME=0.2)
        self.assertEqual((run.status, self.ids(run)), (0, []))
        self.assertEqual(list(self.values(self.project(VIS_A_VIS=[{"GROUP_NO_2": "ABOVE"}], DISTANCE_ALARME=0.2))), [3])

    def test_a_node_on_a_node_has_its_value_where_the_others_of_the_cell_have_none(self):
        """A field of the lower nodes 0 and 1 (LAGS_C of a skin): node (0, 0) and the place (0.5, 0) between them get it, (0.5, 0.5) does not; a
        stand-in stays one."""
        self.write_mesh("mesh_5", [(0, 0), (0.5, 0), (0.5, 0.5)], [("POI1", [k]) for k in range(3)])
        for kind in (1, 2):
            skin = {**self.field, "support": [0, 1], "values": [4.0, 6.0], "present": [kind, kind]}
            self.write_result("result_3", "mesh_1", [0.0], {"DEPL": {0: skin}}, label="RES")
            run = self.project(MAILLAGE_2=concept("mesh_5"))
            self.assertEqual(self.values(run, 0), {0: 4.0, 1: 5.0})
            present = self.read_field("result_4", "DEPL", 0).present
            self.assertEqual([1, 1] if present is None else present.ravel().tolist(), [kind, kind])

    def test_a_mixture_with_no_gap_is_no_gap(self):
        """JEU = -1 without a master (3 of `present`) at the node (1, 0) alone: at places that it has a part in it was mixed with the gaps beside it,
        and on the others' side it has no part."""
        self.write_mesh("mesh_5", [(0.25, 0), (0.5, 0.5), (0, 0.5), (1, 1)], [("POI1", [k]) for k in range(4)])
        skin = {**self.field, "support": range(4), "values": [0.02, -1, 0.02, 0.02], "present": [1, 3, 1, 1]}
        self.write_result("result_3", "mesh_1", [0.0], {"DEPL": {0: skin}}, label="RES")
        run = self.project(MAILLAGE_2=concept("mesh_5"), VIS_A_VIS=[{"GROUP_MA_1": "LEFT"}])
        found = self.values(run, 0)
        self.assertEqual([found[0], found[1]], [-1, -1])
        np.testing.assert_allclose([found[2], found[3]], 0.02, rtol=1e-14)
        self.assertEqual(self.read_field("result_4", "DEPL", 0).present.ravel().tolist(), [3, 3, 1, 1])

    def test_a_projection_that_reaches_no_node_is_refused(self):
        """Too far away, or from cells of another dimension: no result without values."""
        self.write_mesh("mesh_1", POINTS, [*CELLS, ("SEG2", [0, 1])], cell_groups={"SKIN": [2]})
        above = {"GROUP_NO_2": "ABOVE"}
        self.assert_refused(self.project(DISTANCE_MAX=0.05, VIS_A_VIS=[above]), "PROJCHAMP_2", "MESH_1")
        self.assert_refused(self.project(VIS_A_VIS=[{"GROUP_MA_1": "SKIN"}]), "PROJCHAMP_2", "MESH_1")
        self.assertEqual(set(self.values(self.project(DISTANCE_MAX=0.05, PROL_ZERO="OUI", VIS_A_VIS=[above])).values()), {0.0})

    def test_another_mesh_than_that_of_the_field_is_refused(self):
        self.write_model("model_6", "mesh_1", ["D_PLAN/QUAD4"], [0, 0])
        self.write_model("model_7", "mesh_2", ["D_PLAN/QUAD4"], [-1] * 4)
        for own in ({"MAILLAGE_1": concept("mesh_1")}, {"MODELE_1": concept("model_6")}):
            self.assertEqual(self.project(**own).status, 0)
        for other in ({"MAILLAGE_1": concept("mesh_2")}, {"MODELE_1": concept("model_7")}):
            self.assert_refused(self.project(**other), "CREACHAMP_5", "MESH_1", "MESH_2")

    def test_what_is_refused(self):
        self.assert_refused(self.project(NOM_CHAM="VITE"), "RESULT_1", "VITE")
        self.assert_refused(self.project(INST=[0.5]), "FIELDS_2", "0.5")
        self.assert_refused(self.project(VIS_A_VIS=[{"GROUP_MA_1": "MIDDLE"}]), "MESH_1", "MIDDLE")
        cells = {"quantity": "SIEF_R", "location": "ELEM", "components": ["SIXX"], "support": [0, 1], "values": [1.0, 2.0]}
        self.write_result("result_3", "mesh_1", [0.0], {"SIEF": {0: cells}, "DEPL": {0: {**self.field, "values": [0.0] * 8}}})
        self.assert_refused(self.project(NOM_CHAM="SIEF"), "PROJCHAMP_1", "SIEF")
        self.assertEqual(self.project(DISTANCE_ALARME=1.0).status, 0)  # of all fields those at nodes
        with h5py.File(self.path("result_4")) as file:
            self.assertEqual(list(file["fields"]), ["DEPL"])


if __name__ == "__main__":
    unittest.main()
