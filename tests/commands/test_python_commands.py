"""Commands that Python does itself: functions, lists, instants, materials; what their files hold."""

import json
import re
import sys
import unittest

import h5py

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import STUDY, LauncherTest  # noqa: E402

from lacon.base.functions import Piecewise  # noqa: E402
from lacon.core.messages import AsterError  # noqa: E402


class Functions(unittest.TestCase):
    def test_linear(self):
        f = Piecewise([0, 1, 3], [0, 10, 0])
        self.assertEqual([f.value(x) for x in (0, 0.5, 1, 2, 3)], [0, 5, 10, 5, 0])
        self.assertEqual(list(f.value([0.5, 2])), [5, 5])

    def test_logarithmic(self):
        f = Piecewise([1, 100], [1, 100], ("LOG", "LOG"))
        self.assertAlmostEqual(f.value(10), 10)
        self.assertAlmostEqual(Piecewise([1, 100], [0, 2], ("LOG", "LIN")).value(10), 1)
        self.assertAlmostEqual(Piecewise([0, 2], [1, 100], ("LIN", "LOG")).value(1), 10)

    def test_outside(self):
        for left, right, values in (("CONSTANT", "CONSTANT", (1, 3)), ("LINEAIRE", "LINEAIRE", (-1, 5))):
            f = Piecewise([0, 1], [1, 3], left=left, right=right)
            self.assertEqual((f.value(-1), f.value(2)), values)
        with self.assertRaisesRegex(AsterError, "RAMP has no value at 1.1"):
            Piecewise([0, 1], [1, 3]).value(1.1, "RAMP")

    def test_the_last_instant_within_round_off(self):
        self.assertEqual(Piecewise([0, 1], [0, 2]).value(sum([0.1] * 10) + 2e-16), 2)

    def test_one_point(self):
        self.assertEqual(Piecewise([1], [5], left="CONSTANT", right="CONSTANT").value(7), 5)
        self.assertEqual(Piecewise([1], [5]).value(1), 5)
        with self.assertRaises(AsterError):
            Piecewise([1], [5]).value(2)


class Formulas(LauncherTest):
    def test_values(self):
        self.ok(self.run_study("""
DEBUT()
a = 2
def double(x):
    return 2 * x
ramp = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, 10))
f = FORMULE(NOM_PARA=('X', 'Y'), VALE='a * X**2 + sin(Y) + c', c=0.5)
g = FORMULE(NOM_PARA='X', VALE='f(X, 0) + ramp(X) + double(X) + max(X, 0)')
h = FORMULE(NOM_PARA='X', VALE='''sum([i * X
    for i in range(3)])''')
a = 7
assert f(3, 0) == 18.5 and f(X=3, Y=0) == 18.5
assert g(0.5) == f(0.5, 0) + 5 + 1 + 0.5
assert h(2) == 6
assert f.getVariables() == ['X', 'Y'] and 'sin' in f.getExpression()
FIN()
"""))

    def test_a_later_run_has_them_with_their_constants(self):
        self.ok(self.run_study("""
DEBUT()
a = 2
twice = lambda x: 2 * x
F = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, 10))
L = [FORMULE(NOM_PARA='X', VALE='a * X + F(X)')]
g = FORMULE(NOM_PARA='X', VALE='twice(X)')
del F, a
FIN()
"""))
        self.write("more.comm", "POURSUITE()\nassert L[0](0.5) == 6\ng(1)\n")
        self.refused(self.launch("more.comm", "--base", "study.base"), "FORMULE_2", "g has no value at X = 1", "twice was not saved",
                     "more.comm:3")

    def test_mistakes(self):
        for line, *words in (("NOM_PARA='X', VALE='X +'", "FORMULE_1"), ("NOM_PARA='X', VALE='Xx + 1'", "FORMULE_4", "'Xx'", "nearest one is X"),
                             ("NOM_PARA='1X', VALE='1'", "FORMULE_3"), ("NOM_PARA=('X', 'in'), VALE='X'", "FORMULE_3", "'in'"),
                             ("NOM_PARA=('X', 'X'), VALE='X'", "KEYWORD_12"), ("NOM_PARA='X', VALE_C='X', VALE='1'", "KEYWORD_11")):
            with self.subTest(line):
                self.refused(self.run_study(f"DEBUT()\nf = FORMULE({line})\n"), "study.comm:2", *words)
                self.assertEqual(self.entries(), [])

    def test_a_point_without_value(self):
        self.refused(self.run_study("DEBUT()\nf = FORMULE(NOM_PARA='X', VALE='1 / X')\nf(0)\n"), "FORMULE_2", "X = 0", "ZeroDivisionError",
                     "study.comm:3")
        self.refused(self.run_study("DEBUT()\nf = FORMULE(NOM_PARA='X', VALE='1 / X')\nf(0, 1)\n"), "takes the parameters X")


