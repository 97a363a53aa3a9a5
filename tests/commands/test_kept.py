"""What need not be made again: which operators a second run starts, after nothing or any one part of their keys has changed."""

import os
import pathlib
import shutil
import sys
import tempfile
import unittest

import h5py

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import ROOT, STUDY, LauncherTest  # noqa: E402

#: operators of STUDY, in order
ALL = ["lire_maillage", "crea_maillage", "affe_modele", "affe_materiau", "affe_char_cine", "stat_non_line"]
WITH_FIELDS = STUDY.replace("R = STAT", "R = STAT") + """CALC_CHAMP(reuse=R, RESULTAT=R, CONTRAINTE='SIEF_NOEU')
IMPR_RESU(UNITE=80, RESU=_F(RESULTAT=R))
FIN()
"""


class KeptTest(LauncherTest):
    """A test that has the base of a first run of `first`. Only the first test runs it, the others have a copy: keys hold no paths."""

    first = ""

    @classmethod
    def setUpClass(cls):
        cls.template = pathlib.Path(tempfile.mkdtemp(prefix="lacon_test_")) / "study.base"
        cls.addClassCleanup(shutil.rmtree, cls.template.parent, ignore_errors=True)

    def setUp(self):
        super().setUp()
        if self.template.exists():
            self.back_to_first()
        else:
            self.started(self.first)
            shutil.copytree(self.work / "study.base", self.template)

    def back_to_first(self):
        shutil.rmtree(self.work / "study.base", ignore_errors=True)
        shutil.copytree(self.template, self.work / "study.base")

    def started(self, text, *options, **more):
        """Run a study, which ends well. @return the operators that were started, in order"""
        for path in self.orders.glob("*") if self.orders.exists() else ():
            path.unlink()
        self.last_run = self.ok(self.run_study(text, *options, **more))
        return [path.name.split(".")[0].partition("-")[2] for path in sorted(self.orders.glob("*.order.json"))]


