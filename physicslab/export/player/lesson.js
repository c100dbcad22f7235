// A lesson around the player: predictions are locked in before a run, and answers are saved as a file.

const { head, questions, compares, runs: made } = given.lesson;
const answers = {}, seen = new Set(), player = $("player");  // runs by their lines
let shownBook = -1, unsaved = false;
const POINTS = 9, WIDE = 560, HIGH = 220, EDGE = [52, 10, 10, 26];  // left, top, right, bottom

const make = (tag, words, rest) => Object.assign(document.createElement(tag), { textContent: words }, rest);
const partOf = name => [...document.querySelectorAll(".part[data-name]")].find(one => one.dataset.name === name);
const formula = (value, unit) => `${short(value, 4)} ${unit}`.trim();
// A number as it is typed, with a point or a comma; not a number where it is none.
const typed = text => /^\s*[-+\u2212]?(\d+[.,]?\d*|[.,]\d+)(e[-+]?\d+)?\s*$/i.test(text)
  ? Number(text.replace(",", ".").replace("\u2212", "-")) : NaN;

// The one player stands where a run is made.
function showBook(number, place, begin) {
  if (player.parentElement !== place) place.append(player);
  player.hidden = false;
  if (shownBook !== number) { shownBook = number; time = 0; openBook(given.books[number]); fit(); }
  if (!begin) return;
  seek(0);
  play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  player.scrollIntoView({ block: "nearest" });
  $("play").focus({ preventScroll: true });
}

// ---- answers -----------------------------------------------------------------------------------------------

// What is said to an answer: whether it is right, and which reply of the lesson it gets.
function graded(name) {
  const one = questions[name], answer = answers[name];
  if (one.form === "choice") {
    const reply = one.replies[answer.choice - 1];
    return { right: reply.right, reply };
  }
  if (one.form === "number") {
    const near = value => Math.abs(answer.value - value) <= one.tolerance * Math.abs(value);
    return { right: near(one.answer), reply: near(one.answer) ? null : one.replies.find(reply => near(reply.value)) };
  }
  if (one.form === "curve") {
    const drawn = one.times.map(t => between(answer.curve, t)), near = curve => gapOf(drawn, curve) <= one.tolerance;
    return { right: near(one.answer), reply: near(one.answer) ? null : one.replies.find(reply => near(reply.value)) };
  }
  const { sliders } = given.books[one.book], place = sliders.reduce((sum, slider) =>
    sum * slider.texts.length + slider.texts.indexOf(answer.values[slider.name]), 0);
  return { right: Boolean(one.reached[place]), reply: null };
}
function between(points, t) {
  const next = points.findIndex(([at]) => t <= at);
  if (next <= 0) return points.at(next)[1];
  const [[t0, v0], [t1, v1]] = [points[next - 1], points[next]];
  return v0 + (v1 - v0) * (t - t0) / (t1 - t0);
}
function gapOf(drawn, curve) {
  const span = Math.max(...curve) - Math.min(...curve) || Math.abs(curve[0]) || 1;
  return Math.sqrt(drawn.reduce((sum, value, k) => sum + (value - curve[k]) ** 2, 0) / drawn.length) / span;
}

