"""Contact methods that Lacon has not: the same contact as a DEFI_CONTACT of the LAC method, to be pasted."""

from ..base import contents
from ..core import catalog
from ..core.concepts import Concept
from ..core.messages import fail


#: keywords of a zone that have one value with LAC, its default
ONE_VALUE = ("APPARIEMENT", "ADAPTATION")
#: keywords of a zone that take patches out
LEFT_OUT = ("SANS_GROUP_MA", "SANS_GROUP_NO", "SANS_MAILLE", "SANS_NOEUD")


class Name(str):
    """A variable of the form, which stands there without quotes."""


def refuse_other_methods(command, given, where, label):
    """Throws LAC_9 with the LAC form, where a DEFI_CONTACT or a DEFI_CONT asks for another method. What has no two skins (LIAISON_UNIL, XFEM, zones
    without groups) has no such form: its keywords are refused one by one."""
    zones = _occurrences(given.get("ZONE"))
    if not zones or not all(zone.get("GROUP_MA_MAIT") and zone.get("GROUP_MA_ESCL") for zone in zones):
        return
    if command == "DEFI_CONTACT":
        formulation = given.get("FORMULATION", "DISCRETE")
        other = [zone.get("ALGO_CONT", "STANDARD") for zone in zones if zone.get("ALGO_CONT", "STANDARD") != "LAC"]
        if formulation == "CONTINUE" and not other:
            return
        method = f"FORMULATION='{formulation}'" + (f", ALGO_CONT='{other[0]}'" if other else "")
    else:
        method = command
    fail("LAC_9", where, method=method, form=lac_form(given, zones, label))


def lac_form(given, zones, label):
    """The cut of the slave skins and the DEFI_CONTACT, as lines of a command file."""
    model = given.get("MODELE")
    mesh = model.getMesh() if isinstance(model, Concept) and hasattr(model, "getMesh") else None
    slaves = list(dict.fromkeys(name for zone in zones for name in _names(zone.get("GROUP_MA_ESCL"))))
    lines = []
    if mesh is None or not _is_cut(mesh, slaves):
        old = mesh.label if mesh is not None and mesh.label else "MESH"
        lines += [f"CUT = CREA_MAILLAGE(MAILLAGE={old}, DECOUPE_LAC=_F(GROUP_MA_ESCL={_show(slaves)}))",
                  f"# the model and what follows on CUT instead of {old}"]
    row = catalog.command("DEFI_CONTACT")["keyword"]
    unnamed = []
    whole = {"MODELE": model, "FORMULATION": "CONTINUE", "ALGO_RESO_GEOM": "NEWTON"}
    whole.update((name, given[name]) for name in ("LISSAGE", "VERI_NORM", "STOP_INTERP") if given.get(name) in row[name]["into"])
    parts = [f"{name}={_show(value)}" for name, value in whole.items()]
    kept = [_zone(zone, row["ZONE"]["keyword"]) for zone in zones]
    for n, zone in enumerate(kept):
        for name, value in zone.items():
            if isinstance(value, Concept) and not value.label:
                zone[name] = Name(f"{name}_{n + 1}")
                unnamed.append(f"{zone[name]} = ...  # what ZONE[{n + 1}]/{name} had: a variable of its own")
    lines += unnamed
    written = ",\n    ".join("      _F(" + ", ".join(f"{k}={_show(v)}" for k, v in zone.items()) + ")" for zone in kept)
    lines += [f"{label or 'CONTACT'} = DEFI_CONTACT({', '.join(parts)},", f"    ZONE=(\n    {written},))"]
    left_out = sorted({name for zone in kept for name in zone if name in LEFT_OUT})
    if left_out:
        lines.append(f"# {', '.join(left_out)}: whole patches that meet these nodes stay open; leave it out where it is there for imposed displacements alone")
    if given.get("FROTTEMENT", "SANS") != "SANS":
        lines.append("# without friction, which LAC contact does not have")
    return "\n".join(lines)


def _zone(zone, row):
    """The keywords of a zone that LAC contact has too, under their names and with values that it takes."""
    kept = {"GROUP_MA_MAIT": zone.get("GROUP_MA_MAIT"), "GROUP_MA_ESCL": zone.get("GROUP_MA_ESCL"), "ALGO_CONT": "LAC"}
    if zone.get("TYPE_CONTACT") == "BILATERAL":  # of DEFI_CONT
        kept["GLISSIERE"] = "OUI"
    for name, value in zone.items():
        allowed = row.get(name, {}).get("into")
        if name in row and name not in kept and name not in ONE_VALUE and value is not None and (allowed is None or value in allowed):
            kept[name] = value
    return kept


def _is_cut(mesh, slaves):
    with mesh.open() as file:
        return bool(slaves) and set(slaves) <= set(contents.cut_groups(file))


def _occurrences(zones):
    return [zones] if isinstance(zones, dict) else [zone for zone in zones or () if isinstance(zone, dict)]


def _names(groups):
    return [groups] if isinstance(groups, str) else list(groups or ())


def _show(value):
    if isinstance(value, Concept):
        return value.label or value.id
    if isinstance(value, (list, tuple)):
        return _show(value[0]) if len(value) == 1 else "(" + ", ".join(map(_show, value)) + ")"
    if isinstance(value, Name):
        return str(value)
    return "MODEL" if value is None else repr(value)