class Commands(LauncherTest):
    def make(self, *lines):
        """Run the lines as X = ... . @return files of the concepts, open"""
        self.ok(self.run_study("DEBUT()\n" + "".join(f"X{i} = {line}\n" for i, line in enumerate(lines)) + "FIN()\n", "--fresh"))
        labels = self.registry()["labels"]
        files = [h5py.File(self.work / "study.base" / f"{labels[f'X{i}']}.h5") for i in range(len(lines))]
        for file in files:
            self.addCleanup(file.close)
        return files

    def refuses(self, line, *words):
        self.refused(self.run_study(f"DEBUT()\nX = {line}\n"), "study.comm:2", *words)
        self.assertEqual(self.entries(), [])

    def test_functions(self):
        files = self.make(
            "DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, 2), PROL_DROITE='LINEAIRE')",
            "DEFI_FONCTION(NOM_PARA='X', NOM_RESU='DX', ABSCISSE=(1, 2), ORDONNEE=(3, 4), INTERPOL='LOG')",
            "DEFI_FONCTION(NOM_PARA='X', VALE=(2, 20, 1, 10), VERIF='NON', INTERPOL=('LIN', 'LOG'))",
            "DEFI_FONCTION(NOM_PARA='X', VALE_PARA=DEFI_LIST_REEL(VALE=(0, 1)), VALE_FONC=DEFI_LIST_REEL(VALE=(5, 6)))")
        self.assertEqual([(list(f["x"]), list(f["y"])) for f in files],
                         [([0, 1], [0, 2]), ([1, 2], [3, 4]), ([1, 2], [10, 20]), ([0, 1], [5, 6])])
        self.assertEqual([list(f.attrs["interpolation"]) for f in files], [["LIN", "LIN"], ["LOG", "LOG"], ["LIN", "LOG"], ["LIN", "LIN"]])
        a = files[0].attrs
        self.assertEqual((a["parameter"], a["component"], a["extension_left"], a["extension_right"]), ("INST", "TOUTRESU", "EXCLU", "LINEAIRE"))

    def test_attributes_of_every_concept(self):
        (file,) = self.make("DEFI_MATERIAU(ELAS=_F(E=2000, NU=0.3, RHO=7800))")
        a = dict(file.attrs)
        self.assertEqual((a["lacon_type"], a["format"], a["version"], a["id"], a["label"], a["command"], a["references"]),
                         ("material", 1, 1, "material_1", "X0", "DEFI_MATERIAU", "[]"))
        self.assertIn('"E": 2000.0', a["keywords"])
        self.assertEqual(dict(file["ELAS"].attrs), {"E": 2000.0, "NU": 0.3, "RHO": 7800.0})
        self.assertEqual(list(file), ["ELAS"])

    def test_values_of_a_material(self):
        self.ok(self.run_study("""
DEBUT()
E = DEFI_FONCTION(NOM_PARA='TEMP', VALE=(0.0, 2000.0, 100.0, 1000.0))
NU = FORMULE(NOM_PARA='TEMP', VALE='0.3 + 0 * TEMP')
M = DEFI_MATERIAU(ELAS=_F(E=2000.0, NU=0.3))
F = DEFI_MATERIAU(ELAS_FO=_F(E=E, NU=NU))
assert M.RCVALE('ELAS', nomres=('E', 'NU'), stop=2) == ((2000.0, 0.3), (0, 0))
assert M.RCVALE('ELAS', nomres='RHO', stop=0) == ((0.0,), (1,)) == M.RCVALE('ECRO_LINE', nomres=('SY',), stop=0)
assert F.RCVALE('ELAS_FO', 'TEMP', 50.0, ('E', 'NU')) == ((1500.0, 0.3), (0, 0))
for wrong, words in ((lambda: M.RCVALE('ELAS', nomres='RHO'), 'MATERIAL_1'), (lambda: F.RCVALE('ELAS_FO', nomres='E'), 'FUNCTION_2')):
    try:
        wrong()
        raise SystemExit(words)
    except AsterError as error:
        assert words in str(error), error
FIN()
"""))

    def test_lists(self):
        files = self.make("DEFI_LIST_REEL(DEBUT=0, INTERVALLE=(_F(JUSQU_A=1, NOMBRE=2), _F(JUSQU_A=1.3, PAS=0.1)))",
                          "DEFI_LIST_REEL(VALE=(0, 0.5, 7))")
        values = list(files[0]["values"])
        self.assertEqual(len(values), 6)
        for made, expected in zip(values, (0, 0.5, 1, 1.1, 1.2, 1.3)):
            self.assertAlmostEqual(made, expected, 15)
        self.assertEqual(values[-1], 1.3, "the end to the bit")
        self.assertEqual(list(files[1]["values"]), [0, 0.5, 7])

    def test_many_steps_end_where_they_should(self):
        (file,) = self.make("DEFI_LIST_REEL(DEBUT=0, INTERVALLE=_F(JUSQU_A=1, PAS=0.001))")
        self.assertEqual((len(file["values"]), file["values"][-1]), (1001, 1.0))

    def test_instants(self):
        files = self.make("DEFI_LIST_INST(DEFI_LIST=_F(LIST_INST=DEFI_LIST_REEL(VALE=(0, 1))))",
                          "DEFI_LIST_INST(METHODE='MANUEL', DEFI_LIST=_F(VALE=(0, 1, 2)), ECHEC=_F(SUBD_PAS=5, SUBD_NIVEAU=6, SUBD_PAS_MINI=1e-3))",
                          "DEFI_LIST_INST(METHODE='AUTO', DEFI_LIST=_F(VALE=(0, 1)), ECHEC=_F(EVENEMENT='ERREUR', ACTION='ARRET'))")
        self.assertEqual([[f.attrs[k] for k in ("cut", "cut_into", "cut_levels", "smallest")] for f in files],
                         [[1, 4, 3, 0.0], [1, 5, 6, 1e-3], [0, 4, 3, 0.0]])
        self.assertEqual(list(files[1]["values"]), [0, 1, 2])
        self.assertFalse(any("events" in f.attrs for f in files))
        self.assertEqual(["adaptation" in f.attrs for f in files], [False, False, True])

    def test_events_and_adaptation(self):
        (file,) = self.make("""DEFI_LIST_INST(METHODE='AUTO', DEFI_LIST=_F(VALE=(0, 1), PAS_MAXI=0.5, PAS_MINI=1e-3, NB_PAS_MAXI=50),
            ECHEC=(_F(EVENEMENT='RESI_MAXI', RESI_GLOB_MAXI=1e3, ACTION='ARRET'),
                   _F(EVENEMENT='DELTA_GRANDEUR', NOM_CHAM='DEPL', NOM_CMP='DX', GROUP_NO='TOP', VALE_REF=0.1, SUBD_PAS=3)),
            ADAPTATION=_F(MODE_CALCUL_TPLUS='ITER_NEWTON', NB_ITER_NEWTON_REF=7, CRIT_COMP='LT', VALE_I=4))""")
        self.assertEqual([file.attrs[k] for k in ("cut", "cut_into", "cut_levels")], [1, 4, 3])
        self.assertEqual(json.loads(file.attrs["events"]), [
            {"event": "RESI_MAXI", "limit": 1e3, "place": {}, "cut": False, "cut_into": 4, "cut_levels": 3, "smallest": 0.0},
            {"event": "DELTA_GRANDEUR", "limit": 0.1, "cut": True, "cut_into": 3, "cut_levels": 3, "smallest": 0.0,
             "place": {"NOM_CHAM": "DEPL", "NOM_CMP": ["DX"], "GROUP_NO": ["TOP"], "EVAL_CHAM": "VALE", "EVAL_CMP": "VALE", "EVAL_ELGA": "EACH"}}])
        self.assertEqual(json.loads(file.attrs["adaptation"]), {
            "event": "SEUIL", "easy_steps": 2, "easy_iterations": 3, "rule": "ITER_NEWTON", "percent": 100.0, "reference": 7, "smallest": 1e-3,
            "largest": 0.5, "most": 50})

    def test_more_iterations_and_halves(self):
        files = self.make("DEFI_LIST_INST(DEFI_LIST=_F(VALE=(0, 1)), ECHEC=_F(ACTION='ITER_SUPPL', SUBD_METHODE='AUTO', SUBD_PAS_MINI=1e-3))",
                          "DEFI_LIST_INST(DEFI_LIST=_F(VALE=(0, 1)), ECHEC=_F(ACTION='ITER_SUPPL', PCENT_ITER_PLUS=80, SUBD_PAS=3))",
                          "DEFI_LIST_INST(DEFI_LIST=_F(VALE=(0, 1)), ECHEC=_F(EVENEMENT='DIVE_RESI', ACTION='DECOUPE', SUBD_PAS=5))")
        self.assertEqual([[f.attrs[k] for k in ("cut", "cut_into", "cut_levels", "smallest", "more_iterations")] for f in files],
                         [[1, 2, 10, 1e-3, 50], [1, 3, 3, 0.0, 80], [1, 4, 3, 0.0, 0]])
        self.assertEqual(json.loads(files[2].attrs["events"]), [
            {"event": "DIVE_RESI", "limit": 0.0, "place": {}, "cut": True, "cut_into": 5, "cut_levels": 3, "smallest": 0.0}])

    def test_what_has_no_effect_is_an_alarm(self):
        """Given by the command file, not by default; the list is made all the same."""
        for keywords, ignored in (
                ("DEFI_LIST=_F(VALE=(0, 1), PAS_MAXI=0.1)", ["DEFI_LIST/PAS_MAXI has no effect with METHODE='MANUEL'"]),
                ("METHODE='MANUEL', DEFI_LIST=[_F(VALE=(0, 1), PAS_MINI=0.1, NB_PAS_MAXI=1)]",
                 ["DEFI_LIST/PAS_MINI has no effect with METHODE='MANUEL'", "DEFI_LIST/NB_PAS_MAXI has no effect with METHODE='MANUEL'"]),
                ("DEFI_LIST=_F(VALE=(0, 1)), ECHEC=(_F(), _F(EVENEMENT='DIVE_RESI', ACTION='ARRET', SUBD_PAS=4, SUBD_PAS_MINI=0.1))",
                 ["ECHEC[2]/SUBD_PAS has no effect with ACTION='ARRET'", "ECHEC[2]/SUBD_PAS_MINI has no effect with ACTION='ARRET'"]),
                ("METHODE='AUTO', DEFI_LIST=_F(VALE=(0, 1)), ADAPTATION=_F(EVENEMENT='AUCUN', VALE_I=3, PCENT_AUGM=5.0)",
                 ["ADAPTATION/VALE_I has no effect with EVENEMENT='TOUT_INST' or 'AUCUN'", "ADAPTATION/PCENT_AUGM has no effect with EVENEMENT='AUCUN'"]),
                ("METHODE='AUTO', DEFI_LIST=_F(VALE=(0, 1), PAS_MAXI=0.1), ADAPTATION=_F(MODE_CALCUL_TPLUS='ITER_NEWTON', VALE_I=3)", []),
                ("METHODE='AUTO', DEFI_LIST=_F(VALE=(0, 1)), ADAPTATION=_F(MODE_CALCUL_TPLUS='ITER_NEWTON', NB_ITER_NEWTON_REF=4, PCENT_AUGM=5.0)",
                 ["ADAPTATION/PCENT_AUGM has no effect with EVENEMENT='SEUIL' or 'TOUT_INST' and MODE_CALCUL_TPLUS='ITER_NEWTON'"])):
            with self.subTest(keywords):
                run = self.run_study(f"DEBUT()\nX = DEFI_LIST_INST({keywords})\nFIN()\n", "--fresh")
                self.assertEqual((run.status, run.last), (0, "--- DIAGNOSTIC JOB : " + ("<A>_ALARM" if ignored else "OK")), run.err)
                self.assertEqual(re.findall("<A> <KEYWORD_17> DEFI_LIST_INST/(.*)", run.err), ignored)
                self.assertEqual(self.entries(), ["time_steps_1"])
        alarm = "DEBUT({})\nX = DEFI_LIST_INST(DEFI_LIST=_F(VALE=(0, 1), PAS_MAXI=0.1))\nFIN()\n"
        self.refused(self.run_study(alarm.format("ERREUR=_F(ALARME='EXCEPTION')"), "--fresh"), "<F> <KEYWORD_17>")
        self.assertNotIn("KEYWORD_17", self.ok(self.run_study(alarm.format("IGNORE_ALARM='KEYWORD_17'"), "--fresh")).err)

    def test_refused_events(self):
        self.refuses("DEFI_LIST_INST(DEFI_LIST=_F(VALE=(0, 1)), ECHEC=(_F(), _F()))", "DEFI_LIST_4", "ERREUR")
        self.refuses("DEFI_LIST_INST(DEFI_LIST=_F(VALE=(0, 1), PAS_MAXI=0.1), ADAPTATION=_F())", "KEYWORD_10")
        self.refuses("DEFI_LIST_INST(DEFI_LIST=_F(VALE=(0, 1)), ECHEC=_F(EVENEMENT='RESI_MAXI'))", "KEYWORD_2", "RESI_GLOB_MAXI")
        self.refuses("DEFI_LIST_INST(DEFI_LIST=_F(VALE=(0, 1)), ECHEC=_F(EVENEMENT='DIVE_RESI', ACTION='ITER_SUPPL'))", "DEFI_LIST_5", "DIVE_RESI")
        self.refuses("DEFI_LIST_INST(METHODE='AUTO', DEFI_LIST=_F(VALE=(0, 1), PAS_MINI=0.5, PAS_MAXI=0.2))", "DEFI_LIST_7", "0.5", "0.2")
        self.refuses("DEFI_LIST_INST(DEFI_LIST=_F(VALE=(0, 1)), ECHEC=_F(ACTION='DECOUPE', PCENT_ITER_PLUS=50))", "KEYWORD_10")
        self.refuses("DEFI_LIST_INST(DEFI_LIST=_F(VALE=(0, 1)), ECHEC=_F(SUBD_METHODE='AUTO', SUBD_PAS=4))", "KEYWORD_10")
        self.refuses("DEFI_LIST_INST(DEFI_LIST=_F(VALE=(0, 1)), ECHEC=_F(ACTION='CONTINUE'))", "KEYWORD_13")

    def test_refusals(self):
        self.refuses("DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 0, 1))", "DEFI_FONCTION_1", "DEFI_FONCTION/VALE")
        self.refuses("DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 0, 1), VERIF='NON')", "DEFI_FONCTION_1")
        self.refuses("DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1))", "DEFI_FONCTION_2", "3 numbers")
        self.refuses("DEFI_FONCTION(NOM_PARA='INST', ABSCISSE=(0, 1), ORDONNEE=(0,))", "DEFI_FONCTION_5")
        self.refuses("DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 1, 1, 1), INTERPOL='LOG')", "DEFI_FONCTION_4", "parameter")
        self.refuses("DEFI_LIST_REEL(DEBUT=0, INTERVALLE=_F(JUSQU_A=0, NOMBRE=1))", "DEFI_LIST_1", "INTERVALLE[1]/JUSQU_A")
        self.refuses("DEFI_LIST_REEL(DEBUT=0, INTERVALLE=_F(JUSQU_A=1, PAS=0.3))", "DEFI_LIST_2")
        self.refuses("DEFI_LIST_REEL(DEBUT=0, INTERVALLE=_F(JUSQU_A=1, PAS=3))", "DEFI_LIST_2")
        self.refuses("DEFI_LIST_REEL(VALE=(0, 2, 1))", "DEFI_LIST_1")
        self.refuses("DEFI_LIST_REEL(DEBUT=1e9, INTERVALLE=_F(JUSQU_A=1e9 + 1e-6, NOMBRE=100))", "DEFI_LIST_1", "INTERVALLE[1]")
        for much, path in (("NOMBRE=10**9", "INTERVALLE[1]"), ("PAS=1e-300", "INTERVALLE[1]/PAS"), ("PAS=5e-324", "inf")):
            self.refuses(f"DEFI_LIST_REEL(DEBUT=0, INTERVALLE=_F(JUSQU_A=1, {much}))", "DEFI_LIST_6", path)
        self.refuses("DEFI_LIST_ENTI(DEBUT=0, INTERVALLE=_F(JUSQU_A=10**15, PAS=1))", "DEFI_LIST_6", "1e+15")
        self.refuses("DEFI_LIST_INST(DEFI_LIST=_F(VALE=(1, 0)))", "DEFI_LIST_1")

    def test_a_list_of_one_instant(self):
        self.refused(self.run_study("DEBUT()\nL = DEFI_LIST_REEL(VALE=1)\nX = DEFI_LIST_INST(DEFI_LIST=_F(LIST_INST=L))\n"), "DEFI_LIST_3")

    def test_a_function_outside_its_points_in_a_command_file(self):
        self.refused(self.run_study("DEBUT()\nF = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, 1))\nF(2)\n"), "DEFI_FONCTION_3", "F has no value at 2")