function tell(form, name) {
  const one = questions[name], holder = form.querySelector(".said"), said = [];
  if (!(name in answers)) return;
  const locked = one.kind === "predict" && !seen.has(one.run);
  form.classList.toggle("locked", one.kind === "predict");
  if (one.kind === "explain") {
    said.push(make("p", say("A model answer:"), { className: "mark" }), make("p", one.right));
  } else if (locked) {
    said.push(make("p", say("Locked in."), { className: "mark" }));
  } else {
    const { right, reply } = graded(name);
    const mark = one.kind === "predict" ? right ? say("It came as predicted.") : say("It came otherwise.")
      : right ? say("Right.") : say("Not yet.");
    said.push(make("p", `${right ? "\u2713" : "\u2717"} ${mark}`, { className: `mark ${right ? "right" : "wrong"}` }));
    const words = reply?.said || (right ? one.yes : "");
    if (words) said.push(make("p", words));
    if (reply?.idea) said.push(make("p", `${say("The idea behind it:")} ${reply.idea}`, { className: "faint" }));
    if (one.kind === "predict" && !right) said.push(make("p", `${say("What the run shows:")} ${one.expected}`));
    if (reply && "show" in reply) {
      const button = make("button", `${say("See it in a run:")} ${reply.case}`, { type: "button" });
      const place = make("div", "", { className: "here" });
      button.onclick = () => showBook(reply.show, place, true);
      said.push(button, ...(reply.note ? [make("p", reply.note)] : []), place);
    }
  }
  if (holder.contains(player)) { player.hidden = true; document.body.append(player); }
  holder.replaceChildren(...said);
}

// Everything down to the first part of a step that is still to be done.
function refresh() {
  for (const step of document.querySelectorAll(".step")) {
    let open = true;
    for (const part of step.children) {
      part.hidden = !open;
      const { kind, name } = part.dataset;
      if (kind === "run" ? !seen.has(made[name].line) : kind && kind !== "compare" && !(name in answers)) open = false;
    }
  }
  for (const form of document.querySelectorAll("form.part")) {
    const done = form.dataset.name in answers && questions[form.dataset.name].kind === "predict";
    form.querySelector("fieldset")?.toggleAttribute("disabled", done);
    form.querySelector("button.main").hidden = done;
    const note = form.querySelector(".locks");
    if (note) note.hidden = done;
  }
}

function refuse(form, words, field) {
  form.querySelector(".said").replaceChildren(make("p", words, { className: "mark wrong" }));
  field?.focus();
}

// The answer that stands in a form; nothing, and why, where it is not complete.
function read(form) {
  const one = questions[form.dataset.name], data = new FormData(form), found = {};
  if (one.form === "text") found.text = data.get("text");
  if (one.form === "choice") {
    if (!data.has("choice")) return refuse(form, say("Choose an answer first."), form.querySelector("input"));
    found.choice = Number(data.get("choice"));
  } else if (one.form === "number") {
    found.value = typed(data.get("number"));
    if (!Number.isFinite(found.value)) {
      return refuse(form, say("Write a number, as 2.5, without its unit."), form.querySelector("input"));
    }
  } else if (one.form === "curve") {
    found.curve = form.points.map(point => [...point]);
    if (!form.drawn) return refuse(form, say("Draw the curve first."), form.querySelector("input"));
  } else if (one.form === "goal") {
    if (given.books[shownBook] !== given.books[one.book]) return refuse(form, say("Set the sliders first."));
    found.values = Object.fromEntries(sliders.map((slider, n) => [slider.name, slider.texts[chosen[n]]]));
  }
  if (one.kind === "predict") {
    if (!data.has("sure")) return refuse(form, say("Say how sure you are."), form.querySelector(".sure input"));
    found.sure = data.get("sure");
  }
  return found;
}

for (const form of document.querySelectorAll("form.part")) {
  const { name } = form.dataset, one = questions[name];
  if (one.form === "curve") makeCurve(form, one);
  if (one.form === "goal") {
    const place = form.querySelector(".here"), button = make("button", say("Set the sliders"), { type: "button" });
    button.onclick = () => showBook(one.book, place, true);
    place.before(button);
  }
  form.onsubmit = event => {
    event.preventDefault();
    const found = read(form);
    if (!found) return;
    answers[name] = found;
    unsaved = true;
    refresh();
    tell(form, name);
    let next = form.nextElementSibling;
    if (one.kind === "predict") next?.querySelector("input:not([disabled]), button:not([hidden])")?.focus();
  };
}
for (const part of document.querySelectorAll(".part.run")) {
  const { book: number } = made[part.dataset.name];
  part.querySelector("button").onclick = () => showBook(number, part.querySelector(".here"), true);
}
ended.push(() => {
  const { run: line } = book;
  if (shownBook < 0 || seen.has(line)) return;
  if (!Object.values(made).some(one => one.book === shownBook)) return;
  seen.add(line);
  refresh();
  for (const [name, one] of Object.entries(questions)) if (one.run === line) tell(partOf(name), name);
  for (const name of Object.keys(compares)) fillCompare(name);
});

