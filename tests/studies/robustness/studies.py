"""The studies of the table: rows of studies of one kind, with what is asked of them."""

import dataclasses
import itertools
import json
import math
import pathlib

from bodies import (arch, cap, half_disc, lines, polygon, quarter_of_a_lens, round_tool, round_tool_in_space, slab, slab_in_space, tip, turned)
import peer_checks
from meshes import block, graded, union, write_med
from study_test import PEER_MESHES

HERE = pathlib.Path(__file__).resolve().parent

ORDERS = ("QUAD4", "QUAD8")
STRAINS = ("PETIT", "GREEN_LAGRANGE")
PLASTIC_STRAINS = ("PETIT", "PETIT_REAC")
SIDES = (0, 1)  # which of the two skins is the slave


@dataclasses.dataclass
class Study:
    """One computation. An instant of its list is the number of its step, or one of `instants`."""
    name: str
    mesh: object
    materials: dict       # body -> keywords of DEFI_MATERIAU
    moves: list           # keywords of MECA_IMPO, see study.comm
    zones: list
    steps: int
    strain: str = "PETIT"
    model: str = "D_PLAN"
    contact: dict = dataclasses.field(default_factory=dict)  # more keywords of DEFI_CONTACT
    loads: tuple = ()     # keywords of AFFE_CHAR_MECA_F, see study.comm
    instants: tuple = ()
    most: int = 60        # ITER_GLOB_MAXI
    residual: float = 1e-6  # RESI_GLOB_RELA
    cut: bool = False     # whether DEFI_LIST_INST says that a step that fails is cut, which is the default of plain lists too
    stops: bool = False   # whether a step that fails ends the study: ACTION='ARRET'
    solver: str = "MUMPS"  # METHODE of SOLVEUR
    asked: dict = dataclasses.field(default_factory=dict)  # figure -> largest value; "finished" is always asked
    driven: str = ""      # group whose reactions are measured
    measure: object = None  # from (instants, displacements of the driven group, its reactions) to figures
    view: object = None   # limits of the picture (x, y)

    result = "RESU"

    def prepare(self, folder):
        """Write the inputs. @return (arguments of the launcher, variables of its environment)"""
        write_med(folder / "mesh.med", self.mesh)
        orders = {"model": self.model, "materials": self.materials, "moves": self.moves, "zones": self.zones, "contact": self.contact, "strain": self.strain,
                  "cut": self.cut, "stops": self.stops, "loads": self.loads, "most": self.most, "residual": self.residual, "solver": self.solver, "instants": self.instants or [float(k) for k in range(self.steps + 1)]}
        (folder / "study.json").write_text(json.dumps(orders))
        return [HERE / "study.comm", "--unit", f"20={folder / 'mesh.med'}"], {"ROBUSTNESS_STUDY": str(folder / "study.json")}


@dataclasses.dataclass
class PeerCase:
    """One of the peer's cases, as tests/studies runs it; its mesh is not part of the project."""
    name: str
    steps: int
    asked: dict
    measure = driven = view = None
    result = "RESU"

    def prepare(self, folder):
        comms, meshes = peer_checks.files(self.name)
        units = {**{unit: PEER_MESHES / mesh for unit, mesh in meshes.items()}, 80: folder / "out.med"}
        return ([*(HERE.parent / comm for comm in comms), *(word for unit, path in units.items() for word in ("--unit", f"{unit}={path}"))],
                {"CASE": self.name})


def elastic(young, poisson=0.3):
    return {"ELAS": {"E": young, "NU": poisson}}


def plastic(young, limit, slope):
    return {**elastic(young), "ECRO_LINE": {"SY": limit, "D_SIGM_EPSI": slope}}


def zone(first, second, side):
    """The bodies' skins as slave and master. @param side 0: the first one is the slave"""
    slave, master = (first, second) if side == 0 else (second, first)
    return {"GROUP_MA_ESCL": f"{slave}_SKIN", "GROUP_MA_MAIT": f"{master}_SKIN"}


def named(*words):
    return ", ".join(str(word) for word in words if word)


def slave(bodies, side):
    return f"slave {bodies[side].lower()}"


def held(body):
    return {"GROUP_MA": f"{body}_BASE", "DX": 0.0, "DY": 0.0}


