"""Tables: named columns of integers (I), reals (R) or texts (K8, K16, K24, K32, K80), and rows in which cells may be missing.

`Table` is what EXTR_TABLE() gives a command file, under the names of code_aster's class; every table command works on it.
docs/structures.md, section 2, says how it is stored.
"""

import numbers
import re

from ..core.concepts import _F
from ..core.late import numpy
from ..core.nearest import nearest
from . import printing

texts = ("K8", "K16", "K24", "K32", "K80")


def type_of(values):
    """Type of a column with these values, missing ones being None."""
    there = [v for v in values if v is not None]
    if any(isinstance(v, str) for v in there):
        longest = max(len(str(v)) for v in there)
        return next((kind for kind in texts if longest <= int(kind[1:])), "K80")
    return "I" if there and all(isinstance(v, numbers.Integral) and not isinstance(v, bool) for v in there) else "R"


def joined_type(first, second):
    """Type of a column with cells of both types, None where one holds texts and the other numbers."""
    if first == second:
        return first
    if first in texts and second in texts:
        return max(first, second, key=texts.index)
    return None if first in texts or second in texts else "R"


class Column(list):
    """The cells of a column, None where one is missing. A comparison gives the table of the rows where it holds."""

    __hash__ = None

    def __init__(self, table, name):
        super().__init__(row.get(name) for row in table.rows)
        self.table, self.name = table, name

    def _rows(self, holds):
        return Table([row for row, value in zip(self.table.rows, self) if value is not None and holds(value)],
                     self.table.para, self.table.type, self.table.titr)

    def equal(self, target, tolerance=0.0, relative=True):
        """Rows equal to `target`, or to one of several; numbers within `tolerance`."""
        targets = list(target) if isinstance(target, (list, tuple)) else [target]
        return self._rows(lambda value: any(_same(value, t, tolerance, relative) for t in targets))

    def different(self, target, tolerance=0.0, relative=True):
        targets = list(target) if isinstance(target, (list, tuple)) else [target]
        return self._rows(lambda value: not any(_same(value, t, tolerance, relative) for t in targets))

    def __eq__(self, target):
        return self.equal(target)

    def __ne__(self, target):
        return self.different(target)

    def __lt__(self, target):
        return self._rows(lambda value: value < target)

    def __le__(self, target):
        return self._rows(lambda value: value <= target)

    def __gt__(self, target):
        return self._rows(lambda value: value > target)

    def __ge__(self, target):
        return self._rows(lambda value: value >= target)

    def REGEXP(self, pattern):
        return self._rows(lambda value: re.search(pattern, value.strip()) is not None)

    def VIDE(self):
        return Table([row for row, value in zip(self.table.rows, self) if value is None], self.table.para, self.table.type, self.table.titr)

    def NON_VIDE(self):
        return self._rows(lambda value: True)

    def _extreme(self, choose, measure):
        best = choose((measure(v) for v in self if v is not None), default=None)
        return self._rows(lambda value: measure(value) == best)

    def MAXI(self):
        return self._extreme(max, lambda v: v)

    def MINI(self):
        return self._extreme(min, lambda v: v)

    def MAXI_ABS(self):
        return self._extreme(max, abs)

    def MINI_ABS(self):
        return self._extreme(min, abs)

    def values(self):
        return [v for v in self if v is not None]

    def not_none_values(self):
        return self.values()


def _same(value, target, tolerance, relative):
    if isinstance(value, str) or isinstance(target, str):
        return isinstance(value, str) and isinstance(target, str) and value.strip() == target.strip()
    return abs(value - target) <= tolerance * (abs(target) if relative else 1.0)


