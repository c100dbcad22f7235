// The world as it is drawn.

let marks = [];
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

// Faint stars, which are so far away that no camera moves them.
function drawStars(width, height) {
  let number = 3;
  const chance = () => (number = number * 16807 % 2147483647) / 2147483647;
  pen.fillStyle = colours.text;
  for (let n = 0; n < 3000; n++) {
    const x = 4096 * chance(), y = 2048 * chance(), bright = 0.1 + 0.4 * chance() ** 2;
    pen.globalAlpha = bright;
    if (x < width && y < height) { pen.beginPath(); pen.arc(x, y, bright < 0.3 ? 0.6 : 0.95, 0, 7); pen.fill(); }
  }
  pen.globalAlpha = 1;
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

// A coil, whose wire keeps its length: it grows slender where it is stretched; its back is darker.
function drawSpring(spring, now) {
  const [a, b] = ends(spring, now).map(onScreen), length = Math.hypot(b[0] - a[0], b[1] - a[1]), unit = pixel();
  if (spring.b === null) bracket(b, 1);
  if (spring.straight || length < 26) stroke(colours.spring, 1.6 * unit, a, b);
  else {
    const rest = Math.max((spring.rest || spring.longest) * camera.scale, 26), ahead = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
    const turns = Math.round(Math.min(Math.max(rest / (11 * unit), 4), 16)), part = 0.8 / turns;
    const around = Math.sqrt(Math.max((part * rest) ** 2 + (2 * Math.PI * Math.min(7 * unit, 0.1 * rest)) ** 2 - (part * length) ** 2, 0));
    const radius = Math.min(Math.max(around / (2 * Math.PI), 0.8 * unit), 14 * unit), points = [a];
    for (let k = 0; k <= 14 * turns; k++) {
      const turn = k * Math.PI / 7, aside = radius * Math.sin(turn);
      const along = (0.1 + part * k / 14) * length + 0.3 * radius * (1 - Math.cos(turn));
      points.push([a[0] + along * ahead[0] - aside * ahead[1], a[1] + along * ahead[1] + aside * ahead[0]]);
    }
    points.push(b);
    const wire = 2.1 * unit * Math.min(Math.max(Math.sqrt(rest / length), 0.6), 1.25);
    const isFront = k => k < 1 || k > 14 * turns || Math.cos((k - 0.5) * Math.PI / 7) > -0.2;
    for (const front of [false, true]) {
      pen.beginPath();
      for (let k = 0; k + 1 < points.length; k++) {
        if (isFront(k) === front) { pen.moveTo(...points[k]); pen.lineTo(...points[k + 1]); }
      }
      pen.strokeStyle = front ? colours.spring : dark(colours.spring);
      pen.lineWidth = wire;
      pen.lineCap = "round";
      pen.stroke();
    }
    pen.lineCap = "butt";
  }
  disc(a, 2.6 * unit, colours.spring);
  if (spring.b === null) screw(b, 0.7);
}

function stroke(colour, width, ...points) {
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.lineCap = pen.lineJoin = "round";
  path(...points); pen.stroke();
  pen.lineCap = "butt";
}
// Things that hold bodies grow with the root of the scale.
const pixel = () => Math.min(Math.max(Math.sqrt(camera.scale / 100), 0.6), 1.7);
const dark = (colour, share = 0.55) => mixed(colour, colours.background, share);
function disc([x, y], radius, colour) {
  pen.fillStyle = colour;
  pen.beginPath(); pen.arc(x, y, radius, 0, 2 * Math.PI); pen.fill();
}
function ring(at, radius, edge, inside, width = 1) {
  disc(at, radius * pixel(), edge);
  disc(at, (radius - width) * pixel(), inside);
}
function screw(at, angle) {
  const c = 3.2 * pixel() * Math.cos(angle), s = 3.2 * pixel() * Math.sin(angle);
  ring(at, 5.2, dark(colours.pin), colours.pin, 1.2);
  stroke(dark(colours.pin, 0.8), 1.7 * pixel(), [at[0] - c, at[1] + s], [at[0] + c, at[1] - s]);
}
// What fixes a screw to the world: above it (1) or below (-1).
function bracket([x, y], side) {
  const unit = pixel(), reach = y - 11 * side * unit;
  for (const across of [-6.3, -3.15, 0, 3.15, 6.3]) stroke(dark(colours.static, 0.25), 4.2 * unit, [x, y], [x + across * unit, reach]);
  stroke(colours.static, 3.4 * unit, [x - 9 * unit, reach], [x + 9 * unit, reach]);
}
function woven(points) {
  stroke(dark(colours.rope, 0.6), 6.2 * pixel(), ...points);
  stroke(colours.rope, 4.4 * pixel(), ...points);
  pen.setLineDash([1.1 * pixel(), 3.4 * pixel()]);
  pen.strokeStyle = dark(colours.rope, 0.45);
  path(...points); pen.stroke(); pen.setLineDash([]);
}
function held(joint, points, draw) {
  const fixed = points.filter((_, k) => (k ? joint.b : joint.a) === null);
  for (const point of fixed) bracket(point, 1);
  draw();
  for (const point of fixed) screw(point, 0.7);
}

const drawJoint = {  // a kind that is not among them as a rod
  Gear() {},
  Rod(joint, now) {
    const points = ends(joint, now).map(onScreen), [[x, y], [u, v]] = points, unit = pixel(), colour = colours.rod;
    const up = (u < x ? -unit : unit) / (Math.hypot(u - x, v - y) || 1);  // the light comes from above
    held(joint, points, () => {
      stroke(dark(colour), 7 * unit, ...points);
      stroke(colour, 5 * unit, ...points);
      stroke(mixed(colour, colours.shine, 0.5), 1.3 * unit, ...points.map(([px, py]) => [px + up * (v - y), py - up * (u - x)]));
      for (const point of points) { ring(point, 4.4, dark(colour), colour); disc(point, 1.5 * unit, dark(colour, 0.8)); }
    });
  },
  Rope(joint, now) {  // slack hangs as a parabola of the rope's length, nearly
    const [a, b] = ends(joint, now), span = Math.hypot(b[0] - a[0], b[1] - a[1]);
    const [p, q] = [a, b].map(onScreen), slack = Math.max(joint.length - span, 0);
    const sag = Math.sqrt(3 / 8 * slack * Math.max(span, 0.2 * joint.length)) * camera.scale;
    held(joint, [p, q], () => {
      woven(Array.from({ length: 25 }, (_, i) => {
        const t = i / 24;
        return [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]) + 4 * sag * t * (1 - t)];
      }));
      for (const point of [p, q]) ring(point, 3.6, dark(colours.rope), colours.rope);
    });
  },
  Pulley(joint, now) {
    const [a, b] = ends(joint, now), points = [a, ...joint.wheels, b].map(onScreen), wheels = points.slice(1, 3);
    for (const wheel of wheels) { bracket(wheel, 1); ring(wheel, 11, dark(colours.rod), dark(colours.rod, 0.2), 1.6); }
    woven(points);
    for (const end of [points[0], points[3]]) ring(end, 3.6, dark(colours.rope), colours.rope);
    for (const wheel of wheels) screw(wheel, 0.7);
  },
  Pin(joint, now) {  // the head of a screw, whose slot turns; on a bracket where it is fixed
    const at = onScreen(ends(joint, now)[0]), turns = joint.b ?? joint.a;
    if (joint.a === null || joint.b === null) bracket(at, -1);
    screw(at, turns === null ? 0 : now(run.bodies[turns])[2]);
  },
  Slot(joint, now) {
    const [a, b] = ends(joint, now), turn = joint.a === null ? 0 : now(run.bodies[joint.a])[2];
    const size = Math.hypot(...joint.axis), [u, v] = joint.axis.map(part => part / size);
    const axis = [u * Math.cos(turn) - v * Math.sin(turn), u * Math.sin(turn) + v * Math.cos(turn)];
    const along = (b[0] - a[0]) * axis[0] + (b[1] - a[1]) * axis[1];
    const rail = [joint.lower ?? Math.min(along, 0) - 0.6, joint.upper ?? Math.max(along, 0) + 0.6]
      .map(way => onScreen([a[0] + way * axis[0], a[1] + way * axis[1]]));
    stroke(colours.rod, 13 * pixel(), ...rail);
    stroke(dark(colours.rod, 0.8), 9 * pixel(), ...rail);
    ring(onScreen(b), 7, dark(colours.pin), dark(colours.pin, 0.15), 1.2);
  },
  Weld(joint, now) { ring(onScreen(ends(joint, now)[0]), 3.8, dark(colours.pin, 0.6), dark(colours.pin, 0.2)); },
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
      stroke(colours.spark, width, [x, y], [x + share * u, y + share * v]);
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
    const at = now(body), above = body.columns ? Math.max(body.half * camera.scale, body.size) + 9 : 0;
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
  const sky = pen.createLinearGradient(0, 0, 0, height);
  sky.addColorStop(0, colours.sky_top);
  sky.addColorStop(1, run.space && darkly.matches ? colours.sky_top : colours.sky_bottom);
  pen.fillStyle = sky;
  pen.fillRect(0, 0, width, height);
  if (run.space && darkly.matches) drawStars(width, height);
  marks = [];
  if (show.grid) drawGrid(width, height);
  if (run.bounds) drawBounds(run.bounds, width, height);
  drawFields(width, height);
  const trailed = body => show.trails && (movers.length <= 200 || body === selected);
  for (const body of movers) if (trailed(body)) drawTrail(body, frame, now(body));
  drawFlames(now);
  for (const layer of [body => body.fluid, body => !body.fluid && !body.columns, body => !body.fluid && body.columns]) {
    const bodies = drawn.filter(layer);
    drawShadows(bodies, now);
    for (const body of bodies) drawBody(body, now(body));
  }
  for (const spring of run.springs) drawSpring(spring, now);
  for (const joint of run.joints) if (!(time >= joint.until)) (drawJoint[joint.kind] ?? drawJoint.Rod)(joint, now);
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
