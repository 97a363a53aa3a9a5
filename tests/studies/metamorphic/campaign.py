"""Runs contact studies as they were drawn and written otherwise, and compares all fields, tables and iterations.

    campaign.py FIRST [COUNT] [--ways NAME ...] [--keep FOLDER] [--json FILE]

Programs are those of LACON_BIN, without it of build/release. Differences above the promise are listed with the largest first; their inputs
and outputs are kept in FOLDER/NUMBER/WAY.
"""

import argparse
import json
import pathlib
import shutil
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from written import LACON, ORIGIN, WAYS, run, symmetric, ways  # noqa: E402, I001 (it says where results.py is)
import numpy as np  # noqa: E402
from results import Result  # noqa: E402

#: field -> (what its rows are, what they are measured in)
FIELDS = {"DEPL": ("vector", "length"), "SIEF_NOEU": ("tensor", "stress"), "SIEQ_NOEU": ("scalars", "stress"), "EPSI_NOEU": ("tensor", "number"),
          "EPSG_NOEU": ("tensor", "number"), "REAC_NODA": ("vector", "force"), "FORC_NODA": ("vector", "force"), "PRES_NOEU": ("scalars", "stress"),
          "VARI_NOEU": ("scalars", "number")}
CONTACT = {"CONT": "number", "JEU": "length", "PRES": "stress", "COEFSURF": "number"}
EQUAL = {"SIEQ_NOEU": ("VMIS", "TRESCA", "PRIN_1", "PRIN_2", "PRIN_3", "TRACE"), "PRES_NOEU": ("PRES",)}
RESULTS = {"RESU": tuple(FIELDS), "ROUND": ("DEPL", "SIEF_NOEU"), "USER": ("DEPL", "SIEF_NOEU"), "THERE": ("DEPL", "SIEF_NOEU")}


#: what may take other iterations to the same state: a factor of another STAT_NON_LINE does not serve; statuses of an instant's first iteration wait
#: where a whole zone would part, and half a zone parts sooner; iterations of PETSC are not exact; the control promises nothing (drawn study 0 takes 7 or 8
#: in its first instant by the points' last digits)
OWN_ITERATIONS = ("stages", "zones", "petsc", "ulp")
#: times what the last digits of the points change in a field: what another order of sums may change
ROUND_OFF = 100


def units(orders):
    """What one drawn unit of each is in the study as it is written."""
    scale, stiffness = orders["scale"], orders["stiffness"]
    across = 2 if orders["model"] in ("3D", "AXIS") else 1
    force = stiffness * scale ** across
    return {"length": scale, "stress": stiffness, "number": 1.0, "force": force, "vector": force, "moment": force * scale}


