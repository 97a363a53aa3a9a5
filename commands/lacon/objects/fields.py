"""Fields as a command file sees them."""

from ..base.fields import FieldData, check_place
from ..base.seal import open_checked
from ..core import current
from ..core.concepts import Concept
from ..core.late import numpy
from ..core.nearest import nearest
from .files import print_med


class Arithmetic:
    """Sums, differences and multiples of fields of one layout are fields of their own, made by CREA_CHAMP."""

    def __add__(self, other):
        return _combined((self, 1.0), (other, 1.0))

    def __sub__(self, other):
        return _combined((self, 1.0), (other, -1.0))

    def __mul__(self, factor):
        return _combined((self, factor))

    __rmul__ = __mul__

    def __neg__(self):
        return _combined((self, -1.0))

    def copy(self):
        return _combined((self, 1.0))

    def restrict(self, components=(), groups=()):
        """The field of these components, or all, on these groups (of nodes; else of cells), or everywhere."""
        names = self.content()._names(components)
        return self._part(self.type_of_field(), groups, NOM_CMP=names)

    def asPhysicalQuantity(self, quantity, components):
        """The field of another quantity. @param components its name here -> its name there"""
        kind = f"{self.type_of_field().partition('_')[0]}_{quantity}"
        return self._part(kind, (), NOM_CMP=self.content()._names(components), NOM_CMP_RESU=list(components.values()))

    def _part(self, kind, groups, **more):
        mesh = self.getMesh()
        groups = [groups] if isinstance(groups, str) else list(groups)
        keyword = "GROUP_NO" if groups and groups[0] in mesh.getGroupsOfNodes() and kind.startswith("NOEU") else "GROUP_MA"
        part = {"CHAM_GD": self.concept(), **({keyword: groups} if groups else {"TOUT": "OUI"}), **more}
        where = {"MODELE": self._model()} if kind.startswith("ELGA") else {"MAILLAGE": mesh}
        return current.commands["CREA_CHAMP"](OPERATION="ASSE", TYPE_CHAM=kind, ASSE=part, **where)



def _combined(*terms):
    """@param terms (field, factor)"""
    if not all(isinstance(field, Arithmetic) and isinstance(factor, (int, float)) for field, factor in terms):
        return NotImplemented
    parts = [{"CHAM_GD": field.concept(), "COEF_R": float(factor)} for field, factor in terms]
    return current.commands["CREA_CHAMP"](OPERATION="COMB", TYPE_CHAM=terms[0][0].type_of_field(), COMB=parts)


