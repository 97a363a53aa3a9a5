"""The shell scripts that a user runs first: clean, and clear about what they cannot do."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["LACON_SOURCE_DIR"])
SCRIPTS = ["commands/check", "commands/demo", "commands/package", "commands/docs", "commands/setup.sh", ".ci/run"]


def package_names():
    lines = (ROOT / "commands/packages.txt").read_text().splitlines()
    return [name for name in (line.split("#")[0].strip() for line in lines) if name]


def run_setup(call, **tools):
    """Source setup.sh and call a function of it with these commands replaced (name -> shell body)."""
    with tempfile.TemporaryDirectory() as folder:
        for name, body in tools.items():
            tool = Path(folder, name.replace("_", "-"))
            tool.write_text(f"#!/bin/bash\n{body}\n")
            tool.chmod(0o755)
        return subprocess.run(
            ["bash", "-c", f"source {ROOT}/commands/setup.sh; {call}"], text=True, capture_output=True,
            env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "CALLS": f"{folder}/calls"})


class Scripts(unittest.TestCase):
    def test_shellcheck_finds_nothing(self):
        for script in SCRIPTS:
            done = subprocess.run(["shellcheck", "-x", str(ROOT / script)], text=True, capture_output=True)
            self.assertEqual(done.returncode, 0, done.stdout)

    def test_ci_runs_the_test_command_of_the_readme(self):
        self.assertIn("./commands/check", (ROOT / "README.md").read_text())
        self.assertIn("commands/check", (ROOT / ".ci/run").read_text())

    def test_an_unknown_option_is_named(self):
        done = subprocess.run([str(ROOT / "commands/check"), "--fast"], text=True, capture_output=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("--fast", done.stderr)


class Packages(unittest.TestCase):
    def test_every_package_is_named_once(self):
        names = package_names()
        self.assertGreater(len(names), 15)
        self.assertEqual(len(names), len(set(names)))

    def test_nothing_is_installed_where_nothing_is_missing(self):
        done = run_setup("install_packages", dpkg_query="echo -n installed", apt_get="echo CALLED; exit 1")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_only_what_is_missing_is_installed(self):
        dpkg = 'if [[ ${@: -1} == libmetis-dev && ! -e $CALLS ]]; then exit 1; fi; echo -n installed'
        done = run_setup("install_packages", dpkg_query=dpkg, apt_cache="exit 0",
                         apt_get='echo "apt-get $*"; touch "$CALLS"', id="echo 0")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("apt-get -q -y install --no-install-recommends libmetis-dev\n", done.stdout)
        self.assertNotIn("update", done.stdout)

    def test_lists_of_packages_are_fetched_where_there_are_none(self):
        dpkg = 'if [[ ${@: -1} == libmetis-dev && ! -e $CALLS ]]; then exit 1; fi; echo -n installed'
        done = run_setup("install_packages", dpkg_query=dpkg, apt_cache="exit 100",
                         apt_get='echo "apt-get $*"; [[ $* == *update* ]] || touch "$CALLS"', id="echo 0")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("apt-get -q -y update\n", done.stdout)

    def test_a_package_that_cannot_be_installed_is_named(self):
        dpkg = "[[ ${@: -1} == libmetis-dev ]] && exit 1; echo -n installed"
        done = run_setup("install_packages", dpkg_query=dpkg, apt_cache="exit 0", apt_get="exit 100", id="echo 0")
        self.assertEqual(done.returncode, 1)
        self.assertIn("libmetis-dev", done.stderr)


if __name__ == "__main__":
    unittest.main()