def path(body, x, y, **more):
    """The base of a body along points (instant, displacement)."""
    return {"GROUP_MA": f"{body}_BASE", "DX": [list(p) for p in x], "DY": [list(p) for p in y], **more}


# ------------------------------------------------------------------------------------------------- measures


def forces(instants, moved, reactions):
    """The largest ratio of the driven group's force along x to the one along y, once it is pressed, where it has not come off again."""
    fx, fy = reactions[5:, :, 0].sum(axis=1), reactions[5:, :, 1].sum(axis=1)
    pressed = abs(fy) > 1e-6 * abs(fy).max()
    return {"Fx/Fy": float(abs(fx[pressed] / fy[pressed]).max())}


def ripple(instants, moved, reactions):
    """Largest less smallest vertical force of the drag over their mean."""
    force = reactions[5:, :, -1].sum(axis=1)
    return {"ripple": float((force.max() - force.min()) / abs(force.mean()))}


def lost_work(instants, moved, reactions):
    """Work of the driven group over the cycle, by trapezia, over the largest on the way."""
    steps = ((reactions[1:] + reactions[:-1]) / 2 * (moved[1:] - moved[:-1])).sum(axis=(1, 2))
    work = steps.cumsum()
    return {"lost work": float(abs(work[-1]) / abs(work).max())}


# ------------------------------------------------------------------------------------------------- rows


def pressed_cylinder(kind, side, depth, steps, young=(1000.0, 1000.0), **more):
    """A round tool of radius 1 pressed into a block."""
    mesh = union([round_tool(kind, "TOOL", 1.0, (0, 1), (36, 10)), slab(kind, "SLAB", (-2, 2), (-2, 0), (40, 14))])
    return Study(mesh=mesh, materials={"TOOL": elastic(young[0]), "SLAB": elastic(young[1])}, zones=[zone("TOOL", "SLAB", side)],
                 moves=[held("SLAB"), path("TOOL", [(0, 0), (steps, 0)], [(0, 0), (steps, -depth)])], steps=steps, driven="TOOL_BASE",
                 view=((-2, 2), (-1.2, 1.2)), **more)


def hertz():
    for depth, steps, most in ((0.05, 10, 35), (0.3, 1, 9)):
        for kind, strain, side in itertools.product(ORDERS, STRAINS, SIDES):
            yield pressed_cylinder(kind, side, depth, steps, strain=strain, asked={"solutions": most},
                                   name=named(f"{depth * 100:g} % in {steps}", kind, strain, slave(("TOOL", "SLAB"), side)))


def contrast():
    """The ratio is that of the tool to the slab."""
    for ratio, kind, strain, side in itertools.product((1e-6, 1e-3, 1e3, 1e6), ORDERS, STRAINS, SIDES):
        yield pressed_cylinder(kind, side, 0.05, 10, young=(1000.0 * max(ratio, 1), 1000.0 * max(1 / ratio, 1)), strain=strain,
                               asked={"per step": 6}, name=named(f"ratio {ratio:.0e}", kind, strain, slave(("TOOL", "SLAB"), side)))


def ironing():
    """Narrower tools press the slab to less than 1 / sqrt(3) of its height, where the law of GREEN_LAGRANGE has no stable state."""
    for (depth, most), width in itertools.product(((0.1, 5), (0.2, 5), (0.3, 6), (0.4, 7)), (2.0, 2.5, 3.0)):
        for kind, strain, side in itertools.product(ORDERS, STRAINS, SIDES):
            mesh = union([round_tool(kind, "TOOL", width / 2, (-0.75, width / 2), (20, 5)), slab(kind, "SLAB", (-3, 3), (-2, 0), (40, 10))])
            yield Study(name=named(f"{depth * 100:g} % deep", f"width {width:g}", kind, strain, slave(("TOOL", "SLAB"), side)), mesh=mesh,
                        materials={"TOOL": elastic(1e4), "SLAB": elastic(1e3)}, zones=[zone("TOOL", "SLAB", side)], strain=strain, cut=True,
                        moves=[held("SLAB"), path("TOOL", [(0, 0), (15, 0), (45, 1.5)], [(0, 0), (15, -depth), (45, -depth)])], steps=45,
                        asked={"per step": most}, driven="TOOL_BASE", view=((-3, 3), (-1.4, 1.4)))


