"""POST_RELEVE_T: values of fields at nodes, their means, extremes and resultants, as a table."""

from ..core.late import numpy
from ..tables import storage
from ..tables.table import Table
from . import axes, places
from .moved_places import MovedPlaces


def post_releve_t(call):
    table, moved = Table(), MovedPlaces(call)
    for i, action in enumerate(call.keywords["ACTION"], 1):
        path = f"ACTION[{i}]"
        operation = action["OPERATION"]
        if "RESULTANTE" in action and operation != "EXTRACTION":
            call.fail("POST_2", f"{path}/RESULTANTE", operation=operation)
        if "DIRECTION" in action and not any(action["DIRECTION"]):
            call.fail("POST_8", f"{path}/DIRECTION")
        for k, (head, field) in enumerate(_fields(call, action, path)):
            frame = _Frame(call, action, path, field, head, moved)
            if k == 0:
                frame.tell_of_turns()
            made = frame.resultant() if "RESULTANTE" in action else getattr(frame, operation.lower())()
            for row in made:
                table.add_row({**head, **row})
    moved.tell()
    if "TITRE" in call.keywords:
        table.titr = "\n".join(call.keywords["TITRE"])
    return storage.make(call, table)


def _fields(call, action, path):
    """(leading cells of its rows, field) of each instant."""
    for head, field in places.fields(call, action, path, "RESU"):
        yield {"INTITULE": ("K16", action["INTITULE"]), **head}, field


