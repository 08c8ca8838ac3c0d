// Small helpers to make elements. All texts of the system come into the page as text nodes.

const SVG = "http://www.w3.org/2000/svg";

/** Return an SVG element with attributes and children. */
function svg(name, attributes = {}, ...children) {
  return filled(document.createElementNS(SVG, name), attributes, children);
}

/** Return an HTML element; a property that starts with "on" is a listener. */
function html(name, attributes = {}, ...children) {
  return filled(document.createElement(name), attributes, children);
}

function filled(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value !== null) element.setAttribute(name, String(value));
  }
  element.append(...children.filter((each) => each !== null));
  return element;
}

function byId(id) {
  return document.getElementById(id);
}
