"""Robots and obstacles as Python objects; the layout that they make is `vodca.Scenario`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from . import _native


@dataclass(frozen=True)
class Robot:
    """A robot of a scenario.

    start, set_point: [x, y], m.  radius: of its disc, m; half of `model.min_separation` when left out.
    """

    start: Sequence[float]
    set_point: Sequence[float]
    radius: float | None = None
    name: str | None = None


@dataclass(frozen=True)
class Obstacle:
    """A disc at rest.

    position: [x, y] of its centre, m.  radius: m; half of `model.min_separation` when left out.
    """

    position: Sequence[float]
    radius: float | None = None
    name: str | None = None


def scenarios() -> list[str]:
    """The names of the built-in scenarios. Generated ones have names like `ring:16` and `box:16:3:7`."""
    return _native.names()
