"""One robot's controller in somebody else's loop."""

from __future__ import annotations

import numpy as np
import pytest
import vodca


@pytest.mark.parametrize("profile", ["safe", "paper", "orca"])
def test_controllers_in_a_loop_of_ones_own_drive_as_the_team_does(profile):
    run = vodca.run("ex14_d", profile=profile, horizon="random:2", max_ticks=60)
    robots = [vodca.Controller("ex14_d", robot, profile=profile) for robot in range(14)]
    at = run.scenario.starts.copy()
    for tick in range(run.ticks):
        np.testing.assert_array_equal(at, run.positions[tick])
        decisions = [
            robot.tick(at[number], horizon=int(run.horizons[tick, number])) for number, robot in enumerate(robots)
        ]
        np.testing.assert_array_equal([decision.input for decision in decisions], run.inputs[tick])
        assert [decision.rows for decision in decisions] == run.rows[tick].tolist()
        for robot in robots:
            for other, decision in enumerate(decisions):
                robot.hear(other, decision.plan)
        at += 0.2 * np.array([decision.input for decision in decisions])


def test_plans_of_the_same_tick_are_not_heard():
    robots = [vodca.Controller("two_setpoint", robot) for robot in range(2)]
    starts = vodca.Scenario.find("two_setpoint").starts
    plan = robots[0].tick(starts[0]).plan
    with pytest.raises(vodca.Error, match="call tick\\(\\) of all robots first, then hear\\(\\)"):
        robots[1].hear(0, plan)


def test_robots_without_plans_are_seen_and_kept_away_from():
    layout = vodca.Scenario([vodca.Robot((0, 0), (12, 0)), vodca.Robot((6, 0.1), (6, 0.1))])
    mine, at, other = vodca.Controller(layout, 0), np.zeros(2), np.array([6.0, 0.1])
    for tick in range(70):
        mine.see(1, other)
        decision = mine.tick(at, horizon=25)
        mine.hear(1, vodca.Plan(tick, [other] * 26, other))
        at = at + mine.sample_time * decision.input
        assert np.linalg.norm(at - other) >= 1.5 - 1e-9
    assert np.linalg.norm(at - [12, 0]) < 0.1
    assert decision.plan.states.shape == (26, 2) and decision.status == "solved"


def test_mistakes_say_what_is_allowed():
    with pytest.raises(vodca.Error, match="robot = 2 is not allowed; allowed: 0..=1"):
        vodca.Controller("two_setpoint", 2)
    mine = vodca.Controller("two_setpoint", 0)
    with pytest.raises(vodca.Error, match="horizon 0 is outside 1..=49"):
        mine.tick([0, 0], horizon=0)
    with pytest.raises(vodca.Error, match="finite"):
        mine.tick([0, float("inf")])
    with pytest.raises(vodca.Error, match="there is no robot 5"):
        mine.see(5, [0, 0])
    assert mine.next_tick == 0
