"""Files of a base that have changed since they were written: whoever reads them says so, and nothing crashes."""

import pathlib
import random
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from study_test import LACON  # noqa: E402, I001

from .small_study import SmallStudy  # noqa: E402


class Damaged(SmallStudy):
    def setUp(self):
        super().setUp()
        self.orders = self.folder / "orders"
        run = self.run_small("small", LACON_ORDERS=str(self.orders))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.base = self.folder / "small.base"

    def readers(self):
        """(file of the base, order of an operator that reads it whole)"""
        pairs = []
        for order in sorted(self.orders.glob("*.order.json")):
            program, text = order.name.split(".")[0].partition("-")[2], order.read_text(encoding="utf-8")
            for path in sorted(self.base.rglob("*.h5")):
                concept = path.relative_to(self.base).parts[0].removesuffix(".h5")
                named = f'"{concept}"' in text.split('"keywords"')[1] and path.parent.name != "kept" and not path.name.endswith(".masters.h5")
                if named and (path.name == "index.h5" or path.parent == self.base or program == "impr_resu"):
                    pairs.append((path, LACON.parent / program, order))
        return pairs

    def damage(self, number, seed):
        """`number` files, each read when one or several of its bytes have changed, or its end is missing."""
        chance = random.Random(seed)
        pairs = self.readers()
        self.assertGreater(len(pairs), 20)
        for _ in range(number):
            path, program, order = chance.choice(pairs)
            sound = path.read_bytes()
            spoilt = bytearray(sound)
            if chance.random() < 0.2:
                del spoilt[chance.randrange(8, len(spoilt) - 32):]  # some of the content, and the seal
            else:
                for _ in range(chance.choice((1, 1, 4, 16))):
                    spoilt[chance.randrange(len(spoilt) - 32)] ^= chance.randrange(1, 256)  # the last 32 are the seal itself
            path.write_bytes(spoilt)
            with self.subTest(file=path.name, program=program.name, seed=seed):
                run = subprocess.run([program, order], capture_output=True, text=True, errors="replace", timeout=60, check=False)
                self.assertEqual(run.returncode, 2, run.stderr)
                self.assertRegex(run.stderr, r"<F> <BASE_[25]>")
                self.assertIn(path.name, run.stderr)
            path.write_bytes(sound)