class Found:
    """A run's fields, turned back and in drawn units. .figures of run.run, .values: name -> array, with places in an order that numbers have no part in."""

    def __init__(self, written, folder):
        self.written, self.figures = written, run.run(written, LACON, folder)
        self.values, self.units = {}, units(written.orders)
        orders = written.orders
        self.turn, self.shift = np.asarray(orders["turn"]), np.asarray(orders["shift"])
        if self.figures["status"] != "finished":
            return
        for label in RESULTS:
            if label in ("RESU", "THERE") or orders["model"] != "AXIS":
                self.read(label, Result(folder / "study.base", label))
        for name, columns in json.loads((folder / "tables.json").read_text()).items():
            self.table(name, columns)

    def back(self, points):
        return (points - self.shift) @ self.turn / self.units["length"]

    def read(self, label, result):
        # bodies may touch: a place belongs to a body, and comes before others by a direction that no mesh has
        body = np.zeros(len(result.points))
        for k, name in enumerate(("TOOL", "SLAB", "IN_TOOL", "IN_SLAB")):
            for cell in result.groups.get(name, ()):
                body[result.cells[cell][1]] = k + 1
        places = self.back(result.points)
        key = places @ np.array([1.0, 0.7320508, 0.4142136])[:places.shape[1]] + 1e4 * body
        order = np.argsort(key)
        self.values[label, "places"] = {None: places[order]}
        rank = np.empty(len(order), int)
        rank[order] = np.arange(len(order))
        middles = {}
        for name in RESULTS[label]:
            found = {}
            for instant in result.orders:
                try:
                    support, values = result.field(name, instant)
                except Exception:  # a field that this instant does not have
                    continue
                rows = np.argsort(rank[support])
                found[instant] = self.turned_back(label, name, {c: v[rows] for c, v in values.items()})
                if name == "DEPL" and "LAGS_C" in values:
                    self.values.setdefault((label, "LAGS_C"), {})[instant] = np.nan_to_num(values["LAGS_C"][rows][:, None]) / self.units["stress"]
            if found:
                self.values[label, name] = found
        if label != "RESU":
            return
        for instant in result.orders:
            support, values = result.field("CONT_ELEM", instant)
            if not middles:
                middles = [self.back(result.points[result.cells[cell][1]].mean(axis=0)) for cell in support]
                rows = np.argsort(np.array(middles) @ np.array([1.0, 0.7320508, 0.4142136])[:places.shape[1]])
                self.values["RESU", "patches"] = {None: np.array(middles)[rows]}
            for name, unit in CONTACT.items():
                if name == "JEU":  # a patch without a master has none
                    values = {**values, name: np.where(values["CONT"] < 0, 0.0, values[name])}
                self.values.setdefault(("RESU", name), {})[instant] = np.nan_to_num(values[name][rows][:, None]) / self.units[unit]

    def turned_back(self, label, name, values):
        kind, unit = FIELDS[name]
        axes = "XYZ"[:len(self.shift)]
        if kind == "vector":
            rows = np.stack([values[c] for c in sorted(values) if c[-1] in axes and len(c) == 2], axis=1)
            if label in ("RESU", "THERE"):
                rows = rows @ self.turn
        elif kind == "tensor":
            rows = self.tensor(values, label in ("RESU", "THERE"))
        else:
            rows = np.stack([values[c] for c in values if c in EQUAL.get(name, values)], axis=1)
        return rows / self.units[unit]

    def tensor(self, values, turn=True):
        """Components XX YY ZZ XY ... turned back. Those out of the axes that another turn leaves in a sense may change it: cylindrical axes in a mirror."""
        prefix = next(iter(values))[:2]
        full = np.zeros((len(next(iter(values.values()))), 3, 3))
        for i, a in enumerate("XYZ"):
            for j, b in enumerate("XYZ"):
                column = values.get(prefix + min(a, b) + max(a, b))
                if column is not None:
                    full[:, i, j] = column
        if turn:
            q = np.eye(3)
            q[:len(self.turn), :len(self.turn)] = self.turn
            full = q.T @ full @ q
        return full[:, *np.triu_indices(3)]

    def table(self, name, columns):
        unit = self.units[name.split()[-1]]
        rows = np.array(list(columns.values())).T
        if name.endswith("vector"):
            rows = rows @ self.turn
        if name.endswith("moment"):
            rows = rows * np.linalg.det(self.turn)
            rows = rows @ self.turn if rows.shape[1] == 3 else rows
        self.values["table", name] = {None: rows / unit}


def senses(name, values):
    """Of cylindrical axes in a mirror the second one changes its sense: its components' sizes are compared."""
    return np.abs(values) if name in ("ROUND", "USER", "table") else values


#: result or table, field -> the field of RESU in whose largest value it is measured; others in their own
MEASURES = {"length": "DEPL", "stress": "SIEF_NOEU", "vector": "REAC_NODA", "moment": "REAC_NODA", "DEPL": "DEPL", "SIEF_NOEU": "SIEF_NOEU", "JEU": "DEPL",
            "FORC_NODA": "REAC_NODA", "REAC_NODA": "REAC_NODA", "SIEQ_NOEU": "SIEF_NOEU", "PRES_NOEU": "SIEF_NOEU"}


def largest_value(found, key):
    """By which differences of a field are divided: sums that vanish in a study have no size of their own."""
    word = key[1].split()[-1]
    own = found.values["RESU", MEASURES[word]] if word in MEASURES else found.values[key]
    largest = max((np.nanmax(np.abs(values), initial=0.0) for values in own.values()), default=0.0)
    return largest * (np.abs(found.values["RESU", "places"][None]).max() + ORIGIN if word == "moment" else 1.0) or 1.0


def differences(one, other):
    """{(result, field): largest difference over all instants, in the largest value of all}"""
    found = {}
    flipped = np.linalg.det(other.turn) < 0
    if set(one.values) != set(other.values):
        found["fields"] = 1.0
    for key in one.values.keys() & other.values.keys():
        mine, its = one.values[key], other.values[key]
        if mine.keys() != its.keys() or any(mine[k].shape != its[k].shape for k in mine):
            found[key] = float("inf")
            continue
        # statuses at the first instant of all are a guess for each zone: one that touches nowhere is closed as a whole
        pairs = [(mine[k], its[k]) for k in mine if key[1] != "CONT" or k > 0]
        if flipped:
            pairs = [tuple(senses(key[0], values) for values in pair) for pair in pairs]
        odd = any((np.isnan(a) != np.isnan(b)).any() for a, b in pairs)
        difference = max((np.nanmax(np.abs(a - b), initial=0.0) for a, b in pairs), default=0.0)
        found[key] = float("inf") if odd else difference / largest_value(one, key)
    return found


