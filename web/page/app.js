// The page: files, options, search and answer. Nothing leaves the tab.

import { element } from "./dom.js";
import { Cancelled, Engine } from "./engine.js";
import { digits, preview } from "./plot.js";
import { explore } from "./explore.js";
import { control } from "./control.js";
import { answer, report } from "./result.js";

const at = (id) => document.getElementById(id);
const engine = new Engine();
const EXAMPLE = "built-in synthetic record (bowden generate --mode torque --effect viscous --seed 7)";
const OPTIONS = ["mode", "start", "end", "cutoff", "rate", "header_line", "segment", "sheet", "names", "baseline", "max_terms", "drop_bad", "per_file", "invertible"];

// The files, the column roles that the user has chosen, and the last result.
const state = { files: [], looks: new Map(), parts: null, result: null, validated: null, designed: null, compared: null, turn: 0, answered: 0 };

// ---- the user's options -------------------------------------------------------------------------

function choices() {
  const all = {};
  for (const id of OPTIONS) {
    const field = at(id);
    if (field.type === "checkbox") {
      if (field.checked) all[id] = true;
    } else if (field.value.trim() !== "") {
      const text = field.value.trim();
      const isList = id === "names" || id === "baseline";
      all[id] = isList ? text.split(",").map((own) => own.trim()) : field.type === "number" ? Number(text) : text;
    }
  }
  if (state.parts) Object.assign(all, parts());
  if (state.files.length < 2) delete all.per_file;
  return all;
}

// Only roles that differ from the reader's own become options.
function parts() {
  const own = {};
  const chosen = state.parts;
  for (const part of ["time", "input", "output"]) {
    const column = chosen.find((one) => one.part === part);
    if (column && column.guess !== part) own[part] = column.name;
  }
  const channels = chosen.filter((one) => one.part === "channel" && (one.guess !== "channel" || one.channel !== one.guessed));
  if (channels.length) own.channels = channels.map((one) => [one.channel.trim(), one.name]);
  return own;
}

// ---- files --------------------------------------------------------------------------------------

async function add(list) {
  const read = await Promise.all([...list].map(async (file) => ({ name: file.name, bytes: await file.arrayBuffer() })));
  if (!read.length) return;
  state.files = state.files.filter((file) => !file.isExample && read.every((own) => own.name !== file.name)).concat(read);
  await begin();
}

async function begin() {
  state.parts = null;
  state.looks.clear();
  hide("result-part", "progress-part");
  await look();
}

function remove(file) {
  state.files = state.files.filter((own) => own !== file);
  begin();
}

function hide(...ids) {
  for (const id of ids) at(id).hidden = true;
}

// Reads every file with the current options; only the last call counts.
async function look() {
  const turn = ++state.turn;
  const chosen = choices();
  listFiles();
  try {
    for (const file of state.files) {
      const found = await engine.ask({ ask: "look", file: file.name, choices: reading(chosen) }, { files: [file] });
      if (turn !== state.turn) return;
      state.looks.set(file, found);
    }
    at("refusal").replaceChildren();
    show();
    state.answered = turn;
  } catch (error) {
    if (turn === state.turn && !(error instanceof Cancelled)) refuse(error.message);
  }
}

// The reader's options, without those of the search.
function reading(chosen) {
  const { baseline, max_terms, invertible, per_file, ...rest } = chosen;
  return rest;
}

function listFiles() {
  const items = state.files.map((file) => {
    const found = state.looks.get(file);
    const said = found?.refusal ? "not read" : found?.samples ? `${found.samples} samples, ${digits(found.duration)} s, ${digits(found.rate)} Hz, ${found.mode}` : "reading …";
    const name = file.isExample ? "built-in synthetic record" : file.name;
    return element("li", { class: found?.refusal ? "bad" : null },
      element("span", { class: "name" }, name), " ", element("span", { class: "note" }, said), " ",
      element("button", { type: "button", "aria-label": `Remove ${name}`, onclick: () => remove(file) }, "Remove"));
  });
  at("list").replaceChildren(...items);
}

function refuse(line) {
  at("refusal").replaceChildren(element("p", { class: "refusal" }, line));
}

// ---- columns ------------------------------------------------------------------------------------

