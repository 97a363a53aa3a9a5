"""What the MED library itself reads of a file, as JSON on stdout: an oracle for what Lacon writes.

usage: python3 med_library.py FILE. A process of its own: the library brings another build of HDF5 than h5py does.
Exit status 77 where the library's Python modules (python3-med) are not installed.
"""

import json
import sys

try:
    from med import medenum as e
    from med.medfamily import *
    from med.medfield import *
    from med.medfile import *
    from med.medmesh import *
    from med.medprofile import *
except ImportError:
    sys.exit(77)

CELLS = {name: getattr(e, "MED_" + long) for name, long in (
    ("PO1", "POINT1"), ("SE2", "SEG2"), ("SE3", "SEG3"), ("TR3", "TRIA3"), ("TR6", "TRIA6"), ("QU4", "QUAD4"), ("QU8", "QUAD8"),
    ("QU9", "QUAD9"), ("TE4", "TETRA4"), ("T10", "TETRA10"), ("PE6", "PENTA6"), ("P15", "PENTA15"), ("PY5", "PYRA5"),
    ("P13", "PYRA13"), ("HE8", "HEXA8"), ("H20", "HEXA20"), ("H27", "HEXA27"))}


def first(answer):
    return answer[0] if isinstance(answer, (tuple, list)) else answer


def read_mesh(file, at):
    name, space, dimension, *_ = MEDmeshInfo(file, at)
    no = (e.MED_NO_DT, e.MED_NO_IT)
    nodes = first(MEDmeshnEntity(file, name, *no, e.MED_NODE, e.MED_NONE, e.MED_COORDINATE, e.MED_NO_CMODE))
    coordinates = MEDFLOAT([0.0] * nodes * space)
    MEDmeshNodeCoordinateRd(file, name, *no, e.MED_FULL_INTERLACE, coordinates)
    cells = {}
    for kind, geometry in CELLS.items():
        count = first(MEDmeshnEntity(file, name, *no, e.MED_CELL, geometry, e.MED_CONNECTIVITY, e.MED_NODAL))
        if count > 0:
            connectivity = MEDINT([0] * count * (geometry % 100))
            MEDmeshElementConnectivityRd(file, name, *no, e.MED_CELL, geometry, e.MED_NODAL, e.MED_FULL_INTERLACE, connectivity)
            cells[kind] = list(connectivity)
    families = {}
    for f in range(1, MEDnFamily(file, name) + 1):
        size = MEDnFamilyGroup(file, name, f)
        groups = MEDCHAR("\0" * (80 * size + 1))
        family, number = MEDfamilyInfo(file, name, f, groups)[:2]
        text = "".join(c if isinstance(c, str) else chr(c) for c in groups)
        families[number] = [text[80 * i:80 * (i + 1)].strip("\0 ") for i in range(size)]
    return {"name": name, "space": space, "dimension": dimension, "coordinates": list(coordinates), "cells": cells,
            "families": families}


def read_field(file, at):
    size = MEDfieldnComponent(file, at)
    name, mesh, _, _, components, _, _, steps = MEDfieldInfo(file, at)
    found = {"mesh": mesh, "components": components.split(), "steps": []}
    for s in range(1, steps + 1):
        number, order, instant = MEDfieldComputingStepInfo(file, name, s)[:3]
        values = {}
        kinds = [("NOE", e.MED_NODE, e.MED_NONE)] + [("MAI." + k, e.MED_CELL, g) for k, g in CELLS.items()] + [
            ("NOE." + k, e.MED_NODE_ELEMENT, g) for k, g in CELLS.items()]
        for label, entity, geometry in kinds:
            profiles = MEDfieldnProfile(file, name, number, order, entity, geometry)
            for p in range(1, first(profiles) + 1):
                count, profile, profile_size, localisation, points = MEDfieldnValueWithProfile(
                    file, name, number, order, entity, geometry, p, e.MED_COMPACT_STMODE)
                if count <= 0:
                    continue
                data = MEDFLOAT([0.0] * count * points * size)
                MEDfieldValueWithProfileRd(file, name, number, order, entity, geometry, e.MED_COMPACT_STMODE, profile,
                                           e.MED_FULL_INTERLACE, e.MED_ALL_CONSTITUENT, data)
                members = None
                if profile.strip():
                    members = MEDINT([0] * profile_size)
                    MEDprofileRd(file, profile, members)
                    members = list(members)
                whole = first(MEDfieldnValueWithProfile(file, name, number, order, entity, geometry, p, e.MED_GLOBAL_STMODE))
                on_all = MEDFLOAT([0.0] * whole * points * size)
                MEDfieldValueWithProfileRd(file, name, number, order, entity, geometry, e.MED_GLOBAL_STMODE, profile,
                                           e.MED_FULL_INTERLACE, e.MED_ALL_CONSTITUENT, on_all)
                values[label] = {"global": list(on_all), "values": list(data), "profile": members, "points": points, "localisation": localisation.strip()}
        found["steps"].append({"order": number, "instant": instant, "values": values})
    return name, found


def main():
    file = MEDfileOpen(sys.argv[1], e.MED_ACC_RDONLY)
    meshes = [read_mesh(file, i) for i in range(1, MEDnMesh(file) + 1)]
    fields = dict(read_field(file, i) for i in range(1, MEDnField(file) + 1))
    MEDfileClose(file)
    json.dump({"meshes": meshes, "fields": fields}, sys.stdout)


main()
