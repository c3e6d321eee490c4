// Switches the parts of the model on and off; the gains are refitted at every change.
//
// The trace contains the contribution of each part to the output. With some parts switched off, one
// factor for each other part is fitted to the fit segment by least squares; the errors are those on
// each segment.

import { element } from "./dom.js";
import { digits, line, svg, ticks } from "./plot.js";

// The columns of the trace, by name; the names have no units.
export function table(text) {
  const rows = text.trim().split("\n").map(cells);
  const names = rows[0].map((cell) => cell.replace(/ \[[^\]]*\]$/, ""));
  const units = rows[0].map((cell) => /\[([^\]]*)\]$/.exec(cell)?.[1] ?? "");
  return { names, units, rows: rows.slice(1) };
}

function cells(row) {
  const all = row.match(/("([^"]|"")*"|[^,]*)(,|\r?$)/g) ?? [];
  return all.map((cell) => cell.replace(/[,\r]$/, "").replace(/^"|"$/g, ""));
}

// Factors of the columns, by least squares over the rows; null if the columns are not independent.
export function solve(columns, target, rows) {
  const count = columns.length;
  const size = columns.map((own) => Math.sqrt(rows.reduce((sum, i) => sum + own[i] ** 2, 0)) || 1);
  const matrix = columns.map((a, j) => columns.map((b, k) => rows.reduce((sum, i) => sum + a[i] * b[i], 0) / size[j] / size[k]));
  const right = columns.map((a, j) => rows.reduce((sum, i) => sum + a[i] * target[i], 0) / size[j]);
  for (let j = 0; j < count; j++) {
    for (let k = 0; k < j; k++) matrix[j][j] -= matrix[j][k] ** 2;
    if (!(matrix[j][j] > 1e-12)) return null;
    matrix[j][j] = Math.sqrt(matrix[j][j]);
    for (let i = j + 1; i < count; i++) {
      for (let k = 0; k < j; k++) matrix[i][j] -= matrix[i][k] * matrix[j][k];
      matrix[i][j] /= matrix[j][j];
    }
  }
  for (let j = 0; j < count; j++) {
    for (let k = 0; k < j; k++) right[j] -= matrix[j][k] * right[k];
    right[j] /= matrix[j][j];
  }
  for (let j = count - 1; j >= 0; j--) {
    for (let k = j + 1; k < count; k++) right[j] -= matrix[k][j] * right[k];
    right[j] /= matrix[j][j];
  }
  return right.map((own, j) => own / size[j]);
}

const FIXED = ["record", "t", "segment", "input", "measured", "baseline", "final", "residual"];

// `shape` gives the hysteresis state along an input, for the parameters that the user drags.
export function explore(found, shape) {
  const text = (name) => new TextDecoder().decode(found.files[name]);
  const { names, units, rows } = table(text("trace.csv"));
  const numbers = (name) => {
    const index = names.indexOf(name);
    return Float64Array.from(rows, (row) => Number(row[index]));
  };
  const segment = rows.map((row) => row[names.indexOf("segment")]);
  const of = (name) => [...segment.keys()].filter((i) => segment[i] === name);
  const segments = { fit: of("fit"), selection: of("selection"), "held-out": of("held-out") };
  const data = { time: numbers("t"), input: numbers("input"), measured: numbers("measured"), segments };
  const several = names.includes("record");
  if (several) data.time = data.time.map((_, i) => i);
  data.labels = {
    time: several ? "sample of all records" : "t [s]",
    input: label("input", units[names.indexOf("input")]),
    output: label("output", units[names.indexOf("measured")]),
  };
  const parts = names.filter((name) => !FIXED.includes(name)).map((name) => ({ name, values: numbers(name), on: true }));
  const known = JSON.parse(text("result.json")).final.parameters;
  const value = (name) => known.find((own) => own.name === name)?.value;
  const identified = ["rho", "sigma", "n", "eta0"].map(value);
  // With several records, each has its own initial state.
  if (!several && identified.slice(0, 3).every(Number.isFinite)) data.shape = { identified, unit: known.find((own) => own.name === "rho").unit, of: shape };
  return view(data, parts.filter((own) => own.values.some((value) => value !== 0)));
}

