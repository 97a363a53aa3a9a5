"""Temperatures against closed forms: free expansion, held bodies, a ring shrunk on another one, parameters that follow the temperature."""

import math
import unittest

import numpy as np

from load_study import POISSON, YOUNG, LoadTest, flat_block, flat_brick
from meshes import block, union  # noqa: I001 (load_study says where it is)
from results import Result

ALPHA, HEAT = 1e-4, 100.0
#: a field of temperatures of MESH at two instants, uniform at VALE_REF and HEAT above it in some groups
TEMPERATURES = f"""
HOT = DEFI_MATERIAU(ELAS=_F(E={YOUNG}, NU={POISSON}, ALPHA={ALPHA}, RHO=3.0))

def temperature(value, groups):
    return CREA_CHAMP(TYPE_CHAM="NOEU_TEMP_R", OPERATION="AFFE", MAILLAGE=MESH,
                      AFFE=(_F(TOUT="OUI", NOM_CMP="TEMP", VALE=20.0), _F(GROUP_MA=groups, NOM_CMP="TEMP", VALE=value)))

def heat(unit, modelisation, matter=HOT, groups="BODY"):
    global COURSE, FIELD
    model(unit, modelisation, matter)
    COURSE = CREA_RESU(OPERATION="AFFE", TYPE_RESU="EVOL_THER", AFFE=(
        _F(NOM_CHAM="TEMP", CHAM_GD=temperature(20.0, groups), INST=0.0), _F(NOM_CHAM="TEMP", CHAM_GD=temperature({20 + HEAT}, groups), INST=1.0)))
    FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", MATER=matter), AFFE_VARC=_F(NOM_VARC="TEMP", EVOL=COURSE, VALE_REF=20.0))
"""
FLAT = "_F(GROUP_MA='LEFT', DX=0), _F(GROUP_MA='BASE', DY=0)"
#: how a body is held so that it can expand
FREE = {"D_PLAN": FLAT, "C_PLAN": FLAT, "AXIS": "_F(GROUP_MA='BASE', DY=0)",
        "3D": "_F(GROUP_MA='LEFT', DX=0), _F(GROUP_MA='FRONT', DY=0), _F(GROUP_MA='BASE', DZ=0)"}


def free_stretch(law, strain):
    """Of a body that nothing holds. SIMO_MIEHE: J^2 - 1 = 3 e (J + 1 / J)."""
    if law == "SIMO_MIEHE":
        volume = 1.0
        for _ in range(100):
            volume = math.sqrt(1 + 3 * strain * (volume + 1 / volume))
        return volume ** (1 / 3)
    return {"GDEF_LOG": math.exp(strain), "GREEN_LAGRANGE": math.sqrt(1 + 2 * strain), "PETIT": 1 + strain}[law]


