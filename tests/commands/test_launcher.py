"""The launcher: units, exports, exit statuses, the diagnosis, alarms, exceptions in command files, orders."""

import json
import os
import subprocess
import sys
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import ROOT, STUDY, LauncherTest  # noqa: E402

from lacon.base.processor import available_cores  # noqa: E402


def said(severity, identifier="MODELE1_63"):
    return {"severity": severity, "id": identifier, "text": "something to say", "do": "nothing"}


class Endings(LauncherTest):
    def ends(self, run, status, diagnostic):
        self.assertEqual((run.status, run.last), (status, f"--- DIAGNOSTIC JOB : {diagnostic}"), run.out + run.err)

    def test_done(self):
        self.ends(self.run_study(STUDY + "FIN()\n"), 0, "OK")

    def test_alarms(self):
        self.ends(self.run_study(STUDY + "FIN()\n", behaviour={"affe_modele": {"messages": [said("A")]}}), 0, "<A>_ALARM")

    def test_information_is_no_alarm(self):
        self.ends(self.run_study(STUDY + "FIN()\n", behaviour={"affe_modele": {"messages": [said("I")]}}), 0, "OK")

    def test_alarms_as_exceptions(self):
        text = STUDY.replace("DEBUT()", "DEBUT(ERREUR=_F(ALARME='EXCEPTION'))") + "FIN()\n"
        self.ends(self.run_study(text, behaviour={"affe_modele": {"messages": [said("A")]}}), 2, "<F>_ERROR")

    def test_ignored_alarms_are_neither_seen_nor_counted(self):
        text = STUDY.replace("DEBUT()", "DEBUT(ERREUR=_F(ALARME='EXCEPTION'), IGNORE_ALARM=('MODELE1_63', 'OTHER_1'))") + "FIN()\n"
        run = self.run_study(text, behaviour={"affe_modele": {"messages": [said("A"), said("I", "MESH_2")]}})
        self.ends(run, 0, "OK")
        self.assertNotIn("MODELE1_63", run.err)
        self.assertIn("<I> <MESH_2>", run.err)

    def test_user_error(self):
        self.ends(self.run_study(STUDY, behaviour={"crea_maillage": {"status": 2}}), 2, "<F>_ERROR")

    def test_no_convergence(self):
        behaviour = {"stat_non_line": {"status": 3, "messages": [said("S", "MECANONLINE9_7")]}}
        self.ends(self.run_study(STUDY, behaviour=behaviour), 3, "<S>_NO_CONVERGENCE")

    def test_a_singular_matrix_or_no_memory(self):
        for identifier in ("SOLVER_1", "MEMORY_1"):
            self.ends(self.run_study(STUDY, behaviour={"stat_non_line": {"status": 3, "messages": [said("S", identifier)]}}), 3, "<S>_ERROR")

    def test_internal_error(self):
        for behaviour in ({"status": 4}, {"status": 77}, {"kill": 6}):
            self.ends(self.run_study(STUDY, behaviour={"stat_non_line": behaviour}), 4, "<F>_ABNORMAL_ABORT")

    def test_an_operator_that_cannot_be_started_is_told_with_what_to_look_at(self):
        run = self.run_study(STUDY, behaviour={"affe_modele": {"status": 127}})
        self.ends(run, 4, "<F>_ABNORMAL_ABORT")
        self.assertIn("<INTERNAL_4> the operator affe_modele cannot be started", run.err)

    def test_a_check_that_is_missed(self):
        check = "TEST_RESU(MAILLAGE=_F(MAILLAGE=M, CARA='NB_NOEUD', VALE_CALC_I=6, REFERENCE='ANALYTIQUE', VALE_REFE_I={}))\nFIN()\n"
        self.ends(self.run_study(STUDY + check.format(7)), 5, "NOOK_TEST_RESU")
        self.ends(self.run_study(STUDY + check.format(6)), 0, "OK")

    def test_an_error_counts_more_than_a_missed_check(self):
        check = "TEST_RESU(MAILLAGE=_F(MAILLAGE=M, CARA='NB_NOEUD', VALE_CALC_I=6, REFERENCE='ANALYTIQUE', VALE_REFE_I=7))\n"
        run = self.run_study(STUDY + check + "1/0\n")
        self.ends(run, 2, "<F>_ERROR")
        self.assertIn("1 NOOK", run.out)

    def test_python_errors_name_the_users_line(self):
        self.write("helper.py", "def f(x):\n    return 1 / x\n")
        run = self.refused(self.run_study("from helper import f\nDEBUT()\nf(0)\n"), "STUDY_19", "ZeroDivisionError", "helper.py:2")
        self.assertIn('File "study.comm", line 3', run.err)

    def test_syntax_errors(self):
        self.refused(self.run_study("DEBUT()\nM = (\n"), "STUDY_16", "study.comm:2")
        self.refused(self.run_study("DEBUT()\nM = DEFI_MATERIAU(ELAS=1, ELAS=2)\n"), "STUDY_16", "study.comm:2", "repeated")
        for text, word in (("X = 1\0", "null"), ("X = " + " + ".join(["1"] * 20000), "nested too deeply"), ("X = " + "-" * 20000 + "1", "nested too deeply"), ("X = " + "(" * 5000 + "1" + ")" * 5000, "nested")):
            run = self.refused(self.run_study(f"DEBUT()\n{text}\n"), "STUDY_16", "study.comm", word)
            self.assertNotIn("Traceback", run.err)
        self.refused(self.run_study(f"DEBUT()\nF = FORMULE(NOM_PARA='X', VALE='{' + '.join(['X'] * 20000)}')\n"), "FORMULE_1", "study.comm:2", "nested too deeply")

    def test_python_that_ends_in_odd_ways_is_told_as_any_other(self):
        """What is no Exception, an exception without a text, an output that is closed or put to None: a diagnosis, no traceback of the launcher's."""
        for text, word in (("class Odd(BaseException): pass\nraise Odd('why')", "Odd: why"),
                           ("raise GeneratorExit", "GeneratorExit"),
                           ("class Odd(Exception):\n    def __str__(self): raise ValueError\nraise Odd", "Odd: its text cannot be made"),
                           ("import sys\nsys.stdout.close()\n1 / 0", "ZeroDivisionError"), ("import sys\nsys.stdout = None\n1 / 0", "ZeroDivisionError"),
                           ("import io, sys\nsys.stdout = io.StringIO()\n1 / 0", "ZeroDivisionError")):
            with self.subTest(text):
                run = self.run_study(f"DEBUT()\n{text}\n")
                self.assertEqual(run.status, 2, run.err)
                self.assertIn(word, run.err)
                self.assertNotIn("commands/lacon", run.err)
        run = self.run_study("DEBUT()\nimport sys\nsys.stdout = None\nC = DEFI_CONSTANTE(VALE=1.)\nFIN()\n")
        self.assertEqual(run.status, 0, run.err)

    def test_exit(self):
        self.ends(self.run_study("DEBUT()\nimport sys\nsys.exit()\n"), 0, "OK")
        self.refused(self.run_study("DEBUT()\nexit(3)\n"), "STUDY_17", "study.comm:2")

    def test_an_interrupt_that_a_command_file_raises(self):
        run = self.run_study(STUDY + "raise KeyboardInterrupt\n")
        self.ends(run, 4, "<F>_ABNORMAL_ABORT")
        self.assertRegex(run.err, r"<STUDY_18> the run was ended by SIGINT\n +where: .*study.comm:\d+")

    def test_called_through_functions(self):
        self.refused(self.run_study("DEBUT()\ndef f():\n    LIRE_MAILLAGE(UNIT=1)\nf()\n"), "study.comm:3", "called from study.comm:4")


