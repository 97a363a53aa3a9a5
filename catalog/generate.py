#!/usr/bin/env python3
"""Turn the catalogue's TOML rows into constexpr C++ tables and one JSON for Python.

usage: generate.py CATALOG_FOLDER OUTPUT_FOLDER

Writes OUTPUT/lacon/catalog/cell_type.hpp, OUTPUT/tables.cpp and OUTPUT/catalog.json. Every cross-reference between
rows is checked here: a row that names a cell, component or rank that does not exist stops the build.
"""

import json
import pathlib
import re
import sys
import tomllib

import cuts
import refinements


class CatalogError(Exception):
    """A row of the catalogue contradicts another."""


def check(condition, message):
    if not condition:
        raise CatalogError(message)


def load(folder):
    """All rows, as one dictionary: the content of catalog.json."""

    def read(path):
        with open(path, "rb") as file:
            try:
                return tomllib.load(file)
            except tomllib.TOMLDecodeError as error:
                raise CatalogError(f"{path}: {error}") from error

    messages = {}
    for path in sorted((folder / "messages").glob("*.toml")):
        if path.name == "parts.toml":
            continue
        for identifier, row in read(path).items():
            check(identifier not in messages, f"{path}: message {identifier} is there twice")
            check(set(row) == {"severity", "text", "do"}, f"{path}: {identifier} has {sorted(row)}")
            check(row["severity"] in "FSAI", f"{path}: {identifier}: severity {row['severity']}")
            messages[identifier] = row
    parts = read(folder / "messages/parts.toml")
    french, french_parts = read_french(folder, read, messages, parts)
    elements = []
    for path in sorted((folder / "elements").glob("*.toml")):
        elements += read(path)["element"]
    contact = read(folder / "contact.toml")
    cells = [complete_cell(row, rows) for rows in [read(folder / "cells.toml")["cell"]] for row in rows]
    by_name = {cell["name"]: cell for cell in cells}
    all_cuts = [cut for row in read(folder / "cuts.toml")["cut"] for cut in cuts.complete_cut(row, by_name, check)]
    cuts.check_carriers(all_cuts, contact["patch"], contact["slave"], check)
    return {
        "cells": cells,
        "cuts": all_cuts,
        "refinements": refinements.complete_refinements(read(folder / "refinements.toml")["refinement"], by_name, check),
        "patches": contact["patch"],
        "slaves": contact["slave"],
        "elements": complete_elements(elements),
        **read(folder / "behaviours.toml"),
        "quantities": read(folder / "quantities.toml")["quantity"],
        "result_fields": complete_result_fields(read(folder / "quantities.toml")),
        "messages": messages,
        "parts": parts,
        "french": {"messages": french, "parts": french_parts},
        "instead": read(folder / "instead.toml"),
        "instead_in_french": read(folder / "instead.fr.toml"),
        "commands": complete_commands({path.stem.upper(): read(path) for path in sorted((folder / "commands").glob("*.toml"))}),
        "help_in_french": read(folder / "help.fr.toml"),
        "options_in_french": read(folder / "options.fr.toml"),
    }


def complete_result_fields(rows):
    """[(name of a field of results, its types)], families written out."""
    complete = [(name, row["types"]) for row in rows["result_field"] for name in row["names"]]
    complete += [(f"{name}_{place}", [f"{place}_{row['quantity']}"]) for row in rows["result_family"] for name in row["names"] for place in row["places"]]
    quantities = {row["name"] for row in rows["quantity"]}
    for name, types in complete:
        check(all(t.partition("_")[2] in quantities for t in types), f"quantities.toml: {name} is of an unknown quantity: {types}")
    return complete


