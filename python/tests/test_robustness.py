"""Exceptions, Ctrl-C, forks, threads and ten thousand episodes leave nothing behind and hang nobody."""

from __future__ import annotations

import gc
import os
import pickle
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
import vodca


def resident() -> int:
    """Memory of this process, kB."""
    with open("/proc/self/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))


def test_ten_thousand_episodes_leave_no_growth():
    many = vodca.VectorEnv(
        "two_setpoint", 64, profile="paper", max_ticks=12, start_jitter=0.1, autoreset="same_step", actions="horizon"
    )
    many.reset(seed=1)
    chosen = np.full((64, 2), 9)

    def play(episodes: int) -> None:
        ended = 0
        while ended < episodes:
            _, _, terminated, truncated, _ = many.step(chosen)
            ended += int((terminated | truncated).sum())

    play(8_000)
    gc.collect()
    before = resident()
    play(10_000)
    gc.collect()
    assert resident() - before < 3_000, "kB"


def test_runs_leave_no_growth():
    for _ in range(5):
        vodca.run("ex14_d").positions
    before = resident()
    for _ in range(60):
        run = vodca.run("ex14_d")
        assert run.positions.shape[1] == 14 and run.summary["success"]
    gc.collect()
    assert resident() - before < 6_000, "kB"


def test_an_exception_in_a_function_of_horizons_is_what_the_caller_gets():
    class Mine(Exception):
        pass

    def horizon(tick, at):
        if tick == 7:
            raise Mine("at tick 7")
        return 20

    for _ in range(50):
        with pytest.raises(Mine, match="at tick 7"):
            vodca.run("four_gate", horizon=horizon)
    assert vodca.run("four_gate").summary["success"]


def test_ctrl_c_ends_a_run():
    # A parent that ignores the signal, as `nohup ... &` does, hands that down.
    caught = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    code = caught + "import vodca; print('here', flush=True)\nwhile True: vodca.run('ring:60', max_ticks=100000, episode_arrival_tolerance=1e-9)"
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "here\n"
        child.send_signal(signal.SIGINT)
        try:
            _, said = child.communicate(timeout=120)
        finally:
            child.kill()
    assert "KeyboardInterrupt" in said and child.returncode != 0


def test_a_forked_child_plays_on_with_threads_of_its_own():
    many = vodca.VectorEnv("two_setpoint", 8, profile="paper", threads=2)
    many.reset(seed=1)
    chosen = np.zeros((8, 2), np.float32)
    many.step(chosen)
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        signal.alarm(60)  # a child that hangs is ended
        seen = many.step(chosen)[0]
        os.write(writer, seen.tobytes())
        del many
        os._exit(0)
    expected = many.step(chosen)[0]
    _, status = os.waitpid(child, 0)
    assert os.waitstatus_to_exitcode(status) == 0
    np.testing.assert_array_equal(np.frombuffer(os.read(reader, 4096), np.float32).reshape(8, 4), expected)


def test_threads_play_their_own_environments_at_once():
    found: dict[int, list[float]] = {}

    def play(number: int) -> None:
        env = vodca.Env("four_gate", profile="paper", actions="horizon")
        env.reset(seed=number % 2)
        found[number] = [env.step([24] * 4)[1] for _ in range(60)] + [vodca.run("ring:5").summary["path_cost"]]

    threads = [threading.Thread(target=play, args=(number,)) for number in range(8)]
    [thread.start() for thread in threads]
    [thread.join(timeout=120) for thread in threads]
    assert len(found) == 8 and all(found[number] == found[number % 2] for number in range(8))


def test_two_threads_in_one_environment_get_an_error_or_their_step():
    many = vodca.VectorEnv("ex14_d", 32, max_ticks=1000)
    many.reset(seed=1)
    chosen, wrong = np.zeros((32, 14), np.float32), []

    def play() -> None:
        for _ in range(20):
            try:
                many.step(chosen)
            except RuntimeError as error:
                assert "borrowed" in str(error)
            except Exception as error:  # noqa: BLE001 - whatever else it is fails the test
                wrong.append(error)

    threads = [threading.Thread(target=play) for _ in range(4)]
    [thread.start() for thread in threads]
    [thread.join(timeout=120) for thread in threads]
    assert not wrong and not any(thread.is_alive() for thread in threads)


def test_scenarios_can_be_sent_to_other_processes():
    layout = vodca.Scenario.find("ex14_d")
    assert pickle.loads(pickle.dumps(layout)) == layout


def test_what_needs_gymnasium_says_so_without_it():
    code = (
        "import sys; sys.modules['gymnasium'] = None\nimport vodca\nprint(vodca.run('two_setpoint', max_ticks=3).ticks)\n"
        "try: vodca.Env\nexcept ModuleNotFoundError as error: print(error)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == ["3", "vodca.Env needs gymnasium; install it: pip install gymnasium"]
