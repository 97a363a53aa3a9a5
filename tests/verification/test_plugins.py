"""Plug-ins whose modelisations have names of their own are computed as the built-in ones: fields, loads, integrals, contact."""

import os
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import SOURCE, StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from meshes import write_med  # noqa: E402
from patch import patch_mesh  # noqa: E402
from patch_space import stack  # noqa: E402
from results import Result  # noqa: E402

#: a modelisation of one's own -> the built-in one with the same kernels, and the file of its rows
NAMES = {"SLAB": ("D_PLAN", "plane_strain"), "SHEET": ("C_PLAN", "plane_stress"), "RING": ("AXIS", "axisymmetry"), "BLOCK": ("3D", "three_d")}

HEAD = """
DEBUT(ERREUR=_F(ALARME="EXCEPTION"))
TIMES = DEFI_LIST_REEL(VALE=(0.0, 1.0))
MATTER = DEFI_MATERIAU(ELAS=_F(E=2000.0, NU=0.3, RHO=2e-3), ECRO_LINE=_F(D_SIGM_EPSI=200.0, SY=20.0))
"""

#: with {dimension}, {names}, {behaviour}; every figure that is not a field of R[k] is compared here
STUDY = HEAD + """
R, FIGURES = [], []
for name in {names}:
    MESH = LIRE_MAILLAGE(UNITE=20)
    MESH = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL="SLAVE"))
    MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION=name))
    FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", MATER=MATTER))
    H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO={held})
    G = AFFE_CHAR_MECA(MODELE=MODEL, PESANTEUR=_F(GRAVITE=9.81, DIRECTION=[0.0] * ({dimension} - 1) + [-1.0] + [0.0] * (3 - {dimension})))
    P = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA="LOAD", PRES=25.0))
    TOUCH = DEFI_CONTACT(MODELE=MODEL, FORMULATION="CONTINUE", ALGO_RESO_GEOM="NEWTON", ALGO_RESO_CONT="NEWTON",
                         ZONE=_F(GROUP_MA_ESCL="SLAVE", GROUP_MA_MAIT="MASTER", ALGO_CONT="LAC", CONTACT_INIT="OUI"))
    R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, INCREMENT=_F(LIST_INST=TIMES), CONTACT=TOUCH, COMPORTEMENT=_F({behaviour}),
                           CONVERGENCE=_F(ITER_GLOB_MAXI=40),
                           EXCIT=(_F(CHARGE=H), _F(CHARGE=G), _F(CHARGE=P, TYPE_CHARGE="SUIV"))))
    CALC_CHAMP(reuse=R[-1], RESULTAT=R[-1], DEFORMATION={strains}, CONTRAINTE="SIGM_NOEU", FORCE=("FORC_NODA", "REAC_NODA"))
    WHOLE = POST_ELEM(INTEGRALE=_F(TOUT="OUI", RESULTAT=R[-1], NOM_CHAM="SIEF_ELGA", NOM_CMP="SIYY", INST=1.0))
    FIGURES.append([WHOLE["INTE_SIYY", 1], WHOLE["VOL", 1]])
assert FIGURES[0] == FIGURES[1], FIGURES
FIN()
"""


