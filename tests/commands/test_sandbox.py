"""`lacon --sandbox`: a command file that tries to get out. Without bubblewrap, or where the system lets nobody make namespaces, ctest says
Skipped."""

import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import ROOT, LauncherTest  # noqa: E402

TABLE = "T = CREA_TABLE(LISTE=_F(PARA='A', LISTE_R=(1.0, 2.0)))\n"


def works():
    return bool(shutil.which("bwrap")) and not subprocess.run(["bwrap", "--ro-bind", "/", "/", "--unshare-net", "true"], check=False, capture_output=True).returncode


@unittest.skipUnless(works(), "no bubblewrap, or no namespaces")
class Sandbox(LauncherTest):
    def sandbox(self, text, *arguments, **more):
        self.write("study.comm", text)
        return self.launch("--sandbox", "study.comm", *arguments, **more)

    def held(self, attempt, error):
        """What a command file tries ends with this exception of Python."""
        run = self.sandbox(f"import os, socket, subprocess\nDEBUT()\ntry:\n    {attempt}\n    print('got out')\nexcept {error} as error:\n    print('held:', error)\nFIN()\n")
        self.assertEqual(run.status, 0, run.err)
        self.assertNotIn("got out", run.out)
        self.assertIn("held:", run.out)

    def test_writes_its_base_and_the_files_of_its_units(self):
        run = self.sandbox("DEBUT()\n" + TABLE + "IMPR_TABLE(TABLE=T, UNITE=8)\nIMPR_TABLE(TABLE=T, UNITE=9)\nFIN()\n", "--unit", "8=out.txt", "--json", "checks.json")
        self.assertEqual(run.status, 0, run.err)
        self.assertEqual(sorted(path.name for path in self.work.iterdir() if path.name != "mesh.med"),
                         ["checks.json", "out.txt", "study.9.table", "study.base", "study.comm"])
        self.assertIn("2.00000E+00", (self.work / "out.txt").read_text())
        again = self.launch("study.comm", "--unit", "8=out.txt")
        self.assertEqual(again.status, 0, "the base is one that goes on outside: " + again.err)

    def test_a_unit_may_be_written_and_read_again(self):
        text = "DEBUT()\n" + TABLE + "IMPR_TABLE(TABLE=T, UNITE=8)\nIMPR_TABLE(TABLE=T, UNITE=8)\nFIN()\n"
        self.write("out.txt", "old\n")
        self.assertEqual(self.sandbox(text, "--unit", "8=out.txt").status, 0)
        self.assertEqual((self.work / "out.txt").read_text().count("2.00000E+00"), 2)

    def test_exit_status_is_that_of_the_run(self):
        run = self.sandbox("DEBUT()\nNO_SUCH()\n")
        self.assertEqual(run.status, 2)
        self.assertIn("DIAGNOSTIC JOB : <F>_ERROR", run.out)

    def test_no_file_of_the_user_is_written(self):
        marker = pathlib.Path.home() / ".lacon_sandbox_test"
        self.held(f"open({str(marker)!r}, 'w')", "OSError")
        self.assertFalse(marker.exists())

    def test_a_folder_that_is_not_a_base_is_not_opened_to_it(self):
        self.write("study.comm", "DEBUT()\nFIN()\n")
        run = self.launch("--sandbox", "--base", ".", "study.comm")
        self.assertEqual(run.status, 2)
        self.assertIn("<F> <STUDY_4>", run.err)

    def test_nothing_beside_the_command_file_is_written_or_removed(self):
        self.held("open('beside', 'w')", "OSError")
        self.held("os.remove('mesh.med')", "OSError")
        self.assertTrue((self.work / "mesh.med").exists())

    def test_what_others_have_in_tmp_is_not_there(self):
        with socket.socket(socket.AF_UNIX) as server:
            path = f"/tmp/lacon_sandbox_{os.getpid()}.socket"
            server.bind(path)
            try:
                server.listen()
                self.held(f"socket.socket(socket.AF_UNIX).connect({path!r})", "OSError")
            finally:
                os.unlink(path)

    def test_no_network_not_even_to_this_machine(self):
        with socket.create_server(("127.0.0.1", 0)) as server:
            self.held(f"socket.create_connection(('127.0.0.1', {server.getsockname()[1]}), 2)", "OSError")

    def test_no_process_outside_is_seen_or_ended(self):
        with subprocess.Popen(["sleep", "60"]) as sleeper:
            try:
                self.held(f"os.kill({sleeper.pid}, 9)", "ProcessLookupError")
                self.assertIsNone(sleeper.poll())
            finally:
                sleeper.kill()

    def test_what_it_starts_ends_with_it(self):
        mark = f"31{os.getpid()}"
        run = self.sandbox(f"import subprocess\nDEBUT()\nsubprocess.Popen(['sleep', '{mark}'], start_new_session=True)\nFIN()\n")
        self.assertEqual(run.status, 0, run.err)
        self.assertEqual(subprocess.run(["pgrep", "-f", f"^sleep {mark}$"], check=False, capture_output=True).stdout, b"")

    def test_links_in_place_of_a_result_lead_nowhere(self):
        target = self.write("precious", "mine\n")
        text = f"import glob, os\nDEBUT()\n{TABLE}IMPR_TABLE(TABLE=T, UNITE=8)\n[out] = glob.glob('.study_*.partial/units/8/*')\nos.remove(out)\nos.symlink({str(target)!r}, out)\nFIN()\n"
        run = self.sandbox(text, "--unit", "8=out.txt")
        self.assertEqual(run.status, 2)
        self.assertIn("<F> <COMMAND_8>", run.err)
        self.assertFalse((self.work / "out.txt").exists())
        self.assertEqual(target.read_text(), "mine\n")

    def test_a_signal_ends_it(self):
        self.write("study.comm", "import time\nDEBUT()\nprint('waits', flush=True)\ntime.sleep(60)\n")
        process = subprocess.Popen([sys.executable, "-m", "lacon", "--sandbox", "study.comm"], cwd=self.work, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   env={**os.environ, "PYTHONPATH": str(ROOT / "commands"), "LACON_BIN": str(self.bin), "PYTHONDONTWRITEBYTECODE": "1"})
        while "waits" not in process.stdout.readline():
            pass
        began = time.monotonic()
        process.send_signal(signal.SIGTERM)
        out, err = process.communicate(timeout=20)
        self.assertLess(time.monotonic() - began, 10)
        self.assertIn("<STUDY_18>", err)
        self.assertIn("DIAGNOSTIC JOB : <F>_ABNORMAL_ABORT", out)


class WithoutBubblewrap(LauncherTest):
    def test_is_told_with_the_package(self):
        self.write("study.comm", "DEBUT()\nFIN()\n")
        run = self.launch("--sandbox", "study.comm", environment={"PATH": "/nowhere"})
        self.assertEqual(run.status, 2)
        self.assertIn("<F> <STUDY_32>", run.err)
        self.assertIn("bubblewrap", run.err)


if __name__ == "__main__":
    unittest.main()
