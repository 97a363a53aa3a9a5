"""Plug-ins outside the tree: built against the installed package, found, run; and refused, with their file, where they are wrong."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "operators"), str(HERE.parent.parent / "commands/studies")]
import lacon_test  # noqa: E402
from lacon_test import concept  # noqa: E402
from meshes import block, union, weld, write_med  # noqa: E402
from results import Result  # noqa: E402

SIDES = {"left": "LEFT", "right": "RIGHT", "bottom": "BASE", "top": "TOP"}

made = {}  # by setUpModule: the folders that every test uses


def run(*command, **options):
    """Run a command to its end; the completed process with its output."""
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=600, check=False, **options)


def setUpModule():
    """Install the package into a folder of its own and build the plug-ins against it."""
    folder = tempfile.TemporaryDirectory(prefix="lacon consumer ")  # a space in its name, as folders of users have
    unittest.addModuleCleanup(folder.cleanup)
    root = pathlib.Path(folder.name)
    prefix, build = root / "prefix", root / "build"
    others = {name: root / name for name in ("laws", "voids")}
    cmake = os.environ["LACON_CMAKE"]
    settings = [f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_FLAGS={os.environ['LACON_SANITIZE']}", f"-DCMAKE_BUILD_TYPE={os.environ['LACON_BUILD_TYPE']}",
                f"-DCMAKE_CXX_COMPILER={os.environ['LACON_CXX']}", f"-DCMAKE_INSTALL_PREFIX={prefix}"]
    for command in (
        [cmake, "--install", os.environ["LACON_BINARY_DIR"], "--prefix", prefix],
        [cmake, "-G", "Ninja", "-S", HERE / "plane_stress", "-B", build, *settings],
        [cmake, "--build", build],
        *([cmake, "-G", "Ninja", "-S", HERE / name, "-B", folder, *settings] for name, folder in others.items()),
        *([cmake, "--build", folder] for folder in others.values()),
    ):
        done = run(*command)
        if done.returncode:
            raise AssertionError(f"{command} failed:\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    shutil.copy(build / "pull", prefix / "bin/pull")  # beside the operators: it finds the built-in plug-ins as they do
    made.update(root=root, prefix=prefix, build=build, plugin=build / "lib/lacon/plugins/plane_stress",
                **{name: folder / "lib/lacon/plugins" / name for name, folder in others.items()})


def copy_of_plugin(name="plane_stress"):
    """A copy of the plug-in, to break."""
    folder = pathlib.Path(tempfile.mkdtemp(dir=made["root"])) / name
    shutil.copytree(made["plugin"], folder)
    return folder


def plugin_of_another_abi():
    """A copy of the plug-in whose library was built for another ABI."""
    folder = copy_of_plugin()
    text = (HERE / "plane_stress/plane_stress.cpp").read_text(encoding="utf-8")
    assert "LACON_ABI," in text
    source = folder / "other.cpp"
    source.write_text(text.replace("LACON_ABI,", "LACON_ABI + 1,"), encoding="utf-8")
    done = run(os.environ["LACON_CXX"], "-std=c++20", "-shared", "-fPIC", f"-I{made['prefix']}/include", source,
               "-o", folder / "libplane_stress.so")
    assert done.returncode == 0, done.stderr
    return folder


class Installed(unittest.TestCase):
    """What an installation has beside programs and headers; nothing of the build tree is named."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=made["root"]))
        self.environment = {k: v for k, v in os.environ.items() if not k.startswith("LACON_")}

    def python(self, home, text):
        done = run(sys.executable, "-c", text, cwd=self.folder, env={**self.environment, "PYTHONPATH": str(made["prefix"] / home)})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.split()

    def test_a_template_runs_and_python_reads_its_base(self):
        done = run(made["prefix"] / "bin/lacon", "new", "--template", "several_zones", cwd=self.folder, env=self.environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        done = run(made["prefix"] / "bin/lacon", "several_zones.comm", cwd=self.folder / "several_zones", env=self.environment)
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr)
        ask = "import lacon; print(len(lacon.open('several_zones/several_zones.base')['RESULT'].contact()))"
        for home in ("share/lacon/python", "lib/python3/dist-packages"):
            self.assertEqual(self.python(home, ask), ["41"])

    def test_python_runs_studies_with_the_operators_of_its_installation(self):
        found = self.python("share/lacon/python", "from lacon.core import plugins; print(plugins.operator_folder())")
        self.assertEqual(" ".join(found), str(made["prefix"].resolve() / "bin"))

    def test_there_are_completion_and_man_pages(self):
        for path in ("share/bash-completion/completions/lacon", "share/zsh/vendor-completions/_lacon", "share/man/man1/lacon.1", "share/man/man1/lacon-watch.1",
                     "share/man/man7/lacon-DEFI_CONTACT.7", "share/man/fr/man1/lacon-watch.1", "share/man/fr/man7/lacon-DEFI_CONTACT.7",
                     "share/lacon/python/lacon/py.typed", "share/lacon/python/lacon/__init__.pyi"):
            self.assertTrue((made["prefix"] / path).is_file(), path)


