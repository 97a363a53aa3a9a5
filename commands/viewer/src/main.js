// The page of `lacon report`: what is chosen, and who shows it.
import {chart, number} from "./charts.js";
import {at as colourAt, css, diverging, maps, series as colours, statuses} from "./colours.js";
import {mastersOf, quantities, study, values} from "./data.js";
import {element, showCurves, showFigures, showProofs, showRun, showZones} from "./panels.js";
import {Scene} from "./scene.js";
import {t, translatePage} from "./words.js";

const $ = (id) => document.getElementById(id);
const inputs = ["field", "component", "map", "range", "low", "high", "magnify", "opacity", "edges", "zone", "opening", "instant", "iterate"];
const control = Object.fromEntries(inputs.map((id) => [id, $(id)]));

const roundOff = 1e-12; // of the model's size: gaps below it are none
const manyFacets = 20000; // edges of so many are not lines any more

let scene = null;
let shown = {kind: "none", values: null};
let picked = null;
let drawing = 0;

// ---------------------------------------------------------------------------------------------------- theme

function theme() {
  const style = getComputedStyle(document.documentElement);
  const rgb = (name) => style.getPropertyValue(name).trim().match(/[0-9a-f]{2}/gi).slice(0, 3).map((c) => parseInt(c, 16) / 255);
  scene?.setTheme({background: rgb("--view"), ink: rgb("--ink")});
  if (scene) scene.ink = rgb("--ink");
}

function startTheme() {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const set = (name) => {
    document.documentElement.dataset.theme = name;
    theme();
    scene?.render();
  };
  set(dark.matches ? "dark" : "light");
  dark.addEventListener("change", () => set(dark.matches ? "dark" : "light"));
  $("theme").addEventListener("click", () => set(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  let before = null; // while it is on paper
  matchMedia("print").addEventListener("change", ({matches}) => {
    if (matches) before ??= document.documentElement.dataset.theme;
    set(matches ? "light" : before ?? "light");
    if (!matches) before = null;
  });
  // the picture is on the screen a frame later, and only then on paper
  const printLight = async () => {
    const name = document.documentElement.dataset.theme;
    set("light");
    for (let i = 0; i < 2; ++i) await new Promise(requestAnimationFrame);
    print();
    set(name);
  };
  $("print").addEventListener("click", printLight);
  addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "p") return;
    event.preventDefault();
    printLight();
  });
}

// ---------------------------------------------------------------------------------------------------- choices

// What is looked at is one of two courses: the instants of the result, or the iterates of the step that failed.
const instants = {fields: study.fields, drawn: study.drawn, start: study.drawn.length - 1, first: study.first, control: control.instant}; // drawn: indices into study.instants
const iterates = study.failed && {fields: study.failed.fields, drawn: study.failed.iterations.map((_, i) => i), start: study.failed.start, first: study.failed.first, control: control.iterate};
let course = instants;
const drawn = () => course.drawn;
const now = () => drawn()[Number(course.control.value)];
const lastInstant = () => study.drawn[Number(control.instant.value)] ?? study.drawn.at(-1);
const field = () => course.fields.find(({name}) => name === control.field.value);
/** "instant 0.5" of what is looked at. */
const caption = () => (course === instants ? t("instant {instant}", {instant: number(study.instants[now()], 9)})
  : t("iteration {iteration} of the failed step", {iteration: study.failed.iterations[now()]}));
const quantity = () => quantities(field()).find(({name}) => name === control.component.value);

const options = (select, rows) => select.replaceChildren(...rows.map(([value, text]) => element("option", {value, textContent: text})));

/** Look at the other course, with the fields that it has. */
function follow(other) {
  if (course === other) return;
  course.shown = {field: control.field.value, component: control.component.value};
  course = other;
  const {field: name, component} = course.shown ?? course.first;
  fillFields(name, component);
}

function fillFields(name, component) {
  options(control.field, course.fields.map(({name: value, title}) => [value, title]));
  control.field.value = name;
  fillComponents(component);
  $("time").classList.toggle("rests", course !== instants);
  $("iterates").classList.toggle("rests", course !== iterates);
}