def complete_elements(rows):
    """Rows that are like others, written out: their cells with other numbers of points, less those they are without."""
    known = [row for row in rows if "like" not in row]
    complete = list(known)
    for row in rows:
        if "like" not in row:
            continue
        models = [model for model in known if model["modelisation"] == row["like"]]
        served = {cell for model in models for cell in model["points"]}
        check(set(row["points"]) | set(row.get("without", ())) <= served, f"elements: {row['modelisation']} changes cells that {row['like']} does not have")
        for model in models:
            points = {cell: row["points"].get(cell, n) for cell, n in model["points"].items() if cell not in row.get("without", ())}
            complete.append({**model, "modelisation": row["modelisation"], "points": points})
    return complete


def gaps(words):
    """The names between braces."""
    return sorted(set(re.findall(r"\{(\w+)\}", words)))


def read_french(folder, read, messages, parts):
    """(messages, parts) in French. A gap that only one of the languages has stops the build; words that are missing stay English."""
    french = {}
    for path in sorted((folder / "messages/fr").glob("*.toml")):
        rows = read(path)
        if path.name == "parts.toml":
            french_parts = rows
            continue
        for identifier, row in rows.items():
            check(identifier in messages and identifier not in french, f"{path}: {identifier} is no message, or there twice")
            check(set(row) == {"text", "do"}, f"{path}: {identifier} has {sorted(row)}")
            for key in row:
                check(gaps(row[key]) == gaps(messages[identifier][key]), f"{path}: {identifier} has other gaps than in English")
            french[identifier] = row
    for name, words in french_parts.items():
        check(name in parts and gaps(words) == gaps(parts[name]), f"{folder}/messages/fr/parts.toml: {name} is no part, or has other gaps than in English")
    return french, french_parts


def complete_commands(commands):
    """Commands that are like another one get its rows."""
    for name, row in commands.items():
        check("like" not in row or "like" not in commands.get(row["like"], {"like": ""}), f"commands: {name} is like no command with rows of its own")
    return {name: {**commands.get(row.get("like"), {}), **row} for name, row in commands.items()}


# ---------------------------------------------------------------------------------------------------- cells


def complete_cell(row, rows):
    """A cell row with everything derived: nodes, facets, mirror and MED permutation over all nodes, 0-based."""
    linear = next((r for r in rows if r["name"] == row.get("linear", row["name"])), None)
    check(linear is not None, f"cell {row['name']}: its linear cell {row.get('linear')} does not exist")
    adds = row.get("adds", [])
    vertices = linear["vertices"]
    edges = [tuple(v - 1 for v in e) for e in linear.get("edges", [])]
    facets = [(f[0], [v - 1 for v in f[1:]]) for f in linear.get("facets", [])]
    dimension = len(vertices[0])
    node_of_edge, node_of_facet = {}, {}
    nodes = [list(map(float, v)) for v in vertices]

    def centre(of):
        return [sum(vertices[v][k] for v in of) / len(of) for k in range(dimension)]

    if "edges" in adds:
        for edge in edges:
            node_of_edge[frozenset(edge)] = len(nodes)
            nodes.append(centre(edge))
    if "facets" in adds:
        for _, facet in facets:
            node_of_facet[frozenset(facet)] = len(nodes)
            nodes.append(centre(facet))
    if "centre" in adds:
        nodes.append(centre(range(len(vertices))))

    # the facet's own node: its edges' and, where it has one, its centre's
    by_size = {("POI1", 0): "POI1", ("SEG2", 0): "SEG2", ("SEG2", 1): "SEG3", ("TRIA3", 0): "TRIA3", ("TRIA3", 1): "TRIA6",
               ("QUAD4", 0): "QUAD4", ("QUAD4", 1): "QUAD8", ("QUAD4", 2): "QUAD9"}
    full_facets = []
    for name, facet in facets:
        own = list(facet)
        level = 0
        if node_of_edge and len(facet) > 1:
            level = 1
            ring = [(0, 1)] if len(facet) == 2 else [(i, (i + 1) % len(facet)) for i in range(len(facet))]
            own += [node_of_edge[frozenset((facet[i], facet[j]))] for i, j in ring]
            if frozenset(facet) in node_of_facet and len(facet) == 4:
                level = 2
                own.append(node_of_facet[frozenset(facet)])
        full_facets.append([by_size[name, level], own])

    flip = [v - 1 for v in linear["mirror"]]
    mirror = list(flip)
    mirror += [node_of_edge[frozenset(flip[v] for v in edge)] for edge in edges if node_of_edge]
    mirror += [node_of_facet[frozenset(flip[v] for v in facet)] for _, facet in facets if node_of_facet]
    mirror += list(range(len(mirror), len(nodes)))

    permutations = {key: [v - 1 for v in row.get(key, range(1, len(nodes) + 1))]
                    for key in ("med_permutation", "vtk_permutation", "gmsh_permutation")}
    for what, order in (("mirror", mirror), *permutations.items()):
        check(sorted(order) == list(range(len(nodes))), f"cell {row['name']}: {what} is not a permutation")
    same = [r["name"] for r in rows if r.get("linear") == linear["name"]]
    return {
        "name": row["name"], "family": linear["family"], "dimension": dimension, "vertices": len(vertices),
        "order": 2 if adds else 1, "nodes": nodes, "edges": edges, "facets": full_facets, "mirror": mirror, "med": row["med"],
        "vtk": row["vtk"], "gmsh": row["gmsh"], **permutations,
        "linear": linear["name"], "quadratic": same[0] if same else row["name"],
    }