// ---- a curve that is drawn ---------------------------------------------------------------------------------

function axes(first, last, low, high) {
  const x = t => EDGE[0] + (WIDE - EDGE[0] - EDGE[2]) * (t - first) / (last - first);
  const y = v => HIGH - EDGE[3] - (HIGH - EDGE[1] - EDGE[3]) * (v - low) / (high - low);
  const tick = nice((high - low) / 3), parts = [];
  for (let k = Math.ceil(low / tick); k * tick <= high * (1 + 1e-9); k++) {
    parts.push(`<path class="grid" d="M${EDGE[0]} ${y(k * tick)}H${WIDE - EDGE[2]}"/>`,
      `<text x="${EDGE[0] - 12}" y="${y(k * tick) + 4}" text-anchor="end">${short(k * tick, 3)}</text>`);
  }
  return { x, y, parts };
}
function drawing(parts) {
  return `<svg viewBox="0 0 ${WIDE} ${HIGH}" role="img"><title></title>${parts.join("")}</svg>`;
}

function makeCurve(form, one) {
  const holder = form.querySelector(".curve"), picture = make("div", "", { className: "picture" });
  const handles = make("div", "", { className: "handles" });
  const { x, y, parts } = axes(0, one.end, one.low, one.high);
  form.points = Array.from({ length: POINTS }, (_, k) => [one.end * k / (POINTS - 1), (one.low + one.high) / 2]);
  form.drawn = false;
  holder.append(make("p", say("Pull the points, or set each with its slider: up and down keys."), { className: "faint" }), picture, handles);
  const draw = () => {
    const line = form.points.map(([t, v]) => `${x(t)} ${y(v)}`).join("L");
    const dots = form.points.map(([t, v]) => `<circle cx="${x(t)}" cy="${y(v)}" r="6"/>`).join("");
    picture.innerHTML = drawing([...parts, `<text x="${WIDE - EDGE[2]}" y="${HIGH - 6}" text-anchor="end">${short(one.end, 4)} s</text>`,
      `<text x="4" y="12">${make("i", one.unit).innerHTML}</text>`, `<path class="predicted" d="M${line}"/>`, dots]);
  };
  const inputs = form.points.map(([t], k) => {
    const input = Object.assign(document.createElement("input"), {
      type: "range", min: one.low, max: one.high, step: (one.high - one.low) / 100, value: form.points[k][1],
    });
    input.setAttribute("aria-label", `${say("value at")} ${short(t, 3)} s`);
    input.oninput = () => set(k, input.valueAsNumber);
    const label = make("label", `${short(t, 3)} s`);
    label.append(input);
    handles.append(label);
    return input;
  });
  const set = (k, value) => {
    form.points[k][1] = Math.min(Math.max(value, one.low), one.high);
    form.drawn = true;
    inputs[k].value = form.points[k][1];
    inputs[k].setAttribute("aria-valuetext", formula(form.points[k][1], one.unit));
    draw();
  };
  form.setCurve = points => form.points.forEach(([t], k) => set(k, between(points, t)));
  const pulled = event => {
    if (!event.buttons || form.querySelector("fieldset").disabled) return;
    const box = picture.getBoundingClientRect(), px = (event.clientX - box.x) * WIDE / box.width;
    const py = (event.clientY - box.y) * HIGH / box.height, share = (px - EDGE[0]) / (WIDE - EDGE[0] - EDGE[2]);
    const k = Math.min(Math.max(Math.round(share * (POINTS - 1)), 0), POINTS - 1);
    set(k, one.low + (HIGH - EDGE[3] - py) / (HIGH - EDGE[1] - EDGE[3]) * (one.high - one.low));
  };
  picture.onpointerdown = picture.onpointermove = pulled;
  draw();
}

