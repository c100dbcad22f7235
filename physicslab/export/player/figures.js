// Energies against time, and the values of a body.

const chart = $("chart"), ink = chart.getContext("2d"), LEFT = 46, RIGHT = 6;
const extreme = best => lines.map(({ values }) => values.reduce((a, b) => best(a, b)));
const lowest = Math.min(0, ...extreme(Math.min)), highest = Math.max(lowest + 1e-30, ...extreme(Math.max));

function look(line) {
  const own = [colours.accent, colours.b1, colours.b2, colours.b5][lines.indexOf(line) % 4];
  return line.name === "total" ? { colour: colours.text, width: 2.6 } : { colour: own, width: 2 };
}

function drawChart() {
  const [width, height] = sized(chart, ink), low = height - 18, room = width - LEFT - RIGHT;
  const x = t => LEFT + room * t / (end || 1);
  const y = value => low - (low - 8) * (value - lowest) / (highest - lowest);
  const stroke = (...points) => {
    ink.beginPath();
    for (const at of points) ink.lineTo(...at);
    ink.stroke();
  };
  const tick = nice((highest - lowest) / 2.2);
  ink.clearRect(0, 0, width, height);
  ink.font = "12px system-ui, sans-serif";
  ink.fillStyle = colours.faint;
  ink.lineWidth = 1;
  ink.textAlign = "right";
  for (let k = Math.ceil(lowest / tick); k * tick <= highest; k++) {
    ink.strokeStyle = k ? colours.line : colours.axis;
    stroke([LEFT, y(k * tick)], [width - RIGHT, y(k * tick)]);
    ink.fillText(short(k * tick, 2), LEFT - 6, y(k * tick) + 4);
  }
  ink.fillText(`${short(run.start + end, 4)} s`, width - RIGHT, height - 3);
  ink.textAlign = "left";
  ink.fillText(short(run.start, 4), LEFT, height - 3);
  const stride = Math.max(1, Math.floor(COUNT / (2 * room)));
  for (const line of [...lines].reverse()) {  // the total first, below the rest
    const { colour, width: wide } = look(line), points = [];
    for (let k = 0; k < COUNT; k += stride) points.push([x(times[k]), y(line.values[k])]);
    ink.strokeStyle = colour;
    ink.lineWidth = wide;
    ink.setLineDash(line.dash);
    stroke(...points, [x(end), y(line.values[COUNT - 1])]);
  }
  ink.setLineDash([]);
  ink.strokeStyle = colours.text;
  ink.lineWidth = 1;
  stroke([x(time), 2], [x(time), low]);
}

// Rows of a label, drawn before it a line if it has one, and a value.
function fill(table, rows) {
  while (table.rows.length < rows.length) {
    const row = table.insertRow();
    row.insertCell();
    row.insertCell();
  }
  while (table.rows.length > rows.length) table.deleteRow(-1);
  rows.forEach(([label, value, line], i) => {
    const [first, second] = table.rows[i].cells;
    const key = label + (line ? JSON.stringify(look(line)) : "");
    if (first.dataset.key !== key) {
      first.textContent = label;
      if (line) first.prepend(sample(line));
      first.dataset.key = key;
    }
    if (second.textContent !== value) second.textContent = value;
  });
}

function sample(line) {
  const { colour, width } = look(line), holder = document.createElement("span");
  holder.innerHTML = `<svg aria-hidden="true"><path d="M0 4h30" stroke="${colour}" stroke-width="${width}"
    stroke-dasharray="${line.dash}"/></svg>`;
  return holder;
}

function showFigures(frame) {
  const digits = playing ? 4 : 7, value = (amount, unit) => `${number(amount, digits)} ${unit}`;
  fill($("legend"), lines.map(line => [line.name, value(line.values[frame], "J"), line]));
  const rows = [];
  if (selected) {
    const [x, y, angle, vx, vy, spin] = selected.at(frame), { mass, inertia } = selected;
    rows.push(["position x", value(x, "m")], ["position y", value(y, "m")], ["angle", value(angle, "rad")]);
    if (selected.columns) {
      rows.push(["velocity x", value(vx, "m/s")], ["velocity y", value(vy, "m/s")],
        ["speed", value(Math.hypot(vx, vy), "m/s")], ["angular velocity", value(spin, "rad/s")]);
    }
    if (selected.columns && mass) {
      const kinetic = (mass * (vx * vx + vy * vy) + inertia * spin * spin) / 2;
      rows.push(["mass", `${short(mass, 7)} kg`], ["kinetic energy", value(kinetic, "J")]);
      const potential = run.gravity && -mass * (run.gravity[0] * x + run.gravity[1] * y);
      if (run.gravity) rows.push(["potential, 0 at the origin", value(potential, "J")]);
    }
  }
  fill($("values"), rows);
}

function select(body) {
  selected = body;
  $("body").value = body ? run.bodies.indexOf(body) : "";
  stale = true;
}
