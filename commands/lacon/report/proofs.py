"""What a result holds to be trusted by: figures of the contact and of Newton's method at each instant, each with a verdict in plain words."""

from ..core.catalog import part
from ..core.late import numpy

balanced = 1e-8  #: sums of forces and moments that vanish, over the forces
exclusive = 1e-6  #: largest product of pressure and gap, over the largest pressure and the size of a patch
pulling = 1e-9  #: largest tension of a patch in contact, over the largest pressure


def _line(holds, what, found, says):
    return {"holds": holds, "what": what, "found": found, "says": says}


def _figure(x):
    return f"{x:.3g}"


def of_instant(index, parameters, zones, journal, patches):
    """Lines of one instant. @param parameters name -> values of the instants  @param zones contents.contact_zones()
    @param journal what newton() made of the iterations of this instant; None  @param patches reader.Patches; None"""
    lines = []

    def value(name):
        """None where the instant has none: a stage of the result without contact"""
        found = float(parameters[name][index]) if name in parameters else numpy.nan
        return None if numpy.isnan(found) else found

    if journal:
        lines += newton(journal)
    found, expected = value("negative_pivots"), value("expected_negative_pivots")
    if found is not None and found >= 0:
        holds = found == expected
        lines.append(_line(holds, part("stable_equilibrium"), part("pivots_constraints", found=f"{found:.0f}", expected=f"{expected:.0f}"),
                           part("bodies_resist" if holds else "a_body_moves")))
    for number, (slave, master, _, _) in enumerate(zones):
        lines += of_zone(part("slave_on_master", slave=slave, master=master), lambda name, number=number: value(f"zone_{number + 1}_{name}"),
                         None if patches is None else (patches, patches.zone == number))
    return lines


def newton(iterations):
    """@param iterations (limits, iterations of the instant) of the journal"""
    limits, lines = iterations
    last = lines[-1]
    found = []
    for key, keyword in (("rela", "RESI_GLOB_RELA"), ("maxi", "RESI_GLOB_MAXI"), ("refe", "RESI_REFE_RELA")):
        if limits.get(key) is not None:
            holds = last[key] <= limits[key]
            found.append(_line(bool(holds or last.get("converged")), part("equilibrium_by", keyword=keyword), part("asked_for", found=_figure(last[key]), limit=_figure(limits[key])),
                               part("reached_in", count=last.get("iteration", len(lines) - 1)) if holds or last.get("converged") else part("not_reached")))
    if "changes" in last:
        holds = last["changes"] == 0
        found.append(_line(holds, part("contact_settled"), part("patches_changed", count=last["changes"]), part("nothing_changes" if holds else "still_changing")))
    return found


def of_zone(name, value, patches):
    """@param value name of a parameter of the zone -> its value, None where there is none  @param patches (Patches, mask of the zone's); None"""
    vectors = [[value(f"{what}_{axis}") for axis in "xyz"] for what in ("slave_force", "master_force", "moment")]
    if vectors[0][0] is None:
        return []
    slave, master, moment = map(numpy.array, vectors)
    force = max(numpy.linalg.norm(slave), numpy.linalg.norm(master))
    lines = []
    if value("active") == 0:
        return [_line(True, part("no_contact", zone=name), part("patches_open", count=f"{value('open'):.0f}"), part("skins_apart"))]
    pressure, size, reach = force, 1.0, 1.0
    if patches is not None:
        of, mask = patches
        reach = max(float(numpy.ptp(of.centre, axis=0).max()), float(abs(of.centre).max()))
        pressure = float(abs(of.pressure[mask]).max())
        size = float(numpy.sqrt(of.area[mask].mean()) if reach and of.space else of.area[mask].mean())
        force = max(force, float((abs(of.pressure) * of.area)[mask & (of.status == 1)].sum()))
    sums = float(numpy.linalg.norm(slave + master))
    holds = sums <= balanced * force
    lines.append(_line(bool(holds), part("forces_balance", zone=name), part("sum_of", found=_figure(sums), whole=_figure(force)),
                       part("action_is_reaction" if holds else "forces_lost")))
    about = float(numpy.linalg.norm(moment))
    holds = about <= balanced * force * max(reach, 1e-300)
    lines.append(_line(bool(holds), part("moments_balance", zone=name), part("sum_of", found=_figure(about), whole=_figure(force * reach)),
                       part("no_moment" if holds else "own_moment")))
    work = value("largest_lambda_gap")
    holds = work <= exclusive * max(pressure * size, 1e-300)
    lines.append(_line(bool(holds), part("pressure_or_gap", zone=name), part("largest_product", found=_figure(work), whole=_figure(pressure * size)),
                       part("never_both" if holds else "both_at_once")))
    if patches is not None:
        least = float(of.pressure[mask & (of.status == 1)].min())
        holds = least >= -pulling * pressure
        lines.append(_line(bool(holds), part("only_presses", zone=name), part("least_pressure", found=_figure(least)), part("no_patch_pulls" if holds else "a_patch_pulls")))
    covered, whole, lost = value("covered"), value("whole"), value("unpaired")
    if whole:
        lines.append(_line(True if lost == 0 else None, part("slaves_see_masters", zone=name), part("skin_covered", percent=f"{100 * covered / whole:.4g}", count=f"{lost:.0f}"),
                           part("every_patch_has_one" if lost == 0 else "patches_without_one")))
    return lines
