// Curves as SVG: scales, axes, legend, a reading under the pointer. They print as they are and take the page's colours.
import {t} from "./words.js";

const width = 560, height = 270, left = 68, right = 14, top = 12, bottom = 44;

const svg = (name, attributes = {}, ...children) => {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
};

export const number = (x, digits = 4) => {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (x === 0) return "0";
  const size = Math.abs(x);
  return size >= 1e5 || size < 1e-3 ? x.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e") : String(Number(x.toPrecision(digits)));
};

/** About n round numbers from low to high, no nearer than `least`. */
export function ticks(low, high, n = 5, least = 0) {
  const raw = Math.max((high - low) / n || 1, least), power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find((m) => m * power >= raw * 0.999);
  const found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) found.push(i * step);
  return found;
}

function decades(low, high) {
  const first = Math.floor(Math.log10(low)), last = Math.ceil(Math.log10(high));
  const step = Math.max(1, Math.ceil((last - first) / 7));
  const found = [];
  for (let e = first; e <= last; e += step) found.push(10 ** e);
  return found;
}

const narrow = 2e-3; // a range over its values: below it their four digits are all the same

function scaleOf(values, log, whole, least = 0) {
  const known = values.filter((v) => Number.isFinite(v) && (!log || v > 0));
  let low = Math.min(...known), high = Math.max(...known);
  if (!known.length) [low, high] = log ? [1e-8, 1] : [0, 1];
  if (log) {
    low = Math.max(low, 1e-16 * high);
    const marks = decades(low, high * 1.0001);
    [low, high] = [10 ** Math.floor(Math.log10(low)), 10 ** Math.ceil(Math.log10(high * 1.0001))];
    return {low, high, marks, place: (v) => (Math.log(v) - Math.log(low)) / (Math.log(high) - Math.log(low))};
  }
  if (!whole) {
    const size = Math.max(Math.abs(low), Math.abs(high));
    if (high - low < narrow * size) [low, high] = [low - 0.1 * size, high + 0.1 * size];
    if (low > 0 && low < 0.5 * high) low = 0;
    const room = (high - low || Math.abs(high) || 1) * 0.05;
    [low, high] = [low === 0 ? 0 : low - room, high + room];
  } else if (low === high) [low, high] = [low - 0.5, high + 0.5];
  return {low, high, marks: ticks(low, high, 5, least), place: (v) => (v - low) / (high - low)};
}

/**
 * A chart in a figure of its own.
 * @param title, x, y its words  @param series [{name, colour, points: [[x, y]], dash, dots, bars}]
 * @param log whether y is logarithmic  @param levels [{value, name, colour}]  @param dividers places of x with a line
 * @param at the place of x to mark  @param choose called with the nearest x when it is clicked
 */
