"""Studies that nobody has chosen: bodies, meshes, materials, motions and keywords of each are drawn from its number.

    unseen.py FIRST [COUNT] [--forming] [--json FILE] [--keep FOLDER]

Runs the studies FIRST, FIRST + 1, ...; where one stops or takes long, its inputs and outputs are kept in FOLDER/NUMBER. What stops is
not always a defect: a deep tip in a coarse soft body has no solution. Compare two versions by their files.
"""

import argparse
import json
import math
import pathlib
import random
import shutil
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from run import LACON, run  # noqa: E402, I001 (it says where meshes.py is)
import forming  # noqa: E402
from bodies import arch, lines, polygon, round_tool, round_tool_in_space, slab, slab_in_space, turned  # noqa: E402
from meshes import block, union  # noqa: E402
from studies import ORDERS, SIDES, STRAINS, Study, elastic, held, named, plastic, slave, zone  # noqa: E402

LONG = 8  # iterations a step
BODIES = ("TOOL", "SLAB")


class Draw(random.Random):
    """What is drawn for one study; `kinds` (of cells), `strains` and `lengths` (of steps) are what it is drawn from."""

    kinds, kinds_of_space, strains, lengths = ORDERS, ("HEXA8", "HEXA20", "TETRA10"), STRAINS, (6, 24)

    def __init__(self, number):
        super().__init__(number)
        self.kind, self.strain, self.side, self.steps = self.choice(self.kinds), self.choice(self.strains), self.choice(SIDES), self.randint(*self.lengths)
        self.course = self.choice(("on", "on", "lift", "return"))

    def cells(self, fewest, most):
        return self.randint(fewest, most), self.randint(3, 8)

    def law(self):
        return elastic(1e3 * 10 ** self.uniform(-1.5, 2.5), self.choice([0.2, 0.3, 0.3, 0.4, 0.45]))

    def flowing_law(self):
        young = 2e5 * 10 ** self.uniform(-0.5, 0.5)
        return plastic(young, young * self.uniform(1e-3, 4e-3), young * self.uniform(0.005, 0.1))

    def motion(self, depth, slide):
        """Down in the first third of the steps, then along; on, then up, or back to where it came from. @return points of x and of y"""
        third = max(2, self.steps // 3)
        ends = {"on": ([(self.steps, slide)], [(self.steps, -depth)]),
                "lift": ([(2 * third, slide), (self.steps, slide)], [(2 * third, -depth), (self.steps, 0.02)]),
                "return": ([((third + self.steps) // 2, slide), (self.steps, 0)], [(self.steps, -depth)])}
        x, y = ends[self.course]
        return [(0, 0), (third, 0), *x], [(0, 0), (third, -depth), *y]


def tool(x, y):
    """The motion of the tool's base."""
    return {"GROUP_MA": "TOOL_BASE", "DX": [list(p) for p in x], "DY": [list(p) for p in y]}


# ------------------------------------------------------------------------------------------------- bodies: (mesh, motions of the tool)


def round_body(draw):
    radius = draw.uniform(0.5, 1.5)
    mesh = union([round_tool(draw.kind, "TOOL", radius, (-0.5, radius), draw.cells(8, 36), draw.uniform(50, 80)),
                  slab(draw.kind, "SLAB", (-3, 3), (-2, 0), (draw.randint(15, 60), draw.randint(5, 12)))])
    return mesh, [tool(*draw.motion(radius * draw.uniform(0.02, 0.25), draw.uniform(0.2, 1.5)))]


def tilted_block(draw):
    body = turned(block(draw.kind, lines(0, 1, draw.randint(3, 9)), lines(0, 1, 6), None, "TOOL",
                        {"bottom": "TOOL_SKIN", "left": "TOOL_SKIN", "right": "TOOL_SKIN", "top": "TOOL_BASE"}), draw.uniform(-40, 40))
    body.points = body.points - [0, body.points[:, 1].min()]
    return (union([body, slab(draw.kind, "SLAB", (-2, 3), (-1, 0), draw.cells(12, 40))]),
            [tool(*draw.motion(draw.uniform(0.01, 0.12), draw.uniform(0.2, 1)))])


def tip(draw):
    slope = draw.uniform(0.3, 1.2)
    mesh = union([slab(draw.kind, "TOOL", (-1, 1), (0, 2), (draw.randint(6, 20), 6), top=lambda x: slope * abs(x), skin="bottom"),
                  slab(draw.kind, "SLAB", (-2, 2), (-2, 0), (draw.randint(14, 40), draw.randint(5, 12)))])
    return mesh, [tool(*draw.motion(draw.uniform(0.02, 0.2), draw.uniform(0, 0.5)))]


def blocks(draw):
    widths = [draw.uniform(0.4, 1.5) for _ in BODIES]
    mesh = union([slab(draw.kind, "TOOL", (-widths[0], widths[0]), (0, 1), draw.cells(4, 16), skin="bottom"),
                  slab(draw.kind, "SLAB", (-widths[1], widths[1]), (-1, 0), draw.cells(4, 16))])
    return mesh, [tool(*draw.motion(draw.uniform(0.02, 0.2), draw.uniform(0, 0.6)))]


def waves(draw):
    number, height, shift = draw.uniform(2, 6), draw.uniform(0.02, 0.12), draw.uniform(0, 1)
    mesh = union([slab(draw.kind, "TOOL", (-1, 1), (0, 1.2), (draw.randint(10, 30), 4), skin="bottom",
                       top=lambda x: 2 * height + 0.001 - height * math.cos(number * x)),
                  slab(draw.kind, "SLAB", (-2.5, 2.5), (-1, 0), (draw.randint(24, 60), 5), top=lambda x: height * math.cos(number * x + shift))])
    return mesh, [tool(*draw.motion(draw.uniform(0.02, 0.1) + 1.2 * height, draw.uniform(0.1, 1)))]


def wheel(draw):
    sides = draw.randint(7, 18)
    apothem = math.cos(math.pi / sides)
    turn, press = f"{draw.uniform(0.02, 0.09)!r} * max(INST - 3.0, 0.0)", draw.uniform(0.01, 0.06)
    mesh = union([polygon(draw.kind, "TOOL", sides, (0, apothem), (draw.randint(2, 4), 4)), slab(draw.kind, "SLAB", (-1, 4), (-1, 0), (draw.randint(20, 40), 6))])
    draw.strain, draw.steps = "GREEN_LAGRANGE", max(draw.steps, draw.lengths[1] // 2)
    return mesh, [{"GROUP_MA": "TOOL_BASE", "DX": f"X * (cos({turn}) - 1) + (Y - {apothem!r}) * sin({turn}) + {apothem!r} * {turn}",
                   "DY": f"-X * sin({turn}) + (Y - {apothem!r}) * (cos({turn}) - 1) - {press} * min(INST, 3.0) / 3.0"}]


def bridge(draw):
    mesh = union([arch(draw.kind, "SLAB", (draw.uniform(0.6, 0.9), 1.0), (draw.randint(16, 40), draw.randint(2, 4))),
                  slab(draw.kind, "TOOL", (-1.2, 1.2), (1, 1.3), (draw.randint(9, 37), 3), skin="bottom")])
    return mesh, [tool(*draw.motion(draw.uniform(0.05, 0.4), draw.uniform(0, 0.3)))]


def beams(draw):
    height, at = draw.uniform(0.1, 0.3), draw.uniform(1, 3.5)
    upper = block(draw.kind, lines(0, 4, draw.randint(10, 40)), lines(height, 2 * height, 2), None, "TOOL",
                  {"bottom": "TOOL_SKIN", "left": "TOOL_BASE", "right": "TOOL_SKIN"})
    lower = block(draw.kind, lines(at, at + 4, draw.randint(10, 40)), lines(0.0, height, 2), None, "SLAB",
                  {"top": "SLAB_SKIN", "right": "SLAB_BASE", "left": "SLAB_SKIN"})
    return union([upper, lower]), [tool([(0, 0), (draw.steps, 0)], [(0, 0), (draw.steps, -draw.uniform(0.2, 1.2))])]


def body_in_space(draw):
    draw.kind, draw.steps = draw.choice(draw.kinds_of_space), min(draw.steps, 10)
    n = draw.randint(3, 6) if draw.kind == "HEXA8" else draw.randint(2, 4)
    upper = round_tool_in_space(draw.kind, "TOOL", draw.uniform(0.7, 1.2), (-0.3, draw.uniform(-0.2, 0.2), 0), (n, n, 2), draw.random() < 0.6)
    upper.points = upper.points - [0, 0, upper.points[:, 2].min()]
    mesh = union([upper, slab_in_space(draw.kind, "SLAB", (-1.3, 1.4), (-1.2, 1.2), (-1, 0), (draw.randint(4, 9), draw.randint(4, 8), 3))])
    x, down = draw.motion(draw.uniform(0.03, 0.15), draw.uniform(0.1, 0.8))
    aside = draw.uniform(-0.3, 0.3)
    moves = {"DX": x, "DY": [(instant, aside * by) for instant, by in x], "DZ": down}
    return mesh, [{"GROUP_MA": "TOOL_BASE", **{name: [list(p) for p in points] for name, points in moves.items()}}]


def body_of_revolution(draw):
    radius = draw.uniform(0.8, 2)
    low = (lambda x, y: (x, y + (1 - y) * (radius - math.sqrt(radius * radius - (0.7 * x) ** 2)))) if draw.random() < 0.6 else None
    mesh = union([block(draw.kind, lines(0, 0.8, draw.randint(6, 20)), lines(0, 1, 6), low, "TOOL", {"bottom": "TOOL_SKIN", "top": "TOOL_BASE", "left": "AXIS"}),
                  block(draw.kind, lines(0, draw.uniform(0.6, 2), draw.randint(6, 30)), lines(-1, 0, 8), None, "SLAB",
                        {"top": "SLAB_SKIN", "bottom": "SLAB_BASE", "left": "AXIS"})])
    down = [(0, 0), (draw.steps // 2, -draw.uniform(0.02, 0.15)), (draw.steps, 0.02)]
    return mesh, [tool([(0, 0), (draw.steps, 0)], down if draw.course == "lift" else [down[0], (draw.steps, down[1][1])]), {"GROUP_MA": "AXIS", "DX": 0.0}]


SHAPES = {"round": round_body, "tilted": tilted_block, "tip": tip, "blocks": blocks, "waves": waves, "wheel": wheel, "bridge": bridge, "beams": beams,
          "space": body_in_space, "axis": body_of_revolution}
FLOWING = ("round", "blocks", "axis", "waves")  # where the slab may be plastic
OFTEN = ("space", "round")


def study(number, kind_of_draw=Draw):
    """The study of this number."""
    draw = kind_of_draw(number)
    shape = draw.choice([*SHAPES, *OFTEN])
    mesh, moves = SHAPES[shape](draw)
    flows = shape in FLOWING and draw.random() < 0.3
    if flows:
        draw.strain = draw.choice(("PETIT", "PETIT_REAC", "GDEF_LOG", "SIMO_MIEHE"))
    model = {"space": "3D", "axis": "AXIS"}.get(shape, "D_PLAN")
    base = {**held("SLAB"), "DZ": 0.0} if model == "3D" else held("SLAB")
    return Study(name=named(f"{number} {shape}", draw.kind, draw.strain, "plastic" if flows else "", draw.course, slave(BODIES, draw.side)), mesh=mesh, model=model,
                 materials={"TOOL": draw.law(), "SLAB": draw.flowing_law() if flows else draw.law()}, zones=[zone(*BODIES, draw.side)], moves=[base, *moves],
                 steps=draw.steps, strain=draw.strain, cut=draw.random() < 0.7, most=draw.choice((15, 30, 60)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("first", type=int)
    parser.add_argument("count", type=int, nargs="?", default=1)
    parser.add_argument("--forming", action="store_true", help="studies of forming.py")
    parser.add_argument("--json", type=pathlib.Path, help="a file for the figures")
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for those that stop or take long")
    asked = parser.parse_args()
    found = {}
    for number in range(asked.first, asked.first + asked.count):
        one = (forming.study if asked.forming else study)(number)
        folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_unseen_"))
        figures = found[one.name] = run(one, LACON, folder)
        told = "" if figures["status"] == "finished" else figures["status"]
        print(f"{one.name:<70} {figures['solutions']:>5} {figures['lost']:>5} {figures['per step']:>6.1f}  {told[:90]}", flush=True)
        if asked.keep and (told or figures["per step"] > LONG):
            shutil.copytree(folder, asked.keep / str(number), dirs_exist_ok=True)
        shutil.rmtree(folder, ignore_errors=True)
        if asked.json:
            asked.json.write_text(json.dumps(found, indent=0))
    stopped = sum(figures["status"] != "finished" for figures in found.values())
    print(f"{len(found)} studies, {sum(figures['solutions'] for figures in found.values())} iterations, {stopped} stopped")


if __name__ == "__main__":
    main()
