"""A computation that is ended in its middle, whatever ends it: the instants that were told as converged are in the base, and the same
command file run again computes what is missing to the same bits."""

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "robustness")]

from study_test import LACON, SECONDS, StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from meshes import block, brick, union, write_med  # noqa: E402
from unseen import study as unseen  # noqa: E402

STUDY = HERE / "study.comm"
INSTANTS = 20


def stack(fineness):
    """A block with a round foot on two others, meshes that do not match."""
    def lines(first, last, steps):
        return np.linspace(first, last, steps + 1)

    def foot(s, t):
        return s, 1.0 + t + (1 - t) * 0.08 * (s - 1.6) ** 2

    return union([
        block("QUAD8", lines(0, 4, 4 * fineness), lines(-1, 0, 2 * fineness), name="LOWER", sides={"bottom": "BASE", "top": "GROUND"}),
        block("QUAD8", lines(0, 3, 3 * fineness + 1), lines(0, 1, 2 * fineness), name="MIDDLE",
              sides={"bottom": "SOLE", "top": "TABLE", "left": "LEFT", "right": "RIGHT"}),
        block("QUAD8", lines(1, 2.2, 2 * fineness), lines(0, 1, 2 * fineness), place=foot, name="UPPER", sides={"bottom": "FOOT", "top": "TOP"})])


def stack_in_space(fineness):
    """The same of HEXA8, a half wide."""
    def body(name, sides, sizes, first, last, bottom, place=None):
        lines = [np.linspace(first, last, sizes[0] + 1), np.linspace(bottom, bottom + 1, sizes[1] + 1), np.linspace(0, 0.5, sizes[2] + 1)]
        return brick("HEXA8", lines, name=name, place=place, sides={**sides, (2, 0): "FRONT"})

    def foot(x, y, z):
        return x, y + (2 - y) * 0.08 * (x - 1.6) ** 2, z

    return union([
        body("LOWER", {(1, 0): "BASE", (1, 1): "GROUND"}, (4 * fineness, 2 * fineness, fineness), 0, 4, -1),
        body("MIDDLE", {(1, 0): "SOLE", (1, 1): "TABLE", (0, 0): "LEFT", (0, 1): "RIGHT"}, (3 * fineness + 1, 2 * fineness, fineness + 1), 0, 3, 0),
        body("UPPER", {(1, 0): "FOOT", (1, 1): "TOP"}, (2 * fineness, 2 * fineness, fineness), 1, 2.2, 1, foot)])


def converged(text):
    """The instants that a run told as converged."""
    return re.findall(r"Converged at the instant (\S+)", text)


class FaultTest(StudyTest):
    """A test whose folder holds a mesh, and runs that are ended in their middle."""

    fineness = 2

    def setUp(self):
        super().setUp()
        write_med(self.folder / "stack.med", stack(self.fineness))
        self.environment = {}

    study = STUDY

    def command(self, base, *more):
        return [str(LACON), str(self.study), "--base", str(self.folder / base), "--unit", f"20={self.folder / 'stack.med'}", *map(str, more)]

    def start(self, base, *more, **options):
        """A run under way, its output in a pipe."""
        return subprocess.Popen(self.command(base, *more), cwd=self.folder, env={**os.environ, **self.environment}, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)

    def whole(self, base, *more):
        """A run to its end. @return what it said"""
        run = self.start(base, *more)
        text, _ = run.communicate(timeout=SECONDS)
        self.assertEqual(run.returncode, 0, text[-3000:])
        return text

    def until(self, run, count):
        """What a run says until it has told `count` instants as converged."""
        text = ""
        while len(converged(text)) < count:
            line = run.stdout.readline()
            self.assertTrue(line, text[-3000:])
            text += line
        return text

    def poursuite(self, base, lines):
        """A file that goes on with what a base holds. @return the run"""
        (self.folder / "more.comm").write_text(f"POURSUITE()\n{lines}\nFIN()\n", encoding="utf-8")
        return self.run_lacon("more.comm", "--base", self.folder / base)

    def index(self, base):
        """The index of the one result."""
        (path,) = (self.folder / base).glob("result_*/index.h5")
        return path

    def instants(self, base):
        with h5py.File(self.index(base)) as file:
            return [f"{instant:.9g}" for instant in file["instant"][1:]]


