"""Statuses of contact: closing, opening, closing again; CONTACT_INIT; nothing depends on the way that was taken."""

import os
import pathlib
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from meshes import block, union, write_med  # noqa: E402

COMM = pathlib.Path(__file__).resolve().parent / "statuses.comm"
WIDTH = HEIGHT = 50.0
PATCHES = 7


class Statuses(StudyTest):
    def blocks(self, kind, gap):
        """The upper block (slave) at this distance over the lower one, which is wider on both sides."""

        def place(bottom):
            return lambda s, t: (WIDTH * s, bottom + HEIGHT * t)

        upper = block(kind, np.linspace(0, 1, PATCHES + 1), np.linspace(0, 1, 5), place(gap), "UPPER",
                      {"bottom": "SLAVE", "top": "LOAD", "left": "AXIS"})
        lower = block(kind, np.linspace(-0.2, 1.2, 6), np.linspace(0, 1, 4), place(-HEIGHT), "LOWER",
                      {"top": "MASTER", "bottom": "BASE", "left": "FREE"})
        mesh = union([upper, lower])
        path = self.folder / f"{kind}_{gap}.med"
        write_med(path, mesh)
        return path

    def solve(self, mesh, path, initial="INTERPENETRE", **environment):
        """@return for each instant the components of CONT_ELEM, what is present of them, and the least gap that was observed"""
        run = self.run_study(COMM, "--fresh", "--unit", f"20={mesh}", STATUS_PATH=" ".join(map(str, path)), STATUS_INIT=initial,
                             **environment)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        base = self.folder / "statuses.base"
        (index_path,) = base.glob("result_*/index.h5")
        steps = []
        with h5py.File(index_path) as index:
            observed = index["tables/OBSERVATION"]
            least = observed[f"values/{list(observed['columns'].asstr()).index('VALE')}"][()]
            for file, gap in zip(index["fields/CONT_ELEM/file"].asstr(), least, strict=True):
                with h5py.File(base / file) as field:
                    steps.append({**dict(zip(field.attrs["components"], field["values"][()].T)), "least": gap})
                    if "present" in field:
                        steps[-1]["present"] = field["present"][()]
        return steps

    def test_pressed_released_drawn_apart_and_pressed_again(self):
        for kind in ("TRIA3", "QUAD8"):
            with self.subTest(cells=kind):
                steps = self.solve(self.blocks(kind, 0.0), [0, 0, -0.5, 0, 0.5, -0.5])
                touching, pressed, released, apart, again = steps[1:]
                # a patch that touches without load keeps its status and carries nothing
                np.testing.assert_array_equal(touching["CONT"], 1)
                np.testing.assert_array_equal(touching["PRES"], 0)
                np.testing.assert_array_equal(pressed["CONT"], 1)
                self.assertLess(pressed["PRES"].max(), -5)
                scale = abs(pressed["PRES"]).max()
                np.testing.assert_allclose(released["PRES"], 0, atol=1e-10 * scale)
                np.testing.assert_allclose(released["JEU"], 0, atol=1e-10 * HEIGHT)
                np.testing.assert_array_equal(apart["CONT"], 0)
                np.testing.assert_array_equal(apart["PRES"], 0)
                np.testing.assert_allclose(apart["JEU"], 0.5, rtol=1e-12)
                # elastic, without friction: the way does not matter
                np.testing.assert_allclose(again["PRES"], pressed["PRES"], rtol=1e-9)

    def test_every_patch_is_open_or_in_contact_never_both(self):
        """lambda <= 0, g >= 0, lambda g = 0 (METHOD.md 5.1)."""
        for step in self.solve(self.blocks("QUAD4", 0.1), [0, -0.05, -0.2, 0.1]):
            scale = max(abs(step["PRES"]).max(), 1.0)
            self.assertLessEqual(step["PRES"].max(), 1e-10 * scale)
            self.assertGreaterEqual(step["JEU"].min(), -1e-8 * WIDTH / PATCHES)
            self.assertLessEqual(abs(step["PRES"] * step["JEU"]).max(), 1e-8 * scale * WIDTH / PATCHES)

    def test_the_initial_status_does_not_change_the_solution(self):
        overlap, apart = self.blocks("TRIA6", -0.1), self.blocks("TRIA6", 0.1)
        for mesh, contact in ((overlap, 1), (apart, 0)):
            found = {initial: self.solve(mesh, [0, 0], initial) for initial in ("INTERPENETRE", "OUI", "NON")}
            started = {initial: steps[0]["CONT"] for initial, steps in found.items()}
            np.testing.assert_array_equal(started["OUI"], 1)
            np.testing.assert_array_equal(started["NON"], 0)
            np.testing.assert_array_equal(started["INTERPENETRE"], contact)
            for steps in found.values():
                np.testing.assert_array_equal(steps[-1]["CONT"], contact)
                np.testing.assert_allclose(steps[-1]["PRES"], found["OUI"][-1]["PRES"], rtol=1e-9, atol=0)

    def test_a_patch_without_master_is_unpaired(self):
        """Half of the slave skin hangs over: CONT -1, JEU -1, COEFSURF 0 there; the patch on the edge is covered in part."""

        def place(bottom, left):
            return lambda s, t: (WIDTH * (left + s), bottom + HEIGHT * t)

        upper = block("QUAD4", np.linspace(0, 1, PATCHES + 1), np.linspace(0, 1, 5), place(0.0, 0.0), "UPPER",
                      {"bottom": "SLAVE", "top": "LOAD", "left": "AXIS"})
        lower = block("QUAD4", np.linspace(0, 0.5, 5), np.linspace(0, 1, 4), place(-HEIGHT, 0.0), "LOWER",
                      {"top": "MASTER", "bottom": "BASE", "left": "FREE"})
        path = self.folder / "over.med"
        write_med(path, union([upper, lower]))
        step = self.solve(path, [0, -0.1])[0]
        # patches of SEG2 on QUAD4 have three cells with the same values
        cover, status, gap = (step[name].reshape(PATCHES, 3) for name in ("COEFSURF", "CONT", "JEU"))
        np.testing.assert_allclose(cover, np.repeat([[1], [1], [1], [0.5], [0], [0], [0]], 3, axis=1), atol=1e-12)
        np.testing.assert_array_equal(status[4:], -1)
        np.testing.assert_array_equal(gap[4:], -1)
        np.testing.assert_array_equal(status[:4], 1)
        # the gap alone stands in for none there, and is not the least one
        self.assertEqual(step["least"], gap[:4].min())
        np.testing.assert_array_equal(step["present"], np.where((step["CONT"] == -1)[:, None] & (np.arange(5) == 2), 3, 1))


if __name__ == "__main__":
    import unittest

    unittest.main()