class Expansion(LoadTest):
    def test_a_free_body_expands_without_stress(self):
        """u = alpha dT x, (1 + nu) times that in plane strain; with logarithmic strains exp(...) - 1 instead."""
        cases = [(modelisation, kind, law)
                 for modelisation, kind in (("D_PLAN", "QUAD8"), ("C_PLAN", "TRIA6"), ("AXIS", "QUAD4"), ("3D", "HEXA20"), ("3D", "TETRA4"))
                 for law in ("PETIT", "GDEF_LOG") if (modelisation, law) != ("C_PLAN", "GDEF_LOG")]
        cases += [("C_PLAN", "QUAD4", "GREEN_LAGRANGE"), ("AXIS", "QUAD8", "GREEN_LAGRANGE"), ("AXIS", "QUAD4", "SIMO_MIEHE"), ("3D", "TETRA4", "SIMO_MIEHE")]
        text, meshes = TEMPERATURES, []
        for modelisation, kind, law in cases:
            text += f"""heat({20 + len(meshes)}, '{modelisation}')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=({FREE[modelisation]},))
solve(_F(CHARGE=H), COMPORTEMENT=_F(RELATION='ELAS', DEFORMATION='{law}'))
CALC_CHAMP(reuse=R[-1], RESULTAT=R[-1], DEFORMATION=('EPSI_NOEU', 'EPME_NOEU'))
"""
            meshes.append(flat_brick(kind) if modelisation == "3D" else flat_block(kind, start=1.0 if modelisation == "AXIS" else 0.0))
        for (modelisation, kind, law), result in zip(cases, self.solved(meshes, text)):
            with self.subTest(f"{modelisation} {kind} {law}"):
                strain = (1 + POISSON if modelisation == "D_PLAN" else 1) * ALPHA * HEAT
                stretch = free_stretch(law, strain) - 1
                dimension = result.points.shape[1]
                self.assert_near(self.displacement(result, 2, dimension), stretch * result.points)
                self.assert_near(result.at_nodes("EPSI_NOEU", 2, "EPXX"), np.full(len(result.points), stretch))
                mechanical = result.at_nodes("EPME_NOEU", 2, "EPXX")
                self.assertLessEqual(np.abs(mechanical - (stretch - ALPHA * HEAT)).max(), 1e-10 * strain)

    def test_a_held_bar_is_pressed(self):
        """Held at both ends: sigma = -E alpha dT, half of it at half the time, with MECA_STATIQUE, plasticity that does not flow, and
        parameters that are functions."""
        text = TEMPERATURES + f"""
E_OF_T = DEFI_FONCTION(NOM_PARA='TEMP', VALE=(0, {YOUNG}, 200, {YOUNG / 2}))
NU_OF_T = DEFI_CONSTANTE(VALE={POISSON})
ALPHA_OF_T = DEFI_FONCTION(NOM_PARA='TEMP', VALE=(0, {ALPHA}, 200, {2 * ALPHA}))
SOFT = DEFI_MATERIAU(ELAS_FO=_F(E=E_OF_T, NU=NU_OF_T, ALPHA=ALPHA_OF_T, TEMP_DEF_ALPHA=0.0))
YIELD = DEFI_MATERIAU(ELAS=_F(E={YOUNG}, NU={POISSON}, ALPHA={ALPHA}), ECRO_LINE=_F(SY=1e6, D_SIGM_EPSI=1.0))
for matter, law in ((HOT, 'ELAS'), (YIELD, 'VMIS_ISOT_LINE'), (SOFT, 'ELAS')):
    heat(20, 'C_PLAN', matter)
    H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='LEFT', DX=0), _F(GROUP_MA='RIGHT', DX=0), _F(GROUP_MA='BASE', DY=0)))
    R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=_F(CHARGE=H), INCREMENT=_F(LIST_INST=TIMES),
                           COMPORTEMENT=_F(RELATION=law)))
    R[-1] = CALC_CHAMP(reuse=R[-1], RESULTAT=R[-1], CONTRAINTE='SIEF_NOEU')
    if law == 'ELAS':
        R.append(MECA_STATIQUE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=_F(CHARGE=H), LIST_INST=TIMES))
        R[-1] = CALC_CHAMP(reuse=R[-1], RESULTAT=R[-1], CONTRAINTE='SIEF_NOEU')
"""
        run = self.run_text([flat_block("QUAD8")], text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])

        def young(t):
            return YOUNG * (1 - t / 400)

        def grown(t):
            def whole(x):
                return ALPHA * (1 + x / 200) * x
            return whole(t) - whole(20.0)

        soft = {1: -young(70) * grown(70), 2: -young(120) * grown(120)}
        plain = {1: -YOUNG * ALPHA * HEAT / 2, 2: -YOUNG * ALPHA * HEAT}
        for k, (exact, shift) in enumerate(((plain, 0), (plain, 1), (plain, 0), (soft, 0), (soft, 1))):
            result = Result(self.folder / "loads.base", f"R[{k}]")
            for order, stress in exact.items():
                found = result.at_nodes("SIEF_NOEU", order + shift, "SIXX")
                self.assertLessEqual(np.abs(found - stress).max(), 1e-8 * abs(stress), (k, order))


