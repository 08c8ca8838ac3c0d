// What the trees of deros.report.page.expressions mean, as deros.systems.arguments.evaluate has it.
// Integers are BigInt and doubles Number, so that large integers stay exact.

/** A tree has no value: an argument is unknown, or its kind does not fit. */
class CannotEvaluate extends Error {}

const INTEGERS = { least: -(2n ** 63n), most: 2n ** 63n - 1n };

const CALCULATE = {
  "+": (a, b) => a + b,
  "-": (a, b) => a - b,
  "*": (a, b) => a * b,
};

const COMPARE = {
  "=": (a, b) => a == b, // eslint-disable-line eqeqeq -- 1n == 1 compares the numbers
  "!=": (a, b) => a != b, // eslint-disable-line eqeqeq
  "<": (a, b) => a < b,
  "<=": (a, b) => a <= b,
  ">": (a, b) => a > b,
  ">=": (a, b) => a >= b,
};

/** Return the value that a literal of the contents stands for. */
function decoded(literal) {
  if (literal === null || typeof literal !== "object") return literal;
  return "int" in literal ? BigInt(literal.int) : double(literal.double);
}

function double(text) {
  const special = { inf: Infinity, "-inf": -Infinity, nan: NaN };
  return text in special ? special[text] : Number(text);
}

function kindOf(value) {
  return { bigint: "integer", number: "double", string: "text", boolean: "bool" }[typeof value];
}

/** Return the value of an expression. */
function evaluate(tree, values) {
  if (!Array.isArray(tree)) return decoded(tree);
  const [word, ...operands] = tree;
  switch (word) {
    case "value":
      return decoded(operands[0]);
    case "argument":
    case "lookup":
      if (!values.has(operands[0])) throw new CannotEvaluate(`unknown argument '${operands[0]}'`);
      return values.get(operands[0]);
    case "text":
      return operands.map((each) => textOf(each, values)).join("");
    case "if":
      return chosen(...operands, values);
    case "neg":
      return inRange(-numberOf(operands[0], values));
    case "/":
      return quotient(numberOf(operands[0], values), numberOf(operands[1], values));
    default:
      return calculated(CALCULATE[word], ...operands.map((each) => numberOf(each, values)));
  }
}

/** Return the value of a choice: a double where the other value may be one. */
function chosen(condition, one, other, values) {
  const [taken, left] = holds(condition, values) ? [one, other] : [other, one];
  const value = evaluate(taken, values);
  const isDouble = typeof value === "bigint" && kindOfTree(left, values) === "double";
  return isDouble ? Number(value) : value;
}

/** Return the kind of an expression, of a choice between numbers the one that has both. */
function kindOfTree(tree, values) {
  if (!Array.isArray(tree)) return kindOf(decoded(tree));
  const [word, ...operands] = tree;
  switch (word) {
    case "value":
      return kindOf(decoded(operands[0]));
    case "argument":
    case "lookup":
      return values.has(operands[0]) ? kindOf(values.get(operands[0])) : "text";
    case "text":
      return "text";
    case "neg":
      return kindOfTree(operands[0], values);
    case "/":
      return "double";
    default: {
      const [one, other] = operands.slice(-2).map((each) => kindOfTree(each, values));
      return one === other ? one : "double";
    }
  }
}

function numberOf(tree, values) {
  const value = evaluate(tree, values);
  if (typeof value === "bigint" || typeof value === "number") return value;
  throw new CannotEvaluate(`this is a ${kindOf(value)}, not a number`);
}

function calculated(operator, left, right) {
  const whole = typeof left === "bigint" && typeof right === "bigint";
  return inRange(whole ? operator(left, right) : operator(Number(left), Number(right)));
}

function quotient(left, right) {
  if (Number(right) === 0) throw new CannotEvaluate("this divides by zero");
  const whole = typeof left === "bigint" && typeof right === "bigint";
  return inRange(whole ? wholeQuotient(left, right) : Number(left) / Number(right));
}

/** Return the double next to the exact quotient; as doubles, large integers would be rounded. */
function wholeQuotient(left, right) {
  const size = (value) => (value < 0n ? -value : value);
  const bits = 130n; // more than enough to round once, as the last one says what follows
  const scaled = size(left) << bits;
  const quotient = scaled / size(right);
  const rest = scaled % size(right) ? 1n : 0n;
  const sign = left < 0n === right < 0n ? 1 : -1;
  return sign * Number(quotient * 2n + rest) * 2 ** -Number(bits + 1n);
}

function inRange(value) {
  const fits =
    typeof value === "bigint"
      ? value >= INTEGERS.least && value <= INTEGERS.most
      : !Number.isNaN(value);
  if (!fits) throw new CannotEvaluate("number out of range");
  return value;
}

function textOf(piece, values) {
  const value = evaluate(piece, values);
  if (typeof value === "string" || typeof value === "bigint") return String(value);
  throw new CannotEvaluate(`a ${kindOf(value)} has several spellings`);
}

/** Return whether a condition holds; each operand is evaluated, so that a fault shows. */
function holds(tree, values) {
  const [word, ...operands] = tree;
  switch (word) {
    case "not":
      return !holds(operands[0], values);
    case "and":
      return operands.map((each) => holds(each, values)).every(Boolean);
    case "or":
      return operands.map((each) => holds(each, values)).some(Boolean);
    case "in":
      return isOneOf(evaluate(operands[0], values), operands.slice(1).map(decoded));
    case "holds":
      return truthOf(evaluate(operands[0], values));
    default:
      return compared(word, ...operands.map((each) => evaluate(each, values)));
  }
}

function truthOf(value) {
  if (typeof value !== "boolean") throw new CannotEvaluate(`this is a ${kindOf(value)}`);
  return value;
}

function isOneOf(value, choices) {
  return choices.map((each) => compared("=", value, each)).some(Boolean);
}

function compared(word, left, right) {
  const isNumber = (value) => typeof value === "bigint" || typeof value === "number";
  const numbers = isNumber(left) && isNumber(right);
  if (!numbers && (typeof left !== typeof right || !["=", "!="].includes(word))) {
    throw new CannotEvaluate(`a ${kindOf(left)} and a ${kindOf(right)} cannot be compared`);
  }
  return COMPARE[word](left, right);
}

/** Return the values of all arguments, given those that differ from their defaults. */
function argumentValues(contents, given) {
  const values = new Map();
  for (const { key, usual } of contents.lookups) values.set(key, given.get(key) ?? usual);
  for (const argument of contents.arguments) {
    const value = given.get(argument.name) ?? defaultOf(argument, values);
    values.set(argument.name, typed(value, argument.type));
  }
  return values;
}

function defaultOf(argument, values) {
  try {
    return evaluate(argument.default ?? argument.usual, values);
  } catch (fault) {
    if (fault instanceof CannotEvaluate) return decoded(argument.usual);
    throw fault;
  }
}

function typed(value, type) {
  return type === "double" && typeof value === "bigint" ? Number(value) : value;
}