# ---------------------------------------------------------------------------------------------------- C++


class Writer:
    """Collects static arrays and hands out the spans that refer to them."""

    def __init__(self):
        self.arrays = []

    def span(self, kind, items):
        items = list(items)
        if not items:
            return "{}"
        name = f"a{len(self.arrays)}"
        self.arrays.append(f"constexpr {kind} {name}[] = {{{', '.join(items)}}};")
        return name

    def integers(self, values):
        return self.span("std::int8_t", map(str, values))

    def strings(self, values):
        return self.span("std::string_view", map(text, values))


def text(value):
    return json.dumps(value, ensure_ascii=False)


def table(writer, kind, rows):
    """A named table of `rows` (C++ initialisers) behind a function that returns it as a span."""
    return writer.span(kind, rows)


def write_cpp(catalog, writer):
    names = [c["name"] for c in catalog["cells"]]
    kind = lambda name: f"CellType::{name}"  # noqa: E731
    tables = {}

    rows = []
    for c in catalog["cells"]:
        facets = writer.span("FacetRow", (f"{{{kind(n)}, {writer.integers(own)}}}" for n, own in c["facets"]))
        edges = writer.span("EdgeRow", (f"{{{a}, {b}}}" for a, b in c["edges"]))
        rows.append(
            f"{{{kind(c['name'])}, {text(c['name'])}, Family::{c['family']}, {c['dimension']}, {len(c['nodes'])}, {c['vertices']}, "
            f"{c['order']}, {writer.span('double', (repr(x) for n in c['nodes'] for x in n))}, {edges}, {facets}, "
            f"{writer.integers(c['mirror'])}, {text(c['med'])}, {writer.integers(c['med_permutation'])}, "
            f"{c['vtk']}, {writer.integers(c['vtk_permutation'])}, {c['gmsh']}, {writer.integers(c['gmsh_permutation'])}, "
            f"{kind(c['linear'])}, {kind(c['quadratic'])}}}")
    tables["cells", "CellRow"] = rows

    kinds = {}
    for p in catalog["patches"]:
        for n in p["cells"]:
            check(n in names, f"contact.toml: patch {p['kind']} names the cell {n}")
        kinds[p["kind"]] = p["cells"]
    tables["patches", "PatchRow"] = [
        f"{{{p['kind']}, {writer.span('CellType', map(kind, p['cells']))}}}" for p in catalog["patches"]]
    rows, seen = [], set()
    for s in catalog["slaves"]:
        for k in s["kinds"]:
            check(k in kinds, f"contact.toml: {s['element']} names the patch kind {k}")
            for rank in s.get("ranks", range(1, len(kinds[k]) + 1)):
                check(kinds[k][rank - 1] == s["cell"], f"contact.toml: sub-cell {rank} of patch {k} is not a {s['cell']}")
                check((k, rank) not in seen, f"contact.toml: sub-cell {rank} of patch {k} is there twice")
                seen.add((k, rank))
                rows.append(f"{{{k}, {rank - 1}, {text(s['element'])}, {kind(s['cell'])}, "
                            f"{writer.integers(n - 1 for n in s['carriers'])}}}")
    missing = [(k, r + 1) for k, cells in kinds.items() for r in range(len(cells)) if (k, r + 1) not in seen]
    check(not missing, f"contact.toml: no slave element for (patch kind, rank) {missing}")
    tables["slaves", "SlaveRow"] = rows

    def sub_cells(items):
        return writer.span("SubCell", (f"{{{kind(n)}, {writer.integers(own)}}}" for n, own in items))

    tables["cuts", "CutRow"] = [
        f"{{{kind(c['skin'])}, {kind(c['body'])}, {text(c['option'])}, {c['kind']}, {writer.integers(c['facet'])}, "
        f"{writer.span('double', (repr(x) for p in c['skin_nodes'] for x in p))}, "
        f"{writer.span('double', (repr(x) for p in c['body_nodes'] for x in p))}, "
        f"{sub_cells(c['skin_cells'])}, {sub_cells(c['body_cells'])}, {writer.integers(c['carriers'])}, "
        + writer.span("Placement", (f"{{{f}, {writer.integers(own)}}}" for f, own in c["placements"]))
        + f", {writer.integers(c['turned'])}}}" for c in catalog["cuts"]]

    def choices(items):
        return writer.span("RefinementChoice", (f"{{{c['diagonal'][0]}, {c['diagonal'][1]}, {sub_cells(c['cells'])}}}" for c in items))

    tables["refinements", "RefinementRow"] = [
        f"{{{kind(r['cell'])}, {writer.integers(w for p in r['weights'] for w in p)}, "
        f"{writer.span('double', (repr(x) for p in r['points'] for x in p))}, {sub_cells(r['cells'])}, {choices(r['choices'])}}}"
        for r in catalog["refinements"]]

    rows = []
    for e in catalog["elements"]:
        in_plane = e["role"] == "solid" and e["geometry"] == "plane"
        check(("stress_state" in e) == in_plane, f"elements: {e['modelisation']}: solids in the plane have a stress_state, others none")
        for cell, points in e["points"].items():
            check(cell in names, f"elements: {e['modelisation']} names the cell {cell}")
            kernels = writer.span("KernelRow", (f"{{{text(o)}, {text(k)}}}" for o, k in e["kernels"].items()))
            rows.append(f"{{{text(e['modelisation'] + '/' + cell)}, {text(e['modelisation'])}, {text(e['phenomenon'])}, {kind(cell)}, "
                        f"Role::{e['role']}, Geometry::{e['geometry']}, StressState::{e.get('stress_state', 'full')}, {points}, {writer.strings(e['dofs'])}, {writer.strings(e['stress'])}, {kernels}}}")
    tables["elements", "ElementRow"] = rows

    relations, deformations = ({row["name"] for row in catalog[kind]} for kind in ("relation", "deformation"))
    for option in {option for e in catalog["elements"] for option in e["kernels"] if "/" in option}:
        relation, deformation = option.split("/")
        check(relation in relations and deformation in deformations, f"elements: there is no behaviour {option}")
    tables["relations", "RelationRow"] = [
        f"{{{text(r['name'])}, {text(r.get('hardening', ''))}, TransverseStrain::{r.get('transverse_strain', 'unknown')}, "
        f"{cpp_bool(r.get('starts_elastically', False))}}}"
        for r in catalog["relation"]]
    tables["deformations", "DeformationRow"] = [
        f"{{{text(d['name'])}, StressGeometry::{d['stress_geometry']}, StrainMeasure::{d['strain']}, PlasticStrain::{d.get('plastic_strain', 'unknown')}, "
        f"{cpp_bool(d.get('adds_stress', False))}, {cpp_bool(d.get('turns_stress', False))}}}"
        for d in catalog["deformation"]]
    tables["quantities", "QuantityRow"] = [
        f"{{{text(q['name'])}, {writer.strings(q['components'])}}}" for q in catalog["quantities"]]
    tables["result_fields", "ResultFieldRow"] = [f"{{{text(name)}, {writer.strings(types)}}}" for name, types in catalog["result_fields"]]
    tables["messages", "MessageRow"] = [
        f"{{{text(i)}, '{m['severity']}', {text(m['text'])}, {text(m['do'])}}}" for i, m in catalog["messages"].items()]
    french = catalog["french"]
    tables["french_messages", "WordingRow"] = [f"{{{text(i)}, {text(m['text'])}, {text(m['do'])}}}" for i, m in french["messages"].items()]
    tables["parts", "PartRow"] = [f"{{{text(n)}, {text(words)}, {text(french['parts'].get(n, words))}}}" for n, words in catalog["parts"].items()]
    rows = []
    for command, entry in catalog["commands"].items():
        for path, row in keyword_paths(entry.get("keyword", {})):
            multiple = row.get("max", 1) != 1
            rows.append(f"{{{text(command)}, {text(path)}, {text(row['type'])}, "
                        f"{cpp_bool(row.get('status') == 'mandatory')}, {cpp_bool('default' in row)}, {cpp_bool(multiple)}}}")
    tables["keywords", "KeywordRow"] = rows

    body = []
    for (name, row), items in tables.items():
        if items:
            body.append(f"std::span<const {row}> {name}() {{ return {writer.span(row, items)}; }}")
        else:
            body.append(f"std::span<const {row}> {name}() {{ return {{}}; }}")
    includes = "\n".join(f'#include "lacon/catalog/{h}.hpp"' for h in
                         ("behaviours", "cells", "contact", "cuts", "elements", "keywords", "messages", "quantities", "refinements", "wording"))
    return (f"// Made by catalog/generate.py from the catalogue's TOML: do not edit.\n{includes}\n\nnamespace lacon::catalog {{\n"
            "namespace {\n" + "\n".join(writer.arrays) + "\n}\n\n" + "\n".join(body) + "\n}\n")