class Exceptions(LauncherTest):
    def test_a_command_file_may_catch_them(self):
        text = STUDY.replace("R = STAT_NON_LINE", "try:\n    R = STAT_NON_LINE") + """
except ConvergenceError as error:
    assert error.id_message == 'MECANONLINE9_7', error
    R = None
try:
    X = LIRE_MAILLAGE(UNIT=20)
except AsterError as error:
    assert error.id_message == 'KEYWORD_1' and 'UNITE' in error.message
from code_aster import CA
try:
    DYNA_NON_LINE()
except CA.AsterError:
    print('caught')
FIN()
"""
        run = self.run_study(text, behaviour={"stat_non_line": {"status": 3, "messages": [said("S", "MECANONLINE9_7")]}})
        self.ok(run)
        self.assertIn("caught", run.out)
        self.assertNotIn("KEYWORD_1", run.err)


    def test_a_solution_that_stopped_leaves_what_it_had(self):
        text = STUDY.replace("R = STAT_NON_LINE", "try:\n    R = STAT_NON_LINE") + """
except ConvergenceError:
    pass
CALC_CHAMP(reuse=R, RESULTAT=R, CONTRAINTE='SIEF_NOEU')
FIN()
"""
        failure = {"stat_non_line": {"status": 3, "messages": [said("S", "MECANONLINE9_7")]}}
        run = self.run_study(text, behaviour=failure)
        self.ok(run)
        self.assertIn("COMMAND_14", run.err)
        # uncaught, it is there for a POURSUITE
        self.refused(self.run_study(STUDY, "--fresh", behaviour=failure), "COMMAND_14", status=3, diagnostic="<S>_NO_CONVERGENCE")
        self.ok(self.run_study("POURSUITE()\nCALC_CHAMP(reuse=R, RESULTAT=R, CONTRAINTE='SIEF_NOEU')\nFIN()\n"))
        # where it left nothing, there is nothing
        failure["stat_non_line"]["lazy"] = True
        self.refused(self.run_study(text, "--fresh", behaviour=failure), "STUDY_20", "R")

    def test_a_command_file_may_raise_them(self):
        self.refused(self.run_study("DEBUT()\nraise AsterError('not today')\n"), "<F> <USER> not today")