class Kept(KeptTest):
    first = WITH_FIELDS

    def test_nothing_changed(self):
        entries = self.entries()
        self.assertEqual(self.started(WITH_FIELDS), ["impr_resu"])
        self.assertEqual(self.last_run.out.count("unchanged since it was made: kept"), len(ALL) + 1)
        self.assertEqual(self.entries(), entries)

    def test_a_first_run_starts_everything(self):
        self.assertEqual(self.started(WITH_FIELDS, "--fresh"), [*ALL, "calc_champ", "impr_resu"])

    def test_comments_and_lines_change_nothing(self):
        text = "# a line more\n\n" + WITH_FIELDS.replace("NU=0.3", "NU=3.0 / 10")
        self.assertEqual(self.started(text), ["impr_resu"])

    def test_force_runs_everything(self):
        self.assertEqual(self.started(WITH_FIELDS, "--force"), [*ALL, "calc_champ", "impr_resu"])
        self.assertEqual(self.started(WITH_FIELDS), ["impr_resu"])

    def test_a_change_costs_what_follows_from_it(self):
        for old, new, first in (("UNITE=20)", "UNITE=20, INFO=2)", 0), ("'SKIN')", "'SKIN', DECOUPE_HEXA='HEXA')", 1), ("D_PLAN", "C_PLAN", 2),
                                ("DX=0", "DX=1", 4), ("NOMBRE=2", "NOMBRE=3", 5), ("(0, 0, 1, 1)", "(0, 0, 1, 2)", 5)):
            with self.subTest(new=new):
                expected = ALL[first:] if first != 4 else ["affe_char_cine", "stat_non_line"]
                if first == 2:
                    expected = ["affe_modele", "affe_char_cine", "stat_non_line"]
                self.back_to_first()
                self.assertEqual(self.started(WITH_FIELDS.replace(old, new, 1)), [*expected, "calc_champ", "impr_resu"])

    def test_a_material_costs_what_uses_it(self):
        self.assertEqual(self.started(WITH_FIELDS.replace("NU=0.3", "NU=0.2")), ["affe_materiau", "stat_non_line", "calc_champ", "impr_resu"])

    def test_the_end_of_a_study_costs_only_its_end(self):
        self.assertEqual(self.started(WITH_FIELDS.replace("SIEF_NOEU", "SIEF_ELNO")), ["calc_champ", "impr_resu"])
        self.assertEqual(self.started(WITH_FIELDS), ["calc_champ", "impr_resu"])
        self.assertEqual(self.started(WITH_FIELDS.replace("CALC_CHAMP(reuse=R, RESULTAT=R, CONTRAINTE='SIEF_NOEU')\n", "")), ["impr_resu"])
        self.assertEqual(self.started(WITH_FIELDS), ["impr_resu"])

    def test_a_concept_goes_back_to_what_it_was_before_it_was_changed_in_place(self):
        seen = "with R.open() as file: print('version', file.attrs['version'])\n"
        text = WITH_FIELDS.replace("CALC_CHAMP", seen + "CALC_CHAMP").replace("IMPR_RESU", seen + "IMPR_RESU")
        self.assertEqual(self.started(text), ["impr_resu"])
        self.assertEqual([line for line in self.last_run.out.splitlines() if line.startswith("version")], ["version 1", "version 2"])

    def test_the_mesh_file(self):
        (self.work / "mesh.med").write_bytes(b"other bytes, read by no stand-in")
        self.assertEqual(self.started(WITH_FIELDS), [*ALL, "calc_champ", "impr_resu"])
        path = self.work / "mesh.med"
        os.utime(path, (path.stat().st_atime, path.stat().st_mtime + 10))  # the same content, written again
        self.assertEqual(self.started(WITH_FIELDS), ["impr_resu"])

    def test_the_operator(self):
        program = self.bin / "affe_char_cine"
        program.write_text(program.read_text(encoding="utf-8") + "\n# another version\n", encoding="utf-8")
        self.assertEqual(self.started(WITH_FIELDS), ["affe_char_cine", "stat_non_line", "calc_champ", "impr_resu"])

    def test_a_plugin(self):
        folder = self.folder / "plugins" / "mine"
        folder.mkdir(parents=True)
        (folder / "plugin.toml").write_text("", encoding="utf-8")
        environment = {"LACON_PLUGIN_PATH": str(folder.parent)}
        everything = [*ALL, "calc_champ", "impr_resu"]
        self.assertEqual(self.started(WITH_FIELDS, environment=environment), everything)
        self.assertEqual(self.started(WITH_FIELDS, environment=environment), ["impr_resu"])
        (folder / "libmine.so").write_bytes(b"kernels")
        self.assertEqual(self.started(WITH_FIELDS, environment=environment), everything)

    def test_plugins_are_those_that_the_operators_find(self):
        """Beside LACON_BIN, not beside the launcher; a folder that is no plug-in does not count."""
        folder = self.bin.parent / "lib/lacon/plugins/mine"
        folder.mkdir(parents=True)
        (folder / "notes.txt").write_text("no plug-in", encoding="utf-8")
        self.assertEqual(self.started(WITH_FIELDS), ["impr_resu"])
        (folder / "libmine.so").write_bytes(b"kernels")
        self.assertEqual(self.started(WITH_FIELDS), [*ALL, "calc_champ", "impr_resu"])
        (folder / "plugin.toml").write_text('[[element]]\nmodelisation = "MY_MODEL"\n', encoding="utf-8")
        self.ok(self.run_study(WITH_FIELDS.replace("'D_PLAN'", "'MY_MODEL'")))

    def test_the_launchers_part_in_formulae(self):
        """Each module that evaluates them, and the functions that they call."""
        copy = self.folder / "copy"
        shutil.copytree(ROOT / "commands" / "lacon", copy / "lacon", ignore=shutil.ignore_patterns("__pycache__"))
        environment = {"PYTHONPATH": str(copy), "LACON_CATALOG": os.environ.get("LACON_CATALOG", str(ROOT / "catalog"))}
        self.started(WITH_FIELDS, environment=environment)
        self.assertEqual(self.started(WITH_FIELDS, environment=environment), ["impr_resu"])
        for name in ("base/expressions.py", "base/functions.py", "base/names.py", "objects/functions.py"):
            with open(copy / "lacon" / name, "a", encoding="utf-8") as file:
                file.write("\n# another version\n")
            self.assertEqual(self.started(WITH_FIELDS, environment=environment), [*ALL, "calc_champ", "impr_resu"], name)

    def test_a_concept_that_was_lost_or_touched(self):
        mesh = self.work / "study.base" / f"{self.registry()['labels']['M']}.h5"
        os.utime(mesh, ns=(0, 0))
        self.assertEqual(self.started(WITH_FIELDS)[0], "crea_maillage")
        field = next((self.work / "study.base" / self.registry()["labels"]["R"]).glob("DEPL*.h5"))
        field.unlink()
        self.assertEqual(self.started(WITH_FIELDS), ["stat_non_line", "calc_champ", "impr_resu"])

    def test_a_mesh_that_is_changed_after_its_model_was_made(self):
        text = STUDY.replace("MAT =", "DEFI_GROUP(reuse=M, MAILLAGE=M, CREA_GROUP_MA=_F(NOM='A', TOUT='OUI'))\nMAT =") + "FIN()\n"
        self.started(text, "--fresh")
        self.assertEqual(self.started(text), [])
        self.assertEqual(self.started(text.replace("NOM='A'", "NOM='B'")), ["defi_group", "affe_materiau", "affe_char_cine", "stat_non_line"])

    def test_one_recipe_twice_makes_two_concepts(self):
        text = STUDY + "N = CREA_MAILLAGE(MAILLAGE=M0, LINE_QUAD=_F(TOUT='OUI'))\nK = CREA_MAILLAGE(MAILLAGE=M0, LINE_QUAD=_F(TOUT='OUI'))\nFIN()\n"
        self.started(text)
        self.assertEqual(self.started(text), [])
        labels = self.registry()["labels"]
        self.assertNotEqual(labels["N"], labels["K"])

    def test_a_concept_that_is_named_beforehand(self):
        text = STUDY + "MACR_ADAP_MAIL(ADAPTATION='RAFFINEMENT_UNIFORME', MAILLAGE_N=M0, MAILLAGE_NP1=CO('FINE'))\nprint('nodes', FINE.getNumberOfNodes())\nFIN()\n"
        self.assertEqual(self.started(text), ["macr_adap_mail"])
        self.assertEqual(self.started(text), [])
        self.assertIn("nodes 6", self.last_run.out)
        self.assertEqual(self.started(text.replace("MAILLAGE_N=M0", "MAILLAGE_N=M0, GROUP_MA='BODY'")), ["macr_adap_mail"])

    def test_a_failed_run_costs_nothing_of_what_was_made(self):
        self.refused(self.run_study(WITH_FIELDS.replace("CALC_CHAMP", "1/0\nCALC_CHAMP")), "STUDY_19")
        self.assertEqual(self.started(WITH_FIELDS), ["impr_resu"])

    def test_alarms_are_said_again(self):
        alarm = {"affe_modele": {"messages": [{"severity": "A", "id": "MODELE1_63", "text": "something to say", "do": "nothing"}]}}
        for _ in range(2):  # the second time nothing runs
            run = self.run_study(WITH_FIELDS.replace("D_PLAN", "C_PLAN"), behaviour=alarm)
            self.assertEqual(run.last, "--- DIAGNOSTIC JOB : <A>_ALARM")
        self.assertIn("<A> <MODELE1_63> something to say", run.err)
        text = WITH_FIELDS.replace("D_PLAN", "C_PLAN").replace("DEBUT()", "DEBUT(ERREUR=_F(ALARME='EXCEPTION'))")
        self.refused(self.run_study(text, behaviour=alarm), "MODELE1_63")


