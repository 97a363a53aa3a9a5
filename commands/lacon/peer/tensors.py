"""Symbolic tensor fields in Cartesian coordinates X, Y, Z, for manufactured solutions: what command files of code_aster import as
code_aster.MacroCommands.Contrib.TensorModule and HookeTensor. Needs sympy.

A tensor of rank r in dimension n holds an array of shape (n, ..., n) of sympy expressions; grad, div and laplacien differentiate with
respect to the first n of X, Y, Z, whatever assumptions the file's own symbols were made with.
"""

import numbers

import numpy
import sympy
from sympy import sqrt  # noqa: F401  command files import it from here

X, Y, Z = sympy.symbols("X Y Z")


class Tensor:
    """array: numpy array of expressions; rank 0 is an array without axes."""

    __array_priority__ = 100  # numpy's own scalars leave a product to this class

    def __init__(self, array):
        array = array.array if isinstance(array, Tensor) else array
        if isinstance(array, sympy.MatrixBase):
            array = array.tolist()
        self.array = numpy.vectorize(sympy.sympify, otypes=[object])(numpy.array(array, dtype=object)) if numpy.size(array) else numpy.array(array)
        if len(set(self.array.shape)) > 1:
            raise ValueError(f"a tensor has one dimension, and this array has the shape {self.array.shape}")

    @property
    def rank(self):
        return self.array.ndim

    def __repr__(self):
        return f"Tensor({self.array.tolist()!r})"

    def __len__(self):
        return len(self.array)

    def __getitem__(self, index):
        return _plain(self.array[index])

    def __setitem__(self, index, value):
        self.array[index] = value.array if isinstance(value, Tensor) else sympy.sympify(value)

    def __eq__(self, other):
        """Whether the difference simplifies to zero everywhere."""
        other = Tensor(other)
        return self.array.shape == other.array.shape and all(sympy.simplify(d) == 0 for d in numpy.ravel(self.array - other.array))

    __hash__ = None

    def __neg__(self):
        return Tensor(-self.array)

    def __add__(self, other):
        return Tensor(self.array + self._like(other))

    __radd__ = __add__

    def __sub__(self, other):
        return Tensor(self.array - self._like(other))

    def __rsub__(self, other):
        return Tensor(self._like(other) - self.array)

    def _like(self, other):
        """The array of a tensor of the same rank and dimension; 0, with which sum() starts, is one."""
        if isinstance(other, numbers.Number) and other == 0:
            return 0
        other = Tensor(other)
        if other.array.shape != self.array.shape:
            raise ValueError(f"tensors of the shapes {self.array.shape} and {other.array.shape} have no sum")
        return other.array

    def __mul__(self, factor):
        factor = Tensor(factor)
        if factor.rank and self.rank:
            raise TypeError("the product of two tensors is produitSimpleContracte, produitDoubleContracte or produitTensoriel")
        return Tensor(self.array * factor.array)

    __rmul__ = __mul__

    def __truediv__(self, divisor):
        return Tensor(self.array / sympy.sympify(divisor))

    def simplify(self):
        return Tensor(numpy.vectorize(sympy.simplify, otypes=[object])(self.array))

    def produitSimpleContracte(self, other):
        return produitSimpleContracte(self, other)

    def produitDoubleContracte(self, other):
        return produitDoubleContracte(self, other)

    def produitTensoriel(self, other):
        return produitTensoriel(self, other)


def _plain(array):
    """A tensor, or the expression where there are no axes left."""
    return Tensor(array) if isinstance(array, numpy.ndarray) and array.ndim else sympy.sympify(array.item() if isinstance(array, numpy.ndarray) else array)


def _coordinates(array, count):
    """The first `count` coordinates, as the symbols of these names that the expressions hold."""
    held = {s.name: s for e in numpy.ravel(array) for s in e.free_symbols}
    return [held.get(s.name, s) for s in (X, Y, Z)[:count]]


def grad(field):
    """The gradient, one more axis at the end: grad(U)[i, j] = dU_i / dX_j. A scalar has three derivatives."""
    array = Tensor(field).array
    variables = _coordinates(array, len(array) if array.ndim else 3)
    return Tensor(numpy.stack([numpy.vectorize(lambda e: sympy.diff(e, v), otypes=[object])(array) for v in variables], axis=-1))


def gradS(field):
    """The symmetric part of the gradient of a vector."""
    gradient = grad(field)
    return (gradient + transpose(gradient)) / 2


def div(field):
    """The divergence over the last axis: div(T)[i] = sum_j dT_ij / dX_j."""
    array = grad(field).array
    return _plain(numpy.trace(array, axis1=-2, axis2=-1) if array.ndim > 1 else array.sum())


def laplacien(field):
    return div(grad(field))


def transpose(tensor):
    return Tensor(Tensor(tensor).array.T)


def trace(tensor):
    return sympy.sympify(numpy.trace(Tensor(tensor).array))


def determinant(tensor):
    return sympy.Matrix(Tensor(tensor).array).det(method="berkowitz")


def inverse(tensor):
    """The inverse of a tensor of rank 2, by its adjugate."""
    matrix = sympy.Matrix(Tensor(tensor).array)
    return Tensor(matrix.adjugate() / matrix.det(method="berkowitz"))


def produitTensoriel(a, b):
    return Tensor(numpy.tensordot(Tensor(a).array, Tensor(b).array, axes=0))


def produitSimpleContracte(a, b):
    """sum_k a[..., k] b[k, ...]"""
    return _plain(numpy.tensordot(Tensor(a).array, Tensor(b).array, axes=1))


def produitDoubleContracte(a, b):
    """sum_kl a[..., k, l] b[k, l, ...]"""
    return _plain(numpy.tensordot(Tensor(a).array, Tensor(b).array, axes=2))


class HookeIsotropic(Tensor):
    """Isotropic elasticity, C_ijkl = lambda d_ij d_kl + mu (d_ik d_jl + d_il d_jk)."""

    def __init__(self, young, poisson, dimension=3):
        young, poisson = sympy.sympify(young), sympy.sympify(poisson)
        first, second = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))
        d = numpy.eye(dimension, dtype=int)
        super().__init__(first * numpy.einsum("ij,kl->ijkl", d, d)
                         + second * (numpy.einsum("ik,jl->ijkl", d, d) + numpy.einsum("il,jk->ijkl", d, d)))


class HookeTensor:
    """The same under the name by which some files import it."""

    HookeIsotropic = HookeIsotropic
