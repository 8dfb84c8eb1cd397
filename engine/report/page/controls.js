// Input controls: slider, drop-down list, group of buttons. Each is an object { node, value } and calls changed(value)
// when the user changes its value.

/**
 * A slider over the integers 0 .. count - 1.
 * @param text  text(i) is displayed for the value i
 */
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
      showText();
    },
  };
  const showText = () => {
    shown.textContent = text(control.value);
    input.setAttribute("aria-valuetext", shown.textContent);
  };
  input.addEventListener("input", () => {
    changed(control.value);
    showText();
  });
  parent.append(control.node);
  return control;
}

/** A drop-down list; the value is the index of the selected option. */
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

/** A row of buttons of which one is pressed; the value is its index. */
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
