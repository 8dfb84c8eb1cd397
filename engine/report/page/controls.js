// What the reader moves. Each gives { node, value } and calls back when its value changes.

/** A slider over the whole numbers 0 .. count - 1. @param text  what a number stands for */
function slider(parent, name, count, start, text, changed) {
  const input = element("input");
  Object.assign(input, { type: "range", min: 0, max: count - 1, step: 1, value: start });
  input.setAttribute("aria-label", name);
  input.setAttribute("aria-valuetext", text(start));
  const shown = element("output", "", text(start));
  const control = {
    node: element("label", "control slider", element("span", "label", name), input, shown),
    get value() {
      return Number(input.value);
    },
    set(value) {
      input.value = value;
      tell();
    },
  };
  const tell = () => {
    shown.textContent = text(control.value);
    input.setAttribute("aria-valuetext", shown.textContent);
  };
  input.addEventListener("input", () => {
    changed(control.value);
    tell();
  });
  parent.append(control.node);
  return control;
}

/** One of several names, as a list to choose from. */
function choice(parent, name, options, start, changed) {
  const select = element("select");
  options.forEach((option, i) => select.append(new Option(option, i, false, i === start)));
  const control = {
    node: element("label", "control", element("span", "label", name), select),
    get value() {
      return Number(select.value);
    },
  };
  select.addEventListener("change", () => changed(control.value));
  parent.append(control.node);
  return control;
}

/** One of a few names, side by side. */
function buttons(parent, name, options, start, changed) {
  const group = element("span", "switch");
  group.setAttribute("role", "group");
  group.setAttribute("aria-label", name);
  const control = { node: element("span", "control", name, group), value: start };
  options.forEach((option, i) => {
    const button = element("button", "", option);
    button.type = "button";
    button.setAttribute("aria-pressed", i === start);
    button.addEventListener("click", () => {
      control.value = i;
      [...group.children].forEach((other, k) => other.setAttribute("aria-pressed", k === i));
      changed(i);
    });
    group.append(button);
  });
  parent.append(control.node);
  return control;
}
