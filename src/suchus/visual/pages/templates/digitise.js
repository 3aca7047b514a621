"use strict";
const facts = JSON.parse(document.getElementById("facts").textContent);
const pictures = JSON.parse(document.getElementById("pictures").textContent);
const [width, height] = facts.size;
const canvas = document.getElementById("picture"), context = canvas.getContext("2d");
const element = (name) => document.getElementById(name);
const COLOURS = ["#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7", "#ffffff", "#00d0d0", "#a6d854"];
const LENS = 70; // radius of the lens [px]
const ZOOM = 4; // of the lens over the picture
const NAME = /^[A-Za-z][A-Za-z0-9_]*$/;
const SERIES = /^(.*_)(\d+)$/;

const state = { frame: 0, point: facts.points[0], points: [...facts.points], marks: new Map(), undo: [], pointer: null };
const images = new Map();

/** Return the colour of a point. */
const colour = (point) => COLOURS[state.points.indexOf(point) % COLOURS.length];

/** Return the name under which the mark of a point in a frame is kept. */
const markName = (frame, point) => `${frame} ${point}`;

/** Return the place of a point in a frame, [x, y] in pixels of the film, or undefined. */
const markAt = (frame, point) => state.marks.get(markName(frame, point));

/** Return the number of frames in which a point is clicked. */
function countOf(point) {
  let count = 0;
  for (let frame = 0; frame < facts.times.length; frame += 1) count += markAt(frame, point) ? 1 : 0;
  return count;
}

/** Return the image of a frame, which draws itself when it is ready. */
function imageOf(frame) {
  if (!images.has(frame)) {
    if (images.size > 40) images.delete(images.keys().next().value);
    const image = new Image();
    image.onload = draw;
    image.src = `data:image/jpeg;base64,${pictures[frame]}`;
    images.set(frame, image);
  }
  return images.get(frame);
}

/** Return how the film lies in the canvas: scale and the place of its corner, in pixels of the screen. */
function layout() {
  const box = canvas.getBoundingClientRect();
  const scale = Math.min(box.width / width, box.height / height);
  return { scale, left: (box.width - scale * width) / 2, top: (box.height - scale * height) / 2, box };
}

/** Return a place on the screen as a place in the film, within its frame. */
function toFilm(clientX, clientY) {
  const { scale, left, top, box } = layout();
  const x = (clientX - box.left - left) / scale, y = (clientY - box.top - top) / scale;
  return [Math.min(Math.max(x, 0), width), Math.min(Math.max(y, 0), height)];
}

/** Draw the frame, its marks and, while the pointer is down, the lens. */
function draw() {
  const { scale, left, top, box } = layout(), dense = window.devicePixelRatio || 1;
  canvas.width = Math.round(box.width * dense);
  canvas.height = Math.round(box.height * dense);
  context.setTransform(dense, 0, 0, dense, 0, 0);
  context.clearRect(0, 0, box.width, box.height);
  const image = imageOf(state.frame);
  if (image.complete && image.naturalWidth) context.drawImage(image, left, top, scale * width, scale * height);
  const before = state.frame > 0 ? markAt(state.frame - 1, state.point) : undefined;
  if (before) ring(left + scale * before[0], top + scale * before[1], 9, colour(state.point), false);
  for (const point of state.points) {
    const mark = markAt(state.frame, point);
    if (!mark) continue;
    const x = left + scale * mark[0], y = top + scale * mark[1];
    ring(x, y, point === state.point ? 6 : 4, colour(point), true);
    write(point, x + 9, y + 4);
  }
  if (state.pointer && image.complete && image.naturalWidth) drawLens(image, scale, left, top, box);
}

/** Draw the lens beside the pointer: the picture around it, and a cross. */
function drawLens(image, scale, left, top, box) {
  const [x, y] = state.pointer, screenX = left + scale * x, screenY = top + scale * y;
  const middleX = Math.min(Math.max(screenX, LENS), box.width - LENS);
  const middleY = screenY > 2.6 * LENS ? screenY - 1.6 * LENS : screenY + 1.6 * LENS;
  const shown = LENS / (ZOOM * scale), grain = image.naturalWidth / width;
  context.save();
  context.beginPath();
  context.arc(middleX, middleY, LENS, 0, 2 * Math.PI);
  context.clip();
  context.fillStyle = "#000";
  context.fillRect(middleX - LENS, middleY - LENS, 2 * LENS, 2 * LENS);
  context.imageSmoothingEnabled = false;
  context.drawImage(
    image, grain * (x - shown), grain * (y - shown), 2 * grain * shown, 2 * grain * shown,
    middleX - LENS, middleY - LENS, 2 * LENS, 2 * LENS,
  );
  context.strokeStyle = colour(state.point);
  context.lineWidth = 1;
  context.beginPath();
  context.moveTo(middleX - LENS, middleY);
  context.lineTo(middleX + LENS, middleY);
  context.moveTo(middleX, middleY - LENS);
  context.lineTo(middleX, middleY + LENS);
  context.stroke();
  context.restore();
  ring(middleX, middleY, LENS, colour(state.point), false);
}

