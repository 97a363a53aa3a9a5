"""COPIER, INFO_RESU, MACR_INFO_MAIL: concepts once more, and what they hold as text."""

from ..base import contents
from ..core.files import link
from ..tables import printing
from ..tables.table import Table

# -------------------------------------------------------------------------------------------------------- COPIER

#: attributes of a concept's file that say which concept it is
_own = {"id", "label", "version", "command", "keywords"}


def copier(call):
    return copy_of(call, call.keywords["CONCEPT"])


def copy_of(call, source):
    """The concept that a call makes, with the content of another."""
    def fill(file):
        with source.open() as there:
            for name, value in there.attrs.items():
                if name not in _own:
                    file.attrs[name] = value
            for name in there:
                there.copy(name, file)
        if source.type == "field":
            file.attrs["name"] = call.label
        if source.type == "result":
            _link_fields(call.study.base.folder, file)

    made = call.write(source.type, fill)
    if source.type == "formula":
        made._expression = source.expression()  # with the values that no file keeps
    return made


def _link_fields(folder, index):
    """Field files of a result in a folder of its own: they never change, so that a second name is a copy."""
    own = index.attrs["id"]
    (folder / own).mkdir(exist_ok=True)
    for entry in index.get("fields", {}).values():
        files = entry["file"].asstr()[:].tolist()
        copies = [f"{own}/{name.rpartition('/')[2]}" for name in files]
        for name, copy in zip(files, copies):
            link(folder / name, folder / copy)
        entry["file"][:] = copies


# ----------------------------------------------------------------------------------------------------- INFO_RESU


def info_resu(call):
    result = call.keywords["RESULTAT"]
    with result.open() as file:
        instants, orders, parameters = contents.instants(file), contents.fields(file), contents.parameters(file)
    table = Table.of_columns({"NUME_ORDRE": ("I", [o for o, _ in instants]), "INST": ("R", [t for _, t in instants]),
                              **{name: ("R", values.tolist()) for name, values in parameters.items()}}, result.label)
    fields = []
    for name, at in orders.items():
        field = result.field(name, at[0])
        fields.append({"NOM_CHAM": name, "TYPE_CHAM": field.type(), "NOMBRE": len(at), "PREMIER": at[0], "DERNIER": at[-1], "NOM_CMP": " ".join(field.components)})
    parts = [table] + ([Table(fields)] if fields else [])
    _print(call, parts, call.keywords["UNITE"])


def _print(call, tables, unit=6):
    text = "\n\n".join(printing.columns(table) for table in tables)
    call.study.write_text(unit, ".resu", f"{call.command}/UNITE, {call.where}", text + "\n\n")


# ------------------------------------------------------------------------------------------------ MACR_INFO_MAIL


def macr_info_mail(call):
    mesh = call.keywords["MAILLAGE"]
    with mesh.open() as file:
        names, types = contents.cell_types(file)
    types = types.tolist()
    counts = [("NOEUD", mesh.getNumberOfNodes())] + [(name, types.count(k)) for k, name in enumerate(names) if k in types]
    tables = [Table.of_columns({"TYPE": ("K8", [name for name, _ in counts]), "NOMBRE": ("I", [n for _, n in counts])}, mesh.label)]
    groups = [{"GROUPE": name, "SUR": kind, "NOMBRE": number}
              for kind, listed in (("GROUP_MA", mesh.LIST_GROUP_MA()), ("GROUP_NO", mesh.LIST_GROUP_NO())) for name, number in listed]
    if groups:
        tables.append(Table(groups))
    if call.keywords["TAILLE"] == "OUI":
        tables.append(_sizes(mesh))
    _print(call, tables)


def _sizes(mesh):
    """Shortest and longest edge of all cells and of each group whose cells have edges."""
    rows = []
    for name, groups in [("TOUT", ()), *((name, name) for name in mesh.getGroupsOfCells())]:
        edges = mesh.edge_lengths(groups)
        if len(edges):
            rows.append({"GROUP_MA": name, "ARETE_MIN": float(min(edges)), "ARETE_MAX": float(max(edges))})
    return Table(rows)
