//! A whole run in this process: what sweeps, comparisons and replays stand on.

use crate::solver_check::SolverCheck;
use agent::team::Team;
use shared::horizon::Horizon;
use shared::horizon_source::HorizonSource;
use shared::metrics::{RunMetrics, RunSummary};
use shared::params::Params;
use shared::scenario::Scenario;
use shared::step::Step;
use std::convert::Infallible;

/// Runs the team until everybody has arrived or `scenario.max_ticks` have passed, but for one tick at
/// least, as a team of processes does; `horizon(robot, tick)` is N_i^k after any jitter. `on_tick` sees
/// every tick and ends the run by an error.
pub fn run_team<E>(
    scenario: &Scenario,
    params: &Params,
    horizon: impl Fn(usize, u64) -> Horizon,
    on_tick: impl FnMut(u64, &[Step]) -> Result<(), E>,
) -> Result<RunMetrics, E> {
    drive(&mut Team::new(scenario, params, scenario.seed), scenario, params, horizon, on_tick)
}

/// [`run_team`] with a team that is built already and has not driven yet.
pub fn drive<E>(
    team: &mut Team,
    scenario: &Scenario,
    params: &Params,
    horizon: impl Fn(usize, u64) -> Horizon,
    mut on_tick: impl FnMut(u64, &[Step]) -> Result<(), E>,
) -> Result<RunMetrics, E> {
    let mut metrics = RunMetrics::new(scenario, params);
    for tick in 0..scenario.max_ticks {
        let steps = team.step(|robot| horizon(robot, tick));
        metrics.observe(tick, steps);
        on_tick(tick, steps)?;
        if metrics.arrived_all() {
            break;
        }
    }
    Ok(metrics)
}

/// [`run_whole`] with every QP solved a second time by Clarabel.
pub fn run_checked(scenario: &Scenario, params: &Params, source: &HorizonSource) -> (RunSummary, SolverCheck) {
    let mut team = Team::checked(scenario, params, scenario.seed);
    let horizon = |robot, tick| source.horizon(robot, tick);
    match drive(&mut team, scenario, params, horizon, |_, _| Ok::<(), Infallible>(())) {
        Ok(metrics) => (metrics.finish(), team.comparison().unwrap_or_default().into()),
        Err(never) => match never {},
    }
}

/// [`run_team`] with the horizons of `source`, to its end; `on_tick` sees the steps of every tick.
pub fn run_whole(
    scenario: &Scenario,
    params: &Params,
    source: &HorizonSource,
    mut on_tick: impl FnMut(&[Step]),
) -> RunSummary {
    let horizon = |robot, tick| source.horizon(robot, tick);
    let outcome = run_team(scenario, params, horizon, |_, steps| {
        on_tick(steps);
        Ok::<(), Infallible>(())
    });
    match outcome {
        Ok(metrics) => metrics.finish(),
        Err(never) => match never {},
    }
}
