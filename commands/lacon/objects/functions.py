"""Lists, functions and formulae as a command file sees them."""

from ..base.expressions import read_formula
from ..base.functions import between, read_function
from ..core.concepts import Concept
from ..core.late import numpy


class ListOfReals(Concept):
    type = "list_of_reals"

    def getValues(self):
        with self.open() as file:
            return file["values"][:].tolist()

    Valeurs = getValues


class ListOfIntegers(ListOfReals):
    type = "list_of_integers"


class TimeSteps(ListOfReals):
    type = "time_steps"


class Function(Concept):
    type = "function"
    _points = None

    def points(self):
        """A base.functions.Piecewise with its points and rules."""
        if self._points is None:
            self._points = read_function(self)
        return self._points

    def __call__(self, x):
        """The value at x, a number or an array. @throws AsterError outside its points where they are not prolonged"""
        return self.points().value(x, self.label or self.id)

    def on_arrays(self, x):
        """The values at an array of points."""
        return self.points().value(x, self.label or self.id)

    def Absc(self):
        return list(self.points().x)

    def Ordo(self):
        return list(self.points().y)

    def Valeurs(self):
        return [self.Absc(), self.Ordo()]

    def getValues(self):
        return self.Absc() + self.Ordo()

    def getValuesAsArray(self):
        """(n, 2): abscissae and ordinates"""
        return numpy.column_stack(self.Valeurs())

    def size(self):
        return len(self.points().x)

    def Parametres(self):
        """Its rules and names, as keywords of DEFI_FONCTION."""
        points = self.points()
        return {"INTERPOL": list(points.interpolation), "NOM_PARA": points.parameter, "NOM_RESU": points.component,
                "PROL_GAUCHE": points.left, "PROL_DROITE": points.right}


class Formula(Concept):
    type = "formula"
    _expression = None

    def expression(self):
        """A base.expressions.Expression."""
        if self._expression is None:
            self._expression = read_formula(self)
        return self._expression

    def __call__(self, *values, **named):
        """Its value at a point, parameters in their order or by name. @throws AsterError where it has none"""
        expression = self.expression()
        point = dict(zip(expression.parameters, values), **named)
        if len(values) > len(expression.parameters) or set(point) != set(expression.parameters):
            raise TypeError(f"{self.label or self.id} takes the parameters {', '.join(expression.parameters)}")
        return expression.value(point, self.label or self.id)

    def on_arrays(self, *columns):
        """The values at points given by an array, or one value for all, of each parameter in their order."""
        columns = numpy.broadcast_arrays(*map(numpy.asarray, columns))
        expression = self.expression()
        if len(columns) != len(expression.parameters):
            raise TypeError(f"{self.label or self.id} takes the parameters {', '.join(expression.parameters)}")
        flat = dict(zip(expression.parameters, (c.ravel() for c in columns)))
        return expression.values_at(flat, columns[0].size, self.label or self.id).reshape(columns[0].shape)

    def getVariables(self):
        return list(self.expression().parameters)

    def surface(self):
        """(parameters, functions there) of DEFI_NAPPE's function of two parameters; None for any other formula."""
        values = self.expression().values
        return (values["parameters"], values["curves"]) if values.get("between") is between else None

    def Valeurs(self):
        """Of DEFI_NAPPE: [parameters, [[abscissae, ordinates] of each function]]"""
        surface = self.surface()
        if surface is None:
            raise AttributeError(f"{self.label or self.id} is a formula, which has no points of its own; CALC_FONC_INTERP takes it at a list")
        return [list(surface[0]), [curve.Valeurs() for curve in surface[1]]]

    def Absc(self):
        return [curve[0] for curve in self.Valeurs()[1]]

    def Ordo(self):
        return [curve[1] for curve in self.Valeurs()[1]]

    def Parametres(self):
        return {"NOM_PARA": self.getVariables()}

    def getExpression(self):
        return self.expression().text