class Short(Damaged):
    def test_operators_refuse_them(self):
        self.damage(60, seed=1)

    def test_the_launcher_refuses_them(self):
        check = "POURSUITE()\nTEST_RESU(RESU=_F(RESULTAT=RESULT, NUME_ORDRE=3, NOM_CHAM='DEPL', NOM_CMP='DZ', TYPE_TEST='MIN', VALE_CALC=-0.01))\nFIN()\n"
        (self.folder / "check.comm").write_text(check, encoding="utf-8")
        (field,) = self.base.glob("result_*/DEPL_3.h5")
        sound = field.read_bytes()
        for spoilt in (sound[:600] + b"\xff" * 8 + sound[608:], sound[:1000]):
            field.write_bytes(spoilt)
            run = self.run_tool("check.comm", "--base", self.base)
            self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
            self.assertRegex(run.stderr, r"<F> <(BASE_5|STUDY_7)> .*DEPL_3.h5")

    def test_blocks_of_zeros_at_the_end_are_told(self):
        """As a power failure leaves them: the seal is gone with what is before it. An index without its end crashed the operator."""
        (self.folder / "check.comm").write_text("POURSUITE()\nprint(RESULT.getField('DEPL', 3).getValues()[:1], CUT.getCoordinates())\nFIN()\n", encoding="utf-8")
        readers = {(path, program.name): (program, order) for path, program, order in self.readers()}
        for zeros in (8, 24, 32, 512, 2048, 4096):
            for path in {path for path, _ in readers}:
                sound = path.read_bytes()
                if zeros > len(sound) - 512:
                    continue
                path.write_bytes(sound[:-zeros] + bytes(zeros))
                for name in {name for other, name in readers if other == path}:
                    with self.subTest(zeros=zeros, file=path.name, program=name):
                        run = subprocess.run(readers[path, name], capture_output=True, text=True, errors="replace", timeout=60, check=False)
                        self.assertEqual(run.returncode, 2, run.stderr)
                        self.assertRegex(run.stderr, rf"<F> <BASE_5> .*{path.name}")
                if path.name == "DEPL_3.h5":
                    run = self.run_tool("check.comm", "--base", self.base)
                    self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
                    self.assertRegex(run.stderr, rf"<F> <BASE_5> .*{path.name}")
                path.write_bytes(sound)

    def test_an_earlier_version_of_a_result_is_told_too(self):
        """POURSUITE looks which field files it names."""
        (self.folder / "more.comm").write_text("POURSUITE()\nFIN()\n", encoding="utf-8")
        kept = next(self.base.glob("kept/result_*.0.h5"))
        sound = kept.read_bytes()
        kept.unlink()  # it may be a second name of the index
        for spoilt in (b"", b"junk" * 100, sound[:len(sound) // 2], sound[:600] + b"\xff" * 8 + sound[608:]):
            kept.write_bytes(spoilt)
            run = self.run_tool("more.comm", "--base", self.base)
            self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
            self.assertRegex(run.stderr, rf"<F> <(BASE_5|STUDY_7)> .*kept/{kept.name}")
            self.assertNotIn("Traceback", run.stderr)

    def test_a_file_in_the_place_of_another_is_told(self):
        """Sound and sealed, but of another concept, field or instant: a mesh that was not cut yet ended in an internal error, other loads and other
        instants' contact in numbers that were wrong."""
        (result,) = {path.parent for path in self.base.glob("result_*/DEPL_3.h5")}
        (self.folder / "more.comm").write_text("""
POURSUITE()
X = CREA_CHAMP(OPERATION="EXTR", TYPE_CHAM="NOEU_DEPL_R", RESULTAT=RESULT, NOM_CHAM="DEPL", NUME_ORDRE=3)
Y = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, CONTACT=CONTACT, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PUSH, FONC_MULT=GROW)),
                  ETAT_INIT=_F(EVOL_NOLI=RESULT), INCREMENT=_F(LIST_INST=DEFI_LIST_REEL(VALE=(1.0, 1.1))))
FIN()
""", encoding="utf-8")
        (self.folder / "check.comm").write_text("POURSUITE()\nprint(RESULT.getField('DEPL', 3).getValues()[:1], TIMES.getValues())\nFIN()\n", encoding="utf-8")
        meshes, loads = sorted(self.base.glob("mesh_*.h5")), sorted(self.base.glob("load_*.h5"))
        for comm, source, place in (("more", meshes[0], meshes[1]), ("more", loads[0], loads[1]),
                                    ("more", result / "DEPL_1.h5", result / "DEPL_3.h5"), ("more", result / "CONT_ELEM_1.h5", result / "CONT_ELEM_3.h5"),
                                    ("more", result / "DEPL_3.h5", result / "SIEF_ELGA_3.h5"), ("check", result / "DEPL_1.h5", result / "DEPL_3.h5"),
                                    ("check", loads[0], next(self.base.glob("list_of_reals_*.h5")))):
            with self.subTest(f"{source.name} as {place.name}"):
                sound = place.read_bytes()
                place.write_bytes(source.read_bytes())
                run = self.run_tool(f"{comm}.comm", "--base", self.base)
                self.assertEqual(run.returncode, 2, run.stdout[-1000:] + run.stderr)
                self.assertRegex(run.stderr, f"<F> <BASE_[47]> .*{place.stem}")
                self.assertNotIn("Traceback", run.stderr)
                place.write_bytes(sound)

    def test_what_can_be_done_without_is_told_and_left_out(self):
        """The files of masters beside CONT_ELEM: a computation that goes on, `lacon inspect` and `lacon report` were refused for them."""
        (self.folder / "more.comm").write_text("""
POURSUITE()
Y = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, CONTACT=CONTACT, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PUSH)),
                  ETAT_INIT=_F(EVOL_NOLI=RESULT), INCREMENT=_F(LIST_INST=DEFI_LIST_REEL(VALE=(1.0, 1.1))))
FIN()
""", encoding="utf-8")
        (path,) = self.base.glob("result_*/CONT_ELEM_3.masters.h5")
        sound = path.read_bytes()
        (other,) = self.base.glob("result_*/DEPL_3.h5")
        for spoilt in (sound[:600] + b"\xff" * 8 + sound[608:], sound[:300], b"junk" * 100, b"", other.read_bytes()):
            path.write_bytes(spoilt)
            for words in (("more.comm", "--base", self.base), ("inspect", self.base, "--result", "RESULT"), ("report", self.base, "--result", "RESULT", "--out", "page.html")):
                run = self.run_tool(*words)
                if "REPORT_1" in run.stderr:  # the page was not bundled: no npm
                    continue
                with self.subTest(words[0], content=spoilt[:8]):
                    self.assertEqual(run.returncode, 0, run.stdout[-1000:] + run.stderr)
                    self.assertRegex(run.stderr, rf"<A> <BASE_8> .*{path.name}")
                    self.assertEqual(run.stderr.count("BASE_8"), 1)
            path.write_bytes(sound)

    def test_a_result_with_a_field_that_was_touched_is_made_again(self):
        for cut, change in ((1000, b""), (-1, b"\xff")):
            (field,) = self.base.glob("result_*/DEPL_2*.h5")
            field.write_bytes(field.read_bytes()[:cut] + change)
            run = self.run_small("small")
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            self.assertNotRegex(run.stdout, r"RESULT = STAT_NON_LINE.*\n.*kept")
            again = self.run_small("small")
            self.assertRegex(again.stdout, r"RESULT = STAT_NON_LINE.*\n.*kept")

    def test_a_file_that_a_tool_changed_has_no_seal_and_is_read(self):
        mesh = self.base / "mesh_1.h5"
        mesh.write_bytes(mesh.read_bytes()[:-32])
        order = next(order for path, program, order in self.readers() if path == mesh and program.name == "crea_maillage")
        self.assertEqual(subprocess.run([LACON.parent / "crea_maillage", order], capture_output=True, check=False).returncode, 0)


class Long(Damaged):
    def test_operators_refuse_them(self):
        self.damage(2000, seed=2)
