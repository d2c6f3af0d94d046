//! A whole run in this process: what sweeps, comparisons and replays stand on.

use coordinator::policy::client::{ClientError, PolicyClient};
use coordinator::solver_check::SolverCheck;
use std::convert::Infallible;
use vodca::Position;
use vodca::hearing::measured;
use vodca::horizon::Horizon;
use vodca::horizon_source::HorizonSource;
use vodca::metrics::{RunMetrics, RunSummary};
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::step::Step;
use vodca::team::Team;

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
    on_tick: impl FnMut(u64, &[Step]) -> Result<(), E>,
) -> Result<RunMetrics, E> {
    let robots = scenario.robots.len();
    let choose = |tick, _: &[Position], horizons: &mut Vec<Horizon>| {
        horizons.extend((0..robots).map(|robot| horizon(robot, tick)));
        Ok(())
    };
    drive_chosen(team, scenario, params, choose, on_tick)
}

/// [`run_team`] with the horizons that `policy` chooses at every tick from the measured positions, moved by
/// `params.horizon.jitter` as in a team of processes: one sample of a policy. `scenario.seed` is the seed of
/// all that is random in it; starts are moved beforehand, by [`Scenario::jittered`].
///
/// # Errors
/// What `on_tick` ends the run with, or a policy without an answer.
pub fn run_with_policy<E: From<ClientError>>(
    scenario: &Scenario,
    params: &Params,
    policy: &mut PolicyClient,
    on_tick: impl FnMut(u64, &[Step]) -> Result<(), E>,
) -> Result<RunMetrics, E> {
    let (seed, noise, jitter) = (scenario.seed, params.disturbance.noise, params.horizon.jitter);
    let choose = |tick, positions: &[Position], horizons: &mut Vec<Horizon>| {
        let seen = positions.iter().enumerate().map(|(robot, &at)| measured(at, noise, seed, robot, tick));
        let chosen = policy.choose(tick, seen)?.iter().enumerate();
        horizons.extend(chosen.map(|(robot, horizon)| horizon.jittered(jitter, seed, robot, tick)));
        Ok(())
    };
    drive_chosen(&mut Team::new(scenario, params, seed), scenario, params, choose, on_tick)
}

/// `choose(tick, positions, horizons)` appends the horizons of all robots, which stand at `positions` (m).
fn drive_chosen<E>(
    team: &mut Team,
    scenario: &Scenario,
    params: &Params,
    mut choose: impl FnMut(u64, &[Position], &mut Vec<Horizon>) -> Result<(), E>,
    mut on_tick: impl FnMut(u64, &[Step]) -> Result<(), E>,
) -> Result<RunMetrics, E> {
    let mut metrics = RunMetrics::new(scenario, params);
    let mut positions: Vec<Position> = scenario.robots.iter().map(|robot| robot.start).collect();
    let mut horizons = Vec::with_capacity(positions.len());
    for tick in 0..scenario.max_ticks {
        horizons.clear();
        choose(tick, &positions, &mut horizons)?;
        let steps = team.step(|robot| horizons[robot]);
        metrics.observe(tick, steps);
        on_tick(tick, steps)?;
        if metrics.arrived_all() {
            break;
        }
        positions.clear();
        positions.extend(steps.iter().map(|step| step.next_position));
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
