"""A policy that was trained in Python drives."""

from __future__ import annotations

import json
import subprocess

import numpy as np
import pytest
import vodca

from conftest import ROOT, TARGET


def network(robots: int, seed: int = 0, hidden: int = 8):
    rng = np.random.default_rng(seed)
    layer = lambda outputs, inputs: (rng.normal(0, 0.5, (outputs, inputs)), rng.normal(0, 0.1, outputs))  # noqa: E731
    return [layer(hidden, 2 * robots), layer(hidden, hidden), layer(robots, hidden)]


@pytest.mark.parametrize("activation", ["relu", "tanh"])
def test_layers_become_a_version_with_contract_and_reference_set(tmp_path, activation):
    env = vodca.Env("ex14_d")
    exported = vodca.export(network(14), tmp_path / "mine", env, activation=activation, horizon=(5, 40))
    assert exported.version == "v000001" and exported.difference < 1e-5
    manifest = json.loads((tmp_path / "mine" / "v000001" / "manifest.json").read_text())
    assert manifest["robots"] == 14 and manifest["action_map"] == "tanh" and manifest["horizon"] == {"min": 5, "max": 40}
    assert (manifest["observation"]["offset"], manifest["observation"]["scale"]) == tuple(map(list, env.scaling))
    reference = json.loads((tmp_path / "mine" / "v000001" / "reference.json").read_text())
    assert len(reference["cases"]) == 32 and all(5 <= n <= 40 for case in reference["cases"] for n in case["horizon"])
    assert vodca.export(network(14, 1), tmp_path / "mine", env).version == "v000002"


def test_what_cannot_drive_is_refused_and_nothing_is_written(tmp_path):
    env = vodca.Env("two_setpoint")
    broken = network(2)
    broken[1][0][0, 0] = np.nan
    cases = [
        (network(3), env, "with 4 inputs they must be"),
        (network(2)[:2], env, "the policy's answer has the shape \\[8\\]"),
        (broken, env, "a number that is not finite; nothing was written"),
        (lambda seen: seen, env, "a function is no policy"),
        (network(2), vodca.Env("two_setpoint", observation="local"), 'observation="positions"'),
        (network(2), vodca.Env("two_setpoint", actions="horizon"), 'actions="continuous"'),
    ]
    for policy, where, part in cases:
        with pytest.raises(vodca.Error, match=part):
            vodca.export(policy, tmp_path / "mine", where)
    with pytest.raises(vodca.Error, match="1 <= min <= max <= 49"):
        vodca.export(network(2), tmp_path / "mine", env, horizon=(0, 60))
    assert not (tmp_path / "mine").exists()


def test_the_policy_server_takes_it_and_robots_drive_as_in_the_environment(tmp_path, program):
    server = TARGET / "release" / "policy-server"
    if not server.exists():
        pytest.skip("the policy server is not built: ./run.sh policy --help builds it")
    env = vodca.Env("two_setpoint", profile="paper")
    layers = network(2, 3)
    vodca.export(layers, tmp_path / "mine", env)
    subprocess.run([server, "check", tmp_path / "mine"], check=True, capture_output=True)
    folder = tmp_path / "run"
    command = [program, "run", "2", "--profile", "paper", "--policy", tmp_path / "mine", "--out", folder]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode in (0, 1), done.stderr
    driven = vodca.read(folder)
    seen, _ = env.reset()
    for tick in range(driven.ticks):
        values = seen.astype(np.float64)
        for weight, bias in layers[:-1]:
            values = np.maximum(weight.astype(np.float32) @ values + bias.astype(np.float32), 0)
        action = np.tanh(layers[-1][0].astype(np.float32) @ values + layers[-1][1].astype(np.float32))
        seen = env.step(action)[0]
        np.testing.assert_array_equal(env.horizons, driven.horizons[tick])
    np.testing.assert_array_equal(env.measured(), driven.positions[-1])