def two_blocks(kind):
    """A block on a smaller one."""
    return union([slab(kind, "UPPER", (-1, 1), (0, 1), (14, 7), skin="bottom"), slab(kind, "LOWER", (-0.5, 0.5), (-1, 0), (9, 9))])


def overhang():
    for depth, kind, strain, side in itertools.product((0.1, 0.2), ORDERS, STRAINS, SIDES):
        yield Study(name=named(f"{depth * 100:g} %", kind, strain, slave(("UPPER", "LOWER"), side)), mesh=two_blocks(kind),
                    materials={"UPPER": elastic(1e3), "LOWER": elastic(1e3)}, zones=[zone("UPPER", "LOWER", side)], strain=strain, cut=True,
                    moves=[held("LOWER"), path("UPPER", [(0, 0), (10, 0)], [(0, 0), (10, -depth)])], steps=10, asked={"per step": 5},
                    driven="UPPER_BASE")


def pressed_arch():
    for kind, strain, side, ratio in itertools.product(ORDERS, STRAINS, SIDES, (1, 10)):
        mesh = union([arch(kind, "ARCH", (0.85, 1.0), (40, 3)), slab(kind, "PLATE", (-1.2, 1.2), (1, 1.3), (37, 4), skin="bottom")])
        yield Study(name=named(f"plate x{ratio}", kind, strain, slave(("ARCH", "PLATE"), side)), mesh=mesh,
                    materials={"ARCH": elastic(1e3), "PLATE": elastic(1e3 * ratio)}, zones=[zone("ARCH", "PLATE", side)], strain=strain, cut=True,
                    moves=[held("ARCH"), path("PLATE", [(0, 0), (20, 0)], [(0, 0), (20, -0.45)])], steps=20,
                    asked={"solutions": 120, "lost": 0}, driven="PLATE_BASE")


def rolling_polygon():
    sides, press = 12, 0.04
    apothem = math.cos(math.pi / sides)
    turn = f"{math.pi / 40!r} * max(INST - 3.0, 0.0)"
    moves = {"DX": f"X * (cos({turn}) - 1) + (Y - {apothem!r}) * sin({turn}) + {apothem!r} * {turn}",
             "DY": f"-X * sin({turn}) + (Y - {apothem!r}) * (cos({turn}) - 1) - {press} * min(INST, 3.0) / 3.0"}
    for kind, side in itertools.product(ORDERS, SIDES):
        mesh = union([polygon(kind, "WHEEL", sides, (0, apothem), (3, 4)), slab(kind, "SLAB", (-1, 4), (-1, 0), (34, 6))])
        yield Study(name=named(kind, "GREEN_LAGRANGE", slave(("WHEEL", "SLAB"), side)), mesh=mesh,
                    materials={"WHEEL": elastic(1e4), "SLAB": elastic(1e3)}, zones=[zone("WHEEL", "SLAB", side)], strain="GREEN_LAGRANGE",
                    moves=[held("SLAB"), {"GROUP_MA": "WHEEL_BASE", **moves}], steps=43, asked={"solutions": 170}, driven="WHEEL_BASE")


def plastic_indentation():
    for back, punch in itertools.product((5, 1), ("round", "flat")):
        for kind, strain, side in itertools.product(ORDERS, PLASTIC_STRAINS, SIDES):
            tool = (round_tool(kind, "TOOL", 1.0, (0, 1), (24, 6)) if punch == "round" else
                    slab(kind, "TOOL", (-0.5, 0.5), (0, 1), (9, 6), skin="bottom"))
            mesh = union([tool, slab(kind, "SLAB", (-2, 2), (-2, 0), (26, 10))])
            steps = 10 + back
            yield Study(name=named(f"{punch} punch", f"back in {back}", kind, strain, slave(("TOOL", "SLAB"), side)), mesh=mesh,
                        materials={"TOOL": elastic(2e6), "SLAB": plastic(2e5, 400.0, 2000.0)}, zones=[zone("TOOL", "SLAB", side)], strain=strain,
                        cut=True, moves=[held("SLAB"), path("TOOL", [(0, 0), (steps, 0)], [(0, 0), (10, -0.1), (steps, 0.02)])], steps=steps,
                        asked={"solutions": 150}, driven="TOOL_BASE", view=((-2, 2), (-1.2, 1.2)))


