"""A result of a base as arrays: fields, contact of the patches, iterations; and the last iterates of a step that failed."""

import contextlib
from functools import cached_property

from ..base import command_files, contents
from ..base.fields import FieldData, check_place
from ..base.journal import read_journal
from ..base.seal import open_checked
from ..core import catalog
from ..core.catalog import part
from ..core.hdf5 import text
from ..core.late import numpy
from ..core.messages import fail
from . import pictures
from .mesh import as_picture


_farthest = 0.5  #: sizes of the model, that a node of an iterate moves in a picture


class Field(FieldData):
    """A field at one instant. `support` (n) numbers of nodes or cells, `values` (r, components), `present` (r, components), `location` NOEU, ELGA,
    ELNO or ELEM, `offset` (n + 1) the rows of each cell at ELGA and ELNO; field["DX"] are the values of a component, nan where it does not exist."""

    def __init__(self, file, order, instant):
        super().__init__(file)
        self.order, self.instant = order, instant

    def __repr__(self):
        return f"<field {self.name} ({self.location}) at INST {self.instant:g}: {', '.join(self.components)}; {len(self.support)} places>"

    def __getitem__(self, component):
        if component not in self.components:
            raise KeyError(f"{self.name} has no component {component}; it has {', '.join(self.components)}")
        column = self.components.index(component)
        return numpy.where(self.present[:, column], self.values[:, column], numpy.nan)


class Patches:
    """The contact at one instant, one row a patch: `pressure` (positive where bodies press on each other), `gap` (nan where there is no master),
    `status` (1 in contact, 0 open, -1 without master), `coverage` (part of the patch that has a master), `zone` (number, from 0), `area` (length
    in the plane), `centre` (p, 3); `groups` the slave group of each zone. `masters` are the cells that pairing has paired the patches with: (offset
    (p + 1), cells, shares), those of patch k from offset[k] on, with the part of the patch that each covers; None of bases that did not keep them."""

    def __init__(self, mesh, groups, field, read_masters):
        """@param groups the slave group of each zone; of a contact that is not known none: those of the mesh
        @param read_masters returns contents.masters of the field, or None"""
        self._mesh, self._support, self._read_masters = mesh, field.support, read_masters
        self.instant = field.instant
        self.groups = groups or [group for group, _, _ in mesh.patch_zones]
        first = numpy.array([cells[0] for cells in mesh.patches])
        rows = numpy.searchsorted(field.support, first)
        value = {name: column[rows] for name, column in zip(field.components, field.values.T)}
        self.status = value["CONT"].astype(int)
        self.pressure = -value["PRES"]
        self.gap = numpy.where(self.status < 0, numpy.nan, value["JEU"])
        self.coverage = value["COEFSURF"]
        self.zone = numpy.repeat([self.groups.index(group) for group, _, _ in mesh.patch_zones], [last - start for _, start, last in mesh.patch_zones])
        self.area, self.centre = mesh.patch_measures

    @cached_property
    def masters(self):
        found = self._read_masters()
        if found is None:
            return None
        offset, cells, shares = found
        patch_of_cell = numpy.zeros(len(self._mesh.cell_types), int)
        for number, own in enumerate(self._mesh.patches):
            patch_of_cell[own] = number
        # a patch of several cells sees a master by each of them
        couples = numpy.repeat(patch_of_cell[self._support], numpy.diff(offset)) * len(patch_of_cell) + cells
        couples, place = numpy.unique(couples, return_inverse=True)
        patch, cells = numpy.divmod(couples, len(patch_of_cell))
        return numpy.searchsorted(patch, numpy.arange(len(self) + 1)), cells, numpy.bincount(place, shares, minlength=len(couples))

    def masters_of(self, patch):
        """Master cell -> part of the patch that it covers, the largest first; nothing where they were not kept."""
        if self.masters is None:
            return {}
        offset, cells, shares = self.masters
        own = slice(offset[patch], offset[patch + 1])
        return dict(sorted(zip(cells[own].tolist(), shares[own].tolist()), key=lambda item: -item[1]))

    def __len__(self):
        return len(self.status)

    def __repr__(self):
        return f"<{len(self)} patches at INST {self.instant:g}, {(self.status == 1).sum()} in contact>"


