"""A bolt that cooling shortens, then pulled: springs side by side. A sector between oblique planes, and plane stress, against the models that are the same."""

import math
import unittest

import numpy as np

from load_study import StudyTest
from meshes import block, union, weld, write_med  # noqa: I001 (load_study says where it is)
from results import Result

HEAD = """
DEBUT(ERREUR=_F(ALARME='EXCEPTION'))
RAMP = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, 1))

def cut(unit):
    whole = LIRE_MAILLAGE(UNITE=unit)
    return CREA_MAILLAGE(MAILLAGE=whole, DECOUPE_LAC=_F(GROUP_MA_ESCL='SLAVE'))

def on(mesh, modelisation):
    return AFFE_MODELE(MAILLAGE=mesh, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION=modelisation))

def contact(model):
    return DEFI_CONTACT(MODELE=model, FORMULATION='CONTINUE', ALGO_RESO_GEOM='NEWTON', ALGO_RESO_CONT='NEWTON',
                        ZONE=_F(ALGO_CONT='LAC', GROUP_MA_ESCL='SLAVE', GROUP_MA_MAIT='MASTER', CONTACT_INIT='INTERPENETRE'))
"""


def lines(first, last, count):
    return np.linspace(first, last, count + 1)


def round_about(r, t):
    return r * math.cos(t), r * math.sin(t)


class JointTest(StudyTest):
    def run_text(self, text, *meshes):
        """Run HEAD and text with mesh k on unit 20 + k."""
        units = []
        for k, mesh in enumerate(meshes):
            write_med(self.folder / f"{k}.med", mesh)
            units += ["--unit", f"{20 + k}={self.folder / f'{k}.med'}"]
        (self.folder / "joint.comm").write_text(HEAD + text + "FIN()\n", encoding="utf-8")
        run = self.run_study(self.folder / "joint.comm", "--fresh", *units)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])

    def result(self, label):
        return Result(self.folder / "joint.base", label)


