"""Energies, MECA_STATIQUE and the commands that make and move results, against theory: work that forces do is what bodies store."""

import unittest

import numpy as np

from load_study import POISSON, YOUNG, LoadTest, flat_block, flat_brick
from results import Result  # noqa: I001 (load_study says where it is)

STRETCH = """
def stretched(unit, modelisation, matter=MATTER):
    global LOADS
    model(unit, modelisation, matter)
    H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='LEFT', DX=0), _F(GROUP_MA='BASE', DY=0)))
    P = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='RIGHT', PRES=-30.0))
    LOADS = (_F(CHARGE=H), _F(CHARGE=P, FONC_MULT=RAMP))

def table_of(**keywords):
    return POST_ELEM(**keywords).EXTR_TABLE().values()
"""


class Energies(LoadTest):
    def test_the_work_of_forces_is_the_energy_of_an_elastic_body(self):
        """A sheet (2 x 1) under the tension s: s^2 / (2 E) for each unit of volume, as work, of stresses, of strains, cell by cell."""
        run = self.run_text([flat_block("QUAD8")], STRETCH + f"""
stretched(20, 'C_PLAN')
solve(*LOADS)
R[0] = CALC_CHAMP(reuse=R[0], RESULTAT=R[0], ENERGIE=('ENEL_ELGA', 'ENEL_ELEM', 'ETOT_ELGA', 'ETOT_ELEM', 'ENEL_ELNO'),
                  VARI_INTERNE='VARI_ELNO')
END = CALC_CHAMP(RESULTAT=R[0], NUME_ORDRE=2, ENERGIE='ETOT_ELGA')  # alone, of the whole path all the same
R.append(MECA_STATIQUE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=LOADS, LIST_INST=TIMES))
exact = 30.0**2 / (2 * {YOUNG}) * 2.0
for result, shift in ((R[0], 0), (R[1], 1)):
    for kind in ('ENER_ELAS', 'ENER_POT'):
        found = table_of(RESULTAT=result, **{{kind: _F(TOUT='OUI')}})
        assert abs(found['TOTALE'][-1] / exact - 1) < 1e-10 and abs(found['TOTALE'][1] / exact - 0.25) < 1e-10, found
        assert found['NUME_ORDRE'][0] == shift and found['POUR_CENT'][-1] == 100, found
    work = table_of(RESULTAT=result, TRAV_EXT=_F(TOUT='OUI'))
    assert abs(work['TRAV_ELAS'][-1] / exact - 1) < 1e-10 and abs(work['TRAV_REEL'][-1] / exact - 1) < 1e-10, work
for kind, field in (('ENER_ELAS', 'ENEL_ELGA'), ('ENER_POT', 'EPOT_ELGA')):  # a skin stores nothing: no zero without a word
    try:
        POST_ELEM(RESULTAT=R[0], **{{kind: _F(GROUP_MA=('BODY', 'RIGHT'))}})
    except AsterError as refusal:
        assert all(word in str(refusal) for word in ('POSTELEM_2', kind, 'RIGHT', field)), refusal
    else:
        assert False
""")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        result = Result(self.folder / "loads.base", "R[0]")
        for name in ("ENEL_ELGA", "ETOT_ELGA", "ENEL_ELNO"):
            self.assert_near(result.field(name, 2)[1]["TOTALE"], np.full(1, 30.0**2 / (2 * YOUNG)))
        self.assert_near(Result(self.folder / "loads.base", "END").field("ETOT_ELGA", 2)[1]["TOTALE"], np.full(1, 30.0**2 / (2 * YOUNG)))
        for name in ("ENEL_ELEM", "ETOT_ELEM"):
            self.assertAlmostEqual(result.field(name, 2)[1]["TOTALE"].sum(), 30.0**2 / YOUNG, delta=1e-10)
        self.assertEqual(np.abs(result.field("VARI_ELNO", 2)[1]["V1"]).max(), 0)


