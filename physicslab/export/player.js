"use strict";
(() => {
const $ = id => document.getElementById(id);
const run = JSON.parse($("run").textContent);
const COUNT = run.instants, HEAD = 1 + run.energies.length;
const DASHES = [[], [7, 4], [2, 3], [9, 3, 2, 3], [4, 2]];
const SPEEDS = [0.25, 0.5, 1, 2, 4];
const PARTS = [0, 1, 2, 3, 4, 5];  // x, y, angle and their rates

// ---- what was recorded: columns of float32, packed as packing.py has it ----------------------------------
function unpack(text, length) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0)), bits = new Int32Array(length);
  let at = 0;
  for (let start = 0; start < length; start += COUNT) {
    const order = bytes[at++], values = bits.subarray(start, start + COUNT);
    for (let i = 0; i < COUNT; i++) {
      let number = 0, shift = 0, byte;
      do { byte = bytes[at++]; number |= (byte & 127) << shift; shift += 7; } while (byte > 127);
      values[i] = (number >>> 1) ^ -(number & 1);
    }
    for (let k = 0; k < order; k++) for (let i = 1; i < COUNT; i++) values[i] += values[i - 1];
    for (let i = 0; i < COUNT; i++) values[i] ^= (values[i] >> 31) & 0x7fffffff;
  }
  return new Float32Array(bits.buffer);
}
const movers = run.bodies.filter(body => "moves" in body);
const data = unpack(run.data, COUNT * (HEAD + 6 * movers.length));
const column = index => data.subarray(index * COUNT, (index + 1) * COUNT);
const times = column(0), end = times[COUNT - 1];
for (const body of run.bodies) {
  body.columns = "moves" in body ? PARTS.map(k => column(HEAD + 6 * body.moves + k)) : null;
  body.at = frame => body.columns ? body.columns.map(values => values[frame]) : [...body.pose, 0, 0, 0];
  body.reach = body.radius ?? (body.size ? Math.hypot(...body.size) / 2 : 0);
}
const lines = run.energies.map((name, i) => ({ name, values: column(1 + i), dash: DASHES[i % DASHES.length] }))
  .filter(line => line.name === "total" || line.name === "kinetic" || line.values.some(value => value !== 0));
lines[lines.length - 1].dash = [];

// ---- the state of the player ------------------------------------------------------------------------------
const dark = matchMedia("(prefers-color-scheme: dark)");
for (const body of run.bodies) body.named = !/^entity \d+$/.test(body.name);
const named = movers.filter(body => body.named).length;
const show = { trails: movers.length <= 12 || movers.some(body => body.trail), arrows: false,
               names: named > 0 && named <= 12, grid: true, loop: true };
let time = 0, playing = false, speed = 1, selected = null, stale = true, last = 0, colours = {};
const camera = { x: 0, y: 0, scale: 1 };
const natural = end > 60 || end < 1 ? Math.pow(10, Math.floor(Math.log10(end / 6))) : 1;  // scene s per s at 1 x

function frameAt(t) {
  let low = 0, high = COUNT - 1;
  while (low < high) { const middle = (low + high + 1) >> 1; if (times[middle] <= t) low = middle; else high = middle - 1; }
  return low;
}
function pose(body, frame, share) {
  const now = body.at(frame);
  if (share > 0 && body.columns) for (const k of PARTS) now[k] += share * (body.columns[k][frame + 1] - now[k]);
  return now;
}
function moment() {
  const frame = frameAt(time);
  return [frame, frame < COUNT - 1 ? (time - times[frame]) / (times[frame + 1] - times[frame]) : 0];
}
function seek(t) { time = Math.min(Math.max(t, 0), end); stale = true; }
function step(count) { play(false); seek(times[Math.min(Math.max(frameAt(time + 1e-9 * end) + count, 0), COUNT - 1)]); }
function play(on) {
  if (on && time >= end) time = 0;
  if (!on) time = times[frameAt(time)];  // figures are those of an instant that was computed
  playing = on && end > 0;
  const icon = playing ? "M3 2h4v14H3zM11 2h4v14h-4z" : "M4 2l12 7-12 7z";
  $("play").innerHTML = `<svg width="18" height="18" aria-hidden="true"><path d="${icon}"/></svg>`;
  $("play").setAttribute("aria-label", playing ? "Pause" : "Play");
  stale = true;
}
const short = (value, digits) => number(value, digits).replace(/(\.\d*?)0+(?=\u00b7|$)/, "$1").replace(/\.(?=\u00b7|$)/, "");
function number(value, digits) {
  if (value === 0) return "0";
  const power = Math.floor(Math.log10(Math.abs(value)));
  const text = power < -3 || power > 6 ? value.toExponential(digits - 1)
    : value.toFixed(Math.max(digits - 1 - power, 0));
  return text.replace(/^-/, "\u2212").replace(/e([+-])(\d+)/, (_, sign, digits) => `\u00b710^${sign === "-" ? "\u2212" : ""}${digits}`);
}