class Bolt(JointTest):
    """Shank and sleeve without Poisson's ratio between a fixed plane and a head that hardly gives way: two springs of stiffness E A / L."""

    SHANK, BORE, SLEEVE, LENGTH, HIGH = 6.0, 7.0, 14.0, 40.0, 8.0
    YOUNG, ALPHA, COLD = 210e3, 1.2e-5, 50.0
    INSTANTS = (1.0, 1.25, 1.5, 1.75, 2.0)  # cold at 1; then the pull grows until it is 1.5 of what parts the joint
    STIFF = 1e6  # the head's modulus over the shank's

    def stiffnesses(self):
        """Of shank and sleeve."""
        return [self.YOUNG * math.pi * area / self.LENGTH for area in (self.SHANK**2, self.SLEEVE**2 - self.BORE**2)]

    def largest_pull(self):
        shank, sleeve = self.stiffnesses()
        return 1.5 * self.preload() * (1 + shank / sleeve)

    def preload(self):
        shank, sleeve = self.stiffnesses()
        return self.ALPHA * self.COLD * self.LENGTH / (1 / shank + 1 / sleeve)

    def theory(self, pull):
        """(force of the bolt, clamping force) under a pull on the head."""
        shank, sleeve = self.stiffnesses()
        clamp = self.preload() - pull * sleeve / (shank + sleeve)
        return (clamp + pull, clamp) if clamp > 0 else (pull, 0.0)

    def figures(self):
        """Of each instant: pull, force of the bolt, clamping force."""
        shank = block("QUAD8", lines(0, self.SHANK, 2), lines(0, self.LENGTH, 8), None, "SHANK", {"left": "AXIS", "bottom": "FOOT"})
        core = block("QUAD8", lines(0, self.SHANK, 2), lines(self.LENGTH, self.LENGTH + self.HIGH, 2), None, "HEAD", {"left": "AXIS", "top": "TOP"})
        rim = block("QUAD8", lines(self.SHANK, self.SLEEVE, 4), lines(self.LENGTH, self.LENGTH + self.HIGH, 2), None, "HEAD",
                    {"bottom": "MASTER", "top": "TOP"})
        sleeve = block("QUAD8", lines(self.BORE, self.SLEEVE, 3), lines(0, self.LENGTH, 7), None, "SLEEVE", {"bottom": "BASE", "top": "SLAVE"})
        self.run_text(f"""
MESH = cut(20)
MODEL = on(MESH, 'AXIS')
STEEL = DEFI_MATERIAU(ELAS=_F(E={self.YOUNG}, NU=0.0, ALPHA={self.ALPHA}))
STIFF = DEFI_MATERIAU(ELAS=_F(E={self.STIFF * self.YOUNG}, NU=0.0))

def temperature(value):
    return CREA_CHAMP(TYPE_CHAM='NOEU_TEMP_R', OPERATION='AFFE', MAILLAGE=MESH, AFFE=_F(TOUT='OUI', NOM_CMP='TEMP', VALE=value))

COURSE = CREA_RESU(OPERATION='AFFE', TYPE_RESU='EVOL_THER', AFFE=(_F(NOM_CHAM='TEMP', CHAM_GD=temperature(20.0), INST=0.0),
                                                                  _F(NOM_CHAM='TEMP', CHAM_GD=temperature({20 - self.COLD}), INST=1.0)))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=(_F(TOUT='OUI', MATER=STEEL), _F(GROUP_MA='HEAD', MATER=STIFF)),
                      AFFE_VARC=_F(GROUP_MA='SHANK', NOM_VARC='TEMP', EVOL=COURSE, VALE_REF=20.0, PROL_DROITE='CONSTANT'))
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='AXIS', DX=0), _F(GROUP_MA=('FOOT', 'BASE'), DY=0)))
PULL = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='TOP', PRES={-self.largest_pull() / (math.pi * self.SLEEVE**2)}))
LATER = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, 0, 2, 1))
LIST = DEFI_LIST_REEL(VALE=(0.0, *{self.INSTANTS}))
R = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, CONTACT=contact(MODEL), EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PULL, FONC_MULT=LATER)),
                  INCREMENT=_F(LIST_INST=LIST), CONVERGENCE=_F(RESI_GLOB_RELA=1e-8, ITER_GLOB_MAXI=20))
R = CALC_CHAMP(reuse=R, RESULTAT=R, FORCE='REAC_NODA')
""", union([weld(union([shank, core, rim])), sleeve]))
        result = self.result("R")
        ground = np.abs(result.points[:, 1]) < 1e-9
        of_bolt = ground & (result.points[:, 0] < 0.5 * (self.SHANK + self.BORE))
        rows = []
        for order in result.orders[1:]:
            held = 2 * math.pi * result.at_nodes("REAC_NODA", order, "DY")  # forces of one radian
            rows.append((max(result.instants[order] - 1, 0) * self.largest_pull(), -held[of_bolt].sum(), held[ground & ~of_bolt].sum()))
        return rows

    def test_cooling_tightens_it_and_a_pull_is_shared_until_the_joint_parts(self):
        """The head bends by less than 100 / STIFF of what the springs give."""
        rows = self.figures()
        self.assertEqual(len(rows), len(self.INSTANTS))
        for pull, *found in rows:
            self.assertLessEqual(np.abs(np.subtract(found, self.theory(pull))).max(), 100 / self.STIFF * self.preload(), pull)


