"""Curved contact with a closed form, on three meshes each: nested spheres, and rings under a pressure that varies around them. test_convergence.py judges it, book.py tabulates it."""

import math
import types

import numpy as np
from contact import contact_study, run_contact
from meshes import block, brick, union, weld

INNER, MIDDLE, OUTER, PRESSURE = 20.0, 30.0, 40.0, 25.0
#: Lame, one hollow sphere: sigma_rr = p a^3 / (b^3 - a^3) (1 - b^3 / r^3) at the contact
SPHERE = PRESSURE * INNER**3 / (OUTER**3 - INNER**3) * (1 - OUTER**3 / MIDDLE**3)


def spheres_in_axisymmetry(kind, n):
    """Quarters of two nested spheres: n cells along the slave (inner) skin, about 1.4 n along the master."""

    def shell(first, last, columns, rows, name, sides):
        return block(kind, np.linspace(first, last, rows + 1), np.linspace(0, math.pi / 2, columns + 1),
                     lambda r, angle: (r * math.cos(angle), r * math.sin(angle)), name, {**sides, "bottom": "YZERO", "top": "XZERO"})

    other = n + 2 * n // 5 + 1
    mesh = union([shell(INNER, MIDDLE, n, max(2, n // 3), "INSIDE", {"left": "LOAD", "right": "SLAVE"}),
                  shell(MIDDLE, OUTER, other, max(2, n // 3), "OUTSIDE", {"left": "MASTER"})])
    return contact_study(mesh, [{"GROUP_MA": "XZERO", "DX": 0}, {"GROUP_MA": "YZERO", "DY": 0}],
                         [{"GROUP_MA": "LOAD", "PRES": PRESSURE}], model="AXIS", smooth="OUI", zone={"CONTACT_INIT": "OUI"},
                         convergence={"RESI_GLOB_RELA": 1e-9, "ITER_GLOB_MAXI": 30})


def spheres_in_space(kind, n, cut="PYRA"):
    """Eighths of two nested spheres: 3 n^2 cells on the slave skin, 3 (n + 1)^2 on the master."""

    def shell(first, last, count, name, sides):
        angles = np.linspace(0, math.pi / 4, count + 1)

        def place(turn):
            def at(a, b, r):
                direction = np.array([math.tan(a), math.tan(b), 1.0])
                return r * np.roll(direction / np.linalg.norm(direction), turn)
            return at

        # three parts around the middle of the eighth, each the image of the first under a cyclic change of axes
        planes = ("XZERO", "YZERO", "ZZERO")
        parts = [brick(kind, [angles, angles, np.linspace(first, last, max(2, count // 2) + 1)], place(turn), name,
                       {**sides, (0, 0): planes[turn % 3], (1, 0): planes[(1 + turn) % 3]}, curved=True) for turn in range(3)]
        return weld(union(parts), 1e-7)

    mesh = union([shell(INNER, MIDDLE, n, "INSIDE", {(2, 0): "LOAD", (2, 1): "SLAVE"}), shell(MIDDLE, OUTER, n + 1, "OUTSIDE", {(2, 0): "MASTER"})])
    hold = [{"GROUP_MA": f"{axis}ZERO", f"D{axis}": 0} for axis in "XYZ"]
    return contact_study(mesh, hold, [{"GROUP_MA": "LOAD", "PRES": PRESSURE}], smooth="OUI", cut=cut, zone={"CONTACT_INIT": "OUI"},
                         convergence={"RESI_GLOB_RELA": 1e-9, "ITER_GLOB_MAXI": 30})


#: rings of radii 0.2, 0.6, 1 under the outer pressure mean + wave cos(2 angle), plane strain
RINGS = types.SimpleNamespace(radii=(0.2, 0.6, 1.0), poisson=0.2, mean=1e7, wave=1e5)
LINEAR = ("TRIA3", "QUAD4", "HEXA8")


def young_of_rings(kind):
    """The pressure does not depend on it at small displacements. Chords leave gaps that matter the more the stiffer the rings are; contact at
    finite displacements differs from the closed form by p / E, which quadratic cells would show at 1e9."""
    return 1e9 if kind in LINEAR else 1e11


def ring_pressure():
    """LAGS_C between two rings without friction: (mean, factor of cos 2 angle). The mean is Lame's; the wave is Michell's solution
    (A r^2 + B r^4 + C r^-2 + D) cos 2 angle in each ring, without shear at the contact, radial stress and displacement the same on both sides."""
    a, c, b = RINGS.radii
    kappa = 3 - 4 * RINGS.poisson

    def radial(r):
        return np.array([-2, 0, -6 * r**-4, -4 * r**-2])

    def shear(r):
        return np.array([2, 6 * r**2, -6 * r**-4, -2 * r**-2])

    def displacement(r):
        return np.array([-2 * r, (kappa - 3) * r**3, 2 * r**-3, (kappa + 1) / r])

    none = np.zeros(4)
    system = [(radial(a), none), (shear(a), none), (shear(c), none), (none, shear(c)), (radial(c), -radial(c)), (displacement(c), -displacement(c)),
              (none, radial(b)), (none, shear(b))]
    inner = np.linalg.solve(np.array([np.concatenate(row) for row in system]), [0, 0, 0, 0, 0, 0, -RINGS.wave, 0])[:4]
    return -RINGS.mean * (1 - a**2 / c**2) / (1 - a**2 / b**2), radial(c) @ inner


def ring_exact(x):
    mean, wave = ring_pressure()
    return mean + wave * math.cos(2 * math.atan2(x[1], x[0]))


def rings(kind, n):
    """Quarters of the two rings: n cells along the slave (inner) skin, about 1.4 n along the master."""
    a, c, b = RINGS.radii

    def ring(first, last, columns, name, sides):
        return block(kind, np.linspace(first, last, max(2, n // 2) + 1), np.linspace(0, math.pi / 2, columns + 1),
                     lambda r, angle: (r * math.cos(angle), r * math.sin(angle)), name, {**sides, "bottom": "YZERO", "top": "XZERO"})

    mesh = union([ring(a, c, n, "INSIDE", {"right": "SLAVE"}), ring(c, b, n + 2 * n // 5 + 1, "OUTSIDE", {"left": "MASTER", "right": "OUTER"})])
    return contact_study(mesh, [{"GROUP_MA": "XZERO", "DX": 0}, {"GROUP_MA": "YZERO", "DY": 0}], model="D_PLAN", smooth="OUI",
                         varying={"OUTER": f"{RINGS.mean} + {RINGS.wave} * cos(2 * atan2(Y, X))"},
                         elastic={"E": young_of_rings(kind), "NU": RINGS.poisson}, zone={"CONTACT_INIT": "OUI"},
                         convergence={"RESI_GLOB_RELA": 1e-9, "ITER_GLOB_MAXI": 30})


def pressure_error(result, exact):
    """Root of the mean of squares over the slave cells, weighted with their size, and the largest: both relative to the largest exact value.
    @param exact pressure at a point"""
    last = result.orders[-1]
    support, values = result.field("CONT_ELEM", last)
    errors, sizes, scale = [], [], 0.0
    for cell, pressure in zip(support, values["PRES"]):
        kind, nodes = result.cells[cell]
        points = result.points[nodes]
        if points.shape[1] == 2:
            size = np.linalg.norm(points[1] - points[0])
        else:
            corners = points[:3] if kind.startswith("TRIA") else points[:4]
            size = 0.5 * np.linalg.norm(np.cross(corners[2] - corners[0], corners[-1] - corners[1] if len(corners) == 4 else corners[1] - corners[0]))
        middle = points.mean(axis=0)
        errors.append(pressure - exact(middle))
        scale = max(scale, abs(exact(middle)))
        sizes.append(size)
    errors, sizes = np.array(errors), np.array(sizes)
    return types.SimpleNamespace(mean=math.sqrt(sizes @ errors**2 / sizes.sum()) / scale, largest=np.abs(errors).max() / scale)


def orders(values, counts):
    """Observed order between a mesh and the next."""
    return [math.log(a / b) / math.log(m / n) for a, b, n, m in zip(values, values[1:], counts, counts[1:])]


#: name -> (study of n cells, the three n, exact pressure at a point)
CASES = {
    f"{what}, {kind}": (lambda n, kind=kind, make=make: make(kind, n), (16, 32, 64) if kind in LINEAR else (8, 16, 32), exact)
    for what, make, exact in (("spheres, AXIS", spheres_in_axisymmetry, lambda x: SPHERE), ("rings", rings, ring_exact))
    for kind in ("TRIA3", "QUAD4", "TRIA6", "QUAD8", "QUAD9")
}
SPACE_CASES = {
    f"spheres, 3D, {kind}": (lambda n, kind=kind, cut=cut: spheres_in_space(kind, n, cut), counts, lambda x: SPHERE)
    for kind, cut, counts in (("HEXA8", "HEXA", (4, 6, 9)), ("TETRA10", "PYRA", (2, 4, 8)), ("HEXA20", "PYRA", (2, 4, 8)), ("HEXA27", "PYRA", (2, 4, 8)))
}


def errors(test, cases):
    """@return name -> pressure errors on its three meshes"""
    studies = [make(n) for make, counts, _ in cases.values() for n in counts]
    _, results = run_contact(test, studies, CONTACT_ALARMS="ALARME")  # pressures that follow facets are told, and what is measured here
    found, results = {}, iter(results)
    for name, (_, counts, exact) in cases.items():
        found[name] = [pressure_error(next(results), exact) for _ in counts]
    return found
