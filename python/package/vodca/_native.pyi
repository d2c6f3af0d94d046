"""The extension: the product's own code. Documented in the classes and functions of `vodca`."""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Self, Unpack

from ._keywords import Parameters

__version__: str

class Error(ValueError):
    """What was asked for cannot be done. The message names the place and the value, and says what is allowed."""

@final
class Scenario:
    """A layout of robots, set-points and obstacles."""

    def __new__(
        cls, robots: Sequence[Any], obstacles: Sequence[Any] | None = None, *, name: str = "scenario", **further: Any
    ) -> Self: ...
    @staticmethod
    def from_toml(text: str, name: str = "scenario") -> Scenario:
        """The layout in the text of a scenario file."""
    @staticmethod
    def find(given: Any) -> Scenario:
        """The layout of a name ("ex14_d", "ring:16"), a file or a number of robots."""
    def to_toml(self) -> str:
        """The layout as a scenario file, which reads back to the same bits."""
    def jittered(self, spread: float, seed: int, min_separation: float = 1.5) -> Scenario:
        """Every start moved by a uniform draw of up to `spread` m per axis; the same `seed`, the same starts."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def names(self) -> list[str]:
        """The robots' names, by number."""
    @property
    def starts(self) -> NDArray[np.float64]:
        """Where the robots start, m, [robots, 2]."""
    @property
    def set_points(self) -> NDArray[np.float64]:
        """Where they want to be, m, [robots, 2]."""
    @property
    def obstacles(self) -> NDArray[np.float64]:
        """The centres of the obstacles, m, [obstacles, 2]."""
    @property
    def radii(self) -> NDArray[np.float64]:
        """The radii of the robots, m, [robots]; nan where none was given: half of model.min_separation."""
    @property
    def obstacle_radii(self) -> NDArray[np.float64]:
        """The radii of the obstacles, m, [obstacles]; nan where none was given: half of model.min_separation."""
    @property
    def max_ticks(self) -> int:
        """K, the most ticks of a run."""
    @property
    def seed(self) -> int:
        """Seed of everything random in a run."""
    def __len__(self) -> int: ...

@final
class Plan:
    """A robot's plan, as the others hear it."""

    def __new__(cls, tick: int, states: Sequence[ArrayLike], set_point: ArrayLike) -> Self: ...
    @property
    def tick(self) -> int:
        """The tick at which it was made."""
    @property
    def horizon(self) -> int:
        """Its number of steps."""
    @property
    def states(self) -> NDArray[np.float64]:
        """Its places, m, [horizon + 1, 2]."""
    @property
    def set_point(self) -> NDArray[np.float64]:
        """Where the robot wants to be, m, [2]."""

@final
class Decision:
    """What a robot decided in a tick."""

    @property
    def input(self) -> NDArray[np.float64]:
        """The velocity to drive with during this tick, m/s, world frame, [2]."""
    @property
    def plan(self) -> Plan:
        """What the other robots have to hear before the next tick."""
    @property
    def rows(self) -> int:
        """Collision rows of the QP."""
    @property
    def level(self) -> str:
        """Which solver gave the plan."""
    @property
    def status(self) -> str:
        """How the plan came about."""
    @property
    def filtered(self) -> bool:
        """Whether the safety filter changed the input."""
    @property
    def solve_ns(self) -> int:
        """Time in the QP's solvers, ns."""

