// The list of findings, and the way from each to what it is about.

function fillFindings(list, page) {
  const { findings } = page.contents;
  const items = findings.map((finding, number) =>
    html("li", { class: `${finding.severity}${isFoundIn(page.variant, finding) ? "" : " elsewhere"}` },
      button(`${finding.code} ${finding.slug}`, () => page.showFinding(number), { class: "link" }),
      html("div", {}, finding.message),
      html("div", { class: "place" }, placeText(finding.place))));
  byId("where").hidden = page.contents.arguments.length === 0 || items.length === 0;
  list.replaceChildren(...(items.length ? items : [html("li", {}, "none")]));
}

function findingLine(finding) {
  const others = finding.others.map(([place, message]) =>
    html("div", { class: "place" }, `${placeText(place)}: ${message}`));
  return html("div", { class: `finding ${finding.severity}` },
    html("strong", {}, `${finding.severity} ${finding.code}: `), finding.message,
    html("div", { class: "place" }, placeText(finding.place)),
    finding.hint ? html("div", { class: "hint" }, finding.hint) : null,
    ...others);
}

/** Return the key of the first part that a finding is about in a variant, or null. */
function subjectOf(number, page) {
  const { variant, contents } = page;
  const isAbout = (part) => part.findings.includes(number);
  for (const channel of variant.channels.values()) {
    if (channel.topics.some(isAbout)) return channel.key;
  }
  for (const owner of variant.programs.values()) {
    if (isAbout(owner.program) || owner.program.ports.some(isAbout)) return owner.key;
  }
  const groups = [...groupsOf(contents, variant).values()];
  return groups.find((each) => each.described && isAbout(each.described))?.key ?? null;
}
