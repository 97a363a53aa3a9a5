"""The same as manufactured.py by the tensors that files of the peer import: there where sympy is, ImportError where it is not.

Functions and methods of tensors are used side by side, as the peer's files do.
"""

from code_aster.MacroCommands.Contrib.HookeTensor import HookeIsotropic
from code_aster.MacroCommands.Contrib.TensorModule import Tensor, div, grad, inverse, produitSimpleContracte, transpose
from code_aster.Utilities import sympy


class derived:
    """@param displacement expressions of its components  @param modulus Young's"""

    def __init__(self, displacement, modulus):
        dimension = len(displacement)
        one = Tensor(sympy.eye(dimension))
        self.F = F = grad(Tensor([sympy.sympify(text) for text in displacement])) + one
        strain = (F.transpose().produitSimpleContracte(F) - one) / 2
        self.P = F.dot(HookeIsotropic(modulus, 0, dimension).produitDoubleContracte(strain))
        self.inside = [str(f) for f in -div(self.P)]

    def on(self, normal):
        """The traction on a plane face."""
        return [str(t) for t in produitSimpleContracte(self.P, Tensor(normal))]

    def _contact(self, normal):
        """(F^-T N, traction, their product, square of the first): traction and current normal of a face."""
        direction, traction = inverse(transpose(self.F)).dot(Tensor(normal)), self.P.dot(Tensor(normal))
        return direction, traction, direction.dot(traction), direction.dot(direction)

    def pressure(self, normal):
        """What contact carries there: LAGS_C, negative in compression."""
        direction, _, along, _ = self._contact(normal)
        return str(along / direction.norm())

    def beside_contact(self, normal):
        """The traction less what contact carries."""
        direction, traction, along, square = self._contact(normal)
        return [str(t) for t in traction - direction * along / square]
