"""How values are judged against references, and what is said about it: the checks of TEST_RESU, TEST_TABLE, TEST_FONCTION and assertions.

Every check has up to two judgements: against VALE_REFE, the reference, within PRECISION, and against VALE_CALC, another program's
digits, within TOLE_MACHINE. What is missed is NOOK; but a VALE_CALC that is missed beside a reference that is met is DIFF, unless
--checks all asks for both.
"""

import json
import math

from ..core.files import write_whole

#: below it VALE_CALC is zero, and a relative judgement has no meaning
_zero = 1e-16


class Check:
    """One check with all its figures."""

    def __init__(self, where, label, field, component, place, instant, legend, value):
        self.where, self.label, self.field, self.component = where, label, field, component
        self.place, self.instant, self.legend, self.value = place, instant, legend, value
        self.calculated = self.reference = None
        self.source = ""
        self.status = ""

    def judge(self, calculated, reference, source, strict):
        """`calculated`, `reference`: Judgement; `reference` may be None."""
        self.calculated, self.reference, self.source = calculated, reference, source
        if (calculated if reference is None else reference).met:
            self.status = "OK" if calculated.met else "NOOK" if strict else "DIFF"
        else:
            self.status = "NOOK"

    def decisive(self):
        """The judgement that its line shows: the one that was missed, else the reference where there is one."""
        if self.reference is not None and (not self.reference.met or self.calculated.met):
            return self.reference
        return self.calculated

    def data(self):
        return {"status": self.status, "where": self.where, "label": self.label, "field": self.field, "component": self.component,
                "place": self.place, "instant": self.instant, "legend": self.legend, "value": self.value,
                "vale_calc": self.calculated.data(), "reference": self.source or None,
                "vale_refe": self.reference.data() if self.reference else None}


class Judgement:
    """|value - target| against a tolerance, absolute or relative to the target. A value that is no number is never met."""

    def __init__(self, value, target, tolerance, criterion, judged=True):
        self.target, self.tolerance, self.criterion, self.judged = target, tolerance, criterion, judged
        difference = abs(value - target)
        scale = abs(target) if criterion == "RELATIF" else 1.0
        self.error = difference / scale if scale else (0.0 if difference == 0.0 else math.inf)
        # judged as the difference itself: with a relative criterion and the target 0 only 0 will do
        self.met = not judged or difference <= tolerance * scale

    def data(self):
        return {"value": self.target, "error": _finite(self.error), "tolerance": self.tolerance, "criterion": self.criterion,
                "judged": self.judged, "met": self.met}


class TextJudgement(Judgement):
    """A text against a text."""

    def __init__(self, value, target, tolerance, criterion):
        super().__init__(0 if value.strip() == target.strip() else 1, 0, tolerance, criterion)
        self.target = target


def _finite(x):
    return x if isinstance(x, (int, str)) or math.isfinite(x) else str(x)


def judge_calculated(value, target, tolerance, criterion, magnitude=None):
    """The judgement against VALE_CALC: where it is zero it needs an order of magnitude, else it is not judged."""
    if abs(target) <= _zero:
        if magnitude is None:
            return Judgement(value, target, tolerance, "ABSOLU", judged=False)
        return Judgement(value, target, tolerance * abs(magnitude), "ABSOLU")
    return Judgement(value, target, tolerance, criterion)


# ---------------------------------------------------------------------------------------------------- keywords


def conclude(call, check, test):
    """Judge the value of a check as its keywords say: against VALE_CALC and VALE_REFE, for integers and texts VALE_CALC_I, VALE_CALC_K.

    VALE_ABS compares magnitudes: of the value and of what it is compared with. Of several references the nearest one counts. @return the check
    """
    suffix = next(s for s in ("", "_I", "_K") if "VALE_CALC" + s in test)
    if test.get("VALE_ABS") == "OUI" and suffix != "_K":
        check.value = abs(check.value)
        test = {**test, **{key: _magnitudes(test[key]) for key in ("VALE_CALC" + suffix, "VALE_REFE" + suffix) if key in test}}
    criterion, tolerance = test["CRITERE"][0], test["TOLE_MACHINE"][0]
    targets = {name: _nearest_target(check.value, test[name + suffix]) for name in ("VALE_CALC", "VALE_REFE") if name + suffix in test}
    if suffix == "":
        calculated = judge_calculated(check.value, targets["VALE_CALC"], tolerance, criterion, test.get("ORDRE_GRANDEUR"))
        reference = Judgement(check.value, targets["VALE_REFE"], test["PRECISION"], criterion) if "VALE_REFE" in targets else None
    else:
        kind = Judgement if suffix == "_I" else TextJudgement
        calculated, reference = (kind(check.value, targets[n], 0, "ABSOLU") if n in targets else None for n in ("VALE_CALC", "VALE_REFE"))
    check.judge(calculated, reference, test.get("REFERENCE", ""), call.study.strict_checks)
    return check


def _magnitudes(targets):
    return list(map(abs, targets)) if isinstance(targets, list) else abs(targets)


def _nearest_target(value, targets):
    if not isinstance(targets, list):
        return targets
    if isinstance(value, str):
        return value if value in targets else targets[0]
    return min(targets, key=lambda target: abs(value - target))


# ---------------------------------------------------------------------------------------------------- printing


def line(check):
    """"OK   RES  DEPL  LAGS_C  MIN  INST 1  -25  reference -25  error ...": aligned, one line."""
    shown = check.decisive()
    against = "reference" if shown is check.reference else "VALE_CALC"
    instant = "" if check.instant is None else f"INST {check.instant:g}"
    error = f"{shown.error:.2e}" if shown.judged else "not judged"
    kind = {"RELATIF": "rel", "ABSOLU": "abs"}[shown.criterion]
    text = (f"{check.status:<5}{check.label:<10} {check.field:<10} {check.component:<9} {check.place:<14} {instant:<11} "
            f"{_number(check.value):>21}  {against} {_number(shown.target):>16}  error {error:>10}  tolerance {shown.tolerance:.1e} {kind}")
    if not shown.judged:
        text += "  (VALE_CALC is 0 and ORDRE_GRANDEUR is not given)"
    if check.legend:
        text += f"  {check.legend}"
    return text if check.status == "OK" else f"{text}  ({check.where})"


def _number(value):
    return f"{value:.14g}" if isinstance(value, float) else str(value)


def summary(checks):
    """"12 checks: 10 OK, 1 NOOK, 1 DIFF\""""
    count = {status: sum(c.status == status for c in checks) for status in ("OK", "NOOK", "DIFF")}
    return f"{len(checks)} checks: " + ", ".join(f"{n} {status}" for status, n in count.items())


def write_json(path, checks, diagnostic, status, timings):
    """Every check with all its figures, and where the time went."""
    data = {"format": 1, "diagnostic": diagnostic, "status": status, "checks": [c.data() for c in checks], "timings": timings}
    for check in data["checks"]:
        check["value"] = _finite(check["value"])
    write_whole(path, json.dumps(data, indent=1, ensure_ascii=False) + "\n")
