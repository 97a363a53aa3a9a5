"""ETAT_INIT: a computation that starts from another one goes on as if there had been no stop."""

import json
import os
import pathlib
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from load_study import LoadTest  # noqa: E402
from meshes import block, union, write_med  # noqa: E402

COMM = pathlib.Path(__file__).resolve().parent / "initial_state.comm"
BEHAVIOURS = ({"RELATION": "ELAS", "DEFORMATION": "PETIT"}, {"RELATION": "ELAS", "DEFORMATION": "GREEN_LAGRANGE"},
              {"RELATION": "VMIS_ISOT_LINE", "DEFORMATION": "PETIT"}, {"RELATION": "VMIS_ISOT_LINE", "DEFORMATION": "PETIT_REAC"})


class InitialState(StudyTest):
    def setUp(self):
        super().setUp()

        def place(bottom, width, shift=0.0):
            return lambda s, t: (shift + width * s, bottom + 50.0 * t)

        upper = block("QUAD8", np.linspace(0, 1, 6), np.linspace(0, 1, 4), place(0.0, 50.0), "UPPER",
                      {"bottom": "SLAVE", "top": "LOAD", "left": "AXIS"})
        lower = block("QUAD8", np.linspace(0, 1, 5), np.linspace(0, 1, 4), place(-50.0, 70.0), "LOWER",
                      {"top": "MASTER", "bottom": "BASE", "left": "AXIS"})
        write_med(self.folder / "blocks.med", union([upper, lower]))

    def solve(self, behaviour, **environment):
        return self.run_study(COMM, "--fresh", "--unit", f"20={self.folder / 'blocks.med'}", STATE_BEHAVIOUR=json.dumps(behaviour),
                              **environment)

    def results(self):
        """label -> (instants, field -> values at each instant)"""
        base, found = self.folder / "initial_state.base", {}
        for path in base.glob("result_*/index.h5"):
            with h5py.File(path) as index:
                fields = {}
                for name, group in index["fields"].items():
                    fields[name] = [h5py.File(base / file)["values"][()] for file in group["file"].asstr()]
                parameters = {name: values[()] for name, values in index["parameters"].items()}
                found[index.attrs["label"]] = index["instant"][()].tolist(), fields, parameters
        return found

    def test_the_stop_leaves_no_trace(self):
        for behaviour in BEHAVIOURS:
            with self.subTest(**behaviour):
                run = self.solve(behaviour)
                self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
                found = self.results()
                whole = found["WHOLE"][1]
                self.assertGreater(abs(whole["DEPL"][4] - whole["DEPL"][1]).max(), 0.01)
                for label, instants in (("SECOND", [2, 3, 4]), ("THIRD", [2, 3, 4]), ("FIRST", [0, 1, 2, 3, 4])):
                    times, fields, parameters = found[label]
                    self.assertEqual(times, instants)
                    self.assertEqual(set(fields), set(whole))
                    for name, values in fields.items():
                        scale = max(abs(v).max() for v in whole[name])
                        for got, expected in zip(values, whole[name][-len(instants):], strict=True):
                            np.testing.assert_allclose(got, expected, rtol=0, atol=1e-9 * scale, err_msg=f"{label} {name}")
                    for name, values in parameters.items():
                        self.assertEqual(len(values), len(instants), name)

    def test_what_cannot_go_on(self):
        elastic = BEHAVIOURS[0]
        for second, text in (("dict(CHAM_MATER=OTHER)", "EVOLUTION_10"),
                             ("dict(INCREMENT=_F(LIST_INST=TIMES, INST_FIN=2.0))", "EVOLUTION_5"),
                             ("dict(ETAT_INIT=_F(EVOL_NOLI=FIRST, INST=2.5))", "FIELDS_2"),
                             ("dict(reuse=FIRST, CHAM_MATER=OTHER)", "EVOLUTION_12"),
                             ("dict(reuse=WHOLE, ETAT_INIT=_F(EVOL_NOLI=WHOLE, INST=2.0))", "DETR_NUME_SUIV"),
                             ("dict(reuse=WHOLE)", "ETAT_INIT=_F(EVOL_NOLI=WHOLE)"),
                             ("dict(RESULTAT=FIRST)", "without reuse"),
                             ("dict(ETAT_INIT=_F(SIGM=CREA_CHAMP(OPERATION='AFFE', TYPE_CHAM='ELGA_SIEF_R', MODELE=MODEL, PROL_ZERO='OUI',"
                              " AFFE=_F(TOUT='OUI', NOM_CMP='SIYY', VALE=-10.0))))", "SIXX is missing of SIXX, SIYY"),
                             *((f"dict(ETAT_INIT=_F({keyword}=CREA_CHAMP(OPERATION='EXTR', RESULTAT=CALC_CHAMP(reuse=FIRST, RESULTAT=FIRST,"
                                f" CONTRAINTE='SIEF_ELNO'), NOM_CHAM='{name}', TYPE_CHAM='{kind}', INST=2.0)))", "FIELDS_6")
                               for keyword, name, kind in (("DEPL", "SIEF_ELGA", "ELGA_SIEF_R"), ("SIGM", "SIEF_ELNO", "ELNO_SIEF_R"),
                                                           ("VARI", "SIEF_ELGA", "ELGA_SIEF_R")))):
            with self.subTest(second):
                run = self.solve(elastic, STATE_SECOND=second)
                self.assertEqual(run.status, 2, run.stdout[-3000:] + run.stderr[-3000:])
                self.assertIn(text, run.stderr)

    def test_internal_variables_that_were_not_kept_are_not_taken_for_zero(self):
        """With PETIT_REAC, whose law adds to the stress before, nothing else would notice."""
        second = "dict(ETAT_INIT=_F(EVOL_NOLI=EXTR_RESU(RESULTAT=FIRST, ARCHIVAGE=_F(INST=2.0, CHAM_EXCLU='VARI_ELGA'))))"
        for behaviour in BEHAVIOURS:
            if "VMIS" in str(behaviour):
                with self.subTest(behaviour):
                    run = self.solve(behaviour, STATE_SECOND=second)
                    self.assertEqual(run.status, 2, run.stdout[-3000:] + run.stderr[-3000:])
                    self.assertIn("has no field VARI_ELGA", run.stderr)

    def test_another_instant_and_a_law_that_remembers_from_now_on(self):
        second = ("dict(ETAT_INIT=_F(EVOL_NOLI=FIRST, NUME_ORDRE=0, INST_ETAT_INIT=2.5), COMPORTEMENT=_F(RELATION='VMIS_ISOT_LINE'),"
                  " INCREMENT=_F(LIST_INST=TIMES, INST_FIN=3.0))")
        run = self.solve(BEHAVIOURS[0], STATE_SECOND=second)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        self.assertIn("EVOLUTION_13", run.stderr)
        times, fields, _ = self.results()["SECOND"]
        self.assertEqual(times, [2.5, 3])
        self.assertGreater(fields["VARI_ELGA"][1].max(), 1e-3)

    def test_instants_behind_are_removed_where_this_is_asked_for(self):
        second = ("dict(reuse=WHOLE, ETAT_INIT=_F(EVOL_NOLI=WHOLE, INST=2.0), ARCHIVAGE=_F(DETR_NUME_SUIV='OUI'),"
                  " INCREMENT=_F(LIST_INST=DEFI_LIST_REEL(VALE=[2.5, 3.0])))")
        run = self.solve(BEHAVIOURS[0], STATE_SECOND=second, STATE_OBSERVED="{'WHOLE': [(0, 1.0), (0, 2.0), (1, 2.5), (1, 3.0)]}")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        self.assertEqual(self.results()["WHOLE"][0], [0, 1, 2, 2.5, 3])


