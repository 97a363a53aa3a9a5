"""PRE_EPSI against closed forms: bodies that take the strain without stress, bodies that are held, functions, states that follow one another."""

import unittest

import numpy as np

from load_study import POISSON, SIDES_2D, YOUNG, LoadTest, block, flat_block, flat_brick
from results import Result

#: components of a strain without stress, and those that plane strain and axisymmetry know
STRAIN = {"EPXX": 1e-3, "EPYY": -2e-3, "EPZZ": 3e-3, "EPXY": 4e-4, "EPXZ": -5e-4, "EPYZ": 6e-4}
FLAT = ("EPXX", "EPYY", "EPZZ", "EPXY")


def strained(modelisation):
    """Of an element with these axes: (what PRE_EPSI gives, u = G x that leaves it without stress in them)."""
    given = {name: value for name, value in STRAIN.items() if modelisation == "3D" or name in FLAT}
    if modelisation == "3D":
        e = STRAIN
        return given, np.array([[e["EPXX"], e["EPXY"], e["EPXZ"]], [e["EPXY"], e["EPYY"], e["EPYZ"]], [e["EPXZ"], e["EPYZ"], e["EPZZ"]]])
    if modelisation == "AXIS":  # u_r = e r: the hoop strain is the radial one, and a shear turns the sections
        given["EPZZ"] = given["EPXX"]
        return given, np.array([[given["EPXX"], 0], [2 * given["EPXY"], given["EPYY"]]])
    across = POISSON * given["EPZZ"] if modelisation == "D_PLAN" else 0  # what is held across a plane section spreads in it
    return given, np.array([[given["EPXX"] + across, given["EPXY"]], [given["EPXY"], given["EPYY"] + across]])


