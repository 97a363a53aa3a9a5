"""A contact that was made and then forgotten: bodies pass through one another, and the run ends well.

The registry of the base keeps which contacts no command was given yet, since what uses them may follow POURSUITE.
"""

from ..core.concepts import concepts_in

_key = "unused_contacts"  #: id -> {"label", "where", "model", "solved": what computed this model without any contact since}


def forget(study):
    """DEBUT: every contact is made again."""
    study.base.registry.pop(_key, None)


def note(study, command, row, keywords, where, result):
    """A command has ended well."""
    waiting = study.base.registry.get(_key, {})
    for item in concepts_in(keywords):
        waiting.pop(item.id, None)
    if row.get("result") == "contact":
        entry = {"label": result.label or result.id, "where": where, "model": keywords["MODELE"].id, "solved": ""}
        study.base.registry.setdefault(_key, {})[result.id] = entry
    elif row.get("solves") and "CONTACT" not in keywords:
        for entry in waiting.values():
            if entry["model"] == keywords["MODELE"].id:
                entry["solved"] = f"{command} ({where})"


def tell(study):
    """FIN: STUDY_42 of each contact that a computation went without."""
    for entry in study.base.registry.get(_key, {}).values():
        solved, entry["solved"] = entry["solved"], ""
        if solved:
            study.inform("STUDY_42", f"DEFI_CONTACT, {entry['where']}", label=entry["label"], solved=solved)