class _Frame:
    """A field at the nodes of one ACTION."""

    def __init__(self, call, action, path, field, head, moved):
        mesh = field.mesh()
        self.call, self.action, self.path, self.field, self.head, self.moved = call, action, path, field, head, moved
        values, there = places.at_nodes(call, field, path)
        keyword = next((k for k in ("NOM_CMP", "RESULTANTE") if k in action), "")
        wanted = action[keyword] if keyword else field.components
        columns = [places.component(call, field, name, f"{path}/{keyword}") for name in wanted]
        nodes = [n for n in places.nodes(call, action, mesh, path) if there[n, columns].any()]
        if not nodes:
            call.fail("POST_3", path, field=field.name, components=", ".join(wanted))
        self.names, self.nodes = wanted, nodes
        self.points = mesh.getCoordinates().toNumpy()[nodes]
        own, own_there = values[nodes], there[nodes]
        if action["REPERE"] != "GLOBAL":
            own, own_there = axes.turned(field.components, own, own_there,
                                         axes.at(call, action, path, self.points, mesh.getDimension() == 2))
            self._look_at_axes(mesh.getDimension() == 2)
        if action["OPERATION"] in ("EXTREMA", "MOYENNE_ARITH") or "RESULTANTE" in action:
            own_there &= _entering(field, nodes, there[nodes])
        self.values, self.there = own[:, columns], own_there[:, columns]
        self.all_values, self.all_there = values, there
        self.marked = _marked(field, nodes)[:, columns]
        self._derive()

    def _derive(self):
        """Put what INVARIANT, ELEM_PRINCIPAUX, TRAC_DIR or TRAC_NOR asks for in the place of the components."""
        action, values = self.action, numpy.where(self.there, self.values, 0.0)
        keyword = next((k for k in ("INVARIANT", "ELEM_PRINCIPAUX", "TRAC_DIR", "TRAC_NOR") if k in action), None)
        if keyword is None:
            return
        if keyword == "TRAC_DIR":
            made = axes.traces(self.names, values, axes.direction(action["DIRECTION"], len(values)), "DIR")
        elif keyword == "TRAC_NOR":
            made = axes.traces(self.names, values, self._normals(), "NOR")
        else:
            of = axes.invariants if keyword == "INVARIANT" else axes.principals
            made = next((of(given) for _, given in axes.tensors(self.names, values)), {})
        if not made:
            self.call.fail("POST_7", f"{self.path}/{keyword}", field=self.field.name, components=", ".join(self.names))
        self.names, self.values = list(made), numpy.column_stack(list(made.values()))
        self.there = numpy.repeat(self.there.all(axis=1)[:, None], len(made), axis=1)
        self.marked = numpy.zeros(self.there.shape, bool)

    def _displacements(self):
        return self.moved.displacements(self.action, self.head, self.field.mesh(), self.nodes)

    def _look_at_axes(self, plane):
        """Of what REPERE turns at places that have moved."""
        if self.action["REPERE"] not in ("POLAIRE", "CYLINDRIQUE") or not axes.has_turned(self.field.components):
            return
        moved = self._displacements()
        if moved is not None:
            self.moved.look_at_axes(f"{self.path}/REPERE", self.head, axes.axis(self.call, self.action, self.path, plane), self.points, moved)

    def _normals(self):
        """Of the line of nodes, in the axes of the components."""
        if self.action["REPERE"] == "LOCAL":
            return axes.direction((0.0, 1.0), len(self.points))
        return axes.line_axes(self.call, self.action, self.path, self.points, self.field.mesh().getDimension() == 2)[:, 1]

    def extraction(self):
        """A row a node."""
        along = places.curved_abscissa(self.points)
        for i, node in enumerate(self.nodes):
            row = {"NOEUD": ("K8", f"N{node + 1}"), "ABSC_CURV": ("R", float(along[i]))}
            row.update((f"COOR_{axis}", ("R", float(x))) for axis, x in zip("XYZ", self.points[i]))
            row.update((name, ("R", float(self.values[i, k]) if self.there[i, k] else None)) for k, name in enumerate(self.names))
            yield row

    def _of_component(self, k):
        return self.values[self.there[:, k], k]

    def extrema(self):
        """Four rows a component."""
        for k, name in enumerate(self.names):
            rows = numpy.flatnonzero(self.there[:, k])
            if not len(rows):
                continue
            values = self.values[rows, k]
            for what, at, value in (("MAX", values.argmax(), values.max()), ("MIN", values.argmin(), values.min()),
                                    ("MAXI_ABS", abs(values).argmax(), abs(values).max()), ("MINI_ABS", abs(values).argmin(), abs(values).min())):
                yield {"EXTREMA": ("K8", what), "NOEUD": ("K8", f"N{self.nodes[rows[at]] + 1}"), "CMP": ("K8", name), "VALE": ("R", float(value))}

    def moyenne_arith(self):
        """A row a component: the mean over the nodes."""
        for k, name in enumerate(self.names):
            if self.there[:, k].any():
                yield {"CMP": ("K8", name), "MOYENNE": ("R", float(self._of_component(k).mean()))}

    def tell_of_turns(self):
        """An alarm where the way from node to node goes back on itself: a mean along it is no mean along a line, and its length no abscissa."""
        operation = self.action["OPERATION"]
        if operation not in ("MOYENNE", "EXTRACTION") or "RESULTANTE" in self.action:
            return
        count, first = places.turns_back(self.points)
        if count and (operation == "MOYENNE" or self._on_a_line()):
            self.call.study.inform("POST_10" if operation == "MOYENNE" else "POST_11", f"{self.call.command}/{self.path}, {self.call.where}",
                                   count=count, place=f"N{self.nodes[first] + 1}")

    def _on_a_line(self):
        """Whether nodes of groups are those of a line, straight or of line cells: of a surface or a body nobody wants the abscissa, and nodes that
        are named one by one have the order that was wanted."""
        if "NOEUD" in self.action:
            return False
        away = self.points - self.points[0]
        if numpy.linalg.matrix_rank(away, tol=1e-6 * abs(away).max()) < 2:
            return True
        mesh = self.field.mesh()
        named = list(dict.fromkeys(places.cells(self.call, self.action, mesh, self.path)))
        if named:
            return mesh.are_lines(named)
        chain = mesh.chain_of(mesh.lines_among(self.nodes))
        return chain is not None and set(chain) == set(self.nodes)

    def moyenne(self):
        """Six rows: mean along the line of nodes, first moment, extremes, and the ends of the straight line with the same two moments.

        MOMENT_0 = 1/l int f ds, MOMENT_1 = 12/l^2 int f (s - l/2) ds, f linear between nodes; ends MOMENT_0 -+ MOMENT_1/2. Pieces that end at a
        marker (JEU without a master) are left out, as MACR_LIGN_COUPE does it (sums.hpp), unless all nodes are.
        """
        s = places.curved_abscissa(self.points)
        if not self.there.all():
            self.call.fail("POST_4", self.path, node=f"N{self.nodes[int(numpy.flatnonzero(~self.there.all(axis=1))[0])] + 1}", field=self.field.name)
        if s[-1] == 0.0:
            self.call.fail("POST_5", self.path)
        columns = [_moments(s, self.values[:, k], marked if marked.any() and not marked.all() else numpy.zeros(len(s), bool))
                   for k, marked in enumerate(self.marked.T)]
        for what, row in zip(("MOMENT_0", "MOMENT_1", "MINIMUM", "MAXIMUM", "MOYE_INT", "MOYE_EXT"), zip(*columns)):
            yield {"QUANTITE": ("K16", what), **{name: ("R", v) for name, v in zip(self.names, row)}}

    def resultant(self):
        """One row: sums of the components RESULTANTE under their names; with MOMENT under those of axes, with moments about POINT, to which
        MOMENT's own components are added."""
        action = self.action
        given = numpy.where(self.there, self.values, 0.0)
        sums = [("R", float(v)) for v in given.sum(axis=0)]
        if "MOMENT" not in action:
            return [dict(zip(self.names, sums))]
        along = _axes(self.names)
        forces, point = numpy.zeros((len(self.nodes), 3)), numpy.zeros(3)
        forces[:, along] = given
        point[:len(action["POINT"])] = action["POINT"]
        moment = numpy.cross(self.points - point, forces).sum(axis=0)
        moved = self._displacements()
        if moved is not None:
            self.moved.look_at_moment(f"{self.path}/MOMENT", self.head, self.points - point, moved, forces, moment)
        for k, name in zip(_axes(action["MOMENT"]), action["MOMENT"]):
            if name in self.field.components:
                column = self.field.components.index(name)
                moment[k] += self.all_values[self.nodes, column][self.all_there[self.nodes, column]].sum()
        return [{**{f"RESULT_{'XYZ'[k]}": v for k, v in zip(along, sums)}, **{f"MOMENT_{axis}": ("R", float(v)) for axis, v in zip("XYZ", moment)}}]


