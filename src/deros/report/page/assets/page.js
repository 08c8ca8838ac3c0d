// The page as a whole: its state, and what changes it.

const MANY_PROGRAMS = 60; // more, and subsystems are folded at first
const MANY_BOXES = 250; // more than a picture can show, even with folded subsystems

class Page {
  constructor(contents) {
    this.contents = contents;
    this.elk = new ELK();
    this.state = { given: new Map(), folded: new Set(), near: null, selected: null };
    this.variant = variantOf(contents, argumentValues(contents, this.state.given));
    this.picture = byId("picture");
    this.viewport = viewportOf(this.picture);
    this.places = new Map();
    this.drawing = Promise.resolve();
  }

  start() {
    const { contents } = this;
    byId("title").textContent = contents.name;
    byId("title").title = contents.description;
    this.note(contents.note);
    fillFindings(byId("found"), this);
    fillSwitches(byId("switches"), byId("arguments"), this);
    startSearch(byId("wanted"), byId("matches"), this);
    byId("legend").replaceChildren(...legend(contents));
    this.startTools();
    if (this.variant.programs.size > MANY_PROGRAMS) this.state.folded = this.allGroups();
    if (this.view().boxes.size > MANY_BOXES) this.showNothing();
    this.select(null);
    this.redraw(() => this.viewport.fit());
  }

