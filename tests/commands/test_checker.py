"""Keywords are checked before anything runs: every class of mistake, and a property over the whole catalogue."""

import os
import pathlib
import re
import sys
import tempfile
import unittest
import unittest.mock

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import STUDY, LauncherTest  # noqa: E402

from lacon.core import catalog, checker, concepts, plugins  # noqa: E402
from lacon.core.messages import AsterError  # noqa: E402
from lacon.core.nearest import nearest  # noqa: E402
from lacon.objects.kinds import kinds  # noqa: E402


class FakeBase:
    pass


def concept(kind):
    return kinds[kind](FakeBase(), f"{kind}_1", kind.upper())


def problems(command, **keywords):
    """[(identifier, path, text)]"""
    found = checker.complete(command, catalog.command(command), keywords, "study.comm:7")[1]
    return [(m.id, m.where.partition(",")[0], m.text) for m in found]


def complete(command, **keywords):
    made, found, _ = checker.complete(command, catalog.command(command), keywords)
    assert not found, found
    return made


class Mistakes(unittest.TestCase):
    def one(self, identifier, path, *words, command, **keywords):
        found = problems(command, **keywords)
        self.assertEqual([(i, p) for i, p, _ in found], [(identifier, path)], found)
        for word in words:
            self.assertIn(word, found[0][2])

    def contact(self, **zone):
        return {"MODELE": concept("model"), "FORMULATION": "CONTINUE", "ALGO_RESO_GEOM": "NEWTON",
                "ZONE": {"GROUP_MA_MAIT": "A", "GROUP_MA_ESCL": "B", "ALGO_CONT": "LAC", **zone}}

    def test_unknown_keyword_names_the_nearest(self):
        self.one("KEYWORD_1", "LIRE_MAILLAGE/UNITEE", "nearest one is UNITE", command="LIRE_MAILLAGE", UNITEE=20)

    def test_a_keyword_of_another_level_is_named_with_its_place(self):
        """In earlier versions of code_aster METHODE was within DEFI_LIST."""
        self.one("KEYWORD_1", "DEFI_LIST_INST/DEFI_LIST/METHODE", "DEFI_LIST_INST/METHODE is there", command="DEFI_LIST_INST",
                 DEFI_LIST={"LIST_INST": concept("list_of_reals"), "METHODE": "AUTO"})

    def test_integers_beyond_64_bits(self):
        for command, keywords in (("LIRE_MAILLAGE", {"UNITE": 10**400}), ("DEFI_CONSTANTE", {"VALE": 10**400}), ("DEFI_CONSTANTE", {"VALE": -10**400})):
            self.assertEqual(len(problems(command, **keywords)), 1, command)
        for number, bound in ((10**30, "at most 99"), (-10**30, "at least 1")):  # it is an integer
            self.one("KEYWORD_15", "LIRE_MAILLAGE/UNITE", bound, command="LIRE_MAILLAGE", UNITE=number)
        for number, bound in ((2**63, "at most 9.223372037e+18"), (-2**63 - 1, "at least -9.223372037e+18")):
            self.one("KEYWORD_15", "DEFI_LIST_ENTI/DEBUT", bound, command="DEFI_LIST_ENTI", DEBUT=number, INTERVALLE={"JUSQU_A": 3, "PAS": 1})

    def test_bounds_speak_the_language_of_the_user(self):
        """In French they were half English."""
        with unittest.mock.patch.dict(os.environ, LC_ALL="fr_FR.UTF-8"):
            self.one("KEYWORD_15", "LIRE_MAILLAGE/UNITE", "au plus 99", command="LIRE_MAILLAGE", UNITE=10**30)
            self.one("KEYWORD_15", "LIRE_MAILLAGE/UNITE", "au moins 1", command="LIRE_MAILLAGE", UNITE=-1)

    def test_a_margin_of_memory_that_no_machine_has(self):
        """10**9 percent were a factor that MUMPS had no memory for."""
        study = {"MODELE": concept("model"), "CHAM_MATER": concept("material_field"), "EXCIT": {"CHARGE": concept("load")},
                 "INCREMENT": {"LIST_INST": concept("list_of_reals")}}
        for value, wrong in ((10**30, True), (10**9, True), (10001, True), (10000, False)):
            found = problems("STAT_NON_LINE", **study, SOLVEUR={"PCENT_PIVOT": value})
            self.assertEqual([(i, p) for i, p, _ in found], [("KEYWORD_15", "STAT_NON_LINE/SOLVEUR/PCENT_PIVOT")] * wrong, found)
            self.assertEqual("at most 10000" in str(found), wrong)

    def test_counts_beyond_32_bits(self):
        """Operators count in them: 2**31 iterations were -2147483648."""
        study = {"MODELE": concept("model"), "CHAM_MATER": concept("material_field"), "EXCIT": {"CHARGE": concept("load")},
                 "INCREMENT": {"LIST_INST": concept("list_of_reals")}}
        for value, wrong in ((2**31, True), (2**32 + 1, True), (2**31 - 1, False)):
            found = problems("STAT_NON_LINE", **study, CONVERGENCE={"ITER_GLOB_MAXI": value})
            self.assertEqual([(i, p) for i, p, _ in found], [("KEYWORD_15", "STAT_NON_LINE/CONVERGENCE/ITER_GLOB_MAXI")] * wrong, found)
            self.assertEqual("at most 2147483647" in str(found), wrong)
        self.one("KEYWORD_15", "DEFI_LIST_INST/ECHEC[1]/SUBD_NIVEAU", command="DEFI_LIST_INST", DEFI_LIST={"LIST_INST": concept("list_of_reals")},
                 ECHEC={"SUBD_NIVEAU": 2**33})

    def test_texts_that_no_file_gives_back(self):
        """HDF5 ends a text at a zero, so that a group A\\0B was one named A; half a character cannot be written."""
        for text in ("A\0B", "A\ud800"):
            self.one("KEYWORD_3", "AFFE_MATERIAU/AFFE[1]/GROUP_MA", "name of a group of cells", command="AFFE_MATERIAU", MAILLAGE=concept("mesh"),
                     AFFE={"GROUP_MA": text, "MATER": concept("material")})
            self.one("KEYWORD_3", "CREA_TABLE/TITRE", "a text", command="CREA_TABLE", TITRE=text, LISTE={"PARA": "A", "LISTE_R": 1.0})

    def test_unknown_keyword_in_an_occurrence(self):
        self.one("KEYWORD_1", "DEFI_CONTACT/ZONE[1]/CONTACT_INI", "CONTACT_INIT", command="DEFI_CONTACT", **self.contact(CONTACT_INI="OUI"))

    def test_a_keyword_that_only_code_aster_has(self):
        self.one("KEYWORD_11", "DEFI_CONTACT/ZONE[1]/COEF_CONT", "not available", command="DEFI_CONTACT", **self.contact(COEF_CONT=1.0))

    def test_a_keyword_that_only_code_aster_has_is_not_missed_as_well(self):
        self.one("KEYWORD_11", "MODI_MAILLAGE/ORIE_LIGNE", "not available", command="MODI_MAILLAGE", MAILLAGE=concept("mesh"),
                 ORIE_LIGNE={"GROUP_MA": "A"})

    def test_names_of_earlier_versions(self):
        mesh = concept("mesh")
        for old, body in (("ORIE_PEAU_2D", "GROUP_MA_SURF"), ("ORIE_PEAU_3D", "GROUP_MA_VOLU")):
            self.assertEqual(complete("MODI_MAILLAGE", MAILLAGE=mesh, **{old: {"GROUP_MA": ("A", "B"), body: "C"}}),
                             complete("MODI_MAILLAGE", MAILLAGE=mesh, ORIE_PEAU={"GROUP_MA_PEAU": ("A", "B"), "GROUP_MA_INTERNE": "C"}))
        self.one("KEYWORD_6", "MODI_MAILLAGE", "ORIE_PEAU_2D, ORIE_PEAU", command="MODI_MAILLAGE", MAILLAGE=mesh,
                 ORIE_PEAU_2D={"GROUP_MA": "A"}, ORIE_PEAU={"GROUP_MA_PEAU": "B"})

    def test_the_look_of_a_listing_is_taken_and_changes_nothing(self):
        complete("IMPR_RESU", FORMAT="RESULTAT", RESU={"RESULTAT": concept("result"), "FORM_TABL": "OUI", "FORMAT_R": "1PE12.5"})
        complete("IMPR_RESU", MODELE=concept("model"), RESU={"MAILLAGE": concept("mesh")})

    def test_a_line_of_nodes_has_its_ends(self):
        line = {"OPTION": "SEGM_DROI_ORDO", "NOM": "A", "PRECISION": 1e-6, "GROUP_MA": "B", "NOEUD_ORIG": "N1", "GROUP_NO_EXTR": "C"}
        complete("DEFI_GROUP", MAILLAGE=concept("mesh"), CREA_GROUP_NO=line)
        for left_out, missed in (("NOEUD_ORIG", "NOEUD_ORIG"), ("GROUP_NO_EXTR", "NOEUD_EXTR"), ("GROUP_MA", "GROUP_NO")):
            self.one("KEYWORD_2", f"DEFI_GROUP/CREA_GROUP_NO[1]/{missed}", command="DEFI_GROUP", MAILLAGE=concept("mesh"),
                     CREA_GROUP_NO={k: v for k, v in line.items() if k != left_out})
        self.one("KEYWORD_10", "DEFI_GROUP/CREA_GROUP_NO[1]/GROUP_MA", command="DEFI_GROUP", MAILLAGE=concept("mesh"),
                 CREA_GROUP_NO={"OPTION": "PLAN", "NOM": "A", "PRECISION": 1e-6, "POINT": (0.0, 0.0), "VECT_NORMALE": (0.0, 1.0), "GROUP_MA": "B"})

    def test_a_value_that_only_code_aster_has(self):
        self.one("KEYWORD_13", "LIRE_MAILLAGE/FORMAT", "IDEAS", command="LIRE_MAILLAGE", FORMAT="IDEAS")

    def test_what_to_use_instead(self):
        for kind, path, text in (("keyword", "DEFI_CONTACT/ZONE[2]/COEF_CONT", "leave it out: "),  # by its path
                                 ("keyword", "AFFE_CHAR_MECA/PRES_REP[1]/MAILLE", "use GROUP_MA: "),  # by its name
                                 ("value", "DEFI_CONTACT/FORMULATION=DISCRETE", "use FORMULATION='CONTINUE'"),
                                 ("keyword", "MECA_NON_LINE/PILOTAGE", "use displacements imposed"),  # of the command that it is like
                                 ("keyword", "DEFI_CONTACT/ZONE[1]/PENE_MAXI", "no idea")):
            self.assertTrue(catalog.instead(kind, path, "no idea").startswith(text), path)
        (found,) = checker.complete("LIRE_MAILLAGE", catalog.command("LIRE_MAILLAGE"), {"FORMAT": "IDEAS"})[1]
        self.assertTrue(found.do.startswith("use a MED or gmsh file"), found)

    def test_a_command_under_two_names(self):
        one, other = map(catalog.command, ("STAT_NON_LINE", "MECA_NON_LINE"))
        self.assertEqual({**one, "help": "", "like": "STAT_NON_LINE"}, {**other, "help": ""})

    def test_a_number_or_a_function(self):
        for value in (0.5, 1, concept("function"), concept("formula")):
            complete("DEFI_CONTACT", **self.contact(DIST_ESCL=value))
        self.one("KEYWORD_3", "DEFI_CONTACT/ZONE[1]/DIST_ESCL", "a number or a function or a formula", command="DEFI_CONTACT",
                 **self.contact(DIST_ESCL="much"))

    def test_every_replacement_is_of_something_refused(self):
        refused, values = set(), set()

        def visit(path, row):
            for name in row.get("elsewhere", ()):
                values.add(f"{path}={name}")
                refused.update((f"{path}/{name}", str(name)))
            for name, keyword in row.get("keyword", {}).items():
                visit(f"{path}/{name}", keyword)

        for name in catalog.command_names():
            visit(name, catalog.command(name))
        rows = catalog._instead()
        self.assertEqual(set(rows["command"]) - catalog.peer_commands(), set())
        self.assertEqual(set(rows["keyword"]) - refused, set())
        self.assertEqual(set(rows["value"]) - values, set())

    def test_a_default_that_only_code_aster_has(self):
        keywords = self.contact()
        del keywords["FORMULATION"]
        self.one("KEYWORD_13", "DEFI_CONTACT/FORMULATION", "DISCRETE", command="DEFI_CONTACT", **keywords)

    def test_missing(self):
        self.one("KEYWORD_2", "CREA_MAILLAGE/DECOUPE_LAC/GROUP_MA_ESCL", "missing", command="CREA_MAILLAGE", MAILLAGE=concept("mesh"), DECOUPE_LAC={})

    def test_none_is_not_given(self):
        self.assertEqual(problems("LIRE_MAILLAGE", UNITE=None), [])
        self.assertEqual(complete("LIRE_MAILLAGE", UNITE=None)["UNITE"], 20)

    def test_wrong_types(self):
        for value in ("20", 20.0, True, [], [20, 21], concept("mesh")):
            found = problems("LIRE_MAILLAGE", UNITE=value)
            self.assertEqual(len(found), 1, value)
            self.assertIn(found[0][0], ("KEYWORD_3", "KEYWORD_5"))
        self.one("KEYWORD_3", "DEFI_MATERIAU/ELAS/E", "a number", "'hard'", command="DEFI_MATERIAU", ELAS={"E": "hard", "NU": 0.3})
        self.one("KEYWORD_3", "DEFI_MATERIAU/ELAS/E", "nan", command="DEFI_MATERIAU", ELAS={"E": float("nan"), "NU": 0.3})

    def test_concept_of_the_wrong_type(self):
        self.one("KEYWORD_3", "AFFE_CHAR_CINE/MODELE", "a model", "MESH (a mesh)", command="AFFE_CHAR_CINE", MODELE=concept("mesh"),
                 MECA_IMPO={"GROUP_MA": "A", "DX": 0})

    def test_a_name_that_no_command_filled(self):
        self.one("KEYWORD_3", "CREA_MAILLAGE/MAILLAGE", "'later'", command="CREA_MAILLAGE", MAILLAGE=concepts.CO("later"),
                 LINE_QUAD={"TOUT": "OUI"})

    def test_value_outside_the_allowed_set_names_the_nearest(self):
        self.one("KEYWORD_4", "DEFI_CONTACT/ZONE[1]/CONTACT_INIT", "'INTERPENETR'", "nearest one is INTERPENETRE", command="DEFI_CONTACT",
                 **self.contact(CONTACT_INIT="INTERPENETR"))

    def test_modelisations_come_from_the_element_catalogue(self):
        affe = {"TOUT": "OUI", "PHENOMENE": "MECANIQUE", "MODELISATION": "D_PLANE"}
        self.one("KEYWORD_4", "AFFE_MODELE/AFFE[1]/MODELISATION", "nearest one is D_PLAN", command="AFFE_MODELE", MAILLAGE=concept("mesh"), AFFE=affe)
        self.one("KEYWORD_13", "AFFE_MODELE/AFFE[1]/MODELISATION", command="AFFE_MODELE", MAILLAGE=concept("mesh"),
                 AFFE={**affe, "MODELISATION": "COQUE_3D"})

    def test_modelisations_of_plug_ins(self):
        affe = {"TOUT": "OUI", "PHENOMENE": "MECANIQUE", "MODELISATION": "MY_MODEL"}
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "mine").mkdir()
            rows = pathlib.Path(folder) / "mine" / "plugin.toml"
            rows.write_text('[[element]]\nmodelisation = "MY_MODEL"\n')
            for path in (folder, f"{folder}/mine"):
                with unittest.mock.patch.dict(os.environ, LACON_PLUGIN_PATH=f":{path}"):
                    plugins.brought.cache_clear()
                    self.assertEqual(problems("AFFE_MODELE", MAILLAGE=concept("mesh"), AFFE=affe), [])
                    self.assertEqual(problems("AFFE_MODELE", MAILLAGE=concept("mesh"), AFFE={**affe, "MODELISATION": "D_PLAN"}), [])
            rows.write_text("[[element]\n")
            with unittest.mock.patch.dict(os.environ, LACON_PLUGIN_PATH=folder):
                plugins.brought.cache_clear()
                catalog.toml.cache_clear()
                with self.assertRaisesRegex(AsterError, "PLUGIN_1.*plugin.toml"):
                    problems("AFFE_MODELE", MAILLAGE=concept("mesh"), AFFE=affe)
        plugins.brought.cache_clear()
        self.assertEqual(problems("AFFE_MODELE", MAILLAGE=concept("mesh"), AFFE=affe)[0][0], "KEYWORD_4")

    def test_laws_and_material_keywords_of_plug_ins(self):
        law = """[[relation]]
name = "MY_LAW"
[[deformation]]
name = "MY_STRAIN"
[material.MINE]
type = "factor"
help = "my law"
[material.MINE.keyword]
YC = { type = "real", default = 1.0, above = 0.0, help = "energy" }
"""
        elastic = {"E": 1, "NU": 0.3}
        solve = {"MODELE": concept("model"), "CHAM_MATER": concept("material_field"), "INCREMENT": {"LIST_INST": concept("list_of_reals")}}

        def behaviour(**given):
            return [p for p in problems("STAT_NON_LINE", **solve, COMPORTEMENT=given) if "COMPORTEMENT" in p[1]]

        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.dict(os.environ, LACON_PLUGIN_PATH=folder):
            rows = pathlib.Path(folder) / "plugin.toml"
            self.addCleanup(plugins.brought.cache_clear)

            def write(text):
                rows.write_text(text)
                plugins.brought.cache_clear()
                catalog.toml.cache_clear()

            write(law)
            row = plugins.command("DEFI_MATERIAU")
            keywords, found, _ = checker.complete("DEFI_MATERIAU", row, {"ELAS": elastic, "MINE": {}})
            self.assertEqual((found, keywords["MINE"][0]["YC"]), ([], 1.0))
            self.assertEqual(checker.complete("DEFI_MATERIAU", row, {"ELAS": elastic, "MINE": {"YC": -1.0}})[1][0].id, "KEYWORD_15")
            self.assertNotIn("MINE", catalog.command("DEFI_MATERIAU")["keyword"])
            self.assertEqual(behaviour(RELATION="MY_LAW", DEFORMATION="MY_STRAIN"), [])
            self.assertEqual(behaviour(RELATION="ELAS", DEFORMATION="PETIT"), [])
            self.assertEqual([p[0] for p in behaviour(RELATION="HIS_LAW", DEFORMATION="HIS_STRAIN")], ["KEYWORD_4"] * 2)
            for wrong, reason in ((law.replace("MINE", "ELAS"), "another keyword"), (law.replace('help = "my law"\n', ""), "lacks"),
                                  (law.replace('type = "real"', 'kind = "real"'), "material MINE/YC")):
                write(wrong)
                with self.assertRaisesRegex(AsterError, f"PLUGIN_2.*plugin.toml.*{reason}"):
                    plugins.command("DEFI_MATERIAU")

    def test_out_of_range(self):
        self.one("KEYWORD_15", "DEFI_MATERIAU/ELAS/NU", "less than 0.5", command="DEFI_MATERIAU", ELAS={"E": 1, "NU": 0.5})
        self.one("KEYWORD_15", "DEFI_MATERIAU/ELAS/E", "greater than 0", command="DEFI_MATERIAU", ELAS={"E": 0, "NU": 0.3})
        for number, words in ((1e300, "at most 1e+100"), (1e-300, "at least 1e-100"), (float("-inf"), None)):
            identifier = "KEYWORD_15" if words else "KEYWORD_3"
            self.one(identifier, "DEFI_MATERIAU/ELAS/E", *([words] if words else ()), command="DEFI_MATERIAU", ELAS={"E": number, "NU": 0.3})
        self.one("KEYWORD_15", "MODI_MAILLAGE/TRANSLATION", "at least -1e+100", command="MODI_MAILLAGE", MAILLAGE=concept("mesh"), TRANSLATION=(-1e101, 0.0))
        self.one("KEYWORD_15", "LIRE_MAILLAGE/UNITE", "at most 99", command="LIRE_MAILLAGE", UNITE=100)

    def test_exclusive(self):
        self.one("KEYWORD_6", "CREA_MAILLAGE", "DECOUPE_LAC, LINE_QUAD", command="CREA_MAILLAGE", MAILLAGE=concept("mesh"),
                 DECOUPE_LAC={"GROUP_MA_ESCL": "A"}, LINE_QUAD={"TOUT": "OUI"})

    def test_none_of_those_that_are_needed(self):
        self.one("KEYWORD_7", "CREA_MAILLAGE", "LINE_QUAD", command="CREA_MAILLAGE", MAILLAGE=concept("mesh"))
        self.one("KEYWORD_8", "AFFE_CHAR_CINE/MECA_IMPO[2]", "DX, DY, DZ", command="AFFE_CHAR_CINE", MODELE=concept("model"),
                 MECA_IMPO=[{"GROUP_MA": "A", "DX": 0}, {"GROUP_MA": "A"}])

    def test_together(self):
        self.one("KEYWORD_9", "DEFI_FONCTION", "ORDONNEE", command="DEFI_FONCTION", NOM_PARA="INST", ABSCISSE=(0, 1))

    def test_forbidden_by_another(self):
        self.one("KEYWORD_10", "IMPR_RESU/RESU[1]/INST", command="IMPR_RESU", RESU={"MAILLAGE": concept("mesh"), "INST": 1.0})

    def test_mandatory_by_another(self):
        self.one("KEYWORD_2", "DEFI_GROUP/CREA_GROUP_NO[1]/NOM", command="DEFI_GROUP", MAILLAGE=concept("mesh"), CREA_GROUP_NO={"NOEUD": "N1"})
        self.assertEqual(problems("DEFI_GROUP", MAILLAGE=concept("mesh"), CREA_GROUP_NO={"GROUP_MA": "A"}), [])

    def test_cardinality(self):
        self.one("KEYWORD_5", "DEFI_CONTACT/ZONE[1]/GROUP_MA_MAIT", "has 2", command="DEFI_CONTACT", **self.contact(GROUP_MA_MAIT=("A", "B")))
        self.one("KEYWORD_5", "CREA_MAILLAGE/DECOUPE_LAC", "has 2", command="CREA_MAILLAGE", MAILLAGE=concept("mesh"),
                 DECOUPE_LAC=[{"GROUP_MA_ESCL": "A"}] * 2)
        self.one("KEYWORD_5", "DEFI_CONTACT/ZONE", "has 101", command="DEFI_CONTACT",
                 **{**self.contact(), "ZONE": [self.contact()["ZONE"]] * 101})

    def test_repeated_names(self):
        self.one("KEYWORD_12", "CREA_MAILLAGE/DECOUPE_LAC/GROUP_MA_ESCL", "'A'", command="CREA_MAILLAGE", MAILLAGE=concept("mesh"),
                 DECOUPE_LAC={"GROUP_MA_ESCL": ("A", "B", "A")})

    def test_every_mistake_is_found_at_once(self):
        found = problems("DEFI_CONTACT", MODELE=3, ZONE=[{"GROUP_MA_ESCL": 1}, {"BAD": 1}])
        self.assertEqual(sorted(p for _, p, _ in found), sorted([
            "DEFI_CONTACT/MODELE", "DEFI_CONTACT/FORMULATION", "DEFI_CONTACT/ZONE[1]/GROUP_MA_ESCL", "DEFI_CONTACT/ZONE[1]/GROUP_MA_MAIT",
            "DEFI_CONTACT/ZONE[2]/BAD", "DEFI_CONTACT/ZONE[2]/GROUP_MA_MAIT", "DEFI_CONTACT/ZONE[2]/GROUP_MA_ESCL"]))

    def test_a_destroyed_concept(self):
        mesh = concept("mesh")
        mesh.destroyed = "study.comm:3"
        self.one("KEYWORD_14", "CREA_MAILLAGE/MAILLAGE", "study.comm:3", command="CREA_MAILLAGE", MAILLAGE=mesh, LINE_QUAD={"TOUT": "OUI"})

    def test_what_the_operator_refuses_with_the_peers_own_message_passes(self):
        keywords = {**self.contact(), "FROTTEMENT": "COULOMB", "ALGO_RESO_GEOM": "POINT_FIXE", "ALGO_RESO_CONT": "POINT_FIXE"}
        self.assertEqual(problems("DEFI_CONTACT", **keywords), [])
        keywords["ZONE"] = {"GROUP_MA_MAIT": "A", "GROUP_MA_ESCL": "B"}
        self.assertEqual(problems("DEFI_CONTACT", **keywords), [])