// ---- the picture ------------------------------------------------------------------------------------------
const world = $("world"), pen = world.getContext("2d"), chart = $("chart"), ink = chart.getContext("2d");
function readColours() {
  const style = getComputedStyle(document.documentElement), names = ["background", "panel", "line", "text", "faint", "accent",
    "grid", "axis", "static", "static-fill", "spring", "bounds", "arrow", "fill", ...PARTS.map(k => `b${k}`), "b6"];
  colours = Object.fromEntries(names.map(name => [name, style.getPropertyValue(`--${name}`).trim()]));
  const tile = document.createElement("canvas"), line = tile.getContext("2d");
  tile.width = tile.height = 10;
  line.fillStyle = colours["static-fill"]; line.fillRect(0, 0, 10, 10);
  line.strokeStyle = colours.static; line.lineWidth = 1; line.globalAlpha = 0.6;
  for (const shift of [-10, 0, 10]) { line.beginPath(); line.moveTo(shift - 1, 11); line.lineTo(shift + 11, -1); line.stroke(); }
  colours.hatch = pen.createPattern(tile, "repeat");
  run.bodies.forEach((body, i) => { body.colour = body.columns ? ("mass" in body ? colours[`b${i % 7}`] : colours.text) : colours.static; });
  stale = true;
}
function sized(canvas, context) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio);
  }
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return [width, height];
}
const toX = x => world.clientWidth / 2 + (x - camera.x) * camera.scale;
const toY = y => world.clientHeight / 2 - (y - camera.y) * camera.scale;
function fit() {
  const [x0, y0, x1, y1] = run.view;
  camera.x = (x0 + x1) / 2; camera.y = (y0 + y1) / 2;
  camera.scale = Math.min(world.clientWidth / (x1 - x0), world.clientHeight / (y1 - y0)) || 1;
  camera.fitted = true; stale = true;
}
function zoom(factor, px, py) {
  const x = camera.x + (px - world.clientWidth / 2) / camera.scale, y = camera.y - (py - world.clientHeight / 2) / camera.scale;
  camera.scale = Math.min(Math.max(camera.scale * factor, 1e-12), 1e9);
  camera.x = x - (px - world.clientWidth / 2) / camera.scale; camera.y = y + (py - world.clientHeight / 2) / camera.scale;
  camera.fitted = false; stale = true;
}
function nice(value) {
  const power = Math.pow(10, Math.floor(Math.log10(value))), digit = value / power;
  return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}
