// Text of the summary for synthetic studies, without a browser: runs the scripts of the page with a minimal document.
// Argument: folder of the scripts.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import vm from "node:vm";

class Node {
  constructor() {
    this.children = [];
  }
  append(...children) {
    this.children.push(...children);
  }
  get textContent() {
    return this.children.map((child) => child.textContent ?? child).join("");
  }
}
const scripts = ["text", "summary", "overview"].map((name) =>
  readFileSync(path.join(process.argv[2], name + ".js"), "utf8"),
);
const exported = "({ boundAt, rowLabel, cards, nextSentence, activeSentence, shellWord, designTable })";
const page = vm.runInNewContext([...scripts, exported].join("\n"), { document: { createElement: () => new Node() } });
const text = (parts) => [parts].flat().map((part) => part.textContent ?? part).join("");

// Variables at their bounds; a baseline may be outside.
const bounds = { lower: 0.1, upper: 0.3 };
const marks = [0.05, 0.1, 0.2, 0.3, 0.4].map((value) => page.boundAt(value, bounds));
assert.deepEqual(marks, ["below min", "min", "", "max", "above max"]);

// Volume by cells next to the exact volume; number of evaluations.
const row = (name, kind = "objective") => ({ kind, name, unit: "m^3", values: [0.17, 0.08], meaning: "" });
const table = (rows) => ({ columns: [{ name: "best" }, { name: "baseline" }], rows });
const both = [row("workspace-volume"), row("workspace-volume, exact")];
assert.equal(page.rowLabel(both[0], both), "workspace-volume, by cells");
assert.equal(page.rowLabel(both[1], both), "workspace-volume, exact");
assert.equal(page.rowLabel(row("workspace-volume"), [row("workspace-volume")]), "workspace-volume");
const study = (more = {}, problem = {}) => ({
  file: "-s.h5",
  problem: { objectives: [{ name: "workspace-volume", unit: "m^3" }], variables: [], parameters: [], ...problem },
  summary: {
    table: table(both),
    evaluations: 420,
    stages: [{ optimiser: "ga", starts: 0 }],
    state: "finished",
    active: [],
    optimality: null,
    origin: { seed: "1", toml_file: "s.toml" },
    ...more,
  },
});
const cards = text(page.cards(study()));
assert.ok(cards.includes("evaluations420in 1 stage: ga"), cards);
assert.ok(cards.includes("workspace-volume, by cells") && cards.includes("workspace-volume, exact"), cards);
assert.ok(text(page.designTable(table(both), [])).includes("workspace-volume, by cells"));

// A gradient stage is suggested only if the study supports gradients.
const active = { active: ["limbs is active, margin 1e-5 m"] };
assert.match(text(page.nextSentence(study())), /Add a gradient stage/);
assert.match(text(page.activeSentence(study(active))), /An nlopt or ipopt stage/);
const unsupported = { gradients_unsupported: "voxels have no derivatives" };
assert.doesNotMatch(text(page.nextSentence(study({}, unsupported))), /stage/);
assert.doesNotMatch(text(page.activeSentence(study(active, unsupported))), /stage/);
const front = (problem) => ({ ...study({}, { objectives: [{}, {}], ...problem }), front: {} });
assert.match(text(page.nextSentence(front())), /Refine the Pareto front with a stage .*nlopt/);
assert.doesNotMatch(text(page.nextSentence(front(unsupported))), /stage/);

// Commands are quoted for any file name.
assert.equal(text(page.nextSentence(study({ state: "interrupted" }))), "Finish the study: pkmopt resume ./-s.h5.");
assert.equal(page.shellWord("it's"), "'it'\\''s'");
console.log("the text of the summary is correct");
