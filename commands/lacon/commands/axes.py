"""Axes that differ from place to place, and vectors and tensors at nodes in them: REPERE, INVARIANT, TRAC_DIR of POST_RELEVE_T.

MODI_REPERE does the same to whole fields (operators/modi_repere), with the same axes.
"""

from ..core.late import numpy

#: components of tensors, in the order of catalog/quantities.toml
_tensor = (("XX", 0, 0), ("YY", 1, 1), ("ZZ", 2, 2), ("XY", 0, 1), ("XZ", 0, 2), ("YZ", 1, 2))
_vectors, _tensors = ("D", "F", "V"), ("SI", "EP")


def vectors(components, values):
    """[(indices of the components, -1 where there is none; (n, 3) vectors)] of DX ..., FX ..., VX ..."""
    found = []
    for prefix in _vectors:
        columns = [components.index(prefix + axis) if prefix + axis in components else -1 for axis in "XYZ"]
        if max(columns) >= 0:
            made = numpy.zeros((len(values), 3))
            for axis, column in enumerate(columns):
                if column >= 0:
                    made[:, axis] = values[:, column]
            found.append((columns, made))
    return found


def tensors(components, values):
    """[(indices of XX, YY, ZZ, XY, XZ, YZ, -1 where there is none; (n, 3, 3) tensors)] of SIXX ..., EPXX ..."""
    found = []
    for prefix in _tensors:
        columns = [components.index(prefix + name) if prefix + name in components else -1 for name, _, _ in _tensor]
        if max(columns) >= 0:
            made = numpy.zeros((len(values), 3, 3))
            for column, (_, i, j) in zip(columns, _tensor):
                if column >= 0:
                    made[:, i, j] = made[:, j, i] = values[:, column]
            found.append((columns, made))
    return found


def has_turned(components):
    """Whether there are components of a vector or tensor, which other axes change."""
    none = numpy.zeros((0, len(components)))
    return bool(vectors(components, none) or tensors(components, none))


def turned(components, values, there, axes):
    """The values (n, components) with vectors and tensors in other axes (n, 3, 3), whose rows are unit vectors.
    @return (values, there); a vector or tensor that is not whole has no components in other axes"""
    values, there = values.copy(), there.copy()
    for columns, _ in [*vectors(components, values), *tensors(components, values)]:
        columns = [c for c in columns if c >= 0]
        there[:, columns] = there[:, columns].all(axis=1)[:, None]
    for columns, given in vectors(components, values):
        made = numpy.einsum("nij,nj->ni", axes, given)
        for axis, column in enumerate(columns):
            if column >= 0:
                values[:, column] = made[:, axis]
    for columns, given in tensors(components, values):
        made = axes @ given @ axes.transpose(0, 2, 1)
        for column, (_, i, j) in zip(columns, _tensor):
            if column >= 0:
                values[:, column] = made[:, i, j]
    return values, there


def at(call, k, path, points, plane):
    """Axes of REPERE at points (n, 3), as rows of (n, 3, 3). @param plane the mesh has two dimensions"""
    if k["REPERE"] == "UTILISATEUR":
        return numpy.broadcast_to(_nautical(k["ANGL_NAUT"]), (len(points), 3, 3))
    if k["REPERE"] == "LOCAL":
        return line_axes(call, k, path, points, plane)
    origin, line = axis(call, k, path, plane)
    radial = radii(points, (origin, line))
    length = numpy.linalg.norm(radial, axis=1)
    lost = ~(length > 1e-10 * max(abs(points - origin).max(), 1e-300))
    if lost.any():
        across = numpy.eye(3)[abs(line).argmin()]
        radial[lost] = across - across @ line * line
        length[lost] = numpy.linalg.norm(radial[lost], axis=1)
        call.study.inform("MODIREPERE_4", f"{call.command}/{path}, {call.where}", count=int(lost.sum()))
    radial /= length[:, None]
    along = numpy.broadcast_to(line, radial.shape)
    around = numpy.cross(along, radial)
    polar = plane or k["REPERE"] == "POLAIRE"
    return numpy.stack([radial, around, along] if polar else [radial, along, around], axis=1)


def axis(call, k, path, plane):
    """(a point, unit vector) of the axis that REPERE='POLAIRE' and 'CYLINDRIQUE' are about"""
    origin = numpy.zeros(3)
    given = k.get("ORIGINE", ())
    origin[:len(given)] = given
    line = numpy.array([0.0, 0.0, 1.0])
    if k["REPERE"] == "CYLINDRIQUE" and not plane:
        if "AXE_Z" not in k or not any(k["AXE_Z"]):
            call.fail("POST_8", f"{path}/AXE_Z")
        line = numpy.array(k["AXE_Z"]) / numpy.linalg.norm(k["AXE_Z"])
    return origin, line


