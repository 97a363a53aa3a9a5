"""The checks of the peer's cases, read from checks.csv: what their command files pass to TEST_RESU, and how a run is judged."""

import csv
import os
import pathlib

CHECKS = pathlib.Path(os.environ["LACON_SHARED_CASES"]) / "checks.csv"


#: case -> (command files, mesh of unit 20) where they are not CASE.comm and CASE.mmed; ssnp170z has a mesh a unit
OTHERS = {
    **{case: (["ssnp170_orders.comm"], f"{case}.mmed") for case in ("ssnp170m", "ssnp170p", "ssnp170r", "ssnp170w")},
    **{case: (["ssnv104.comm"], f"{case}.mmed") for case in ("ssnv104k", "ssnv104n")},
    **{case: (["ssnp150.comm", "ssnp150.com1"], mesh) for case, mesh in (("ssnp150c", "ssnp150c.mmed"), ("ssnp150f", "ssnp150e.mmed"))},
    **{case: (["ssnp165.comm"], "ssnp165a.mmed") for case in ("ssnp165c", "ssnp165e")},
    **{f"ssnv219{case}": (["ssnv219.comm"], f"ssnv219{mesh}.mmed") for case, mesh in zip("egikl", "edddl")},
}


def files(case):
    """Command files and meshes by unit."""
    if case == "ssnp170z":
        return ["ssnp170z.comm"], {unit: f"ssnp170z.{unit}" for unit in range(20, 28)}
    comms, mesh = OTHERS.get(case, ([f"{case}.comm"], f"{case}.mmed"))
    return comms, {20: mesh}


def rows(case):
    """The rows of a case, in the order of its command file."""
    with open(CHECKS, newline="", encoding="utf-8") as file:
        return [row for row in csv.DictReader(file) if row["test"] == case]


def judged(row):
    """The keywords that all kinds of TEST commands share."""
    words = {"VALE_CALC": float(row["vale_calc"]), "CRITERE": row["crit"]}
    tolerance, _, magnitude = row["tole_machine"].partition("; OG=")
    if float(tolerance) != 1e-6:
        words["TOLE_MACHINE"] = float(tolerance)
    if magnitude:
        words["ORDRE_GRANDEUR"] = float(magnitude)
    if row["vale_refe"]:
        words.update(REFERENCE=row["kind"], VALE_REFE=float(row["vale_refe"]), PRECISION=float(row["precision"]))
    return words


def of_result(row):
    """The keywords of TEST_RESU/RESU but for RESULTAT."""
    words = {"INST": float(row["inst"]), "NOM_CHAM": row["field"], "NOM_CMP": row["component"], **judged(row)}
    if row["where"] in ("MIN", "MAX"):
        words["TYPE_TEST"] = row["where"]
    else:
        kind, name = row["where"].split()
        words[kind] = name
    return words


def number(row):
    """Which result of a case a row is about, from 0: "result #2" is 1, "result" 0."""
    return int(row["object"].partition("#")[2].split()[0] or 1) - 1 if "#" in row["object"] else 0