class Table:
    """rows: list of dict, column -> value; para, type: columns and their types; titr: title."""

    def __init__(self, rows=(), para=(), typ=(), titr="", nom=""):
        self.para = list(para)
        self.rows = [{k: v for k, v in row.items() if k in self.para} if self.para else dict(row) for row in rows]
        if not self.para:
            self.para = list(dict.fromkeys(k for row in self.rows for k in row))
        self.type = list(typ) or [type_of([row.get(name) for row in self.rows]) for name in self.para]
        self.titr = "\n".join(titr) if isinstance(titr, (list, tuple)) else titr
        self.nom = nom

    @classmethod
    def of_columns(cls, columns, title=""):
        """@param columns name -> (type, values), None where a cell is missing; short columns end in missing cells"""
        length = max((len(values) for _, values in columns.values()), default=0)
        rows = [{name: values[i] for name, (_, values) in columns.items() if i < len(values) and values[i] is not None}
                for i in range(length)]
        return cls(rows, list(columns), [kind for kind, _ in columns.values()], title)

    # ---------------------------------------------------------------------------------------------- reading

    def __len__(self):
        return len(self.rows)

    def __iter__(self):
        return iter(self.rows)

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __getitem__(self, key):
        """A column by its name; the table of some columns by a list of names; a cell by (column, row), rows from 1."""
        if isinstance(key, tuple) and len(key) == 2 and isinstance(key[1], numbers.Integral):
            return self.cell(*key)
        if isinstance(key, (list, tuple)):
            return Table([{k: v for k, v in row.items() if k in key} for row in self.rows], [self._known(k) for k in key],
                         [self.kind(k) for k in key], self.titr)
        return Column(self, self._known(key))

    def _known(self, name):
        if name not in self.para:
            raise KeyError(f"the table has no column {name}{nearest(name, self.para)}; it has {', '.join(self.para)}")
        return name

    def cell(self, name, number):
        """The value of column `name` in row `number`, counted from 1; None where it is missing."""
        self._known(name)
        if not 1 <= number <= len(self.rows):
            raise IndexError(f"row {number} of a table with the rows 1 to {len(self.rows)}")
        return self.rows[number - 1].get(name)

    def kind(self, name):
        """"I", "R", "K8", ... of a column"""
        return self.type[self.para.index(self._known(name))]

    def values(self):
        """column -> list of its cells, None where one is missing"""
        return {name: [row.get(name) for row in self.rows] for name in self.para}

    def EXTR_TABLE(self):
        return self

    def Impr(self, FICHIER=None, FORMAT="TABLEAU"):
        """Print it, to a file or the output of the run; FORMAT is TABLEAU or ASTER."""
        if FORMAT not in ("TABLEAU", "ASTER"):
            raise ValueError(f"Impr: FORMAT is {FORMAT!r}; take TABLEAU or ASTER, or IMPR_TABLE for curves")
        text = printing.aster(self) if FORMAT == "ASTER" else printing.columns(self)
        if FICHIER is None:
            print(text)
            return
        with open(FICHIER, "a", encoding="utf-8") as file:
            file.write(text + "\n")

    ImprTabl = Impr

    def Array(self, *names):
        """The columns as a numpy array, rows with a missing cell left out."""
        return numpy.array([[row[n] for n in names] for row in self.rows if all(row.get(n) is not None for n in names)], float)

    def dict_CREA_TABLE(self):
        """Keywords of CREA_TABLE that make this table, without columns that have no value."""
        lists = []
        for name, kind in zip(self.para, self.type):
            numbered = [(i, row[name]) for i, row in enumerate(self.rows, 1) if row.get(name) is not None]
            if not numbered:
                continue
            factor = _F({"PARA": name, "LISTE_" + kind[0]: [v for _, v in numbered]})
            if len(numbered) < len(self.rows):
                factor["NUME_LIGN"] = [i for i, _ in numbered]
            if kind[0] == "K":
                factor["TYPE_K"] = kind
            lists.append(factor)
        return {"LISTE": lists, **({"TITRE": self.titr} if self.titr else {})}

    # ---------------------------------------------------------------------------------------------- changing

    def copy(self):
        return Table(self.rows, self.para, self.type, self.titr, self.nom)

    def append(self, row):
        """Add a row; new columns are those of its keys, and a column of integers that gets a real becomes one of reals."""
        for name, value in row.items():
            if name not in self.para:
                self.para.append(name)
                self.type.append(type_of([value]))
            elif value is not None:
                self._widen(name, type_of([value]), repr(value))
        self.rows.append({k: v for k, v in row.items() if v is not None})

    def _widen(self, name, kind, what):
        at = self.para.index(name)
        both = joined_type(self.type[at], kind)
        if both is None:
            raise TypeError(f"the column {name} of the table holds {'texts' if self.type[at] in texts else 'numbers'}, and {what} is none")
        self.type[at] = both

    def add_row(self, cells):
        """Append a row given as column -> (type, value); columns that are new get their type from it."""
        for name, (kind, _) in cells.items():
            if name not in self.para:
                self.add_column(name, kind, [])
        self.append({name: value for name, (_, value) in cells.items()})

    def extend(self, rows):
        for row in rows:
            self.append(row)

    def add_column(self, name, kind, values):
        """Set or add a column; None where a cell is missing. Further values make further rows."""
        if name in self.para:
            self.type[self.para.index(name)] = kind
        else:
            self.para.append(name)
            self.type.append(kind)
        for _ in range(len(values) - len(self.rows)):
            self.rows.append({})
        for i, row in enumerate(self.rows):
            row.pop(name, None)
            if i < len(values) and values[i] is not None:
                row[name] = values[i]

    def __setitem__(self, name, values):
        self.add_column(name, type_of(values), list(values))

    def __delitem__(self, name):
        i = self.para.index(self._known(name))
        del self.para[i], self.type[i]
        for row in self.rows:
            row.pop(name, None)

    def Renomme(self, old, new):
        self._known(old)
        if new in self.para:
            raise KeyError(f"the table has a column {new} already")
        self.para[self.para.index(old)] = new
        self.rows = [{new if k == old else k: v for k, v in row.items()} for row in self.rows]

    def sort(self, CLES=None, ORDRE="CROISSANT"):
        """Sort rows by columns, the first one first; rows without the cell come last."""
        names = [CLES] if isinstance(CLES, str) else list(CLES or self.para)
        for name in reversed(names):
            self._known(name)
            there = [row for row in self.rows if row.get(name) is not None]
            there.sort(key=lambda row: row[name], reverse=ORDRE == "DECROISSANT")
            self.rows = there + [row for row in self.rows if row.get(name) is None]

    def fromfunction(self, name, function, parameters=None, const=None):
        """Add the column `name` of values of `function`; a row that lacks one of its parameters gets none."""
        if parameters is None:
            parameters = function.getVariables()
        parameters = [parameters] if isinstance(parameters, str) else list(parameters)
        for parameter in parameters:
            if not const or parameter not in const:
                self._known(parameter)
        values = []
        for row in self.rows:
            arguments = [row.get(p, (const or {}).get(p)) for p in parameters]
            values.append(None if any(a is None for a in arguments) else function(*arguments))
        self.add_column(name, type_of(values), values)

    def SansColonneVide(self, names=()):
        """The table without the columns (of `names`, or of all) that have no cell."""
        asked = names or self.para
        return self[[name for name in self.para if name not in asked or any(row.get(name) is not None for row in self.rows)]]

    def OrdreColonne(self, names):
        """Put some columns first, in this order."""
        first = [self._known(name) for name in ([names] if isinstance(names, str) else names)]
        order = first + [name for name in self.para if name not in first]
        self.type = [self.kind(name) for name in order]
        self.para = order

    def Croise(self):
        """The third column by the first (down) and the second (across)."""
        if len(self.para) != 3:
            raise TypeError(f"Croise: a table of three columns is needed; this one has {', '.join(self.para)}")
        return crossed(self, self.para)

    def __or__(self, other):
        """Rows of either, in the order of this one, then the other's."""
        made = self.copy()
        made.extend(row for row in other.rows if row not in self.rows)
        return made

    def __and__(self, other):
        """Rows of both."""
        return Table([row for row in self.rows if row in other.rows], self.para, self.type, self.titr)

    def __repr__(self):
        return printing.columns(self)

    __str__ = __repr__


def hidden_by_crossing(table, names, real="12.5E"):
    """How many rows crossed() does not show, for a later one has the same first cell and the same name of its column."""
    down, across, _ = names
    return len(table) - len({(row.get(down), printing.cell(row.get(across), real).strip()) for row in table.rows})


def crossed(table, names, real="12.5E"):
    """The third column by the first (down) and the second (across), whose cells `real` makes names of columns; of several rows for one cell the last."""
    down, across, what = names
    rows, heads = {}, {}
    for row in table.rows:
        head = printing.cell(row.get(across), real).strip()
        heads.setdefault(head, None)
        rows.setdefault(row.get(down), {})[head] = row.get(what)
    return Table([{down: key, **{k: v for k, v in cells.items() if v is not None}} for key, cells in rows.items()], [down, *heads],
                 [table.kind(down)] + [table.kind(what)] * len(heads), f"{what} by {down} (down) and {across} (across)")
