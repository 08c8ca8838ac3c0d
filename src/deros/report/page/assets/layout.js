// The places of boxes and edges, found by ELK (https://eclipse.dev/elk).

const SIZES = { line: 16, pad: 10, port: 8, portGap: 14, longest: 42, title: 24 };

const ROOT_OPTIONS = {
  "elk.algorithm": "rectpacking",
  "elk.json.edgeCoords": "ROOT",
  "elk.json.shapeCoords": "ROOT",
  "elk.spacing.nodeNode": "24",
  "elk.padding": "[top=16,left=16,bottom=16,right=16]",
};

// What is connected is laid out together; the parts of the picture are then packed.
const PART_OPTIONS = {
  "elk.algorithm": "layered",
  "elk.direction": "RIGHT",
  "elk.hierarchyHandling": "INCLUDE_CHILDREN",
  "elk.edgeRouting": "ORTHOGONAL",
  "elk.layered.spacing.nodeNodeBetweenLayers": "32",
  "elk.layered.spacing.edgeEdgeBetweenLayers": "8",
  "elk.layered.spacing.edgeNodeBetweenLayers": "12",
  "elk.layered.considerModelOrder.strategy": "PREFER_EDGES",
  "elk.layered.thoroughness": "3",
  "elk.spacing.nodeNode": "18",
  "elk.spacing.edgeNode": "12",
  "elk.padding": "[top=0,left=0,bottom=0,right=0]",
};

const GROUP_OPTIONS = { "elk.padding": "[top=40,left=16,bottom=16,right=16]" };
const PROGRAM_OPTIONS = { "elk.portConstraints": "FIXED_SIDE" };

/**
 * Return a promise of the view with a place and a size for each box, and points of each edge.
 * `aspect`: the width of the picture that is wanted, relative to its height.
 */
async function laidOut(elk, view, aspect) {
  const nodes = new Map();
  for (const box of view.boxes.values()) nodes.set(box.key, elkNode(box));
  for (const box of view.boxes.values()) {
    if (box.parent !== null) (nodes.get(box.parent).children ??= []).push(nodes.get(box.key));
  }
  const children = partsOf(view).map((part, number) => elkPart(part, number, nodes));
  const layoutOptions = { ...ROOT_OPTIONS, "elk.aspectRatio": String(aspect) };
  const done = await elk.layout({ id: "root", layoutOptions, children });
  const all = done.children.flatMap((part) => part.edges ?? []);
  const sections = new Map(all.map((each) => [each.id, each.sections ?? []]));
  return {
    width: done.width,
    height: done.height,
    boxes: [...view.boxes.values()].map((box) => ({ ...box, ...placeOf(nodes.get(box.key)) })),
    edges: view.edges.map((edge) => ({ ...edge, sections: sections.get(edge.key) })),
  };
}

/** Return the connected parts of a view: the outermost boxes of each, and its edges. */
function partsOf(view) {
  const leaders = new Map();
  const topOf = (key) => {
    const { parent } = view.boxes.get(key);
    return parent === null ? key : topOf(parent);
  };
  const leaderOf = (key) => {
    const leader = leaders.get(key) ?? key;
    return leader === key ? key : leaderOf(leader);
  };
  for (const edge of view.edges) {
    const [from, to] = [leaderOf(topOf(edge.from)), leaderOf(topOf(edge.to))];
    if (from !== to) leaders.set(to, from);
  }
  const parts = new Map();
  const partOf = (key) => {
    const leader = leaderOf(topOf(key));
    if (!parts.has(leader)) parts.set(leader, { tops: [], edges: [] });
    return parts.get(leader);
  };
  for (const box of view.boxes.values()) if (box.parent === null) partOf(box.key).tops.push(box.key);
  for (const edge of view.edges) partOf(edge.from).edges.push(edge);
  return [...parts.values()];
}

/** Return a part of the picture; a box by itself is one. */
function elkPart(part, number, nodes) {
  const [first, ...others] = part.tops.map((key) => nodes.get(key));
  if (!others.length && !first.children) return first;
  return {
    id: `part ${number}`,
    layoutOptions: PART_OPTIONS,
    children: [first, ...others],
    edges: part.edges.map((edge) => elkEdge(edge, nodes)),
  };
}

function elkNode(box) {
  const lines = linesOf(box);
  const width = Math.max(...lines.map(widthOf), 40) + 2 * SIZES.pad;
  const height = lines.length * SIZES.line + SIZES.pad;
  const node = { id: box.key, width, height };
  if (box.kind === "group" && !box.isFolded) node.layoutOptions = groupOptions(width);
  if (box.kind === "program") {
    const sides = [true, false].map((feeds) => box.owner.ends.filter((e) => e.port.feeds === feeds));
    const most = Math.max(...sides.map((each) => each.length));
    node.height = Math.max(height, (most + 1) * SIZES.portGap);
    node.layoutOptions = PROGRAM_OPTIONS;
    node.ports = [];
  }
  return node;
}

function groupOptions(width) {
  const size = { "elk.nodeSize.constraints": "MINIMUM_SIZE" };
  return { ...GROUP_OPTIONS, ...size, "elk.nodeSize.minimum": `(${width}, ${SIZES.title})` };
}

function elkEdge(edge, nodes) {
  const node = nodes.get(edge.box);
  const end = edge.isGroup ? edge.box : `${edge.key} port`;
  if (!edge.isGroup) {
    const side = { "elk.port.side": edge.feeds ? "EAST" : "WEST" };
    node.ports.push({ id: end, width: SIZES.port, height: SIZES.port, layoutOptions: side });
  }
  const [from, to] = edge.feeds ? [end, edge.to] : [edge.from, end];
  return { id: edge.key, sources: [from], targets: [to] };
}

function placeOf({ x, y, width, height, ports }) {
  const places = (ports ?? []).map((port) => [port.id.slice(0, -" port".length), port]);
  return { x, y, width, height, ports: new Map(places) };
}

/** Return the lines of text in a box. */
function linesOf(box) {
  if (box.kind === "channel") {
    const { channel } = box;
    return [shortened(channel.name), shortened(typesOf(channel))];
  }
  if (box.kind === "program") {
    const { program, type } = box.owner;
    return [shortened(program.name), shortened(type)];
  }
  const { group } = box;
  const name = group.path[group.path.length - 1];
  return box.isFolded ? [shortened(name), counted(group.programs.length, "program")] : [shortened(name)];
}

function shortened(text) {
  const { longest } = SIZES;
  return text.length <= longest ? text : `${text.slice(0, longest - 12)}\u2026${text.slice(-11)}`;
}

function counted(number, word) {
  return `${number} ${word}${number === 1 ? "" : "s"}`;
}

let measure = null;

/** Return the width of a text as the picture shows it. */
function widthOf(text) {
  measure ??= Object.assign(document.createElement("canvas").getContext("2d"), {
    font: "bold 13px sans-serif",
  });
  return measure.measureText(text).width;
}
