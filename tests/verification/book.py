"""Runs the verification studies and writes docs/verification.md: book.py [FOLDER of a build; build/release without].

Every figure comes from the run that it makes.
"""

import contextlib
import io
import math
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT / "build/release"
os.environ.setdefault("LACON_SOURCE_DIR", str(ROOT))
os.environ.setdefault("LACON_BIN", str(BUILD / "bin"))
os.environ.setdefault("LACON_SHARED_CASES", str(ROOT.parent / "shared/cases"))
os.environ.setdefault("LACON_SHARED_BENCH", str(ROOT.parent / "shared/bench"))
sys.path[:0] = [str(ROOT / "tests/studies"), str(ROOT / "tests/studies/robustness"), str(ROOT / "commands/studies/roller_bearing")]

from study_test import PEER_MESHES, StudyTest  # noqa: E402, I001 (it says where meshes.py is)
import chapter  # noqa: E402
import convergence  # noqa: E402
import families  # noqa: E402
import hertz  # noqa: E402
import hertz_axis  # noqa: E402
import orders  # noqa: E402
import patch  # noqa: E402
import patch_space  # noqa: E402
import peer_checks  # noqa: E402
from test_patch import COMM, two_materials  # noqa: E402

PRESSURE = 25.0
LOWER = (1000.0, 0.4)


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def patch_section(runner):
    run = patch.run_patches(runner, COMM, patch.PAIRS, pressure=PRESSURE)
    runner.assert_all_ok(run, patch.CHECKS_A_PAIR * len(patch.PAIRS))
    found = dict(zip(patch.PAIRS, patch.by_pair(run, len(patch.PAIRS))))

    def pressure_error(pair):
        return max(patch.worst(found[pair][c], -PRESSURE) for c in ("LAGS_C", "PRES")) / PRESSURE

    rows = [[slave] + [f"{pressure_error((slave, master)):.1e}" for master in patch.KINDS] for slave in patch.KINDS]
    worst = {c: max(patch.worst(f[c], value) for f in found.values()) for c, value in (("SIYY", -PRESSURE), ("JEU", 0), ("COEFSURF", 1))}
    return f"""## Patch test

Two blocks, 50 wide and 50 high, in plane strain; 7 columns of cells on 5, with no common grid lines; E = 2000, nu = 0.3; pressure 25 on
top, free sideways, TYPE_JACOBIEN='INITIAL', RESI_GLOB_RELA 1e-12. Theory: LAGS_C = PRES = SIYY = -25, JEU = 0, COEFSURF = 1.

Largest error of LAGS_C and PRES over the skin, relative to the pressure; slave body (rows) on master body (columns):

{table(["", *patch.KINDS], rows)}

Over all 25 pairs: SIYY within {worst["SIYY"] / PRESSURE:.1e} of the pressure (required: 1e-10), the gap within
{worst["JEU"] / patch.HEIGHT:.1e} of the height (1e-10), COEFSURF within {worst["COEFSURF"]:.1e} (1e-12).
"""


def current_section(runner):
    pairs = [(kind, kind) for kind in patch.KINDS]
    run = patch.run_patches(runner, COMM, pairs, pressure=PRESSURE, jacobian="ACTUALISE")
    runner.assert_all_ok(run, patch.CHECKS_A_PAIR * len(pairs))
    stretch = 1 + patch.strain(PRESSURE, patch.YOUNG, patch.POISSON)[0]
    expected = -PRESSURE / stretch
    rows = [[slave, f"{found['LAGS_C'][0]:.12f}", f"{patch.worst(found['LAGS_C'], expected) / PRESSURE:.1e}"]
            for (slave, _), found in zip(pairs, patch.by_pair(run, len(pairs)))]
    return f"""## On the current length

The same with TYPE_JACOBIEN='ACTUALISE': the pressure belongs to the stretched skin, -p A0 / A with A / A0 = 1 + nu (1 + nu) p / E =
{stretch:.6f} (plane strain, free sideways), so {expected:.12f}.

{table(["cells", "LAGS_C", "error / p"], rows)}
"""


