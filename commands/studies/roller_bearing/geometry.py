"""Dimensions of the study, mm and MPa: what the mesh, the command file and the report agree on."""

#: radii: of the roller, of the inner ring's outer face (it bulges), of the outer ring's inner face (it is hollow)
ROLLER, INNER, OUTER = 10.0, 30.0, 50.0
#: thickness of the rings, and how far they reach to the left and right
RING, REACH = 12.0, 16.0
#: the rings' common centre lies below the roller's, which is the origin
CENTRE = -(INNER + ROLLER)
#: the roller is mounted with a preload: its radius is larger than the room between the rings allows
PRELOAD = 0.004
#: (E, nu): a polymer roller (PEEK) between steel rings
POLYMER, STEEL = (3600.0, 0.38), (210000.0, 0.3)
#: how far the outer ring comes down
PRESS = 0.2
STEPS = 8


def hertz(force, radius_sum):
    """Line contact of two cylinders of a polymer and of steel. @param force N/mm @param radius_sum 1/R1 + 1/R2, 1/mm
    @return (half-width mm, largest pressure MPa)"""
    from math import pi, sqrt

    compliance = sum((1 - nu**2) / young for young, nu in (POLYMER, STEEL))
    half_width = sqrt(4 * force * compliance / (pi * radius_sum))
    return half_width, 2 * force / (pi * half_width)
