// What part of the picture is seen: zoom and pan by wheel, pointer, keys and buttons.

const ZOOM = { step: 1.25, wheel: 1.0015, least: 0.02, most: 4 };

/** Return functions that move what the picture shows. */
function viewportOf(picture) {
  let size = { width: 1, height: 1 };
  let seen = { x: 0, y: 0, width: 1, height: 1 };

  const show = (next) => {
    seen = next;
    picture.setAttribute("viewBox", `${seen.x} ${seen.y} ${seen.width} ${seen.height}`);
  };
  const fit = () => {
    const { clientWidth, clientHeight } = picture;
    const scale = Math.min(clientWidth / size.width, clientHeight / size.height, 1) || 1;
    const [width, height] = [clientWidth / scale || 1, clientHeight / scale || 1];
    show({ x: (size.width - width) / 2, y: (size.height - height) / 2, width, height });
  };
  const zoom = (factor, place = { x: 0.5, y: 0.5 }) => {
    const scale = picture.clientWidth / (seen.width / factor);
    if (scale < ZOOM.least || scale > ZOOM.most) return;
    const [width, height] = [seen.width / factor, seen.height / factor];
    const x = seen.x + (seen.width - width) * place.x;
    show({ x, y: seen.y + (seen.height - height) * place.y, width, height });
  };
  const pan = (x, y) => {
    const scale = seen.width / picture.clientWidth;
    show({ ...seen, x: seen.x - x * scale, y: seen.y - y * scale });
  };
  const centre = (box) => {
    const scale = Math.max(0.8, picture.clientWidth / seen.width);
    const [width, height] = [picture.clientWidth / scale, picture.clientHeight / scale];
    const [x, y] = [box.x + box.width / 2 - width / 2, box.y + box.height / 2 - height / 2];
    show({ x, y, width, height });
  };
  /** Keep a box at the place of the screen where another one was. */
  const keep = (before, after) =>
    show({ ...seen, x: seen.x + after.x - before.x, y: seen.y + after.y - before.y });
  /** Show all of a box, if a part of it is outside. */
  const reveal = (box) => {
    const right = box.x + box.width <= seen.x + seen.width;
    const low = box.y + box.height <= seen.y + seen.height;
    if (box.x >= seen.x && box.y >= seen.y && right && low) return;
    const wide = Math.max(seen.width, box.width * 1.05, (box.height * 1.05 * seen.width) / seen.height);
    const height = (wide * seen.height) / seen.width;
    show({ x: box.x + (box.width - wide) / 2, y: box.y + (box.height - height) / 2, width: wide, height });
  };
  const aspect = () => picture.clientWidth / (picture.clientHeight || 1);

  listen(picture, { zoom, pan, fit });
  return { fit, zoom, centre, keep, reveal, aspect, resized: (next) => (size = next) };
}

const KEYS = {
  "+": ({ zoom }) => zoom(ZOOM.step),
  "=": ({ zoom }) => zoom(ZOOM.step),
  "-": ({ zoom }) => zoom(1 / ZOOM.step),
  0: ({ fit }) => fit(),
  ArrowLeft: ({ pan }) => pan(60, 0),
  ArrowRight: ({ pan }) => pan(-60, 0),
  ArrowUp: ({ pan }) => pan(0, 60),
  ArrowDown: ({ pan }) => pan(0, -60),
};

const DRAGGED = 4; // pixels, from which on it is no click

function listen(picture, moves) {
  let last = null;
  let way = 0;
  picture.addEventListener("pointerdown", (event) => {
    last = { x: event.clientX, y: event.clientY };
    way = 0;
  });
  window.addEventListener("pointerup", () => (last = null));
  window.addEventListener("pointermove", (event) => {
    if (last === null) return;
    const [x, y] = [event.clientX - last.x, event.clientY - last.y];
    way += Math.hypot(x, y);
    moves.pan(x, y);
    last = { x: event.clientX, y: event.clientY };
  });
  const stopAfterDrag = (event) => {
    if (way > DRAGGED) event.stopPropagation();
    way = 0;
  };
  picture.addEventListener("click", stopAfterDrag, { capture: true });
  picture.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const frame = picture.getBoundingClientRect();
      const x = (event.clientX - frame.left) / frame.width;
      moves.zoom(ZOOM.wheel ** -event.deltaY, { x, y: (event.clientY - frame.top) / frame.height });
    },
    { passive: false },
  );
  picture.addEventListener("keydown", (event) => {
    if (!(event.key in KEYS) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    KEYS[event.key](moves);
  });
}
