"""LIRE_MAILLAGE(FORMAT='GMSH'): .msh files written here, version 2.2, 4.0 and 4.1, as text and as bytes."""

import struct
import unittest

import numpy as np

from lacon_test import CELLS, OperatorTest

#: gmsh's manual, "Node ordering": number of the type, reference vertices, and of what vertices each further node is the centre
LINE = [(-1,), (1,)]
TRIANGLE = [(0, 0), (1, 0), (0, 1)]
QUADRANGLE = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
TETRAHEDRON = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
HEXAHEDRON = [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]
PRISM = [(0, 0, -1), (1, 0, -1), (0, 1, -1), (0, 0, 1), (1, 0, 1), (0, 1, 1)]
PYRAMID = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 1)]
HEXA_EDGES = [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)]
HEXA_FACES = [(0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7)]
QUAD_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0)]
GMSH = {
    "POI1": (15, [()], []), "SEG2": (1, LINE, []), "TRIA3": (2, TRIANGLE, []), "QUAD4": (3, QUADRANGLE, []), "TETRA4": (4, TETRAHEDRON, []),
    "HEXA8": (5, HEXAHEDRON, []), "PENTA6": (6, PRISM, []), "PYRAM5": (7, PYRAMID, []), "SEG3": (8, LINE, [(0, 1)]),
    "TRIA6": (9, TRIANGLE, [(0, 1), (1, 2), (2, 0)]), "QUAD9": (10, QUADRANGLE, [*QUAD_EDGES, (0, 1, 2, 3)]),
    "TETRA10": (11, TETRAHEDRON, [(0, 1), (1, 2), (2, 0), (0, 3), (2, 3), (1, 3)]),
    "HEXA27": (12, HEXAHEDRON, [*HEXA_EDGES, *HEXA_FACES, tuple(range(8))]), "QUAD8": (16, QUADRANGLE, QUAD_EDGES),
    "HEXA20": (17, HEXAHEDRON, HEXA_EDGES),
    "PENTA15": (18, PRISM, [(0, 1), (0, 2), (0, 3), (1, 2), (1, 4), (2, 5), (3, 4), (3, 5), (4, 5)]),
    "PYRAM13": (19, PYRAMID, [(0, 1), (0, 3), (0, 4), (1, 2), (1, 4), (2, 3), (2, 4), (3, 4)]),
}


def reference_nodes(name):
    _, vertices, others = GMSH[name]
    vertices = np.array([(*v, 0, 0, 0)[:3] for v in vertices], float)
    return [*vertices, *(vertices[list(of)].mean(axis=0) for of in others)]


class Writer:
    """The content of a .msh file; numbers of sections as text or as bytes."""

    def __init__(self, version, binary):
        self.binary = binary
        self.content = f"$MeshFormat\n{version} {int(binary)} 8\n".encode()
        if binary:
            self.content += struct.pack("<i", 1) + b"\n"
        self.content += b"$EndMeshFormat\n"

    def text(self, text, encoding="utf-8"):
        self.content += text.encode(encoding)

    def numbers(self, kinds, *values):
        """@param kinds of the values: i integer, Q size, d real"""
        if self.binary:
            self.content += struct.pack("<" + kinds, *values)
        else:
            self.content += (" ".join(f"{v:.17g}" if k == "d" else str(v) for k, v in zip(kinds, values)) + "\n").encode()

    def names(self, names, encoding="utf-8"):
        if names:
            rows = "".join(f'{dimension} {tag} "{name}"\n' for dimension, tag, name in names)
            self.text(f"$PhysicalNames\n{len(names)}\n{rows}$EndPhysicalNames\n", encoding)

    def section(self, name):
        self.text(f"$End{name}\n" if self.content.endswith(b"\n") and not self.binary else f"\n$End{name}\n")


def write_msh(path, version, binary, nodes, cells, names=(), encoding="utf-8"):
    """@param nodes {tag: point} @param cells list of (type, physical groups, node tags)"""
    if version == "1":
        write_1(path, nodes, cells)
        return
    out = Writer(version, binary)
    out.names(names, encoding)
    if version == "2.2":
        write_2(out, nodes, cells)
    else:
        write_4(out, nodes, cells, before_1=version == "4")
    path.write_bytes(out.content)


def write_1(path, nodes, cells):
    """As gmsh before version 2: groups by number alone, a cell once for each of them."""
    rows = [(kind, group, own) for kind, groups, own in cells for group in groups or [0]]
    path.write_text("\n".join([
        "$NOD", str(len(nodes)), *(f"{tag} " + " ".join(f"{x:.17g}" for x in point) for tag, point in nodes.items()), "$ENDNOD", "$ELM", str(len(rows)),
        *(f"{tag} {GMSH[kind][0]} {group} 7 {len(own)} " + " ".join(map(str, own)) for tag, (kind, group, own) in enumerate(rows, 1)), "$ENDELM", ""]))


