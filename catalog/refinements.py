"""Completes the rows of refinements.toml: points as weights of the cell's vertices, mid nodes of the sub-cells.

Used by generate.py. A point is known by its weights, multiples of 1 / SCALE: the same point of two cells has the same weights of
the same vertices, and its reference coordinates are the weighted mean of the vertices'.
"""

from fractions import Fraction

from cuts import combine, supports

#: weights are integers over it: a vertex of a sub-cell is the mean of up to 8 vertices, a node of a sub-cell that of up to 8 of those
SCALE = 64


def complete_refinements(rows, cells, check):
    """One row for each cell, linear or not, that a row of refinements.toml makes."""
    by_name = {row["cell"]: row for row in rows}
    check(len(by_name) == len(rows), "refinements.toml: a cell is there twice")
    done = []
    for cell in cells.values():
        row = by_name.pop(cell["linear"], None) if cell["name"] == cell["linear"] else None
        if row:
            same = [c for c in cells.values() if c["linear"] == cell["name"]]
            done += [_complete(row, version, cells, check) for version in same]
    check(not by_name, f"refinements.toml: {sorted(by_name)}: no such linear cell")
    linear = {row["cell"]: row for row in done}
    for row in done:
        _check_facets(row, cells, linear, check)
    return done


def _mean(points):
    return tuple(sum(p[k] for p in points) / len(points) for k in range(len(points[0])))


def _complete(row, cell, cells, check):
    name = f"refinements.toml: {cell['name']}"
    n = cell["vertices"]
    vertex = [tuple(Fraction(int(i == k)) for k in range(n)) for i in range(n)]
    points = [_mean([vertex[v] for v in support]) for support in supports(cell)]
    own = len(points)
    reference = [tuple(Fraction(x) for x in p) for p in cell["nodes"][:n]]

    def number(point):
        if point not in points:
            check(all((SCALE * w).denominator == 1 for w in point), f"{name}: the weights {point} are no multiples of 1/{SCALE}")
            points.append(point)
        return points.index(point)

    def named(text):
        numbers = [int(v) - 1 for v in text.split("-")]
        check(set(numbers) <= set(range(n)), f"{name}: {text} names no vertex")
        return _mean([vertex[v] for v in numbers])

    def version(kind):
        """The cell of this family with the kinds of nodes that `cell` has."""
        linear = cells[kind]
        if cell["order"] == 1:
            return linear
        complete = cell["name"] != cells[cell["linear"]]["quadratic"]
        found = [c for c in cells.values() if c["linear"] == kind and c["order"] == 2]
        check(found, f"{name}: {kind} has no quadratic cell")
        return max(found, key=lambda c: len(c["nodes"])) if complete else cells[linear["quadratic"]]

    def numbered(sub_cells):
        made = []
        for kind, *texts in sub_cells:
            check(kind in cells, f"{name}: no such cell {kind}")
            corners = [named(text) for text in texts]
            check(len(corners) == cells[kind]["vertices"], f"{name}: {kind} {texts}")
            sub = version(kind)
            made.append([sub["name"], [number(_mean([corners[v] for v in support])) for support in supports(sub)]])
        return made

    def volume(sub_cells):
        total = 0
        for kind, numbers in sub_cells:
            place = [combine(points[p], reference) for p in numbers]
            own_volume = _volume(cells[kind], place)
            check(own_volume > 0, f"{name}: the sub-cell {kind} at {[tuple(map(str, p)) for p in place]} is inside out")
            total += own_volume
        return total

    sub_cells = numbered(row["cells"])
    choices = [{"diagonal": [number(named(end)) for end in choice["diagonal"]], "cells": numbered(choice["cells"])}
               for choice in row.get("choices", [])]
    for choice in choices or [{"cells": []}]:
        check(volume(sub_cells) + volume(choice["cells"]) == _volume(cell, reference), f"{name}: the sub-cells do not fill the cell")
    return {
        "cell": cell["name"], "own": own,
        "weights": [[int(SCALE * w) for w in p] for p in points],
        "points": [[float(x) for x in combine(p, reference)] for p in points],
        "cells": sub_cells, "choices": choices,
    }


def _volume(cell, place):
    """Measure of a linear cell with plane facets, exactly."""
    if cell["dimension"] == 1:
        return place[1][0] - place[0][0]
    if cell["dimension"] == 2:
        ring = place[:cell["vertices"]]
        return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:] + ring[:1])) / 2
    total = 0
    for _, numbers in cell["facets"]:
        corners = [place[v] for v in numbers if v < cell["vertices"]]
        for b, c in zip(corners[1:], corners[2:]):
            a = corners[0]
            total += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    return total


def _check_facets(row, cells, rows, check):
    """Two cells with a common facet cut it alike: as the facet's own row does."""
    cell = cells[row["cell"]]
    if cell["dimension"] < 2:
        return
    for kind, numbers in cell["facets"]:
        corners = [v for v in numbers if v < cell["vertices"]]
        expected = set()
        for _, own in rows[kind]["cells"]:
            weights = [[0] * cell["vertices"] for _ in own]
            for at, point in zip(weights, own):
                for vertex, weight in zip(corners, rows[kind]["weights"][point]):
                    at[vertex] = weight
            expected.add(frozenset(map(tuple, weights)))
        for choice in row["choices"] or [{"cells": []}]:
            found = set()
            for sub, own in row["cells"] + choice["cells"]:
                for _, local in cells[sub]["facets"]:
                    weights = [tuple(row["weights"][own[i]]) for i in local]
                    if all(w == 0 for point in weights for v, w in enumerate(point) if v not in corners):
                        found.add(frozenset(weights))
            check(found == expected, f"refinements.toml: {row['cell']} cuts a facet {kind} otherwise than {kind} itself")
