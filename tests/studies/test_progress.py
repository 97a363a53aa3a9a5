"""What a user sees of a computation while it runs: a line on the terminal, the journal of its iterations, `lacon watch` in another terminal."""

import fcntl
import os
import pathlib
import pty
import re
import select
import struct
import subprocess
import sys
import termios
import time
import unittest


from study_test import LACON, SECONDS, SOURCE, StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from meshes import block, union, write_med  # noqa: E402
import numpy as np  # noqa: E402

sys.path.insert(0, str(SOURCE / "commands"))

from lacon.base.base import ReadBase  # noqa: E402
from lacon.base.journal import read_journal  # noqa: E402

INSTANTS = 4
#: of a terminal: back to the first column, empty the line
EMPTY = "\r\x1b[K"

STUDY = f"""
DEBUT()
MESH = LIRE_MAILLAGE(UNITE=20)
CUT = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL='SOLE'))
MODEL = AFFE_MODELE(MAILLAGE=CUT, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='D_PLAN'))
STEEL = DEFI_MATERIAU(ELAS=_F(E=200.0, NU=0.3))
MATTER = AFFE_MATERIAU(MAILLAGE=CUT, AFFE=_F(TOUT='OUI', MATER=STEEL))
HELD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='BASE', DX=0.0, DY=0.0), _F(GROUP_MA='TOP', DX=0.0)))
DOWN = DEFI_FONCTION(NOM_PARA='INST', VALE=(0.0, 0.0, 1.0, -0.05))
DRIVE = AFFE_CHAR_CINE_F(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='TOP', DY=DOWN))
CONTACT = DEFI_CONTACT(MODELE=MODEL, FORMULATION='CONTINUE', ALGO_RESO_GEOM='NEWTON', ALGO_RESO_CONT='NEWTON',
                       ZONE=_F(APPARIEMENT='MORTAR', ALGO_CONT='LAC', GROUP_MA_ESCL='SOLE', GROUP_MA_MAIT='GROUND'))
TIMES = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=_F(JUSQU_A=1.0, NOMBRE={INSTANTS}))
RESULT = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, CONTACT=CONTACT, EXCIT=(_F(CHARGE=HELD), _F(CHARGE=DRIVE)),
                       INCREMENT=_F(LIST_INST=TIMES))
FIN()
"""


def write_study(folder):
    """mesh.med, a block with a round foot on another one, and study.comm, which presses it down."""
    lower = block("QUAD4", np.linspace(-2, 2, 17), np.linspace(-1, 0, 5), name="LOWER", sides={"bottom": "BASE", "top": "GROUND"})
    upper = block("QUAD4", np.linspace(-1, 1, 11), np.linspace(0, 1, 5), lambda s, t: (s, t + 0.1 * (1 - t) * s * s), name="UPPER",
                  sides={"bottom": "SOLE", "top": "TOP"})
    write_med(folder / "mesh.med", union([lower, upper]))
    (folder / "study.comm").write_text(STUDY, encoding="utf-8")


class ProgressTest(StudyTest):
    def setUp(self):
        super().setUp()
        write_study(self.folder)

    def on_terminal(self, *command, columns=100, **redirected):
        """Run on a terminal of its own. @return what it has written there"""
        ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 30, columns, 0, 0))
        run = subprocess.Popen(list(map(str, command)), cwd=self.folder, stdin=theirs, stdout=redirected.get("stdout", theirs), stderr=theirs,
                               env={**os.environ, "TERM": "xterm"}, start_new_session=True)
        os.close(theirs)
        text, until = b"", time.monotonic() + SECONDS
        while time.monotonic() < until:
            if not select.select([ours], [], [], 1.0)[0]:
                continue
            try:
                part = os.read(ours, 65536)
            except OSError:  # the other end is closed
                break
            text += part
        os.close(ours)
        self.assertEqual(run.wait(SECONDS), 0, text.decode()[-3000:])
        return text.decode()

    def journal(self, base="study.base"):
        base = ReadBase(self.folder / base, "")
        return read_journal(base, base.registry["labels"]["RESULT"])


