"""The study of ./commands/demo: a roller that nothing but contact holds between two rings, against Hertz' theory."""

import subprocess
import sys
import unittest

from study_test import SOURCE, StudyTest

STUDY = SOURCE / "commands/studies/roller_bearing"
sys.path.insert(0, str(STUDY))

from results import Result  # noqa: E402 (study_test says where it is)
from geometry import STEPS, hertz  # noqa: E402
from report import ZONES, Zone  # noqa: E402


class RollerBearing(StudyTest):
    def python(self, script, *arguments):
        done = subprocess.run([sys.executable, "-B", STUDY / script, *arguments], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_pressures_are_those_of_hertz(self):
        self.python("mesh.py", "mesh.med")
        run = self.run_study(STUDY / "roller_bearing.comm", "--unit", "20=mesh.med", "--unit", "80=out.med", "--unit", "81=out.vtu")
        self.assertEqual((run.status, run.diagnostic), (0, "--- DIAGNOSTIC JOB : OK"), run.stderr[-3000:])
        result = Result(self.folder / "roller_bearing.base", "RESU")
        self.assertEqual(len(result.orders), STEPS + 1, "no step was cut")
        active = {group: [] for group in ZONES}
        for order in result.orders[1:]:
            forces = []
            for group, (_, curvature) in ZONES.items():
                zone = Zone(result, group)
                pressure = zone.pressure(order)
                self.assertGreaterEqual(pressure.min(), 0.0, "contact does not pull")
                forces.append(float(pressure @ zone.width))
                half, largest = hertz(forces[-1], curvature)
                # theory is of half-planes: differences are of the order of half-width / radius, here up to 9 %, squared
                self.assertAlmostEqual(pressure.max() / largest, 1.0, delta=0.015)
                # the edge of the contact is known to a patch at either end
                self.assertAlmostEqual(zone.width[zone.active(order)].sum() / 2, half, delta=zone.width[zone.active(order)].max())
                active[group].append(int(zone.active(order).sum()))
            # the roller hands on what it gets; skins turn by up to 3 degrees, which the force from initial lengths leaves out
            self.assertAlmostEqual(forces[0] / forces[1], 1.0, delta=2e-3)
        for group, counts in active.items():
            self.assertEqual(counts, sorted(counts), group)
            self.assertGreater(counts[-1], 2 * counts[0], f"the contact {group} grows")
        conforms = subprocess.run(["medconforme", self.folder / "out.med"], capture_output=True, text=True)
        self.assertEqual(conforms.returncode, 0, conforms.stdout)
        shown = self.python("report.py", self.folder / "roller_bearing.base", "roller")
        self.assertEqual(sum(line.startswith("    1.000 ") for line in shown.splitlines()), len(ZONES))
        self.assertGreater((self.folder / "roller.png").stat().st_size, 50_000)


if __name__ == "__main__":
    unittest.main()