class Completion(unittest.TestCase):
    def test_one_or_many(self):
        import numpy as np

        mesh = concept("mesh")
        for groups in ("A", ("A",), ["A"]):
            made = complete("CREA_MAILLAGE", MAILLAGE=mesh, DECOUPE_LAC={"GROUP_MA_ESCL": groups})
            self.assertEqual(made["DECOUPE_LAC"], [{"GROUP_MA_ESCL": ["A"], "DECOUPE_HEXA": "PYRA"}])
        for factor in ({"JUSQU_A": 1, "PAS": 1}, ({"JUSQU_A": 1, "PAS": 1},), [{"JUSQU_A": 1, "PAS": 1}]):
            self.assertEqual(complete("DEFI_LIST_REEL", DEBUT=0, INTERVALLE=factor)["INTERVALLE"], [{"JUSQU_A": 1.0, "PAS": 1.0}])
        for values in ([0, 1], (0, 1), range(2), np.arange(2), np.array([0.0, 1.0], np.float32)):
            made = complete("DEFI_LIST_REEL", VALE=values)["VALE"]
            self.assertEqual(made, [0.0, 1.0])
            self.assertTrue(all(type(x) is float for x in made))
        self.assertEqual(complete("LIRE_MAILLAGE", UNITE=np.int64(21))["UNITE"], 21)
        self.assertEqual(complete("LIRE_MAILLAGE", FORMAT=("MED",))["FORMAT"], "MED")

    def test_keywords_of_the_command_that_mean_its_occurrences(self):
        """POST_ELEM(RESULTAT=R, INST=1.0, INTEGRALE=_F(...)): as within the occurrence, which may have its own."""
        integral = {"NOM_CHAM": "SIEF_ELGA", "TOUT": "OUI"}
        whole = complete("POST_ELEM", RESULTAT=concept("result"), INST=1.0, PRECISION=1e-3, INTEGRALE=(integral, {**integral, "INST": 2.0}))
        self.assertNotIn("RESULTAT", whole)
        self.assertEqual([one["INST"] for one in whole["INTEGRALE"]], [[1.0], [2.0]])
        self.assertEqual([(one["RESULTAT"].type, one["PRECISION"]) for one in whole["INTEGRALE"]], [("result", 1e-3)] * 2)
        field = complete("POST_ELEM", CHAM_GD=concept("field"), MODELE=concept("model"), MINMAX={"TOUT": "OUI"})
        self.assertEqual(set(field["MINMAX"][0]) - {"PRECISION", "CRITERE"}, {"TOUT", "CHAM_GD", "MODELE"})
        self.assertEqual(complete("POST_ELEM", RESULTAT=concept("result"), ENER_POT={"TOUT": "OUI"})["RESULTAT"].type, "result")
        self.assertEqual([p for _, p, _ in problems("POST_ELEM", CHAM_GD=concept("field"), RESULTAT=concept("result"), ENER_POT={})], ["POST_ELEM/CHAM_GD"])
        self.assertIn("POST_ELEM/INTEGRALE[1]", [p for _, p, _ in problems("POST_ELEM", INTEGRALE={"TOUT": "OUI"})])

    def test_defaults_that_depend_on_another_keyword(self):
        zone = {"GROUP_MA_MAIT": "A", "GROUP_MA_ESCL": "B", "ALGO_CONT": "LAC"}
        for kind, residual in (("NEWTON", 1e-6), ("POINT_FIXE", 1e-2)):
            made = complete("DEFI_CONTACT", MODELE=concept("model"), FORMULATION="CONTINUE", ALGO_RESO_GEOM=kind, ZONE=zone)
            self.assertEqual(made["RESI_GEOM"], residual)
        self.assertEqual(complete("DEFI_CONTACT", MODELE=concept("model"), FORMULATION="CONTINUE", ZONE=zone, RESI_GEOM=0.5)["RESI_GEOM"], 0.5)

    def test_defaults_of_contact_are_those_of_the_method_document(self):
        zone = {"GROUP_MA_MAIT": "A", "GROUP_MA_ESCL": "B", "ALGO_CONT": "LAC"}
        made = complete("DEFI_CONTACT", MODELE=concept("model"), FORMULATION="CONTINUE", ALGO_RESO_GEOM="NEWTON", ZONE=zone)
        expected = {"FROTTEMENT": "SANS", "ALGO_RESO_CONT": "NEWTON", "RESI_GEOM": 1e-6, "RESI_CONT": -1.0, "LISSAGE": "NON",
                    "VERI_NORM": "OUI", "CONT_STAT_ELAS": 0}
        self.assertEqual({k: made[k] for k in expected}, expected)
        of_zone = {**zone, "APPARIEMENT": "MORTAR", "TYPE_APPA": "RAPIDE", "RESI_APPA": 1e-8, "COEF_MULT_APPA": -1.0, "TYPE_JACOBIEN": "INITIAL",
                   "INTEGRATION": "AUTO", "CONTACT_INIT": "INTERPENETRE"}
        self.assertEqual({k: made["ZONE"][0][k] for k in of_zone}, of_zone)

    def test_convergence(self):
        base = {"MODELE": concept("model"), "CHAM_MATER": concept("material_field"), "EXCIT": {"CHARGE": concept("load")},
                "INCREMENT": {"LIST_INST": concept("list_of_reals")}}
        made = complete("STAT_NON_LINE", **base)
        self.assertEqual(made["CONVERGENCE"][0]["RESI_GLOB_RELA"], 1e-6)
        made = complete("STAT_NON_LINE", CONVERGENCE={"RESI_GLOB_MAXI": 1e-12}, **base)
        self.assertNotIn("RESI_GLOB_RELA", made["CONVERGENCE"][0])
        self.assertEqual(made["COMPORTEMENT"][0]["RELATION"], "ELAS")
        self.assertEqual(made["ARCHIVAGE"][0]["CRITERE"], "RELATIF")


