"""Environment steps per second from Python, beside Rust, PettingZoo alone and (if it is installed) VMAS.

    target/python/bin/python results/python/speed.py [SECONDS]

An environment step is one tick of 14 robots of `ex14_d`, safe profile, random horizons. Each figure is the median of five
takes of SECONDS (1). Prints a Markdown table: by the clock, and by the processor's time that the process itself had, which says
what a quiet machine would give where others were busy.
"""

from __future__ import annotations

import os
import pathlib
import platform
import resource
import statistics
import subprocess
import sys
import time

import numpy as np
import vodca
from gymnasium import spaces
from pettingzoo import ParallelEnv

SECONDS = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
TAKES, ROBOTS, MANY = 5, 14, 64
TICKS = 200  # of each environment in a take of many: about two episodes, for Rust as well
ROOT = pathlib.Path(__file__).resolve().parents[2]


Figure = tuple[float, float]
"""Environment steps per second, and per second of processor time."""


def medians(takes: list[Figure]) -> Figure:
    return statistics.median(take[0] for take in takes), statistics.median(take[1] for take in takes)


def rate(step, steps_each: int) -> Figure:
    """How often `step` plays `steps_each` environment steps."""

    def take() -> Figure:
        begun, used, calls = time.perf_counter(), time.process_time(), 0
        while True:
            step()
            calls += 1
            spent = time.perf_counter() - begun
            if spent > SECONDS:
                return calls * steps_each / spent, calls * steps_each / (time.process_time() - used)

    return medians([take() for _ in range(TAKES)])


class Empty(ParallelEnv):
    """Fourteen agents that see zeros: what PettingZoo's form of an environment costs by itself."""

    metadata = {"name": "empty"}

    def __init__(self) -> None:
        self.possible_agents = self.agents = [f"robot-{robot}" for robot in range(ROBOTS)]
        self._space = spaces.Box(-10, 10, (45,), np.float32)
        self._actions = np.zeros((1, ROBOTS), np.float32)

    def step(self, actions):
        for robot, agent in enumerate(self.agents):
            self._actions[0, robot] = actions[agent][0]
        seen, rewards = np.zeros((ROBOTS, 45), np.float32), np.zeros(ROBOTS)
        return (
            dict(zip(self.agents, seen)), dict(zip(self.agents, rewards.tolist())), dict.fromkeys(self.agents, False),
            dict.fromkeys(self.agents, False), {agent: {} for agent in self.agents},
        )


def drawn(count: int) -> list[np.ndarray]:
    rng = np.random.default_rng(3)
    return [rng.uniform(-1, 1, (count, ROBOTS)).astype(np.float32) for _ in range(256)]


def joint() -> Figure:
    env, actions, tick = vodca.Env("ex14_d"), drawn(1), 0
    env.reset()

    def step() -> None:
        nonlocal tick
        tick += 1
        _, _, terminated, truncated, _ = env.step(actions[tick % 256][0])
        if terminated or truncated:
            env.reset()

    return rate(step, 1)


def each(env: ParallelEnv) -> Figure:
    actions = [dict(zip(env.possible_agents, row[0][:, None])) for row in drawn(1)]
    tick = 0
    env.reset() if not isinstance(env, Empty) else None

    def step() -> None:
        nonlocal tick
        tick += 1
        env.step(actions[tick % 256])
        if not env.agents:
            env.reset()

    return rate(step, 1)


def many(threads: int) -> Figure:
    envs, actions = vodca.VectorEnv("ex14_d", MANY, threads=threads, autoreset="same_step"), drawn(MANY)

    def take() -> Figure:
        envs.reset(seed=0)
        begun, used = time.perf_counter(), time.process_time()
        for tick in range(TICKS):
            envs.step(actions[tick])
        return MANY * TICKS / (time.perf_counter() - begun), MANY * TICKS / (time.process_time() - used)

    return medians([take() for _ in range(TAKES)])


def rust(threads: int) -> Figure | None:
    program = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "environments"
    if not program.exists():
        return None
    command = [program, "ex14_d", str(MANY), str(TICKS)]
    if threads == 1:
        command = ["taskset", "-c", "0", *command]
    takes = []
    for _ in range(TAKES):
        used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - used
        takes.append((float(text.split("steps per second")[1]), MANY * TICKS / used))
    return medians(takes)


def vmas(count: int) -> Figure | None:
    try:
        import torch
        from vmas import make_env
    except ModuleNotFoundError:
        return None
    torch.set_num_threads(os.cpu_count() or 1)
    env = make_env("navigation", num_envs=count, device="cpu", n_agents=ROBOTS, seed=0)
    env.reset()
    actions = [torch.rand(count, 2) * 2 - 1 for _ in range(ROBOTS)]
    return rate(lambda: env.step(actions), count)


def main() -> None:
    busy = os.getloadavg()[0]
    cores = len(os.sched_getaffinity(0))
    rows: list[tuple[str, Figure | None]] = [
        ("`vodca.Env`, one environment", joint()),
        ("`vodca.parallel_env`, one environment, local observations", each(vodca.parallel_env("ex14_d"))),
        ("PettingZoo alone: 14 agents that see zeros", each(Empty())),
        (f"`vodca.VectorEnv`, {MANY} environments, 1 thread", many(1)),
        (f"`vodca.VectorEnv`, {MANY} environments, {cores} threads", many(cores)),
        (f"Rust (`examples/environments.rs`), {MANY} environments, 1 thread", rust(1)),
        (f"Rust, {MANY} environments, {cores} threads", rust(cores)),
        ("VMAS `navigation`, 14 agents, one environment", vmas(1)),
        (f"VMAS `navigation`, 14 agents, {MANY} environments", vmas(MANY)),
        ("VMAS `navigation`, 14 agents, 256 environments", vmas(256)),
    ]
    print(f"Python {platform.python_version()}, NumPy {np.__version__}, {cores} cores, load {busy:.1f} at the start\n")
    print("| what | environment steps per second | per second of processor time |\n|---|---|---|")
    for what, figure in rows:
        both = "not measured | not measured" if figure is None else f"{figure[0]:,.0f} | {figure[1]:,.0f}"
        print(f"| {what} | {both} |")


if __name__ == "__main__":
    main()
