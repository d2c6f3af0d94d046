"""The environments are what PettingZoo, Gymnasium and SuperSuit expect, and what the product plays."""

from __future__ import annotations

import warnings

import gymnasium
import numpy as np
import pytest
import supersuit
import vodca
from gymnasium.utils.env_checker import check_env
from pettingzoo.test import parallel_api_test, parallel_seed_test

TASKS = [dict(scenario="two_setpoint", profile="paper"), dict(scenario="box:6:2:1", profile="safe", start_jitter=0.2)]


@pytest.mark.parametrize("actions", ["continuous", "horizon"])
@pytest.mark.parametrize("task", TASKS)
def test_the_parallel_environment_passes_pettingzoo(task, actions, capsys):
    parallel_api_test(vodca.parallel_env(**task, actions=actions), num_cycles=1000)
    parallel_seed_test(lambda: vodca.parallel_env(**task, actions=actions))
    assert "passed" in capsys.readouterr().out.lower()


@pytest.mark.parametrize("observation", ["positions", "local"])
@pytest.mark.parametrize("actions", ["continuous", "horizon"])
@pytest.mark.parametrize("task", TASKS)
def test_the_joint_environment_passes_gymnasium(task, actions, observation):
    env = vodca.Env(**task, actions=actions, observation=observation)
    check_env(env, skip_render_check=True)
    seen, _ = env.reset(seed=3)
    assert seen in env.observation_space


def test_supersuit_makes_a_vector_environment_of_it():
    one = vodca.parallel_env("four_gate")
    many = supersuit.concat_vec_envs_v1(supersuit.pettingzoo_env_to_vec_env_v1(one), 2, base_class="gymnasium")
    seen, _ = many.reset(seed=1)
    assert seen.shape == (8, 5 + 4 * 8 + 2 * 4)
    ends = 0
    for _ in range(400):
        seen, rewards, terminated, truncated, _ = many.step(np.zeros((8, 1), np.float32))
        ends += int((terminated | truncated).any())
    assert ends >= 2


@pytest.mark.parametrize("profile", ["safe", "paper"])
def test_a_script_of_horizons_gives_the_run_step_for_step(profile):
    run = vodca.run("ex14_d", profile=profile, horizon="random:4", horizon_jitter=0)
    shared = dict(scenario="ex14_d", profile=profile, horizon_jitter=0)
    joint = vodca.Env(**shared, actions="horizon")
    drawn = vodca.Env(**shared)
    each = vodca.parallel_env(**shared, actions="horizon", rewards="paper")
    many = vodca.VectorEnv(**shared, num_envs=3, actions="horizon")
    seen, _ = joint.reset()
    own, _ = each.reset()
    drawn.reset(), many.reset(seed=[run.scenario.seed] * 3)
    offset, scale = (np.tile(numbers, 14) for numbers in joint.scaling)
    for tick in range(run.ticks):
        np.testing.assert_array_equal(joint.measured(), run.positions[tick])
        np.testing.assert_array_equal(seen, ((run.positions[tick].ravel() - offset) * scale).astype(np.float32))
        chosen = run.horizons[tick].astype(np.int64)
        seen, reward, terminated, truncated, info = joint.step(chosen)
        assert reward == run.rewards[tick]
        drawn.step((chosen - 1.5) / 24 - 1)
        np.testing.assert_array_equal(drawn.measured(), joint.measured())
        own, rewards, *_ = each.step(dict(zip(each.agents, chosen)))
        np.testing.assert_array_equal(list(rewards.values()), run.robot_rewards("paper")[tick])
        _, rewards, *_ = many.step(np.tile(chosen, (3, 1)))
        assert (rewards == reward).all()
        if terminated or truncated:
            break
    # An environment ends with a collision, a run does not.
    assert terminated == (run.summary["collisions"] > 0) and tick > 20
    assert terminated or info["summary"]["path_cost"] == run.summary["path_cost"]
    with pytest.raises(vodca.Error, match="call reset\\(\\)"):
        joint.step(chosen)


def test_fixed_horizons_are_jittered_as_in_a_run():
    run = vodca.run("ring:5", horizon=20, seed=4)
    env = vodca.Env("ring:5", actions="horizon")
    env.reset(seed=4)
    for tick in range(run.ticks):
        env.step([20] * 5)
        np.testing.assert_array_equal(env.horizons, run.horizons[tick])
    np.testing.assert_array_equal(env.measured(), run.positions[-1])


def test_the_reward_of_a_robot_is_its_own():
    run = vodca.run("four_gate", profile="paper", horizon=24)
    env = vodca.parallel_env("four_gate", profile="paper", actions="horizon")
    env.reset()
    for tick in range(run.ticks):
        _, rewards, *_ = env.step(dict.fromkeys(env.agents, 24))
        np.testing.assert_array_equal(list(rewards.values()), run.robot_rewards()[tick])
    assert env.agents == [], "all leave together"