class Program(unittest.TestCase):
    """A program of one's own that links the package."""

    def setUp(self):
        self.prefix, self.build, self.plugin = made["prefix"], made["build"], made["plugin"]

    def pull(self, *folders, path="", program=None):
        environment = dict(os.environ, LACON_PLUGIN_PATH=str(path))
        return run(program or self.prefix / "bin/pull", *folders, env=environment)

    def assert_stresses(self, done):
        self.assertEqual(done.returncode, 0, done.stderr)
        # E / (1 - nu^2) eps = 400 / 100; nu times that; none across; no shear
        for value, exact in zip(map(float, done.stdout.split()), (4, 2, 0, 0), strict=True):
            self.assertAlmostEqual(value, exact, delta=1e-12)

    def test_the_package_installs_the_built_in_plugins_and_the_interface(self):
        for name in ("solid", "load", "contact"):
            self.assertTrue((self.prefix / f"lib/lacon/plugins/{name}/lib{name}.so").is_file(), name)
        for header in ("elements/plugin.h", "elements/lanes.hpp", "elements/registry.hpp", "catalog/cell_type.hpp"):
            self.assertTrue((self.prefix / "include/lacon" / header).is_file(), header)

    def test_a_program_reads_meshes(self):
        """HDF5 comes with all that it needs, also in a folder whose name has a space, where h5cc cannot be asked."""
        mesh = made["root"] / "mesh.med"
        write_med(mesh, block("QUAD4", np.linspace(0, 1, 4), np.linspace(0, 1, 3)))
        done = run(self.build / "count_nodes", mesh)
        self.assertEqual((done.returncode, done.stdout), (0, "12\n"), done.stderr)

    def test_it_is_found_by_folder_and_by_path(self):
        self.assert_stresses(self.pull(self.plugin))
        self.assert_stresses(self.pull(path=self.plugin))

    def test_it_is_found_where_it_was_installed(self):
        done = run(os.environ["LACON_CMAKE"], "--install", self.build)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.addCleanup(shutil.rmtree, self.prefix / "lib/lacon/plugins/plane_stress")
        self.assert_stresses(self.pull())

    def test_rows_that_name_built_in_kernels_need_the_built_in_plugins(self):
        elsewhere = self.build / "pull"
        self.assert_stresses(self.pull(path=f"{self.prefix}/lib/lacon/plugins:{self.plugin}", program=elsewhere))
        done = self.pull(self.plugin, program=elsewhere)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("'load', which was not found", done.stderr)

    def assert_refused(self, folder, identifier, *parts):
        done = self.pull(folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(f"<{identifier}>", done.stderr)
        for part in parts:
            self.assertIn(str(part), done.stderr)

    def test_a_library_of_another_abi_is_refused_with_its_file(self):
        folder = plugin_of_another_abi()
        self.assert_refused(folder, "PLUGIN_1", folder / "libplane_stress.so", "ABI")

    def test_a_missing_kernel_is_refused_with_the_library(self):
        folder = copy_of_plugin()
        rows = folder / "plugin.toml"
        rows.write_text(rows.read_text().replace("plane_stress/elastic", "plane_stress/plastic"))
        self.assert_refused(folder, "PLUGIN_3", folder / "libplane_stress.so", "'plastic'")

    def test_a_row_that_names_nothing_is_refused_with_its_file(self):
        folder = copy_of_plugin()
        rows = folder / "plugin.toml"
        rows.write_text(rows.read_text().replace("QUAD4 = 4", "QUAD5 = 4"))
        self.assert_refused(folder, "PLUGIN_2", rows, "'QUAD5'")

    def test_a_file_that_is_no_library_is_refused_with_its_name(self):
        folder = copy_of_plugin()
        (folder / "libplane_stress.so").write_text("no library")
        self.assert_refused(folder, "PLUGIN_1", folder / "libplane_stress.so")


class Operators(lacon_test.OperatorTest):
    """The installed operators with the plug-in: a bar of a QUAD4 and two TRIA3, pulled along x under plane stress."""

    E, NU, PULL = 100.0, 0.3, 10.0

    def setUp(self):
        super().setUp()
        self.addCleanup(setattr, lacon_test, "BIN", lacon_test.BIN)
        lacon_test.BIN = made["prefix"] / "bin"
        self.coordinates = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1]], float)
        self.write_mesh("mesh_1", self.coordinates, [("QUAD4", [0, 1, 2, 3]), ("TRIA3", [1, 4, 5]), ("TRIA3", [1, 5, 2]), ("SEG2", [4, 5])],
                        cell_groups={"RIGHT": [3]}, node_groups={"LEFT": [0, 3], "ORIGIN": [0]})
        self.write_material("mater_2", ELAS={"E": self.E, "NU": self.NU})
        self.write_material_field("field_3", "mesh_1", ["mater_2"], [0, 0, 0, 0])
        with self.create("list_4", "list_of_reals") as file:
            file["values"] = np.array([0.0, 1.0])

    def prepare(self, modelisation):
        """Model and loads by the operators; @return the keywords of STAT_NON_LINE"""
        for command, keywords, result in (
            ("AFFE_MODELE", {"MAILLAGE": concept("mesh_1"),
                             "AFFE": [{"TOUT": "OUI", "PHENOMENE": "MECANIQUE", "MODELISATION": modelisation}]}, "model_5"),
            ("AFFE_CHAR_CINE", {"MODELE": concept("model_5"),
                                "MECA_IMPO": [{"GROUP_NO": ["LEFT"], "DX": 0.0}, {"GROUP_NO": ["ORIGIN"], "DY": 0.0}]}, "load_6"),
            ("AFFE_CHAR_MECA", {"MODELE": concept("model_5"), "PRES_REP": [{"GROUP_MA": ["RIGHT"], "PRES": -self.PULL}]}, "load_7"),
        ):
            done = self.run_command(command, keywords, result=result, environment=self.path_of(made["plugin"]))
            self.assertEqual(done.status, 0, done.stderr)
        return {"MODELE": concept("model_5"), "CHAM_MATER": concept("field_3"), "INCREMENT": [{"LIST_INST": concept("list_4")}],
                "EXCIT": [{"CHARGE": concept("load_6")}, {"CHARGE": concept("load_7")}]}

    @staticmethod
    def path_of(folder):
        return {"LACON_PLUGIN_PATH": str(folder)}

    def test_a_bar_under_plane_stress_stretches_and_narrows_as_the_theory_says(self):
        done = self.run_command("STAT_NON_LINE", self.prepare("PLANE_STRESS"), result="result_8", environment=self.path_of(made["plugin"]))
        self.assertEqual(done.status, 0, done.stderr)
        with h5py.File(self.path("model_5")) as file:
            self.assertEqual({lacon_test.text(n) for n in file["elements"][()]},
                             {"PLANE_STRESS/QUAD4", "PLANE_STRESS/TRIA3", "PLANE_STRESS/SEG2"})
        stress = self.read_field("result_8", "SIEF_ELGA", 1)
        columns = [stress.components.index(c) for c in ("SIXX", "SIYY", "SIZZ", "SIXY")]
        np.testing.assert_allclose(stress.values[:, columns], np.tile([self.PULL, 0, 0, 0], (4 + 1 + 1, 1)), atol=1e-12 * self.PULL)
        # plane strain would give (1 - nu^2) and nu (1 + nu) in place of 1 and nu
        depl = self.read_field("result_8", "DEPL", 1)
        exact = self.PULL / self.E * self.coordinates[depl.support] * [1, -self.NU]
        columns = [depl.components.index(c) for c in ("DX", "DY")]
        np.testing.assert_allclose(depl.values[:, columns], exact, atol=1e-12)

    def test_without_the_plugin_the_model_is_refused(self):
        self.assert_refuses("MODELE_1", "AFFE_MODELE", {"MAILLAGE": concept("mesh_1"), "AFFE": [
            {"TOUT": "OUI", "PHENOMENE": "MECANIQUE", "MODELISATION": "PLANE_STRESS"}]}, "PLANE_STRESS", result="model_5",
            environment=self.path_of(""))

    def test_a_library_of_another_abi_stops_the_operator_and_leaves_the_base_as_it_was(self):
        keywords, folder = self.prepare("PLANE_STRESS"), plugin_of_another_abi()
        self.assert_refuses("PLUGIN_1", "STAT_NON_LINE", keywords, str(folder / "libplane_stress.so"), "ABI", result="result_8",
                            environment=self.path_of(folder))


