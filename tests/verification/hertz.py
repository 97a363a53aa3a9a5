"""Contact of a paraboloid with a half space, and of a parabolic cylinder with one, of the same material: Hertz' theory and what is found.

Bodies are 200 times as large as the contact, so that what their far ends do to it is below the error of the meshes; in the plane that falls
as slowly as the inverse of their size.
"""

import dataclasses
import math

import numpy as np
from contact import contact_study, run_contact
from meshes import block, union
from report import Zone

RADIUS, YOUNG, POISSON = 1.0, 2000.0, 0.3
HALF_WIDTH = 0.005                  #: of the contact, about
EXTENT = 200 * HALF_WIDTH
MODULUS = YOUNG / (2 * (1 - POISSON**2))
MESHES = (4, 8, 16)                 #: cells along the half-width
MODELS = {"D_PLAN": "cylinder", "AXIS": "sphere"}
DEPTH = 4 * HALF_WIDTH              #: of the points that approach each other


@dataclasses.dataclass
class Contact:
    pressure: float  #: the largest
    radius: float    #: or half of the width
    approach: float  #: of the points on the axis at DEPTH in both bodies


def theory(model, force):
    """@param force of the half plane x > 0 in D_PLAN, where it is by unit of depth"""
    if model == "AXIS":
        radius = (3 * force * RADIUS / (4 * MODULUS)) ** (1 / 3)
        pressure = 3 * force / (2 * math.pi * radius**2)
    else:
        radius = math.sqrt(8 * force * RADIUS / (math.pi * MODULUS))
        pressure = 4 * force / (math.pi * radius)
    return Contact(pressure, radius, 2 * integral(lambda z: -pressure * strain(model, z), DEPTH / radius) * radius)


def strain(model, z):
    """Along the axis, at the depth z over the radius, of a largest pressure 1 (Johnson, Contact mechanics, 3.45 and 4.46)."""
    if model == "AXIS":
        axial = -1 / (1 + z**2)
        radial = -(1 + POISSON) * (1 - z * np.arctan2(1, z)) - axial / 2
        return (axial - 2 * POISSON * radial) / YOUNG
    root = np.sqrt(1 + z**2)
    along = -((1 + 2 * z**2) / root - 2 * z)
    return ((1 - POISSON**2) * -1 / root - POISSON * (1 + POISSON) * along) / YOUNG


def integral(function, end):
    points, weights = np.polynomial.legendre.leggauss(40)
    return float(end / 2 * (weights @ function(end / 2 * (points + 1))))


def graded(cells):
    """From 0: cells of the same width to twice the contact's, then each a third longer than the one before."""
    width = HALF_WIDTH / cells
    lines = list(width * np.arange(2 * cells + 1))
    while lines[-1] < EXTENT:
        width *= 4 / 3
        lines.append(lines[-1] + width)
    return np.array(lines) * EXTENT / lines[-1]


def study(model, cells):
    lines = graded(cells)
    axis = {"left": "AXIS"}

    def above(x, y):
        bottom = x**2 / (2 * RADIUS)
        return x, bottom + y * (EXTENT - bottom) / EXTENT

    upper = block("QUAD8", lines, lines, above, "UPPER", {"bottom": "SLAVE", "top": "TOP", **axis})
    coarser = np.append(0, lines[1:] * (1 - 0.3 * np.exp(-lines[1:] / HALF_WIDTH)))  # lines of the two do not meet
    lower = block("QUAD8", coarser, -lines[::-1], None, "LOWER", {"top": "MASTER", "bottom": "BASE", **axis})
    far = 2 * math.log(2 * EXTENT / HALF_WIDTH) - POISSON / (1 - POISSON)
    approach = HALF_WIDTH**2 / RADIUS * (1 if model == "AXIS" else far / 4)
    return contact_study(union([upper, lower]), [{"GROUP_MA": "AXIS", "DX": 0}, {"GROUP_MA": "BASE", "DY": 0}, {"GROUP_MA": "TOP", "DY": -approach}],
                         model=model, zone={"CONTACT_INIT": "INTERPENETRE"}, convergence={"RESI_GLOB_RELA": 1e-10, "ITER_GLOB_MAXI": 30})


def found(model, result):
    """@return (Contact, the force)"""
    zone = Zone(result, "SLAVE")
    pressure, active = zone.pressure(1), zone.active(1)
    weight = zone.width * (2 * math.pi * zone.middle if model == "AXIS" else 1)
    inner = active & (np.cumsum(active) < active.sum())  # the last one is in contact in part
    slope, square = np.polyfit(zone.middle[inner] ** 2, pressure[inner] ** 2, 1)  # p^2 = p0^2 (1 - x^2 / a^2)
    down = result.at_nodes("DEPL", 1, "DY")

    def on_axis(body, height):
        nodes = np.unique(np.concatenate([result.cells[c][1] for c in result.groups[body]]))
        nodes = nodes[np.argsort(result.points[nodes, 0], kind="stable")]
        nodes = nodes[result.points[nodes, 0] < 1e-12]
        order = np.argsort(result.points[nodes, 1])
        return np.interp(height, result.points[nodes[order], 1], down[nodes[order]])

    approach = (on_axis("UPPER", 0) - on_axis("UPPER", DEPTH)) - (on_axis("LOWER", 0) - on_axis("LOWER", -DEPTH))
    return Contact(math.sqrt(square), math.sqrt(-square / slope), approach), float(pressure @ weight)


def errors(test):
    """@return model -> of each mesh (found, theory)"""
    cases = [(model, cells) for model in MODELS for cells in MESHES]
    _, results = run_contact(test, [study(*case) for case in cases])
    table = {model: [] for model in MODELS}
    for (model, _), result in zip(cases, results):
        contact, force = found(model, result)
        table[model].append((contact, theory(model, force)))
    return table
