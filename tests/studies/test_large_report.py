"""`lacon report` of 200 000 cells: the page stays small, and is made and shown at once."""

import os
import resource
import subprocess
import unittest

import numpy as np
from study_test import LACON, SECONDS, StudyTest
from test_report import MODELS, NO_BROWSER, NO_PAGE, STUDY, Browser, Told

from meshes import block, union, write_med

CELLS = 200_000
LARGEST = 20e6  #: bytes of a page
PROCESSOR = 5.0  #: seconds of processor to make it
FIRST_VIEW = 2.0  #: seconds until its picture stands, on a machine with nothing else to do


@unittest.skipIf(NO_PAGE, NO_PAGE)
class LargeReport(StudyTest):
    def test_a_page_of_200_000_cells(self):
        across, up = 500, CELLS // 1000
        line = np.linspace
        lower = block("QUAD4", line(0, 2, across + 1), line(-1, 0, up + 1), name="LOWER", sides={"bottom": "BASE", "top": "GROUND"})
        upper = block("QUAD4", line(0, 2, across // 3 + 1), line(0, 1, up // 3 + 1), name="UPPER", sides={"bottom": "SOLE", "top": "TOP"})
        third = block("QUAD4", line(3, 5, across + 1), line(-1, 0, up + 1 - up // 9), name="ASIDE", sides={"bottom": "ASIDE_BASE", "top": "ASIDE_TOP"})
        write_med(self.folder / "mesh.med", union([lower, upper, third]))
        held = "_F(GROUP_MA=('BASE', 'ASIDE_BASE'),"
        (self.folder / "study.comm").write_text(STUDY.format(**MODELS[2]).replace("_F(GROUP_MA='BASE',", held).replace("NOMBRE=2", "NOMBRE=1"), encoding="utf-8")
        done = subprocess.run([LACON, "study.comm", "--unit", "20=mesh.med"], cwd=self.folder, capture_output=True, text=True, timeout=20 * SECONDS, check=False)
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr)

        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = self.run_tool("report", "study.base")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.assertEqual(done.returncode, 0, done.stderr)
        used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        page = self.folder / "study.html"
        told = Told(page)
        self.assertGreater(len(told.array(told.study["facet_cells"])), 0.98 * CELLS)
        size = page.stat().st_size
        print(f"{size / 1e6:.1f} MB, {used:.1f} s of processor")
        self.assertLess(size, LARGEST)
        self.assertLess(used, PROCESSOR)
        if NO_BROWSER:
            self.skipTest(NO_BROWSER)
        browser = Browser()
        self.addCleanup(browser.close)
        seconds = min(browser.do(open=page)["seconds"] for _ in range(3))
        load = max(1.0, os.getloadavg()[0] / os.cpu_count())
        print(f"first view {seconds:.1f} s, load {load:.1f} a processor")
        self.assertLess(seconds, FIRST_VIEW * load)


if __name__ == "__main__":
    unittest.main()