class Launched(lacon_test.OperatorTest):
    """The installed launcher with the plug-in `plugin`."""

    plugin = ""
    options, environment = (), {}  # of launch_study()

    def launch(self, *arguments, **environment):
        return run(made["prefix"] / "bin/lacon", *arguments, cwd=self.folder,
                   env={**os.environ, "LACON_PLUGIN_PATH": str(made[self.plugin]), **environment})

    def launch_study(self, mesh, text):
        """@return the launcher's process; the base is study.base"""
        write_med(self.folder / "mesh.med", mesh)
        (self.folder / "study.comm").write_text(text, encoding="utf-8")
        return self.launch("study.comm", "--unit", "20=mesh.med", "--base", "study.base", "--fresh", *self.options, **self.environment)

    def by_two_processes(self, has_cells=True):
        """For each METHODE whose work two processes share: its name, the same whoever evaluates cells.
        @param has_cells whether processes may have cells, which the study then counts"""
        self.environment = {"LACON_MPI_FROM": "1"}
        for method in ("MUMPS", "PETSC") if (made["prefix"] / "bin/lacon_petsc").exists() and shutil.which("mpirun") else ("MUMPS",):
            self.options = ("--mpi", "2", "--json", "run.json")
            with self.subTest(method=method):
                yield f"SOLVEUR=_F(METHODE='{method}'{', RESI_RELA=1e-13' if method == 'PETSC' else ''})"
                commands = json.loads((self.folder / "run.json").read_text(encoding="utf-8"))["timings"]["commands"]
                counts = next(c["counts"] for c in commands if c["command"] == "STAT_NON_LINE")
                self.assertEqual(counts.get("processes with cells"), 2 if has_cells else None, counts)