function label(name, unit) {
  return unit ? `${name} [${unit}]` : name;
}

const NO_POINT = "Move the pointer over a figure, or use the arrow keys in the residual, to read values.";

function view(data, parts) {
  const span = { from: 0, to: data.time.length - 1 };
  const state = { parts, span, model: null, at: null };
  const errors = element("p", { class: "error", "aria-live": "polite" });
  const hover = element("output", { class: "note" }, NO_POINT);
  const list = element("div");
  const figures = {
    loop: element("div"),
    rest: element("div", { tabindex: "0", role: "group", "aria-label": "Residual over time. The left and right arrow keys move the cursor." }),
  };
  const slide = (end, text) => {
    const field = element("input", { type: "range", min: 0, max: data.time.length - 1, value: span[end], "aria-label": text });
    field.addEventListener("input", () => {
      span[end] = Number(field.value);
      if (span.to - span.from < 8) span[end] = end === "from" ? Math.max(0, span.to - 8) : Math.min(data.time.length - 1, span.from + 8);
      draw();
    });
    return field;
  };
  const from = slide("from", "Start of the time range shown");
  const to = slide("to", "End of the time range shown");
  const zoom = (a, b) => {
    [span.from, span.to] = a === null ? [0, data.time.length - 1] : [Math.min(a, b), Math.max(a, b)];
    [from.value, to.value] = [span.from, span.to];
    draw();
  };
  const point = (index) => {
    state.at = index;
    hover.textContent = index === null ? NO_POINT
      : `${data.labels.time} ${digits(data.time[index])} · ${data.labels.input} ${digits(data.input[index])} · measured ${digits(data.measured[index])} · model ${digits(state.model[index])} · residual ${digits(data.measured[index] - state.model[index])}`;
    draw();
  };
  figures.rest.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const next = (state.at ?? (step > 0 ? span.from - 1 : span.to + 1)) + step * (event.shiftKey ? 10 : 1);
    point(Math.min(span.to, Math.max(span.from, next)));
  });
  const draw = () => {
    figures.loop.replaceChildren(loop(data, state, point));
    figures.rest.replaceChildren(residual(data, state, point, zoom));
  };
  const fit = () => {
    const on = parts.filter((own) => own.on);
    const factors = solve(on.map((own) => own.values), data.measured, data.segments.fit);
    state.model = Float64Array.from(data.measured, (_, i) => (factors ?? []).reduce((sum, f, k) => sum + f * on[k].values[i], 0));
    parts.forEach((own) => (own.factor.textContent = own.on && factors ? `× ${digits(factors[on.indexOf(own)])}` : "off"));
    const share = (name) => {
      const rows = data.segments[name];
      const mean = rows.reduce((sum, i) => sum + data.measured[i], 0) / rows.length;
      const of = (value) => Math.sqrt(rows.reduce((sum, i) => sum + value(i) ** 2, 0) / rows.length);
      return (100 * of((i) => data.measured[i] - state.model[i])) / of((i) => data.measured[i] - mean);
    };
    const said = Object.keys(data.segments).filter((name) => data.segments[name].length).map((name) => `${name} ${digits(share(name))} %`);
    errors.textContent = factors ? `Error relative to the output's std: ${said.join(" · ")}` : "This record cannot distinguish these parts.";
    draw();
  };
  for (const own of parts) {
    own.factor = element("output", { class: "note" });
    const box = element("input", { type: "checkbox", checked: true });
    box.addEventListener("change", () => {
      own.on = box.checked;
      fit();
    });
    list.append(element("label", {}, box, own.name, own.factor));
  }
  const shapes = sliders(data, parts.find((own) => own.name === "transmission.hysteresis"), fit);
  const root = element("section", { "aria-labelledby": "explore-head" },
    element("h3", { id: "explore-head" }, "Take the model apart"),
    element("p", { class: "note" }, "Switch a part off to refit the gains of the others on the fit segment. Drag over the residual to zoom. The loop shows the same time range."),
    errors,
    element("div", { class: "explore" },
      element("fieldset", {}, element("legend", {}, "Parts of the model"), list),
      shapes,
      element("fieldset", {}, element("legend", {}, "Time range shown"),
        element("label", { class: "slide" }, "from", from), element("label", { class: "slide" }, "to", to),
        element("p", {}, element("button", { type: "button", onclick: () => zoom(null) }, "Show all")), hover)),
    element("p", { class: "note keys" }, element("span", { class: "measured" }, "measured"), element("span", { class: "model" }, "model"), element("span", { class: "rest" }, "residual")),
    element("div", { class: "explore" }, figures.loop, figures.rest));
  fit();
  return root;
}

