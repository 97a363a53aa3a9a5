"""Contact of another method is refused with the LAC form of the same study, which is accepted as it stands."""

import contextlib
import sys
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
import support  # noqa: E402, F401 (where the package is)

from lacon.core import catalog, checker  # noqa: E402
from lacon.core.concepts import _F, Concept  # noqa: E402
from lacon.core.messages import AsterError  # noqa: E402
from lacon.objects.kinds import kinds  # noqa: E402
from lacon.run.contact_methods import refuse_other_methods  # noqa: E402


class Mesh(Concept):
    type = "mesh"

    def __init__(self, cut=()):
        super().__init__(None, "mesh_1", "MAIL")
        self.cut = cut

    @contextlib.contextmanager
    def open(self):
        yield {"patches": {}, "patches/zone_group": [name.encode() for name in self.cut]} if self.cut else {}


class Model(kinds["model"]):
    def __init__(self, cut=()):
        super().__init__(None, "model_2", "MODELE")
        self.mesh = Mesh(cut)

    def getMesh(self):
        return self.mesh


ZONES = (_F(GROUP_MA_MAIT="M", GROUP_MA_ESCL="E", ALGO_CONT="PENALISATION", E_N=1e6, COEF_PENA_CONT=1e5, ADAPTATION="ADAPT_COEF", SANS_GROUP_NO=("A", "B")),
         _F(GROUP_MA_MAIT="N", GROUP_MA_ESCL="F", ALGO_CONT="PENALISATION", GLISSIERE="OUI", APPARIEMENT="MAIT_ESCL", DIST_ESCL=0.5))


class OtherMethods(unittest.TestCase):
    def form(self, command, cut=(), **given):
        with self.assertRaises(AsterError) as caught:
            refuse_other_methods(command, {"MODELE": Model(cut), **given}, "study.comm:7", "CTC")
        self.assertEqual(caught.exception.id_message, "LAC_9")
        return caught.exception.messages[0]

    def test_what_is_lac_passes(self):
        refuse_other_methods("DEFI_CONTACT", {"FORMULATION": "CONTINUE", "ZONE": _F(ALGO_CONT="LAC")}, "", "")

    def test_the_form_is_a_study_s_own_and_is_accepted(self):
        for command, given in (("DEFI_CONTACT", {"FORMULATION": "DISCRETE"}), ("DEFI_CONTACT", {}), ("DEFI_CONTACT", {"FORMULATION": "CONTINUE"}),
                               ("DEFI_CONTACT", {"FORMULATION": "CONTINUE", "FROTTEMENT": "COULOMB", "LISSAGE": "OUI"}), ("DEFI_CONT", {})):
            with self.subTest(command=command, given=given):
                said = self.form(command, ZONE=ZONES, **given)
                lines = said.do.partition("\n\n")[2]
                self.assertIn("CUT = CREA_MAILLAGE(MAILLAGE=MAIL, DECOUPE_LAC=_F(GROUP_MA_ESCL=('E', 'F')))", lines)
                self.assertIn("CTC = DEFI_CONTACT(", lines)
                self.assertEqual("friction" in lines, "FROTTEMENT" in given)
                made = []

                def command_of(name, made=made):
                    return lambda **keywords: made.append((name, keywords))

                exec(lines, {"_F": _F, "MAIL": Mesh(), "MODELE": Model(), "CREA_MAILLAGE": command_of("CREA_MAILLAGE"),
                             "DEFI_CONTACT": command_of("DEFI_CONTACT")})
                for name, keywords in made:
                    self.assertEqual(checker.complete(name, catalog.command(name), keywords)[1], [])
                contact = made[1][1]
                self.assertEqual(contact.get("LISSAGE"), given.get("LISSAGE"))
                self.assertEqual(contact["ZONE"], (_F(GROUP_MA_MAIT="M", GROUP_MA_ESCL="E", ALGO_CONT="LAC", SANS_GROUP_NO=("A", "B")),
                                                   _F(GROUP_MA_MAIT="N", GROUP_MA_ESCL="F", ALGO_CONT="LAC", GLISSIERE="OUI", DIST_ESCL=0.5)))

    def test_a_function_that_no_variable_holds_is_left_to_be_named(self):
        """DIST_MAIT=DEFI_CONSTANTE(...) inside the zone: the form named it by its number in the base, which no study knows."""
        zone = _F(GROUP_MA_MAIT="M", GROUP_MA_ESCL="E", DIST_MAIT=Concept(None, "function_6"))
        lines = self.form("DEFI_CONTACT", FORMULATION="DISCRETE", ZONE=(zone, zone)).do
        self.assertNotIn("function_6", lines)
        for n in (1, 2):
            self.assertIn(f"DIST_MAIT_{n} = ...", lines)
            self.assertIn(f"DIST_MAIT=DIST_MAIT_{n})", lines)

    def test_the_form_says_that_excluded_nodes_open_whole_patches(self):
        self.assertIn("# SANS_GROUP_NO: whole patches", self.form("DEFI_CONTACT", ZONE=ZONES).do)
        self.assertNotIn("whole patches", self.form("DEFI_CONTACT", ZONE=ZONES[1]).do)

    def test_a_skin_that_is_cut_is_not_cut_again(self):
        said = self.form("DEFI_CONTACT", cut=("E", "F"), FORMULATION="DISCRETE", ZONE=ZONES)
        self.assertNotIn("CREA_MAILLAGE", said.do)

    def test_what_has_no_two_skins_has_no_lac_form(self):
        """Its keywords are refused by name: a form without slave or master was printed."""
        for zone in (_F(GROUP_MA="M", NOM_CMP="DY", COEF_IMPO=0.0), _F(FISS_MAIT="F"), _F(GROUP_MA_ESCL="E"), ()):
            refuse_other_methods("DEFI_CONTACT", {"MODELE": Model(), "FORMULATION": "LIAISON_UNIL", "ZONE": zone}, "study.comm:7", "CTC")
        _, problems, _ = checker.complete("DEFI_CONTACT", catalog.command("DEFI_CONTACT"),
                                          {"MODELE": Model(), "FORMULATION": "LIAISON_UNIL", "ZONE": _F(GROUP_MA="M", NOM_CMP="DY", COEF_IMPO=0.0)})
        self.assertIn("stiff body", " ".join(problem.do for problem in problems))

    def test_bilateral_contact_of_defi_cont_glides(self):
        said = self.form("DEFI_CONT", ZONE=_F(GROUP_MA_MAIT="M", GROUP_MA_ESCL="E", ALGO_CONT="LAGRANGIEN", TYPE_CONTACT="BILATERAL"))
        self.assertIn("GLISSIERE='OUI'", said.do)
        self.assertIn("DECOUPE_LAC=_F(GROUP_MA_ESCL='E')", said.do)


if __name__ == "__main__":
    unittest.main()