def children_of(process):
    """Processes that a process has started and not yet taken leave of."""
    try:
        return [int(child) for task in pathlib.Path(f"/proc/{process}/task").iterdir() for child in (task / "children").read_text().split()]
    except OSError:
        return []


def operator_of(launcher):
    """The operator that a launcher has started."""
    (operator,) = children_of(launcher)
    return operator


def is_alive(process):
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


class Kept(FaultTest):
    """What converged is kept under its name."""

    def check_kept(self, base, told):
        """Every instant told is in the index, and POURSUITE finds them, and says that the result is unfinished and where it ends."""
        there = self.instants(base)
        self.assertEqual(there[:len(told)], told)
        self.assertLess(len(there), INSTANTS)
        run = self.poursuite(base, f"print('it has', len(RESULT.getAccessParameters()['INST']))\nassert abs(RESULT.getField('DEPL', {len(there)}).getValues()[0]) < 1")
        self.assertEqual(run.status, 0, run.stdout + run.stderr)
        self.assertIn(f"it has {len(there) + 1}", run.stdout)
        self.assertIn("<A> <STUDY_31> RESULT is unfinished", run.stderr)
        self.assertIn(f"its last instant is {there[-1]}", run.stderr)

    def test_an_operator_is_killed(self):
        run = self.start("s.base")
        text = self.until(run, 3)
        os.kill(operator_of(run.pid), signal.SIGKILL)
        text += run.communicate(timeout=SECONDS)[0]
        self.assertEqual(run.returncode, 4, text)
        self.assertIn("INTERNAL_3", text)
        self.check_kept("s.base", converged(text))

    def test_a_launcher_is_killed(self):
        run = self.start("s.base", start_new_session=True)
        text = self.until(run, 3)
        os.killpg(run.pid, signal.SIGKILL)
        text += run.communicate(timeout=SECONDS)[0]
        self.check_kept("s.base", converged(text))

    def test_a_function_ends_in_the_middle(self):
        """<F> at the instant 0.55: a formula has no value there."""
        text = STUDY.read_text(encoding="utf-8").replace("GROUP_MA=\"TOP\", DX=ASIDE, DY=DOWN", "GROUP_MA=\"TOP\", DX=ASIDE, DY=HALF")
        text = text.replace("ASIDE = ", 'HALF = DEFI_FONCTION(NOM_PARA="INST", VALE=(0.0, 0.0, 0.52, -0.01))\nASIDE = ')
        (self.folder / "half.comm").write_text(text, encoding="utf-8")
        run = self.run_lacon("half.comm", "--base", "s.base", "--unit", "20=stack.med")
        self.assertEqual(run.status, 2, run.stdout[-2000:])
        self.assertIn("FUNCTION_1", run.stderr)
        self.assertEqual(len(converged(run.stdout)), 10)
        self.check_kept("s.base", converged(run.stdout))

    def test_the_index_can_be_read_at_any_moment(self):
        most = 0
        run = subprocess.Popen(self.command("s.base"), cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        while run.poll() is None:
            for path in (self.folder / "s.base").glob("result_*/index.h5"):
                with h5py.File(path) as file:
                    self.assertGreaterEqual(len(file["instant"]), max(2, most))
                    most = len(file["instant"])
                    for entry in file["fields"].values():
                        self.assertTrue(all((self.folder / "s.base" / name).is_file() for name in entry["file"].asstr()[:]))
        self.assertEqual((run.returncode, most), (0, INSTANTS + 1))


class Ends(FaultTest):
    """No operator outlives its launcher, and both end within two seconds."""

    MOMENT = 2.0

    def ended_by(self, number, whom=lambda run: run.pid, how=os.kill):
        """A run that gets a signal after two instants; no operator is left. @return its exit status, what it said"""
        run = self.start("s.base", start_new_session=True)
        text = self.until(run, 2)
        operator, start = operator_of(run.pid), time.monotonic()
        how(whom(run), number)
        text += run.communicate(timeout=SECONDS)[0]
        while is_alive(operator) and time.monotonic() < start + SECONDS:
            time.sleep(0.01)
        self.assertLess(time.monotonic() - start, self.MOMENT)
        self.assertEqual(self.instants("s.base")[:2], converged(text)[:2])
        return run.returncode, text

    def test_the_launcher_is_killed(self):
        self.assertEqual(self.ended_by(signal.SIGKILL)[0], -signal.SIGKILL)

    def test_the_launcher_is_killed_beside_a_formula(self):
        """The operator waits for its values: it told an internal error."""
        plain = STUDY.read_text(encoding="utf-8")
        self.study = self.folder / "formula.comm"
        self.study.write_text(plain.replace('ASIDE = DEFI_FONCTION(NOM_PARA="INST", VALE=(0.0, 0.0, 0.3, 0.0, 1.0, 0.04))',
                                            'ASIDE = FORMULE(NOM_PARA="INST", VALE="aside(INST)", aside=aside)')
                              .replace("DEBUT()\n", "import time\n\ndef aside(instant):\n    time.sleep(0.3)\n    return 0.04 * instant\n\nDEBUT()\n"), encoding="utf-8")
        status, text = self.ended_by(signal.SIGKILL)
        self.assertEqual(status, -signal.SIGKILL)
        self.assertNotIn("INTERNAL_1", text)
        self.assertLessEqual(set(re.findall(r"<[FS]> <(\w+)>", text)), {"FORMULE_7", "EVOLUTION_30"})  # or its output has gone with the launcher

    def test_the_launcher_is_asked_to_end(self):
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGXCPU):
            status, text = self.ended_by(number)
            self.assertEqual(status, 4, text)
            self.assertIn(f"<F> <STUDY_18> the run was ended by {number.name}\n    where: {STUDY}:", text)
            self.assertIn("COMMAND_14", text)
            shutil.rmtree(self.folder / "s.base")

    def test_the_operator_is_asked_to_end(self):
        """The status is that of any interruption, whoever got the signal."""
        status, text = self.ended_by(signal.SIGTERM, lambda run: operator_of(run.pid))
        self.assertEqual(status, 4, text)
        self.assertIn("<F> <EVOLUTION_30> ended by SIGTERM", text)
        self.assertIn("--- DIAGNOSTIC JOB : <F>_ABNORMAL_ABORT", text)

    def test_both_are_interrupted(self):
        """As by Ctrl-C in a terminal."""
        status, text = self.ended_by(signal.SIGINT, lambda run: os.getpgid(run.pid), os.killpg)
        self.assertEqual(status, 4, text)
        self.assertIn(f"<F> <STUDY_18> the run was ended by SIGINT\n    where: {STUDY}:", text)

    def test_whoever_reads_the_output_goes(self):
        """As after `lacon study.comm | head`; `both`: after `lacon study.comm 2>&1 | head`."""
        for both in (False, True):
            with open(self.folder / "log", "w+", encoding="utf-8") as log:
                run = subprocess.Popen(self.command("s.base"), cwd=self.folder, env={**os.environ, **self.environment}, text=True,
                                       stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT if both else log)
                told = converged(self.until(run, 2))
                operator = operator_of(run.pid)
                run.stdout.close()
                self.assertEqual(run.wait(SECONDS), 4)
                self.assertFalse(is_alive(operator))
                log.seek(0)
                said = log.read()
            self.assertNotIn("Traceback", said)
            self.assertTrue(both or "<F> <STUDY_18> the run was ended by SIGPIPE" in said, said)
            self.assertEqual(self.instants("s.base")[:2], told[:2])
            shutil.rmtree(self.folder / "s.base")

    def test_the_time_limit_is_over(self):
        (self.folder / "s.export").write_text(f"P time_limit 1.5\nF comm {STUDY} D 1\nF libr {self.folder}/stack.med D 20\n", encoding="utf-8")
        self.environment["FAULTS_LAW"] = "VMIS_ISOT_LINE"
        write_med(self.folder / "stack.med", stack(16))  # many times the limit on any machine
        run = self.run_tool("s.export", "--base", "s.base", FAULTS_LAW="VMIS_ISOT_LINE")
        self.assertEqual(run.returncode, 3, run.stdout[-2000:] + run.stderr)
        self.assertIn(f"<S> <STUDY_25> the time limit of 1.5 s is over\n    where: {STUDY}:", run.stderr)

    def test_who_uses_the_base(self):
        write_med(self.folder / "stack.med", stack(9))
        run = self.start("s.base")
        self.until(run, 1)
        other = self.run_tool(*self.command("s.base")[1:])
        self.assertEqual(other.returncode, 2, other.stdout)
        self.assertIn(f"in use by another run: process {run.pid}, since 20", other.stderr)
        self.assertEqual(run.wait(SECONDS), 0, run.communicate())
        run.stdout.close()

    def test_the_next_run_waits_for_the_operator_of_one_that_was_killed(self):
        run = self.start("s.base")
        self.until(run, 1)
        run.kill()
        run.communicate()
        self.whole("s.base")


