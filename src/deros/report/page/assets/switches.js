// The arguments of the system, as switches: the page shows the variant that they choose.

function fillSwitches(section, form, page) {
  const { contents } = page;
  section.hidden = contents.arguments.length + contents.lookups.length === 0;
  form.addEventListener("submit", (event) => event.preventDefault());
  const lookups = contents.lookups.map(lookupSwitch);
  const all = [...contents.arguments, ...lookups];
  form.replaceChildren(...all.map((each) => switchRow(each, page)),
    button("Defaults", () => page.setValues(new Map())));
  showSwitches(form, page);
}

function lookupSwitch({ key, usual }) {
  return { name: key, type: typeof usual === "boolean" ? "bool" : "string", choices: [] };
}

function switchRow(argument, page) {
  const id = `argument-${argument.name}`;
  const hints = [argument.unit && `[${argument.unit}]`, argument.limits, argument.description];
  const change = (event) => changed(event.target, argument, page);
  return html("div", { class: "switch" }, html("label", { for: id }, argument.name),
    control(argument, { id, name: argument.name, onchange: change }),
    html("small", {}, hints.filter(Boolean).join(" ")));
}

function control(argument, attributes) {
  if (argument.type === "bool") return html("input", { type: "checkbox", ...attributes });
  if (!argument.choices.length) return html("input", { type: "text", spellcheck: "false", ...attributes });
  const choices = argument.choices.map(decoded);
  return html("select", attributes, ...choices.map((value, number) =>
    html("option", { value: number }, String(value))));
}

/** Show in the switches which values the page has. */
function showSwitches(form, page) {
  for (const argument of page.contents.arguments) {
    showValue(form.elements[argument.name], argument, page.variant.values.get(argument.name));
  }
  for (const each of page.contents.lookups) {
    showValue(form.elements[each.key], lookupSwitch(each), page.variant.values.get(each.key));
  }
}

function showValue(element, argument, value) {
  element.removeAttribute("aria-invalid");
  if (argument.type === "bool") element.checked = value;
  else if (argument.choices.length) element.selectedIndex = argument.choices.map(decoded).findIndex((each) => each == value); // eslint-disable-line eqeqeq
  else element.value = String(value);
}

function changed(element, argument, page) {
  const value = enteredValue(element, argument);
  element.setAttribute("aria-invalid", String(value === null));
  if (value === null) {
    page.say(`${argument.name}: '${element.value}' is not ${article(argument.type)} ${argument.type} ${argument.limits}`);
    return;
  }
  page.setValues(new Map([...page.state.given, [argument.name, value]]));
}

function article(word) {
  return /^[aeiou]/.test(word) ? "an" : "a";
}

/** Return what has been entered as a value of the argument, or null. */
function enteredValue(element, argument) {
  if (argument.type === "bool") return element.checked;
  if (argument.choices.length) return decoded(argument.choices[element.selectedIndex]);
  if (argument.type === "string") return element.value;
  const value = argument.type === "integer" ? enteredInteger(element.value) : enteredDouble(element.value);
  return value !== null && isWithin(value, argument.bounds) ? value : null;
}

function enteredInteger(text) {
  if (!/^\s*[+-]?\d+\s*$/.test(text)) return null;
  const value = BigInt(text.trim().replace(/^\+/, ""));
  return value >= INTEGERS.least && value <= INTEGERS.most ? value : null;
}

function enteredDouble(text) {
  return text.trim() && !Number.isNaN(Number(text)) ? Number(text) : null;
}

function isWithin(value, bounds) {
  if (bounds === null) return true;
  const [lower, upper] = [decoded(bounds[0]), decoded(bounds[1])];
  const above = bounds[2] ? value >= lower : value > lower;
  return above && (bounds[3] ? value <= upper : value < upper);
}