class Strains(LoadTest):
    def test_logarithmic_and_plastic_strains(self):
        """EPSL of a sheet that is stretched twofold, compressed to 0.8 and turned by 50 degrees: ln of the stretches; EPSP of a bar in tension: what flows, at
        constant volume, also beside a thermal strain."""
        run = self.run_text([flat_block("QUAD8"), flat_brick("HEXA8")], STRETCH + """
from math import cos, radians, sin
c, s = cos(radians(50)), sin(radians(50))
model(20, 'D_PLAN')
H = AFFE_CHAR_CINE_F(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BODY', DX=formula(f'{2 * c} * X - {0.8 * s} * Y - X'), DY=formula(f'{2 * s} * X + {0.8 * c} * Y - Y')))
R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=_F(CHARGE=H), INCREMENT=_F(LIST_INST=DEFI_LIST_REEL(VALE=(0., 1.))),
                       COMPORTEMENT=_F(RELATION='ELAS', DEFORMATION='GDEF_LOG')))
R[0] = CALC_CHAMP(reuse=R[0], RESULTAT=R[0], DEFORMATION=('EPSL_ELGA', 'EPSL_NOEU', 'EPMG_ELGA', 'EPSG_ELGA', 'EPSP_ELGA'))
SOFT = DEFI_MATERIAU(ELAS=_F(E=2000., NU=0.3, ALPHA=1e-3), ECRO_LINE=_F(SY=10.0, D_SIGM_EPSI=100.0))
model(21, '3D', SOFT)
WARM = CREA_CHAMP(TYPE_CHAM='NOEU_TEMP_R', OPERATION='AFFE', MAILLAGE=MESH, AFFE=_F(TOUT='OUI', NOM_CMP='TEMP', VALE=4.0))
COLD = CREA_CHAMP(TYPE_CHAM='NOEU_TEMP_R', OPERATION='AFFE', MAILLAGE=MESH, AFFE=_F(TOUT='OUI', NOM_CMP='TEMP', VALE=0.0))
HEAT = CREA_RESU(OPERATION='AFFE', TYPE_RESU='EVOL_THER', AFFE=(_F(NOM_CHAM='TEMP', CHAM_GD=COLD, INST=0.0), _F(NOM_CHAM='TEMP', CHAM_GD=WARM, INST=1.0)))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=SOFT), AFFE_VARC=_F(TOUT='OUI', NOM_VARC='TEMP', EVOL=HEAT, VALE_REF=0.0))
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='LEFT', DX=0), _F(GROUP_MA='FRONT', DY=0), _F(GROUP_MA='BASE', DZ=0)))
P = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='RIGHT', PRES=-30.0))
solve(_F(CHARGE=H), _F(CHARGE=P, FONC_MULT=RAMP), COMPORTEMENT=_F(RELATION='VMIS_ISOT_LINE'))
R[1] = CALC_CHAMP(reuse=R[1], RESULTAT=R[1], DEFORMATION=('EPSP_ELGA', 'EPSP_NOEU'))
""")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        turned, flowed = (Result(self.folder / "loads.base", f"R[{k}]") for k in range(2))
        for name in ("EPSL_ELGA", "EPSL_NOEU"):
            strain = turned.field(name, 1)[1]
            for component, exact in (("EPXX", np.log(2)), ("EPYY", np.log(0.8)), ("EPZZ", 0), ("EPXY", 0)):
                self.assertLessEqual(np.abs(strain[component] - exact).max(), 1e-10, (name, component))
        self.assert_near(turned.field("EPMG_ELGA", 1)[1]["EPXX"], turned.field("EPSG_ELGA", 1)[1]["EPXX"])
        self.assertEqual(np.abs(turned.field("EPSP_ELGA", 1)[1]["EPXX"]).max(), 0)  # nothing flows
        plastic = (30.0 - 10.0) * (1 / 100.0 - 1 / YOUNG)
        for name in ("EPSP_ELGA", "EPSP_NOEU"):
            strain = flowed.field(name, 2)[1]
            for component, exact in (("EPXX", plastic), ("EPYY", -plastic / 2), ("EPZZ", -plastic / 2), ("EPXY", 0)):
                self.assertLessEqual(np.abs(strain[component] - exact).max(), 1e-8 * plastic, (name, component))


    def test_what_has_flowed_at_large_strains_does_not_turn(self):
        """A cube stretched by l along x and 1 / sqrt(l) across while it turns by 80 degrees: the plastic strain, on the initial axes, is (p, -p/2, -p/2).
        With SIMO_MIEHE, whose p is summed up step by step, it is the logarithmic strain less that of b, bx - by = R(p) / mu."""
        hard, yields, mu = 100.0, 10.0, YOUNG / (2 * (1 + POISSON))
        cases = [("GDEF_LOG", 1.5), ("GROT_GDEP", 1.02), ("SIMO_MIEHE", 1.5)]
        text = f"""
from math import cos, radians, sin
SOFT = DEFI_MATERIAU(ELAS=_F(E={YOUNG}, NU={POISSON}), ECRO_LINE=_F(SY={yields}, D_SIGM_EPSI={hard}))
model(20, '3D', SOFT)
STEPS = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=_F(JUSQU_A=1.0, NOMBRE=8))
for law, most in {cases}:
    x, y = f"{{most}}**INST * X", f"{{most}}**(-INST / 2) * Y"
    H = AFFE_CHAR_CINE_F(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BODY', DX=formula(f"cos(radians(80 * INST)) * {{x}} - sin(radians(80 * INST)) * {{y}} - X"),
        DY=formula(f"sin(radians(80 * INST)) * {{x}} + cos(radians(80 * INST)) * {{y}} - Y"), DZ=formula(f"{{most}}**(-INST / 2) * Z - Z")))
    R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=_F(CHARGE=H), INCREMENT=_F(LIST_INST=STEPS),
                           COMPORTEMENT=_F(RELATION='VMIS_ISOT_LINE', DEFORMATION=law)))
    R[-1] = CALC_CHAMP(reuse=R[-1], RESULTAT=R[-1], DEFORMATION='EPSP_ELGA', INST=1.0)
NEAR = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=_F(CHARGE=H), INCREMENT=_F(LIST_INST=STEPS, NUME_INST_FIN=1),
                     COMPORTEMENT=_F(RELATION='VMIS_ISOT_LINE', DEFORMATION='PETIT_REAC'))
try:
    CALC_CHAMP(RESULTAT=NEAR, DEFORMATION='EPSP_ELGA')
    raise SystemExit('PETIT_REAC')
except AsterError as refusal:
    assert 'CALCCHAMP_7' in str(refusal)
"""
        run = self.run_text([flat_brick("HEXA8")], text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        for k, (law, most) in enumerate(cases):
            result = Result(self.folder / "loads.base", f"R[{k}]")
            strain, variables = result.field("EPSP_ELGA", 8)[1], result.field("VARI_ELGA", 8)[1]
            along = p = variables["V1"]
            if law == "SIMO_MIEHE":
                v = [variables[f"V{i}"] for i in range(3, 9)]
                b = np.eye(3) - 2 * np.array([[v[0], v[3], v[4]], [v[3], v[1], v[5]], [v[4], v[5], v[2]]]).transpose(2, 0, 1)
                stretches = np.linalg.eigvalsh(b)
                r = yields + hard * YOUNG / (YOUNG - hard) * p
                self.assertLessEqual(np.abs(stretches[:, 2] - stretches[:, 0] - r / mu).max(), 1e-12)
                along = np.log(most) - np.log(stretches[:, 2] / stretches[:, 0]) / 3
            for component, exact in (("EPXX", along), ("EPYY", -along / 2), ("EPZZ", -along / 2), ("EPXY", 0 * p), ("EPXZ", 0 * p)):
                self.assertLessEqual(np.abs(strain[component] - exact).max(), 1e-9 * p.max(), (law, component))


class Balance(LoadTest):
    def test_what_forces_and_supports_give_is_stored(self):
        """ENERGIE of a sheet (2 x 1) stretched by a tension, by its end that is moved, and on with reuse=; the work of supports is TRAV_LIAI."""
        run = self.run_text([flat_block("QUAD8")], STRETCH + f"""
exact = 30.0**2 / (2 * {YOUNG}) * 2.0
def works(result):
    return RECU_TABLE(CO=result, NOM_TABLE='PARA_CALC').EXTR_TABLE().values()
def near(found, *values):
    assert len(found) == len(values) and all(abs(a - b) < 1e-9 * exact for a, b in zip(found, values)), (found, values)
stretched(20, 'C_PLAN')
solve(*LOADS, ENERGIE=_F())
found = works(R[0])
near(found['INST'], 0, 0.5, 1)
near(found['TRAV_EXT'], 0, exact / 4, exact)
near(found['ENER_TOT'], 0, exact / 4, exact)
near(found['TRAV_LIAI'], 0, 0, 0)
R[0] = STAT_NON_LINE(reuse=R[0], RESULTAT=R[0], MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=LOADS, ETAT_INIT=_F(EVOL_NOLI=R[0], INST=0.5), ENERGIE=_F(),
                     INCREMENT=_F(LIST_INST=TIMES), ARCHIVAGE=_F(DETR_NUME_SUIV='OUI'), CONVERGENCE=_F(RESI_GLOB_RELA=1e-10))
found = works(R[0])
assert found['NUME_REUSE'] == [0, 0, 1, 1] and found['INST'] == [0, 0.5, 0.5, 1], found
near(found['TRAV_EXT'], 0, exact / 4, 0, exact * 3 / 4)
PULL = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='RIGHT', DX=30.0 / {YOUNG} * 2.0))
solve(LOADS[0], _F(CHARGE=PULL, FONC_MULT=RAMP), ENERGIE=_F())
found = works(R[1])
near(found['TRAV_EXT'], 0, 0, 0)
near(found['ENER_TOT'], 0, exact / 4, exact)
near(found['TRAV_LIAI'], 0, -exact / 4, -exact)
""")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])


