"""Teams of robots that plan for themselves, from Python.

>>> import vodca
>>> run = vodca.run("ex14_d", horizon=20)
>>> run.positions.shape  # ticks + 1, robots, [x, y] in metres
(91, 14, 2)

`run` plays a team in this process, `read` reads the folder of a recorded run; both give a `Run`. `parallel_env` is a
PettingZoo environment, `Env` and `VectorEnv` are Gymnasium's, `Controller` is one robot's controller for a simulator of
your own, `export` makes a policy that was trained here drive with `./run.sh 14 --policy FOLDER`.

Lengths are metres, times seconds, speeds m/s, angles rad, all in one world frame. A tick lasts `model.sample_time`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._native import Controller, Decision, Error, Plan, Scenario, __version__
from ._parameters import Parameters, documented, effective_parameters, parameters
from ._run import Run, read, run
from ._scenario import Obstacle, Robot, scenarios

if TYPE_CHECKING:
    from ._export import export
    from ._gymnasium import Env, VectorEnv
    from ._pettingzoo import parallel_env

__all__ = [
    "Controller",
    "Decision",
    "Env",
    "Error",
    "Obstacle",
    "Parameters",
    "Plan",
    "Robot",
    "Run",
    "Scenario",
    "VectorEnv",
    "__version__",
    "effective_parameters",
    "export",
    "parallel_env",
    "parameters",
    "read",
    "run",
    "scenarios",
]

# What needs more than NumPy is imported when it is used.
_LATER = {"Env": "_gymnasium", "VectorEnv": "_gymnasium", "parallel_env": "_pettingzoo", "export": "_export"}

documented(run)


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module 'vodca' has no attribute {name!r}")
    from importlib import import_module

    try:
        module = import_module("." + _LATER[name], __name__)
    except ModuleNotFoundError as missing:
        if missing.name in ("gymnasium", "pettingzoo"):
            raise ModuleNotFoundError(
                f"vodca.{name} needs {missing.name}; install it: pip install {missing.name}", name=missing.name
            ) from missing
        raise
    globals()[name] = value = getattr(module, name)
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
