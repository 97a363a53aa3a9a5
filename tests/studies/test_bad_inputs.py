"""The table of bad inputs: each is refused with its message, its exit status and its diagnosis, and the base stays as it was."""

import unittest

import h5py
import numpy as np
from study_test import StudyTest, content

from meshes import Mesh, block, union, write_med

#: what every row goes on from: two blocks, cut, with materials, loads and contact
GOOD = """
DEBUT()
MESH = LIRE_MAILLAGE(UNITE=20)
CUT = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL="SLAVE"))
INWARD = LIRE_MAILLAGE(UNITE=21)
INCUT = CREA_MAILLAGE(MAILLAGE=INWARD, DECOUPE_LAC=_F(GROUP_MA_ESCL="SLAVE"))
ALL = _F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION="D_PLAN")
UNCUTMOD = AFFE_MODELE(MAILLAGE=MESH, AFFE=ALL)
MODEL = AFFE_MODELE(MAILLAGE=CUT, AFFE=ALL)
MIXED = AFFE_MODELE(MAILLAGE=CUT, AFFE=(ALL, _F(GROUP_MA=("LOWER", "MASTER"), PHENOMENE="MECANIQUE", MODELISATION="AXIS")))
INMOD = AFFE_MODELE(MAILLAGE=INCUT, AFFE=ALL)
STEEL = DEFI_MATERIAU(ELAS=_F(E=2000.0, NU=0.3))
MATTER = AFFE_MATERIAU(MAILLAGE=CUT, AFFE=_F(TOUT="OUI", MATER=STEEL))
PUSH = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA="LOAD", PRES=25.0))
NEWTON = dict(FORMULATION="CONTINUE", ALGO_RESO_GEOM="NEWTON", ALGO_RESO_CONT="NEWTON")
ZONE = dict(GROUP_MA_ESCL="SLAVE", GROUP_MA_MAIT="MASTER", ALGO_CONT="LAC", CONTACT_INIT="OUI")
CONTACT = DEFI_CONTACT(MODELE=MODEL, ZONE=_F(**ZONE), **NEWTON)
TIMES = DEFI_LIST_REEL(VALE=(0.0, 1.0))
HELD = AFFE_CHAR_MECA(MODELE=MODEL, DDL_IMPO=(_F(GROUP_MA="BASE", DY=0.0), _F(GROUP_MA="AXIS", DX=0.0), _F(GROUP_MA="LOOSE", DX=0.0, DY=0.0)))
RIGID = AFFE_CHAR_MECA(MODELE=MODEL, LIAISON_SOLIDE=_F(GROUP_MA="SLAVE"), DDL_IMPO=_F(GROUP_MA="MASTER", DX=0.0, DY=0.0))  # more patches than motions
FIN()
"""

USER, SOLUTION = (2, "<F>_ERROR"), (3, "<S>_ERROR")

