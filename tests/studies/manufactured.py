"""Loads and contact pressure that belong to a given displacement of a St-Venant-Kirchhoff body with nu = 0, as expressions for FORMULE.

    exact = manufactured(("0.2*Y**3*(0.5 - X)", "..."), modulus=1.0)
    exact.inside[0], exact.on((1, 0))[1], exact.pressure((0, -1))

With F = 1 + grad u, S = E (F'F - 1) / 2 (nu = 0, also in plane strain) and P = F S, the body is in equilibrium under the volume force
-Div P and the traction P N, all on the reference configuration. On a slave skin the pressure p = n . P N, with n = F^-T N normalised,
is left to contact, and P N - p n is what is applied.
"""

import ast
import itertools


class Polynomial:
    """In X, Y, Z: exponents -> coefficient."""

    def __init__(self, terms=()):
        self.terms = {powers: c for powers, c in dict(terms).items() if c != 0}

    @classmethod
    def of(cls, text):
        """From an expression of numbers, X, Y, Z with + - * ** and brackets."""
        names = {name: cls({tuple(int(i == j) for j in range(3)): 1.0}) for i, name in enumerate("XYZ")}

        def value(node):
            if isinstance(node, ast.Constant):
                return cls({(0, 0, 0): float(node.value)})
            if isinstance(node, ast.Name):
                return names[node.id]
            if isinstance(node, ast.UnaryOp):
                return -value(node.operand)
            left = value(node.left)
            if isinstance(node.op, ast.Pow):
                product = cls({(0, 0, 0): 1.0})
                for _ in range(node.right.value):
                    product = product * left
                return product
            right = value(node.right)
            return {ast.Add: left.__add__, ast.Sub: left.__sub__, ast.Mult: left.__mul__}[type(node.op)](right)

        return value(ast.parse(text, mode="eval").body)

    def __add__(self, other):
        terms = dict(self.terms)
        for powers, c in other.terms.items():
            terms[powers] = terms.get(powers, 0.0) + c
        return Polynomial(terms)

    def __neg__(self):
        return Polynomial({powers: -c for powers, c in self.terms.items()})

    def __sub__(self, other):
        return self + -other

    def __mul__(self, other):
        terms = {}
        for (p, c), (q, d) in itertools.product(self.terms.items(), other.terms.items()):
            powers = tuple(i + j for i, j in zip(p, q))
            terms[powers] = terms.get(powers, 0.0) + c * d
        return Polynomial(terms)

    def scaled(self, factor):
        return Polynomial({powers: factor * c for powers, c in self.terms.items()})

    def derivative(self, axis):
        terms = {}
        for powers, c in self.terms.items():
            if powers[axis]:
                lower = tuple(p - (i == axis) for i, p in enumerate(powers))
                terms[lower] = terms.get(lower, 0.0) + c * powers[axis]
        return Polynomial(terms)

    def __str__(self):
        def term(powers, c):
            return "*".join([repr(c)] + [name + (f"**{p}" if p > 1 else "") for name, p in zip("XYZ", powers) if p])

        return " + ".join(f"({term(powers, c)})" for powers, c in sorted(self.terms.items())) or "0.0"


def _sum(items):
    total = Polynomial()
    for item in items:
        total = total + item
    return total


class manufactured:
    """@param displacement expressions of its components  @param modulus Young's"""

    def __init__(self, displacement, modulus):
        self.axes = range(len(displacement))
        u = [Polynomial.of(text) for text in displacement]
        one = Polynomial({(0, 0, 0): 1.0})
        self.F = F = [[u[i].derivative(j) + (one if i == j else Polynomial()) for j in self.axes] for i in self.axes]
        S = [[(_sum(F[k][i] * F[k][j] for k in self.axes) - (one if i == j else Polynomial())).scaled(modulus / 2) for j in self.axes]
             for i in self.axes]
        self.P = [[_sum(F[i][k] * S[k][j] for k in self.axes) for j in self.axes] for i in self.axes]

    @property
    def inside(self):
        """The volume force."""
        return [str(-_sum(self.P[i][j].derivative(j) for j in self.axes)) for i in self.axes]

    def _traction(self, normal):
        return [_sum(self.P[i][j].scaled(float(normal[j])) for j in self.axes) for i in self.axes]

    def on(self, normal):
        """The traction on a plane face."""
        return [str(t) for t in self._traction(normal)]

    def _direction(self, normal):
        """cof(F) N, along the current normal."""
        n = len(self.axes)

        def cofactor(i, j):
            rows, columns = [r for r in self.axes if r != i], [c for c in self.axes if c != j]
            if n == 2:
                minor = self.F[rows[0]][columns[0]]
            else:
                minor = self.F[rows[0]][columns[0]] * self.F[rows[1]][columns[1]] - self.F[rows[0]][columns[1]] * self.F[rows[1]][columns[0]]
            return minor if (i + j) % 2 == 0 else -minor

        return [_sum(cofactor(i, j).scaled(float(normal[j])) for j in self.axes) for i in self.axes]

    def pressure(self, normal):
        """What contact carries there: LAGS_C, negative in compression."""
        direction, traction = self._direction(normal), self._traction(normal)
        along = _sum(d * t for d, t in zip(direction, traction))
        square = _sum(d * d for d in direction)
        return f"({along})/sqrt({square})"

    def beside_contact(self, normal):
        """The traction less what contact carries."""
        direction, traction = self._direction(normal), self._traction(normal)
        along = _sum(d * t for d, t in zip(direction, traction))
        square = _sum(d * d for d in direction)
        return [f"({t}) - ({along})*({d})/({square})" for d, t in zip(direction, traction)]