function drawGrid(width, height) {
  const metres = nice(160 / camera.scale), pixels = metres * camera.scale;
  pen.font = "12px system-ui, sans-serif"; pen.lineWidth = 1;
  for (const across of [true, false]) {
    const size = across ? width : height, zero = across ? toX(0) : toY(0), towards = across ? 1 : -1;
    const first = Math.ceil(across ? -zero / pixels : (zero - size) / pixels);
    for (let k = first, at; at = zero + towards * k * pixels, across ? at <= size : at >= 0; k++) {
      const place = Math.round(at) + 0.5, label = short(k * metres, 7);
      pen.strokeStyle = k ? colours.grid : colours.axis;
      pen.beginPath(); across ? (pen.moveTo(place, 0), pen.lineTo(place, height)) : (pen.moveTo(0, place), pen.lineTo(width, place)); pen.stroke();
      if (across && at > 40 && at < width - 24) marks.push([label, place, height - 7, "center"]);
      if (!across && at > 18 && at < height - 22) marks.push([label, 7, place - 5, "left"]);
    }
  }
  $("scale").textContent = "axes in metres";
}
let marks = [];
function written(text, x, y, align, colour) {
  pen.textAlign = align; pen.lineWidth = 3; pen.strokeStyle = colours.background; pen.lineJoin = "round";
  pen.strokeText(text, x, y); pen.fillStyle = colour; pen.fillText(text, x, y);
}
function outline(body, [x, y, angle], grow = 0) {
  pen.beginPath();
  if (body.kind === "box") {
    const [w, h] = body.size.map(size => Math.max(size * camera.scale, 1.5) / 2 + grow), c = Math.cos(angle), s = Math.sin(angle);
    for (const [u, v] of [[-w, -h], [w, -h], [w, h], [-w, h]]) pen.lineTo(toX(x) + c * u + s * v, toY(y) - s * u + c * v);
    pen.closePath();
  } else pen.arc(toX(x), toY(y), (body.kind === "circle" ? Math.max(body.radius * camera.scale, 1) : 5) + grow, 0, 2 * Math.PI);
}
function drawBody(body, at) {
  if (body.kind === "none" || !Number.isFinite(toX(at[0]) + toY(at[1]))) return;
  const reach = body.reach * camera.scale + 9;
  if (toX(at[0]) < -reach || toX(at[0]) > world.clientWidth + reach || toY(at[1]) < -reach || toY(at[1]) > world.clientHeight + reach) return;
  outline(body, at);
  pen.lineWidth = 1.8; pen.setLineDash([]); pen.strokeStyle = body.colour;
  if (!body.columns && body.kind !== "point") { pen.fillStyle = colours.hatch; pen.fill(); pen.stroke(); return; }
  pen.fillStyle = colours.background; pen.fill();
  pen.globalAlpha = body.kind === "point" ? 1 : Number(colours.fill);
  pen.fillStyle = body.colour; pen.fill(); pen.globalAlpha = 1; pen.stroke();
  const mark = (body.radius ?? (body.size ? body.size[0] / 2 : 0)) * camera.scale;
  if (mark < 4 || !body.columns) return;
  pen.beginPath(); pen.moveTo(toX(at[0]), toY(at[1])); pen.lineTo(toX(at[0]) + mark * Math.cos(at[2]), toY(at[1]) - mark * Math.sin(at[2])); pen.stroke();
}
function ends(spring, now) {
  const place = (body, [u, v]) => {
    if (body === null) return [u, v];
    const [x, y, angle] = now(run.bodies[body]), c = Math.cos(angle), s = Math.sin(angle);
    return [x + c * u - s * v, y + s * u + c * v];
  };
  return [place(spring.a, spring.anchor_a), place(spring.b, spring.anchor_b)];
}
for (const spring of run.springs) {  // one that keeps its length is a string, drawn straight
  const lengths = Array.from({ length: Math.min(COUNT, 100) }, (_, i) => Math.floor(i * COUNT / Math.min(COUNT, 100)))
    .map(frame => { const [a, b] = ends(spring, body => body.at(frame)); return Math.hypot(b[0] - a[0], b[1] - a[1]); });
  spring.longest = Math.max(...lengths);
  spring.straight = spring.longest - Math.min(...lengths) < 0.03 * spring.longest;
}
function drawSpring(spring, now) {
  const [a, b] = ends(spring, now).map(([x, y]) => [toX(x), toY(y)]), dx = b[0] - a[0], dy = b[1] - a[1], length = Math.hypot(dx, dy);
  const turns = Math.round(Math.min(Math.max(spring.longest * camera.scale / 18, 4), 14));
  pen.strokeStyle = colours.spring; pen.lineWidth = 1.6; pen.lineJoin = "round"; pen.beginPath(); pen.moveTo(...a);
  if (!spring.straight && length > 14) for (let k = 0; k < 2 * turns; k++) {
    const share = 0.1 + 0.8 * (k + 0.5) / (2 * turns), side = (k % 2 ? 6 : -6) / length;
    if (!k) pen.lineTo(a[0] + 0.1 * dx, a[1] + 0.1 * dy);
    pen.lineTo(a[0] + share * dx - side * dy, a[1] + share * dy + side * dx);
    if (k === 2 * turns - 1) pen.lineTo(a[0] + 0.9 * dx, a[1] + 0.9 * dy);
  }
  pen.lineTo(...b); pen.stroke();
  if (spring.b === null) { pen.beginPath(); pen.arc(...b, 4, 0, 2 * Math.PI); pen.fillStyle = colours.spring; pen.fill(); }
}
function drawTrail(body, frame, at) {
  const first = frameAt(time - (body.trail ?? Math.min(2 * natural, end / 3))), [xs, ys] = body.columns;
  pen.strokeStyle = body.colour; pen.lineWidth = 2; pen.lineJoin = "round";
  for (let part = 0; part < 8; part++) {  // fainter the longer ago
    const from = first + Math.floor((frame - first) * part / 8), to = first + Math.floor((frame - first) * (part + 1) / 8);
    pen.globalAlpha = (part + 1) / 10; pen.beginPath();
    for (let k = from; k <= to; k++) pen.lineTo(toX(xs[k]), toY(ys[k]));
    if (part === 7) pen.lineTo(toX(at[0]), toY(at[1]));
    pen.stroke();
  }
  pen.globalAlpha = 1;
}
const speeds = movers.flatMap(body => Array.from({ length: 20 }, (_, i) => body.at(Math.floor(i * COUNT / 20))))
  .map(at => Math.hypot(at[3], at[4])).sort((a, b) => a - b);