class InitialStrains(LoadTest):
    def test_a_body_takes_the_strain_without_stress(self):
        """u = e x where LEFT moves so, in every modelisation, with elasticity and plasticity; in plane strain SIZZ = -E EPZZ."""
        cases = [("D_PLAN", "QUAD8", "ELAS", "PETIT"), ("C_PLAN", "TRIA6", "ELAS", "PETIT"), ("C_PLAN", "QUAD4", "VMIS_ISOT_LINE", "PETIT"),
                 ("AXIS", "QUAD4", "ELAS", "PETIT_REAC"), ("3D", "HEXA8", "VMIS_ISOT_LINE", "PETIT"), ("3D", "TETRA10", "ELAS", "PETIT")]
        text = f"HARD = DEFI_MATERIAU(ELAS=_F(E={YOUNG}, NU={POISSON}), ECRO_LINE=_F(SY=1e6, D_SIGM_EPSI=1.0))\n"
        meshes = []
        for modelisation, kind, law, measure in cases:
            given, gradient = strained(modelisation)
            moved = ", ".join(f"D{c}=formula('''{' + '.join(f'({float(g)!r}) * {axis}' for g, axis in zip(row, 'XYZ'))}''')"
                              for c, row in zip("XYZ", gradient))
            text += f"""model({20 + len(meshes)}, '{modelisation}', HARD)
H = AFFE_CHAR_CINE_F(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='LEFT', {moved}))
S = AFFE_CHAR_MECA(MODELE=MODEL, PRE_EPSI=_F({'TOUT="OUI"' if kind == 'QUAD8' else 'GROUP_MA="BODY"'}, {', '.join(f'{k}={v!r}' for k, v in given.items())}))
solve(_F(CHARGE=H, FONC_MULT=RAMP), _F(CHARGE=S, FONC_MULT=RAMP), COMPORTEMENT=_F(RELATION='{law}', DEFORMATION='{measure}'))
CALC_CHAMP(reuse=R[-1], RESULTAT=R[-1], CONTRAINTE='SIEF_NOEU', DEFORMATION=('EPSI_NOEU',))
"""
            meshes.append(flat_brick(kind) if modelisation == "3D" else flat_block(kind, start=1.0 if modelisation == "AXIS" else 0.0))
        for (modelisation, kind, law, measure), result in zip(cases, self.solved(meshes, text)):
            with self.subTest(f"{modelisation} {kind} {law} {measure}"):
                given, gradient = strained(modelisation)
                exact = result.points @ gradient.T
                # PETIT_REAC has second order terms of the strain in a step
                near = 1e-2 if measure == "PETIT_REAC" else 1e-8
                self.assert_near(self.displacement(result, 2, len(gradient)), exact, near)
                self.assert_near(self.displacement(result, 1, len(gradient)), exact / 2, near)
                for component in ("SIXX", "SIYY", "SIZZ", "SIXY"):
                    stress = -YOUNG * given["EPZZ"] if (modelisation, component) == ("D_PLAN", "SIZZ") else 0
                    found = result.at_nodes("SIEF_NOEU", 2, component)
                    self.assertLessEqual(np.abs(found - stress).max(), near * YOUNG * 1e-3, component)
                across = {"D_PLAN": 0.0}.get(modelisation, given["EPZZ"])
                self.assertLessEqual(np.abs(result.at_nodes("EPSI_NOEU", 2, "EPZZ") - across).max(), near * 1e-3)

    def test_stress_is_that_of_the_strain_less_the_initial_one(self):
        """At each point of a body that takes a part of an uneven initial strain: SIEF = C : (EPSI - initial), EPME = EPSI - initial, and energies are
        halves of SIEF : EPME. By functions, or as a field of their values at the points: the same."""
        cases, text, meshes = [("D_PLAN", "QUAD8"), ("C_PLAN", "TRIA6"), ("AXIS", "QUAD8"), ("3D", "HEXA8")], "", []
        lame, shear = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), YOUNG / 2 / (1 + POISSON)
        for modelisation, kind in cases:
            names = tuple(STRAIN) if modelisation == "3D" else FLAT
            text += f"""
names = {names}
columns = ['X%d' % (k + 1) for k in range(len(names))]
model({20 + len(meshes)}, '{modelisation}')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='LEFT', DX=0, DY=0{", DZ=0" if modelisation == "3D" else ""}), _F(GROUP_MA='TOP', DY=1e-3)))
S = AFFE_CHAR_MECA_F(MODELE=MODEL, PRE_EPSI=_F(GROUP_MA='BODY', **{{name: formula('%r * (1 + X * Y * INST)' % STRAIN[name]) for name in names}}))
solve(_F(CHARGE=H, FONC_MULT=RAMP), _F(CHARGE=S, FONC_MULT=ONE))
A = R[-1]
CALC_CHAMP(reuse=A, RESULTAT=A, DEFORMATION=('EPSI_ELGA', 'EPME_ELGA'), ENERGIE='ENEL_ELGA')
NODES = CREA_CHAMP(TYPE_CHAM='NOEU_GEOM_R', OPERATION='EXTR', MAILLAGE=MESH, NOM_CHAM='GEOMETRIE')
PLACES = CREA_CHAMP(TYPE_CHAM='ELGA_GEOM_R', OPERATION='DISC', MODELE=MODEL, CHAM_GD=NODES)
LAWS = CREA_CHAMP(TYPE_CHAM='ELGA_NEUT_F', OPERATION='AFFE', MODELE=MODEL, AFFE=_F(GROUP_MA='BODY', NOM_CMP=columns,
                  VALE_F=[FORMULE(NOM_PARA=('X', 'Y'), VALE='%r * (1 + X * Y)' % STRAIN[name]) for name in names]))
VALUES = CREA_CHAMP(TYPE_CHAM='ELGA_NEUT_R', OPERATION='EVAL', CHAM_F=LAWS, CHAM_PARA=PLACES)
FREE = CREA_CHAMP(TYPE_CHAM='ELGA_EPSI_R', OPERATION='ASSE', MODELE=MODEL, ASSE=_F(TOUT='OUI', CHAM_GD=VALUES, NOM_CMP=columns, NOM_CMP_RESU=names))
D = AFFE_CHAR_MECA(MODELE=MODEL, PRE_EPSI=_F(EPSI=FREE))
B = MECA_STATIQUE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=H), _F(CHARGE=D)), INST=1.0)
CALC_CHAMP(reuse=B, RESULTAT=B, DEFORMATION='EPME_ELGA')
for name in ('DEPL', 'SIEF_ELGA', 'EPME_ELGA'):
    one, other = (numpy.array(r.getField(name, k).getValues()) for r, k in ((A, 2), (B, 1)))
    assert abs(one - other).max() <= 1e-9 * abs(one).max(), name
def rows(field):
    return field.toSimpleFieldOnCells().getValues()[0].reshape(-1, len(field.getComponents()))
strain, elastic, stress, free = (rows(f) for f in (*(A.getField(name, 2) for name in ('EPSI_ELGA', 'EPME_ELGA', 'SIEF_ELGA')), FREE))
expected = {2 * shear!r} * elastic
expected[:, :3] += {lame!r} * elastic[:, :3].sum(axis=1)[:, None]
assert abs(stress - expected).max() < 1e-9 * abs(stress).max(), 'stress'
known = [c for c in range(len(names)) if c != 2 or '{modelisation}' != 'C_PLAN']  # the strain across a plate follows from the stress
assert abs(elastic - (strain - free))[:, known].max() < 1e-9 * abs(free).max(), 'elastic strain'
energy = rows(A.getField('ENEL_ELGA', 2)).ravel()
double = numpy.array([1, 1, 1] + [2] * (len(names) - 3))
assert abs(energy - 0.5 * (stress * elastic * double).sum(axis=1)).max() < 1e-9 * energy.max(), 'energy'
sums = [POST_ELEM(RESULTAT=A, INST=1.0, **{{which: _F(TOUT='OUI')}})['TOTALE', 1] for which in ('ENER_ELAS', 'ENER_POT')]
assert abs(sums[0] / sums[1] - 1) < 1e-9, sums
"""
            meshes.append(flat_brick(kind) if modelisation == "3D" else flat_block(kind, start=1.0 if modelisation == "AXIS" else 0.0))
        run = self.run_text(meshes, f"import numpy\nSTRAIN = {STRAIN}\n{text}")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])

    def test_the_forces_of_a_stress_as_load(self):
        """PRE_SIGM = C : e, of cells, makes the strain e and the stress C : e, which it does not take off, and no reactions. The forces of a stress at
        points that is in equilibrium with a load are that load."""
        cases, text, meshes = [("D_PLAN", "QUAD8"), ("C_PLAN", "TRIA6"), ("AXIS", "QUAD4"), ("3D", "TETRA10")], "", []
        for modelisation, kind in cases:
            stress, gradient = self.stressed(modelisation)
            moved = {f"D{c}": " + ".join(f"({float(g)!r}) * {axis}" for g, axis in zip(row, "XYZ")) for c, row in zip("XYZ", gradient)}
            text += f"""
model({20 + len(meshes)}, '{modelisation}')
H = AFFE_CHAR_CINE_F(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='LEFT', **{{name: formula(text) for name, text in {moved}.items()}}))
F = CREA_CHAMP(TYPE_CHAM='CART_SIEF_R', OPERATION='AFFE', MAILLAGE=MESH, AFFE=_F(TOUT='OUI', NOM_CMP={tuple(stress)}, VALE={tuple(stress.values())}))
S = AFFE_CHAR_MECA(MODELE=MODEL, PRE_SIGM=_F(SIGM=F))
solve(_F(CHARGE=H, FONC_MULT=RAMP), _F(CHARGE=S, FONC_MULT=RAMP))
CALC_CHAMP(reuse=R[-1], RESULTAT=R[-1], CONTRAINTE='SIEF_NOEU', FORCE='REAC_NODA')
O = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='LEFT', DX=0, DY=0{", DZ=0" if modelisation == "3D" else ""}))
P = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='TOP', PRES=2.0))
A = MECA_STATIQUE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=O), _F(CHARGE=P)), INST=1.0)
F = CREA_CHAMP(TYPE_CHAM='ELGA_SIEF_R', OPERATION='EXTR', RESULTAT=A, NOM_CHAM='SIEF_ELGA', NUME_ORDRE=1)
Q = AFFE_CHAR_MECA(MODELE=MODEL, PRE_SIGM=_F(SIGM=F))
B = MECA_STATIQUE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=O), _F(CHARGE=Q)), INST=1.0)
u, v = (numpy.array(r.getField('DEPL', 1).getValues()) for r in (A, B))
assert abs(u - v).max() <= 1e-9 * abs(u).max()
"""
            meshes.append(flat_brick(kind) if modelisation == "3D" else flat_block(kind, start=1.0 if modelisation == "AXIS" else 0.0))
        for (modelisation, kind), result in zip(cases, self.solved(meshes, "import numpy\n" + text)):
            with self.subTest(f"{modelisation} {kind}"):
                stress, gradient = self.stressed(modelisation)
                for order, factor in ((1, 0.5), (2, 1.0)):
                    self.assert_near(self.displacement(result, order, len(gradient)), factor * result.points @ gradient.T, 1e-8)
                    for component, value in stress.items():
                        found = result.at_nodes("SIEF_NOEU", order, component)
                        self.assertLessEqual(np.abs(found - factor * value).max(), 1e-8 * YOUNG * 1e-3, component)
                    self.assertLessEqual(np.abs(result.at_nodes("REAC_NODA", order, "DX")).max(), 1e-8 * YOUNG * 1e-3)

    def test_forces_of_a_stress_under_a_law_that_takes_no_initial_strain(self):
        """What BEHAVIOUR_6 names in its place: a bar with GREEN_LAGRANGE and the dead forces of PRE_SIGM = E e stretches by g, (1 + g) E (g + g^2 / 2) = E e."""
        strain = 0.1
        (result,) = self.solved([flat_block("QUAD8")], f"""model(20, 'C_PLAN', BAR)
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='LEFT', DX=0), _F(GROUP_MA='BASE', DY=0)))
F = CREA_CHAMP(TYPE_CHAM='CART_SIEF_R', OPERATION='AFFE', MAILLAGE=MESH, AFFE=_F(TOUT='OUI', NOM_CMP='SIXX', VALE={YOUNG * strain}))
S = AFFE_CHAR_MECA(MODELE=MODEL, PRE_SIGM=_F(SIGM=F))
solve(_F(CHARGE=H), _F(CHARGE=S, FONC_MULT=RAMP), COMPORTEMENT=_F(RELATION='ELAS', DEFORMATION='GREEN_LAGRANGE'))
""")
        stretch = 0.0
        for _ in range(50):
            stretch = strain / ((1 + stretch) * (1 + stretch / 2))
        self.assert_near(self.displacement(result, 2, 2), np.stack([stretch * result.points[:, 0], 0 * result.points[:, 0]], axis=1), 1e-9)

    def stressed(self, modelisation):
        """(C : e as SIXX, ...; u = G x of that strain e), which in the plane has no part across."""
        lame, shear = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), YOUNG / 2 / (1 + POISSON)
        strain, gradient = strained(modelisation)
        if modelisation in ("D_PLAN", "C_PLAN"):
            strain["EPZZ"], gradient = 0.0, np.array([[strain["EPXX"], strain["EPXY"]], [strain["EPXY"], strain["EPYY"]]])
        if modelisation == "C_PLAN":
            strain["EPZZ"] = -POISSON / (1 - POISSON) * (strain["EPXX"] + strain["EPYY"])
        trace = sum(strain[f"EP{a}{a}"] for a in "XYZ")
        return {f"SI{name[2:]}": float(2 * shear * e + (lame * trace if name[2] == name[3] else 0)) for name, e in strain.items()}, gradient

    def test_a_held_bar_is_pressed(self):
        """Held at both ends: sigma = -E e, also on a first instant alone and with MECA_STATIQUE; mechanical strains and energies are the stress's."""
        text = """
model(20, 'C_PLAN')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='LEFT', DX=0), _F(GROUP_MA='RIGHT', DX=0), _F(GROUP_MA='BASE', DY=0)))
S = AFFE_CHAR_MECA(MODELE=MODEL, PRE_EPSI=_F(GROUP_MA='BODY', EPXX=1e-3))
ONCE = DEFI_LIST_REEL(VALE=(0.0, 1.0))
R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=H), _F(CHARGE=S)), INCREMENT=_F(LIST_INST=ONCE)))
R.append(MECA_STATIQUE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=H), _F(CHARGE=S)), LIST_INST=ONCE))
for k in range(2):
    CALC_CHAMP(reuse=R[k], RESULTAT=R[k], CONTRAINTE='SIEF_NOEU', DEFORMATION=('EPME_NOEU', 'EPSP_NOEU'), FORCE='REAC_NODA')
    elastic = POST_ELEM(RESULTAT=R[k], INST=1.0, ENER_ELAS=_F(TOUT='OUI'))['TOTALE', 1]
    stored = POST_ELEM(RESULTAT=R[k], INST=1.0, ENER_POT=_F(TOUT='OUI'))['TOTALE', 1]
    assert abs(elastic / (2000.0 * 1e-6 / 2 * 2.0) - 1) < 1e-10 and abs(stored / elastic - 1) < 1e-10, (elastic, stored)
"""
        run = self.run_text([flat_block("QUAD8")], text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        for k, order in ((0, 1), (1, 2)):
            result = Result(self.folder / "loads.base", f"R[{k}]")
            for name, component, value in (("SIEF_NOEU", "SIXX", -YOUNG * 1e-3), ("EPME_NOEU", "EPXX", -1e-3), ("EPME_NOEU", "EPYY", POISSON * 1e-3),
                                           ("EPME_NOEU", "EPZZ", POISSON * 1e-3), ("EPSP_NOEU", "EPXX", 0), ("EPSP_NOEU", "EPZZ", 0)):
                scale = YOUNG * 1e-3 if name.startswith("SI") else 1e-3
                self.assertLessEqual(np.abs(result.at_nodes(name, order, component) - value).max(), 1e-10 * scale, (k, name, component))
            reaction = result.at_nodes("REAC_NODA", order, "DX")
            self.assertAlmostEqual(reaction[result.points[:, 0] < 1e-9].sum(), YOUNG * 1e-3, delta=1e-9)

    def test_a_state_goes_on_with_its_initial_strains(self):
        """A second computation under the same load leaves the stress, one without the load leaves none; plasticity and elasticity alike."""
        text = f"""
HARD = DEFI_MATERIAU(ELAS=_F(E={YOUNG}, NU={POISSON}), ECRO_LINE=_F(SY=1e6, D_SIGM_EPSI=1.0))
for law in ('ELAS', 'VMIS_ISOT_LINE'):
    model(20, 'C_PLAN', HARD)
    H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='LEFT', DX=0), _F(GROUP_MA='RIGHT', DX=0), _F(GROUP_MA='BASE', DY=0)))
    S = AFFE_CHAR_MECA_F(MODELE=MODEL, PRE_EPSI=_F(GROUP_MA='BODY', EPXX=only_inst('1e-3 * min(INST, 1.0)')))
    first = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=H), _F(CHARGE=S)), INCREMENT=_F(LIST_INST=TIMES), COMPORTEMENT=_F(RELATION=law))
    LATER = DEFI_LIST_REEL(VALE=(1.0, 2.0))
    for loads in ((_F(CHARGE=H), _F(CHARGE=S)), (_F(CHARGE=H),)):
        R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=loads, INCREMENT=_F(LIST_INST=LATER), COMPORTEMENT=_F(RELATION=law),
                               ETAT_INIT=_F(EVOL_NOLI=first)))
        CALC_CHAMP(reuse=R[-1], RESULTAT=R[-1], CONTRAINTE='SIEF_NOEU')
"""
        run = self.run_text([flat_block("QUAD4")], text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        for k, stress in enumerate((-YOUNG * 1e-3, 0.0) * 2):
            found = Result(self.folder / "loads.base", f"R[{k}]").at_nodes("SIEF_NOEU", 1, "SIXX")
            self.assertLessEqual(np.abs(found - stress).max(), 1e-10 * YOUNG * 1e-3, k)

    def test_fields_with_the_strains_of_loads_are_told(self):
        """A held bar whose stress, 2, is given by fields: it stays without the load that made it, and with it an alarm says that it counts twice."""
        run = self.run_text([flat_block("QUAD4")], f"""
model(20, 'C_PLAN')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='LEFT', DX=0), _F(GROUP_MA='RIGHT', DX=0), _F(GROUP_MA='BASE', DY=0)))
T = AFFE_CHAR_MECA(MODELE=MODEL, PRE_EPSI=_F(TOUT='OUI', EPXX={-2 / YOUNG!r}))
A = MECA_STATIQUE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=H), _F(CHARGE=T)), INST=1.0)
U = CREA_CHAMP(OPERATION='EXTR', TYPE_CHAM='NOEU_DEPL_R', RESULTAT=A, NOM_CHAM='DEPL', INST=1.0)
S = CREA_CHAMP(OPERATION='EXTR', TYPE_CHAM='ELGA_SIEF_R', RESULTAT=A, NOM_CHAM='SIEF_ELGA', INST=1.0)
def go_on(*loads):
    return STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=[_F(CHARGE=load) for load in loads], ETAT_INIT=_F(DEPL=U, SIGM=S),
                         INCREMENT=_F(LIST_INST=TIMES, INST_INIT=0.5), COMPORTEMENT=_F(RELATION='ELAS'))
found = go_on(H).getField('SIEF_ELGA', 1).getValues('SIXX')
assert max(abs(value - 2.0) for value in found) < 1e-9, found
try:
    go_on(H, T)
except AsterError as error:
    assert error.id_message == 'EVOLUTION_78', error  # an alarm, which DEBUT makes an error
else:
    assert False
""")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])

    def test_a_strained_state_of_another_mesh_is_refused(self):
        """Its strains are those of cells that the mesh of the model need not have."""
        line = np.linspace(0.0, 1.0, 61)
        run = self.run_text([block("QUAD4", line, line, None, "BODY", SIDES_2D), flat_block("QUAD4")], """
for unit in (20, 21):
    model(unit, 'D_PLAN')
    H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0, DY=0))
    if unit == 20:
        S = AFFE_CHAR_MECA(MODELE=MODEL, PRE_EPSI=_F(GROUP_MA='BODY', EPXX=1e-3))
        first = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=H), _F(CHARGE=S)), INCREMENT=_F(LIST_INST=TIMES))
STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=_F(CHARGE=H), INCREMENT=_F(LIST_INST=TIMES), ETAT_INIT=_F(EVOL_NOLI=first, NUME_ORDRE=0))
""")
        self.assertEqual(run.status, 2, run.stdout[-3000:] + run.stderr[-3000:])
        self.assertIn("EVOLUTION_1>", run.stderr)

    def test_functions_of_place_and_time(self):
        """EPXX = X t: u = t X2 / 2, exact with quadratic cells."""
        text = ""
        meshes = [flat_block("TRIA6"), flat_brick("HEXA20")]
        for k, (modelisation, held) in enumerate((("C_PLAN", ("LEFT DX", "BASE DY")), ("3D", ("LEFT DX", "FRONT DY", "BASE DZ")))):
            hold = ", ".join(f"_F(GROUP_MA='{group}', {dof}=0)" for group, dof in map(str.split, held))
            text += f"""model({20 + k}, '{modelisation}')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=({hold}))
S = AFFE_CHAR_MECA_F(MODELE=MODEL, PRE_EPSI=_F(GROUP_MA='BODY', EPXX=formula('X * INST')))
solve(_F(CHARGE=H), _F(CHARGE=S, FONC_MULT=ONE))
"""
        for mesh, result in zip(meshes, self.solved(meshes, text)):
            dimension = mesh.points.shape[1]
            exact = np.zeros_like(mesh.points)
            exact[:, 0] = mesh.points[:, 0] ** 2 / 2
            for order, factor in ((1, 0.5), (2, 1.0)):
                self.assert_near(self.displacement(result, order, dimension), factor * exact, 1e-9)

    def test_what_takes_none_is_refused_by_name(self):
        for expected, text in (
                ("BEHAVIOUR_6", "S = AFFE_CHAR_MECA(MODELE=MODEL, PRE_EPSI=_F(GROUP_MA='BODY', EPXX=1e-3))\n"
                                "solve(_F(CHARGE=H), _F(CHARGE=S), COMPORTEMENT=_F(RELATION='ELAS', DEFORMATION='GDEF_LOG'))"),
                ("FIELDS_6", "F = CREA_CHAMP(TYPE_CHAM='NOEU_SIEF_R', OPERATION='AFFE', MAILLAGE=MESH, AFFE=_F(TOUT='OUI', NOM_CMP='SIXX', VALE=1.0))\n"
                             "AFFE_CHAR_MECA(MODELE=MODEL, PRE_SIGM=_F(SIGM=F))"),
                ("FIELDS_6", "F = CREA_CHAMP(TYPE_CHAM='ELGA_SIEF_R', OPERATION='AFFE', MODELE=MODEL, AFFE=_F(TOUT='OUI', NOM_CMP='SIXX', VALE=1.0))\n"
                             "AFFE_CHAR_MECA(MODELE=MODEL, PRE_EPSI=_F(EPSI=F))"),
                ("CHARGE_9", "AFFE_CHAR_MECA(MODELE=MODEL, PRE_EPSI=_F(GROUP_MA='BODY', EPXZ=1e-3))"),
                ("CHARGE_6", "AFFE_CHAR_MECA(MODELE=MODEL, PRE_EPSI=_F(GROUP_MA='LEFT', EPXX=1e-3))")):
            run = self.run_text([flat_block("QUAD4")], "model(20, 'D_PLAN')\n"
                                "H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0, DY=0))\n" + text)
            self.assertEqual(run.status, 2, run.stdout + run.stderr)
            self.assertIn(expected, run.stderr)


if __name__ == "__main__":
    unittest.main()
