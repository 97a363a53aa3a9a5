"""Loads against closed forms: manufactured solutions that the elements hold exactly, bars under their weight, functions of place and time."""

import unittest

import numpy as np

from load_study import NORMALS_2D, NORMALS_3D, POISSON, SIDES_2D, SIDES_3D, YOUNG, LoadTest, flat_block, flat_brick
from meshes import block, write_med  # noqa: I001 (load_study says where it is)
from patch import patch_mesh
from results import Result


class Quadratic:
    """u_i = x . Q_i x / 2 (times a function of time): the strain is linear in x, the force in the body constant."""

    def __init__(self, dimension, plane_stress=False):
        rng = np.random.default_rng(dimension)
        self.q = [0.01 * (a + a.T) for a in rng.uniform(-1, 1, (dimension, dimension, dimension))]
        self.lame = YOUNG * POISSON / ((1 + POISSON) * ((1 - POISSON) if plane_stress else (1 - 2 * POISSON)))
        self.shear = YOUNG / (2 * (1 + POISSON))
        self.dimension = dimension

    def displacement(self, x):
        return np.stack([np.einsum("ni,ij,nj->n", x, q, x) / 2 for q in self.q], axis=1)

    def texts(self, coefficients):
        """A linear form of X, Y, Z"""
        return " + ".join(f"({c!r}) * {name}" for c, name in zip(map(float, coefficients), "XYZ"))

    def displacement_texts(self):
        return [" + ".join(f"({float(q[i, j]) / 2!r}) * {'XYZ'[i]} * {'XYZ'[j]}" for i in range(self.dimension)
                           for j in range(self.dimension)) for q in self.q]

    def traction_texts(self, normal):
        n, q, d = np.array(normal, float), self.q, range(self.dimension)
        divergence = sum(q[k][k] for k in d)  # as a linear form
        forms = [self.lame * divergence * n[i] + self.shear * sum((q[i][j] + q[j][i]) * n[j] for j in d) for i in d]
        return [self.texts(form) for form in forms]

    def body_force(self):
        d = range(self.dimension)
        return [-float((self.lame + self.shear) * sum(self.q[k][k, i] for k in d) + self.shear * np.trace(self.q[i])) for i in d]


class Manufactured(LoadTest):
    """FORCE_INTERNE, FORCE_CONTOUR, FORCE_FACE and AFFE_CHAR_CINE_F with formulae of X, Y, Z, INST."""

    def loads(self, exact, normals, surface, time):
        """Command lines: displacements on LEFT, tractions elsewhere, forces inside, each times `time`."""
        components = range(exact.dimension)

        def terms(letter, texts):
            return ", ".join(f"{letter}{'XYZ'[i]}=formula('''({texts[i]}) * ({time})''')" for i in components)

        traction = ", ".join(f"_F(GROUP_MA='{side}', {terms('F', exact.traction_texts(n))})" for side, n in normals.items() if side != "LEFT")
        return f"""
H = AFFE_CHAR_CINE_F(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='LEFT', {terms('D', exact.displacement_texts())}))
S = AFFE_CHAR_MECA_F(MODELE=MODEL, {surface}=({traction}))
V = AFFE_CHAR_MECA_F(MODELE=MODEL, FORCE_INTERNE=_F(GROUP_MA='BODY', {terms('F', [repr(f) for f in exact.body_force()])}))
solve(_F(CHARGE=H), _F(CHARGE=S, FONC_MULT=ONE), _F(CHARGE=V))
"""

    def test_quadratic_displacements_are_exact_in_the_plane(self):
        kinds, text, meshes = ("TRIA6", "QUAD8", "QUAD9"), "", []
        for modelisation in ("D_PLAN", "C_PLAN"):
            for kind in kinds:
                text += f"model({20 + len(meshes)}, '{modelisation}')" + self.loads(
                    Quadratic(2, modelisation == "C_PLAN"), NORMALS_2D, "FORCE_CONTOUR", "INST**2")
                meshes.append(flat_block(kind))
        for k, result in enumerate(self.solved(meshes, text)):
            exact = Quadratic(2, k >= 3).displacement(result.points)
            for order, factor in ((1, 0.25), (2, 1.0)):
                self.assert_near(self.displacement(result, order, 2), factor * exact)

    def test_quadratic_displacements_are_exact_in_space(self):
        kinds, exact = ("TETRA10", "PENTA15", "HEXA20", "HEXA27"), Quadratic(3)
        meshes = [flat_brick(kind) for kind in kinds]
        text = "".join(f"model({20 + k}, '3D')" + self.loads(exact, NORMALS_3D, "FORCE_FACE", "2 * INST - 1") for k in range(len(kinds)))
        for kind, mesh, result in zip(kinds, meshes, self.solved(meshes, text)):
            with self.subTest(kind):
                self.assert_near(self.displacement(result, 2, 3), exact.displacement(mesh.points))
                self.assertLessEqual(np.abs(self.displacement(result, 1, 3)).max(), 1e-12)

    def test_quadratic_displacements_are_exact_in_axisymmetry(self):
        """u_r = a r2 + b r z, u_z = c r2 + d z2."""
        a, b, c, d = 0.01, -0.02, 0.015, 0.005
        lame, shear = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), YOUNG / (2 * (1 + POISSON))
        trace = f"({3 * a!r} * X + {2 * b + 2 * d!r} * Y)"
        radial = f"({lame!r} * {trace} + {2 * shear!r} * ({2 * a!r} * X + {b!r} * Y))"
        axial = f"({lame!r} * {trace} + {2 * shear * 2 * d!r} * Y)"
        sheared = f"({shear * (b + 2 * c)!r} * X)"
        inside = (-(3 * lame + 6 * shear) * a, -(shear * (b + 2 * c) * 2 + lame * (2 * b + 2 * d) + 4 * shear * d))
        sides = ", ".join(f"_F(GROUP_MA='{side}', FX=formula('{n[0]} * {radial} + {n[1]} * {sheared}'), "
                          f"FY=formula('{n[0]} * {sheared} + {n[1]} * {axial}'))" for side, n in NORMALS_2D.items() if side != "BASE")
        kinds, meshes, text = ("TRIA6", "QUAD8", "QUAD9"), [], ""
        for kind in kinds:
            text += f"""model({20 + len(meshes)}, 'AXIS')
H = AFFE_CHAR_CINE_F(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=formula('{a!r} * X**2 + {b!r} * X * Y'), DY=formula('{c!r} * X**2')))
S = AFFE_CHAR_MECA_F(MODELE=MODEL, FORCE_CONTOUR=({sides}))
V = AFFE_CHAR_MECA(MODELE=MODEL, FORCE_INTERNE=_F(GROUP_MA='BODY', FX={inside[0]!r}, FY={inside[1]!r}))
solve(_F(CHARGE=H, FONC_MULT=RAMP), _F(CHARGE=S, FONC_MULT=RAMP), _F(CHARGE=V, FONC_MULT=RAMP))
"""
            meshes.append(flat_block(kind, start=1.0))
        for kind, result in zip(kinds, self.solved(meshes, text)):
            r, z = result.points.T
            with self.subTest(kind):
                self.assert_near(self.displacement(result, 2, 2), np.stack([a * r**2 + b * r * z, c * r**2 + d * z**2], axis=1))


