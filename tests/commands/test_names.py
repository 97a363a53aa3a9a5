"""Concepts are labelled by the variable they are assigned to; POURSUITE finds names again or says why not."""

import cProfile
import json
import random
import sys
import types
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import STUDY, LauncherTest  # noqa: E402

from lacon.base import registry  # noqa: E402
from lacon.base.names import Names, concepts_of  # noqa: E402
from lacon.core.concepts import Concept  # noqa: E402

MATERIAL = "DEFI_MATERIAU(ELAS=_F(E=1, NU=0))"


class Labels(LauncherTest):
    def labels(self, body):
        self.ok(self.run_study(f"DEBUT()\n{body}\nFIN()\n"))
        return self.registry()["labels"]

    def test_a_variable(self):
        self.assertEqual(self.labels(f"MAT = {MATERIAL}"), {"MAT": "material_1"})

    def test_elements_of_a_list_in_a_loop(self):
        labels = self.labels(f"M = [None] * 2\nfor i in range(2):\n    M[i] = {MATERIAL}")
        self.assertEqual(labels, {"M[0]": "material_1", "M[1]": "material_2"})

    def test_an_index_that_is_computed(self):
        run = self.ok(self.run_study(f"DEBUT()\nM = {{}}\ni = 1\nM[i + 1, 'a'] = {MATERIAL}\nFIN()\n"))
        self.assertIn("M[(2, 'a')] = DEFI_MATERIAU", run.out)
        self.assertEqual(list(self.registry()["labels"]), ["M[(2, 'a')]"])

    def test_append_and_comprehension(self):
        labels = self.labels(f"M = []\nM.append({MATERIAL})\nN = [{MATERIAL} for i in range(2)]")
        self.assertEqual(set(labels), {"M[0]", "N[0]", "N[1]"})

    def test_elements_of_a_comprehension_are_announced_one_by_one(self):
        run = self.ok(self.run_study(f"DEBUT()\nfor k in range(2):\n    N = [{MATERIAL} for i in range(3) if i != 1]\n"
                                     f"D = {{'x' + i: {MATERIAL} for i in 'ab'}}\n"
                                     "F = [FORMULE(NOM_PARA='X', VALE='X * i', i=i) for i in (2, 3)]\nassert F[1](5) == 15\nFIN()\n"))
        if sys.version_info < (3, 12):
            self.assertEqual(run.out.count("N[0] = DEFI_MATERIAU"), 2)
            self.assertEqual(run.out.count("N[1] = DEFI_MATERIAU"), 2)
            self.assertIn("F[1] = FORMULE", run.out)
        self.assertIn("D['xa'] = DEFI_MATERIAU", run.out)
        self.assertIn("D['xb'] = DEFI_MATERIAU", run.out)
        self.assertEqual(set(self.registry()["labels"]), {"N[0]", "N[1]", "D['xa']", "D['xb']", "F[0]", "F[1]"})

    def test_tuples_and_dictionaries(self):
        labels = self.labels(f"A, B = {MATERIAL}, {MATERIAL}\nD = {{'x': {MATERIAL}}}\nT = ({MATERIAL}, [{MATERIAL}])")
        self.assertEqual(set(labels), {"A", "B", "D['x']", "T[0]", "T[1][0]"})

    def test_a_function_that_returns_a_concept(self):
        run = self.ok(self.run_study(f"DEBUT()\ndef f():\n    return {MATERIAL}\nA = f()\nL = [0]\nL[0] = f()\nFIN()\n"))
        self.assertIn("A = DEFI_MATERIAU", run.out)
        self.assertIn("L[0] = DEFI_MATERIAU", run.out)
        self.assertEqual(set(self.registry()["labels"]), {"A", "L[0]"})

    def test_a_local_variable_labels_the_file_and_not_the_study(self):
        self.assertEqual(set(self.labels(f"def f():\n    inner = {MATERIAL}\n    return inner\nA = f()")), {"A"})
        import h5py

        with h5py.File(self.work / "study.base" / "material_1.h5") as file:
            self.assertEqual(file.attrs["label"], "inner")

    def test_an_argument_has_no_label(self):
        run = self.ok(self.run_study(f"DEBUT()\nf = lambda x: x\nA = f({MATERIAL})\nFIN()\n"))
        self.assertIn(": DEFI_MATERIAU", run.out)
        self.assertEqual(set(self.registry()["labels"]), {"A"})

    def test_a_name_given_with_co_becomes_the_concept(self):
        run = self.ok(self.run_study(STUDY + """
MA = [M0, None, None]
kept = {}
for i in range(2):
    MA[i + 1] = CO('MA_%d' % (i + 1))
    kept[i] = MA[i + 1]
    MACR_ADAP_MAIL(ADAPTATION='RAFFINEMENT_UNIFORME', MAILLAGE_N=MA[i], MAILLAGE_NP1=MA[i + 1])
    assert MA[i + 1] is kept[i] and MA[i + 1].getNumberOfNodes() == 6
    C = CREA_MAILLAGE(MAILLAGE=MA[i + 1], LINE_QUAD=_F(TOUT='OUI'))
MACR_ADAP_MAIL(ADAPTATION='RAFFINEMENT_UNIFORME', MAILLAGE_N=M0, MAILLAGE_NP1=CO('FINE'))
assert FINE.getNumberOfNodes() == 6 and MA_2 is MA[2]
DETRUIRE(NOM=FINE)
FIN()
"""))
        self.assertIn("MA_1 = MACR_ADAP_MAIL", run.out)
        labels = self.registry()["labels"]
        self.assertTrue({"MA[1]", "MA[2]", "C"} <= set(labels) and "FINE" not in labels, labels)
        order = self.last_order("MACR_ADAP_MAIL")
        self.assertEqual(order["keywords"]["MAILLAGE_NP1"], {"concept": order["result"]["id"]})
        self.ok(self.run_study("POURSUITE()\nassert MA[2].getNumberOfNodes() == 6 and MA_2 is MA[2] and kept[1] is MA[2]\nFIN()\n"))

    def test_a_name_given_with_co_stays_one_when_the_command_fails(self):
        self.ok(self.run_study(STUDY + """
N = CO('N')
try:
    MACR_ADAP_MAIL(ADAPTATION='RAFFINEMENT_UNIFORME', MAILLAGE_N=M0, MAILLAGE_NP1=N)
except AsterError:
    assert isinstance(N, CO)
FIN()
""", behaviour={"macr_adap_mail": {"status": 2, "lazy": True}}))
        self.refused(self.run_study("POURSUITE()\nprint(N)\n"), "STUDY_8", "CO('N')", "no command has made its concept")

    def test_what_is_not_a_new_name_is_refused(self):
        call = "MACR_ADAP_MAIL(ADAPTATION='RAFFINEMENT_UNIFORME', MAILLAGE_N={}, MAILLAGE_NP1={})"
        for given, word in ((("M0", "M0"), "KEYWORD_16"), (("M0", "'N'"), "KEYWORD_3"), (("CO('N')", "CO('O')"), "has not been made"),
                            (("M0", "CO('taken')"), "taken = [1]"), (("M0", "CO('LIRE_MAILLAGE')"), "KEYWORD_16")):
            self.refused(self.run_study(STUDY + "\ntaken = [1]\n" + call.format(*given)), word)

    def test_a_name_given_with_co_is_assigned_where_a_variable_has_it(self):
        """Also to the mesh that the command starts from, and in a loop."""
        self.ok(self.run_study(STUDY + """
before, ids = M0, []
for i in range(2):
    MACR_ADAP_MAIL(ADAPTATION='RAFFINEMENT_UNIFORME', MAILLAGE_N=M0, MAILLAGE_NP1=CO('M0'))
    ids.append(M0.id)
MA = {1: CO('MA')}  # the name of what holds it
MACR_ADAP_MAIL(ADAPTATION='RAFFINEMENT_UNIFORME', MAILLAGE_N=M0, MAILLAGE_NP1=MA[1])
assert len({before.id, MA[1].id, *ids}) == 4 and isinstance(MA, dict)
FIN()
"""))
        self.assertNotEqual(self.registry()["labels"]["M0"], self.registry()["labels"]["before"])
        self.ok(self.run_study("POURSUITE()\nassert M0.id == ids[1] != before.id\nFIN()\n"))

    def test_two_names_of_one_concept(self):
        self.assertEqual(self.labels(f"A = {MATERIAL}\nB = A"), {"A": "material_1", "B": "material_1"})

    def test_a_variable_names_a_concept_before_a_list_that_has_it(self):
        text = f"box = dict(A=1)\nA = {MATERIAL}\nfor box in (dict(IT=A),):\n    B = {MATERIAL}\nprint('NAME', A.getName(), box['IT'].getName())\n"
        self.assertIn("NAME A A", self.ok(self.run_study(f"DEBUT()\n{text}FIN()\n")).out)

    def test_assigning_again_leaves_what_was_made_on_the_old_concept(self):
        self.ok(self.run_study(STUDY + "M = CREA_MAILLAGE(MAILLAGE=M0, LINE_QUAD=_F(TOUT='OUI'))\nFIN()\n"))
        labels = self.registry()["labels"]
        self.assertNotEqual(labels["M"], "mesh_4")
        self.assertIn("mesh_4", self.entries(), "the model refers to it")

    def test_reuse_with_and_without_assignment(self):
        text = STUDY + """
MODI_MAILLAGE(reuse=M, MAILLAGE=M, ORIE_PEAU=_F(GROUP_MA_PEAU='SKIN'))
N = MODI_MAILLAGE(reuse=M, MAILLAGE=M, ORIE_PEAU=_F(GROUP_MA_PEAU='SKIN'))
assert N is M
CALC_CHAMP(reuse=R, RESULTAT=R, CONTRAINTE='SIEF_NOEU')
FIN()
"""
        self.ok(self.run_study(text))
        import h5py

        labels = self.registry()["labels"]
        self.assertEqual(labels["M"], labels["N"])
        with h5py.File(self.work / "study.base" / f"{labels['M']}.h5") as file:
            self.assertEqual(file.attrs["version"], 3)
        self.assertEqual(self.last_order("CALC_CHAMP")["result"], {"id": labels["R"], "label": "R", "reuse": True})


