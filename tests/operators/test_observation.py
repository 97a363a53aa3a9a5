"""OBSERVATION, SUIVI_DDL and events of time steps in stat_non_line, on the two squares of test_stat_non_line: every value is known in closed form."""

import json
import math
import unittest

import h5py
from lacon_test import concept
from test_stat_non_line import EXX, EYY, NU, PRESSURE, TwoSquares

COLUMNS = ["NOM_OBSERVATION", "TYPE_OBJET", "NUME_REUSE", "NUME_OBSE", "INST", "NOM_CHAM", "EVAL_CHAM", "NOM_CMP", "NOM_VARI", "EVAL_CMP",
           "NOEUD", "MAILLE", "EVAL_ELGA", "POINT", "SOUS_POINT", "VALE", "NUME_GLOBAL_NOEUD"]


class Observation(TwoSquares):
    def observe(self, *occurrences, **changes):
        """The table of observations: occurrences are dicts of keywords."""
        run = self.solve(OBSERVATION=list(occurrences), **changes)
        self.assertEqual(run.status, 0, run.stderr)
        with h5py.File(self.path("result_9")) as file:
            table = self.read_table(file["tables/OBSERVATION"])
        self.assertEqual(list(table[0]), COLUMNS)
        return table

    def assert_rows(self, table, names, rows):
        """The columns `names` of the table, reals to 1e-12."""
        found = [[row[name] for name in names] for row in table]
        self.assertEqual(len(found), len(rows), found)
        for got, expected in zip(found, rows):
            for a, b in zip(got, expected):
                self.assertTrue(math.isclose(a, b, abs_tol=1e-11) if isinstance(b, float) else a == b, (got, expected))

    def test_values_at_nodes(self):
        table = self.observe({"NOM_CHAM": "DEPL", "NOM_CMP": ["DX", "LAGS_C"], "NOEUD": ["N2", "N13"], "INST": [1.0], "OBSE_ETAT_INIT": "NON"})
        self.assert_rows(table, ["NOM_OBSERVATION", "TYPE_OBJET", "NUME_OBSE", "INST", "EVAL_CHAM", "NOM_CMP", "NOEUD", "NUME_GLOBAL_NOEUD", "VALE"],
                         [["OBSERVATION_1", "NOEUD", 0, 1.0, "VALE", "DX", "N2", 2, EXX],
                          ["OBSERVATION_1", "NOEUD", 0, 1.0, "VALE", "DX", "N13", 13, EXX / 2],
                          ["OBSERVATION_1", "NOEUD", 0, 1.0, "VALE", "LAGS_C", "N13", 13, -PRESSURE]])

    def test_reductions_over_nodes_of_cells(self):
        occurrences = [{"NOM_CHAM": "DEPL", "NOM_CMP": ["DY"], "GROUP_MA": ["SLAVE"], "EVAL_CHAM": how, "OBSE_ETAT_INIT": "NON"}
                       for how in ("MIN", "MAX", "MOY", "MINI_ABS", "MAXI_ABS")]
        occurrences[2] = {**occurrences[2], "GROUP_MA": None, "MAILLE": ["M3"], "TITRE": "upper"}
        table = self.observe(*[{k: v for k, v in o.items() if v is not None} for o in occurrences])
        self.assert_rows(table, ["NOM_OBSERVATION", "EVAL_CHAM", "NOEUD", "VALE"],
                         [["OBSERVATION_1", "MIN", None, EYY], ["OBSERVATION_2", "MAX", None, EYY], ["upper", "MOY", None, 2 * EYY],
                          ["OBSERVATION_4", "MINI_ABS", None, -EYY], ["OBSERVATION_5", "MAXI_ABS", None, -EYY]])

    def test_fields_on_cells_and_at_points(self):
        table = self.observe({"NOM_CHAM": "CONT_ELEM", "NOM_CMP": ["PRES", "CONT"], "OBSE_ETAT_INIT": "NON"},
                             {"NOM_CHAM": "SIEF_ELGA", "NOM_CMP": ["SIYY"], "MAILLE": ["M4"], "POINT": [1, 9], "OBSE_ETAT_INIT": "NON"},
                             {"NOM_CHAM": "SIEF_ELGA", "NOM_CMP": ["SIZZ"], "EVAL_ELGA": "MAX", "OBSE_ETAT_INIT": "NON"},
                             {"NOM_CHAM": "SIEF_ELGA", "NOM_CMP": ["SIZZ"], "EVAL_ELGA": "MIN", "EVAL_CHAM": "MOY", "OBSE_ETAT_INIT": "NON"})
        self.assert_rows(table, ["NOM_OBSERVATION", "MAILLE", "EVAL_ELGA", "POINT", "NOM_CMP", "VALE"],
                         [["OBSERVATION_1", "M2", None, None, "PRES", -PRESSURE], ["OBSERVATION_1", "M2", None, None, "CONT", 1.0],
                          ["OBSERVATION_2", "M4", "VALE", 1, "SIYY", -PRESSURE], ["OBSERVATION_2", "M4", "VALE", 9, "SIYY", -PRESSURE],
                          ["OBSERVATION_3", "M4", "MAX", None, "SIZZ", -NU * PRESSURE], ["OBSERVATION_3", "M5", "MAX", None, "SIZZ", -NU * PRESSURE],
                          ["OBSERVATION_4", None, "MIN", None, "SIZZ", -NU * PRESSURE]])

    def test_instants(self):
        self.write_function("function_10", [0.0, 1.0], [0.0, 1.0])
        self.write_list("list_of_reals_11", [0.0, 0.25, 0.5, 0.75, 1.0])
        self.write_list("list_of_reals_12", [0.25, 1.0])
        loads = ["load_5", {"CHARGE": concept("load_6"), "FONC_MULT": concept("function_10")}]
        what = {"NOM_CHAM": "DEPL", "NOM_CMP": ["LAGS_C"], "EVAL_CHAM": "MIN"}
        table = self.observe({**what, "TITRE": "all"}, {**what, "PAS_OBSE": 2, "TITRE": "second"}, {**what, "INST": [0.5000000001], "TITRE": "one"},
                             {**what, "LIST_INST": concept("list_of_reals_12"), "OBSE_ETAT_INIT": "NON", "TITRE": "list"},
                             loads=loads, INCREMENT={"LIST_INST": concept("list_of_reals_11")})
        for name, instants in (("all", [0, 0.25, 0.5, 0.75, 1]), ("second", [0, 0.5, 1]), ("one", [0, 0.5]), ("list", [0.25, 1])):
            rows = [row for row in table if row["NOM_OBSERVATION"] == name]
            self.assert_rows(rows, ["NUME_OBSE", "INST", "VALE"], [[i, float(t), -PRESSURE * t] for i, t in enumerate(instants)])

    def test_followed_values_are_printed(self):
        run = self.solve(SUIVI_DDL=[{"NOM_CHAM": "DEPL", "NOM_CMP": ["DY"], "EVAL_CHAM": "MIN"},
                                    {"NOM_CHAM": "DEPL", "NOM_CMP": ["LAGS_C"], "NOEUD": ["N13"], "TITRE": ["PRESSURE", "HERE"]}])
        self.assertEqual(run.status, 0, run.stderr)
        self.assertRegex(run.stdout, rf"SUIVI_1 +DEPL DY MIN {2 * EYY:.9g}\n PRESSURE HERE +DEPL LAGS_C N13 -25\n")
        with h5py.File(self.path("result_9")) as file:
            self.assertNotIn("tables", file)

    def test_works_along_the_displacements(self):
        """ENERGIE: half the pressure times what its side moves, stored in the squares; contact and supports do no work, and the table is there at every instant."""
        self.write_list("list_of_reals_11", [0.0, 0.5, 1.0])
        self.write_function("function_10", [0.0, 1.0], [0.0, 1.0])
        loads = ["load_5", {"CHARGE": concept("load_6"), "FONC_MULT": concept("function_10")}]
        for changes, instants in (({}, [0.0, 1.0]), ({"loads": loads, "INCREMENT": {"LIST_INST": concept("list_of_reals_11")}}, [0.0, 0.5, 1.0])):
            self.assertEqual(self.solve(ENERGIE=[{}], **changes).status, 0)
            with h5py.File(self.path("result_9")) as file:
                table = self.read_table(file["tables/PARA_CALC"])
            work = -PRESSURE * 2 * EYY / 2
            self.assert_rows(table, ["NUME_REUSE", "INST", "TRAV_EXT", "ENER_CIN", "ENER_TOT", "TRAV_AMOR", "TRAV_LIAI", "DISS_SCH"],
                             [[0, t, work * t**2, 0.0, work * t**2, 0.0, 0.0, 0.0] for t in instants])

    def test_what_cannot_be_observed_is_refused_before_the_first_instant(self):
        for identifier, occurrence, words in (
                ("OBSERVATION_1", {"NOM_CHAM": "SIEF_NOEU", "NOM_CMP": ["SIYY"]}, ["SIEF_NOEU"]),
                ("OBSERVATION_2", {"NOM_CHAM": "DEPL", "NOM_CMP": ["DZ"]}, ["DZ"]),
                ("OBSERVATION_3", {"NOM_CHAM": "SIEF_ELGA", "NOM_CMP": ["SIYY"], "NOEUD": ["N1"], "EVAL_ELGA": "MIN"}, ["NOEUD"]),
                ("OBSERVATION_3", {"NOM_CHAM": "SIEF_ELGA", "NOM_CMP": ["SIYY"]}, ["EVAL_ELGA"]),
                ("OBSERVATION_3", {"NOM_CHAM": "DEPL", "NOM_CMP": ["DX"], "POINT": [1]}, ["POINT"]),
                ("OBSERVATION_4", {"NOM_CHAM": "CONT_ELEM", "NOM_CMP": ["PRES"], "MAILLE": ["M4"]}, ["CONT_ELEM"]),
                ("OBSERVATION_4", {"NOM_CHAM": "DEPL", "NOM_CMP": ["LAGS_C"], "NOEUD": ["N1"], "OBSE_ETAT_INIT": "NON"}, ["DEPL"]),
                ("OBSERVATION_5", {"NOM_CHAM": "DEPL", "NOM_CMP": ["DX"], "NOEUD": ["N17"]}, ["N17"]),
                ("OBSERVATION_6", {"NOM_CHAM": "SIEF_ELGA", "NOM_CMP": ["SIYY"], "POINT": [10]}, ["10", "M4", "9"]),
                ("MESH_1", {"NOM_CHAM": "DEPL", "NOM_CMP": ["DX"], "GROUP_MA": ["SLAV"]}, ["SLAV"])):
            with self.subTest(identifier):
                run = self.assert_fails(identifier, *words, OBSERVATION=[occurrence])
                self.assertNotIn("Instant de calcul", run.stdout)
                self.assertEqual(self.ids(run), [identifier])  # nothing about contact, of which no instant has shown anything


