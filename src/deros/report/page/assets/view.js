// What of a variant is drawn: subsystems that are folded stand for all that is in them.

const GROUP = "group ";

function groupKey(path) {
  return GROUP + path.join("/");
}

/** Return the key of the outermost folded subsystem around a path, or null. */
function folder(path, folded) {
  for (let depth = 1; depth <= path.length; depth += 1) {
    const key = groupKey(path.slice(0, depth));
    if (folded.has(key)) return key;
  }
  return null;
}

/** Return the subsystems around the programs of a variant by key, outer ones first. */
function groupsOf(contents, variant) {
  const described = new Map(contents.groups.map((each) => [groupKey(each.path), each]));
  const groups = new Map();
  for (const { program } of variant.programs.values()) {
    for (let depth = 1; depth <= program.path.length; depth += 1) {
      const path = program.path.slice(0, depth);
      const key = groupKey(path);
      if (!groups.has(key)) groups.set(key, { key, path, programs: [], described: described.get(key) });
      groups.get(key).programs.push(program);
    }
  }
  return groups;
}

/**
 * Return the boxes, by key, and the edges to draw.
 * `near`: the key of a box; only it and what it is connected to are drawn. Null: everything.
 */
function viewOf(contents, variant, folded, near) {
  const groups = groupsOf(contents, variant);
  const boxes = new Map();
  const parentOf = (path) => (path.length ? groupKey(path) : null);
  for (const group of groups.values()) {
    const around = group.path.slice(0, -1);
    if (folder(around, folded)) continue;
    const isFolded = folded.has(group.key);
    boxes.set(group.key, { key: group.key, kind: "group", parent: parentOf(around), group, isFolded });
  }
  for (const owner of variant.programs.values()) {
    const { path } = owner.program;
    if (folder(path, folded)) continue;
    boxes.set(owner.key, { key: owner.key, kind: "program", parent: parentOf(path), owner });
  }
  for (const channel of variant.channels.values()) {
    if (folder(channel.home, folded)) continue;
    const parent = parentOf(channel.home);
    // A topic that only absent nodes would use may be declared in a subsystem that is not there.
    const known = parent === null || boxes.has(parent) ? parent : null;
    boxes.set(channel.key, { key: channel.key, kind: "channel", parent: known, channel });
  }
  const edges = edgesOf(variant, boxes, folded);
  const mark = markIn(contents, variant);
  for (const box of boxes.values()) {
    box.findings = findingsOf(box, contents, variant);
    box.mark = mark(box.findings);
  }
  for (const edge of edges) edge.mark = mark(edge.ends.flatMap((end) => end.port.findings));
  return near === null ? { boxes, edges } : nearOnly(boxes, edges, near);
}

/** Return the edges between the boxes; those of one folded subsystem to one channel are one. */
function edgesOf(variant, boxes, folded) {
  const edges = new Map();
  for (const channel of variant.channels.values()) {
    if (!boxes.has(channel.key)) continue;
    channel.ends.forEach((end, number) => {
      const group = folder(end.owner.program.path, folded);
      const box = group ?? end.owner.key;
      const key = `${channel.key} ${end.port.feeds ? "<" : ">"} ${group ?? `${box} ${number}`}`;
      if (!edges.has(key)) {
        const [from, to] = end.port.feeds ? [box, channel.key] : [channel.key, box];
        edges.set(key, { key, from, to, box, feeds: end.port.feeds, isGroup: group !== null, ends: [] });
      }
      edges.get(key).ends.push(end);
    });
  }
  return [...edges.values()];
}

/** Return what marks a part with findings: "faulty", or "elsewhere" if none is of this variant. */
function markIn(contents, variant) {
  const isHere = (number) => isFoundIn(variant, contents.findings[number]);
  return (numbers) => (numbers.length === 0 ? "" : numbers.some(isHere) ? "faulty" : "elsewhere");
}

/** Return the positions of the findings that a box shows, without repeats. */
function findingsOf(box, contents, variant) {
  const found = new Set();
  const add = (positions) => positions.forEach((each) => found.add(each));
  if (box.kind === "channel") {
    box.channel.topics.forEach((each) => add(each.findings));
  } else if (box.kind === "program") {
    addOfProgram(box.owner.program, add);
  } else {
    if (box.group.described) add(box.group.described.findings);
    if (box.isFolded) addInside(box.group, contents, variant, add);
  }
  return [...found].sort((one, other) => one - other);
}

function addOfProgram(program, add) {
  add(program.findings);
  program.ports.forEach((port) => add(port.findings));
}

function addInside(group, contents, variant, add) {
  const isInside = (path) => group.path.every((name, place) => path[place] === name);
  group.programs.forEach((each) => addOfProgram(each, add));
  contents.groups.filter((each) => isInside(each.path)).forEach((each) => add(each.findings));
  for (const channel of variant.channels.values()) {
    if (isInside(channel.home)) channel.topics.forEach((each) => add(each.findings));
  }
}

/** Return a box, what it is connected to, and the subsystems around these. */
function nearOnly(boxes, edges, near) {
  const one = new Set([near]);
  const kept = new Set([near]);
  const others = (edge) => [edge.from, edge.to];
  edges.filter((edge) => others(edge).some((each) => one.has(each))).forEach((edge) =>
    others(edge).forEach((each) => kept.add(each)),
  );
  const channels = [...kept].filter((key) => boxes.get(key)?.kind === "channel");
  edges.filter((edge) => others(edge).some((each) => channels.includes(each))).forEach((edge) =>
    others(edge).forEach((each) => kept.add(each)),
  );
  for (const key of [...kept]) {
    for (let box = boxes.get(key); box; box = boxes.get(box.parent)) kept.add(box.key);
  }
  return {
    boxes: new Map([...boxes].filter(([key]) => kept.has(key))),
    edges: edges.filter((edge) => kept.has(edge.from) && kept.has(edge.to)),
  };
}
