"""The pairing inspector: IMPR_RESU with PAIRING or CONTACT, and `lacon inspect`. One slave cell lies over two masters that stand
apart and a third one below the second: the covered fraction is 2.6 of 3, and the third couple is hidden."""

import base64
import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import types
import unittest
import xml.etree.ElementTree

import h5py
import numpy as np
from study_test import LACON, SOURCE, StudyTest, content

from meshes import block, brick, union, write_med

COMM = SOURCE / "tests/studies/inspect_pairing.comm"
STEP = "-0000000000000000001-0000000000000000001"
MODELS = {"D_PLAN": 2, "3D": 3}
COVERED = 2.6 / 3  # of the slave skin, on the initial geometry
REASONS = ["facing away", "hidden", "sliver", "degenerate slave", "degenerate master", "no image", "too far", "too steep", "too deep", "other side", "far behind", "wall"]


def write_mesh(path, dimension):
    """A block of one cell, 3 long, over blocks from 0 to 1.2 and from 1.6 to 3, and one from 2 to 3 that lies lower."""
    def body(first, last, low, high, name, sides):
        lines = [[first, last], [0.0, 1.0], [low, high]]
        if dimension == 2:
            return block("QUAD4", lines[0], lines[2], name=name, sides=sides)
        return brick("HEXA8", lines, name=name, sides={(2, 0 if side == "bottom" else 1): group for side, group in sides.items()})

    masters = [body(*box, "LOW", {"top": "MASTER", "bottom": "BASE"}) for box in ((0, 1.2, -1, 0), (1.6, 3, -1, 0), (2, 3, -3, -2))]
    write_med(path, union([body(0, 3, 0, 1, "UP", {"bottom": "SLAVE", "top": "TOP"}), *masters]))


def read_vtu(path):
    """.points, .cells (lists of points), .types, .data (cell arrays by name)"""
    root = xml.etree.ElementTree.parse(path).getroot()
    kinds = {"Float64": "<f8", "Int64": "<i8", "UInt8": "u1"}

    def values(array):
        raw = base64.b64decode(array.text)
        found = np.frombuffer(raw[8:], kinds[array.get("type")])
        width = int(array.get("NumberOfComponents", 1))
        return found.reshape(-1, width) if width > 1 else found

    arrays = {place: {a.get("Name"): values(a) for a in root.find(f".//{place}")} for place in ("Points", "Cells", "CellData")}
    ends = arrays["Cells"]["offsets"]
    cells = [arrays["Cells"]["connectivity"][a:b] for a, b in zip([0, *ends[:-1]], ends)]
    return types.SimpleNamespace(points=arrays["Points"]["Points"], cells=cells, types=arrays["Cells"]["types"], data=arrays["CellData"])


def measure(points):
    """Length of a segment, area of a plane convex polygon."""
    if len(points) == 2:
        return np.linalg.norm(points[1] - points[0])
    sides = points[1:] - points[0]
    return sum(np.linalg.norm(np.cross(a, b)) for a, b in zip(sides, sides[1:])) / 2


