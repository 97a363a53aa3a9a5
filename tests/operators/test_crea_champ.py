"""crea_champ and post_elem alone: fields by hand in, fields and tables out."""

import json
import types
import unittest

import h5py
import numpy as np
from lacon_test import OperatorTest, concept, fill_field, text

#: two squares side by side (the right one is wider) and the lower skin of the left one; M4 has no element
POINTS = np.array([(0, 0), (1, 0), (3, 0), (0, 1), (1, 1), (3, 1)], float)
CELLS = [("SEG2", [0, 1]), ("QUAD4", [0, 1, 4, 3]), ("QUAD4", [1, 2, 5, 4]), ("SEG2", [1, 2])]
GROUPS = {"SKIN": [0], "LEFT": [1], "RIGHT": [2], "BODY": [1, 2]}
GAUSS = [(i, j) for j in (-1 / np.sqrt(3), 1 / np.sqrt(3)) for i in (-1 / np.sqrt(3), 1 / np.sqrt(3))]
#: integration points of M1 (skin, 2), M2 and M3 (4 each)
PLACES = np.array([(0.5 - 0.5 / np.sqrt(3), 0), (0.5 + 0.5 / np.sqrt(3), 0)]
                  + [(0.5 + 0.5 * x, 0.5 + 0.5 * y) for x, y in GAUSS] + [(2 + x, 0.5 + 0.5 * y) for x, y in GAUSS])


def linear(points):
    return 1 + 2 * points[:, 0] - 3 * points[:, 1]


