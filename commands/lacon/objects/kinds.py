"""The class of each type of concept."""

from ..base import contents
from ..core.concepts import Concept
from ..core.messages import fail
from .fields import FieldConcept
from .functions import Formula, Function, ListOfIntegers, ListOfReals, TimeSteps
from .meshes import Mesh, Model
from .results import Result, Table


class Material(Concept):
    type = "material"

    def RCVALE(self, phenomenon, nompar=(), valpar=(), nomres=(), stop=1):
        """(values, codes) of the parameters `nomres` of a factor keyword, at these values of the functions' parameters; code 0: it has one, 1: it has
        none. @throws AsterError with stop=1 where one is missing"""
        names = [nomres] if isinstance(nomres, str) else list(nomres)
        given = dict(zip([nompar] if isinstance(nompar, str) else nompar, valpar if isinstance(valpar, (list, tuple)) else [valpar]))
        with self.open() as file:
            attributes = dict(file[phenomenon].attrs) if phenomenon in file else {}
        values = [self._at(attributes.get(name), given) for name in names]
        if stop and None in values:
            fail("MATERIAL_1", material=self.label, law=phenomenon, name=names[values.index(None)])
        return tuple(0.0 if value is None else value for value in values), tuple(int(value is None) for value in values)

    def _at(self, value, given):
        if not isinstance(value, (str, bytes)):
            return None if value is None else float(value)
        function = self.base.concept(value.decode() if isinstance(value, bytes) else value)
        names = function.Parametres()["NOM_PARA"]
        names = [names] if isinstance(names, str) else names
        missing = [name for name in names if name not in given]
        if missing:
            fail("FUNCTION_2", keyword="RCVALE", label=function.label, parameter=missing[0], known=", ".join(given) or "-")
        return float(function(*(given[name] for name in names)))


class OfModel(Concept):
    """What is made on a model."""

    def getModel(self):
        with self.open() as file:
            return self.base.concept(contents.reference(file, "model"))

    def getMesh(self):
        return self.getModel().getMesh()


class MaterialField(Concept):
    type = "material_field"

    def getMesh(self):
        with self.open() as file:
            return self.base.concept(contents.reference(file, "mesh"))


class ElementCharacteristics(OfModel):
    type = "element_characteristics"


class Load(OfModel):
    type = "load"


class Contact(OfModel):
    type = "contact"


kinds = {c.type: c for c in (Mesh, Model, Material, MaterialField, ElementCharacteristics, Load, Contact, FieldConcept, ListOfReals, ListOfIntegers,
                             TimeSteps, Function, Formula, Result, Table)}