function fillControls() {
  options(control.map, [...Object.keys(maps)].map((name) => [name, t(name)]));
  options(control.zone, study.zones.map(({slave, master}, z) => [z, `${z + 1}: ${t("{slave} on {master}", {slave, master})}`]));
  $("book").hidden = !study.zones.length;
  for (const one of [instants, iterates].filter(Boolean)) {
    one.control.max = one.drawn.length - 1;
    one.control.value = one.start;
    one.shown = null;
  }
  $("time").hidden = study.drawn.length < (iterates ? 1 : 2);
  $("iterates").hidden = !iterates;
  course = study.drawn.length ? instants : iterates;
  fillFields(course.first.field, course.first.component);
  $("parts").replaceChildren(...(study.parts.length > 1 ? study.parts.map((name, part) => {
    const box = element("input", {type: "checkbox", checked: true});
    box.addEventListener("change", () => {
      scene.see.hidden[box.checked ? "delete" : "add"](part);
      scene.applyLook();
      scene.render();
    });
    return element("label", {className: "check"}, box, ` ${name}`);
  }) : []));
}

function fillComponents(wanted) {
  if (!field()) return;
  const list = quantities(field());
  options(control.component, list.map(({name, label}) => [name, t(label)]));
  control.component.value = list.some(({name}) => name === wanted) ? wanted : list[0].name;
  chooseMap();
}

/** What has both signs is best seen about zero. */
function chooseMap() {
  control.map.value = quantity().name === "gap" ? diverging : "viridis";
  control.map.disabled = quantity().name === "status";
}

// ---------------------------------------------------------------------------------------------------- drawing

function rangeOf(list) {
  let low = Infinity, high = -Infinity;
  for (const v of list) {
    if (v < low) low = v;
    if (v > high) high = v;
  }
  return low <= high ? [low, high] : [0, 1];
}

async function valuesAt(instant) {
  const all = await values(field(), instant);
  return all && quantity().of(all);
}

async function range(own) {
  if (control.range.value === "own") return [Number(control.low.value), Number(control.high.value)];
  let found = rangeOf(own ?? []);
  if (control.range.value === "all")
    for (const instant of drawn()) {
      const other = await valuesAt(instant);
      if (!other) continue;
      const [low, high] = rangeOf(other);
      found = [Math.min(found[0], low), Math.max(found[1], high)];
    }
  if (found[1] - found[0] <= 1e-6 * Math.max(...found.map(Math.abs))) found = [Math.min(0, ...found), Math.max(0, ...found)]; // one value and round-off
  if (quantity()?.name === "gap" && Math.max(...found.map(Math.abs)) < roundOff * study.size) found = [-roundOff * study.size, roundOff * study.size];
  if (control.map.value === diverging) {
    const most = Math.max(Math.abs(found[0]), Math.abs(found[1]));
    found = [-most, most];
  }
  [control.low.value, control.high.value] = found.map((x) => Number(x.toPrecision(6)));
  return found;
}

/** Draw what is chosen; the latest choice wins. */
async function draw() {
  const mine = ++drawing;
  const instant = now();
  const displacement = course.fields.find(({name}) => name === "DEPL");
  const moved = displacement ? await values(displacement, instant) : null;
  const vector = moved && ["DX", "DY", "DZ"].map((name) => displacement.components.indexOf(name)).filter((c) => c >= 0).map((c) => moved[c]);
  const own = field() ? await valuesAt(instant) : null;
  const limits = await range(own);
  if (mine !== drawing) return;
  const map = quantity()?.name === "status" ? "status" : control.map.value;
  scene.setMap(map, limits);
  scene.colour(field()?.kind, own);
  const scale = Number(control.magnify.value) * bound(vector);
  scene.deform(vector, scale);
  shown = {kind: field()?.kind, values: own, vector, limits, map};
  showScale(own);
  showTimes(scale);
  showPicked();
  scene.render();
  document.body.dataset.drawn = String(mine);
}

/** By what displacements are scaled: iterations that diverge leave nodes far away. */
function bound(vector) {
  if (course === instants || !vector) return 1;
  let farthest = 0;
  for (let i = 0; i < vector[0].length; ++i) farthest = Math.max(farthest, Math.hypot(...vector.map((v) => v[i] || 0)));
  return Math.min(1, (0.5 * study.size) / farthest);
}