const usual = speeds[Math.floor(0.95 * speeds.length)] || 1;
const seconds = nice(0.12 * Math.max(run.view[2] - run.view[0], run.view[3] - run.view[1]) / usual);
function drawArrow([x, y, , vx, vy]) {
  const x0 = toX(x), y0 = toY(y), dx = vx * seconds * camera.scale, dy = -vy * seconds * camera.scale, length = Math.hypot(dx, dy);
  if (!(length > 5)) return;
  const u = dx / length, v = dy / length, head = Math.min(9, 0.6 * length), tip = [x0 + dx, y0 + dy];
  pen.strokeStyle = pen.fillStyle = colours.arrow; pen.lineWidth = 2.4;
  pen.beginPath(); pen.moveTo(x0, y0); pen.lineTo(tip[0] - u * head, tip[1] - v * head); pen.stroke();
  pen.beginPath(); pen.moveTo(...tip); pen.lineTo(tip[0] - u * head - v * head / 2, tip[1] - v * head + u * head / 2);
  pen.lineTo(tip[0] - u * head + v * head / 2, tip[1] - v * head - u * head / 2); pen.fill();
}
function drawWorld(frame, share) {
  const [width, height] = sized(world, pen), poses = new Map();
  const now = body => poses.get(body) ?? (poses.set(body, pose(body, frame, share)), poses.get(body));
  pen.fillStyle = colours.background; pen.fillRect(0, 0, width, height); marks = [];
  if (show.grid) drawGrid(width, height); else $("scale").textContent = "";
  if (run.bounds) {
    const [x0, y0, x1, y1] = run.bounds;
    pen.strokeStyle = colours.bounds; pen.lineWidth = 2; pen.setLineDash([]);
    pen.strokeRect(toX(x0), toY(y1), (x1 - x0) * camera.scale, (y1 - y0) * camera.scale);
  }
  colours.hatch.setTransform(new DOMMatrix().translate(toX(0) % 10, toY(0) % 10));
  for (const body of run.bodies) if (!body.columns) drawBody(body, now(body));
  if (show.trails) for (const body of movers) if (movers.length <= 200 || body === selected) drawTrail(body, frame, now(body));
  for (const spring of run.springs) drawSpring(spring, now);
  for (const body of movers) drawBody(body, now(body));
  if (show.arrows) { movers.forEach(body => drawArrow(now(body))); $("scale").textContent += `${show.grid ? "; " : ""}arrows: path in ${short(seconds, 1)} s`; }
  if (selected) { outline(selected, now(selected), 4); pen.strokeStyle = colours.text; pen.lineWidth = 2; pen.setLineDash([5, 3]); pen.stroke(); pen.setLineDash([]); }
  pen.font = "12px system-ui, sans-serif";
  for (const mark of marks) written(...mark, colours.faint);
  pen.font = "13px system-ui, sans-serif";
  const taken = [];
  for (const body of [...(selected ? [selected] : []), ...(show.names ? movers : [])]) {
    if (body.kind === "none" || taken.some(other => other.body === body) || body !== selected && named && !body.named) continue;
    const at = now(body), half = pen.measureText(body.name).width / 2 + 4, x = toX(at[0]);
    let y = Math.max(toY(at[1]) - (body.columns ? (body.radius ?? (body.size ? Math.max(...body.size) / 2 : 0)) * camera.scale + 9 : 0), 16);
    for (let i = 0; i < 3 && taken.some(other => Math.abs(other.x - x) < other.half + half && Math.abs(other.y - y) < 15); i++) y -= 16;
    taken.push({ body, x, y, half });
    written(body.name, x, y, "center", colours.text);
  }
}

