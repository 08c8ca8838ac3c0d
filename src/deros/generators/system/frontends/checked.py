"""What a launch file in XML or YAML refuses to start with: wrong values, and missing files."""

from __future__ import annotations

from collections.abc import Iterator

from deros.generators.system.computed import Computed
from deros.generators.system.frontends.actions import hides_arguments
from deros.generators.system.frontends.elements import Comment, Element, element, group
from deros.generators.system.frontends.grammar import escaped, template
from deros.generators.system.frontends.texts import Texts
from deros.generators.system.launch.checks import DOUBLE, INTEGER, Check, checks_of
from deros.generators.system.launch.declared import declared
from deros.generators.system.launch.needed_files import needed_files, united
from deros.generators.system.launch.overflow import overflow_checks
from deros.generators.system.launch.quoting import MISREAD, NO_TEXT, misread_texts
from deros.generators.system.launch.terms import Substitution
from deros.generators.system.view import NodeView, SystemView
from deros.models.arguments import Condition
from deros.models.node import Parameter


def argument(found: Parameter, texts: Texts) -> Element:
    """Return the declaration of an argument."""
    default, choices = declared(found)
    said = " ".join(filter(None, (found.description, found.unit and f"({found.unit})")))
    return element(
        "arg",
        *(element("choice", value=escaped(each)) for each in choices),
        name=escaped(found.name),
        default=None if default is None else texts.text(default),
        description=escaped(said) if said else None,
    )


def checked_arguments(view: SystemView, texts: Texts) -> Iterator[Comment | Element]:
    """Yield what refuses values that the arguments cannot have.

    A value comes into the expression by a variable of the environment: quotes in it end nothing.
    """
    asked = list(checks_of(view, texts.made.quoted))
    if not asked:
        return
    inside = []
    for check in asked:
        value = template((Substitution("LaunchConfiguration", ((check.name,),)),))
        inside.append(element("set_env", name="VALUE", value=value))
        inside.append(element("let", name=_result(view), value=_checked(check)))
    yield Comment("Refuse values that the arguments cannot have, before anything is started")
    yield group(*inside)


def _checked(check: Check) -> str:
    holds = check.holds.replace("INTEGER", f"r'{INTEGER}'").replace("DOUBLE", f"r'{DOUBLE}'")
    raised = _raised(f"argument {check.name}", f"it has to be {check.wanted}")
    text = f"[value := os.environ['VALUE']] and {holds} or {raised}"
    return template((Substitution("PythonExpression", ((text,), ("os,re",))),))


def checked_integers(view: SystemView, texts: Texts) -> Iterator[Comment | Element]:
    """Yield what refuses integers that are calculated and have more than 64 bits."""
    checks = [
        _let(texts.template((check,)), when, view, texts)
        for check, when in overflow_checks(view, texts.made)
    ]
    if checks:
        yield Comment("Refuse integers of more than 64 bits, before anything is started")
        yield group(*checks)


def checked_texts(view: SystemView, texts: Texts) -> Iterator[Comment | Element]:
    """Yield what refuses texts that a node would read as bools or numbers.

    ``launch_ros`` writes them without quotes, except for nodes that a container loads.
    """
    arguments = {each.name: each for each in view.arguments}
    asked = {
        (each.pieces, node.when): (node, name, each)
        for node, name, each in reversed([*misread_texts(view.nodes, arguments)])
        if isinstance(each, Computed)
    }
    inside = []
    for node, name, found in reversed(asked.values()):
        value = Element("set_env", (("name", "VALUE"), ("value", texts.text(found))))
        checked = element("let", name=_result(view), value=_as_text(node.name, name))
        inside.append(group(value, checked, condition=texts.condition(node.when)))
    if inside:
        yield Comment("Refuse texts that nodes would read as bools or numbers")
        yield from inside


def _as_text(node: str, parameter: str) -> str:
    what = f"parameter {parameter} of {node}"
    text = (
        f"[value := os.environ['VALUE']] and not (re.fullmatch(r'{MISREAD}', value, re.I)"
        f" and yaml.dump(value)[0] == value[0]) or {_raised(what, NO_TEXT)}"
    )
    return template((Substitution("PythonExpression", ((text,), ("os,re,yaml",))),))


def _raised(what: str, reason: str) -> str:
    message = f"{what} is {{value!r}}: {reason}"
    return f"exec({f'raise ValueError(f{message!r})'!r})"


def checked_files(view: SystemView, texts: Texts) -> Iterator[Comment | Element]:
    """Yield what refuses to start anything without the files that belong to it."""
    inside = [_let(each.path, each.when, view, texts) for each in needed_files(view, texts.content)]
    needs_xacro = united(e.when for e in view.programs if isinstance(e, NodeView) and e.described)
    program = template((Substitution("FindExecutable", (("xacro",),)),))
    inside += (_let(program, when, view, texts) for when in needs_xacro)
    if any(hides_arguments(each, view) for each in view.launches):
        yield Comment("Refuse to be included below set_remap, set_parameter and the like")
        around = (("global_params",), ("",)), (("ros_remaps",), ("",))
        terms = tuple(Substitution("LaunchConfiguration", each) for each in around)
        yield group(element("let", name=_result(view), value=template(terms)))
    if inside:
        yield Comment("Refuse to start anything without the files that belong to it")
        yield group(*inside)


def _let(value: str, when: Condition | None, view: SystemView, texts: Texts) -> Element:
    found = (("name", _result(view)), ("value", value))
    return Element("let", (*found, *texts.condition(when)))


def _result(view: SystemView) -> str:
    """Return what takes the result of a check, and is the name of no argument."""
    return template((f"{view.stem}.checked",))
