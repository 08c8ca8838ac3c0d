// Search by name, type or topic.

const MOST_MATCHES = 20;

/** Return what a text is found in: boxes that are there, also inside of folded subsystems. */
function matchesOf(text, page) {
  const wanted = text.trim().toLowerCase();
  if (!wanted) return [];
  const candidates = [
    ...[...page.variant.programs.values()].map((each) =>
      ({ key: each.key, name: each.name, kind: each.program.kind, type: each.type })),
    ...[...page.variant.channels.values()].map((each) =>
      ({ key: each.key, name: each.name, kind: each.kind, type: typesOf(each) })),
    ...[...groupsOf(page.contents, page.variant).values()].map((each) =>
      ({ key: each.key, name: each.path.join("/"), kind: "subsystem", type: each.described?.system ?? "" })),
  ];
  const rank = ({ name, type }) => {
    const last = name.toLowerCase().split("/").pop();
    if (last === wanted || name.toLowerCase() === wanted) return 0;
    if (last.startsWith(wanted)) return 1;
    if (name.toLowerCase().includes(wanted)) return 2;
    return type.toLowerCase().includes(wanted) ? 3 : 4;
  };
  const ranked = candidates.map((each) => [rank(each), each]).filter(([place]) => place < 4);
  return ranked.sort(([one], [other]) => one - other).map(([, each]) => each);
}

function startSearch(input, list, page) {
  const close = () => {
    list.hidden = true;
    list.replaceChildren();
  };
  const goTo = (match) => {
    close();
    page.goTo(match.key);
  };
  const refresh = () => {
    const found = matchesOf(input.value, page);
    const items = found.slice(0, MOST_MATCHES).map((match) =>
      html("li", {}, button(match.name, () => goTo(match), { class: "link" }),
        html("small", {}, ` ${match.kind} ${match.type}`)));
    const more = found.length - items.length;
    if (more > 0) items.push(html("li", {}, `and ${more} more`));
    if (input.value.trim() && !items.length) items.push(html("li", {}, "nothing found"));
    list.replaceChildren(...items);
    list.hidden = items.length === 0;
  };
  input.addEventListener("input", refresh);
  byId("search").addEventListener("keydown", (event) => {
    if (event.key === "Escape") close();
    if (event.key !== "Enter" || event.target !== input) return;
    event.preventDefault();
    const [first] = matchesOf(input.value, page);
    if (first) goTo(first);
  });
}
