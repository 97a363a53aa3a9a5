"""A contact that no command was given, beside a computation of its model: STUDY_42 at FIN, once."""

import sys
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import CONTACT, STUDY, LauncherTest  # noqa: E402

HEAD, SOLVE = STUDY[:STUDY.index("R = ")], STUDY[STUDY.index("R = "):]
SOLVE_WITH = SOLVE.replace("CHAM_MATER", "CONTACT=C, CHAM_MATER")


class UnusedContacts(LauncherTest):
    def told(self, *texts):
        """How often, over runs of these texts one after the other."""
        runs = [self.run_study(text, "--base", "study.base", name=f"study{i}.comm") for i, text in enumerate(texts)]
        for run in runs:
            self.assertEqual(run.status, 0, run.out + run.err)
        self.err = "".join(run.err for run in runs)
        return [run.err.count("<A> <STUDY_42>") for run in runs]

    def test_where_a_computation_went_without(self):
        self.assertEqual(self.told(f"{HEAD}{CONTACT}{SOLVE}FIN()\n"), [1])
        self.assertIn("no command was given the contact C, and STAT_NON_LINE (study0.comm:13) computed its model without any", self.err)
        self.assertIn("where: DEFI_CONTACT, study0.comm:11", self.err)
        self.assertIn("CONTACT=C in STAT_NON_LINE", self.err)

    def test_not_elsewhere(self):
        other = "O = AFFE_MODELE(MAILLAGE=M, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='C_PLAN'))\n"
        for text in (CONTACT, SOLVE + CONTACT, CONTACT + SOLVE_WITH, CONTACT + SOLVE + SOLVE_WITH.replace("R = ", "R2 = "),
                     other + CONTACT.replace("MODELE=MO", "MODELE=O") + SOLVE, CONTACT + "DETRUIRE(CONCEPT=_F(NOM=C))\n" + SOLVE):
            self.assertEqual(self.told(f"{HEAD}{text}FIN()\n"), [0], text)

    def test_in_a_study_that_goes_on(self):
        made = f"{HEAD}{CONTACT}FIN()\n"
        go_on = "POURSUITE()\n{}FIN()\n"
        self.assertEqual(self.told(made, go_on.format(SOLVE_WITH)), [0, 0])
        self.assertEqual(self.told(made, go_on.format(SOLVE), go_on.format("")), [0, 1, 0])
        self.assertEqual(self.told(f"{HEAD}{CONTACT}{SOLVE_WITH}FIN()\n", go_on.format(SOLVE.replace("R = ", "R2 = "))), [0, 0])

    def test_files_of_one_run_are_one_study(self):
        self.write("first.comm", f"{HEAD}{CONTACT}{SOLVE}FIN()\n")
        for rest, count in ((SOLVE_WITH.replace("R = ", "R2 = "), 0), ("", 1)):
            self.write("second.comm", f"POURSUITE()\n{rest}FIN()\n")
            run = self.launch("first.comm", "second.comm", "--unit", "20=mesh.med")
            self.assertEqual((run.status, run.err.count("STUDY_42")), (0, count), run.err)

    def test_a_study_that_is_begun_again(self):
        self.assertEqual(self.told(f"{HEAD}{CONTACT}{SOLVE}FIN()\n", f"{HEAD}{SOLVE}FIN()\n"), [1, 0])


if __name__ == "__main__":
    unittest.main()