def space_section(runner):
    """Every pair of facets in space, on plain meshes and on distorted ones."""
    found = {shaking: patch_space.run(runner, patch_space.matrix(shaking=shaking)) for shaking in (False, True)}
    tables = {}
    for what in ("pressure", "stress"):
        cells = [f"{getattr(a, what):.0e}, {getattr(b, what):.0e}" for a, b in zip(found[False], found[True])]
        n = len(patch_space.MASTERS)
        tables[what] = table(["slave body", *patch_space.MASTERS], [[slave, *cells[n * k:n * k + n]] for k, slave in enumerate(patch_space.SLAVES)])
    both = found[False] + found[True]
    return f"""## Patch test in space

Two unit blocks stacked along the direction (0.48, -0.6, 0.64), meshes that do not match, one material (E = {patch_space.YOUNG:g}, nu =
{patch_space.POISSON}), pressure {patch_space.PRESSURE:g} on both ends, each block held at single nodes as a statically determinate body; RESI_GLOB_RELA 1e-12.
Theory: LAGS_C = PRES = -p, sigma = -p n n at every node, u linear. First figure: plain grids. Second figure: inner nodes moved at
random, in the contact plane by up to {patch_space.SHAKE[0]} of a grid step along each axis (quadrangles of scaled Jacobian down to 0.4), elsewhere by up to {patch_space.SHAKE[1]}.
Required: 1e-10 where facets are affine, 1e-8 elsewhere; the long tests require the same with coordinates scaled by 1e-3 and 1e3, and with
TYPE_JACOBIEN='ACTUALISE' (-p A0 / A).

Largest error of LAGS_C and PRES, relative to p; slave body (rows) on the facets of the master (columns):

{tables["pressure"]}

Largest error of the nodal stress n . sigma . n, relative to p:

{tables["stress"]}

Over all {len(both)} studies: displacements within {max(f.displacement for f in both):.0e} of the largest one, the gap within {max(f.gap for f in both):.0e} of the
height, COEFSURF within {max(f.cover for f in both):.0e}; at most {max(f.iterations for f in both)} iteration(s) after the first.
"""


def degree_section(runner):
    run = subprocess.run([BUILD / "tests/degrees"], capture_output=True, text=True, check=True)
    return f"""## Degree of quadrature

Shape functions of a trapezoid or of a distorted quadrangle are rational in the plane of the facet, or worse: points on exact polygons leave
an error that falls with the degree of the rule. E1 to E4 of the cut of a hexahedron's face on distorted triangles, and distorted quadrangles on
distorted quadrangles (in brackets the smallest scaled Jacobian), all flat. Last row: the degree that pairing chooses for each couple
(`integration_degree()` in `pairing/space.cpp`; 4 where both facets are affine).

Largest error of a nodal force of a uniform pressure, slave or master, relative to the largest one:

{run.stdout}"""


def materials_section(runner):
    pairs = [(kind, kind) for kind in patch.KINDS]
    rows = []
    for (slave, _), figures in zip(pairs, two_materials(runner, COMM, pairs, LOWER)):
        order = math.log(figures[0].error / figures[-1].error) / math.log(figures[0].strain / figures[-1].strain)
        rows.append([slave, *(f"{f.error:.2e} ({f.error / f.strain:.2f})" for f in figures), f"{order:.3f}"])
    head = [f"p = {p:g}" for p in (25, 5, 1)]
    return f"""## Two materials

The lower block has E = {LOWER[0]:g}, nu = {LOWER[1]:g}: it stretches sideways more than the upper one, so that the two skins end at different
places. The pressure is no longer uniform: its error is of the order of the difference between the strains.

Largest error of PRES relative to p, and in brackets its ratio to the difference of strains:

{table(["cells", *head, "order"], rows)}
"""