/** @param scale of the displacements that are shown */
function showTimes(scale) {
  if (study.drawn.length) {
    const at = {instant: number(study.instants[lastInstant()], 9), number: Number(control.instant.value) + 1, count: study.drawn.length};
    $("instant-value").textContent = t("instant {instant}  ({number} of {count})", at);
    control.instant.setAttribute("aria-valuetext", t("instant {instant}", at));
  }
  if (!iterates) return;
  const iteration = {iteration: study.failed.iterations[Number(control.iterate.value)], instant: number(study.failed.instant, 9)};
  $("iterate-value").textContent = t("iteration {iteration} of the step to {instant}", iteration);
  if (course === iterates && scale !== Number(control.magnify.value)) $("iterate-value").textContent += `, ${t("displacements × {scale}", {scale: number(scale, 2)})}`;
  control.iterate.setAttribute("aria-valuetext", $("iterate-value").textContent);
}

/** Also what stands around the picture; of iterates the tables stay with the last instant. */
async function drawAll() {
  await draw();
  showProofs(lastInstant());
  showZones(lastInstant());
  showCurves(lastInstant(), (instant) => {
    const nearest = study.drawn.reduce((best, d, i) => (Math.abs(d - instant) < Math.abs(study.drawn[best] - instant) ? i : best), 0);
    follow(instants);
    control.instant.value = nearest;
    drawAll();
  }, await alongSkins());
}

function showScale(own) {
  const name = field() ? `${field().title}, ${t(quantity().label)}` : "";
  if (!own) {
    $("scale").replaceChildren(element("b", {textContent: name ? t("{field}: not kept at this instant", {field: name}) : t("no field")}));
    return;
  }
  const {limits, map} = shown;
  if (map === "status") {
    const keys = statuses.map(({name: word, colour}) => element("span", {}, element("i", {style: `background:${css(colour)}`}), t(word)));
    $("scale").replaceChildren(element("b", {textContent: name}), element("div", {className: "keys"}, ...keys));
    return;
  }
  const steps = Array.from({length: 33}, (_, i) => css(colourAt(map, i / 32))).join(",");
  const places = (limits[0] === limits[1] ? [0] : [0, 0.25, 0.5, 0.75, 1]).map((x) => limits[0] + x * (limits[1] - limits[0]));
  const digits = [3, 4, 5, 6].find((n) => new Set(places.map((x) => number(x, n))).size === places.length) ?? 6; // neighbours differ
  const marks = places.map((x) => element("span", {textContent: number(x, digits)}));
  $("scale").replaceChildren(element("b", {textContent: name}), element("div", {className: "bar", style: `background:linear-gradient(90deg,${steps})`}),
    element("div", {className: "ticks"}, ...marks));
}

/** In the plane: pressure and gap over the length of each slave skin. */
async function alongSkins() {
  if (study.dimension !== 2 || !study.zones.length) return [];
  const contact = course.fields.find(({kind}) => kind === "patch");
  const all = contact && (await values(contact, now()));
  if (!all) return [];
  const column = (name) => all[contact.components.indexOf(name)];
  const curves = {pressure: [], gap: []};
  for (const surface of scene.surfaces) {
    if (surface.meta.kind !== "slave") continue;
    const steps = {pressure: [], gap: []};
    const {ends, facets} = surface;
    const order = followed(ends);
    let length = 0;
    for (const i of order) {
      const [a, b] = [3 * ends[2 * i], 3 * ends[2 * i + 1]];
      const step = Math.hypot(scene.initial[b] - scene.initial[a], scene.initial[b + 1] - scene.initial[a + 1]);
      for (const s of [length, length + step])
        for (const name of ["pressure", "gap"]) steps[name].push([s, column(name)[scene.facetPatch[facets[i]]]]);
      length += step;
    }
    const zone = study.zones[surface.meta.zone];
    for (const name of ["pressure", "gap"])
      curves[name].push({name: t("{slave} on {master}", zone), colour: colours[surface.meta.zone % colours.length], points: steps[name]});
  }
  return [["pressure", t("Contact pressure along the slave skins")], ["gap", t("Gap along the slave skins")]].map(([name, title]) =>
    chart({title: `${title}, ${caption()}`, x: t("length along the skin, from its end"), y: t(name), series: curves[name]}));
}

/** The segments of a skin one behind the other. */
function followed(ends) {
  const from = new Map(), into = new Set();
  for (let i = 0; i < ends.length / 2; ++i) {
    from.set(ends[2 * i], i);
    into.add(ends[2 * i + 1]);
  }
  const order = [], done = new Set();
  const walk = (node) => {
    for (let i = from.get(node); i !== undefined && !done.has(i); i = from.get(ends[2 * i + 1])) {
      done.add(i);
      order.push(i);
    }
  };
  for (const node of from.keys()) if (!into.has(node)) walk(node);
  for (const node of from.keys()) walk(node);
  return order;
}

