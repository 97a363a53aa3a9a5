"""Writes the seeds of `corpus/` again: what Lacon writes today of a small study, as text (h5_text.hpp), orders, meshes of gmsh.

    LACON_BIN=build/release/bin LACON_CATALOG=build/release/generated/catalog.json python3 tests/fuzz/seeds.py

Seeds that something was found with (`found_*`) stay.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
from urllib.parse import quote

import h5py
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
sys.path += [str(SOURCE / "commands/studies"), str(SOURCE / "tests/operators")]
from meshes import block, union, write_med  # noqa: E402

CORPUS = HERE / "corpus"
#: numpy's names of what h5_text.hpp calls i1 ...
KINDS = {"int8": "i1", "uint8": "u1", "int32": "i4", "uint32": "i4", "int64": "i8", "float64": "f8"}


def squares():
    """One QUAD4 below, one above."""
    line = np.array([0.0, 1.0])
    mesh = union([block("QUAD4", line, line, name="VBOT", sides={"bottom": "BASE", "top": "CBOT"}),
                  block("QUAD4", line, line + 1.0, name="VTOP", sides={"bottom": "CTOP", "top": "TOP", "right": "SIDE"})])
    mesh.node_groups["CORNER"] = [0]
    return mesh


def as_text(path):
    """An HDF5 file in the language of h5_text.hpp."""
    lines = []
    with h5py.File(path) as file:
        def visit(name, item):
            place = quote("/" + name)
            if isinstance(item, h5py.Dataset):
                lines.append(f"{place} {_content(item.dtype, item.shape, item[()])}")
            elif name and not len(item):
                lines.append(f"{place} group")
            for key in item.attrs:
                value = item.attrs.get_id(key)
                lines.append(f"{place}@{quote(key)} {_content(value.dtype, value.shape, item.attrs[key])}")

        visit("", file)
        file.visititems(visit)
    # groups come into being with what is in them
    return "\n".join(sorted(lines, key=lambda line: "@" in line.split(" ")[0])) + "\n"


def _content(dtype, shape, value):
    if dtype.subdtype:  # names in MED: rows of bytes
        width = dtype.subdtype[1][0]
        value = [bytes(np.uint8(row)).rstrip(b"\0").decode() for row in np.atleast_2d(value)]
        kind = f"t{width}"
    elif dtype.kind == "S":
        kind, value = f"t{dtype.itemsize}", [item.decode() for item in np.atleast_1d(value).ravel()]
    elif h5py.check_string_dtype(dtype):
        kind, value = "s", [item.decode() if isinstance(item, bytes) else item for item in np.atleast_1d(value).ravel()]
    else:
        kind, value = KINDS[dtype.name], [repr(item.item()) for item in np.atleast_1d(value).ravel()]
    extents = f" [{','.join(map(str, shape))}]" if shape else ""
    return f"{kind}{extents} " + " ".join(quote(item, safe="") or "%" for item in value)


def write(target, name, content):
    folder = CORPUS / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def of_the_study(folder):
    write_med(folder / "squares.med", squares())
    subprocess.run([os.environ["LACON_BIN"] + "/lacon", HERE / "study.comm", "--unit", "20=squares.med", "--unit", "80=result.med", "--base", "base"],
                   cwd=folder, env={**os.environ, "LACON_ORDERS": str(folder / "orders")}, check=True, stdout=subprocess.DEVNULL)
    for path in sorted((folder / "base").rglob("*.h5")):
        if path.name.startswith("kept") or (path.parent.name != "base" and path.name.endswith(("_0.h5", "_1.h5"))):
            continue  # one instant is enough
        write("concepts", path.relative_to(folder / "base").as_posix().replace("/", "_").replace(".h5", ""), as_text(path))
    write("med", "squares", as_text(folder / "squares.med"))
    write("med", "result", as_text(folder / "result.med"))
    for path in sorted((folder / "orders").glob("*.order.json")):
        text = re.sub(re.escape(str(folder)), "/folder", path.read_text())
        write("order", path.name.partition(".")[0].partition("-")[2], text.replace(str(SOURCE), "/source"))


def of_gmsh(folder):
    from test_lire_maillage_gmsh import write_msh

    nodes = {1: (0.0, 0.0, 0.0), 2: (1.0, 0.0, 0.0), 3: (1.0, 1.0, 0.0), 4: (0.0, 1.0, 0.0), 7: (0.5, 0.5, 0.0)}
    cells = [("POI1", [3], [1]), ("SEG2", [1], [1, 2]), ("TRIA3", [2], [1, 2, 7]), ("QUAD4", [2], [1, 2, 3, 4])]
    for version in ("2.2", "4", "4.1"):
        for binary in (False, True):
            path = folder / "mesh.msh"
            write_msh(path, version, binary, nodes, cells, [(1, 1, "SKIN"), (2, 2, "BODY")])
            write("msh", f"version_{version}{'_binary' if binary else ''}", path.read_bytes())


def of_numbers():
    """Bytes that the targets of numbers choose by: pseudo-random ones, always the same."""
    random = np.random.default_rng(1)
    for target in ("clipping", "pairing", "cuts"):
        for k in range(8):
            write(target, f"random_{k}", random.integers(0, 256, 64, dtype=np.uint8).tobytes())


def main():
    with tempfile.TemporaryDirectory() as folder:
        of_the_study(pathlib.Path(folder))
        of_gmsh(pathlib.Path(folder))
    of_numbers()
    for path in SOURCE.glob("tests/consumer/*/plugin.toml"):
        write("plugin", path.parent.name, path.read_bytes())


main()
