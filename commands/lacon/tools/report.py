"""`lacon report BASE`: one HTML file of a result, to look at in a browser, offline; also of a run in progress."""

import json
import pathlib
import webbrowser

from ..core import outcome, plugins
from ..core.catalog import part
from ..core.command_line import CommandLine
from ..core.files import write_whole
from ..core.messages import fail
from ..reader.base import open_base
from ..report import study

_marker = "<!--STUDY-->"


def parser():
    """What it is called with."""
    made = CommandLine(
        prog="lacon report", description="Writes one HTML file that shows a result: the deformed bodies in 3D with every field, the contact patch by patch, "
        "curves of Newton's method and of the contact, what the result may be trusted for, times and the command file.")
    made.add("base", metavar="BASE", help="folder of the base, STUDY.base")
    made.add("--result", metavar="LABEL", help="the result; otherwise the only one of displacements")
    made.add("--out", metavar="FILE", help="the file to write, which is replaced; otherwise BASE without its suffix and with .html")
    made.add("--open", action="store_true", help="show it in the browser")
    return made


def run(arguments):
    """@return exit status"""
    options = parser().parse_args(arguments)
    page = template()
    base = open_base(options.base)
    target = pathlib.Path(options.out or base.folder.with_suffix(".html").name)
    if base.needs(target):
        fail("STUDY_41", "lacon report", option="--out", file=target)
    told, packing = study.make(base, base.only_result(options.result))
    try:
        write_whole(target, filled(page, told, packing))
    except OSError as error:
        fail("STUDY_50", "lacon report --out", option="--out", file=target, reason=error.strerror)
    print(part("report_made", file=target, size=f"{target.stat().st_size / 1e6:.1f}", instants=len(told["drawn"]), fields=len(told["fields"])))
    if options.open:
        webbrowser.open(target.resolve().as_uri())
    return outcome.done


def template():
    """The page without a study, made where npm is when Lacon is built. @throws AsterError REPORT_1 where it was not"""
    root = plugins.operator_folder().parent
    for path in (root / "share" / "lacon" / "report.html", root / "generated" / "report.html"):
        if path.exists():
            return path.read_text(encoding="utf-8")
    fail("REPORT_1", "lacon report")
    raise AssertionError


def filled(page, told, packing):
    """The page with a study."""
    text = json.dumps(told, allow_nan=False).replace("<", "\\u003c")
    return page.replace(_marker, f'<script type="application/json" id="study">{text}</script>\n{packing.elements()}', 1)
