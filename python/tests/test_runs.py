"""A run from Python is the run of the command line, and says all that the record says."""

from __future__ import annotations

import numpy as np
import pytest
import vodca

# Few robots beside the large ones: each is a process of its own.
SCENARIOS = [
    "two_setpoint", "four_gate", "four_cross", "ex14_a", "ex14_d", "antipodal8", "ring:5", "box:6:2:3", "exchange:6:1",
    "rand8o3_s0",
]


@pytest.mark.parametrize("profile", ["safe", "paper"])
@pytest.mark.parametrize("name", SCENARIOS)
def test_a_run_has_the_bytes_of_the_command_line(recorded, name, profile):
    arguments = ["--profile", profile, "--horizon", "random:3", "--seed", "5", "--max-ticks", "80"]
    folder = recorded(name, *arguments)
    run = vodca.run(name, profile=profile, horizon="random:3", seed=5, max_ticks=80)
    assert run.trajectory() == (folder / "trajectory.csv").read_text()


def test_a_recorded_run_reads_back_to_the_same_numbers(recorded):
    read = vodca.read(recorded("four_gate", "--horizon", "fixed:24"))
    run = vodca.run("four_gate", horizon=24)
    for name in ("positions", "inputs", "horizons", "rows", "levels", "statuses", "separations", "rewards"):
        np.testing.assert_array_equal(getattr(read, name), getattr(run, name), err_msg=name)
    for figure in ("success", "ticks", "path_cost", "min_separation", "guarantee", "lower_bound"):
        assert read.summary[figure] == run.summary[figure]
    assert read.plan(3, 1).shape == (run.horizons[3, 1] + 1, 2)
    np.testing.assert_allclose(read.plan(3, 1), run.plan(3, 1), atol=1e-9)
    with pytest.raises(vodca.Error, match="recorded already"):
        read.save()


def test_a_saved_run_is_a_recorded_one(tmp_path, program):
    import subprocess

    run = vodca.run("ring:5", horizon="random:1")
    folder = run.save(tmp_path / "run")
    assert vodca.read(folder).summary == run.summary
    for command in ("verify", "replay"):
        subprocess.run([program, command, folder], check=True, capture_output=True)
    with pytest.raises(vodca.Error, match="runs are never overwritten"):
        run.save(folder)


def test_arrays_have_their_shapes_and_follow_the_model():
    run = vodca.run("ex14_d")
    ticks, robots = run.ticks, len(run.scenario)
    assert run.positions.shape == (ticks + 1, robots, 2) and run.inputs.shape == (ticks, robots, 2)
    assert run.horizons.shape == run.rows.shape == run.levels.shape == run.statuses.shape == (ticks, robots)
    assert run.rewards.shape == (ticks,) and run.time.shape == (ticks + 1,)
    np.testing.assert_array_equal(run.positions[0], run.scenario.starts)
    moved = np.diff(run.positions, axis=0)
    np.testing.assert_allclose(moved, 0.2 * run.inputs, atol=1e-12)
    path = np.linalg.norm(moved, axis=2).sum()
    assert path == pytest.approx(run.summary["path_cost"])
    assert run.separations.min() == pytest.approx(run.summary["min_separation"])
    objective = run.robot_rewards()
    late = (np.linalg.norm(run.scenario.set_points - run.positions[1:], axis=2) >= 0.1).sum()
    nearer = np.linalg.norm(run.scenario.set_points - run.positions, axis=2)
    assert objective.sum() == pytest.approx(-(path - (nearer[0] - nearer[-1]).sum()) - 0.03 * late)
    variance = run.horizons.astype(float).var(axis=1)
    np.testing.assert_allclose(run.robot_rewards("paper").sum(axis=1) - variance, run.rewards, rtol=1e-9)


def test_horizons_come_from_numbers_arrays_and_functions():
    script = vodca.run("four_gate", horizon="random:7", horizon_jitter=0)
    for given in (script.horizons, script.horizons.tolist(), lambda tick, at: script.horizons[tick]):
        again = vodca.run("four_gate", horizon=given)
        assert again.trajectory() == script.trajectory()
    assert (vodca.run("two_setpoint", profile="paper", horizon=[9, 40]).horizons == [9, 40]).all()
    seen = []
    vodca.run("two_setpoint", horizon=lambda tick, at: seen.append(at) or 20, max_ticks=3, seed=1)
    assert len(seen) == 3 and seen[0].shape == (2, 2)


def test_a_scenario_is_made_of_python_objects():
    run = vodca.run(
        vodca.Scenario(
            [vodca.Robot(start=(0, 0), set_point=np.array([9.0, 0.0]), name="left"), {"start": [9, 3], "set_point": [0, 3]}],
            [vodca.Obstacle(position=(4.5, -3), radius=1.0)],
            name="mine",
            max_ticks=90,
        )
    )
    assert run.summary["success"] and run.scenario.names == ["left", "robot-1"]
    assert run.scenario.max_ticks == 90 and run.scenario.obstacle_radii == [1.0]
    copy = vodca.Scenario.from_toml(run.scenario.to_toml())
    assert copy == run.scenario and vodca.run(copy).trajectory() == run.trajectory()
    file = vodca.Scenario.find("ex14_d")
    assert len(file) == 14 and file.starts.shape == (14, 2)