class Resume(LauncherTest):
    def resume(self, first, second, *options):
        self.ok(self.run_study(f"DEBUT()\n{first}\nFIN()\n"))
        name = self.write("more.comm", f"POURSUITE()\n{second}\nFIN()\n").name
        return self.launch(name, "--base", "study.base", "--unit", "20=mesh.med", *options)

    def test_every_python_name_in_the_same_run(self):
        self.write("study.comm", f"DEBUT()\nA = {MATERIAL}\ndef f(x):\n    return x + 1\nclass Box: pass\nbox = Box()\nbox.a = A\nFIN()\n")
        self.write("study.com1", f"POURSUITE()\nassert f(1) == 2 and box.a is A\nassert A.open()\nB = {MATERIAL}\nFIN()\n")
        self.ok(self.launch("study.comm", "study.com1"))
        self.assertEqual(set(self.registry()["labels"]), {"A", "B"})

    def test_a_concept_that_only_an_object_holds_survives_fin_in_the_middle(self):
        self.write("study.comm", f"DEBUT()\nclass Box: pass\nbox = Box()\nbox.a = {MATERIAL}\nFIN()\n")
        self.write("study.com1", "POURSUITE()\nbox.a.open().close()\nFIN()\n")
        self.ok(self.launch("study.comm", "study.com1"))
        self.assertEqual(self.entries(), [], "and at the end nothing refers to it")

    def test_concepts_and_plain_data_in_a_later_run(self):
        first = f"""
import numpy as np
from numpy import linspace
A = {MATERIAL}
L = [A, {MATERIAL}]
D = {{'x': (1, 2.5, 'text', None, True), 3: [1j, b'b', {{4}}]}}
X = np.arange(6.0).reshape(2, 3)
x32 = np.float32(1.5)
inf = float('inf')
table = np.array([(1, 2.5)], dtype=[('n', 'i4'), ('x', 'f8')])
big = [0.5] * 100000
mixed = [1.5, float('nan'), 'a']
strange = 'caf\\udce9'
F = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, 10))
"""
        second = """
assert L[0] is A and A.label == 'A' and len(L) == 2, L
assert D == {'x': (1, 2.5, 'text', None, True), 3: [1j, b'b', {4}]}, D
assert type(D['x']) is tuple
assert X.shape == (2, 3) and X[1, 2] == 5 and X.dtype == float
assert x32 == 1.5 and x32.dtype == np.float32
assert inf > 1e308
assert table['x'][0] == 2.5 and big == [0.5] * 100000 and mixed[1] != mixed[1] and strange == 'caf\\udce9'
assert linspace(0, 1, 3)[1] == 0.5
assert F(0.25) == 2.5
B = AFFE_MATERIAU(MAILLAGE=LIRE_MAILLAGE(), AFFE=_F(TOUT='OUI', MATER=L[1]))
"""
        self.ok(self.resume(first, second))

    def test_a_lost_name_is_explained_where_it_is_first_used(self):
        run = self.refused(self.resume("def helper():\n    return 1\n", "a = 1\nb = helper()"), "STUDY_8", "'helper'", "function",
                           "more.comm:3")
        self.assertIn("define it again", run.err)

    def test_a_lost_name_inside_a_function(self):
        self.refused(self.resume("g = open(__file__)", "def f():\n    return g\nf()"), "STUDY_8", "'g'", "TextIOWrapper", "more.comm:3")

    def test_a_lost_name_that_is_defined_again_is_no_error(self):
        self.ok(self.resume("def f():\n    return 1", "def f():\n    return 2\nassert f() == 2"))

    def test_a_lost_name_stays_lost_in_a_third_run(self):
        self.ok(self.resume("f = lambda: 1", "a = 1"))
        self.refused(self.launch(self.write("third.comm", "POURSUITE()\nf()\n").name, "--base", "study.base"), "STUDY_8", "'f'")

    def test_a_name_that_never_was_is_an_ordinary_error(self):
        self.refused(self.resume("a = 1", "nowhere"), "STUDY_20", "'nowhere'", "more.comm:2")

    def test_a_list_that_holds_a_function_is_lost_with_its_reason(self):
        self.refused(self.resume("L = [1, lambda: 2]", "L"), "STUDY_8", "'L'", "function")

    def test_a_killed_run_loses_nothing_that_was_done(self):
        text = f"DEBUT()\nA = {MATERIAL}\nL = []\nL.append({MATERIAL})\nM = [0]\nM[0] = {MATERIAL}\nimport os, signal\nos.kill(os.getpid(), 9)\n"
        self.assertEqual(self.run_study(text).status, -9)
        more = self.write("more.comm", "POURSUITE()\nassert A and M[0]\nA.open(); M[0].open()\nFIN()\n")
        self.ok(self.launch(more.name, "--base", "study.base"))

    def test_data_that_a_killed_run_did_not_save_say_so(self):
        self.run_study(f"DEBUT()\nx = 5\nA = {MATERIAL}\nimport os\nos.kill(os.getpid(), 9)\n")
        self.refused(self.run_study("POURSUITE()\nassert A.getType() == 'material'\nprint(x)\n"), "STUDY_24", "'x'", "was killed")
        self.refused(self.run_study("POURSUITE()\nprint(x)\n"), "STUDY_20")  # this one was not killed

    def test_a_killed_run_keeps_the_data_of_the_run_before(self):
        self.ok(self.run_study("DEBUT()\nx = 5\ny = [1, 2]\nz = 1\nw = 1\nFIN()\n"))
        text = f"POURSUITE()\ny.append(3)\nz = {MATERIAL}\ndel w\nA = {MATERIAL}\nimport os\nos.kill(os.getpid(), 9)\n"
        self.assertEqual(self.launch(self.write("second.comm", text).name, "--base", "study.base").status, -9)
        more = self.write("third.comm", "POURSUITE()\nassert x == 5 and y == [1, 2]\nA.open(); z.open()\nassert 'w' not in globals()\nFIN()\n")
        self.ok(self.launch(more.name, "--base", "study.base"))

    def test_long_lists_cost_little(self):
        """Concepts are looked for in a list of points without a call for each."""
        calls = []
        for length in (10, 1000):
            counter = cProfile.Profile(builtins=False)
            self.assertEqual(counter.runcall(lambda n: list(concepts_of("points", [[0.0, 1.0, 2.0] for _ in range(n)])), length), [])
            calls.append(sum(line.callcount for line in counter.getstats()))
        self.assertEqual(*calls)

    def test_without_a_base(self):
        self.refused(self.run_study("POURSUITE()\n"), "STUDY_2", "study.base", "study.comm:1")
        self.assertFalse((self.work / "study.base").exists())

    def test_names_after_poursuite_win_over_saved_ones(self):
        self.ok(self.resume(f"A = {MATERIAL}\nx = 1", "x = 2\nA = 3"))
        self.assertEqual(self.registry()["labels"], {})
        self.ok(self.launch(self.write("third.comm", "POURSUITE()\nassert (x, A) == (2, 3)\n").name, "--base", "study.base"))


