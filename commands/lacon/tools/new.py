"""`lacon new mesh.med`: a starter study written from a mesh's groups, to be corrected by its user; `lacon new --template hertz`: a study of the
templates, which runs as it is (tools/templates.py).

Bodies are the groups of cells of the mesh's dimension, skins those of one dimension less. Two skins that face each other closely on parts of
the mesh that are not connected make a contact pair; the slave is the one that its name calls so, otherwise the finer one. Plane skins at the zero of an
axis are taken for symmetries. What is a guess says so in the file.
"""

import argparse
import os
import pathlib
import re
import tempfile

from ..base import contents
from ..core import outcome
from ..core.catalog import option_words, part
from ..core.command_line import CommandLine
from ..core.late import numpy
from ..core.messages import fail
from ..run import execution, launch
from ..run.study import Study
from . import templates
from .convert import read_formats

_near = 2.0  # skins are a pair where a cell of one is nearer to a cell of the other than this many of their lengths
_facing = -0.7  # and their outward normals have at most this product
_share = 0.25  # and where that holds for this part of the cells
_sample = 1500  # cells of a skin that are looked at


class Skin:
    """A group of skin cells: dimension and size of the mesh, nodes' coordinates, the parts of the mesh that it bounds, length of a cell;
    middles and outward unit normals of cells that stand for all, how deep the middles of the body cells under them lie, and how far they are apart."""

    def __init__(self, name, dimension, size, points, parts, length, spacing, middles, normals, depths):
        self.name, self.dimension, self.points, self.parts, self.length = name, dimension, points, parts, length
        self.size, self.spacing, self.middles, self.normals, self.depths = size, spacing, middles, normals, depths
        self.part = parts[0] if len(parts) == 1 else -1

    def plane(self):
        """(axis, coordinate) of the coordinate plane it lies in; nothing where it lies in none"""
        spread = self.points.max(axis=0) - self.points.min(axis=0)
        for axis in range(self.dimension):
            if spread[axis] <= 1e-6 * max(spread.max(), 1e-300) and spread.max() > 0:
                at = float(self.points[:, axis].mean())
                return "XYZ"[axis], 0.0 if abs(at) <= 1e-6 * self.size else at
        return None

    def words(self):
        at = self.plane()
        said = part("starter_plane_skin", axis=at[0], value=f"{at[1]:.6g}") if at else part("starter_curved_skin")
        if len(self.parts) == 1:
            return said
        return part("starter_on_several_bodies", skin=said) if self.parts else part("starter_on_no_body", skin=said)

    def role(self):
        """1 where its name says that it is a slave, -1 a master, 0 neither or both."""
        return bool(re.search("SLAVE|ESCL", self.name.upper())) - bool(re.search("MASTER|MA[IÎ]T", self.name.upper()))

    def mirror(self, upward):
        """Whether it looks like a plane of symmetry: at the zero of an axis; of the one along which bodies stand on each other, if it cuts several."""
        at = self.plane()
        return bool(at) and at[1] == 0.0 and (at[0] != upward or len(self.parts) > 1)