class Field(Arithmetic, FieldData):
    """A field at one instant, with the methods of code_aster's fields."""

    def __init__(self, base, path, origin=None):
        """@param path of its file, relative to the base  @param origin of a field of a result: (result, its name there, order number)"""
        with open_checked(base.folder / path) as file:
            super().__init__(file)
            if origin:
                check_place(base.folder / path, file, *origin[1:])
        self.base = base
        self._origin = origin

    def concept(self):
        """It as a concept of its own."""
        result, name, order = self._origin
        return current.commands["CREA_CHAMP"](OPERATION="EXTR", TYPE_CHAM=self.type(), RESULTAT=result, NOM_CHAM=name, NUME_ORDRE=order)

    def type_of_field(self):
        return self.type()

    def content(self):
        return self

    def _model(self):
        return self._origin[0].getModel()

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        known = [k for k in dir(type(self)) if not k.startswith("_")]
        raise AttributeError(f"{self.name}, a field, has no '{name}' here{nearest(name, known)}")

    def printMedFile(self, path, local=True):
        result, name, order = self._origin
        print_med(path, RESULTAT=result, NOM_CHAM=name, NUME_ORDRE=order)

    def mesh(self):
        return self.base.concept(self.mesh_id)

    def __repr__(self):
        return f"<field {self.name} ({self.location}) {', '.join(self.components)}>"

    getMesh = mesh

    def getName(self):
        return self.name

    def getComponents(self):
        return list(self.components)

    def getNumberOfComponents(self):
        return len(self.components)

    def getPhysicalQuantity(self):
        return self.quantity

    def getLocalization(self):
        return self.location

    def norm(self, kind="NORM_2", components=()):
        """Of the values that exist, of these components or of all: the sum of magnitudes (NORM_1), the root of the sum of squares (NORM_2) or the largest
        magnitude (NORM_INFINITY)."""
        orders = {"NORM_1": 1, "NORM_2": 2, "NORM_INFINITY": numpy.inf}
        if kind not in orders:
            raise ValueError(f"norm: {kind!r} is none of {', '.join(orders)}")
        parts = [self.values[self.counted[:, column], column] for column in map(self.components.index, self._names(components))]
        values = numpy.concatenate(parts)
        return float(numpy.linalg.norm(values, orders[kind])) if len(values) else 0.0

    def dot(self, other):
        """The sum of the products of the values that both have."""
        other = other.content() if isinstance(other, FieldConcept) else other
        if self.components != other.components or self.values.shape != other.values.shape or (self.support != other.support).any():
            raise ValueError(f"dot: {self.name} and {other.name} have not the same components at the same places")
        return float((self.values * other.values)[self.counted & other.counted].sum())

    def toSimpleFieldOnNodes(self):
        return SimpleField(self, on_nodes=True)

    def toSimpleFieldOnCells(self):
        return SimpleField(self, on_nodes=False)

    def getValuesWithDescription(self, components=(), groups=()):
        """Values that exist, node after node (x1, y1, z1, x2, ...), of nodes in these groups (of nodes, or of cells: their nodes), or of cells in them
        point after point.
        @return (values, (numbers of the nodes from 0, names of the components)), of a field of cells (values, (cells, points, subpoints)), all from 0"""
        rows, columns = self._places(components, groups)
        values, (owner, place) = self.values[rows, columns].tolist(), self.rows()
        if self.location != "NOEU":
            return values, (owner[rows].tolist(), place[rows].tolist(), [0] * len(rows))
        return values, (self.support[rows].tolist(), [self.components[column] for column in columns])

    def getValues(self, components=(), groups=()):
        """As getValuesWithDescription: the values alone."""
        return self.values[self._places(components, groups)].tolist()

    def EXTR_COMP(self, component=" ", groups=(), topo=0):
        """code_aster's older way: .valeurs (array); with topo=1 .noeud or .maille, .point, .sous_point (numbers from 1) and .comp."""
        return Extract(self, self._chosen([component] if component.strip() else (), groups), topo)

    def _names(self, components):
        names = [components] if isinstance(components, str) else list(components) or self.components
        unknown = [name for name in names if name not in self.components]
        if unknown:
            raise ValueError(f"{self.name} has no component {unknown[0]}; it has {', '.join(self.components)}")
        return names

    def _places(self, components, groups):
        """(rows, columns) of what _chosen() has, row after row."""
        chosen = self._chosen(components, groups)
        rows = numpy.concatenate([rows for _, rows in chosen])
        columns = numpy.concatenate([numpy.full(len(rows), self.components.index(name)) for name, rows in chosen])
        order = numpy.argsort(rows, kind="stable")
        return rows[order], columns[order]

    def _chosen(self, components, groups):
        """[(component, rows of the groups where it exists)]"""
        names = self._names(components)
        groups = [groups] if isinstance(groups, str) else list(groups)
        owner, _ = self.rows()
        wanted = numpy.ones(len(owner), bool)
        there = self.present if groups or self.location != "NOEU" else self.counted  # a node that is named has its stand-in too
        if groups:
            mesh = self.mesh()
            members = mesh.getNodes(groups) if self.location == "NOEU" else mesh.getCells(groups)
            wanted = numpy.isin(owner, members)
        return [(name, numpy.flatnonzero(wanted & there[:, self.components.index(name)])) for name in names]