class ManyNames(unittest.TestCase):
    """What a command costs does not grow with the square of how many there are."""

    def study(self):
        return Names({"DEBUT": print}), types.SimpleNamespace(registry=registry.empty())

    def test_labels_of_what_is_new_are_those_of_all_names(self):
        """Whatever a command file does between two commands; drawn by lot. The other study looks at all names each time."""
        quickly = 0
        for seed in range(200):
            draw = random.Random(seed)
            (quick, base), (whole, other) = self.study(), self.study()
            for names, at in ((quick, base), (whole, other)):
                if seed % 2:
                    names.values["L"] = []  # which may come to hold concepts
                if seed % 5 == 0:  # of an earlier run
                    at.registry["labels"] = {"A0[1]": "mesh_1", "B1.x": "mesh_2", "L[0]": "mesh_3", "old": "mesh_4"}
            for number in range(30):
                identifier, label = f"material_{number}", draw.choice("ABCDEFGH") + str(number // 8)
                made, same = Concept(None, identifier, label), Concept(None, identifier, label)
                pending = draw.choice([(label, identifier), (f"L[{number}]", identifier), ("", identifier)])
                for names, at in ((quick, base), (whole, other)):
                    names._seen = names._seen if names is quick else None
                    names.update_labels(at, pending)
                self.assertEqual(base.registry, other.registry, seed)
                kind = draw.randrange(11)
                for names, item in ((quick, made), (whole, same)):
                    values = names.values
                    if kind < 5:
                        values[label] = item
                    elif kind == 5:
                        values.setdefault("L", []).append(item)
                    elif kind == 6:
                        values["i"] = number
                        values[label] = values["again"] = item
                    elif kind == 7:
                        values.pop(label, None)
                        values["plain"] = [number]
                    elif kind == 8:  # DETRUIRE
                        for name in [n for n, v in values.items() if isinstance(v, Concept)][:1]:
                            values.pop(name).destroyed = "here"
                whole._seen = None
                before = quick._seen
                self.assertEqual(quick.update_labels(base), whole.update_labels(other), seed)
                quickly += before is not None and quick._seen is before
                self.assertEqual(base.registry, other.registry, seed)
                self.assertEqual([getattr(v, "label", None) for v in quick.values.values()], [getattr(v, "label", None) for v in whole.values.values()])
        self.assertGreater(quickly, 500)

    def test_all_names_are_looked_at_once(self):
        names, base = self.study()
        looked = []
        names._update_all_labels = lambda *arguments: looked.append(1) or Names._update_all_labels(names, *arguments)
        for number in range(100):
            names.update_labels(base)
            names.update_labels(base, (f"F{number}", f"function_{number}"))
            names.values[f"F{number}"] = Concept(None, f"function_{number}")
            names.values["i"] = number
        self.assertTrue(names.update_labels(base) is False and len(base.registry["labels"]) == 100)
        self.assertEqual(len(looked), 1)

    def test_the_text_of_a_registry_is_that_of_its_content(self):
        """Of versions of concepts it is put together from what is known of each."""
        content = {**registry.empty(), "made": {}}
        for number in range(5):
            content["made"].setdefault(f"mesh_{number // 2}", []).append({"key": str(number), "stat": [1, number], "alarms": [], "references": []})
            self.assertTrue(registry.sealed(content).startswith(json.dumps(content)[:-1]))
        content["made"]["mesh_0"][1] = dict(content["made"]["mesh_0"][1], key="another")
        del content["made"]["mesh_1"]
        self.assertTrue(registry.sealed(content).startswith(json.dumps(content)[:-1]))


if __name__ == "__main__":
    unittest.main()
