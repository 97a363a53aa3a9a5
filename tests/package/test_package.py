"""The Debian package installs on a bare Debian 12, and a study runs there."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["LACON_SOURCE_DIR"])
MIRROR = os.environ.get("LACON_DEBIAN_MIRROR", "http://deb.debian.org/debian")

#: what a user does first
SMOKE = """
set -e
cd "$(mktemp -d)"
lacon --version
lacon help DEFI_CONTACT >help
for template in press_fit several_zones; do
  lacon new --template $template
  (cd $template && lacon $template.comm && lacon watch $template.base)
done
python3 -c 'import lacon; assert (lacon.open("press_fit/press_fit.base")["RESULT"].contact().status == 1).all()'
! lacon plot press_fit/press_fit.base 2>missing
grep -q 'install python3-matplotlib' missing
"""


def run(*command, **options):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False, **options)
    if done.returncode:
        raise AssertionError(f"{command} failed:\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout


@unittest.skipUnless(os.geteuid() == 0 and shutil.which("debootstrap"), "needs root and debootstrap")
class Package(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="lacon_debian_"))
        self.addCleanup(shutil.rmtree, self.root, ignore_errors=True)

    def inside(self, *command):
        return run("chroot", self.root, *command, env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND": "noninteractive"})

    def test_it_installs_runs_and_goes_on_a_bare_debian(self):
        run(SOURCE / "commands/package")
        (package,) = (SOURCE / "build/package").glob("lacon_*.deb")
        run("debootstrap", "--variant=minbase", "bookworm", self.root, MIRROR)
        for path in ("/etc/resolv.conf", "/etc/hosts"):
            shutil.copyfile(path, self.root / path[1:])
        run("mount", "-t", "proc", "proc", self.root / "proc")
        self.addCleanup(run, "umount", self.root / "proc")
        before = set(self.inside("find", "/usr", "/etc").split())
        shutil.copyfile(package, self.root / "lacon.deb")
        self.inside("apt-get", "-q", "update")
        self.inside("apt-get", "-q", "-y", "install", "--no-install-recommends", "/lacon.deb")
        said = self.inside("bash", "-c", SMOKE)
        self.assertEqual(said.count("--- DIAGNOSTIC JOB : OK"), 2)
        self.inside("apt-get", "-q", "-y", "purge", "lacon")
        left = {path for path in set(self.inside("find", "/usr", "/etc").split()) - before if "lacon" in path}
        self.assertEqual(left, set())


if __name__ == "__main__":
    unittest.main()