function ring(x, y, radius, paint, isFull) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.lineWidth = 4;
  context.strokeStyle = "#000";
  context.stroke();
  context.lineWidth = 2;
  context.strokeStyle = paint;
  context.stroke();
  if (isFull) {
    context.fillStyle = paint;
    context.fill();
  }
}

function write(text, x, y) {
  context.font = '600 12px "DejaVu Sans", system-ui, sans-serif';
  context.lineWidth = 3;
  context.strokeStyle = "#000";
  context.strokeText(text, x, y);
  context.fillStyle = "#fff";
  context.fillText(text, x, y);
}

/** Set or remove the mark of a point in a frame, and remember what was there. */
function mark(frame, point, place) {
  state.undo.push([frame, point, markAt(frame, point)]);
  if (place) state.marks.set(markName(frame, point), place);
  else state.marks.delete(markName(frame, point));
  keep();
}

/** Go to the next frame or point, as the user chose. */
function goOn() {
  const order = element("order").value;
  if (order === "frames" && state.frame < facts.times.length - 1) state.frame += 1;
  if (order === "points") {
    const next = state.points.indexOf(state.point) + 1;
    if (next < state.points.length) state.point = state.points[next];
    else if (state.frame < facts.times.length - 1) {
      state.frame += 1;
      state.point = state.points[0];
    }
  }
  refresh();
}

/** Take back the last change. */
function undo() {
  const last = state.undo.pop();
  if (!last) return say("There is nothing to undo.");
  const [frame, point, place] = last;
  if (place) state.marks.set(markName(frame, point), place);
  else state.marks.delete(markName(frame, point));
  state.frame = frame;
  state.point = point;
  keep();
  refresh();
}

/** Show a sentence beside the points. */
function say(text) {
  element("notice").textContent = text;
}

/** Keep all marks in the browser, so that a closed page loses nothing. */
function keep() {
  try {
    localStorage.setItem(facts.key, JSON.stringify({ points: state.points, marks: [...state.marks] }));
  } catch {
    say("This browser keeps nothing between visits: save the table before you close the page.");
  }
}

/** Take up what the browser kept of this film. */
function recall() {
  try {
    const kept = JSON.parse(localStorage.getItem(facts.key) || "null");
    if (!kept || !kept.marks.length) return;
    state.points = kept.points;
    state.marks = new Map(kept.marks);
    say(`${kept.marks.length} clicks of an earlier visit are here again.`);
  } catch {
    return;
  }
}

/** Return the marks as a plain table, from the first frame with a mark to the last. */
function table() {
  const points = state.points.filter((point) => countOf(point) > 0);
  const rows = facts.times.map((time, frame) => {
    const cells = points.flatMap((point) => {
      const place = markAt(frame, point);
      return place ? place.map((value) => value.toFixed(2)) : ["", ""];
    });
    return { cells, line: [time.toFixed(6), ...cells].join(","), full: cells.some((cell) => cell !== "") };
  });
  const first = rows.findIndex((row) => row.full), last = rows.findLastIndex((row) => row.full);
  const heading = ["time [s]", ...points.flatMap((point) => [`${point}_x [px]`, `${point}_y [px]`])].join(",");
  return [heading, ...rows.slice(Math.max(first, 0), last + 1).map((row) => row.line), ""].join("\n");
}

/** Read a table that this page saved: its points, and the marks of the frames whose times it has. */
function readTable(text) {
  const rows = text.trim().split(/\r?\n/).map((line) => line.split(","));
  const columns = rows[0].map((heading) => /^(.+)_([xy]) \[px\]$/.exec(heading.trim()));
  if (rows[0][0].trim() !== "time [s]" || columns.slice(1).some((column) => !column)) {
    throw new Error("The first line must be time [s] and columns such as hip_x [px] and hip_y [px].");
  }
  const marks = new Map(), points = [...new Set(columns.slice(1).map((column) => column[1]))];
  for (const row of rows.slice(1)) {
    const time = Number(row[0]), frame = facts.times.findIndex((value) => Math.abs(value - time) < 1e-4);
    if (frame < 0) throw new Error(`No frame of ${facts.film} is at ${row[0]} s: the table is of another film.`);
    for (const point of points) {
      const place = ["x", "y"].map((axis) => {
        const column = columns.findIndex((found) => found && found[1] === point && found[2] === axis);
        return row[column] === undefined || row[column].trim() === "" ? NaN : Number(row[column]);
      });
      if (place.every(Number.isFinite)) marks.set(markName(frame, point), place);
    }
  }
  return { points, marks };
}

