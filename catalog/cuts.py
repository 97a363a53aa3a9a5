"""Completes the rows of cuts.toml: rotations of the body cell, numbers for names, mid nodes of the quadratic cuts.

Used by generate.py. Everything here is in reference coordinates, as exact fractions.
"""

import itertools
from fractions import Fraction


def supports(cell):
    """The vertices of which each node of a completed cell row is the centre."""
    nodes = [[v] for v in range(cell["vertices"])]
    if len(cell["nodes"]) > len(nodes):
        nodes += [list(edge) for edge in cell["edges"]]
    if len(cell["nodes"]) > len(nodes) + 1:
        nodes += facet_corners(cell)
    if len(cell["nodes"]) > len(nodes):
        nodes.append(list(range(cell["vertices"])))
    return nodes


def facet_corners(cell):
    """The vertices of each facet, seen from outside."""
    return [[n for n in own if n < cell["vertices"]] for _, own in cell["facets"]]


def rotations(cell):
    """The node orders of the same cell turned, never mirrored: node j of the turned cell is node order[j]."""
    facets = facet_corners(cell)

    def canonical(facet):
        """The facet, from its smallest vertex on; two vertices have an order of their own (an edge has two sides)."""
        if len(facet) < 3:
            return tuple(facet)
        first = facet.index(min(facet))
        return tuple(facet[first:] + facet[:first])

    known = {canonical(f) for f in facets}
    where = {frozenset(s): i for i, s in enumerate(supports(cell))}
    for order in itertools.permutations(range(cell["vertices"])):
        if all(canonical([order[v] for v in f]) in known for f in facets):
            yield [where[frozenset(order[v] for v in s)] for s in supports(cell)]


def shape(cell, point):
    """Shape functions of a linear SEG2, TRIA3 or QUAD4 at a point: enough for the facets of all cells."""
    if cell["family"] == "TRIA":
        return [1 - point[0] - point[1], point[0], point[1]]
    values = []
    for vertex in cell["nodes"][:cell["vertices"]]:
        value = Fraction(1)
        for x, v in zip(point, vertex):
            value *= (1 + x * Fraction(v)) / 2
        values.append(value)
    return values


def combine(weights, points):
    return tuple(sum(w * p[k] for w, p in zip(weights, points)) for k in range(len(points[0])))


def middle(a, b):
    return tuple((x + y) / 2 for x, y in zip(a, b))


class Nodes:
    """Nodes of one side of a cut (skin or body) by reference coordinates; new ones are appended."""

    def __init__(self, points):
        self.points = list(points)

    def find(self, point):
        return self.points.index(point) if point in self.points else None

    def add(self, point):
        self.points.append(point)
        return len(self.points) - 1


def complete_cut(row, cells, check):
    """The cuts that one row of cuts.toml makes: one, or a linear and a quadratic one."""
    as_list = lambda value: value if isinstance(value, list) else [value]  # noqa: E731
    skins, bodies, kinds = as_list(row["skin"]), as_list(row["body"]), as_list(row["kind"])
    check(len(skins) == len(bodies) == len(kinds), f"cuts.toml: {skins} on {bodies}: as many skins as bodies and kinds")
    return [_complete(row, cells, check, *what) for what in zip(skins, bodies, kinds)]


