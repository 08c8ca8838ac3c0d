"""Checks of safety rules: errors found when building them, and suspicious constructs."""

from __future__ import annotations

from collections.abc import Iterator

from deros.diagnostics import Diagnostic
from deros.models.rules import Rules
from deros.rules.compiler.build import BuildResult
from deros.validators.findings.context import CheckContext
from deros.validators.rules.losses.rules_failsafe import check_failsafe
from deros.validators.rules.losses.rules_noticed import noticed_of
from deros.validators.rules.losses.rules_timeouts import check_timeouts
from deros.validators.rules.losses.rules_unknown import check_unknown
from deros.validators.rules.rules_actions import check_actions, check_hidden
from deros.validators.rules.rules_beams import check_beams, check_blindness
from deros.validators.rules.rules_gates import check_gates
from deros.validators.rules.rules_heartbeat import check_input_timeouts
from deros.validators.rules.rules_ranges import check_ranges
from deros.validators.rules.rules_readings import check_readings
from deros.validators.rules.rules_releases import check_releases
from deros.validators.rules.rules_services import check_services
from deros.validators.rules.rules_signs import check_latencies, check_signs
from deros.validators.rules.rules_surprises import check_surprises
from deros.validators.rules.rules_topics import check_topics
from deros.validators.rules.rules_usage import check_usage
from deros.validators.safety.safety_wiring import check_users


def check(rules: Rules, context: CheckContext) -> Iterator[Diagnostic]:
    """Yield every finding about the rules; the system that they use is checked separately."""
    yield from check_rules(rules, context.builds.of(rules))


def check_rules(rules: Rules, result: BuildResult) -> Iterator[Diagnostic]:
    """Yield every finding about the rules, given the result of building them."""
    yield from result.diagnostics
    yield from check_usage(rules)
    yield from check_timeouts(rules)
    yield from check_topics(rules, result.topics)
    yield from check_services(rules, result.topics)
    yield from check_gates(rules, result)
    yield from check_input_timeouts(result)
    yield from check_ranges(rules, result.comparisons)
    if result.program is not None:
        noticed = noticed_of(rules, result.program)
        yield from check_unknown(rules, result.program, noticed, result.functions)
        yield from check_failsafe(rules, result.program)
        yield from check_surprises(rules, result.program, noticed, result.functions)
        yield from check_readings(rules, result.program)
        yield from check_releases(rules, result.program)
        yield from check_signs(rules, result.program, noticed.used, result.comparisons)
        yield from check_latencies(result.program, result.comparisons)
        yield from check_actions(result.program)
        yield from check_hidden(result.program)
        yield from check_beams(result.program, result.comparisons)
        yield from check_blindness(result.program, result.functions)
    yield from check_users(rules)
