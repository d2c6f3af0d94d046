"""Policies that were trained in Python, made to drive: ONNX, contract, reference set, one version of a policies folder."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._gymnasium import Env, VectorEnv

Layers = Sequence[tuple[NDArray[Any], NDArray[Any]]]

CASES = 32
"""Observations of the reference set."""


class Exported(NamedTuple):
    """What `export` has written."""

    folder: str
    version: str
    difference: float
    """Largest difference between the ONNX file's answers and the policy's own; nan where nothing could run the file."""


def export(
    policy: Any,
    folder: str | os.PathLike[str],
    env: Env | VectorEnv,
    *,
    activation: str = "relu",
    squash: bool | None = None,
    horizon: tuple[int, int] = (1, 49),
    name: str | None = None,
) -> Exported:
    """Makes `policy` the current version of the policies folder `folder`: `./run.sh 14 --policy FOLDER` drives with it.

    policy: from the observation of `env` (float32 [2 robots]) to an action per robot. One of
        - the layers of a NumPy network, [(weight [outputs, inputs], bias [outputs]), ...], the last one without activation;
        - a torch module: `Sequential` of `Linear`, `ReLU` and `Tanh`, or any other that `torch.onnx` can export;
        - a Stable-Baselines3 model with a multilayer policy and continuous actions (SAC, TD3, DDPG, PPO, A2C).
    env: the environment it was trained in; with positions as observation and continuous actions.
    activation: "relu" or "tanh", what follows a hidden layer of a NumPy network.
    squash: whether the action is the tanh of what the policy gives. Left out: of a NumPy network yes, of a module no unless
        it ends in `Tanh`, of a Stable-Baselines3 model what it does itself.
    horizon: bounds of the horizons that it may choose, steps.

    The file is run, and must answer 32 observations of `env` as the policy does, before it becomes the current version. The
    policy server tries the same ones before it serves. Raises `Error` when an answer differs, and nothing is written.
    """
    native = env._native
    if native.observation != "positions" or env._horizons:
        raise _native.Error(
            "a policy that drives sees positions and answers in -1..1; train it in an environment with "
            'observation="positions" and actions="continuous"'
        )
    observations, positions = _cases(native)
    network = _network(policy, activation, squash, observations)
    answers = network.answers(observations)
    if answers.shape != (len(observations), native.robots):
        raise _native.Error(
            f"the policy's answer has the shape {list(answers.shape[1:])}; it must be [{native.robots}], an action per robot"
        )
    if not np.isfinite(answers).all():
        case = int(np.flatnonzero(~np.isfinite(answers).all(axis=1))[0])
        raise _native.Error(f"the policy answers observation {case} with a number that is not finite; nothing was written")
    offset, scale = native.scaling()
    meaning = {
        "name": name or os.path.basename(os.path.normpath(os.fspath(folder))),
        "robots": native.robots,
        "offset": offset,
        "scale": scale,
        "squash": network.squash,
        "horizon": horizon,
        "trained_from": f"Python, {native.scenario(0).name} {native.profile}",
        "cases": list(zip(positions.tolist(), answers.astype(float).tolist())),
    }
    folder = os.fspath(folder)
    if network.layers is not None:
        version, difference = _native.publish_layers(folder, network.layers, network.activation, meaning)
    else:
        model = network.onnx()
        difference = _difference(model, observations, answers)
        version = _native.publish_model(folder, model, meaning)
    return Exported(folder, version, difference)


def _cases(native: _native.Environments) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    """Observations all over the scenario, and the positions (m) that they are of."""
    low, high = (np.asarray(corner, np.float64) for corner in ([-1.2] * 2, [1.2] * 2))
    offset, scale = (np.tile(numbers, native.robots) for numbers in native.scaling())
    drawn = np.random.default_rng(0).uniform(np.tile(low, native.robots), np.tile(high, native.robots), (CASES, 2 * native.robots))
    positions = drawn / scale + offset
    return ((positions - offset) * scale).astype(np.float32), positions


class _Network(NamedTuple):
    """A policy, taken apart as far as that is possible."""

    layers: list[tuple[NDArray[np.float32], NDArray[np.float32]]] | None
    activation: str
    squash: bool
    answers: Callable[[NDArray[np.float32]], NDArray[Any]]
    """What the policy itself answers, before squashing."""
    onnx: Callable[[], bytes]


def _network(policy: Any, activation: str, squash: bool | None, observations: NDArray[np.float32]) -> _Network:
    if isinstance(policy, (list, tuple)):
        layers = [(_float32(weight), _float32(bias)) for weight, bias in policy]
        own = _numpy_answers(layers, activation)
        return _Network(layers, activation, True if squash is None else squash, own, bytes)
    if hasattr(policy, "policy") and hasattr(policy, "predict"):
        from ._torch import of_stable_baselines

        module, squashed = of_stable_baselines(policy)
        squash = squashed if squash is None else squash
    elif hasattr(policy, "state_dict") and callable(policy):
        module = policy
    else:
        raise _native.Error(
            f"a {type(policy).__name__} is no policy that can be exported; give layers [(weight, bias), ...], a torch "
            "module or a Stable-Baselines3 model"
        )
    from ._torch import answers, layers_of, onnx_of

    found, activation, ends_in_tanh = layers_of(module)
    if found is not None and ends_in_tanh:
        # tanh(mean) is what the contract calls squashing: the last layer without it is the mean.
        return _Network(found, activation, True, _numpy_answers(found, activation), bytes)
    return _Network(found, activation, bool(squash), answers(module), lambda: onnx_of(module, observations.shape[1]))


def _float32(numbers: Any) -> NDArray[np.float32]:
    return np.ascontiguousarray(numbers, np.float32)


def _numpy_answers(layers: Layers, activation: str) -> Callable[[NDArray[np.float32]], NDArray[Any]]:
    def answer(observations: NDArray[np.float32]) -> NDArray[Any]:
        values = observations.astype(np.float64)
        for number, (weight, bias) in enumerate(layers):
            if weight.ndim != 2 or bias.shape != weight.shape[:1] or weight.shape[1] != values.shape[1]:
                raise _native.Error(
                    f"layer {number} has a weight {list(weight.shape)} and a bias {list(bias.shape)}; with "
                    f"{values.shape[1]} inputs they must be [outputs, {values.shape[1]}] and [outputs]"
                )
            values = values @ weight.T.astype(np.float64) + bias
            if number + 1 < len(layers):
                values = np.tanh(values) if activation == "tanh" else np.maximum(values, 0.0)
        return values

    return answer


def _difference(model: bytes, observations: NDArray[np.float32], answers: NDArray[Any]) -> float:
    """How far the answers of an ONNX file differ, with whichever of onnxruntime and onnx is there."""
    try:
        from onnxruntime import InferenceSession

        run = InferenceSession(model, providers=["CPUExecutionProvider"]).run
    except ModuleNotFoundError:
        try:
            from onnx import load_from_string
            from onnx.reference import ReferenceEvaluator

            run = ReferenceEvaluator(load_from_string(model)).run
        except ModuleNotFoundError:
            return float("nan")
    found = np.concatenate([run(["mean"], {"state": observation[None]})[0] for observation in observations])
    difference = float(np.abs(found - answers).max())
    if not difference <= 1e-4:
        raise _native.Error(f"the ONNX file answers differently from the policy, by {difference:.2e}; nothing was written")
    return difference
