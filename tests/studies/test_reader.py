"""A base as arrays and pictures: the reader behind `import lacon` and `lacon plot`."""

import copy
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock

from study_test import LACON, SECONDS, SOURCE

sys.path.insert(0, str(SOURCE / "commands"))

import numpy as np  # noqa: E402
import test_progress  # noqa: E402
from lacon.core.messages import AsterError  # noqa: E402
from lacon.reader.base import Base, open_base  # noqa: E402
from lacon.report import study  # noqa: E402

try:
    import meshio
except ImportError:
    meshio = None
try:
    import matplotlib.image
except ImportError:
    matplotlib = None


class Reader(unittest.TestCase):
    """One study for all: a base that is only read."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_reader_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        test_progress.write_study(cls.folder)
        text = (cls.folder / "study.comm").read_text().replace("FIN()", "IMPR_RESU(FORMAT='VTU', UNITE=80, RESU=_F(RESULTAT=RESULT, INST=1.0))\nFIN()")
        (cls.folder / "study.comm").write_text(text)
        cls.run_lacon("study.comm", "--unit", "20=mesh.med", "--unit", "80=result.pvd")
        cls.base = open_base(cls.folder / "study.base")
        cls.result = cls.base["RESULT"]

    @classmethod
    def run_lacon(cls, *arguments, status=0):
        done = subprocess.run([LACON, *arguments], cwd=cls.folder, capture_output=True, text=True, timeout=SECONDS, stdin=subprocess.DEVNULL)
        assert done.returncode == status, done.stdout[-2000:] + done.stderr
        return done

    def refused(self, identifier, ask):
        with self.assertRaises(AsterError) as refusal:
            ask()
        self.assertEqual(refusal.exception.id_message, identifier)

    def test_a_base_names_what_it_holds(self):
        self.assertEqual(sorted(self.base.meshes), ["CUT", "MESH"])
        self.assertEqual(list(self.base.results), ["RESULT"])
        self.assertIsNone(self.base.running)
        self.assertIn("5 instants to INST 1", repr(self.result))
        self.refused("READER_1", lambda: self.base["RESULTS"])
        self.refused("READER_7", lambda: open_base(self.folder / "none.base"))

    def test_the_result_that_is_meant_has_displacements(self):
        """Beside a course of temperatures, that a command file made to heat the bodies, the computed result is the one to look at."""
        (self.folder / "warm.comm").write_text("""DEBUT()
