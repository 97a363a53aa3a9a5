"""What studies of loads share: small blocks, the head of a command file, and a test that runs one and reads its results."""

import os
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from meshes import block, brick, write_med  # noqa: E402
from results import Result  # noqa: E402

YOUNG, POISSON = 2000.0, 0.3
SIDES_2D = {"left": "LEFT", "right": "RIGHT", "bottom": "BASE", "top": "TOP"}
SIDES_3D = {(0, 0): "LEFT", (0, 1): "RIGHT", (1, 0): "FRONT", (1, 1): "BACK", (2, 0): "BASE", (2, 1): "TOP"}
#: outward normals of the sides
NORMALS_2D = {"LEFT": (-1, 0), "RIGHT": (1, 0), "BASE": (0, -1), "TOP": (0, 1)}
NORMALS_3D = {"LEFT": (-1, 0, 0), "RIGHT": (1, 0, 0), "FRONT": (0, -1, 0), "BACK": (0, 1, 0), "BASE": (0, 0, -1), "TOP": (0, 0, 1)}

HEAD = f"""
DEBUT(ERREUR=_F(ALARME="EXCEPTION"))
TIMES = DEFI_LIST_REEL(VALE=(0.0, 0.5, 1.0))
MATTER = DEFI_MATERIAU(ELAS=_F(E={YOUNG}, NU={POISSON}, RHO=3.0))
BAR = DEFI_MATERIAU(ELAS=_F(E={YOUNG}, NU=0.0, RHO=3.0))
RAMP = DEFI_FONCTION(NOM_PARA="INST", VALE=(0, 0, 1, 1))
ONE = FORMULE(NOM_PARA="INST", VALE="1.0")
R = []

def model(unit, modelisation, matter=MATTER):
    global MESH, MODEL, FIELD
    MESH = LIRE_MAILLAGE(UNITE=unit)
    MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION=modelisation))
    FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", MATER=matter))

def solve(*loads, **more):
    R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=[dict(load) for load in loads], INCREMENT=_F(LIST_INST=TIMES),
                           CONVERGENCE=_F(RESI_GLOB_RELA=1e-10, ITER_GLOB_MAXI=40), **more))

def formula(text):
    return FORMULE(NOM_PARA=("X", "Y", "Z", "INST"), VALE=text)

def only_inst(text):
    return FORMULE(NOM_PARA="INST", VALE=text)
"""


def flat_block(kind, size=(2.0, 1.0), start=0.0):
    lines = [np.array([0, 0.4, 1.0]) * size[0] + start, np.array([0, 0.55, 1.0]) * size[1]]
    return block(kind, *lines, None, "BODY", SIDES_2D)


def flat_brick(kind):
    return brick(kind, (np.array([0, 0.8, 2.0]), np.array([0, 1.0]), np.array([0, 0.6, 1.5])), None, "BODY", SIDES_3D)


class LoadTest(StudyTest):
    head = HEAD

    def run_text(self, meshes, text):
        """Run HEAD and text with mesh k on unit 20 + k. @return the run"""
        units = []
        for k, mesh in enumerate(meshes):
            write_med(self.folder / f"{k}.med", mesh)
            units += ["--unit", f"{20 + k}={self.folder / f'{k}.med'}"]
        comm = self.folder / "loads.comm"
        comm.write_text(self.head + text + "\nFIN()\n")
        return self.run_study(comm, "--fresh", *units)

    def solved(self, meshes, text):
        """The results R[0], R[1], ..."""
        run = self.run_text(meshes, text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        base = self.folder / "loads.base"
        return [Result(base, f"R[{k}]") for k in range(text.count("solve("))]

    def displacement(self, result, order, dimension):
        return np.stack([result.at_nodes("DEPL", order, c) for c in ("DX", "DY", "DZ")[:dimension]], axis=1)

    def assert_near(self, found, exact, tolerance=1e-10):
        self.assertLessEqual(np.abs(found - exact).max(), tolerance * np.abs(exact).max())
