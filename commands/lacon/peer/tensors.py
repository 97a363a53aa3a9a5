"""Symbolic tensor fields in Cartesian coordinates X, Y, Z, for manufactured solutions: what command files of code_aster import as
code_aster.MacroCommands.Contrib.TensorModule and HookeTensor. Needs sympy.

A tensor of rank r in dimension n holds an array of shape (n, ..., n) of sympy expressions. One of rank 0, which products and invariants
give, does whatever its expression does, in sympy's functions too. What is a function here is a method of Tensor as well: grad(U), U.grad().
grad, div and laplacien differentiate with respect to the first n of X, Y, Z, whatever assumptions the file's own symbols were made with.
"""

import itertools
import numbers

import numpy
import sympy

X, Y, Z = sympy.symbols("X Y Z")


class Tensor:
    """array: numpy array of expressions; rank 0 is an array without axes."""

    __array_priority__ = 100  # numpy's own scalars leave a product to this class

    def __init__(self, array):
        array = array.array if isinstance(array, Tensor) else array
        if isinstance(array, sympy.MatrixBase):
            array = array.tolist()
        given = numpy.array(array, dtype=object)
        self.array = numpy.array(numpy.vectorize(sympy.sympify, otypes=[object])(given), dtype=object) if given.size else given
        if len(set(self.array.shape)) > 1:
            raise ValueError(f"a tensor has one dimension, and this array has the shape {self.array.shape}")

    @property
    def rank(self):
        return self.array.ndim

    @property
    def T(self):
        return self.transpose()

    def __repr__(self):
        return f"Tensor({self.array.tolist()!r})" if self.rank else str(self.array.item())

    def __len__(self):
        return len(self.array)

    def __getitem__(self, index):
        found = self.array[index]
        return Tensor(found) if isinstance(found, numpy.ndarray) and found.ndim else sympy.sympify(found)

    def __setitem__(self, index, value):
        self.array[index] = value.array if isinstance(value, Tensor) else sympy.sympify(value)

    def __eq__(self, other):
        """Whether the difference simplifies to zero everywhere."""
        other = Tensor(other)
        return self.array.shape == other.array.shape and all(sympy.simplify(d) == 0 for d in numpy.ravel(self.array - other.array))

    __hash__ = None

    # ------------------------------------------------------------------------------------------- rank 0

    def _sympy_(self):
        """What sympy's own functions take for it."""
        if self.rank:
            raise sympy.SympifyError(f"a tensor of rank {self.rank} is no expression")
        return self.array.item()

    def __getattr__(self, name):
        """subs, diff, evalf, ... of its expression."""
        if name.startswith("__") or name == "array" or self.rank:
            raise AttributeError(f"'Tensor' object of rank {self.rank} has no attribute {name!r}" if name != "array" else name)
        return getattr(self.array.item(), name)

    def __float__(self):
        return float(self._sympy_())

    def __bool__(self):
        return bool(self.array.item()) if not self.rank else len(self) > 0

    def __pow__(self, exponent):
        return Tensor(self._sympy_() ** sympy.sympify(exponent))

    def __rpow__(self, base):
        return Tensor(sympy.sympify(base) ** self._sympy_())

    def __rtruediv__(self, dividend):
        return Tensor(dividend) / self

    def __abs__(self):
        return Tensor(abs(self._sympy_()))

    # ------------------------------------------------------------------------------------------- sums and multiples

    def __pos__(self):
        return self

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

    def __matmul__(self, other):
        return produitSimpleContracte(self, other)

    def __rmatmul__(self, other):
        return produitSimpleContracte(other, self)

    def __truediv__(self, divisor):
        divisor = Tensor(divisor)
        if divisor.rank:
            raise TypeError("a tensor is divided by a number, an expression or a tensor of rank 0")
        return Tensor(self.array / divisor.array.item())

    def simplify(self):
        return Tensor(numpy.vectorize(sympy.simplify, otypes=[object])(self.array))


def _method(function):
    """A function whose first argument is a tensor, as a method of Tensor too."""
    setattr(Tensor, function.__name__, function)
    return function


def _coordinates(array, count):
    """The first `count` coordinates, as the symbols of these names that the expressions hold."""
    held = {s.name: s for e in numpy.ravel(array) for s in e.free_symbols}
    return [held.get(s.name, s) for s in (X, Y, Z)[:count]]