def tips():
    gradient, depth = math.tan(math.radians(15)), 0.1
    for what, kind, strain, side in itertools.product(("tip", "groove", "wedge"), ORDERS, STRAINS, SIDES):
        moves = [(0, 0), (10, 0)], [(0, 0), (10, -depth)]
        if what == "tip":
            mesh = union([tip(kind, "TOOL", 1.0, (12, 8)), slab(kind, "SLAB", (-2, 2), (-2, 0), (26, 10))])
        elif what == "groove":
            mesh = union([round_tool(kind, "TOOL", 0.6, (0, 0.6 * math.sqrt(2) - 0.8), (24, 6)),
                          slab(kind, "SLAB", (-1.6, 1.6), (-2, 0), (24, 8), top=lambda x: -max(0.0, 0.8 - abs(x)))])
        else:  # a slope driven below a block from the right, whose right lower corner it meets
            mesh = union([slab(kind, "SLAB", (-1.0, 2.0), (-1, 0), (21, 6), top=lambda x: gradient * x),
                          slab(kind, "TOOL", (0, 1), (gradient, 1 + gradient), (8, 8), skin="bottom", sides={"right": "TOOL_SKIN"})])
            moves = [(0, 0), (10, 0)], [(0, 0), (10, 0)]
        drive = [held("TOOL"), path("SLAB", [(0, 0), (10, -0.5)], [(0, 0), (10, 0)])] if what == "wedge" else [held("SLAB"), path("TOOL", *moves)]
        yield Study(name=named(what, kind, strain, slave(("TOOL", "SLAB"), side)), mesh=mesh,
                    materials={"TOOL": elastic(1e4), "SLAB": elastic(1e3)}, zones=[zone("TOOL", "SLAB", side)], strain=strain, cut=True,
                    moves=drive, steps=10, asked={"solutions": 45}, driven="TOOL_BASE")


def tilted_corner():
    """Frictionless on a plate all of whose nodes are held: no force along it."""
    for kind, strain, side in itertools.product(ORDERS, STRAINS, SIDES):
        body = block(kind, lines(0, 1, 6), lines(0, 1, 6), None, "TOOL",
                     {"bottom": "TOOL_SKIN", "left": "TOOL_SKIN", "top": "TOOL_BASE", "right": "TOOL_BASE"})
        mesh = union([turned(body, 20), slab(kind, "PLATE", (-1.5, 3), (-0.5, 0), (31, 2))])
        yield Study(name=named(kind, strain, slave(("TOOL", "PLATE"), side)), mesh=mesh,
                    materials={"TOOL": elastic(1e3), "PLATE": elastic(1e6)}, zones=[zone("TOOL", "PLATE", side)], strain=strain,
                    moves=[{"GROUP_MA": "PLATE", "DX": 0.0, "DY": 0.0}, path("TOOL", [(0, 0), (5, 0), (20, 1)], [(0, 0), (5, -0.05), (20, -0.05)])],
                    steps=20, asked={"Fx/Fy": 1e-6}, driven="TOOL_BASE", measure=forces)


def closed_cycle():
    """Two blocks, free sideways, crushed by 25 % and released: exact integration gives the work back."""
    for half, kind, side in itertools.product((5, 10), ORDERS, SIDES):
        mesh = union([slab(kind, "UPPER", (0, 1), (0, 1), (5, 5), skin="bottom", sides={"left": "AXIS"}),
                      slab(kind, "LOWER", (0, 1), (-1, 0), (7, 7), sides={"left": "AXIS"})])
        yield Study(name=named(f"{2 * half} steps", kind, slave(("UPPER", "LOWER"), side)), mesh=mesh,
                    materials={"UPPER": elastic(1e3), "LOWER": elastic(1e3)}, zones=[zone("UPPER", "LOWER", side)], strain="PETIT_REAC_MILIEU", cut=True,
                    moves=[{"GROUP_MA": "LOWER_BASE", "DY": 0.0}, {"GROUP_MA": "AXIS", "DX": 0.0},
                           {"GROUP_MA": "UPPER_BASE", "DY": [[0, 0], [half, -0.5], [2 * half, 0]]}],
                    steps=2 * half, asked={"lost work": 0.01}, driven="UPPER_BASE", measure=lost_work)


