// What stands around the picture: verdicts, tables of zones, curves, the run, the command file.
import {chart, number} from "./charts.js";
import {series as colours} from "./colours.js";
import {study} from "./data.js";
import {t} from "./words.js";

export const element = (name, properties = {}, ...children) => {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children.filter((child) => child !== null));
  return made;
};

const judged = {true: ["✓", "good"], false: ["✗", "bad"], null: ["?", "unknown"]};

function mark(holds) {
  const [sign, kind] = judged[holds ?? null];
  return element("span", {className: `mark ${kind}`, textContent: sign, ariaLabel: {good: t("holds"), bad: t("does not hold"), unknown: t("not known")}[kind]});
}

function table(heads, rows, caption = "") {
  const line = (cells, kind) => element("tr", {}, ...cells.map((cell) => {
    const isFigure = cell?.figure !== undefined;
    return element(kind, {className: isFigure ? "figure" : ""}, ...(isFigure ? [cell.figure] : [cell].flat()));
  }));
  const made = element("table", {}, element("thead", {}, line(heads, "th")), element("tbody", {}, ...rows.map((row) => line(row, "td"))));
  if (caption) made.prepend(element("caption", {textContent: caption}));
  return element("div", {className: "scroll"}, made);
}

const list = (pairs) => element("dl", {}, ...pairs.flatMap(([name, value]) => [element("dt", {textContent: name}), element("dd", {textContent: value})]));

/** The verdict over all instants, and one line a proof at this instant. */
export function showProofs(instant) {
  const step = study.failed && {holds: false, what: t("The step from {begins} to {instant}", {begins: number(study.failed.begins, 9), instant: number(study.failed.instant, 9)}),
    found: study.failed.message, says: study.failed.reason};
  const all = [...study.proofs.flat(), step].filter(Boolean);
  const failed = all.filter(({holds}) => holds === false).length;
  const verdict = document.getElementById("verdict");
  verdict.className = failed ? "bad" : "good";
  verdict.textContent = !all.length ? "" : t(failed ? "✗ {failed} of {all} checks to look at" : "✓ all {all} checks hold", {failed, all: all.length});
  verdict.hidden = !all.length;
  const lines = [step, ...(study.proofs[instant] ?? [])].filter(Boolean);
  document.getElementById("proof-lines").replaceChildren(lines.length
    ? table(["", t("What is checked"), t("Found"), t("What it says")], lines.map(({holds, what, found, says}) => [mark(holds), what, found, says]))
    : element("p", {textContent: t("The result holds no figures to check at this instant.")}));
}

export function showZones(instant) {
  const box = document.getElementById("zones");
  box.hidden = !study.zones.length || instant === undefined;
  if (box.hidden) return;
  const at = study.instants[instant];
  const rows = study.zones.map((zone, z) => {
    const now = zone.course[instant] ?? {};
    const figure = (x) => ({figure: number(x)});
    return [`${z + 1}`, t("{slave} on {master}", zone), figure(now.active), figure(now.open), figure(now.unpaired), figure(now.area), figure(now.covered),
      {figure: (now.force ?? []).map((x) => number(x)).join(", ")}, figure(now.largest)];
  });
  document.getElementById("zone-table").replaceChildren(
    table([t("Zone"), t("Slave on master"), {figure: t("In contact")}, {figure: t("Open")}, {figure: t("Without master")}, {figure: study.dimension === 3 ? t("Area in contact") : t("Length in contact")},
      {figure: t("Slave skin covered")}, {figure: t("Force on the slave")}, {figure: t("Largest pressure")}], rows),
    element("p", {className: "unknown", textContent: [t("At the instant {instant}. Patches are counted; forces are resultants in {axes}.", {instant: number(at, 9), axes: study.dimension === 3 ? "x, y, z" : "x, y"}),
      study.of_revolution ? t("Forces, and how much of the slave skin is covered, are those of one radian of the axisymmetric bodies.") : ""].join(" ").trim()}));
}

/** All curves, with the instant that is shown. @param choose called with the number of an instant  @param along pressure along the skins, in the plane */
export function showCurves(instant, choose, along) {
  const made = [...newtonCurves(), ...instantCurves(instant, choose), ...along];
  document.getElementById("charts").replaceChildren(...(made.length ? made : [element("p", {textContent: t("The base holds nothing to draw over instants.")})]));
}