@_method
def grad(field):
    """The gradient, one more axis at the end: grad(U)[i, j] = dU_i / dX_j. A scalar has three derivatives."""
    array = Tensor(field).array
    variables = _coordinates(array, len(array) if array.ndim else 3)
    return Tensor(numpy.stack([numpy.vectorize(lambda e: sympy.diff(e, v), otypes=[object])(array) for v in variables], axis=-1))


@_method
def gradS(field):
    """The symmetric part of the gradient of a vector."""
    gradient = grad(field)
    return (gradient + transpose(gradient)) / 2


@_method
def div(field):
    """The divergence over the last axis: div(T)[i] = sum_j dT_ij / dX_j."""
    array = grad(field).array
    return Tensor(numpy.trace(array, axis1=-2, axis2=-1) if array.ndim > 1 else array.sum())


@_method
def laplacien(field):
    return div(grad(field))


@_method
def transpose(tensor):
    return Tensor(Tensor(tensor).array.T)


@_method
def trace(tensor):
    return Tensor(numpy.trace(Tensor(tensor).array))


@_method
def determinant(tensor):
    return Tensor(sympy.Matrix(Tensor(tensor).array).det(method="berkowitz"))


@_method
def inverse(tensor):
    """The inverse of a tensor of rank 2, by its adjugate."""
    matrix = sympy.Matrix(Tensor(tensor).array)
    return Tensor(matrix.adjugate() / matrix.det(method="berkowitz"))


@_method
def diagonal(tensor):
    """The vector of the diagonal."""
    return Tensor(numpy.diagonal(Tensor(tensor).array))


@_method
def norm(tensor):
    """The root of the sum of squares of the components."""
    return Tensor(sympy.sqrt(sum(e**2 for e in numpy.ravel(Tensor(tensor).array))))


@_method
def sqrt(tensor):
    """The square root of an expression or of a tensor of rank 0; of a symmetric positive tensor of rank 2 the one that is symmetric and
    positive. @throws ValueError"""
    tensor = Tensor(tensor)
    if tensor.rank == 0:
        return Tensor(sympy.sqrt(tensor.array.item()))
    if tensor.rank != 2 or tensor != transpose(tensor):
        raise ValueError("a square root is of a number, an expression or a symmetric tensor of rank 2")
    matrix = sympy.Matrix(tensor.array)
    made = sympy.zeros(*matrix.shape)
    for block in matrix.connected_components():
        root = _root_of_block(matrix.extract(block, block))
        for (i, row), (j, column) in itertools.product(enumerate(block), repeat=2):
            made[row, column] = root[i, j]
    return Tensor(made)


def _root_of_block(a):
    """By Cayley and Hamilton, from the invariants of the root; of 3 x 3 these from the principal values, which are equal in no block that
    is one."""
    if a.rows == 1:
        return a.applyfunc(sympy.sqrt)
    one = sympy.eye(a.rows)
    if a.rows == 2:
        second = sympy.sqrt(a.det())
        return (a + second * one) / sympy.sqrt(a.trace() + 2 * second)
    mean = a.trace() / 3
    deviator = a - mean * one
    radius = sympy.sqrt((deviator * deviator).trace() / 6)
    cosine = deviator.det(method="berkowitz") / (2 * radius**3)
    if cosine.is_number:
        cosine = sympy.Min(1, sympy.Max(-1, cosine))  # but for round-off
    angle = sympy.acos(cosine) / 3
    p, q, r = (sympy.sqrt(mean + 2 * radius * sympy.cos(angle + 2 * sympy.pi * k / 3)) for k in range(3))
    first, second, third = p + q + r, p * q + q * r + r * p, p * q * r
    return ((first**2 - second) * a + first * third * one - a * a) / (first * second - third)


@_method
def produitTensoriel(a, b):
    return Tensor(numpy.tensordot(Tensor(a).array, Tensor(b).array, axes=0))


@_method
def produitSimpleContracte(a, b):
    """sum_k a[..., k] b[k, ...]"""
    return Tensor(numpy.tensordot(Tensor(a).array, Tensor(b).array, axes=1))


Tensor.dot = produitSimpleContracte


@_method
def produitDoubleContracte(a, b):
    """sum_kl a[..., k, l] b[k, l, ...]"""
    return Tensor(numpy.tensordot(Tensor(a).array, Tensor(b).array, axes=2))


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