// Shows the reader's answers, with the current roles.
function show() {
  listFiles();
  const looks = state.files.map((file) => state.looks.get(file)).filter(Boolean);
  const first = looks.find((own) => own.columns);
  const refused = looks.find((own) => own.refusal);
  at("columns-part").hidden = !first;
  at("per-file-part").hidden = state.files.length < 2;
  at("refusal").replaceChildren(...(refused ? refusal(refused) : []));
  if (!first) return;
  guess(first);
  const names = { time: "time", input: "input", output: "output" };
  const missing = Object.keys(names).filter((part) => !state.parts.some((own) => own.part === part));
  at("columns-note").textContent = missing.length
    ? `Choose the column for the ${missing.join(" and for the ")}.`
    : "The roles below follow from the column names. To change a role, choose another one.";
  const focus = document.activeElement?.id;
  at("columns").replaceChildren(...first.columns.map((column, index) => card(column, index, refused?.refusal?.column)));
  if (focus?.startsWith("part-") || focus?.startsWith("channel-")) at(focus)?.focus();
  const notes = [...new Set(looks.flatMap((own) => own.notes ?? []))];
  const defects = looks.flatMap((own) => own.defects ?? []);
  at("notes").replaceChildren(...said("Notes on the file", notes), ...said("Measurement defects", defects.map((own) => own.message)));
  at("identify").disabled = Boolean(refused);
}

function said(title, lines) {
  if (!lines.length) return [];
  return [element("h3", {}, title), element("ul", { class: "notes" }, ...lines.map((line) => element("li", {}, line)))];
}

// The reader's roles, which apply until the user chooses others.
function guess(found) {
  if (state.parts && state.parts.length === found.columns.length) return;
  state.parts = found.columns.map((own) => ({ name: own.name, guess: own.part, guessed: own.channel, part: own.part, channel: own.channel ?? "" }));
}

function card(column, index, refused) {
  const own = state.parts[index];
  const title = column.unit ? `${column.name} [${column.unit}]` : column.name || `column ${index + 1}`;
  const choose = element("select", { id: `part-${index}`, "aria-label": `Role of ${title}`, disabled: !column.name, onchange: (event) => change(index, event.target.value) },
    ...[["", "not read"], ["time", "time"], ["input", "input"], ["output", "output"], ["channel", "channel"]].map(([value, text]) => element("option", { value, selected: (own.part ?? "") === value }, text)));
  const channel = own.part === "channel"
    ? element("input", { id: `channel-${index}`, type: "text", list: "channel-names", value: own.channel, "aria-label": `Name of the channel ${title}`, onchange: (event) => ((own.channel = event.target.value), look()) })
    : null;
  const count = column.numbers === column.rows ? `${column.rows} rows` : `${column.numbers} numbers in ${column.rows} rows`;
  const range = column.preview.filter(Boolean);
  const span = range.length ? `${digits(Math.min(...range.map((v) => v[0])))} to ${digits(Math.max(...range.map((v) => v[1])))}` : "no number";
  return element("div", { class: `card ${own.part ?? "unread"}${refused === column.name ? " refused" : ""}` },
    element("h3", {}, title), preview(column.preview, `${title} over the rows: ${span}`),
    element("p", { class: "note" }, `${span} · ${count}`), element("p", { class: "choose" }, choose, channel));
}

function change(index, part) {
  const own = state.parts[index];
  // Time, input and output have one column each.
  if (["time", "input", "output"].includes(part)) {
    for (const other of state.parts) if (other.part === part) other.part = null;
  }
  own.part = part || null;
  if (part === "channel" && !own.channel) own.channel = own.name.replace(/\s+/g, "_");
  const both = ["input", "output"].every((one) => state.parts.some((column) => column.part === one));
  show();
  if (both || part === "channel" || !part) look();
}

// The program's error line, and its place in the table.
function refusal(found) {
  const { text, line, column, lines } = found.refusal;
  const all = [element("p", { class: "refusal" }, text)];
  if (lines.length) {
    const index = (found.columns ?? []).findIndex((own) => own.name === column);
    const rows = lines.map((own) => element("tr", { class: own.number === line ? "marked" : null },
      element("th", { scope: "row" }, String(own.number)),
      ...own.cells.slice(0, 40).map((cell, k) => element("td", { class: own.number === line && k === index ? "marked" : null }, cell || " "))));
    all.push(element("div", { class: "wide", tabindex: "0", role: "region", "aria-label": "The place in the file" },
      element("table", { class: "place" }, element("caption", {}, `Line ${line} of the file${column ? `, column ${column}` : ""}`), element("tbody", {}, ...rows))));
  }
  return all;
}

// ---- the search ---------------------------------------------------------------------------------

