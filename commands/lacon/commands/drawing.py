"""Curves on the unit of a command: FORMAT='XMGRACE' and 'PNG'."""

from ..core.files import whole
from ..tables.curves import Plot


def draw(call, made):
    """Add curves to the plot of the unit, and write it anew. FORMAT says how."""
    k, run = call.keywords, call.study
    png = k["FORMAT"] == "PNG"
    unit, where = k["UNITE"], f"{call.command}/UNITE, {call.where}"
    path = run.announced_output(unit, ".png" if png else ".agr", where)
    plot = run.plots.setdefault((unit, k["FORMAT"]), Plot())
    before = dict(vars(plot), curves=list(plot.curves))
    plot.describe(k)
    plot.curves += made
    try:
        with whole(path) as partial:
            if png:
                plot.png(partial)
            else:
                with open(partial, "w", encoding="utf-8") as file:
                    file.write(plot.xmgrace())
    except ImportError:
        vars(plot).update(before)
        call.fail("FUNCTION_10", "FORMAT")
    except OSError:
        vars(plot).update(before)
        call.fail("COMMAND_8", "UNITE", unit=unit, file=path)
    run.written_units[unit] = path