class States:
    """States of bodies by their order numbers: what instants of a result and iterates of a failed step have in common."""

    complete = False

    def _start(self, base, identifier, label, file):
        """@param file of the result or of the failed step, open"""
        self._base, self.id, self.label = base, identifier, label
        self.parameters = contents.parameters(file)
        self.mesh_id = contents.reference(file, "mesh")
        self._contact_ids = contents.contacts(file)

    @cached_property
    def mesh(self):
        return self._base.mesh_of(self.mesh_id)

    @cached_property
    def journal(self):
        """The iterations, a base.journal.Journal; None where they were not written down."""
        return read_journal(self._base, self.id)

    @property
    def commands(self):
        """[{"name", "text"}] of the command files that it was computed by."""
        return command_files.known(self._base, self.id)

    @cached_property
    def zones(self):
        """[(slave group, master group, slave cells, master cells)] of its contact; where it has had several, with all that a slave group meets."""
        found = []
        for identifier in self._contact_ids:
            with self._base.open(identifier) as file:
                found.append(contents.contact_zones(file))
        return found[0] if len(found) == 1 else contents.zones_of_contacts(found)

    def field_orders(self, name):
        """The order numbers at which a field is."""
        return list(self._fields[name])

    def order_of(self, instant=None, order=None):
        """The order number of an instant, the last one by default. @throws AsterError READER_2"""
        if order is None and instant is None:
            return self.orders[-1]
        if order is None:
            nearest = int(numpy.argmin(abs(self.instants - instant)))
            if abs(self.instants[nearest] - instant) <= 1e-6 * max(abs(self.instants).max(), 1e-300):
                return self.orders[nearest]
        elif order in self.orders:
            return order
        asked = f"order {order}" if instant is None else f"INST {instant:g}"
        fail("READER_2", "lacon", label=self.label, asked=asked, known=", ".join(f"{t:g}" for t in self.instants))
        raise AssertionError

    def field(self, name, instant=None, order=None):
        """A Field at an instant or an order number, the last one by default. @throws AsterError READER_2, RESULT_1"""
        order = self.order_of(instant, order)
        if order not in self._fields.get(name, ()):
            fail("RESULT_1", "lacon", label=self.label, field=name, order=order, known=", ".join(self._fields) or part("none"))
        with self._opened(name, order) as stored:
            return Field(stored, order, float(self.instants[self.orders.index(order)]))

    def displacements(self, instant=None, order=None):
        """(nodes of the mesh, 3)"""
        field = self.field("DEPL", instant, order)
        found = numpy.zeros((len(self.mesh.points), 3))
        for column, name in enumerate(("DX", "DY", "DZ")):
            if name in field.components:
                values = field.values[:, field.components.index(name)]
                found[field.support, column] = numpy.where(field.present[:, field.components.index(name)], values, 0.0)
        return found

    def contact(self, instant=None, order=None):
        """The Patches at an instant; None where it was computed without contact."""
        order = self.order_of(instant, order)
        if order not in self._fields.get("CONT_ELEM", ()):
            return None
        groups = [slave for slave, *_ in self.zones]
        return Patches(self.mesh, groups, self.field("CONT_ELEM", order=order), lambda: self._masters(order))

    def to_meshio(self, instant=None, order=None):
        """A meshio.Mesh on the deformed points: fields of nodes as point data, those of cells as cell data, nan where they are not."""
        order = self.order_of(instant, order)
        made = self.mesh.to_meshio(self.mesh.points + self.displacements(order=order))
        for name in self._fields:
            if order not in self._fields[name]:
                continue
            field = self.field(name, order=order)
            if field.location == "NOEU":
                made.point_data[name] = _spread(field, len(self.mesh.points))
            elif field.location == "ELEM":
                whole = _spread(field, len(self.mesh.cell_types))
                made.cell_data[name] = [whole[numbers] for numbers, _ in self.mesh.cells.values()]
        return made

    def _bound(self, _):
        """By what displacements are scaled in pictures, so that bodies are seen."""
        return 1.0

    def _shown(self, _):
        """The field by which an order is coloured where none is asked for; nothing: displacements."""
        return None

    def plot(self, instant=None, order=None, scale=1.0, field=None, component=None):
        """A picture of the deformed mesh, coloured by a field at nodes (the magnitude of its components where none is named; by default that of the
        displacements, of an iterate that of the forces not in balance): a matplotlib figure. @param scale of the displacements"""
        order = self.order_of(instant, order)
        moved = self.displacements(order=order)
        scale *= self._bound(moved)
        field = field or self._shown(order)
        if field is None:
            values, name = numpy.linalg.norm(moved, axis=1), "|DEPL|"
        else:
            values, name = self.field(field, order=order).magnitude(component, len(moved)), f"{field} {component or 'magnitude'}"
        title = self.title_of(order) + (f", {part('displacements_times', scale=f'{scale:.3g}')}" if scale != 1.0 else "")
        return pictures.bodies(self.mesh.points + scale * moved, self.mesh.dimension, self.mesh.boundary, values, name, title)

    def plot_pressure(self, instant=None, order=None):
        """A picture of the contact pressure of every zone. @throws AsterError READER_3 without contact"""
        order = self.order_of(instant, order)
        patches = self.contact(order=order)
        if patches is None:
            fail("READER_3", "lacon", label=self.label)
        outlines = [self.mesh.polygons(cells) for cells in self.mesh.patches]
        moved = self.displacements(order=order)
        return pictures.pressure(self.mesh.points + self._bound(moved) * moved, self.mesh.dimension, outlines, patches,
                                 f"{self.title_of(order)}: {part('contact_pressure')}")

    def plot_convergence(self):
        """A picture of residuals and changes of contact over the iterations. @throws AsterError READER_4 without journal"""
        if self.journal is None:
            fail("READER_4", "lacon", label=self.label)
        return pictures.convergence(self.journal, f"{self.label}: {part('newton_method')}")

    def _repr_png_(self):
        return as_picture(self.plot())


