"""`lacon check`: everything but the solution is made and checked, in a base that disappears."""

import sys
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import CONTACT, STUDY, LauncherTest  # noqa: E402

REST = """CALC_CHAMP(reuse=R, RESULTAT=R, CONTRAINTE='SIEF_NOEU')
IMPR_RESU(UNITE=80, RESU=_F(RESULTAT=R))
TEST_RESU(RESU=_F(RESULTAT=R, NOM_CHAM='DEPL', NOM_CMP='DX', INST=1.0, NOEUD='N1', VALE_CALC=0.0))
"""


class Check(LauncherTest):
    def check(self, text, **more):
        self.write("study.comm", text)
        run = self.launch("check", "study.comm", "--unit", "20=mesh.med", **more)
        self.assertEqual(sorted(path.name for path in self.work.iterdir()), ["mesh.med", "study.comm"], "nothing is left behind")
        return run

    def operators(self):
        return [path.name.split(".")[0].partition("-")[2] for path in sorted(self.orders.glob("*.order.json"))]

    def test_a_study_that_is_right(self):
        run = self.check(STUDY + REST + "FIN()\n")
        self.assertEqual(run.status, 0, run.err)
        self.assertIn("study.comm: 14 commands are right", run.out)
        self.assertIn("up to the first instant: STAT_NON_LINE (line 11)\n  by their keywords alone: CALC_CHAMP (line 12), IMPR_RESU (line 13), TEST_RESU (line 14)", run.out)
        self.assertEqual(self.operators(), ["lire_maillage", "crea_maillage", "affe_modele", "affe_materiau", "affe_char_cine", "stat_non_line"])
        self.assertNotIn("at work", run.out)

    def test_a_command_file_may_leave_its_folder(self):
        """Also for one that is no longer there."""
        for leave in ("os.chdir('/')", "folder = tempfile.mkdtemp()\nos.chdir(folder)\nos.rmdir(folder)"):
            run = self.check(f"import os, tempfile\n{STUDY}{leave}\nFIN()\n")
            self.assertEqual(run.status, 0, run.err)
            self.assertIn("study.comm: 11 commands are right", run.out)

    def test_lines_of_several_files_say_which(self):
        self.write("first.comm", STUDY)
        self.write("second.comm", REST + "FIN()\n")
        run = self.launch("check", "first.comm", "second.comm", "--unit", "20=mesh.med")
        self.assertIn("first.comm, second.comm: 14 commands are right", run.out)
        self.assertIn("STAT_NON_LINE (first.comm:11)\n  by their keywords alone: CALC_CHAMP (second.comm:1), IMPR_RESU (second.comm:2), TEST_RESU (second.comm:3)", run.out)

    def test_up_to_a_value_that_only_a_run_can_give(self):
        text = STUDY + REST + "T = RECU_TABLE(CO=R, NOM_TABLE='OBSERVATION')\ntry:\n    n = T['VALE', 1]\nexcept Exception:\n    n = 0\nFIN(NO_SUCH=1)\n"
        run = self.check(text)
        self.assertEqual(run.status, 0, run.err)
        self.assertIn("checked up to study.comm:17: it needs what T holds, which only a run can give (T is made at study.comm:15)", run.out)
        run = self.check(STUDY + "T = RECU_TABLE(CO=R, NOM_TABLE='OBSERVATION')\nn = EXTR_TABLE(TABLE=T, TYPE_RESU='REEL', NOM_PARA='VALE')\nFIN(NO_SUCH=1)\n")
        self.assertEqual(run.status, 0, run.err)
        self.assertIn("checked up to study.comm:13: it needs what T holds", run.out)

    def test_mistakes_behind_the_solution_are_found(self):
        run = self.check(STUDY + REST.replace("SIEF_NOEU", "SIEF_NODE"))
        self.assertEqual(run.status, 2)
        self.assertIn("CALC_CHAMP/CONTRAINTE", run.err)

    def test_what_an_operator_refuses_is_found(self):
        wrong = {"affe_char_cine": {"status": 2, "messages": [{"severity": "F", "id": "MESH_1", "text": "no such group", "do": "correct it"}]}}
        run = self.check(STUDY, behaviour=wrong)
        self.assertEqual(run.status, 2)
        self.assertIn("<F> <MESH_1> no such group", run.err)

    def test_what_solves_is_refused_before_its_first_instant(self):
        wrong = {"stat_non_line": {"status": 2, "messages": [{"severity": "F", "id": "EVOLUTION_7", "text": "no material", "do": "give it"}]}}
        run = self.check(STUDY, behaviour=wrong)
        self.assertEqual(run.status, 2)
        self.assertIn("<F> <EVOLUTION_7> no material", run.err)

    def test_a_computation_behind_another_is_checked_by_its_keywords(self):
        again = "R2 = STAT_NON_LINE(MODELE=MO, CHAM_MATER=CM, EXCIT=_F(CHARGE=BC), INCREMENT=_F(LIST_INST=L), ETAT_INIT=_F(EVOL_NOLI=R))\n"
        run = self.check(STUDY + again)
        self.assertEqual(run.status, 0, run.err)
        self.assertIn("by their keywords alone: STAT_NON_LINE (line 12)", run.out)

    def test_a_contact_that_nothing_was_given_is_told(self):
        run = self.check(STUDY.replace("R = STAT", CONTACT + "R = STAT") + "FIN()\n")
        self.assertEqual(run.status, 0, run.err)
        self.assertEqual(run.err.count("STUDY_42"), 1, run.err)

    def test_the_base_of_the_study_is_left_alone(self):
        self.ok(self.run_study(STUDY + "FIN()\n"))
        before = {path.name: path.stat().st_mtime_ns for path in (self.work / "study.base").iterdir()}
        self.launch("check", "study.comm", "--unit", "20=mesh.med")
        self.assertEqual({path.name: path.stat().st_mtime_ns for path in (self.work / "study.base").iterdir()}, before)

    def test_refuses_what_is_not_there(self):
        run = self.launch("check", "nowhere.comm")
        self.assertEqual(run.status, 2)
        self.assertIn("STUDY_14", run.err)


if __name__ == "__main__":
    unittest.main()