// ---- energy and values ------------------------------------------------------------------------------------
const extremes = lines.flatMap(line => [line.values.reduce((a, b) => Math.min(a, b)), line.values.reduce((a, b) => Math.max(a, b))]);
const lowest = Math.min(0, ...extremes), highest = Math.max(...extremes, lowest + 1e-30);
const look = (line, i) => line.name === "total" ? [colours.text, 2.6] : [[colours.accent, colours.b1, colours.b2, colours.b5][i % 4], 2];
const LEFT = 46;
function drawChart() {
  const [width, height] = sized(chart, ink), tick = nice((highest - lowest) / 2.2), low = height - 18, room = width - LEFT - 6;
  const x = t => LEFT + room * t / (end || 1), y = value => low - (low - 8) * (value - lowest) / (highest - lowest);
  ink.clearRect(0, 0, width, height); ink.font = "12px system-ui, sans-serif"; ink.fillStyle = colours.faint; ink.lineWidth = 1;
  for (let k = Math.ceil(lowest / tick); k * tick <= highest * (1 + 1e-9); k++) {
    ink.strokeStyle = k ? colours.line : colours.axis; ink.setLineDash([]); ink.beginPath(); ink.moveTo(LEFT, y(k * tick)); ink.lineTo(width - 6, y(k * tick)); ink.stroke();
    ink.textAlign = "right"; ink.fillText(short(k * tick, 2), LEFT - 6, y(k * tick) + 4);
  }
  ink.textAlign = "left"; ink.fillText("J", 2, 12); ink.fillText(short(run.start, 4), LEFT, height - 3);
  ink.textAlign = "right"; ink.fillText(`${short(run.start + end, 4)} s`, width - 6, height - 3);
  const stride = Math.max(1, Math.floor(COUNT / (2 * room)));
  [...lines].reverse().forEach(line => {  // the total below the rest
    const i = lines.indexOf(line);
    [ink.strokeStyle, ink.lineWidth] = look(line, i); ink.setLineDash(line.dash); ink.beginPath();
    for (let k = 0; k < COUNT; k += stride) ink.lineTo(x(times[k]), y(line.values[k]));
    ink.lineTo(x(end), y(line.values[COUNT - 1])); ink.stroke();
  });
  ink.setLineDash([]); ink.strokeStyle = colours.text; ink.lineWidth = 1; ink.beginPath(); ink.moveTo(x(time), 2); ink.lineTo(x(time), low); ink.stroke();
}
function fill(table, rows) {
  while (table.rows.length < rows.length) { const row = table.insertRow(); row.insertCell(); row.insertCell(); }
  while (table.rows.length > rows.length) table.deleteRow(-1);
  rows.forEach(([label, value], i) => {
    const [first, second] = table.rows[i].cells;
    if (first.dataset.label !== label) { first.innerHTML = label; first.dataset.label = label; }
    if (second.textContent !== value) second.textContent = value;
  });
}
function showFigures(frame) {
  const digits = playing ? 4 : 7;
  fill($("legend"), lines.map((line, i) => {
    const [colour, width] = look(line, i);
    return [`<svg aria-hidden="true"><path d="M0 4h30" stroke="${colour}" stroke-width="${width}" stroke-dasharray="${line.dash}"/></svg>${line.name}`, `${number(line.values[frame], digits)} J`];
  }));
  if (!selected) { fill($("values"), []); return; }
  const [x, y, angle, vx, vy, spin] = selected.at(frame), rows = [["position x", `${number(x, digits)} m`], ["position y", `${number(y, digits)} m`],
    ["angle", `${number(angle, digits)} rad`]];
  if (selected.columns) rows.push(["velocity x", `${number(vx, digits)} m/s`], ["velocity y", `${number(vy, digits)} m/s`],
    ["speed", `${number(Math.hypot(vx, vy), digits)} m/s`], ["angular velocity", `${number(spin, digits)} rad/s`]);
  if ("mass" in selected && selected.columns) {
    const { mass, inertia } = selected;
    rows.push(["mass", `${short(mass, 7)} kg`], ["kinetic energy", `${number((mass * (vx * vx + vy * vy) + inertia * spin * spin) / 2, digits)} J`]);
    if (run.gravity) rows.push(["potential, 0 at the origin", `${number(-mass * (run.gravity[0] * x + run.gravity[1] * y), digits)} J`]);
  }
  fill($("values"), rows);
}
function select(body) { selected = body; $("body").value = body ? run.bodies.indexOf(body) : ""; stale = true; }

