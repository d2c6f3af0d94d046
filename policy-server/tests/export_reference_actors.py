#!/usr/bin/env python3
"""Exports the reference actors in tests/actors with PyTorch, together with what PyTorch answers.

    pip install torch onnx onnxscript numpy
    python3 policy-server/tests/export_reference_actors.py policy-server/tests/actors

Written with torch 2.15, onnx 1.23, onnxscript 0.7. Each actor is a small squashed-Gaussian network
(SAC, CleanRL form) for three robots; NAME.json is its contract and NAME.reference.json what
PyTorch gives for eight observations. Both exporters, opsets 11 to 23, dynamic and fixed batch, with and
without log_std.
"""

import json
import math
import pathlib
import sys

import numpy
import onnx
import torch

ROBOTS = 3
HIDDEN = 24
SCALE = 0.02  # 1/m; the network sees positions of 50 m as 1


class Actor(torch.nn.Module):
    def __init__(self, samples):
        super().__init__()
        self.first = torch.nn.Linear(2 * ROBOTS, HIDDEN)
        self.second = torch.nn.Linear(HIDDEN, HIDDEN)
        self.mean = torch.nn.Linear(HIDDEN, ROBOTS)
        self.log_std = torch.nn.Linear(HIDDEN, ROBOTS) if samples else None
        with torch.no_grad():
            self.mean.weight *= 8.0  # horizons that differ

    def forward(self, state):
        hidden = torch.relu(self.second(torch.relu(self.first(state))))
        if self.log_std is None:
            return self.mean(hidden)
        return self.mean(hidden), torch.clamp(self.log_std(hidden), -20.0, 2.0)


def export(folder, name, opset, dynamo, dynamic, samples):
    actor = Actor(samples).eval()
    path = folder / f"{name}.onnx"
    outputs = ["mean", "log_std"] if samples else ["mean"]
    state = torch.zeros(2 if dynamic else 1, 2 * ROBOTS)
    arguments = dict(input_names=["state"], output_names=outputs, opset_version=opset, dynamo=dynamo)
    if dynamo:
        # Else the weights go to a second file.
        arguments["external_data"] = False
        if dynamic:
            arguments["dynamic_shapes"] = ({0: torch.export.Dim("batch")},)
    elif dynamic:
        arguments["dynamic_axes"] = {port: {0: "batch"} for port in ["state"] + outputs}
    torch.onnx.export(actor, (state,), str(path), **arguments)
    forget_where(path)

    def shape(width):
        return ["batch" if dynamic else 1, width]

    contract = {
        "schema": "vodca/policy/1",
        "name": name,
        "robots": ROBOTS,
        "observation": {
            "kind": "positions",
            "layout": "xy_interleaved",
            "offset": [0.0, 0.0],
            "scale": [SCALE, SCALE],
        },
        "input": {"name": "state", "shape": shape(2 * ROBOTS)},
        "outputs": {port: {"name": port, "shape": shape(ROBOTS)} for port in outputs},
        "action_map": "tanh",
    }
    path.with_suffix(".json").write_text(json.dumps(contract, indent=2) + "\n")
    path.with_suffix(".reference.json").write_text(json.dumps(reference(actor, samples)) + "\n")


def forget_where(path):
    """The newer exporter notes the stack trace, with paths of this machine, on every node."""
    model = onnx.load(path)
    for noted in [model.graph, *model.graph.node, *model.graph.value_info, *model.graph.initializer]:
        noted.ClearField("metadata_props")
        noted.ClearField("doc_string")
    onnx.checker.check_model(model, full_check=True)
    onnx.save(model, path)


def reference(actor, samples):
    cases = []
    for _ in range(8):
        observation = (numpy.random.rand(2 * ROBOTS) * 100.0 - 50.0).round(3)
        with torch.no_grad():
            answer = actor(torch.tensor((observation * SCALE).astype(numpy.float32))[None])
        mean, log_std = answer if samples else (answer, None)
        mean = [float(value) for value in mean[0]]
        horizon = [max(1, min(49, math.ceil(1.0 + (math.tanh(value) + 1.0) * 24.0))) for value in mean]
        case = {"observation": observation.tolist(), "mean": mean, "horizon": horizon}
        if samples:
            case["log_std"] = [float(value) for value in log_std[0]]
        cases.append(case)
    return {"tolerance": 1e-5, "cases": cases}


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    torch.manual_seed(1)
    numpy.random.seed(1)
    for opset in (11, 13, 17, 18):
        export(folder, f"legacy_opset{opset}_dynamic", opset, False, True, True)
    export(folder, "legacy_opset17_fixed", 17, False, False, True)
    export(folder, "legacy_opset17_mean_only", 17, False, True, False)
    for opset in (18, 20, 23):
        export(folder, f"dynamo_opset{opset}_dynamic", opset, True, True, True)
    export(folder, "dynamo_opset18_fixed", 18, True, False, True)
    export(folder, "dynamo_opset18_mean_only", 18, True, True, False)


if __name__ == "__main__":
    main()