#: name -> (command, message identifier, words of the message, (exit status, diagnosis))
TABLE = {
    "missing file": ("LIRE_MAILLAGE(UNITE=30)", "COMMAND_5", ["30", "nowhere.med"], USER),
    "unit without file": ("LIRE_MAILLAGE(UNITE=77)", "COMMAND_4", ["77"], USER),
    "not HDF5": ("LIRE_MAILLAGE(UNITE=31)", "MED_2", ["text.med"], USER),
    "MED without mesh": ("LIRE_MAILLAGE(UNITE=32)", "MED_4", ["empty.med"], USER),
    "cell of mixed Jacobian": ("LIRE_MAILLAGE(UNITE=33)", "LIRE_2", ["M1", "QUAD4"], USER),
    "unknown group": ("CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL='SLAV'))", "MESH_1",
                      ["GROUP_MA_ESCL", "SLAV", "SLAVE"], USER),
    "empty group": ("CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL='EMPTY'))", "MESH_2", ["GROUP_MA_ESCL", "EMPTY"], USER),
    "slave without body": ("CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL='LOOSE'))", "MESH1_2", ["LOOSE", "SEG2"], USER),
    "inward skin": ("DEFI_CONTACT(MODELE=INMOD, ZONE=_F(**ZONE), **NEWTON)", "MODELISA4_24", ["GROUP_MA_MAIT", "MASTER"], USER),
    "DECOUPE_LAC forgotten": ("DEFI_CONTACT(MODELE=UNCUTMOD, ZONE=_F(**ZONE), **NEWTON)", "CONTACT4_2", ["MESH"], USER),
    "slave and master swapped": ("DEFI_CONTACT(MODELE=MODEL, ZONE=_F(GROUP_MA_ESCL='MASTER', GROUP_MA_MAIT='SLAVE', ALGO_CONT='LAC'), "
                                 "**NEWTON)", "CONTACT4_5", ["MASTER"], USER),
    "a ring on a plate": ("DEFI_CONTACT(MODELE=MIXED, ZONE=_F(**ZONE), **NEWTON)", "LAC_6", ["AXIS/SEG2", "D_PLAN/SEG2"], USER),
    "friction": ("DEFI_CONTACT(MODELE=MODEL, FROTTEMENT='COULOMB', ZONE=_F(**ZONE), **NEWTON)", "CONTACT4_4", ["COULOMB"], USER),
    "ALGO_RESO_GEOM missing": ("DEFI_CONTACT(MODELE=MODEL, FORMULATION='CONTINUE', ZONE=_F(**ZONE))", "CONTACT4_1",
                               ["ALGO_RESO_GEOM", "POINT_FIXE"], USER),
    "unknown keyword": ("AFFE_MODELE(MAILLAGE=CUT, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATON='D_PLAN'))", "KEYWORD_1",
                        ["AFFE_MODELE/AFFE[1]/MODELISATON", "nearest one is MODELISATION"], USER),
    "load on a missing group": ("AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='LOADS', PRES=1.0))", "MESH_1",
                                ["PRES_REP", "LOADS", "LOAD"], USER),
    "no boundary condition": ("STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, EXCIT=_F(CHARGE=PUSH), CONTACT=CONTACT, "
                              "INCREMENT=_F(LIST_INST=TIMES))", "SOLVER_3", ["singular"], SOLUTION),
    "a contact between rigid skins": ("STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, EXCIT=[_F(CHARGE=c) for c in (HELD, PUSH, RIGID)], CONTACT=CONTACT, "
                                      "INCREMENT=_F(LIST_INST=TIMES))", "SOLVER_14", ["of the relations"], SOLUTION),
    "the same with a cheaper factor": ("STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, EXCIT=[_F(CHARGE=c) for c in (HELD, PUSH, RIGID)], CONTACT=CONTACT, "
                                       "INCREMENT=_F(LIST_INST=TIMES), SOLVEUR=_F(METHODE='MUMPS', MIXER_PRECISION='OUI'))", "SOLVER_14",
                                       ["of the relations"], SOLUTION),
    "a residual of nothing": ("STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, EXCIT=[_F(CHARGE=c) for c in (HELD, PUSH)], CONTACT=CONTACT, "
                              "INCREMENT=_F(LIST_INST=TIMES), SOLVEUR=_F(METHODE='MUMPS', RESI_RELA=0.0))", "SOLVER_19", ["RESI_RELA is 0", "1e-16"], USER),
    # numbers whose squares or volumes are none: the matrix was singular, or MUMPS an internal error
    "modulus out of range": ("DEFI_MATERIAU(ELAS=_F(E=1e300, NU=0.3))", "KEYWORD_15", ["DEFI_MATERIAU/ELAS/E is 1e+300", "at most 1e+100"], USER),
    "modulus next to none": ("DEFI_MATERIAU(ELAS=_F(E=1e-300, NU=0.3))", "KEYWORD_15", ["DEFI_MATERIAU/ELAS/E is 1e-300", "at least 1e-100"], USER),
    "pressure out of range": ("AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='LOAD', PRES=-1e200))", "KEYWORD_15", ["PRES_REP[1]/PRES", "at least -1e+100"], USER),
    "displacement out of range": ("AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='LOAD', DX=1e200))", "KEYWORD_15", ["MECA_IMPO[1]/DX", "at most 1e+100"], USER),
    "modulus that is no number": ("DEFI_MATERIAU(ELAS=_F(E=float('nan'), NU=0.3))", "KEYWORD_3", ["DEFI_MATERIAU/ELAS/E", "nan"], USER),
    "node out of range": ("LIRE_MAILLAGE(UNITE=34)", "LIRE_8", ["N3", "X = 1e+200"], USER),
    "node at no number": ("LIRE_MAILLAGE(UNITE=35)", "MED_9", ["N3"], USER),
    "scale out of range": ("MODI_MAILLAGE(reuse=MESH, MAILLAGE=MESH, ECHELLE=1e99)", "LIRE_8", ["N2", "X = 3.33e+98"], USER),
    "scale next to none": ("MODI_MAILLAGE(reuse=MESH, MAILLAGE=MESH, ECHELLE=1e-99)", "LIRE_9", ["e-99 large"], USER),
    "result in an unwritable folder": ("IMPR_RESU(FORMAT='MED', UNITE=80, RESU=_F(MAILLAGE=CUT))", "COMMAND_8", ["80", "out.med"], USER),
}


