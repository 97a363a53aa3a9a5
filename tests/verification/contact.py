"""Contact studies of generated meshes: one run of contact.comm for a list of them."""

import json
import pathlib

import numpy as np

from meshes import write_med
from results import Result

COMM = pathlib.Path(__file__).resolve().parent / "contact.comm"


def contact_study(mesh, hold, push=(), slaves=("SLAVE",), masters=("MASTER",), model="3D", **more):
    """@param mesh a meshes.Mesh or the path of a MED file; hold, push lists of occurrences of MECA_IMPO and PRES_REP, multiplied by the
    instant; more: elastic (E, NU), other (E or NU of the groups `others`), times, cut (option of DECOUPE_HEXA), smooth (LISSAGE), orient (groups for
    ORIE_PEAU), varying (group -> pressure as an expression of X, Y), zone (keywords of every ZONE), convergence"""
    zone = more.pop("zone", {})
    study = {"mesh": mesh, "model": model, "hold": list(hold), "push": list(push),
             "zones": [{"GROUP_MA_ESCL": slave, "GROUP_MA_MAIT": master, **zone} for slave, master in zip(slaves, masters)],
             "elastic": {"E": 2000.0, "NU": 0.3}, "other": {}, "others": [], "times": [0.0, 1.0], "smooth": "NON", "orient": [], "varying": {},
             "convergence": {"RESI_GLOB_RELA": 1e-12, "ITER_GLOB_MAXI": 20}, **more}
    study["cut"] = {"GROUP_MA_ESCL": list(slaves), "DECOUPE_HEXA": more.get("cut", "PYRA")}
    return study


def run_contact(test, studies, **environment):
    """One run of the launcher. @param test a StudyTest @param environment CONTACT_ALARMS="ALARME": alarms do not end it
    @return (run, result of each study)"""
    units, orders = [], []
    for k, one in enumerate(studies):
        path = one["mesh"]
        if not isinstance(path, pathlib.Path):
            path = test.folder / f"{k}.med"
            write_med(path, one["mesh"])
        units += ["--unit", f"{20 + k}={path}"]
        orders.append({name: value for name, value in one.items() if name != "mesh"})
    orders_file = test.folder / "studies.json"
    orders_file.write_text(json.dumps(orders))
    run = test.run_study(COMM, "--fresh", *units, CONTACT_STUDIES=str(orders_file), **environment)
    test.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
    return run, [Result(test.folder / f"{COMM.stem}.base", f"RESU[{k}]") for k in range(len(studies))]


def normal_force(result):
    """The sum of the normal forces of the contact on all slave cells at the last instant, of cells with straight edges."""
    over_whole = result.on_cells("CONT_ELEM", result.orders[-1], "PRESCOOR")
    force = 0.0
    for patch in result.patches:
        for cell in patch:
            kind, nodes = result.cells[cell]
            n = {"SEG": 2, "TRI": 3}.get(kind[:3], 4)
            corners = np.array([result.points[node] for node in nodes[:n]])
            size = np.linalg.norm(corners[1] - corners[0]) if n == 2 else np.linalg.norm(np.cross(corners[2] - corners[0], corners[-1] - corners[1])) / 2
            force -= over_whole[cell] * size
    return force