def _moments(s, f, left_out):
    """MOMENT_0, MOMENT_1, MINIMUM, MAXIMUM, MOYE_INT, MOYE_EXT of values f at the abscissas s: of the pieces neither end of which is left out, and
    the straight line from the first to the last of them that has their mean and slope; None where there is no such piece."""
    extremes = float(f[~left_out].min()), float(f[~left_out].max())
    piece = numpy.flatnonzero(~left_out[1:] & ~left_out[:-1])
    step = s[piece + 1] - s[piece]
    length = step.sum()
    if not length > 0:
        return (None, None, *extremes, None, None)
    middle = (step * (s[piece] + s[piece + 1])).sum() / 2 / length
    mean = (step * (f[piece] + f[piece + 1])).sum() / 2 / length
    a, b = s[piece] - middle, s[piece + 1] - middle
    # Simpson's rule, exact for the product of two linear functions
    first = (step * (f[piece] * a + f[piece + 1] * b + (f[piece] + f[piece + 1]) * (a + b))).sum() / 6
    slope = first / ((step * (a * a + a * b + b * b)).sum() / 3)
    begin, end = s[piece[0]], s[piece[-1] + 1]
    return (float(mean), float(slope * (end - begin)), *extremes, float(mean + slope * (begin - middle)), float(mean + slope * (end - middle)))


def _marked(field, nodes):
    """Where nodes have a marker in place of a value."""
    if field.location != "NOEU":
        return numpy.zeros((len(nodes), len(field.components)), bool)
    mask = numpy.zeros((field.mesh().getNumberOfNodes(), len(field.components)), bool)
    mask[field.support] = field.marked
    return mask[nodes]


def _entering(field, nodes, there):
    """Which values at nodes enter sums, means and extremes: stand-ins (LAGS_C beside its carriers) only where nothing else is."""
    if field.location != "NOEU":
        return there
    _, counted = field.on_nodes(field.mesh().getNumberOfNodes(), counted=True)
    return numpy.where(counted[nodes].any(axis=0), counted[nodes], there)


def _axes(names):
    """Indices of the axes that the names of components end in; where they do not say, X, Y, Z in this order."""
    said = ["XYZ".find(name[-1]) for name in names]
    return said if -1 not in said and len(set(said)) == len(said) else list(range(len(names)))