def convergence_section(runner):
    cases = {**convergence.CASES, **convergence.SPACE_CASES}
    rows = []
    for name, found in convergence.errors(runner, cases).items():
        counts = cases[name][1]
        rows.append([name, ", ".join(map(str, counts)), *(f"{e.mean:.1e} ({e.largest:.1e})" for e in found),
                     ", ".join(f"{order:.2f}" for order in convergence.orders([e.mean for e in found], counts))])
    mean, wave = convergence.ring_pressure()
    return f"""## Curved contact: order of the pressure

Three meshes that do not match, n cells along the slave skin (in space: along each side of a third of it), LISSAGE='OUI'. Error of PRES: root
of the mean square over the skin, in brackets the largest, relative to the largest pressure. Theory: the error of linear cells falls at least as h,
that of quadratic ones at least as h^1.5.

Spheres (ssnp173): radii {convergence.INNER:g}, {convergence.MIDDLE:g}, {convergence.OUTER:g}, E = 2000, nu = 0.3, inner pressure {convergence.PRESSURE:g}; Lame's solution
{convergence.SPHERE:.6f} everywhere. Rings: radii 0.2, 0.6, 1, plane strain, nu = {convergence.RINGS.poisson}, E = 1e9 (linear cells), 1e11 (quadratic cells: at
1e9 the finite displacements show, p / E = 1e-2), outer pressure 1e7 + 1e5 cos 2a; Lame's and Michell's solutions with a contact without friction,
{mean:.3f} {wave:+.3f} cos 2a. Chords of linear cells overlap or gape by h^2 / 8 R, which at E = 2000 is a pressure of its own.

{table(["study", "n", "coarse", "middle", "fine", "order of the mean"], rows)}
"""


def peer_section(runner):
    if not PEER_MESHES.is_dir():
        return "## The peer's cases\n\nNot run: their meshes were not there.\n"
    rows = []
    for name in ("zzzz383a", "zzzz383c", "zzzz383d", "zzzz383e", "ssnp170a", "ssnp170k", "ssnp170m", "ssnp170p", "ssnp170r", "ssnp170w", "ssnp170z",
                 "ssnp173a", "ssnv104k", "ssnv104n", "ssnp165c", "ssnp165e"):
        comms, meshes = peer_checks.files(name)
        units = {**{unit: PEER_MESHES / mesh for unit, mesh in meshes.items()}, **{80: runner.folder / "out.med"}}
        run = runner.run_lacon(*(ROOT / "tests/studies" / comm for comm in comms), "--fresh", "--base", runner.folder / f"{name}.base",
                               *(word for unit, path in units.items() for word in ("--unit", f"{unit}={path}")), CASE=name)
        count = {status: sum(c["status"] == status for c in run.checks) for status in ("OK", "NOOK", "DIFF")}
        worst = max(c["vale_calc"]["error"] for c in run.checks)
        own, peers = [], []
        for row, check in zip(peer_checks.rows(name), run.checks):
            theory = float(row["vale_refe"] or 0)
            if theory:  # a reference that is zero is judged by its tolerance
                own.append(abs(check["value"] - theory) / abs(theory))
                peers.append(abs(float(row["vale_calc"]) - theory) / abs(theory))
        rows.append([name, len(run.checks), *count.values(), *(f"{max(found):.1e}" if found else "-" for found in (own, peers)), f"{worst:.1e}"])
    return f"""## The peer's cases

Every check at the peer's own tolerances. OK: reference and VALE_CALC are met; DIFF: the reference is met and the peer's digits are not; NOOK: they are not,
and there is no reference. In ssnp170r, w and z these carry the error of the peer's rule for PYRAM13 (-25.06 to -24.92); here the pressure is -25 to 1e-9. The half ring (ssnp165) has no
reference: its displacements and pressures are within 6 % of the largest of their kind, 12 and 120, and within 1 % with VARIATION_JEU='FIGEE'; with the residual at 1e-6 they
are the same. What remains is the contact forces alone: here they are the derivative of the gap (METHOD.md 5.4 c), on facets that slide far and are not parallel. The peer integrates the master's side on the
master's facets with the master's normals, so that its forces on slave and master do not balance. With the peer's matrix put in as an experiment (2D, linear edges), all 30 values
of ssnp165c came out as the peer's to 4e-12 of their size, and the forces on slave and master differed by up to 1.0 % of the load. Distances from theory
are relative to it. ssnp150 and ssnv219: the next section.

{table(["case", "checks", "OK", "NOOK", "DIFF", "from theory", "the peer from theory", "largest error against VALE_CALC"], rows)}
"""


