"""What the files of concepts hold (docs/structures.md, sections 2 and 3), as arrays and plain Python. Each function takes an open HDF5 file.

The one place that knows the layout on reading: for the objects of a command file, the tools and studies of their own.
"""

import json

from ..core.hdf5 import ragged, text, texts
from ..core.late import numpy


def holds(file):
    """What a file of a base says that it is: the id of a concept, of other files their type; empty where it says neither."""
    return text(file.attrs.get("id", file.attrs.get("lacon_type", "")))


# ---------------------------------------------------------------------------------------------------- mesh


def is_deformed(mesh):
    """Whether a field has moved its nodes, and none has brought them back (Mesh::first_place)."""
    return "first_place" in mesh


def dimension(mesh):
    """2 or 3"""
    return int(mesh.attrs["dimension"])


def points(mesh):
    """Coordinates of the nodes, (n, 3)."""
    return mesh["coordinates"][:]


def number_of_nodes(mesh):
    return mesh["coordinates"].shape[0]


def number_of_cells(mesh):
    return mesh["cells/type"].shape[0]


def cell_types(mesh):
    """(names of the types that the mesh has, index of each cell's type in them)"""
    return texts(mesh["cells"], "types"), mesh["cells/type"][:]


def connectivity(mesh):
    """(offset, nodes): those of cell c are nodes[offset[c]:offset[c + 1]], in the order of catalog/cells.toml."""
    return mesh["cells/offset"][:], mesh["cells/nodes"][:]


def cells(mesh):
    """[(name of its type, nodes)]"""
    names, types = cell_types(mesh)
    return list(zip((names[t] for t in types), ragged(mesh["cells"], "nodes")))


def nodes_of(mesh, cells):
    """Nodes of cells, one cell after the other."""
    offset, nodes = connectivity(mesh)
    parts = [nodes[offset[c]:offset[c + 1]] for c in cells]
    return numpy.concatenate(parts) if parts else nodes[:0]


def group_names(mesh, kind):
    """Names of the groups of "cells" or of "nodes"."""
    groups = mesh.get(f"groups/{kind}")
    return [] if groups is None else list(groups["name"].asstr()[:])


def group(mesh, kind, name):
    """Members of a group, from 0; nothing where there is no such group."""
    names = group_names(mesh, kind)
    if name not in names:
        return None
    groups, k = mesh[f"groups/{kind}"], names.index(name)
    return groups["values"][groups["offset"][k]:groups["offset"][k + 1]]


def groups(mesh, kind):
    """name -> members, from 0"""
    return dict(zip(group_names(mesh, kind), ragged(mesh[f"groups/{kind}"]))) if f"groups/{kind}" in mesh else {}


def cut_groups(mesh):
    """Slave skins that DECOUPE_LAC has cut."""
    return list(map(text, mesh["patches/zone_group"][:])) if "patches" in mesh else []


def patches(mesh):
    """The skin cells of each patch of a cut mesh."""
    return ragged(mesh["patches/cells"]) if "patches" in mesh else []


def patch_zones(mesh):
    """[(slave group, number of its first patch, number behind its last one)] of a cut mesh."""
    if "patches" not in mesh:
        return []
    offset = mesh["patches/zone_offset"][:].tolist()
    return list(zip(mesh["patches/zone_group"].asstr()[:], offset[:-1], offset[1:]))


# ---------------------------------------------------------------------------------------------------- contact


def contact_zones(contact):
    """[(slave group, master group, slave cells, master cells)] of a contact"""
    zones = contact["zones"]
    return list(zip(zones["slave_group"].asstr()[:], zones["master_group"].asstr()[:], ragged(zones["slave"]), ragged(zones["master"])))


def contacts(states):
    """The ids of the contacts of a result's stages, each once, the first one first, or that of a failed step."""
    if "stages" not in states.attrs:  # results of format 1, failed steps
        return [identifier] if (identifier := reference(states, "contact")) else []
    return list(dict.fromkeys(stage["contact"] for stage in stages(states) if stage["contact"]))


def zones_of_contacts(contacts_in_turn):
    """contact_zones() of several contacts together: those of a slave group are one, by the order of the first contact. What it meets is named and listed
    for all of them. @param contacts_in_turn contact_zones() of each"""
    merged = {}
    for zones in contacts_in_turn:
        for slave, master, slaves, masters_of_zone in zones:
            names, _, cells = merged.setdefault(slave, ([], slaves, []))
            if master not in names:
                names.append(master)
                cells.append(masters_of_zone)
    return [(slave, ", ".join(names), slaves, numpy.unique(numpy.concatenate(cells))) for slave, (names, slaves, cells) in merged.items()]


def masters(group):
    """(offset, master cells, shares) that a file of masters holds: those of row i of its CONT_ELEM from offset[i] on."""
    return tuple(group[name][:] for name in ("offset", "cell", "share"))


def path_of_masters(field):
    """The file of masters beside a field file CONT_ELEM. @param field its path"""
    return field.with_name(field.name.removesuffix(".h5") + ".masters.h5")


# ---------------------------------------------------------------------------------------------------- result

failed_step = "failed_step.h5"  #: in the folder of a result: the last iterates of a step that was given up


def instants(result):
    """[(order number, instant)]"""
    return list(zip(result["order"][:].tolist(), result["instant"][:].tolist()))


def stages(result):
    """[{"first", "contact", "loads", "behaviour"}]: what its instants were computed with, from an order number on; of one of format 1 without loads and behaviour"""
    if "stages" in result.attrs:
        return json.loads(text(result.attrs["stages"]))
    return [{"first": 0, "contact": reference(result, "contact")}]


def orders_with_contact(result):
    """The order numbers that belong to a stage with contact."""
    found, with_contact = stages(result), []
    for order, _ in instants(result):
        stage = [one for one in found if one["first"] <= order][-1]
        if stage["contact"]:
            with_contact.append(order)
    return with_contact


def is_complete(result):
    """Its computation came to its end."""
    return bool(result.attrs.get("complete", 1))


def fields(result):
    """name of a field -> its order numbers"""
    return {name: result["fields"][name]["order"][:].tolist() for name in sorted(result.get("fields", ()))}


def field_file(result, name, order):
    """The file of a field, relative to the base; nothing where there is none."""
    entry = result.get(f"fields/{name}")
    orders = [] if entry is None else entry["order"][:].tolist()
    return entry["file"].asstr()[orders.index(order)] if order in orders else None


def field_files_by_order(result, name):
    """order number -> the file of a field, relative to the base"""
    entry = result[f"fields/{name}"]
    return dict(zip(entry["order"][:].tolist(), entry["file"].asstr()[:]))


def field_files(result):
    """Every field file that the index of a result names."""
    return {path for entry in result.get("fields", {}).values() for path in entry["file"].asstr()[:]}


def iterations(failed_step):
    """Numbers of the iterates of a failed step."""
    return failed_step["iteration"][:].tolist()


def fields_of_iterates(failed_step):
    """name of a field -> the iterations that have it; its group is fields/NAME/ITERATION, laid out as a field's file."""
    return {name: sorted(map(int, groups)) for name, groups in failed_step["fields"].items()}


def modelisations(model):
    """Names of those that its cells have, "AXIS"."""
    return {text(name).partition("/")[0] for name in model["elements"][:]}


def parameters(result):
    """name -> one value an instant"""
    return {name: values[:] for name, values in result.get("parameters", {}).items()}


def reference(concept, name):
    """The id of the concept that another one refers to as `name`: "mesh", "model", "material_field", "contact"; empty where it refers to none."""
    return text(concept.attrs.get(name, ""))