# ---------------------------------------------------------------------------------------- over the whole catalogue


def sample(row):
    """A value that one keyword accepts."""
    kind = row["type"].partition("|")[0]
    if row.get("makes"):
        one = concepts.CO("NAME")
    elif "into_from" in row:
        one = plugins.lists[row["into_from"]]()[0]
    elif "into" in row:
        one = row["into"][0]
    elif kind == "real":
        one = (row.get("above", row.get("at_least", 0.0)) + row.get("below", row.get("at_most", 2.0))) / 2
    elif kind == "integer":
        one = int(row.get("at_least", 1))
    elif kind in ("text", "scalar", "group_ma", "group_no", "cell", "node"):
        one = "NAME"
    else:
        one = concept("mesh" if kind == "concept" else kind)
    low = row.get("min", 1)
    return one if low == 1 else [one] * low


def minimal(row):
    """The fewest keywords that a command, or an occurrence, needs."""
    rows = row.get("keyword", {})
    given = {}

    def add(name):
        given[name] = minimal(rows[name]) if rows[name]["type"] == "factor" else sample(rows[name])

    for name, keyword in rows.items():
        if keyword.get("status") == "mandatory":
            add(name)
    for _ in range(3):  # rules may ask for what other rules hold
        for rule in row.get("rule", ()):
            there = [k for k in rule["of"] if k in given]
            if rule["kind"] in ("exactly_one", "at_least_one") and not there:
                add(rule["of"][0])
            elif rule["kind"] == "together" and there:
                for name in rule["of"]:
                    if name not in given:
                        add(name)
        for when in row.get("when", ()):
            effective = {**{k: keyword["default"] for k, keyword in rows.items() if "default" in keyword}, **given}
            if (all(effective.get(k) in allowed for k, allowed in when.get("if", {}).items())
                    and all(k in given for k in when.get("present", ())) and not any(k in given for k in when.get("absent", ()))):
                for name in when.get("mandatory", ()):
                    if name not in given:
                        add(name)
    return given