def radii(points, about):
    """From an axis, as axis() gives it, to points (n, 3)."""
    origin, line = about
    from_origin = points - origin
    return from_origin - numpy.outer(from_origin @ line, line)


def line_axes(call, k, path, points, plane):
    """Axes at points of a line: X its tangent, the mean of the directions of the pieces beside a point; Y towards VECT_Y."""
    pieces = numpy.diff(points, axis=0)
    lengths = numpy.linalg.norm(pieces, axis=1)
    if not len(pieces) or not lengths.all():
        call.fail("POST_5", path)
    pieces /= lengths[:, None]
    tangent = numpy.vstack([pieces[:1], pieces[1:] + pieces[:-1], pieces[-1:]])
    if "VECT_Y" in k:
        towards = numpy.zeros(3)
        towards[:len(k["VECT_Y"])] = k["VECT_Y"]
        across = numpy.cross(tangent, towards / max(numpy.linalg.norm(towards), 1e-300))
    elif plane:
        across = numpy.tile([0.0, 0.0, 1.0], (len(points), 1))
    else:
        call.fail("POST_9", f"{path}/VECT_Y")
    sizes = numpy.linalg.norm(tangent, axis=1), numpy.linalg.norm(across, axis=1)
    if sizes[0].min() < 1e-6:
        call.fail("POST_12", path, place=", ".join(f"{x:g}" for x in points[sizes[0].argmin()]))
    if sizes[1].min() < 1e-6:
        call.fail("POST_9", f"{path}/VECT_Y")
    tangent, across = tangent / sizes[0][:, None], across / sizes[1][:, None]
    return numpy.stack([tangent, numpy.cross(across, tangent), across], axis=1)


def _nautical(degrees):
    """Axes turned by alpha about Z, beta about the new Y, gamma about the new X."""
    a, b, c = numpy.radians([*degrees, 0.0, 0.0][:3])
    about_x = numpy.array([[1, 0, 0], [0, numpy.cos(c), numpy.sin(c)], [0, -numpy.sin(c), numpy.cos(c)]])
    about_y = numpy.array([[numpy.cos(b), 0, -numpy.sin(b)], [0, 1, 0], [numpy.sin(b), 0, numpy.cos(b)]])
    about_z = numpy.array([[numpy.cos(a), numpy.sin(a), 0], [-numpy.sin(a), numpy.cos(a), 0], [0, 0, 1]])
    return about_x @ about_y @ about_z


def invariants(given):
    """{name: (n) values} of tensors (n, 3, 3): VMIS, TRESCA, TRACE, DETER."""
    trace = numpy.trace(given, axis1=1, axis2=2)
    deviator = given - trace[:, None, None] / 3 * numpy.eye(3)
    principal = numpy.linalg.eigvalsh(given)
    return {"VMIS": numpy.sqrt(1.5 * (deviator**2).sum(axis=(1, 2))), "TRESCA": principal[:, 2] - principal[:, 0], "TRACE": trace,
            "DETER": numpy.linalg.det(given)}


def principals(given):
    """{name: (n) values}: PRIN_1 <= PRIN_2 <= PRIN_3 and VECT_1_X ..., whose component of largest magnitude is positive."""
    values, directions = numpy.linalg.eigh(given)
    largest = numpy.take_along_axis(directions, abs(directions).argmax(axis=1)[:, None, :], axis=1)
    directions = directions * numpy.sign(largest)
    made = {f"PRIN_{i + 1}": values[:, i] for i in range(3)}
    made.update((f"VECT_{i + 1}_{axis}", directions[:, a, i]) for i in range(3) for a, axis in enumerate("XYZ"))
    return made


def traces(components, values, along, kind):
    """{name: (n) values}: TRAC_DIR = v . d of vectors, TR_DIR_1 ... = T d of tensors; nothing where there are neither. @param along unit vectors
    d (n, 3) @param kind "DIR" or "NOR\""""
    for _, given in tensors(components, values):
        return {f"TR_{kind}_{i + 1}": column for i, column in enumerate(numpy.einsum("nij,nj->in", given, along))}
    for _, given in vectors(components, values):
        return {f"TRAC_{kind}": (given * along).sum(axis=1)}
    return {}


def direction(given, count):
    """A direction as unit vectors (count, 3)."""
    unit = numpy.zeros(3)
    unit[:len(given)] = given
    return numpy.tile(unit / numpy.linalg.norm(unit), (count, 1))