#: a body at 20 degrees, then at 420, where E is half of what it is and NU less, and ALPHA 0; lengths are 1 along y
HOT_METAL = f"""
TIMES = DEFI_LIST_REEL(VALE=(0.0, 1.0, 2.0, 3.0))
NOTHING = DEFI_CONSTANTE(VALE=0.0)
CHANGING = dict(E=DEFI_FONCTION(NOM_PARA='TEMP', VALE=(20, {YOUNG}, 420, {YOUNG / 2})),
                NU=DEFI_FONCTION(NOM_PARA='TEMP', VALE=(20, 0.4, 420, 0.2)), ALPHA=NOTHING)
LINE = dict(SY=2.0, D_SIGM_EPSI=200.0)
PULL = FORMULE(NOM_PARA='INST', VALE='0.01 * min(INST, 1) + 0.01 * max(INST - 2, 0)')
LATE = FORMULE(NOM_PARA='INST', VALE='0.02 * max(INST - 2, 0)')

def heated(unit, modelisation, matter):
    global FIELD
    model(unit, modelisation, matter)
    cold, hot = (CREA_CHAMP(TYPE_CHAM='NOEU_TEMP_R', OPERATION='AFFE', MAILLAGE=MESH, AFFE=_F(TOUT='OUI', NOM_CMP='TEMP', VALE=t)) for t in (20., 420.))
    course = CREA_RESU(OPERATION='AFFE', TYPE_RESU='EVOL_THER', NOM_CHAM='TEMP', AFFE=(_F(CHAM_GD=cold, INST=(0., 1.)), _F(CHAM_GD=hot, INST=(2., 3.))))
    FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=matter), AFFE_VARC=_F(NOM_VARC='TEMP', EVOL=course, VALE_REF=20.0))

def pulled(modelisation, how, law, deformation='PETIT', **more):
    held = {{'3D': [dict(GROUP_MA='LEFT', DX=0), dict(GROUP_MA='FRONT', DY=0), dict(GROUP_MA='BASE', DZ=0)], 'AXIS': [dict(GROUP_MA='BASE', DY=0)]}}.get(
        modelisation, [dict(GROUP_MA='LEFT', DX=0), dict(GROUP_MA='BASE', DY=0)])
    H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=held)
    P = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=dict(GROUP_MA='BACK', DY=1.0) if modelisation == '3D' else dict(GROUP_MA='TOP', DY=1.0))
    solve(_F(CHARGE=H), _F(CHARGE=P, FONC_MULT=how), COMPORTEMENT=_F(RELATION=law, DEFORMATION=deformation), **more)
    return R[-1]

def values(result, name, component):
    return result.getField(name, 3).getValues(component)
"""


