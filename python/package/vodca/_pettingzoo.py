"""PettingZoo's parallel environment: one agent per robot."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray
from pettingzoo import ParallelEnv

from . import _native
from ._environments import FEWEST, MOST, Pickled, Sessions, actions_are_horizons, figures
from ._parameters import documented

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._keywords import Parameters


class parallel_env(Pickled, ParallelEnv):
    """A team as a PettingZoo environment: an agent per robot, with a view and a reward of its own.

    An agent sees, in its own frame (origin: where it measures itself, first axis: to its set-point), the distance to its
    set-point, its velocity, last horizon and rows, the `neighbours` nearest robots and the `obstacles` nearest discs:
    float32 [5 + 8 neighbours + 4 obstacles], each number in -10..10. It chooses its prediction horizon: as the paper's number
    a in -1..1, N = ceil(1 + 24 (a + 1)) (`actions="continuous"`, float32 [1]), or the horizon itself, 1..49
    (`actions="horizon"`).

    rewards: "objective": minus its detour (m), minus 0.03 m for each tick until it has arrived, minus 5 m in a collision;
        "paper": its share of the paper's reward.
    Every agent stays to the common end, arrived or not: terminated by a collision, truncated `after_arrival` ticks after
    everybody has arrived, or at K (only there with `after_arrival=None`).

    scenario, profile, max_ticks, params, keywords: as of `vodca.run`.
    seed: of the first session of episodes, unless `reset(seed=)` begins another one; the scenario's when left out.
    start_jitter: every start is moved by up to this much per axis, m, anew for every episode.
    family: a generated layout less its seed ("box:8:3"): every episode has a layout of its own; `scenario` is one of it.

    A pickled environment becomes a new one with the same arguments.
    """

    metadata = {"name": "vodca_v0", "render_modes": [], "is_parallelizable": True}

    def __init__(
        self,
        scenario: _native.Scenario | str | int | os.PathLike[str],
        *,
        profile: str = "safe",
        actions: str = "continuous",
        rewards: str = "objective",
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
        if rewards not in ("objective", "paper"):
            raise _native.Error(f'rewards = "{rewards}" is not known; allowed: "objective", "paper"')
        self._horizons = actions_are_horizons(actions)
        self._native = _native.Environments(
            scenario, 1, observation="local", rewards=rewards, autoreset="disabled", threads=1, profile=profile,
            seed=seed, max_ticks=max_ticks, start_jitter=start_jitter, family=family, after_arrival=after_arrival,
            neighbours=neighbours, obstacles=obstacles, params=params, keywords=keywords,
        )
        layout = self._native.scenario(0)
        self._sessions = Sessions(self._native, layout.seed)
        self.render_mode = render_mode
        self.possible_agents: list[str] = list(layout.names)
        self.agents: list[str] = []
        low, high = self._native.bounds()
        robots = range(len(self.possible_agents))
        seen = [spaces.Box(low[robot], high[robot], dtype=np.float32) for robot in robots]
        chosen = [
            spaces.Discrete(MOST, start=FEWEST) if self._horizons else spaces.Box(-1.0, 1.0, (1,), np.float32)
            for _ in robots
        ]
        self.observation_spaces = dict(zip(self.possible_agents, seen))
        self.action_spaces = dict(zip(self.possible_agents, chosen))
        width = len(self.possible_agents)
        self._actions = np.zeros((1, width), np.int64 if self._horizons else np.float32)
        low, high = self._native.state_bounds()
        self.state_space = spaces.Box(low, high, dtype=np.float32)

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """What `agent` sees."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """What `agent` chooses from."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, NDArray[np.float32]], dict[str, dict[str, Any]]]:
        """Begins an episode: the first of the session with `seed`, or the next one."""
        seen = self._sessions.reset([seed])
        self.agents = self.possible_agents[:]
        return dict(zip(self.agents, seen[0])), {agent: {} for agent in self.agents}

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[
        dict[str, NDArray[np.float32]], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]
    ]:
        """Plays one tick. At the end of an episode every agent's info has its figures under "summary"."""
        agents = self.agents
        if not agents:
            return {}, {}, {}, {}, {}
        chosen = self._actions[0]
        try:
            if self._horizons:
                for robot, agent in enumerate(agents):
                    chosen[robot] = actions[agent]
            else:
                for robot, agent in enumerate(agents):
                    chosen[robot] = actions[agent][0]
        except KeyError as missing:
            raise _native.Error(f"there is no action of agent {missing}; every robot needs one") from None
        seen, _, rewards, terminated, truncated, ended = self._native.step(self._actions)
        terminations = dict.fromkeys(agents, bool(terminated[0]))
        truncations = dict.fromkeys(agents, bool(truncated[0]))
        summary = {"summary": figures(ended[0][2])} if ended else {}
        if ended:
            self.agents = []
        infos = {agent: dict(summary) for agent in agents}
        return dict(zip(agents, seen[0])), dict(zip(agents, rewards[0].tolist())), terminations, truncations, infos

    def state(self) -> NDArray[np.float32]:
        """Everybody's measured position, x and y of the first robot, of the second, ..., scaled to about -1..1."""
        return self._native.state(0)

    def measured(self) -> NDArray[np.float64]:
        """Where every robot measures itself, m, [robots, 2]."""
        return self._native.measured(0)

    @property
    def scenario(self) -> _native.Scenario:
        """The layout of this episode; its seed is the episode's."""
        return self._native.scenario(0)

    def render(self) -> None:
        """Draws nothing: `vodca.run` and `Run.animate` do."""

    def close(self) -> None:
        """Nothing is kept open."""


documented(parallel_env)
