// What there is to read about a box: in one line, beside the pointer, and in the panel.

/** Return what a screen reader says of a box. */
function spoken(box) {
  const marks = box.findings.length ? `, ${counted(box.findings.length, "finding")}` : "";
  return `${kindWord(box)} ${nameOf(box)}, ${summary(box)}${marks}`;
}

function kindWord(box) {
  if (box.kind === "group") return "subsystem";
  if (box.kind === "channel") return box.channel.kind;
  return { node: "node", safety: "safety node", process: "process" }[box.owner.program.kind];
}

function nameOf(box) {
  if (box.kind === "group") return box.group.path.join("/");
  return box.kind === "channel" ? box.channel.name : box.owner.name;
}

function summary(box) {
  if (box.kind === "group") return counted(box.group.programs.length, "program");
  return box.kind === "channel" ? typesOf(box.channel) : box.owner.type;
}

/** Fill the tip that stands beside the pointer. */
function fillTip(tip, box) {
  const lines = [html("strong", {}, nameOf(box)), html("div", {}, `${kindWord(box)}: ${summary(box)}`)];
  if (box.kind === "channel") lines.push(...tipOfChannel(box.channel));
  if (box.kind === "program") {
    lines.push(...box.owner.ends.map(({ port, channel }) => tipLine(port, channel.name)));
  }
  const most = 14;
  const more = lines.length > most ? [html("div", {}, `and ${lines.length - most} more`)] : [];
  tip.replaceChildren(...lines.slice(0, most), ...more);
}

function tipOfChannel(channel) {
  const pins = channel.topics.filter((each) => each.qos).map((each) => html("div", {}, `pinned: ${each.qos}`));
  return [...pins, ...channel.ends.map(({ port, owner }) => tipLine(port, owner.name))];
}

function arrowOf(port) {
  if (!port.directed) return "\u2013";
  return port.feeds ? "\u2192" : "\u2190";
}

function tipLine(port, name) {
  const arrow = arrowOf(port);
  const rest = [port.qos, ...port.units].filter(Boolean).join("; ");
  return html("div", {}, `${arrow} ${name} `, html("small", {}, rest));
}

/** Fill the panel with what is selected. */
function fillDetails(panel, box, page) {
  panel.hidden = box === null;
  if (box === null) return;
  const fill = { group: groupDetails, channel: channelDetails, program: programDetails }[box.kind];
  const lines = [
    html("h2", {}, `${kindWord(box)} ${nameOf(box)}`),
    ...box.findings.map((number) => findingLine(page.contents.findings[number])),
    ...fill(box, page),
  ];
  panel.replaceChildren(...lines.filter((each) => each !== null));
}

function legend(contents) {
  const rows = [
    ["node", "node"],
    ["safety", "node made of safety rules"],
    ["process", "other process"],
    ["topic", "topic"],
    ["service", "service or action"],
    ["faulty", "has findings"],
    ["elsewhere", "has them in another variant"],
  ];
  const known = contents.arguments.length ? rows : rows.filter(([kind]) => kind !== "elsewhere");
  return [
    html("h2", {}, "Legend"),
    html("ul", { class: "legend" }, ...known.map(([kind, text]) =>
      html("li", {}, html("span", { class: `key ${kind}` }), text))),
    html("p", {}, "Dashed arrows: ports that use their own names, because nothing connects them. ",
      "A click shows more; a double click, or the sign, folds a subsystem. ",
      "Wheel and drag move the picture, as +, \u2212, 0 and the arrow keys do."),
  ];
}

function rows(...pairs) {
  const known = pairs.filter(([, value]) => value);
  return html("dl", {}, ...known.flatMap(([name, value]) => [html("dt", {}, name), html("dd", {}, value)]));
}

function placeText({ file, line }) {
  return `${file}:${line}`;
}

function said(text) {
  return text ? html("p", { class: "said" }, text) : null;
}

function button(text, onclick, attributes = {}) {
  return html("button", { type: "button", onclick, ...attributes }, text);
}

function nearButton(box, page) {
  const isNear = page.state.near === box.key;
  const text = isNear ? "Show everything" : "Show only its neighbours";
  return button(text, () => page.setNear(isNear ? null : box.key));
}

function groupDetails(box, page) {
  const { described } = box.group;
  return [
    said(described?.description),
    rows(["system", described?.system], ["programs", String(box.group.programs.length)],
      ["written at", described && placeText(described.place)]),
    button(box.isFolded ? "Unfold" : "Fold", () => page.toggle(box)),
  ];
}

function programDetails(box, page) {
  const { program, type, ends } = box.owner;
  return [
    said(program.description),
    rows(["type", type], ["package", program.package],
      ["executable", program.executable !== type && program.executable],
      ["host", program.host],
      ["managed", program.lifecycle && "yes (lifecycle)"],
      ["written at", placeText(program.place)],
      ["described at", program.declared && placeText(program.declared)]),
    nearButton(box, page),
    ends.length ? html("h3", {}, "Ports") : null,
    ...ends.map(({ port, channel }) => endDetails(port, channel.name, channel.key, page)),
    program.parameters.length ? html("h3", {}, "Parameters") : null,
    rows(...program.parameters.map(([name, value]) => [name, shown(value, page.variant.values) || "\"\""])),
  ];
}

function channelDetails(box, page) {
  const { channel } = box;
  const declared = channel.topics.map((topic) => html("div", {}, said(topic.description), rows(
    ["pinned type", topic.type], ["pinned QoS", topic.qos], ["external", topic.external && "yes"],
    ["units", topic.units.join(", ")], ["declared at", placeText(topic.place)])));
  const side = (feeds, title) => {
    const ends = channel.ends.filter(({ port }) => port.directed && port.feeds === feeds);
    if (!ends.length) return [];
    return [html("h3", {}, title),
      ...ends.map(({ port, owner }) => endDetails(port, owner.name, owner.key, page))];
  };
  const titles = channel.kind === "topic" ? ["Publishers", "Subscriptions"] : ["Clients", "Servers"];
  return [rows(["type", typesOf(channel)]), ...declared, nearButton(box, page),
    ...side(true, titles[0]), ...side(false, titles[1]),
    ...channel.ends.filter(({ port }) => !port.directed)
      .map(({ port, owner }) => endDetails(port, owner.name, owner.key, page))];
}

/** Return an end with the way to what is at its other side. */
function endDetails(port, name, key, page) {
  const faulty = port.findings.length > 0;
  return html("div", { class: faulty ? "end faulty" : "end" },
    html("div", {}, `${port.kind} ${port.name} ${arrowOf(port)} `,
      button(name, () => page.goTo(key), { class: "link" })),
    rows(["type", port.type], ["QoS", port.qos && `${port.qos}${port.assumed ? " (assumed)" : ""}`],
      ["units", port.units.join(", ")], ["", port.description],
      ["connected at", port.wired ? placeText(port.place) : "not connected"]));
}