class Laws(Launched):
    """The installed launcher with a plug-in that brings laws: a square of plane strain, stretched along x by u_x = strain x."""

    plugin = "laws"
    LAMBDA, MU, YC = 60.0, 40.0, 0.5
    STRAINS = (0.02, 0.04, 0.01)  # stretched, further, and partly released

    STUDY = """
DEBUT(ERREUR=_F(ALARME="EXCEPTION"))
MESH = LIRE_MAILLAGE(UNITE=20)
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION="D_PLAN"))
MATTER = DEFI_MATERIAU(ELAS=_F(E=104.0, NU=0.3), LAME=_F(LAMBDA={0.LAMBDA}, MU={0.MU}), DAMAGE=_F(YC={0.YC}))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", MATER=MATTER))
TIMES = DEFI_LIST_REEL(VALE=(0.0, 1.0, 2.0, 3.0))
PATH = DEFI_FONCTION(NOM_PARA="INST", VALE=(0.0, 0.0, 1.0, {1[0]}, 2.0, {1[1]}, 3.0, {1[2]}))
HELD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA="LEFT", DX=0), _F(GROUP_MA="BASE", DY=0), _F(GROUP_MA="TOP", DY=0)))
PULLED = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA="RIGHT", DX=1))
R = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, INCREMENT=_F(LIST_INST=TIMES), COMPORTEMENT=_F({2}),
                  EXCIT=(_F(CHARGE=HELD), _F(CHARGE=PULLED, FONC_MULT=PATH)))
CALC_CHAMP(reuse=R, RESULTAT=R, DEFORMATION="EPSI_ELGA", FORCE="REAC_NODA")
FIN()
"""

    def study(self, behaviour):
        """@return the launcher's process; the base is study.base"""
        mesh = block("QUAD8", np.array([0, 0.4, 1.0]), np.array([0, 0.7, 1.0]), None, "BODY", SIDES)
        return self.launch_study(mesh, self.STUDY.format(self, self.STRAINS, behaviour))

    def stresses(self, behaviour):
        """At each instant SIXX, which is the same at every point."""
        done = self.study(behaviour)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-3000:])
        result, found = Result(self.folder / "study.base", "R"), []
        for order in (1, 2, 3):
            stress = result.field("SIEF_ELGA", order)[1]["SIXX"]
            np.testing.assert_allclose(stress, stress[0], rtol=1e-10)
            found.append(stress[0])
        return np.array(found), result, done.stderr

    def test_an_elastic_law_with_a_keyword_of_its_own(self):
        for deformation in ("PETIT", "INFINITESIMAL"):
            stress, _, _ = self.stresses(f"RELATION='ELAS_LAME', DEFORMATION='{deformation}'")
            np.testing.assert_allclose(stress, (self.LAMBDA + 2 * self.MU) * np.array(self.STRAINS), rtol=1e-10)

    def test_a_law_with_internal_variables_remembers_and_names_them(self):
        stress, result, said = self.stresses("RELATION='DAMAGE'")
        strain = np.array(self.STRAINS)
        kappa = np.maximum.accumulate((self.LAMBDA + 2 * self.MU) * strain**2 / 2)
        np.testing.assert_allclose(stress, self.YC / (self.YC + kappa) * (self.LAMBDA + 2 * self.MU) * strain, rtol=1e-10)
        for order in (1, 2, 3):
            values = result.field("VARI_ELGA", order)[1]
            np.testing.assert_allclose(values["V1"], kappa[order - 1], rtol=1e-10)
            np.testing.assert_allclose(values["V2"], kappa[order - 1] / (self.YC + kappa[order - 1]), rtol=1e-10)
        self.assertIn("DAMAGE/PETIT in VARI_ELGA: V1 = KAPPA, V2 = ENDO", said)

    def test_processes_open_the_plug_in_as_well(self):
        """The law and its memory, in processes that have their part of the cells."""
        strain = np.array(self.STRAINS)
        kappa = np.maximum.accumulate((self.LAMBDA + 2 * self.MU) * strain**2 / 2)
        for solver in self.by_two_processes():
            stress, result, said = self.stresses(f"RELATION='DAMAGE'), {solver[:-1]}")
            np.testing.assert_allclose(stress, self.YC / (self.YC + kappa) * (self.LAMBDA + 2 * self.MU) * strain, rtol=1e-10)
            for order in (1, 2, 3):
                np.testing.assert_allclose(result.field("VARI_ELGA", order)[1]["V1"], kappa[order - 1], rtol=1e-10)
            self.assertEqual(said.count("DAMAGE/PETIT in VARI_ELGA: V1 = KAPPA, V2 = ENDO"), 1)

    def test_initial_strains_are_taken_by_laws_that_start_elastically(self):
        """What is no strain of the law's is off: sigma = C (eps - eps0), with eps0 the same at all instants; others are refused, by what their rows say."""
        initial, young, nu = 0.005, 104.0, 0.3
        self.addCleanup(setattr, Laws, "STUDY", Laws.STUDY)
        Laws.STUDY = Laws.STUDY.replace("R = STAT", f"GROWN = AFFE_CHAR_MECA(MODELE=MODEL, PRE_EPSI=_F(GROUP_MA='BODY', EPXX={initial}))\nR = STAT").replace(
            "EXCIT=(", "EXCIT=(_F(CHARGE=GROWN), ")
        for deformation in ("PETIT", "INFINITESIMAL"):
            stress, _, _ = self.stresses(f"RELATION='ELAS_HOOKE', DEFORMATION='{deformation}'")
            np.testing.assert_allclose(stress, young * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) * (np.array(self.STRAINS) - initial), rtol=1e-10)
        for relation, words in (("ELAS_LAME", "<BEHAVIOUR_6> cell M"), ("ELAS_FALSE", "<BEHAVIOUR_9> the behaviour ELAS_FALSE/PETIT")):
            done = self.study(f"RELATION='{relation}'")
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)

    def test_the_launcher_knows_the_law_and_its_keywords(self):
        material, solver = self.launch("help", "DEFI_MATERIAU").stdout, self.launch("help", "STAT_NON_LINE").stdout
        for text in ("LAME", "LAMBDA", "YC", "energy density at which half of the stiffness is left", "default 1.0"):
            self.assertIn(text, material)
        for text in ("ELAS_LAME", "DAMAGE", "INFINITESIMAL"):
            self.assertIn(text, solver)

    def test_a_keyword_that_the_law_lacks_and_a_law_that_the_element_lacks_are_refused(self):
        self.addCleanup(setattr, Laws, "STUDY", Laws.STUDY)
        study = Laws.STUDY
        Laws.STUDY = study.replace("LAME=_F(", "LAME=_F(NU=0.3, ")
        done = self.study("RELATION='DAMAGE'")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("LAME/NU", done.stderr.replace("[1]", ""))
        Laws.STUDY = study
        done = self.study("RELATION='DAMAGE', DEFORMATION='INFINITESIMAL'")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("<BEHAVIOUR_1> there is no DAMAGE/INFINITESIMAL", done.stderr)


