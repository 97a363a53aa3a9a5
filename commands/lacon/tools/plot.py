"""`lacon plot BASE`: pictures for papers, and for who has no browser: the mesh, the contact pressure, the convergence, as PNG and SVG.

Reads the base, and never changes it.
"""

import os
import pathlib

from ..core import outcome
from ..core.command_line import CommandLine
from ..core.messages import AsterError, fail, show
from ..reader.base import open_base
from ..reader.result import Result

formats = ("png", "svg")
pictures = ("mesh", "pressure", "convergence")


def parser():
    """Of its command line."""
    made = CommandLine(
        prog="lacon plot", description="Draws the deformed mesh, the contact pressure and the convergence of a result, as NAME_mesh, NAME_pressure and "
        "NAME_convergence, each as PNG and SVG; also of a run in progress.")
    made.add("base", metavar="BASE", help="folder of the base, STUDY.base")
    made.add("--result", metavar="LABEL", help="the result; otherwise the only one of displacements")
    made.add("--instant", type=float, metavar="T", help="an instant of the result; otherwise the last one")
    made.add("--iteration", type=int, metavar="N", help="an iterate of the step at which the computation failed, by its number")
    made.add("--field", metavar="NAME", help="colours of the mesh: a field at nodes, SIEF_NOEU; otherwise the displacements, of an iterate the forces not in balance")
    made.add("--component", metavar="NAME", help="a component of the field; otherwise its magnitude")
    made.add("--scale", type=float, default=1.0, metavar="X", help="of the displacements; 1 by default")
    made.add("--format", action="append", choices=formats, help="one of them alone; may be repeated")
    made.add("--dpi", type=float, default=150.0, help="of PNG files; 150 by default")
    made.add("--out", metavar="NAME", help="what the files' names begin with, a folder among it; otherwise the name of the study")
    return made


def run(arguments):
    """@return exit status"""
    asked = parser()
    options = asked.parse_args(arguments)
    base = open_base(options.base)
    stem = pathlib.Path(options.out or base.folder.resolve().stem)
    places = {(name, suffix): stem.with_name(f"{stem.name}_{name}.{suffix}") for name in pictures for suffix in options.format or formats}
    if (taken := next(filter(base.needs, places.values()), None)) is not None:
        fail("STUDY_41", "lacon plot", option="--out", file=taken)
    result = base.only_result(options.result)
    if options.iteration is not None:
        result = result.failed_step or result
        if isinstance(result, Result):
            fail("PLOT_2", "lacon plot --iteration", label=result.label)
    at = {"instant": options.instant, "order": options.iteration}
    drawing = (lambda: result.plot(**at, scale=options.scale, field=checked(result, at, options), component=options.component),
               lambda: result.plot_pressure(**at), result.plot_convergence)
    for name, draw in zip(pictures, drawing):
        try:
            figure = draw()
        except AsterError as error:
            if error.id_message not in ("READER_3", "READER_4"):
                raise
            show(error.messages[0]._replace(severity="I"))  # a result without contact, or without journal, has the other pictures
            continue
        for suffix in options.format or formats:
            path = places[name, suffix]
            try:
                stem.parent.mkdir(parents=True, exist_ok=True)
                figure.savefig(path, dpi=options.dpi)
            except OSError as error:
                fail("STUDY_50", "lacon plot --out", option="--out", file=path, reason=error.strerror)
            print(os.path.relpath(path))
    return outcome.done


def checked(result, at, options):
    """The field that is meant. @throws AsterError PLOT_1"""
    if options.field is None:
        return None
    field = result.field(options.field, **at)
    if field.location != "NOEU" or (options.component and options.component not in field.components):
        fail("PLOT_1", f"lacon plot --field {options.field}", field=options.field, location=field.location, components=", ".join(field.components))
    return options.field