def content_of(base):
    """Everything that the one result of a base holds: (field, order) -> its arrays; parameters, instants and tables of its index."""
    found = {}
    (path,) = base.glob("result_*/index.h5")
    with h5py.File(path) as index:
        assert index.attrs["complete"] == 1
        for name, entry in index["fields"].items():
            for order, file in zip(entry["order"][:], entry["file"].asstr()[:]):
                with h5py.File(base / file) as field:
                    found[name, int(order)] = {key: field[key][:].tobytes() for key in field}
        for name in ("order", "instant"):
            found[name] = index[name][:].tobytes()
        for name, values in index["parameters"].items():
            found["parameter", name] = values[:].tobytes()
        if "tables" in index:
            index["tables"].visititems(lambda name, item: found.update({("table", name): item[:].tolist()}) if isinstance(item, h5py.Dataset) else None)
    return found


class GoesOn(FaultTest):
    """The same command file again goes on behind the last archived instant, to the bits of a run that nothing disturbed."""

    def check(self, *stops, law="ELAS", model="D_PLAN", **keywords):
        """Undisturbed, and ended behind these numbers of instants each time. @return what both whole runs said"""
        return self.compare(stops, {"FAULTS_LAW": law, "FAULTS_MODEL": model, "FAULTS_ORDERS": json.dumps(keywords)})

    def compare(self, stops, environment):
        """Likewise, with what the study reads in its environment."""
        self.environment = {**environment, "LACON_RESTART_ALWAYS": "1"}
        undisturbed = self.whole("whole.base")
        expected = content_of(self.folder / "whole.base")
        told = 0
        for stop in stops:
            run = self.start("s.base")
            self.until(run, stop - told)
            os.kill(operator_of(run.pid), signal.SIGKILL)
            text = run.communicate(timeout=SECONDS)[0]
            self.assertEqual(run.returncode, 4, text)
            told = len(self.instants("s.base"))
        text = self.whole("s.base")
        self.assertRegex(text, r"RESU\w* goes on behind the instant")
        found = content_of(self.folder / "s.base")
        self.assertEqual(sorted(map(str, found)), sorted(map(str, expected)))
        self.assertEqual([key for key in expected if found[key] != expected[key]], [])
        self.assertEqual([path.name for path in self.index("s.base").parent.glob("restart*")], [])
        return undisturbed, text

    def test_elastic_bodies(self):
        _, text = self.check(3, 9, 17)
        self.assertLess(len(converged(text)), 4)

    def test_plastic_bodies(self):
        self.check(2, 8, 15, law="VMIS_ISOT_LINE")

    def test_a_matrix_that_is_not_symmetric(self):
        self.check(4, 12, COMPORTEMENT=[{"TOUT": "OUI", "RELATION": "VMIS_ISOT_LINE", "DEFORMATION": "PETIT_REAC"}])

    def test_instants_that_begin_where_the_last_motion_leads_to(self):
        self.check(4, 12, NEWTON={"PREDICTION": "EXTRAPOLE"})

    def test_a_factor_that_serves_for_many_instants(self):
        """Without the pressure that follows the stiffness never changes: GMRES and columns of the inverse make up for contact."""
        write_med(self.folder / "stack.med", stack_in_space(4))
        loads = [{"CHARGE": "HOLD"}, {"CHARGE": "MOVE"}, {"CHARGE": "GRIP"}]
        text, _ = self.check(4, 11, 12, model="3D", EXCIT=loads)
        self.assertGreater(len(re.findall(r"\| +- \| .* - \|", text)), 5, "factors that were used again")

    def assert_same_alarms(self, undisturbed, text, *identifiers):
        """Each alarm is told once, before the end or behind it, with the same words."""
        of_both = [sorted(line for line in said.splitlines() if line.startswith("<A>")) for said in (undisturbed, text)]
        self.assertEqual(of_both[1], of_both[0])
        self.assertEqual(len(set(of_both[0])), len(of_both[0]))
        for identifier in identifiers:
            self.assertEqual(text.count(f"<A> <{identifier}>"), 1, identifier)

    def test_alarms_are_told_once(self):
        """Those of the start, which a record holds and the run that goes on finds as well."""
        said = self.check(4, 12, ARCHIVAGE={"CHAM_EXCLU": "DEPLL", "DETR_NUME_SUIV": "OUI", "INST": [0.05 * i for i in range(1, 21)] + [0.33]})
        self.assert_same_alarms(*said, "EVOLUTION_56", "EVOLUTION_58", "EVOLUTION_62")

    def test_patches_that_keep_their_cover(self):
        def lines(first, last, steps):
            return np.linspace(first, last, steps + 1)

        self.study = HERE / "punch.comm"
        write_med(self.folder / "stack.med", union([
            block("QUAD4", lines(-2, 2, 17), lines(-1, 0, 5), name="LOWER", sides={"bottom": "BASE", "top": "GROUND"}),
            block("QUAD4", lines(-1, 1, 8), lines(0, 1, 4), name="PUNCH", sides={"bottom": "FACE", "top": "TOP"})]))
        self.assert_same_alarms(*self.check(2, 5, 6), "EVOLUTION_50")

    def test_equilibria_that_are_not_stable(self):
        """An arch that is pressed (drawn study 5089): its instants are solved by attempts that differ; that it is unstable is said once, of before too."""
        arguments, environment = unseen(5089).prepare(self.folder)
        self.study = arguments[0]
        os.replace(self.folder / "mesh.med", self.folder / "stack.med")
        _, text = self.compare((6, 8, 14), environment)
        self.assertEqual(text.count("EVOLUTION_54"), 1)

    def test_a_record_that_lies_behind(self):
        """Instants that take no time do not all get a record: some are computed again, and none is out of the index meanwhile."""
        self.environment = {"FAULTS_LAW": "VMIS_ISOT_LINE"}
        run = self.start("s.base")
        text = self.until(run, 10)
        os.kill(operator_of(run.pid), signal.SIGKILL)
        text += run.communicate(timeout=SECONDS)[0]
        for _ in range(2):  # the second time it is ended before it has come to where it was
            run = self.start("s.base")
            again = self.until(run, 1)
            self.assertEqual(self.instants("s.base")[:10], converged(text)[:10])
            run.send_signal(signal.SIGTERM)
            run.communicate(timeout=SECONDS)
        self.assertEqual(self.instants("s.base")[:10], converged(text)[:10])
        again = self.whole("s.base")
        self.assertGreater(len(converged(again)), 0)
        self.whole("whole.base")
        self.assertEqual(content_of(self.folder / "whole.base"), content_of(self.folder / "s.base"))

    def test_steps_that_grow(self):
        self.check(5, 12, law="VMIS_ISOT_LINE", INCREMENT={"LIST_INST": "STEPS"})

    def test_steps_that_are_cut(self):
        """Behind the instant 0.3 the upper body moves too far in a step, by 0.0029 where 0.002 is allowed: some ends come between two parts."""
        text, _ = self.check(8, 11, 18, law="VMIS_ISOT_LINE", INCREMENT={"LIST_INST": "CUTS"})
        self.assertEqual((text.count("EVOLUTION_7"), len(converged(text))), (14, INSTANTS + 14))

    def test_instants_that_begin_again(self):
        """Where a law flows ever more, the residual of an instant that begins where the motion leads to is too large, and then that of the last state."""
        text, _ = self.check(17, 20, law="VMIS_ISOT_LINE", INCREMENT={"LIST_INST": "LIMITS"})
        self.assertGreater(text.count("EVOLUTION_48"), 0)

    def test_few_instants_are_archived(self):
        """One in four, of the others nothing is there: they are computed again."""
        _, text = self.check(6, law="VMIS_ISOT_LINE", ARCHIVAGE={"PAS_ARCH": 4, "CHAM_EXCLU": "SIEF_ELGA"})
        self.assertEqual(len(converged(text)), INSTANTS - 4)

    def test_tables_go_on(self):
        """Observations and works: rows of before, sums that go on from them."""
        watch = {"NOM_CHAM": "DEPL", "NOM_CMP": "DY", "GROUP_MA": "TOP", "EVAL_CHAM": "MIN"}
        self.check(7, OBSERVATION=watch, ENERGIE={})

    def test_a_launcher_is_killed_behind_the_end(self):
        """The operator has come to its end, and its launcher does not get to entering that: the next one asks for what there is."""
        self.environment = {"FAULTS_LAW": "VMIS_ISOT_LINE"}
        run = self.start("s.base")
        text = self.until(run, 1)
        operator = operator_of(run.pid)
        run.send_signal(signal.SIGSTOP)
        text += self.until(run, INSTANTS - 1)
        start = time.monotonic()
        while is_alive(operator) and time.monotonic() < start + SECONDS:
            time.sleep(0.01)
        run.kill()
        told = converged(text + run.communicate(timeout=SECONDS)[0])
        run = self.start("s.base")
        self.until(run, 1)
        run.kill()
        run.communicate(timeout=SECONDS)
        self.assertEqual((len(told), self.instants("s.base")), (INSTANTS, told))
        self.whole("s.base")
        self.whole("whole.base")
        self.assertEqual(content_of(self.folder / "whole.base"), content_of(self.folder / "s.base"))
        self.assertEqual([path.name for path in self.index("s.base").parent.glob("restart*")], [])

    def test_a_run_may_start_over(self):
        run = self.start("s.base")
        self.until(run, 3)
        run.kill()
        run.communicate()
        self.assertEqual(len(converged(self.whole("s.base", "--force"))), INSTANTS)


