"""`lacon check` on real operators: what the solution refuses before its first instant is found without solving."""

import unittest

from faults.small_study import STUDY, SmallStudy


class Check(SmallStudy):
    def check(self, *replaced):
        text = STUDY
        for old, new in zip(replaced[::2], replaced[1::2]):
            self.assertIn(old, text)
            text = text.replace(old, new)
        (self.folder / "study.comm").write_text(text, encoding="utf-8")
        return self.run_tool("check", "study.comm", "--unit", "20=blocks.med")

    def test_a_study_that_is_right_goes_up_to_its_first_instant(self):
        run = self.check("DEBUT()", "DEBUT()")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("up to the first instant: STAT_NON_LINE", run.stdout)
        self.assertNotIn("INST", run.stdout.upper().replace("INSTANT", ""))
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["blocks.med", "study.comm"])

    def test_a_body_without_material(self):
        run = self.check('AFFE=_F(TOUT="OUI", MATER=STEEL)', 'AFFE=_F(GROUP_MA="VBOT", MATER=STEEL)')
        self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
        self.assertIn("where: STAT_NON_LINE", run.stderr)

    def test_a_behaviour_whose_parameters_the_material_lacks(self):
        run = self.check('RELATION="ELAS"', 'RELATION="VMIS_ISOT_LINE"')
        self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
        self.assertIn("where: STAT_NON_LINE", run.stderr)

    def test_a_group_that_what_follows_the_solution_names_and_no_mesh_has(self):
        """The hours of the solution are not spent before a word that is wrong is found."""
        table = 'T = POST_RELEVE_T(ACTION=_F(INTITULE="F", RESULTAT=RESULT, NOM_CHAM="DEPL", GROUP_NO="VBOT", OPERATION="EXTRACTION", NOM_CMP="DX"))'
        run = self.check("FIN()", f"{table}\nFIN()")
        self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
        self.assertIn("<F> <TEST_RESU_9> there is no group of nodes 'VBOT'; there is a cell group of this name, which GROUP_MA takes", run.stderr)
        self.assertIn("where: POST_RELEVE_T/ACTION[1]/GROUP_NO, study.comm:", run.stderr)

    def test_instants_that_are_not_there(self):
        run = self.check("INCREMENT=_F(LIST_INST=TIMES)", "INCREMENT=_F(LIST_INST=TIMES, INST_FIN=7.0)")
        self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
        self.assertIn("where: STAT_NON_LINE", run.stderr)

    def test_components_that_what_is_watched_has_not(self):
        """Of OBSERVATION, SUIVI_DDL and ECHEC; those that it has are right, and their values are not printed."""
        watch = "INCREMENT=_F(LIST_INST=TIMES), {}=_F(NOM_CHAM='DEPL', NOM_CMP='{}', EVAL_CHAM='MAX', TOUT='OUI')"
        event = "INCREMENT=_F(LIST_INST=DEFI_LIST_INST(DEFI_LIST=_F(LIST_INST=TIMES), ECHEC=_F(EVENEMENT='DELTA_GRANDEUR', VALE_REF=1e3, NOM_CHAM='DEPL', NOM_CMP='{}')))"
        for words in (watch.format("OBSERVATION", "{}"), watch.format("SUIVI_DDL", "{}"), event):
            run = self.check("INCREMENT=_F(LIST_INST=TIMES)", words.format("DRX"))
            self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
            self.assertRegex(run.stderr, r"<F> <OBSERVATION_\d> .*DRX")
            run = self.check("INCREMENT=_F(LIST_INST=TIMES)", words.format("DZ"))
            self.assertEqual((run.returncode, "DZ" in run.stdout), (0, False), run.stdout + run.stderr)

    def test_loads_without_value_at_the_first_instant_or_the_last(self):
        load = "FORCE_INTERNE=_F(GROUP_MA='VTOP', FZ=F)"
        for formula, made in (("log(INST - 10)", load), ("1 / (INST - 1)", load), ("log(X - 10)", load), ("log(INST - 10)", "PRES_REP=_F(GROUP_MA='TOP', PRES=F)"),
                              ("INST", load)):
            given = f"F = FORMULE(NOM_PARA=('X', 'INST'), VALE='{formula}')\nLOAD = AFFE_CHAR_MECA_F(MODELE=MODEL, {made})\nRESULT = STAT_NON_LINE("
            run = self.check("RESULT = STAT_NON_LINE(", given, "EXCIT=(_F(CHARGE=HOLD),", "EXCIT=(_F(CHARGE=LOAD), _F(CHARGE=HOLD),")
            self.assertEqual(run.returncode, 0 if formula == "INST" else 2, run.stdout + run.stderr)
            self.assertEqual("<FORMULE_2>" in run.stderr, formula != "INST", run.stderr)


if __name__ == "__main__":
    unittest.main()
