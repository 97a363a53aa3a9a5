"""TEST_RESU: what is read, how it is judged, what is printed. Rules: the peer's, as the inventory of its test cases states them."""

import json
import math
import os
import sys
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import STUDY, LauncherTest  # noqa: E402

from lacon.commands.checks import Check, Judgement, judge_calculated  # noqa: E402
from lacon.core.concepts import listed  # noqa: E402


class Rules(unittest.TestCase):
    """Judgement of one value against one target."""

    def test_relative(self):
        self.assertTrue(Judgement(-25.0000249, -25.0, 1e-6, "RELATIF").met)
        self.assertFalse(Judgement(-25.0000251, -25.0, 1e-6, "RELATIF").met)

    def test_absolute(self):
        self.assertTrue(Judgement(1e-7, 0.0, 1e-6, "ABSOLU").met)
        self.assertFalse(Judgement(1.1e-6, 0.0, 1e-6, "ABSOLU").met)

    def test_relative_to_zero_takes_nothing_but_zero(self):
        self.assertTrue(Judgement(0.0, 0.0, 1e-3, "RELATIF").met)
        self.assertFalse(Judgement(1e-300, 0.0, 1e-3, "RELATIF").met)

    def test_no_number_is_never_met(self):
        for value in (math.nan, math.inf, -math.inf):
            for criterion in ("RELATIF", "ABSOLU"):
                self.assertFalse(Judgement(value, 1.0, 1e30, criterion).met, value)
        self.assertFalse(Judgement(math.nan, 0.0, 1.0, "RELATIF").met)

    def test_zero_without_order_of_magnitude_is_not_judged(self):
        for criterion in ("RELATIF", "ABSOLU"):
            judgement = judge_calculated(5.0, 0.0, 1e-6, criterion)
            self.assertTrue(judgement.met)
            self.assertFalse(judgement.judged)

    def test_zero_with_order_of_magnitude_is_judged_absolutely(self):
        self.assertTrue(judge_calculated(0.9e-4, 1e-17, 1e-6, "RELATIF", 100.0).met)
        self.assertFalse(judge_calculated(1.1e-4, 1e-17, 1e-6, "RELATIF", 100.0).met)

    def test_order_of_magnitude_does_not_matter_away_from_zero(self):
        self.assertFalse(judge_calculated(1.1, 1.0, 1e-6, "RELATIF", 1e9).met)

    def status(self, calculated, reference, strict=False):
        check = Check("", "", "", "", "", None, "", 1.0)
        check.judge(Judgement(1.0, calculated, 1e-6, "RELATIF"),
                    None if reference is None else Judgement(1.0, reference, 1e-3, "RELATIF"), "ANALYTIQUE", strict)
        return check.status

    def test_statuses(self):
        self.assertEqual(self.status(1.0, None), "OK")
        self.assertEqual(self.status(1.0, 1.0), "OK")
        self.assertEqual(self.status(1.1, None), "NOOK")
        self.assertEqual(self.status(1.1, 1.0), "DIFF")
        self.assertEqual(self.status(1.0, 1.1), "NOOK")
        self.assertEqual(self.status(1.1, 1.1), "NOOK")
        self.assertEqual(self.status(1.1, None, strict=True), "NOOK")
        self.assertEqual(self.status(1.1, 1.0, strict=True), "NOOK")


