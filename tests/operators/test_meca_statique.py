"""meca_statique alone: one square of test_stat_non_line in tension, by hand; every instant by itself."""

import unittest

import h5py
import numpy as np
from lacon_test import concept
from test_stat_non_line import E, EXX, EYY, PRESSURE, TwoSquares, square


class MecaStatique(TwoSquares):
    """The lower square between its base and the pressure on its upper side."""

    def setUp(self):
        super().setUp()
        self.write_model("model_2", "mesh_1", ["D_PLAN/SEG3", "D_PLAN/QUAD8"], [0, -1, -1, 1, -1])
        self.write_load("load_5", imposed=[(n, "DY", 0.0) for n in (0, 1, 4)] + [(n, "DX", 0.0) for n in (0, 3, 7)], kind="cine")
        self.write_load("load_6", pressure=[(0, PRESSURE)])
        self.write_function("function_10", [0.0, 2.0], [0.0, 2.0])

    def static(self, **changes):
        keywords = {"MODELE": concept("model_2"), "CHAM_MATER": concept("material_field_4"),
                    "EXCIT": [{"CHARGE": concept("load_5")}, {"CHARGE": concept("load_6"), "FONC_MULT": concept("function_10")}], **changes}
        return self.run_command("MECA_STATIQUE", keywords, result="result_9", label="RES")

    def instants(self, run):
        self.assertEqual((run.status, run.messages), (0, []), run.stderr)
        with h5py.File(self.path("result_9")) as file:
            return dict(zip(file["order"][()].tolist(), file["instant"][()].tolist()))

    def test_each_instant_by_itself(self):
        """Orders count from 1, the first instant of the list is solved too, and the load of one leaves nothing to the next."""
        self.write_list("list_of_reals_8", [0.5, 1.0, 2.0])
        self.assertEqual(self.instants(self.static(LIST_INST=concept("list_of_reals_8"))), {1: 0.5, 2: 1.0, 3: 2.0})
        points = np.array(square(-1))
        for order, factor in ((1, 0.5), (2, 1.0), (3, 2.0)):
            field = self.read_field("result_9", "DEPL", order)
            np.testing.assert_array_equal(field.support, range(8))
            np.testing.assert_allclose(field.values, factor * np.column_stack([EXX * points[:, 0], EYY * (points[:, 1] + 1)]), atol=1e-14)
            stress = self.read_field("result_9", "SIEF_ELGA", order)
            np.testing.assert_allclose(stress.values[:, stress.components.index("SIYY")], -factor * PRESSURE, atol=1e-10)

    def test_one_instant_the_last_one_and_no_stresses(self):
        self.assertEqual(self.instants(self.static(INST=1.5)), {1: 1.5})
        self.write_list("list_of_reals_8", [0.5, 1.0, 2.0])
        run = self.static(LIST_INST=concept("list_of_reals_8"), INST_FIN=1.0, OPTION="SANS")
        self.assertEqual(self.instants(run), {1: 0.5, 2: 1.0})
        with h5py.File(self.path("result_9")) as file:
            self.assertEqual(list(file["fields"]), ["DEPL"])

    def test_what_is_refused(self):
        self.write_list("list_of_reals_8", [0.5, 1.0])
        self.assert_refused(self.static(LIST_INST=concept("list_of_reals_8"), INST_FIN=0.1), "EVOLUTION_34")
        self.assert_refused(self.static(INST=3.0), "FUNCTION_1", "INST = 3")
        self.assert_refused(self.static(INST=1.0, EXCIT=[{"CHARGE": concept("load_6")}]), "SOLVER_3", status=3)

    def test_a_stiffer_body_moves_less(self):
        self.write_material("material_3", ELAS={"E": 4 * E, "NU": 0.3})
        self.instants(self.static(INST=1.0))
        self.assertAlmostEqual(self.read_field("result_9", "DEPL", 1).values[:, 1].min(), EYY / 4, delta=1e-14)


if __name__ == "__main__":
    unittest.main()
