"""A result as its page shows it: which instants and fields are drawn, the contact of each instant, the run."""

import time

from .. import version
from ..base import contents
from ..core import catalog
from ..core.catalog import part
from ..core.late import numpy
from ..core.messages import AsterError, message, show
from ..reader.result import FailedStep
from . import proofs
from .packing import Packing
from .surface import Drawing

_largest_page = 14e6  #: bytes that the fields of the page may take, about
_read = 700e6  #: bytes of field files that are read for it
_deflated = 0.8  #: of a number of 16 bits, with what base64 adds
_most_courses = 400  #: instants whose contact is followed
_most_components = 12  #: of a field: internal variables may be many
_shown = ("DEPL", "RESI_NOEU", "SIEF_NOEU", "SIEQ_NOEU", "SIEF_ELNO", "SIEF_ELGA")  #: fields that come first
_places = {"ELEM": "by_cell", "ELGA": "mean_of_points", "ELNO": "mean_at_nodes"}  #: parts that say how a field is shown
_share = 10000  #: of a patch, of which masters have whole numbers
_contact = ("pressure", "gap", "status", "coverage")


def make(base, result):
    """@param base reader.Base, result reader.Result  @return (what the page is told, Packing)"""
    return _Page(base, result).made()


class _Page:
    def __init__(self, base, result):
        self.base, self.result, self.mesh = base, result, result.mesh
        self.notes = []
        self.step = result if isinstance(result, FailedStep) else self._if_sound(lambda: result.failed_step, "read_without_failed_step")
        self.orders, self.instants = ([], numpy.zeros(0)) if result is self.step else (result.orders, result.instants)
        self.packing = Packing()
        self.zones = result.zones
        self.drawing = Drawing(self.mesh, self.zones)
        self.fields = self._heads(result) if self.orders else {}
        self.drawn = self._instants()

    def made(self):
        started = time.perf_counter()
        points = self.mesh.points[self.drawing.nodes]
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        add, skins = self.packing.add, self.drawing.facet_skins
        drawn = {index: self.orders[index] for index in self.drawn}
        fields = [self._field(self.result, name, self.fields[name], drawn) for name in sorted(self.fields, key=_rank)]
        contact, courses = self._contact()
        if contact:
            fields.insert(0, contact)
        told = {
            "title": part("result_of_base", label=self.result.label, base=self.base.folder.name), "language": "fr" if catalog.in_french() else "en", "label": self.result.label, "base": self.base.folder.name,
            "subtitle": self._subtitle(), "dimension": self.mesh.dimension,
            "size": float(numpy.linalg.norm(numpy.ptp(points, axis=0))), "points": add(points - middle, "f4"),
            "nodes": add(self.drawing.nodes + 1, "i4"), "facet_cells": add(numpy.where(skins >= 0, skins, self.drawing.facet_cells) + 1, "i4"),
            "facet_patches": add(self.drawing.facet_patches, "i4"), "surfaces": [self._surface(s) for s in self.drawing.surfaces],
            "parts": self.drawing.parts, "fields": fields, "instants": self.instants.tolist(), "drawn": self.drawn,
            "first": _first(fields), "failed": self._failed(), "zones": courses, "patch_areas": self.mesh.patch_measures[0].tolist() if self.zones else [],
            "share": _share, "of_revolution": self.result is not self.step and self.result.is_of_revolution,
            "iterations": numpy.asarray(self.result.parameters.get("newton_iterations", [])).tolist(), "proofs": self._proofs,
            "journal": self._journal(), "commands": self.result.commands, "run": self._run(started), "notes": self.notes}
        return told, self.packing

    # ------------------------------------------------------------------------------------------- what is drawn

    def _heads(self, states):
        """name -> (location, components) of the fields that can be drawn; contact is drawn by patches."""
        heads = {name: self._head(states, name) for name in states.fields if name != "CONT_ELEM"}
        return {name: head for name, head in heads.items() if head}

    def _head(self, states, name):
        """(location, components) of a field that can be drawn; nothing otherwise."""
        order = states.orders[-1]
        files = states.field_orders(name)
        field = states.field(name, order=order if order in files else files[-1])
        if field.functions or not len(field.support):
            return None
        components = [c for c in field.components if c != "LAGS_C"][:_most_components]
        if len(components) < len([c for c in field.components if c != "LAGS_C"]):
            self.notes.append(part("first_components", field=name, count=_most_components, all=len(field.components)))
        return field.location, components

    def _instants(self):
        """Which instants are drawn: all, or so many of them that the page stays small, the first and the last among them."""
        count = len(self.orders)
        iterates = len(self.step.orders) * self._bytes_of(self._heads(self.step)) if self.step else 0.0
        most = min((_largest_page - iterates) / max(1.0, self._bytes_of(self.fields) + self._bytes_of_contact()), _read / max(1.0, self._bytes_of_an_instant()))
        chosen = min(count, max(1, int(most)))
        if chosen < count:
            self.notes.append(part("instants_drawn", count=chosen, all=count))
        return numpy.unique(numpy.rint(numpy.linspace(count - 1, 0, chosen)).astype(int)).tolist()

    def _if_sound(self, read, without):
        """What is read of a file that the page can do without, or None and a note. @param without the part that says what is left out"""
        try:
            return read()
        except AsterError as damage:
            told = message("BASE_8", reason=damage.messages[0].text, without=part(without))
            if told.text not in self.notes:
                self.notes.append(told.text)
                show(told)
            return None

    def _masters(self, patches):
        return self._if_sound(lambda: patches.masters, "read_without_masters")

    def _bytes_of(self, heads):
        """What the fields of a state take in the page, about."""
        return 2 * _deflated * sum(len(components) * (len(self.drawing.nodes) if location in ("NOEU", "ELNO") else len(self.drawing.facet_cells))
                                   for location, components in heads.values())

    def _bytes_of_contact(self):
        """Likewise of patches and their masters."""
        if not self.orders or "CONT_ELEM" not in self.result.fields:
            return 0.0
        patches = self.result.contact(order=self.result.field_orders("CONT_ELEM")[-1])
        masters = self._masters(patches)
        return _deflated * (4 * (len(_contact) + 1) * len(patches) + (6 * len(masters[1]) if masters else 0))

    def _bytes_of_an_instant(self):
        return sum(self.result.bytes_of_field(name) for name in self.fields)

    def _surface(self, surface):
        told = {key: surface[key] for key in ("name", "kind", "zone", "part")}
        for key in ("triangles", "triangle_facets", "quads", "quad_facets", "edges", "segments", "segment_facets"):
            if key in surface:
                told[key] = self.packing.add(surface[key], "u4" if not key.endswith("facets") else "i4")
        return told

    def _field(self, states, name, head, drawn):
        """@param drawn number in the page -> order"""
        location, components = head
        on_nodes = location in ("NOEU", "ELNO")
        instants = {}
        for index, order in drawn.items():
            if order not in states.field_orders(name):
                continue
            field = states.field(name, order=order)
            values = numpy.column_stack([field[c] if c in field.components else numpy.full(len(field.values), numpy.nan) for c in components])
            stored, ranges = self.packing.add_quantised(self._placed(field, values))
            instants[index] = {"values": stored, "ranges": ranges}
        return {"name": name, "title": name + (part(_places[location]) if location in _places else f" ({part('unbalanced_forces')})" if name == "RESI_NOEU" else ""), "kind": "node" if on_nodes else "facet", "components": components, "instants": instants}

    def _placed(self, field, values):
        """The rows of a field at the drawn nodes or facets, nan elsewhere."""
        nodes, cells = len(self.mesh.points), len(self.mesh.cell_types)
        if field.location == "NOEU":
            return _spread(nodes, field.support, values)[self.drawing.nodes]
        if field.location == "ELEM":
            whole, skins, under = _spread(cells, field.support, values), self.drawing.facet_skins, self.drawing.facet_cells
            return whole[numpy.where((skins >= 0) & ~numpy.isnan(whole[skins]).all(axis=1), skins, under)]  # of a skin its own values, if it has any
        if field.location == "ELGA":
            means = _means(field.offset, values)
            return _spread(cells, field.support, means)[self.drawing.facet_cells]
        offset, members = self.mesh.connectivity
        cell, place = field.rows()
        inside = place < (offset[cell + 1] - offset[cell])
        node = members[offset[cell[inside]] + place[inside]]
        whole = numpy.full((nodes, values.shape[1]), numpy.nan)
        for c in range(values.shape[1]):
            known = numpy.isfinite(values[inside, c])
            count = numpy.bincount(node[known], minlength=nodes)
            total = numpy.bincount(node[known], values[inside, c][known], minlength=nodes)
            with numpy.errstate(invalid="ignore"):
                whole[:, c] = numpy.where(count > 0, total / count, numpy.nan)
        return whole[self.drawing.nodes]

    # ------------------------------------------------------------------------------------------- contact

    def _contact(self):
        """(the field of the patches, or nothing; what the page is told of each zone). Makes the proof lines too."""
        count = len(self.orders)
        followed = set(numpy.unique(numpy.rint(numpy.linspace(0, count - 1, min(count, _most_courses))).astype(int)).tolist()) | set(self.drawn)
        courses = [{"slave": slave, "master": master, "course": []} for slave, master, _, _ in self.zones]
        instants, self._proofs = {}, []
        journal = self.result.journal
        with_patches = bool(self.zones) and "CONT_ELEM" in self.result.fields
        for index, order in enumerate(self.orders):
            patches = None
            if with_patches and index in followed and order in self.result.field_orders("CONT_ELEM"):
                patches = self.result.contact(order=order)
                patches.space = self.mesh.dimension == 3
                if index in self.drawn:
                    instants[index] = self._of_patches(patches)
            for number, zone in enumerate(courses):
                zone["course"].append(self._figures(index, number, patches))
            self._proofs.append([] if index == 0 and count > 1 else
                                proofs.of_instant(index, self.result.parameters, self.zones, _newton_of(journal, self.instants[index]), patches))
        return _contact_field(instants), courses

    def _of_patches(self, patches):
        stored = {"values": self.packing.add(numpy.array([patches.pressure, patches.gap, patches.status, patches.coverage]), "f4")}
        if (masters := self._masters(patches)) is not None:
            offset, cells, shares = masters
            stored["masters"] = {"offset": self.packing.add(offset, "u4"), "cells": self.packing.add(cells + 1, "u4"),
                                 "shares": self.packing.add(numpy.rint(shares * _share), "u2")}
        return stored

    def _figures(self, index, number, patches):
        """Of a zone at an instant."""
        value = {name: float(values[index]) for name, values in self.result.parameters.items()}
        start = f"zone_{number + 1}_"
        if numpy.isnan(value.get(start + "active", numpy.nan)):  # no contact, or none in this stage
            return {}
        told = {name: value[start + name] for name in ("active", "open", "unpaired", "covered")}
        told["force"] = [value[f"{start}slave_force_{axis}"] for axis in "xyz"[:self.mesh.dimension]]
        if start + "dissipated" in value:
            told["dissipated"] = value[start + "dissipated"]
        if patches is not None:
            active = (patches.zone == number) & (patches.status == 1)
            told["area"] = float((patches.area * patches.coverage)[active].sum())
            told["largest"] = float(patches.pressure[active].max(initial=0.0))
        return told

    def _failed(self):
        """The last iterates of the step that failed, with their fields."""
        step = self.step
        if step is None:
            return None
        drawn = dict(enumerate(step.orders))
        fields = [self._field(step, name, head, drawn) for name, head in sorted(self._heads(step).items(), key=lambda item: _rank(item[0]))]
        contact = _contact_field({index: self._of_patches(step.contact(order=order)) for index, order in drawn.items()
                                  if order in step.fields.get("CONT_ELEM", ())})
        return {"instant": step.instant, "begins": step.begins, "message": step.message, "reason": step.reason, "iterations": step.orders,
                "start": step.orders.index(step.order_of()), "fields": ([contact] if contact else []) + fields, "first": {"field": "RESI_NOEU", "component": "decades"}}

    # ------------------------------------------------------------------------------------------- the run

    def _journal(self):
        journal = self.result.journal
        if journal is None:
            return None
        rows, without = [], {"changes": 0, "active": 0} if journal.patches else {}  # contact: of instants that have none
        for number, attempt in enumerate(journal.attempts):
            rows += [{"attempt": number, **without, **{key: _finite(line[key]) for key in ("rela", "maxi", "geometry", "changes", "active") if key in line}}
                     for line in attempt.iterations]
        if len(rows) > 5000:
            self.notes.append(part("last_iterations", count=5000, all=len(rows)))
        return {"limits": journal.limits, "patches": journal.patches, "rows": rows[-5000:]}

    def _subtitle(self):
        nodes, cells = len(self.mesh.points), sum(len(numbers) for numbers, _ in self.mesh.cells_of_dimension(self.mesh.dimension).values())
        words = [part("nodes_cells_bodies", nodes=nodes, cells=cells, bodies=len(self.drawing.parts))]
        if self.zones:
            words.append(part("patches_in_zones" if len(self.zones) > 1 else "patches_in_zone", patches=len(self.mesh.patches), zones=len(self.zones)))
        if self.orders:
            words.append(part("instants_to", count=len(self.orders), last=f"{self.instants[-1]:g}"))
        if self.step:
            words.append(part("step_that_failed", instant=f"{self.step.instant:g}"))
        elif not self.result.complete:
            words.append(part("under_way" if self.base.running else "not_at_its_end"))
        return "; ".join(words)

    def _run(self, started):
        journal = self.result.journal
        machine_of = {} if journal is None else journal.machine
        study = [(part("run_base"), str(self.base.folder)), (part("run_result"), self.result.label), (part("run_mesh"), self.mesh.label)]
        machine = [(name, str(machine_of[key])) for name, key in (("Lacon", "lacon"), (part("run_processor"), "processor"), (part("run_threads"), "threads"),
                                                                     (part("run_blas"), "blas")) if machine_of.get(key)]
        totals = []
        if journal is not None:
            rows = [line for _, line in journal.iterations()]
            totals += [(part("run_in_all"), f"{journal.now:.4g} s"), (part("run_iterations"), part("iterations_in", count=len(rows), tried=len(journal.attempts))),
                       (part("run_factorisations"), str(sum(bool(line.get("factorised")) for line in rows)))]
            totals += [(part("run_memory"), f"{journal.memory / 2**20:.0f} MiB")] if journal.memory else []
        page = [("Lacon", version), (part("run_made"), time.strftime("%Y-%m-%d %H:%M")), (part("run_drawn"), part("some_of", count=len(self.drawn), all=len(self.orders))),
                (part("run_fields"), part("bits")), (part("run_made_in"), f"{time.perf_counter() - started:.2f} s")]
        return {"study": study, "machine": machine, "totals": totals,
                "phases": {} if journal is None else journal.phases, "page": page}


