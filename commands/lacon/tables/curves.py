"""Curves on paper: files of Grace (FORMAT='XMGRACE'), pictures (FORMAT='PNG', with matplotlib), columns of numbers (FORMAT='TABLEAU')."""

import itertools
import math
import re

from .table import Table

#: Grace's colours 0 to 15
_colours = ("white", "black", "red", "lime", "blue", "yellow", "#bc8f8f", "#dcdcdc", "#9400d3", "cyan", "magenta", "orange", "#7221bc",
            "#670748", "turquoise", "green")
#: Grace's lines 0 to 5 and symbols 0 to 10, as matplotlib names them
_lines = ("none", "-", ":", "--", (0, (8, 3)), "-.")
_symbols = ("", "o", "s", "D", "^", "<", "v", ">", "+", "x", "*")


class Curve:
    """Points with a name and a look; look: numbers of Grace, None where Grace or matplotlib choose."""

    def __init__(self, x, y, names=("X", "Y"), legend="", colour=None, line=None, symbol=None, every=0, sort="N"):
        self.x, self.y = list(map(float, x)), list(map(float, y))
        self.names, self.legend = tuple(names), legend
        self.colour, self.line, self.symbol, self.every = colour, line, symbol, every
        order = {"N": None, "X": lambda p: p[0], "Y": lambda p: p[1], "XY": lambda p: p, "YX": lambda p: p[::-1]}[sort]
        if order:
            self.x, self.y = map(list, zip(*sorted(zip(self.x, self.y), key=order)))


class Plot:
    """All curves of one file; what later commands say of titles, ranges and scales holds."""

    def __init__(self):
        self.curves = []
        self.title = self.subtitle = self.x_label = self.y_label = ""
        self.x_range = self.y_range = None
        self.x_scale = self.y_scale = "LIN"
        self.x_grid = self.y_grid = None

    def describe(self, k):
        """Take over TITRE, SOUS_TITRE, LEGENDE_X, ... of a command's keywords."""
        for name, key in (("title", "TITRE"), ("subtitle", "SOUS_TITRE"), ("x_label", "LEGENDE_X"), ("y_label", "LEGENDE_Y"),
                          ("x_range", "BORNE_X"), ("y_range", "BORNE_Y"), ("x_scale", "ECHELLE_X"), ("y_scale", "ECHELLE_Y"),
                          ("x_grid", "GRILLE_X"), ("y_grid", "GRILLE_Y")):
            if key in k:
                setattr(self, name, " ".join(k[key]) if key.endswith("TITRE") else k[key])

    # -------------------------------------------------------------------------------------------- Grace

    def xmgrace(self):
        """The text of a Grace project."""
        low, high = self._ranges()
        lines = ["# Grace project file", "@version 50100", "@page size 842, 595", "@with g0",
                 f"@    world {low[0]:.9g}, {low[1]:.9g}, {high[0]:.9g}, {high[1]:.9g}",
                 f'@    title "{_quoted(self.title)}"', f'@    subtitle "{_quoted(self.subtitle)}"',
                 f"@    xaxes scale {_scale(self.x_scale)}", f"@    yaxes scale {_scale(self.y_scale)}",
                 f'@    xaxis label "{_quoted(self.x_label)}"', f'@    yaxis label "{_quoted(self.y_label)}"']
        for axis, grid, scale, k in (("x", self.x_grid, self.x_scale, 0), ("y", self.y_grid, self.y_scale, 1)):
            lines.append(f"@    {axis}axis tick major {_tick(low[k], high[k], scale):.9g}")
            if grid:
                lines += [f"@    {axis}axis tick major grid on", f"@    {axis}axis tick major {grid:.9g}"]
        for i, curve in enumerate(self.curves):
            colour = i % 14 + 1 if curve.colour is None else curve.colour
            lines += [f"@    s{i} type xy", f"@    s{i} line color {colour}", f"@    s{i} line linestyle {1 if curve.line is None else curve.line}",
                      f"@    s{i} symbol {curve.symbol or 0}", f"@    s{i} symbol color {colour}", f"@    s{i} symbol skip {curve.every}",
                      f'@    s{i} legend "{_quoted(curve.legend)}"']
        for i, curve in enumerate(self.curves):
            lines += [f"@target G0.S{i}", "@type xy", *(f"{x:.16g} {y:.16g}" for x, y in zip(curve.x, curve.y)), "&"]
        return "\n".join(lines) + "\n"

    def _ranges(self):
        """((least x, least y), (greatest x, greatest y))"""
        found = []
        for given, scale, values in ((self.x_range, self.x_scale, [v for c in self.curves for v in c.x]),
                                     (self.y_range, self.y_scale, [v for c in self.curves for v in c.y])):
            values = [v for v in values if math.isfinite(v) and (v > 0 or scale == "LIN")] or [1.0]
            low, high = given or (min(values), max(values))
            if low == high:
                low, high = (low / 2, low * 2) if scale == "LOG" else (low - 0.5, low + 0.5)
            found.append((low, high))
        return tuple(zip(*found))

    # ------------------------------------------------------------------------------------------ pictures

    def png(self, path):
        """@throws ImportError where matplotlib is not installed"""
        import matplotlib  # start-up, and optional

        matplotlib.use("Agg")
        from matplotlib.figure import Figure  # after the choice of Agg

        figure = Figure(figsize=(8, 6), layout="constrained")
        axes = figure.add_subplot()
        for i, curve in enumerate(self.curves):
            look = {"color": _colours[curve.colour % 16] if curve.colour is not None else f"C{i % 10}"}
            if curve.line is not None:
                look["linestyle"] = _lines[curve.line % 6]
            if curve.symbol:
                look.update(marker=_symbols[curve.symbol % 11], markevery=curve.every + 1)
            elif len(curve.x) == 1:
                look["marker"] = "o"
            axes.plot(curve.x, curve.y, label=_mathematics(curve.legend) or None, **look)
        axes.set_title("\n".join(filter(None, map(_mathematics, (self.title, self.subtitle)))))
        axes.set_xlabel(_mathematics(self.x_label))
        axes.set_ylabel(_mathematics(self.y_label))
        axes.set_xscale("log" if self.x_scale == "LOG" else "linear")
        axes.set_yscale("log" if self.y_scale == "LOG" else "linear")
        if self.x_range:
            axes.set_xlim(self.x_range)
        if self.y_range:
            axes.set_ylim(self.y_range)
        axes.grid(True, alpha=0.3)
        if any(curve.legend for curve in self.curves):
            axes.legend()
        figure.savefig(path, format="png", dpi=100)