  startTools() {
    byId("fold-all").addEventListener("click", () => this.fold(this.allGroups()));
    byId("unfold-all").addEventListener("click", () => this.fold(new Set()));
    byId("zoom-in").addEventListener("click", () => this.viewport.zoom(ZOOM.step));
    byId("zoom-out").addEventListener("click", () => this.viewport.zoom(1 / ZOOM.step));
    byId("fit").addEventListener("click", () => this.viewport.fit());
    document.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.leave();
    });
    window.addEventListener("beforeprint", () => this.viewport.fit());
  }

  allGroups() {
    return new Set(groupsOf(this.contents, this.variant).keys());
  }

  view() {
    return viewOf(this.contents, this.variant, this.state.folded, this.state.near);
  }

  /** Lay the view out and draw it, after what is being drawn; then do `after` with the old places. */
  redraw(after = () => {}) {
    this.picture.setAttribute("aria-busy", "true");
    this.drawing = this.drawing.then(() => this.drawNow(after));
    return this.drawing;
  }

  async drawNow(after) {
    const before = this.places;
    const placed = await laidOut(this.elk, this.view(), this.viewport.aspect());
    this.places = new Map(placed.boxes.map((box) => [box.key, box]));
    const focused = document.activeElement?.closest?.("[data-key]")?.dataset.key;
    draw(this.picture, placed, this.actions());
    this.viewport.resized(placed);
    this.markSelected();
    this.focusOn(focused);
    after(before);
    this.picture.setAttribute("aria-busy", "false");
  }

  actions() {
    const alone = (act) => (box, event) => {
      event.preventDefault();
      event.stopPropagation();
      act(box);
    };
    return {
      select: alone((box) => this.select(box)),
      toggle: alone((box) => box.kind === "group" && this.toggle(box)),
      hover: (box, event) => this.hover(box, event),
      leave: () => this.leave(),
    };
  }

  elementOf(key) {
    return [...this.picture.querySelectorAll("[data-key]")].find((each) => each.dataset.key === key);
  }

  /** Give a box the focus, without the tip, which would hide what is around it. */
  focusOn(key) {
    this.elementOf(key)?.focus({ preventScroll: true });
    this.leave();
  }

  select(box) {
    this.state.selected = box === null ? null : box.key;
    fillDetails(byId("details"), box, this);
    this.markSelected();
  }

  markSelected() {
    const { selected } = this.state;
    for (const each of this.picture.querySelectorAll(".selected")) each.classList.remove("selected");
    if (selected === null) return;
    this.elementOf(selected)?.classList.add("selected");
    for (const edge of this.picture.querySelectorAll(".edge")) {
      const { from, to } = edge.dataset;
      edge.classList.toggle("selected", from === selected || to === selected);
    }
  }

  toggle(box) {
    const { folded } = this.state;
    if (!folded.delete(box.key)) folded.add(box.key);
    return this.redraw((before) => {
      const [old, now] = [before.get(box.key), this.places.get(box.key)];
      if (old && now) this.viewport.keep(old, now);
      if (now) this.viewport.reveal(now);
      if (this.state.selected === box.key && now) this.select(now);
    });
  }

  fold(groups) {
    this.state.folded = groups;
    this.redraw(() => this.viewport.fit());
  }

  setNear(key) {
    this.state.near = key;
    this.note(this.contents.note);
    return this.redraw(() => {
      this.select(this.places.get(this.state.selected) ?? null);
      this.viewport.fit();
    });
  }

  /** Unfold what holds a box, and show it. */
  goTo(key) {
    const path = this.pathOf(key);
    for (let depth = 1; depth <= path.length; depth += 1) {
      this.state.folded.delete(groupKey(path.slice(0, depth)));
    }
    if (this.state.near !== null) this.setNear(key);
    return this.redraw(() => {
      const box = this.places.get(key);
      if (!box) return;
      this.viewport.centre(box);
      this.select(box);
      this.focusOn(key);
    });
  }

  /** Return the path of the subsystems around what has a key. */
  pathOf(key) {
    const { programs, channels } = this.variant;
    if (programs.has(key)) return programs.get(key).program.path;
    if (channels.has(key)) return channels.get(key).home;
    return key.slice(GROUP.length).split("/").slice(0, -1);
  }

  setValues(given) {
    this.state.given = given;
    this.variant = variantOf(this.contents, argumentValues(this.contents, given));
    showSwitches(byId("arguments"), this);
    fillFindings(byId("found"), this);
    return this.redraw(() => {
      this.select(this.places.get(this.state.selected) ?? null);
      this.viewport.fit();
    });
  }

  showFinding(number) {
    const finding = this.contents.findings[number];
    if (!isFoundIn(this.variant, finding)) {
      this.setValues(new Map(finding.where.map(([name, value]) => [name, decoded(value)])));
    }
    const key = subjectOf(number, this);
    if (key !== null) return this.goTo(key);
    const elsewhere = this.isAboutSomething(number);
    const place = placeText(finding.place);
    this.say(elsewhere ? `not in this variant: ${place}` : `about no part of the picture: ${place}`);
    return this.drawing;
  }

  isAboutSomething(number) {
    const { programs, topics, groups } = this.contents;
    const ports = programs.flatMap((each) => each.ports);
    return [...programs, ...ports, ...topics, ...groups].some((part) => part.findings.includes(number));
  }

  hover(box, event) {
    const tip = byId("tip");
    fillTip(tip, box);
    tip.hidden = false;
    const frame = byId("stage").getBoundingClientRect();
    const item = event.currentTarget.getBoundingClientRect();
    const x = Math.min((event.clientX || item.left) - frame.left + 12, frame.width - tip.offsetWidth - 8);
    const below = item.bottom - frame.top + 8;
    const above = item.top - frame.top - tip.offsetHeight - 8;
    tip.style.left = `${Math.max(4, x)}px`;
    tip.style.top = `${below + tip.offsetHeight < frame.height ? below : Math.max(4, above)}px`;
  }

  leave() {
    byId("tip").hidden = true;
  }

  /** Start with the search alone: the picture would be larger than anybody can read. */
  showNothing() {
    const { size } = this.view().boxes;
    this.state.near = "";
    this.note(`All ${size} boxes would make a picture that nobody reads: search for one to see it and`
      + " its neighbours. ", button("Draw everything", () => this.setNear(null)));
  }

  note(...content) {
    byId("note").replaceChildren(...content);
    byId("note").hidden = !byId("note").textContent;
  }

  say(text) {
    byId("status").textContent = text;
  }
}

new Page(JSON.parse(byId("contents").textContent)).start();
