"""DEFI_LIST_REEL, DEFI_LIST_ENTI and DEFI_LIST_INST."""

import json
import math

from ..core.catalog import part


most = 10_000_000  #: values of a list: those of more are a slip of the pen, and would take the machine's memory


def _few_enough(call, count, path):
    if count > most:
        call.fail("DEFI_LIST_6", path, count=f"{count:g}", most=most)


def _increasing(call, values, path):
    for a, b in zip(values, values[1:]):
        if not a < b:
            call.fail("DEFI_LIST_1", path, first=f"{a:g}", second=f"{b:g}")


def defi_list_reel(call):
    k = call.keywords
    if "VALE" in k:
        values = list(k["VALE"])
        _increasing(call, values, "VALE")
    else:
        values = [k["DEBUT"]]
        for i, interval in enumerate(k["INTERVALLE"], 1):
            values += _interval(call, values[-1], interval, f"INTERVALLE[{i}]")
    return call.write("list_of_reals", lambda file: file.create_dataset("values", data=values, dtype="f8"))


def _interval(call, start, interval, path):
    """Values after `start` up to JUSQU_A; the last one is JUSQU_A to the bit."""
    end = interval["JUSQU_A"]
    if not end > start:
        call.fail("DEFI_LIST_1", f"{path}/JUSQU_A", first=f"{start:g}", second=f"{end:g}")
    if "NOMBRE" in interval:
        count = interval["NOMBRE"]
    else:
        exact = (end - start) / interval["PAS"]
        _few_enough(call, exact, f"{path}/PAS")
        count = round(exact)
        if count < 1 or abs(exact - count) > 1e-3:
            call.fail("DEFI_LIST_2", f"{path}/PAS", step=f"{interval['PAS']:g}", start=f"{start:g}", end=f"{end:g}")
    _few_enough(call, count, path)
    step = (end - start) / count
    values = [start + i * step for i in range(1, count)] + [end]
    _increasing(call, [start, *values], path)  # where steps are too small for their place
    return values


def defi_list_enti(call):
    k = call.keywords
    values = list(k["VALE"]) if "VALE" in k else [k["DEBUT"]]
    for i, interval in enumerate(k.get("INTERVALLE", ()), 1):
        start, end, path = values[-1], interval["JUSQU_A"], f"INTERVALLE[{i}]"
        if not end > start:
            call.fail("DEFI_LIST_1", f"{path}/JUSQU_A", first=start, second=end)
        step = interval.get("PAS") or (end - start) // interval["NOMBRE"]
        if step == 0 or (end - start) % step or (end - start) // step != interval.get("NOMBRE", (end - start) // step):
            call.fail("DEFI_LIST_2", path, step=step or part("share_of_interval", count=interval["NOMBRE"]), start=start, end=end)
        _few_enough(call, (end - start) // step, path)
        values += range(start + step, end + 1, step)
    return call.write("list_of_integers", lambda file: file.create_dataset("values", data=values, dtype="i8"))


def defi_list_inst(call):
    k = call.keywords
    definition = k["DEFI_LIST"][0]
    if "LIST_INST" in definition:
        values = definition["LIST_INST"].getValues()
        path = "DEFI_LIST/LIST_INST"
    else:
        values = definition["VALE"]
        path = "DEFI_LIST/VALE"
        _increasing(call, values, path)
    if len(values) < 2:
        call.fail("DEFI_LIST_3", path)
    if k["METHODE"] == "AUTO" and definition["PAS_MINI"] > definition.get("PAS_MAXI", math.inf):
        call.fail("DEFI_LIST_7", "DEFI_LIST/PAS_MINI", shortest=definition["PAS_MINI"], longest=definition["PAS_MAXI"])
    failures = {}
    for i, factor in enumerate(k["ECHEC"], 1):
        if factor["EVENEMENT"] in failures:
            call.fail("DEFI_LIST_4", f"ECHEC[{i}]/EVENEMENT", event=factor["EVENEMENT"])
        if factor["ACTION"] == "ITER_SUPPL" and factor["EVENEMENT"] != "ERREUR":
            call.fail("DEFI_LIST_5", f"ECHEC[{i}]/ACTION", event=factor["EVENEMENT"])
        failures[factor["EVENEMENT"]] = factor
    solution = failures.pop("ERREUR", {"ACTION": "DECOUPE", "SUBD_PAS": 4, "SUBD_NIVEAU": 3, "SUBD_PAS_MINI": 0.0})

    def fill(file):
        file.create_dataset("values", data=values, dtype="f8")
        for name, value in _action(solution).items():
            file.attrs[name] = int(value) if name != "smallest" else value
        file.attrs["more_iterations"] = solution.get("PCENT_ITER_PLUS", 0)
        if failures:
            file.attrs["events"] = json.dumps([{"event": event, **_limit(factor), **_action(factor)} for event, factor in failures.items()])
        if k["METHODE"] == "AUTO":
            file.attrs["adaptation"] = json.dumps(_adaptation(definition, k["ADAPTATION"][0]))

    return call.write("time_steps", fill)


def _action(factor):
    """What is done with a step that fails: docs/structures.md, time_steps."""
    return {"cut": factor["ACTION"] != "ARRET", "cut_into": factor["SUBD_PAS"], "cut_levels": factor["SUBD_NIVEAU"],
            "smallest": factor["SUBD_PAS_MINI"]}


def _limit(factor):
    """What an event compares, and where it looks."""
    if factor["EVENEMENT"] in ("RESI_MAXI", "DIVE_RESI"):
        return {"limit": factor.get("RESI_GLOB_MAXI", 0.0), "place": {}}
    place = {name: factor[name] for name in ("NOM_CHAM", "NOEUD", "GROUP_NO", "MAILLE", "GROUP_MA") if name in factor}
    return {"limit": factor["VALE_REF"], "place": {**place, "NOM_CMP": [factor["NOM_CMP"]], "EVAL_CHAM": "VALE", "EVAL_CMP": "VALE",
                                                   "EVAL_ELGA": "EACH"}}


def _adaptation(definition, factor):
    return {"event": factor["EVENEMENT"], "easy_steps": factor["NB_INCR_SEUIL"],
            "easy_iterations": factor["VALE_I"] - (factor["CRIT_COMP"] == "LT"), "rule": factor["MODE_CALCUL_TPLUS"],
            "percent": factor["PCENT_AUGM"], "reference": factor["NB_ITER_NEWTON_REF"], "smallest": definition["PAS_MINI"],
            "largest": definition.get("PAS_MAXI", 0.0), "most": definition["NB_PAS_MAXI"]}
