// The system for some values of its arguments: what is there, and what it is connected to.

/** Return a graph name: behind a doubled "/" it starts anew, "~" is the node's own name. */
function graphName(tree, values, owner = "") {
  if (typeof tree === "string") return tree;
  const name = withoutEmptyParts(tree, values).replace(/^.*\/\//, "/");
  const own = name.indexOf("/~");
  return own < 0 ? name : owner + name.slice(own + 2);
}

/** Return the text of a name: behind an empty namespace it goes on, and does not start anew. */
function withoutEmptyParts(tree, values) {
  if (tree[0] !== "text") return String(evaluate(tree, values));
  let isEmpty = false;
  let name = "";
  for (const piece of tree.slice(1)) {
    const text = typeof piece === "string" ? piece : String(evaluate(piece, values));
    name += isEmpty && name.endsWith("/") && text.startsWith("/") ? text.slice(1) : text;
    isEmpty = text === "";
  }
  return name;
}

/** Return the value of a setting as it is shown. */
function shown(tree, values) {
  if (Array.isArray(tree) && tree[0] === "list") {
    return `[${tree.slice(1).map((each) => shown(each, values)).join(", ")}]`;
  }
  try {
    const value = evaluate(tree, values);
    return typeof value === "number" ? shownDouble(value) : String(value);
  } catch (fault) {
    if (fault instanceof CannotEvaluate) return "?";
    throw fault;
  }
}

function shownDouble(value) {
  return Number.isInteger(value) && Math.abs(value) < 1e16 ? `${value}.0` : String(value);
}

/** Return whether a part is there; one whose condition has no value is not. */
function isThere(part, values) {
  return part.when === null || without(() => holds(part.when, values), false);
}

function without(compute, otherwise) {
  try {
    return compute();
  } catch (fault) {
    if (fault instanceof CannotEvaluate) return otherwise;
    throw fault;
  }
}

/**
 * Return the programs, by key, and the channels, by key, of the variant with these values.
 * A channel has its ends, and the declarations of its topic.
 */
function variantOf(contents, values) {
  const programs = new Map();
  const channels = new Map();
  contents.programs.forEach((program, number) => {
    if (isThere(program, values)) {
      const name = without(() => graphName(program.full_name, values), "?");
      const type = shown(program.type, values);
      programs.set(`p${number}`, { key: `p${number}`, name, type, program, ends: [] });
    }
  });
  for (const topic of contents.topics) {
    const name = isThere(topic, values) && without(() => graphName(topic.name, values), "");
    if (name) channelOf(channels, "topic", name).topics.push(topic);
  }
  for (const owner of programs.values()) {
    for (const port of owner.program.ports) {
      const name = without(() => graphName(port.to, values, owner.name), "");
      if (name) connect(channelOf(channels, port.channel, name), owner, port);
    }
  }
  for (const channel of channels.values()) channel.home = homeOf(channel);
  return { values, programs, channels };
}

function channelOf(channels, kind, name) {
  const key = `${kind} ${name}`;
  if (!channels.has(key)) channels.set(key, { key, kind, name, ends: [], topics: [] });
  return channels.get(key);
}

function connect(channel, owner, port) {
  const end = { channel, owner, port };
  channel.ends.push(end);
  owner.ends.push(end);
}

/** Return the path of the innermost subsystem that holds all ends of a channel. */
function homeOf(channel) {
  const paths = channel.ends.length
    ? channel.ends.map((each) => each.owner.program.path)
    : channel.topics.map((each) => each.path);
  return paths.reduce((one, other) => {
    const apart = one.findIndex((name, place) => name !== other[place]);
    return apart < 0 ? one : one.slice(0, apart);
  });
}

/** Return the types of a channel: the one that its topic pins, and those of its ends. */
function typesOf(channel) {
  const pinned = channel.topics.map((each) => each.type).filter(Boolean);
  const all = [...pinned, ...channel.ends.map((each) => each.port.type).filter(Boolean)];
  return [...new Set(all)].join(", ") || "unknown type";
}

/** Return whether a finding was found with the values that a variant has. */
function isFoundIn(variant, finding) {
  // eslint-disable-next-line eqeqeq -- 1n == 1 compares the numbers
  return finding.where.every(([name, value]) => variant.values.get(name) == decoded(value));
}
