"""What tests of operators share: a base made by hand with h5py, an order with every default of the catalogue, a run of the
executable, and a look at what it left. Nothing here uses Lacon's own Python or C++: layouts are those of docs/structures.md.

    class Test(OperatorTest):
        def test_something(self):
            self.write_mesh("mesh_1", coordinates, [("QUAD4", [0, 1, 2, 3])], cell_groups={"BODY": [0]})
            run = self.run_command("CREA_MAILLAGE", {"MAILLAGE": concept("mesh_1"), ...}, result="mesh_2")
            self.assertEqual(run.status, 0, run.stderr)
            mesh = self.read_mesh("mesh_2")
"""

import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import types
import unittest

import h5py
import numpy as np

BIN = pathlib.Path(os.environ.get("LACON_BIN", "build/release/bin")).resolve()
SHARED_CASES = pathlib.Path(os.environ.get("LACON_SHARED_CASES", "../shared/cases")).resolve()
CATALOG = json.loads(
    pathlib.Path(os.environ.get("LACON_CATALOG", "build/release/generated/catalog.json")).read_text(encoding="utf-8"))
CELLS = {row["name"]: row for row in CATALOG["cells"]}
CELL_TYPES = list(CELLS)
SECONDS = 60 * int(os.environ.get("LACON_PATIENCE", "1"))  # no operator on a test's mesh takes longer


def concept(identifier):
    """A keyword's value that is a concept."""
    return {"concept": identifier}


def complete(rows, given):
    """Keywords with the defaults of the catalogue filled in. @param rows entry of a command or of a factor keyword"""
    keywords = {}
    for name, row in rows.get("keyword", {}).items():
        if row["type"] == "factor":
            occurrences = given.get(name, [{}] if row.get("default") == {} else None)
            if occurrences is not None:
                occurrences = occurrences if isinstance(occurrences, list) else [occurrences]
                keywords[name] = [complete(row, one) for one in occurrences]
        elif name in given:
            value = given[name]
            keywords[name] = [value] if row.get("max", 1) != 1 and not isinstance(value, list) else value
        elif "default" in row:
            keywords[name] = row["default"]
    for when in rows.get("when", []):
        if (all(keywords.get(k) in values for k, values in when.get("if", {}).items())
                and all(k in given for k in when.get("present", [])) and not any(k in given for k in when.get("absent", []))):
            for name, value in when.get("default", {}).items():
                keywords.setdefault(name, value)
    for name in given:  # what the catalogue does not know goes into the order all the same: it is the operator that refuses it
        keywords.setdefault(name, given[name])
    return keywords


def fill_field(file, components, support, values, offset=None, present=None):
    """What the file of a field holds beside its head, docs/structures.md."""
    file.attrs["components"] = np.array(components, h5py.string_dtype())
    file["support"] = np.array(support, np.int32)
    file["values"] = np.asarray(values, float).reshape(-1, len(components))
    if offset is not None:
        file["offset"] = np.array(offset, np.int64)
    if present is not None:
        file["present"] = np.array(present, np.uint8).reshape(-1, len(components))


