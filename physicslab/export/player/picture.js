// The world as it is drawn.

const COLOURS = [
  "background", "panel", "line", "text", "faint", "accent", "grid", "axis", "static", "static-fill", "spring",
  "bounds", "arrow", "fill", "b0", "b1", "b2", "b3", "b4", "b5", "b6",
];
const world = $("world"), pen = world.getContext("2d");
let colours = {}, marks = [];

function readColours() {
  const style = getComputedStyle(document.documentElement);
  colours = Object.fromEntries(COLOURS.map(name => [name, style.getPropertyValue(`--${name}`).trim()]));
  const tile = document.createElement("canvas"), line = tile.getContext("2d");
  tile.width = tile.height = 10;
  line.fillStyle = colours["static-fill"];
  line.fillRect(0, 0, 10, 10);
  line.strokeStyle = colours.static;
  line.globalAlpha = 0.6;
  for (const shift of [-10, 0, 10]) {
    line.beginPath(); line.moveTo(shift - 1, 11); line.lineTo(shift + 11, -1); line.stroke();
  }
  colours.hatch = pen.createPattern(tile, "repeat");
  paintBodies();
  stale = true;
}

// A body has a colour of its own, or that of its number, as in the window.
function paintBodies() {
  for (const body of run.bodies) {
    const own = "mass" in body ? colours[`b${body.entity % 7}`] : colours.text;
    body.paint = body.colour ?? (body.fluid ? colours.b0 : body.columns ? own : colours.static);
  }
}
loaders.push(paintBodies);

// As many pixels as the screen has; returns the size in pixels of the page.
function sized(canvas, context) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  const across = Math.round(width * ratio), down = Math.round(height * ratio);
  if (canvas.width !== across || canvas.height !== down) { canvas.width = across; canvas.height = down; }
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return [width, height];
}

const toX = x => world.clientWidth / 2 + (x - camera.x) * camera.scale;
const toY = y => world.clientHeight / 2 - (y - camera.y) * camera.scale;

function fit() {
  const [x0, y0, x1, y1] = book.view;
  camera.x = (x0 + x1) / 2;
  camera.y = (y0 + y1) / 2;
  camera.scale = Math.min(world.clientWidth / (x1 - x0), world.clientHeight / (y1 - y0)) || 1;
  camera.fitted = stale = true;
}

// The point under a pixel stays there.
function zoom(factor, px, py) {
  const u = px - world.clientWidth / 2, v = world.clientHeight / 2 - py;
  const x = camera.x + u / camera.scale, y = camera.y + v / camera.scale;
  camera.scale = Math.min(Math.max(camera.scale * factor, 1e-12), 1e9);
  camera.x = x - u / camera.scale;
  camera.y = y - v / camera.scale;
  camera.fitted = false;
  stale = true;
}

function path(...points) {
  pen.beginPath();
  for (const [x, y] of points) pen.lineTo(x, y);
}

function written(text, x, y, align, colour) {
  pen.textAlign = align;
  pen.lineWidth = 3;
  pen.lineJoin = "round";
  pen.strokeStyle = colours.background;
  pen.strokeText(text, x, y);
  pen.fillStyle = colour;
  pen.fillText(text, x, y);
}

function drawGrid(width, height) {
  const metres = nice(160 / camera.scale), pixels = metres * camera.scale;
  pen.lineWidth = 1;
  for (let k = Math.ceil(-toX(0) / pixels), at; (at = toX(k * metres)) <= width; k++) {
    const x = Math.round(at) + 0.5;
    pen.strokeStyle = k ? colours.grid : colours.axis;
    path([x, 0], [x, height]); pen.stroke();
    if (x > 40 && x < width - 24) marks.push([short(k * metres, 7), x, height - 7, "center"]);
  }
  for (let k = Math.ceil((toY(0) - height) / pixels), at; (at = toY(k * metres)) >= 0; k++) {
    const y = Math.round(at) + 0.5;
    pen.strokeStyle = k ? colours.grid : colours.axis;
    path([0, y], [width, y]); pen.stroke();
    if (y > 18 && y < height - 22) marks.push([short(k * metres, 7), 7, y - 5, "left"]);
  }
}

