"""INCLUDE, DEFI_FICHIER and INFO_EXEC_ASTER."""

import sys

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import STUDY, LauncherTest, main  # noqa: E402

TABLE = "T = CREA_TABLE(LISTE=_F(PARA='A', LISTE_I=(1, 2)))\n"


class Include(LauncherTest):
    def test_a_unit_and_a_name(self):
        self.write("part.21", "A = 3\nINNER = DEFI_LIST_REEL(VALE=(0., float(B)))\n")
        self.write("more.comm", "C = A + 1\n")
        text = "DEBUT()\nB = 2\nINCLUDE(UNITE=21)\nINCLUDE(DONNEE='more.comm')\nassert INNER.getValues() == [0, 2] and C == 4\nFIN()\n"
        self.ok(self.run_study(text, "--unit", "21=part.21"))
        self.assertIn("INNER", self.registry()["labels"])
        self.ok(self.run_study("POURSUITE()\nassert INNER.getValues() == [0, 2] and C == 4\nFIN()\n", name="study.com1"))
        run = self.launch("check", "study.comm", "--unit", "21=part.21")
        self.assertEqual(run.status, 0, run.out + run.err)

    def test_errors_name_their_file(self):
        cases = (("DEFI_LIST_REEL(VALE=(1., 0.))", "DEFI_LIST_1", "part.21:1"), ("1/0", "STUDY_19", "part.21:1"), ("a b", "STUDY_16", "part.21:1"))
        for part, *words in cases:
            self.write("part.21", part + "\n")
            self.refused(self.run_study("DEBUT()\nINCLUDE(UNITE=21)\n", "--unit", "21=part.21"), *words)
        self.refused(self.run_study("DEBUT()\nINCLUDE(DONNEE='none')\n"), "STUDY_14", "none")
        self.refused(self.run_study("DEBUT()\nINCLUDE(UNITE=22)\n"), "COMMAND_4")
        self.write("a.comm", "INCLUDE(UNITE=23)\n")
        self.write("b.comm", "INCLUDE(DONNEE='a.comm')\n")
        round_and_round = self.run_study("DEBUT()\nINCLUDE(DONNEE='a.comm')\n", "--unit", "23=b.comm")
        self.refused(round_and_round, "STUDY_49", "study.comm -> a.comm -> b.comm -> a.comm", "b.comm:1")
        self.assertNotIn("RecursionError", round_and_round.err)
        self.refused(self.run_study("DEBUT()\nINCLUDE(DONNEE='study.comm')\n"), "STUDY_49", "study.comm -> study.comm")
        self.write("twice.comm", "X = 1\n")
        self.ok(self.run_study("DEBUT()\nINCLUDE(DONNEE='twice.comm')\nINCLUDE(DONNEE='twice.comm')\nFIN()\n"))
        self.refused(self.run_study("DEBUT()\nINCLUDE(UNITE=22, DONNEE='part.21')\n"), "KEYWORD_6")

    def test_a_command_file_without_anything_is_told(self):
        """As one that a full disk has cut off: it ended as a study that had done its work."""
        for text in ("", "\n\n", "# DEBUT()\n"):
            self.refused(self.run_study(text), "STUDY_51", "study.comm")
        self.write("study.com1", "")
        self.write("study.comm", "DEBUT()\nFIN()\n")
        run = self.launch("study.comm", "study.com1")
        self.assertEqual((run.status, run.last), (0, "--- DIAGNOSTIC JOB : <A>_ALARM"), run.err)
        self.assertIn("<A> <STUDY_52>", run.err)
        self.assertIn("study.com1", run.err)

    def test_an_included_file_is_never_replaced(self):
        self.write("part.21", TABLE)
        self.refused(self.run_study("DEBUT()\nINCLUDE(UNITE=21)\nIMPR_TABLE(TABLE=T, UNITE=21)\n", "--unit", "21=part.21"), "COMMAND_12")
        self.assertEqual((self.work / "part.21").read_text(), TABLE)