function newtonCurves() {
  const journal = study.journal;
  if (!journal?.rows.length) return [];
  const dividers = [], breaks = new Set();
  journal.rows.forEach(({attempt}, i) => {
    if (i && attempt !== journal.rows[i - 1].attempt) {
      dividers.push(i + 0.5);
      breaks.add(i + 1);
    }
  });
  const of = (key) => journal.rows.map((row, i) => [i + 1, row[key]]);
  const curve = (key, name, colour) => ({name, colour, points: of(key), breaks});
  const known = (curves) => curves.filter(({points}) => points.some(([, q]) => q > 0));
  const levels = Object.entries({rela: 0, maxi: 1, geometry: 2, constraint: 3}).filter(([key]) => journal.limits[key])
    .map(([key, c]) => ({value: journal.limits[key], name: t("limit of {what}", {what: words[key]}), colour: colours[c]}));
  const shown = dividers.length > 80 ? [] : dividers;
  const residuals = chart({title: t("Newton's method: residuals"), x: t("iteration"), y: t("residual"), log: true, dividers: shown,
    levels: levels.filter(({name}) => !name.endsWith(words.constraint)),
    series: known([curve("rela", words.rela, colours[0]), curve("maxi", words.maxi, colours[1]), curve("geometry", words.geometry, colours[2])])});
  const changes = chart({title: t("Newton's method: contact"), x: t("iteration"), y: t("patches"), dividers: shown,
    series: [{name: t("in contact"), colour: colours[4], points: of("active"), breaks}, {name: t("changes of status"), colour: colours[1], points: of("changes"), bars: true}]});
  return journal.patches ? [residuals, changes] : [residuals];
}

const words = {rela: "RESI_GLOB_RELA", maxi: "RESI_GLOB_MAXI", geometry: "RESI_GEOM", constraint: t("gap of active patches")};

function instantCurves(instant, choose) {
  if (study.instants.length < 2) return [];
  const at = study.instants[instant];
  const pick = (at) => choose(study.instants.indexOf(at));
  const over = (title, y, make, more = {}) => {
    const curves = study.zones.map((zone, z) => ({name: t("{slave} on {master}", zone), colour: colours[z % colours.length],
      points: zone.course.map((now, i) => [study.instants[i], make(now)]).filter(([, q]) => q !== undefined && q !== null)})).filter(({points}) => points.length);
    return curves.length ? [chart({title, x: t("instant"), y, series: curves, at, choose: pick, ...more})] : [];
  };
  const found = [
    ...over(study.of_revolution ? t("Contact force on the slave, of one radian") : t("Contact force on the slave"), t("force"), (now) => now.force && Math.hypot(...now.force)),
    ...over(study.dimension === 3 ? t("Area in contact") : t("Length in contact"), study.dimension === 3 ? t("area") : t("length"), (now) => now.area),
    ...over(t("Largest contact pressure"), t("pressure"), (now) => now.largest),
    ...over(t("Patches in contact"), t("patches"), (now) => now.active),
    ...over(t("Dissipated by friction"), t("energy"), (now) => now.dissipated),
  ];
  if (study.iterations.some((n) => n > 0))
    found.push(chart({title: t("Iterations of each instant"), x: t("instant"), y: t("iterations"), at, choose: pick,
      series: [{name: t("iterations"), colour: colours[0], bars: true, points: study.iterations.map((n, i) => [study.instants[i], n])}]}));
  return found;
}

const seconds = (s) => (s >= 100 ? `${Math.floor(s / 60)} min ${Math.round(s % 60)} s` : `${number(s, 3)} s`);

export function showRun() {
  const {run} = study;
  const block = (title, pairs) => (pairs.length ? element("div", {}, element("h3", {textContent: title}), list(pairs)) : null);
  const phases = Object.entries(run.phases ?? {}).sort((a, b) => b[1] - a[1]).map(([name, s]) => [t(name), seconds(s)]);
  document.getElementById("run-facts").replaceChildren(element("div", {className: "facts"},
    block(t("Study"), run.study), block(t("Machine and versions"), run.machine), block(t("Time and memory of the solution"), [...run.totals, ...phases]), block(t("This page"), run.page)));
  const files = study.commands.map(({name, text}) => element("details", {open: study.commands.length === 1}, element("summary", {textContent: name}), element("pre", {textContent: text})));
  document.getElementById("command-files").replaceChildren(...(files.length ? files : [element("p", {textContent: t("The base does not know its command file.")})]));
  document.getElementById("notes").textContent = study.notes.join(" ");
}

/** Figures of what was picked. @param masters of a patch: [{cell, share}], null where they are not known; undefined for what has none */
export function showFigures(title, pairs, masters) {
  const box = document.getElementById("figures");
  if (!title) {
    box.replaceChildren(element("span", {className: "unknown", textContent: study.zones.length ? t("Click on a patch or a body.") : t("Click on a body.")}));
    return;
  }
  box.replaceChildren(element("h3", {textContent: title}), list(pairs), ...(masters === undefined ? [] : [element("h3", {textContent: t("Its masters")}), masters?.length
    ? list(masters.map(({cell, share}) => [`M${cell}`, `${(100 * share).toFixed(share < 0.1 ? 1 : 0)} %`]))
    : element("span", {className: "unknown", textContent: t(masters ? "none along its normals" : "not known: the base was computed before they were kept")})]));
}
