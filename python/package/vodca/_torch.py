"""Policies of torch and Stable-Baselines3. The only file that imports torch."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import nn

from . import _native


def layers_of(module: nn.Module) -> tuple[list[tuple[NDArray[np.float32], NDArray[np.float32]]] | None, str, bool]:
    """The layers of a multilayer network (`None`: it is another one), their activation, and whether a tanh ends it."""
    parts = [part for part in _flat(module) if not isinstance(part, (nn.Identity, nn.Dropout, nn.Flatten))]
    ends_in_tanh = bool(parts) and isinstance(parts[-1], nn.Tanh)
    parts = parts[:-1] if ends_in_tanh else parts
    linear, between = parts[::2], parts[1::2]
    kinds = {type(part) for part in between}
    fits = len(parts) % 2 == 1 and all(type(part) is nn.Linear for part in linear) and len(kinds) <= 1
    if not fits or not kinds <= {nn.ReLU, nn.Tanh}:
        return None, "relu", False
    layers = []
    for part in linear:
        weight = part.weight.detach().cpu().float().numpy()
        bias = np.zeros(len(weight), np.float32) if part.bias is None else part.bias.detach().cpu().float().numpy()
        layers.append((np.ascontiguousarray(weight), np.ascontiguousarray(bias)))
    return layers, "tanh" if kinds == {nn.Tanh} else "relu", ends_in_tanh


def _flat(module: nn.Module) -> list[nn.Module]:
    if type(module) is nn.Sequential:
        return [part for child in module for part in _flat(child)]
    return [module]


def answers(module: nn.Module) -> Callable[[NDArray[np.float32]], NDArray[Any]]:
    """What the module itself answers."""

    def answer(observations: NDArray[np.float32]) -> NDArray[Any]:
        training = module.training
        module.eval()
        with torch.no_grad():
            given = torch.from_numpy(observations).to(next(module.parameters()).device)
            found: NDArray[Any] = module(given).cpu().numpy()
        module.train(training)
        return found

    return answer


def onnx_of(module: nn.Module, inputs: int) -> bytes:
    """The module as an ONNX file, input `state` [batch, inputs], output `mean`."""
    module = module.cpu().eval()
    file = io.BytesIO()
    torch.onnx.export(
        module, (torch.zeros(1, inputs),), file, input_names=["state"], output_names=["mean"], opset_version=17,
        dynamic_axes={"state": {0: "batch"}, "mean": {0: "batch"}}, dynamo=False,
    )
    return file.getvalue()


def of_stable_baselines(model: Any) -> tuple[nn.Module, bool]:
    """The actor of a model as one module, and whether its answer has still to be squashed by tanh."""
    policy = model.policy
    actor = getattr(policy, "actor", None)
    if actor is not None and hasattr(actor, "latent_pi"):  # SAC
        return nn.Sequential(actor.latent_pi, actor.mu), True
    if actor is not None and hasattr(actor, "mu"):  # TD3, DDPG: the last layer is a tanh
        return actor.mu, False
    if hasattr(policy, "mlp_extractor") and hasattr(policy, "action_net"):  # PPO, A2C: the action itself, clipped
        return nn.Sequential(policy.mlp_extractor.policy_net, policy.action_net), False
    raise _native.Error(
        f"the policy {type(policy).__name__} has no multilayer actor that is known; give its torch module instead"
    )