def orders_section(runner):
    if not PEER_MESHES.is_dir():
        return "## Manufactured solutions\n\nNot run: the peer's meshes were not there.\n"
    results = {case: orders.run(runner, case, ROOT / "tests/studies") for case in orders.CASES}
    orders.plot(results, ROOT / "docs/orders_of_convergence.png")
    return orders_text(results)


def orders_text(results):
    return f"""## Manufactured solutions

A St-Venant-Kirchhoff body with large displacements on a curved rigid skin (the peer's ssnp150 in the plane, ssnv219 in space; loads derived in
`tests/studies/manufactured.py`), each mesh twice as fine as the one before, with one mesh more than the peer. Theory: displacement 2 (linear cells), 2.5 to 3
(quadratic); pressure at least 0.5 and 1. The peer's windows were fitted to its own slopes: a pressure that converges faster falls outside as well, and so
does ssnv219k, whose window follows the peer's rule for PYRAM13 (with the exact rule its release of 2020 found 3.670 and 1.090).

![Errors against the width of the mesh](orders_of_convergence.png)

{table(["case", "cells", "of", "orders", "Lacon, peer's last two meshes", "peer", "accepted there", "inside"], orders.rows(results))}
"""


def hertz_meshes_section(runner):
    rows = []
    for model, found in hertz.errors(runner).items():
        for cells, (here, theory) in zip(hertz.MESHES, found):
            rows.append([hertz.MODELS[model], cells, *(f"{getattr(here, name):.4g} ({100 * (getattr(here, name) / getattr(theory, name) - 1):+.2f} %)"
                                                       for name in ("pressure", "radius", "approach"))])
    return f"""## Contacts of Hertz on three meshes

A paraboloid on a half space (AXIS) and a parabolic cylinder on one (D_PLAN), radius {hertz.RADIUS:g}, both of E = {hertz.YOUNG:g}, nu = {hertz.POISSON}; QUAD8, bodies
{hertz.EXTENT / hertz.HALF_WIDTH:g} times as large as the contact, three meshes with as many cells along its radius as the second column says. Radius: where the line through the squares of
the pressures of patches over their squared distances from the axis comes to zero. Approach: of the points on the axis, one in each body,
{hertz.DEPTH / hertz.HALF_WIDTH:g} radii deep; theory: the strains below a pressure of Hertz, integrated. In brackets the distance from theory for the force that was found; what
the ends of the bodies do is 1 / {hertz.EXTENT / hertz.HALF_WIDTH:g} in the plane.

{table(["", "cells", "largest pressure", "radius or half width", "approach"], rows)}

On the peer's spheres of Hertz (ssnv104k, n) the section on its cases compares both with theory.
"""


def roller_section(runner):
    from report import Result, summary

    study = ROOT / "commands/studies/roller_bearing"
    subprocess.run([sys.executable, "-B", study / "mesh.py", runner.folder / "mesh.med"], check=True, capture_output=True)
    run = runner.run_study(study / "roller_bearing.comm", *(w for n, f in ((20, "mesh.med"), (80, "out.med"), (81, "out.vtu"))
                                                           for w in ("--unit", f"{n}={runner.folder / f}")))
    if run.status != 0:
        raise SystemExit(run.stderr)
    text = io.StringIO()
    with contextlib.redirect_stdout(text):
        summary(Result(runner.folder / "roller_bearing.base", "RESU"))
    return f"""## Line contacts of Hertz

The study of `./commands/demo`: a polymer roller between two steel rings (QUAD8 on TRIA6, QUAD4 on QUAD8). Hertz' half-width and largest
pressure are those for the computed force; the half-width is known to within a patch.

```{text.getvalue().rstrip()}
```
"""


def hertz_section(runner):
    return hertz_axis.section(runner)


def of_test(case, method, *given):
    """What a method of a test case makes, in a folder of its own."""
    test = case(method)
    test.setUp()
    try:
        return getattr(test, method)(*given)
    finally:
        test.doCleanups()


def families_section(runner):
    return families.section(runner)