class Gravity(LoadTest):
    def test_a_bar_under_its_weight(self):
        """nu = 0: u = -rho g (L y - y2 / 2) / E along the bar, in every modelisation; FONC_MULT may be a formula."""
        meshes = [flat_block("QUAD8"), flat_block("TRIA6"), flat_block("QUAD9", start=1.0), flat_brick("HEXA20"), flat_brick("TETRA10")]
        text = ""
        for k, (modelisation, along) in enumerate((("D_PLAN", 1), ("C_PLAN", 1), ("AXIS", 1), ("3D", 2), ("3D", 2))):
            hold = ", ".join(f"D{c}=0" for c in ("XYZ" if along == 2 else "XY"))
            text += f"""model({20 + k}, '{modelisation}', BAR)
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', {hold}))
G = AFFE_CHAR_MECA(MODELE=MODEL, PESANTEUR=_F(GRAVITE=10.0, DIRECTION=(0, {"0, -7" if along == 2 else "-7, 0"})))
solve(_F(CHARGE=H), _F(CHARGE=G, FONC_MULT=only_inst('INST**2 if INST > 0 else 0')))
"""
        for mesh, result in zip(meshes, self.solved(meshes, text)):
            dimension = mesh.points.shape[1]
            y = mesh.points[:, -1]
            exact = np.zeros_like(mesh.points)
            exact[:, -1] = -3.0 * 10.0 / YOUNG * (y.max() * y - y**2 / 2)
            for order, factor in ((1, 0.25), (2, 1.0)):
                self.assert_near(self.displacement(result, order, dimension), factor * exact)

    def test_a_material_without_density_is_refused(self):
        run = self.run_text([flat_block("QUAD4")], """
LIGHT = DEFI_MATERIAU(ELAS=_F(E=1.0, NU=0.0))
model(20, 'D_PLAN', LIGHT)
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0, DY=0))
G = AFFE_CHAR_MECA(MODELE=MODEL, PESANTEUR=_F(GRAVITE=10.0, DIRECTION=(0, -1, 0)))
solve(_F(CHARGE=H), _F(CHARGE=G))
""")
        self.assertEqual(run.status, 2)
        self.assertIn("ELAS/RHO", run.stderr)


