"""The peer's cases: every reference is met; those that theory decides to the last digit too."""

import pathlib
import re
import unittest

import peer_checks
from study_test import PEER_MESHES, StudyTest

HERE = pathlib.Path(__file__).resolve().parent


@unittest.skipUnless(PEER_MESHES.is_dir(), f"the peer's meshes are not in {PEER_MESHES} (set LACON_SHARED_CASES)")
class PeerCase(StudyTest):
    def judge(self, case, exact=None, faster=False, **environment):
        """Every reference is met, every clean check is OK. @param exact what the patch test gives where the peer's own digits carry the
        error of its rule for PYRAM13 @param faster references are orders of convergence, and higher ones are as good  @return the run"""
        comms, meshes = peer_checks.files(case)
        outputs = {unit: self.folder / f"out.{unit}" for unit in (29, 33, 40, 80)}
        units = {**{unit: PEER_MESHES / mesh for unit, mesh in meshes.items()}, **{unit: path for unit, path in outputs.items() if unit not in meshes}}
        run = self.run_lacon(*(HERE / comm for comm in comms), "--base", self.folder / f"{case}.base",
                             *(word for unit, path in units.items() for word in ("--unit", f"{unit}={path}")), CASE=case, **environment)
        rows = peer_checks.rows(case)
        missed = any(check["status"] == "NOOK" for check in run.checks or [])
        self.assertEqual((run.status, len(run.checks or [])), (5 if missed else 0, len(rows)), run.stdout[-3000:] + run.stderr[-3000:])
        for row, check in zip(rows, run.checks):
            with self.subTest(case=case, number=row["no"]):
                beside = [] if row["clean"] == "1" else ["DIFF"] if row["vale_refe"] else ["NOOK"]
                if not (faster and check["value"] > float(row["vale_refe"])):
                    self.assertIn(check["status"], ["OK", *beside])
                if row["clean"] != "1" and exact is not None:
                    theory = 1.0 if row["component"] == "COEFSURF" else exact
                    self.assertLessEqual(abs(check["value"] - theory), 1e-9 * abs(theory))
        return run