def press_fit_section(_runner):
    from test_thermal import PressFit

    rows = [[f"{speed:g}", f"{found.mean():.6f}", f"{exact:.6f}", f"{abs(found / exact - 1).max():.1e}"]
            for speed, found, exact in of_test(PressFit, "figures")]
    return f"""## A press fit that is heated and turns

Two rings, r = 1 to 2 and 2 to 3, held along the axis (AXIS, QUAD8, 12 and 14 cells across); E = 2000, nu = 0.3, alpha = 1e-4, density 3. The inner one is heated by
100 degrees (AFFE_VARC), then both turn (ROTATION). Theory: Lame's pressure of the interference (1 + nu) alpha dT b less what the two rings widen apart, in plane strain.

{table(["speed", "LAGS_C", "theory", "error"], rows)}
"""


def joints_section(_runner):
    from test_joints import Bolt, PlaneStress, Sector

    rows = [[f"{round(value, 2) + 0.0:.2f}" for value in (pull, bolt, of_bolt, clamp, of_clamp)]
            for pull, bolt, clamp in of_test(Bolt, "figures") for of_bolt, of_clamp in [Bolt().theory(pull)]]
    sector, plane = (max(of_test(case, "differences")) for case in (Sector, PlaneStress))
    return f"""## A bolt that cooling tightens

A bolt, radius 6, in a sleeve 40 long, radii 7 to 14, under a nearly rigid head (AXIS, QUAD8; E = 210000, nu = 0, alpha = 1.2e-5). The shank is cooled by 50 degrees (AFFE_VARC),
then the head is pulled until the joint parts. Theory: two springs E A / L, which share the pull as long as the sleeve is compressed; then the bolt carries it alone.

{table(["pull, N", "bolt", "theory", "clamping force", "theory"], rows)}

Equivalent models: a sector of 30 degrees of two rings under a pressure 1 + 1.2 cos 6 t, held by LIAISON_OBLIQUE, has the displacements and contact pressures of the quarter
within {sector:.0e}; a pin in a hole in plane stress those of plane strain with nu' = nu / (1 + nu), E' = E (1 + 2 nu) / (1 + nu)^2 within {plane:.0e}.
"""


def snap_fit_section(_runner):
    from test_snap_fit import SnapFit

    study = SnapFit()
    rows = of_test(SnapFit, "figures")
    flank = [[f"{way:.1f}", f"{force[0]:.6f}", f"{-force[2]:.6f}", f"{force[0] / -force[2]:.6f}", f"{energy:.4f}"]
             for (way, force, *_), (_, energy) in zip([row for row in rows if row[0] > study.GAP], study.on_flank(rows))]
    taken, given = study.work(rows)
    return f"""## A hook that snaps over a ridge

In space, HEXA20: a beam 3 long, 0.2 thick, 0.6 wide, whose nose goes over a ridge of the same flanks, 0.3 to 0.55, which is ten times stiffer (E = 2000, nu = 0), in {study.STEPS} steps,
DEFI_LIST_INST as it is. Theory: without friction the force is normal to the flank; where the flanks are in full contact, force times travel is twice the bending energy of a cantilever.

{table(["way", "force to the side", "up", f"ratio ({study.FLANK:.6f})", "work over bending"], flank)}

To be lifted over the ridge the hook takes {taken:.5f}, behind it gives {given:.5f} back (trapezia of the steps). At the end nothing presses it and it is straight within {rows[-1][-1]:.0e}.
"""