/** Write the list of points, the counts and the picture anew. */
function refresh() {
  const list = element("points");
  list.replaceChildren(...state.points.map((point) => {
    const button = document.createElement("button"), dot = document.createElement("span");
    const done = document.createElement("span");
    button.type = "button";
    button.setAttribute("role", "radio");
    button.setAttribute("aria-checked", String(point === state.point));
    button.dataset.point = point;
    dot.className = "dot";
    dot.style.background = colour(point);
    done.className = "done";
    done.textContent = `${countOf(point)} of ${facts.times.length}`;
    button.append(dot, point, done);
    button.onclick = () => {
      state.point = point;
      refresh();
    };
    return button;
  }));
  element("time").value = String(state.frame);
  element("clock").textContent = `${state.frame + 1} of ${facts.times.length}, ${facts.times[state.frame].toFixed(3)} s`;
  const missing = facts.needed.filter((point) => countOf(point) === 0);
  const every = facts.needed.every((point) => countOf(point) === facts.times.length);
  element("count").textContent = missing.length
    ? `A gait needs these points too: ${missing.join(", ")}. To measure a walk, two points of the trunk and the feet are enough.`
    : every ? "All points that a gait needs are clicked in all frames." : "All points that a gait needs are there; frames without a click are gaps.";
  draw();
}

canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  state.pointer = toFilm(event.clientX, event.clientY);
  draw();
  event.preventDefault();
  canvas.focus();
});
canvas.addEventListener("pointermove", (event) => {
  if (!state.pointer) return;
  state.pointer = toFilm(event.clientX, event.clientY);
  draw();
});
canvas.addEventListener("pointerup", () => {
  if (!state.pointer) return;
  mark(state.frame, state.point, state.pointer);
  state.pointer = null;
  goOn();
});
canvas.addEventListener("pointercancel", () => {
  state.pointer = null;
  draw();
});
/** Go some frames on or back. */
function step(count) {
  state.frame = Math.min(Math.max(state.frame + count, 0), facts.times.length - 1);
  refresh();
}
/** Choose the point some places further in the list. */
function choose(count) {
  const index = state.points.indexOf(state.point) + count;
  state.point = state.points[Math.min(Math.max(index, 0), state.points.length - 1)];
  refresh();
}
function lose() {
  mark(state.frame, state.point, null);
  goOn();
}
element("before").onclick = () => step(-1);
element("next").onclick = () => step(1);
element("lost").onclick = lose;
element("undo").onclick = undo;
element("time").max = String(facts.times.length - 1);
element("time").oninput = (event) => {
  state.frame = Number(event.target.value);
  refresh();
};
element("more").onsubmit = (event) => {
  event.preventDefault();
  const name = element("name").value.trim();
  if (!NAME.test(name)) return say("A name has letters, digits and underscores and begins with a letter, as spine_1.");
  if (state.points.includes(name)) return say(`${name} is there already.`);
  state.points.push(name);
  state.point = name;
  const series = SERIES.exec(name);
  element("name").value = series ? `${series[1]}${Number(series[2]) + 1}` : "";
  say("");
  keep();
  refresh();
};
element("save").onclick = () => {
  if (!state.marks.size) return say("Nothing is clicked yet.");
  const link = document.createElement("a"), name = `${facts.film.replace(/\.[^.]*$/, "")}_points.csv`;
  link.href = URL.createObjectURL(new Blob([table()], { type: "text/csv" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  say(`Saved as ${name}, in the folder of downloads. Next: suchus capture ${name} --out my_gait.toml, or --tables measured.`);
};
element("load").onchange = async (event) => {
  const file = event.target.files[0];
  if (!file) return;
  try {
    const read = readTable(await file.text());
    state.marks = read.marks;
    state.points = [...new Set([...state.points, ...read.points])];
    state.undo = [];
    keep();
    say(`${read.marks.size} clicks of ${file.name} are here.`);
    refresh();
  } catch (error) {
    say(`${file.name} was not read. ${error.message}`);
  }
  event.target.value = "";
};
document.addEventListener("keydown", (event) => {
  if (event.target.matches("input, select")) return;
  const actions = { ArrowLeft: () => step(-1), ArrowRight: () => step(1), ArrowUp: () => choose(-1), ArrowDown: () => choose(1), Delete: lose };
  const action = (event.ctrlKey || event.metaKey) && event.key === "z" ? undo : actions[event.key];
  if (!action) return;
  event.preventDefault();
  action();
});
window.addEventListener("resize", draw);
recall();
refresh();