class Unknowns(Launched):
    """Nodes with a PHI beside their displacements, in the part VOIDS of a layer: u_y = 0 everywhere, pulled along x by PULL."""

    plugin = "voids"
    B, XI, ALPHA, PULL = 20.0, 50.0, 2.0, 7.0
    STIFF = 140.0  # lambda + 2 mu
    # sigma = STIFF u' + B phi = PULL and ALPHA phi'' = XI phi + B u': far from what holds phi it is UNIFORM
    OF_VOIDS = XI - B**2 / STIFF
    UNIFORM = -B * PULL / (STIFF * OF_VOIDS)

    STUDY = """
DEBUT(ERREUR=_F(ALARME="EXCEPTION"))
MESH = LIRE_MAILLAGE(UNITE=20)
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=(_F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION="D_PLAN"),
                                         _F(GROUP_MA=("VOIDS", "LEFT"), PHENOMENE="MECANIQUE", MODELISATION="D_VOIDS")))
MATTER = DEFI_MATERIAU(ELAS=_F(E=104.0, NU=0.3), VOIDS=_F(B={0.B}, XI={0.XI}, ALPHA={0.ALPHA}))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", MATER=MATTER))
TIMES = DEFI_LIST_REEL(VALE=(0.0, 1.0, 2.0))
RAMP = DEFI_FONCTION(NOM_PARA="INST", VALE=(0.0, 0.0, 2.0, 1.0))
LAYER = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA="LEFT", DX=0), _F(GROUP_MA=("BASE", "TOP"), DY=0)))
PULLED = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA="RIGHT", PRES=-{0.PULL}))
{1}
R = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, INCREMENT=_F(LIST_INST=TIMES),
                  EXCIT=(_F(CHARGE=LAYER), _F(CHARGE=PULLED, FONC_MULT=RAMP), {2}))
AGAIN = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, INCREMENT=_F(LIST_INST=TIMES), ETAT_INIT=_F(EVOL_NOLI=R, INST=1.0),
                      EXCIT=(_F(CHARGE=LAYER), _F(CHARGE=PULLED, FONC_MULT=RAMP), {2}))
CALC_CHAMP(reuse=R, RESULTAT=R, FORCE="REAC_NODA")
FIN()
"""

    def result(self, x, plain=(), load="", excit=""):
        """@param x grid lines of the part with voids @param plain those of a part without behind it @param load, excit held PHI"""
        parts = [block("QUAD8", np.array(s), np.array([0, 0.3, 1.0]), None, name, {**SIDES, "right": right, "left": left})
                 for s, name, left, right in ((x, "VOIDS", "LEFT", "JOINT" if plain else "RIGHT"), (plain, "PLAIN", "JOINT", "RIGHT")) if len(s)]
        done = self.launch_study(weld(union(parts)), self.STUDY.format(self, load, excit))
        self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-3000:])
        return Result(self.folder / "study.base", "R")

    def test_it_takes_part_where_its_elements_are_and_is_nowhere_else(self):
        """Without anything that holds PHI it is uniform, which any mesh represents."""
        result = self.result([0, 0.4, 1.0], plain=(1.0, 1.5, 2.0))
        inside = result.points[:, 0] <= 1 + 1e-12
        for label in ("R", "AGAIN"):
            result = Result(self.folder / "study.base", label)
            x, last = result.points[:, 0], result.orders[-1]
            np.testing.assert_allclose(result.where_present("DEPL", last, "PHI"), np.full(inside.sum(), self.UNIFORM), rtol=1e-10)
            exact = self.PULL / self.STIFF * x - self.B * self.UNIFORM / self.STIFF * np.minimum(x, 1)
            np.testing.assert_allclose(result.at_nodes("DEPL", last, "DX"), exact, rtol=1e-10, atol=1e-12)
            np.testing.assert_allclose(result.field("SIEF_ELGA", last)[1]["SIXX"], self.PULL, rtol=1e-10)
        result = Result(self.folder / "study.base", "R")
        held = result.at_nodes("REAC_NODA", 2, "DX")
        np.testing.assert_allclose([held[x == 0].sum(), np.abs(held[x > 0]).max()], [-self.PULL, 0], atol=1e-10)

    def test_processes_share_its_equations(self):
        """PHI is none of the unknowns that processes with cells know: one process has the cells, and says so."""
        study = Unknowns.STUDY
        self.addCleanup(setattr, Unknowns, "STUDY", study)
        for solver in self.by_two_processes(has_cells=False):
            Unknowns.STUDY = study.replace("CHAM_MATER=FIELD, ", f"CHAM_MATER=FIELD, {solver}, ")
            result = self.result([0, 0.4, 1.0], plain=(1.0, 1.5, 2.0))
            np.testing.assert_allclose(result.where_present("DEPL", 2, "PHI"), self.UNIFORM, rtol=1e-9)

    def test_where_it_is_held_it_forms_boundary_layers(self):
        """phi = UNIFORM (1 - cosh(k (x - 1/2)) / cosh(k / 2)) between x = 0 and 1, where DDL_IMPO holds it: errors go as h^3."""
        k = np.sqrt(self.OF_VOIDS / self.ALPHA)
        errors = []
        for n in (8, 16):
            result = self.result(np.linspace(0, 1, n + 1), load="HELD = AFFE_CHAR_MECA(MODELE=MODEL, DDL_IMPO=_F(GROUP_MA=('LEFT', 'RIGHT'), PHI=0))",
                                 excit="_F(CHARGE=HELD)")
            x = result.points[:, 0]
            phi = self.UNIFORM * (1 - np.cosh(k * (x - 0.5)) / np.cosh(k / 2))
            errors.append(np.abs(result.at_nodes("DEPL", 2, "PHI") - phi).max() / abs(self.UNIFORM))
            longer = (self.PULL - self.B * self.UNIFORM * (1 - np.tanh(k / 2) / (k / 2))) / self.STIFF
            np.testing.assert_allclose(result.at_nodes("DEPL", 2, "DX")[x == 1], longer, rtol=(k / n)**4)
        self.assertLess(errors[1], (k / 16)**3)
        self.assertGreater(errors[0] / errors[1], 2**2.8)

    def test_elements_without_it_refuse_it(self):
        done = self.launch_study(block("QUAD8", np.array([0, 1.0]), np.array([0, 1.0]), None, "PLAIN", SIDES), self.STUDY.replace(
            '("VOIDS", "LEFT")', '"LEFT"').format(self, "HELD = AFFE_CHAR_MECA(MODELE=MODEL, DDL_IMPO=_F(GROUP_MA='RIGHT', PHI=0))", "_F(CHARGE=HELD)"))
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("<CHARGE_3>", done.stderr)


if __name__ == "__main__":
    unittest.main()
