"""What is odd around a run, but happens: outputs that take no more, files in other encodings, folders that are gone, names that hide others. Each ends well,
or with a message of the user's."""

import os
import pathlib
import shutil
import subprocess
import sys
import time
import types
import unittest.mock

from support import ROOT, STUDY, LauncherTest, main
from lacon.base import kept

PRINT = "IMPR_RESU(UNITE=80, RESU=_F(RESULTAT=R))\n"


class Surroundings(LauncherTest):
    def shell(self, line, before=""):
        """`lacon` with these words of a shell, behind what comes before. @return the process"""
        env = {**os.environ, "PYTHONPATH": str(ROOT / "commands"), "LACON_BIN": str(self.bin), "PYTHONDONTWRITEBYTECODE": "1"}
        return subprocess.run(["sh", "-c", f"{before} exec '{sys.executable}' -m lacon {line}"], cwd=self.work, env=env, text=True, capture_output=True, timeout=120)

    def test_an_encoding_that_the_file_does_not_name(self):
        for content, line, byte in ((b"# \xe9t\xe9\nDEBUT()\n", 1, "0xE9"), (b"DEBUT()\n\n\nt = '\xe9t\xe9'\n", 4, "0xE9"),
                                    ("DEBUT()\n".encode("utf-16"), 1, "0xFF")):
            (self.work / "study.comm").write_bytes(content)
            run = self.refused(self.launch("study.comm"), "STUDY_35", f"study.comm:{line}", byte, "# coding: latin-1")
            self.assertNotIn("Traceback", run.err)
        (self.work / "study.comm").write_bytes(b"# coding: ascii\nDEBUT()\n\n# \xe9\n")
        self.refused(self.launch("study.comm"), "STUDY_16", "study.comm", "ascii")
        (self.work / "study.comm").write_bytes(b"\xef\xbb\xbfDEBUT()\r\nfor i in (1,):\r\n\tprint('\xc3\xa9', i)\r\nFIN()\r\n")
        self.assertIn("é 1", self.ok(self.launch("study.comm")).out)
        self.assertIn("\\xe9 1", self.ok(self.launch("study.comm", environment={"PYTHONIOENCODING": "ascii"})).out)

    def test_an_output_that_takes_no_more(self):
        """As a file on a disk that is full: the run says so where it still can, and ends as at any other full disk."""
        self.write("study.comm", STUDY + "FIN()\n")
        self.write("wrong.comm", "DEBUT(")
        for name, closed in (("study.comm", ">/dev/full"), ("study.comm", ">/dev/full 2>&1"), ("wrong.comm", "2>/dev/full")):
            run = self.shell(f"{name} --unit 20=mesh.med {closed}")
            self.assertEqual(run.returncode, 2, closed + run.stderr)
            self.assertEqual("<F> <STUDY_34> what the run says cannot be written: No space left on device" in run.stderr, closed == ">/dev/full", run.stderr)
            self.assertNotIn("Traceback", run.stderr)
        os.environ["STAND_IN"] = '{"affe_modele": {"log_lost": true}}'  # what an operator says is lost as well
        self.addCleanup(os.environ.pop, "STAND_IN")
        run = self.shell("study.comm --unit 20=mesh.med 2>/dev/full")
        self.assertEqual((run.returncode, run.stdout.splitlines()[-1]), (2, "--- DIAGNOSTIC JOB : <F>_ERROR"), run.stdout)
        self.assertEqual(self.shell("help DEFI_CONTACT >/dev/full").returncode, 2)
        self.ok(self.launch("study.comm", "--unit", "20=mesh.med"))

    def test_an_output_that_a_command_file_closes_beneath_python(self):
        run = self.run_study("import os\nDEBUT()\nos.close(1)\nos.close(0)\nL = DEFI_LIST_REEL(VALE=(0.,))\n")
        self.assertEqual(run.status, 2)
        self.assertIn("<STUDY_34> what the run says cannot be written: Bad file descriptor\n    where: study.comm:5", run.err)
        self.assertNotIn("Traceback", run.err)

    def test_two_units_do_not_write_one_file(self):
        """The second would replace the first in silence; a unit that was released, and one that is read, may have its file."""
        (self.work / "link").symlink_to(self.work / "out")
        for path in ("out", "./out", "link"):
            run = self.run_study(STUDY + PRINT + PRINT.replace("80", "81"), "--unit", "80=out", "--unit", f"81={path}", behaviour={"impr_resu": {"unit": "80"}})
            self.refused(run, "COMMAND_17", "unit 81 has the file of the unit 80", "IMPR_RESU/UNITE, study.comm:13")
        self.ok(self.run_study(STUDY + "L2 = LIRE_MAILLAGE(UNITE=21)\nFIN()\n", "--unit", "21=mesh.med"))

    def test_no_unit_and_no_report_is_a_file_of_the_base(self):
        """Results went into the place of the registry, or of a concept, and the run said OK."""
        for name in ("base.json", "mesh_1.h5", "new"):
            run = self.run_study(STUDY + PRINT, "--unit", f"80=study.base/{name}", behaviour={"impr_resu": {"unit": "80"}})
            self.refused(run, "COMMAND_18", f"study.base/{name}", "IMPR_RESU/UNITE, study.comm:12")
        self.ok(self.run_study(STUDY + PRINT, "--unit", "80=study.based", behaviour={"impr_resu": {"unit": "80"}}))
        self.ok(self.launch("study.comm", "--unit", "20=mesh.med", "--unit", "80=out"))
        (self.work / "out").write_bytes(b"a result")
        for name in ("study.base/base.json", "study.comm", "mesh.med", "out"):
            before = (self.work / name).read_bytes()
            self.refused(self.launch("study.comm", "--unit", "20=mesh.med", "--unit", "80=out", "--json", name), "STUDY_41", name)
            self.assertEqual((self.work / name).read_bytes(), before)

    def test_a_link_stays_one_and_its_file_is_written(self):
        (self.work / "disk").mkdir()
        for name in ("out", "checks.json"):
            (self.work / name).symlink_to(f"disk/{name}")
        for first in (True, False):  # before there is such a file, and when there is one
            self.ok(self.run_study(STUDY + PRINT + "FIN()\n", "--unit", "80=out", "--json", "checks.json", behaviour={"impr_resu": {"unit": "80"}}))
            for name in ("out", "checks.json"):
                self.assertTrue((self.work / name).is_symlink(), name)
                self.assertGreater((self.work / "disk" / name).stat().st_size, 0, name)
            self.assertEqual(self.last_order("IMPR_RESU")["units"], {"80": os.path.realpath(self.work / "disk/out")})  # an operator renames what it has written

    def test_no_result_replaces_what_is_included_later(self):
        """Nor the export file."""
        self.write("part.comm", "X = 1\n")
        self.write("s.export", "F comm study.comm D 1\nF libr mesh.med D 20\nF libr out R 80\n")
        text = STUDY + PRINT + "INCLUDE(DONNEE='part.comm')\nassert X == 1\nFIN()\n"
        behaviour = {"impr_resu": {"unit": "80"}}
        self.refused(self.run_study(text, "--unit", "80=part.comm", behaviour=behaviour), "COMMAND_12", "part.comm")
        self.ok(self.run_study(text, "--unit", "80=out", behaviour=behaviour))
        self.refused(self.launch("s.export", "--unit", "80=s.export", behaviour=behaviour), "COMMAND_12", "s.export")

    def test_one_file_has_one_format(self):
        """A second one would replace the first, or be put behind it; texts of several commands may follow one another, and a unit that has got another file is free."""
        table = "T = CREA_TABLE(LISTE=_F(PARA='X', LISTE_R=(1., 2.)))\n"
        med, listing, text = PRINT, PRINT.replace("RESU=", "FORMAT='RESULTAT', RESU="), "IMPR_TABLE(TABLE=T, UNITE=80)\n"
        behaviour = {"impr_resu": {"unit": "80"}}
        for first, second, words in ((med, listing, "FORMAT='MED', and FORMAT='RESULTAT'"), (listing, med, "FORMAT='RESULTAT', and FORMAT='MED'"),
                                     (med, text, "FORMAT='MED', and FORMAT='RESULTAT'"), (text, med, "FORMAT='RESULTAT', and FORMAT='MED'")):
            run = self.run_study(STUDY + table + first + second, "--unit", "80=out", behaviour=behaviour)
            self.refused(run, "COMMAND_20", words, "study.comm:14")
        again = "DEFI_FICHIER(UNITE=80, FICHIER='{}', ACCES='NEW')\n"
        self.ok(self.run_study(STUDY + table + listing + text + again.format("two") + med + med + again.format("two") + text + "FIN()\n", "--unit", "80=out",
                               behaviour=behaviour))

    def test_no_page_replaces_a_file_of_its_study(self):
        """Of `lacon report --out`; also through a link."""
        self.ok(self.run_study(STUDY + "FIN()\n"))
        (self.folder / "generated").mkdir()
        (self.folder / "generated/report.html").write_text("the page without a study")
        (self.work / "link").symlink_to("mesh.med")
        files = ("study.base/base.json", "study.base/new", "study.comm", "mesh.med", "link")
        before = {path: path.read_bytes() for path in self.work.rglob("*") if path.is_file()}
        for name in files:
            run = self.launch("report", "study.base", "--out", name)
            self.assertEqual(run.status, 2, run.err)
            self.assertIn(f"<F> <STUDY_41> --out {name} would replace a file of this study", run.err)
        self.assertEqual({path: path.read_bytes() for path in self.work.rglob("*") if path.is_file()}, before)

    def test_no_picture_and_no_pairing_goes_into_a_base(self):
        """Of `lacon plot --out` and `lacon inspect --out`; nor over a file that the study reads."""
        self.write("pairing.med", "a mesh")
        self.write("study.comm", STUDY + "FIN()\n")
        self.ok(self.launch("study.comm", "--unit", "20=pairing.med"))
        before = {path: path.read_bytes() for path in self.work.rglob("*") if path.is_file()}
        for tool, out in (("plot", "study.base/picture"), ("inspect", "study.base"), ("inspect", "study.base/kept/new"), ("inspect", ".")):
            run = self.launch(tool, "study.base", "--out", out)
            self.assertEqual(run.status, 2, run.err)
            self.assertIn(f"<F> <STUDY_41> --out {out}", run.err)
        self.assertEqual({path: path.read_bytes() for path in self.work.rglob("*") if path.is_file()}, before)

    def test_lacon_bin_is_a_folder_of_programs(self):
        self.write("study.comm", STUDY + "FIN()\n")
        for said, what in (("nowhere", "no folder"), ("mesh.med", "no folder"), (".", "no program of Lacon")):
            run = self.refused(self.launch("study.comm", "--unit", "20=mesh.med", environment={"LACON_BIN": said}), "COMMAND_22", f"'{said}'", what)
            self.assertIn("build/release/bin", run.err)

    def test_more_processes_than_any_machine_has(self):
        """They were started one by one, until nothing else ran."""
        self.write("study.comm", STUDY + "FIN()\n")
        self.write("s.export", "P mpi_nbcpu 999999\nF comm study.comm D 1\n")
        for arguments in (("study.comm", "--mpi", "100000"), ("s.export",)):
            self.refused(self.launch(*arguments), "STUDY_40", "1024")

    def test_numbers_of_an_export_file_are_numbers(self):
        """They were taken for 1 where they were none."""
        self.write("study.comm", STUDY + "FIN()\n")
        for line in ("P mpi_nbcpu abc", "P ncpus -2", "P mpi_nbcpu 2.0", "P ncpus", "P ncpus 2 3"):
            self.write("s.export", f"F comm study.comm D 1\n{line}\n")
            self.refused(self.launch("s.export"), "STUDY_43", "s.export:2", line.split()[1])

    def test_a_time_limit_is_a_number_of_seconds(self):
        """What is none was no limit; one that is over before the study begins, or longer than any timer, ended in a traceback."""
        self.write("study.comm", STUDY + "FIN()\n")
        for limit in ("-5", "nan", "abc", "10s", "0x10", "", "1 2"):
            self.write("s.export", f"F comm study.comm D 1\nP time_limit {limit}\n")
            self.refused(self.launch("s.export"), "STUDY_45", "s.export:2")
        for limit in ("1e-9", "1e-6"):
            self.write("s.export", f"F comm study.comm D 1\nP time_limit {limit}\n")
            self.refused(self.launch("s.export"), "STUDY_25", status=3, diagnostic="<S>_CPU_LIMIT")
        for limit in ("0", "1e300", "inf"):
            self.write("s.export", f"F comm study.comm D 1\nP time_limit {limit}\nF mmed mesh.med D 20\n")
            self.ok(self.launch("s.export"))

    def test_a_unit_of_an_export_file_has_one_file(self):
        """The last one was read in silence, an older result for the mesh."""
        self.write("study.comm", STUDY + "FIN()\n")
        self.write("s.export", "F comm study.comm D 1\nF mmed mesh.med D 20\nF rmed out.med R 20\n")
        self.refused(self.launch("s.export"), "STUDY_44", "s.export:3", "mesh.med", "out.med")
        self.write("s.export", "F comm study.comm D 1\nF mmed mesh.med D 20\nF mmed mesh.med R 20\n")
        self.ok(self.launch("s.export"))

    def test_an_end_asked_for_before_the_study_begins(self):
        """Ctrl-C while Python still reads Lacon's modules, or behind the end of the run."""
        self.write("study.comm", "DEBUT()\nFIN()\n")
        for step in ("units_of", "run_study"):
            code = (f"import sys; from lacon import main; from lacon.run import launch\ndef end(*_): raise KeyboardInterrupt\n"
                    f"launch.{step} = end\nsys.exit(main.main(['study.comm']))")
            run = subprocess.run([sys.executable, "-c", code], cwd=self.work, env={**os.environ, "PYTHONPATH": str(ROOT / "commands")}, text=True,
                                 capture_output=True, timeout=120)
            self.assertEqual(run.returncode, 4, run.stderr)
            self.assertIn("<STUDY_18> the run was ended by SIGINT", run.stderr)
            self.assertNotIn("Traceback", run.stderr)

    def test_an_export_file_that_begins_with_a_mark_of_its_encoding(self):
        self.write("study.comm", STUDY + "FIN()\n")
        (self.work / "study.export").write_bytes(b"\xef\xbb\xbfF comm study.comm D 1\r\nF mmed mesh.med D 20\r\n")
        self.ok(self.launch("study.export"))

    def test_a_file_that_hides_a_package(self):
        (self.work / "h5py").mkdir()
        for name, package in (("numpy.py", "numpy"), ("h5py/__init__.py", "h5py")):
            self.write(name, "")
            run = self.refused(self.run_study("DEBUT()\nFIN()\n"), "<STUDY_36>", f"{name} beside the command file hides the Python package {package}")
            self.assertNotIn("Traceback", run.err)
            (self.work / name).unlink()
        self.ok(self.run_study("DEBUT()\nFIN()\n"))  # a folder of that name alone hides nothing

    def test_files_named_as_modules_of_python_do_not_matter(self):
        """numpy, h5py and Lacon find Python's own, whether or not the command file imports what lies beside it."""
        names = ("copy", "random", "string", "logging", "inspect", "platform", "dis", "secrets", "subprocess")
        for name in names:
            self.write(f"{name}.py", "mine = True\n")
        for first in ("", f"import {', '.join(names)}\nassert copy.mine and random.mine\n"):
            self.ok(self.run_study(first + STUDY + "VALUES = DEFI_LIST_REEL(VALE=(0, 1))\nassert len(VALUES.getValues()) == 2\n"
                                   + ("import copy\nassert copy.mine\n" if first else "") + "FIN()\n"))
        self.refused(self.run_study("import copy\ncopy.deepcopy(1)\n"), "STUDY_19", "deepcopy")  # the command file itself finds its own

    def test_a_working_folder_that_was_removed(self):
        self.write("study.comm", "DEBUT()\nFIN()\n")
        for arguments in ("../study.comm", "new ../mesh.med"):
            run = self.shell(arguments, "mkdir gone; cd gone; rmdir ../gone;")
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertIn("<STUDY_37> the working folder is not there any more", run.stderr)
            self.assertNotIn("Traceback", run.stderr)

    def test_an_operator_that_the_system_does_not_start(self):
        """As where the limit of processes is reached."""
        for content in ("#!/nowhere/at/all\n", "\x7fELF"):
            (self.bin / "affe_modele").write_text(content)
            run = self.refused(self.run_study(STUDY), "<STUDY_38> the operator affe_modele cannot be started", "study.comm:7")
            self.assertNotIn("Traceback", run.err)

    def test_processes_that_a_command_file_forks(self):
        """They end as any other at a signal, and leave the base, its end and its diagnosis to the run."""
        run = self.ok(self.run_study("""
import multiprocessing, os, signal, threading
DEBUT()
x = 1
with multiprocessing.get_context("fork").Pool(2) as pool:
    assert pool.map(abs, [-1, -2]) == [1, 2]
for end in ("raise SystemExit(0)", "FIN()"):
    child = os.fork()
    if child == 0:
        x = 2
        exec(end)
        raise SystemExit(0)
    os.waitpid(child, 0)
def forks():
    child = os.fork()
    if child == 0:  # a handler of Python's would run only where the process does not wait
        os._exit(signal.getsignal(signal.SIGTERM) != signal.SIG_DFL or signal.SIGTERM in signal.pthread_sigmask(signal.SIG_BLOCK, []))
    statuses.append(os.waitpid(child, 0)[1])
statuses = []
forks()
thread = threading.Thread(target=forks)
thread.start()
thread.join()
assert statuses == [0, 0]
assert signal.getsignal(signal.SIGTERM) != signal.SIG_DFL and not signal.pthread_sigmask(signal.SIG_BLOCK, [])
del forks, thread
C = DEFI_CONSTANTE(VALE=1.0)
FIN()
"""))
        self.assertNotIn("Traceback", run.err)
        self.assertEqual(run.out.count("DIAGNOSTIC JOB"), 1, run.out)
        self.ok(self.run_study("POURSUITE()\nassert x == 1 and C(0.0) == 1.0\nFIN()\n"))

    def test_what_changes_nothing(self):
        """A base that is a link, a mask of rights, no HOME, no folder for temporary files, a terminal of one column, a name of 255 bytes, much said."""
        (self.work / "elsewhere").mkdir()
        (self.work / "study.base").symlink_to("elsewhere")
        text = STUDY + "for i in range(10000): print(i)\nFIN()\n"
        before = os.umask(0o077)
        try:
            run = self.ok(self.run_study(text, environment={"HOME": "", "TMPDIR": "/nowhere/at/all", "COLUMNS": "1", "LINES": "1", "LC_ALL": "C"}))
        finally:
            os.umask(before)
        self.assertEqual(run.out.count("\n9999\n"), 1)
        self.assertTrue((self.work / "elsewhere/base.json").is_file() and (self.work / "study.base").is_symlink())
        self.assertEqual((self.work / "elsewhere/base.json").stat().st_mode & 0o077, 0)  # the rest is of stand-ins, which have a mask of their own
        self.write(f"{'n' * 250}.comm", STUDY + "FIN()\n")
        self.ok(self.launch(f"{'n' * 250}.comm", "--unit", "20=mesh.med"))
        self.ok(self.run_study(STUDY + "FIN()\n", "--base", "é à b.base", name="été.comm"))

    def test_a_base_that_is_removed_beneath_a_run(self):
        run = self.refused(self.run_study(STUDY.replace("R = STAT", "import shutil\nshutil.rmtree('study.base')\nR = STAT")), "<STUDY_3>", "study.base", "study.comm:13")
        self.assertNotIn("Traceback", run.err)

    def test_files_of_units_that_are_no_files(self):
        """Pipes and folders are refused as data and as results, before a result replaces them."""
        os.mkfifo(self.work / "pipe")
        (self.work / "folder").mkdir()
        for path, what in (("pipe", "a pipe"), ("folder", "a folder"), ("/dev/null", "a device")):
            self.write("study.comm", STUDY + PRINT)
            self.refused(self.launch("study.comm", "--unit", f"20={path}"), "COMMAND_21", path, what, "LIRE_MAILLAGE/UNITE")
            self.refused(self.launch("study.comm", "--unit", "20=mesh.med", "--unit", f"80={path}"), "COMMAND_21", path, what)
        self.assertTrue(pathlib.Path("/dev/null").is_char_device() and (self.work / "pipe").is_fifo())

    def test_a_file_that_opens_and_cannot_be_read(self):
        """As on a disk that fails; the command ended in a Python error of the command file."""
        file = "/proc/self/mem"
        for command in ("LIRE_MAILLAGE(UNITE=20)", "LIRE_FONCTION(UNITE=20, NOM_PARA='INST')", "LIRE_FONCTION(UNITE=20, NOM_PARA='INST', FORMAT='NUMPY')",
                        "LIRE_TABLE(UNITE=20)", "INCLUDE(UNITE=20)"):
            self.write("study.comm", f"DEBUT()\nX = {command}\n")
            run = self.refused(self.launch("study.comm", "--unit", f"20={file}"), "COMMAND_5", f"'{file}'", "study.comm:2")
            self.assertNotIn("Traceback", run.err)
        self.refused(self.launch(file), "STUDY_14", f"'{file}'")

    def test_a_file_whose_reading_fails_later_has_no_key(self):
        """Its operator runs, and says what it cannot read."""
        program = self.bin / "lire_maillage"
        order = {"command": "LIRE_MAILLAGE", "keywords": {}, "result": {"id": "mesh_1", "label": "M", "reuse": False}}
        records = kept.Kept(types.SimpleNamespace(registry={}))
        self.assertTrue(records.order_key(order, program, {20: self.work / "mesh.med"}))
        with unittest.mock.patch.object(kept, "_content", side_effect=OSError(5, "Input/output error")):
            self.assertIsNone(records.order_key(order, program, {20: self.work / "mesh.med"}))

    def test_a_limit_of_memory(self):
        """Limits at which the launcher fits, and numpy, which takes ten times as much, does not; a little above, HDF5 itself may crash."""
        peak = "import lacon.main; print(next(line.split()[1] for line in open('/proc/self/status') if line.startswith('VmPeak')))"
        need = int(subprocess.run([sys.executable, "-c", peak], env={**os.environ, "PYTHONPATH": str(ROOT / "commands")}, capture_output=True, text=True, check=True).stdout)
        self.write("study.comm", "DEBUT()\nF = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, 1))\nprint(F(0.5))\nFIN()\n")
        for limit, status in ((need + 22_000, 3), (need + 32_000, 3), (need + 42_000, 3), (2_000_000, 0)):
            run = self.shell("study.comm", f"ulimit -v {limit} &&")
            self.assertEqual(run.returncode, status, run.stdout + run.stderr)
            self.assertEqual("<S> <MEMORY_1> the memory is used up" in run.stderr, status == 3, run.stderr)
            self.assertNotIn("Traceback", run.stderr)
            self.assertTrue(run.stdout.endswith(f"--- DIAGNOSTIC JOB : {'<S>_ERROR' if status else 'OK'}\n"), run.stdout)

    def test_memory_that_does_not_suffice_for_the_message(self):
        """The catalogue is read when the first message is made."""
        spoil = "from lacon.core import catalog\ndef no_memory(): raise MemoryError\ncatalog.messages = no_memory\n"
        for text in ("DEBUT()\n" + spoil + "M = LIRE_MAILLAGE(UNITE=21)\n", spoil + "M = LIRE_MAILLAGE()\n"):
            run = self.refused(self.run_study(text), status=3, diagnostic="<S>_ERROR")
            self.assertEqual(run.err, "<S> <MEMORY_1> the memory is used up\n")

    def test_an_array_of_a_command_file_that_is_too_large(self):
        """numpy says which one: that is the command file's error."""
        self.refused(self.run_study("import numpy\nDEBUT()\nnumpy.zeros(10**15)\n"), "STUDY_19", "Unable to allocate", "study.comm:3")
        run = self.run_study("DEBUT()\nx = [0] * 10**15\n")
        self.refused(run, "<S> <MEMORY_1>", "study.comm:2", status=3, diagnostic="<S>_ERROR")