class HotMetal(LoadTest):
    def test_the_tension_curve_has_its_slope_at_each_modulus(self):
        """Behind SY the slope is D_SIGM_EPSI whatever E is, whether the body flowed before, when it was cold, or not: 2 + 200 (0.02 - 2 / 1000).
        That of the cold modulus would be 200 / 0.9 for 200 / 0.8."""
        text = HOT_METAL + """
METAL = DEFI_MATERIAU(ELAS_FO=_F(**CHANGING), ECRO_LINE=_F(**LINE))
TIMED = DEFI_MATERIAU(ELAS_FO=_F(**dict(CHANGING, E=DEFI_FONCTION(NOM_PARA='INST', VALE=(1, 2000, 2, 1000, 3, 1000), PROL_GAUCHE='CONSTANT'))), ECRO_LINE=_F(**LINE))
for unit, modelisation, law in ((20, 'C_PLAN', 'VMIS_ISOT_LINE'), (20, 'AXIS', 'VMIS_ISOT_LINE'), (20, 'AXIS', 'VMIS_CINE_LINE'),
                                (21, '3D', 'VMIS_ISOT_LINE'), (21, '3D', 'VMIS_CINE_LINE')):
    for matter in (METAL, TIMED):
        for how in (LATE, PULL):
            heated(unit, modelisation, matter)
            found = values(pulled(modelisation, how, law), 'SIEF_ELGA', 'SIYY')
            assert max(abs(value - 5.6) for value in found) < 5.6e-8, (modelisation, law, how, found)
"""
        run = self.run_text([flat_block("QUAD4"), flat_brick("HEXA8")], text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])

    def test_a_computation_that_goes_on_knows_the_moduli_of_its_start(self):
        """From the cold body that flows, and from the hot one before it flows again: 5.6 as of one run."""
        text = HOT_METAL + """
METAL = DEFI_MATERIAU(ELAS_FO=_F(**CHANGING), ECRO_LINE=_F(**LINE))
for law in ('VMIS_ISOT_LINE', 'VMIS_CINE_LINE'):
    heated(20, 'AXIS', METAL)
    first = pulled('AXIS', PULL, law)
    for start in (1.0, 2.0):
        last = pulled('AXIS', PULL, law, ETAT_INIT=_F(EVOL_NOLI=first, INST=start))
        found = last.getField('SIEF_ELGA', last.getAccessParameters()['NUME_ORDRE'][-1]).getValues('SIYY')
        assert max(abs(value - 5.6) for value in found) < 5.6e-8, (law, start, found)
"""
        run = self.run_text([flat_block("QUAD4")], text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])

    def test_a_hot_body_is_one_of_its_modulus(self):
        """Every law and measure: heated without load and then pulled, the body has the stresses of one that has always had the E and NU of the heat."""
        text = HOT_METAL + f"""
METAL = DEFI_MATERIAU(ELAS_FO=_F(**CHANGING), ECRO_LINE=_F(**LINE))
OTHER = DEFI_MATERIAU(ELAS=_F(E={YOUNG / 2}, NU=0.2), ECRO_LINE=_F(**LINE))
for unit, modelisation in ((20, 'D_PLAN'), (20, 'C_PLAN'), (20, 'AXIS'), (21, '3D')):
    for law, deformation in (('VMIS_ISOT_LINE', 'PETIT'), ('VMIS_CINE_LINE', 'PETIT'), ('VMIS_ISOT_LINE', 'GDEF_LOG'), ('VMIS_ISOT_LINE', 'SIMO_MIEHE')):
        if modelisation == 'C_PLAN' and (law, deformation) != ('VMIS_ISOT_LINE', 'PETIT'):
            continue
        heated(unit, modelisation, METAL)
        hot = pulled(modelisation, LATE, law, deformation)
        model(unit, modelisation, OTHER)
        other = pulled(modelisation, LATE, law, deformation)
        for component in ('SIXX', 'SIYY', 'SIZZ', 'SIXY'):
            assert max(abs(a - b) for a, b in zip(values(hot, 'SIEF_ELGA', component), values(other, 'SIEF_ELGA', component))) < 1e-8, (modelisation, law, deformation)
"""
        run = self.run_text([flat_block("QUAD4"), flat_brick("HEXA8")], text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])

    def test_two_reference_temperatures_of_one_material(self):
        """Without ALPHA they mean nothing, whichever half comes first."""
        text = HOT_METAL + """
METAL = DEFI_MATERIAU(ELAS_FO=_F(**CHANGING), ECRO_LINE=_F(**LINE))
for references in ((20.0, 420.0), (420.0, 20.0)):
    heated(20, 'C_PLAN', METAL)
    MESH = DEFI_GROUP(reuse=MESH, MAILLAGE=MESH, CREA_GROUP_MA=_F(NOM='RIGHT_HALF', OPTION='BANDE', POINT=(2.0, 0.0), VECT_NORMALE=(1.0, 0.0), DIST=0.5))
    FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=METAL), AFFE_VARC=[
        dict(place, NOM_VARC='TEMP', CHAM_GD=CREA_CHAMP(TYPE_CHAM='NOEU_TEMP_R', OPERATION='AFFE', MAILLAGE=MESH, AFFE=_F(TOUT='OUI', NOM_CMP='TEMP', VALE=420.)),
             VALE_REF=value) for place, value in zip(({}, dict(GROUP_MA='RIGHT_HALF')), references)])
    found = values(pulled('C_PLAN', LATE, 'VMIS_ISOT_LINE'), 'SIEF_ELGA', 'SIYY')
    assert max(abs(value - 5.6) for value in found) < 5.6e-8, (references, found)
"""
        run = self.run_text([flat_block("QUAD4")], text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])

    def test_a_plate_grows_thin_by_the_ratio_of_its_temperature(self):
        """Pulled along y: EPZZ is EPXX, an elastic body has not flowed, what has flowed keeps its volume, and both elastic energies are one."""
        text = HOT_METAL + """
METAL = DEFI_MATERIAU(ELAS_FO=_F(**CHANGING), ECRO_LINE=_F(**LINE))
for law in ('ELAS', 'VMIS_ISOT_LINE'):
    heated(20, 'C_PLAN', METAL)
    result = pulled('C_PLAN', LATE, law)
    CALC_CHAMP(reuse=result, RESULTAT=result, DEFORMATION=('EPSI_ELGA', 'EPSP_ELGA'))
    for across, along in zip(values(result, 'EPSI_ELGA', 'EPZZ'), values(result, 'EPSI_ELGA', 'EPXX')):
        assert abs(across - along) < 1e-12 and across < -0.003, (law, across, along)
    flown = [values(result, 'EPSP_ELGA', name) for name in ('EPXX', 'EPYY', 'EPZZ')]
    assert max(abs(sum(three)) for three in zip(*flown)) < 1e-12, (law, flown)
    assert law != 'ELAS' or max(abs(value) for one in flown for value in one) < 1e-12, flown
    if law == 'ELAS':
        of_stress, of_strain = (POST_ELEM(RESULTAT=result, NUME_ORDRE=3, **{name: _F(TOUT='OUI')})['TOTALE', 1] for name in ('ENER_ELAS', 'ENER_POT'))
        assert abs(of_stress - 0.5 * 1000 * 0.02**2 * 2) < 1e-10 and abs(of_strain - of_stress) < 1e-10, (of_stress, of_strain)
"""
        run = self.run_text([flat_block("QUAD4")], text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])


