"""Pictures of runs. The only file that imports matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from ._run import Run


def _matplotlib() -> Any:
    try:
        import matplotlib.pyplot as pyplot
    except ModuleNotFoundError as missing:
        raise ModuleNotFoundError(
            "pictures need matplotlib; install it: pip install matplotlib", name="matplotlib"
        ) from missing
    return pyplot


def _radii(run: Run, given: np.ndarray) -> np.ndarray:
    return np.where(np.isnan(given), run.params["model.min_separation"] / 2, given)


def _colours(run: Run) -> list[Any]:
    map_ = _matplotlib().get_cmap("turbo")
    robots = len(run.scenario)
    return [map_((robot + 0.5) / robots) for robot in range(robots)]


def _scene(run: Run, ax: Any) -> None:
    from matplotlib.patches import Circle

    ax.set_aspect("equal")
    ax.set_xlabel("x (m)")
    ax.set_ylabel("y (m)")
    for centre, radius in zip(run.scenario.obstacles, _radii(run, run.scenario.obstacle_radii)):
        ax.add_patch(Circle(centre, radius, color="0.6"))
    for point, colour in zip(run.scenario.set_points, _colours(run)):
        ax.plot(*point, marker="x", color=colour, linestyle="none")


def plot(run: Run, ax: Any = None) -> Any:
    """Paths with a dot at every start."""
    ax = _matplotlib().subplots()[1] if ax is None else ax
    _scene(run, ax)
    for robot, colour in enumerate(_colours(run)):
        ax.plot(run.positions[:, robot, 0], run.positions[:, robot, 1], color=colour, linewidth=1)
        ax.plot(*run.positions[0, robot], marker="o", color=colour, markersize=4)
    ax.set_title(f"{run.scenario.name}, {run.ticks} ticks")
    return ax


def animate(run: Run, speed: float, plans: bool) -> Any:
    """Discs that move, with the plans that the others see."""
    from matplotlib.animation import FuncAnimation
    from matplotlib.patches import Circle

    figure, ax = _matplotlib().subplots()
    _scene(run, ax)
    points = np.concatenate([run.positions.reshape(-1, 2), run.scenario.set_points, run.scenario.obstacles])
    margin = run.params["model.min_separation"]
    ax.set_xlim(points[:, 0].min() - margin, points[:, 0].max() + margin)
    ax.set_ylim(points[:, 1].min() - margin, points[:, 1].max() + margin)
    colours, radii = _colours(run), _radii(run, run.scenario.radii)
    discs = [ax.add_patch(Circle((0, 0), radius, color=colour, alpha=0.6)) for radius, colour in zip(radii, colours)]
    ahead = [ax.plot([], [], color=colour, linewidth=1)[0] for colour in colours]

    def draw(tick: int) -> list[Any]:
        for robot, (disc, line) in enumerate(zip(discs, ahead)):
            disc.center = run.positions[tick, robot]
            shown = plans and tick < run.ticks
            line.set_data(*(run.plan(tick, robot).T if shown else ([], [])))
        ax.set_title(f"{run.scenario.name}, {run.time[tick]:.1f} s")
        return [*discs, *ahead]

    interval = 1000 * run.params["model.sample_time"] / speed
    return FuncAnimation(figure, draw, frames=run.ticks + 1, interval=interval, blit=False)