def _complete(row, cells, check, skin_name, body_name, kind):
    name = f"cuts.toml: {skin_name} on {body_name}"
    check(skin_name in cells and body_name in cells, f"{name}: no such cell")
    skin, body = cells[skin_name], cells[body_name]
    skin_linear, body_linear = cells[skin["linear"]], cells[body["linear"]]
    quadratic = skin["order"] == 2
    exact = lambda points: [tuple(Fraction(x) for x in p) for p in points]  # noqa: E731
    n_corners = skin["vertices"]

    # the facet and the rotations that bring every other one there
    facet = [v - 1 for v in row["facet"]]
    corners = facet_corners(body)
    check(facet in corners, f"{name}: {row['facet']} is not a facet seen from outside")
    placements = []
    named_turns = [[v - 1 for v in turn] for turn in row.get("turns", [])]
    order_of = lambda turn: turn[:body["vertices"]]  # noqa: E731
    turns = sorted(rotations(body), key=lambda turn: order_of(turn) not in named_turns)
    check(all(order_of(turn) in named_turns for turn in turns[:len(named_turns)]), f"{name}: turns: not orders of the body turned")
    for index, (facet_type, _) in enumerate(body["facets"]):
        if facet_type == skin_name:
            order = next((t for t in turns if {t[v] for v in facet} == set(corners[index])), None)
            check(order is not None, f"{name}: no rotation brings facet {index + 1} to {row['facet']}")
            placements.append([index, order])
    check(placements, f"{name}: {body_name} has no facet {skin_name}")

    # new nodes by name
    skin_nodes, body_nodes = Nodes(exact(skin["nodes"])), Nodes(exact(body["nodes"]))
    on_body = lambda p: combine(shape(skin_linear, p), [body_nodes.points[v] for v in facet])  # noqa: E731
    named = {k: exact([v])[0] for k, v in row.get("skin_nodes", {}).items()}
    skin_number = {f"n{i + 1}": i for i in range(len(skin["nodes"]))}
    positions = {f"n{i + 1}": skin_nodes.points[i] for i in range(n_corners)} | named

    def position(text):
        ends = [positions[end] for end in text.split("-")]
        return ends[0] if len(ends) == 1 else middle(*ends)

    for text in row.get("quadratic_nodes", named) if quadratic else named:
        check(skin_nodes.find(position(text)) is None, f"{name}: the skin node {text} is there twice")
        skin_number[text] = skin_nodes.add(position(text))

    def number_cells(cells_of_row, numbers, nodes, may_add):
        """Sub-cells as (type, node numbers), mid nodes by their position."""
        done = []
        for kind_of_cell, *vertices in cells_of_row:
            own = [numbers[v] for v in vertices]
            sub = cells[cells[kind_of_cell]["quadratic"]] if quadratic else cells[kind_of_cell]
            check(len(own) == sub["vertices"], f"{name}: {kind_of_cell} {vertices}")
            for support in supports(sub)[len(own):]:
                check(len(support) == 2, f"{name}: {sub['name']} has nodes that are not half-way between two vertices")
                point = middle(nodes.points[own[support[0]]], nodes.points[own[support[1]]])
                at = nodes.find(point)
                check(at is not None or may_add, f"{name}: no node at {point} in quadratic_nodes")
                own.append(nodes.add(point) if at is None else at)
            done.append([sub["name"], own])
        return done

    skin_cells = number_cells(row.get("skin_cells", []), skin_number, skin_nodes, False)
    if not skin_cells:
        skin_cells = [[skin_name, list(range(len(skin["nodes"])))]]
    new_skin = skin_nodes.points[len(skin["nodes"]):]
    body_number = {f"b{i + 1}": i for i in range(len(body["nodes"]))}
    for text, at in skin_number.items():
        if at >= len(skin["nodes"]):
            body_number[text] = at - len(skin["nodes"]) + len(body["nodes"])
    for point in new_skin:
        body_nodes.add(on_body(point))
    first_new = len(body_nodes.points)
    for text, at in row.get("body_nodes", {}).items():
        body_number[text] = body_nodes.add(exact([at])[0])
    for text in row.get("quadratic_body_nodes", []) if quadratic else []:
        point = middle(*(body_nodes.points[body_number[end]] for end in text.split("-")))
        check(body_nodes.find(point) is None, f"{name}: the body node {text} is there twice")
        body_nodes.add(point)
    body_cells = number_cells(row.get("body_cells", []), body_number, body_nodes, True)
    new_body = body_nodes.points[first_new:]
    used = {n for _, own in skin_cells for n in own}
    check(set(range(len(skin_nodes.points))) <= used, f"{name}: a skin node is in no sub-cell")
    used = {n for _, own in body_cells for n in own}
    check(not body_cells or set(range(len(body_nodes.points))) <= used, f"{name}: a body node is in no sub-cell")

    # the new skin nodes as seen from each vertex of the skin
    vertices = exact(skin["nodes"])[:n_corners]
    turned = []
    for start in range(n_corners):
        seen = [combine(shape(skin_linear, p), [vertices[(i + start) % n_corners] for i in range(n_corners)]) for p in new_skin]
        if n_corners == 2 and start == 1:
            seen = list(new_skin)  # an edge seen from outside has one first vertex only
        check(set(seen) == set(new_skin), f"{name}: the new skin nodes change when the skin cell is turned")
        turned += [new_skin.index(p) for p in seen]
    return {
        "skin": skin_name, "body": body_name, "kind": kind, "option": row.get("option", ""), "facet": facet,
        "skin_nodes": [[float(x) for x in p] for p in new_skin], "body_nodes": [[float(x) for x in p] for p in new_body],
        "skin_cells": skin_cells, "body_cells": body_cells, "carriers": [skin_number[c] for c in row["carriers"]],
        "placements": placements, "turned": turned,
    }


def check_carriers(cuts, patches, slaves, check):
    """The sub-cells and carriers of every cut are those of contact.toml."""
    for cut in cuts:
        name = f"cuts.toml: {cut['skin']} on {cut['body']}"
        patch = next((p for p in patches if p["kind"] == cut["kind"]), None)
        check(patch is not None, f"{name}: contact.toml has no patch {cut['kind']}")
        check([c for c, _ in cut["skin_cells"]] == patch["cells"], f"{name}: contact.toml has {patch['cells']} in patch {cut['kind']}")
        carriers = set()
        for rank, (_, own) in enumerate(cut["skin_cells"], 1):
            for slave in slaves:
                if cut["kind"] in slave["kinds"] and rank in slave.get("ranks", [rank]):
                    carriers |= {own[n - 1] for n in slave["carriers"]}
        check(carriers == set(cut["carriers"]), f"{name}: contact.toml has the carriers {sorted(carriers)}")