def _scale(name):
    return "Logarithmic" if name == "LOG" else "Normal"


def _tick(low, high, scale):
    """A round distance of ticks; on a logarithmic axis the factor between them."""
    if scale == "LOG":
        return 10.0
    rough = (high - low) / 5
    power = 10.0 ** math.floor(math.log10(rough))
    return next(m * power for m in (1, 2, 5, 10) if m * power >= rough * (1 - 1e-12))


def _quoted(text):
    return text.replace('"', "'").replace("\n", " ")


def _mathematics(text):
    """A text with Grace's escapes as matplotlib writes it: \\s and \\S up to \\N are indices, other escapes change fonts only."""
    text = text.replace("$", r"\$")
    text = re.sub(r"\\s(.*?)(?:\\N|$)", r"$_{\1}$", text)
    text = re.sub(r"\\S(.*?)(?:\\N|$)", r"$^{\1}$", text)
    return re.sub(r"\\(?:[fvhzcrtT]\{[^}]*\}|[^$])", "", text)


def columns(curves):
    """A table of the curves: those with the same abscissae share the column of these."""
    made = {}

    def add(name, values):
        unique = next(n for n in itertools.chain([name], (f"{name}_{i}" for i in itertools.count(2))) if n not in made)
        made[unique] = ("R", values)

    last = None
    for curve in curves:
        if curve.x != last:
            add(curve.names[0], curve.x)
            last = curve.x
        add(curve.legend.strip() or curve.names[1], curve.y)
    return Table.of_columns(made)
