"""The class of each type of concept."""

from ..core.concepts import Concept
from .fields import FieldConcept
from .functions import Formula, Function, ListOfIntegers, ListOfReals, TimeSteps
from .meshes import Mesh, Model
from .results import Result, Table


class Material(Concept):
    type = "material"


class MaterialField(Concept):
    type = "material_field"


class ElementCharacteristics(Concept):
    type = "element_characteristics"


class Load(Concept):
    type = "load"


class Contact(Concept):
    type = "contact"


kinds = {c.type: c for c in (Mesh, Model, Material, MaterialField, ElementCharacteristics, Load, Contact, FieldConcept, ListOfReals, ListOfIntegers,
                             TimeSteps, Function, Formula, Result, Table)}
