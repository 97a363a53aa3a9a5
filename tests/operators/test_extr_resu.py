"""extr_resu alone: a result by hand in, part of it out."""

import unittest

import h5py
from lacon_test import OperatorTest, concept

INSTANTS = [0.0, 0.25, 0.5, 0.75, 1.0]


class ExtrResu(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", [(0, 0), (1, 0), (0, 1)], [("TRIA3", [0, 1, 2])])
        def field(name, order):
            return {"quantity": f"{name}_R", "location": "NOEU", "components": ["DX" if name == "DEPL" else "TEMP"], "support": [0, 1, 2], "values": [order] * 3}
        self.write_result("result_2", "mesh_1", INSTANTS, {"DEPL": {k: field("DEPL", k) for k in range(5)}, "TEMP": {k: field("TEMP", k) for k in (0, 4)}},
                          label="RES")

    def keep(self, reuse=False, **choice):
        """@return name of a field -> its orders, in the result that is made"""
        result = "result_2" if reuse else "result_3"
        run = self.run_command("EXTR_RESU", {"RESULTAT": concept("result_2"), "ARCHIVAGE": choice}, result=result, reuse=reuse, label="RES")
        self.assertEqual((run.status, run.messages), (0, []), run.stderr)
        with h5py.File(self.path(result)) as file:
            self.assertEqual([INSTANTS[o] for o in file["order"][()]], file["instant"][()].tolist())
            kept = file["order"][()].tolist()
            fields = {name: group["order"][()].tolist() for name, group in file["fields"].items()}
        for name, orders in fields.items():
            self.assertEqual([self.read_field(result, name, o).values[0, 0] for o in orders], orders)
        return kept, fields

    def test_instants_and_fields_that_are_kept(self):
        every = list(range(5))
        for choice, kept in (({"TOUT_ORDRE": "OUI"}, every), ({"NUME_ORDRE": [1, 3]}, [1, 3]), ({"INST": [0.5, 1.0]}, [2, 4]), ({"PAS_ARCH": 3}, [0, 3, 4]),
                             ({"CHAM_EXCLU": ["TEMP"]}, every)):
            for reuse in (False, True):
                with self.subTest(choice=choice, reuse=reuse):
                    self.setUp()
                    fields = {"DEPL": kept, "TEMP": [o for o in kept if o in (0, 4)]}
                    if "CHAM_EXCLU" in choice:
                        del fields["TEMP"]
                    self.assertEqual(self.keep(reuse, **choice), (kept, {name: orders for name, orders in fields.items() if orders}))

    def test_a_field_that_is_not_there_is_told(self):
        run = self.run_command("EXTR_RESU", {"RESULTAT": concept("result_2"), "ARCHIVAGE": {"CHAM_EXCLU": ["TEMPP", "TEMP"]}}, result="result_3")
        self.assertEqual((run.status, self.ids(run)), (0, ["EXTRRESU_1"]), run.stderr)
        self.assertIn("the result RES has no field 'TEMPP'", run.stderr)

    def test_an_instant_that_is_not_there_is_refused(self):
        for identifier, choice, word in (("FIELDS_2", {"INST": [0.6]}, "0.6"), ("FIELDS_1", {"NUME_ORDRE": [7]}, "7")):
            self.assert_refuses(identifier, "EXTR_RESU", {"RESULTAT": concept("result_2"), "ARCHIVAGE": choice}, word, result="result_3")


if __name__ == "__main__":
    unittest.main()