def lame_pressure(interference, a, b, c, young, poisson):
    """Of two rings a < b < c of one material in plane stress."""
    outer, inner = (c**2 + b**2) / (c**2 - b**2) + poisson, (b**2 + a**2) / (b**2 - a**2) - poisson
    return interference * young / (b * (outer + inner))


def turned_radius(r, inside, outside, young, poisson, strength):
    """Displacement of a free ring that turns, in plane stress. @param strength density times speed^2"""
    return strength * (3 + poisson) / (8 * young) * (
        (1 - poisson) * (inside**2 + outside**2) * r + (1 + poisson) * inside**2 * outside**2 / r - (1 - poisson**2) / (3 + poisson) * r**3)


class PressFit(LoadTest):
    """A ring that is heated in another one, held along the axis (plane strain): Lame's pressure, which turning takes away."""

    A, B, C, SPEED = 1.0, 2.0, 3.0, 0.4

    def pressures(self):
        lines = np.linspace(0, 0.5, 3)
        inner = block("QUAD8", np.linspace(self.A, self.B, 13), lines, None, "IN", {"right": "SLAVE"})
        outer = block("QUAD8", np.linspace(self.B, self.C, 15), np.linspace(0, 0.5, 4), None, "OUT", {"left": "MASTER"})
        run = self.run_text([union([inner, outer])], TEMPERATURES + f"""
WHOLE = LIRE_MAILLAGE(UNITE=20)
MESH = CREA_MAILLAGE(MAILLAGE=WHOLE, DECOUPE_LAC=_F(GROUP_MA_ESCL='SLAVE'))
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='AXIS'))
COURSE = CREA_RESU(OPERATION="AFFE", TYPE_RESU="EVOL_THER", AFFE=(
    _F(NOM_CHAM="TEMP", CHAM_GD=temperature(20.0, 'IN'), INST=0.0), _F(NOM_CHAM="TEMP", CHAM_GD=temperature({20 + HEAT}, 'IN'), INST=1.0)))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", MATER=HOT),
                      AFFE_VARC=_F(GROUP_MA='IN', NOM_VARC="TEMP", EVOL=COURSE, VALE_REF=20.0, PROL_DROITE='CONSTANT'))
CONTACT = DEFI_CONTACT(MODELE=MODEL, FORMULATION='CONTINUE', ALGO_RESO_GEOM='NEWTON', ALGO_RESO_CONT='NEWTON',
                       ZONE=_F(ALGO_CONT='LAC', GROUP_MA_ESCL='SLAVE', GROUP_MA_MAIT='MASTER', CONTACT_INIT='INTERPENETRE'))
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(TOUT='OUI', DY=0))
TURN = AFFE_CHAR_MECA(MODELE=MODEL, ROTATION=_F(VITESSE={self.SPEED}, AXE=(0, 1, 0), CENTRE=(0, 0, 0)))
SQUARE = FORMULE(NOM_PARA='INST', VALE='max(INST - 1, 0)**2')
LIST = DEFI_LIST_REEL(VALE=(0.0, 1.0, 1.5, 2.0))
R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, CONTACT=CONTACT, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=TURN, FONC_MULT=SQUARE)),
                       INCREMENT=_F(LIST_INST=LIST), CONVERGENCE=_F(RESI_GLOB_RELA=1e-10, ITER_GLOB_MAXI=20)))
""")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        result = Result(self.folder / "loads.base", "R[0]")
        return {order: result.where_present("DEPL", order, "LAGS_C") for order in (1, 2, 3)}

    def figures(self):
        """Of each instant: speed, LAGS_C of the patches, theory."""
        young, poisson = YOUNG / (1 - POISSON**2), POISSON / (1 - POISSON)  # plane strain as plane stress
        heated = (1 + POISSON) * ALPHA * HEAT * self.B
        pressures = self.pressures()
        rows = []
        for order, part in ((1, 0.0), (2, 0.5), (3, 1.0)):
            strength = 3.0 * (self.SPEED * part) ** 2
            opened = (turned_radius(self.B, self.B, self.C, young, poisson, strength)
                      - turned_radius(self.B, self.A, self.B, young, poisson, strength))
            rows.append((self.SPEED * part, pressures[order], -lame_pressure(heated - opened, self.A, self.B, self.C, young, poisson)))
        return rows

    def test_lames_pressure_and_its_loss_with_the_speed(self):
        for speed, found, exact in self.figures():
            self.assertLessEqual(np.abs(found - exact).max(), 1e-6 * abs(exact), speed)


