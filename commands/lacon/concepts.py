"""Concepts as a command file sees them: small objects that know their id in the base and read their file when asked."""

import json


class Concept:
    """What a command made. Two variables of one concept are one Python object."""

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
        from .checker import nearest

        known = [k for k in dir(type(self)) if not k.startswith("_")]
        raise AttributeError(f"{self.label or self.id}, a {self.type.replace('_', ' ')}, has no '{name}' here{nearest(name, known)}")

    def open(self):
        """Its HDF5 file, open for reading."""
        return self.base.open(self.id)


class Mesh(Concept):
    type = "mesh"

    def _shape(self, name):
        with self.open() as file:
            return file[name].shape[0]

    def getNumberOfNodes(self):
        return self._shape("coordinates")

    def getNumberOfCells(self):
        return self._shape("cells/type")

    def getDimension(self):
        with self.open() as file:
            return int(file.attrs["dimension"])

    def getCoordinates(self):
        return Coordinates(self)

    def group(self, kind, name):
        """Members of a group, 0-based; None where there is no such group. `kind` is "cells" or "nodes"."""
        with self.open() as file:
            groups = file.get(f"groups/{kind}")
            names = [] if groups is None else list(groups["name"].asstr()[:])
            if name not in names:
                return None
            k = names.index(name)
            first, last = groups["offset"][k], groups["offset"][k + 1]
            return groups["values"][first:last]

    def group_names(self, kind):
        with self.open() as file:
            groups = file.get(f"groups/{kind}")
            return [] if groups is None else list(groups["name"].asstr()[:])

    def getGroupsOfCells(self, local=False):
        return self.group_names("cells")

    def getGroupsOfNodes(self, local=False):
        return self.group_names("nodes")

    def hasGroupOfCells(self, name, local=False):
        return name in self.group_names("cells")

    def hasGroupOfNodes(self, name, local=False):
        return name in self.group_names("nodes")

    def getCells(self, groups=()):
        """Numbers from 0 of the cells of a group or of several, in the mesh's order; of all without groups."""
        if not groups:
            return list(range(self.getNumberOfCells()))
        return sorted({int(cell) for name in _names(groups) for cell in self._members("cells", name)})

    def getNodes(self, groups=()):
        """Numbers from 0 of the nodes of groups (of nodes; else of cells: their nodes), in the mesh's order; of all without groups."""
        if not groups:
            return list(range(self.getNumberOfNodes()))
        found = set()
        for name in _names(groups):
            if name in self.group_names("nodes"):
                found.update(self._members("nodes", name).tolist())
            else:
                found.update(self.getNodesFromCells(name))
        return sorted(found)

    def getNodesFromCells(self, groups):
        connectivity = self.getConnectivity()
        return sorted({node for cell in self.getCells(groups) for node in connectivity[cell]})

    def _members(self, kind, name):
        members = self.group(kind, name)
        if members is None:
            from .checker import nearest

            known = self.group_names(kind)
            raise ValueError(f"{self.label or self.id} has no group of {kind} '{name}'{nearest(name, known)}")
        return members

    def getConnectivity(self):
        """Nodes of each cell, from 0, in the order of catalog/cells.toml."""
        with self.open() as file:
            offset, nodes = file["cells/offset"][:].tolist(), file["cells/nodes"][:].tolist()
        return [nodes[first:last] for first, last in zip(offset[:-1], offset[1:])]

    def getCellTypeName(self, cell):
        """"TRIA6\""""
        from .fields import texts

        with self.open() as file:
            return texts(file["cells"], "types")[file["cells/type"][cell]]

    def isParallel(self):
        return False

    def getCellName(self, cell):
        return f"M{cell + 1}"

    def getNodeName(self, node):
        return f"N{node + 1}"

    def LIST_GROUP_MA(self):
        """[(name, number of cells)]"""
        return [(name, len(self._members("cells", name))) for name in self.group_names("cells")]

    def LIST_GROUP_NO(self):
        """[(name, number of nodes)]"""
        return [(name, len(self._members("nodes", name))) for name in self.group_names("nodes")]


class Coordinates:
    """What Mesh.getCoordinates() returns."""

    def __init__(self, mesh):
        self._mesh = mesh

    def toNumpy(self):
        """(n, 3) array"""
        with self._mesh.open() as file:
            return file["coordinates"][:]

    def __getitem__(self, node):
        """[x, y, z] of a node, counted from 0"""
        with self._mesh.open() as file:
            return file["coordinates"][node].tolist()

    def getValues(self):
        """x1, y1, z1, x2, ... as a list"""
        return self.toNumpy().ravel().tolist()


