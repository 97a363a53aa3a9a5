"""Where a file of C++ can be mutated, from clang's syntax tree: operators and numbers that a running program evaluates."""

import os
import pathlib
import re

from clang.cindex import Config, CursorKind, Diagnostic, Index, TypeKind

Config.set_library_file("libclang-16.so.1")

#: what stands for an operator: kind of the mutation and the other operator
BINARY = {
    "+": ("sign", "-"), "-": ("sign", "+"), "+=": ("sign", "-="), "-=": ("sign", "+="),
    "*": ("weight", "/"), "/": ("weight", "*"), "%": ("index", "/"),
    "<": ("bound", ">="), ">": ("bound", "<="), "<=": ("bound", ">"), ">=": ("bound", "<"), "==": ("bound", "!="), "!=": ("bound", "=="),
    "&&": ("bound", "||"), "||": ("bound", "&&"),
}
UNARY = {"-": "sign", "!": "bound"}

K = CursorKind
#: evaluated by the compiler, or by nobody
NOT_RUN = {K.STATIC_ASSERT, K.TYPE_ALIAS_DECL, K.TYPEDEF_DECL, K.TYPE_ALIAS_TEMPLATE_DECL, K.ENUM_DECL,
           K.DECL_REF_EXPR, K.SIZE_OF_PACK_EXPR, K.CXX_UNARY_EXPR, K.CXX_THROW_EXPR}
DECLARATIONS = {K.VAR_DECL, K.FIELD_DECL, K.PARM_DECL}
FUNCTIONS = {K.FUNCTION_DECL, K.CXX_METHOD, K.FUNCTION_TEMPLATE, K.CONVERSION_FUNCTION, K.DESTRUCTOR}
#: a conditional expression chooses between two values of these
VALUES = {TypeKind.BOOL, TypeKind.INT, TypeKind.UINT, TypeKind.LONG, TypeKind.ULONG, TypeKind.LONGLONG, TypeKind.ULONGLONG, TypeKind.SHORT,
          TypeKind.USHORT, TypeKind.CHAR_S, TypeKind.SCHAR, TypeKind.UCHAR, TypeKind.FLOAT, TypeKind.DOUBLE, TypeKind.VECTOR}