class Units(LauncherTest):
    def test_no_file(self):
        self.refused(self.run_study("DEBUT()\nM = LIRE_MAILLAGE(UNITE=21)\n"), "COMMAND_4", "unit 21", "--unit 21=FILE", "study.comm:2")

    def test_missing_file(self):
        self.write("study.comm", "DEBUT()\nM = LIRE_MAILLAGE()\n")
        self.refused(self.launch("study.comm", "--unit", "20=nowhere.med"), "COMMAND_5", "nowhere.med")
        self.assertEqual(self.entries(), [])

    def test_an_output_that_cannot_be_written(self):
        os.mkfifo(self.work / "pipe")
        for path, identifier in (("nowhere/out.med", "COMMAND_8"), ("mesh.med/out.med", "COMMAND_8"), (".", "COMMAND_21"), ("pipe", "COMMAND_21")):
            run = self.run_study(STUDY + "IMPR_RESU(UNITE=80, RESU=_F(RESULTAT=R))\n", "--unit", f"80={path}")
            self.refused(run, identifier, "IMPR_RESU/UNITE, study.comm:12")

    def test_results_never_replace_data(self):
        kept = (self.work / "mesh.med").read_bytes()
        for options in ((), ("--unit", "80=mesh.med"), ("--unit", "80=study.comm")):
            unit = 80 if options else 20
            run = self.run_study(STUDY + f"IMPR_RESU(UNITE={unit}, RESU=_F(RESULTAT=R))\n", *options)
            self.refused(run, "COMMAND_12", f"unit {unit}", "IMPR_RESU/UNITE, study.comm:12")
        self.write("c.comm", "POURSUITE()\nIMPR_RESU(UNITE=20, RESU=_F(RESULTAT=R))\n")
        self.write("c.export", "F comm c.comm D 1\nF mmed mesh.med D 20\n")
        self.refused(self.launch("c.export", "--base", "study.base"), "COMMAND_12", "mesh.med")
        self.assertEqual((self.work / "mesh.med").read_bytes(), kept)

    def test_the_time_limit_of_an_export_file(self):
        self.write("slow.comm", "DEBUT()\nL = DEFI_LIST_REEL(VALE=(0., 1.))\ntry:\n    import time\n    time.sleep(60)\nexcept Exception:\n    pass\n")
        self.write("slow.export", "P time_limit 3\nF comm slow.comm D 1\n")
        run = self.launch("slow.export")
        self.refused(run, "STUDY_25", "3 s", "slow.comm:5", status=3, diagnostic="<S>_CPU_LIMIT")
        self.ok(self.launch(self.write("more.comm", "POURSUITE()\nassert L.getValues() == [0, 1]\nFIN()\n").name, "--base", "slow.base"))

    def test_what_an_earlier_run_has_read_is_not_replaced(self):
        self.ok(self.run_study(STUDY + "FIN()\n"))
        for _ in range(2):
            run = self.run_study("POURSUITE()\nIMPR_RESU(UNITE=20, RESU=_F(MAILLAGE=M))\nFIN()\n")
            self.refused(run, "COMMAND_12", "mesh.med")
        self.ok(self.run_study("POURSUITE()\nFIN()\nDEBUT()\nFIN()\n"))

    def test_what_this_run_wrote_may_be_read_and_written_again(self):
        prints = "IMPR_RESU(UNITE=80, RESU=_F(RESULTAT=R))\n"
        behaviour = {"impr_resu": {"unit": "80"}}
        self.ok(self.run_study(STUDY + prints + "N = LIRE_MAILLAGE(UNITE=80)\n" + prints + "FIN()\n", behaviour=behaviour))

    def test_paths_are_absolute_in_orders(self):
        self.ok(self.run_study(STUDY + "FIN()\n"))
        order = self.last_order("LIRE_MAILLAGE")
        self.assertEqual(order["units"], {"20": str(self.work / "mesh.med")})

    def test_a_command_file_may_change_its_folder(self):
        (self.work / "other").mkdir()
        run = self.run_study("import os\nDEBUT()\nos.chdir('other')\nM = LIRE_MAILLAGE(UNITE=20)\nFIN()\n", "--json", "report.json")
        self.assertEqual(run.status, 0, run.err)
        self.assertEqual(list((self.work / "other").iterdir()), [])
        self.assertTrue((self.work / "report.json").exists())

    def test_an_output_without_file_goes_beside_the_command_file_and_says_so(self):
        behaviour = {"impr_resu": {"unit": "80"}}
        run = self.ok(self.run_study(STUDY + "IMPR_RESU(RESU=_F(RESULTAT=R))\nIMPR_RESU(RESU=_F(MAILLAGE=M))\nFIN()\n", behaviour=behaviour))
        self.assertTrue((self.work / "study.80.med").exists())
        self.assertEqual(run.err.count("study.80.med"), 1)

    def test_a_second_print_to_one_unit_appends(self):
        self.ok(self.run_study(STUDY + "IMPR_RESU(RESU=_F(RESULTAT=R))\n" * 2 + "FIN()\n"))
        orders = sorted(self.orders.glob("*impr_resu.order.json"))
        self.assertEqual([json.loads(p.read_text()).get("append") for p in orders], [None, ["80"]])

    def test_paths_that_are_not_utf_8_are_refused_by_name(self):
        path = os.fsdecode(b"k\xf6rper.msh")
        self.refused(self.run_study("DEBUT()\nFIN()\n", "--unit", f"21={path}"), "STUDY_26", "rper.msh", "UTF-8")
        self.refused(self.run_study("DEBUT()\nFIN()\n", "--base", self.work / os.fsdecode(b"b\xe4se")), "STUDY_26", "se")
        self.assertEqual([name for name in os.listdir(self.work) if "base" in name], [])

    def test_bad_options(self):
        self.write("study.comm", "DEBUT()\n")
        for options in (("--unit", "mesh.med"), ("--unit", "0=a"), ("--unit", "20=a", "--unit", "20=b"), ("--threads", "0"), ("--nope",)):
            self.assertEqual(self.launch("study.comm", *options).status, 2, options)
        self.refused(self.launch("nowhere.comm"), "STUDY_14", "nowhere.comm")