class Masses(LoadTest):
    def test_masses_of_bricks_tubes_and_sheets(self):
        """Closed forms: a brick, also turned and about its corner; a sheet for each unit of thickness; a tube, axisymmetric, all round."""
        run = self.run_text([flat_brick("HEXA20"), flat_block("QUAD8"), flat_block("QUAD8", start=1.0)], """
from math import pi
def masses(**factor):
    table = POST_ELEM(MASS_INER=_F(**factor), MODELE=MODEL, CHAM_MATER=FIELD).EXTR_TABLE()
    assert len(table) == 1 and table.LIEU[0] == factor.get('GROUP_MA', 'TOUT')
    return {name: values[0] for name, values in table.values().items()}
def near(found, **exact):
    for name, value in exact.items():
        assert abs(found[name] - value) <= 1e-12 * (1 + abs(value)), (name, found[name], value)
def moments(mass, a, b, c):
    return mass * (b**2 + c**2) / 12, mass * (a**2 + c**2) / 12, mass * (a**2 + b**2) / 12
model(20, '3D')
x, y, z = moments(9, 2, 1, 1.5)
near(masses(TOUT='OUI', ORIG_INER=(0., 0., 0.)), MASSE=9, CDG_X=1, CDG_Y=0.5, CDG_Z=0.75, IX_G=x, IY_G=y, IZ_G=z, IXY_G=0, IXZ_G=0, IYZ_G=0,
     IX_PRIN_G=x, IY_PRIN_G=z, IZ_PRIN_G=y, X_P=0, IX_P=x + 9 * (0.5**2 + 0.75**2), IXY_P=9 * 0.5, IXZ_P=9 * 0.75, IYZ_P=9 * 0.375)
MESH = MODI_MAILLAGE(reuse=MESH, MAILLAGE=MESH, ROTATION=_F(POIN_1=(0., 0., 0.), DIR=(0., 0., 1.), ANGLE=30.))
near(masses(GROUP_MA='BODY'), MASSE=9, IX_PRIN_G=x, IY_PRIN_G=z, IZ_PRIN_G=y, IZ_G=z, IXY_G=9 / 12 * (2**2 - 1**2) * 3**0.5 / 4)
model(21, 'C_PLAN')
x, y, z = moments(6, 2, 1, 0)
near(masses(), MASSE=6, CDG_X=1, CDG_Y=0.5, CDG_Z=0, IX_G=x, IY_G=y, IZ_G=x + y, IX_PRIN_G=x, IY_PRIN_G=y, IZ_PRIN_G=x + y)
near(masses(ORIG_INER=(1., 0.)), IX_P=x + 6 * 0.25, IY_P=y, Z_P=0)
model(22, 'AXIS')
m = 3 * pi * (9 - 1)
near(masses(), MASSE=m, CDG_X=0, CDG_Y=0.5, IY_G=m * 10 / 2, IX_G=m * (10 / 4 + 1 / 12), IZ_G=m * (10 / 4 + 1 / 12), IXY_G=0)
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DY=0))
S = MECA_STATIQUE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=_F(CHARGE=H), LIST_INST=DEFI_LIST_REEL(VALE=(0., 1., 2.)))
timed = POST_ELEM(MASS_INER=_F(TOUT='OUI'), RESULTAT=S, INST=(1., 2.)).EXTR_TABLE()
assert timed.NUME_ORDRE.values() == [2, 3] and timed.INST.values() == [1, 2] and abs(timed.MASSE.values()[1] - m) < 1e-11 * m, timed.values()
assert 'INST' not in POST_ELEM(MASS_INER=_F(TOUT='OUI'), RESULTAT=S).EXTR_TABLE().para
for error, factor in (('POSTELEM_5', _F(GROUP_MA='RIGHT')), ('MESH_1', _F(GROUP_MA='NONE'))):
    try:
        POST_ELEM(MASS_INER=factor, MODELE=MODEL, CHAM_MATER=FIELD)
    except AsterError as refusal:
        assert error in str(refusal), refusal
    else:
        assert False
""")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])