def engineering_section(_runner):
    from test_engineering import Beams, ExpandedTube, RoundedPunch

    def beams(method):
        return [[f"{load:g}", str(count), f"{length:.2f}", f"{free:.2f}", f"{force:.4f}", f"{exact:.4f}"]
                for load, count, length, free, force, exact, _ in of_test(Beams, method)]

    tube = [[f"{pressure:.0f}", f"{c:.3f}", f"{least:.3f} to {largest:.3f}", f"{exact:.3f}"]
            for pressure, c, least, largest, exact in of_test(ExpandedTube, "figures")]
    punch = [[f"{depth:g}", f"{force:.1f}", f"{width:.3f}", f"{exact:.3f}", f"{middle:.1f}", f"{theory:.1f}"]
             for depth, force, width, exact, middle, theory in of_test(RoundedPunch, "figures")]
    heads = ["iterations", "free length", "theory", "force", "theory"]
    return f"""## Beams on a floor

Beams of E = 200000, nu = 0, on floors a hundred times stiffer (D_PLAN, QUAD8). Theory: thin beams, with zero moment where they meet the floor. Patches are 0.625
and 1 long. Lengths are measured to the first patch in contact.

A clamped beam, 100 long, 1 thick, 0.2 above the floor, under a pressure q: q l^4 / (72 E I) is the height; the floor bears q (100 - 2 l / 3).

{table(["q", *heads], beams("pressed_onto"))}

A heavy beam, 200 long, 2 thick, lifted at its end: q l^4 / (24 E I) is the height, q l / 2 the force.

{table(["height", *heads], beams("lifted"))}

## A tube expanded by a sleeve

An elastic sleeve, radii 8 to 10, is expanded by internal pressure inside a tube, radii 10 to 20, that yields at 200 (D_PLAN_SI, QUAD8, 30 degrees; E = 200000, nu = 0.3). R. Hill (The
Mathematical Theory of Plasticity, 1950): the pressure that the tube bears when it has yielded up to the radius c, which follows from the expansion of its outer surface.

{table(["pressure inside", "c", "pressure of contact", "Hill"], tube)}

## A flat punch with rounded edges

A stiff punch, flat to 1, then rounded with the radius 20, on a block 60 wide and high (D_PLAN, QUAD8, cells of 0.05; E = 200000, nu = 0.3). M. Ciavarella, D. A. Hills and
G. Monno (Proc. Instn Mech. Engrs C 212, 1998), for the computed force.

{table(["depth", "force", "half width", "theory", "pressure in the middle", "theory"], punch)}
"""


def large_strain_section(_runner):
    from test_large_strain import Necking, Upsetting

    from test_upsetting import BILLETS, MESHES, LongBounds

    rows = [[law, f"{stress:.1e}", f"{moved:.1e}"] for law, stress, moved in of_test(Upsetting, "figures")]
    loads, considere, strain, width, neck = of_test(Necking, "figures")
    shown = [min(neck, key=lambda row: abs(row[0] - radius)) for radius in (0.9, 0.8, 0.7, 0.6)]
    bridgman = [[f"{value:.3f}" for value in row] for row in shown]
    later, bounds = of_test(LongBounds, "at_a_tenth")
    pressed = []
    for name, (modelisation, ratio) in BILLETS.items():
        found, (lower, upper) = of_test(LongBounds, "figures", name)
        hill = f"{0.75 + ratio / 4:.3f}" if modelisation == "D_PLAN_SI" and ratio > 1 else "-"
        pressed += [[name, law, *(f"{load:.4f}" for load in found[law]), f"{lower:.3f}", f"{upper:.3f}", hill] for law in found]
    return f"""## Plasticity at large strain

A round billet, 10 wide and 10 high, upset to 5.5 by a rigid die that slides without friction, in 10 steps (AXIS, QUAD8; E = 200000, nu = 0.3, yield stress
400 + 600 p). Theory: everywhere Kirchhoff's stress 400 + 600 p over the logarithmic strain. GDEF_LOG gives it whatever the steps; SIMO_MIEHE is first-order accurate in
the step, here 6 % of strain.

{table(["DEFORMATION", "error of the stress", "of the widening"], rows)}

The round bar of Simo and Miehe (Comput. Methods Appl. Mech. Engrg. 98, 1992): 53.334 long, radius 6.413, made 0.5 % thinner in its middle, pulled by 14 (GDEF_LOG).
Theory while it is a cylinder (Considere): the load is largest, {considere:.0f}, at the strain {strain:.3f}. Found: {loads.max():.0f}, {loads.max() / considere:.4f} of it (the
thinner section has 0.99 of the area). At the end the neck has {width["neck"]:.3f} of the first radius, the end of the bar {width["end"]:.3f} (exp(-strain / 2) = {math.exp(-strain / 2):.3f}).

Stresses in the neck (P. W. Bridgman, Studies in Large Plastic Flow and Fracture, 1952): with the neck's radius a and that of its profile R, both as they are
found, the mean axial stress is (1 + 2 R / a) ln(1 + a / 2 R) times the flow stress at the strain 2 ln(a0 / a), and the largest, in the middle, 1 + ln(1 + a / 2 R)
times. He assumes uniform strain over the section; it is larger in the middle, and the computed stresses are up to 6 % above his. Published neck radii of
this bar are not compared: none was at hand with a source that could be cited.

{table(["neck over first radius", "a / R", "mean over flow stress", "Bridgman", "middle over mean", "Bridgman"], bridgman)}

## Upsetting between rough platens

Billets of the height 1 between platens that stick, without hardening (yield stress Y = 20, E = 200000, so that the limit load comes at strains of a thousandth), QUAD8 with
fewer integration points (D_PLAN_SI, AXIS_SI), {MESHES[0]} and {MESHES[1]} cells over half the height. Load: mean pressure over 2 k = 2 Y / sqrt(3) (prisms) or Y (cylinders). Bounds that are
theorems: below one stress everywhere; above the work of a flow whose v_x or v_r is the same over the height (cylinder: B. Avitzur, Metal Forming, 1968, 1 + 2 m R / (3 sqrt(3) h)
with m = 1; prism: 1 + w / (4 h)), or of four rigid wedges, (w / h + h / w) / 2. A square prism has no other load than 1. R. Hill (The Mathematical Theory of
Plasticity, 1950) has 3 / 4 + w / (4 h) for wide prisms, from Prandtl's field (1923): an approximation.

{table(["billet", "DEFORMATION", "load, coarse", "fine", "below", "above", "Hill"], pressed)}

Width over height 1 and 4, diameter over height 1 and 4. When a tenth of the wide prism's height is gone, over the platens' first width (coarse mesh): {", ".join(f"{load:.3f} ({law})" for law, load in later.items())}; below
{bounds[0]:.0f}, above h / h' + w / (4 h') = {bounds[1]:.3f}, whatever has bulged out.
"""