class ResidualStresses(LoadTest):
    def test_a_bent_bar_that_lies_free_is_in_equilibrium(self):
        """A bar is bent plastically and released, on supports that hold it and no more; its residual stresses and internal variables are the
        beginning of another computation. No force acts there, no support has a reaction: what is left is their round-off."""
        mesh = block("QUAD8", np.linspace(0, 10, 21), np.linspace(0, 1, 5), None, "BAR", {"top": "TOP"})
        for name, x in (("FIRST", 0), ("LAST", 10)):
            mesh.node_groups[name] = mesh.nodes_where(lambda at, y, x=x: abs(at - x) + abs(y - 0.5) < 1e-9)
        behaviour = "COMPORTEMENT=_F(RELATION='VMIS_ISOT_LINE')"
        bent, free = self.solved([mesh], f"""
model(20, 'D_PLAN', DEFI_MATERIAU(ELAS=_F(E=2e5, NU=0.3), ECRO_LINE=_F(SY=400.0, D_SIGM_EPSI=2000.0)))
HOLD = _F(CHARGE=AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_NO='FIRST', DX=0, DY=0), _F(GROUP_NO='LAST', DY=0))))
COURSE = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 0.5, 1, 1, 0))
PUSH = _F(CHARGE=AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='TOP', PRES=9.5)), FONC_MULT=COURSE)
TIMES = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=_F(JUSQU_A=1.0, NOMBRE=10))
solve(HOLD, PUSH, {behaviour})
S, V = (CREA_CHAMP(TYPE_CHAM=f'ELGA_{{kind}}_R', OPERATION='EXTR', RESULTAT=R[0], NOM_CHAM=f'{{kind}}_ELGA', INST=1.0) for kind in ('SIEF', 'VARI'))
TIMES = DEFI_LIST_REEL(VALE=(0, 1, 2))
solve(HOLD, ETAT_INIT=_F(SIGM=S, VARI=V), {behaviour})
""")
        given, found = (result.field("SIEF_ELGA", order)[1] for result, order in ((bent, 10), (free, 2)))
        for name, values in given.items():
            self.assert_near(found[name], values, 1e-9)
        self.assertGreater(max(np.abs(values).max() for values in given.values()), 50.0)
        self.assertLessEqual(np.abs(self.displacement(free, 2, 2)).max(), 1e-9)


if __name__ == "__main__":
    import unittest

    unittest.main()
