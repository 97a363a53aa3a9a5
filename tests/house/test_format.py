"""C++ is formatted as .clang-format says."""

import re
import shutil
import subprocess
import unittest

from test_house import FLOORS, SOURCE

#: the version of Debian 12: others break some lines elsewhere
VERSION = 14


def program():
    """clang-format of that version, or None."""
    for name in (f"clang-format-{VERSION}", "clang-format"):
        path = shutil.which(name)
        if path and re.search(rf"version {VERSION}\.", subprocess.run([path, "--version"], capture_output=True, text=True, check=True).stdout):
            return path
    return None


class Format(unittest.TestCase):
    @unittest.skipUnless(program(), f"no clang-format {VERSION}")
    def test_every_cpp_file_is_formatted(self):
        files = sorted(str(path.relative_to(SOURCE)) for room in (*FLOORS, "tests") for path in (SOURCE / room).rglob("*")
                       if path.suffix in (".cpp", ".hpp", ".h"))
        self.assertGreater(len(files), 100)
        said = subprocess.run([program(), "--dry-run", "--Werror", *files], cwd=SOURCE, capture_output=True, text=True, check=False)
        wrong = sorted(set(re.findall(r"^(\S+?):\d+:\d+: error:", said.stderr, re.MULTILINE)))
        self.assertFalse(wrong, f"to be formatted:\n    clang-format -i {' '.join(wrong)}")
        self.assertEqual(said.returncode, 0, said.stderr)


if __name__ == "__main__":
    unittest.main()
