"""What tests of the command language share: runs of the launcher in a folder of their own, with stand-ins for operators.

A stand-in reads its order and writes a small concept with h5py, so that these tests are about the language and nothing else.
"""

import functools
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import types
import unittest

ROOT = pathlib.Path(os.environ.get("LACON_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(ROOT / "commands"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import stand_in_server  # noqa: E402

OPERATORS = ("lire_maillage", "modi_maillage", "crea_maillage", "defi_group", "affe_modele", "affe_materiau", "affe_char_cine",
             "affe_char_meca", "defi_contact", "stat_non_line", "calc_champ", "impr_resu", "macr_adap_mail")

#: a study up to a result, for tests that need one
STUDY = """
DEBUT()
L = DEFI_LIST_REEL(DEBUT=0, INTERVALLE=_F(JUSQU_A=1, NOMBRE=2))
RAMP = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, 1))
M0 = LIRE_MAILLAGE(UNITE=20)
M = CREA_MAILLAGE(MAILLAGE=M0, DECOUPE_LAC=_F(GROUP_MA_ESCL='SKIN'))
MO = AFFE_MODELE(MAILLAGE=M, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='D_PLAN'))
MAT = DEFI_MATERIAU(ELAS=_F(E=2000, NU=0.3))
CM = AFFE_MATERIAU(MAILLAGE=M, AFFE=_F(TOUT='OUI', MATER=MAT))
BC = AFFE_CHAR_CINE(MODELE=MO, MECA_IMPO=_F(GROUP_MA='SKIN', DX=0))
R = STAT_NON_LINE(MODELE=MO, CHAM_MATER=CM, EXCIT=_F(CHARGE=BC, FONC_MULT=RAMP), INCREMENT=_F(LIST_INST=L))
"""
#: a contact of its model
CONTACT = """C = DEFI_CONTACT(MODELE=MO, FORMULATION='CONTINUE', ALGO_RESO_GEOM='NEWTON', ALGO_RESO_CONT='NEWTON',
                 ZONE=_F(ALGO_CONT='LAC', GROUP_MA_ESCL='SKIN', GROUP_MA_MAIT='SKIN'))
"""


@functools.cache
def stand_in():
    """Text of the executable that stands in for every operator."""
    return stand_in_server.start()


class LauncherTest(unittest.TestCase):
    """A test with an empty folder, where `run` writes a command file and runs it."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_test_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.bin = self.folder / "bin"
        self.bin.mkdir()
        for name in OPERATORS:
            program = self.bin / name
            program.write_text(stand_in(), encoding="utf-8")
            program.chmod(0o755)
        self.orders = self.folder / "orders"
        self.work = self.folder / "work"
        self.work.mkdir()
        (self.work / "mesh.med").write_bytes(b"not read by the stand-in")

    def write(self, name, text):
        path = self.work / name
        path.write_text(text, encoding="utf-8")
        return path

    def run_study(self, text, *options, name="study.comm", **more):
        """Write `text` to a command file and run it with unit 20 attached. @return as launch()"""
        self.write(name, text)
        return self.launch(name, "--unit", "20=mesh.med", *options, **more)

    def launch(self, *arguments, behaviour=None, environment=None, output=True):
        """@return .status, .out, .err, .last (the last line of standard output); without `output` nothing waits for its end"""
        env = {**os.environ, "PYTHONPATH": str(ROOT / "commands"), "LACON_BIN": str(self.bin), "LACON_ORDERS": str(self.orders),
               "STAND_IN": json.dumps(behaviour or {}), "PYTHONDONTWRITEBYTECODE": "1", "OPENBLAS_NUM_THREADS": "1", **(environment or {})}
        done = subprocess.run([sys.executable, "-m", "lacon", *map(str, arguments)], cwd=self.work, env=env, text=True, timeout=120,
                              stdout=subprocess.PIPE if output else subprocess.DEVNULL, stderr=subprocess.PIPE if output else subprocess.DEVNULL)
        if not output:
            return types.SimpleNamespace(status=done.returncode)
        lines = done.stdout.rstrip("\n").split("\n")
        return types.SimpleNamespace(status=done.returncode, out=done.stdout, err=done.stderr, last=lines[-1])

    def ok(self, run):
        self.assertEqual((run.status, run.last), (0, "--- DIAGNOSTIC JOB : OK"), run.out + run.err)
        return run

    def refused(self, run, *words, status=2, diagnostic="<F>_ERROR"):
        """The run ended as a user's error, and said these words."""
        self.assertEqual((run.status, run.last), (status, f"--- DIAGNOSTIC JOB : {diagnostic}"), run.out + run.err)
        for word in words:
            self.assertIn(word, run.err)
        self.assertNotIn("/lacon/", run.err, "the launcher's own files are no concern of the user's")
        return run

    def all_refused(self, prelude, calls):
        """In one run each call, made after `prelude`, is an error of the user's that names its identifier. @param calls [(call, identifier)]"""
        tries = "".join(f"""
try:
    {call}
except AsterError as error:
    assert error.id_message == {identifier!r}, ({call!r}, str(error))
else:
    raise AssertionError({call!r})
""" for call, identifier in calls)
        return self.ok(self.run_study(f"{prelude}\n{tries}\nFIN()\n"))

    def registry(self, base="study.base"):
        return json.loads((self.work / base / "base.json").read_text(encoding="utf-8"))

    def entries(self, base="study.base"):
        """Concepts that are there, without their suffix."""
        return sorted(path.name.removesuffix(".h5") for path in (self.work / base).iterdir() if path.name != "base.json")

    def last_order(self, command):
        paths = sorted(self.orders.glob(f"*-{command.lower()}.order.json"))
        return json.loads(paths[-1].read_text(encoding="utf-8"))


def main():
    unittest.main()