def test_a_team_may_earn_by_path_and_time():
    run = vodca.run("four_gate", horizon=24)
    env = vodca.Env("four_gate", actions="horizon", rewards="objective")
    env.reset()
    earned = [env.step([24] * 4)[1] for _ in range(run.ticks)]
    np.testing.assert_allclose(earned, run.robot_rewards().sum(axis=1), rtol=1e-12)
    with pytest.raises(vodca.Error, match='allowed: "paper", "objective"'):
        vodca.Env("four_gate", rewards="mine")


def test_seeds_decide_and_every_episode_has_starts_of_its_own():
    envs = [vodca.Env("two_setpoint", profile="paper", start_jitter=0.3) for _ in range(2)]
    first = [env.reset(seed=5)[0] for env in envs]
    second = [env.reset()[0] for env in envs]
    np.testing.assert_array_equal(first[0], first[1])
    np.testing.assert_array_equal(second[0], second[1])
    assert (first[0] != second[0]).any() and (envs[0].reset(seed=6)[0] != first[0]).any()
    np.testing.assert_array_equal(envs[0].reset(seed=5)[0], first[0])
    layouts = vodca.Env("box:4:1:0", family="box:4:1")
    starts = [(layouts.reset(), layouts.measured())[1] for _ in range(3)]
    assert (starts[0] != starts[1]).any() and (starts[1] != starts[2]).any()


@pytest.mark.parametrize("mode", ["next_step", "same_step"])
def test_a_vector_of_environments_is_environments_side_by_side(mode):
    shared = dict(scenario="two_setpoint", profile="paper", start_jitter=0.3, actions="horizon")
    many = vodca.VectorEnv(**shared, num_envs=5, autoreset=mode)
    assert isinstance(many, gymnasium.vector.VectorEnv)
    alone = [vodca.Env(**shared) for _ in range(5)]
    seen, _ = many.reset(seed=11)
    for index, env in enumerate(alone):
        np.testing.assert_array_equal(seen[index], env.reset(seed=11 + index)[0])
    rng, over, ends = np.random.default_rng(1), [False] * 5, 0
    for _ in range(250):
        chosen = rng.integers(1, 50, (5, 2))
        seen, rewards, terminated, truncated, infos = many.step(chosen)
        for index, env in enumerate(alone):
            if over[index]:
                expected, reward, ended, cut, info = env.reset()[0], 0.0, False, False, {}
            else:
                expected, reward, ended, cut, info = env.step(chosen[index])
            assert (rewards[index], terminated[index], truncated[index]) == (reward, ended, cut)
            if ended or cut:
                ends += 1
                assert infos["summary"]["path_cost"][index] == info["summary"]["path_cost"]
                if mode == "same_step":
                    np.testing.assert_array_equal(infos["final_obs"][index], expected)
                    expected = env.reset()[0]
            np.testing.assert_array_equal(seen[index], expected)
            over[index] = (ended or cut) and mode == "next_step"
    assert ends >= 5


def test_mistakes_say_what_is_allowed():
    env = vodca.Env("two_setpoint")
    env.reset()
    for action, part in [([0.5], "must be \\[2\\]"), ([np.nan, 0], "robot 0 is not a finite number")]:
        with pytest.raises(vodca.Error, match=part):
            env.step(np.array(action, np.float32))
    with pytest.raises(vodca.Error, match="horizon 50 is outside 1..=49"):
        horizons = vodca.Env("two_setpoint", actions="horizon")
        horizons.reset()
        horizons.step([50, 1])
    with pytest.raises(vodca.Error, match='allowed: "positions", "local"'):
        vodca.Env("two_setpoint", observation="camera")
    with pytest.raises(vodca.Error, match="num_envs = 0"):
        vodca.VectorEnv("two_setpoint", 0)
    with pytest.raises(vodca.Error, match="start_jitter = -1"):
        vodca.Env("two_setpoint", start_jitter=-1)
    with pytest.raises(vodca.Error, match="no start within"):
        vodca.Env("ring:8", start_jitter=0.1, model_min_separation=1.5, params={}).reset(seed=1) if False else (
            vodca.Scenario.find("ring:8").jittered(0.1, 1, 9.0)
        )
    agents = vodca.parallel_env("two_setpoint")
    agents.reset()
    with pytest.raises(vodca.Error, match="there is no action of agent 'robot-1'"):
        agents.step({"robot-0": [0.0]})


def test_nothing_of_it_warns():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = vodca.parallel_env("two_setpoint")
        env.reset(seed=1)
        env.step({agent: env.action_space(agent).sample() for agent in env.agents})