class Extract:
    """What EXTR_COMP returns."""

    def __init__(self, field, chosen, topo):
        rows = numpy.concatenate([rows for _, rows in chosen]) if chosen else numpy.zeros(0, int)
        columns = numpy.concatenate([numpy.full(len(rows), field.components.index(name)) for name, rows in chosen]) if chosen else rows
        self.valeurs = field.values[rows, columns]
        if topo:
            owner, place = field.rows()
            if field.location == "NOEU":
                self.noeud = (owner[rows] + 1).tolist()
            else:
                self.maille = (owner[rows] + 1).tolist()
                self.point = (place[rows] + 1).tolist()
                self.sous_point = [1] * len(rows)
            self.comp = [name for name, rows in chosen for _ in rows]


class SimpleField:
    """A field as two arrays: of nodes over the whole mesh, of cells over those that have values."""

    def __init__(self, field, on_nodes):
        self._field = field
        if on_nodes != (field.location == "NOEU"):
            ask, own = ("toSimpleFieldOnNodes", "toSimpleFieldOnCells") if on_nodes else ("toSimpleFieldOnCells", "toSimpleFieldOnNodes")
            raise TypeError(f"{ask}: {field.name} is a field of type {field.type()}; take {own}")

    def getComponents(self):
        return list(self._field.components)

    def getNumberOfComponents(self):
        return len(self._field.components)

    def getComponent(self, index):
        return self._field.components[index]

    def getPhysicalQuantity(self):
        return self._field.quantity

    def getLocalization(self):
        return self._field.location

    def getMesh(self):
        return self._field.mesh()

    def getNumberOfNodes(self):
        return self._field.mesh().getNumberOfNodes()

    def getNumberOfCells(self):
        return self._field.mesh().getNumberOfCells()

    def getCellsWithValues(self):
        """Numbers of the cells whose rows getValues() returns, from 0."""
        return self._field.support.tolist()

    def getNumberOfPointsOfCell(self, cell):
        """0 where the cell has no values."""
        first, last = self._rows(cell)
        return last - first

    def _rows(self, owner):
        """(first, last + 1) of the rows of a cell or node; (0, 0) where it has none."""
        field, at = self._field, numpy.flatnonzero(self._field.support == owner)
        if not len(at):
            return 0, 0
        at = int(at[0])
        return (at, at + 1) if field.offset is None else (int(field.offset[at]), int(field.offset[at + 1]))

    def hasValue(self, owner, component, point=0, subpoint=0):
        """Whether a node, or a cell at a point (or node of it), has a component, named or by its number from 0."""
        first, last = self._rows(owner)
        column = self._column(component)
        return bool(column is not None and subpoint == 0 and 0 <= point < last - first and self._field.present[first + point, column])

    def getValue(self, owner, component, point=0, subpoint=0):
        if not self.hasValue(owner, component, point, subpoint):
            raise ValueError(f"{self._field.name} has no {component} at {owner}, point {point}")
        return float(self._field.values[self._rows(owner)[0] + point, self._column(component)])

    def _column(self, component):
        names = self._field.components
        if isinstance(component, str):
            return names.index(component) if component in names else None
        return component if 0 <= component < len(names) else None

    def getValues(self, copy=True):
        """@return (values, mask), of nodes (nodes of the mesh, components), of cells (points or nodes of cells that have values,
        components); mask is true where the component exists"""
        field = self._field
        if field.location != "NOEU":
            return field.values, field.present
        return field.on_nodes(self.getNumberOfNodes())

    toNumpy = getValues


class FieldConcept(Arithmetic, Concept):
    """A field of its own, of CREA_CHAMP; what a field of a result does, it does too."""

    type = "field"

    def concept(self):
        return self

    def type_of_field(self):
        return self.content().type()

    def _model(self):
        return None  # which a field of its own does not know

    def printMedFile(self, path, local=True):
        print_med(path, CHAM_GD=self, NOM_CHAM_MED=self.label or self.content().quantity)

    def content(self):
        """A Field."""
        return Field(self.base, self.base.path(self.id).relative_to(self.base.folder))

    def __getattr__(self, name):
        if not name.startswith("_") and callable(getattr(Field, name, None)):
            return getattr(self.content(), name)
        return super().__getattr__(name)
