# Stands in for an operator: reads its order, writes a small concept. The environment's STAND_IN says how it misbehaves:
# {"crea_maillage": {"status": 2, "messages": [...], "kill": 9, "launcher": 9, "half": true, "lazy": true, "print": "NAME"}}
import json
import os
import pathlib
import sys

import h5py
import numpy as np

order = json.loads(pathlib.Path(sys.argv[1]).read_text())
program = pathlib.Path(sys.argv[0]).name
behaviour = json.loads(os.environ.get("STAND_IN", "{}")).get(program, {})
base = pathlib.Path(order["base"])
result = order.get("result")
text = h5py.string_dtype()


def ids(value):
    if isinstance(value, dict):
        if set(value) == {"concept"}:
            return [value["concept"]]
        value = list(value.values())
    return [i for item in value for i in ids(item)] if isinstance(value, list) else []


def ragged(group, rows):
    group["offset"] = np.cumsum([0] + [len(r) for r in rows])
    group["values"] = np.array(sum(rows, []), np.int32)


def fill_mesh(file):
    """Two QUAD4 side by side over a SEG2 skin: nodes 1 2 3 / 4 5 6, cells M1 and M2, skin M3."""
    file["coordinates"] = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]], float)
    file.attrs["dimension"] = 2
    cells = file.create_group("cells")
    cells.attrs.create("types", ["QUAD4", "SEG2"], dtype=text)
    cells["type"] = np.array([0, 0, 1], np.int8)
    cells["offset"] = np.array([0, 4, 8, 10])
    cells["nodes"] = np.array([0, 1, 4, 3, 1, 2, 5, 4, 0, 1], np.int32)
    for kind, groups in (("cells", {"SKIN": [2], "BODY": [0, 1]}), ("nodes", {"ONE": [3], "TOP": [3, 4, 5]})):
        group = file.create_group(f"groups/{kind}")
        group["name"] = np.array(list(groups), text)
        ragged(group, list(groups.values()))


def fill_field(name, order_number, instant, location, components, support, values, offset=None, present=None):
    path = base / result["id"] / f"{name}_{order_number}.h5"
    path.parent.mkdir(exist_ok=True)
    with h5py.File(path, "w") as file:
        for key, value in {"lacon_type": "field", "format": 1, "name": name, "quantity": f"{name}_R", "location": location, "mesh": mesh_of_model(),
                           "order": order_number, "instant": instant}.items():
            file.attrs[key] = value
        file.attrs.create("components", components, dtype=text)
        file["support"] = np.array(support, np.int32)
        file["values"] = np.array(values, float)
        if offset:
            file["offset"] = np.array(offset)
        if present:
            file["present"] = np.array(present, np.uint8)
    return f"{result['id']}/{path.name}"


def mesh_of_model():
    with h5py.File(base / f"{order['keywords']['MODELE']['concept']}.h5") as file:
        return file.attrs["mesh"]


def fill_result(file):
    """Instants 0, 0.5, 1. DEPL: DX = instant x node number, LAGS_C on N2 and N5 only. CONT_ELEM on M3. SIEF_ELGA, SIEF_ELNO on M1, M2.
    STAND_IN: JEU = -1, 0.25, 0.5, the first of which stands in for no gap."""
    file["order"] = np.arange(3)
    file["instant"] = np.array([0.0, 0.5, 1.0])
    file["parameters/newton_iterations"] = np.array([0, 2, 3])
    file.attrs["mesh"] = mesh_of_model()
    file.attrs["model"] = order["keywords"]["MODELE"]["concept"]
    file.attrs["material_field"] = order["keywords"].get("CHAM_MATER", {}).get("concept", "")
    names = {}
    for k, t in enumerate((0.0, 0.5, 1.0)):
        nodes = range(6)
        names.setdefault("DEPL", []).append(fill_field(
            "DEPL", k, t, "NOEU", ["DX", "LAGS_C"], nodes, [[t * (n + 1), -25 * t if n in (1, 4) else 0] for n in nodes],
            present=[[1, n in (1, 4)] for n in nodes]))
        names.setdefault("CONT_ELEM", []).append(fill_field("CONT_ELEM", k, t, "ELEM", ["PRES", "JEU"], [2], [[-25 * t, 1e-9]]))
        names.setdefault("SIEF_ELGA", []).append(fill_field(
            "SIEF_ELGA", k, t, "ELGA", ["SIYY"], [0, 1], [[1], [-2], [3], [-4]], offset=[0, 2, 4]))
        names.setdefault("SIEF_ELNO", []).append(fill_field(
            "SIEF_ELNO", k, t, "ELNO", ["SIYY"], [0, 1], [[i] for i in range(1, 9)], offset=[0, 4, 8]))
        names.setdefault("STAND_IN", []).append(fill_field(
            "STAND_IN", k, t, "ELEM", ["JEU"], [0, 1, 2], [[-1], [0.25], [0.5]], present=[[2], [1], [1]]))
        names.setdefault("BAD", []).append(fill_field("BAD", k, t, "NOEU", ["X"], [0], [[float("nan")]]))
    for name, files in names.items():
        group = file.create_group(f"fields/{name}")
        group["order"] = np.arange(3)
        group["file"] = np.array(files, text)


def write(path):
    path.parent.mkdir(exist_ok=True)
    partial = path.with_name(path.name + ".partial")
    kind = result["id"].rpartition("_")[0]
    version = 1
    if result["reuse"]:
        with h5py.File(path) as file:
            version = int(file.attrs["version"]) + 1
        if kind == "result":
            partial.write_bytes(path.read_bytes())
    with h5py.File(partial, "a" if kind == "result" and result["reuse"] else "w") as file:
        for key, value in {"lacon_type": kind, "format": 1, "version": version, "id": result["id"], "label": result["label"],
                           "command": order["command"], "keywords": json.dumps(order["keywords"])}.items():
            file.attrs[key] = value
        if not result["reuse"] or kind == "mesh":
            file.attrs["references"] = json.dumps([] if kind == "mesh" else ids(order["keywords"]))
        if kind == "mesh":
            fill_mesh(file)
        elif kind == "model":
            file.attrs["mesh"] = order["keywords"]["MAILLAGE"]["concept"]
        elif kind == "result" and not result["reuse"]:
            fill_result(file)
    if not behaviour.get("half"):
        os.replace(partial, path)


def main():
    print(f"{program} at work")
    if "print" in behaviour:
        print(behaviour["print"], os.environ[behaviour["print"]])
    if result and not behaviour.get("lazy") and "--check" not in sys.argv:
        write(base / result["id"] / "index.h5" if result["id"].startswith("result") else base / f"{result['id']}.h5")
    if "unit" in behaviour:
        pathlib.Path(order["units"][behaviour["unit"]]).write_text("written\n")
    if behaviour.get("launcher"):
        os.kill(int(os.environ["LACON_LAUNCHER"]), behaviour["launcher"])
    if behaviour.get("kill"):
        sys.stdout.flush()
        os.kill(os.getpid(), behaviour["kill"])
    for m in behaviour.get("messages", []):
        where = f"{order['command']}, {order['source']}"
        print(f"<{m['severity']}> <{m['id']}> {m['text']}\n    where: {where}\n    do:    {m.get('do', '')}", file=sys.stderr)
    status = behaviour.get("status", 0)
    pathlib.Path(sys.argv[sys.argv.index("--status") + 1]).write_text(json.dumps(
        {"status": status, "messages": behaviour.get("messages", []), "seconds": {"work": 0.001}, "counts": {"factorisations": 3}, "log_lost": behaviour.get("log_lost", False)}))
    return status


sys.exit(main())