class Units(LauncherTest):
    def test_a_file_by_its_name(self):
        self.ok(self.run_study(f"""DEBUT()
{TABLE}
def rows():
    with open('x.txt') as file:
        return sum(line.split() == ['1'] for line in file)
assert DEFI_FICHIER(ACTION='ASSOCIER', UNITE=39, FICHIER='x.txt') == 39
IMPR_TABLE(TABLE=T, UNITE=39)
IMPR_TABLE(TABLE=T, UNITE=39)
assert rows() == 2
DEFI_FICHIER(ACTION='LIBERER', UNITE=39)
DEFI_FICHIER(UNITE=39, FICHIER='x.txt', ACCES='APPEND')
IMPR_TABLE(TABLE=T, UNITE=39)
assert rows() == 3
DEFI_FICHIER(ACTION='LIBERER', FICHIER='x.txt')
unit = DEFI_FICHIER(ACTION='ASSOCIER', FICHIER='x.txt')
IMPR_TABLE(TABLE=T, UNITE=unit)
assert rows() == 1
FIN()
"""))

    def test_unit_6_is_the_terminal_unless_it_has_a_file(self):
        study = STUDY + TABLE + "IMPR_TABLE(TABLE=T, UNITE=6)\nIMPR_RESU(FORMAT='RESULTAT', UNITE=6, RESU=_F(RESULTAT=R))\nprint('behind')\nFIN()\n"
        run = self.ok(self.run_study(study, behaviour={"impr_resu": {"unit": "6"}}))
        self.assertRegex(run.out, r"(?s)\n +1\n +2\n.*\nwritten\n.*behind\n")
        self.assertEqual(sorted(path.name for path in self.work.iterdir()), ["mesh.med", "study.base", "study.comm"])
        self.ok(self.run_study(study, "--unit", "6=six.txt", behaviour={"impr_resu": {"unit": "6"}}))
        self.assertEqual((self.work / "six.txt").read_text(), "written\n")

    def test_a_released_unit_has_its_own_file_again(self):
        self.ok(self.run_study(f"""DEBUT()
{TABLE}
IMPR_TABLE(TABLE=T, UNITE=39)
DEFI_FICHIER(UNITE=39, FICHIER='x.txt')
IMPR_TABLE(TABLE=T, UNITE=39)
DEFI_FICHIER(ACTION='LIBERER', UNITE=39)
IMPR_TABLE(TABLE=T, UNITE=39)
FIN()
""", "--unit", "39=own.txt"))
        count = {name: (self.work / name).read_text().split().count("2") for name in ("x.txt", "own.txt")}
        self.assertEqual(count, {"x.txt": 1, "own.txt": 2})

    def test_errors(self):
        self.all_refused("DEBUT()", [
            ("DEFI_FICHIER(UNITE=39, FICHIER='none', ACCES='OLD')", "COMMAND_5"), ("DEFI_FICHIER(ACTION='LIBERER', FICHIER='none')", "COMMAND_16"),
            ("DEFI_FICHIER(ACTION='ASSOCIER')", "KEYWORD_8"),
            ("INFO_EXEC_ASTER(LISTE_INFO='ETAT_UNITE')", "KEYWORD_7")])

    def test_what_is_said_of_the_run(self):
        text = """DEBUT()
T = INFO_EXEC_ASTER(LISTE_INFO=('UNITE_LIBRE', 'CPU_RESTANT'))
free = T['UNITE_LIBRE', 1]
DEFI_FICHIER(UNITE=free, FICHIER='x.txt')
T1 = INFO_EXEC_ASTER(LISTE_INFO=('UNITE_LIBRE', 'ETAT_UNITE'), UNITE=free)
assert T1['UNITE_LIBRE', 1] != free and T1['ETAT_UNITE', 1] == 'OUVERT'
DEFI_FICHIER(ACTION='LIBERER', UNITE=free)
T2 = INFO_EXEC_ASTER(LISTE_INFO='ETAT_UNITE', UNITE=free)
assert T2['ETAT_UNITE', 1] == 'FERME'
assert LOW < T['CPU_RESTANT', 1] <= HIGH, T['CPU_RESTANT', 1]
FIN()
"""
        self.ok(self.run_study("LOW, HIGH = 1e9, float('inf')\n" + text))
        self.write("study.comm", "LOW, HIGH = 100, 1000\n" + text)
        self.write("study.export", "P time_limit 1000\nF comm study.comm D 1\n")
        self.ok(self.launch("study.export"))


if __name__ == "__main__":
    main()
