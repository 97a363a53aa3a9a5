"""A disk that fills up at any moment of a study: a clear error, nothing half-written, and the same command file again comes to the same end."""

import os
import pathlib
import re
import struct
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "studies"))

from study_test import StudyTest
from test_threads import datasets

from meshes import brick, union, write_med

SHIM = pathlib.Path(os.environ["LACON_BINARY_DIR"]).resolve() / "tests/full_disk.so"
PLENTY = 1 << 40
STUDY = """
DEBUT()
MESH = LIRE_MAILLAGE(UNITE=20)
MESH = MODI_MAILLAGE(reuse=MESH, MAILLAGE=MESH, ORIE_PEAU=_F(GROUP_MA_PEAU=("CTOP", "CBOT")))
CUT = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL="CTOP"))
MODEL = AFFE_MODELE(MAILLAGE=CUT, AFFE=_F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION="3D"))
STEEL = DEFI_MATERIAU(ELAS=_F(E=2000.0, NU=0.3))
MATTER = AFFE_MATERIAU(MAILLAGE=CUT, AFFE=_F(TOUT="OUI", MATER=STEEL))
CONTACT = DEFI_CONTACT(MODELE=MODEL, FORMULATION="CONTINUE", ALGO_RESO_GEOM="NEWTON", ALGO_RESO_CONT="NEWTON",
                       ZONE=_F(APPARIEMENT="MORTAR", ALGO_CONT="LAC", GROUP_MA_MAIT="CBOT", GROUP_MA_ESCL="CTOP"))
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA=("BASE", "TOP"), DX=0.0, DY=0.0), _F(GROUP_MA="BASE", DZ=0.0)))
PUSH = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA="TOP", DZ=-0.01))
GROW = DEFI_FONCTION(NOM_PARA="INST", VALE=(0.0, 0.0, 1.0, 1.0))
TIMES = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=_F(JUSQU_A=1.0, NOMBRE=3))
RESULT = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, CONTACT=CONTACT, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PUSH, FONC_MULT=GROW)),
                       COMPORTEMENT=_F(RELATION="ELAS"), INCREMENT=_F(LIST_INST=TIMES))
RESULT = CALC_CHAMP(reuse=RESULT, RESULTAT=RESULT, CONTRAINTE="SIGM_NOEU")
IMPR_RESU(FORMAT="MED", UNITE=80, RESU=_F(RESULTAT=RESULT))
IMPR_RESU(FORMAT="VTU", UNITE=81, RESU=_F(RESULTAT=RESULT))
IMPR_RESU(FORMAT="RESULTAT", UNITE=8, RESU=_F(RESULTAT=RESULT))
FIN()
"""


def two_blocks():
    def lines(n, z):
        return [np.linspace(0.0, 1.0, n + 1), np.array([0.0, 0.5]), np.array([z, z + 0.5, z + 1.0])]

    return union([brick("HEXA8", lines(3, 0.0), name="VBOT", sides={(2, 0): "BASE", (2, 1): "CBOT"}),
                  brick("HEXA8", lines(2, 1.0), name="VTOP", sides={(2, 0): "CTOP", (2, 1): "TOP"})])


def first_name(file):
    """A field that was begun twice has a file of another name, SIGM_NOEU_0_2.h5."""
    return re.sub(r"(_\d+)_\d+(?=\.h5$)", r"\1", file)


def fields(base):
    """What a base holds, without the names of files, which the index of a result and its copy in kept/ know."""
    return {(first_name(file), name): value for (file, name), value in datasets(base).items()
            if not (file.endswith("index.h5") or file.startswith("kept/"))}


class FullDisk(StudyTest):
    def setUp(self):
        super().setUp()
        write_med(self.folder / "blocks.med", two_blocks())
        (self.folder / "study.comm").write_text(STUDY, encoding="utf-8")
        self.left = self.folder / "left"

    def run_with(self, name, left=None):
        """Run the study, whose base and outputs begin with `name`, on a disk that takes `left` bytes more. @return the run"""
        shim = {}
        if left is not None:
            self.left.write_bytes(struct.pack("<q", left))
            shim = {"LD_PRELOAD": str(SHIM), "LACON_TEST_DISK": str(self.left)}
        outputs = ((80, f"{name}.rmed"), (81, f"{name}.vtu"), (8, f"{name}.txt"))
        units = (word for unit, file in ((20, "blocks.med"), *outputs) for word in ("--unit", f"{unit}={file}"))
        return self.run_tool("study.comm", "--base", f"{name}.base", *units, **shim)

    def files(self, name):
        return {str(path.relative_to(self.folder)) for path in self.folder.rglob("*") if path.relative_to(self.folder).parts[0].startswith(name)}

    def fill(self, levels):
        """The study on disks that are full after a share of what it writes, and again with room enough."""
        whole = self.run_with("whole", PLENTY)
        self.assertEqual(whole.returncode, 0, whole.stderr)
        needed = PLENTY - struct.unpack("<q", self.left.read_bytes())[0]
        expected = fields(self.folder / "whole.base")
        self.assertGreater(len(expected), 50)
        for number, share in enumerate(levels):
            name = f"part{number}_"
            with self.subTest(share=share, bytes=int(share * needed)):
                run = self.run_with(name, int(share * needed))
                self.assertEqual((run.returncode, run.stdout.splitlines()[-1]), (2, "--- DIAGNOSTIC JOB : <F>_ERROR"), run.stdout + run.stderr)
                self.assertIn("No space left on device", run.stderr)
                self.assertNotIn("Traceback", run.stderr)
                self.assertEqual([file for file in self.files(name) if ".partial" in file and ".base/" not in file], [])
                for path in self.folder.glob(f"{name}*.rmed"):
                    h5py.File(path).close()  # whole, or not there
                again = self.run_with(name)
                self.assertEqual(again.returncode, 0, again.stdout + again.stderr)
                found = fields(self.folder / f"{name}.base")
                self.assertEqual([key for key in found.keys() | expected.keys() if found.get(key) != expected.get(key)], [])
                self.assertEqual({first_name(file.replace(name, "whole")) for file in self.files(name)}, self.files("whole"))


class Short(FullDisk):
    def test_the_same_command_again_comes_to_the_same_end(self):
        self.fill([0, 0.002, 0.05, 0.3, 0.48, 0.98])


class Long(FullDisk):
    def test_the_same_command_again_comes_to_the_same_end(self):
        self.fill([level / 64 for level in range(64)])