def _contact_field(instants):
    """The field of the patches, or nothing. @param instants number in the page -> values"""
    if not instants:
        return None
    return {"name": "CONT_ELEM", "title": part("contact"), "kind": "patch", "exact": True, "components": list(_contact), "instants": instants}


def _rank(name):
    return (_shown.index(name) if name in _shown else len(_shown), name)


def _first(fields):
    """What the page shows first."""
    names = [field["name"] for field in fields]
    for name, component in (("SIEF_NOEU", "mises"), ("SIEF_ELNO", "mises"), ("SIEF_ELGA", "mises"), ("DEPL", "magnitude")):
        if name in names:
            return {"field": name, "component": component}
    return {"field": names[0] if names else "", "component": ""}


def _spread(count, support, values):
    whole = numpy.full((count, values.shape[1]), numpy.nan)
    whole[support] = values
    return whole


def _means(offset, values):
    """Of the rows of each cell; nan where there are none."""
    counts = numpy.diff(offset)
    means = numpy.full((len(counts), values.shape[1]), numpy.nan)
    filled = counts > 0
    if filled.any():
        means[filled] = numpy.add.reduceat(values, offset[:-1][filled], axis=0) / counts[filled, None]
    return means


def _newton_of(journal, instant):
    """(limits, iterations) of the attempt that solved an instant; nothing where there is none."""
    if journal is None:
        return None
    for attempt in reversed(journal.attempts):
        if attempt.solved and attempt.iterations and abs(attempt.instant - instant) <= 1e-9 * max(abs(instant), 1e-300):
            return journal.limits, attempt.iterations
    return None


def _finite(x):
    """A number that JSON has."""
    return x if isinstance(x, (int, bool)) or numpy.isfinite(x) else None
