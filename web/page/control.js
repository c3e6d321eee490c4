// Controller gains for the identified model, and controllers on the simulated rig.

import { element } from "./dom.js";
import { Cancelled } from "./engine.js";
import { command, download, report } from "./result.js";

const GAINS = [
  ["rate", "Sampling rate [Hz]", { required: true }],
  ["delay", "Delay [s]", { required: true, "aria-describedby": "delay-note" }],
  ["noise", "Noise of the measured torque [N·m rms]", { placeholder: "0" }],
  ["drive_gain", "Torque per command unit [N·m]", { placeholder: "1" }],
];

const TRIALS = [
  ["seconds", "Length of a trial [s]", { placeholder: "60", min: 8, max: 3600 }],
  ["seeds", "Number of trials", { placeholder: "6", min: 1, max: 1000, step: 1 }],
  ["noise", "Noise of the torque sensors [N·m rms]", { placeholder: "from the gains, or 0.28" }],
];

const RIG = [
  ["drive_gain", "Torque per command unit [N·m]", { placeholder: "from the gains, or 0.6" }],
  ["motor_inertia", "Inertia of motor and pulley [kg·m²]", { placeholder: "0.2" }],
  ["motor_damping", "Friction of motor and pulley [N·m·s/rad]", { placeholder: "2.7" }],
  ["joint_inertia", "Inertia of the joint [kg·m²]", { placeholder: "0.004" }],
  ["joint_damping", "Damping of the joint [N·m·s/rad]", { placeholder: "0.5" }],
  ["load_stiffness", "Stiffness of the spring at the joint [N·m/rad]", { placeholder: "150" }],
  ["delay", "Delay of the drive [samples]", { placeholder: "1", max: 8, step: 1 }],
  ["drive_lag", "Time constant of the drive [s]", { placeholder: "0.0005" }],
  ["sensor_lag", "Time constant of the torque sensors [s]", { placeholder: "0.001" }],
];

// The two parts of the page. `model` gives name and bytes of the model, `ask` asks the engine,
// `keep` receives each answer.
export function control(found, { model, ask, stop, keep }) {
  if (!model().bytes) return [];
  if (found.mode !== "torque") {
    return [element("h3", {}, "Controller gains"), element("p", { class: "note" }, "Gains can be derived only from a model in torque mode.")];
  }
  let gains = null;
  const paper = element("option", { value: "paper" }, "those of Nguyen et al. (2018)");
  const own = element("option", { value: "own", disabled: true }, "the gains above");
  const which = element("select", { name: "gains" }, own, paper);
  which.value = "paper";
  const design = task("design", "Derive gains", async (options) => {
    const { name, bytes } = model();
    const answered = await ask({ ask: "design", model: name, options }, { bytes: bytes.slice().buffer });
    gains = answered.files["gains.toml"];
    own.disabled = false;
    which.value = "own";
    keep("designed", answered);
    return answered;
  }, () => {}, fields(GAINS));
  const compare = task("compare", "Compare", async ({ gains: chosen, noise, varying, gait, seconds, seeds, ...rig }, told) => {
    const options = { noise, varying, gait, seconds, seeds, rig };
    const files = [held(model().name, model().bytes)];
    if (chosen === "own") files.push(held("gains.toml", gains));
    const answered = await ask({ ask: "compare", model: files[0].name, gains: files[1]?.name, options }, { files, told });
    keep("compared", answered);
    return answered;
  }, stop, element("div", { class: "fields" }, element("label", {}, "Gains", which), ...TRIALS.map(number),
    tick("varying", "Move the conduit during the trials"), tick("gait", "Follow a gait, with one push-off per second")),
  element("details", {}, element("summary", {}, "Parameters of the rig"), fields(RIG)));
  return [
    element("h3", {}, "Controller gains"),
    element("p", { id: "delay-note", class: "note" }, "Gains and limits for a PI and an adaptive controller. The delay is the time from a command to its effect in the measured torque: transport, computation, drive, sensor and joint."),
    ...design,
    element("h3", {}, "Compare controllers on the simulated rig"),
    element("p", { class: "note" }, "With the gains above, the rig has your model's transmission. With the gains of Nguyen et al. (2018), your model is used only for the feed-forward."),
    ...compare,
  ];
}

function held(name, bytes) {
  return { name, bytes: bytes.slice().buffer };
}

function fields(list) {
  return element("div", { class: "fields" }, ...list.map(number));
}

function number([name, text, more]) {
  return element("label", {}, text, element("input", { name, type: "number", min: 0, step: "any", ...more }));
}

function tick(name, text) {
  return element("label", { class: "check" }, element("input", { name, type: "checkbox" }), text);
}

// The fields that the user has filled in.
function filled(form) {
  const all = {};
  for (const field of form.elements) {
    if (field.type === "checkbox" && field.checked) all[field.name] = true;
    else if (field.type === "number" && field.value !== "") all[field.name] = Number(field.value);
    else if (field.type === "select-one") all[field.name] = field.value;
  }
  return all;
}

// A form with its button, the state of its run, and its answer.
function task(kind, text, run, stop, ...inner) {
  const status = element("span", { class: "note", role: "status" });
  const cancel = element("button", { type: "button", hidden: true, onclick: stop }, "Cancel");
  const button = element("button", { type: "submit", class: "main" }, text);
  const shown = element("div", { id: `${kind}-answer` });
  const form = element("form", { id: kind }, ...inner, element("p", { class: "actions" }, button, " ", cancel, " ", status));
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    button.disabled = true;
    cancel.hidden = kind !== "compare";
    status.textContent = "running …";
    shown.replaceChildren();
    try {
      const answered = await run(filled(form), (what) => (status.textContent = `running ${what} …`));
      shown.replaceChildren(...outcome(answered, kind));
      status.textContent = answered.headline?.[0] ?? "";
    } catch (error) {
      status.textContent = error instanceof Cancelled ? "Cancelled." : "";
      if (!(error instanceof Cancelled)) shown.replaceChildren(element("p", { class: "refusal", role: "alert" }, error.message));
    }
    button.disabled = false;
    cancel.hidden = true;
  });
  return [form, shown];
}

// The program's text, its files and its report.
function outcome(answered, kind) {
  const names = Object.keys(answered.files).filter((name) => name !== "result.txt").concat("result.txt");
  const text = new TextDecoder().decode(answered.files["result.txt"]).trim();
  return [
    element("pre", { tabindex: "0", role: "region", "aria-label": `Output of bowden ${kind}` }, text),
    element("h4", {}, "Download"),
    element("p", { class: "downloads" }, ...names.map((name) => download(name, answered.files[name], kind))),
    element("h4", {}, "Equivalent command line"),
    command(answered.command),
    answered.files["report.html"] ? element("details", { open: true }, element("summary", {}, "Plots and tables"), report(answered, kind)) : null,
  ].filter(Boolean);
}
