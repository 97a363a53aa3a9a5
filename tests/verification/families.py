"""Studies like those that users of contact have, against theory: a pressed ring, a bolted flange."""

import ast
import math
import pathlib

import numpy as np

from meshes import block, union, write_med

HERE = pathlib.Path(__file__).resolve().parent
RADIUS, THICKNESS, YOUNG, CRUSH = 10.0, 0.4, 2000.0, 0.05


def ring_mesh():
    """A quarter of the ring, 48 x 2 QUAD8, and the plate that touches its crown."""
    inner, outer = RADIUS - THICKNESS / 2, RADIUS + THICKNESS / 2
    ring = block("QUAD8", np.linspace(inner, outer, 3), np.linspace(0, math.pi / 2, 49), place=lambda r, t: (r * math.cos(t), r * math.sin(t)), name="RING",
                 sides={"right": "OUTSIDE", "bottom": "ACROSS", "top": "ALONG"})
    plate = block("QUAD8", np.linspace(0, 4, 6), outer + np.linspace(0, 1, 2), name="PLATE", sides={"bottom": "FACE", "top": "ABOVE"})
    mesh = union([ring, plate])
    for name, (x, y) in (("SIDE", (RADIUS, 0)), ("CROWN", (0, RADIUS))):
        mesh.node_groups[name] = mesh.nodes_where(lambda a, b, x=x, y=y: math.hypot(a - x, b - y) < 1e-9)
    return mesh


class Ring:
    """Force on the plate, how much wider and how much lower the ring's middle line is, beside the theory of thin rings."""

    def __init__(self, force, wider, lower):
        self.force, self.wider, self.lower = force, wider, lower
        bending = force * RADIUS**3 / (YOUNG * THICKNESS**3 / 12)
        self.lower_thin, self.wider_thin = bending * (math.pi / 4 - 2 / math.pi), bending * (2 / math.pi - 0.5)


def pressed_ring(runner):
    """@param runner a StudyTest"""
    write_med(runner.folder / "ring.med", ring_mesh())
    run = runner.run_study(HERE / "pressed_ring.comm", "--unit", f"20={runner.folder / 'ring.med'}", RING_THICKNESS=str(THICKNESS), RING_CRUSH=str(CRUSH),
                           RING_YOUNG=str(YOUNG))
    runner.assertEqual(run.status, 0, run.stdout[-2000:] + run.stderr[-2000:])
    return Ring(*ast.literal_eval(next(line for line in run.stdout.splitlines() if line.startswith("RING ")).removeprefix("RING ")))


def flange(runner):
    """The template `bolted_flange`. @return force in the bolt, with the load, between the plates; the load"""
    made = runner.run_tool("new", "--template", "bolted_flange")
    runner.assertEqual(made.returncode, 0, made.stderr)
    comm = runner.folder / "bolted_flange" / "bolted_flange.comm"
    ask = 'print("FLANGE", repr((tight, loaded, clamp, LOAD)))\nFIN()\n'
    comm.write_text(comm.read_text(encoding="utf-8").replace("FIN()\n", ask), encoding="utf-8")
    run = runner.run_lacon(comm)
    runner.assertEqual(run.status, 0, run.stdout[-2000:] + run.stderr[-2000:])
    return ast.literal_eval(next(line for line in run.stdout.splitlines() if line.startswith("FLANGE ")).removeprefix("FLANGE "))


def section(runner):
    """Of the verification book."""
    ring = pressed_ring(runner)
    tight, loaded, clamp, load = flange(runner)
    return f"""## A pressed ring

A ring, radius of its middle line {RADIUS:g}, {THICKNESS:g} thick, pressed between two stiff plates by {CRUSH:g} (a quarter: D_PLAN, 48 x 2 QUAD8; E = {YOUNG:g}, nu = 0).
Theory of thin rings (Timoshenko): under the force F the middle line is lower by F R^3 / (E I) (pi / 4 - 2 / pi), wider by F R^3 / (E I) (2 / pi - 1 / 2), but for
terms (t / R)^2 = {(THICKNESS / RADIUS) ** 2:.1e}.

| F = {ring.force:.6f} | found | theory | difference |
| --- | --- | --- | --- |
| lower by | {ring.lower:.6f} | {ring.lower_thin:.6f} | {ring.lower / ring.lower_thin - 1:+.2%} |
| wider by | {ring.wider:.6f} | {ring.wider_thin:.6f} | {ring.wider / ring.wider_thin - 1:+.2%} |

## A bolted flange

The template `bolted_flange`: the bolt is tightened, then the flange is pulled with {load:.0f} N; two contact zones. Theory: the bolt alone holds the plates together, so it
carries the remaining clamping force plus the load, as long as the joint is tight.

| | N |
| --- | --- |
| bolt, tightened | {tight:.3f} |
| bolt, with the load | {loaded:.3f} |
| between the plates, with the load | {clamp:.3f} |
| bolt less clamping force less load, over the first | {(loaded - clamp - load) / tight:.0e} |

Of the load the bolt feels {(loaded - tight) / load:.1%}.
"""
