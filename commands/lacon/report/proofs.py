"""What a result holds to be trusted by: figures of the contact and of Newton's method at each instant, each with a verdict in plain words."""

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
    value = lambda name: float(parameters[name][index]) if name in parameters else None  # noqa: E731
    if journal:
        lines += newton(journal)
    found, expected = value("negative_pivots"), value("expected_negative_pivots")
    if found is not None and found >= 0:
        holds = found == expected
        lines.append(_line(holds, "Stable equilibrium", f"{found:.0f} negative pivots, {expected:.0f} constraints",
                           "as many as constraints: the bodies resist every motion that contact leaves them" if holds else
                           "not as many as constraints: a body can move away or buckle, or the equilibrium is not the only one"))
    for number, (slave, master, _, _) in enumerate(zones):
        lines += of_zone(f"{slave} on {master}", lambda name, number=number: value(f"zone_{number + 1}_{name}"),
                         None if patches is None else (patches, patches.zone == number))
    return lines


def newton(iterations):
    """@param iterations (limits, iterations of the instant) of the journal"""
    limits, lines = iterations
    last = lines[-1]
    found = []
    for key, keyword in (("rela", "RESI_GLOB_RELA"), ("maxi", "RESI_GLOB_MAXI")):
        if limits.get(key) is not None:
            holds = last[key] <= limits[key]
            found.append(_line(bool(holds or last.get("converged")), f"Equilibrium, {keyword}", f"{_figure(last[key])}, asked for {_figure(limits[key])}",
                               f"reached in {len(lines)} iterations" if holds or last.get("converged") else "not reached"))
    if "changes" in last:
        holds = last["changes"] == 0
        found.append(_line(holds, "Contact has settled", f"{last['changes']} patches changed in the last iteration",
                           "no patch opens or closes any more" if holds else "the computation ended while patches were opening or closing"))
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
        return [_line(True, f"{name}: no contact", f"{value('open'):.0f} patches open", "the skins do not touch at this instant")]
    pressure, size, reach = force, 1.0, 1.0
    if patches is not None:
        of, mask = patches
        reach = max(float(numpy.ptp(of.centre, axis=0).max()), float(abs(of.centre).max()))
        pressure = float(abs(of.pressure[mask]).max())
        size = float(numpy.sqrt(of.area[mask].mean()) if reach and of.space else of.area[mask].mean())
        force = max(force, float((abs(of.pressure) * of.area)[mask & (of.status == 1)].sum()))
    sums = float(numpy.linalg.norm(slave + master))
    holds = sums <= balanced * force
    lines.append(_line(bool(holds), f"{name}: forces balance", f"sum {_figure(sums)} of {_figure(force)}",
                       "action equals reaction" if holds else "action and reaction differ: forces are lost in the contact"))
    about = float(numpy.linalg.norm(moment))
    holds = about <= balanced * force * max(reach, 1e-300)
    lines.append(_line(bool(holds), f"{name}: moments balance", f"sum {_figure(about)} of {_figure(force * reach)}",
                       "the contact makes no moment out of nothing" if holds else "the contact makes a moment of its own"))
    work = value("largest_lambda_gap")
    holds = work <= exclusive * max(pressure * size, 1e-300)
    lines.append(_line(bool(holds), f"{name}: pressure or gap", f"largest |pressure × gap| {_figure(work)} of {_figure(pressure * size)}",
                       "where there is pressure there is no gap" if holds else "some patch has pressure and a gap, or overlap, at once"))
    if patches is not None:
        least = float(of.pressure[mask & (of.status == 1)].min())
        holds = least >= -pulling * pressure
        lines.append(_line(bool(holds), f"{name}: contact only presses", f"least pressure {_figure(least)}",
                           "no patch in contact pulls" if holds else "a patch in contact pulls: the load is between two instants, or the iteration ended early"))
    covered, whole, lost = value("covered"), value("whole"), value("unpaired")
    if whole:
        lines.append(_line(True if lost == 0 else None, f"{name}: slaves see masters", f"{100 * covered / whole:.4g} % of the slave skin, {lost:.0f} patches without master",
                           "every patch has a master" if lost == 0 else "patches without master carry nothing: right where the slave skin reaches beyond the master"))
    return lines