def sliding_in_a_die():
    """A block pushed by 155 mm through a die that narrows by 2.5 of 25 mm; its half, the base of the block on the plane of symmetry."""
    def profile(x):
        return 25.0 - 2.5 * min(max((x - 110.0) / 50.0, 0.0), 1.0)

    for kind, strain, side in itertools.product(ORDERS, PLASTIC_STRAINS, SIDES):
        mesh = union([slab(kind, "BLOCK", (0, 100), (0, 25), (20, 5), sides={"left": "PUSHED"}),
                      slab(kind, "DIE", (-10, 280), (0, 65), (58, 4), top=profile, skin="bottom")])
        yield Study(name=named("die", kind, strain, slave(("BLOCK", "DIE"), side)), mesh=mesh,
                    materials={"BLOCK": plastic(2e5, 400.0, 2000.0), "DIE": elastic(2e5)}, zones=[zone("BLOCK", "DIE", side)], strain=strain, cut=True,
                    moves=[held("DIE"), {"GROUP_MA": "BLOCK_BASE", "DY": 0.0}, {"GROUP_MA": "PUSHED", "DX": [[0, 0], [31, 155.0]]}], steps=31,
                    asked={"per step": 8}, driven="PUSHED")


def meeting_beams():
    for kind, strain, side in itertools.product(ORDERS, STRAINS, SIDES):
        upper = block(kind, lines(0, 4, 30), lines(0.2, 0.4, 2), None, "UPPER", {"bottom": "UPPER_SKIN", "left": "UPPER_BASE", "right": "UPPER_SKIN"})
        lower = block(kind, lines(3, 7, 33), lines(0.0, 0.2, 2), None, "LOWER", {"top": "LOWER_SKIN", "right": "LOWER_BASE", "left": "LOWER_SKIN"})
        yield Study(name=named("beams", kind, strain, slave(("UPPER", "LOWER"), side)), mesh=union([upper, lower]),
                    materials={"UPPER": elastic(1e4), "LOWER": elastic(1e4)}, zones=[zone("UPPER", "LOWER", side)], strain=strain, cut=True,
                    moves=[held("LOWER"), path("UPPER", [(0, 0), (20, 0)], [(0, 0), (20, -1.0)])], steps=20, asked={"per step": 8}, driven="UPPER_BASE")


def bodies_held_by_contact():
    """Two round bodies between two plates, which touch at points and are held along the axis by nothing else: three zones."""
    skins = (("LOW_PLATE_SKIN", "FIRST_LOW"), ("FIRST_HIGH", "SECOND_LOW"), ("SECOND_HIGH", "TOP_PLATE_SKIN"))
    bodies = ("LOW_PLATE", "FIRST", "SECOND", "TOP_PLATE")
    for model, kind, strain, side in itertools.product(("AXIS", "D_PLAN"), ORDERS, STRAINS, SIDES):
        axis = {"left": "AXIS"}
        mesh = union([slab(kind, "LOW_PLATE", (0, 1.5), (-0.5, 0), (9, 3), sides=axis), half_disc(kind, "FIRST", 1.0, 1.0, 4),
                      half_disc(kind, "SECOND", 1.0, 3.0, 5), slab(kind, "TOP_PLATE", (0, 1.5), (4, 4.5), (10, 3), skin="bottom", sides=axis)])
        moves = [held("LOW_PLATE"), path("TOP_PLATE", [(0, 0), (10, 0)], [(0, 0), (10, -0.2)]), {"GROUP_MA": "AXIS", "DX": 0.0}]
        yield stack(named("stack", model, kind, strain, "slaves below" if side == 0 else "slaves above"), mesh, moves, bodies, skins, side, strain, model)
    for kind, strain, side in itertools.product(("HEXA8", "HEXA20"), STRAINS, SIDES):
        planes = {(0, 0): "XZERO", (1, 0): "YZERO"}
        mesh = union([slab_in_space(kind, "LOW_PLATE", (0, 0.8), (0, 0.8), (-0.4, 0), (4, 4, 2), sides=planes),
                      quarter_of_a_lens(kind, "FIRST", 1.0, 3, planes), quarter_of_a_lens(kind, "SECOND", 3.0, 4, planes),
                      slab_in_space(kind, "TOP_PLATE", (0, 0.8), (0, 0.8), (4, 4.4), (5, 5, 2), skin="bottom", sides=planes)])
        moves = [{"GROUP_MA": "LOW_PLATE_BASE", "DZ": 0.0}, {"GROUP_MA": "TOP_PLATE_BASE", "DZ": [[0, 0], [10, -0.2]]},
                 {"GROUP_MA": "XZERO", "DX": 0.0}, {"GROUP_MA": "YZERO", "DY": 0.0}]
        yield stack(named("stack", "3D", kind, strain, "slaves below" if side == 0 else "slaves above"), mesh, moves, bodies, skins, side, strain, "3D")


