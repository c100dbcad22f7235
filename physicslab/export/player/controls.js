// Mouse, fingers, keys and buttons; and the loop that plays.

const touching = new Map();
let moved = 0;

world.addEventListener("pointerdown", event => {
  world.setPointerCapture(event.pointerId);
  touching.set(event.pointerId, [event.offsetX, event.offsetY]);
  if (touching.size === 1) moved = 0;
});
world.addEventListener("pointermove", event => {
  const before = touching.get(event.pointerId), at = [event.offsetX, event.offsetY];
  if (!before) return;
  moved += Math.hypot(at[0] - before[0], at[1] - before[1]);
  const other = [...touching].find(([id]) => id !== event.pointerId)?.[1];
  const apart = place => Math.hypot(place[0] - other[0], place[1] - other[1]);
  if (other) zoom(apart(at) / Math.max(apart(before), 1), ...other);
  else if (moved > 6) {
    camera.x -= (at[0] - before[0]) / camera.scale;
    camera.y += (at[1] - before[1]) / camera.scale;
    camera.fitted = false;
    stale = true;
  }
  touching.set(event.pointerId, at);
});
world.addEventListener("pointerup", event => {
  if (touching.size === 1 && moved <= 6) select(bodyAt(event.offsetX, event.offsetY));
  touching.delete(event.pointerId);
});
world.addEventListener("pointercancel", event => touching.delete(event.pointerId));
world.addEventListener("wheel", event => {
  event.preventDefault();
  zoom(Math.exp(-0.0015 * event.deltaY * (event.deltaMode ? 30 : 1)), event.offsetX, event.offsetY);
}, { passive: false });

// How far a place in a body's own directions is from its outline [m]; negative within.
function beyond({ core, radius }, u, v) {
  let nearest = Infinity, within = core.length > 2;
  core.forEach(([x, y], k) => {
    const [toX, toY] = core[(k + 1) % core.length], ex = toX - x, ey = toY - y, dx = u - x, dy = v - y;
    const share = Math.min(Math.max((dx * ex + dy * ey) / (ex * ex + ey * ey || 1), 0), 1);
    nearest = Math.min(nearest, Math.hypot(dx - share * ex, dy - share * ey));
    within &&= ex * dy - ey * dx >= 0;
  });
  return (within ? -nearest : nearest) - radius;
}

// The nearest body within 14 pixels, one that moves before one that does not.
function bodyAt(px, py) {
  const [frame, share] = moment();
  let best = null, nearest = 14;
  for (const body of drawn) {
    const [x, y, angle] = pose(body, frame, share), dx = px - toX(x), dy = py - toY(y);
    const c = Math.cos(angle), s = Math.sin(angle), scale = camera.scale;
    const off = Math.max(beyond(body, (c * dx - s * dy) / scale, (-s * dx - c * dy) / scale) * scale, 0);
    if (off < nearest || best && off <= nearest && body.columns) { best = body; nearest = off; }
  }
  return best;
}

function toggle(name) {
  show[name] = !show[name];
  $(name).setAttribute("aria-pressed", show[name]);
  stale = true;
}
function setSpeed(value) {
  speed = value;
  $("speed").value = value;
}
function selectNext(back) {
  const at = drawn.indexOf(selected), before = at > 0 ? at - 1 : drawn.length - 1;
  select(drawn[back ? before : (at + 1) % drawn.length] ?? null);
}
const zoomMiddle = factor => zoom(factor, world.clientWidth / 2, world.clientHeight / 2);
const keys = {
  " ": () => play(!playing), k: () => play(!playing),
  arrowleft: event => step(event.shiftKey ? -10 : -1), arrowright: event => step(event.shiftKey ? 10 : 1),
  home: () => seek(0), end: () => { play(false); seek(end); },
  l: () => toggle("loop"), t: () => toggle("trails"), v: () => toggle("arrows"), n: () => toggle("names"),
  g: () => toggle("grid"), b: event => selectNext(event.shiftKey),
  0: fit, "+": () => zoomMiddle(1.25), "-": () => zoomMiddle(0.8),
};
SPEEDS.forEach((value, i) => { keys[i + 1] = () => setSpeed(value); });
document.addEventListener("keydown", event => {
  const on = event.target.tagName, key = event.key.toLowerCase();
  const own = given.lesson && !event.target.closest("#player") || on === "SELECT" || on === "INPUT" && /^(arrow|home|end)/.test(key)
    || key === " " && (on === "BUTTON" || on === "SUMMARY");
  if (own || event.ctrlKey || event.metaKey || event.altKey || !keys[key]) return;
  event.preventDefault();
  keys[key](event);
});

$("play").onclick = () => play(!playing);
$("back").onclick = () => step(-1);
$("forward").onclick = () => step(1);
$("fit").onclick = fit;
for (const name of ["loop", "trails", "arrows", "names", "grid"]) {
  $(name).onclick = () => toggle(name);
  $(name).setAttribute("aria-pressed", show[name]);
}
$("time").oninput = event => { play(false); seek(times[event.target.valueAsNumber]); };
$("speed").onchange = event => setSpeed(Number(event.target.value));
$("body").onchange = event => select(run.bodies[event.target.value] ?? null);

