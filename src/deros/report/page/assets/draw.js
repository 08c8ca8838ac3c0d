// The picture: boxes and edges at the places that ELK found.

/** Draw a view; `act` has what a click on a box and on the sign of a subsystem does. */
function draw(picture, placed, act) {
  const isOpen = (box) => box.kind === "group" && !box.isFolded;
  const open = placed.boxes.filter(isOpen).map((box) => drawnBox(box, act));
  const edges = placed.edges.map((edge) => drawnEdge(edge));
  const others = placed.boxes.filter((box) => !isOpen(box)).map((box) => drawnBox(box, act));
  picture.replaceChildren(arrowHeads(), ...open, ...edges, ...others);
}

const HEAD = { orient: "auto", markerUnits: "userSpaceOnUse" };

function arrowHeads() {
  const heads = ["arrow", "arrow-red"].map((id) =>
    svg(
      "marker",
      { id, viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 9, markerHeight: 9, ...HEAD },
      svg("path", { d: "M0,0 L8,4 L0,8 z", class: id }),
    ),
  );
  return svg("defs", {}, ...heads);
}

function drawnBox(box, act) {
  const { x, y, width, height } = box;
  const classes = [box.kind, kindOfBox(box), box.mark, box.isFolded ? "folded" : ""];
  const element = svg(
    "g",
    {
      class: classes.filter(Boolean).join(" "),
      "data-key": box.key,
      tabindex: 0,
      role: "button",
      "aria-label": spoken(box),
      transform: `translate(${x},${y})`,
      onclick: (event) => act.select(box, event),
      onkeydown: (event) => {
        if (event.key === "Enter" || event.key === " ") act.select(box, event);
      },
      ondblclick: (event) => act.toggle(box, event),
      onpointerenter: (event) => act.hover(box, event),
      onpointerleave: () => act.leave(),
      onfocus: (event) => act.hover(box, event),
      onblur: () => act.leave(),
    },
    svg("rect", { width, height, rx: box.kind === "channel" ? Math.min(height / 2, 18) : 4 }),
    ...drawnLines(box),
    ...[...box.ports].map(([, port]) => drawnPort(port, box)),
  );
  if (box.kind === "group") element.append(foldSign(box, act));
  if (box.mark) element.append(badge(box));
  return element;
}

function kindOfBox(box) {
  if (box.kind === "program") return box.owner.program.kind;
  return box.kind === "channel" ? box.channel.kind : "";
}

function drawnLines(box) {
  const isOpen = box.kind === "group" && !box.isFolded;
  const lines = linesOf(box);
  const top = isOpen ? 18 : (box.height - lines.length * SIZES.line) / 2 + 12;
  return lines.map((line, number) =>
    svg(
      "text",
      {
        x: isOpen ? 28 : box.width / 2,
        y: top + number * SIZES.line,
        class: number ? "type" : "name",
        "text-anchor": isOpen ? "start" : "middle",
      },
      line,
    ),
  );
}

function drawnPort(port, box) {
  const { x, y } = { x: port.x - box.x, y: port.y - box.y };
  return svg("rect", { x, y, width: port.width, height: port.height, class: "port" });
}

/** Return the sign that folds or unfolds a subsystem. */
function foldSign(box, act) {
  const corner = box.isFolded ? { x: box.width - 14, y: 4 } : { x: 8, y: 8 };
  return svg(
    "g",
    {
      class: "sign",
      role: "button",
      tabindex: 0,
      "aria-expanded": String(!box.isFolded),
      "aria-label": `${box.isFolded ? "Unfold" : "Fold"} ${box.group.path.join("/")}`,
      transform: `translate(${corner.x},${corner.y})`,
      onclick: (event) => act.toggle(box, event),
      onkeydown: (event) => {
        if (event.key === "Enter" || event.key === " ") act.toggle(box, event);
      },
    },
    svg("rect", { width: 12, height: 12 }),
    svg("path", { d: box.isFolded ? "M2,6 H10 M6,2 V10" : "M2,6 H10" }),
  );
}

function badge(box) {
  const number = box.findings.length;
  return svg(
    "g",
    { class: "badge", transform: `translate(${box.width},0)`, "aria-hidden": "true" },
    svg("circle", { r: 9 }),
    svg("text", { y: 4, "text-anchor": "middle" }, number > 99 ? "99+" : String(number)),
  );
}

function drawnEdge(edge) {
  const unwired = edge.ends.every((end) => !end.port.wired);
  const classes = ["edge", edge.mark, unwired ? "unwired" : ""].filter(Boolean);
  const directed = edge.ends.some((end) => end.port.directed);
  const head = directed && `url(#${edge.mark === "faulty" ? "arrow-red" : "arrow"})`;
  return svg(
    "g",
    { class: classes.join(" "), "data-from": edge.from, "data-to": edge.to, "data-ends": edge.ends.length },
    ...edge.sections.map((section) => svg("path", { d: pathOf(section), "marker-end": head })),
  );
}

/** Return the path of a section: straight lines with rounded corners. */
function pathOf({ startPoint, endPoint, bendPoints = [] }) {
  const at = ({ x, y }) => `${x.toFixed(1)},${y.toFixed(1)}`;
  const points = [startPoint, ...bendPoints, endPoint];
  const pieces = bendPoints.map((bend, number) => {
    const [before, after] = [points[number], points[number + 2]];
    return `L${at(towards(bend, before))} Q${at(bend)} ${at(towards(bend, after))}`;
  });
  return [`M${at(startPoint)}`, ...pieces, `L${at(endPoint)}`].join(" ");
}

/** Return the point near a corner on the way to another point. */
function towards(corner, other) {
  const [x, y] = [other.x - corner.x, other.y - corner.y];
  const length = Math.hypot(x, y);
  const share = length ? Math.min(6, length / 2) / length : 0;
  return { x: corner.x + x * share, y: corner.y + y * share };
}
