"""`lacon report`: the page says what the base holds, and shows it in headless Chromium. Where Chromium or npm are not, what needs them is skipped."""

import base64
import functools
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import time
import unittest
import zlib

import numpy as np
from study_test import LACON, SECONDS, SOURCE, StudyTest

from meshes import block, brick, union, write_med

BUILT = pathlib.Path(os.environ["LACON_BINARY_DIR"])
PAGE, VIEWER = BUILT / "generated/report.html", BUILT / "commands/viewer"
CHROMIUM = shutil.which("chromium")
NODE = shutil.which("node") or shutil.which("nodejs")
NO_PAGE = "" if PAGE.exists() else "the page was not bundled: npm is missing, or did not reach its registry"
NO_BROWSER = NO_PAGE or ("" if CHROMIUM and NODE and (VIEWER / "node_modules/playwright-core").exists() else "chromium, node or playwright-core are missing")
TYPES = {"u1": "u1", "u2": "<u2", "i4": "<i4", "u4": "<u4", "f4": "<f4"}
#: where an absent number of 16 bits is
ABSENT = 65535
SQUASH = 0.04  #: of the strip, by which its top comes down

STUDY = """
DEBUT()
MESH = LIRE_MAILLAGE(UNITE=20)
CUT = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL='SOLE'))
MODEL = AFFE_MODELE(MAILLAGE=CUT, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='{model}'))
STEEL = DEFI_MATERIAU(ELAS=_F(E=200.0, NU={nu}))
MATTER = AFFE_MATERIAU(MAILLAGE=CUT, AFFE=_F(TOUT='OUI', MATER=STEEL))
HELD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='BASE', {fixed}), _F(GROUP_MA='TOP', {kept})))
PUSH = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='TOP', {down}={way}))
RAMP = DEFI_FONCTION(NOM_PARA='INST', VALE=(0.0, 0.0, 1.0, 1.0))
CONTACT = DEFI_CONTACT(MODELE=MODEL, FORMULATION='CONTINUE', ALGO_RESO_GEOM='NEWTON', ALGO_RESO_CONT='NEWTON',
                       ZONE=_F(APPARIEMENT='MORTAR', ALGO_CONT='LAC', GROUP_MA_ESCL='SOLE', GROUP_MA_MAIT='GROUND'))
TIMES = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=_F(JUSQU_A=1.0, NOMBRE=2))
RESULT = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, CONTACT=CONTACT, EXCIT=(_F(CHARGE=HELD), _F(CHARGE=PUSH, FONC_MULT=RAMP)),
                       INCREMENT=_F(LIST_INST=TIMES))
RESULT = CALC_CHAMP(reuse=RESULT, RESULTAT=RESULT, CONTRAINTE='SIEF_NOEU')
FIN()
"""
MODELS = {2: {"model": "D_PLAN", "nu": 0.0, "fixed": "DX=0.0, DY=0.0", "kept": "DX=0.0", "down": "DY", "way": -2 * SQUASH},
          "AXIS": {"model": "AXIS", "nu": 0.0, "fixed": "DX=0.0, DY=0.0", "kept": "DX=0.0", "down": "DY", "way": -2 * SQUASH},
          3: {"model": "3D", "nu": 0.3, "fixed": "DX=0.0, DY=0.0, DZ=0.0", "kept": "DX=0.0, DY=0.0", "down": "DZ", "way": -0.05}}


def write_mesh(path, dimension):
    """In the plane two strips of one width, which do not bulge (NU = 0): displacements are linear. In space a dome of 4 x 4 patches on a plate."""
    line = np.linspace
    if dimension != 3:
        lower = block("QUAD4", line(0, 2, 5), line(-1, 0, 3), name="LOWER", sides={"bottom": "BASE", "top": "GROUND"})
        upper = block("QUAD4", line(0, 2, 4), line(0, 1, 3), name="UPPER", sides={"bottom": "SOLE", "top": "TOP"})
    else:
        lower = brick("HEXA8", [line(-1.2, 1.2, 7), line(-1.2, 1.2, 7), line(-1, 0, 3)], name="PLATE", sides={(2, 0): "BASE", (2, 1): "GROUND"})
        upper = brick("HEXA8", [line(-1, 1, 5), line(-1, 1, 5), line(0, 1, 3)], lambda r, s, t: (r, s, t + 0.1 * (1 - t) * (r * r + s * s)),
                      name="DOME", sides={(2, 0): "SOLE", (2, 1): "TOP"})
    write_med(path, union([lower, upper]))