// Sliders for the hysteresis parameters; the loop follows.
function sliders(data, part, fit) {
  if (!data.shape || !part) return null;
  const { identified, unit, of } = data.shape;
  const identifiedValues = part.values;
  const now = identified.slice();
  const ranges = [
    { name: "rho", unit, low: identified[0] / 5, high: identified[0] * 5 },
    { name: "sigma", unit: "", low: 0.5, high: Math.max(5, 2 * identified[1]) },
    { name: "n", unit: "", low: 1, high: Math.max(5, 2 * identified[2]) },
  ];
  let turn = 0;
  const said = element("p", { class: "note" }, "as identified");
  const change = async () => {
    const own = ++turn;
    const eta = await of([...now.slice(0, 3), now[3] ?? 0], data.input);
    if (own !== turn) return;
    part.values = eta;
    said.textContent = "The error is recomputed from the samples of the trace. At the identified values, it is close, but not equal, to the error in the report.";
    fit();
  };
  const fields = ranges.map(({ name, unit, low, high }, k) => {
    const shown = element("output", {}, digits(now[k]));
    const scale = Math.log(high / low) / 1000;
    const at = (value) => Math.round(Math.log(value / low) / scale);
    const field = element("input", { type: "range", min: 0, max: 1000, value: at(now[k]), "aria-label": `${name}${unit ? `, in ${unit}` : ""}` });
    field.addEventListener("input", () => {
      now[k] = Math.min(high, Math.max(low, low * Math.exp(scale * Number(field.value))));
      shown.textContent = digits(now[k]);
      change();
    });
    return { row: element("label", { class: "slide" }, `${name}${unit ? ` [${unit}]` : ""}`, field, shown), reset: () => ((field.value = at(identified[k])), (shown.textContent = digits(identified[k]))) };
  });
  const back = element("button", { type: "button" }, "As identified");
  back.addEventListener("click", () => {
    turn++;
    identified.forEach((value, k) => (now[k] = value));
    part.values = identifiedValues;
    fields.forEach((own) => own.reset());
    said.textContent = "as identified";
    fit();
  });
  return element("fieldset", {}, element("legend", {}, "Shape of the hysteresis"), ...fields.map((own) => own.row), element("p", {}, back), said,
    element("p", { class: "note" }, "rho: initial slope of eta. 2·sigma·rho: slope after a reversal. n: sharpness of the knee; larger is sharper."));
}

const [WIDTH, HEIGHT, LEFT, BOTTOM] = [560, 340, 58, 40];