async function identify() {
  at("refusal").replaceChildren();
  at("reached").replaceChildren();
  at("bar").value = 0;
  at("stage").textContent = "loading the program";
  hide("result-part");
  at("progress-part").hidden = false;
  at("identify").disabled = true;
  const files = state.files;
  const chosen = choices();
  try {
    const found = await engine.ask({ ask: "identify", files: files.map((file) => file.name), choices: chosen }, { files, told });
    state.result = { found, choices: chosen };
    showModels(found, files);
    at("progress-part").hidden = true;
    at("result").replaceChildren(...answer(found, "identify"));
    at("explore").replaceChildren(explore(found, shape));
    begins();
    at("report").replaceChildren(report(found, "identify"));
    at("result-part").hidden = false;
    at("result-head").focus();
    document.dispatchEvent(new CustomEvent("answered"));
  } catch (error) {
    at("progress-part").hidden = true;
    if (error instanceof Cancelled) refuse("Cancelled. The files and your choices are still here.");
    else refuse(error.message);
    at("refusal").scrollIntoView({ block: "center" });
  }
  at("identify").disabled = false;
}

function told(what, share) {
  if (what.startsWith("so far: ")) {
    at("reached").append(element("li", {}, what.slice("so far: ".length)));
    return;
  }
  at("stage").textContent = what;
  if (share !== null) at("bar").value = Math.max(share, at("bar").value);
}

// The hysteresis state along an input, with other parameters.
async function shape(parameters, input) {
  const answered = await engine.ask({ ask: "shape", parameters }, { bytes: input.slice().buffer });
  return new Float64Array(answered.files.eta.slice().buffer);
}

// With separate gains, each file has a model, and the user chooses one.
function showModels(found, files) {
  const record = (name) => files[Number(/-(\d+)\./.exec(name)?.[1] ?? 1) - 1]?.name;
  at("model").replaceChildren(...found.models.map((name) => element("option", { value: name }, `${name}: ${record(name)}`)));
  at("model-part").hidden = found.models.length < 2;
}

// Clears what belongs to another model.
function begins() {
  at("validated").replaceChildren();
  at("control").replaceChildren(...control(state.result.found, steps));
}

function chosenModel() {
  const name = at("model").value;
  return { name, bytes: state.result?.found.files[name] };
}

// What the controller part of the page needs.
const steps = {
  model: chosenModel,
  ask: (request, options) => engine.ask(request, options),
  stop: () => engine.cancel(),
  keep: (what, answered) => (state[what] = answered),
};

async function validate(file) {
  const { found, choices: chosen } = state.result ?? {};
  const { name, bytes } = chosenModel();
  if (!bytes) {
    at("validated").replaceChildren(element("p", { class: "refusal" }, `No model to validate: ${found?.no_model ?? ""}`));
    return;
  }
  at("validated").replaceChildren(element("p", { class: "note" }, "validating …"));
  const { start, end, header_line, segment, sheet, names, baseline, max_terms, invertible, per_file, ...rest } = chosen;
  try {
    const held = await engine.ask({ ask: "validate", model: name, file: file.name, choices: rest }, { files: [file], bytes: bytes.slice().buffer });
    state.validated = held;
    at("validated").replaceChildren(...answer(held, "validate"), element("details", {}, element("summary", {}, "Validation report"), report(held, "validate")));
  } catch (error) {
    at("validated").replaceChildren(element("p", { class: "refusal" }, error.message));
  }
}

// ---- events -------------------------------------------------------------------------------------

function dropOn(zone, take) {
  zone.addEventListener("dragover", (event) => {
    event.preventDefault();
    zone.classList.add("over");
  });
  zone.addEventListener("dragleave", () => zone.classList.remove("over"));
  zone.addEventListener("drop", (event) => {
    event.preventDefault();
    zone.classList.remove("over");
    take(event.dataTransfer.files);
  });
}

const second = async (list) => {
  const [file] = list;
  if (file) await validate({ name: file.name, bytes: await file.arrayBuffer() });
};

dropOn(at("drop"), add);
dropOn(at("drop-second"), second);
// Without this, a file dropped outside a zone would replace the page.
for (const kind of ["dragover", "drop"]) window.addEventListener(kind, (event) => event.preventDefault());
at("files").addEventListener("change", (event) => add(event.target.files).then(() => (event.target.value = "")));
at("second").addEventListener("change", (event) => second(event.target.files).then(() => (event.target.value = "")));
at("example").addEventListener("click", () => {
  state.files = [{ name: EXAMPLE, isExample: true }];
  begin();
});
at("identify").addEventListener("click", identify);
at("model").addEventListener("change", begins);
at("cancel").addEventListener("click", () => engine.cancel());
for (const id of ["options", "mode"]) at(id).addEventListener("change", () => state.files.length && look());
document.body.append(element("datalist", { id: "channel-names" }, ...["phi_p", "phi_d", "temperature", "load"].map((value) => element("option", { value }))));
engine.prepare().catch((error) => refuse(`The program could not be loaded: ${error.message}`));

// The state of the page, for tests and for the console.
window.bowden = { state, engine };
