"""What end_to_end.py measured as tables and a chart, and their place in docs/performance.md.

A row has the yardsticks of its own run with it, so that figures of several runs may stand in one table.
"""

import json
import pathlib
import re
import tomllib

import numpy as np

PEERS = tomllib.loads((pathlib.Path(__file__).parent / "peers.toml").read_text(encoding="utf-8"))
#: of a Google Benchmark, what is kept
COUNTERS = ("name", "items/s", "GF/s", "of_dgemm", "GB/s", "of_copy", "peak_MB", "macro_elements/s")
#: phase -> its name in the tables, in the order of a study
PHASES = {"launcher": "launcher, Python", "mesh": "mesh: read, turn, cut, write", "other commands": "other commands", "read": "reading of the problem",
          "elements": "elements and assembly", "pairing": "pairing, gaps, integrals", "contact": "contact assembly", "analysis": "analysis",
          "factorisation": "factorisation", "solution": "solutions, columns, GMRES", "archive": "archive", "rest": "rest"}
SOLVER = ("analysis", "factorisation", "solution")


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def number(value, digits=3):
    """With this many digits that count, spaces between thousands: 42.2, 0.66; whole numbers as they are: 310 965."""
    if isinstance(value, int) or value == 0:
        return f"{int(value):,}".replace(",", " ")
    decimals = max(0, digits - 1 - int(np.floor(np.log10(abs(value)))))
    return f"{value:,.{decimals}f}".replace(",", " ")


def power_law(sizes, values):
    """(exponent, factor) of values = factor * sizes^exponent, by least squares of the logarithms."""
    exponent, logarithm = np.polyfit(np.log(sizes), np.log(values), 1)
    return float(exponent), float(np.exp(logarithm))


def series(rows, curved, threads=1):
    """The hexahedral studies of one kind by size, without the smallest, where start-up counts for more than the work."""
    chosen = sorted((row for row in rows if re.fullmatch(r"H\d+" + "c" * curved, row["name"]) and row["threads"] == threads),
                    key=lambda row: row["equations"])
    return chosen[1:]


def studies_section(measured):
    rows, counts = [], sorted({row["threads"] for row in measured["studies"]})
    by_name = {}
    for row in measured["studies"]:
        by_name.setdefault(row["name"], {})[row["threads"]] = row
    for name, runs in by_name.items():
        first = runs[min(runs)]
        multiple = first["wall"] / first["yardsticks"]["factorisation_seconds"]
        wall, memory, iterations = PEERS["code_aster"]["studies"].get(name, (None, None, None))
        peer = wall / PEERS["code_aster"]["cube"] if wall else None
        rows.append([name, number(first["equations"]), *(number(runs[n]["wall"]) if n in runs else "-" for n in counts), number(multiple),
                     *((number(peer), f"**{peer / multiple:.1f}**") if wall else ("-", "-")), number(first["memory"], 4), memory or "-",
                     int(first["counts"]["solutions"]), iterations or "-", int(first["counts"]["factorisations"])])
    head = ["study", "equations", *(f"{n} thread{'s' * (n > 1)}, s" for n in counts), "multiples", "code_aster", "ratio", "memory, MB", "code_aster",
            "Newton solutions", "code_aster", "factorisations"]
    return table(head, rows)


def calculix_section(measured):
    own = {(row["name"], row["threads"]): row for row in measured["studies"]}
    rows = []
    for row in measured["calculix"]:
        ours = own.get((row["name"], 1))
        if not ours:
            continue
        ratio = row["seconds"] / ours["wall"]
        if row["failure"]:
            said = f"more than {ratio:.1f}" if row["failure"] == "out of time" else row["failure"]
            rows.append([row["name"], "-", number(ours["wall"]), number(row["seconds"]), said, number(ours["memory"], 4), f"{number(row['memory'], 4)} so far",
                         int(ours["counts"]["solutions"]), "-", number(ours["force"], 5), "-", "-"])
        else:
            rows.append([row["name"], number(row["equations"]), number(ours["wall"]), number(row["seconds"]), f"**{ratio:.1f}**",
                         number(ours["memory"], 4), number(row["memory"], 4), int(ours["counts"]["solutions"]), row["iterations"],
                         number(ours["force"], 5), number(row["force"], 5),
                         f"{number(max(ours['pressures']), 4)}, {number(max(row['pressures']), 4)}"])
    return table(["study", "equations there", "Lacon, s", "ccx, s", "ratio", "Lacon, MB", "ccx, MB", "solutions", "ccx", "force", "ccx",
                  "largest pressure: Lacon, ccx"], rows)