class Result(States):
    """A result, also of a computation in progress: what was asked for once stays as it was then; take it from the base again for later instants.

    `label` the variable of the study, `orders` and `instants` (k), `complete` whether its computation has come to its end, `mesh`, `fields` name ->
    instants that have it, `parameters` name -> (k), `is_of_revolution` whether it is axisymmetric, its forces being those of one radian,
    `failed_step` the last iterates of the step at which the computation failed, or None.
    """

    def __init__(self, base, identifier, label):
        with base.open(identifier) as file:
            self._start(base, identifier, label, file)
            self._model_id = contents.reference(file, "model")
            pairs = contents.instants(file)
            self.orders, self.instants = [order for order, _ in pairs], numpy.array([instant for _, instant in pairs])
            self.complete = contents.is_complete(file)
            self._fields = {name: contents.field_files_by_order(file, name) for name in contents.fields(file)}

    def __repr__(self):
        more = ("" if self.complete else ", not complete") + (f", then {self.failed_step!r}" if self.failed_step else "")
        return f"<result {self.label}: {len(self.orders)} instants to INST {self.instants[-1]:g}{more}; fields {', '.join(self._fields)}>"

    @property
    def fields(self):
        of_order = dict(zip(self.orders, self.instants.tolist()))
        return {name: [of_order[order] for order in files] for name, files in self._fields.items()}

    @cached_property
    def failed_step(self):
        return FailedStep(self._base, self.id, self.label) if self._base.failed_step(self.id).exists() else None

    @cached_property
    def is_of_revolution(self):
        if not self._model_id:
            return False
        turned = {row["modelisation"] for row in catalog.elements() if row["geometry"] == "axis"}
        with self._base.open(self._model_id) as file:
            return bool(contents.modelisations(file) & turned)

    def bytes_of_field(self, name):
        """What its last file takes."""
        return (self._base.folder / list(self._fields[name].values())[-1]).stat().st_size

    def title_of(self, order):
        """"RES, INST 0.5\""""
        return f"{self.label}, INST {self.instants[self.orders.index(order)]:g}"

    @contextlib.contextmanager
    def _opened(self, name, order):
        path = self._base.folder / self._fields[name][order]
        with open_checked(path) as file:
            check_place(path, file, name, order)
            yield file

    def _masters(self, order):
        path = contents.path_of_masters(self._base.folder / self._fields["CONT_ELEM"][order])
        if not path.exists():
            return None
        with open_checked(path) as file:
            if (found := contents.holds(file)) not in ("masters", ""):
                fail("BASE_7", file=path, found=found, expected="masters")
            return contents.masters(file)