MORE = """
POURSUITE()
assert len(RESULT.getAccessParameters()["INST"]) >= 11
RESULT = STAT_NON_LINE(
    reuse=RESULT, RESULTAT=RESULT, MODELE=MODEL, CHAM_MATER=MATTER, CONTACT=CONTACT,
    EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=MOVE), _F(CHARGE=GRIP), _F(CHARGE=BLOW, TYPE_CHARGE="SUIV")),
    COMPORTEMENT=(_F(TOUT="OUI", RELATION="ELAS"), _F(GROUP_MA="MIDDLE", RELATION=law)), ETAT_INIT=_F(EVOL_NOLI=RESULT),
    INCREMENT=_F(LIST_INST=TIMES), CONVERGENCE=_F(ITER_GLOB_MAXI=40),
)
{then}
FIN()
"""


class Pursued(FaultTest):
    """A file that goes on with a result (reuse=) is run again after an error behind that, or in its middle."""

    def setUp(self):
        super().setUp()
        half = {"FAULTS_LAW": "VMIS_ISOT_LINE", "FAULTS_ORDERS": json.dumps({"INCREMENT": {"LIST_INST": "TIMES", "INST_FIN": 0.5}})}
        self.environment = {**half, "LACON_RESTART_ALWAYS": "1"}
        self.whole("s.base")
        shutil.copytree(self.folder / "s.base", self.folder / "whole.base")
        self.assertEqual(self.more("whole.base").returncode, 0)

    def write_more(self, then):
        (self.folder / "more.comm").write_text(MORE.format(then=then), encoding="utf-8")

    def more(self, base, then=""):
        self.write_more(then)
        return self.run_tool("more.comm", "--base", base)

    def test_an_error_behind_it(self):
        first = self.more("s.base", "1 / 0")
        self.assertEqual((first.returncode, len(converged(first.stdout))), (2, 10), first.stdout[-2000:] + first.stderr)
        for then in ("1 / 0", ""):
            again = self.more("s.base", then)
            self.assertEqual((again.returncode, len(converged(again.stdout))), (2 if then else 0, 0), again.stdout[-2000:] + again.stderr)
            self.assertNotIn("EVOLUTION_5", again.stderr)
            self.assertIn("unchanged since it was made: kept", again.stdout)
        self.assertEqual(content_of(self.folder / "s.base"), content_of(self.folder / "whole.base"))

    def test_killed_in_its_middle(self):
        self.write_more("")
        run = subprocess.Popen([LACON, "more.comm", "--base", "s.base"], cwd=self.folder, env={**os.environ, **self.environment}, text=True,
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.until(run, 4)
        run.kill()
        run.communicate()
        self.assertEqual(self.instants("s.base")[:14], self.instants("whole.base")[:14])
        again = self.more("s.base")
        self.assertEqual(again.returncode, 0, again.stdout[-2000:] + again.stderr)
        self.assertIn("goes on behind the instant", again.stderr)
        self.assertEqual(content_of(self.folder / "s.base"), content_of(self.folder / "whole.base"))

    def test_another_order_does_not_go_on_from_its_record(self):
        """Killed in its middle, changed, and killed again before it has come to an instant: nothing of the first order is in what follows."""
        command = [LACON, STUDY, "more.comm", "--base", "s.base", "--unit", "20=stack.med"]
        for most, count in ((40, 4), (41, 0)):
            (self.folder / "more.comm").write_text(MORE.format(then="").replace("MAXI=40", f"MAXI={most}"), encoding="utf-8")
            run = subprocess.Popen(command, cwd=self.folder, env={**os.environ, **self.environment}, text=True,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
            while not run.stdout.readline().startswith("more.comm:4: RESULT"):
                self.assertIsNone(run.poll())
            while not children_of(run.pid):
                self.assertIsNone(run.poll())
            self.until(run, count)
            os.killpg(run.pid, signal.SIGKILL)
            run.communicate()
        again = self.run_tool(*command[1:], **self.environment)
        self.assertEqual((again.returncode, converged(again.stdout)[:1]), (0, ["0.55"]), again.stdout[-2000:] + again.stderr)
        self.assertNotIn("goes on behind the instant", again.stderr)

    def test_the_remedy_where_the_order_is_another_one(self):
        self.more("s.base", "1 / 0")
        (self.folder / "more.comm").write_text(MORE.format(then="").replace("MAXI=40", "MAXI=41"), encoding="utf-8")
        again = self.run_tool("more.comm", "--base", "s.base")
        self.assertIn("there is no instant behind that of ETAT_INIT, 1", again.stderr)
        self.assertIn("leave this command out", again.stderr)


if __name__ == "__main__":
    unittest.main()