class Copies(LauncherTest):
    def test_every_kind_of_concept_is_copied(self):
        """A copy has the content, and is a concept of its own: what changes or takes out the one leaves the other."""
        self.ok(self.run_study(STUDY + """
F = FORMULE(NOM_PARA='X', VALE='twice(X)', twice=lambda x: 2 * x)
T = CREA_TABLE(LISTE=_F(PARA='A', LISTE_R=(1., 2.)))
RAMP2, F2, T2, M2, R2 = COPIER(CONCEPT=RAMP), COPIER(CONCEPT=F), COPIER(CONCEPT=T), COPIER(CONCEPT=M), COPIER(CONCEPT=R)
assert RAMP2.Valeurs() == RAMP.Valeurs() and RAMP2.id != RAMP.id
assert F2(3) == 6 and M2.getGroupsOfCells() == M.getGroupsOfCells() and M2.getNumberOfNodes() == 6
before = R.getField('DEPL', 1).getValues()
T = CALC_TABLE(reuse=T, TABLE=T, ACTION=_F(OPERATION='SUPPRIME', NOM_PARA='A'))
assert T2.EXTR_TABLE().para == ['A']
DETRUIRE(NOM=(R, M2))
assert R2.getField('DEPL', 1).getValues() == before and R2.getModel() is MO
FIN()
"""))
        self.write("more.comm", "POURSUITE()\nassert R2.getField('DEPL', 1).getMesh() is M\nFIN()\n")
        self.ok(self.launch("more.comm", "--base", "study.base"))

    def test_the_check_knows_the_kind_of_a_copy(self):
        self.write("checked.comm", STUDY + "S = COPIER(CONCEPT=R)\nIMPR_RESU(RESU=_F(RESULTAT=S))\nFIN()\n")
        self.assertEqual(self.launch("check", "checked.comm", "--unit", "20=mesh.med").status, 0)