class OnATerminal(ProgressTest):
    def test_a_line_says_where_a_run_is_and_leaves_the_table_alone_behind(self):
        """What a line that is taken away has stood on begins in the first column."""
        text = self.on_terminal(LACON, "study.comm", "--unit", "20=mesh.med")
        lines = re.findall(re.escape(EMPTY) + r"(INST [^\r]*)", text)
        self.assertTrue(any(re.match(r"INST 0\.5  iteration \d+  \S.* 25 % of the instants  \d.*, about \d.* left$", line) for line in lines), lines)
        self.assertEqual({line.split()[1] for line in lines}, {"0.25", "0.5", "0.75", "1"})
        stays = re.sub(r"INST [^\r\n]*(?=\r)", "", text.replace("\r\n", "\n")).replace(EMPTY, "")
        stays = "".join(line for line in stays.splitlines(keepends=True) if not line.startswith("<I>"))
        piped = self.run_tool("study.comm", "--unit", "20=mesh.med", "--base", "other.base")
        self.assertNotIn("\x1b", piped.stdout + piped.stderr)
        seconds = re.compile(r" +\d+\.\d{4} \|")
        self.assertEqual(seconds.sub("|", stays), seconds.sub("|", piped.stdout))

    def test_a_narrow_terminal_cuts_the_line(self):
        text = self.on_terminal(LACON, "study.comm", "--unit", "20=mesh.med", columns=40)
        self.assertLessEqual(max(len(line) for line in re.findall(r"INST [^\r\n]*(?=\r)", text)), 39)

    def test_none_in_a_pipe(self):
        ours, theirs = os.pipe()
        text = self.on_terminal(LACON, "study.comm", "--unit", "20=mesh.med", stdout=theirs)
        os.close(theirs)
        os.close(ours)
        self.assertNotIn("\x1b", text)


class Journals(ProgressTest):
    def test_the_journal_has_every_line_of_the_table(self):
        run = self.run_tool("study.comm", "--unit", "20=mesh.med")
        table = [[cell.split() for cell in line.split("|")[1:-1]] for line in run.stdout.splitlines() if re.match(r" \| +\d", line)]
        journal = self.journal()
        self.assertTrue(journal.completed)
        self.assertEqual([attempt.instant for attempt in journal.attempts], [0.25, 0.5, 0.75, 1.0])
        self.assertEqual(journal.instants, [0.0, 0.25, 0.5, 0.75, 1.0])
        lines = [line for _, line in journal.iterations()]
        self.assertEqual([(f"{line['rela']:.5E}", f"{line['maxi']:.5E}", str(line["changes"])) for line in lines],
                         [(row[1][0], row[2][0], row[4][0]) for row in table])
        self.assertEqual(journal.share(journal.reached()), 1.0)
        self.assertGreater(lines[-1]["active"], 0)
        self.assertLessEqual(lines[-1]["active"], journal.patches)

    def test_watch_shows_the_end_of_a_run_that_is_over(self):
        self.run_tool("study.comm", "--unit", "20=mesh.med")
        shown = self.run_tool("watch", "study.base")
        self.assertEqual(shown.returncode, 0, shown.stderr)
        last = self.journal().iterations()[-1][1]
        for words in ("study.base: RESULT; not running", "INST 1 ", "100 % of the instants", "complete", f"RESI_GLOB_RELA, now {last['rela']:.2e}",
                      f"{last['active']} of {self.journal().patches} patches are in contact"):
            self.assertIn(words, shown.stdout)

    def test_lines_that_are_none_of_a_journal_are_left_out(self):
        self.run_tool("study.comm", "--unit", "20=mesh.med")
        shown = self.run_tool("watch", "study.base").stdout
        (path,) = self.folder.glob("study.base/*/journal.jsonl")
        path.write_text('[]\nnull\n1\n"at"\n' + path.read_text() + "[" * 100000 + "\n{}\n{")
        again = self.run_tool("watch", "study.base")
        self.assertEqual((again.returncode, again.stdout), (0, shown), again.stderr)
        path.unlink()
        path.mkdir()
        again = self.run_tool("watch", "study.base")
        self.assertEqual((again.returncode, "<F> <READER_4> RESULT has no journal" in again.stderr), (2, True), again.stderr)

    def test_watch_follows_a_run_and_ends_with_it(self):
        run = subprocess.Popen([LACON, "study.comm", "--unit", "20=mesh.med"], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not (self.folder / "study.base/base.json").exists():
            time.sleep(0.01)
        text = self.on_terminal(LACON, "watch", "study.base", "--every", "0.05")
        self.assertEqual(run.wait(SECONDS), 0)
        frames = text.split("\x1b[H")
        self.assertGreater(len(frames), 1)
        self.assertTrue(any("running since" in frame for frame in frames))
        self.assertIn("; not running", frames[-1])
        self.assertIn("complete", frames[-1])

    def test_a_base_without_a_computation_says_so(self):
        (self.folder / "none.comm").write_text("DEBUT()\nSTEEL = DEFI_MATERIAU(ELAS=_F(E=200.0, NU=0.3))\nFIN()\n", encoding="utf-8")
        self.run_tool("none.comm")
        shown = self.run_tool("watch", "none.base")
        self.assertEqual(shown.returncode, 2)
        self.assertIn("<F> <WATCH_1>", shown.stderr)


if __name__ == "__main__":
    unittest.main()