class Edges(LoadTest):
    def test_functions_along_an_edge(self):
        """f = X2 per unit of length on the edge X = 0 to 2 of a brick held at its base: the supports give the integral, 8 / 3, and its moment; time is FONC_MULT's."""
        mesh = flat_brick("HEXA20")
        ends = {tuple(p): i for i, p in enumerate(np.round(mesh.points, 9))}
        top = mesh.points[:, 2].max()
        line = [[ends[0.0, 0.0, top], ends[0.8, 0.0, top], ends[0.4, 0.0, top]], [ends[0.8, 0.0, top], ends[2.0, 0.0, top], ends[1.4, 0.0, top]]]
        mesh.cells["SEG3"] = np.array(line)
        mesh.cell_groups["EDGE"] = [("SEG3", 0), ("SEG3", 1)]
        text = """
model(20, '3D')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0, DY=0, DZ=0))
E = AFFE_CHAR_MECA_F(MODELE=MODEL, FORCE_ARETE=_F(GROUP_MA='EDGE', FZ=FORMULE(NOM_PARA='X', VALE='-X**2'), FY=DEFI_CONSTANTE(VALE=2.0)))
solve(_F(CHARGE=H), _F(CHARGE=E, FONC_MULT=RAMP))
CALC_CHAMP(reuse=R[0], RESULTAT=R[0], FORCE='REAC_NODA')
try:
    AFFE_CHAR_MECA_F(MODELE=MODEL, FORCE_ARETE=_F(GROUP_MA='EDGE', FZ=RAMP))
    raise SystemExit('a function of time')
except AsterError as error:
    assert error.id_message == 'FUNCTION_2', error
"""
        result, = self.solved([mesh], text)
        for order, factor in ((1, 0.5), (2, 1.0)):
            up, across = (result.at_nodes("REAC_NODA", order, c) for c in ("DZ", "DY"))
            held = result.points[:, 2] < 1e-9
            self.assertAlmostEqual(up[held].sum(), factor * 8 / 3, delta=1e-10)
            self.assertAlmostEqual((up * result.points[:, 0])[held].sum(), factor * 4.0, delta=1e-10)
            self.assertAlmostEqual(across[held].sum(), -factor * 4.0, delta=1e-10)


class Equalities(LoadTest):
    def test_pressure_traction_nodal_forces_and_their_functions_agree(self):
        """p = 5 on the top of a TRIA6 block: as pressure, as traction, as a function of place, with shear; to the last digits."""
        mesh = flat_block("TRIA6")
        push = ["AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='TOP', PRES=5.0, CISA_2D=2.0))",
                "AFFE_CHAR_MECA(MODELE=MODEL, FORCE_CONTOUR=_F(GROUP_MA='TOP', FX=-2.0, FY=-5.0))",
                "AFFE_CHAR_MECA_F(MODELE=MODEL, PRES_REP=_F(GROUP_MA='TOP', PRES=formula('5 * Y'), CISA_2D=formula('Y + 1')))",
                "AFFE_CHAR_MECA_F(MODELE=MODEL, FORCE_CONTOUR=_F(GROUP_MA='TOP', FX=formula('-2 * Y'), FY=only_inst('-5.0')))",
                "AFFE_CHAR_MECA_F(MODELE=MODEL, PRES_REP=_F(GROUP_MA='TOP', PRES=DEFI_CONSTANTE(VALE=5.0), CISA_2D=DEFI_NAPPE(NOM_PARA='Y', "
                "PARA=(0.0, 2.0), NOM_PARA_FONC='X', DEFI_FONCTION=(_F(VALE=(0, 1, 2, 1)), _F(VALE=(0, 3, 2, 3))))))"]
        text = "model(20, 'D_PLAN')\nH = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0, DY=0))\n"
        for line in push:
            text += f"P = {line}\nsolve(_F(CHARGE=H), _F(CHARGE=P, FONC_MULT=RAMP))\n"
        results = self.solved([mesh], text)
        first = self.displacement(results[0], 2, 2)
        for other in results[1:]:
            self.assert_near(self.displacement(other, 2, 2), first, 1e-13)

    def test_nodal_forces_are_those_of_the_shape_functions(self):
        """One edge of length 2 under a traction of 3: Simpson's 1/6, 4/6, 1/6 of 6 on its nodes."""
        mesh = block("QUAD8", np.array([0, 2.0]), np.array([0, 1.0]), None, "BODY", SIDES_2D)
        for k, node in enumerate(((0, 1), (2, 1), (1, 1))):
            mesh.node_groups[f"N{k}"] = mesh.nodes_where(lambda x, y, at=node: (x, y) == at)
        text = "model(20, 'D_PLAN')\nH = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0, DY=0))\n"
        for line in ("FORCE_CONTOUR=_F(GROUP_MA='TOP', FY=3.0)", "FORCE_NODALE=(_F(GROUP_NO=('N0', 'N1'), FY=1.0), _F(GROUP_NO='N2', FY=4.0))"):
            text += f"P = AFFE_CHAR_MECA(MODELE=MODEL, {line})\nsolve(_F(CHARGE=H), _F(CHARGE=P))\n"
        one, other = self.solved([mesh], text)
        self.assert_near(self.displacement(one, 1, 2), self.displacement(other, 1, 2), 1e-13)