// A core of vertices, counter-clockwise, rounded by a radius: an arc around each, between the normals of two faces.
function outline({ core, radius, reach, kind }, [x, y, angle], grow = 0) {
  const c = Math.cos(angle), s = Math.sin(angle);
  pen.beginPath();
  if (core.length === 1 || reach * camera.scale < 1) {
    pen.arc(toX(x), toY(y), (kind === "point" ? 5 : Math.max(reach * camera.scale, 1)) + grow, 0, 2 * Math.PI);
    return;
  }
  const normal = k => {
    const [u, v] = core[k], [p, q] = core[(k + 1) % core.length];
    return -angle - Math.atan2(u - p, q - v);
  };
  core.forEach(([u, v], k) => {
    const before = normal((k + core.length - 1) % core.length);
    pen.arc(toX(x + c * u - s * v), toY(y + s * u + c * v), radius * camera.scale + grow, before, normal(k), true);
  });
  pen.closePath();
}

function drawBody(body, at) {
  const x = toX(at[0]), y = toY(at[1]), reach = body.reach * camera.scale + 9;
  const seen = x > -reach && x < world.clientWidth + reach && y > -reach && y < world.clientHeight + reach;
  if (!seen) return;
  outline(body, at);
  pen.lineWidth = 1.8;
  pen.strokeStyle = body.paint;
  if (body.fluid) {
    pen.globalAlpha = 0.22;
    pen.fillStyle = body.paint;
    pen.fill();
    pen.globalAlpha = 1;
    return;
  }
  if (!body.columns && body.kind !== "point" && !body.colour) {
    pen.fillStyle = colours.hatch;
    pen.fill(); pen.stroke();
    return;
  }
  pen.fillStyle = colours.background;
  pen.fill();
  pen.globalAlpha = body.kind === "point" ? 1 : Number(colours.fill);
  pen.fillStyle = body.paint;
  pen.fill();
  pen.globalAlpha = 1;
  pen.stroke();
  const mark = (Math.max(...body.core.map(corner => corner[0])) + body.radius) * camera.scale;
  if (body.charge) written(body.charge > 0 ? "+" : "\u2212", x, y + 5, "center", colours.text);
  else if (mark > 7) { path([x, y], [x + mark * Math.cos(at[2]), y - mark * Math.sin(at[2])]); pen.stroke(); }
}

// Where a point of a body is, or of the world where there is no body.
function placed(number, [u, v], now) {
  if (number === null || number === undefined) return [u, v];
  const [x, y, angle] = now(run.bodies[number]), c = Math.cos(angle), s = Math.sin(angle);
  return [x + c * u - s * v, y + s * u + c * v];
}
const ends = (link, now) => [placed(link.a, link.anchor_a, now), placed(link.b, link.anchor_b, now)];
const onScreen = ([x, y]) => [toX(x), toY(y)];

loaders.push(() => {
  for (const spring of run.springs) {  // one that keeps its length is a string, and drawn straight
    const looks = Math.min(COUNT, 100);
    const lengths = Array.from({ length: looks }, (_, i) => {
      const [a, b] = ends(spring, body => body.at(Math.floor(i * COUNT / looks)));
      return Math.hypot(b[0] - a[0], b[1] - a[1]);
    });
    spring.longest = Math.max(...lengths);
    spring.straight = spring.longest - Math.min(...lengths) < 0.03 * spring.longest;
  }
});

