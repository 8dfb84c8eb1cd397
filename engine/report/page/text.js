// Formats numbers, units and names for display. Text from study files is untrusted: it must be inserted into the page
// as textContent, and into Plotly labels through label(), because Plotly interprets some HTML and templates.

/** Escapes text for Plotly. */
function label(text) {
  const entities = { "&": "&amp;", "<": "&lt;", ">": "&gt;", "%": "&#37;" };
  return String(text).replace(/[&<>%]/g, (c) => entities[c]);
}

/** Up to `count` significant digits, without trailing zeros; "–" for missing values. */
function digits(value, count = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const text = Number(value.toPrecision(count));
  const size = Math.abs(text);
  const plain = size !== 0 && (size < 1e-4 || size >= 1e9) ? text.toExponential() : String(text);
  return plain.replace("e+", "e").replace(/^-/, "−").replace("e-", "e−");
}

function unitText(unit) {
  return unit === "1" || !unit ? "" : unit.replace(/\^2/g, "²").replace(/\^3/g, "³").replace(/ /g, " ");
}

/** Display unit of an SI unit: mm and deg. Files and commands use SI. */
function shownUnit(unit) {
  return { m: "mm", rad: "deg" }[unit] ?? unit;
}
function shownScale(unit) {
  return { m: 1000, rad: 180 / Math.PI }[unit] ?? 1;
}
/**
 * Display unit of objectives and outputs. Here rad is not converted, because it is seldom an angle: a workspace ratio
 * over x, z and theta, for example, has this unit.
 */
function resultUnit(unit) {
  return unit === "rad" ? { unit, scale: 1 } : { unit: shownUnit(unit), scale: shownScale(unit) };
}

/** An SI value in its display unit. */
function shownQuantity(value, unit, count) {
  return quantity(value === null ? null : value * shownScale(unit), shownUnit(unit), count);
}

/** Text that shows the unrounded SI value on hover. */
function rounded(text, value, unit) {
  const node = element("span", "", text);
  if (Number.isFinite(value)) node.title = String(value) + (unitText(unit) ? " " + unitText(unit) : "");
  return node;
}
/** A length, angle or margin. */
function measured(value, unit, count) {
  return rounded(shownQuantity(value, unit, count), value, unit);
}
/** The name that the value of a variable selects from a catalogue; undefined if the variable is a number. */
function choiceName(value, variable) {
  return variable?.choices?.[Math.round(value) - 1];
}
/** A value of an objective or output. */
function result(value, unit) {
  const shown = resultUnit(unit);
  return rounded(quantity(value === null ? null : value * shown.scale, shown.unit), value, unit);
}

function quantity(value, unit, count) {
  const name = unitText(unit);
  return digits(value, count) + (name ? " " + name : "");
}

/** Axis title "x [m]". */
function axisName(name, unit) {
  const text = unitText(unit);
  return label(name) + (text ? " [" + label(text) + "]" : "");
}

function duration(seconds) {
  if (seconds === null || seconds === undefined) return "–";
  if (seconds < 1e-3) return digits(1e6 * seconds, 3) + " µs";
  if (seconds < 1) return digits(1e3 * seconds, 3) + " ms";
  if (seconds < 120) return digits(seconds, 3) + " s";
  const minutes = Math.floor(seconds / 60);
  if (minutes < 120) return minutes + " min " + Math.round(seconds - 60 * minutes) + " s";
  return Math.floor(minutes / 60) + " h " + (minutes % 60) + " min";
}

/** A number with a noun: "1 design", "2 designs". */
function count(number, one, many = one + "s") {
  return number.toLocaleString("en-GB") + " " + (number === 1 ? one : many);
}

function ordinal(number) {
  const tens = number % 100,
    ones = number % 10;
  return number + (tens > 10 && tens < 14 ? "th" : ones === 1 ? "st" : ones === 2 ? "nd" : ones === 3 ? "rd" : "th");
}

/** Creates an element with CSS classes and children; strings become text nodes. */
function element(name, classes = "", ...children) {
  const node = document.createElement(name);
  if (classes) node.className = classes;
  node.append(...children.filter((child) => child !== null && child !== undefined && child !== ""));
  return node;
}
