"""Where a command was called from, and the variable its concept goes to.

A command looks outward from the frame that called it to the assignment it is part of. Python 3.11 says which expression a frame
is executing; the syntax tree of the file, read once, says what that expression is assigned to. Command files themselves run as
they are, so that tracebacks name the user's own lines.
"""

import ast
import itertools
import linecache
import os
import sys

#: the launcher's own folder, spelled as in the file names of its frames
package = os.path.dirname(os.path.dirname(sys._getframe().f_code.co_filename)) + os.sep
_tables = {}
_pools = os.path.join(os.path.dirname(os.__file__), "concurrent", "futures", "")

#: file name -> source of the command files of this run
sources = {}


def user_frame():
    """The innermost frame of a command file or of what it imports."""
    frame = sys._getframe(1)
    while frame is not None and is_own(frame):
        frame = frame.f_back
    return frame


def files_under_way():
    """The command files that are running, each included by the one before it."""
    names, frame = [], user_frame()
    while frame is not None:
        if frame.f_code.co_name == "<module>" and frame.f_code.co_filename in sources:
            names.append(frame.f_code.co_filename)
        frame = frame.f_back
    return names[::-1]


def is_own(frame):
    """Whether a frame is the launcher's, or a formula's."""
    return frame.f_code.co_filename.startswith((package, "<formula>"))


def is_of_pool(filename):
    """Whether a file is one of concurrent.futures: between a command and the line of the user's it shows nothing."""
    return filename.startswith(_pools)


def location(frame):
    """"study.comm:12"; empty without frame. What a pool of threads was given as it is was called where it was submitted."""
    if frame and is_of_pool(frame.f_code.co_filename):
        place = getattr(getattr(frame.f_locals.get("self"), "fn", None), "place", "")
        if place:
            return place
    return f"{frame.f_code.co_filename}:{frame.f_lineno}" if frame else ""


def label(frame):
    """The variable that the call which `frame` is executing is assigned to, "M" or "M[0]"; empty where there is none.

    A call that is returned by a function takes the variable of that function's own call; an argument of another call has none.
    """
    while frame is not None:
        code = frame.f_code
        if is_of_pool(code.co_filename):
            return ""
        if not is_own(frame):
            table = _table(code.co_filename)
            position = _position(frame)
            if position in table:
                target = table[position]
                return _text(target, frame) if target is not None else ""
            if code.co_name == "<module>":
                return ""
        frame = frame.f_back
    return ""


def _position(frame):
    return next(itertools.islice(frame.f_code.co_positions(), frame.f_lasti // 2, None), None)


def _table(filename):
    """Position (line, end line, column, end column) of a call -> its target, a syntax node or None for an argument."""
    if filename not in _tables:
        table = {}
        try:
            tree = ast.parse(_source(filename))
        except (OSError, SyntaxError, ValueError):
            tree = ast.Module([], [])
        for node in ast.walk(tree):
            if isinstance(node, ast.Assign):
                _pair(node.targets[0], node.value, table)
            elif isinstance(node, (ast.AnnAssign, ast.NamedExpr)) and node.value is not None:
                _pair(node.target, node.value, table)
        _tables[filename] = table
    return _tables[filename]


def _source(filename):
    """The text of a file; of a module that a command file imports, in its own encoding; of a cell of a notebook."""
    if filename in sources:
        return sources[filename]
    if not os.path.exists(filename):
        return "".join(linecache.getlines(filename))
    with open(filename, "rb") as file:
        return file.read()


def _place(call):
    return call.lineno, call.end_lineno, call.col_offset, call.end_col_offset


def _calls_below(node):
    return (below for below in ast.walk(node) if isinstance(below, ast.Call))


def _pair(target, value, table):
    """Enter the calls of `value`, which is assigned to `target`."""
    if not isinstance(value, ast.Call):
        for its_target, its_value in _parts(target, value):
            _pair(its_target, its_value, table)
        return
    table[_place(value)] = target
    for argument in itertools.chain(value.args, (k.value for k in value.keywords)):
        table.update((_place(call), None) for call in _calls_below(argument))


def _parts(target, value):
    """What an assigned value consists of, each part with its own target: elements of lists and dictionaries, branches, or the calls in it."""
    def element(index):
        return ast.Subscript(target, index, ast.Load())

    if isinstance(value, (ast.Tuple, ast.List)):
        if not isinstance(target, (ast.Tuple, ast.List)):
            return [(element(ast.Constant(i)), v) for i, v in enumerate(value.elts)]
        are_known = len(target.elts) == len(value.elts) and not any(isinstance(t, ast.Starred) for t in target.elts)
        return zip(target.elts, value.elts) if are_known else ()
    if isinstance(value, ast.Dict):
        return [(element(k), v) for k, v in zip(value.keys, value.values) if k is not None]
    if isinstance(value, ast.IfExp):
        return [(target, value.body), (target, value.orelse)]
    if isinstance(value, ast.ListComp) and isinstance(value.elt, ast.Call):
        return [(element(_counted), value.elt)]
    if isinstance(value, ast.DictComp):
        return [(element(value.key), value.value)]
    if isinstance(value, (ast.ListComp, ast.GeneratorExp, ast.Await, ast.BoolOp)):
        return [(target, call) for call in _calls_below(value)]
    return ()


#: the index of an element that a list comprehension is making
_counted = ast.Constant(...)
_progress = (None, 0)  # iterator of the comprehension that ran last, elements made so far


def _count(frame):
    """How many elements the comprehension of this frame has made, as text; unknown where Python runs it inside its function."""
    global _progress
    iterator = frame.f_locals.get(".0")
    if iterator is None:
        return "..."
    _progress = (iterator, _progress[1] + 1 if _progress[0] is iterator else 0)
    return str(_progress[1])


_plain = (ast.Name, ast.Constant, ast.BinOp, ast.UnaryOp, ast.Tuple, ast.Subscript, ast.Attribute, ast.operator, ast.unaryop,
          ast.expr_context, ast.Slice)


def _text(target, frame):
    """"M[0]": a target with the values of its indices."""
    if isinstance(target, ast.Name):
        return target.id
    if isinstance(target, ast.Attribute):
        return f"{_text(target.value, frame)}.{target.attr}"
    if isinstance(target, ast.Starred):
        return _text(target.value, frame)
    if isinstance(target, ast.Subscript):
        return f"{_text(target.value, frame)}[{_index(target.slice, frame)}]"
    return ""


def _index(node, frame):
    """An index as text; only what has no side effect is evaluated."""
    if node is _counted:
        return _count(frame)
    if not all(isinstance(part, _plain) for part in ast.walk(node)):
        return "?"
    try:
        value = eval(compile(ast.fix_missing_locations(ast.Expression(node)), "<index>", "eval"), frame.f_globals, frame.f_locals)
        return repr(value)
    except Exception:
        return "?"