// ---- the hands of a user ----------------------------------------------------------------------------------
const touching = new Map();
let moved = 0;
world.addEventListener("pointerdown", event => { world.setPointerCapture(event.pointerId); touching.set(event.pointerId, [event.offsetX, event.offsetY]); if (touching.size === 1) moved = 0; });
world.addEventListener("pointermove", event => {
  const before = touching.get(event.pointerId), at = [event.offsetX, event.offsetY];
  if (!before) return;
  moved += Math.hypot(at[0] - before[0], at[1] - before[1]);
  const other = [...touching].find(([id]) => id !== event.pointerId)?.[1];
  if (other) zoom(Math.hypot(at[0] - other[0], at[1] - other[1]) / Math.max(Math.hypot(before[0] - other[0], before[1] - other[1]), 1), ...other);
  else if (moved > 6) { camera.x -= (at[0] - before[0]) / camera.scale; camera.y += (at[1] - before[1]) / camera.scale; camera.fitted = false; stale = true; }
  touching.set(event.pointerId, at);
});
world.addEventListener("pointerup", event => {
  if (touching.size === 1 && moved <= 6) pick(event.offsetX, event.offsetY);
  touching.delete(event.pointerId);
});
world.addEventListener("pointercancel", event => touching.delete(event.pointerId));
world.addEventListener("wheel", event => { event.preventDefault(); zoom(Math.exp(-0.0015 * event.deltaY * (event.deltaMode ? 30 : 1)), event.offsetX, event.offsetY); }, { passive: false });
function pick(px, py) {
  const [frame, share] = moment();
  let best = null, nearest = 14;
  for (const body of run.bodies) {
    if (body.kind === "none") continue;
    const at = pose(body, frame, share), dx = px - toX(at[0]), dy = py - toY(at[1]), c = Math.cos(at[2]), s = Math.sin(at[2]);
    const size = (body.size ?? [0, 0]).map(extent => extent * camera.scale / 2);
    const off = body.kind === "box" ? Math.hypot(Math.max(Math.abs(c * dx - s * dy) - size[0], 0), Math.max(Math.abs(s * dx + c * dy) - size[1], 0))
      : Math.max(Math.hypot(dx, dy) - (body.radius ?? 0) * camera.scale, 0);
    if (off < nearest || best && off <= nearest && body.columns) { best = body; nearest = off; }
  }
  select(best);
}
function toggle(name) { show[name] = !show[name]; $(name).setAttribute("aria-pressed", show[name]); stale = true; }
function setSpeed(value) { speed = value; $("speed").value = value; }
const keys = {
  " ": () => play(!playing), k: () => play(!playing), arrowleft: event => step(event.shiftKey ? -10 : -1), arrowright: event => step(event.shiftKey ? 10 : 1),
  home: () => seek(0), end: () => { play(false); seek(end); }, l: () => toggle("loop"), t: () => toggle("trails"), v: () => toggle("arrows"),
  n: () => toggle("names"), g: () => toggle("grid"), 0: fit, "+": () => zoom(1.25, world.clientWidth / 2, world.clientHeight / 2),
  "-": () => zoom(0.8, world.clientWidth / 2, world.clientHeight / 2),
  b: event => { const all = run.bodies.filter(body => body.kind !== "none"); select(all[(all.indexOf(selected) + (event.shiftKey ? all.length - 1 : 1)) % all.length] ?? null); },
};
SPEEDS.forEach((value, i) => { keys[i + 1] = () => setSpeed(value); });
document.addEventListener("keydown", event => {
  const on = event.target.tagName, key = event.key.toLowerCase();
  if (event.ctrlKey || event.metaKey || event.altKey || on === "SELECT" || on === "INPUT" && /^(arrow|home|end)/.test(key)) return;
  if (!keys[key] || key === " " && (on === "BUTTON" || on === "SUMMARY")) return;
  event.preventDefault(); keys[key](event);
});
$("play").onclick = () => play(!playing);
$("back").onclick = () => step(-1);
$("forward").onclick = () => step(1);
$("fit").onclick = fit;
for (const name of ["loop", "trails", "arrows", "names", "grid"]) { $(name).onclick = () => toggle(name); $(name).setAttribute("aria-pressed", show[name]); }
const decimals = Math.min(Math.max(2 - Math.floor(Math.log10(end / COUNT * 10 || 1)), 0), 9);
$("time").max = COUNT - 1;
$("time").oninput = event => { play(false); seek(times[event.target.valueAsNumber]); };
$("speed").append(...SPEEDS.map(value => new Option(`${short(value * natural, 3)}\u00d7`, value)));
$("speed").onchange = event => setSpeed(Number(event.target.value));
setSpeed(1);
$("body").append(new Option("none (click a body)", ""), ...run.bodies.map((body, i) => new Option(body.name, i)).filter((_, i) => run.bodies[i].kind !== "none"));
$("body").onchange = event => select(run.bodies[event.target.value] ?? null);
const scrub = event => { if (event.buttons) { play(false); seek(times[frameAt((event.offsetX - LEFT) / (chart.clientWidth - LEFT - 6) * end)]); } };
chart.onpointerdown = scrub; chart.onpointermove = scrub;
$("notes").append(...[...run.notes, `${COUNT} instants, positions to 7 digits (float32). While it plays, bodies move straight from one to the next; paused, the figures are those computed.`]
  .map(note => Object.assign(document.createElement("li"), { textContent: note })));
