"""What is said of moments and axes that take places where they are in the mesh, though displacements have moved them since; the rules are those of
operators/fields/moved_places.hpp."""

from ..core.late import numpy
from . import axes

_near = 1e-2   # of the size of the mesh: what is nearer to an axis or a point has no direction and no lever arm to speak of
_least = 0.05  # share of the largest radius or lever arm by which places have moved before that is told


class MovedPlaces:
    """Looks at the nodes of one command, at each instant, and tells the worst of them."""

    def __init__(self, call):
        self.call = call
        self._size = None  # of the mesh
        self._axes = self._moment = None  # (share, path, values of the message)

    def displacements(self, action, instant, mesh, nodes):
        """(n, 3) of these nodes; None without a result, where it has no DEPL at that instant, and where MODI_MAILLAGE has moved the mesh by a field:
        then nodes are where somebody wants them. @param instant cells that say which one it is, as places.fields gives them"""
        field = action["RESULTAT"].field("DEPL", instant["NUME_ORDRE"][1]) if "RESULTAT" in action else None
        if field is None or mesh.is_deformed():
            return None
        if self._size is None:
            places = numpy.array(mesh.getCoordinates().getValues()).reshape(-1, 3)
            self._size = float(numpy.linalg.norm(places.max(axis=0) - places.min(axis=0)))
        values, _ = field.on_nodes(mesh.getNumberOfNodes())
        made = numpy.zeros((len(nodes), 3))
        for k, name in enumerate(("DX", "DY", "DZ")):
            if name in field.components:
                made[:, k] = values[nodes, field.components.index(name)]
        return made

    def look_at_axes(self, path, instant, axis, points, moved):
        """Axes about `axis` at points (n, 3), which have moved by `moved` (n, 3)."""
        before, now = axes.radii(points, axis), axes.radii(points + moved, axis)
        angle = numpy.arctan2(numpy.linalg.norm(numpy.cross(before, now), axis=1), (before * now).sum(axis=1))
        radius = numpy.linalg.norm(before, axis=1)
        way, largest = numpy.where(radius < _near * self._size, 0, angle * radius), radius.max()
        if way.max() > (self._axes[0] if self._axes else _least) * largest:
            self._axes = (way.max() / largest, path, {**_at(instant), "angle": f"{numpy.degrees(angle[way.argmax()]):.3g}"})

    def look_at_moment(self, path, instant, arms, moved, forces, found):
        """The moment `found` of forces (n, 3) with these arms (n, 3), which have moved by `moved` (n, 3)."""
        then = found + numpy.cross(moved, forces).sum(axis=0)
        arm, way = (float(numpy.linalg.norm(vectors, axis=1).max()) for vectors in (arms, moved))
        arm = max(arm, _near * self._size)
        # a moment below a thousandth of what these forces could make is none, and its change is round-off
        told = max(0.05 * max(numpy.linalg.norm(found), numpy.linalg.norm(then)), 1e-3 * abs(forces).sum() * max(arm, way))
        if way > (self._moment[0] if self._moment else _least) * arm and numpy.linalg.norm(then - found) > told:
            share = way / arm
            self._moment = (share, path, {**_at(instant), "share": f"{100 * share:.3g}", "found": _words(found), "then": _words(then)})

    def tell(self):
        """MODIREPERE_6 and POST_13, each once at most."""
        for identifier, finding in (("MODIREPERE_6", self._axes), ("POST_13", self._moment)):
            if finding:
                _, path, values = finding
                self.call.study.inform(identifier, f"{self.call.command}, {self.call.where}", keyword=path, **values)


def _at(instant):
    return {"instant": f"{instant['INST'][1]:.9g}"}


def _words(vector):
    return ", ".join(f"{x:.6g}" for x in vector)