class InitialState(LoadTest):
    def test_a_state_of_fields_goes_on_as_the_computation_it_came_from(self):
        """Plastic: DEPL, SIGM and VARI at half the load and on to the whole one, as in one run; elastic: stresses that balance a load
        move nothing."""
        run = self.run_text([flat_block("QUAD8")], STRETCH + f"""
SOFT = DEFI_MATERIAU(ELAS=_F(E={YOUNG}, NU={POISSON}), ECRO_LINE=_F(SY=10.0, D_SIGM_EPSI=100.0))
stretched(20, 'D_PLAN', SOFT)
solve(*LOADS, COMPORTEMENT=_F(RELATION='VMIS_ISOT_LINE'))
fields = dict((name, CREA_CHAMP(TYPE_CHAM=kind, OPERATION='EXTR', RESULTAT=R[0], NOM_CHAM=cham, INST=0.5))
              for name, kind, cham in (('DEPL', 'NOEU_DEPL_R', 'DEPL'), ('SIGM', 'ELGA_SIEF_R', 'SIEF_ELGA'), ('VARI', 'ELGA_VARI_R', 'VARI_ELGA')))
LATE = DEFI_LIST_REEL(VALE=(0.5, 1.0))
R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=LOADS, INCREMENT=_F(LIST_INST=LATE), ETAT_INIT=_F(**fields),
                       COMPORTEMENT=_F(RELATION='VMIS_ISOT_LINE'), CONVERGENCE=_F(RESI_GLOB_RELA=1e-10)))
stretched(20, 'C_PLAN')
solve(*LOADS)
whole = CREA_CHAMP(TYPE_CHAM='ELGA_SIEF_R', OPERATION='EXTR', RESULTAT=R[2], NOM_CHAM='SIEF_ELGA', INST=1.0)
STILL = (LOADS[0], dict(LOADS[1], FONC_MULT=ONE))
R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=STILL, INCREMENT=_F(LIST_INST=LATE), ETAT_INIT=_F(SIGM=whole)))
""")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        results = [Result(self.folder / "loads.base", f"R[{k}]") for k in range(4)]
        self.assert_near(self.displacement(results[1], 1, 2), self.displacement(results[0], 2, 2), 1e-8)
        scale = np.abs(self.displacement(results[2], 2, 2)).max()
        self.assertLessEqual(np.abs(self.displacement(results[3], 1, 2)).max(), 1e-10 * scale)


