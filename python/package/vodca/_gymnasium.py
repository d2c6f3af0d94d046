"""Gymnasium's environments: the team as one agent, alone or many at once."""

from __future__ import annotations

import os
from collections.abc import Mapping
from operator import index
from typing import TYPE_CHECKING, Any, SupportsIndex

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from . import _native
from ._environments import FEWEST, MOST, Pickled, Sessions, actions_are_horizons, figures, team_rewards
from ._parameters import documented

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._keywords import Parameters

_SHARED = """

    The observation is the paper's s: everybody's measured position, x and y of robot 0, of robot 1, ..., scaled to about
    -1..1 over the scenario (float32 [2 robots]; `scaling` says how), what a policy sees that `export` makes of it. With
    `observation="local"` it is what each robot sees in its own frame, float32 [robots, numbers], as in `parallel_env`.
    The action is one number per robot: the paper's a in -1..1, N = ceil(1 + 24 (a + 1)) (`actions="continuous"`, float32
    [robots]), or the prediction horizon itself, 1..49 (`actions="horizon"`, int64 [robots]). The reward
    is the paper's R (`rewards="paper"`), or what the robots earn by path and time (`rewards="objective"`): minus all detours (m),
    minus 0.03 m for each tick of each robot that has not arrived, minus 5 m for each robot in a collision.
    An episode is terminated by a collision, truncated `after_arrival` ticks after everybody has arrived, or at K (only there
    with `after_arrival=None`).

    scenario, profile, max_ticks, params, keywords: as of `vodca.run`.
    seed: of the first session of episodes, unless `reset(seed=)` begins another one; the scenario's when left out. The
        first episode of a session has its seed, the others seeds that follow from it.
    start_jitter: every start is moved by up to this much per axis, m, anew for every episode.
    family: a generated layout less its seed ("box:8:3"): every episode has a layout of its own; `scenario` is one of it.

    A pickled environment becomes a new one with the same arguments.
"""


class Env(Pickled, gymnasium.Env):
    """A team as a Gymnasium environment: one agent chooses every robot's horizon."""

    metadata = {"render_modes": []}

    def __init__(
        self,
        scenario: _native.Scenario | str | int | os.PathLike[str],
        *,
        profile: str = "safe",
        observation: str = "positions",
        actions: str = "continuous",
        rewards: str = "paper",
        neighbours: int = 4,
        obstacles: int = 2,
        start_jitter: float = 0.0,
        family: str | None = None,
        after_arrival: int | None = 0,
        seed: int | None = None,
        max_ticks: int | None = None,
        params: Mapping[str, Any] | None = None,
        render_mode: str | None = None,
        **keywords: Unpack[Parameters],
    ) -> None:
        self._horizons = actions_are_horizons(actions)
        self._native = _native.Environments(
            scenario, 1, observation=observation, rewards=team_rewards(rewards), autoreset="disabled", threads=1, profile=profile,
            seed=seed, max_ticks=max_ticks, start_jitter=start_jitter, family=family, after_arrival=after_arrival,
            neighbours=neighbours, obstacles=obstacles, params=params, keywords=keywords,
        )
        self._sessions = Sessions(self._native, self._native.scenario(0).seed)
        self.render_mode = render_mode
        self.observation_space, self.action_space = _spaces(self._native, self._horizons)
        self._shape = (1, self._native.robots)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begins an episode: the first of the session with `seed`, or the next one."""
        super().reset(seed=seed)
        return self._sessions.reset([seed])[0], {}

    def step(self, action: Any) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Plays one tick. At the end of an episode `info["summary"]` has its figures."""
        chosen = np.asarray(action, np.int64 if self._horizons else np.float32)
        if chosen.shape != self._shape[1:]:
            raise _native.Error(f"action has the shape {list(chosen.shape)}; it must be {list(self._shape[1:])}")
        seen, reward, _, terminated, truncated, ended = self._native.step(chosen.reshape(self._shape))
        info = {"summary": figures(ended[0][2])} if ended else {}
        return seen[0], float(reward[0]), bool(terminated[0]), bool(truncated[0]), info

    def measured(self) -> NDArray[np.float64]:
        """Where every robot measures itself, m, [robots, 2]."""
        return self._native.measured(0)

    @property
    def horizons(self) -> NDArray[np.uint8]:
        """The horizons of the newest tick, steps, [robots]."""
        return self._native.horizons(0)

    @property
    def scenario(self) -> _native.Scenario:
        """The layout of this episode; its seed is the episode's."""
        return self._native.scenario(0)

    @property
    def scaling(self) -> tuple[list[float], list[float]]:
        """[x, y] subtracted from positions, m, and what they are then multiplied by, 1/m."""
        return self._native.scaling()


