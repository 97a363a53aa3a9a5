"""DEFI_LIST_REEL and DEFI_LIST_INST."""


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
        count = round(exact)
        if count < 1 or abs(exact - count) > 1e-3:
            call.fail("DEFI_LIST_2", f"{path}/PAS", step=f"{interval['PAS']:g}", start=f"{start:g}", end=f"{end:g}")
    step = (end - start) / count
    return [start + i * step for i in range(1, count)] + [end]


def defi_list_inst(call):
    k = call.keywords
    definition, failure = k["DEFI_LIST"][0], k["ECHEC"][0]
    if "LIST_INST" in definition:
        values = definition["LIST_INST"].getValues()
        path = "DEFI_LIST/LIST_INST"
    else:
        values = definition["VALE"]
        path = "DEFI_LIST/VALE"
        _increasing(call, values, path)
    if len(values) < 2:
        call.fail("DEFI_LIST_3", path)
    if k["METHODE"] == "AUTO":
        call.study.inform("DEFI_LIST_4", f"DEFI_LIST_INST/METHODE, {call.where}")

    def fill(file):
        file.create_dataset("values", data=values, dtype="f8")
        file.attrs["cut"] = int(failure["ACTION"] == "DECOUPE")
        file.attrs["cut_into"] = failure["SUBD_PAS"]
        file.attrs["cut_levels"] = failure["SUBD_NIVEAU"]
        file.attrs["smallest"] = failure["SUBD_PAS_MINI"]

    return call.write("time_steps", fill)