MESH = LIRE_MAILLAGE(UNITE=20)
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='D_PLAN'))
MATTER = DEFI_MATERIAU(ELAS=_F(E=1.0, NU=0.0, ALPHA=1e-3))
WARM = CREA_CHAMP(TYPE_CHAM='NOEU_TEMP_R', OPERATION='AFFE', MAILLAGE=MESH, AFFE=_F(TOUT='OUI', NOM_CMP='TEMP', VALE=20.0))
COURSE = CREA_RESU(OPERATION='AFFE', TYPE_RESU='EVOL_THER', AFFE=_F(NOM_CHAM='TEMP', CHAM_GD=WARM, INST=(0.0, 1.0)))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=MATTER), AFFE_VARC=_F(NOM_VARC='TEMP', EVOL=COURSE, VALE_REF=0.0))
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(TOUT='OUI', DX=0.0, DY=0.0))
RESULT = MECA_STATIQUE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=_F(CHARGE=HOLD), INST=1.0)
FIN()
""")
        self.run_lacon("warm.comm", "--unit", "20=mesh.med")
        self.assertEqual(open_base(self.folder / "warm.base").only_result().label, "RESULT")

    def test_a_base_without_a_result_says_why_there_may_be_none(self):
        """Its run failed before an instant and left no iterates, or its command file computes nothing: no result can be named."""
        (self.folder / "mesh.comm").write_text("DEBUT()\nMESH = LIRE_MAILLAGE(UNITE=20)\nFIN()\n")
        self.run_lacon("mesh.comm", "--unit", "20=mesh.med")
        self.refused("READER_8", lambda: open_base(self.folder / "mesh.base").only_result())
        said = self.run_lacon("plot", "mesh.base", status=2).stderr
        self.assertIn("<F> <READER_8> the base mesh.base has no result: none was computed, or the computation stopped before its first instant", said)
        self.assertNotIn("--result", said)

    def test_several_results_are_named(self):
        second = copy.copy(self.result)
        second.id = "result_99"
        results = {"FIRST": self.result, "SECOND": second}
        with unittest.mock.patch.object(Base, "results", results), self.assertRaisesRegex(AsterError, "READER_5.*has 2 results(.|\n)*FIRST, SECOND"):
            self.base.only_result()

    def test_a_result_with_several_names_is_one(self):
        """Under its first plain variable, for every tool; each of its names finds it."""
        text = (self.folder / "study.comm").read_text().replace("DEBUT()\n", "DEBUT()\nL = []\n").replace("IMPR_RESU(", "L.append(RESULT)\nB = RESULT\nkept = {'of': CONTACT}\nIMPR_RESU(")
        (self.folder / "names.comm").write_text(text)
        self.run_lacon("names.comm", "--unit", "20=mesh.med", "--unit", "80=names.pvd")
        base = open_base(self.folder / "names.base")
        self.assertEqual(set(base.results), {"RESULT", "B", "L[0]"})
        self.assertEqual([base.only_result(label).label for label in (None, "B", "L[0]")], ["RESULT", "B", "L[0]"])
        self.assertIn("names.base: RESULT; not running", self.run_lacon("watch", "names.base").stdout)
        self.assertIn("Pairing of RESULT at instant 1", self.run_lacon("inspect", "names.base").stdout)
        for name in ("B", "L[0]"):
            self.assertIn("at instant 1", self.run_lacon("inspect", "names.base", "--result", name).stdout)

    def test_contacts_with_several_names_are_one(self):
        text = (self.folder / "study.comm").read_text().partition("RESULT =")[0] + "keywords = {'CONTACT': CONTACT}\nFIN()\n"
        (self.folder / "contact.comm").write_text(text)
        self.run_lacon("contact.comm", "--unit", "20=mesh.med")
        self.assertIn("Pairing of CONTACT on the initial geometry", self.run_lacon("inspect", "contact.base").stdout)

    def test_a_mesh_is_points_cells_and_groups(self):
        mesh = self.base["MESH"]
        self.assertEqual((mesh.dimension, len(mesh.points)), (2, 17 * 5 + 11 * 5))
        self.assertEqual({name: nodes.shape for name, (_, nodes) in mesh.cells.items()}, {"SEG2": (52, 2), "QUAD4": (104, 4)})
        self.assertEqual({name: len(members) for name, members in mesh.groups.items()},
                         {"LOWER": 64, "BASE": 16, "GROUND": 16, "UPPER": 40, "SOLE": 10, "TOP": 10})
        self.assertEqual(set(mesh.cell_types[mesh.groups["TOP"]]), {"SEG2"})
        np.testing.assert_allclose(mesh.points[mesh.polygons(mesh.groups["TOP"])[0]][:, 1], 1.0)

    def test_the_boundary_of_a_body_in_space_is_seen_from_outside(self):
        """Of a box of hexahedra, of pyramids: the areas of its facets, as vectors, add up to nothing, and their flux of x to three volumes."""
        from meshes import brick, write_med

        for kind in ("HEXA20", "PYRAM5"):
            lines = [np.linspace(0.0, size, 3) for size in (1.0, 2.0, 3.0)]
            write_med(self.folder / "box.med", brick(kind, lines, name="BOX"))
            (self.folder / "box.comm").write_text("DEBUT()\nBOX = LIRE_MAILLAGE(UNITE=20)\nFIN()\n")
            self.run_lacon("box.comm", "--fresh", "--unit", "20=box.med")
            mesh = open_base(self.folder / "box.base")["BOX"]
            area, flux = np.zeros(3), 0.0
            for _, facets in mesh.boundary.values():
                corners = mesh.points[facets]
                for i in range(1, facets.shape[1] - 1):
                    triangles = np.cross(corners[:, i] - corners[:, 0], corners[:, i + 1] - corners[:, 0]) / 2
                    area += triangles.sum(axis=0)
                    flux += (triangles * corners[:, [0, i, i + 1]].mean(axis=1)).sum()
            np.testing.assert_allclose(area, 0.0, atol=1e-12, err_msg=kind)
            self.assertAlmostEqual(flux, 3 * 6.0, places=11, msg=kind)

    def test_fields_have_their_instants(self):
        self.assertEqual(self.result.instants.tolist(), [0.0, 0.25, 0.5, 0.75, 1.0])
        self.assertTrue(self.result.complete)
        top = np.unique(np.concatenate(self.result.mesh.polygons(self.result.mesh.groups["TOP"])))
        for instant in (0.25, 1.0):
            np.testing.assert_allclose(self.result.displacements(instant)[top], [[0.0, -0.05 * instant, 0.0]] * len(top), atol=1e-15)
        field = self.result.field("DEPL")
        self.assertEqual((field.instant, field.location), (1.0, "NOEU"))
        self.assertEqual(np.isfinite(field["LAGS_C"]).sum(), (field.present[:, field.components.index("LAGS_C")]).sum())
        self.refused("READER_2", lambda: self.result.field("DEPL", 0.3))
        self.refused("RESULT_1", lambda: self.result.field("TEMP"))

    def test_pressures_of_the_patches_carry_the_force(self):
        """On a skin that is nearly flat: pressure times length is the vertical force of the zone, up to the slope squared."""
        patches = self.result.contact()
        self.assertEqual((len(patches), patches.groups, set(patches.zone.tolist())), (10, ["SOLE"], {0}))
        self.assertEqual((patches.status == 1).sum(), self.result.journal.iterations()[-1][1]["active"])
        force = self.result.parameters["zone_1_slave_force_y"][-1]
        self.assertAlmostEqual((patches.pressure * patches.area).sum() / force, 1.0, delta=0.02)
        self.assertTrue((patches.gap[patches.status == 0] > 0.0).all())

    def test_masters_that_something_has_touched_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            base = shutil.copytree(self.base.folder, pathlib.Path(folder) / "copy.base")
            (path,) = base.glob("result_*/CONT_ELEM_4.masters.h5")
            spoilt = bytearray(path.read_bytes())
            spoilt[len(spoilt) // 2] ^= 1
            path.write_bytes(spoilt)
            self.refused("BASE_5", lambda: open_base(base)["RESULT"].contact().masters)

    def test_files_that_are_missing_or_damaged_are_told_by_name(self):
        """In whatever way: they ended in tracebacks of h5py, and a mesh that is gone as if Lacon were not installed whole."""
        def without_seal(content):  # whose root group is another one
            return content[:-32].replace(b"components", b"compoments").replace(b"values", b"valves").replace(b"cell", b"call")

        other, masters = (next(self.base.folder.glob(name)).read_bytes() for name in ("load_*.h5", "result_*/CONT_ELEM_4.masters.h5"))

        def with_another_mark(content):
            return content[:-40] + bytes(byte ^ 1 for byte in content[-40:-24]) + content[-24:]

        for pattern, spoil, identifier in (("mesh_2.h5", None, "STUDY_7"), ("mesh_2.h5", lambda content: b"", "STUDY_7"),
                                           ("result_*/CONT_ELEM_4.masters.h5", lambda content: b"", "STUDY_7"),
                                           ("result_*/CONT_ELEM_4.masters.h5", lambda content: content[:len(content) // 2], "STUDY_7"),
                                           ("result_*/CONT_ELEM_4.masters.h5", without_seal, "BASE_5"), ("result_*/CONT_NOEU_4.h5", without_seal, "BASE_5"),
                                           ("result_*/CONT_NOEU_4.h5", with_another_mark, "BASE_5"),
                                           *((name, lambda content: other, "BASE_7") for name in ("mesh_2.h5", "result_*/DEPL_4.h5", "result_*/index.h5")),
                                           *((name, lambda content: masters, "BASE_7") for name in ("contact_*.h5", "result_*/DEPL_4.h5")),
                                           ("result_*/CONT_ELEM_4.masters.h5", lambda content: other, "BASE_7")):
            with self.subTest(pattern, expected=identifier), tempfile.TemporaryDirectory() as folder:
                base = shutil.copytree(self.base.folder, pathlib.Path(folder) / "copy.base")
                (path,) = base.glob(pattern)
                content = path.read_bytes()
                path.unlink()
                if spoil:
                    path.write_bytes(spoil(content))
                with self.assertRaisesRegex(AsterError, f"<F> <{identifier}> .*{path.name}"):
                    shown = open_base(base)
                    if path.name.endswith(".masters.h5"):  # the page can do without, and says so
                        told, _ = study.make(shown, shown.only_result())
                        self.assertEqual([path.name in note for note in told["notes"]], [True])
                        shown.only_result().contact().masters_of(0)
                    study.make(shown, shown.only_result())

    @unittest.skipUnless(meshio, "no meshio")
    def test_meshio_gets_what_it_reads_from_our_own_files(self):
        made, read = self.result.to_meshio(), meshio.read(next(self.folder.glob("result_*.vtu")))
        np.testing.assert_allclose(np.sort(made.points, axis=0), np.sort(self.result.mesh.points + self.result.displacements(), axis=0))
        self.assertEqual({b.type: len(b.data) for b in made.cells}, {kind: sum(len(b.data) for b in read.cells if b.type == kind) for kind in {b.type for b in read.cells}})
        for kind, nodes in made.cells_dict.items():
            np.testing.assert_array_equal(np.sort(nodes, axis=0), np.sort(read.cells_dict[kind], axis=0))
        np.testing.assert_allclose(np.nan_to_num(made.point_data["DEPL"][:, :2]), read.point_data["DEPL"][:, :2], atol=1e-14)

    @unittest.skipUnless(matplotlib, "no matplotlib")
    def test_plot_draws_three_pictures_as_png_and_svg(self):
        said = self.run_lacon("plot", "study.base", "--out", "pictures/press", "--dpi", "60").stdout.splitlines()
        self.assertEqual(said, [f"pictures/press_{name}.{form}" for name in ("mesh", "pressure", "convergence") for form in ("png", "svg")])
        for path in said:
            content = (self.folder / path).read_bytes()
            if path.endswith(".png"):
                self.assertEqual(content[:8], b"\x89PNG\r\n\x1a\n")
                self.assertGreater(min(struct.unpack(">II", content[16:24])), 100)
                pixels = matplotlib.image.imread(self.folder / path)
                self.assertGreater(len(np.unique(pixels.reshape(-1, pixels.shape[2]), axis=0)), 50, "not an empty sheet")
            else:
                self.assertIn(b"</svg>", content)
        self.assertIn(b"contact pressure", (self.folder / "pictures/press_pressure.svg").read_bytes())

    @unittest.skipUnless(matplotlib, "no matplotlib")
    def test_plot_says_what_it_cannot_draw(self):
        self.assertIn("<F> <PLOT_1>", self.run_lacon("plot", "study.base", "--field", "CONT_ELEM", status=2).stderr)
        self.assertIn("<F> <READER_2>", self.run_lacon("plot", "study.base", "--instant", "0.3", status=2).stderr)
        (self.folder / "matplotlib.py").write_text("raise ImportError('not here')")
        said = subprocess.run([LACON, "plot", "study.base"], cwd=self.folder, capture_output=True, text=True, timeout=SECONDS,
                              env={**os.environ, "PYTHONPATH": str(self.folder)})
        (self.folder / "matplotlib.py").unlink()
        self.assertEqual(said.returncode, 2)
        self.assertIn("<F> <READER_6> pictures need matplotlib", said.stderr)

    def test_a_base_in_use_is_read_while_it_grows(self):
        run = subprocess.Popen([LACON, "study.comm", "--unit", "20=mesh.med", "--base", "live.base"], cwd=self.folder, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
        seen = set()
        while run.poll() is None:
            if (self.folder / "live.base/base.json").exists():
                for result in open_base(self.folder / "live.base").results.values():
                    seen.add((len(result.instants), result.complete))
                    self.assertEqual(result.displacements().shape, result.mesh.points.shape)
            time.sleep(0.002)
        self.assertEqual(run.returncode, 0)
        self.assertIn((5, True), seen | {(len(r.instants), r.complete) for r in open_base(self.folder / "live.base").results.values()})


if __name__ == "__main__":
    unittest.main()