@final
class Controller:
    """One robot's controller, tick by tick, for a simulator or robots of your own."""

    def __new__(
        cls,
        scenario: Any,
        robot: int,
        *,
        profile: str = "safe",
        seed: int | None = None,
        params: Mapping[str, Any] | None = None,
        **keywords: Unpack[Parameters],
    ) -> Self: ...
    def tick(self, position: ArrayLike, horizon: int = 20) -> Decision:
        """Decides the next tick of the robot that measures itself at `position` ([x, y], m) over `horizon` steps, 1..49."""
    def hear(self, robot: int, plan: Plan) -> None:
        """Hears the newest `plan` of another robot. It must be of a tick that has been decided here already."""
    def see(self, robot: int, position: ArrayLike, set_point: ArrayLike | None = None) -> None:
        """Sees another robot at `position` ([x, y], m) at the start of the next tick."""
    @property
    def robot(self) -> int:
        """The robot's number."""
    @property
    def next_tick(self) -> int:
        """The tick that is decided next."""
    @property
    def sample_time(self) -> float:
        """How long an input is held, s."""
    def params(self) -> dict[str, Any]:
        """The effective parameters, by key."""

@final
class Run:
    LEVELS: ClassVar[list[str]]
    STATUSES: ClassVar[list[str]]
    ticks: int
    scenario: Scenario
    folder: str | None
    def positions(self) -> NDArray[np.float64]: ...
    def inputs(self) -> NDArray[np.float64]: ...
    def horizons(self) -> NDArray[np.uint8]: ...
    def rows(self) -> NDArray[np.uint32]: ...
    def levels(self) -> NDArray[np.uint8]: ...
    def statuses(self) -> NDArray[np.uint8]: ...
    def separations(self) -> NDArray[np.float64]: ...
    def rewards(self) -> NDArray[np.float64]: ...
    def robot_rewards(self, objective: bool) -> NDArray[np.float64]: ...
    def plan(self, tick: int, robot: int) -> NDArray[np.float64]: ...
    def params(self) -> dict[str, Any]: ...
    def summary(self) -> str: ...
    def about(self) -> str: ...
    def trajectory(self) -> str: ...
    def report(self) -> str: ...
    def save(self, folder: str | None) -> str: ...

@final
class Environments:
    def __new__(
        cls,
        scenario: Any,
        count: int,
        *,
        observation: str,
        rewards: str,
        autoreset: str,
        threads: int = 0,
        profile: str = "safe",
        seed: int | None = None,
        max_ticks: int | None = None,
        start_jitter: float = 0.0,
        family: str | None = None,
        after_arrival: int | None = 0,
        neighbours: int = 4,
        obstacles: int = 2,
        params: Mapping[str, Any] | None = None,
        keywords: Mapping[str, Any] | None = None,
    ) -> Self: ...
    robots: int
    count: int
    profile: str
    observation: str
    def reset(self, seeds: Sequence[int | None]) -> NDArray[np.float32]: ...
    def step(
        self, actions: NDArray[Any]
    ) -> tuple[
        NDArray[np.float32],
        NDArray[np.float64],
        Any,
        NDArray[np.bool_],
        NDArray[np.bool_],
        list[tuple[int, NDArray[np.float32], str]],
    ]: ...
    def measured(self, index: int) -> NDArray[np.float64]: ...
    def horizons(self, index: int) -> NDArray[np.uint8]: ...
    def scenario(self, index: int) -> Scenario: ...
    def tick(self, index: int) -> int: ...
    def summary(self, index: int) -> str: ...
    def params(self) -> dict[str, Any]: ...
    def bounds(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]: ...
    def state(self, index: int) -> NDArray[np.float32]: ...
    def state_bounds(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]: ...
    def scaling(self) -> tuple[list[float], list[float]]: ...

def run(scenario: Any, **keywords: Any) -> Run: ...
def read(folder: str) -> Run: ...
def names() -> list[str]: ...
def parameters(profile: str = "safe") -> list[tuple[str, Any, str, str, str, str]]: ...
def effective(scenario: Any, **keywords: Any) -> dict[str, Any]: ...
def publish_layers(
    folder: str, layers: Sequence[tuple[NDArray[np.float32], NDArray[np.float32]]], activation: str, meaning: dict[str, Any]
) -> tuple[str, float]: ...
def publish_model(folder: str, model: bytes, meaning: dict[str, Any]) -> str: ...