class FailedStep(States):
    """The last iterates of the step at which a computation failed: no instant of its result, but fields that are looked at as those of one.

    `label` of the result, `instant` that was not solved, `begins` the last one that was, `reason` why in words, `orders` the numbers of the
    iterations (k), `fields` name -> iterations that have it: DEPL, RESI_NOEU (forces at nodes that are not in balance, internal less external), with
    contact CONT_ELEM; `parameters` resi_glob_rela, resi_glob_maxi, status_changes (k), nan of an iterate that was not judged any more.
    """

    failed_step = None

    def __init__(self, base, identifier, label):
        self._path = base.failed_step(identifier)
        with open_checked(self._path) as file:
            self._start(base, identifier, label, file)
            self.orders = contents.iterations(file)
            self.instant, self.begins = float(file.attrs["instant"]), float(file.attrs["begins"])
            self.message, self.reason = text(file.attrs["message"]), text(file.attrs["text"])
            self._fields = contents.fields_of_iterates(file)
        self.instants = numpy.full(len(self.orders), self.instant)

    def __repr__(self):
        return f"<failed step of {self.label} to INST {self.instant:g}: iterations {', '.join(map(str, self.orders))}; fields {', '.join(self._fields)}>"

    @property
    def fields(self):
        return {name: list(iterations) for name, iterations in self._fields.items()}

    def order_of(self, instant=None, order=None):
        """The number of an iteration, the last one that was judged by default. @throws AsterError READER_2"""
        return self._fields["RESI_NOEU"][-1] if instant is None and order is None else super().order_of(instant, order)

    def bytes_of_field(self, name):
        """What one of its iterates takes."""
        return self.field(name, order=self._fields[name][-1]).values.nbytes

    def _bound(self, moved):
        """Iterations that diverge leave nodes far away."""
        size = numpy.linalg.norm(numpy.ptp(self.mesh.points, axis=0))
        return min(1.0, _farthest * size / max(numpy.linalg.norm(moved, axis=1).max(), 1e-300))

    def _shown(self, order):
        return "RESI_NOEU" if order in self._fields.get("RESI_NOEU", ()) else None

    def title_of(self, order):
        """"RES, iteration 7 of the failed step to INST 0.5\""""
        return part("title_of_iterate", label=self.label, instant=f"{self.instant:g}", iteration=order)

    @contextlib.contextmanager
    def _opened(self, name, order):
        with open_checked(self._path) as file:
            yield file[f"fields/{name}/{order}"]

    def _masters(self, order):
        with self._opened("CONT_ELEM", order) as stored:
            return contents.masters(stored["masters"])


def _spread(field, count):
    """The values over all nodes or cells of the mesh, nan where the field is not."""
    whole = numpy.full((count, len(field.components)), numpy.nan)
    whole[field.support] = numpy.where(field.present, field.values, numpy.nan)
    return whole