function drawSpring(spring, now) {
  const [a, b] = ends(spring, now).map(onScreen);
  const dx = b[0] - a[0], dy = b[1] - a[1], length = Math.hypot(dx, dy), points = [a];
  if (!spring.straight && length > 14) {
    const half = 2 * Math.round(Math.min(Math.max(spring.longest * camera.scale / 18, 4), 14));
    const along = (share, side) => [a[0] + share * dx - side * dy, a[1] + share * dy + side * dx];
    points.push(along(0.1, 0));
    const coil = k => along(0.1 + 0.8 * (k + 0.5) / half, (k % 2 ? 6 : -6) / length);
    for (let k = 0; k < half; k++) points.push(coil(k));
    points.push(along(0.9, 0));
  }
  pen.strokeStyle = pen.fillStyle = colours.spring;
  pen.lineWidth = 1.6;
  pen.lineJoin = "round";
  path(...points, b); pen.stroke();
  if (spring.b === null) { pen.beginPath(); pen.arc(...b, 4, 0, 2 * Math.PI); pen.fill(); }
}

function stroke(colour, width, ...points) {
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.lineCap = pen.lineJoin = "round";
  path(...points); pen.stroke();
  pen.lineCap = "butt";
}
function knob([x, y], radius, width = 2) {
  pen.strokeStyle = colours.spring;
  pen.lineWidth = width;
  pen.fillStyle = colours.background;
  pen.beginPath(); pen.arc(x, y, radius, 0, 2 * Math.PI); pen.fill(); pen.stroke();
}
function bracket([x, y]) {
  pen.strokeStyle = colours.spring;
  pen.lineWidth = 2;
  pen.fillStyle = colours.background;
  pen.beginPath(); pen.rect(x - 9, y - 9, 18, 18); pen.fill(); pen.stroke();
}

const drawJoint = {
  Rod(joint, now) {
    const points = ends(joint, now).map(onScreen);
    stroke(colours.spring, 5, ...points);
    for (const [point, body] of [[points[0], joint.a], [points[1], joint.b]]) {
      if (body === null) bracket(point);
      knob(point, 4, 1.5);
    }
  },
  Rope(joint, now) {  // slack hangs as a parabola of the rope's length, nearly
    const [a, b] = ends(joint, now), span = Math.hypot(b[0] - a[0], b[1] - a[1]);
    const [p, q] = [a, b].map(onScreen), slack = Math.max(joint.length - span, 0);
    const sag = Math.sqrt(3 / 8 * slack * Math.max(span, 0.2 * joint.length)) * camera.scale;
    stroke(colours.spring, 2.5, ...Array.from({ length: 25 }, (_, i) => {
      const t = i / 24;
      return [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]) + 4 * sag * t * (1 - t)];
    }));
    for (const point of [p, q]) knob(point, 3, 1.5);
  },
  Pulley(joint, now) {
    const [a, b] = ends(joint, now), points = [a, ...joint.wheels, b].map(onScreen);
    stroke(colours.spring, 2.5, ...points);
    for (const wheel of points.slice(1, 3)) { knob(wheel, 11); knob(wheel, 3); }
  },
  Pin(joint, now) {  // the head of a screw, whose slot turns; on a bracket where it is fixed
    const at = onScreen(ends(joint, now)[0]), turns = joint.b ?? joint.a;
    const angle = turns === null ? 0 : now(run.bodies[turns])[2], c = 3.4 * Math.cos(angle), s = 3.4 * Math.sin(angle);
    if (joint.a === null || joint.b === null) bracket(at);
    knob(at, 5);
    stroke(colours.spring, 2, [at[0] - c, at[1] + s], [at[0] + c, at[1] - s]);
  },
  Slot(joint, now) {
    const [a, b] = ends(joint, now), turn = joint.a === null ? 0 : now(run.bodies[joint.a])[2];
    const size = Math.hypot(...joint.axis), [u, v] = joint.axis.map(part => part / size);
    const axis = [u * Math.cos(turn) - v * Math.sin(turn), u * Math.sin(turn) + v * Math.cos(turn)];
    const along = (b[0] - a[0]) * axis[0] + (b[1] - a[1]) * axis[1];
    const rail = [joint.lower ?? Math.min(along, 0) - 0.6, joint.upper ?? Math.max(along, 0) + 0.6]
      .map(way => onScreen([a[0] + way * axis[0], a[1] + way * axis[1]]));
    stroke(colours.spring, 7, ...rail);
    stroke(colours.background, 4, ...rail);
    knob(onScreen(b), 6);
  },
  Weld(joint, now) { knob(onScreen(ends(joint, now)[0]), 3.5, 1.5); },
};