class Threads(LauncherTest):
    """Of a command file, which call commands: they wait for one another. Half of such runs ended with STUDY_3."""

    def test_one_that_an_included_file_waits_for(self):
        """The command INCLUDE lets it have its turn."""
        self.write("included.py", "import threading\nt = threading.Thread(target=lambda: DEFI_CONSTANTE(VALE=1.0))\nt.start()\nt.join()\nONE = DEFI_CONSTANTE(VALE=2.0)\n")
        self.ok(self.run_study("DEBUT()\nINCLUDE(UNITE=21)\nFIN()\n", "--unit", "21=included.py"))

    def test_one_that_fails_behind_an_exit(self):
        run = self.run_study("import sys, threading, time\nDEBUT()\ndef late():\n    time.sleep(0.2)\n    LIRE_MAILLAGE(UNITE=77)\nthreading.Thread(target=late).start()\nsys.exit()\n")
        self.refused(run, "COMMAND_4")

    def test_six_at_once(self):
        text = """
import sys, threading
sys.setswitchinterval(1e-5)
DEBUT()
meshes, errors = {}, []
def make(i):
    try:
        mesh = LIRE_MAILLAGE(UNITE=20)
        meshes[i] = MODI_MAILLAGE(reuse=mesh, MAILLAGE=mesh, ORIE_PEAU=_F(GROUP_MA_PEAU='SKIN')) if i % 2 else mesh
        globals()[f'F{i}'] = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, i))
    except BaseException as error:
        errors.append(error)
threads = [threading.Thread(target=make, args=(i,)) for i in range(6)]
for thread in threads: thread.start()
for thread in threads: thread.join()
assert not errors, errors
FIN()
"""
        for options in (("--fresh",), ("--fresh",), ()):
            self.ok(self.run_study(text, *options))
            labels = self.registry()["labels"]
            self.assertEqual({root for root in labels if root.startswith(("F", "meshes"))}, {f"{name}" for i in range(6) for name in (f"F{i}", f"meshes[{i}]")})
            self.assertEqual(len(set(labels.values())), 12)

    def test_the_end_of_the_file_waits_for_them(self):
        text = """
import threading, time
DEBUT()
def work():
    global M
    time.sleep(0.5)
    M = LIRE_MAILLAGE(UNITE=20)
threading.Thread(target=work).start()
"""
        self.ok(self.run_study(text))
        self.assertEqual(self.registry()["labels"], {"M": "mesh_1"})

    def test_a_pool_that_nobody_shuts_down(self):
        text = "from concurrent.futures import ThreadPoolExecutor\nDEBUT()\npool = ThreadPoolExecutor(2)\nM = pool.submit(LIRE_MAILLAGE, UNITE=20).result()\nFIN()\n"
        self.ok(self.run_study(text))

    def test_what_a_pool_does_when_the_file_ends(self):
        """The work is done, also that which other work has submitted; before, what had not begun was lost, with status 0. The next file goes on with the pool."""
        self.write("next.comm", "def third():\n    global N\n    time.sleep(0.3)\n    N = LIRE_MAILLAGE(UNITE=20)\nthreading.Thread(target=lambda: (time.sleep(0.3), pool.submit(third))).start()\n")
        text = """
from concurrent.futures import ThreadPoolExecutor
import threading, time
DEBUT()
pool = ThreadPoolExecutor(1)
def first():
    global L
    time.sleep(0.3)
    L = LIRE_MAILLAGE(UNITE=20)
    threading.Thread(target=lambda: pool.submit(second)).start()
def second():
    global M
    M = LIRE_MAILLAGE(UNITE=20)
pool.submit(time.sleep, 0.1)
pool.submit(first)
"""
        self.write("study.comm", text)
        for file in (("next.comm",), ()):
            self.ok(self.launch("study.comm", *file, "--unit", "20=mesh.med", "--fresh"))
            self.assertEqual(sorted(self.registry()["labels"]), ["L", "M", *["N"] * len(file)])

    def test_a_command_that_fails_in_a_pool(self):
        """The run fails by it, unless the file has asked how it ended; the place is a line of the file."""
        begin = "from concurrent.futures import ThreadPoolExecutor, wait\nimport os, time\nDEBUT()\npool = ThreadPoolExecutor(1)\n"
        for text, message in (("pool.submit(LIRE_MAILLAGE, UNITE=77)\n", "COMMAND_4"), ("pool.map(lambda n: LIRE_MAILLAGE(UNITE=n), [77])\n", "COMMAND_4"),
                              ("wait([pool.submit(LIRE_MAILLAGE, UNITE=77)])\nFIN()\n", "COMMAND_4"),
                              ("wait([pool.submit(LIRE_MAILLAGE, UNITE=77)], return_when='FIRST_EXCEPTION')\nFIN()\n", "COMMAND_4"),
                              ("pool.submit(lambda: (time.sleep(0.3), LIRE_MAILLAGE(UNITE=20)))\nFIN()\n", "STUDY_12")):
            run = self.refused(self.run_study(begin + text), f"<{message}>", "study.comm:5")
            self.assertNotIn("concurrent", run.err)
        asked = """
work = pool.submit(LIRE_MAILLAGE, UNITE=77)
try:
    {ask}
except AsterError as error:
    assert error.id_message == 'COMMAND_4', error
else:
    raise AssertionError
"""
        for ask in ("work.result()", "raise work.exception()"):
            self.ok(self.run_study(begin + asked.format(ask=ask)))
        self.ok(self.run_study(begin + "pool.submit(time.sleep, 0.5)\npool.submit(LIRE_MAILLAGE, UNITE=77).cancel()\nif os.fork() == 0:\n    1\nelse:\n    os.wait()\n"))
        run = self.ok(self.run_study(begin + "pool.submit(lambda: 1 / 0)\nFIN()\n"))
        self.assertIn("ZeroDivisionError", run.err)

    def test_a_command_that_fails_in_one(self):
        text = "import threading\nDEBUT()\ndef work():\n    LIRE_MAILLAGE(UNITE=21)\nthreading.Thread(target=work).start()\n"
        run = self.refused(self.run_study(text), "<COMMAND_4>", "study.comm:4")
        self.assertNotIn("Traceback", run.err)
        run = self.refused(self.run_study("import threading, time\nDEBUT()\ndef work():\n    time.sleep(0.5)\n    LIRE_MAILLAGE(UNITE=20)\nthreading.Thread(target=work).start()\nFIN()\n"),
                           "<STUDY_12>", "study.comm:5")
        self.assertNotIn("Traceback", run.err)

    def test_an_error_ends_the_operator_of_another(self):
        (self.bin / "lire_maillage").write_text("#!/bin/sh\ntouch started\nexec sleep 60\n")
        text = """
import os, threading, time
DEBUT()
threading.Thread(target=lambda: LIRE_MAILLAGE(UNITE=20)).start()
while not os.path.exists('started'): time.sleep(0.01)
1 / 0
"""
        before = time.monotonic()
        self.refused(self.run_study(text), "<STUDY_19>", "ZeroDivisionError")
        self.assertLess(time.monotonic() - before, 30)

    def test_a_process_that_is_forked_during_a_command(self):
        """The command of the process that it comes from is not under way in it."""
        (self.bin / "lire_maillage").write_text("#!/bin/sh\ntouch started\nsleep 1\nexit 2\n")
        text = """
import os, threading, time
DEBUT()
def work():
    try:
        LIRE_MAILLAGE(UNITE=20)
    except AsterError:
        pass
thread = threading.Thread(target=work)
thread.start()
while not os.path.exists('started'): time.sleep(0.01)
child = os.fork()
if not child:
    try:
        DEFI_LIST_REEL()
    except AsterError:
        os._exit(7)
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
thread.join()
"""
        self.ok(self.run_study(text))


if __name__ == "__main__":
    main()