// Axes around a range, with functions that map values to positions.
function frame(xs, ys, labels, title) {
  const range = (values) => {
    let [low, high] = [Infinity, -Infinity];
    for (const value of values) [low, high] = [Math.min(low, value), Math.max(high, value)];
    const more = 0.04 * (high - low || 1);
    return [low - more, high + more];
  };
  const [x0, x1] = range(xs);
  const [y0, y1] = range(ys);
  const x = (value) => LEFT + ((WIDTH - LEFT - 8) * (value - x0)) / (x1 - x0);
  const y = (value) => HEIGHT - BOTTOM - ((HEIGHT - BOTTOM - 8) * (value - y0)) / (y1 - y0);
  const picture = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "figure", role: "img", "aria-label": title });
  for (const value of ticks(x0, x1)) {
    picture.append(svg("line", { class: "grid", x1: x(value), x2: x(value), y1: 8, y2: HEIGHT - BOTTOM }),
      svg("text", { x: x(value), y: HEIGHT - BOTTOM + 16, "text-anchor": "middle" }, [digits(value)]));
  }
  for (const value of ticks(y0, y1)) {
    picture.append(svg("line", { class: "grid", x1: LEFT, x2: WIDTH - 8, y1: y(value), y2: y(value) }),
      svg("text", { x: LEFT - 6, y: y(value) + 4, "text-anchor": "end" }, [digits(value)]));
  }
  picture.append(svg("rect", { class: "frame", x: LEFT, y: 8, width: WIDTH - LEFT - 8, height: HEIGHT - BOTTOM - 8 }),
    svg("text", { x: (LEFT + WIDTH) / 2, y: HEIGHT - 6, "text-anchor": "middle" }, [labels[0]]),
    svg("text", { x: 14, y: HEIGHT / 2 - 16, transform: `rotate(-90 14 ${HEIGHT / 2 - 16})`, "text-anchor": "middle" }, [labels[1]]));
  return { picture, x, y };
}

// The position of the pointer, in the units of the figure.
function place(picture, event) {
  const box = picture.getBoundingClientRect();
  return [((event.clientX - box.left) * WIDTH) / box.width, ((event.clientY - box.top) * HEIGHT) / box.height];
}

function loop(data, state, point) {
  const { from, to } = state.span;
  const [xs, seen, made] = [data.input, data.measured, state.model].map((own) => own.slice(from, to + 1));
  const { picture, x, y } = frame(xs, [...seen, ...made], [data.labels.input, data.labels.output], "Output versus input: measured and model");
  picture.append(svg("path", { class: "measured", d: line(xs, seen, x, y) }), svg("path", { class: "model", d: line(xs, made, x, y) }));
  if (state.at !== null) picture.append(svg("circle", { class: "cursor", cx: x(data.input[state.at]), cy: y(data.measured[state.at]), r: 6, fill: "none" }));
  picture.addEventListener("pointermove", (event) => {
    const [px, py] = place(picture, event);
    let [best, nearest] = [Infinity, null];
    for (let i = from; i <= to; i++) {
      const away = (x(data.input[i]) - px) ** 2 + (y(data.measured[i]) - py) ** 2;
      if (away < best) [best, nearest] = [away, i];
    }
    point(nearest);
  });
  return picture;
}

function residual(data, state, point, zoom) {
  const { from, to } = state.span;
  const xs = data.time.slice(from, to + 1);
  const rest = Float64Array.from(xs, (_, k) => data.measured[from + k] - state.model[from + k]);
  const { picture, x, y } = frame(xs, rest, [data.labels.time, `residual: ${data.labels.output}`], "Residual over time");
  picture.append(svg("path", { class: "rest", d: line(xs, rest, x, y) }));
  if (state.at !== null && state.at >= from && state.at <= to) picture.append(svg("line", { class: "cursor", x1: x(data.time[state.at]), x2: x(data.time[state.at]), y1: 8, y2: HEIGHT - BOTTOM }));
  const index = (event) => {
    const share = (place(picture, event)[0] - LEFT) / (WIDTH - LEFT - 8);
    return Math.round(from + Math.min(1, Math.max(0, share)) * (to - from));
  };
  // The figure is redrawn while the pointer moves, so the start of the drag is kept in the state.
  if (state.start !== undefined && state.at !== null) {
    const [a, b] = [x(data.time[state.start]), x(data.time[state.at])];
    picture.append(svg("rect", { class: "span", x: Math.min(a, b), width: Math.abs(b - a), y: 8, height: HEIGHT - BOTTOM - 8 }));
  }
  picture.addEventListener("pointerdown", (event) => {
    if (event.pointerType === "mouse") state.start = index(event);
  });
  picture.addEventListener("pointermove", (event) => point(index(event)));
  picture.addEventListener("pointerup", (event) => {
    const [first, last] = [state.start, index(event)];
    state.start = undefined;
    if (first !== undefined && Math.abs(first - last) > 8) zoom(first, last);
  });
  return picture;
}