def test_walls_are_kept_away_from_and_read_back():
    wall = {"wall": [[5, -1], [5, 1]], "thickness": 0.2}
    layout = vodca.Scenario([vodca.Robot((0, 0), (10, 0)), vodca.Robot((10, 3), (0, 3))], [vodca.Obstacle((5, -4)), wall])
    run = vodca.run(layout)
    assert run.summary["success"] and run.summary["path_ratio"] > 1.01
    assert vodca.Scenario.from_toml(layout.to_toml()) == layout


def test_a_scenario_is_found_by_file_name_and_number(tmp_path):
    layout = vodca.Scenario.find("four_gate")
    (tmp_path / "mine.toml").write_text(layout.to_toml())
    by_file = vodca.run(tmp_path / "mine.toml", max_ticks=5)
    assert by_file.trajectory() == vodca.run(4, max_ticks=5).trajectory() == vodca.run(layout, max_ticks=5).trajectory()


def test_mistakes_are_told_as_on_the_command_line(program):
    import subprocess

    def said(*arguments):
        done = subprocess.run([program, "run", *arguments], capture_output=True, text=True, check=False)
        assert done.returncode == 2
        return done.stderr.removeprefix("error: ").rstrip("\n")

    cases = [
        (dict(scenario="ex14d"), ["--scenario", "ex14d"]),
        (dict(scenario="two_setpoint", vodca_turn=9), ["--scenario", "two_setpoint", "--set", "vodca.turn=9"]),
        (dict(scenario="two_setpoint", params={"vodca": {"rws": 1}}), ["2", "--set", "vodca.rws=1"]),
        (dict(scenario="two_setpoint", rows="each"), ["2", "--set", "rows=each"]),
        (dict(scenario="two_setpoint", horizon=[9, 40, 3]), ["2", "--horizon", "fixed:9,40,3"]),
        (dict(scenario="ex14_d", model_min_separation=3.5), ["14", "--set", "model.min_separation=3.5"]),
    ]
    for keywords, arguments in cases:
        with pytest.raises(vodca.Error) as refused:
            vodca.run(**keywords)
        assert str(refused.value) == said(*arguments)
    with pytest.raises(vodca.Error, match="unknown profile `fast`"):
        vodca.run(2, profile="fast")
    with pytest.raises(vodca.Error, match="max_ticks = 0 is not allowed"):
        vodca.run(2, max_ticks=0)
    with pytest.raises(vodca.Error, match="unknown field `goal`"):
        vodca.Scenario([{"start": [0, 0], "goal": [1, 1]}])
    with pytest.raises(vodca.Error, match="must be finite|coordinates"):
        vodca.Scenario([{"start": [0, float("nan")], "set_point": [1, 1]}])
    with pytest.raises(vodca.Error, match="give the folder of a recorded run"):
        vodca.read("no/such/folder")
    with pytest.raises(vodca.Error, match="at tick 0: horizon 50 is outside 1..=49"):
        vodca.run(2, horizon=lambda tick, at: [50, 1])


def test_parameters_are_keywords_and_documented():
    known = {parameter.key: parameter for parameter in vodca.parameters("paper")}
    assert len(known) > 40 and known["model.min_separation"].unit == "m"
    values = vodca.effective_parameters("two_setpoint", params={"vodca.turn": 0.25}, cell_enabled=False, vodca_rows="first")
    assert (values["vodca.turn"], values["cell.enabled"], values["vodca.rows"]) == (0.25, False, "first")
    for key, parameter in known.items():
        assert f"{key.replace('.', '_')}: {parameter.effect}" in vodca.run.__doc__
        given = {key.replace(".", "_"): parameter.value}
        assert vodca.effective_parameters("two_setpoint", profile="paper", **given)[key] == parameter.value
    assert "model.sample_time" in repr(vodca.parameters()) and "<table>" in vodca.parameters()._repr_html_()


def test_the_keywords_of_the_type_stubs_are_those_of_the_table():
    import importlib.util
    import pathlib

    place = pathlib.Path(__file__).parents[1] / "keywords.py"
    spec = importlib.util.spec_from_file_location("keywords", place)
    keywords = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(keywords)
    assert keywords.FILE.read_text() == keywords.text(), "run python/keywords.py"


def test_pages_and_pictures(tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    run = vodca.run("four_gate")
    assert run._repr_html_().startswith("<iframe srcdoc=")
    assert "four_gate" in run.report(tmp_path / "page.html") and (tmp_path / "page.html").stat().st_size > 50_000
    assert len(run.plot().lines) == 4 * 3
    vodca.run("four_gate", max_ticks=3).animate().save(tmp_path / "run.gif", writer="pillow")
    matplotlib.pyplot.close("all")
    assert (tmp_path / "run.gif").stat().st_size > 1_000
    text = str(run.summary)
    assert "success         yes" in text and "guarantee" in text and "<table>" in run.summary._repr_html_()