class Readings(LauncherTest):
    """What each way of naming a place reads, in one study: expected values are in stand_in.py."""

    def checks(self, *lines, options=()):
        """Run checks of R, a check a line from line 2 on. @return (run, their figures)"""
        if not (self.work / "study.base").exists():
            self.ok(self.run_study(STUDY + "FIN()\n"))
        tests = "".join(f"TEST_RESU(RESU=_F(RESULTAT=R, {line}))\n" for line in lines)
        self.write("check.comm", f"POURSUITE()\n{tests}FIN()\n")
        run = self.launch("check.comm", "--base", "study.base", "--json", "checks.json", *options)
        return run, json.loads((self.work / "checks.json").read_text())["checks"]

    def test_values(self):
        expected = [
            ("INST=1.0, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N4'", 4.0),
            ("INST=0.5, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N4'", 2.0),
            ("NUME_ORDRE=1, NOM_CHAM='DEPL', NOM_CMP='DX', GROUP_NO='ONE'", 2.0),
            ("INST=1.0, NOM_CHAM='DEPL', NOM_CMP='DX', GROUP_NO='TOP', TYPE_TEST='SOMM'", 15.0),
            ("INST=1.0, NOM_CHAM='DEPL', NOM_CMP='DX', GROUP_MA='SKIN', TYPE_TEST='MAX'", 2.0),
            ("INST=1.0, NOM_CHAM='DEPL', NOM_CMP='DX', TYPE_TEST='MAX'", 6.0),
            ("INST=1.0, NOM_CHAM='DEPL', NOM_CMP='LAGS_C', TYPE_TEST='MAX'", -25.0),
            ("INST=1.0, NOM_CHAM='DEPL', NOM_CMP='LAGS_C', TYPE_TEST='SOMM_ABS'", 50.0),
            ("INST=1.0, NOM_CHAM='DEPL', NOM_CMP='LAGS_C', NOEUD='N2', VALE_ABS='OUI'", 25.0),
            ("INST=1.0, NOM_CHAM='CONT_ELEM', NOM_CMP='PRES', TYPE_TEST='MIN'", -25.0),
            ("INST=1.0, NOM_CHAM='CONT_ELEM', NOM_CMP='PRES', GROUP_MA='SKIN'", -25.0),
            ("INST=1.0, NOM_CHAM='CONT_ELEM', NOM_CMP='PRES', MAILLE='M3'", -25.0),
            ("INST=1.0, NOM_CHAM='SIEF_ELGA', NOM_CMP='SIYY', MAILLE='M2', POINT=1", 3.0),
            ("INST=1.0, NOM_CHAM='SIEF_ELGA', NOM_CMP='SIYY', MAILLE='M2', POINT=1, SOUS_POINT=1", 3.0),
            ("INST=1.0, NOM_CHAM='SIEF_ELGA', NOM_CMP='SIYY', GROUP_MA='BODY', TYPE_TEST='MIN'", -4.0),
            ("INST=1.0, NOM_CHAM='SIEF_ELGA', NOM_CMP='SIYY', TYPE_TEST='MAX_ABS'", 4.0),
            ("INST=1.0, NOM_CHAM='SIEF_ELGA', NOM_CMP='SIYY', TYPE_TEST='MIN_ABS'", 1.0),
            ("INST=1.0, NOM_CHAM='SIEF_ELNO', NOM_CMP='SIYY', MAILLE='M2', NOEUD='N5'", 8.0),
            ("INST=1.0, NOM_CHAM='SIEF_ELNO', NOM_CMP='SIYY', MAILLE='M2', POINT=2", 6.0),
            # what stands in for no value is no extreme, nor a part of a sum, but where nothing else is
            ("INST=1.0, NOM_CHAM='STAND_IN', NOM_CMP='JEU', MAILLE='M1'", -1.0),
            ("INST=1.0, NOM_CHAM='STAND_IN', NOM_CMP='JEU', TYPE_TEST='MIN'", 0.25),
            ("INST=1.0, NOM_CHAM='STAND_IN', NOM_CMP='JEU', TYPE_TEST='SOMM_ABS'", 0.75),
            ("INST=1.0, NOM_CHAM='STAND_IN', NOM_CMP='JEU', MAILLE='M1', TYPE_TEST='MIN'", -1.0),
            ("NUME_ORDRE=1, PARA='INST'", 0.5),
        ]
        run, made = self.checks(*(f"{place}, VALE_CALC={value}" for place, value in expected))
        self.ok(run)
        self.assertEqual([c["value"] for c in made], [value for _, value in expected])
        self.assertEqual({c["status"] for c in made}, {"OK"})
        self.assertIn(f"{len(expected)} checks: {len(expected)} OK, 0 NOOK, 0 DIFF", run.out)

    def test_vale_abs_compares_magnitudes(self):
        """LAGS_C is -25, and so may the references be; a magnitude that differs is missed."""
        place = "INST=1.0, NOM_CHAM='DEPL', NOM_CMP='LAGS_C', NOEUD='N2', VALE_ABS='OUI', REFERENCE='ANALYTIQUE'"
        run, made = self.checks(f"{place}, VALE_CALC=-25.0, VALE_REFE=-25.0", f"{place}, VALE_CALC=-25.0, VALE_REFE=25.0",
                                f"{place}, VALE_CALC=25.0, VALE_REFE=-25.0", f"{place}, VALE_CALC=25.0, VALE_REFE=-24.0")
        self.assertEqual([c["status"] for c in made], ["OK", "OK", "OK", "NOOK"], run.out)
        self.assertEqual([(c["value"], c["vale_refe"]["value"]) for c in made], [(25.0, 25.0)] * 3 + [(25.0, 24.0)])

    def test_the_json_has_every_figure(self):
        _, made = self.checks("INST=1.0, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N4', VALE_CALC=4.1, VALE_REFE=5.0, REFERENCE='ANALYTIQUE',"
                              "PRECISION=0.01, LEGENDE='a word'")
        self.assertEqual(made, [{
            "status": "NOOK", "where": "check.comm:2", "label": "R", "field": "DEPL", "component": "DX", "place": "N4", "instant": 1.0,
            "legend": "a word", "value": 4.0, "reference": "ANALYTIQUE",
            "vale_calc": {"value": 4.1, "error": abs(4.0 - 4.1) / 4.1, "tolerance": 1e-6, "criterion": "RELATIF", "judged": True, "met": False},
            "vale_refe": {"value": 5.0, "error": 0.2, "tolerance": 0.01, "criterion": "RELATIF", "judged": True, "met": False}}])

    def test_digits_without_a_reference_are_the_reference(self):
        run, made = self.checks("INST=1.0, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N4', VALE_CALC=7.2")
        self.assertEqual((run.status, run.last, made[0]["status"]), (5, "--- DIAGNOSTIC JOB : NOOK_TEST_RESU", "NOOK"))
        self.assertRegex(run.out, r"(?m)^NOOK .*VALE_CALC +7.2 ")

    def test_diff_is_no_failure_and_checks_all_makes_it_one(self):
        line = "INST=1.0, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N4', VALE_CALC=4.1, VALE_REFE=4.0, REFERENCE='ANALYTIQUE'"
        run, made = self.checks(line)
        self.ok(run)
        self.assertEqual(made[0]["status"], "DIFF")
        self.assertRegex(run.out, r"(?m)^DIFF +R +DEPL +DX +N4 +INST 1 +4 +VALE_CALC +4.1 +error +2.44e-02 +tolerance 1.0e-06 rel  \(check.comm:2\)$")
        run, made = self.checks(line, options=("--checks", "all"))
        self.assertEqual((run.status, run.last, made[0]["status"]), (5, "--- DIAGNOSTIC JOB : NOOK_TEST_RESU", "NOOK"))
        self.assertRegex(run.out, r"(?m)^NOOK ")

    def test_the_line_shows_what_was_missed(self):
        run, _ = self.checks("INST=1.0, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N4', VALE_CALC=4.1, VALE_REFE=4.0, REFERENCE='ANALYTIQUE'",
                             "INST=1.0, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N4', VALE_CALC=4.0, VALE_REFE=4.0, REFERENCE='ANALYTIQUE'")
        self.assertRegex(run.out, r"(?m)^DIFF .*VALE_CALC +4.1")
        self.assertRegex(run.out, r"(?m)^OK .*reference +4 ")

    def test_a_message_about_an_instant_names_those_around_it(self):
        """Of many; the first ones where none is asked for."""
        instants = [(order, order / 10) for order in range(40)]
        self.assertEqual(listed(instants[:2], 7.0), "0 (INST 0), 1 (INST 0.1)")
        self.assertRegex(listed(instants), r"^0 \(INST 0\), .*, 11 \(INST 1.1\), \.\.\.$")
        self.assertRegex(listed(instants, 2.04), r"^\.\.\., 15 \(INST 1.5\), .*, 26 \(INST 2.6\), \.\.\.$")
        self.assertRegex(listed(instants, 9.0), r"^\.\.\., 28 \(INST 2.8\), .*, 39 \(INST 3.9\)$")

    def test_two_tolerances_and_two_criteria(self):
        line = "INST={}, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N4', VALE_CALC=4.0, TOLE_MACHINE=({}), CRITERE=({})"
        self.ok(self.checks(line.format(1.0000009, "1e-6,", "'RELATIF',"))[0])
        self.refused(self.checks(line.format(1.00001, "1e-6,", "'RELATIF',"))[0], "TEST_RESU_1", "instant 1.00001", "0 (INST 0), 1 (INST 0.5)")
        self.ok(self.checks(line.format(1.00001, "1e-6, 1e-4", "'RELATIF',"))[0])
        run, made = self.checks(line.format(1.3, "1e-6, 0.4", "'RELATIF', 'ABSOLU'"))
        self.ok(run)
        self.assertEqual(made[0]["instant"], 1.0)
        self.refused(self.checks(line.format(0.9, "1e-6, 0.5", "'RELATIF', 'ABSOLU'"))[0], "TEST_RESU_2", "0.5, 1")

    def test_the_instant_zero(self):
        self.ok(self.checks("INST=0, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N4', VALE_CALC=0, ORDRE_GRANDEUR=1.0")[0])

    def test_zero_and_its_order_of_magnitude(self):
        place = "INST=1.0, NOM_CHAM='CONT_ELEM', NOM_CMP='JEU', MAILLE='M3', VALE_CALC=0.0, CRITERE='ABSOLU'"
        run, made = self.checks(place, place + ", ORDRE_GRANDEUR=1.0, VALE_REFE=0.0, REFERENCE='ANALYTIQUE'", place + ", ORDRE_GRANDEUR=1e-6")
        self.assertEqual([c["status"] for c in made], ["OK", "OK", "NOOK"])
        self.assertIn("not judged", run.out)
        self.assertEqual([c["vale_calc"]["tolerance"] for c in made[1:]], [1e-6, 1e-12])

    def test_a_value_that_is_no_number(self):
        run, made = self.checks("INST=1.0, NOM_CHAM='BAD', NOM_CMP='X', NOEUD='N1', VALE_CALC=1.0, VALE_REFE=1.0, REFERENCE='ANALYTIQUE'")
        self.assertEqual((run.status, made[0]["status"], made[0]["value"]), (5, "NOOK", "nan"))

    def test_integers_of_an_instant(self):
        run, made = self.checks("INST=1.0, PARA='ITER_GLOB', VALE_CALC_I=3, VALE_REFE_I=3, REFERENCE='NON_DEFINI'",
                                "NUME_ORDRE=2, PARA='ITER_GLOB', VALE_CALC=3.0", "NUME_ORDRE=2, PARA='ITER_GLOB', VALE_CALC_I=4")
        self.assertEqual([(c["status"], c["value"]) for c in made], [("OK", 3), ("OK", 3), ("NOOK", 3)])
        self.assertRegex(run.out, r"(?m)^OK +R +ITER_GLOB +INST 1 +3 +reference +3 ")

    def test_meshes(self):
        test = "TEST_RESU(MAILLAGE=({}))\nFIN()\n".format(", ".join(
            f"_F(MAILLAGE=M, CARA='{cara}', VALE_CALC_I={n}, VALE_REFE_I={n}, REFERENCE='ANALYTIQUE')"
            for cara, n in (("NB_NOEUD", 6), ("NB_MAILLE", 3), ("NB_GROUP_MA", 2), ("NB_GROUP_NO", 2),
                            ("NB_MA_GROUP_MA', NOM_GROUP_MA='SKIN", 1), ("NB_NO_GROUP_NO', NOM_GROUP_NO='TOP", 3))))
        run = self.ok(self.run_study(STUDY + test))
        self.assertRegex(run.out, r"(?m)^OK +M +NB_NOEUD +6 +reference +6 ")
        self.assertRegex(run.out, r"(?m)^OK +M +NB_NO_GROUP_NO TOP +3 +reference +3 ")
        for given, identifier in (("NB_MA_GROUP_MA", "KEYWORD_2"), ("NB_MA_GROUP_MA', NOM_GROUP_MA='SKINN", "TEST_RESU_9")):
            self.refused(self.run_study(STUDY + f"TEST_RESU(MAILLAGE=_F(MAILLAGE=M, CARA='{given}', VALE_CALC_I=1))\n"), identifier)
        run = self.run_study(STUDY + "TEST_RESU(MAILLAGE=_F(MAILLAGE=M, CARA='NB_NOEUD', VALE_CALC_I=7))\n")
        self.assertRegex(run.out, r"(?m)^NOOK ")

    def test_lines_are_aligned(self):
        run, _ = self.checks(*(f"INST=1.0, NOM_CHAM='{f}', NOM_CMP='{c}', TYPE_TEST='{t}', VALE_CALC=1" for f, c, t in
                               (("DEPL", "LAGS_C", "MIN"), ("CONT_ELEM", "PRES", "SOMM_ABS"), ("SIEF_ELGA", "SIYY", "MAX"))))
        lines = [line for line in run.out.splitlines() if line.startswith(("OK", "NOOK"))]
        self.assertEqual(len({line.index("VALE_CALC") for line in lines}), 1, lines)

    def test_refusals(self):
        for line, identifier, word in (
                ("NUME_ORDRE=7, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N1'", "TEST_RESU_1", "order number 7"),
                ("INST=1, NOM_CHAM='VITE', NOM_CMP='DX', NOEUD='N1'", "TEST_RESU_3", "CONT_ELEM"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='DZ', NOEUD='N1'", "TEST_RESU_4", "DX, LAGS_C"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N1', POINT=1", "TEST_RESU_5", "POINT"),
                ("INST=1, NOM_CHAM='CONT_ELEM', NOM_CMP='PRES', NOEUD='N1'", "TEST_RESU_5", "NOEUD"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='LAGS_C', NOEUD='N1'", "TEST_RESU_6", "N1"),
                ("INST=1, NOM_CHAM='CONT_ELEM', NOM_CMP='PRES', GROUP_MA='BODY'", "TEST_RESU_6", "BODY"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='DX', GROUP_NO='TOP'", "TEST_RESU_7", "3 values"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='DX', GROUP_NO='TOP'", "TEST_RESU_7", "or add TYPE_TEST"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N7'", "TEST_RESU_8", "N1 to N6"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='A1'", "TEST_RESU_8", "A1"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='DX', GROUP_NO='TOPP'", "TEST_RESU_9", "nearest one is TOP"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='DX', GROUP_NO='SKIN'", "TEST_RESU_9", "cell group of this name, which GROUP_MA takes"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='DX'", "KEYWORD_8", "TYPE_TEST"),
                ("NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N1'", "KEYWORD_7", "INST"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N1', VALE_REFE=1.0", "KEYWORD_2", "REFERENCE"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N1', REFERENCE='ANALYTIQUE'", "KEYWORD_2", "VALE_REFE"),
                ("INST=1, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N1', VALE_CALC_I=1", "KEYWORD_10", "VALE_CALC_I"),
                ("INST=1, NOM_CHAM='DEPL', PARA='INST'", "KEYWORD_10", "NOM_CHAM"),
                ("INST=1, NOM_CMP='DX', NOEUD='N1'", "KEYWORD_2", "NOM_CHAM"),
                ("INST=1, PARA='ITER_GLOBE'", "TABLE_13", "nearest one is ITER_GLOB")):
            with self.subTest(line):
                run, made = self.checks(line + ", VALE_CALC=1.0")
                self.refused(run, identifier, word, "check.comm:2")
                self.assertEqual(made, [])

    def test_a_json_that_cannot_be_written(self):
        """Before the study runs."""
        for name, reason in (("nowhere/checks.json", "No such file"), (".", "Is a directory"), ("study.comm/checks.json", "No such file")):
            run = self.run_study("DEBUT()\nFIN()\n", "--json", name)
            self.assertEqual((run.status, "DEBUT" in run.out), (2, False), run.err)
            self.assertIn(f"<F> <STUDY_50> '{name}' cannot be written: {reason}", run.err)
            self.assertIn("or give --json another place", run.err)

    def test_a_device_for_the_figures_stays_one(self):
        (self.work / "sink").symlink_to(os.devnull)
        self.ok(self.run_study("DEBUT()\nFIN()\n", "--json", "sink"))
        self.assertTrue((self.work / "sink").is_char_device())


if __name__ == "__main__":
    unittest.main()
