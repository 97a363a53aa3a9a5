// What `lacon report` has put into the page: one text of JSON and arrays, each deflated by itself, unpacked when they are asked for.

export const study = JSON.parse(document.getElementById("study").textContent);

const types = {u1: Uint8Array, u2: Uint16Array, i4: Int32Array, u4: Uint32Array, f4: Float32Array};
const unpacked = new Map();

async function inflate(text) {
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = letters.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The first bytes of all numbers come first, then the second ones: so they deflate better. @return a buffer of whole numbers */
function unshuffle(bytes, size) {
  const n = bytes.length / size;
  if (size === 1) return bytes.buffer;
  const whole = size === 2 ? new Uint16Array(n) : new Uint32Array(n);
  if (size === 2) for (let i = 0; i < n; ++i) whole[i] = bytes[i] | (bytes[n + i] << 8);
  else for (let i = 0; i < n; ++i) whole[i] = bytes[i] | (bytes[n + i] << 8) | (bytes[2 * n + i] << 16) | (bytes[3 * n + i] << 24);
  return whole.buffer;
}

async function unpack({id, type}) {
  const bytes = await inflate(document.getElementById(`array-${id}`).textContent);
  return new types[type](unshuffle(bytes, types[type].BYTES_PER_ELEMENT));
}

/** The typed array of a reference {id, type}. @return a promise */
export function array(reference) {
  if (!unpacked.has(reference.id)) unpacked.set(reference.id, unpack(reference));
  return unpacked.get(reference.id);
}

const absent = 65535;

/** The components of a field at an instant: one Float32Array each, NaN where there is no value. */
export async function values(field, instant) {
  const stored = field.instants[instant];
  if (!stored) return null;
  const raw = await array(stored.values);
  const count = raw.length / field.components.length;
  return field.components.map((_, c) => {
    const part = raw.subarray(c * count, (c + 1) * count);
    if (field.exact) return part;
    const [low, high] = stored.ranges[c];
    const step = (high - low) / (absent - 1);
    const own = new Float32Array(count);
    for (let i = 0; i < count; ++i) own[i] = part[i] === absent ? NaN : low + part[i] * step;
    return own;
  });
}

/** The masters of a patch: [{cell, share}], the largest share first; null where the base does not know them. @returns a promise */
export async function mastersOf(stored, patch) {
  if (!stored?.masters) return null;
  const {offset, cells, shares} = stored.masters;
  const [from, cell, share] = await Promise.all([offset, cells, shares].map(array));
  const own = Array.from({length: from[patch + 1] - from[patch]}, (_, i) => from[patch] + i);
  return own.map((i) => ({cell: cell[i], share: share[i] / study.share})).sort((a, b) => b.share - a.share);
}

const tensor = ["SIXX", "SIYY", "SIZZ", "SIXY", "SIXZ", "SIYZ"];

/** What a field can be coloured by: its components, and what is made of them: [{name, label, of(components)}]. */
export function quantities(field) {
  const at = (name) => field.components.indexOf(name);
  const found = field.components.map((name, c) => ({name, label: field.labels?.[c] ?? name, unit: field.units?.[c] ?? "", of: (all) => all[c]}));
  const vector = ["DX", "DY", "DZ"].map(at).filter((c) => c >= 0);
  if (["DEPL", "RESI_NOEU"].includes(field.name) && vector.length > 1)
    found.unshift({name: "magnitude", label: "magnitude", of: (all) => combine(vector.map((c) => all[c]), (v) => Math.hypot(...v))});
  if (field.name === "RESI_NOEU") found.unshift({name: "decades", label: "log₁₀ of the magnitude", of: (all) => decades(combine(vector.map((c) => all[c]), (v) => Math.hypot(...v)))});
  const stress = tensor.map(at);
  if (field.name.startsWith("SIEF") && stress.slice(0, 4).every((c) => c >= 0))
    found.unshift({name: "mises", label: "von Mises", of: (all) => combine(stress.map((c) => (c < 0 ? null : all[c])), mises)});
  return found;
}

/** Residuals are of many sizes: their logarithms, as far as a millionth of the largest one; nothing where there is none. */
function decades(sizes) {
  const least = Math.log10(sizes.reduce((a, b) => Math.max(a, b), 0)) - 6;
  return sizes.map((v) => (v > 0 ? Math.max(Math.log10(v), least) : NaN));
}

function mises([xx, yy, zz, xy, xz, yz]) {
  return Math.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (xy * xy + xz * xz + yz * yz));
}

function combine(parts, make) {
  const made = new Float32Array(parts.find((part) => part).length);
  const row = new Array(parts.length);
  for (let i = 0; i < made.length; ++i) {
    for (let k = 0; k < parts.length; ++k) row[k] = parts[k] ? parts[k][i] : 0;
    made[i] = make(row);
  }
  return made;
}