#: behind the instant 0.5 a step that is cut nowhere, and meets no criterion
FAILS = """
RESULT = STAT_NON_LINE(reuse=RESULT, RESULTAT=RESULT, ETAT_INIT=_F(EVOL_NOLI=RESULT), MODELE=MODEL, CHAM_MATER=MATTER, CONTACT=CONTACT,
                       EXCIT=(_F(CHARGE=HELD), _F(CHARGE=PUSH, FONC_MULT=RAMP)), INCREMENT=_F(LIST_INST=TIMES),
                       CONVERGENCE=_F(RESI_GLOB_MAXI=1e-30, ITER_GLOB_MAXI=7))
FIN()"""


@functools.cache
def failed_study():
    """As study(2), with a step that fails behind its first instant."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_report_"))
    unittest.addModuleCleanup(shutil.rmtree, folder, ignore_errors=True)
    write_mesh(folder / "mesh.med", 2)
    text = STUDY.format(**MODELS[2]).replace("LIST_INST=TIMES", "LIST_INST=TIMES, INST_FIN=0.5", 1).replace("\nFIN()", FAILS)
    (folder / "study.comm").write_text(text, encoding="utf-8")
    for arguments, status in ((("study.comm", "--unit", "20=mesh.med"), 3), (("report", "study.base"), 0)):
        done = subprocess.run([LACON, *arguments], cwd=folder, capture_output=True, text=True, timeout=SECONDS, stdin=subprocess.DEVNULL, check=False)
        assert done.returncode == status, done.stdout[-3000:] + done.stderr
    return folder


@functools.cache
def study(dimension):
    """Folder of a study that was run and reported, the same for all tests, which change nothing in it."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_report_"))
    unittest.addModuleCleanup(shutil.rmtree, folder, ignore_errors=True)
    write_mesh(folder / "mesh.med", dimension)
    (folder / "study.comm").write_text(STUDY.format(**MODELS[dimension]), encoding="utf-8")
    for arguments in (("study.comm", "--unit", "20=mesh.med"), ("report", "study.base")):
        done = subprocess.run([LACON, *arguments], cwd=folder, capture_output=True, text=True, timeout=SECONDS, stdin=subprocess.DEVNULL, check=False)
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr
    return folder


class Told:
    """What a page was told: `study`, and the arrays."""

    def __init__(self, path):
        text = path.read_text(encoding="utf-8")
        self.study = json.loads(re.search(r'<script type="application/json" id="study">(.*?)</script>', text, re.S)[1])
        self._texts = dict(re.findall(r'<script type="text/plain" id="array-(\d+)">(.*?)</script>', text))

    def array(self, reference):
        raw = np.frombuffer(zlib.decompress(base64.b64decode(self._texts[str(reference["id"])])), np.uint8)
        kind = np.dtype(TYPES[reference["type"]])
        return raw.reshape(kind.itemsize, -1).T.copy().view(kind).ravel()

    def field(self, name):
        return next(field for field in self.study["fields"] if field["name"] == name)

    def values(self, name, instant):
        """component -> values"""
        field = self.field(name)
        stored = field["instants"][str(instant)]
        rows = self.array(stored["values"]).astype(float).reshape(len(field["components"]), -1)
        if not field.get("exact"):
            low, high = np.array(stored["ranges"]).T[:, :, None]
            rows = np.where(rows == ABSENT, np.nan, low + rows * (high - low) / (ABSENT - 1))
        return dict(zip(field["components"], rows))


def base_of(folder):
    """The base as the reader of the launcher gives it."""
    import sys

    if str(SOURCE / "commands") not in sys.path:
        sys.path.insert(0, str(SOURCE / "commands"))
    from lacon.reader.base import open_base

    return open_base(folder / "study.base")