class VectorEnv(Pickled, gymnasium.vector.VectorEnv):
    """Many teams at once, on all cores and without Python's lock: a Gymnasium vector environment.

    Environment i is an `Env` with the seed `seed + i`. Episodes begin again by themselves: in the step after the last one
    (`autoreset="next_step"`, Gymnasium's default; that step's action is not used), or in the last step itself
    (`autoreset="same_step"`; what was seen last is in `infos["final_obs"]`).
    threads: how many are used; 0: one for each core.
    """

    def __init__(
        self,
        scenario: _native.Scenario | str | int | os.PathLike[str],
        num_envs: int,
        *,
        profile: str = "safe",
        observation: str = "positions",
        actions: str = "continuous",
        rewards: str = "paper",
        autoreset: str = "next_step",
        neighbours: int = 4,
        obstacles: int = 2,
        start_jitter: float = 0.0,
        family: str | None = None,
        after_arrival: int | None = 0,
        seed: int | None = None,
        max_ticks: int | None = None,
        threads: int = 0,
        params: Mapping[str, Any] | None = None,
        **keywords: Unpack[Parameters],
    ) -> None:
        if autoreset not in ("next_step", "same_step"):
            raise _native.Error(f'autoreset = "{autoreset}" is not known; allowed: "next_step", "same_step"')
        self._horizons = actions_are_horizons(actions)
        self._native = _native.Environments(
            scenario, num_envs, observation=observation, rewards=team_rewards(rewards), autoreset=autoreset, threads=threads,
            profile=profile, seed=seed, max_ticks=max_ticks, start_jitter=start_jitter, family=family,
            after_arrival=after_arrival, neighbours=neighbours, obstacles=obstacles, params=params, keywords=keywords,
        )
        self._sessions = Sessions(self._native, self._native.scenario(0).seed)
        self._same_step = autoreset == "same_step"
        self.metadata = {
            "render_modes": [],
            "autoreset_mode": AutoresetMode.SAME_STEP if self._same_step else AutoresetMode.NEXT_STEP,
        }
        self.num_envs = num_envs
        self.single_observation_space, self.single_action_space = _spaces(self._native, self._horizons)
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, num_envs)
        self.action_space = gymnasium.vector.utils.batch_space(self.single_action_space, num_envs)
        self._shape = (num_envs, self._native.robots)

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begins an episode everywhere; an integer `seed` is that of environment 0, the others follow."""
        seeds: list[int | None] = [None] * self.num_envs
        if isinstance(seed, SupportsIndex):
            seeds = [index(seed) + number for number in range(self.num_envs)]
        elif seed is not None:
            seeds = list(seed)
        return self._sessions.reset(seeds), {}

    def step(
        self, actions: Any
    ) -> tuple[NDArray[np.float32], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Plays one tick everywhere. Figures of episodes that ended are in `infos["summary"]`, by environment."""
        chosen = np.asarray(actions, np.int64 if self._horizons else np.float32)
        seen, rewards, _, terminated, truncated, ended = self._native.step(chosen)
        return seen, rewards, terminated, truncated, self._infos(ended) if ended else {}

    def measured(self, number: int) -> NDArray[np.float64]:
        """Where the robots of environment `number` measure themselves, m, [robots, 2]."""
        return self._native.measured(number)

    @property
    def scaling(self) -> tuple[list[float], list[float]]:
        """[x, y] subtracted from positions, m, and what they are then multiplied by, 1/m."""
        return self._native.scaling()

    def _infos(self, ended: list[tuple[int, NDArray[np.float32], str]]) -> dict[str, Any]:
        infos: dict[str, Any] = {}
        last = np.empty(self.num_envs, dtype=object)
        over = np.zeros(self.num_envs, dtype=np.bool_)
        for number, seen, text in ended:
            over[number], last[number] = True, seen
            infos = self._add_info(infos, {"summary": figures(text)}, number)
        if self._same_step:
            infos |= {"final_obs": last, "_final_obs": over}
        return infos


def _spaces(native: _native.Environments, horizons: bool) -> tuple[spaces.Box, spaces.Space[Any]]:
    low, high = native.bounds()
    robots = native.robots
    seen = spaces.Box(low, high, dtype=np.float32)
    if horizons:
        return seen, spaces.MultiDiscrete(np.full(robots, MOST), start=np.full(robots, FEWEST))
    return seen, spaces.Box(-1.0, 1.0, (robots,), np.float32)


for _environment in (Env, VectorEnv):
    _environment.__doc__ = (_environment.__doc__ or "").rstrip() + _SHARED
    documented(_environment)
