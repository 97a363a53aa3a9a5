"""Studies of forming that nobody has chosen: a punch draws a sheet into a die or bends it over a roller, a tool forms the head of a rivet; most of them flow.
Each is drawn from its number: `unseen.py --forming FIRST [COUNT]`."""

import math
import random

from bodies import lines
from meshes import block, union
from studies import Study, elastic, named, plastic

SYMMETRY = {"GROUP_MA": "MIDDLE", "DX": 0.0}


def fillet(radius, along):
    """How far a rounded edge is behind the flat it begins at, behind so much of its length."""
    return radius - math.sqrt(max(radius ** 2 - max(along, 0.0) ** 2, 0.0))


def arc(radius, cells, most=1.3):
    """Places along a rounded edge, at equal angles up to `most`."""
    return [radius * math.sin(angle) for angle in lines(0, most, cells)]


def zone(slave, master):
    return {"GROUP_MA_ESCL": slave, "GROUP_MA_MAIT": master}


def pressed(draw, depth):
    return {"GROUP_MA": "PUNCH_BASE", "DX": 0.0, "DY": [[0.0, 0.0], [float(draw.steps), -depth]]}


def sheet(draw, length, thickness, cells):
    return block(draw.kind, lines(0, length, cells), lines(0, thickness, draw.choice((2, 3))), None, "SHEET",
                 {"top": "SHEET_TOP", "bottom": "SHEET_LOW", "left": "MIDDLE"})


def punch(draw, inner, edge, height):
    """A flat punch with a rounded edge, at rest on a sheet of that height."""
    xs = [*lines(0, inner, 4)[:-1], *(inner + along for along in arc(edge, draw.randint(5, 14)))]
    return block(draw.kind, xs, lines(0, 1, 2), lambda x, y: (x, height + (1 - y) * fillet(edge, x - inner) + y * (edge + 0.2)), "PUNCH",
                 {"bottom": "PUNCH_SKIN", "top": "PUNCH_BASE"})


def deep_drawing(draw):
    thickness, radius, edge = draw.uniform(0.3, 0.8), draw.uniform(1.5, 2.5), draw.uniform(0.5, 1.2)
    mouth, shoulder = radius + draw.uniform(1.05, 1.4) * thickness, draw.uniform(0.5, 1.0)
    flat = mouth + shoulder  # where the shoulder of the die begins
    xs = [*(flat - along for along in reversed(arc(shoulder, draw.randint(6, 14)))), *lines(flat, 5.5, 4)[1:]]
    die = block(draw.kind, xs, lines(0, 1, 2), lambda x, y: (x, -(1 - y) * 1.3 * shoulder - y * fillet(shoulder, flat - x)), "DIE",
                {"top": "DIE_SKIN", "bottom": "DIE_BASE"})
    mesh = union([sheet(draw, 5.0, thickness, draw.randint(24, 60)), punch(draw, radius - edge, edge, thickness), die])
    return draw.choice(("AXIS", "D_PLAN")), mesh, [zone("SHEET_TOP", "PUNCH_SKIN"), zone("SHEET_LOW", "DIE_SKIN")], [pressed(draw, draw.uniform(0.5, 1.8))]


def bending(draw):
    thickness, edge, roller, at = draw.uniform(0.2, 0.5), draw.uniform(0.3, 1.0), draw.uniform(0.3, 0.8), draw.uniform(1.5, 3.0)

    def place(x, y):
        return x, -(1 - y) * (roller + 0.2) - y * fillet(roller, abs(x - at))

    side = arc(roller, draw.randint(5, 10))
    die = block(draw.kind, [*(at - along for along in reversed(side[1:])), *(at + along for along in side)], lines(0, 1, 2), place, "DIE",
                {"top": "DIE_SKIN", "bottom": "DIE_BASE"})
    mesh = union([sheet(draw, 5.0, thickness, draw.randint(24, 60)), punch(draw, 0.2, edge, thickness), die])
    return "D_PLAN", mesh, [zone("SHEET_TOP", "PUNCH_SKIN"), zone("SHEET_LOW", "DIE_SKIN")], [pressed(draw, draw.uniform(0.3, 1.2))]


def riveting(draw):
    height, gap, hollow = draw.uniform(1.0, 2.2), draw.uniform(0.02, 0.1), draw.choice((0.0, draw.uniform(0.1, 0.6)))

    def under(x, y):
        return x, height + hollow / 2.2 ** 2 * (1 - (1 - y) * x * x) + 0.8 * y

    shank = block(draw.kind, lines(0, 1, draw.randint(5, 10)), lines(-1, height, draw.randint(10, 20)), None, "SHEET",
                  {"top": "SHEET_TOP", "right": "SHEET_SIDE", "bottom": "FOOT", "left": "MIDDLE"})
    plate = block(draw.kind, lines(1 + gap, 3, draw.randint(5, 10)), lines(-1, 0, 4), None, "DIE", {"top": "DIE_SKIN", "left": "DIE_SKIN", "bottom": "DIE_BASE"})
    snap = block(draw.kind, lines(0, 2.2, draw.randint(10, 24)), lines(0, 1, 2), under, "PUNCH", {"bottom": "PUNCH_SKIN", "top": "PUNCH_BASE"})
    return ("AXIS", union([shank, plate, snap]), [zone("SHEET_TOP", "PUNCH_SKIN"), zone("SHEET_SIDE", "DIE_SKIN")],
            [pressed(draw, draw.uniform(0.2, 0.5) * height), {"GROUP_MA": "FOOT", "DY": 0.0}])


SHAPES = (deep_drawing, bending, riveting)


def study(number):
    """The study of this number."""
    draw = random.Random(f"forming {number}")
    draw.kind, draw.steps = draw.choice(("QUAD4", "QUAD8", "TRIA6")), draw.choice((5, 10, 20))
    shape = draw.choice(SHAPES)
    model, mesh, zones, moves = shape(draw)
    flows = draw.random() < 0.85
    tools = {body: elastic(draw.choice((2e5, 2e6))) for body in ("PUNCH", "DIE")}
    strain = draw.choice(("GDEF_LOG", "GDEF_LOG", "SIMO_MIEHE", "PETIT_REAC")) if flows else "GREEN_LAGRANGE"
    return Study(name=named(f"{number} {shape.__name__}", model, draw.kind, strain), mesh=mesh, model=model, zones=zones,
                 materials={**tools, "SHEET": plastic(2e5, draw.uniform(100, 600), draw.uniform(200, 5000)) if flows else elastic(2000.0)},
                 moves=[*moves, {"GROUP_MA": "DIE_BASE", "DX": 0.0, "DY": 0.0}, SYMMETRY],
                 steps=draw.steps, strain=strain, cut=draw.random() < 0.5, most=draw.choice((10, 10, 30)))