// ---------------------------------------------------------------------------------------------------- picking

function pickAt(x, y) {
  const hit = scene.pick(x, y);
  picked = hit && {facet: hit.facet, node: scene.nodeAt(hit), zone: hit.surface.meta.zone, kind: hit.surface.meta.kind, name: hit.surface.meta.name};
  showPicked();
  scene.render();
}

/** Cells of the base are named from 1 on. */
async function showPicked() {
  if (!picked) {
    scene.mark([]);
    showFigures();
    return;
  }
  const {facet, node, zone, kind, name} = picked;
  const patch = scene.facetPatch[facet];
  const pairs = [[t("on"), name], [t("cell"), `M${scene.facetCell[facet]}`], [t("nearest node"), `N${scene.nodes[node]}`]];
  const own = {node, facet, patch}[shown.kind];
  if (shown.values && own >= 0) pairs.push([`${t(quantity().label)} (${field().name})`, number(shown.values[own], 6)]);
  if (shown.vector) pairs.push([t("displacement"), shown.vector.map((v) => number(v[node])).join(", ")]);
  if (kind !== "slave" || patch < 0) {
    scene.mark([{kind: "patch", wanted: {facets: new Set([facet])}}]);
    showFigures(t("Cell {name}", {name: `M${scene.facetCell[facet]}`}), pairs);
    return;
  }
  const contact = course.fields.find(({kind: of}) => of === "patch");
  const all = contact && (await values(contact, now()));
  if (all) {
    const value = (what) => all[contact.components.indexOf(what)][patch];
    const state = statuses.find((s) => s.value === value("status"));
    pairs.unshift([t("status"), state ? t(state.name) : "–"], [t("pressure"), number(value("pressure"), 6)], [t("gap"), number(value("gap"), 4)],
      [t("covered"), `${(100 * value("coverage")).toFixed(1)} %`], [t(study.dimension === 3 ? "area" : "length"), number(study.patch_areas[patch], 5)]);
  }
  const masters = await mastersOf(contact?.instants[now()], patch);
  const facets = new Set();
  scene.facetPatch.forEach((p, f) => {
    if (p === patch) facets.add(f);
  });
  scene.mark([{kind: "masters", wanted: {facets: scene.facetsOf((masters ?? []).map((m) => m.cell), zone), onSkins: true}}, {kind: "patch", wanted: {facets, onSkins: true}}]);
  showFigures(t("Patch {patch}, zone {zone}", {patch: patch + 1, zone: zone + 1}), pairs, masters);
  scene.render();
}

function startPicking() {
  let down = null;
  $("canvas").addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]), true);
  $("canvas").addEventListener("pointerup", (event) => {
    const box = $("canvas").getBoundingClientRect();
    if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 5) pickAt(event.clientX - box.left, event.clientY - box.top);
    down = null;
  }, true);
}

// ---------------------------------------------------------------------------------------------------- keys, buttons, time

let playing = null;
function play() {
  const stop = playing !== null;
  clearInterval(playing);
  playing = stop ? null : setInterval(() => step(1, true), 600);
  $("play").textContent = stop ? "▶" : "❚❚";
  $("play").ariaLabel = stop ? t("Play") : t("Pause");
}

function step(by, around = false) {
  const next = Number(course.control.value) + by, count = drawn().length;
  course.control.value = around ? next % count : Math.min(Math.max(next, 0), count - 1);
  return drawAll();
}

function openBook(opening) {
  control.opening.value = opening;
  scene.openBook(study.zones.length ? Number(control.zone.value) : -1, Number(control.opening.value));
  showPicked();
  scene.render();
}

const keys = {
  ArrowLeft: () => scene.turn(-5, 0), ArrowRight: () => scene.turn(5, 0), ArrowUp: () => scene.turn(0, 5), ArrowDown: () => scene.turn(0, -5),
  "+": () => scene.zoom(1.15), "=": () => scene.zoom(1.15), "-": () => scene.zoom(1 / 1.15), f: () => scene.fit(), x: () => scene.lookAlong("x"), y: () => scene.lookAlong("y"),
  z: () => scene.lookAlong("z"), 3: () => scene.lookAlong("3D"), "[": () => step(-1), "]": () => step(1), " ": play,
  o: () => study.zones.length && openBook(Number(control.opening.value) > 0 ? 0 : 1),
  Enter: () => pickAt($("canvas").clientWidth / 2, $("canvas").clientHeight / 2),
};