class Results(LoadTest):
    def test_results_out_of_fields_and_on_other_meshes(self):
        """CREA_RESU of functions of X, Y and INST, EXTR_RESU of some of it, PROJ_CHAMP onto another mesh: a quadratic field is exact."""
        run = self.run_text([flat_block("QUAD9"), flat_block("TRIA6"), flat_brick("HEXA20")], """
model(20, 'D_PLAN')
F = CREA_CHAMP(TYPE_CHAM='NOEU_TEMP_F', OPERATION='AFFE', MAILLAGE=MESH, AFFE=_F(TOUT='OUI', NOM_CMP='TEMP', VALE_F=formula('(1 + INST) * X * Y + X**2')))
R.append(CREA_RESU(OPERATION='AFFE', TYPE_RESU='EVOL_THER', AFFE=_F(NOM_CHAM='TEMP', CHAM_GD=F, INST=(0.0, 0.5, 1.0))))
R.append(EXTR_RESU(RESULTAT=R[0], ARCHIVAGE=_F(INST=(0.5, 1.0))))
OTHER = LIRE_MAILLAGE(UNITE=21)
R.append(PROJ_CHAMP(METHODE='COLLOCATION', RESULTAT=R[1], MAILLAGE_1=MESH, MAILLAGE_2=OTHER, INST=1.0))
HERE = CREA_CHAMP(TYPE_CHAM='NOEU_TEMP_R', OPERATION='EXTR', RESULTAT=R[0], NOM_CHAM='TEMP', INST=1.0)
THERE = PROJ_CHAMP(METHODE='COLLOCATION', CHAM_GD=HERE, MAILLAGE_1=MESH, MAILLAGE_2=OTHER)
points, (values, mask) = OTHER.getCoordinates().toNumpy(), THERE.toSimpleFieldOnNodes().getValues()
assert THERE.getMesh() is OTHER and mask.all() and abs(values[:, 0] - (2 * points[:, 0] * points[:, 1] + points[:, 0]**2)).max() < 1e-13
try:
    PROJ_CHAMP(CHAM_GD=F, MAILLAGE_2=OTHER)
except AsterError as refusal:
    assert 'PROJCHAMP_1' in str(refusal)
else:
    assert False
R[0] = CREA_RESU(reuse=R[0], RESULTAT=R[0], OPERATION='AFFE', TYPE_RESU='EVOL_THER', AFFE=_F(NOM_CHAM='TEMP', CHAM_GD=F, INST=2.0))
""")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        made, part, moved = (Result(self.folder / "loads.base", f"R[{k}]") for k in range(3))
        self.assertEqual((list(made.instants.values()), list(part.instants.values()), list(moved.instants.values())),
                         ([0.0, 0.5, 1.0, 2.0], [0.5, 1.0], [1.0]))
        for result, order, instant in ((made, 0, 0.0), (made, 3, 2.0), (part, 1, 0.5), (moved, 2, 1.0)):
            x, y = result.points.T
            self.assert_near(result.at_nodes("TEMP", order, "TEMP"), (1 + instant) * x * y + x**2)


if __name__ == "__main__":
    unittest.main()
