"""`lacon new`: the starter study of a mesh passes `lacon check`, names the pair that the geometry shows, and runs."""

import unittest

import numpy as np
from study_test import StudyTest

from meshes import block, brick, union, write_med


def lines(cells, start, length=1.0):
    return start + np.linspace(0, length, cells + 1)


def plate():
    upper = block("QUAD4", lines(3, 0), lines(2, 0), name="UPPER", sides={"bottom": "FINE", "top": "LOAD", "left": "SIDE_1"})
    lower = block("QUAD4", lines(2, 0), lines(2, -1), name="LOWER", sides={"top": "COARSE", "bottom": "BASE", "left": "SIDE_2"})
    return union([upper, lower])


class New(StudyTest):
    def new(self, mesh, *arguments):
        write_med(self.folder / "mesh.med", mesh)
        return self.run_tool("new", "mesh.med", *arguments)

    def assert_checked(self, name="mesh.comm"):
        done = self.run_tool("check", name, "--unit", "20=mesh.med")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("commands are right", done.stdout)
        return (self.folder / name).read_text(encoding="utf-8")

    def test_a_contact_of_two_blocks(self):
        done = self.new(plate())
        self.assertEqual(done.returncode, 0, done.stderr)
        text = self.assert_checked()
        self.assertIn("GROUP_MA_ESCL='FINE', GROUP_MA_MAIT='COARSE'", text)
        self.assertIn("MECA_IMPO=_F(GROUP_MA='BASE', DX=0.0, DY=0.0)", text)
        self.assertIn("PRES_REP=_F(GROUP_MA='LOAD', PRES=1.0)", text)
        self.assertIn("# Bodies: LOWER, UPPER", text)
        # with the sides on rollers it is a patch test, and runs
        (self.folder / "study.comm").write_text(text.replace("GROUP_MA='BASE', DX=0.0, DY=0.0)", "GROUP_MA='BASE', DY=0.0), ")
                                                .replace("DY=0.0), )", "DY=0.0), _F(GROUP_MA=('SIDE_1', 'SIDE_2'), DX=0.0)))")
                                                .replace("MECA_IMPO=_F", "MECA_IMPO=(_F"), encoding="utf-8")
        run = self.run_lacon("study.comm", "--unit", "20=mesh.med", "--unit", "80=result.med")
        self.assertEqual(run.status, 0, run.stdout[-2000:] + run.stderr)

    def test_without_a_pair_the_file_says_what_to_add(self):
        done = self.new(brick("HEXA8", [lines(1, 0), lines(1, 0), lines(1, 0)], name="BODY", sides={(2, 0): "LOW"}), "--out", "one.comm")
        self.assertEqual(done.returncode, 0, done.stderr)
        text = self.assert_checked("one.comm")
        self.assertIn("MODELISATION='3D'", text)
        self.assertIn("CHOOSE a slave and a master", text)
        self.assertNotIn("\nCONTACT =", text)

    def test_a_mesh_without_groups_of_skins(self):
        self.new(block("TRIA3", lines(2, 0), lines(2, 0), name="BODY"))
        self.assertIn("GROUP_MA='BODY', DX=0.0, DY=0.0", self.assert_checked())

    def test_never_replaces_a_file(self):
        (self.folder / "mesh.comm").write_text("mine", encoding="utf-8")
        done = self.new(plate())
        self.assertEqual(done.returncode, 2)
        self.assertIn("mesh.comm is there already", done.stderr)
        self.assertEqual((self.folder / "mesh.comm").read_text(encoding="utf-8"), "mine")

    def test_refuses_what_is_no_mesh(self):
        (self.folder / "mesh.med").write_text("no mesh", encoding="utf-8")
        for name, word in (("mesh.med", "MED_2"), ("nowhere.med", "nowhere.med"), ("mesh.unv", ".msh")):
            done = self.run_tool("new", name)
            self.assertEqual(done.returncode, 2)
            self.assertIn(word, done.stderr)
        self.assertFalse((self.folder / "mesh.comm").exists())


if __name__ == "__main__":
    unittest.main()