function startKeys() {
  for (const kind of ["keydown", "keypress", "keyup"])
    addEventListener(kind, (event) => {
      if (event.target.closest("input, select, textarea, button, a, summary")) return;
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      event.stopPropagation(); // vtk.js has keys of its own
      if (kind !== "keydown") return;
      const arrows = event.key.startsWith("Arrow") || event.key === " " || event.key === "Enter";
      if (arrows && document.activeElement !== $("view")) return; // they move the page
      const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (!act) return;
      event.preventDefault();
      act();
    }, true);
}

/** @param share 0: bodies are solid, 1: they are not there */
function seeThrough(share) {
  control.opacity.value = share;
  scene.see.opacity = 1 - share;
  scene.applyLook();
}

function startControls() {
  control.field.addEventListener("change", () => {
    fillComponents(control.component.value);
    if (field().kind === "patch" && study.dimension === 3 && control.opacity.value === "0") seeThrough(0.75); // skins lie between bodies
    draw();
  });
  control.component.addEventListener("change", () => {
    chooseMap();
    draw();
  });
  for (const id of ["map", "low", "high", "magnify"]) control[id].addEventListener("change", draw);
  control.range.addEventListener("change", () => {
    $("own-range").hidden = control.range.value !== "own";
    draw();
  });
  for (const one of [instants, iterates].filter(Boolean))
    one.control.addEventListener("input", () => {
      follow(one);
      drawAll();
    });
  control.opacity.addEventListener("input", () => {
    seeThrough(Number(control.opacity.value));
    scene.render();
  });
  control.edges.addEventListener("change", () => {
    scene.see.edges = control.edges.checked;
    scene.applyLook();
    scene.render();
  });
  control.zone.addEventListener("change", () => openBook(Number(control.opening.value)));
  control.opening.addEventListener("input", () => openBook(Number(control.opening.value)));
  $("play").addEventListener("click", play);
  const views = study.dimension === 2 ? [["fit", () => scene.fit()]] : [["x", () => scene.lookAlong("x")], ["y", () => scene.lookAlong("y")], ["z", () => scene.lookAlong("z")],
    ["3D", () => scene.lookAlong("3D")], ["fit", () => scene.fit()]];
  $("views").replaceChildren(...views.map(([name, act]) => {
    const button = element("button", {type: "button", textContent: t(name), title: name === "fit" ? t("Show all (F)") : t("Look from {where}", {where: name})});
    button.addEventListener("click", act);
    return button;
  }));
}

// ---------------------------------------------------------------------------------------------------- start

/** All that is chosen as at the beginning. */
async function restart() {
  picked = null;
  fillControls();
  [control.range.value, control.magnify.value, control.edges.checked] = ["instant", 1, scene.facetCell.length < manyFacets];
  Object.assign(scene.see, {edges: control.edges.checked, hidden: new Set()});
  seeThrough(field()?.kind === "patch" && study.dimension === 3 ? 0.75 : 0);
  scene.hold = true; // one picture, when all is in place
  openBook(0);
  await drawAll();
  scene.hold = false;
  scene.lookAlong("3D");
}

function failed(reason) {
  const told = element("p", {id: "failure", role: "alert", textContent: t("The picture cannot be drawn: {reason}. A browser with WebGL 2 is needed; tables and curves below are complete.", {reason})});
  document.querySelector("main").before(told);
  $("look").hidden = true;
}

async function start() {
  translatePage();
  document.title = `${study.label}: ${study.base}`;
  $("title").textContent = `${study.title}`;
  $("subtitle").textContent = study.subtitle;
  $("hint").textContent = study.dimension === 2 ? t("drag moves, wheel zooms, click picks") : t("drag turns, Shift-drag moves, wheel zooms, click picks");
  fillControls();
  startTheme();
  showFigures();
  showRun();
  try {
    scene = await Scene.create($("canvas"));
  } catch (error) {
    failed(error.message);
    showProofs(lastInstant());
    showZones(lastInstant());
    showCurves(lastInstant(), () => {}, []);
    return;
  }
  theme();
  startControls();
  startKeys();
  startPicking();
  scene.hold = true;
  scene.resize();
  await restart();
  document.body.dataset.ready = "yes";
  window.lacon = {scene, study, restart}; // for tests and the curious
}

start();
