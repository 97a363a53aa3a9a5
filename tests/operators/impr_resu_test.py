"""What tests of IMPR_RESU share: a small mesh, a result on it with fields of all kinds, orders."""

import xml.etree.ElementTree

import numpy as np

from lacon_test import OperatorTest, concept

# Two quadrangles side by side on the skin cell M1 (slave) and M2; cells of the two types interleave.
POINTS = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]
MESH_CELLS = [("SEG2", [0, 1]), ("QUAD4", [0, 1, 4, 3]), ("SEG2", [1, 2]), ("QUAD4", [1, 2, 5, 4])]
CELL_GROUPS = {"SLAVE": [0], "BODY": [1, 3], "LEFT_BODY": [1]}
NODE_GROUPS = {"BOTTOM": [0, 1, 2], "CORNER <&>": [5]}
INSTANTS = [0.0, 0.5, 1.0]
POINTS_PER_CELL = 4


def displacement(order):
    """DEPL with LAGS_C on the nodes 0 and 1 only."""
    values = np.array([[0.1 * n + order, -0.2 * n, -25.0 * (n + 1) * (n < 2)] for n in range(6)])
    present = np.ones((6, 3), int)
    present[2:, 2] = 0
    return {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX", "DY", "LAGS_C"], "support": range(6), "values": values,
            "present": present}


def contact(order):
    return {"quantity": "CLAC_R", "location": "ELEM", "components": ["CONT", "PRES"], "support": [0], "values": [[1.0, -25.0 * order]]}


def stress_at_points(order):
    return {"quantity": "SIEF_R", "location": "ELGA", "components": ["SIXX", "SIYY"], "support": [1, 3],
            "offset": [0, POINTS_PER_CELL, 2 * POINTS_PER_CELL], "values": np.arange(16.0) + 100 * order}


def stress_at_cell_nodes(order):
    return {"quantity": "SIEF_R", "location": "ELNO", "components": ["SIXX"], "support": [3], "offset": [0, 4],
            "values": [1.0, 2.0, 3.0, 4.0]}


class ImprResuTest(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", POINTS, MESH_CELLS, CELL_GROUPS, NODE_GROUPS, label="MA")
        self.write_result("result_2", "mesh_1", INSTANTS, {
            "DEPL": {k: displacement(k) for k in range(3)}, "CONT_ELEM": {k: contact(k) for k in (1, 2)},
            "SIEF_ELGA": {k: stress_at_points(k) for k in range(3)}, "SIEF_ELNO": {2: stress_at_cell_nodes(2)}}, label="U")
        self.file = self.folder / "out.med"

    def print(self, resu, form="MED", append=False, **more):
        return self.run_order("impr_resu", self.order(resu, form, append, **more))

    def order(self, resu, form="MED", append=False, **more):
        defaults = {"PRECISION": 1e-6, "CRITERE": "RELATIF", "INFO_MAILLAGE": "NON", "IMPR_COOR": "NON", "IMPR_NOM_VARI": "OUI"}
        resu = resu if isinstance(resu, list) else [resu]
        return {"format": 1, "command": "IMPR_RESU", "base": str(self.base), "units": {"80": str(self.file)},
                "append": ["80"] if append else [], "source": "study.comm:9",
                "keywords": {"FORMAT": form, "UNITE": 80, "PROC0": "OUI", "INFO": 1, "RESU": [{**defaults, **one} for one in resu], **more}}

    def refuses(self, identifier, resu, *words, form="MED", append=False):
        before = self.snapshot()
        self.assert_refused(self.print(resu, form, append), identifier, *words)
        self.assertEqual(self.snapshot(), before)

    U = {"RESULTAT": concept("result_2")}
    MA = {"MAILLAGE": concept("mesh_1")}

    def collection(self):
        """[(time, name, file)] of the .pvd."""
        root = xml.etree.ElementTree.parse(self.file.with_suffix(".pvd")).getroot()
        self.assertEqual((root.tag, root.get("type")), ("VTKFile", "Collection"))
        return [(float(d.get("timestep")), d.get("name"), self.folder / d.get("file")) for d in root.iter("DataSet")]