class Named(StudyTest):
    def setUp(self):
        super().setUp()
        self.plugins = self.folder / "plugins"
        for own, (name, file) in NAMES.items():
            rows = (SOURCE / "catalog/elements" / f"{file}.toml").read_text(encoding="utf-8")
            (self.plugins / own.lower()).mkdir(parents=True)
            (self.plugins / own.lower() / "plugin.toml").write_text(rows.replace(f'"{name}"', f'"{own}"'), encoding="utf-8")

    def run_text(self, mesh, text):
        path = self.folder / "named.comm"
        path.write_text(text, encoding="utf-8")
        write_med(self.folder / "mesh.med", mesh)
        return self.run_study(path, "--unit", f"20={self.folder / 'mesh.med'}", LACON_PLUGIN_PATH=str(self.plugins))

    def compare(self, own, mesh, dimension, held, behaviour, strains):
        names = (NAMES[own][0], own)
        run = self.run_text(mesh, STUDY.format(names=names, dimension=dimension, held=held, behaviour=behaviour, strains=strains))
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        built_in, named = (Result(self.folder / "named.base", f"R[{k}]") for k in range(2))
        for field in ("DEPL", "SIEF_ELGA", "CONT_ELEM", *strains, "SIGM_NOEU", "FORC_NODA", "REAC_NODA"):
            (places, values), (own_places, own_values) = (result.field(field, 1) for result in (built_in, named))
            np.testing.assert_array_equal(own_places, places)
            for component in values:
                np.testing.assert_array_equal(own_values[component], values[component], err_msg=f"{own} {field} {component}")
        return built_in, named

    def test_fields_loads_integrals_and_contact_are_those_of_the_built_in_modelisations(self):
        flat = patch_mesh("QUAD8", "TRIA6")
        held = [{"GROUP_MA": "AXIS", "DX": 0}, {"GROUP_MA": "BASE", "DY": 0}]
        for own in ("SLAB", "SHEET", "RING"):
            for behaviour, strains in (("DEFORMATION='GREEN_LAGRANGE'", ("EPSI_ELGA", "EPSG_ELGA")), ("RELATION='VMIS_ISOT_LINE'", ("EPSI_ELGA",))):
                with self.subTest(own, behaviour=behaviour):
                    _, result = self.compare(own, flat, 2, held, behaviour, strains)
                    across = result.field("EPSI_ELGA", 1)[1]["EPZZ"]
                    self.assertEqual(bool(np.abs(across).max() > 1e-4), own != "SLAB")
        with self.subTest("BLOCK"):
            mesh, _ = stack("TETRA4", "QUAD4", normal=(0.0, 0.0, 1.0))
            held = [{"GROUP_MA": "BASE", "DX": 0, "DY": 0, "DZ": 0}, {"GROUP_MA": "LOAD", "DX": 0, "DY": 0}]
            self.compare("BLOCK", mesh, 3, held, "DEFORMATION='GREEN_LAGRANGE'", ("EPSI_ELGA", "EPSG_ELGA"))

    def refused(self, own, command, identifier):
        run = self.run_text(patch_mesh("QUAD4", "TRIA3"), HEAD + f"""
MESH = LIRE_MAILLAGE(UNITE=20)
MESH = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL="SLAVE"))
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=(_F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION="SLAB"),
                                         _F(GROUP_MA=("UPPER", "SLAVE"), PHENOMENE="MECANIQUE", MODELISATION="{own}")))
{command}
FIN()
""")
        self.assertEqual(run.status, 2, run.stdout[-3000:] + run.stderr[-3000:])
        self.assertIn(f"<{identifier}>", run.stderr)

    def test_what_has_no_meaning_around_an_axis_is_refused_whatever_its_name(self):
        self.refused("RING", "G = AFFE_CHAR_MECA(MODELE=MODEL, PESANTEUR=_F(GRAVITE=9.81, DIRECTION=(-1, 0, 0), GROUP_MA='UPPER'))", "CHARGE_10")
        self.refused("RING", "S = AFFE_CHAR_MECA(MODELE=MODEL, LIAISON_SOLIDE=_F(GROUP_MA='SLAVE'))", "CHARGE_14")
        self.refused("RING", """C = DEFI_CONTACT(MODELE=MODEL, FORMULATION="CONTINUE", ALGO_RESO_GEOM="NEWTON", ALGO_RESO_CONT="NEWTON",
                             ZONE=_F(GROUP_MA_ESCL="SLAVE", GROUP_MA_MAIT="MASTER", ALGO_CONT="LAC", CONTACT_INIT="OUI"))""", "LAC_6")

    def test_a_law_whose_hardening_does_not_know_the_temperature_is_refused_where_e_follows_it(self):
        """A kernel that takes ECRO_LINE by its curve alone has the slope of E at VALE_REF; VMIS_ISOT_LINE itself takes D_SIGM_EPSI as well."""
        (self.plugins / "rigid").mkdir()
        (self.plugins / "rigid" / "plugin.toml").write_text("""
[[relation]]
name = "RIGID_LINE"
hardening = "ECRO_LINE"
starts_elastically = true
help = "linear hardening by its curve"

[[law]]
relation = "RIGID_LINE"
deformation = "PETIT"
kernels = { D_PLAN = "solid/plane_strain_small_von_mises" }
""", encoding="utf-8")
        run = self.run_text(patch_mesh("QUAD4", "TRIA3"), HEAD + """
MESH = LIRE_MAILLAGE(UNITE=20)
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(GROUP_MA="UPPER", PHENOMENE="MECANIQUE", MODELISATION="D_PLAN"))
H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA="UPPER", DX=0, DY=0))
E = DEFI_FONCTION(NOM_PARA="INST", VALE=(0, 2000.0, 1, 1000.0))
LINE = _F(D_SIGM_EPSI=200.0, SY=20.0)
def said(law, **elastic):
    matter = DEFI_MATERIAU(ECRO_LINE=LINE, **elastic)
    field = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", MATER=matter))
    try:
        STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=field, INCREMENT=_F(LIST_INST=TIMES), COMPORTEMENT=_F(RELATION=law), EXCIT=_F(CHARGE=H))
    except AsterError as error:
        return error.id_message
follows = dict(ELAS_FO=_F(E=E, NU=DEFI_CONSTANTE(VALE=0.3)))
found = [said("RIGID_LINE", ELAS=_F(E=2000.0, NU=0.3)), said("RIGID_LINE", **follows), said("VMIS_ISOT_LINE", **follows)]
assert found == [None, "BEHAVIOUR_5", None], found
FIN()
""")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])


if __name__ == "__main__":
    unittest.main()
