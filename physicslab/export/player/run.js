// What was recorded, and the state of the player.

const $ = id => document.getElementById(id);
const given = JSON.parse($("run").textContent);  // in a lesson several books of runs, else one
for (const one of given.books ?? []) one.runs = one.runs.map(number => given.runs[number]);
let book = given.books?.[0] ?? given;
const say = text => given.words[text] ?? text;
let run, COUNT, HEAD, movers, times, end, drawn, named, lines, quantities;
const loaders = [];  // what is to be done for every run that is shown, in order
const PARTS = [0, 1, 2, 3, 4, 5];  // x, y, angle and their rates
const DASHES = [[], [7, 4], [2, 3], [9, 3, 2, 3], [4, 2]];
const SPEEDS = [0.25, 0.5, 1, 2, 4];

// The bytes of a text in base 85, five letters for four of them.
const DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%&()*+-;,=>?@^_`{|}~";
const DIGIT = Uint8Array.from({ length: 128 }, (_, code) => Math.max(DIGITS.indexOf(String.fromCharCode(code)), 0));
function bytesOf(text) {
  const bytes = new Uint8Array(Math.ceil(text.length / 5) * 4);
  for (let i = 0, at = 0; i < text.length; i += 5) {
    let number = 0;
    for (let k = i; k < i + 5; k++) number = number * 85 + (k < text.length ? DIGIT[text.charCodeAt(k)] : 84);
    for (let shift = 24; shift >= 0; shift -= 8) bytes[at++] = number >>> shift;
  }
  return bytes;
}
// Columns of float32, as packing.py packs them.
function unpack(text, length) {
  const bytes = bytesOf(text), bits = new Int32Array(length);
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

// Show another run of the page; its numbers are unpacked when it is first shown.
function load(next) {
  run = next;
  COUNT = run.instants;
  HEAD = 1 + run.energies.length + run.quantities.length;
  movers = run.bodies.filter(body => "moves" in body);
  run.numbers ??= unpack(run.data, COUNT * (HEAD + 6 * movers.length));
  const column = index => run.numbers.subarray(index * COUNT, (index + 1) * COUNT);
  times = column(0);
  end = times[COUNT - 1];
  for (const body of run.bodies) {
    body.columns = "moves" in body ? PARTS.map(k => column(HEAD + 6 * body.moves + k)) : null;
    body.at = frame => body.columns ? body.columns.map(values => values[frame]) : [...body.pose, 0, 0, 0];
    body.core ??= [[0, 0]];
    body.radius ??= 0;
    body.reach = Math.max(...body.core.map(corner => Math.hypot(...corner))) + body.radius;
    body.half = Math.max(...body.core.flat().map(Math.abs)) + body.radius;
    body.named = !/^entity \d+$/.test(body.name);
  }
  drawn = run.bodies.filter(body => body.kind !== "none");
  named = movers.filter(body => body.named).length;
  lines = run.energies
    .map((name, i) => ({ name, values: column(1 + i), dash: name === "total" ? [] : DASHES[i % 5] }))
    .filter(({ name, values }) => name === "total" || name === "kinetic" || values.some(value => value !== 0));
  quantities = run.quantities.map((one, i) => ({ ...one, values: column(1 + run.energies.length + i) }));
  for (const each of loaders) each();
  stale = true;
}

const show = { trails: false, arrows: false, names: false, grid: true, loop: true };
const camera = { x: 0, y: 0, scale: 1, fitted: true };
// natural: how many seconds of the scene pass in a second at ordinary speed.
loaders.push(() => {
  natural = end > 60 || end < 1 ? Math.pow(10, Math.floor(Math.log10(end / 6))) : 1;
  time = Math.min(time, end);
});
let natural = 1, time = 0, playing = false, speed = 1, selected = null, stale = true;

function frameAt(t) {
  let low = 0, high = COUNT - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle; else high = middle - 1;
  }
  return low;
}

// The instant at or before the present time, and how far the next one is, from 0 to 1.
function moment() {
  const frame = frameAt(time);
  return [frame, frame < COUNT - 1 ? (time - times[frame]) / (times[frame + 1] - times[frame]) : 0];
}

function pose(body, frame, share) {
  const now = body.at(frame);
  if (share > 0 && body.columns) {
    for (const k of PARTS) now[k] += share * (body.columns[k][frame + 1] - now[k]);
  }
  return now;
}

const ended = [];  // what is to be done when a run is at its end
function seek(t) {
  time = Math.min(Math.max(t, 0), end);
  stale = true;
  if (time >= end) for (const each of ended) each();
}

function step(count) {
  play(false);
  seek(times[Math.min(Math.max(frameAt(time) + count, 0), COUNT - 1)]);
}

function play(on) {
  if (on && time >= end) time = 0;
  if (!on) time = times[frameAt(time)];  // the figures shown are those of an instant that was computed
  playing = on && end > 0;
  const icon = playing ? "M3 2h4v14H3zM11 2h4v14h-4z" : "M4 2l12 7-12 7z";
  $("play").innerHTML = `<svg width="18" height="18" aria-hidden="true"><path d="${icon}"/></svg>`;
  $("play").setAttribute("aria-label", playing ? say("Pause") : say("Play"));
  stale = true;
}

// A number to so many digits, and without the zeros at its end, with the decimal mark of the page.
const marked = text => text.replace(".", given.mark);
const number = (value, digits) => marked(plain(value, digits));
function plain(value, digits) {
  if (value === 0) return "0";
  const power = Math.floor(Math.log10(Math.abs(value)));
  const text = power >= -3 && power <= 6 ? value.toFixed(Math.max(digits - 1 - power, 0)) : value.toExponential(digits - 1);
  return text.replace(/e\+?(-?)(\d+)$/, "\u00b710^$1$2").replaceAll("-", "\u2212");
}
// A unit as people write it.
const raised = unit => unit === "1" ? "" : unit.replace("^2", "\u00b2").replace("^3", "\u00b3");
function short(value, digits) {
  return marked(plain(value, digits).replace(/(\.\d*?)0+(?=\u00b7|$)/, "$1").replace(/\.(?=\u00b7|$)/, ""));
}
function nice(value) {
  const power = Math.pow(10, Math.floor(Math.log10(value))), digit = value / power;
  return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}