class FieldTest(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", POINTS, CELLS, cell_groups=GROUPS, node_groups={"ENDS": [0, 2]})
        self.write_model("model_2", "mesh_1", ["D_PLAN/SEG2", "D_PLAN/QUAD4"], [0, 1, 1, -1])

    def own(self, identifier, kind, components, support, values, offset=None, present=None, mesh="mesh_1", **attributes):
        """A field concept of type NOEU_DEPL_R."""
        location, _, quantity = kind.partition("_")
        with self.create(identifier, "field", references=[mesh], mesh=mesh, location=location, quantity=quantity, order=0, instant=0.0,
                         name=identifier.upper(), **attributes) as file:
            fill_field(file, components, support, values, offset, present)

    def run_ok(self, command, result, **keywords):
        run = self.run_command(command, keywords, result=result)
        self.assertEqual((run.status, run.messages), (0, []), run.stderr)

    def make(self, result, **keywords):
        """@return the field that CREA_CHAMP makes"""
        self.run_ok("CREA_CHAMP", result, **keywords)
        with h5py.File(self.path(result)) as file:
            self.assertEqual((text(file.attrs["lacon_type"]), text(file.attrs["mesh"])), ("field", "mesh_1"))
            return types.SimpleNamespace(
                kind=f"{text(file.attrs['location'])}_{text(file.attrs['quantity'])}", components=[text(c) for c in file.attrs["components"]],
                support=file["support"][()].tolist(), values=file["values"][()], offset=file["offset"][()].tolist() if "offset" in file else None,
                present=file["present"][()] if "present" in file else None)

    def table(self, **keywords):
        """@return column -> list of POST_ELEM's table"""
        self.run_ok("POST_ELEM", "table_9", **keywords)
        with h5py.File(self.path("table_9")) as file:
            return {text(name): file[f"values/{k}"][()] for k, name in enumerate(file["columns"][()])}

    def refuses(self, identifier, *words, command="CREA_CHAMP", **keywords):
        self.assert_refuses(identifier, command, keywords, *words, result="field_8" if command == "CREA_CHAMP" else "table_9")


class CreaChamp(FieldTest):
    def test_the_geometry_of_a_mesh(self):
        field = self.make("field_3", OPERATION="EXTR", TYPE_CHAM="NOEU_GEOM_R", NOM_CHAM="GEOMETRIE", MAILLAGE=concept("mesh_1"))
        self.assertEqual((field.kind, field.components), ("NOEU_GEOM_R", ["X", "Y"]))
        np.testing.assert_array_equal(field.values, POINTS)

    def test_a_field_of_a_result(self):
        depl = {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX"], "support": range(6)}
        self.write_result("result_3", "mesh_1", [0.0, 1.0], {"DEPL": {k: {**depl, "values": np.arange(6) * k} for k in (0, 1)}}, label="RES")
        which = {"OPERATION": "EXTR", "RESULTAT": concept("result_3"), "NOM_CHAM": "DEPL"}
        for choice in ({"INST": 1.0}, {"NUME_ORDRE": 1}):
            field = self.make("field_4", TYPE_CHAM="NOEU_DEPL_R", **which, **choice)
            np.testing.assert_array_equal(field.values[:, 0], range(6))
        self.refuses("CREACHAMP_8", "0, 1", TYPE_CHAM="NOEU_DEPL_R", **which)
        self.refuses("CREACHAMP_9", "NOEU_DEPL_R", "ELGA_SIEF_R", TYPE_CHAM="ELGA_SIEF_R", INST=1.0, **which)
        self.refuses("FIELDS_2", "0.5", TYPE_CHAM="NOEU_DEPL_R", INST=0.5, **which)
        self.refuses("RESULT_1", "VITE", "DEPL", TYPE_CHAM="NOEU_DEPL_R", INST=1.0, **{**which, "NOM_CHAM": "VITE"})

    def test_elastic_results_have_internal_variables_that_are_zero(self):
        """V1 = 0 at every integration point, as ETAT_INIT/VARI and code_aster's studies take it; of plastic ones that were not kept nothing."""
        stress = {"quantity": "SIEF_R", "location": "ELGA", "components": ["SIXX", "SIYY"], "support": [1, 2], "offset": [0, 4, 8], "values": np.ones((8, 2))}
        what = {"TYPE_CHAM": "ELGA_VARI_R", "OPERATION": "EXTR", "RESULTAT": concept("result_3"), "NOM_CHAM": "VARI_ELGA", "INST": 1.0}
        for relation in ("ELAS", "VMIS_ISOT_LINE"):
            self.write_result("result_3", "mesh_1", [0.0, 1.0], {"SIEF_ELGA": {1: stress}}, label="RES", model="model_2",
                              behaviour=json.dumps([{"RELATION": relation, "DEFORMATION": "PETIT"}]))
            if relation == "ELAS":
                field = self.make("field_4", **what)
                self.assertEqual((field.kind, field.components, field.support, field.offset), ("ELGA_VARI_R", ["V1"], [1, 2], [0, 4, 8]))
                np.testing.assert_array_equal(field.values, np.zeros((8, 1)))
            else:
                self.refuses("RESULT_1", "VARI_ELGA", **what)

    def test_extremes_over_instants(self):
        """DX = (2, -1) at node 1 and 4 at node 2 grow, turn and vanish; LAGS_C is there at node 2 and from the second instant on alone."""
        depl = {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX", "DY", "LAGS_C"], "support": [0, 1]}
        values = [[(0, 0, 0), (4, 0, 0)], [(2, 1, 0), (4, -3, -5)], [(-1, -4, 0), (0, 0, -25)]]
        present = [[(1, 1, 0), (1, 1, 0)], [(1, 1, 0), (1, 1, 1)], [(1, 1, 0), (1, 1, 1)]]
        self.write_result("result_3", "mesh_1", [0.0, 0.5, 1.0], {"DEPL": {k: {**depl, "values": np.array(values[k], float), "present": np.array(present[k], np.uint8)}
                                                                          for k in range(3)}}, label="RES")
        what = {"OPERATION": "EXTR", "RESULTAT": concept("result_3"), "NOM_CHAM": "DEPL", "TYPE_CHAM": "NOEU_DEPL_R"}
        for kind, extremes, instants, choice in (
                ("MAXI", [(2, 1), (4, 0, -5)], [(0.5, 0.5), (0, 0, 0.5)], {"TOUT_ORDRE": "OUI"}),
                ("MINI", [(-1, -4), (0, -3, -25)], [(1, 1), (1, 0.5, 1)], {}),
                ("MAXI_ABS", [(2, 4), (4, 3, 25)], [(0.5, 1), (0, 0.5, 1)], {"INST": [0.0, 0.5, 1.0]}),
                ("MINI_ABS", [(0, 0), (0, 0, 5)], [(0, 0), (1, 0, 0.5)], {"NUME_ORDRE": [0, 1, 2]}),
                ("NORM_TRAN", [(-1, -4), (4, -3, -5)], [(1, 1), (0.5, 0.5, 0.5)], {}),
                ("MAXI", [(2, 1), (4, 0, -5)], [(0.5, 0.5), (0.5, 1, 0.5)], {"INST": [0.5, 1.0]})):
            for resu, expected in (("VALE", extremes), ("INST", instants)):
                with self.subTest(kind=kind, resu=resu):
                    field = self.make("field_4", TYPE_MAXI=kind, TYPE_RESU=resu, **what, **choice)
                    np.testing.assert_array_equal(field.present, [(1, 1, 0), (1, 1, 1)])
                    np.testing.assert_array_equal(field.values[field.present > 0], [x for row in expected for x in row])
        self.refuses("FIELDS_2", "0.7", TYPE_MAXI="MAXI", TYPE_RESU="VALE", INST=[0.7], **what)
        for instant, dx, dy, pressure in ((0.25, (1, 4), (0.5, -1.5), None), (0.7, (0.8, 2.4), (-1, -1.8), -13), (1.0 + 1e-9, (-1, 0), (-4, 0), -25)):
            with self.subTest(instant=instant):
                field = self.make("field_4", INTERPOL="LIN", INST=[instant], **what)
                np.testing.assert_allclose(field.values[:, :2].T, [dx, dy], atol=1e-14)
                np.testing.assert_array_equal(field.present, [(1, 1, 0), (1, 1, pressure is not None)])
                self.assertAlmostEqual(field.values[1, 2], pressure or 0.0, delta=1e-13)
        self.refuses("FIELDS_2", "1.5", INTERPOL="LIN", INST=[1.5], **what)

    def test_what_stands_in_for_no_value_stays_one(self):
        """JEU = -1 without a gap (2 of `present`): copied as such, the extreme only where there never is a gap, no part of means at nodes."""
        gaps, present = ([(-1,), (-1,)], [(0.5,), (-1,)]), ([(2,), (2,)], [(1,), (2,)])
        contact = {"quantity": "CLAC_R", "location": "ELEM", "components": ["JEU"], "support": [1, 2]}
        self.write_result("result_3", "mesh_1", [0.0, 1.0], {"CONT_ELEM": {k: {**contact, "values": np.array(gaps[k], float), "present": np.array(present[k], np.uint8)}
                                                                           for k in (0, 1)}}, label="RES", model="model_2")
        what = {"OPERATION": "EXTR", "RESULTAT": concept("result_3"), "NOM_CHAM": "CONT_ELEM", "TYPE_CHAM": "ELEM_CLAC_R"}
        least = self.make("field_4", TYPE_MAXI="MINI", TYPE_RESU="VALE", **what)
        last = self.make("field_5", INST=[1.0], **what)
        for field in (least, last):
            self.assertEqual((field.values.tolist(), field.present.tolist()), ([[0.5], [-1]], [[1], [2]]))
        self.make("field_6", INST=[0.0], **what)
        total = self.make("field_7", OPERATION="COMB", TYPE_CHAM="ELEM_CLAC_R",
                          COMB=[{"CHAM_GD": concept("field_5"), "COEF_R": 1.0}, {"CHAM_GD": concept("field_6"), "COEF_R": 1.0}])
        self.assertEqual(total.present.tolist(), [[2], [2]])
        where = {"OPERATION": "DISC", "CHAM_GD": concept("field_5"), "MODELE": concept("model_2")}
        cell_nodes = self.make("field_8", TYPE_CHAM="ELNO_CLAC_R", **where)
        self.assertEqual((cell_nodes.values.ravel().tolist(), cell_nodes.present.ravel().tolist()), ([0.5] * 4 + [-1] * 4, [1] * 4 + [2] * 4))
        nodes = self.make("field_9", TYPE_CHAM="NOEU_CLAC_R", **where)
        self.assertEqual((nodes.support, nodes.values.ravel().tolist()), ([0, 1, 3, 4], [0.5] * 4))

    def test_what_is_made_with_no_gap_is_no_gap(self):
        """JEU = -1 without a master (3 of `present`) is in no sum, no multiple and nothing between instants: they showed mixtures of it as gaps."""
        gaps, present = ([(0.5,), (-1,)], [(0.25,), (0.5,)]), ([(1,), (3,)], [(1,), (1,)])
        contact = {"quantity": "CLAC_R", "location": "ELEM", "components": ["JEU"], "support": [1, 2]}
        self.write_result("result_3", "mesh_1", [0.0, 1.0], {"CONT_ELEM": {k: {**contact, "values": np.array(gaps[k], float), "present": np.array(present[k], np.uint8)}
                                                                           for k in (0, 1)}}, label="RES", model="model_2")
        what = {"OPERATION": "EXTR", "RESULTAT": concept("result_3"), "NOM_CHAM": "CONT_ELEM", "TYPE_CHAM": "ELEM_CLAC_R"}

        def check(first, **keywords):
            field = self.make("field_9", **keywords)
            self.assertEqual((field.values.tolist(), field.present.tolist()), ([[first], [-1]], [[1], [3]]))

        check(0.375, INTERPOL="LIN", INST=[0.5], **what)
        self.make("field_4", INST=[0.0], **what)
        self.make("field_5", INST=[1.0], **what)
        combine = lambda a, b: {"OPERATION": "COMB", "TYPE_CHAM": "ELEM_CLAC_R", "COMB": [
            {"CHAM_GD": concept("field_4"), "COEF_R": a}, {"CHAM_GD": concept("field_5"), "COEF_R": b}]}
        check(-0.25, **combine(-1.0, 1.0))
        unmixed = self.make("field_9", **combine(0.0, 2.0))  # none of it is in this
        self.assertEqual((unmixed.values.tolist(), set(unmixed.present.ravel().tolist())), ([[0.5], [1]], {1}))
        parts = [{"TOUT": "OUI", "CHAM_GD": concept("field_5"), "COEF_R": 2.0}, {"TOUT": "OUI", "CHAM_GD": concept("field_4"), "COEF_R": 3.0, "CUMUL": "OUI"}]
        check(2.0, OPERATION="ASSE", TYPE_CHAM="ELEM_CLAC_R", MODELE=concept("model_2"), ASSE=parts)
        check(2.0, OPERATION="ASSE", TYPE_CHAM="ELEM_CLAC_R", MODELE=concept("model_2"), ASSE=[{**parts[1], "CUMUL": "NON"}, {**parts[0], "CUMUL": "OUI"}])
        check(0.5, TYPE_MAXI="MAXI_ABS", NUME_ORDRE=[0], **what)

    def test_values_on_groups_the_later_one_counts(self):
        field = self.make("field_3", OPERATION="AFFE", TYPE_CHAM="NOEU_DEPL_R", MAILLAGE=concept("mesh_1"), AFFE=[
            {"TOUT": "OUI", "NOM_CMP": ["DX"], "VALE": [1.0]}, {"GROUP_MA": "SKIN", "NOM_CMP": ["DX", "DY"], "VALE": [2.0, 3.0]},
            {"GROUP_NO": "ENDS", "NOM_CMP": ["DY"], "VALE": [4.0]}])
        np.testing.assert_array_equal(field.values, [(2, 4), (2, 3), (1, 4), (1, 0), (1, 0), (1, 0)])
        np.testing.assert_array_equal(field.present[:, 1], [1, 1, 1, 0, 0, 0])

    def test_values_at_points_with_zero_elsewhere_or_nowhere(self):
        given = {"OPERATION": "AFFE", "TYPE_CHAM": "ELGA_NEUT_R", "MODELE": concept("model_2"), "AFFE": {"GROUP_MA": "RIGHT", "NOM_CMP": ["X1"], "VALE": [7.0]}}
        field = self.make("field_3", **given)
        self.assertEqual((field.support, field.offset), ([2], [0, 4]))
        field = self.make("field_4", PROL_ZERO="OUI", **given)
        self.assertEqual((field.support, field.offset), ([0, 1, 2], [0, 2, 6, 10]))
        np.testing.assert_array_equal(field.values[:, 0], [0] * 6 + [7] * 4)

    def test_a_function_at_nodes_and_at_points_is_exact_there(self):
        """A piecewise function needs no launcher; FORMULE: verification/norms."""
        with self.create("function_5", "function", parameter="X", component="TOUTRESU", extension_left="LINEAIRE", extension_right="LINEAIRE") as file:
            file.attrs["interpolation"] = np.array(["LIN", "LIN"], h5py.string_dtype())
            file["x"], file["y"] = np.array([0.0, 1.0]), np.array([5.0, 7.0])
        self.make("field_3", OPERATION="EXTR", TYPE_CHAM="NOEU_GEOM_R", NOM_CHAM="GEOMETRIE", MAILLAGE=concept("mesh_1"))
        self.make("field_4", OPERATION="DISC", TYPE_CHAM="ELGA_GEOM_R", MODELE=concept("model_2"), CHAM_GD=concept("field_3"))
        for where, place, points in (("NOEU", "field_3", POINTS), ("ELGA", "field_4", PLACES)):
            on = {"MAILLAGE": concept("mesh_1")} if where == "NOEU" else {"MODELE": concept("model_2")}
            self.make("field_6", OPERATION="AFFE", TYPE_CHAM=f"{where}_NEUT_F", AFFE={"TOUT": "OUI", "NOM_CMP": ["X2"], "VALE_F": [concept("function_5")]}, **on)
            field = self.make("field_7", OPERATION="EVAL", TYPE_CHAM=f"{where}_NEUT_R", CHAM_F=concept("field_6"), CHAM_PARA=[concept(place)])
            self.assertEqual((field.kind, field.components), (f"{where}_NEUT_R", ["X2"]))
            np.testing.assert_allclose(field.values[:, 0], 5 + 2 * points[:, 0], atol=1e-14)
        self.own("field_3", "NOEU_GEOM_R", ["Y"], range(6), POINTS[:, 1])
        self.make("field_6", OPERATION="AFFE", TYPE_CHAM="NOEU_NEUT_F", MAILLAGE=concept("mesh_1"), AFFE={"TOUT": "OUI", "NOM_CMP": ["X2"], "VALE_F": [concept("function_5")]})
        evaluate = {"OPERATION": "EVAL", "TYPE_CHAM": "NOEU_NEUT_R", "CHAM_F": concept("field_6"), "CHAM_PARA": [concept("field_3")]}
        self.refuses("FUNCTION_2", "X", **evaluate)
        self.own("field_3", "NOEU_GEOM_R", ["X"], [0, 1], POINTS[:2, 0])
        self.refuses("CREACHAMP_13", "node N3", **evaluate)

    def test_parts_are_renamed_scaled_and_added(self):
        self.own("field_3", "NOEU_NEUT_R", ["X1", "X2"], range(6), np.arange(12))
        self.own("field_4", "NOEU_DEPL_R", ["DX"], [1, 2], [100, 200])
        field = self.make("field_5", OPERATION="ASSE", TYPE_CHAM="NOEU_DEPL_R", MAILLAGE=concept("mesh_1"), ASSE=[
            {"TOUT": "OUI", "CHAM_GD": concept("field_3"), "NOM_CMP": ["X1", "X2"], "NOM_CMP_RESU": ["DY", "DX"]},
            {"GROUP_NO": "ENDS", "CHAM_GD": concept("field_4"), "CUMUL": "OUI", "COEF_R": -1.0},
            {"GROUP_MA": "SKIN", "CHAM_GD": concept("field_3"), "NOM_CMP": ["X1"], "NOM_CMP_RESU": ["LAGS_C"]}])
        self.assertEqual(field.components, ["DY", "DX", "LAGS_C"])
        dx = np.arange(1, 13, 2)
        np.testing.assert_array_equal(field.values[:, 1], dx - [0, 0, 200, 0, 0, 0])  # N1 is in ENDS, but field_4 is not there
        np.testing.assert_array_equal(field.values[:, 0], np.arange(0, 12, 2))
        np.testing.assert_array_equal(field.present[:, 2], [1, 1, 0, 0, 0, 0])

    def write_table(self, identifier, columns):
        """@param columns name -> (type, cells, None where one is missing)"""
        with self.create(identifier, "table", title="") as file:
            file["columns"] = np.array(list(columns), h5py.string_dtype())
            file["types"] = np.array([kind for kind, _ in columns.values()], h5py.string_dtype())
            for k, (kind, cells) in enumerate(columns.values()):
                stored = {"I": np.int64, "R": float}.get(kind, h5py.string_dtype())
                file[f"values/{k}"] = np.array([("" if kind[0] == "K" else 0) if cell is None else cell for cell in cells], stored)
                file[f"present/{k}"] = np.array([cell is not None for cell in cells], np.uint8)

    def test_a_field_of_a_table(self):
        """Columns that are components go to the places that the rows name; others, and cells that are missing, make nothing."""
        self.write_table("table_3", {"INST": ("R", [0.0, 0.0]), "NOEUD": ("K8", ["N4", "N2"]), "DX": ("R", [3.0, None]), "DY": ("R", [5.0, 7.0])})
        made = {"OPERATION": "EXTR", "MAILLAGE": concept("mesh_1"), "TABLE": concept("table_3"), "NOM_CHAM": ""}
        field = self.make("field_4", TYPE_CHAM="NOEU_DEPL_R", **made)
        self.assertEqual((field.components, field.support, field.present.tolist()), (["DX", "DY"], [1, 3], [[0, 1], [1, 1]]))
        np.testing.assert_array_equal(field.values, [[0, 7], [3, 5]])
        self.write_table("table_3", {"MAILLE": ("K8", ["M3", "M2"]), "POINT": ("I", [4, 1]), "NOEUD": ("K8", ["N5", "N1"]), "X1": ("R", [1.0, 2.0])})
        cells = self.make("field_5", TYPE_CHAM="ELEM_NEUT_R", **made)
        self.assertEqual((cells.support, cells.values[:, 0].tolist()), ([1, 2], [2, 1]))
        points = self.make("field_6", TYPE_CHAM="ELGA_NEUT_R", **{**made, "MODELE": concept("model_2")})
        self.assertEqual([points.support[0], points.support[-1]], [1, 2])
        self.assertEqual(points.values[points.present[:, 0] != 0, 0].tolist(), [2, 1])
        nodes = self.make("field_7", TYPE_CHAM="ELNO_NEUT_R", **made)  # N5 is the third node of M3, N1 the first of M2
        self.assertEqual((nodes.support, np.flatnonzero(nodes.present[:, 0]).tolist()), ([1, 2], [0, 4 + CELLS[2][1].index(4)]))
        self.refuses("CREACHAMP_2", "TABLE", "X1", TYPE_CHAM="NOEU_TEMP_R", **made)
        self.refuses("CREACHAMP_19", "NOEU_NEUT_F", TYPE_CHAM="NOEU_NEUT_F", **made)
        self.write_table("table_3", {"MAILLE": ("K8", ["M3", "M9"]), "POINT": ("I", [5, 1]), "X1": ("R", [1.0, 2.0])})
        self.refuses("CREACHAMP_17", "NOEUD", TYPE_CHAM="NOEU_NEUT_R", **made)
        self.refuses("CREACHAMP_18", "M9", "row 2", TYPE_CHAM="ELEM_NEUT_R", **made)
        self.refuses("CREACHAMP_18", "POINT", "'5'", TYPE_CHAM="ELNO_NEUT_R", **made)

    def test_a_value_of_a_cell_goes_to_all_its_points(self):
        self.own("field_3", "ELEM_CLAC_R", ["PRES"], [0], [-3.0])
        field = self.make("field_4", OPERATION="ASSE", TYPE_CHAM="CART_NEUT_R", MAILLAGE=concept("mesh_1"),
                          ASSE={"GROUP_MA": "SKIN", "CHAM_GD": concept("field_3"), "NOM_CMP": ["PRES"], "NOM_CMP_RESU": ["X1"]})
        self.assertEqual((field.kind, field.support), ("ELEM_NEUT_R", [0]))
        field = self.make("field_5", OPERATION="DISC", TYPE_CHAM="ELGA_NEUT_R", MODELE=concept("model_2"), PROL_ZERO="OUI", CHAM_GD=concept("field_4"))
        np.testing.assert_array_equal(field.values[:, 0], [-3, -3] + [0] * 8)

    def test_a_linear_field_is_exact_wherever_it_goes(self):
        self.own("field_3", "NOEU_NEUT_R", ["X1"], range(6), linear(POINTS))
        model, body = concept("model_2"), [n for _, nodes in CELLS[:3] for n in nodes]
        points = self.make("field_4", OPERATION="DISC", TYPE_CHAM="ELGA_NEUT_R", MODELE=model, CHAM_GD=concept("field_3"))
        np.testing.assert_allclose(points.values[:, 0], linear(PLACES), atol=1e-14)
        for source in ("field_3", "field_4"):
            nodes = self.make("field_5", OPERATION="DISC", TYPE_CHAM="ELNO_NEUT_R", MODELE=model, CHAM_GD=concept(source))
            np.testing.assert_allclose(nodes.values[:, 0], linear(POINTS[body]), atol=1e-14)
        back = self.make("field_6", OPERATION="DISC", TYPE_CHAM="NOEU_NEUT_R", MODELE=model, CHAM_GD=concept("field_4"))
        np.testing.assert_allclose(back.values[:, 0], linear(POINTS), atol=1e-14)
        middle = self.make("field_7", OPERATION="DISC", TYPE_CHAM="ELEM_NEUT_R", MODELE=model, CHAM_GD=concept("field_4"))
        np.testing.assert_allclose(middle.values[:, 0], linear(np.array([(0.5, 0), (0.5, 0.5), (2, 0.5)])), atol=1e-14)

    def test_a_cell_whose_nodes_lack_a_component(self):
        self.own("field_3", "NOEU_NEUT_R", ["X1"], [0, 1, 3, 4], [1, 1, 1, 1])
        given = {"OPERATION": "DISC", "TYPE_CHAM": "ELGA_NEUT_R", "MODELE": concept("model_2"), "CHAM_GD": concept("field_3")}
        self.assertEqual(self.make("field_4", **given).support, [0, 1])
        np.testing.assert_allclose(self.make("field_5", PROL_ZERO="OUI", **given).values[:, 0], [1] * 6 + [0] * 4, atol=1e-15)

    def test_sums_and_normals(self):
        self.own("field_3", "NOEU_DEPL_R", ["DX"], range(6), np.arange(6))
        self.own("field_4", "NOEU_DEPL_R", ["DX"], range(6), np.ones(6))
        both = [{"CHAM_GD": concept("field_3"), "COEF_R": 2.0}, {"CHAM_GD": concept("field_4"), "COEF_R": -1.0}]
        field = self.make("field_5", OPERATION="COMB", TYPE_CHAM="NOEU_DEPL_R", COMB=both)
        np.testing.assert_array_equal(field.values[:, 0], 2 * np.arange(6) - 1)
        self.own("field_4", "NOEU_DEPL_R", ["DX"], [0], [1.0])
        self.refuses("CREACHAMP_15", "FIELD_4", OPERATION="COMB", TYPE_CHAM="NOEU_DEPL_R", COMB=both)
        field = self.make("field_6", OPERATION="NORMALE", TYPE_CHAM="NOEU_GEOM_R", MODELE=concept("model_2"), GROUP_MA="SKIN")
        np.testing.assert_allclose(field.values, [(0, -1), (0, -1)], atol=1e-15)

    def test_refusals(self):
        mesh = {"MAILLAGE": concept("mesh_1")}
        affect = {"OPERATION": "AFFE", "AFFE": {"TOUT": "OUI", "NOM_CMP": ["DX"], "VALE": [1.0]}}
        self.refuses("CREACHAMP_1", "NOEU_DEPL", TYPE_CHAM="NOEU_DEPL", **affect, **mesh)
        self.refuses("CREACHAMP_1", "SOMM_DEPL_R", TYPE_CHAM="SOMM_DEPL_R", **affect, **mesh)
        self.refuses("CREACHAMP_2", "DX", TYPE_CHAM="NOEU_SIEF_R", **affect, **mesh)
        self.refuses("CREACHAMP_3", TYPE_CHAM="ELGA_DEPL_R", **affect, **mesh)
        self.refuses("CREACHAMP_6", "AFFE", TYPE_CHAM="NOEU_DEPL_R", **affect)
        self.refuses("CREACHAMP_10", "VALE", TYPE_CHAM="NOEU_DEPL_F", **affect, **mesh)
        for identifier, change in (("CREACHAMP_11", {"VALE": [1.0, 2.0]}), ("MESH_1", {"TOUT": None, "GROUP_MA": "RIHGT"})):
            one = {k: v for k, v in {**affect["AFFE"], **change}.items() if v is not None}
            self.refuses(identifier, TYPE_CHAM="NOEU_DEPL_R", OPERATION="AFFE", AFFE=one, **mesh)
        self.refuses("CREACHAMP_7", "ELEM_DEPL_R", TYPE_CHAM="ELEM_DEPL_R", OPERATION="AFFE", AFFE={"GROUP_NO": "ENDS", "NOM_CMP": ["DX"], "VALE": [1.0]}, **mesh)
        self.own("field_3", "ELGA_NEUT_R", ["X1"], [1], np.ones(9), offset=[0, 9])
        part = {"TOUT": "OUI", "CHAM_GD": concept("field_3")}
        model = {"MODELE": concept("model_2")}
        self.refuses("CREACHAMP_4", "M2", TYPE_CHAM="ELGA_NEUT_R", OPERATION="ASSE", ASSE=part, **model)
        self.refuses("CREACHAMP_9", "ELGA_NEUT_R", TYPE_CHAM="NOEU_NEUT_R", OPERATION="ASSE", ASSE=part, **mesh)
        self.refuses("CREACHAMP_14", "X7", TYPE_CHAM="ELGA_NEUT_R", OPERATION="ASSE", ASSE={**part, "NOM_CMP": ["X7"]}, **model)
        self.refuses("CREACHAMP_12", TYPE_CHAM="ELGA_NEUT_R", OPERATION="EVAL", CHAM_F=concept("field_3"), CHAM_PARA=[concept("field_3")])
        self.write_mesh("mesh_6", POINTS, CELLS, label="OTHER")
        self.own("field_4", "NOEU_NEUT_R", ["X1"], [0], [1.0], mesh="mesh_6")
        self.refuses("CREACHAMP_5", "OTHER", TYPE_CHAM="NOEU_NEUT_R", OPERATION="ASSE", ASSE={**part, "CHAM_GD": concept("field_4")}, **model)


class PostElem(FieldTest):
    def test_norms_are_those_of_numpy(self):
        """Measures of the points: 1/2 on the skin, 1/4 in the left cell, 1/2 in the right one."""
        values = np.random.default_rng(3).normal(size=(10, 2))
        self.own("field_3", "ELGA_DEPL_R", ["DX", "DY"], range(3), values, offset=[0, 2, 6, 10])
        measure = np.array([0.5] * 2 + [0.25] * 4 + [0.5] * 4)
        squares = measure * (values**2).sum(1)
        norm = {"TYPE_NORM": "L2", "CHAM_GD": concept("field_3"), "MODELE": concept("model_2")}
        for place, rows in (({"GROUP_MA": "SKIN"}, slice(0, 2)), ({"GROUP_MA": ["LEFT", "RIGHT"]}, slice(2, 10)), ({"TOUT": "OUI"}, slice(2, 10))):
            table = self.table(NORME={**norm, **place})
            self.assertAlmostEqual(table["VALE_NORM"][0], np.sqrt(squares[rows].sum()), 14)
        table = self.table(NORME={**norm, "TOUT": "OUI", "NOM_CMP": ["DY"], "COEF_MULT": [3.0]})
        self.assertAlmostEqual(table["VALE_NORM"][0], np.sqrt((3 * measure * values[:, 1]**2)[2:].sum()), 14)

    def test_the_norm_of_a_tensor_counts_both_off_diagonals(self):
        self.own("field_3", "ELGA_SIEF_R", ["SIXX", "SIYY", "SIXY"], [1], [(1.0, 2.0, 3.0)] * 4, offset=[0, 4])
        norm = {"CHAM_GD": concept("field_3"), "MODELE": concept("model_2"), "GROUP_MA": "LEFT"}
        self.assertAlmostEqual(self.table(NORME={**norm, "TYPE_NORM": "L2"})["VALE_NORM"][0], np.sqrt(14), 14)
        self.assertAlmostEqual(self.table(NORME={**norm, "TYPE_NORM": "FROBENIUS"})["VALE_NORM"][0], np.sqrt(23), 14)

    def test_integrals_of_a_linear_field_are_exact(self):
        depl = {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX"], "support": range(6), "values": linear(POINTS)}
        self.write_result("result_3", "mesh_1", [0.0, 1.0], {"DEPL": {k: depl for k in (0, 1)}}, model="model_2")
        table = self.table(INTEGRALE={"RESULTAT": concept("result_3"), "NOM_CHAM": "DEPL", "GROUP_MA": ["LEFT", "RIGHT", "SKIN"], "INST": [1.0]})
        middle = linear(np.array([(0.5, 0.5), (2, 0.5), (0.5, 0)]))
        np.testing.assert_allclose(table["VOL"], [1, 2, 1], atol=1e-14)
        np.testing.assert_allclose(table["MOYE_DX"], middle, atol=1e-14)
        np.testing.assert_allclose(table["INTE_DX"], middle * [1, 2, 1], atol=1e-14)
        self.assertEqual((table["NUME_ORDRE"].tolist(), table["INST"].tolist()), ([1] * 3, [1.0] * 3))

    def test_lengths_do_not_add_up_to_areas(self):
        """A group of a square and its skin: TYPE_MAILLE says which of them; without it the square counts, and what is left out is told."""
        self.write_mesh("mesh_1", POINTS, CELLS, cell_groups={**GROUPS, "MIXED": [0, 1]})
        self.own("field_3", "NOEU_DEPL_R", ["DX"], range(6), linear(POINTS))
        of = {"CHAM_GD": concept("field_3"), "MODELE": concept("model_2")}
        square, skin = linear(np.array([(0.5, 0.5), (0.5, 0)]))
        for place, kind, expected in (({"GROUP_MA": ["MIXED"]}, "2D", (1, square)), ({"GROUP_MA": ["MIXED"]}, "1D", (1, skin)), ({"TOUT": "OUI"}, "1D", (1, skin)),
                                      ({"TOUT": "OUI"}, "2D", (3, (square + 2 * linear(np.array([(2, 0.5)]))[0]) / 3))):
            table = self.table(INTEGRALE={**of, **place, "TYPE_MAILLE": kind})
            np.testing.assert_allclose([table["VOL"][0], table["MOYE_DX"][0]], expected, atol=1e-14)
        for keywords in ({"INTEGRALE": {**of, "GROUP_MA": ["MIXED"]}}, {"NORME": {**of, "TYPE_NORM": "L2", "GROUP_MA": ["SKIN", "LEFT"]}}):
            run = self.run_command("POST_ELEM", keywords, result="table_9")
            self.assertEqual((run.status, [message["id"] for message in run.messages]), (0, ["POSTELEM_6"]), run.stderr)
        self.refuses("POSTELEM_2", "LEFT", command="POST_ELEM", INTEGRALE={**of, "GROUP_MA": ["LEFT"], "TYPE_MAILLE": "1D"})

    def test_axisymmetry_integrates_over_one_radian(self):
        self.write_model("model_2", "mesh_1", ["AXIS/SEG2", "AXIS/QUAD4"], [0, 1, 1, -1])
        self.own("field_3", "NOEU_DEPL_R", ["DX"], range(6), np.ones(6))
        table = self.table(INTEGRALE={"CHAM_GD": concept("field_3"), "MODELE": concept("model_2"), "TOUT": "OUI"})
        self.assertAlmostEqual(table["VOL"][0], 4.5, 13)  # radius 3, height 1

    def test_extreme_values_with_their_places(self):
        self.own("field_3", "NOEU_DEPL_R", ["DX"], range(6), linear(POINTS))
        table = self.table(MINMAX={"CHAM_GD": concept("field_3"), "MODELE": concept("model_2"), "GROUP_MA": ["LEFT"]})
        self.assertEqual((table["MIN_DX"][0], text(table["NO_MIN_DX"][0]), table["MAX_DX"][0], text(table["NO_MAX_DX"][0])), (-2, "N4", 3, "N2"))

    def test_what_stands_in_for_no_value_is_left_out(self):
        """JEU = -1 where there is no gap: not the least one, nor a part of means and norms; where nothing else is it shows."""
        self.own("field_3", "ELEM_CLAC_R", ["PRES", "JEU"], range(3), [(0, -1), (0, -1), (-25, 0.5)], present=[(1, 2), (1, 2), (1, 1)])
        of = {"CHAM_GD": concept("field_3"), "MODELE": concept("model_2")}
        table = self.table(MINMAX={**of, "TOUT": "OUI"})
        self.assertEqual((table["MIN_JEU"][0], text(table["MA_MIN_JEU"][0]), table["MAX_JEU"][0], table["MAX_PRES"][0]), (0.5, "M3", 0.5, 0))
        table = self.table(MINMAX={**of, "GROUP_MA": ["LEFT"]})
        self.assertEqual((table["MIN_JEU"][0], table["MAX_JEU"][0]), (-1, -1))
        table = self.table(INTEGRALE={**of, "GROUP_MA": ["LEFT", "RIGHT", "BODY"]})
        np.testing.assert_allclose(table["VOL"], [1, 2, 3], atol=1e-14)
        np.testing.assert_allclose(table["INTE_JEU"], [0, 1, 1], atol=1e-14)
        np.testing.assert_allclose(table["MOYE_JEU"][1:], [0.5, 0.5], atol=1e-14)
        np.testing.assert_allclose(table["MOYE_PRES"], [0, -25, -50 / 3], atol=1e-13)
        table = self.table(INTEGRALE={**of, "GROUP_MA": ["LEFT", "RIGHT", "BODY"], "NOM_CMP": ["JEU"]})  # alone, VOL is what it is over
        np.testing.assert_allclose([table["VOL"], table["INTE_JEU"]], [[0, 2, 2], [0, 1, 1]], atol=1e-14)
        norm = self.table(NORME={**of, "TYPE_NORM": "L2", "TOUT": "OUI", "NOM_CMP": ["JEU"]})["VALE_NORM"]
        self.assertAlmostEqual(norm[0], np.sqrt(2) / 2, 14)

    def test_a_mean_is_that_of_the_cells_that_have_the_component(self):
        """X1 = 4 on the left (area 1), X2 = 6 on the right (area 2): over both X1 is 4 in the mean, not 4/3, and its integral 4; where no cell of
        a group has it there is none."""
        self.own("field_3", "ELEM_NEUT_R", ["X1", "X2"], [1, 2], [(4, 0), (0, 6)], present=[(1, 0), (0, 1)])
        table = self.table(INTEGRALE={"CHAM_GD": concept("field_3"), "MODELE": concept("model_2"), "GROUP_MA": ["BODY", "LEFT"]})
        np.testing.assert_allclose(table["VOL"], [3, 1], atol=1e-14)
        np.testing.assert_allclose([table["INTE_X1"], table["INTE_X2"]], [[4, 4], [12, 0]], atol=1e-13)
        np.testing.assert_allclose([table["MOYE_X1"][0], table["MOYE_X1"][1], table["MOYE_X2"][0]], [4, 4, 6], atol=1e-13)
        with h5py.File(self.path("table_9")) as file:
            cells = self.read_table(file)
        self.assertIsNone(cells[1]["MOYE_X2"])

    def test_what_is_integrated_already_adds_up(self):
        """ENEL_ELEM, the energy of each cell: its sum, and only if that is asked for. A field of means must be said to be one."""
        energy = {"quantity": "ENER_R", "location": "ELEM", "components": ["TOTALE"], "support": [1, 2], "values": [4.0, 6.0]}
        self.write_result("result_3", "mesh_1", [0.0], {"ENEL_ELEM": {0: energy}}, model="model_2")
        self.own("field_3", "ELEM_ENER_R", ["TOTALE"], [1, 2], [4.0, 6.0])
        self.own("field_4", "NOEU_DEPL_R", ["DX"], range(6), linear(POINTS))
        self.own("field_5", "ELEM_CLAC_R", ["PRES"], range(3), np.ones(3))
        of = {"RESULTAT": concept("result_3"), "NOM_CHAM": "ENEL_ELEM", "GROUP_MA": ["BODY", "RIGHT"]}
        table = self.table(INTEGRALE={**of, "DEJA_INTEGRE": "OUI"})
        np.testing.assert_allclose([table["INTE_TOTALE"], table["VOL"], table["MOYE_TOTALE"]], [[10, 6], [3, 2], [10 / 3, 3]], rtol=1e-14)
        for more in ({}, {"DEJA_INTEGRE": "NON"}):
            self.refuses("POSTELEM_7", "ENEL_ELEM", "DEJA_INTEGRE", command="POST_ELEM", INTEGRALE={**of, **more})
        own = {"MODELE": concept("model_2"), "GROUP_MA": ["BODY"]}
        self.refuses("POSTELEM_7", command="POST_ELEM", INTEGRALE={"CHAM_GD": concept("field_3"), **own})
        for said, sum_ in (("NON", 4 + 2 * 6), ("OUI", 10)):
            table = self.table(INTEGRALE={"CHAM_GD": concept("field_3"), "DEJA_INTEGRE": said, **own})
            self.assertAlmostEqual(table["INTE_TOTALE"][0], sum_, 13)
        for field in ("field_4", "field_5"):
            self.refuses("POSTELEM_8", command="POST_ELEM", INTEGRALE={"CHAM_GD": concept(field), "DEJA_INTEGRE": "OUI", **own})

    def test_cells_whose_nodes_lack_a_component_are_told(self):
        """DX at the nodes of the left cell alone; LAGS_C, one value for each patch, is refused where it is named and empty where it is not."""
        self.own("field_3", "NOEU_DEPL_R", ["DX", "DY", "LAGS_C"], range(6), np.ones((6, 3)), present=[(k in (0, 1, 3, 4), 1, k < 2) for k in range(6)])
        of = {"CHAM_GD": concept("field_3"), "MODELE": concept("model_2")}
        for components, ids in ((["DX"], ["POSTELEM_10"]), (["DY"], []), (None, ["POSTELEM_10"])):
            named = {"NOM_CMP": components} if components else {}
            run = self.run_command("POST_ELEM", {"INTEGRALE": {**of, **named, "GROUP_MA": ["BODY", "LEFT"]}}, result="table_9")
            self.assertEqual((run.status, [message["id"] for message in run.messages]), (0, ids), run.stderr)
            self.assertTrue(all("1 of 2 cell(s), the first M3" in message["text"] for message in run.messages), run.messages)
        with h5py.File(self.path("table_9")) as file:
            row = self.read_table(file)[0]
        self.assertEqual((row["INTE_LAGS_C"], row["MOYE_LAGS_C"]), (None, None))
        self.assertAlmostEqual(row["INTE_DY"], 3, 13)
        for keyword, more in (("INTEGRALE", {}), ("NORME", {"TYPE_NORM": "L2"})):
            self.refuses("POSTELEM_9", "LAGS_C", command="POST_ELEM", **{keyword: {**of, **more, "GROUP_MA": ["SKIN"], "NOM_CMP": ["LAGS_C"]}})

    def test_masses_ask_for_what_a_result_does_not_say(self):
        """A result that PROJ_CHAMP or CREA_RESU made names neither model nor materials."""
        depl = {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX"], "support": range(6), "values": np.zeros(6)}
        self.write_result("result_3", "mesh_1", [0.0], {"DEPL": {0: depl}}, label="RES")
        self.refuses("FIELDS_8", "RES", "MODELE", command="POST_ELEM", RESULTAT=concept("result_3"), MASS_INER={"TOUT": "OUI"})
        self.refuses("FIELDS_8", "RES", "CHAM_MATER", command="POST_ELEM", RESULTAT=concept("result_3"), MODELE=concept("model_2"), MASS_INER={"TOUT": "OUI"})

    def test_refusals(self):
        self.own("field_3", "NOEU_DEPL_R", ["DX"], [0, 1, 3, 4], np.ones(4))
        norm = {"TYPE_NORM": "L2", "CHAM_GD": concept("field_3"), "MODELE": concept("model_2")}
        self.refuses("POSTELEM_2", "RIGHT", command="POST_ELEM", NORME={**norm, "GROUP_MA": "RIGHT"})
        self.refuses("CREACHAMP_14", "DZ", command="POST_ELEM", NORME={**norm, "TOUT": "OUI", "NOM_CMP": ["DZ"]})
        self.refuses("CREACHAMP_11", "COEF_MULT", command="POST_ELEM", NORME={**norm, "TOUT": "OUI", "COEF_MULT": [1.0, 2.0]})


if __name__ == "__main__":
    unittest.main()