def write_2(out, nodes, cells):
    out.text(f"$Nodes\n{len(nodes)}\n")
    for tag, point in nodes.items():
        out.numbers("iddd", tag, *point)
    out.section("Nodes")
    rows = [(kind, group, own) for kind, groups, own in cells for group in groups or [0]]  # a cell once for each of its groups
    out.text(f"$Elements\n{len(rows)}\n")
    for tag, (kind, group, own) in enumerate(rows, 1):
        head = (GMSH[kind][0], 1, 2, tag) if out.binary else (tag, GMSH[kind][0], 2)
        out.numbers("i" * (len(head) + 2 + len(own)), *head, group, 7, *own)
    out.section("Elements")


def write_4(out, nodes, cells, before_1):
    """Every cell on a geometrical entity of its own, numbered from 100; nodes in two blocks, the second with parameters.

    @param before_1 as version 4.0: points have boxes, entities go by tag and dimension, tags are integers beside their nodes, no extremes
    """
    def entity(dimension, tag):
        return (tag, dimension) if before_1 else (dimension, tag)

    def counts(*values):
        out.numbers("Q" * len(values[:2 if before_1 else 4]), *values[:2 if before_1 else 4])

    kind_of_tags = "i" if before_1 else "Q"
    of = {d: [i for i, (kind, _, _) in enumerate(cells) if CELLS[kind]["dimension"] == d] for d in range(4)}
    out.text("$Entities\n")
    out.numbers("QQQQ", *(len(of[d]) for d in range(4)))
    for d in range(4):
        for i in of[d]:
            groups = cells[i][1]
            box = [0.0] * (3 if d == 0 and not before_1 else 6)
            bounding = [1, -2] if d else []
            end = [len(bounding), *bounding] if d else []
            out.numbers("i" + "d" * len(box) + "Q" + "i" * len(groups) + ("Qii" if d else ""), 100 + i, *box, len(groups), *groups, *end)
    out.section("Entities")
    out.text("$Nodes\n")
    tags = list(nodes)
    half = len(tags) // 2
    counts(2, len(tags), min(tags), max(tags))
    for block, parametric in ((tags[:half], 0), (tags[half:], 1)):
        out.numbers("iiiQ", *entity(2, 1), parametric, len(block))
        for tag in [] if before_1 else block:
            out.numbers("Q", tag)
        for tag in block:
            values = [*nodes[tag], *([0.25, 0.75] if parametric else [])]
            out.numbers("i" * before_1 + "d" * len(values), *([tag] if before_1 else []), *values)
    out.section("Nodes")
    out.text("$Elements\n")
    counts(len(cells), len(cells), 1, len(cells))
    for i, (kind, _, own) in enumerate(cells):
        out.numbers("iiiQ", *entity(CELLS[kind]["dimension"], 100 + i), GMSH[kind][0], 1)
        out.numbers(kind_of_tags * (1 + len(own)), i + 1, *own)
    out.section("Elements")


FORMATS = [(version, binary) for version in ("2.2", "4", "4.1") for binary in (False, True)]
#: tags of nodes are neither consecutive nor sorted
SQUARE = {40: (0, 0, 0), 7: (2, 0, 0), 12: (4, 0, 0), 3: (4, 2, 0), 99: (2, 2, 0), 5: (0, 2, 0)}
PLANE = [("QUAD4", [1], [40, 7, 99, 5]), ("SEG2", [3], [40, 7]), ("QUAD4", [1, 2], [7, 12, 3, 99]), ("SEG2", [3, 4], [7, 12]),
         ("POI1", [9], [40]), ("TRIA3", [], [40, 7, 99])]
NAMES = [(2, 1, "Body"), (2, 2, "Right half"), (1, 3, "Low"), (0, 9, "Corner"), (2, 8, "Nobody")]


