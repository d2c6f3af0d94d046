"""Runs: played here or read from a folder, as NumPy arrays, figures, pictures and pages."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._native import Scenario

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._keywords import Parameters

Horizon = int | str | Sequence[int] | NDArray[Any] | Callable[[int, NDArray[np.float64]], Any] | None


def run(
    scenario: Scenario | str | int | os.PathLike[str],
    *,
    profile: str = "safe",
    horizon: Horizon = None,
    seed: int | None = None,
    max_ticks: int | None = None,
    params: Mapping[str, Any] | None = None,
    **keywords: Unpack[Parameters],
) -> Run:
    """Plays a team in this process until everybody has arrived or `max_ticks` have passed.

    The trajectory is that of `./run.sh` with the same scenario, profile, horizons, seed and parameters, to the last byte.

    scenario: a `Scenario`, a name ("ex14_d", "ring:16", "box:16:3:7"), a file, or a number of robots.
    profile: "safe", "paper", "orca" or "orca-rh".
    horizon: prediction horizons, 1..49 steps: a number for all robots (20 when left out), one per robot, an array
        [ticks, robots] (its last row holds on), `function(tick, positions) -> horizons` with positions [robots, 2] in m,
        or what `--horizon` takes ("fixed:9,40", "random:3", "script:FILE").
    seed: of everything random; the scenario's when left out.
    max_ticks: K; the scenario's when left out.
    params: parameters by key, {"vodca.rows": "each"} or {"vodca": {"rows": "each"}}; as keywords: vodca_rows="each".

    Raises `Error` with the command line's sentence, what a `horizon` function raises, and KeyboardInterrupt.
    """
    played = _native.run(
        scenario, profile=profile, horizon=horizon, seed=seed, max_ticks=max_ticks, params=params, **keywords
    )
    return Run(played)


def read(folder: str | os.PathLike[str]) -> Run:
    """Reads the folder of a recorded run; of one that was cut what it recorded. Raises `Error`."""
    return Run(_native.read(os.fspath(folder)))


class Summary(dict[str, Any]):
    """The figures of a run, those of `summary.json`; prints the ones that matter."""

    def __str__(self) -> str:
        return "\n".join(f"{name:<16}{value}" for name, value in self._lines())

    __repr__ = __str__

    def _repr_html_(self) -> str:
        rows = (f"<tr><th>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in self._lines())
        return f"<table>{''.join(rows)}</table>"

    def _lines(self) -> list[tuple[str, str]]:
        if not self:
            return [("summary", "none: the run was cut")]
        robots = self["robots"]
        arrived = sum(robot["arrived_tick"] is not None for robot in robots)
        success = "yes" if self["success"] else f"no: {arrived} of {len(robots)} arrived, {self['collisions']} pairs collided"
        time, ratio, least = self["completion_time"], self["path_ratio"], self["min_separation"]
        lines = [
            ("scenario", f"{self['scenario']}, {self['profile']}, {self['horizon']}" if "scenario" in self else None),
            ("success", success),
            ("ticks", str(self["ticks"])),
            ("completion time", "-" if time is None else f"{time:.1f} s"),
            ("path", f"{self['path_cost']:.2f} m" + ("" if ratio is None else f", {ratio:.4f} of the straight lines")),
            ("min separation", "-" if least is None else f"{least:.6f} m (between samples)"),
            ("collisions", f"{self['collisions']} pairs"),
            ("guarantee", self.get("guarantee")),
        ]
        return [(name, value) for name, value in lines if value is not None]


class Run:
    """A run, tick by tick. `ticks` is their number; arrays are made when they are asked for, and kept."""

    LEVELS: tuple[str, ...] = tuple(_native.Run.LEVELS)
    """What the numbers in `levels` mean: which solver gave the plan."""
    STATUSES: tuple[str, ...] = tuple(_native.Run.STATUSES)
    """What the numbers in `statuses` mean: how the plan came about."""

    def __init__(self, native: _native.Run) -> None:
        self._native = native

    @property
    def ticks(self) -> int:
        """Ticks that were played."""
        return self._native.ticks

    @property
    def scenario(self) -> Scenario:
        """The layout, with the seed and the number of ticks that were used."""
        return self._native.scenario

    @cached_property
    def params(self) -> dict[str, Any]:
        """The effective parameters, by key."""
        return self._native.params()

    @cached_property
    def summary(self) -> Summary:
        """The figures of `summary.json`; empty of a recorded run that was cut."""
        return Summary(json.loads(self._native.summary()) or {})

    @cached_property
    def about(self) -> dict[str, Any]:
        """How the run came about: profile, horizons, seed, versions, machine."""
        about: dict[str, Any] = json.loads(self._native.about())
        return about

    @property
    def folder(self) -> str | None:
        """Where the run is recorded, if it was read."""
        return self._native.folder and os.fspath(self._native.folder)

    @cached_property
    def time(self) -> NDArray[np.float64]:
        """Start of every tick and the end of the last one, s, [ticks + 1]."""
        sample_time: float = self.params["model.sample_time"]
        return np.arange(self.ticks + 1, dtype=np.float64) * sample_time

    @cached_property
    def positions(self) -> NDArray[np.float64]:
        """Where the robots were, m, world frame, [ticks + 1, robots, 2]: at the start of each tick, and at the end."""
        return self._native.positions()

    @cached_property
    def inputs(self) -> NDArray[np.float64]:
        """Velocities, m/s, [ticks, robots, 2]; constant within a tick."""
        return self._native.inputs()

    @cached_property
    def horizons(self) -> NDArray[np.uint8]:
        """Prediction horizons, steps, [ticks, robots]."""
        return self._native.horizons()

    @cached_property
    def rows(self) -> NDArray[np.uint32]:
        """Collision rows of the QPs, [ticks, robots]."""
        return self._native.rows()

    @cached_property
    def levels(self) -> NDArray[np.uint8]:
        """Which solver gave the plan, an index into `LEVELS`, [ticks, robots]."""
        return self._native.levels()

    @cached_property
    def statuses(self) -> NDArray[np.uint8]:
        """How the plan came about, an index into `STATUSES`, [ticks, robots]."""
        return self._native.statuses()

    @cached_property
    def separations(self) -> NDArray[np.float64]:
        """Smallest separation of each robot to anything, m, between samples too, [ticks, robots]; inf if it is alone."""
        return self._native.separations()

    @cached_property
    def rewards(self) -> NDArray[np.float64]:
        """The team's reward R of the paper's section IV, [ticks]."""
        return self._native.rewards()

    def robot_rewards(self, kind: str = "objective") -> NDArray[np.float64]:
        """What each robot earned, [ticks, robots].

        "objective": minus its detour (m), minus 0.03 m for each tick until it has arrived, minus 5 m in a collision;
        "paper": its share of `rewards` (the variance of the horizons, R_v, belongs to nobody).
        """
        if kind not in ("objective", "paper"):
            raise _native.Error(f'kind = "{kind}" is not known; allowed: "objective", "paper"')
        return self._native.robot_rewards(kind == "objective")

    def plan(self, tick: int, robot: int) -> NDArray[np.float64]:
        """The plan that `robot` published at `tick`, m, [horizon + 1, 2]; row 0 is where it planned."""
        return self._native.plan(tick, robot)

    def trajectory(self) -> str:
        """The run as `trajectory.csv` has it."""
        return self._native.trajectory()

    def save(self, folder: str | os.PathLike[str] | None = None) -> str:
        """Records the run in `folder` (new or empty; `runs/...` when left out) for `./run.sh report`, `verify`, `replay`."""
        return os.fspath(self._native.save(None if folder is None else os.fspath(folder)))

    def report(self, file: str | os.PathLike[str] | None = None) -> str:
        """The run's page: one HTML text with replay and charts that needs no network; also written to `file`."""
        page = self._native.report()
        if file is not None:
            with open(file, "w", encoding="utf-8") as out:
                out.write(page)
        return page

    def plot(self, ax: Any = None) -> Any:
        """Draws paths, set-points and obstacles with matplotlib into `ax`, or new axes; gives them."""
        from ._plotting import plot

        return plot(self, ax)

    def animate(self, *, speed: float = 4.0, plans: bool = True) -> Any:
        """A matplotlib animation, `speed` times as fast as the robots, with the plans ahead of them."""
        from ._plotting import animate

        return animate(self, speed, plans)

    def __len__(self) -> int:
        return self.ticks

    def __repr__(self) -> str:
        return f"<vodca.Run of {self.scenario.name}: {len(self.scenario)} robots, {self.ticks} ticks>"

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{escape(self.report())}" width="100%" height="720" style="border:0"></iframe>'