// What was drawn stands in the graph of the run, beside what is measured and the theory.
loaders.push(() => {
  for (const [name, one] of Object.entries(questions)) {
    if (one.form !== "curve" || one.run !== book.run || !(name in answers) || typeof one.graph !== "number") continue;
    const at = charts[one.graph + 1], drawn = Float32Array.from(times, t => between(answers[name].curve, t) * one.factor);
    at.shown.push({ name: say("predicted"), unit: at.shown[0].unit, values: drawn, dash: DASHES[2], place: 3 });
    at.lowest = Math.min(at.lowest, ...drawn);
    at.highest = Math.max(at.highest, ...drawn);
  }
});

// ---- prediction, theory and measurement --------------------------------------------------------------------

function fillCompare(name) {
  const one = compares[name], part = partOf(name), body = part.querySelector("tbody");
  const told = one.prediction && answers[one.prediction.name];
  const predicted = told ? told.value * one.prediction.factor : null;
  const rows = one.cases.map((words, n) => ({ words, row: one.rows[n], book: one.books[n] }));
  const own = given.books[shownBook], place = own?.run === one.run && own.sliders.length ? placeOf() : -1;
  if (place >= 0 && sliders.some((slider, n) => chosen[n] !== slider.start)) {
    const words = sliders.map((slider, n) => `${slider.name} = ${short(slider.values[chosen[n]], 4)} ${slider.unit}`.trim());
    rows.push({ words: `${words.join("; ")} (${say("your run")})`, row: own.rows[place][name] });
  }
  body.replaceChildren(...rows.map(({ words, row, book: number }, n) => {
    const line = document.createElement("tr"), first = make("th", "", { scope: "row" });
    first.append(make("span", `${n + 1}. ${words} `));
    if (number !== undefined) {
      const button = make("button", "\u25b6\ufe0e", { type: "button", title: say("See this run") });
      button.setAttribute("aria-label", `${say("See this run")}: ${words}`);
      button.onclick = () => {
        const holder = part.querySelector(".here") ?? part.appendChild(make("div", "", { className: "here" }));
        showBook(number, holder, true);
      };
      first.append(button);
    }
    line.append(first, make("td", n === 0 && predicted !== null && row ? formula(predicted, row.unit) : "\u2013"));
    const cells = row ? [...row.words, `${row.near ? "\u2713" : "\u2717"} ${row.gap}`] : ["\u2013", "\u2013", "\u2013"];
    line.append(...cells.map((cell, k) => make("td", cell, { className: k === 2 && row ? row.near ? "right" : "wrong" : "" })));
    return line;
  }));
  part.classList.toggle("unpredicted", predicted === null);
  if (!one.along) plotCompare(part.querySelector(".plot"), one, rows.map(each => each.row), predicted);
}
const placeOf = () => sliders.reduce((sum, slider, n) => sum * slider.values.length + chosen[n], 0);
loaders.push(() => { for (const name of Object.keys(compares)) if (seen.has(compares[name].run)) fillCompare(name); });