def iterations(figures):
    return figures["of steps"], figures["cuts"], figures["lost"]


def compare(number, names, folder):
    """(Found as drawn, [(Found otherwise, tolerance, differences)])"""
    one, others = ways(number, names)
    drawn = Found(one, make(folder, "drawn"))
    yield drawn, 0.0, {}
    if drawn.figures["status"] == "finished":
        for other, tolerance in others:
            found = Found(other, make(folder, other.name))
            yield found, tolerance, differences(drawn, found) if found.values and drawn.values else {}


def judge(drawn, found, tolerance, different, control):
    """What of a pair is not as promised, the largest first. @param control what the last digits of the points change (the way "ulp")"""
    figures, mine = found.figures, drawn.figures
    if figures["status"].split(":")[0] != mine["status"].split(":")[0]:
        return [figures["status"]]
    told = []
    if found.written.name not in OWN_ITERATIONS and iterations(figures) != iterations(mine):
        told.append(f"iterations {iterations(figures)}")
    apart = [(value, key) for key, value in different.items() if value > max(tolerance, ROUND_OFF * control.get(key, 0.0))]
    return told + [f"{value:.1e} {' '.join(key)}" for value, key in sorted(apart, reverse=True, key=lambda pair: pair[0])]


def make(folder, name):
    (folder / name).mkdir(parents=True, exist_ok=True)
    return folder / name


def half(number, folder):
    """[(field, largest difference)] of the half model of a study with a mirror and the whole, and the iterations of both; nothing without a mirror."""
    made = symmetric(number)
    if not made:
        return None
    whole, part = (Found(one, make(folder, name)) for name, one in zip(("whole", "half"), made))
    found = {}
    for label, name, places in (("RESU", "DEPL", "places"), ("RESU", "PRES", "patches"), ("RESU", "CONT", "patches"), ("RESU", "JEU", "patches")):
        if whole.figures["status"] != "finished" or part.figures["status"] != "finished":
            break
        own, all_places = part.values[label, places][None], whole.values[label, places][None]
        at = [int(np.argmin(abs(all_places - place).max(axis=1))) for place in own]
        if places == "places":  # bodies that touch have nodes of one place, which come in the same order
            at = np.flatnonzero(all_places[:, 0] > -1e-12)
        found[name] = max(abs(part.values[label, name][k] - whole.values[label, name][k][at]).max() for k in part.values[label, name]) / largest_value(whole, (label, name))
    return found, whole.figures, part.figures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("first", type=int)
    parser.add_argument("count", type=int, nargs="?", default=1)
    parser.add_argument("--ways", nargs="+", default=list(WAYS), choices=list(WAYS))
    parser.add_argument("--half", action="store_true", help="half models of those that have a mirror, against the whole")
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for what differs")
    parser.add_argument("--json", type=pathlib.Path, help="a file for the figures")
    asked = parser.parse_args()
    figures, pairs, apart = {}, 0, 0
    for number in range(asked.first, asked.first + asked.count):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_metamorphic_"))
        drawn = None
        if asked.half:
            if made := half(number, folder):
                print(number, *made[1:][0]["of steps"], *made[2]["of steps"], {name: f"{value:.1e}" for name, value in made[0].items()}, made[1]["status"][:40], made[2]["status"][:40], flush=True)
            shutil.rmtree(folder, ignore_errors=True)
            continue
        for found, tolerance, different in compare(number, asked.ways, folder):
            name = found.written.name
            if drawn is None:
                drawn, way, control = found, "drawn", {}
                print(f"{name}: {found.figures['status']}, {iterations(found.figures)}, {found.figures['seconds']} s", flush=True)
                if found.figures["status"] != "finished" and asked.keep:
                    shutil.copytree(folder / way, asked.keep / str(number) / way, dirs_exist_ok=True)
                continue
            if name == "ulp":
                control = different
            pairs += 1
            told = judge(drawn, found, tolerance, different, control)
            apart += bool(told)
            figures[f"{number} {name}"] = {" ".join(key): value for key, value in different.items()}
            largest = max(different.values(), default=0.0)
            print(f"    {number} {name:<9} {largest:.1e}  {'; '.join(told[:6])}", flush=True)
            if told and asked.keep:
                for way in ("drawn", name):
                    shutil.copytree(folder / way, asked.keep / str(number) / way, dirs_exist_ok=True)
        shutil.rmtree(folder, ignore_errors=True)
        if asked.json:
            asked.json.write_text(json.dumps(figures, indent=0))
    print(f"{asked.count} studies, {pairs} pairs, {apart} apart")
    return 1 if apart else 0


if __name__ == "__main__":
    sys.exit(main())
