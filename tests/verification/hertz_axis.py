"""Hertz' sphere on a block in axisymmetry: the template `hertz`, whose mesh script is beside it, and the pressure at the nodes of the skin."""

import math

HERTZ_RADIUS = 50.0
YOUNG, POISSON = 210000.0, 0.3

#: what goes before FIN() of the template: nodes of the skin as a table, and their sums
ASK = """
NODES = POST_RELEVE_T(ACTION=_F(OPERATION="EXTRACTION", INTITULE="skin", RESULTAT=RESULT, NOM_CHAM="CONT_NOEU", INST=1.0, GROUP_MA="SKIN",
                                NOM_CMP=("PRES", "JEU", "VX", "VY")))
SUM = POST_RELEVE_T(ACTION=_F(OPERATION="EXTRACTION", INTITULE="sum", RESULTAT=RESULT, NOM_CHAM="CONT_NOEU", INST=1.0, GROUP_MA="SKIN",
                              RESULTANTE=("RNX", "RNY")))
ROWS = sorted(zip(*(NODES.EXTR_TABLE()[name] for name in ("COOR_X", "PRES", "JEU", "VY"))))
print("SKIN", repr((force, 2.0 * pi * SUM["RNY", 1], ROWS)))
FIN()
"""


class Contact:
    """What the study found, beside Hertz for the force at the nodes of the skin."""

    def __init__(self, reaction, force, rows):
        self.reaction, self.force = reaction, force
        self.rows = rows  # (radius, PRES, JEU, VY) of each node
        stiffness = YOUNG / (2 * (1 - POISSON**2))
        self.radius = (3 * force * HERTZ_RADIUS / (4 * stiffness)) ** (1 / 3)
        self.largest = 3 * force / (2 * math.pi * self.radius**2)

    def hertz(self, r):
        return -self.largest * math.sqrt(max(0.0, 1 - (r / self.radius) ** 2))

    def worst_inside(self, share):
        """Largest difference from Hertz up to a share of the radius of contact, over the largest pressure."""
        return max(abs(pressure - self.hertz(r)) for r, pressure, *_ in self.rows if r <= share * self.radius) / self.largest


def section(runner):
    """Of the verification book."""
    found = run(runner)
    shown = [min(found.rows, key=lambda row: abs(row[0] - share * found.radius)) for share in (0, 0.25, 0.5, 0.75, 0.9, 1.1)]
    rows = "\n".join(f"| {r:.3f} | {abs(pressure):.1f} | {abs(found.hertz(r)):.1f} | "
                     f"{(found.hertz(r) - pressure) / found.largest + 0.0:+.2%} | {gap if gap > 1e-12 else 0:.1e} |"
                     for r, pressure, gap, _ in shown)
    return f"""## Hertz in axisymmetry

The template `hertz` (`lacon new --template hertz`; its mesh is made by `mesh.py` beside it): a sphere of radius {HERTZ_RADIUS:g} on a block, both of steel, QUAD8; the
slave is the sphere. The table shows `CONT_NOEU` at nodes of the skin, averages over the patches around each. Hertz for the force at these nodes, {found.force:.1f} N
(the reaction at the top is the same to {abs(found.force / found.reaction - 1):.0e}): radius of contact {found.radius:.4f}, largest pressure {found.largest:.1f}.

| radius | PRES found | Hertz | difference, of the largest | JEU |
|---|---|---|---|---|
{rows}

Up to 0.8 of the radius of contact no node differs by more than {found.worst_inside(0.8):.2%}.
"""


def run(runner):
    """@param runner a StudyTest  @return a Contact"""
    made = runner.run_tool("new", "--template", "hertz")
    assert made.returncode == 0, made.stderr
    study = runner.folder / "hertz" / "hertz.comm"
    text = study.read_text(encoding="utf-8")
    assert text.rstrip().endswith("FIN()")
    study.write_text(text.rstrip().removesuffix("FIN()") + ASK, encoding="utf-8")
    done = runner.run_lacon(study)
    runner.assertEqual(done.status, 0, done.stdout[-3000:] + done.stderr[-3000:])
    line = next(line for line in done.stdout.splitlines() if line.startswith("SKIN "))
    return Contact(*eval(line[5:]))