def stack(name, mesh, moves, bodies, skins, side, strain, model):
    return Study(name=name, mesh=mesh, model=model, materials={body: elastic(1e3) for body in bodies}, strain=strain, cut=True, moves=moves, steps=10,
                 zones=[{"GROUP_MA_ESCL": pair[side], "GROUP_MA_MAIT": pair[1 - side]} for pair in skins], asked={"per step": 8},
                 driven="TOP_PLATE_BASE")


def difficult():
    yield from sliding_in_a_die()
    yield from meeting_beams()
    yield from bodies_held_by_contact()


def ironing_in_space():
    for ball, kind, strain, side in itertools.product((True, False), ("HEXA8", "HEXA20", "TETRA10"), STRAINS, SIDES):
        fine = kind == "HEXA8"
        mesh = union([round_tool_in_space(kind, "TOOL", 1.0, (-0.4, 0, 1), (6, 6, 3) if fine else (4, 4, 2), ball),
                      slab_in_space(kind, "SLAB", (-1.2, 1.4), (-1, 1), (-1, 0), (12, 9, 4) if fine else (8, 6, 3))])
        low, drag = [[0, 0], [4, -0.1], [12, -0.1]], [[0, 0], [4, 0], [12, 0.8]]
        yield Study(name=named("sphere" if ball else "half-cylinder", kind, strain, slave(("TOOL", "SLAB"), side)), mesh=mesh, model="3D",
                    materials={"TOOL": elastic(1e4), "SLAB": elastic(1e3)}, zones=[zone("TOOL", "SLAB", side)], strain=strain, cut=True,
                    moves=[{**held("SLAB"), "DZ": 0.0}, {"GROUP_MA": "TOOL_BASE", "DX": drag, "DY": 0.0, "DZ": low}], steps=12,
                    asked={"per step": 6}, driven="TOOL_BASE", measure=ripple)


def aligned_ends():
    """Columns whose ends are aligned, which flow and widen alike: an end of the one comes to lie on either side of the other's."""
    for model, kind, cells, side in itertools.product(("D_PLAN", "C_PLAN"), ORDERS, ((4, 6), (7, 5)), SIDES):
        mesh = union([slab(kind, name, (-0.5, 0.5), (low, low + 1), (n, n), skin=skin)
                      for name, low, n, skin in (("UPPER", 0, cells[0], "bottom"), ("LOWER", -1, cells[1], "top"))])
        law = plastic(2e5, 400.0, 2000.0)
        yield Study(name=named(model, kind, f"{cells[0]} on {cells[1]} cells", slave(("UPPER", "LOWER"), side)), mesh=mesh, model=model,
                    materials={"UPPER": law, "LOWER": {**law, "ELAS": {"E": 2e5, "NU": 0.2}}}, zones=[zone("UPPER", "LOWER", side)],
                    moves=[held("LOWER"), path("UPPER", [(0, 0), (10, 0)], [(0, 0), (10, -0.02)])], steps=10, asked={"per step": 8}, driven="UPPER_BASE")


def aligned_faces():
    """The same in space: columns a cell thick, free on all sides, each of whose faces comes to lie on either side of the other column's."""
    for cells, side in itertools.product(((4, 6), (7, 5)), SIDES):
        mesh = union([slab_in_space("HEXA20", name, (-0.5, 0.5), (0, 0.25), (low, low + 1), (n, 1, n), skin=skin)
                      for name, low, n, skin in (("UPPER", 0, cells[0], "bottom"), ("LOWER", -1, cells[1], "top"))])
        law = plastic(2e5, 400.0, 2000.0)
        yield Study(name=named("HEXA20", f"{cells[0]} on {cells[1]} cells", slave(("UPPER", "LOWER"), side)), mesh=mesh, model="3D",
                    materials={"UPPER": law, "LOWER": {**law, "ELAS": {"E": 2e5, "NU": 0.2}}}, zones=[zone("UPPER", "LOWER", side)],
                    moves=[{**held("LOWER"), "DZ": 0.0}, {**held("UPPER"), "DZ": [[0, 0], [10, -0.02]]}], steps=10,
                    asked={"per step": 8}, driven="UPPER_BASE")