class Report(StudyTest):
    def test_without_the_page_it_says_what_to_install(self):
        (self.folder / "bin").mkdir()
        done = self.run_tool("report", "any.base", LACON_BIN=str(self.folder / "bin"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("<F> <REPORT_1>", done.stderr)
        self.assertIn("install nodejs and npm", done.stderr)


@unittest.skipIf(NO_PAGE, NO_PAGE)
class Content(StudyTest):
    def test_a_base_that_is_none_is_said(self):
        done = self.run_tool("report", "none.base")
        self.assertEqual((done.returncode, list(self.folder.iterdir())), (2, []))
        self.assertIn("<F> <READER_7>", done.stderr)

    def test_the_page_is_in_the_language_it_is_asked_in(self):
        """Every text of the page's sources has its French, and a page made in French says so."""
        sources = {path.name: path.read_text(encoding="utf-8") for path in (SOURCE / "commands/viewer/src").iterdir()}
        french = set(re.findall(r'^  "((?:[^"\\]|\\.)*)": "', sources["words.js"], re.M))
        asked = {text for name, source in sources.items() if name.endswith(".js") for text in re.findall(r'\bt\("((?:[^"\\]|\\.)*)"', source)}
        body = re.sub(r"<(script|pre)\b.*?</\1>|<!--.*?-->", "", sources["page.html"].partition("<body>")[2], flags=re.S)
        asked |= {words.strip() for words in re.findall(r">([^<>]+)<", body) if re.search(r"[a-z]", words)} | set(re.findall(r'(?:aria-label|title)="([^"]+)"', body))
        asked |= {phase for room in ("assembly", "operators/evolution", "operators/stat_non_line") for path in (SOURCE / room).rglob("*.cpp")
                  for phase in re.findall(r'(?:Phase phase|add_to_phase)\("([^"]+)"', path.read_text(encoding="utf-8"))}
        self.assertEqual(asked - french, set())
        base = study(2) / "study.base"
        for language, proof in (("fr", "Le contact s'est établi"), ("en", "Contact has settled")):
            done = self.run_tool("report", str(base), "--out", "page.html", LC_ALL=language)
            self.assertEqual(done.returncode, 0, done.stderr)
            told = Told(self.folder / "page.html").study
            self.assertEqual(told["language"], language)
            self.assertIn(proof, [line["what"] for lines in told["proofs"] for line in lines])

    def test_a_page_is_made_while_the_computation_runs(self):
        write_mesh(self.folder / "mesh.med", 2)
        (self.folder / "study.comm").write_text(STUDY.format(**MODELS[2]).replace("NOMBRE=2", "NOMBRE=400"), encoding="utf-8")
        with subprocess.Popen([LACON, "study.comm", "--unit", "20=mesh.med"], cwd=self.folder, stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True) as run:
            for line in run.stdout:
                if line.startswith(" Converged at the instant") and not line.startswith(" Converged at the instant 0.0025 "):
                    break
            done = self.run_tool("report", "study.base")
            under_way = run.poll() is None
            run.kill()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(under_way, "the computation came to its end before its page was made")
        told = Told(self.folder / "study.html").study
        self.assertIn("the computation is under way", told["subtitle"])
        self.assertTrue(2 <= len(told["instants"]) < 401)
        self.assertTrue(told["journal"]["rows"])

    def test_values_are_those_of_the_base_to_16_bits(self):
        for dimension in (2, 3):
            told, result = Told(study(dimension) / "study.html"), base_of(study(dimension))["RESULT"]
            nodes = told.array(told.study["nodes"]) - 1
            field = result.field("DEPL")
            whole = np.full((len(result.mesh.points), 3), np.nan)
            for c in range(dimension):
                name = field.components[c]
                whole[field.support, c] = field[name]
                shown, span = told.values("DEPL", 2)[name], np.ptp(field[name])
                np.testing.assert_allclose(shown, whole[nodes, c], rtol=0, atol=span / 65534 / 2 * 1.0001)
            middle = result.mesh.points[nodes]
            middle = (middle.min(axis=0) + middle.max(axis=0)) / 2
            np.testing.assert_allclose(told.array(told.study["points"]).reshape(-1, 3), result.mesh.points[nodes] - middle, atol=1e-6)

    def test_contact_is_that_of_the_base(self):
        for dimension in (2, 3):
            told, patches = Told(study(dimension) / "study.html"), base_of(study(dimension))["RESULT"].contact()
            shown = told.values("CONT_ELEM", 2)
            np.testing.assert_allclose(shown["pressure"], patches.pressure, rtol=1e-6)
            np.testing.assert_array_equal(shown["status"], patches.status)
            last = told.study["zones"][0]["course"][2]
            self.assertAlmostEqual(last["area"], (patches.area * patches.coverage)[patches.status == 1].sum(), places=9)
            self.assertAlmostEqual(np.linalg.norm(last["force"][-1]), np.linalg.norm(last["force"]), places=2)  # what presses is upright

    def test_the_skin_of_a_box_is_drawn_whole(self):
        """3D: outer facets alone, each once: the area of what is drawn is that of the box."""
        told = Told(study(3) / "study.html")
        points = told.array(told.study["points"]).reshape(-1, 3)
        area = 0.0
        for surface in told.study["surfaces"]:
            if surface["name"] in ("PLATE", "GROUND"):
                for name, n in (("triangles", 3), ("quads", 4)):
                    corners = points[told.array(surface[name]).reshape(-1, n)]
                    for k in range(1, n - 1):
                        area += np.linalg.norm(np.cross(corners[:, k] - corners[:, 0], corners[:, k + 1] - corners[:, 0]), axis=1).sum() / 2
        self.assertAlmostEqual(area, 2 * 2.4 * 2.4 + 4 * 2.4, places=4)

    def test_it_tells_the_command_file_the_iterations_and_the_checks(self):
        told = Told(study(3) / "study.html").study
        self.assertEqual([(one["name"], one["text"]) for one in told["commands"]], [("study.comm", STUDY.format(**MODELS[3]))])
        self.assertEqual(told["journal"]["rows"][-1]["changes"], 0)
        self.assertLessEqual(told["journal"]["rows"][-1]["rela"], told["journal"]["limits"]["rela"])
        checks = {line["what"]: line for line in told["proofs"][-1]}
        for name in ("Equilibrium, RESI_GLOB_RELA", "Contact has settled", "Stable equilibrium", "SOLE on GROUND: forces balance",
                     "SOLE on GROUND: moments balance", "SOLE on GROUND: pressure or gap", "SOLE on GROUND: contact only presses"):
            self.assertIs(checks[name]["holds"], True, name)
        self.assertEqual((told["parts"], told["instants"]), (["PLATE", "DOME"], [0.0, 0.5, 1.0]))

    def test_a_figure_that_is_wrong_is_judged_so(self):
        """Forces that do not balance, a pulling patch, pivots too many: none of them holds."""
        import sys
        import types

        sys.path.insert(0, str(SOURCE / "commands"))
        from lacon.report import proofs

        zone = {"slave_force_x": 0.0, "slave_force_y": 0.0, "slave_force_z": 1.0, "master_force_x": 0.0, "master_force_y": 0.0, "master_force_z": -0.9,
                "moment_x": 0.5, "moment_y": 0.0, "moment_z": 0.0, "active": 1.0, "open": 0.0, "unpaired": 0.0, "covered": 1.0, "whole": 1.0,
                "largest_lambda_gap": 0.1}
        parameters = {"negative_pivots": [2], "expected_negative_pivots": [1], **{f"zone_1_{name}": [value] for name, value in zone.items()}}
        patches = types.SimpleNamespace(zone=np.zeros(2, int), status=np.ones(2, int), pressure=np.array([1.0, -0.1]), area=np.array([0.5, 0.5]),
                                        centre=np.array([[0.0, 0, 0], [1.0, 0, 0]]), space=True)
        limits, iteration = {"rela": 1e-6, "maxi": None}, {"rela": 1e-3, "maxi": 1.0, "changes": 3, "converged": False}
        lines = proofs.of_instant(0, parameters, [("S", "M", [], [])], (limits, [iteration]), patches)
        self.assertEqual([line["what"] for line in lines if line["holds"] is not False], ["S on M: slaves see masters"])
        self.assertEqual(len(lines), 8)


class Browser:
    """report_page.mjs, which has a page open."""

    def __init__(self):
        self._process = subprocess.Popen([NODE, SOURCE / "tests/studies/report_page.mjs", VIEWER, CHROMIUM], stdin=subprocess.PIPE,
                                         stdout=subprocess.PIPE, text=True)

    def do(self, **step):
        self._process.stdin.write(json.dumps({k: str(v) if isinstance(v, pathlib.Path) else v for k, v in step.items()}) + "\n")
        self._process.stdin.flush()
        answer = json.loads(self._process.stdout.readline() or '{"failed": "the browser has ended"}')
        if "failed" in answer:
            raise AssertionError(answer["failed"])
        return answer

    def ask(self, script):
        return self.do(ask=script).get("value")

    def figures(self):
        """What is said of what was picked: title, and name -> value."""
        pairs = self.ask("[...document.querySelectorAll('#figures dt')].map((e) => [e.textContent, e.nextSibling.textContent])")
        return self.ask("document.querySelector('#figures h3')?.textContent ?? ''"), dict(pairs)

    def picture(self):
        """(rows, columns, 3) of bytes."""
        told = self.do(picture=True)
        return np.frombuffer(base64.b64decode(told["pixels"]), np.uint8).reshape(told["height"], told["width"], 3).astype(int)

    def place(self, point):
        """Where a point of the page's coordinates is in the picture."""
        return self.ask(f"""(() => {{ const {{scene}} = window.lacon, {{width, height}} = scene.box.getBoundingClientRect();
          const m = scene.renderer.getActiveCamera().getCompositeProjectionMatrix(width / height, -1, 1), p = [...{json.dumps(list(map(float, point)))}, 1];
          const [x, y,, w] = [0, 1, 2, 3].map((r) => p.reduce((sum, v, c) => sum + m[4 * r + c] * v, 0));
          return [(x / w + 1) / 2 * width, (1 - y / w) / 2 * height]; }})()""")

    def close(self):
        self._process.stdin.close()
        self._process.wait(SECONDS)
        self._process.stdout.close()


@unittest.skipIf(NO_BROWSER, NO_BROWSER)
class Shown(unittest.TestCase):
    """Tests share a browser, and the page that is open: each chooses what it needs."""

    @classmethod
    def setUpClass(cls):
        cls.browser, cls.opened = Browser(), None
        cls.addClassCleanup(cls.browser.close)

    def open(self, dimension, **more):
        self.open_page(study(dimension) / "study.html", **more)

    def open_page(self, page, **more):
        if self.opened != (page, more):
            self.browser.do(open=page, **more)
            type(self).opened = page, more
        else:
            self.browser.ask("window.lacon.restart()")
        self.told = Told(page)
        self.addCleanup(self.no_complaint)

    def no_complaint(self):
        """The console is empty, and nothing but the file was asked for."""
        said = self.browser.do(said=True)
        self.assertEqual(said["console"], [])
        self.assertEqual([url for url in said["requests"] if not url.startswith(("file:", "data:", "blob:"))], [])

    def test_space_every_field_is_seen_and_has_its_scale(self):
        self.open(3)
        pictures = []
        for field in self.told.study["fields"]:
            self.browser.do(set={"field": field["name"]})
            picture = self.browser.picture()
            pictures.append(picture)
            self.assertGreater(picture.std(), 5.0, field["name"])
            self.assertIn(field["title"], self.browser.ask("document.querySelector('#scale b').textContent"))
        for first, second in zip(pictures, pictures[1:]):
            self.assertGreater(abs(first - second).max(), 20)

    def test_plane_the_picture_is_what_theory_draws(self):
        """Two strips squashed together: DY is linear from 0 at the base to the way of the top. Each pixel has the colour of its place."""
        import matplotlib

        self.open(2)
        self.browser.do(set={"field": "DEPL", "component": "DY", "edges": False})
        self.browser.ask("(() => { const {scene} = window.lacon; for (const s of scene.surfaces) if (s.meta.kind !== 'body') s.actor.setVisibility(false);"
                         " scene.render(); })()")
        picture = self.browser.picture()
        way = 2 * SQUASH
        left, low = self.browser.place([-1, -1, 0])
        right, top = self.browser.place([1, 1 - way, 0])
        rows = np.arange(len(picture)) + 0.5
        share = np.clip((low - rows) / (low - top), 0, 1)  # of the height, and of the way: DY from 0 to -way
        wanted = np.array(matplotlib.colormaps["viridis"](1 - share))[:, :3] * 255
        inside = (slice(int(top) + 3, int(low) - 2), slice(int(left) + 3, int(right) - 2))
        away = abs(picture - wanted[:, None, :])[inside]
        self.assertLess(away.mean(), 3.0)
        self.assertLess(np.quantile(away, 0.99), 14.0)
        background = picture[:int(top) - 3]
        self.assertEqual(abs(background - picture[0, 0]).max(), 0)

    def test_space_slider_and_keys_change_the_instant(self):
        self.open(3)
        last = self.browser.picture()
        self.assertIn("instant 1 ", self.browser.ask("document.getElementById('instant-value').textContent"))
        self.browser.do(set={"instant": 1})
        self.assertIn("instant 0.5 ", self.browser.ask("document.getElementById('instant-value').textContent"))
        self.assertGreater(abs(self.browser.picture() - last).max(), 20)
        self.browser.do(key="]")
        self.assertIn("instant 1 ", self.browser.ask("document.getElementById('instant-value').textContent"))
        self.assertLess(abs(self.browser.picture() - last).mean(), 0.05)
        self.browser.do(key="ArrowLeft")
        self.assertGreater(abs(self.browser.picture() - last).max(), 20)

    def test_plane_iterates_of_a_failed_step_have_a_slider_and_their_residual_as_colours(self):
        self.open_page(failed_study() / "study.html")
        step = base_of(failed_study())["RESULT"].failed_step
        shown = "document.querySelector('#scale b').textContent + document.getElementById('instant-value').textContent"
        self.assertIn("SIEF_NOEU, von Mises", self.browser.ask(shown))  # instants come first
        self.assertIn("instant 0.5 ", self.browser.ask(shown))
        of_instant = self.browser.picture()
        names = ["CONT_ELEM", "DEPL", "RESI_NOEU"]
        for place, iteration in ((0, step.orders[0]), (5, 7)):
            self.browser.do(set={"iterate": place})
            self.assertIn("RESI_NOEU (forces not in balance), log", self.browser.ask(shown))
            self.assertEqual(self.browser.ask("document.getElementById('iterate-value').textContent"), f"iteration {iteration} of the step to 1")
            self.assertEqual(self.browser.ask("[...document.querySelectorAll('#field option')].map((o) => o.value)"), names)
            high = float(self.browser.ask("document.getElementById('high').value"))
            field = step.field("RESI_NOEU", order=iteration)
            self.assertAlmostEqual(high, np.log10(np.hypot(*field.values.T).max()), delta=1e-3)
        self.assertGreater(abs(self.browser.picture() - of_instant).max(), 20)
        self.assertEqual(self.browser.ask("window.lacon.study.instants"), [0, 0.5])  # an iterate is none of them
        self.assertIn("✗ 1 of", self.browser.ask("document.getElementById('verdict').textContent"))
        self.assertIn("EVOLUTION_4", self.browser.ask("document.getElementById('proof-lines').textContent"))
        self.browser.do(set={"instant": 1})
        self.assertIn("SIEF_NOEU, von Mises", self.browser.ask(shown))
        self.assertLess(abs(self.browser.picture() - of_instant).mean(), 0.05)

    def test_space_a_click_on_a_patch_tells_its_figures_and_masters(self):
        """3D, the book open: every fifth patch is picked at its middle."""
        self.open(3)
        self.browser.do(set={"field": "CONT_ELEM", "opening": 1})
        result = base_of(study(3))["RESULT"]
        patches, ground = result.contact(), set((result.mesh.groups["GROUND"] + 1).tolist())
        words = {1: "in contact", 0: "open", -1: "without master"}
        for patch in range(0, len(patches), 5):
            middle = self.browser.ask(f"""(() => {{ const {{scene}} = window.lacon, s = scene.surfaces.find((one) => one.meta.kind === 'slave'), found = [0, 0, 0];
              const t = s.facetOfTriangle.findIndex((f) => scene.facetPatch[f] === {patch});
              for (let k = 0; k < 3; ++k) for (let c = 0; c < 3; ++c) found[c] += s.coordinates[3 * s.triangles[3 * t + k] + c] / 3;
              const m = s.turn; return [0, 1, 2].map((r) => m[r] * found[0] + m[4 + r] * found[1] + m[8 + r] * found[2] + m[12 + r]); }})()""")
            self.browser.do(click=self.browser.place(middle))
            title, figures = self.browser.figures()
            self.assertEqual((title, figures["status"]), (f"Patch {patch + 1}, zone 1", words[patches.status[patch]]))
            self.assertAlmostEqual(float(figures["pressure"]), patches.pressure[patch], delta=1e-5 * abs(patches.pressure).max())
            masters = {int(name[1:]): float(share.rstrip(" %")) for name, share in figures.items() if re.fullmatch(r"M\d+", name)}
            paired = {cell + 1: 100 * share for cell, share in patches.masters_of(patch).items()}
            self.assertEqual(set(masters), set(paired))
            self.assertLessEqual(set(masters), ground)
            for cell, share in paired.items():  # said to 1 %, small ones to 0.1 %
                self.assertAlmostEqual(masters[cell], share, delta=0.51)
            marked = self.browser.ask(f"[...window.lacon.scene.facetsOf({list(masters)}, 0)].map((f) => window.lacon.scene.facetCell[f])")
            self.assertEqual(sorted(marked), sorted(masters))

    def test_plane_a_pressure_that_is_one_has_one_colour_on_a_scale_from_zero(self):
        """Both strips carry the same stress everywhere: its round-off is not spread over all colours."""
        self.open(2)
        self.browser.do(set={"field": "CONT_ELEM", "component": "pressure"})
        low, high = (float(self.browser.ask(f"document.getElementById('{name}').value")) for name in ("low", "high"))
        pressure = base_of(study(2))["RESULT"].contact().pressure
        self.assertEqual(low, 0.0)
        self.assertAlmostEqual(high, pressure.max(), delta=1e-5 * pressure.max())

    def test_plane_cell_fields_colour_the_skins_too(self):
        """Skins lie over the bodies as ribbons: each piece has the value of the cell under it. The stress is the same everywhere."""
        self.open(2)
        self.browser.do(set={"field": "SIEF_ELGA", "component": "SIYY"})
        values = self.browser.ask("""window.lacon.scene.surfaces.filter((s) => s.meta.segments)
          .map((s) => s.mapper.getScalarVisibility() && [...s.polydata.getCellData().getScalars().getData()])""")
        self.assertEqual(len(values), 2)
        for one in values:
            np.testing.assert_allclose(one, -200.0 * SQUASH, rtol=1e-3)

    def test_plane_masters_are_those_that_lie_opposite(self):
        """Slave cells of 2/3 on master cells of 1/2: shares are known, and picking a patch says them."""
        result = base_of(study(2))["RESULT"]
        mesh, patches = result.mesh, result.contact()
        own = [mesh.points[corners][:, 0] for corners in mesh.polygons(mesh.patches[0])]
        low, high = min(map(min, own)), max(map(max, own))
        wanted = {}
        for cell, corners in zip(mesh.groups["GROUND"].tolist(), mesh.polygons(mesh.groups["GROUND"])):
            x = mesh.points[corners][:, 0]
            wanted[cell] = max(0.0, min(high, x.max()) - max(low, x.min())) / (high - low)
        wanted = {cell: share for cell, share in wanted.items() if share > 0}
        found = patches.masters_of(0)
        self.assertEqual(set(found), set(wanted))
        for cell, share in wanted.items():
            self.assertAlmostEqual(found[cell], share, delta=1e-9)
        self.open(2)
        place = self.browser.ask("""(() => { const {scene} = window.lacon, s = scene.surfaces.find((one) => one.meta.kind === 'slave');
          const t = s.facetOfTriangle.findIndex((f) => scene.facetPatch[f] === 0);
          return [0, 1, 2].map((c) => [0, 1, 2].reduce((sum, k) => sum + s.coordinates[3 * s.triangles[3 * t + k] + c] / 3, 0)); })()""")
        self.browser.do(click=self.browser.place(place))
        title, figures = self.browser.figures()
        self.assertEqual(title, "Patch 1, zone 1")
        self.assertEqual({name: share for name, share in figures.items() if re.fullmatch(r"M\d+", name)},
                         {f"M{cell + 1}": f"{100 * share:.0f} %" for cell, share in wanted.items()})

    def test_space_the_open_book_shows_both_skins_apart(self):
        """Seen from where the page looks, slave and master cover different places and face the one who looks."""
        self.open(3)
        self.browser.do(set={"opening": 1})
        sides = self.browser.ask("""(() => { const {scene} = window.lacon; const camera = scene.renderer.getActiveCamera().getDirectionOfProjection();
          return ['slave', 'master'].map((kind) => { const s = scene.surfaces.find((one) => one.meta.kind === kind), {normal} = scene.shapeOf(s), m = s.turn;
          return [0, 1, 2].reduce((sum, r) => sum - camera[r] * (m[r] * normal[0] + m[4 + r] * normal[1] + m[8 + r] * normal[2]), 0); }); })()""")
        self.assertGreater(min(sides), 0.9)
        self.assertEqual(self.browser.ask("window.lacon.scene.surfaces.filter((s) => s.actor.getVisibility()).map((s) => s.meta.kind)"), ["slave", "master"])
        self.browser.do(set={"opening": 0})
        self.assertEqual(len(self.browser.ask("window.lacon.scene.surfaces.filter((s) => s.actor.getVisibility()).map((s) => s.meta.kind)")), 4)

    def test_what_is_picked_of_a_body_is_outlined_where_the_body_is_seen(self):
        """Not beside the open book, nor where the body is hidden."""
        outlines = "window.lacon.scene.marks.filter((one) => one.actor.getVisibility()).length"
        self.open(2)
        self.browser.do(click=self.browser.place([0.5, -0.75, 0.0]))
        self.assertIn("Cell M", self.browser.figures()[0])
        self.assertEqual(self.browser.ask(outlines), 1)
        toggle = "[...document.querySelectorAll('#parts label')].find((e) => e.textContent.includes('LOWER')).querySelector('input').click()"
        for step in range(2):
            self.browser.do(set={"opening": 1 - step})
            self.assertEqual(self.browser.ask(outlines), step)
        for step in range(2):
            self.browser.ask(toggle)
            self.assertEqual(self.browser.ask(outlines), step)

    def test_the_dark_and_light_differ_and_print_is_light(self):
        self.open(2, dark=True)
        self.wait_for_ground("dark")
        self.browser.do(media="print")
        self.wait_for_ground("light")
        self.browser.do(media="screen")
        self.wait_for_ground("dark")
        self.browser.ask("document.getElementById('theme').click()")
        self.wait_for_ground("light")

    def wait_for_ground(self, ground):
        """The corner of the picture becomes dark or light: a busy machine draws later."""
        for _ in range(100):
            brightness = self.browser.picture()[0, 0].mean()
            if (brightness < 60) if ground == "dark" else (brightness > 200):
                return
            time.sleep(0.1)
        self.fail(f"the brightness of the ground stays at {brightness}, not {ground}")

    def test_axisymmetric_forces_are_said_to_be_of_one_radian(self):
        """The two strips turned round x = 0: each force is the pressure times the area of one radian, and the page says so."""
        self.open("AXIS")
        result = base_of(study("AXIS"))["RESULT"]
        self.assertTrue(result.is_of_revolution)
        patches = result.contact()
        self.assertAlmostEqual(self.told.study["zones"][0]["course"][-1]["force"][1], patches.pressure.mean() * 2.0**2 / 2, places=5)
        self.assertIn("of one radian", self.browser.ask("document.getElementById('zones').textContent"))
        self.assertIn("Contact force on the slave, of one radian", self.browser.ask("document.getElementById('charts').textContent"))

    def test_space_tables_and_curves_stand(self):
        self.open(3)
        self.assertIn("checks hold", self.browser.ask("document.getElementById('verdict').textContent"))
        titles = self.browser.ask("[...document.querySelectorAll('figcaption')].map((e) => e.textContent)")
        self.assertEqual(titles[:3], ["Newton's method: residuals", "Newton's method: contact", "Contact force on the slave"])
        self.assertNotIn("radian", self.browser.ask("document.getElementById('zones').textContent"))
        self.assertIn("DEFI_CONTACT", self.browser.ask("document.querySelector('#command-files pre').textContent"))
        self.assertIn("vtk.js", self.browser.ask("document.querySelector('footer pre').textContent"))


if __name__ == "__main__":
    unittest.main()