class Sector(JointTest):
    """Two rings on one another, pressed by 1 + 1.2 cos 6 t: a sector of 30 degrees, held by LIAISON_OBLIQUE, is a third of the quarter."""

    def differences(self):
        """Largest difference of (displacements, pressures) over their size."""
        def rings(parts):
            angle = parts * math.pi / 6
            sides = {"bottom": "START", "top": "END"}
            return [block("QUAD8", lines(15, 22, 3), lines(0, angle, 8 * parts), round_about, "OUT", {"left": "SLAVE", "right": "RIM", **sides}),
                    block("QUAD8", lines(10, 15, 3), lines(0, angle, 10 * parts), round_about, "IN", {"right": "MASTER", **sides})]

        of_sector, of_quarter = rings(1), rings(3)
        self.run_text("""
STEEL = DEFI_MATERIAU(ELAS=_F(E=200e3, NU=0.3))
PRESSURE = FORMULE(NOM_PARA=('X', 'Y'), VALE='200 * (1 + 1.2 * cos(6 * atan2(Y, X)))')
LIST = DEFI_LIST_REEL(VALE=(0.0, 1.0))
R = []
for unit in (20, 21):
    MESH = cut(unit)
    MODEL = on(MESH, 'D_PLAN')
    if unit == 20:
        HOLD = AFFE_CHAR_MECA(MODELE=MODEL, DDL_IMPO=_F(GROUP_MA='START', DY=0), LIAISON_OBLIQUE=_F(GROUP_MA='END', ANGL_NAUT=30.0, DY=0))
    else:
        HOLD = AFFE_CHAR_MECA(MODELE=MODEL, DDL_IMPO=(_F(GROUP_MA='START', DY=0), _F(GROUP_MA='END', DX=0)))
    PUSH = AFFE_CHAR_MECA_F(MODELE=MODEL, PRES_REP=_F(GROUP_MA='RIM', PRES=PRESSURE))
    FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=STEEL))
    R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, CONTACT=contact(MODEL), EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PUSH, FONC_MULT=RAMP)),
                           INCREMENT=_F(LIST_INST=LIST), CONVERGENCE=_F(RESI_GLOB_RELA=1e-10, ITER_GLOB_MAXI=20)))
""", union(of_sector), union(of_quarter))
        sector, quarter = self.result("R[0]"), self.result("R[1]")
        moved = [np.stack([r.at_nodes("DEPL", 1, c) for c in ("DX", "DY")], axis=1) for r in (sector, quarter)]
        # a block's nodes are numbered row by row from START
        same = [*range(len(of_sector[0].points)), *(len(of_quarter[0].points) + np.arange(len(of_sector[1].points)))]
        self.assertLessEqual(np.abs(quarter.points[same] - sector.points).max(), 1e-12)
        pressures = [r.where_present("CONT_ELEM", 1, "PRES")[:8] for r in (sector, quarter)]  # along the skin, from START
        return [np.abs(ours - theirs).max() / np.abs(theirs).max() for ours, theirs in ((moved[0], moved[1][same]), pressures)]

    def test_it_is_the_quarter(self):
        self.assertLessEqual(max(self.differences()), 1e-9)


class PlaneStress(JointTest):
    """A pin in a hole that is wider by 0.2 %: plane stress is plane strain with nu' = nu / (1 + nu), E' = E (1 + 2 nu) / (1 + nu)^2."""

    def differences(self):
        """Largest difference of (displacements, pressures) over their size."""
        pin = block("QUAD8", lines(1.5, 5.0, 3), lines(-math.pi / 2, math.pi / 2, 20), round_about, "PIN", {"right": "SLAVE", "left": "CORE", "bottom": "MIDDLE", "top": "MIDDLE"})
        plate = block("QUAD8", lines(5.01, 20.0, 5), lines(-math.pi / 2, math.pi / 2, 24), round_about, "PLATE",
                      {"left": "MASTER", "right": "RIM", "bottom": "MIDDLE", "top": "MIDDLE"})
        self.run_text("""
LIST = DEFI_LIST_REEL(VALE=(0.0, 0.5, 1.0))
MESH = cut(20)
R = []
for modelisation, young, poisson in (('C_PLAN', 210e3, 0.3), ('D_PLAN', 210e3 * 1.6 / 1.3**2, 0.3 / 1.3)):
    MODEL = on(MESH, modelisation)
    STEEL = DEFI_MATERIAU(ELAS=_F(E=young, NU=poisson))
    FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=STEEL))
    HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='MIDDLE', DX=0), _F(GROUP_MA='RIM', DX=0, DY=0)))
    PUSH = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='CORE', DY=-0.05))
    R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, CONTACT=contact(MODEL), EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PUSH, FONC_MULT=RAMP)),
                           INCREMENT=_F(LIST_INST=LIST), CONVERGENCE=_F(RESI_GLOB_RELA=1e-10, ITER_GLOB_MAXI=20)))
""", union([pin, plate]))
        stress, strain = self.result("R[0]"), self.result("R[1]")
        found = []
        for field, component in (("DEPL", "DY"), ("CONT_ELEM", "PRES")):
            ours, theirs = (r.where_present(field, 2, component) for r in (stress, strain))
            found.append(np.abs(ours - theirs).max() / np.abs(theirs).max())
        self.assertGreater(np.count_nonzero(theirs), 3, "patches in contact")
        self.assertGreater(np.count_nonzero(theirs == 0), 3, "open patches")
        return found

    def test_it_is_plane_strain_with_other_constants(self):
        self.assertLessEqual(max(self.differences()), 1e-9)


if __name__ == "__main__":
    unittest.main()