class FieldConcept(Concept):
    """A field of its own, of CREA_CHAMP; what a field of a result does, it does too."""

    type = "field"

    def content(self):
        """A fields.Field."""
        from .fields import read_field

        return read_field(self.base, self.base.path(self.id).relative_to(self.base.folder))

    def __getattr__(self, name):
        from .fields import Field

        if not name.startswith("_") and callable(getattr(Field, name, None)):
            return getattr(self.content(), name)
        return super().__getattr__(name)


class Model(Concept):
    type = "model"

    def getMesh(self):
        with self.open() as file:
            return self.base.concept(_text(file.attrs["mesh"]))


class Material(Concept):
    type = "material"


class MaterialField(Concept):
    type = "material_field"


class Load(Concept):
    type = "load"


class Contact(Concept):
    type = "contact"


class ListOfReals(Concept):
    type = "list_of_reals"

    def getValues(self):
        with self.open() as file:
            return file["values"][:].tolist()

    Valeurs = getValues


class TimeSteps(ListOfReals):
    type = "time_steps"


class Function(Concept):
    type = "function"
    _points = None

    def points(self):
        """A functions.Piecewise with its points and rules."""
        if self._points is None:
            from .functions import read_function

            self._points = read_function(self)
        return self._points

    def __call__(self, x):
        """The value at x, a number or an array. @throws AsterError outside its points where they are not prolonged"""
        return self.points().value(x, self.label or self.id)

    def on_arrays(self, x):
        """The values at an array of points."""
        return self.points().value(x, self.label or self.id)

    def Absc(self):
        return list(self.points().x)

    def Ordo(self):
        return list(self.points().y)

    def Valeurs(self):
        return [self.Absc(), self.Ordo()]

    def getValues(self):
        return self.Absc() + self.Ordo()


class Formula(Concept):
    type = "formula"
    _expression = None

    def expression(self):
        """A formulas.Expression."""
        if self._expression is None:
            from .formulas import read_formula

            self._expression = read_formula(self)
        return self._expression

    def __call__(self, *values, **named):
        """Its value at a point, parameters in their order or by name. @throws AsterError where it has none"""
        expression = self.expression()
        point = dict(zip(expression.parameters, values), **named)
        if len(values) > len(expression.parameters) or set(point) != set(expression.parameters):
            raise TypeError(f"{self.label or self.id} takes the parameters {', '.join(expression.parameters)}")
        return expression.value(point, self.label or self.id)

    def on_arrays(self, *columns):
        """The values at points given by an array, or one value for all, of each parameter in their order."""
        import numpy

        columns = numpy.broadcast_arrays(*map(numpy.asarray, columns))
        expression = self.expression()
        if len(columns) != len(expression.parameters):
            raise TypeError(f"{self.label or self.id} takes the parameters {', '.join(expression.parameters)}")
        flat = dict(zip(expression.parameters, (c.ravel() for c in columns)))
        return expression.values_at(flat, columns[0].size, self.label or self.id).reshape(columns[0].shape)

    def getVariables(self):
        return list(self.expression().parameters)

    def getExpression(self):
        return self.expression().text


def listed(instants):
    """The first order numbers and instants of a result, for messages."""
    return ", ".join(f"{order} (INST {t:g})" for order, t in instants[:12]) + (", ..." if len(instants) > 12 else "")


