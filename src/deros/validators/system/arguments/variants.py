"""Checks of a system that is computed from arguments, for every combination of their values."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace

from deros import codes
from deros.diagnostics import Code, Diagnostic, Related, Span, report
from deros.models.common import Scalar
from deros.models.system import System
from deros.systems.arguments.assignments import Space
from deros.systems.arguments.variants import Variants
from deros.systems.flat import FlatSystem
from deros.systems.groups import groups_of
from deros.systems.parameters.overrides import documents
from deros.validators.node.values import show
from deros.validators.system.arguments.declared import check_values

EVERYWHERE = frozenset(
    {
        codes.UNUSED_TOPIC,
        codes.UNUSED_IMPORT,
        codes.NO_SUBSCRIBER,
        codes.GATE_UNREAD,
        codes.NO_NODE_BELOW,
        codes.UNREAD_SECTION,
        codes.UNREAD_PARAMETER,
    }
)
"""Codes of what is no fault of a variant: it has to be so in all that have the part at all."""

_Key = tuple[Code, Span]


def in_variants(
    system: System, check: Callable[[FlatSystem], Iterable[Diagnostic]]
) -> Iterator[Diagnostic]:
    """Yield the findings of all variants of a system, each with the smallest that shows it.

    Args:
        system: as written, without faults in its arguments.
        check: yields the findings of a variant.
    """
    variants = Variants(system)
    space = variants.space
    found: dict[_Key, Diagnostic] = {}
    shown: dict[_Key, list[int]] = {}
    for number in variants.numbers:
        of_variant: dict[_Key, Diagnostic] = {}
        faults = check_values(system, space.assignment(number), variants.faults(number))
        for each in (*faults, *check(variants.flat(number))):
            of_variant.setdefault((each.code, each.span), each)
        for key, each in of_variant.items():
            found.setdefault(key, each)
            shown.setdefault(key, []).append(number)
    places = {number: places_of(variants.flat(number)) for number in variants.numbers}
    for key, each in found.items():
        without = set(variants.numbers).difference(shown[key])
        if each.code in EVERYWHERE:
            place = _place_of(each, places)
            if not any(is_there(place, places[number], places) for number in without):
                yield each
        elif not without:
            yield each
        else:
            where = _values(space, shown[key], variants.numbers)
            text = " and ".join(f"{name} = {show(value)}" for name, value in where.items())
            yield replace(each, message=f"{each.message}, where {text}", where=tuple(where.items()))
    if variants.gap is not None:
        yield _incomplete(system, variants, variants.gap.span)


def places_of(flat: FlatSystem) -> set[Span]:
    """Return the places of topics, nodes, connections, settings and files that a variant has."""
    topics = {topic.declaration.name_span for topic in flat.topics}
    nodes = {node.instance.name_span for node in flat.nodes}
    of_groups = {
        each.name_span for _, group in groups_of(flat.system) for each in group.settings.parameters
    }
    wirings = {each.span for node in flat.nodes for each in node.instance.wirings}
    files = {Span(each.source, 0, 0) for _, each in documents(flat.files)}
    return topics | nodes | wirings | of_groups | files


def _place_of(found: Diagnostic, places: Mapping[int, set[Span]]) -> Span:
    """Return the place that a finding is about: of one in a parameter file, the file."""
    file = Span(found.span.source, 0, 0)
    return file if any(file in each for each in places.values()) else found.span


def is_there(place: Span, places: set[Span], all_places: Mapping[int, set[Span]]) -> bool:
    """Return whether a variant has what stands at a place; of anything else, all have it."""
    return place in places or not any(place in each for each in all_places.values())


def _values(space: Space, shown: list[int], numbers: list[int]) -> Mapping[str, Scalar]:
    """Return the values of the arguments with which a finding is shown, and without which not."""
    first = shown[0]
    values: Mapping[str, Scalar] = space.difference(first)
    if not values:
        # It is there by default: the arguments that make it go away say what it depends on.
        others = set(numbers).difference(shown)
        apart = {each: space.difference(first, each) for each in others}
        least = min(map(len, apart.values()))
        nearest = (apart[each] for each in sorted(others) if len(apart[each]) == least)
        values = {name: value for each in nearest for name, value in each.items()}
    return values


def _incomplete(system: System, variants: Variants, cause: Span | None) -> Diagnostic:
    varied = [each for each in system.arguments if each.name in variants.space.values]
    related = [Related(each.name_span, "it varies, too") for each in varied[1:4]]
    if cause is not None:
        related = [Related(cause, "this alone depends on them in too many ways")]
    return report(
        codes.UNCHECKED_COMBINATIONS,
        f"the arguments have {variants.space.count:,} combinations, too many to tell apart: checked"
        f" are the {len(variants.numbers):,} in which the fewest differ from their defaults",
        varied[0].name_span,
        "divide what depends on so many arguments, or give them fewer values to choose from",
        tuple(related),
    )
