"""Results and tables as a command file sees them."""

from ..base import contents
from ..core import current
from ..core.catalog import part
from ..core.concepts import Concept, listed
from ..core.messages import fail
from ..tables.storage import read_table
from .fields import Field
from .files import print_med


class Result(Concept):
    type = "result"

    def instants(self):
        """[(order number, instant)]"""
        with self.open() as file:
            return contents.instants(file)

    def getIndexes(self):
        return [order for order, _ in self.instants()]

    def getNumberOfIndexes(self):
        return len(self.instants())

    getRanks, getNumberOfRanks = getIndexes, getNumberOfIndexes  # before version 16

    def getLastIndex(self):
        return self.instants()[-1][0]

    def getFirstIndex(self):
        return self.instants()[0][0]

    def getTime(self, index):
        return dict(self.instants())[index]

    getTimeValue = getTime

    def field_names(self):
        return list(self.LIST_CHAMPS())

    getFieldsNames = field_names

    def mesh(self):
        with self.open() as file:
            return self.base.concept(contents.reference(file, "mesh"))

    def field(self, name, order):
        """The Field of an order number; None where there is none."""
        with self.open() as file:
            path = contents.field_file(file, name, order)
        return Field(self.base, path, (self, name, order)) if path else None

    def getField(self, name, value=None, para="NUME_ORDRE", crit="RELATIF", prec=1e-6, index=None, **ignored):
        """The field of an order number, or with para="INST" of an instant. @throws AsterError where there is none"""
        order = value if index is None else index
        instants = self.instants()
        if para == "INST":
            order = self._order_at(instants, order, crit, prec)
        elif para != "NUME_ORDRE":
            raise ValueError(f"getField: para is {para!r}; results here know NUME_ORDRE and INST")
        field = self.field(name, order)
        if field is None:
            if order not in dict(instants):
                fail("TEST_RESU_1", "getField", label=self.label, what=part("order_number", number=order), known=listed(instants))
            known = ", ".join(sorted(self.LIST_CHAMPS())) or part("none")
            fail("RESULT_1", "getField", label=self.label, field=name, order=order, known=known)
        return field

    def _order_at(self, instants, instant, crit, prec):
        """The order number of an instant. @throws AsterError TEST_RESU_1, TEST_RESU_2 where there is none, or several"""
        found = self._orders_near(instant, crit, prec)
        if not found:
            what = part("value_at_instant", instant=f"{instant:.9g}")
            fail("TEST_RESU_1", "getField", label=self.label, what=what, known=listed(instants, instant))
        if len(found) > 1:
            fail("TEST_RESU_2", "getField", instant=f"{instant:.9g}", found=", ".join(f"{t:.10g}" for order, t in instants if order in found))
        return found[0]

    def _orders_near(self, instant, crit, prec):
        scale = abs(instant) if crit == "RELATIF" else 1.0
        return [order for order, t in self.instants() if abs(t - instant) <= prec * scale]

    def getIndexFromParameter(self, para, value, crit="RELATIF", prec=1e-6, throw_except=True):
        """The order number of an instant; -1 where there is not one, or with `throw_except` a ValueError."""
        if para != "INST":
            raise ValueError(f"getIndexFromParameter: para is {para!r}; results here know INST")
        found = self._orders_near(value, crit, prec)
        if len(found) != 1 and throw_except:
            raise ValueError(f"{self.label} has {len(found)} instants at {value:g} within {prec:g}; it has {listed(self.instants(), value)}")
        return found[0] if len(found) == 1 else -1

    def printInfo(self):
        current.commands["INFO_RESU"](RESULTAT=self)

    printListOfFields = printInfo

    def printMedFile(self, path, medname="", local=True):
        """@param medname what names of fields begin with, instead of the result's name"""
        print_med(path, RESULTAT=self, **({"NOM_RESU_MED": medname} if medname else {}))

    def getAccessParameters(self):
        """{"NUME_ORDRE": [...], "INST": [...]}"""
        instants = self.instants()
        return {"NUME_ORDRE": [o for o, _ in instants], "INST": [t for _, t in instants]}

    LIST_VARI_ACCES = getAccessParameters

    def LIST_CHAMPS(self):
        """name of a field -> its order numbers"""
        with self.open() as file:
            return contents.fields(file)

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

    def getMaterialField(self, index=None):
        """Of any order number: it has one."""
        return self._referred("material_field")

    def getLastTime(self):
        return self.instants()[-1][1]

    def getMesh(self):
        return self.mesh()

    def getModel(self, index=None):
        return self._referred("model")

    def _referred(self, what):
        """A concept that the result was computed with; nothing where it was made of fields alone."""
        with self.open() as file:
            identifier = contents.reference(file, what)
        return self.base.concept(identifier) if identifier else None


class Table(Concept):
    type = "table"

    def EXTR_TABLE(self, para=None):
        """Its content, a tables.Table that may be changed; of the columns `para` only, where they are given."""
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
