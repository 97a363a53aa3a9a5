"""What keywords hold beside numbers and texts: concepts, names of concepts that are yet to be made, occurrences of factor keywords."""

import json

from .messages import fail
from .nearest import nearest

#: type of a concept -> the part that says it
types = {"concept": "type_concept", "contact": "type_contact", "element_characteristics": "type_element_characteristics", "field": "type_field", "formula":
         "type_formula", "function": "type_function", "list_of_integers": "type_list_of_integers", "list_of_reals": "type_list_of_reals", "load": "type_load",
         "material": "type_material", "material_field": "type_material_field", "mesh": "type_mesh", "model": "type_model", "result": "type_result", "table":
         "type_table", "time_steps": "type_time_steps"}


class Concept:
    """What a command made, as the variable it was assigned to holds it. Two variables of one concept are one Python object.

    objects/ has a class for each type of concept, with the methods that command files call.
    """

    type = "concept"

    def __init__(self, base, identifier, label=""):
        self.base = base
        self.id = identifier
        self.label = label
        self.destroyed = ""  #: where DETRUIRE took it out of the study

    def __repr__(self):
        return f"<{self.type} {self.label or self.id}>"

    def __bool__(self):
        return True  # a table without rows too

    def getName(self):
        """The variable it was assigned to."""
        return self.label

    @property
    def userName(self):
        return self.label

    def getType(self):
        return self.type

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        known = [k for k in dir(type(self)) if not k.startswith("_")]
        raise AttributeError(f"{self.label or self.id}, a {self.type.replace('_', ' ')}, has no '{name}' here{nearest(name, known)}")

    def open(self):
        """Its HDF5 file, open for reading. @throws AsterError KEYWORD_14 behind DETRUIRE"""
        if self.destroyed:
            fail("KEYWORD_14", path=self.type, label=self.label or self.id, place=self.destroyed)
        return self.base.open(self.id)


class CO:
    """A name given beforehand to a concept that a command will make: the object itself becomes that concept."""

    def __init__(self, name):
        self.name = str(name)

    def __repr__(self):
        return f"CO({self.name!r})"

    def become(self, base, identifier):
        """Be the concept `identifier` of a base from now on, wherever this object is held."""
        kind, label = base.kinds[type_of(identifier)], self.name
        self.__dict__.clear()
        self.__class__ = kind
        self.__init__(base, identifier, label)
        base.enter(self)


class _F(dict):
    """An occurrence of a factor keyword: _F(GROUP_MA='A', PRES=1.0)."""

    def __init__(self, *args, **keywords):
        super().__init__(*args, **keywords)


def type_of(identifier):
    """"material_field_3" -> "material_field\""""
    return identifier.rpartition("_")[0]


def to_json(value):
    """Keywords as an order holds them: a concept becomes {"concept": id}."""
    if isinstance(value, Concept):
        return {"concept": value.id}
    if isinstance(value, dict):
        return {k: to_json(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [to_json(v) for v in value]
    return value


def dumps(value):
    return json.dumps(to_json(value), ensure_ascii=False)


def concepts_in(value):
    """Every concept that keywords refer to, without repetition."""
    found = {}

    def visit(item):
        if isinstance(item, Concept):
            found[item.id] = item
        elif isinstance(item, dict):
            for v in item.values():
                visit(v)
        elif isinstance(item, (list, tuple)):
            for v in item:
                visit(v)

    visit(value)
    return list(found.values())


def listed(instants, near=None):
    """The first order numbers and instants of a result, for messages; those that lie nearest to the instant `near`, where it is given."""
    nearest = range(len(instants)) if near is None else sorted(range(len(instants)), key=lambda i: abs(instants[i][1] - near))
    shown = sorted(nearest[:12])
    said = [f"{order} (INST {t:.9g})" for order, t in (instants[i] for i in shown)]
    return ", ".join(["..."] * (bool(shown) and shown[0] > 0) + said + ["..."] * (bool(shown) and shown[-1] < len(instants) - 1))