// What differs from run to run; runs are in order, those of the last slider next to each other.
let chosen, sliders;
const makeSlider = (slider, n) => {
  const row = document.createElement("label"), words = document.createElement("span");
  const input = Object.assign(document.createElement("input"), {
    type: "range", id: `slider-${n}`, min: 0, max: slider.values.length - 1, step: 1, value: chosen[n],
  });
  const output = document.createElement("output");
  words.textContent = slider.label;
  input.oninput = () => { chosen[n] = input.valueAsNumber; showChosen(); };
  row.append(words, input, output);
  $("sliders").append(row);
  return { ...slider, input, output };
};
// Play another book of runs, from the middle of its sliders, or where it says.
function openBook(next) {
  book = next;
  $("sliders").replaceChildren();
  chosen = book.sliders.map(slider => slider.start ?? Math.floor((slider.values.length - 1) / 2));
  sliders = book.sliders.map(makeSlider);
  const aspect = (book.view[2] - book.view[0]) / (book.view[3] - book.view[1]);
  $("stage").style.setProperty("--aspect", Math.min(Math.max(aspect, 0.9), 2));
  showChosen();
}
function showChosen() {
  let place = 0;
  sliders.forEach(({ values, unit, input, output }, n) => {
    place = place * values.length + chosen[n];
    const written = `${short(values[chosen[n]], 5)} ${raised(unit)}`.trim();
    output.textContent = written;
    input.setAttribute("aria-valuetext", written);
  });
  const next = book.runs[place], failed = "failure" in next;
  $("failure").textContent = failed ? `${say("This run has no picture:")} ${next.failure}` : "";
  document.body.classList.toggle("failed", failed);
  load(failed ? book.runs.find(one => !("failure" in one)) : next);
}

let decimals = 2;
loaders.push(() => {
  const name = selected?.name;
  selected = run.bodies.find(body => body.name === name) ?? null;
  $("time").max = COUNT - 1;
  document.body.classList.toggle("still", COUNT === 1);
  decimals = Math.min(Math.max(2 - Math.floor(Math.log10(end / COUNT * 10 || 1)), 0), 9);
  $("speed").replaceChildren(...SPEEDS.map(value => new Option(`${short(value * natural, 3)}\u00d7`, value)));
  $("speed").value = speed;
  $("body").replaceChildren(new Option(say("none (click a body)"), ""),
    ...drawn.map(body => new Option(body.name, run.bodies.indexOf(body))));
  $("body").value = selected ? run.bodies.indexOf(selected) : "";
  const notes = [
    ...run.notes,
    `${COUNT} ${say("instants, positions to 7 digits (float32). While it plays, bodies move straight from one to the next; paused, the figures are those computed.")}`,
  ];
  $("notes").replaceChildren(...notes.map(text => Object.assign(document.createElement("li"), { textContent: text })));
});
new ResizeObserver(() => { if (camera.fitted) fit(); stale = true; }).observe(world);
darkly.addEventListener("change", readColours);

// What shows this page in a frame may set the time [s] and play, by messages; from then on it is told of both.
let host = null, told = {};
addEventListener("message", ({ source, data }) => {
  if (source !== window.parent || source === window) return;
  host = source;
  if (typeof data.playing === "boolean") play(data.playing);
  if (Number.isFinite(data.time)) seek(data.time - run.start);
  told = {};
});
function tellHost(now) {
  if (!host || told.playing === playing && playing && now - told.now < 200) return;
  told = { time: run.start + time, playing, now };
  host.postMessage({ time: told.time, playing }, "*");
}

let last = 0;
function tick(now) {
  const passed = Math.min((now - last) / 1000, 0.1);
  last = now;
  if (playing) {
    seek(time + passed * speed * natural);
    if (time >= end && show.loop) time = 0;
    else if (time >= end) play(false);
  }
  if (stale) {
    stale = false;
    const [frame, share] = moment();
    drawWorld(frame, share);
    for (const one of charts) drawChart(one, frame);
    showFigures(frame);
    $("time").value = frame;
    $("clock").textContent = `${marked((run.start + time).toFixed(decimals))} / ${short(run.start + end, 4)} s`;
    $("time").setAttribute("aria-valuetext", $("clock").textContent);
    tellHost(now);
  }
  requestAnimationFrame(tick);
}

// For a console, and for tests.
window.player = {
  get book() { return book; }, seek, play, get run() { return run; }, get times() { return times; }, get lines() { return lines; },
  get quantities() { return quantities; }, get chosen() { return [...chosen]; }, get time() { return time; }, get playing() { return playing; },
  get selected() { return selected?.name ?? null; },
  at: (name, frame) => run.bodies.find(body => body.name === name).at(frame),
  pixel: (x, y) => [world.getBoundingClientRect().x + toX(x), world.getBoundingClientRect().y + toY(y)],
};
show.loop = !given.lesson;
readColours();
openBook(book);
show.trails = movers.length <= 12 || movers.some(body => body.trail);
show.grid = !run.space;
show.names = named > 0 && named <= 12;
for (const name of ["loop", "trails", "names", "grid"]) $(name).setAttribute("aria-pressed", show[name]);
fit();
setSpeed(1);
select(movers.length === 1 ? movers[0] : null);
play(!given.lesson && !matchMedia("(prefers-reduced-motion: reduce)").matches);
requestAnimationFrame(now => { last = now; tick(now); });