FORMULAS = '''
import math
DEBUT()
p = [1.0]
M = LIRE_MAILLAGE(UNITE=20)
RAMP = DEFI_FONCTION(NOM_PARA='X', VALE=(0, 0, 1, 1))
F = FORMULE(NOM_PARA='X', VALE="""p[0] * X + RAMP(X)""")
MO = AFFE_MODELE(MAILLAGE=M, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='D_PLAN'))
MAT = DEFI_MATERIAU(ELAS=_F(E=2000, NU=0.3))
CM = AFFE_MATERIAU(MAILLAGE=M, AFFE=_F(TOUT='OUI', MATER=MAT))
BC = AFFE_CHAR_CINE(MODELE=MO, MECA_IMPO=_F(GROUP_MA='SKIN', DX=0))
L = DEFI_LIST_REEL(VALE=(0, 1))
R = STAT_NON_LINE(MODELE=MO, CHAM_MATER=CM, EXCIT=_F(CHARGE=BC, FONC_MULT=F), INCREMENT=_F(LIST_INST=L))
FIN()
'''


class Formulas(KeptTest):
    first = FORMULAS

    def changed(self, old, new, kept=False):
        """The solution is computed again after `old` became `new`, or is `kept`."""
        self.assertIn(old, FORMULAS)
        self.assertEqual(self.started(FORMULAS.replace(old, new, 1)), [] if kept else ["stat_non_line"])

    def test_the_expression(self):
        self.changed("p[0] * X", "p[0] + X")

    def test_a_constant(self):
        self.changed("p = [1.0]", "p = [2.0]")

    def test_a_constant_that_changes_after_the_formula_was_defined(self):
        self.changed("MO =", "p[0] = 7.0\nMO =")

    def test_a_function_that_the_formula_uses(self):
        self.changed("VALE=(0, 0, 1, 1)", "VALE=(0, 0, 1, 3)")

    def test_what_has_nothing_to_do_with_it(self):
        self.changed("import math", "import math\nq = 3", kept=True)

    def test_expressions_whose_value_may_change_by_itself_are_never_kept(self):
        self.write("own.py", "def f(x):\n    return x\n")
        self.write("numbers.txt", "3.0\n")
        for head, expression in (("from own import f", "f(X)"), ("def f(x): return x", "f(X)"), ("import own", "own.f(X)"),
                                 ("from time import time", "time() + X"), ("import numpy as np", "np.random.rand() * X"),
                                 ("", "len(open('study.comm').read()) * X"), ("from numpy import random as r", "r.rand() * X"),
                                 ("import numpy as np", "np.loadtxt('numbers.txt') * X"), ("import numpy as np", "np.fromfile('numbers.txt', sep=' ')[0] * X"),
                                 ("from numpy import genfromtxt", "genfromtxt('numbers.txt') * X"), ("from numpy import lib", "lib.npyio.loadtxt('numbers.txt') * X"),
                                 ("from numpy import loadtxt as read", "read('numbers.txt') * X")):
            text = FORMULAS.replace("import math", head).replace("p[0] * X", expression)
            with self.subTest(expression=expression):
                self.started(text)
                self.assertEqual(self.started(text), ["stat_non_line"])

    def test_steady_modules(self):
        for expression in ("np.sin(X) + math.pi + max(X, 0)", "np.interp(X, np.array([0.0, 1.0]), q.T[0]).sum() + np.linalg.norm([X, np.pi]) + np.float64(1)",
                           "piecewise(X, [X > 0], [lambda x: np.where(x > 1, x, 2)]) + Polynomial([1, 2])(X)"):
            text = FORMULAS.replace("import math", "import numpy as np\nfrom numpy import piecewise\nfrom numpy.polynomial import Polynomial")
            text = text.replace("p[0] * X", expression).replace("p = [", "import math\nq = np.eye(2)\np = [")
            with self.subTest(expression=expression):
                self.started(text)
                self.assertEqual(self.started(text), [])