class Exports(LauncherTest):
    def export(self, text):
        self.write("case.export", text)
        return self.launch("case.export")

    def test_a_study(self):
        self.write("case.comm", "DEBUT()\nfrom ssnv import value\nM = LIRE_MAILLAGE()\nN = LIRE_MAILLAGE(UNITE=21)\nFIN()\n")
        self.write("case.com1", "POURSUITE()\nassert value == 3 and M is not N\nFIN()\n")
        (self.work / "data").mkdir()
        self.write("data/ssnv.py", "value = 3\n")
        run = self.export("P time_limit 60\nP memory_limit 512.0\nP testlist submit verification\nP ncpus 3\n\n# a comment\n"
                          "F com1 case.com1 D 2\nF comm case.comm D 1\nF mmed mesh.med D 20\nF mmed mesh.med D 21\nF nom data/ssnv.py D 0\n"
                          "F rmed out.med R 80\n")
        self.ok(run)
        self.assertEqual(self.last_order("LIRE_MAILLAGE")["units"], {"21": str(self.work / "mesh.med")})
        self.assertFalse((self.work / "ssnv.py").exists(), "delivered for the time of the run")

    def test_files_are_found_beside_the_export_file(self):
        (self.work / "sub").mkdir()
        (self.work / "sub" / "m.med").write_text("")
        self.write("sub/c.comm", "DEBUT()\nM = LIRE_MAILLAGE()\nFIN()\n")
        self.write("sub/c.export", "F comm c.comm D 1\nF mmed m.med D 20\n")
        self.ok(self.launch("sub/c.export"))

    def test_names_with_spaces(self):
        self.write("a  study é.comm", "DEBUT()\nM = LIRE_MAILLAGE()\nFIN()\n")
        (self.work / "a mesh D 3.med").write_text("")
        self.ok(self.export("F comm a  study é.comm D 1\nF mmed a mesh D 3.med D 20\n"))
        self.assertEqual(self.last_order("LIRE_MAILLAGE")["units"], {"20": str(self.work / "a mesh D 3.med")})

    def test_the_type_orders_command_files_of_any_name(self):
        self.write("first.comm", "DEBUT()\nL = 1\nFIN()\n")
        self.write("second.comm", "POURSUITE()\nassert L == 1\nFIN()\n")
        self.ok(self.export("F com1 second.comm D 1\nF comm first.comm D 1\n"))

    def test_many_continuations_run_in_their_order(self):
        self.write("c.comm", "DEBUT()\nL = [0]\nFIN()\n")
        lines = ["F comm c.comm D 1"]
        for i in (10, 2, 1):
            self.write(f"c.com{i}", f"POURSUITE()\nL.append({i})\nif {i} == 10:\n    assert L == [0, 1, 2, 10], L\nFIN()\n")
            lines.append(f"F com{i} c.com{i} D 1")
        self.ok(self.export("\n".join(lines) + "\n"))

    def test_a_data_file_by_name(self):
        (self.work / "data").mkdir()
        self.write("data/points.txt", "42\n")
        self.write("c.comm", "DEBUT()\nassert open('points.txt').read() == '42\\n'\nFIN()\n")
        self.ok(self.export("F comm c.comm D 1\nF nom data/points.txt D 0\n"))
        self.write("points.txt", "another\n")
        self.refused(self.export("F comm c.comm D 1\nF nom data/points.txt D 0\n"), "STUDY_21", "points.txt")
        self.assertEqual((self.work / "points.txt").read_text(), "another\n")

    def test_mistakes(self):
        self.refused(self.export("F comm\n"), "STUDY_13", "case.export:1")
        self.refused(self.export("F mmed mesh.med D 20\n"), "STUDY_15")
        self.refused(self.export("F comm nowhere.comm D 1\n"), "STUDY_14", "nowhere.comm")
        self.write("c.comm", "DEBUT()\n")
        self.refused(self.launch("case.export", "c.comm"), "STUDY_22")


