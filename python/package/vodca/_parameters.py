"""Every parameter of the method: what it is, its unit, what is allowed, and its value in a run.

`Parameters` (the keywords, one by one) is in `_keywords.py`, which is made of the same table as docs/PARAMETERS.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from . import _native
from ._keywords import Parameters

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["Parameter", "Parameters", "documented", "effective_parameters", "parameters"]

T = TypeVar("T")


class Parameter(NamedTuple):
    """What is known about one parameter."""

    key: str
    value: float | int | bool | str
    unit: str
    allowed: str
    source: str
    effect: str


class _Table(list[Parameter]):
    """All parameters; prints as a table."""

    def __repr__(self) -> str:
        rows = [("parameter", "value", "unit", "allowed", "effect")]
        rows += [(p.key, str(p.value), p.unit, p.allowed, p.effect) for p in self]
        widths = [max(len(row[column]) for row in rows) for column in range(4)]
        return "\n".join("  ".join([*map(str.ljust, row[:4], widths), row[4]]) for row in rows)

    def _repr_html_(self) -> str:
        from html import escape

        cells = ("".join(f"<td>{escape(str(value))}</td>" for value in parameter) for parameter in self)
        head = "".join(f"<th>{field}</th>" for field in Parameter._fields)
        return f"<table><tr>{head}</tr>{''.join(f'<tr>{row}</tr>' for row in cells)}</table>"


def parameters(profile: str = "safe") -> list[Parameter]:
    """Every parameter with its value in `profile` ("safe", "paper", "orca", "orca-rh"), unit, range, source and effect."""
    return _Table(Parameter(*row) for row in _native.parameters(profile))


def effective_parameters(
    scenario: Any, *, profile: str = "safe", params: Mapping[str, Any] | None = None, **keywords: Unpack[Parameters]
) -> dict[str, float | int | bool | str]:
    """The parameters of a run of `scenario`, by key: those of the profile, overlaid by the scenario's, by what is given."""
    return _native.effective(scenario, profile=profile, params=params, **keywords)


def keyword(key: str) -> str:
    """`vodca.turn` as a keyword: `vodca_turn`."""
    return key.replace(".", "_")


def documented(target: T) -> T:
    """Adds every parameter to the docstring of `target`."""
    lines = [f"    {keyword(p.key)}: {p.effect} ({p.allowed}{'' if p.unit == '-' else ', ' + p.unit})" for p in parameters()]
    text = "\n".join(["", "", "Parameters of the method (profile, scenario and these, the later wins):", *lines, ""])
    target.__doc__ = (target.__doc__ or "") + text
    return target