class LireMaillageGmsh(OperatorTest):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "plate.msh"

    def read(self, **keywords):
        return self.run_command("LIRE_MAILLAGE", {"FORMAT": "GMSH", **keywords}, result="mesh_1", label="MA", units={20: self.file})

    def refuses(self, identifier, *words):
        self.assert_refuses(identifier, "LIRE_MAILLAGE", {"FORMAT": "GMSH"}, *words, result="mesh_1", units={20: self.file})

    def test_every_cell_has_its_nodes_at_their_places(self):
        for version, binary in [*FORMATS, ("1", False)]:
            nodes, cells = {}, []
            for k, name in enumerate(GMSH):
                own = []
                for point in reference_nodes(name):
                    tag = 1000 - len(nodes)
                    nodes[tag] = tuple(np.add(point, (3 * k, 0, 0)))
                    own.append(tag)
                cells.append((name, [], own))
            write_msh(self.file, version, binary, nodes, cells)
            with self.subTest(version=version, binary=binary):
                run = self.read()
                self.assertEqual(run.status, 0, run.stderr)
                self.assertEqual(self.ids(run), [])
                mesh = self.read_mesh("mesh_1")
                self.assertEqual(mesh.types, list(CELLS))
                self.assertEqual((mesh.dimension, mesh.name, len(mesh.coordinates)), (3, "plate", len(nodes)))
                for name, own in zip(mesh.types, mesh.cells):
                    expected = np.zeros((len(own), 3))
                    expected[:, :CELLS[name]["dimension"]] = CELLS[name]["nodes"]
                    expected[:, 0] += 3 * list(GMSH).index(name)
                    np.testing.assert_allclose(mesh.coordinates[own], expected, atol=1e-15)

    def test_groups_cells_and_nodes(self):
        for version, binary in FORMATS:
            write_msh(self.file, version, binary, SQUARE, PLANE, NAMES)
            with self.subTest(version=version, binary=binary):
                run = self.read()
                self.assertEqual(run.status, 0, run.stderr)
                mesh = self.read_mesh("mesh_1")
                self.assertEqual(mesh.dimension, 2)
                np.testing.assert_array_equal(mesh.coordinates, list(SQUARE.values()))
                self.assertEqual(mesh.types, ["POI1", "SEG2", "SEG2", "TRIA3", "QUAD4", "QUAD4"])
                self.assertEqual(mesh.cells, [[0], [0, 1], [1, 2], [0, 1, 4], [0, 1, 4, 5], [1, 2, 3, 4]])
                self.assertEqual({name: list(members) for name, members in mesh.cell_groups.items()},
                                 {"Body": [4, 5], "Right half": [5], "Low": [1, 2], "GM4": [2], "Corner": [0], "Nobody": []})
                self.assertEqual({name: list(members) for name, members in mesh.node_groups.items()}, {"Corner": [0]})

    def test_version_1_has_groups_by_number_and_is_read_behind_pre_gmsh_too(self):
        write_msh(self.file, "1", False, SQUARE, PLANE)
        for wanted in ("GMSH", "ASTER"):
            run = self.read(FORMAT=wanted)
            self.assertEqual(run.status, 0, run.stderr)
            mesh = self.read_mesh("mesh_1")
            self.assertEqual(mesh.cells, [[0], [0, 1], [1, 2], [0, 1, 4], [0, 1, 4, 5], [1, 2, 3, 4]])
            self.assertTrue(all(name.startswith("GM") for name in mesh.cell_groups), mesh.cell_groups)
            self.assertEqual(sorted(len(members) for members in mesh.cell_groups.values()), [1, 1, 1, 2, 2])
        content = self.file.read_text()
        for text, words in ((content[:content.index("$ENDNOD")], ("NOD", "$ENDNOD")), (content[:content.index("$ENDELM")], ("ELM", "$ENDELM")),
                            (content.replace(" 7 2 ", " 7 3 ", 1), ("ELM", "has 3 nodes"))):
            self.file.write_text(text)
            self.refuses("GMSH_3", *words)

    def test_names_that_are_not_utf_8_are_latin_1(self):
        names = [(2, 1, "Körper"), (1, 3, "Fläche §")]
        for version, binary in FORMATS:
            for encoding, ids in (("utf-8", []), ("latin-1", ["FORMAT_1"])):
                write_msh(self.file, version, binary, SQUARE, PLANE, names, encoding)
                with self.subTest(version=version, binary=binary, encoding=encoding):
                    run = self.read()
                    self.assertEqual((run.status, [i for i in self.ids(run) if i == "FORMAT_1"]), (0, ids), run.stderr)
                    self.assertEqual([name for name in self.read_mesh("mesh_1").cell_groups if not name.startswith("GM")], ["Fläche §", "Körper"])
                    self.assertEqual("'Fläche §', 'Körper'" in run.stderr, bool(ids))

    def test_a_clockwise_body_is_turned(self):
        write_msh(self.file, "2.2", False, SQUARE, [("QUAD4", [1], [40, 5, 99, 7])])
        self.assertEqual(self.ids(self.read()), ["LIRE_1", "LIRE_3"])
        self.assertEqual(self.read_mesh("mesh_1").cells, [[0, 1, 4, 5]])

    def test_unknown_sections_comments_and_windows_lines(self):
        write_msh(self.file, "4.1", False, SQUARE, PLANE, NAMES)
        text = self.file.read_text(encoding="ascii").replace("$Nodes", "$Comments\nmade by hand\n$EndComments\n$Periodic\n0\n$EndPeriodic\n$Nodes")
        self.file.write_bytes(text.replace("\n", "\r\n").encode())
        self.assertEqual(self.read().status, 0)
        self.assertEqual(len(self.read_mesh("mesh_1").cells), 6)

    def test_refuses_what_is_no_msh_file(self):
        self.refuses("MED_1", "there is no such file")
        self.file.write_text("", encoding="ascii")
        self.refuses("MED_1", "empty")
        self.file.write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
        self.refuses("GMSH_1", "plate.msh")
        self.file.write_text("$VIEW", encoding="ascii")
        self.refuses("GMSH_1")

    def test_refuses_other_versions_types_and_partitions(self):
        write_msh(self.file, "2.2", False, SQUARE, PLANE)
        text = self.file.read_text(encoding="ascii")
        for old, new, identifier, word in (("2.2 0 8", "5 0 8", "GMSH_2", "5.0"), ("2.2 0 8", "1 0 8", "GMSH_2", "1.0"),
                                           ("1 3 2 1 7 40 7 99 5", "1 14 2 1 7 40 7 99 5", "GMSH_4", "14-node pyramid"),
                                           ("1 3 2 1 7 40 7 99 5", "1 92 2 1 7 40 7 99 5", "GMSH_4", "92"),
                                           ("1 3 2 1 7 40 7 99 5", "1 3 4 1 7 2 1 40 7 99 5", "GMSH_6", "partitioned")):
            with self.subTest(new=new):
                self.assertIn(old, text)
                self.file.write_text(text.replace(old, new), encoding="ascii")
                self.refuses(identifier, word)

    def test_refuses_damaged_files(self):
        write_msh(self.file, "2.2", False, SQUARE, PLANE)
        text = self.file.read_text(encoding="ascii")
        for old, new, identifier, word in (("40 7 99 5", "40 7 98 5", "GMSH_5", "98"), ("40 0 0 0", "40 0 nan 0", "GMSH_3", "not finite"),
                                           ("\n7 2 0 0", "\n40 2 0 0", "GMSH_3", "twice"), ("$Nodes\n6", "$Nodes\n600000000", "GMSH_3", "too short"),
                                           ("40 0 0 0", "40 0 zero 0", "GMSH_3", "'zero'"), ("$EndElements", "", "GMSH_3", "$EndElements"),
                                           ("$Elements", "$Elementals", "GMSH_3", "no end")):
            with self.subTest(new=new):
                self.assertIn(old, text)
                self.file.write_text(text.replace(old, new, 1), encoding="ascii")
                self.refuses(identifier, word)

    def test_refuses_counts_that_are_too_small(self):
        """They lost cells without a word."""
        for version, binary in FORMATS:
            write_msh(self.file, version, binary, SQUARE, PLANE, NAMES)
            whole = self.file.read_bytes()
            for section in (b"Nodes", b"Elements", b"PhysicalNames", b"Entities"):
                begin = whole.find(b"$" + section + b"\n") + len(section) + 2
                if begin < len(section) + 2 or section == b"Entities" and binary:
                    continue
                if binary and version[0] == "4" and section != b"PhysicalNames":  # blocks, then entries
                    counts = [(begin + 8 * k, begin + 8 * k + 8, struct.unpack_from("<Q", whole, begin + 8 * k)[0]) for k in (0, 1)]
                    texts = [struct.pack("<Q", n - 1) for _, _, n in counts]
                else:
                    line = whole[begin:whole.index(b"\n", begin)]
                    words = line.split()[:2 if version[0] == "4" else 1] if section != b"Entities" else line.split()[:4]
                    places = [begin + len(b" ".join(words[:k])) + bool(k) for k in range(len(words))]
                    counts = [(at, at + len(word), int(word)) for at, word in zip(places, words)]
                    texts = [str(n - 1).encode() for _, _, n in counts]
                for (first, end, count), text in zip(counts, texts):
                    if count > 0:
                        with self.subTest(version=version, binary=binary, section=section, place=first - begin):
                            self.file.write_bytes(whole[:first] + text + whole[end:])
                            self.refuses("GMSH_3")

    def test_refuses_files_cut_off_anywhere(self):
        for version, binary in FORMATS:
            write_msh(self.file, version, binary, SQUARE, PLANE, NAMES)
            whole = self.file.read_bytes()
            for length in range(12, len(whole) - 12, 61):
                with self.subTest(version=version, binary=binary, length=length):
                    self.file.write_bytes(whole[:length])
                    self.refuses("GMSH_3")


if __name__ == "__main__":
    unittest.main()
