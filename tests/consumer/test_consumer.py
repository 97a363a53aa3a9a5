"""A plug-in outside the tree: built against the installed package, found, run; and refused, with its file, where it is wrong."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent


def run(*command, **options):
    """Run a command to its end; the completed process with its output."""
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=600, check=False, **options)


class Consumer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="lacon_consumer_")
        cls.addClassCleanup(cls.folder.cleanup)
        root = pathlib.Path(cls.folder.name)
        cls.prefix, cls.build = root / "prefix", root / "build"
        flags = "-fsanitize=address,undefined" if os.environ["LACON_SANITIZE"] == "ON" else ""
        cmake = os.environ["LACON_CMAKE"]
        for command in (
            [cmake, "--install", os.environ["LACON_BINARY_DIR"], "--prefix", cls.prefix],
            [cmake, "-S", HERE / "plane_stress", "-B", cls.build, f"-DCMAKE_PREFIX_PATH={cls.prefix}", f"-DCMAKE_CXX_FLAGS={flags}",
             f"-DCMAKE_BUILD_TYPE={os.environ['LACON_BUILD_TYPE']}", f"-DCMAKE_CXX_COMPILER={os.environ['LACON_CXX']}",
             f"-DCMAKE_INSTALL_PREFIX={cls.prefix}"],
            [cmake, "--build", cls.build],
        ):
            done = run(*command)
            if done.returncode:
                raise AssertionError(f"{command} failed:\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
        cls.plugin = cls.build / "lib/lacon/plugins/plane_stress"
        shutil.copy(cls.build / "pull", cls.prefix / "bin/pull")  # beside the operators: it finds the built-in plug-ins as they do

    def pull(self, *folders, path="", program=None):
        environment = dict(os.environ, LACON_PLUGIN_PATH=str(path))
        return run(program or self.prefix / "bin/pull", *folders, env=environment)

    def assert_stresses(self, done):
        self.assertEqual(done.returncode, 0, done.stderr)
        # E / (1 - nu^2) eps = 400 / 100; nu times that; none across; no shear
        for value, exact in zip(map(float, done.stdout.split()), (4, 2, 0, 0), strict=True):
            self.assertAlmostEqual(value, exact, delta=1e-12)

    def copy(self, name="plane_stress"):
        """A copy of the plug-in, to break."""
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.folder.name)) / name
        shutil.copytree(self.plugin, folder)
        return folder

    def test_the_package_installs_the_built_in_plugins_and_the_interface(self):
        for name in ("solid", "load", "contact"):
            self.assertTrue((self.prefix / f"lib/lacon/plugins/{name}/lib{name}.so").is_file(), name)
        for header in ("elements/plugin.h", "elements/lanes.hpp", "elements/registry.hpp", "catalog/cell_type.hpp"):
            self.assertTrue((self.prefix / "include/lacon" / header).is_file(), header)

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
        folder = self.copy()
        source = folder / "other.cpp"
        text = (HERE / "plane_stress/plane_stress.cpp").read_text()
        self.assertIn("LACON_ABI,", text)
        source.write_text(text.replace("LACON_ABI,", "LACON_ABI + 1,"))
        library = folder / "libplane_stress.so"
        done = run(os.environ["LACON_CXX"], "-std=c++20", "-shared", "-fPIC", f"-I{self.prefix}/include", source, "-o", library)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_refused(folder, "PLUGIN_1", library, "ABI")

    def test_a_missing_kernel_is_refused_with_the_library(self):
        folder = self.copy()
        rows = folder / "plugin.toml"
        rows.write_text(rows.read_text().replace("plane_stress/elastic", "plane_stress/plastic"))
        self.assert_refused(folder, "PLUGIN_3", folder / "libplane_stress.so", "'plastic'")

    def test_a_row_that_names_nothing_is_refused_with_its_file(self):
        folder = self.copy()
        rows = folder / "plugin.toml"
        rows.write_text(rows.read_text().replace("QUAD4 = 4", "QUAD5 = 4"))
        self.assert_refused(folder, "PLUGIN_2", rows, "'QUAD5'")

    def test_a_file_that_is_no_library_is_refused_with_its_name(self):
        folder = self.copy()
        (folder / "libplane_stress.so").write_text("no library")
        self.assert_refused(folder, "PLUGIN_1", folder / "libplane_stress.so")


if __name__ == "__main__":
    unittest.main()