def two_blocks():
    lines = lambda n, first: np.linspace(first, first + 1, n + 1)  # noqa: E731
    upper = block("QUAD4", lines(3, 0), lines(2, 0), name="UPPER", sides={"bottom": "SLAVE", "top": "LOAD", "left": "AXIS"})
    lower = block("QUAD4", lines(2, 0), lines(2, -1), name="LOWER", sides={"top": "MASTER", "bottom": "BASE", "left": "AXIS"})
    loose = Mesh([(3.0, 0.0), (4.0, 0.0)], {"SEG2": [(0, 1)]}, {"LOOSE": [("SEG2", 0)], "EMPTY": []})
    return union([upper, lower, loose])


class BadInputs(StudyTest):
    def setUp(self):
        super().setUp()
        self.base = self.folder / "study.base"
        self.units = {number: self.folder / name for number, name in
                      {20: "good.med", 21: "inward.med", 30: "nowhere.med", 31: "text.med", 32: "empty.med", 33: "arrow.med", 34: "far.med",
                       35: "none.med",
                       80: "text.med/out.med"}.items()}
        mesh = two_blocks()
        write_med(self.units[20], mesh)
        for kind, c in mesh.cell_groups["MASTER"]:
            mesh.cells[kind][c] = mesh.cells[kind][c][::-1]
        write_med(self.units[21], mesh)
        self.units[31].write_text("this is no mesh\n")
        with h5py.File(self.units[32], "w") as file:
            info = file.create_group("INFOS_GENERALES")
            for name, value in (("MAJ", 4), ("MIN", 1), ("REL", 0)):
                info.attrs[name] = np.int32(value)
        write_med(self.units[33], Mesh([(0, 0), (1, 0), (0.1, 0.1), (0, 1)], {"QUAD4": [(0, 1, 2, 3)]}, {"BODY": [("QUAD4", 0)]}))
        for number, third in ((34, (1e200, 1.0)), (35, (float("nan"), 1.0))):
            write_med(self.units[number], Mesh([(0, 0), (1, 0), third, (0, 1)], {"QUAD4": [(0, 1, 2, 3)]}, {"BODY": [("QUAD4", 0)]}))

    def run_text(self, text, base=None):
        comm = self.folder / "study.comm"
        comm.write_text(text)
        units = [word for number, path in self.units.items() if number != 80 or "UNITE=80" in text for word in ("--unit", f"{number}={path}")]
        return self.run_lacon(comm, "--base", base or self.base, *units)

    def assert_refused(self, run, identifier, words, outcome):
        status, diagnosis = outcome
        self.assertEqual(run.status, status, run.stderr)
        self.assertEqual(run.diagnostic, f"--- DIAGNOSTIC JOB : {diagnosis}")
        mark = f"<{diagnosis[1]}> <{identifier}>"
        self.assertIn(mark, run.stderr)
        self.assertNotIn("<SOLVER_4>", run.stderr)  # what a singular matrix brings about is not told before it
        message = run.stderr[run.stderr.index(mark):]
        for word in [*words, "where:", "study.comm:2", "do:"]:
            self.assertIn(word, message)
        self.assertEqual(run.stderr.count("where:"), run.stderr.count("<F> <") + run.stderr.count("<S> <"), "one place a message")
        self.assertNotIn("Traceback", run.stderr)

    def test_every_row_of_the_table(self):
        run = self.run_text(GOOD)
        self.assertEqual(run.status, 0, run.stderr)
        before = content(self.base)
        for name, (command, identifier, words, outcome) in TABLE.items():
            with self.subTest(name):
                result = "" if command.startswith("IMPR_RESU") else "BAD = "
                self.assert_refused(self.run_text(f"POURSUITE()\n{result}{command}\nFIN()\n"), identifier, words, outcome)
                self.assertEqual(content(self.base), before)

    def test_a_concept_without_a_name_is_named_by_its_number(self):
        """Messages had nothing in its place."""
        self.assertEqual(self.run_text(GOOD).status, 0)
        hold = "_F(CHARGE=AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX={})))"
        run = self.run_text("POURSUITE()\nBAD = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, INCREMENT=_F(LIST_INST=TIMES), "
                            f"EXCIT=({hold.format(0.0)}, {hold.format(1.0)}))\nFIN()\n")
        self.assertRegex(run.stderr, r"<F> <LOAD_1> .* load_\d+ imposes 0, load_\d+ imposes 1")

    def test_a_base_in_an_unwritable_folder(self):
        run = self.run_text(GOOD, base=self.units[31] / "study.base")  # below a file that is no folder: fails for root too
        self.assertEqual(run.status, 2)
        self.assertIn("<F> <STUDY_", run.stderr)
        self.assertIn("text.med", run.stderr)
        self.assertEqual(run.diagnostic, "--- DIAGNOSTIC JOB : <F>_ERROR")
        self.assertEqual(self.units[31].read_text(), "this is no mesh\n")

    def test_outputs_that_can_never_be_written_are_refused_before_the_work(self):
        """They were refused behind it; a folder that is missing may be made by the command file."""
        self.assertEqual(self.run_text(GOOD).status, 0)
        solve = ("POURSUITE()\nRESULT = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, EXCIT=[_F(CHARGE=c) for c in (HELD, PUSH)], CONTACT=CONTACT, "
                 "INCREMENT=_F(LIST_INST=TIMES))\n{}IMPR_RESU(FORMAT='MED', UNITE=80, RESU=_F(RESULTAT=RESULT))\nFIN()\n")
        for place, identifier in (("text.med/out.med", "COMMAND_8"), (".", "COMMAND_21")):
            self.units[80] = self.folder / place
            run = self.run_text(solve.format(""))
            self.assertEqual(run.status, 2, run.stderr)
            self.assertIn(f"<F> <{identifier}>", run.stderr)
            self.assertNotIn("Converged", run.stdout)
        self.units[80] = self.folder / "later/out.med"
        run = self.run_text(solve.format(f"import os; os.mkdir({str(self.folder / 'later')!r})\n"))
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(run.stderr.count("<A> <COMMAND_19>"), 1)
        self.assertTrue(self.units[80].exists())

    def test_a_base_that_is_no_place(self):
        for base, words in (("", "--base: give the name of a folder"), (self.folder / "link.base", "<F> <STUDY_47> .*link.base' is a symbolic link to 'gone'")):
            if base:
                base.symlink_to("gone")
            comm = self.folder / "study.comm"
            comm.write_text("DEBUT()\nFIN()\n")
            run = self.run_tool(comm, "--base", base)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertRegex(run.stderr, words)
        self.assertFalse((self.folder / "gone").exists())

    def test_a_table_is_not_put_behind_a_med_file(self):
        self.units[80] = self.folder / "out.med"
        run = self.run_text("DEBUT()\nM = LIRE_MAILLAGE(UNITE=20); IMPR_RESU(FORMAT='MED', UNITE=80, RESU=_F(MAILLAGE=M))\n"
                            "T = CREA_TABLE(LISTE=_F(PARA='A', LISTE_R=1.0)); IMPR_TABLE(TABLE=T, UNITE=80)\nFIN()\n")
        self.assertEqual(run.status, 2, run.stderr)
        for word in ("<F> <COMMAND_13>", "out.med", "unit 80"):
            self.assertIn(word, run.stderr)
        self.assertNotIn(b"\nA", self.units[80].read_bytes()[-200:])

    def test_a_base_that_is_not_there_is_not_made_by_a_refused_poursuite(self):
        run = self.run_text("POURSUITE()\nFIN()\n")
        self.assertEqual(run.status, 2)
        self.assertFalse(self.base.exists())


if __name__ == "__main__":
    unittest.main()