class Information(LauncherTest):
    def test_a_result_and_a_mesh_are_told(self):
        done = self.run_study(STUDY + """
INFO_RESU(RESULTAT=R)
INFO_RESU(RESULTAT=R, UNITE=45)
MACR_INFO_MAIL(MAILLAGE=M, TAILLE='OUI')
FIN()
""", "--unit", "45=told.txt")
        self.ok(done)
        for words in ("NUME_ORDRE", "INST", "DEPL +NOEU_DEPL_R +[0-9]+ ", "QUAD4 +2", "SEG2 +1", "BODY +GROUP_MA +2", "TOP +GROUP_NO +3",
                      "TOUT +1.00000E\\+00 +1.00000E\\+00", "BODY +1.00000E\\+00"):
            self.assertRegex(done.out, words)
        self.assertIn("NOEU_DEPL_R", (self.work / "told.txt").read_text())


class Integers(LauncherTest):
    def test_lists_of_integers_are_taken_where_several_are(self):
        self.ok(self.run_study(STUDY + """
assert DEFI_LIST_ENTI(VALE=(3, 1)).getValues() == [3, 1]
assert DEFI_LIST_ENTI(DEBUT=1, INTERVALLE=(_F(JUSQU_A=5, PAS=2), _F(JUSQU_A=8, NOMBRE=3))).getValues() == [1, 3, 5, 6, 7, 8]
orders = DEFI_LIST_ENTI(OPERATION='DEFI', VALE=(0, 1))
T = CREA_TABLE(RESU=_F(RESULTAT=R, NOM_CHAM='DEPL', LIST_ORDRE=orders, NOM_CMP='DX', GROUP_NO='ONE'))
assert T.EXTR_TABLE().NUME_ORDRE == T.EXTR_TABLE()['NUME_ORDRE'] and sorted(set(T.values()['NUME_ORDRE'])) == [0, 1]
DETRUIRE(NOM=orders)
FIN()
"""))
        for line, *words in (("DEFI_LIST_ENTI(DEBUT=1, INTERVALLE=_F(JUSQU_A=4, NOMBRE=2))", "DEFI_LIST_2"),
                             ("DEFI_LIST_ENTI(DEBUT=1, INTERVALLE=_F(JUSQU_A=4, PAS=2))", "DEFI_LIST_2", "2"),
                             ("DEFI_LIST_ENTI(DEBUT=1, INTERVALLE=_F(JUSQU_A=1, PAS=2))", "DEFI_LIST_1"),
                             ("DEFI_LIST_ENTI(OPERATION='NUME_ORDRE', VALE=1)", "KEYWORD_13", "getIndexes")):
            with self.subTest(line):
                self.refused(self.run_study(f"DEBUT()\nX = {line}\n"), *words)


if __name__ == "__main__":
    unittest.main()