def cpp_bool(value):
    return "true" if value else "false"


def keyword_paths(keywords, prefix=""):
    """(path, row) of every keyword, factor keywords before what they hold."""
    for name, row in keywords.items():
        yield prefix + name, row
        yield from keyword_paths(row.get("keyword", {}), prefix + name + "/")


def write_cell_type(catalog):
    names = ", ".join(c["name"] for c in catalog["cells"])
    families = ", ".join(dict.fromkeys(c["family"] for c in catalog["cells"]))
    return ("// Made by catalog/generate.py from cells.toml: do not edit.\n#pragma once\n#include <cstdint>\n\nnamespace lacon {\n"
            f"enum class CellType : std::int8_t {{ {names} }};\nenum class Family : std::int8_t {{ {families} }};\n}}\n")


def main():
    folder, output = map(pathlib.Path, sys.argv[1:3])
    try:
        catalog = load(folder)
        files = {
            "lacon/catalog/cell_type.hpp": write_cell_type(catalog),
            "tables.cpp": write_cpp(catalog, Writer()),
            "catalog.json": json.dumps(catalog, ensure_ascii=False, separators=(",", ":")),
        }
    except CatalogError as error:
        sys.exit(f"catalogue: {error}")
    for name, content in files.items():
        path = output / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text() != content:  # unchanged files keep their time stamp
            path.write_text(content)


if __name__ == "__main__":
    main()