class Continued(KeptTest):
    first = STUDY + "CALC_CHAMP(reuse=R, RESULTAT=R, CONTRAINTE='SIEF_NOEU')\nFIN()\n"

    def test_a_second_file_changes_a_result_of_the_first(self):
        more = "FIN()\nPOURSUITE()\nCALC_CHAMP(reuse=R, RESULTAT=R, CONTRAINTE='SIEF_NOEU')\nFIN()\n"
        self.assertEqual(self.started(STUDY + more), [])
        self.assertEqual(self.started(STUDY + more.replace("NOEU", "ELNO")), ["calc_champ"])

    def test_a_later_run_goes_on_from_what_is_there(self):
        more = "POURSUITE()\nCALC_CHAMP(reuse=R, RESULTAT=R, CONTRAINTE='SIEF_NOEU')\nFIN()\n"
        self.assertEqual(self.started(more, "--base", "study.base", name="more.comm"), ["calc_champ"])
        self.assertEqual(self.started(more, "--base", "study.base", name="more.comm"), ["calc_champ"])
        self.assertEqual(self.started(self.first), [])
        self.assertEqual(self.started(more, "--base", "study.base", name="more.comm"), [])  # what it made of the same R is there

    def test_a_killed_run_between_versions(self):
        run = self.run_study(STUDY + "import os\nos._exit(9)\n")  # R is what it was before CALC_CHAMP
        self.assertEqual(run.status, 9)
        self.assertEqual(self.started(self.first), [])
        self.run_study(STUDY + "import os\nos._exit(9)\n")
        more = "POURSUITE()\nprint(R.field_names())\nIMPR_RESU(UNITE=80, RESU=_F(RESULTAT=R))\nN = AFFE_MODELE(MAILLAGE=M, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='3D'))\nFIN()\n"
        self.assertEqual(self.started(more, "--base", "study.base", name="more.comm"), ["impr_resu", "affe_modele"])

    def test_what_a_killed_run_enriched_is_not_enriched_twice(self):
        """Killed behind the operator, at each step until the registry tells what it has made, and at the next one."""
        die = """
import os, sys
def step(frame, event, _):
    if event == EVENT and frame.f_code.co_name == NAME and "lacon" in frame.f_code.co_filename:
        os._exit(9)
"""
        more = """
POURSUITE()
sys.setprofile(step)
DEFI_GROUP(reuse=M0, MAILLAGE=M0, CREA_GROUP_MA=_F(NOM='NEW', TOUT='OUI'))
FIN()
"""
        for name, event in (("Outcome", ""), ("enter_next", "call"), ("_add", "call"), ("enter_next", "return"), ("update_labels", "return"), ("write", "return"), ("_result", "return")):
            with self.subTest(name, event=event):
                self.back_to_first()
                text = die.replace("EVENT", repr(event)).replace("NAME", repr(name)) + more
                run = self.run_study(text, "--base", "study.base", name="more.comm", behaviour={"defi_group": {"launcher": 9}} if not event else None)
                self.assertIn(run.status, (9, -9), run.err)
                self.ok(self.run_study(die + more.replace("step", "None"), "--base", "study.base", name="more.comm"))
                (mesh,) = [i for label, i in self.registry()["labels"].items() if label == "M0"]
                with h5py.File(self.work / "study.base" / f"{mesh}.h5") as file:
                    self.assertEqual(file.attrs["version"], 2)
                self.assertEqual([path.name for path in (self.work / "study.base").rglob("*.partial")], [])


if __name__ == "__main__":
    unittest.main()
