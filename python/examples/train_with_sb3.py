"""Soft actor-critic of Stable-Baselines3 on two robots that change places; the result drives with `./run.sh`.

    pip install './python[env]' stable-baselines3      # torch comes with it: gigabytes
    python python/examples/train_with_sb3.py [STEPS] [FOLDER]
"""

from __future__ import annotations

import sys
import time

import numpy as np
import torch
import vodca
from stable_baselines3 import SAC

TASK = dict(scenario="two_setpoint", profile="paper", start_jitter=0.1)
TESTS = 200


def play(act, seeds) -> tuple[np.ndarray, np.ndarray]:
    """Path over the straight lines (2: failed) and ticks of one episode for each seed."""
    cost, ticks = [], []
    for seed in seeds:
        env = vodca.Env(**TASK)
        seen, _ = env.reset(seed=int(seed))
        over = False
        while not over:
            seen, _, terminated, truncated, info = env.step(act(seen))
            over = terminated or truncated
        summary = info["summary"]
        cost.append(summary["path_ratio"] if summary["success"] else 2.0)
        ticks.append(summary["ticks"])
    return np.array(cost), np.array(ticks)


def fixed(horizon: int):
    return lambda seen: np.full(2, (horizon - 1.5) / 24 - 1, np.float32)


def main() -> None:
    steps = int(sys.argv[1]) if len(sys.argv) > 1 else 20_000
    folder = sys.argv[2] if len(sys.argv) > 2 else "policies/sb3_two"
    torch.set_num_threads(1)
    env = vodca.Env(**TASK, rewards="objective", seed=1)
    model = SAC("MlpPolicy", env, seed=1, gamma=0.98, learning_starts=2_000, policy_kwargs=dict(net_arch=[64, 64]))
    begun = time.process_time()
    model.learn(steps)
    print(f"{steps} steps in {time.process_time() - begun:.0f} s of processor time")
    unseen = range(2_000_000, 2_000_000 + TESTS)
    policy, policy_ticks = play(lambda seen: model.predict(seen, deterministic=True)[0], unseen)
    for horizon in (2, 7):
        cost, ticks = play(fixed(horizon), unseen)
        gain = 100 * (1 - policy.mean() / cost.mean())
        print(f"fixed {horizon}: {cost.mean():.3f} in {ticks.mean():.0f} ticks; the policy is {gain:.1f} % better")
    print(f"policy:  {policy.mean():.3f} in {policy_ticks.mean():.0f} ticks, {(policy == 2).sum()} of {TESTS} failed")
    exported = vodca.export(model, folder, env)
    print(f"./run.sh 2 --profile paper --policy {exported.folder}   # version {exported.version}")


if __name__ == "__main__":
    main()