class Result(Concept):
    type = "result"

    def instants(self):
        """[(order number, instant)]"""
        with self.open() as file:
            return list(zip(file["order"][:].tolist(), file["instant"][:].tolist()))

    def getIndexes(self):
        return [order for order, _ in self.instants()]

    def getNumberOfIndexes(self):
        return len(self.instants())

    def getLastIndex(self):
        return self.instants()[-1][0]

    def getTime(self, index):
        return dict(self.instants())[index]

    def field_names(self):
        with self.open() as file:
            return sorted(file["fields"]) if "fields" in file else []

    getFieldsNames = field_names

    def mesh(self):
        with self.open() as file:
            return self.base.concept(_text(file.attrs["mesh"]))

    def field(self, name, order):
        """The field of an order number, a fields.Field; None where there is none."""
        from .fields import read_field

        with self.open() as file:
            group = file.get(f"fields/{name}")
            if group is None:
                return None
            orders = group["order"][:].tolist()
            if order not in orders:
                return None
            path = group["file"].asstr()[orders.index(order)]
        return read_field(self.base, path)

    def getField(self, name, value=None, para="NUME_ORDRE", crit="RELATIF", prec=1e-6, index=None, **ignored):
        """The field of an order number, or with para="INST" of an instant. @throws AsterError where there is none"""
        from .messages import fail

        order = value if index is None else index
        instants = self.instants()
        if para == "INST":
            scale = abs(order) if crit == "RELATIF" else 1.0
            found = [o for o, t in instants if abs(t - order) <= prec * scale]
            order = found[0] if len(found) == 1 else f"(INST {order:g})"
        elif para != "NUME_ORDRE":
            raise ValueError(f"getField: para is {para!r}; results here know NUME_ORDRE and INST")
        field = self.field(name, order)
        if field is None:
            if isinstance(order, int) and order not in dict(instants):
                fail("TEST_RESU_1", "getField", label=self.label, what=f"order number {order}", known=listed(instants))
            known = ", ".join(sorted(self.LIST_CHAMPS())) or "none"
            fail("RESULT_1", "getField", label=self.label, field=name, order=order, known=known)
        return field

    def getAccessParameters(self):
        """{"NUME_ORDRE": [...], "INST": [...]}"""
        instants = self.instants()
        return {"NUME_ORDRE": [o for o, _ in instants], "INST": [t for _, t in instants]}

    LIST_VARI_ACCES = getAccessParameters

    def LIST_CHAMPS(self):
        """name of a field -> its order numbers"""
        with self.open() as file:
            return {name: file["fields"][name]["order"][:].tolist() for name in file.get("fields", ())}

    def LIST_PARA(self):
        """Names of its parameters."""
        with self.open() as file:
            return ["INST", "NUME_ORDRE", *file.get("parameters", ())]

    def _names_at(self, on_nodes):
        orders = self.LIST_CHAMPS()
        return [name for name in orders if (self.field(name, orders[name][0]).location == "NOEU") == on_nodes]

    def getFieldsOnNodesRealNames(self):
        return self._names_at(True)

    def getFieldsOnCellsRealNames(self):
        return self._names_at(False)

    def getMaterialField(self):
        with self.open() as file:
            return self.base.concept(_text(file.attrs["material_field"]))

    def getLastTime(self):
        return self.instants()[-1][1]

    def getMesh(self):
        return self.mesh()

    def getModel(self):
        with self.open() as file:
            return self.base.concept(_text(file.attrs["model"]))



class Table(Concept):
    type = "table"

    def EXTR_TABLE(self, para=None):
        """Its content, a tables.Table that may be changed; of the columns `para` only, where they are given."""
        from .tables import read_table

        with self.open() as file:
            table = read_table(file)
        table.nom = self.label
        return table if para is None else table[[para] if isinstance(para, str) else para]

    def __getitem__(self, key):
        """The cell (column, row), rows counted from 1; None where it is missing."""
        return self.EXTR_TABLE().cell(*key)

    def __len__(self):
        return len(self.EXTR_TABLE())

    def getNumberOfLines(self):
        return len(self)

    def getParameters(self):
        return self.EXTR_TABLE().para

    def getColumnType(self, name):
        return self.EXTR_TABLE().kind(name)

    def getValues(self, name):
        """(numbers of the rows that have the cell, from 1; their values)"""
        column = enumerate(self.EXTR_TABLE()[name], 1)
        return tuple(map(list, zip(*((i, v) for i, v in column if v is not None)))) or ([], [])

    def get_nrow(self):
        return len(self)

    get_nom_para = getParameters

    def TITRE(self):
        return self.EXTR_TABLE().titr

    def values(self):
        """column -> list of its cells"""
        return self.EXTR_TABLE().values()


_types = {c.type: c for c in (Mesh, Model, Material, MaterialField, Load, Contact, FieldConcept, ListOfReals, TimeSteps, Function, Formula, Result,
                           Table)}


def type_of(identifier):
    """"material_field_3" -> "material_field\""""
    return identifier.rpartition("_")[0]


def make(base, identifier, label=""):
    """The object of a concept by its id."""
    return _types[type_of(identifier)](base, identifier, label)


def known_type(identifier):
    return type_of(identifier) in _types and identifier.rpartition("_")[2].isdigit()


class CO:
    """A name given beforehand to a concept that a command will make: the object itself becomes that concept."""

    def __init__(self, name):
        self.name = str(name)

    def __repr__(self):
        return f"CO({self.name!r})"

    def become(self, base, identifier):
        """Be the concept `identifier` of a base from now on, wherever this object is held."""
        kind, label = _types[type_of(identifier)], self.name
        self.__dict__.clear()
        self.__class__ = kind
        self.__init__(base, identifier, label)
        base.enter(self)


def _names(groups):
    return [groups] if isinstance(groups, str) else list(groups)


def _text(value):
    return value.decode() if isinstance(value, bytes) else value


def to_json(value):
    """Keywords as an order holds them: a concept becomes {"concept": id}."""
    if isinstance(value, Concept):
        return {"concept": value.id}
    if isinstance(value, dict):
        return {k: to_json(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [to_json(v) for v in value]
    return value


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


def dumps(value):
    return json.dumps(to_json(value), ensure_ascii=False)