class PeerCases(PeerCase):
    def run_case(self, name, count):
        mesh, out = PEER_MESHES / f"{name}.mmed", self.folder / "out.med"
        run = self.run_study(HERE / f"{name}.comm", "--checks", "all", "--unit", f"20={mesh}", "--unit", f"80={out}")
        self.assert_all_ok(run, count)
        self.assertEqual(sum(line.startswith("OK ") for line in run.stdout.splitlines()), count)
        return run

    def test_zzzz383a_cuts_a_square_on_two_edges(self):
        self.run_case("zzzz383a", 4)
        self.assertTrue((self.folder / "out.med").exists())

    def test_zzzz383c_cuts_a_cube_of_every_degree(self):
        self.run_case("zzzz383c", 10)

    def test_zzzz383d_cuts_tetrahedra(self):
        self.run_case("zzzz383d", 6)

    def test_zzzz383e_cuts_around_a_square(self):
        self.run_case("zzzz383e", 2)

    def test_ssnp170a_patch_test_of_triangles(self):
        run = self.run_case("ssnp170a", 14)
        self.assertIn("NEWTON", run.stdout)

    def test_ssnp170k_tetrahedra_and_an_observed_cell(self):
        self.judge("ssnp170k", exact=-25.0)

    def test_ssnp170_either_block_is_the_slave(self):
        for case in ("ssnp170m", "ssnp170p", "ssnp170r", "ssnp170w"):
            self.judge(case, exact=-25.0)

    def test_ssnp170z_prisms_and_pyramids(self):
        self.judge("ssnp170z", exact=-25.0)

    def test_ssnp173a_nested_spheres(self):
        self.judge("ssnp173a")

    def test_ssnv104_hertz(self):
        for case in ("ssnv104k", "ssnv104n"):
            self.judge(case)

    def test_ssnp165_a_half_ring_snaps_open(self):
        """The peer's digits are those of a residual of 0.5 and of forces that do not derive from the gap: displacements and pressures
        agree to 1 % of the largest with the frozen gap, whatever the residual, to 6 % with its derivative. No step is cut, and where forces
        are derivatives Newton's matrix is exact: the peer takes 164 solutions."""
        largest = {"DEPL": 12.0, "PRES_NOEU": 120.0}
        for case, residual, gap, share in (("ssnp165c", "0.5", "FIGEE", 0.01), ("ssnp165c", "1e-6", "FIGEE", 0.01),
                                           ("ssnp165e", "0.5", "FIGEE", 0.01), ("ssnp165c", "0.5", "EXACTE", 0.06),
                                           ("ssnp165e", "0.5", "EXACTE", 0.06)):
            run = self.judge(case, RESIDUAL=residual, GAP=gap)
            self.assertNotIn("EVOLUTION_7", run.stdout + run.stderr)
            if gap == "EXACTE":
                self.assertLessEqual(len(re.findall(r"^ \| +\d+X? +\|", run.stdout, re.M)), 90)
            for row, check in zip(peer_checks.rows(case), run.checks):
                with self.subTest(case=case, residual=residual, gap=gap, number=row["no"]):
                    self.assertLessEqual(abs(check["value"] - float(row["vale_calc"])), share * largest[row["field"]])

    def test_an_export_file_runs_the_same_case(self):
        export = self.folder / "zzzz383a.export"
        export.write_text("P time_limit 70\nP memory_limit 524\nP ncpus 1\n"
                          f"F comm {HERE / 'zzzz383a.comm'} D 1\nF mmed {PEER_MESHES / 'zzzz383a.mmed'} D 20\n"
                          f"F rmed {self.folder / 'out.med'} R 80\n")
        run = self.run_lacon(export, "--base", self.folder / "study.base", "--checks", "all")
        self.assert_all_ok(run, 4)
        self.assertTrue((self.folder / "out.med").exists())


    def test_manufactured_solutions_are_the_same_with_and_without_sympy(self):
        """Formulae that the tensors of the peer's files derive, and literal ones: errors on the first two meshes."""
        without = self.folder / "without"
        without.mkdir()
        (without / "sympy.py").write_text("raise ImportError('not installed')\n")
        for case in ("ssnp150c", "ssnv219i"):
            comms, meshes = peer_checks.files(case)
            found = []
            for path in ("", str(without)):
                run = self.run_lacon(*(HERE / comm for comm in comms), "--base", self.folder / "study.base", "--fresh",
                                     *(word for unit, mesh in meshes.items() for word in ("--unit", f"{unit}={PEER_MESHES / mesh}")),
                                     CASE=case, MESHES="2", PYTHONPATH=path)
                self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
                found.append([float(word) for word in re.findall(r"[\d.e+-]+", re.search(f"ERRORS {case} (.*)", run.stdout)[1])])
            self.assertEqual(len(found[0]), 4)
            for derived, literal in zip(*found):
                # errors of displacements and pressures of size 1: Newton's last correction is what is left between two runs
                self.assertLessEqual(abs(derived - literal), 1e-9 * max(1, abs(literal)), case)


class LongPeerCases(PeerCase):
    """Label `long`."""

    def test_ssnp150_orders_of_convergence_in_the_plane(self):
        """Of f the peer's windows end at 2.8475 (PU, theory 2.5) and 1.02 (PP, theory 1); with exact forces 2.97 and 1.0208."""
        self.judge("ssnp150c")
        self.judge("ssnp150f", faster=True)

    def test_ssnv219i_order_of_convergence_in_space(self):
        """The others differ from the peer's own slopes by more than its tolerances: PP of e is 1.730 (at most 1.2825 is taken), of g
        1.894 (1.890), of l 1.887 (1.885): pressures that converge faster; PU of k by the peer's rule for PYRAM13 (3.667 here, 3.670 with the exact rule of its release 15, 2.470 now)."""
        self.judge("ssnv219i")


if __name__ == "__main__":
    unittest.main()