class Sites:
    """Those of one file. `found` has for each: its kind; what is edited (begin, end, what stands there instead); the range that is written
    anew, with the mutant and without; and what is written there where sum and difference are of different types, as Eigen's are: a factor."""

    def __init__(self, name):
        self.text, self.found = pathlib.Path(name).read_text("latin-1"), {}  # clang counts bytes

    def add(self, kind, whole, begin, end, instead, factor=None):
        edit = (begin, end, instead)
        self.found[edit] = {"kind": kind, "edit": edit, "range": edit[:2] if factor else whole, "factor": factor}

    def visit(self, node):
        if node.kind in NOT_RUN or (node.kind == K.CALL_EXPR and node.spelling == "fail"):
            return
        children = list(node.get_children())
        self.mutate(node, children)
        for child in self.evaluated(node, children):
            self.visit(child)

    def evaluated(self, node, children):
        """The children that the running program evaluates."""
        begin = node.extent.start.offset
        if node.kind in FUNCTIONS:
            return [child for child in children if child.kind == K.COMPOUND_STMT]
        if node.kind in DECLARATIONS:
            if "constexpr" in self.text[begin:node.location.offset]:
                return []
            name = node.location.offset + len(node.spelling)
            return [child for child in children if child.extent.start.offset >= name and re.search("[=({]", self.text[name:child.extent.start.offset + 1])]
        if node.kind == K.IF_STMT and self.text.startswith("if constexpr", begin):
            return children[1:]
        if node.kind == K.CASE_STMT:
            return children[1:]
        if node.kind == K.MEMBER_REF_EXPR:
            return children[:1] if children and children[0].kind not in (K.TYPE_REF, K.TEMPLATE_REF, K.NAMESPACE_REF) else []
        if any(child.kind in (K.TYPE_REF, K.TEMPLATE_REF, K.NAMESPACE_REF) for child in children) and node.kind.is_expression():
            before = [(child, self.text[begin:child.extent.start.offset]) for child in children]  # arguments of a template
            return [child for child, text in before if text.count("<") <= text.count(">")]
        return children

    def mutate(self, node, children):
        begin, end = node.extent.start.offset, node.extent.end.offset
        whole = (begin, end)
        text = self.text[begin:end]
        if node.kind == K.FLOATING_LITERAL and re.fullmatch(r"\d+\.\d+", text):
            self.add("weight", whole, begin, end, repr(1.5 * float(text) or 1.0))
        elif node.kind == K.CALL_EXPR and (call := re.match(r"std::(min|max)\b(?=\()", text)):
            self.add("bound", whole, begin, begin + call.end(), "std::max" if call[1] == "min" else "std::min")
        elif node.kind in (K.ARRAY_SUBSCRIPT_EXPR, K.CALL_EXPR) and text.endswith("]") and len(children) >= 2 and children[-1].extent.end.offset < end:
            self.integer("index", children[-1], lambda index: index - 1 if index else 1)
        elif node.kind in (K.UNARY_OPERATOR, K.CALL_EXPR) and re.match("[-!](?!=)", text) and len(children) == 1 + (node.kind == K.CALL_EXPR):
            self.add(UNARY[text[0]], whole, begin, begin + 1, "", "({} ? 1 : -1) *" if text[0] == "-" and self.several(node) else None)
        elif node.kind in (K.BINARY_OPERATOR, K.COMPOUND_ASSIGNMENT_OPERATOR, K.CALL_EXPR) and len(children) >= 2:
            self.binary(node, children[0], children[-1], whole)

    def binary(self, node, left, right, whole):
        between = self.text[left.extent.end.offset:right.extent.start.offset]
        operator = between.strip()
        if operator not in BINARY or left.extent.start.offset < whole[0]:
            return
        at = left.extent.end.offset + between.index(operator)
        kind, other = BINARY[operator]
        several = self.several(node)
        factor = {"+": "+ ({} ? -1 : 1) *", "-": "+ ({} ? 1 : -1) *"}.get(operator) if several else None
        if operator == "<" and re.fullmatch("[ijkpdn]", self.text[left.extent.start.offset:left.extent.end.offset]):
            other = "<="
        if not several or operator not in "*/":
            self.add(kind, whole, at, at + len(operator), other, factor)
        if operator in "+-":
            self.integer("index", right, lambda number: 2 if number == 1 else None)
        if operator in "*/":
            for side in (left, right):
                self.integer("weight", side, lambda number: number + 1 if 2 <= number <= 9 else None)

    def integer(self, kind, node, other):
        begin, end = node.extent.start.offset, node.extent.end.offset
        if re.fullmatch(r"\d", self.text[begin:end]) and (number := other(int(self.text[begin:end]))) is not None:
            self.add(kind, (begin, end), begin, end, str(number))

    @staticmethod
    def several(node):
        """Whether an expression is of more than one number: products cannot be turned into quotients then."""
        return node.type.get_canonical().kind not in VALUES


def sites(commands, wanted):
    """{file: its sites} of wanted files, from the entries of a compile_commands.json whose units meet them."""
    found = {}
    for command in commands:
        words = re.findall(r"(?<= )-(?:isystem |[ID]|std=)\S+", command["command"])
        unit = Index.create().parse(command["file"], args=" ".join(words).split())
        if fatal := [message for message in unit.diagnostics if message.severity >= Diagnostic.Fatal]:
            raise SystemExit(f"clang does not understand {command['file']}: {fatal[0]}")
        met = {}
        for node in unit.cursor.get_children():
            name = node.location.file and os.path.realpath(node.location.file.name)
            if name in wanted and name not in found:
                met.setdefault(name, Sites(name)).visit(node)
        found |= {name: list(sites.found.values()) for name, sites in met.items()}
    return found
