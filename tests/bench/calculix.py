"""The study of two stacked blocks for CalculiX: its input deck, a run of ccx, and what it found.

Settings, the best that were found for version 2.20: TYPE=MORTAR with a linear pressure-overclosure of 4000 E / h (HARD is silently reduced to a
slope of 1e5, 20 times E: 2 % of the force), one increment, SPOOLES, its own convergence criteria, small strains. LINMORTAR takes as long on linear
cells, PGLINMORTAR longer. Mortar contact ends with exit status 255 where a slave node is held, so that the nodes of the slave skin on the planes of symmetry
are left free; flat, their solution is the same; curved, it costs some thousandths of the force. Springs that hold them double the time.
"""

import os
import pathlib
import re
import resource
import shutil
import subprocess
import time

import numpy as np

YOUNG, POISSON, PRESSURE, STIFFNESS = 2000.0, 0.3, 25.0, 1e8

#: cell -> (name there, its faces S1, S2, ... by the vertices that they have)
CELLS = {"HEXA8": ("C3D8", ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 4, 5), (1, 2, 5, 6), (2, 3, 6, 7), (0, 3, 4, 7))),
         "TETRA4": ("C3D4", ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)))}
#: group of skin cells -> component of displacement that is zero there
HELD = {"XB": 1, "XT": 1, "YB": 2, "YT": 2, "BASE": 3}


def program():
    """The path of ccx, or None."""
    return shutil.which("ccx")


def deck(mesh, push=None):
    """The input deck, a text. @param mesh of the base (results.MeshOfBase), not cut @param push how far TOP comes down; None: pressed by PRESSURE"""
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{n}, {x:.16g}, {y:.16g}, {z:.16g}" for n, (x, y, z) in enumerate(mesh.points.tolist(), 1)]
    faces = {}  # vertices -> (cell, number of the face)
    for kind, (name, of_cell) in CELLS.items():
        chosen = [(number, nodes) for number, (cell, nodes) in enumerate(mesh.cells, 1) if cell == kind]
        if chosen:
            lines.append(f"*ELEMENT, TYPE={name}, ELSET=SOLID")
        for number, nodes in chosen:
            lines.append(f"{number}, " + ", ".join(str(n + 1) for n in nodes.tolist()))
            for face, local in enumerate(of_cell, 1):
                faces[frozenset(nodes[list(local)].tolist())] = number, face

    def faces_of(group):
        return [faces[frozenset(mesh.cells[cell][1].tolist())] for cell in mesh.groups[group]]

    def nodes_of(group):
        return (np.unique(np.concatenate([mesh.cells[cell][1] for cell in mesh.groups[group]])) + 1).tolist()

    for skin in ("CTOP", "CBOT"):
        lines += [f"*SURFACE, NAME={skin}", *(f"{cell}, S{face}" for cell, face in faces_of(skin))]
    for group in ("BASE", "TOP"):
        lines += [f"*NSET, NSET={group}", *(f"{node}," for node in nodes_of(group))]
    slave = set(nodes_of("CTOP"))
    held = sorted({(node, component) for group, component in HELD.items() for node in nodes_of(group) if node not in slave})
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG}, {POISSON}", "*SOLID SECTION, ELSET=SOLID, MATERIAL=STEEL",
              "*BOUNDARY", *(f"{node}, {component}, {component}" for node, component in held),
              "*SURFACE INTERACTION, NAME=CONTACT", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{STIFFNESS:.3e}",
              "*CONTACT PAIR, INTERACTION=CONTACT, TYPE=MORTAR", "CTOP, CBOT", "*STEP", "*STATIC, DIRECT, SOLVER=SPOOLES", "1., 1."]
    lines += (["*DLOAD", *(f"{cell}, P{face}, {PRESSURE}" for cell, face in faces_of("TOP"))] if push is None else
              ["*BOUNDARY", f"TOP, 3, 3, {-push!r}"])
    lines += ["*NODE PRINT, NSET=BASE, TOTALS=ONLY", "RF", "*CONTACT FILE", "CDIS, CSTR", "*END STEP"]
    return "\n".join(lines) + "\n"


def contact_pressures(frd):
    """CPRESS at the slave nodes, from the text of a result file of ccx."""
    start = frd.rindex(" -4  CONTACT ")
    block = frd[start:frd.index("\n -3", start)].splitlines()
    names = [line.split()[1] for line in block if line.startswith(" -5")]
    column = names.index("CPRESS")
    return np.array([float(line[13 + 12 * column:25 + 12 * column]) for line in block if line.startswith(" -1")])


def solve(mesh, folder, push, limit):
    """Run ccx with one thread for at most `limit` seconds and two thirds of the machine's memory.
    @return seconds, memory (MB), `failure` (None, or what happened), and of a run that ended well: equations, iterations, force (on the base), pressures (least,
    largest)"""
    folder = pathlib.Path(folder)
    for old in folder.glob("blocks.*"):
        old.unlink()
    (folder / "blocks.inp").write_text(deck(mesh, push))
    bytes_allowed = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") * 2 // 3
    start = time.perf_counter()
    with open(folder / "blocks.log", "w+", encoding="utf-8", errors="replace") as log:
        process = subprocess.Popen([program(), "blocks"], cwd=folder, stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                   env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (bytes_allowed, bytes_allowed)))
        late = False
        while True:
            ended, status, usage = os.wait4(process.pid, os.WNOHANG)
            if ended:
                break
            if not late and time.perf_counter() - start > limit:
                late = True
                process.kill()
            time.sleep(0.02)
        seconds = time.perf_counter() - start
        log.seek(0)
        said = log.read()
    process.returncode = os.waitstatus_to_exitcode(status)
    found = {"seconds": seconds, "memory": usage.ru_maxrss / 1024, "failure": None}
    if late:
        found["failure"] = "out of time"
    elif re.search("alloc", said):
        found["failure"] = f"out of memory ({bytes_allowed / 1e9:.0f} GB)"
    elif status:
        found["failure"] = "diverged" if "diverg" in said or "too many cutbacks" in said else f"exit status {process.returncode}"
    if not found["failure"]:
        pressures = contact_pressures((folder / "blocks.frd").read_text())
        found |= {"equations": int(re.findall(r"number of equations\s+(\d+)", said)[-1]),
                  "iterations": len(re.findall(r"^ iteration \d+", said, re.MULTILINE)),
                  "force": float((folder / "blocks.dat").read_text().split()[-1]),
                  "pressures": [float(pressures.min()), float(pressures.max())]}
    return found