def profile_section(measured):
    rows = [row for row in measured["studies"] if row["threads"] == min(r["threads"] for r in measured["studies"])]

    def line(title, value):
        return [title, *(value(row) for row in rows)]

    def share(phases):
        return lambda row: f"{100 * sum(row['phases'].get(phase, 0.0) for phase in phases) / row['wall']:.1f} %"

    def gflops(row):
        rate = row["counts"]["Gflop of factorisations"] / row["phases"]["factorisation"]
        return f"{rate:.1f} ({100 * rate / row['yardsticks']['dgemm_gflops']:.0f} %)"

    def io(row):
        rate = 1e-9 * row["io"]["bytes"] / row["io"]["seconds"]
        return f"{rate:.2f} ({100 * rate / row['yardsticks']['copy_gbytes']:.1f} %)"

    def beside(row):
        solver = sum(row["phases"].get(phase, 0.0) for phase in SOLVER)
        return f"{100 * (row['wall'] - solver - row['phases']['launcher']) / solver:.0f} %"

    found = [line("wall, s", lambda row: number(row["wall"])), *(line(title, share([phase])) for phase, title in PHASES.items()),
             line("all but solver and launcher, of the solver", beside), line("factorisation, GF/s (of dgemm)", gflops),
             line("files, GB/s (of a copy of memory)", io),
             line("Newton solutions", lambda row: int(row["counts"]["solutions"])),
             line("factorisations", lambda row: int(row["counts"]["factorisations"])),
             line("columns of the inverse", lambda row: int(row["counts"]["columns of the inverse"])),
             line("iterations of GMRES", lambda row: int(row["counts"].get("iterations of GMRES", 0)))]
    return table(["", *(row["name"] for row in rows)], found)


def growth_section(measured):
    memory = measured["machine"]["memory_gbytes"]
    rows = []
    for curved in (False, True):
        chosen = series(measured["studies"], curved)
        if len(chosen) < 2:
            continue
        sizes = [row["equations"] for row in chosen]
        time, per_time = power_law(sizes, [row["wall"] for row in chosen])
        factor, _ = power_law(sizes, [row["phases"]["factorisation"] for row in chosen])
        space, per_space = power_law(sizes, [row["memory"] / 1000 for row in chosen])
        limit = (memory / per_space) ** (1 / space)
        rows.append([f"{chosen[0]['name']} to {chosen[-1]['name']}", *(f"{exponent:.2f}" for exponent in (time, factor, space)), f"{limit / 1e6:.1f} million",
                     number(per_time * limit**time / 60, 2)])
    if not rows:
        return "Three sizes of a kind are needed for an exponent; they were not measured."
    return table(["studies", "wall", "factorisation", "memory", f"equations in {memory:.0f} GB", "that takes, minutes"], rows)


def parts_section(measured):
    def rate(case, name, part):
        return f"{number(case[name])} ({100 * case[part]:.0f} %)" if name in case else ""

    def amount(value):
        step = next((step for step in ("G", "M", "k") if value >= {"G": 1e9, "M": 1e6, "k": 1e3}[step]), "")
        return f"{number(value / {'G': 1e9, 'M': 1e6, 'k': 1e3, '': 1}[step])} {step}".rstrip()

    rows, elements, behaviours = [], {}, []
    for case in measured["parts"]:
        if case["program"] == "stiffness":  # "stiffness 3D/HEXA8 ELAS/PETIT": a row an element, a column a behaviour
            _, element, behaviour = case["name"].split()
            elements.setdefault(element, {})[behaviour] = f"{amount(case['items/s'])}, {rate(case, 'GF/s', 'of_dgemm')}, {rate(case, 'GB/s', 'of_copy')}"
            behaviours += [behaviour] * (behaviour not in behaviours)
        else:
            name = f"`{case['name']}`" if "<" in case["name"] else case["name"]  # <...> were a link
            rows.append([name, amount(case["items/s"]), rate(case, "GF/s", "of_dgemm"), rate(case, "GB/s", "of_copy"),
                         number(case["peak_MB"]) if "peak_MB" in case else ""])
    made = [table(["case", "items a second", "GF/s (of dgemm)", "GB/s (of a copy)", "peak, MB"], rows)] if rows else []
    if elements:
        made += ["Stiffness, forces and stresses: elements a second, GF/s (of dgemm), GB/s of matrices (of a copy).",
                 table(["element", *behaviours], [[element, *(found.get(b, "") for b in behaviours)] for element, found in elements.items()])]
    return "\n\n".join(made)


def machine_section(measured):
    m = measured["machine"]
    return (f"{m['processor']}, {m['cores']} cores, {m['memory_gbytes']:.0f} GB. Cube of 32^3 HEXA8 factorised in {m['factorisation_seconds']:.2f} s at "
            f"{m['factorisation_gflops']:.1f} GF/s; dgemm {m['dgemm_gflops']:.1f} GF/s, copy of memory {m['copy_gbytes']:.1f} GB/s.")