def indentation_section(_runner):
    from test_indentation import LAWS, TABOR, Indentation

    found = {law: of_test(Indentation, "figures", law) for law in LAWS}
    rows = [[f"{depth:.2f}", f"{radius:.3f}", *(f"{found[law][k][2]:.3f}" for law in LAWS)] for k, (depth, radius, _) in enumerate(found[LAWS[1]])]
    return f"""## Indentation

The template `indentation` of `lacon new`: a hard round punch, driven into a plastic block (AXIS, von Mises with little hardening), with three measures of strain.
D. Tabor (The Hardness of Metals, 1951): once the plastic zone has reached the surface, the mean pressure is {TABOR} times the yield stress, whatever the depth. The
radius of contact is known to within a patch, 0.1, which is 10 % of the pressure at the end.

{table(["depth", "radius of contact", *(f"mean pressure / yield stress, {law}" for law in LAWS)], rows)}
"""


def extrusion_section(_runner):
    from test_extrusion import ENTRY, EXIT, SLOPE, YIELD, Extrusion, bounds

    lower, upper = bounds()
    steady = [force for way, force in of_test(Extrusion, "forces") if way > 1.35]
    return f"""## Extrusion

A billet of the half height {ENTRY:.0f} is pushed through a smooth die that leaves {EXIT} of it, in plane strain and without friction (D_PLAN_SI, QUAD8, GDEF_LOG; yield stress {YIELD:.0f},
{SLOPE:.0f} of it more for each unit of strain). Theory: limit analysis of a rigid plastic material without hardening. The work of a pure stretch, {lower:.1f}, is less than any flow takes; that
of v_x = 1 / h, v_y = y h' / h^2, which follows the die, is {upper:.1f}, more than the flow takes (upper bound theorem). Found where the flow is steady: {min(steady):.1f} to {max(steady):.1f}.
"""


def robustness_section(runner):
    return chapter.section()


def main():
    runner = StudyTest()
    runner.setUp()
    try:
        sections = [make(runner) for make in (patch_section, current_section, space_section, degree_section, materials_section,
                                              convergence_section, peer_section, orders_section, hertz_meshes_section, roller_section,
                                              hertz_section, families_section, press_fit_section, joints_section, snap_fit_section,
                                              engineering_section, large_strain_section, indentation_section, extrusion_section, robustness_section)]
    finally:
        runner.doCleanups()
    text = "# Verification\n\nWritten by `python3 tests/verification/book.py`, which runs the studies; the same studies are tests.\n\n" + "\n".join(sections)
    (ROOT / "docs/verification.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