def whole_skins():
    """A block on a smaller or a larger one, all sides of both in the zone."""
    sides = {name: {"left": f"{name}_SKIN", "right": f"{name}_SKIN"} for name in ("UPPER", "LOWER")}
    for (widths, kind), strain, side in itertools.product(itertools.product(((1.0, 0.5), (0.5, 1.0)), ORDERS), STRAINS, SIDES):
        mesh = union([slab(kind, "UPPER", (-widths[0], widths[0]), (0, 1), (round(14 * widths[0]), 7), skin="bottom", sides=sides["UPPER"]),
                      slab(kind, "LOWER", (-widths[1], widths[1]), (-1, 0), (round(18 * widths[1]), 9), sides=sides["LOWER"])])
        for body in ("UPPER", "LOWER"):
            mesh.cell_groups[f"{body}_SKIN"] += mesh.cell_groups[f"{body}_BASE"]
        yield Study(name=named("larger above" if widths[0] > widths[1] else "smaller above", kind, strain, slave(("UPPER", "LOWER"), side)), mesh=mesh,
                    materials={"UPPER": elastic(1e3), "LOWER": elastic(1e3)}, zones=[zone("UPPER", "LOWER", side)], strain=strain, cut=True,
                    moves=[held("LOWER"), path("UPPER", [(0, 0), (10, 0)], [(0, 0), (10, -0.1)])], steps=10, asked={"per step": 6}, driven="UPPER_BASE")


def force_driven():
    """Half a round body, or a block, that nothing but contact holds along its axis, pressed on a slab by a force, with the default of
    10 iterations: the contact of the round one begins in a point, and is 7 cells wide behind the first step."""
    instants = (0.0, 0.04, 0.28, 0.52, 0.76, 1.0)
    for model, what, kind, strain, side in itertools.product(("AXIS", "D_PLAN"), ("round", "block"), ORDERS, STRAINS, SIDES):
        fine = graded(1.0, 0.01, 0.1, 1.2)
        low = (lambda x, y: (x, y + (1 - y) * (1 - math.sqrt(1 - (0.9 * x) ** 2)))) if what == "round" else None
        across = fine if what == "round" else lines(0, 0.5, 16)
        mesh = union([block(kind, across, graded(1.0, 0.01, 0.05, 1.3), low, "TOOL", {"bottom": "TOOL_SKIN", "top": "TOOL_BASE", "left": "AXIS"}),
                      block(kind, graded(2.0, 0.013, 0.15, 1.3), -graded(2.0, 0.013, 0.05, 1.3)[::-1], None, "SLAB",
                            {"top": "SLAB_SKIN", "bottom": "SLAB_BASE", "left": "AXIS"})])
        pressure = 3.0 if what == "round" else 30.0
        yield Study(name=named(what, model, kind, strain, slave(("TOOL", "SLAB"), side)), mesh=mesh, model=model, strain=strain, cut=True,
                    materials={"TOOL": elastic(1e3), "SLAB": elastic(1e3)}, zones=[zone("TOOL", "SLAB", side)], instants=instants, steps=5,
                    moves=[held("SLAB"), {"GROUP_MA": "AXIS", "DX": 0.0}], loads=({"PRES_REP": {"GROUP_MA": "TOOL_BASE", "PRES": [[0, 0], [1, pressure]]}},),
                    most=10, asked={"per step": 8, "lost": 0}, driven="TOOL_BASE")


