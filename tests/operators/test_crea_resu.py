"""crea_resu alone: fields by hand in, a result out."""

import unittest

import h5py
import numpy as np
from lacon_test import OperatorTest, concept

POINTS = [(0, 0), (1, 0), (1, 1), (0, 1)]


class CreaResu(OperatorTest):
    def setUp(self):
        super().setUp()
        for mesh in ("mesh_1", "mesh_2"):
            self.write_mesh(mesh, POINTS, [("QUAD4", [0, 1, 2, 3])])
        for identifier, value, mesh in (("field_3", 1.0, "mesh_1"), ("field_4", 2.0, "mesh_1"), ("field_5", 3.0, "mesh_2")):
            with self.create(identifier, "field", mesh=mesh, location="NOEU", quantity="TEMP_R", order=0, instant=0.0, name=identifier) as file:
                file.attrs["components"] = np.array(["TEMP"], h5py.string_dtype())
                file["support"], file["values"] = np.arange(4, dtype=np.int32), np.full((4, 1), value)

    def make(self, *occurrences, reuse=False, **more):
        return self.run_command("CREA_RESU", {"OPERATION": "AFFE", "TYPE_RESU": "EVOL_THER", "AFFE": [{"NOM_CHAM": "TEMP", **one} for one in occurrences], **more},
                                result="result_6", reuse=reuse, label="RES")

    def instants(self):
        with h5py.File(self.path("result_6")) as file:
            return dict(zip(file["order"][()].tolist(), file["instant"][()].tolist()))

    def value(self, order, name="TEMP"):
        values = self.read_field("result_6", name, order).values
        self.assertEqual(values.min(), values.max())
        return values[0, 0]

    def test_instants_get_the_next_orders_and_one_that_is_there_is_replaced(self):
        """By INST within PRECISION; instants that come later than greater ones stay behind them, as in code_aster."""
        self.assertEqual(self.make({"CHAM_GD": concept("field_3"), "INST": [0.0, 1.0]}, {"CHAM_GD": concept("field_4"), "INST": [1.0 + 1e-9]}).status, 0)
        self.assertEqual((self.instants(), self.value(0), self.value(1)), ({0: 0.0, 1: 1.0}, 1, 2))
        self.assertEqual(self.make({"CHAM_GD": concept("field_3"), "INST": [0.5], "NOM_CHAM": "OTHER"}, reuse=True).status, 0)
        self.assertEqual(self.instants(), {0: 0.0, 1: 1.0, 2: 0.5})
        self.assertEqual((self.value(1), self.value(2, "OTHER")), (2, 1))

    def test_instants_of_a_part_of_a_list(self):
        with self.create("list_of_reals_7", "list_of_reals") as file:
            file["values"] = np.array([0.0, 1.0, 2.0, 3.0])
        part = {"CHAM_GD": concept("field_3"), "LIST_INST": concept("list_of_reals_7"), "NUME_INIT": 2, "NUME_FIN": 3}
        self.assertEqual(self.make(part).status, 0)
        self.assertEqual(self.instants(), {0: 1.0, 1: 2.0})

    def test_what_is_refused(self):
        with self.create("list_of_reals_7", "list_of_reals") as file:
            file["values"] = np.array([0.0, 1.0])
        for identifier, one in (("CREARESU_2", {"CHAM_GD": concept("field_5"), "INST": [1.0]}),
                                ("FIELDS_6", {"CHAM_GD": concept("field_3"), "INST": [1.0], "NOM_CHAM": "DEPL"}),
                                ("FIELDS_6", {"CHAM_GD": concept("field_3"), "INST": [1.0], "NOM_CHAM": "SIEF_ELGA"}),
                                ("FIELDS_7", {"CHAM_GD": concept("field_3"), "INST": [1.0], "NOM_CHAM": "UT01_ELGA"}),
                                ("CREARESU_1", {"CHAM_GD": concept("field_3"), "LIST_INST": concept("list_of_reals_7"), "NUME_INIT": 3}),
                                ("CREARESU_1", {"CHAM_GD": concept("field_3"), "INST": [1.0], "NOM_CHAM": None})):
            with self.subTest(identifier):
                run = self.run_command("CREA_RESU", {"OPERATION": "AFFE", "TYPE_RESU": "EVOL_THER", "AFFE": [
                    {"NOM_CHAM": "TEMP", "CHAM_GD": concept("field_3"), "INST": [0.0]},
                    {name: value for name, value in {"NOM_CHAM": "TEMP", **one}.items() if value is not None}]}, result="result_6")
                self.assert_refused(run, identifier)
                if identifier == "FIELDS_6":  # what it is, and what fits
                    self.assertIn("NOEU_TEMP_R", run.stderr)
                    self.assertIn({"DEPL": "NOEU_DEPL_R", "SIEF_ELGA": "ELGA_SIEF_R"}[one["NOM_CHAM"]], run.stderr)


if __name__ == "__main__":
    unittest.main()