def occurrences(row, given, path=()):
    """(row, keywords, path) of the command and of every factor keyword in `given`."""
    yield row, given, path
    for name, value in given.items():
        keyword = row["keyword"][name]
        if keyword["type"] == "factor":
            yield from occurrences(keyword, value, (*path, name))


class Properties(unittest.TestCase):
    """For each command a minimal call is accepted, and each single change that breaks it is refused with the keyword's name."""

    def refused(self, command, given, name):
        found = problems(command, **given)
        self.assertTrue(found, (command, name))
        for identifier, path, text in found:
            plain = re.sub(r"\[\d+\]", "", path + " " + text)
            self.assertIn(name, plain, found)

    def start(self, command):
        given = minimal(catalog.command(command))
        if command == "DEFI_CONTACT":
            given["FORMULATION"] = "CONTINUE"
        return given

    def each(self):
        for command in catalog.command_names():
            for _, _, path in occurrences(catalog.command(command), self.start(command)):
                given = self.start(command)
                row, inner = catalog.command(command), given
                for name in path:
                    row, inner = row["keyword"][name], inner[name]
                yield command, row, given, inner

    def test_minimal_calls_are_accepted(self):
        for command in catalog.command_names():
            with self.subTest(command):
                self.assertEqual(problems(command, **self.start(command)), [])

    def test_an_unknown_keyword_is_refused(self):
        for command, row, given, inner in self.each():
            if "others" in row:
                continue
            with self.subTest(command):
                inner["NO_SUCH"] = 1
                self.refused(command, given, "NO_SUCH")

    def test_a_missing_mandatory_keyword_is_refused(self):
        for command, row, given, inner in self.each():
            for name, keyword in row.get("keyword", {}).items():
                if keyword.get("status") == "mandatory":
                    with self.subTest(command, name=name):
                        kept = inner.pop(name)
                        self.refused(command, given, name)
                        inner[name] = kept

    def test_a_value_of_another_type_is_refused(self):
        class Thing:
            pass

        for command, row, given, inner in self.each():
            for name in list(inner):
                with self.subTest(command, name=name):
                    kept = inner[name]
                    inner[name] = Thing()
                    self.refused(command, given, name)
                    inner[name] = kept

    def test_an_empty_list_is_refused(self):
        for command, row, given, inner in self.each():
            for name in list(inner):
                with self.subTest(command, name=name):
                    kept = inner[name]
                    inner[name] = []
                    self.refused(command, given, name)
                    inner[name] = kept

    def test_a_text_outside_the_allowed_ones_is_refused(self):
        for command, row, given, inner in self.each():
            for name, keyword in row.get("keyword", {}).items():
                if keyword["type"] == "text" and ("into" in keyword or "into_from" in keyword):
                    with self.subTest(command, name=name):
                        kept = dict(inner)
                        inner[name] = "NO SUCH VALUE"
                        self.assertIn(name, " ".join(path for _, path, _ in problems(command, **given)))
                        inner.clear()
                        inner.update(kept)

    def test_rows_are_of_the_documented_shape(self):
        known = {"type", "status", "max", "min", "default", "into", "into_from", "elsewhere", "above", "at_least", "below", "at_most",
                 "unique", "unit", "makes", "help", "keyword", "rule", "when", "formerly", "example"}
        types = {"real", "integer", "text", "scalar", "group_ma", "group_no", "cell", "node", "factor", "concept", *kinds}

        def visit(path, row):
            for name, keyword in row.get("keyword", {}).items():
                here = f"{path}/{name}"
                self.assertLessEqual(set(keyword), known, here)
                self.assertLessEqual(set(keyword["type"].split("|")), types, here)
                self.assertTrue(keyword["help"], here)
                self.assertFalse(set(keyword.get("into", ())) & set(keyword.get("elsewhere", ())), here)
                visit(here, keyword)
            names = set(row.get("keyword", {}))
            self.assertFalse(names & set(row.get("elsewhere", ())), path)
            self.assertFalse((names | set(row.get("elsewhere", ()))) & set(row.get("formerly", {})), path)
            self.assertLessEqual(set(row.get("formerly", {}).values()), names, path)
            for rule in row.get("rule", ()):
                self.assertIn(rule["kind"], ("exactly_one", "at_least_one", "exclusive", "together"))
                self.assertLessEqual(set(rule["of"]), names, path)
            for when in row.get("when", ()):
                self.assertLessEqual({k for key in ("if", "present", "absent", "default", "mandatory", "forbidden") for k in when.get(key, ())},
                                     names, path)
                for name in when.get("ignored", ()):
                    factor, _, own = name.rpartition("/")
                    self.assertIn(own, row["keyword"][factor]["keyword"] if factor else names, path)

        for command in catalog.command_names():
            visit(command, catalog.command(command))
            rows, down = catalog.command(command).get("keyword", {}), catalog.command(command).get("hands_down", {"keywords": (), "to": ()})
            for row in (rows, *(rows[name]["keyword"] for name in down["to"])):
                self.assertLessEqual(set(down["keywords"]), set(row), command)
            self.assertTrue(catalog.command(command)["help"])