class Files(LauncherTest):
    def test_what_a_command_file_finds(self):
        text = """
DEBUT(CODE=_F(NIV_PUB_WEB='INTERNET'), ERREUR=_F(ALARME='EXCEPTION'), DEBUG=_F(SDVERI='OUI'), INFO=1)
assert cos(pi) == -1 and _F(A=1) == {'A': 1} and _F(A=1)['A'] == 1
import os
assert os.environ['MARK'] == 'here'
assert __name__ == '__main__' and __file__ == 'study.comm'
import code_aster
from code_aster.Commands import *
from code_aster import CA
assert code_aster.AsterError is CA.AsterError
test = code_aster.TestCase()
test.assertEqual(1, 1)
test.assertAlmostEqual(1.0, 1.0 + 1e-9)
test.printSummary()
name = CO('later')
print("a title \\q \\2")
FIN()
"""
        run = self.ok(self.run_study(text, environment={"MARK": "here"}))
        self.assertEqual(run.err, "")
        self.assertIn("2 checks: 2 OK", run.out)

    def test_a_failed_assertion_of_a_test_case_is_nook(self):
        run = self.run_study("from code_aster import CA\nDEBUT()\nCA.TestCase().assertEqual(1, 2)\nFIN()\n")
        self.assertEqual((run.status, run.last), (5, "--- DIAGNOSTIC JOB : NOOK_TEST_RESU"))

    def test_init_and_close(self):
        self.write("a.comm", "from code_aster import CA\nCA.init('--test', ERREUR=_F(ALARME='ALARME'))\nx = 1\nCA.close()\n")
        self.write("a.com1", "from code_aster import CA\nCA.init('--test', '--continue')\nassert x == 1\nCA.close()\n")
        self.ok(self.launch("a.comm", "a.com1"))

    def test_an_encoding(self):
        (self.work / "study.comm").write_bytes("# coding: latin-1\nDEBUT()\nt = 'déplacé'\nassert len(t) == 7\nFIN()\n".encode("latin-1"))
        self.ok(self.launch("study.comm"))

    def test_mesh_objects(self):
        self.ok(self.run_study("""
DEBUT()
M = LIRE_MAILLAGE()
assert M.getNumberOfNodes() == 6 and M.getNumberOfCells() == 3
values = M.getCoordinates().getValues()
assert len(values) == 18 and values[3:6] == [1.0, 0.0, 0.0]
assert M.getName() == 'M' and M.getGroupsOfCells() == ['SKIN', 'BODY']
assert M.getConnectivity() == [[0, 1, 4, 3], [1, 2, 5, 4], [0, 1]] and M.getDimension() == 2
assert M.getCells('BODY') == [0, 1] and M.getCells() == [0, 1, 2] and M.getCells(['SKIN', 'BODY']) == [0, 1, 2]
assert M.getNodes('TOP') == [3, 4, 5] and M.getNodes('SKIN') == [0, 1] == M.getNodesFromCells('SKIN')
assert M.hasGroupOfCells('SKIN') and not M.hasGroupOfNodes('SKIN') and M.LIST_GROUP_MA() == [('SKIN', 1), ('BODY', 2)]
assert M.getCoordinates()[4] == [1.0, 1.0, 0.0] and M.isParallel() is False
assert M.getCellName(0) == 'M1' and M.getNodeName(3) == 'N4'
assert M.getMinMaxEdgeSizes('BODY') == (1.0, 1.0) == M.getMinMaxEdgeSizes(['SKIN', 'BODY']) and not M.isQuadratic()
FIN()
"""))

    def test_fields_of_a_result(self):
        self.ok(self.run_study(STUDY + """
values, mask = R.getField('DEPL', 2).toSimpleFieldOnNodes().getValues()
assert values.shape == (6, 2) and values[3, 0] == 4.0
assert mask[:, 0].all() and list(mask[:, 1]) == [False, True, False, False, True, False]
values, mask = R.getField('CONT_ELEM', 1).toSimpleFieldOnCells().getValues()
assert values[0, 0] == -12.5 and mask.all() and R.getField('CONT_ELEM', 1).toSimpleFieldOnCells().getCellsWithValues() == [2]
assert (R.getField('DEPL', 0.5, 'INST').values == R.getField('DEPL', para='INST', value=0.5).values).all()
assert R.getField('DEPL', index=1).getPhysicalQuantity() == 'DEPL_R'
values, (nodes, names) = R.getField('DEPL', 2).getValuesWithDescription('DX', 'TOP')
assert values == [4.0, 5.0, 6.0] and nodes == [3, 4, 5] and names == ['DX'] * 3
assert R.getField('DEPL', 2).getValues('DX', ['SKIN']) == [1.0, 2.0]
field = R.getField('DEPL', 2)
assert R.getField('STAND_IN', 2).norm('NORM_1') == 0.75 and R.getField('STAND_IN', 2).getValues() == [-1, 0.25, 0.5]
assert field.norm('NORM_1', 'DX') == 21 and field.norm('NORM_INFINITY') == 25 and abs(field.norm('NORM_2', ['LAGS_C']) - 25 * 2**0.5) < 1e-13
assert 'DEPL' in R.getFieldsOnNodesRealNames() and 'CONT_ELEM' in R.getFieldsOnCellsRealNames() and R.getMaterialField() is CM
part = R.getField('DEPL', 2).EXTR_COMP('LAGS_C', [], 1)
assert list(part.valeurs) == [-25.0, -25.0] and part.noeud == [2, 5]
assert R.getAccessParameters() == {'NUME_ORDRE': [0, 1, 2], 'INST': [0.0, 0.5, 1.0]} == R.LIST_VARI_ACCES()
assert 'DEPL' in R.LIST_CHAMPS() and R.getMesh() is M and R.getModel().getMesh() is M and R.getLastTime() == 1.0
for wrong, word in ((lambda: R.getField('VITE', 1), 'has no field VITE at order 1'), (lambda: R.getField('DEPL', 9), 'no order number 9'),
                    (lambda: R.getField('DEPL', 0.7, 'INST'), 'the result R has no instant 0.7'), (lambda: R.getField('DEPL', 0.7), 'no order number 0.7'),
                    (lambda: R.getField('DEPL', 0.7, 'INST'), 'it has: 0 (INST 0), 1 (INST 0.5), 2 (INST 1)'),
                    (lambda: R.getField('DEPL', 0.7, 'INST', prec=0.5), 'several instants of the result are within the tolerance of 0.7: 0.5, 1'),
                    (lambda: R.getField('DEPL', 1).toSimpleFieldOnCells(), 'toSimpleFieldOnNodes'),
                    (lambda: R.getField('DEPL', 1).getValues('DZ'), 'DX, LAGS_C'), (lambda: field.norm('NORM_3'), 'NORM_INFINITY'),
                    (lambda: M.getCells('BODYY'), 'nearest one is BODY'), (lambda: M.getConnectivities(), "no 'getConnectivities' here")):
    try:
        wrong()
    except (AsterError, AttributeError, TypeError, ValueError) as error:
        assert word in str(error), error
    else:
        raise AssertionError(word)
assert R.getIndexes() == [0, 1, 2] == R.getRanks() and R.getTime(1) == 0.5 == R.getTimeValue(1)
FIN()
"""))

    def test_the_order(self):
        self.ok(self.run_study(STUDY + "FIN()\n"))
        order = self.last_order("CREA_MAILLAGE")
        self.assertEqual(order, {
            "format": 1, "command": "CREA_MAILLAGE", "base": str(self.work / "study.base"),
            "result": {"id": "mesh_4", "label": "M", "reuse": False}, "units": {}, "source": "study.comm:6",
            "keywords": {"MAILLAGE": {"concept": "mesh_3"}, "INFO": 1,
                         "DECOUPE_LAC": [{"GROUP_MA_ESCL": ["SKIN"], "DECOUPE_HEXA": "PYRA"}]}})

    def test_threads(self):
        run = self.run_study("DEBUT()\nM = LIRE_MAILLAGE()\n", "--threads", "2", behaviour={"lire_maillage": {"print": "LACON_THREADS"}})
        self.assertIn("LACON_THREADS 2", run.out)

    def test_threads_where_nobody_says_how_many(self):
        """As many as there are cores; the environment variable says otherwise."""
        study, printed = "DEBUT()\nM = LIRE_MAILLAGE()\n", {"lire_maillage": {"print": "LACON_THREADS"}}
        cores = os.environ.get("LACON_THREADS", available_cores())
        self.assertIn(f"LACON_THREADS {cores}\n", self.run_study(study, behaviour=printed).out)
        self.assertIn("LACON_THREADS 7\n", self.run_study(study, "--fresh", behaviour=printed, environment={"LACON_THREADS": "7"}).out)

    def test_memory_in_huge_pages(self):
        """Beside other settings of the allocator that the user has; his own one of these stands."""
        study, name = "DEBUT()\nM = LIRE_MAILLAGE()\n", "GLIBC_TUNABLES"
        for given, found in (("", "glibc.malloc.hugetlb=1"), ("glibc.malloc.check=0", "glibc.malloc.check=0:glibc.malloc.hugetlb=1"),
                             ("glibc.malloc.hugetlb=0", "glibc.malloc.hugetlb=0")):
            run = self.run_study(study, "--fresh", behaviour={"lire_maillage": {"print": name}}, environment={name: given})
            self.assertIn(f"{name} {found}\n", run.out)

    def test_cores_of_a_container(self):
        """Its share of their time counts, where it has less than all of them."""
        quota, all_of_them = self.work / "cpu.max", available_cores(self.work / "none")
        for text, cores in (("max 100000", all_of_them), ("100000 100000", 1), ("30000 100000", 1), ("9900000 100000", all_of_them), ("?", all_of_them)):
            quota.write_text(text + "\n", encoding="ascii")
            self.assertEqual(available_cores(quota), cores, text)

    def test_lines_and_labels_however_the_package_was_found(self):
        run = self.run_study("DEBUT()\nM = LIRE_MAILLAGE()\nLIRE_MAILLAGE(UNIT=1)\n",
                             environment={"PYTHONPATH": str(ROOT / "commands" / ".." / "tests" / ".." / "commands")})
        self.refused(run, "study.comm:3")
        self.assertIn("study.comm:2: M = LIRE_MAILLAGE", run.out)

    def test_timings(self):
        run = self.run_study(STUDY + "FIN()\n", "--timings", "--json", "run.json")
        for word in ("start-up of the launcher", "STAT_NON_LINE  study.comm:11", "      work", "      factorisations 3\n", "total"):
            self.assertIn(word, run.out)
        self.assertTrue(run.last.startswith("--- DIAGNOSTIC"))
        solved = json.loads((self.work / "run.json").read_text())["timings"]["commands"][-2]
        self.assertEqual((solved["command"], solved["phases"], solved["counts"]), ("STAT_NON_LINE", {"work": 0.001}, {"factorisations": 3}))
        self.assertGreaterEqual(solved["seconds"], solved["operator"])

    def test_version_and_help(self):
        self.assertRegex(self.launch("--version").out, r"^lacon \d+\.\d+\.\d+")
        help_text = self.launch("--help").out
        for word in ("--unit", "--base", "--fresh", "--checks", "--json", "--timings", "--verbose", "--threads", "Exit status"):
            self.assertIn(word, help_text)

    def test_help_about_commands(self):
        run = self.launch("help")
        self.assertEqual(run.status, 0)
        self.assertRegex(run.out, r"(?m)^DEFI_CONTACT +Contact by local average")
        run = self.launch("help", "defi_contact", "MODI_MAILLAGE")
        self.assertEqual(run.status, 0)
        for line in ("DEFI_CONTACT -> contact", "  MODELE  model; mandatory", "  ZONE  _F(...); up to 100; mandatory",
                     "      TYPE_APPA  text; one of RAPIDE, ROBUSTE; default RAPIDE", "      RESI_APPA  real; above 0; default 1e-08",
                     "  with ALGO_RESO_GEOM='NEWTON': RESI_GEOM is 1e-06 by default",
                     "  reuse= is needed: the concept given as MAILLAGE is changed in place"):
            self.assertIn(line + "\n", run.out)
        run = self.launch("help", "DEFI_CONTAC")
        self.assertEqual(run.status, 2)
        self.assertIn("the nearest one is DEFI_CONTACT", run.out)
        run = self.launch("help", "DYNA_NON_LINE")
        self.assertEqual(run.status, 2)
        self.assertIn("not available", run.out)

    def test_help_into_a_pipe_that_closes(self):
        shell = f"set -o pipefail; {sys.executable} -m lacon help STAT_NON_LINE AFFE_CHAR_MECA CREA_CHAMP POST_ELEM | true"
        for _ in range(3):
            done = subprocess.run(["bash", "-c", shell], env={**os.environ, "PYTHONPATH": str(ROOT / "commands")}, text=True, capture_output=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_help_about_every_command(self):
        from lacon.core import catalog

        run = self.launch("help", *catalog.command_names())
        self.assertEqual(run.status, 0)
        for command in catalog.command_names():
            for keyword in catalog.command(command).get("keyword", {}):
                self.assertIn(f"  {keyword}  ", run.out)

    def test_the_catalogue_is_said_to_be_missing(self):
        self.write("study.comm", "DEBUT()\n")
        run = self.launch("study.comm", environment={"LACON_CATALOG": "/nowhere"})
        self.assertEqual(run.status, 4)
        self.assertIn("/nowhere", run.err)


class Sources(unittest.TestCase):
    def test_solutions_that_failed_otherwise_than_newtons_are_those_of_the_catalogue(self):
        from lacon.base import orders
        from lacon.core import catalog

        named = [name for name, row in catalog.messages().items() if row["severity"] == "S" and name.startswith(orders.not_newton)]
        self.assertLess({"SOLVER_1", "MEMORY_1"}, set(named))

    def test_every_message_that_is_raised_exists_with_its_gaps(self):
        import ast
        import re
        import string

        from lacon.core import catalog

        known = catalog.messages()
        used = set()
        for path in sorted((ROOT / "commands" / "lacon").rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text())):
                if not isinstance(node, ast.Call):
                    continue
                first = node.args[0] if node.args else None
                choices = (first.body, first.orelse) if isinstance(first, ast.IfExp) else (first,)
                ids = [a.value for a in choices if isinstance(a, ast.Constant) and isinstance(a.value, str)
                       and re.fullmatch(r"[A-Z_]+_\d+", a.value)]
                for identifier in ids:
                    used.add(identifier)
                    self.assertIn(identifier, known, path.name)
                    gaps = {g for key in ("text", "do") for _, g, _, _ in string.Formatter().parse(known[identifier][key]) if g}
                    given = {k.arg for k in node.keywords} | {"path"}
                    self.assertLessEqual(gaps, given, f"{path.name}: {identifier}")
        mine = catalog.toml(ROOT / "catalog" / "messages" / "commands.toml")
        self.assertEqual(set(mine) - used, set(), "messages that nothing raises")


if __name__ == "__main__":
    unittest.main()
