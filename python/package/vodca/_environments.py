"""What PettingZoo's and Gymnasium's environments have in common."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _native

FEWEST, MOST = 1, 49
"""Horizons are in between, both included."""


def actions_are_horizons(actions: str) -> bool:
    """Whether an action is a horizon itself rather than the paper's number in -1..1."""
    if actions not in ("continuous", "horizon"):
        raise _native.Error(f'actions = "{actions}" is not known; allowed: "continuous", "horizon"')
    return actions == "horizon"


def team_rewards(rewards: str) -> str:
    """What a team earns, as the extension calls it."""
    if rewards not in ("paper", "objective"):
        raise _native.Error(f'rewards = "{rewards}" is not known; allowed: "paper", "objective"')
    return "team" if rewards == "paper" else rewards


class Sessions:
    """Seeds of episodes: a seed begins a session, whose episodes have seeds of their own; no seed goes on with it."""

    def __init__(self, native: _native.Environments, seed: int | None) -> None:
        self._native = native
        self._first = seed

    def reset(self, seeds: list[int | None]) -> NDArray[np.float32]:
        """First observations of new episodes."""
        if self._first is not None:
            seeds = [self._first + index if seed is None else seed for index, seed in enumerate(seeds)]
            self._first = None
        return self._native.reset(seeds)


class Pickled:
    """Pickles as a new environment with the same arguments, before its first episode."""

    _given: tuple[tuple[Any, ...], dict[str, Any]]

    def __new__(cls, *arguments: Any, **keywords: Any) -> Any:
        made = super().__new__(cls)
        made._given = (arguments, keywords)
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return (_remade, (type(self), *self._given))


def _remade(kind: type, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
    return kind(*arguments, **keywords)


def figures(text: str) -> dict[str, Any]:
    """The figures of an episode."""
    found: dict[str, Any] = json.loads(text)
    return found
