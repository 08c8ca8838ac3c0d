"""The helper functions of verdicts in C: logic with three values, and temporal operators.

Each text holds its contract. ``@`` stands for the prefix of public types, ``$`` for that of macros.
"""

from __future__ import annotations

from collections.abc import Mapping

VERDICTS: Mapping[str, str] = {
    "truth_of": """\
/* The verdict of a condition, which is unknown unless its values are known. */
/*@ assigns \\nothing;
    ensures is_verdict(\\result);
    ensures \\result == $_TRUE <==> known != 0 && holds != 0;
    ensures \\result == $_FALSE <==> known != 0 && holds == 0; */
static @_verdict truth_of(bool known, bool holds)
{
  const @_verdict verdict = holds ? $_TRUE : $_FALSE;
  return known ? verdict : $_UNKNOWN;
}
""",
    "negated": """\
/* Kleene's negation. */
/*@ requires is_verdict(operand);
    assigns \\nothing;
    ensures is_verdict(\\result);
    ensures \\result == $_TRUE <==> operand == $_FALSE;
    ensures \\result == $_FALSE <==> operand == $_TRUE; */
static @_verdict negated(@_verdict operand)
{
  @_verdict verdict = $_UNKNOWN;
  if (operand == $_TRUE) {
    verdict = $_FALSE;
  } else if (operand == $_FALSE) {
    verdict = $_TRUE;
  } else {
    /* neither true nor false */
  }
  return verdict;
}
""",
    "both": """\
/* Kleene's conjunction: the less true of the two. */
/*@ requires is_verdict(a) && is_verdict(b);
    assigns \\nothing;
    ensures is_verdict(\\result);
    ensures \\result == $_TRUE <==> a == $_TRUE && b == $_TRUE;
    ensures \\result == $_FALSE <==> a == $_FALSE || b == $_FALSE; */
static @_verdict both(@_verdict a, @_verdict b)
{
  return (a < b) ? a : b;
}
""",
    "either": """\
/* Kleene's disjunction: the truer of the two. */
/*@ requires is_verdict(a) && is_verdict(b);
    assigns \\nothing;
    ensures is_verdict(\\result);
    ensures \\result == $_TRUE <==> a == $_TRUE || b == $_TRUE;
    ensures \\result == $_FALSE <==> a == $_FALSE && b == $_FALSE; */
static @_verdict either(@_verdict a, @_verdict b)
{
  return (a < b) ? b : a;
}
""",
    "failsafe": """\
/* A failsafe rule: unknown counts as true, unless an input has been awaited since the start. */
/*@ requires is_verdict(operand);
    assigns \\nothing;
    ensures is_verdict(\\result);
    ensures \\result == $_TRUE <==> operand == $_TRUE || (operand == $_UNKNOWN && due != 0);
    ensures \\result == $_FALSE <==> operand == $_FALSE; */
static @_verdict failsafe(@_verdict operand, bool due)
{
  return ((operand == $_UNKNOWN) && due) ? $_TRUE : operand;
}
""",
    "heard": """\
/* The cause of a 'since': one that is unknown is none before all that it reads has come. */
/*@ requires is_verdict(cause);
    assigns \\nothing;
    ensures is_verdict(\\result);
    ensures \\result == $_TRUE <==> cause == $_TRUE;
    ensures \\result == $_FALSE <==> cause == $_FALSE || (cause == $_UNKNOWN && come == 0); */
static @_verdict heard(@_verdict cause, bool come)
{
  return ((cause == $_UNKNOWN) && (!come)) ? $_FALSE : cause;
}
""",
    "lasting": """\
/* 'for': true once the operand has been true without a break for so long, since *since. */
/*@ requires \\valid(since) && \\valid(due) && \\separated(since, due);
    requires is_verdict(operand) && 0 <= now <= $_LATEST && 0 < duration <= $_LATEST;
    requires *since == $_UNSET || 0 <= *since <= now;
    assigns *since, *due;
    ensures operand != $_TRUE ==> *since == $_UNSET && \\result == operand;
    ensures operand == $_TRUE && \\old(*since) == $_UNSET ==> *since == now;
    ensures operand == $_TRUE && \\old(*since) != $_UNSET ==> *since == \\old(*since);
    ensures operand == $_TRUE && now - *since >= duration ==> \\result == $_TRUE;
    ensures operand == $_TRUE && now - *since < duration ==> \\result == $_FALSE;
    ensures operand == $_TRUE && \\old(*since) == $_UNSET
      ==> *due == \\min(\\old(*due), now + duration);
    ensures operand != $_TRUE || \\old(*since) != $_UNSET ==> *due == \\old(*due); */
static @_verdict lasting(
  @_verdict operand, int64_t duration, int64_t now, int64_t *since, int64_t *due)
{
  @_verdict verdict = operand;
  if (operand != $_TRUE) {
    *since = $_UNSET;
  } else {
    if (*since == $_UNSET) {
      *since = now;
      *due = earlier(*due, now + duration);
    }
    verdict = ((now - *since) >= duration) ? $_TRUE : $_FALSE;
  }
  return verdict;
}
""",
    "begun": """\
/* 'begins': true while the operand, true since *since, has not lasted the shortest time. */
/*@ requires is_verdict(lasts);
    requires since != $_UNSET ==> lasts == $_TRUE || lasts == $_FALSE;
    requires since == $_UNSET ==> lasts != $_TRUE;
    assigns \\nothing;
    ensures is_verdict(\\result);
    ensures \\result == $_TRUE <==> since != $_UNSET && lasts == $_FALSE;
    ensures \\result == $_UNKNOWN <==> since == $_UNSET && lasts == $_UNKNOWN; */
static @_verdict begun(@_verdict lasts, int64_t since)
{
  return (since == $_UNSET) ? lasts : negated(lasts);
}
""",
    "recent": """\
/* 'within': true while the operand is, and until *until, so long after it has ceased to be. */
/*@ requires \\valid(until) && \\valid(due) && \\separated(until, due);
    requires is_verdict(operand) && 0 <= now <= $_LATEST && 0 < duration <= $_LATEST;
    assigns *until, *due;
    ensures operand == $_TRUE ==> *until == $_NEVER;
    ensures operand != $_TRUE && \\old(*until) == $_NEVER ==> *until == now + duration;
    ensures operand != $_TRUE && \\old(*until) != $_NEVER ==> *until == \\old(*until);
    ensures \\result == (now < *until ? $_TRUE : operand);
    ensures operand != $_TRUE && \\old(*until) == $_NEVER
      ==> *due == \\min(\\old(*due), now + duration);
    ensures operand == $_TRUE || \\old(*until) != $_NEVER ==> *due == \\old(*due); */
static @_verdict recent(
  @_verdict operand, int64_t duration, int64_t now, int64_t *until, int64_t *due)
{
  if (operand == $_TRUE) {
    *until = $_NEVER;
  } else if (*until == $_NEVER) {
    *until = now + duration;
    *due = earlier(*due, *until);
  } else {
    /* it has ceased before */
  }
  return (now < *until) ? $_TRUE : operand;
}
""",
    "counted": """\
/* 'times within': true if the operand turned true so often; else unknown where the operand is. */
/*@ requires is_verdict(operand);
    assigns \\nothing;
    ensures is_verdict(\\result);
    ensures \\result == $_TRUE <==> often != 0;
    ensures \\result == $_UNKNOWN <==> often == 0 && operand == $_UNKNOWN; */
static @_verdict counted(@_verdict operand, bool often)
{
  @_verdict verdict = $_FALSE;
  if (often) {
    verdict = $_TRUE;
  } else if (operand == $_UNKNOWN) {
    verdict = $_UNKNOWN;
  } else {
    /* known, and not true as often */
  }
  return verdict;
}
""",
    "turned": """\
/* Stores a rule's verdict; returns whether it has changed. */
/*@ requires \\valid(held) && \\valid(since) && \\separated(held, since);
    assigns *held, *since;
    ensures *held == verdict;
    ensures *since == (verdict != \\old(*held) && (verdict == $_TRUE || \\old(*held) == $_TRUE)
      ? now : \\old(*since));
    ensures \\result != 0 <==> verdict != \\old(*held); */
static bool turned(@_verdict verdict, @_verdict *held, int64_t *since, int64_t now)
{
  const bool changed = (verdict != *held);
  if (changed && ((verdict == $_TRUE) || (*held == $_TRUE))) {
    *since = now;
  }
  *held = verdict;
  return changed;
}
""",
}
"""By name, each after those that it calls."""