def sections(measured):
    """Name -> text, of what was measured."""
    made = {"machine": machine_section(measured)}
    if measured["studies"]:
        made |= {"studies": studies_section(measured), "profile": profile_section(measured), "growth": growth_section(measured)}
    if measured["calculix"]:
        made["calculix"] = calculix_section(measured)
    if measured["parts"]:
        made["parts"] = parts_section(measured)
    made |= {name: f"```\n{text}\n```" for name, text in measured["texts"].items()}
    return made


def fill(text, name, content):
    """Put `content` between the markers of this name. Throws ValueError where they are not there once."""
    begin, end = f"<!-- {name}: written by tests/bench/end_to_end.py -->", f"<!-- end of {name} -->"
    if text.count(begin) != 1 or text.count(end) != 1 or text.index(begin) > text.index(end):
        raise ValueError(f"the markers {begin} and {end} are not there once, one behind the other")
    return text[:text.index(begin)] + f"{begin}\n{content}\n" + text[text.index(end):]


def merged(old, new):
    """New figures in place of old ones of the same study, threads or case; order of the studies by kind and size."""
    def key(row):
        return (row["name"], row.get("threads", 0), row.get("program", ""))

    made = {"machine": new["machine"], "texts": old.get("texts", {}) | new["texts"]}
    for kind in ("studies", "calculix", "parts"):
        rows = {key(row): row for row in old.get(kind, [])} | {key(row): row for row in new[kind]}
        made[kind] = list(rows.values())
        if kind != "parts":
            made[kind].sort(key=lambda row: (row["name"].endswith("c"), key(row)))
    return made


def as_json(measured):
    """With a row a line, so that a new measurement changes its own lines alone."""
    def of(kind, value):
        rows = [json.dumps(row) for row in value] if isinstance(value, list) else [f"{json.dumps(k)}: {json.dumps(v)}" for k, v in value.items()]
        left, right = "[]" if isinstance(value, list) else "{}"
        return f"{json.dumps(kind)}: {left}\n" + ",\n".join(rows) + f"\n{right}"

    return "{\n" + ",\n".join(of(kind, value) for kind, value in measured.items()) + "\n}\n"


def write_docs(docs, measured):
    """Update docs/performance.json, and from it the sections and the chart of docs/performance.md."""
    store, page = docs / "performance.json", docs / "performance.md"
    old = json.loads(store.read_text(encoding="utf-8")) if store.exists() else {}
    measured = merged(old, measured)
    text = page.read_text(encoding="utf-8")
    for name, content in sections(measured).items():
        text = fill(text, name, content)
    store.write_text(as_json(measured), encoding="utf-8")
    page.write_text(text, encoding="utf-8")
    chart(measured, docs / "performance.png")


def chart(measured, path):
    """Time and memory against size beside the peers, and the share of each phase."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(16, 5), constrained_layout=True)
    threads = min(row["threads"] for row in measured["studies"])
    studies = [row for row in measured["studies"] if row["threads"] == threads and row["name"].startswith("H")]
    peers = {row["name"]: row for row in measured["calculix"] if not row["failure"]}
    aster = PEERS["code_aster"]
    for curved, line in ((False, "-"), (True, "--")):
        rows = [row for row in studies if row["name"].endswith("c") == curved]
        kind = "curved" if curved else "flat"
        cube = [row["yardsticks"]["factorisation_seconds"] for row in rows]
        curves = {"Lacon": ("C0", [(r["equations"], r["wall"] / c, r["memory"]) for r, c in zip(rows, cube)]),
                  "code_aster": ("C1", [(r["equations"], aster["studies"][r["name"]][0] / aster["cube"], aster["studies"][r["name"]][1]) for r in rows]),
                  "CalculiX MORTAR": ("C2", [(r["equations"], peers[r["name"]]["seconds"] / c, peers[r["name"]]["memory"])
                                             for r, c in zip(rows, cube) if r["name"] in peers])}
        for name, (colour, points) in curves.items():
            if points:
                size, time, memory = zip(*points)
                axes[0].loglog(size, time, "o" + line, color=colour, markersize=4, label=f"{name}, {kind}")
                axes[1].loglog(size, memory, "o" + line, color=colour, markersize=4)
    axes[0].set(xlabel="equations", ylabel="wall time / factorisation of a cube of 32^3 HEXA8")
    axes[1].set(xlabel="equations", ylabel="peak memory, MB")
    axes[0].legend(fontsize=8)
    names, bottom = [row["name"] for row in measured["studies"] if row["threads"] == threads], 0
    for phase, title in PHASES.items():
        share = np.array([100 * row["phases"].get(phase, 0.0) / row["wall"] for row in measured["studies"] if row["threads"] == threads])
        axes[2].bar(names, share, bottom=bottom, label=title, color=plt.get_cmap("tab20")(list(PHASES).index(phase)))
        bottom = bottom + share
    axes[2].set(ylabel="share of the wall time, %", ylim=(0, 100))
    axes[2].legend(fontsize=7, loc="center left", bbox_to_anchor=(1, 0.5))
    figure.savefig(path, dpi=100)
    plt.close(figure)