export function chart({title, x, y, series, log = false, levels = [], dividers = [], at = null, choose = null, xTicks = null}) {
  const drawn = series.filter(({points}) => points.length);
  const places = drawn.flatMap(({points}) => points.map(([p]) => p));
  const bars = drawn.find((one) => one.bars)?.points.length;
  const room = bars ? (0.5 * (Math.max(...places) - Math.min(...places))) / Math.max(1, bars - 1) : 0; // a bar stands about its place
  const across = scaleOf([...places, Math.min(...places) - room, Math.max(...places) + room], false, true, places.every(Number.isInteger) ? 1 : 0);
  const up = scaleOf([...drawn.flatMap(({points}) => points.map(([, q]) => q)), ...levels.map(({value}) => value)], log, false);
  const px = (v) => left + across.place(v) * (width - left - right);
  const py = (v) => height - bottom - Math.min(Math.max(up.place(v), 0), 1) * (height - top - bottom);
  const picture = svg("svg", {viewBox: `0 0 ${width} ${height}`, role: "img", class: "chart"});
  const spoken = drawn.map(({name, points}) => t("{name}: {count} values, the last one {last}", {name, count: points.length, last: number(points.at(-1)[1])})).join("; ");
  picture.append(svg("title", {}, `${title}. ${spoken}`));
  for (const mark of up.marks) {
    const h = py(mark);
    picture.append(svg("line", {x1: left, x2: width - right, y1: h, y2: h, class: "grid"}),
      svg("text", {x: left - 7, y: h + 4, class: "tick", "text-anchor": "end"}, log ? mark.toExponential(0).replace("e+", "e") : number(mark)));
  }
  for (const mark of xTicks ?? across.marks) {
    if (mark < across.low || mark > across.high) continue;
    picture.append(svg("text", {x: px(mark), y: height - bottom + 17, class: "tick", "text-anchor": "middle"}, number(mark)));
  }
  for (const place of dividers) picture.append(svg("line", {x1: px(place), x2: px(place), y1: top, y2: height - bottom, class: "divider"}));
  for (const {value, colour} of levels)
    picture.append(svg("line", {x1: left, x2: width - right, y1: py(value), y2: py(value), class: "level", style: `stroke:${colour}`}));
  picture.append(svg("path", {d: `M${left} ${top}V${height - bottom}H${width - right}`, class: "axis"}),
    svg("text", {x: (left + width - right) / 2, y: height - 8, class: "label", "text-anchor": "middle"}, x),
    svg("text", {x: 13, y: (top + height - bottom) / 2, class: "label", "text-anchor": "middle", transform: `rotate(-90 13 ${(top + height - bottom) / 2})`}, y));
  for (const one of drawn) {
    if (one.bars) {
      const breadth = Math.max(1.5, Math.min(14, (0.7 * (width - left - right)) / one.points.length));
      for (const [p, q] of one.points)
        if (q > up.low) picture.append(svg("rect", {x: px(p) - breadth / 2, width: breadth, y: py(q), height: height - bottom - py(q), fill: one.colour}));
      continue;
    }
    const path = runs(one.points, log, one.breaks).map((run) => run.map(([p, q], i) => `${i ? "L" : "M"}${px(p).toFixed(1)} ${py(q).toFixed(1)}`).join("")).join("");
    picture.append(svg("path", {d: path, class: "curve", style: `stroke:${one.colour}`, "stroke-dasharray": one.dash ?? ""}));
    if (one.points.length <= 60)
      for (const [p, q] of one.points)
        if (Number.isFinite(q) && (!log || q > 0)) picture.append(svg("circle", {cx: px(p), cy: py(q), r: 2.6, fill: one.colour}));
  }
  if (at !== null && at >= across.low && at <= across.high)
    picture.append(svg("line", {x1: px(at), x2: px(at), y1: top, y2: height - bottom, class: "now"}));
  return framed({title, x, picture, drawn, levels, px, choose});
}

/** Parts of a curve between values that cannot be drawn, and at breaks. */
function runs(points, log, breaks = new Set()) {
  const found = [[]];
  for (const [p, q] of points) {
    if (breaks.has(p)) found.push([]);
    if (Number.isFinite(q) && (!log || q > 0)) found.at(-1).push([p, q]);
    else found.push([]);
  }
  return found.filter((run) => run.length);
}

function framed({title, x, picture, drawn, levels, px, choose}) {
  const figure = document.createElement("figure");
  figure.className = "chart-frame";
  const caption = document.createElement("figcaption");
  caption.textContent = title;
  const legend = document.createElement("div");
  legend.className = "legend";
  for (const {name, colour, dash} of [...drawn, ...levels.map((level) => ({...level, dash: "5 4"}))]) {
    const entry = document.createElement("span");
    const line = svg("svg", {width: 22, height: 8, "aria-hidden": "true"}, svg("line", {x1: 0, x2: 22, y1: 4, y2: 4, style: `stroke:${colour}`, "stroke-width": 2.5, "stroke-dasharray": dash ?? ""}));
    entry.append(line, ` ${name}`);
    legend.append(entry);
  }
  const reading = document.createElement("output");
  reading.className = "reading";
  const pointer = svg("line", {y1: top, y2: height - bottom, class: "pointer", visibility: "hidden"});
  picture.append(pointer);
  const xs = [...new Set(drawn.flatMap(({points}) => points.map(([p]) => p)))].sort((a, b) => a - b);
  const nearest = (event) => {
    const box = picture.getBoundingClientRect();
    const place = ((event.clientX - box.left) / box.width) * width;
    return xs.reduce((best, v) => (Math.abs(px(v) - place) < Math.abs(px(best) - place) ? v : best), xs[0]);
  };
  picture.addEventListener("pointermove", (event) => {
    if (!xs.length) return;
    const v = nearest(event);
    pointer.setAttribute("x1", px(v));
    pointer.setAttribute("x2", px(v));
    pointer.setAttribute("visibility", "visible");
    const parts = drawn.map(({name, points}) => [name, points.find(([p]) => p === v)?.[1]]).filter(([, q]) => q !== undefined);
    reading.textContent = `${x} ${number(v, 6)}:  ${parts.map(([name, q]) => `${name} ${number(q)}`).join(",  ")}`;
  });
  picture.addEventListener("pointerleave", () => {
    pointer.setAttribute("visibility", "hidden");
    reading.textContent = "";
  });
  if (choose && xs.length) {
    picture.classList.add("chooses");
    picture.addEventListener("click", (event) => choose(nearest(event)));
  }
  figure.append(caption, picture, legend, reading);
  return figure;
}