class Events(TwoSquares):
    """What DEFI_LIST_INST says of steps, on the ramp from 0 to the full pressure: DX of N2 goes from 0 to EXX."""

    def steps(self, adaptation=None, convergence=None, more_iterations=0, **event):
        """Solve with one event beside failures. @return the run and its instants"""
        self.write_function("function_10", [0.0, 1.0], [0.0, 1.0])
        with self.create("time_steps_11", "time_steps", cut=0, cut_into=4, cut_levels=3, smallest=0.0, more_iterations=more_iterations) as file:
            file["values"] = [0.0, 1.0] if adaptation is None else [0.0, 0.125, 1.0]
            if event:
                file.attrs["events"] = json.dumps([{"place": {}, "cut": True, "cut_into": 4, "cut_levels": 3, "smallest": 0.0, **event}])
            if adaptation is not None:
                file.attrs["adaptation"] = json.dumps({"event": "SEUIL", "easy_steps": 1, "easy_iterations": 5, "rule": "FIXE", "percent": 100.0,
                                                       "reference": 5, "smallest": 1e-12, "largest": 0.0, "most": 100, **adaptation})
        run = self.solve(loads=["load_5", {"CHARGE": concept("load_6"), "FONC_MULT": concept("function_10")}],
                         INCREMENT={"LIST_INST": concept("time_steps_11")}, **({"CONVERGENCE": convergence} if convergence else {}))
        if run.status:
            return run, []
        with h5py.File(self.path("result_9")) as file:
            return run, file["instant"][:].tolist()

    def test_large_increments_cut_the_step(self):
        place = {"NOM_CHAM": "DEPL", "NOM_CMP": ["DX"], "NOEUD": ["N2"], "EVAL_CHAM": "VALE", "EVAL_CMP": "VALE", "EVAL_ELGA": "VALE"}
        run, instants = self.steps(event="DELTA_GRANDEUR", limit=0.3 * EXX, place=place)
        self.assertEqual(instants, [0, 0.25, 0.5, 0.75, 1])
        self.assertEqual(self.ids(run), ["EVOLUTION_7"])
        self.assertIn("DX at N2", run.messages[0]["text"])
        self.assertEqual(self.steps(event="DELTA_GRANDEUR", limit=1.1 * EXX, place=place)[1], [0, 1])
        self.assertEqual(self.steps(event="DELTA_GRANDEUR", limit=(1 - 1e-11) * EXX, place=place)[1], [0, 1])  # equal to it up to round-off
        self.assertEqual(self.steps(event="DELTA_GRANDEUR", limit=0.3 * EXX, place=place, cut=False)[0].status, 3)

    def test_large_increments_of_stresses_cut_the_step(self):
        """At any integration point; the stress goes from 0 to the pressure."""
        place = {"NOM_CHAM": "SIEF_ELGA", "NOM_CMP": ["SIYY"], "MAILLE": ["M4", "M5"], "EVAL_CHAM": "VALE", "EVAL_CMP": "VALE", "EVAL_ELGA": "EACH"}
        run, instants = self.steps(event="DELTA_GRANDEUR", limit=0.3 * PRESSURE, place=place)
        self.assertEqual(instants, [0, 0.25, 0.5, 0.75, 1])
        self.assertRegex(run.messages[0]["text"], r"SIYY at point \d of M\d")
        self.assertEqual(self.steps(event="DELTA_GRANDEUR", limit=1.1 * PRESSURE, place=place)[1], [0, 1])

    def test_large_residuals_fail_the_step(self):
        run, _ = self.steps(event="RESI_MAXI", limit=1e-30, cut=False)
        self.assertEqual((run.status, self.ids(run)), (3, ["STEP_1"]))
        self.assertEqual(self.steps(event="RESI_MAXI", limit=1e6)[1], [0, 1])

    def test_residuals_that_grow_fail_the_step(self):
        """Nothing meets 1e-30: residuals wander at round-off, and some time two are above the one before them."""
        endless = {"RESI_GLOB_MAXI": 1e-30, "ITER_GLOB_MAXI": 200}
        run, _ = self.steps(convergence=endless, event="DIVE_RESI", limit=0.0, cut=False)
        self.assertEqual((run.status, self.ids(run)), (3, ["STEP_4"]))
        self.assertEqual(self.steps(event="DIVE_RESI", limit=0.0)[1], [0, 1])

    def test_more_iterations(self):
        for more, most in ((0, 6), (50, 9), (25, 7)):
            run, _ = self.steps(convergence={"RESI_GLOB_MAXI": 1e-30, "ITER_GLOB_MAXI": 6}, more_iterations=more, event="RESI_MAXI", limit=1e9)
            self.assertIn(f"{most} iterations", run.messages[-1]["text"])

    def test_steps_grow(self):
        self.assertEqual(self.steps(adaptation={})[1], [0, 0.125, 0.375, 0.875, 1])
        self.assertEqual(self.steps(adaptation={"largest": 0.5, "percent": 300.0})[1], [0, 0.125, 0.625, 1])


if __name__ == "__main__":
    unittest.main()