class MeshGroups:
    """What a starter needs to know of a mesh: reads the concept's file."""

    def __init__(self, mesh):
        with mesh.open() as file:
            self.dimension = contents.dimension(file)
            self.points = contents.points(file)
            types, kind = contents.cell_types(file)
            offset, nodes = contents.connectivity(file)
            members = contents.groups(file, "cells")
        self._offset, self._nodes = offset, nodes
        self.size = float(numpy.ptp(self.points, axis=0).max())
        of_family = {"POI": 0, "SEG": 1, "TRIA": 2, "QUAD": 2}
        dimension = numpy.array([of_family.get(re.match("[A-Z]*", t)[0], 3) for t in types])[kind]
        self._body = dimension == self.dimension
        self._part = self._parts(offset, nodes, self._body)
        self._around = self._cells_around()
        cells = lambda group: numpy.concatenate([nodes[offset[c]:offset[c + 1]] for c in group])  # noqa: E731
        self.bodies, self.skins = {}, []
        for name, group in members.items():
            if len(group) and (dimension[group] == self.dimension).all():
                self.bodies[name] = set(self._part[cells(group)].tolist())
            elif len(group) and (dimension[group] == self.dimension - 1).all():
                own = numpy.unique(cells(group))
                first = nodes[offset[group]], nodes[offset[group] + 1]
                length = float(numpy.linalg.norm(self.points[first[0]] - self.points[first[1]], axis=1).mean())
                parts = [part for part in numpy.unique(self._part[own]).tolist() if part >= 0]
                step = -(-len(group) // _sample)
                some, spacing = group[::step], length * step ** (1 / (self.dimension - 1))
                self.skins.append(Skin(name, self.dimension, self.size, self.points[own], parts, length, spacing,
                                       *self._faces([nodes[offset[c]:offset[c + 1]] for c in some])))

    def _parts(self, offset, nodes, body):
        """The connected part of each node, by its lowest node; -1 where no body cell has the node."""
        label = numpy.arange(len(self.points))
        cell = numpy.repeat(numpy.arange(len(body)), numpy.diff(offset))
        inside = body[cell]
        cell, nodes = cell[inside], nodes[inside]
        while len(nodes):
            least = numpy.full(len(body), len(label))
            numpy.minimum.at(least, cell, label[nodes])
            new = label.copy()
            numpy.minimum.at(new, nodes, least[cell])
            new = new[new]
            if (new == label).all():
                break
            label = new
        used = numpy.zeros(len(label), bool)
        used[nodes] = True
        return numpy.where(used, label, -1)

    def _cells_around(self):
        """(offset, body cells) of the nodes."""
        cell = numpy.repeat(numpy.arange(len(self._body)), numpy.diff(self._offset))
        inside = self._body[cell]
        order = numpy.argsort(self._nodes[inside], kind="stable")
        first = numpy.searchsorted(self._nodes[inside][order], numpy.arange(len(self.points) + 1))
        return first, cell[inside][order]

    def _faces(self, faces):
        """Middles of skin cells, their unit normals, away from the body cell that they bound, and how deep its middle lies; 0 where they bound none."""
        middles, normals, depths = numpy.zeros((len(faces), 3)), numpy.zeros((len(faces), 3)), numpy.zeros(len(faces))
        first, cells = self._around
        for i, face in enumerate(faces):
            middles[i] = self.points[face].mean(axis=0)
            bodies = set.intersection(*(set(cells[first[n]:first[n + 1]].tolist()) for n in face))
            if not bodies:
                continue
            inside = self.points[self._nodes[self._offset[min(bodies)]:self._offset[min(bodies) + 1]]].mean(axis=0)
            one = self.points[face[1]] - self.points[face[0]]
            normal = (one[1], -one[0], 0.0) if self.dimension == 2 else numpy.cross(one, self.points[face[2]] - self.points[face[0]])
            length = numpy.linalg.norm(normal)
            if length > 0:
                height = numpy.dot(normal, middles[i] - inside) / length
                normals[i], depths[i] = numpy.array(normal) / length * (1.0 if height > 0 else -1.0), abs(height)
        return middles, normals, depths

    def pairs(self):
        """[(slave, master)] of skins that face each other on different parts, the closest first; each skin once."""
        far = {(a, b): _distances(a, b) for a in self.skins for b in self.skins if a.part != b.part and (a.part >= 0 or b.part >= 0)}
        nearest = {a: numpy.min([d for (one, _), d in far.items() if one is a], axis=0, initial=numpy.inf) for a in self.skins}
        found = []
        for i, a in enumerate(self.skins):
            for b in self.skins[i + 1:]:
                if (a, b) in far:
                    shares, distance = zip(*(_closeness(far[one], nearest[one[0]], max(a.spacing, b.spacing)) for one in ((a, b), (b, a))))
                    if max(shares) >= _share:
                        # a group of more than the facing skin has a smaller sum
                        found.append((-sum(shares), -abs(a.role() - b.role()), round(min(distance) / self.size, 6), *_slave_first(a, b)))
        taken, pairs = set(), []
        for *_, slave, master in sorted(found, key=lambda row: row[:3]):
            if slave.name not in taken and master.name not in taken:
                taken |= {slave.name, master.name}
                pairs.append((slave, master))
        return pairs


def _slave_first(a, b):
    """A slave is on one body; which skin it is, their names say, otherwise how fine they are."""
    if a.part < 0 or b.part < 0:
        return (a, b) if b.part < 0 else (b, a)
    return (a, b) if (a.role(), -a.length) >= (b.role(), -b.length) else (b, a)


def _distances(a, b):
    """How far each of a's cells is from the nearest cell of b that faces it; infinite where none does. Those that look away from each other, with their
    bodies between them, do not: what a cell sees lies before it, or behind it by less than the middle of its body cell (skins that overlap)."""
    limit = _near * max(a.spacing, b.spacing)
    found = numpy.full(len(a.middles), numpy.inf)
    for rows in numpy.array_split(numpy.arange(len(a.middles)), max(1, len(a.middles) // 100)):
        to = b.middles[None, :, :] - a.middles[rows, None, :]
        distance = numpy.linalg.norm(to, axis=2)
        before = (to * a.normals[rows, None, :]).sum(axis=2) > -a.depths[rows, None]
        faces = (distance <= limit) & before & (a.normals[rows] @ b.normals.T <= _facing)
        found[rows] = numpy.where(faces, distance, numpy.inf).min(axis=1)
    return found


def _closeness(distances, nearest, spacing):
    """(the part of a skin's cells that face another one and no skin that is clearly nearer, how far these are from it) @param nearest of all skins"""
    near = numpy.isfinite(distances) & (distances <= nearest + 0.5 * spacing)
    return near.mean(), distances[near].mean() if near.any() else numpy.inf


def standing(free, dimension):
    """(axis along which bodies stand on each other, symmetries, the support or nothing, what is pressed or nothing): the last axis, unless another one has
    both a support and, on another body, a skin that can be pressed. @param free skins without contact"""
    found = []
    for axis in reversed("XYZ"[:dimension]):
        mirrors = [skin for skin in free if skin.mirror(axis)]
        flat = [skin for skin in free if skin.plane() and skin.plane()[0] == axis and skin.parts and skin not in mirrors]
        held = min(flat, key=lambda skin: skin.plane()[1], default=None)
        pressed = max((skin for skin in flat if skin is not held and skin.part >= 0), key=lambda skin: skin.plane()[1], default=None)
        found.append((axis, mirrors, held, pressed))
    return next((ways for ways in found if ways[3] and ways[2].part != ways[3].part), found[0])


def study(groups, mesh_file, read_format):
    """The text of the starter study."""
    pairs = groups.pairs()
    in_contact = {skin.name for pair in pairs for skin in pair}
    free = [skin for skin in groups.skins if skin.name not in in_contact]
    stand = standing(free, groups.dimension)
    pressed = stand[3]
    cut = "CUT" if pairs else "MESH"
    lines = [*_head(groups, mesh_file), *_mesh(groups, pairs, read_format), *_model(groups, cut), *_supports(groups, free, stand), *_loads(pressed)]
    if len(groups.bodies) > 1 or pairs:
        lines += ["# " + part("starter_rigid_motion")]
    return "\n".join([*lines, "", *_contact(pairs), *_solution(pairs, pressed)])


def _head(groups, mesh_file):
    """What the study is, how to run it, and what was found in the mesh."""
    return ["# " + part("starter_head", mesh=mesh_file),
            "#", f"#   lacon check {part('starter_this_file')} --unit 20={mesh_file}",
            f"#   lacon {part('starter_this_file')} --unit 20={mesh_file} --unit 80=result.med", "#",
            "# " + part("starter_bodies", names=", ".join(groups.bodies) or part("starter_no_body_group")),
            "# " + part("starter_skins"), *[f"#   {skin.name}: {skin.words()}" for skin in groups.skins], ""]


def _mesh(groups, pairs, read_format):
    """The mesh: read, its skins turned outward, the slave ones cut."""
    lines = ["DEBUT()", "", f"MESH = LIRE_MAILLAGE(UNITE=20, FORMAT={read_format!r})"]
    skins = tuple(skin.name for skin in groups.skins if skin.part >= 0)
    if skins:
        lines += [f"MESH = MODI_MAILLAGE(reuse=MESH, MAILLAGE=MESH, ORIE_PEAU=_F(GROUP_MA_PEAU={skins!r}))"]
    if pairs:
        return [*lines, "", "# " + part("starter_cut"),
                f"CUT = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL={tuple(slave.name for slave, _ in pairs)!r}))"]
    return [*lines, "", "# " + part("starter_no_pair"),
            "#   CUT = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL='SLAVE'))",
            "#   CONTACT = DEFI_CONTACT(MODELE=MODEL, FORMULATION='CONTINUE', ALGO_RESO_GEOM='NEWTON', ALGO_RESO_CONT='NEWTON',",
            "#                          ZONE=_F(APPARIEMENT='MORTAR', ALGO_CONT='LAC', GROUP_MA_ESCL='SLAVE', GROUP_MA_MAIT='MASTER'))"]


def _model(groups, cut):
    """@param cut name of the mesh that is solved on"""
    modelisation = "3D" if groups.dimension == 3 else "D_PLAN"
    plane = "" if groups.dimension == 3 else "  # " + part("starter_modelisation")
    return ["", f"MODEL = AFFE_MODELE(MAILLAGE={cut}, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION={modelisation!r})){plane}",
            "", "# " + part("starter_units", size=f"{groups.size:.3g}"), "# " + part("starter_units_more"),
            "STEEL = DEFI_MATERIAU(ELAS=_F(E=210000.0, NU=0.3))  # " + part("starter_material"),
            f"MATTER = AFFE_MATERIAU(MAILLAGE={cut}, AFFE=_F(TOUT='OUI', MATER=STEEL))", ""]


def _supports(groups, free, stand):
    """Imposed displacements, and why these. @param free skins that are in no contact @param stand what standing() found of them"""
    axis, mirrors, held, pressed = stand
    fixed = ", ".join(f"{d}=0.0" for d in ("DX", "DY", "DZ")[:groups.dimension])
    supports = []  # (occurrence of MECA_IMPO, why)
    if held:
        supports.append((f"_F(GROUP_MA={held.name!r}, {fixed})", part("starter_lowest_skin", skin=held.name)))
    for skin in mirrors:
        supports.append((f"_F(GROUP_MA={skin.name!r}, D{skin.plane()[0]}=0.0)", part("starter_symmetry", skin=skin.name, axis=skin.plane()[0])))
    if pressed:  # what is pressed alone may glide away
        mirrored = {skin.plane()[0] for skin in mirrors if skin.part in (pressed.part, -1)}
        across = [f"D{a}=0.0" for a in "XYZ"[:groups.dimension] if a not in mirrored and a != axis]
        if across:
            supports.append((f"_F(GROUP_MA={pressed.name!r}, {', '.join(across)})", part("starter_pressed", skin=pressed.name)))
    if not supports:
        lowest = min(free, key=lambda skin: skin.points[:, groups.dimension - 1].mean(), default=None)
        whole = next(iter(groups.bodies), None)
        where = f"GROUP_MA={lowest.name!r}" if lowest else f"GROUP_MA={whole!r}" if whole else "TOUT='OUI'"
        supports.append((f"_F({where}, {fixed})", part("starter_no_support", skin=lowest.name) if lowest else part("starter_no_skin")))
    imposed, why = zip(*supports)
    return ["# " + part("starter_held", why="; ".join(why)),
            f"HELD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO={imposed[0] if len(imposed) == 1 else '(' + ', '.join(imposed) + ')'})"]


def _loads(pressed):
    if not pressed:
        return ["# " + part("starter_loads_to_add", load="LOAD = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='...', PRES=1.0))")]
    return ["# " + part("starter_loads", skin=pressed.name),
            f"LOAD = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA={pressed.name!r}, PRES=1.0))",
            "RAMP = DEFI_FONCTION(NOM_PARA='INST', VALE=(0.0, 0.0, 1.0, 1.0))"]


def _contact(pairs):
    if not pairs:
        return []
    zones = [f"    _F(APPARIEMENT='MORTAR', ALGO_CONT='LAC', GROUP_MA_ESCL={slave.name!r}, GROUP_MA_MAIT={master.name!r})," for slave, master in pairs]
    return ["# " + part("starter_swap"),
            "CONTACT = DEFI_CONTACT(MODELE=MODEL, FORMULATION='CONTINUE', ALGO_RESO_GEOM='NEWTON', ALGO_RESO_CONT='NEWTON', ZONE=(",
            *zones, "))", ""]


def _solution(pairs, pressed):
    """The computation, and what is done with its result."""
    loads = ["_F(CHARGE=HELD)", *(["_F(CHARGE=LOAD, FONC_MULT=RAMP)"] if pressed else [])]
    return ["STEPS = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=_F(JUSQU_A=1.0, NOMBRE=1))",
            "TIMES = DEFI_LIST_INST(DEFI_LIST=_F(LIST_INST=STEPS), ECHEC=_F(EVENEMENT='ERREUR', ACTION='DECOUPE'))",
            "RESULT = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER,", f"                       EXCIT=({', '.join(loads)},),",
            *(["                       CONTACT=CONTACT,"] if pairs else []),
            "                       COMPORTEMENT=_F(TOUT='OUI', RELATION='ELAS', DEFORMATION='PETIT'),",
            "                       INCREMENT=_F(LIST_INST=TIMES),",
            "                       CONVERGENCE=_F(RESI_GLOB_RELA=1.0e-6, ITER_GLOB_MAXI=50))", "",
            "RESULT = CALC_CHAMP(reuse=RESULT, RESULTAT=RESULT, CONTRAINTE='SIEF_NOEU')",
            "IMPR_RESU(FORMAT='MED', UNITE=80, RESU=_F(RESULTAT=RESULT))", "", "FIN()", ""]


def parser():
    """Of its command line."""
    made = CommandLine(prog="lacon new", description="Writes a starter study from a mesh's groups, or a template that runs as it is.",
                                     formatter_class=argparse.RawDescriptionHelpFormatter,
                                     epilog="\n".join([option_words("templates:"), *(f"  {name:15} {option_words(words)}" for name, words in templates.known().items())]))
    which = made.add_mutually_exclusive_group(required=True)
    made.add("mesh", group=which, metavar="MESH", nargs="?", help="the mesh: {formats}", filled={"formats": ", ".join(read_formats)})
    made.add("--template", group=which, metavar="NAME", help="one of those below: a folder with the command file and the script of its mesh")
    made.add("--out", metavar="FILE", help="the command file or the folder to write, which must not be there; otherwise MESH.comm or NAME")
    return made


def run(arguments):
    """@return exit status"""
    asked = parser()
    options = asked.parse_args(arguments)
    if options.template:
        return templates.write(options.template, options.out)
    source = pathlib.Path(options.mesh)
    if source.suffix.lower() not in read_formats:
        asked.wrong("file_named", file=source, names=", ".join(read_formats))
    target = pathlib.Path(options.out or source.with_suffix(".comm").name)
    if target.exists():
        asked.wrong("file_is_there", file=target)
    form = read_formats[source.suffix.lower()]
    with tempfile.TemporaryDirectory(prefix="lacon_new_") as folder:
        this = Study(pathlib.Path(folder) / "new.base", {20: str(source)}, provided=execution.provided_names())
        made = []

        def work():
            execution.run_text(this, "lacon new", f"DEBUT()\nMESH = LIRE_MAILLAGE(UNITE=20, FORMAT={form!r})\n")
            made.append(study(MeshGroups(this.names.values["MESH"]), os.fspath(source), form))

        status, _ = launch.run_study(this, work)
    if status == outcome.done:
        try:
            target.write_text(made[0], encoding="utf-8")
        except OSError as error:
            fail("STUDY_50", "lacon new --out", option="--out", file=target, reason=error.strerror)
        print(part("starter_made", file=target, mesh=source))
    return status
