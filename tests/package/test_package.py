"""The Debian package installs on a bare Debian 12, and a study runs there."""

import os
import pathlib
import shutil
import unittest

from debian import Debian, possible, run

SOURCE = pathlib.Path(os.environ["LACON_SOURCE_DIR"])

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


@unittest.skipUnless(possible(), "needs root and debootstrap")
class Package(unittest.TestCase):
    def test_it_installs_runs_and_goes_on_a_bare_debian(self):
        run(SOURCE / "commands/package")
        (package,) = (SOURCE / "build/package").glob("lacon_*.deb")
        with Debian() as system:
            before = set(system.inside("find", "/usr", "/etc").split())
            shutil.copyfile(package, system.root / "lacon.deb")
            system.inside("apt-get", "-q", "-y", "install", "--no-install-recommends", "/lacon.deb")
            said = system.inside("bash", "-c", SMOKE)
            self.assertEqual(said.count("--- DIAGNOSTIC JOB : OK"), 2)
            system.inside("apt-get", "-q", "-y", "purge", "lacon")
            left = {path for path in set(system.inside("find", "/usr", "/etc").split()) - before if "lacon" in path}
            self.assertEqual(left, set())


if __name__ == "__main__":
    unittest.main()