// Marks that stay where they are in the world: dots out of the plane, crosses into it, arrows along a field.
function drawFields(width, height) {
  if (!run.fields) return;
  const { magnetic, electric: [ex, ey] } = run.fields, apart = 2 ** Math.round(Math.log2(80 / camera.scale));
  const strength = Math.hypot(ex, ey), far = apart * camera.scale, place = 0.5 * far;
  pen.globalAlpha = 0.55;
  for (let x = toX(Math.ceil((camera.x - width / 2 / camera.scale) / apart) * apart); x < width; x += far) {
    for (let y = toY(Math.floor((camera.y + height / 2 / camera.scale) / apart) * apart); y < height; y += far) {
      if (magnetic > 0) { pen.fillStyle = colours.faint; pen.beginPath(); pen.arc(x, y, 2, 0, 7); pen.fill(); }
      if (magnetic < 0) for (const s of [4, -4]) stroke(colours.faint, 1.2, [x - 4, y - s], [x + 4, y + s]);
      if (strength) arrowFrom(x + place, y + place, 20 * ex / strength, -20 * ey / strength, colours.faint, 1.2);
    }
  }
  pen.globalAlpha = 1;
}

function drawFlames(now) {
  const largest = Math.max(...run.thrusts.map(one => Math.hypot(...one.force)));
  for (const { body, force: [fx, fy], at, turns, frequency, phase } of run.thrusts) {
    const angle = turns ? now(run.bodies[body])[2] : 0, c = Math.cos(angle), s = Math.sin(angle);
    const swing = -48 / largest * Math.cos(2 * Math.PI * frequency * (run.start + time) + phase);
    const [x, y] = onScreen(placed(body, at, now));
    const [u, v] = [swing * (c * fx - s * fy), -swing * (s * fx + c * fy)];
    for (const [share, width] of [[1, 3], [0.65, 6], [0.35, 9]]) {
      pen.globalAlpha = 0.5;
      stroke(colours.arrow, width, [x, y], [x + share * u, y + share * v]);
    }
  }
  pen.globalAlpha = 1;
}

function drawInstruments(now) {
  for (const gate of run.gates) {
    const [a, b] = gate.ends.map((end, k) => onScreen(placed(gate.bodies[k], end, now)));
    pen.setLineDash([7, 5]); stroke(colours.accent, 2, a, b); pen.setLineDash([]);
    written(gate.name, a[0], a[1] - 8, "center", colours.accent);
  }
  for (const note of run.texts) {
    const [x, y] = onScreen(placed(note.body, note.at, now));
    note.text.split("\n").forEach((line, k) => written(line, x, y + 17 * k, "left", colours.text));
  }
}

function drawTrail(body, frame, at) {
  const first = frameAt(time - (body.trail ?? Math.min(2 * natural, end / 3))), [xs, ys] = body.columns;
  pen.strokeStyle = body.paint;
  pen.lineWidth = 2;
  pen.lineJoin = "round";
  for (let part = 0; part < 8; part++) {  // fainter the longer ago
    const from = first + Math.floor((frame - first) * part / 8);
    const to = first + Math.floor((frame - first) * (part + 1) / 8);
    pen.globalAlpha = (part + 1) / 10;
    pen.beginPath();
    for (let k = from; k <= to; k++) pen.lineTo(toX(xs[k]), toY(ys[k]));
    if (part === 7) pen.lineTo(toX(at[0]), toY(at[1]));
    pen.stroke();
  }
  pen.globalAlpha = 1;
}

// An arrow is the way of so many seconds, such that the usual speed has an arrow of usual length.
let arrowSeconds = 1;
loaders.push(() => {
  const looks = Array.from({ length: 20 }, (_, i) => Math.floor(i * COUNT / 20));
  const speeds = movers.flatMap(body => looks.map(frame => Math.hypot(...body.at(frame).slice(3, 5))));
  speeds.sort((a, b) => a - b);
  const extent = Math.max(book.view[2] - book.view[0], book.view[3] - book.view[1]);
  arrowSeconds = nice(0.12 * extent / (speeds[Math.floor(0.95 * speeds.length)] || 1));
});

