// An answer: its headline, its numbers, its files, and the report page itself.

import { element } from "./dom.js";

const TYPES = { html: "text/html", csv: "text/csv", json: "application/json", toml: "application/toml" };
const LABELS = {
  "report.html": "report page",
  "model.toml": "model.toml",
  "model.rs": "model.rs (Rust)",
  "model.h": "model.h (C)",
  "model.vector.csv": "test vector",
  "gains.toml": "gains.toml",
  "gains.rs": "gains.rs (Rust)",
  "trace.csv": "trace (CSV)",
  "result.json": "result (JSON)",
  "result.txt": "result (text)",
};

// "model-2.rs" is the second file's "model.rs".
const common = (name) => name.replace(/^model-\d+/, "model");

function labelOf(name) {
  const place = /^model-(\d+)/.exec(name)?.[1];
  const text = LABELS[common(name)];
  if (!place) return text;
  return text.startsWith("model") ? text.replace("model", `model-${place}`) : `${text} ${place}`;
}

export function answer(found, kind) {
  const [first, ...more] = found.headline ?? [];
  const files = Object.keys(LABELS).flatMap((own) => Object.keys(found.files).filter((name) => common(name) === own));
  return [
    element("p", { class: "headline" }, first ?? ""),
    // The best term; the summary gives the rest in sentences.
    ...more.filter((own) => own.includes(" · ")).map((own) => element("p", { class: "term" }, own)),
    element("p", {}, found.summary),
    found.no_model ? element("p", { class: "note" }, `No model file: ${found.no_model}`) : null,
    element("h3", {}, "Download"),
    element("p", { class: "downloads" }, ...files.map((name) => download(name, found.files[name], kind))),
    element("h3", {}, "Equivalent command line"),
    command(found.command),
  ].filter(Boolean);
}

export function download(name, bytes, kind) {
  const type = TYPES[name.split(".").pop()] ?? "text/plain";
  const link = element("a", { class: "button", download: kind === "identify" || name.startsWith("gains.") ? name : `${kind}-${name}` }, labelOf(name));
  // The file stays in the tab; nothing is fetched.
  link.href = URL.createObjectURL(new Blob([bytes], { type }));
  return link;
}

export function command(line) {
  const copy = element("button", { type: "button" }, "Copy");
  copy.addEventListener("click", async () => {
    await navigator.clipboard?.writeText(line);
    copy.textContent = "Copied";
  });
  return element("div", { class: "command" }, element("pre", { tabindex: "0" }, element("code", {}, line)), copy);
}

// The program's report page, in a frame.
//
// The frame runs no scripts and is as tall as its text, so that the page scrolls as a whole.
export function report(found, kind) {
  const frame = element("iframe", { class: "report", title: `Report of bowden ${kind}`, sandbox: "allow-same-origin" });
  const fit = () => {
    const root = frame.contentDocument?.documentElement;
    if (root) frame.style.height = `${root.getBoundingClientRect().height + 24}px`;
  };
  frame.addEventListener("load", () => {
    fit();
    new ResizeObserver(fit).observe(frame);
  });
  // Links within the report would lead to this page, because its address is the base of the frame.
  const html = new TextDecoder().decode(found.files["report.html"]);
  frame.srcdoc = html.replaceAll('href="#', 'href="about:srcdoc#');
  return frame;
}