def flush_ends():
    """A block flush with the end of a wider one, pressed by a part of its modulus in one step or in five: each widens, and the end of the
    one comes to lie within 1e-4 of the other's, where forces change by the pressure times the gap there."""
    for kind, strain, side, (pressure, steps) in itertools.product(ORDERS, STRAINS, SIDES, ((0.025, 1), (0.05, 1), (0.05, 5))):
        mesh = union([slab(kind, "UPPER", (0, 3), (1, 2), (3, 2), skin="bottom"), slab(kind, "LOWER", (0, 4), (0, 1), (4, 2))])
        yield Study(name=named(f"{100 * pressure:g} %", f"{steps} steps", kind, strain, slave(("UPPER", "LOWER"), side)), mesh=mesh, strain=strain,
                    materials={"UPPER": elastic(2e3), "LOWER": elastic(2e3)}, zones=[zone("UPPER", "LOWER", side)], steps=steps,
                    moves=[held("LOWER"), {"GROUP_MA": "UPPER_BASE", "DX": 0.0}], most=25,
                    loads=({"PRES_REP": {"GROUP_MA": "UPPER_BASE", "PRES": [[0, 0], [steps, 2e3 * pressure]]}},),
                    asked={"solutions": 14 if steps == 1 else 40, "lost": 0}, driven="UPPER_BASE")


def caps():
    """A block with a curved underside, whose faces on two sides slide, comes down on a wider one under its whole load: 400 patches or 270, of which those that are
    wrong are more than columns of the inverse are worth."""
    laws = {"elastic": elastic(2e3), "plastic": plastic(2e3, 10.0, 100.0)}
    for n, (law, material), steps in itertools.product(((20, 20, 9), (18, 15, 8)), laws.items(), (1, 3)):
        mesh = union([cap("HEXA8", "UPPER", (0, 1), (0, 1), (0.5, 1), n, 0.0125, {(0, 0): "UPPER_X", (1, 0): "UPPER_Y"}),
                      slab_in_space("HEXA8", "LOWER", (0, 1), (0, 1), (0, 0.5), (n[0] + 2, *n[1:]), sides={(0, 0): "LOWER_X", (1, 0): "LOWER_Y"})])
        yield Study(name=named(f"{n[0] * n[1]} patches", law, f"{steps} steps"), mesh=mesh, model="3D", materials={"UPPER": material, "LOWER": material},
                    zones=[zone("UPPER", "LOWER", 0)], steps=steps, most=50,
                    moves=[{"GROUP_MA": "LOWER_BASE", "DZ": 0.0}, *({"GROUP_MA": f"{body}_{axis}", f"D{axis}": 0.0} for body in ("UPPER", "LOWER") for axis in "XY")],
                    loads=({"PRES_REP": {"GROUP_MA": "UPPER_BASE", "PRES": [[0, 0], [steps, 25.0]]}},), asked={"per step": 8 if law == "elastic" else 10, "lost": 0},
                    driven="LOWER_BASE")


def peer_cases():
    for name, steps, most in (("ssnv104k", 10, 50), ("ssnv104n", 10, 50), ("ssnp165c", 20, 90), ("ssnp165e", 20, 90)):
        if PEER_MESHES.is_dir():
            yield PeerCase(name, steps, {"solutions": most})


#: row -> (what it is, its studies)
ROWS = {
    "hertz": ("Hertz cylinder", hertz),
    "ironing": ("ironing by a half-cylinder", ironing),
    "overhang": ("block crushed on a smaller one", overhang),
    "arch": ("arch pressed by a plate", pressed_arch),
    "polygon": ("polygon rolling half a turn", rolling_polygon),
    "plastic": ("plastic indentation and unloading", plastic_indentation),
    "tips": ("tip of 45 degrees, groove, wedge", tips),
    "contrast": ("contrast of stiffness", contrast),
    "space": ("ironing in space", ironing_in_space),
    "difficult": ("block in a die, beams that meet, bodies held by contact", difficult),
    "corner": ("tilted corner dragged", tilted_corner),
    "aligned": ("columns whose ends are aligned", aligned_ends),
    "faces": ("columns whose faces are aligned, in space", aligned_faces),
    "skins": ("blocks whose whole skins are in the zone", whole_skins),
    "force": ("bodies that contact alone holds, driven by a force", force_driven),
    "flush": ("blocks with flush ends, pressed in few steps", flush_ends),
    "caps": ("curved blocks that come down in few steps", caps),
    "peer": ("the peer's half spheres and half ring", peer_cases),
    "cycle": ("closed elastic cycle with PETIT_REAC (before) and PETIT_REAC_MILIEU (now)", closed_cycle),
}


def studies(row):
    return list(ROWS[row][1]())