class Refusals(LoadTest):
    def test_what_temperatures_cannot_do_is_said(self):
        text = TEMPERATURES.replace("HOT =", "from code_aster import CA\nHOT =") + """
def said(**more):
    try:
        STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=_F(CHARGE=H), **dict(dict(INCREMENT=_F(LIST_INST=TIMES)), **more))
    except CA.AsterError as error:
        return error.id_message

heat(20, 'D_PLAN')
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='LEFT', DX=0), _F(GROUP_MA='BASE', DY=0)))
LATER = DEFI_LIST_REEL(VALE=(0.0, 1.0, 2.0))
assert said(INCREMENT=_F(LIST_INST=LATER)) == 'THERMAL_6'
LATE = DEFI_LIST_REEL(VALE=(0.5, 1.0))
assert said(INCREMENT=_F(LIST_INST=LATE)) == 'EVOLUTION_33'  # an alarm, which DEBUT makes an error
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=HOT), AFFE_VARC=_F(NOM_VARC='TEMP', CHAM_GD=temperature(20.0, 'BODY')))
assert said() == 'THERMAL_1'
PART = CREA_CHAMP(TYPE_CHAM="NOEU_TEMP_R", OPERATION="AFFE", MAILLAGE=MESH, AFFE=_F(GROUP_MA="LEFT", NOM_CMP="TEMP", VALE=30.0))
COURSE = CREA_RESU(OPERATION="AFFE", TYPE_RESU="EVOL_THER", NOM_CHAM="TEMP", AFFE=(
    _F(CHAM_GD=temperature(20.0, "BODY"), INST=0.0), _F(CHAM_GD=PART, INST=2.0)))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=HOT), AFFE_VARC=_F(NOM_VARC='TEMP', EVOL=COURSE, VALE_REF=20.0))
assert said() == 'THERMAL_7'
COLD = DEFI_MATERIAU(ELAS=_F(E=1000.0, NU=0.3))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=COLD), AFFE_VARC=_F(NOM_VARC='TEMP', CHAM_GD=temperature(20.0, 'BODY'), VALE_REF=20.0))
assert said() == 'THERMAL_8'
STIFF = DEFI_MATERIAU(ELAS=_F(E=1000.0, NU=0.3, ALPHA=0.0))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=STIFF), AFFE_VARC=_F(NOM_VARC='TEMP', CHAM_GD=temperature(20.0, 'BODY'), VALE_REF=20.0))
assert said() is None
LAW = DEFI_FONCTION(NOM_PARA='TEMP', VALE=(-100, 2000, 200, 1000))
SOFT = DEFI_MATERIAU(ELAS_FO=_F(E=LAW, NU=DEFI_CONSTANTE(VALE=0.3)))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=SOFT))
assert said() == 'THERMAL_3'
LAW = DEFI_FONCTION(NOM_PARA='TEMP', VALE=(-100, 2000, 200, 1000))
SOFT = DEFI_MATERIAU(ELAS_FO=_F(E=LAW, NU=DEFI_CONSTANTE(VALE=0.3)), ECRO_LINE=_F(SY=10.0, D_SIGM_EPSI=100.0))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=SOFT), AFFE_VARC=_F(NOM_VARC='TEMP', CHAM_GD=temperature(20.0, 'BODY'), VALE_REF=20.0))
assert said(COMPORTEMENT=_F(RELATION='VMIS_ISOT_LINE', DEFORMATION='GROT_GDEP')) == 'BEHAVIOUR_5'
FLAT = DEFI_MATERIAU(ELAS_FO=_F(E=LAW, NU=DEFI_CONSTANTE(VALE=0.3)), ECRO_LINE=_F(SY=10.0, D_SIGM_EPSI=1700.0))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=FLAT), AFFE_VARC=_F(NOM_VARC='TEMP', CHAM_GD=temperature(20.0, 'BODY'), VALE_REF=-100.0))
assert said(COMPORTEMENT=_F(RELATION='VMIS_ISOT_LINE')) == 'BEHAVIOUR_2'  # E is 1600 at 20 degrees
for modulus, expected in ((1600.0, None), (2000.0, 'BEHAVIOUR_2')):  # that at VALE_REF says nothing
    CURVE = DEFI_FONCTION(NOM_PARA='EPSI', VALE=(10 / modulus, 10.0, 1.0, 100.0))
    METAL = DEFI_MATERIAU(ELAS_FO=_F(E=LAW, NU=DEFI_CONSTANTE(VALE=0.3)), TRACTION=_F(SIGM=CURVE))
    FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=METAL), AFFE_VARC=_F(NOM_VARC='TEMP', CHAM_GD=temperature(20.0, 'BODY'), VALE_REF=-100.0))
    assert said(COMPORTEMENT=_F(RELATION='VMIS_ISOT_TRAC')) == expected, modulus
"""
        run = self.run_text([flat_block("QUAD4")], text)
        self.assertEqual(run.status, 0, run.stdout[-2000:] + run.stderr[-3000:])


if __name__ == "__main__":
    unittest.main()
