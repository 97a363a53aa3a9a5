"""A round punch driven into a block that flows, at large strain, against Tabor's mean pressure."""

import json
import os
import pathlib
import shutil
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import SOURCE, StudyTest  # noqa: E402

TEMPLATE = SOURCE / "commands/studies/templates/indentation"
#: what is measured at each instant in place of the template's check at the last one
MEASURED = """
import json

found = []
for instant in RESULT.getAccessParameters()["INST"][1:]:
    SUM = POST_RELEVE_T(ACTION=_F(OPERATION="EXTRACTION", INTITULE="force", RESULTAT=RESULT, NOM_CHAM="REAC_NODA", INST=instant, GROUP_MA="TOP",
                                  RESULTANTE=("DX", "DY")))
    force = -2.0 * pi * SUM["DY", 1]  # in axisymmetry forces are those of one radian
    contact = RESULT.getField("CONT_ELEM", instant, "INST")
    points, nodes = CUT.getCoordinates().toNumpy(), CUT.getConnectivity()
    radius = max(float(points[nodes[cell], 0].max()) for cell, status in zip(contact.support, contact.component("CONT")[1]) if status == 1)
    found.append((instant * DEPTH, radius, force / (pi * radius**2) / YIELD))
with open("found.json", "w") as file:
    json.dump(found, file)
FIN()
"""
LAWS = ("PETIT", "GDEF_LOG", "SIMO_MIEHE")
TABOR = 2.8  # The Hardness of Metals, 1951: of a full indentation, times the yield stress


class Indentation(StudyTest):
    def figures(self, law):
        """@return (depth, radius of contact, mean pressure over yield stress) of each instant"""
        text = (TEMPLATE / "indentation.comm").read_text(encoding="utf-8")
        head = text.partition("# Tabor: once")[0].replace('RELATION="VMIS_ISOT_LINE"', f'RELATION="VMIS_ISOT_LINE", DEFORMATION="{law}"')
        shutil.copy(TEMPLATE / "mesh.py", self.folder)
        (self.folder / "indentation.comm").write_text(head + MEASURED, encoding="utf-8")
        run = self.run_study(self.folder / "indentation.comm", "--fresh", PYTHONPATH=SOURCE / "commands/studies")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        return json.loads((self.folder / "found.json").read_text())

    def test_the_mean_pressure_of_a_full_indentation_is_tabors(self):
        """Of a block that deforms by large strains. The radius is known to a patch, 0.1 of 1.1: 10 % of the pressure either way."""
        for law in LAWS[1:]:
            with self.subTest(law):
                self.assertAlmostEqual(self.figures(law)[-1][2], TABOR, delta=0.1 * TABOR)


if __name__ == "__main__":
    unittest.main()