class OperatorTest(unittest.TestCase):
    """A test with an empty folder and an empty base in it."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_test_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.base = self.folder / "study.base"
        self.base.mkdir()

    # ------------------------------------------------------------------------------------------ running

    def run_command(self, command, keywords, result=None, reuse=False, units=None, label=None, environment=None, plugins=None):
        """Write the complete order of a command and run its operator.
        @return .status, .stdout, .stderr, .messages (list of {"severity", "id", "text", "do"}), .order (path)"""
        row = CATALOG["commands"][command]
        order = {"format": 1, "command": command, "base": str(self.base), "source": "study.comm:1",
                 "units": {str(unit): str(path) for unit, path in (units or {}).items()},
                 "keywords": complete(row, keywords)}
        if result:
            order["result"] = {"id": result, "label": label or result.upper(), "reuse": reuse}
        if plugins:
            order["plugins"] = [str(path) for path in plugins]
        return self.run_order(row["operator"], order, environment)

    def run_order(self, operator, order, environment=None, options=()):
        """Run an operator on an order (a dictionary, or text as it is)."""
        path = self.folder / "order.json"
        path.write_text(order if isinstance(order, str) else json.dumps(order, indent=1), encoding="utf-8")
        status = self.folder / "status.json"
        status.unlink(missing_ok=True)
        done = subprocess.run([BIN / operator, path, "--status", status, *options], capture_output=True, text=True, timeout=SECONDS,
                              stdin=subprocess.DEVNULL, env={**os.environ, **(environment or {})})
        self.assertTrue(status.exists(), f"{operator} wrote no status, exit {done.returncode}\n{done.stderr}")
        outcome = json.loads(status.read_text(encoding="utf-8"))
        self.assertEqual(outcome["status"], done.returncode)
        return types.SimpleNamespace(status=done.returncode, stdout=done.stdout, stderr=done.stderr,
                                     messages=outcome["messages"], seconds=outcome["seconds"], counts=outcome["counts"], blas=outcome.get("blas"),
                                     order=path)

    def snapshot(self):
        """Every file of the test's folder but the order and the status, with a digest of its content."""
        return {str(path.relative_to(self.folder)): hashlib.sha256(path.read_bytes()).hexdigest()
                for path in sorted(self.folder.rglob("*")) if path.is_file() and path.name not in ("order.json", "status.json")}

    def assert_refused(self, run, identifier, *words, status=2):
        """The run ended with this status and this message, whose text has these words."""
        errors = [m for m in run.messages if m["severity"] in "FS"]
        self.assertEqual((run.status, [m["id"] for m in errors]), (status, [identifier]), run.stderr)
        for word in words:
            self.assertIn(word, errors[0]["text"])
        self.assertIn(f"<{identifier}>", run.stderr)

    def assert_refuses(self, identifier, command, keywords, *words, status=2, **more):
        """The command is refused with this message, and leaves every file as it was."""
        before = self.snapshot()
        run = self.run_command(command, keywords, **more)
        self.assert_refused(run, identifier, *words, status=status)
        self.assertEqual(self.snapshot(), before)
        return run

    def ids(self, run, severities="FSAI"):
        """Identifiers of a run's messages."""
        return [m["id"] for m in run.messages if m["severity"] in severities]

    # ------------------------------------------------------------------------------------------ MED files

    def med_library(self, file):
        """What the MED library reads."""
        script = pathlib.Path(__file__).with_name("med_library.py")
        done = subprocess.run([sys.executable, "-B", script, file], capture_output=True, text=True, timeout=SECONDS,
                              stdin=subprocess.DEVNULL, check=False)
        if done.returncode == 77:
            self.skipTest("python3-med is not installed")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        return json.loads(done.stdout)

    def med_tool(self, *command):
        """Output of one of the MED tools; they loop on an open input, and complain in French."""
        if not shutil.which(command[0]):
            self.skipTest(f"{command[0]} is not installed (libmed-tools)")
        done = subprocess.run(command, capture_output=True, timeout=SECONDS, stdin=subprocess.DEVNULL, check=False)
        output = (done.stdout + done.stderr).decode("utf-8", "replace")
        self.assertEqual(done.returncode, 0, output)
        self.assertNotIn("Erreur", output)
        self.assertNotIn("ERREUR", output)
        return output

    def assert_conforms(self, file):
        """The MED library's own check accepts the file."""
        output = self.med_tool("medconforme", str(file))
        self.assertIn("conforme au format HDF", output)
        self.assertNotIn("non conforme", output.lower())

    # ------------------------------------------------------------------------------------------ making concepts

    def create(self, identifier, lacon_type, label=None, references=(), index=False, **attributes):
        """An open HDF5 file with the attributes that every concept has; use it in a `with`."""
        path = self.base / identifier / "index.h5" if index else self.base / f"{identifier}.h5"
        path.parent.mkdir(exist_ok=True)
        file = h5py.File(path, "w")
        head = {"lacon_type": lacon_type, "format": np.int64(1), "version": np.int64(1), "id": identifier,
                "label": label or identifier.upper(), "command": "BY_HAND", "keywords": "{}", "references": json.dumps(list(references))}
        for name, value in {**head, **attributes}.items():
            file.attrs[name] = np.int64(value) if isinstance(value, int) else value
        return file

    def write_mesh(self, identifier, coordinates, cells, cell_groups=None, node_groups=None, dimension=None, label=None, name="MESH"):
        """@param coordinates (n, 2 or 3) @param cells list of (type name, nodes), 0-based, in Lacon's node order"""
        coordinates = np.asarray(coordinates, float)
        dimension = dimension or coordinates.shape[1]
        if coordinates.shape[1] == 2:
            coordinates = np.column_stack([coordinates, np.zeros(len(coordinates))])
        with self.create(identifier, "mesh", label, dimension=dimension, name=name) as file:
            file["coordinates"] = coordinates
            group = file.create_group("cells")
            group.attrs["types"] = np.array(CELL_TYPES, h5py.string_dtype())
            group["type"] = np.array([CELL_TYPES.index(kind) for kind, _ in cells], np.int8)
            write_ragged(group, "offset", "nodes", [nodes for _, nodes in cells])
            for kind, groups in (("cells", cell_groups or {}), ("nodes", node_groups or {})):
                where = file.create_group(f"groups/{kind}")
                where["name"] = np.array(list(groups), h5py.string_dtype())
                write_ragged(where, "offset", "values", list(groups.values()))

    def write_model(self, identifier, mesh, elements, cell_elements, dimension=2, phenomenon="MECANIQUE", label=None):
        """@param elements row names @param cell_elements of each cell: index into elements, -1 for none"""
        with self.create(identifier, "model", label, [mesh], mesh=mesh, phenomenon=phenomenon, dimension=dimension) as file:
            file["elements"] = np.array(elements, h5py.string_dtype())
            file["cells/element"] = np.array(cell_elements, np.int32)

    def write_material(self, identifier, label=None, **laws):
        """laws: ELAS={"E": 1.0, "NU": 0.3}"""
        with self.create(identifier, "material", label) as file:
            for law, parameters in laws.items():
                group = file.create_group(law)
                for name, value in parameters.items():
                    group.attrs[name] = value

    def write_material_field(self, identifier, mesh, materials, cell_materials, model="", label=None):
        references = [mesh, *materials, *([model] if model else [])]
        with self.create(identifier, "material_field", label, references, mesh=mesh, model=model) as file:
            file["materials"] = np.array(materials, h5py.string_dtype())
            file["cells/material"] = np.array(cell_materials, np.int32)

    def write_field(self, path, name, quantity, location, components, support, values, mesh, order=0, instant=0.0, offset=None,
                    present=None):
        """A field file; `path` is relative to the base."""
        file_path = self.base / path
        file_path.parent.mkdir(parents=True, exist_ok=True)
        with h5py.File(file_path, "w") as file:
            head = {"lacon_type": "field", "format": np.int64(1), "name": name, "quantity": quantity, "mesh": mesh,
                    "order": np.int64(order), "instant": float(instant), "location": location}
            for key, value in head.items():
                file.attrs[key] = value
            fill_field(file, components, support, values, offset, present)

    def write_result(self, identifier, mesh, instants, fields, model="", material_field="", contact="", loads=(), label=None, behaviour="{}"):
        """@param instants of the orders 0, 1, ... @param fields name -> {order: keywords of write_field but path, name, mesh}"""
        references = [one for one in (mesh, model, material_field, contact) if one]
        with self.create(identifier, "result", label, references, index=True, model=model, mesh=mesh, material_field=material_field,
                         contact=contact, loads=json.dumps(list(loads)), behaviour=behaviour) as file:
            file["order"] = np.arange(len(instants), dtype=np.int64)
            file["instant"] = np.asarray(instants, float)
            file.create_group("parameters")
            file.create_group("fields")
            for name, steps in fields.items():
                files = []
                for order, field in steps.items():
                    files.append(f"{identifier}/{name}_{order}.h5")
                    self.write_field(files[-1], name, mesh=mesh, order=order, instant=instants[order], **field)
                group = file.create_group(f"fields/{name}")
                group["order"] = np.array(list(steps), np.int64)
                group["file"] = np.array(files, h5py.string_dtype())

    # ------------------------------------------------------------------------------------------ reading concepts

    def path(self, identifier):
        single = self.base / f"{identifier}.h5"
        return single if single.exists() else self.base / identifier / "index.h5"

    def attributes(self, identifier):
        with h5py.File(self.path(identifier)) as file:
            return dict(file.attrs)

    def read_mesh(self, identifier):
        """@return .name, .dimension, .coordinates (n, 3), .types (names), .cells (lists), .cell_groups, .node_groups (name -> array),
        .patches (None, or .kind, .parent, .cells, .carriers, .zone_group, .zone_offset)"""
        with h5py.File(self.path(identifier)) as file:
            names = [text(t) for t in file["cells"].attrs["types"]]
            patches = None
            if "patches" in file:
                group = file["patches"]
                patches = types.SimpleNamespace(
                    zone_group=[text(t) for t in group["zone_group"]], zone_offset=group["zone_offset"][()], kind=group["kind"][()],
                    parent=group["parent"][()], cells=read_ragged(group["cells"]), carriers=read_ragged(group["carriers"]))
            return types.SimpleNamespace(
                name=text(file.attrs["name"]), dimension=int(file.attrs["dimension"]), coordinates=file["coordinates"][()],
                types=[names[i] for i in file["cells/type"][()]], cells=read_ragged(file["cells"], "offset", "nodes"),
                cell_groups=read_groups(file["groups/cells"]), node_groups=read_groups(file["groups/nodes"]), patches=patches)

    def read_table(self, group):
        """Rows of a table, column -> cell, None where it is missing."""
        columns = {}
        for k, name in enumerate(group["columns"].asstr()[:]):
            data = group[f"values/{k}"]
            values = (data.asstr()[:] if h5py.check_string_dtype(data.dtype) else data[:]).tolist()
            there = group[f"present/{k}"][:] if f"present/{k}" in group else [1] * len(values)
            columns[name] = [v if p else None for v, p in zip(values, there)]
        return [dict(zip(columns, row)) for row in zip(*columns.values())]

    def read_field(self, result, name, order):
        """@return the field file as a namespace: .attributes, .components, .support, .values, .offset and .present (or None)"""
        with h5py.File(self.path(result)) as index:
            group = index[f"fields/{name}"]
            at = list(group["order"][()]).index(order)
            path = self.base / text(group["file"][at])
        with h5py.File(path) as file:
            return types.SimpleNamespace(
                attributes=dict(file.attrs), components=[text(c) for c in file.attrs["components"]], support=file["support"][()],
                values=file["values"][()], offset=file["offset"][()] if "offset" in file else None,
                present=file["present"][()] if "present" in file else None)


def text(value):
    return value.decode("utf-8") if isinstance(value, bytes) else str(value)


def write_ragged(group, offset, values, rows):
    group[offset] = np.concatenate([[0], np.cumsum([len(row) for row in rows])]).astype(np.int64)
    group[values] = np.array([item for row in rows for item in row], np.int32)


def read_ragged(group, offset="offset", values="values"):
    ends, items = group[offset][()], group[values][()]
    return [list(items[a:b]) for a, b in zip(ends[:-1], ends[1:])]


def read_groups(group):
    return {text(name): np.array(members, int) for name, members in zip(group["name"][()], read_ragged(group))}