class Inspect(StudyTest):
    runs = {}  #: model -> its run, which no test changes

    @classmethod
    def tearDownClass(cls):
        for run in cls.runs.values():
            shutil.rmtree(run.folder, ignore_errors=True)

    def study(self, model):
        """The run of the study for a model; its .folder holds all files and the base."""
        if model not in self.runs:
            self.runs[model] = self.run_model(model, pathlib.Path(tempfile.mkdtemp(prefix="lacon_inspect_")))
        return self.runs[model]

    def run_model(self, model, folder):
        write_mesh(folder / "in.med", MODELS[model])
        units = [f"--unit={n}={folder / name}" for n, name in ((20, "in.med"), (80, "out.med"), (81, "out.vtu"), (8, "out.resu"))]
        run = self.run_lacon(COMM, "--base", folder / "study.base", *units, INSPECT_MODEL=model)
        self.assertEqual((run.status, run.diagnostic), (0, "--- DIAGNOSTIC JOB : OK"), run.stdout + run.stderr)
        run.folder = folder
        return run

    def inspect(self, folder, *arguments):
        return subprocess.run([LACON, "inspect", folder / "study.base", *map(str, arguments)], cwd=folder, capture_output=True, text=True,
                              timeout=60, stdin=subprocess.DEVNULL, check=False)

    def stored(self, folder, name, order):
        """A field of the result: component -> value by cell or node number (from 1)."""
        [result] = (folder / "study.base").glob("result_*")
        with h5py.File(result / "index.h5") as index:
            group = index[f"fields/{name}"]
            path = folder / "study.base" / group["file"].asstr()[list(group["order"][()]).index(order)]
        with h5py.File(path) as file:
            return {component: dict(zip(file["support"][()] + 1, column))
                    for component, column in zip(file.attrs["components"], file["values"][()].T)}

    def test_polygons_of_the_initial_geometry_are_the_true_fraction(self):
        for model, dimension in MODELS.items():
            with self.subTest(model):
                folder = self.study(model).folder
                pairs = read_vtu(folder / "out_pairs_0001.vtu")
                areas = np.array([measure(pairs.points[cell]) for cell in pairs.cells])
                self.assertAlmostEqual(areas.sum() / 3, COVERED, delta=1e-12)
                np.testing.assert_allclose(pairs.points[:, dimension - 1], 0, atol=1e-15)
                # every polygon lies over the master that it names: 0 to 1.2, or 1.6 to 3
                low = np.array([pairs.points[cell, 0].min() for cell in pairs.cells])
                high = np.array([pairs.points[cell, 0].max() for cell in pairs.cells])
                first = pairs.data["MASTER"] == pairs.data["MASTER"][np.argmin(low)]
                self.assertLess(high[first].max(), 1.2 + 1e-12)
                self.assertGreater(low[~first].min(), 1.6 - 1e-12)
                self.assertEqual(len(set(pairs.data["MASTER"])), 2)
                np.testing.assert_allclose(pairs.data["GAP"], 0, atol=1e-14)
                # a polygon that is a fan of triangles has its measure on each of them
                one = {(s, m, f): f for s, m, f in zip(pairs.data["SLAVE"], pairs.data["MASTER"], pairs.data["FRACTION"])}
                self.assertAlmostEqual(sum(one.values()), COVERED, delta=1e-12)

    def test_skins_say_what_the_result_says(self):
        for model in MODELS:
            with self.subTest(model):
                folder = self.study(model).folder
                for order in (0, 1):
                    skins = read_vtu(folder / f"out_skins_000{order + 1}.vtu")
                    stored = self.stored(folder, "CONT_ELEM", order)
                    slave = skins.data["GROUP_MA SLAVE_1"] == 1
                    self.assertEqual((slave.sum() > 2, (skins.data["GROUP_MA MASTER_1"] == 1).sum()), (True, 3))
                    for name, component in (("COVERAGE", "COEFSURF"), ("GAP", "JEU"), ("STATUS", "CONT"), ("PRESSURE", "PRES")):
                        expected = [stored[component][cell] for cell in skins.data["CELL"][slave]]
                        np.testing.assert_allclose(skins.data[name][slave], expected, rtol=1e-11, atol=1e-13, err_msg=name)
                        self.assertTrue(np.all(np.isnan(skins.data[name][~slave])), name)
                self.assertEqual(set(skins.data["STATUS"][slave]), {1.0})
                # the geometry is that of the instant
                bottom = skins.points[skins.cells[np.flatnonzero(slave)[0]], MODELS[model] - 1]
                self.assertLess(bottom.max(), 0)

    def test_points_carry_gaps_and_images(self):
        for model in MODELS:
            with self.subTest(model):
                folder = self.study(model).folder
                points, pairs = read_vtu(folder / "out_points_0002.vtu"), read_vtu(folder / "out_pairs_0002.vtu")
                self.assertEqual(set(points.types), {1})
                self.assertEqual(set(zip(points.data["SLAVE"], points.data["MASTER"])), set(zip(pairs.data["SLAVE"], pairs.data["MASTER"])))
                # the image lies on the slave's normal: its distance is the gap, whose sign the pressed master turns
                np.testing.assert_allclose(np.linalg.norm(points.data["TO_MASTER"], axis=1), np.abs(points.data["GAP"]), atol=1e-12)
                self.assertGreater(np.abs(points.data["GAP"]).max(), 1e-6)

    def test_rejected_couples_have_a_reason_and_a_line(self):
        for model in MODELS:
            with self.subTest(model):
                folder = self.study(model).folder
                rejected = read_vtu(folder / "out_rejected_0001.vtu")
                skins = read_vtu(folder / "out_skins_0001.vtu")
                self.assertEqual({REASONS[int(reason)] for reason in rejected.data["REASON"]}, {"hidden"})
                np.testing.assert_array_equal(rejected.data["GROUP_MA hidden"], 1)
                [third] = set(rejected.data["MASTER"])
                where = skins.cells[list(skins.data["CELL"]).index(third)]
                self.assertEqual(skins.points[where, MODELS[model] - 1].max(), -2)
                for cell in rejected.cells:
                    np.testing.assert_allclose(rejected.points[cell[1]], skins.points[where].mean(axis=0), atol=1e-14)
                listed = skins.data["REJECTED"][list(skins.data["CELL"]).index(third)]
                self.assertEqual(listed, len(rejected.cells))

    def test_med_has_the_same_and_conforms(self):
        for model in MODELS:
            with self.subTest(model):
                folder = self.study(model).folder
                with h5py.File(folder / "out.med") as file:
                    meshes = {f"{name}{end}" for name in ("PAIRS", "SKINS", "POINTS", "REJECTED") for end in ("_0", "_1")}
                    self.assertEqual({m for m in file["ENS_MAA"] if m.startswith("RESU_")}, {f"RESU_{name}" for name in meshes})
                    self.assertEqual(len([m for m in file["ENS_MAA"] if m.startswith("CONTACT_")]), 4)
                    pairs = read_vtu(folder / "out_pairs_0002.vtu")
                    coordinates = file[f"ENS_MAA/RESU_PAIRS_1/{STEP}/NOE/COO"][()].reshape(MODELS[model], -1).T
                    np.testing.assert_array_equal(coordinates, pairs.points[:, :MODELS[model]])
                    field = file["CHA/RESU_PAIRS_1_FRACTION"]
                    self.assertEqual(field.attrs["MAI"], b"RESU_PAIRS_1")
                    [step] = field.values()
                    self.assertEqual((step.attrs["NDT"], step.attrs["PDT"]), (1, 1.0))
                    found = np.concatenate([step[kind]["MED_NO_PROFILE_INTERNAL/CO"][()] for kind in step])
                    np.testing.assert_array_equal(np.sort(found), np.sort(pairs.data["FRACTION"]))
                    # in space the slave widens by 1e-3 beyond the second block, and sees the third one there, in a sliver
                    self.assertEqual([bytes(row.astype(np.uint8)).rstrip(b"\0") for family in file["FAS/RESU_REJECTED_1/ELEME"].values()
                                      for row in family["GRO/NOM"][()]], [b"hidden", b"sliver"] if model == "3D" else [b"hidden"])
                if not shutil.which("medconforme"):
                    self.skipTest("medconforme is not installed (libmed-tools)")
                conforms = subprocess.run(["medconforme", folder / "out.med"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
                self.assertEqual(conforms.returncode, 0, conforms.stdout)
                self.assertNotIn("non conforme", conforms.stdout.lower())

    def test_lines_name_the_patch_its_couples_and_what_was_rejected(self):
        run = self.study("D_PLAN")
        # the skin is cut in three: M1 to M3, on the masters M5, M7 and M9 below
        line = "patch 1, covered to 86.67 %: M1 on M5: 33.33 %; M2 on M5: 6.667 %; M2 on M7: 13.33 %; M3 on M7: 33.33 %; M3 on M9: hidden"
        self.assertIn(line, run.stdout)
        self.assertIn("zone 1, SLAVE on MASTER: 3 slave cells in 1 patches, 3 master cells, 4 contact cells; covered 2.6 of 3 (86.67 %)", run.stdout)
        self.assertIn("Pairing of CONTACT on the initial geometry", run.stdout)
        listing = (run.folder / "out.resu").read_text()
        self.assertIn("Pairing of RESU at instant 1\n", listing)
        self.assertNotIn("instant 0", listing)

    def test_a_curved_couple_of_many_polygons_is_named_once(self):
        def bend(x, y, z):
            return x, y, z + 0.1 * x * x

        def turn(x, y, z):
            return bend(0.8 * x - 0.6 * y + 0.5, 0.6 * x + 0.8 * y - 0.2, z)

        lines = np.linspace(0, 1, 3)
        upper = brick("HEXA20", [lines, lines, [0, 1]], place=bend, curved=True, name="UP", sides={(2, 0): "SLAVE", (2, 1): "TOP"})
        lower = brick("PENTA15", [np.linspace(-0.5, 1.5, 4), np.linspace(-0.5, 1.2, 4), [-1, 0]], place=turn, curved=True, name="LOW",
                      sides={(2, 1): "MASTER", (2, 0): "BASE"})
        write_med(self.folder / "in.med", union([upper, lower]))
        units = [f"--unit={n}={self.folder / name}" for n, name in ((20, "in.med"), (80, "out.med"), (81, "out.vtu"), (8, "out.resu"))]
        run = self.run_lacon(COMM, "--base", self.folder / "study.base", *units, INSPECT_MODEL="3D")
        self.assertEqual(run.status, 0, run.stdout + run.stderr)
        # the masters leave a corner of one patch free, all others are covered
        [(covered, couples)] = re.findall(r"patch \d+, covered to (\S+) %: (.*)", (self.folder / "out.resu").read_text())
        parts = re.findall(r"(M\d+ on M\d+): ([\d.e-]+) %", couples)
        self.assertEqual(len({couple for couple, _ in parts}), len(parts))
        self.assertAlmostEqual(sum(float(part) for _, part in parts), float(covered), delta=0.005 * (1 + len(parts)))
        self.assertLess(float(covered), 99)
        pairs = read_vtu(self.folder / "out_pairs_0002.vtu")
        met = set(zip(pairs.data["SLAVE"], pairs.data["MASTER"]))
        self.assertGreater(len(pairs.cells), 2 * len(met))
        skins = read_vtu(self.folder / "out_skins_0002.vtu")
        for cell, couples in zip(skins.data["CELL"], skins.data["COUPLES"]):
            self.assertEqual(couples, sum(cell in couple for couple in met))

    def test_inspect_writes_both_formats_and_leaves_the_base_alone(self):
        folder = self.study("D_PLAN").folder
        before = content(folder / "study.base")
        done = self.inspect(folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count("Pairing of RESU at instant 1\n"), 1)
        made = folder / "study_pairing"
        self.assertEqual({p.name for p in made.glob("*.pvd")}, {f"pairing_{name}.pvd" for name in ("pairs", "skins", "points", "rejected")})
        self.assertTrue((made / "pairing.med").exists())
        self.assertEqual(content(made)["pairing_pairs_0001.vtu"], content(folder)["out_pairs_0002.vtu"])
        done = self.inspect(folder, "--instant", "all", "--out", "every")
        self.assertEqual(re.findall(r"at instant (\S+)", done.stdout), ["0", "1"])
        self.assertEqual(len(list((folder / "every").glob("pairing_pairs_*.vtu"))), 2)
        done = self.inspect(folder, "--result", "CONTACT", "--out", "first")
        self.assertIn("Pairing of CONTACT on the initial geometry", done.stdout)
        self.assertEqual(content(folder / "first")["pairing_pairs_0001.vtu"], content(folder)["out_pairs_0001.vtu"])
        self.assertEqual(content(folder / "study.base"), before)

    def test_inspect_leaves_nothing_of_an_earlier_look(self):
        folder = self.study("D_PLAN").folder
        self.assertEqual(self.inspect(folder, "--instant", "all", "--out", "look").returncode, 0)
        (folder / "look/pairing_rejected_0009.vtu").write_text("of another study")
        (folder / "look/pairing_of_mine.vtu").write_text("no layer")
        self.assertIn("at instant 0\n", self.inspect(folder, "--instant", "0", "--out", "look").stdout)
        self.assertEqual(self.inspect(folder, "--result", "CONTACT", "--out", "look").returncode, 0)
        layers = ("pairs", "skins", "points", "rejected")
        self.assertEqual(set(content(folder / "look")), {"pairing.med", "pairing_of_mine.vtu", *(f"pairing_{name}.pvd" for name in layers),
                                                         *(f"pairing_{name}_0001.vtu" for name in layers)})

    def test_inspect_takes_a_result_whose_run_was_killed(self):
        """Its variable was never assigned: the contact was shown instead, before any instant, and --result refused it."""
        path = shutil.copytree(self.study("D_PLAN").folder / "study.base", self.folder / "study.base") / "base.json"
        registry = json.loads(path.read_text(encoding="utf-8"))
        registry["unfinished"] = {registry["labels"].pop("RESU"): {"label": "RESU", "key": None, "at": None, "where": "study.comm:1"}}
        registry["format"] = 1  # which had no seal
        del registry["seal"]
        path.write_text(json.dumps(registry), encoding="utf-8")
        for arguments in ((), ("--result", "RESU")):
            self.assertIn("Pairing of RESU at instant 1\n", self.inspect(self.folder, *arguments).stdout)

    def test_inspect_refuses_what_is_not_there(self):
        folder = self.study("D_PLAN").folder
        for arguments, words in ((["--result", "RESUL"], ["INSPECT_1", "'RESUL'", "CONTACT, RESU"]), (["--instant", "0.5"], ["FIELDS_2", "0.5"]),
                                 (["--result", "CONTACT", "--instant", "1"], ["INSPECT_3", "'CONTACT'"])):
            done = self.inspect(folder, *arguments)
            self.assertEqual(done.returncode, 2, done.stderr)
            for word in words:
                self.assertIn(word, done.stderr)
            self.assertFalse((folder / "study_pairing").exists())
        done = self.inspect(self.folder)
        self.assertEqual((done.returncode, "<READER_7>" in done.stderr), (2, True), done.stderr)
        (self.folder / "study.comm").write_text("DEBUT()\nFIN()\n")
        self.assertEqual(self.run_lacon("study.comm").status, 0)
        done = self.inspect(self.folder)
        self.assertEqual((done.returncode, "<INSPECT_4>" in done.stderr), (2, True), done.stderr)


if __name__ == "__main__":
    unittest.main()
