"""The documentation becomes a site without a warning: no link that leads nowhere, no page left out."""

import os
import pathlib
import re
import subprocess
import unittest

SOURCE = pathlib.Path(os.environ["LACON_SOURCE_DIR"])


class Site(unittest.TestCase):
    def test_one_command_makes_it(self):
        done = subprocess.run([SOURCE / "commands/docs"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-3000:])
        site = SOURCE / "build/docs/html"
        for page in ("index", "tutorial", "tasks", "python", "reference/stat_non_line", "reference/messages"):
            self.assertTrue((site / f"{page}.html").is_file(), page)
        missing = [f"{page.name}: {picture}" for page in site.glob("*.html")
                   for picture in re.findall(r'<img[^>]* src="(?!data:)([^"]+)"', page.read_text(encoding="utf-8")) if not (page.parent / picture).exists()]
        self.assertEqual(missing, [])
        strange = {f"{page.name}: {link}" for page in site.glob("**/*.html") for link in re.findall(r'<a [^>]*href="(\w+:[^"]*)"', page.read_text(encoding="utf-8"))
                   if not link.startswith(("http:", "https:"))}
        self.assertEqual(strange, set())  # names of C++ between < and > are no links


if __name__ == "__main__":
    unittest.main()
