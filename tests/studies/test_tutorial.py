"""The tutorial does what it says: its commands, one after the other, in a shell."""

import os
import pathlib
import re
import subprocess
import unittest

from study_test import LACON, SECONDS, SOURCE, StudyTest

try:
    import matplotlib  # noqa: F401
    drawn = True
except ImportError:
    drawn = False

PAGE = SOURCE / "docs/tutorial.md"


class Tutorial(StudyTest):
    @unittest.skipUnless(drawn, "no matplotlib")
    def test_its_commands_run_and_print_what_it_shows(self):
        text = PAGE.read_text(encoding="utf-8")
        blocks = re.findall(r"^```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
        self.assertGreater(len(blocks), 4)
        environment = {**os.environ, "PATH": f"{pathlib.Path(LACON).parent}:/usr/bin:/bin", "PYTHONPATH": str(SOURCE / "commands")}
        done = subprocess.run(["bash", "-ec", "\n".join(blocks)], cwd=self.folder, capture_output=True, text=True, timeout=SECONDS, env=environment,
                              stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr)
        shown = re.search(r"force \d+ N, radius of contact [\d.]+ mm, largest pressure \d+ MPa", text)[0]
        self.assertIn(shown, done.stdout)
        self.assert_table(text, done.stdout.partition("--- DIAGNOSTIC")[0])
        self.assertEqual(done.stdout.count("--- DIAGNOSTIC JOB : OK"), 2)
        errors = [float(error) for error in re.findall(r"^OK .* error +(\S+)", done.stdout, re.MULTILINE)]
        told = [float(words) for words in re.search(r"falls from ([\d.]+) % to ([\d.]+) %", text).groups()]
        self.assertEqual([round(100 * error, 2) for error in errors], told)
        self.assertTrue((self.folder / "hertz/hertz_pressure.svg").exists())

    def assert_table(self, text, printed):
        """Its table is that of the last instant: as many iterations with the same marks and pivots, and the same contact; digits near round-off differ from machine
        to machine."""
        def rows(lines):
            return [re.sub(r" +", " ", re.sub(r"[\d.]+E[-+]\d+", "#", line)) for line in lines]

        of_page = [line.removeprefix("    ").split(" | ") for line in text.splitlines() if line.startswith("    | ")]
        of_run = [line.strip().split(" | ") for line in printed.rpartition("Instant de calcul")[2].splitlines() if re.match(r" *\| +\d+[X ] \|", line)]
        self.assertEqual(rows(" | ".join((*cells[:2], *cells[3:6], cells[6])) for cells in of_page),
                         rows(" | ".join((*cells[:2], *cells[4:8])) for cells in of_run))
        for words in ("Converged at the instant 1 with .*", r"SKIN on PLANE: .*", r"force on the slave .* on the master [^ ]+ [^ ]+ "):
            self.assertEqual(re.findall(words, text)[-1], re.findall(words, printed)[-1])


if __name__ == "__main__":
    unittest.main()