class Messages(LauncherTest):
    def test_file_line_command_and_path(self):
        run = self.refused(self.run_study(STUDY + """
C = DEFI_CONTACT(MODELE=MO, FORMULATION='CONTINUE',
                 ZONE=_F(GROUP_MA_MAIT='BODY', GROUP_MA_ESCLA='SKIN', ALGO_CONT='LAC'))
"""), "<F> <KEYWORD_1>", "<F> <KEYWORD_2>", "DEFI_CONTACT/ZONE[1]/GROUP_MA_ESCLA, study.comm:13", "the nearest one is GROUP_MA_ESCL")
        self.assertEqual(run.err.count("<F>"), 2)

    def test_unknown_commands(self):
        self.refused(self.run_study("DEBUT()\nX = DYNA_NON_LINE(MODELE=1)\n"), "COMMAND_11", "DYNA_NON_LINE", "not available in Lacon",
                     "use STAT_NON_LINE", "study.comm:2")
        self.refused(self.run_study("DEBUT()\nX = LIRE_MALLAGE()\n"), "STUDY_20", "LIRE_MALLAGE", "LIRE_MAILLAGE", "study.comm:2")

    def test_spaces_around_a_name_are_not_what_it_is_far_by(self):
        self.assertEqual(nearest("TOP" + 21 * " ", ["BASE", "TOP"]), "; the nearest one is TOP")

    def test_a_name_that_is_not_defined_is_near_one_of_the_study(self):
        """Or near a command where it is called; never near one that is not available (RESOUDRE)."""
        made = "DEBUT()\nRAMP = DEFI_CONSTANTE(VALE=1.0)\n"
        for line, said in (("DETRUIRE(CONCEPT=_F(NOM=RESU))", "the name 'RESU' is not defined\n"), ("x = RESOUDR()", "the name 'RESOUDR' is not defined\n"),
                           ("x = RAMPE(0.5)", "'RAMPE' is not defined; the nearest one is RAMP\n"), ("x = rampe", "'rampe' is not defined; the nearest one is RAMP\n"),
                           ("DETRUIRE(CONCEPT=_F(NOM=RAMP_2))", "'RAMP_2' is not defined; the nearest one is RAMP\n"),
                           ("x = DEFI_CONSTANT(VALE=1.0)", "the nearest one is DEFI_CONSTANTE\n"),
                           ("MODELE = 1; x = AFFE_MODEL(MODELE)", "the nearest one is AFFE_MODELE\n")):
            with self.subTest(line):
                self.refused(self.run_study(made + line + "\n"), "STUDY_20", said, "study.comm:3")

    def test_keywords_only(self):
        self.refused(self.run_study("DEBUT()\nLIRE_MAILLAGE(20)\n"), "COMMAND_1", "study.comm:2")

    def test_reuse(self):
        self.refused(self.run_study("DEBUT()\nM = LIRE_MAILLAGE()\nMODI_MAILLAGE(MAILLAGE=M, ORIE_PEAU=_F(GROUP_MA_PEAU='A'))\n"), "COMMAND_2")
        self.refused(self.run_study("DEBUT()\nM = LIRE_MAILLAGE()\nLIRE_MAILLAGE(reuse=M)\n"), "COMMAND_3", "LIRE_MAILLAGE/reuse")
        self.refused(self.run_study("DEBUT()\nM = LIRE_MAILLAGE()\nN = LIRE_MAILLAGE()\n"
                                    "MODI_MAILLAGE(reuse=M, MAILLAGE=N, ORIE_PEAU=_F(GROUP_MA_PEAU='A'))\n"), "COMMAND_9")

    def test_reuse_wants_what_the_command_makes(self):
        """It was passed over in silence where the keyword that it stands for is absent: STAT_NON_LINE without RESULTAT."""
        row = catalog.command("STAT_NON_LINE")["keyword"]["RESULTAT"]
        self.assertEqual(checker.problems_of("STAT_NON_LINE/reuse", row, kinds["result"](None, "result_1", "R")), [])
        for value in ("R", 3, kinds["material_field"](None, "material_field_1", "CM")):
            (problem,) = checker.problems_of("STAT_NON_LINE/reuse", row, value, "study.comm:7")
            self.assertEqual((problem.id, problem.where), ("KEYWORD_3", "STAT_NON_LINE/reuse, study.comm:7"))
        self.refused(self.run_study("DEBUT()\nM = LIRE_MAILLAGE()\nF = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 1))\n"
                                    "CALC_CHAMP(reuse=F, CONTRAINTE='SIEF_NOEU')\n"), "KEYWORD_3", "CALC_CHAMP/reuse")


if __name__ == "__main__":
    unittest.main()