function arrowFrom(x, y, dx, dy, colour, width) {
  const length = Math.hypot(dx, dy);
  if (!(length > 5)) return;
  const head = Math.min(9, 0.6 * length) / length, tip = [x + dx, y + dy];
  const neck = [tip[0] - head * dx, tip[1] - head * dy], u = head * dx / 2, v = head * dy / 2;
  stroke(colour, width, [x, y], neck);
  pen.fillStyle = colour;
  path(tip, [neck[0] - v, neck[1] + u], [neck[0] + v, neck[1] - u]); pen.fill();
}
function drawArrow([x, y, , vx, vy]) {
  const scale = arrowSeconds * camera.scale;
  arrowFrom(toX(x), toY(y), vx * scale, -vy * scale, colours.arrow, 2.4);
}

// Names above bodies; one that another is in the way of goes higher.
function drawNames(now) {
  const taken = [], overlaps = (one, other) =>
    Math.abs(one.x - other.x) < one.half + other.half && Math.abs(one.y - other.y) < 15;
  const wanted = show.names ? movers.filter(body => body.named || !named) : [];
  for (const body of new Set([...(selected ? [selected] : []), ...wanted])) {
    if (body.kind === "none") continue;
    const at = now(body), above = body.columns ? body.half * camera.scale + 9 : 0;
    const wide = pen.measureText(body.name).width / 2 + 4;
    const label = { x: toX(at[0]), y: Math.max(toY(at[1]) - above, 16), half: wide };
    for (let i = 0; i < 3 && taken.some(other => overlaps(label, other)); i++) label.y -= 16;
    taken.push(label);
    written(body.name, label.x, label.y, "center", colours.text);
  }
}

function drawWorld(frame, share) {
  const [width, height] = sized(world, pen), poses = new Map();
  const now = body => poses.get(body) ?? poses.set(body, pose(body, frame, share)).get(body);
  pen.fillStyle = colours.background;
  pen.fillRect(0, 0, width, height);
  marks = [];
  if (show.grid) drawGrid(width, height);
  if (run.bounds) {
    const [x0, y0, x1, y1] = run.bounds;
    pen.strokeStyle = colours.bounds;
    pen.lineWidth = 2;
    pen.strokeRect(toX(x0), toY(y1), (x1 - x0) * camera.scale, (y1 - y0) * camera.scale);
  }
  colours.hatch.setTransform(new DOMMatrix().translate(toX(0) % 10, toY(0) % 10));
  drawFields(width, height);
  for (const body of drawn) if (!body.columns && !body.fluid) drawBody(body, now(body));
  const trailed = body => show.trails && (movers.length <= 200 || body === selected);
  for (const body of movers) if (trailed(body)) drawTrail(body, frame, now(body));
  for (const spring of run.springs) drawSpring(spring, now);
  drawFlames(now);
  for (const body of drawn) if (body.columns) drawBody(body, now(body));
  for (const body of drawn) if (body.fluid) drawBody(body, now(body));
  for (const joint of run.joints) drawJoint[joint.kind]?.(joint, now);
  if (show.arrows) for (const body of movers) drawArrow(now(body));
  if (selected) {
    outline(selected, now(selected), 4);
    pen.strokeStyle = colours.text;
    pen.lineWidth = 2;
    pen.setLineDash([5, 3]); pen.stroke(); pen.setLineDash([]);
  }
  pen.font = "12px system-ui, sans-serif";
  for (const mark of marks) written(...mark, colours.faint);
  pen.font = "13px system-ui, sans-serif";
  drawInstruments(now);
  drawNames(now);
  const scale = [show.grid && say("axes in metres"), show.arrows && `${say("arrows: path in")} ${short(arrowSeconds, 1)} s`];
  $("scale").textContent = scale.filter(Boolean).join("; ");
}