def rotation(dimension):
    """A rotation that leaves no axis where it was."""
    a = 0.5
    plane = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
    if dimension == 2:
        return plane
    first, second = np.eye(3), np.eye(3)
    first[:2, :2], second[1:, 1:] = plane, plane
    return first @ second


class Relations(LoadTest):
    def assert_pivots(self, run, expected):
        """Every factorisation had as many negative pivots as there are relations: a difference is shown as "3 of 5"."""
        lines = [line.split("|") for line in run.stdout.splitlines() if line.startswith(" |") and "TANGENTE" in line]
        self.assertTrue(lines)
        found = {cell.strip() for line in lines for cell in line if cell.strip() == str(expected) or " of " in cell}
        self.assertEqual(found, {str(expected)})

    def test_normals_of_tilted_sides_are_held(self):
        """A block turned in space, its lower sides held along their normals, pressed on top: uniaxial in the turned frame."""
        meshes, models = [], ("D_PLAN", "D_PLAN", "3D", "3D")
        for mesh in (flat_block("TRIA3"), flat_block("QUAD8"), flat_brick("HEXA8"), flat_brick("TETRA10")):
            mesh.straight = mesh.points
            mesh.points = mesh.points @ rotation(mesh.points.shape[1]).T
            meshes.append(mesh)
        text = ""
        for k, modelisation in enumerate(models):
            sides = ["BASE", "LEFT"] + ["FRONT"] * (modelisation == "3D")
            held = ", ".join(f"_F(GROUP_MA='{side}', DNOR=0.0)" for side in sides)
            text += f"""model({20 + k}, '{modelisation}')
H = AFFE_CHAR_MECA(MODELE=MODEL, FACE_IMPO=({held}))
P = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='TOP', PRES=20.0))
solve(_F(CHARGE=H), _F(CHARGE=P, FONC_MULT=RAMP))
"""
        for mesh, modelisation, result in zip(meshes, models, self.solved(meshes, text)):
            dimension = mesh.points.shape[1]
            factor = (1 + POISSON) if modelisation == "D_PLAN" else 1.0
            strain = np.full(dimension, POISSON * factor * 20.0 / YOUNG)
            strain[-1] = -(1 - POISSON**2 if modelisation == "D_PLAN" else 1.0) * 20.0 / YOUNG
            self.assert_near(self.displacement(result, 2, dimension), (mesh.straight * strain) @ rotation(dimension).T)

    def test_normal_and_tangent_that_are_given_are_those_displacements(self):
        """DNOR and DTAN on one side instead of DX and DY; FONC_MULT and functions of INST multiply both."""
        mesh = flat_block("QUAD8")
        sides = ("AFFE_CHAR_MECA_F(MODELE=MODEL, FACE_IMPO=_F(GROUP_MA='RIGHT', DNOR=only_inst('0.1 * INST'), DTAN=only_inst('0.2 * INST')))",
                 "AFFE_CHAR_MECA(MODELE=MODEL, FACE_IMPO=_F(GROUP_MA='RIGHT', DX=0.1, DY=0.2))",
                 "AFFE_CHAR_MECA(MODELE=MODEL, FACE_IMPO=_F(GROUP_MA='RIGHT', DNOR=0.1, DTAN=0.2))")
        text = "model(20, 'D_PLAN')\nH = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='LEFT', DX=0, DY=0))\n"
        for k, side in enumerate(sides):
            text += f"S = {side}\nsolve(_F(CHARGE=H), _F(CHARGE=S{'' if k == 0 else ', FONC_MULT=RAMP'}))\n"
        results = self.solved([mesh], text)
        for order in (1, 2):
            exact = self.displacement(results[1], order, 2)
            for result in (results[0], results[2]):
                self.assert_near(self.displacement(result, order, 2), exact, 1e-12)

    def test_a_rigid_body_turns_without_stress(self):
        """LIAISON_SOLIDE on every node leaves rigid motions: three (six) displacements say which one. Stiff as steel."""
        meshes, text, spins = [flat_block("QUAD8"), flat_brick("HEXA8")], "", []
        text = "STEEL = DEFI_MATERIAU(ELAS=_F(E=2.1e11, NU=0.3))\n"
        for k, mesh in enumerate(meshes):
            dimension = mesh.points.shape[1]
            corners = [(0.0,) * dimension, (2.0,) + (0.0,) * (dimension - 1), (0.0, 1.0) + (0.0,) * (dimension - 2)]
            spin = np.array([[0, -0.3], [0.3, 0]]) if dimension == 2 else np.array([[0, -0.3, 0.2], [0.3, 0, 0.1], [-0.2, -0.1, 0]])
            spins.append(spin)
            given = [(0, "X"), (0, "Y"), (1, "Y")] if dimension == 2 else [(0, "X"), (0, "Y"), (0, "Z"), (1, "Y"), (1, "Z"), (2, "Z")]
            for c, corner in enumerate(corners):
                mesh.node_groups[f"C{c}"] = mesh.nodes_where(lambda *x, at=corner: x == at)
            imposed = ", ".join(f"_F(GROUP_NO='C{c}', D{axis}={float((spin @ corners[c])['XYZ'.index(axis)])!r})" for c, axis in given)
            text += f"""model({20 + k}, '{"D_PLAN" if dimension == 2 else "3D"}', STEEL)
S = AFFE_CHAR_MECA(MODELE=MODEL, LIAISON_SOLIDE=_F(GROUP_MA='BODY'))
H = AFFE_CHAR_MECA(MODELE=MODEL, DDL_IMPO=({imposed}))
solve(_F(CHARGE=H, FONC_MULT=RAMP), _F(CHARGE=S))
"""
        for mesh, spin, result in zip(meshes, spins, self.solved(meshes, text)):
            self.assert_near(self.displacement(result, 2, len(spin)), mesh.points @ spin.T)

    def test_a_uniform_displacement_spreads_a_force(self):
        """One corner of the top is pushed, and all of it goes down alike: nu = 0 leaves the bar's solution; as many negative
        pivots as relations."""
        mesh = flat_block("QUAD8")
        mesh.node_groups["CORNER"] = mesh.nodes_where(lambda x, y: (x, y) == (2.0, 1.0))
        write_med(self.folder / "0.med", mesh)
        text = """model(20, 'D_PLAN', BAR)
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0, DY=0))
U = AFFE_CHAR_MECA(MODELE=MODEL, LIAISON_UNIF=_F(GROUP_MA='TOP', DDL='DY'), FORCE_NODALE=_F(GROUP_NO='CORNER', FY=-40.0))
solve(_F(CHARGE=H), _F(CHARGE=U, FONC_MULT=RAMP))
"""
        run = self.run_text([mesh], text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        self.assert_pivots(run, 4)  # five nodes
        result = Result(self.folder / "loads.base", "R[0]")
        self.assert_near(self.displacement(result, 2, 2), np.stack([0 * mesh.points[:, 1], -40 / (YOUNG * 2.0) * mesh.points[:, 1]], axis=1))

    def test_relations_and_contact_stand_in_one_system(self):
        """The patch test with a top that goes down as one: LAGS_C = -p, negative pivots = active patches + relations."""
        mesh = patch_mesh("QUAD8", "TRIA6")  # 7 patches; 15 nodes on top
        text = """
MESH = LIRE_MAILLAGE(UNITE=20)
MESH = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL="SLAVE"))
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION="D_PLAN"))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", MATER=MATTER))
TOUCH = DEFI_CONTACT(MODELE=MODEL, FORMULATION="CONTINUE", ALGO_RESO_GEOM="NEWTON", ALGO_RESO_CONT="NEWTON",
                     ZONE=_F(GROUP_MA_ESCL="SLAVE", GROUP_MA_MAIT="MASTER", ALGO_CONT="LAC", CONTACT_INIT="OUI"))
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA="AXIS", DX=0), _F(GROUP_MA="BASE", DY=0)))
U = AFFE_CHAR_MECA(MODELE=MODEL, LIAISON_UNIF=_F(GROUP_MA="LOAD", DDL="DY"))
P = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA="LOAD", PRES=25.0))
solve(_F(CHARGE=H), _F(CHARGE=U), _F(CHARGE=P, FONC_MULT=RAMP), CONTACT=TOUCH)
"""
        run = self.run_text([mesh], text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        result = Result(self.folder / "loads.base", "R[0]")
        support, values = result.field("CONT_ELEM", 2)
        np.testing.assert_allclose(values["PRES"], -25.0, rtol=1e-9)
        self.assert_pivots(run, len(support) + 14)

    def test_relations_between_two_nodes_and_between_two_sides(self):
        """LIAISON_DDL against the displacement it amounts to; LIAISON_GROUP between opposite sides: a uniform strain on any mesh."""
        mesh = flat_block("TRIA6")
        mesh.node_groups["A"], mesh.node_groups["B"] = (mesh.nodes_where(lambda x, y, at=at: (x, y) == at) for at in ((0, 1), (2, 1)))
        mesh.node_groups["O"] = mesh.nodes_where(lambda x, y: (x, y) == (0, 0))
        text = """model(20, 'C_PLAN')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0, DY=0))
A = AFFE_CHAR_MECA(MODELE=MODEL, DDL_IMPO=(_F(GROUP_NO='A', DY=0.02), _F(GROUP_NO='B', DX=0.03)))
solve(_F(CHARGE=H), _F(CHARGE=A, FONC_MULT=RAMP))
A = AFFE_CHAR_MECA_F(MODELE=MODEL, DDL_IMPO=_F(GROUP_NO='A', DY=only_inst('0.02 * INST')),
                     LIAISON_DDL=_F(GROUP_NO=('A', 'B'), DDL=('DY', 'DX'), COEF_MULT=(3.0, -2.0), COEF_IMPO=only_inst('0.0')))
solve(_F(CHARGE=H), _F(CHARGE=A))
L = AFFE_CHAR_MECA(MODELE=MODEL, LIAISON_GROUP=(
    _F(GROUP_MA_1='LEFT', GROUP_MA_2='RIGHT', TRAN=(2.0, 0.0), DDL_1='DX', COEF_MULT_1=-1.0, DDL_2='DX', COEF_MULT_2=1.0, COEF_IMPO=0.02),
    _F(GROUP_MA_1='LEFT', GROUP_MA_2='RIGHT', TRAN=(2.0, 0.0), DDL_1='DY', COEF_MULT_1=-1.0, DDL_2='DY', COEF_MULT_2=1.0, COEF_IMPO=0.0)))
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='BASE', DY=0), _F(GROUP_NO='O', DX=0)))
solve(_F(CHARGE=H), _F(CHARGE=L, FONC_MULT=RAMP))
"""
        one, other, periodic = self.solved([mesh], text)
        for order in (1, 2):
            self.assert_near(self.displacement(other, order, 2), self.displacement(one, order, 2), 1e-12)
        self.assert_near(self.displacement(periodic, 2, 2), mesh.points * (0.01, -POISSON * 0.01))

    def test_imposed_displacements_that_contradict_a_relation_are_refused(self):
        run = self.run_text([flat_block("QUAD4")], """
model(20, 'D_PLAN')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='BASE', DX=0, DY=0), _F(GROUP_MA='TOP', DX=0, DY=1)))
U = AFFE_CHAR_MECA(MODELE=MODEL, LIAISON_DDL=_F(NOEUD=('N1', 'N7'), DDL=('DY', 'DY'), COEF_MULT=(1, -1), COEF_IMPO=0))
solve(_F(CHARGE=H), _F(CHARGE=U))
""")
        self.assertEqual(run.status, 2, run.stdout[-2000:])
        self.assertIn("<LOAD_6> a relation of U (LIAISON_DDL/DDL)", run.stderr)

    def test_relations_that_say_the_same_are_held_once(self):
        """A tie said twice, one that is the sum of two others and one that imposed displacements make already: displacements are those of the first alone."""
        tie = "_F(GROUP_MA='TOP', DDL='DX')"
        more = """, LIAISON_DDL=(_F(NOEUD=('N7', 'N8'), DDL=('DX', 'DX'), COEF_MULT=(3.0, -3.0), COEF_IMPO=0),
                                  _F(NOEUD=('N1', 'N2', 'N8', 'N7'), DDL=('DX', 'DY', 'DX', 'DX'), COEF_MULT=(1.0, 5.0, 0.5, -0.5), COEF_IMPO=0))"""
        mesh = flat_block("QUAD4")
        text = "model(20, 'D_PLAN')\nH = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0, DY=0))\nP = AFFE_CHAR_MECA(MODELE=MODEL, "
        text += "FORCE_CONTOUR=_F(GROUP_MA='RIGHT', FX=3.0, FY=1.0))\n"
        for relations in (f"LIAISON_UNIF={tie}", f"LIAISON_UNIF=({tie}, {tie})" + more):
            text += f"U = AFFE_CHAR_MECA(MODELE=MODEL, {relations})\nsolve(_F(CHARGE=H), _F(CHARGE=P, FONC_MULT=RAMP), _F(CHARGE=U))\n"
        one, twice = self.solved([mesh], text)
        self.assert_near(self.displacement(twice, 2, 2), self.displacement(one, 2, 2), 1e-12)

    def test_a_rigid_face_may_meet_planes_of_symmetry(self):
        """Of a rigid top two planes hold more nodes than it has motions: displacements are those where a plane lets go of the top at what adds nothing."""
        mesh = flat_brick("HEXA8")
        top = mesh.points[:, 2].max()
        mesh.node_groups["X0"] = mesh.nodes_where(lambda x, y, z: x == 0)
        mesh.node_groups["Y0"] = mesh.nodes_where(lambda x, y, z: y == 0)
        mesh.node_groups["ENOUGH"] = mesh.nodes_where(lambda x, y, z: y == 0 and (x == 0 or z < top))
        self.assertEqual(len(mesh.node_groups["Y0"]) - len(mesh.node_groups["ENOUGH"]), 2)
        text = "model(20, '3D')\nP = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='TOP', PRES=12.0))\nU = AFFE_CHAR_MECA(MODELE=MODEL, LIAISON_SOLIDE=_F(GROUP_MA='TOP'))\n"
        for plane in ("Y0", "ENOUGH"):
            text += f"""H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='BASE', DX=0, DY=0, DZ=0), _F(GROUP_NO='X0', DX=0), _F(GROUP_NO='{plane}', DY=0)))
solve(_F(CHARGE=H), _F(CHARGE=P, FONC_MULT=RAMP), _F(CHARGE=U))
"""
        both, enough = self.solved([mesh], text)
        self.assert_near(self.displacement(both, 2, 3), self.displacement(enough, 2, 3), 1e-12)

    def test_relations_that_contradict_each_other_are_refused(self):
        run = self.run_text([flat_block("QUAD4")], """
model(20, 'D_PLAN')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0, DY=0))
U = AFFE_CHAR_MECA(MODELE=MODEL, LIAISON_UNIF=_F(GROUP_MA='TOP', DDL='DX'),
                   LIAISON_DDL=_F(NOEUD=('N7', 'N8'), DDL=('DX', 'DX'), COEF_MULT=(1, -1), COEF_IMPO=0.5))
solve(_F(CHARGE=H), _F(CHARGE=U))
""")
        self.assertEqual(run.status, 2, run.stdout[-2000:])
        self.assertIn("<LOAD_6> a relation of U (LIAISON_", run.stderr)


class Following(LoadTest):
    """TYPE_CHARGE='SUIV': pressure on the skin where it is now."""

    def test_pressure_on_a_stretched_top_has_its_present_area(self):
        """Every node is pulled sideways by 1 + s; nu = 0: u_y = -p (1 + s) y / E, (1 + s)2 in axisymmetry and space."""
        meshes, stretch = [flat_block("QUAD4"), flat_block("TRIA6", start=1.0), flat_brick("HEXA8"), flat_brick("TETRA10")], 0.5
        text = ""
        for k, modelisation in enumerate(("D_PLAN", "AXIS", "3D", "3D")):
            sideways = f"DX=formula('{stretch} * X * INST')" + (f", DY=formula('{stretch} * Y * INST')" if modelisation == "3D" else "")
            text += f"""model({20 + k}, '{modelisation}', BAR)
S = AFFE_CHAR_CINE_F(MODELE=MODEL, MECA_IMPO=_F(TOUT='OUI', {sideways}))
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', {"DZ" if modelisation == "3D" else "DY"}=0))
P = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='TOP', PRES=20.0))
solve(_F(CHARGE=S), _F(CHARGE=H), _F(CHARGE=P, FONC_MULT=RAMP, TYPE_CHARGE='SUIV'))
"""
        for mesh, power, result in zip(meshes, (1, 2, 2, 2), self.solved(meshes, text)):
            for order, instant in ((1, 0.5), (2, 1.0)):
                found = self.displacement(result, order, mesh.points.shape[1])[:, -1]
                self.assert_near(found, -20.0 * instant * (1 + stretch * instant)**power / YOUNG * mesh.points[:, -1])

    def test_reactions_balance_the_pressure_on_the_deformed_skin(self):
        """A pressure that varies and bends the top: the reactions' sum is int p n over the current edges."""
        mesh = flat_block("QUAD8", size=(2.0, 2.0))
        text = """model(20, 'D_PLAN')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0, DY=0))
P = AFFE_CHAR_MECA_F(MODELE=MODEL, PRES_REP=_F(GROUP_MA='TOP', PRES=formula('50.0 + 150.0 * X')))
solve(_F(CHARGE=H), _F(CHARGE=P, FONC_MULT=RAMP, TYPE_CHARGE='SUIV'))
CALC_CHAMP(reuse=R[0], RESULTAT=R[0], FORCE='REAC_NODA')
"""
        (result,) = self.solved([mesh], text)
        self.assertGreater(np.abs(self.displacement(result, 2, 2)).max(), 0.15)
        current = result.points + self.displacement(result, 2, 2)
        gauss, weights = np.polynomial.legendre.leggauss(4)
        force = np.zeros(2)
        for cell in result.groups["TOP"]:
            nodes = result.cells[cell][1]
            for xi, weight in zip(gauss, weights):
                shape = np.array([xi * (xi - 1) / 2, xi * (xi + 1) / 2, 1 - xi**2])
                slope = np.array([xi - 0.5, xi + 0.5, -2 * xi])
                tangent = slope @ current[nodes]
                pressure = 50 + 150 * (shape @ result.points[nodes, 0])
                force -= weight * pressure * np.array([tangent[1], -tangent[0]])
        reactions = np.array([result.at_nodes("REAC_NODA", 2, c).sum() for c in ("DX", "DY")])
        self.assertLessEqual(np.abs(reactions + force).max(), 1e-8 * np.abs(force).max())

    def test_an_axis_that_no_load_holds_may_move_by_the_error_of_the_discretisation(self):
        """A constant pressure on any skin from the axis outward thrusts by p r2 / 2 for one radian, wherever the skin has moved. On
        the foot of this cylinder nothing but elasticity keeps the nodes of the axis there: some are beyond it by up to 1e-3."""
        beyond = 0.0
        for pressure in (-60.0, 60.0):
            mesh = flat_block("QUAD8", size=(2.0, 2.0))
            text = f"""model(20, 'AXIS')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0, DY=0))
P = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='TOP', PRES={pressure}))
solve(_F(CHARGE=H), _F(CHARGE=P, FONC_MULT=RAMP, TYPE_CHARGE='SUIV'))
CALC_CHAMP(reuse=R[0], RESULTAT=R[0], FORCE='REAC_NODA')
"""
            (result,) = self.solved([mesh], text)
            current = result.points + self.displacement(result, 2, 2)
            radii = current[np.isclose(result.points[:, 1], 2.0), 0]
            thrust = pressure * (radii.max()**2 - radii[np.abs(radii).argmin()]**2) / 2
            self.assertLessEqual(abs(result.at_nodes("REAC_NODA", 2, "DY").sum() - thrust), 1e-8 * abs(thrust))
            beyond = min(beyond, radii.min())
        self.assertLess(beyond, -1e-5)

    def test_what_cannot_follow_is_refused(self):
        run = self.run_text([flat_block("QUAD4")], """
model(20, 'D_PLAN')
P = AFFE_CHAR_MECA(MODELE=MODEL, FORCE_CONTOUR=_F(GROUP_MA='TOP', FX=1.0))
solve(_F(CHARGE=P, TYPE_CHARGE='SUIV'))
""")
        self.assertEqual(run.status, 2, run.stdout[-2000:])
        self.assertIn("<LOAD_5>", run.stderr)


class TurnedForces(LoadTest):
    """FORCE_NODALE with ANGL_NAUT by functions: bodies answer linearly, so that a force that turns moves them by what its components do."""

    def test_a_force_turns_with_the_instant(self):
        """180 degrees times t: FX is FY at t = 1/2, and -FX at t = 1."""
        text = """model(20, 'C_PLAN')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='LEFT', DX=0, DY=0))
for name in ('FX', 'FY'):
    solve(_F(CHARGE=H), _F(CHARGE=AFFE_CHAR_MECA(MODELE=MODEL, FORCE_NODALE=_F(GROUP_MA='RIGHT', **{name: 2.0}))))
two = DEFI_CONSTANTE(VALE=2.0)
solve(_F(CHARGE=H), _F(CHARGE=AFFE_CHAR_MECA_F(MODELE=MODEL, FORCE_NODALE=_F(GROUP_MA='RIGHT', FX=two, ANGL_NAUT=only_inst('180 * INST')))))
"""
        self.solved([flat_block("QUAD8")], text)
        along, across, turned = (Result(self.folder / "loads.base", f"R[{k}]") for k in range(3))
        for order, exact in ((1, self.displacement(across, 1, 2)), (2, -self.displacement(along, 2, 2))):
            self.assert_near(self.displacement(turned, order, 2), exact, 1e-9)

    def test_three_angles_are_those_of_numbers(self):
        """Forces and angles that depend on the place are those of the node."""
        (numbers, functions) = self.solved([flat_brick("HEXA20")], """model(20, '3D')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='LEFT', DX=0, DY=0, DZ=0))
MESH = DEFI_GROUP(reuse=MESH, MAILLAGE=MESH, CREA_GROUP_NO=_F(NOM='TIP', OPTION='ENV_SPHERE', POINT=(2.0, 1.0, 1.5), RAYON=1e-3, PRECISION=1e-3))
N = AFFE_CHAR_MECA(MODELE=MODEL, FORCE_NODALE=_F(GROUP_NO='TIP', FX=1.0, FY=2.0, FZ=3.0, ANGL_NAUT=(20.0, 30.0, 40.0)))
G = AFFE_CHAR_MECA_F(MODELE=MODEL, FORCE_NODALE=_F(GROUP_NO='TIP', FX=formula('X / 2'), FY=formula('X * Y'), FZ=formula('X * Z'),
                                                   ANGL_NAUT=(formula('10 * X'), formula('30 * Y'), formula('20 * X'))))
solve(_F(CHARGE=H), _F(CHARGE=N))
solve(_F(CHARGE=H), _F(CHARGE=G))
""")
        self.assert_near(self.displacement(functions, 1, 3), self.displacement(numbers, 1, 3), 1e-9)

    def test_axes_that_leave_the_plane_are_refused(self):
        run = self.run_text([flat_block("QUAD4")], "model(20, 'D_PLAN')\nF = only_inst('INST')\n"
                            "AFFE_CHAR_MECA_F(MODELE=MODEL, FORCE_NODALE=_F(GROUP_MA='RIGHT', FX=F, ANGL_NAUT=(F, F)))")
        self.assertEqual(run.status, 2, run.stdout + run.stderr)
        self.assertIn("MODIREPERE_5", run.stderr)


del LoadTest


if __name__ == "__main__":
    unittest.main()