new ResizeObserver(() => { if (camera.fitted !== false) fit(); stale = true; }).observe(world);
dark.addEventListener("change", () => { readColours(); document.querySelectorAll("#legend td").forEach(cell => { delete cell.dataset.label; }); });

function tick(now) {
  const passed = Math.min((now - last) / 1000, 0.1);
  last = now;
  if (playing) {
    seek(time + passed * speed * natural);
    if (time >= end && !(show.loop && (time = 0, true))) play(false);
  }
  if (stale) {
    stale = false;
    const [frame, share] = moment();
    drawWorld(frame, share); drawChart(); showFigures(frame);
    $("time").value = frame;
    $("clock").textContent = `${(run.start + time).toFixed(decimals)} / ${short(run.start + end, 4)} s`;
    $("time").setAttribute("aria-valuetext", $("clock").textContent);
  }
  requestAnimationFrame(tick);
}
window.player = { run, seek, play, get time() { return time; }, get playing() { return playing; },
                  at: (name, frame) => run.bodies.find(body => body.name === name).at(frame), times, lines };
$("stage").style.setProperty("--aspect", Math.min(Math.max((run.view[2] - run.view[0]) / (run.view[3] - run.view[1]), 0.9), 2));
readColours(); fit();
select(movers.length === 1 ? movers[0] : null);
play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
requestAnimationFrame(now => { last = now; tick(now); });
})();