function plotCompare(holder, one, rows, predicted) {
  const numbers = rows.flatMap(row => row ? [row.theory, row.measured] : []).concat(predicted ?? []);
  if (!numbers.length) return;
  const low = Math.min(0, ...numbers), high = Math.max(0, ...numbers) || low + 1;
  const room = 0.08 * (high - low) || 1, below = low < 0 ? room : 0;
  const { x, y, parts } = axes(0.5, rows.length + 0.5, low - below, high + room);
  rows.forEach((row, n) => {
    const at = x(n + 1);
    parts.push(`<text x="${at}" y="${HIGH - 6}" text-anchor="middle">${n + 1}</text>`);
    if (!row) return;
    parts.push(`<path class="gap" d="M${at} ${y(row.theory)}V${y(row.measured)}"/>`,
      `<rect class="theory" x="${at - 8}" y="${y(row.theory) - 8}" width="16" height="16"/>`,
      `<circle class="measured" cx="${at}" cy="${y(row.measured)}" r="5"/>`);
  });
  if (predicted !== null) parts.push(`<path class="guess" d="M${x(1)} ${y(predicted) - 9}l9 9l-9 9l-9 -9z"/>`);
  const row = rows.find(Boolean), key = [
    `<svg viewBox="0 0 20 20"><rect class="theory" x="3" y="3" width="14" height="14"/></svg>${say("by theory")}`,
    `<svg viewBox="0 0 20 20"><circle class="measured" cx="10" cy="10" r="5"/></svg>${say("measured")}`,
    ...predicted === null ? [] : [`<svg viewBox="0 0 20 20"><path class="guess" d="M10 2l8 8l-8 8l-8 -8z"/></svg>${say("predicted")}`],
  ];
  holder.innerHTML = `<p class="key"></p>${drawing(parts)}`;
  holder.querySelector("title").textContent = one.quantity;
  holder.querySelector(".key").innerHTML = key.map(each => `<span>${each}</span>`).join("");
  holder.querySelector(".key").prepend(make("span", row.unit ? `${one.quantity} (${row.unit})` : one.quantity));
}

// ---- the file of answers -----------------------------------------------------------------------------------

$("save").onclick = () => {
  const file = new Blob([`${JSON.stringify(answersFile(), null, 2)}\n`], { type: "application/json" });
  const link = make("a", "", { href: URL.createObjectURL(file), download: `${head.lesson}-answers.json` });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  $("kept").textContent = `${say("Saved as")} ${link.download}`;
  unsaved = false;
};
addEventListener("beforeunload", event => { if (unsaved) event.preventDefault(); });  // the browser asks
const answersFile = () => ({ ...head, learner: $("learner").value.trim().slice(0, 200), answers });
$("open").onchange = async event => {
  const [file] = event.target.files;
  if (!file) return;
  let found;
  try { found = JSON.parse(await file.text()); } catch { found = {}; }
  if (found?.format !== head.format || found.lesson !== head.lesson || typeof found.answers !== "object") {
    $("kept").textContent = say("This file holds no answers to this lesson.");
    return;
  }
  $("learner").value = found.learner ?? "";
  const unread = Object.entries(found.answers ?? {}).filter(([name, answer]) => !taken(name, answer));
  refresh();
  for (const form of document.querySelectorAll("form.part")) tell(form, form.dataset.name);
  const left = unread.length ? ` ${say("These could not be read:")} ${unread.map(([name]) => name).join(", ")}` : "";
  $("kept").textContent = say("The answers of the file are in the page.") + left;
};
// Whether an answer of a file is one to a question of this lesson; it then stands in the page.
function taken(name, answer) {
  const form = name in questions && partOf(name);
  try {
    if (!form || !restore(form, questions[name], answer)) return false;
  } catch { return false; }
  answers[name] = answer;
  return true;
}
function restore(form, one, answer) {
  for (const input of form.querySelectorAll("input[type=radio]")) {
    if (input.name === "sure") input.checked = input.value === answer.sure;
    else input.checked = Number(input.value) === answer.choice;
  }
  if (one.form === "choice") return one.replies[answer.choice - 1] !== undefined;
  if (typeof answer.value === "string") answer.value = typed(answer.value.replace(one.unit, ""));
  if (one.form === "number") form.querySelector(".number").value = marked(String(answer.value));
  if (one.form === "text") form.querySelector("textarea").value = answer.text ?? "";
  if (one.form === "curve") form.setCurve(answer.curve);
  if (one.form === "goal") {
    return given.books[one.book].sliders.every(slider => slider.texts.includes(answer.values[slider.name]));
  }
  return one.form !== "number" || Number.isFinite(answer.value);
}

player.hidden = true;
document.body.classList.add("lesson");
refresh();
window.lesson = { answers, seen };
