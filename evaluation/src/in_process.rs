//! A whole run in this process: what comparisons, searches and replays stand on.

use std::convert::Infallible;
use vodca::horizon_source::{HorizonSource, Horizons};
use vodca::metrics::{RunMetrics, RunSummary};
use vodca::params::Params;
use vodca::play::{Halt, HaltOf, Limits, Tick, Verdict, play};
use vodca::scenario::Scenario;
use vodca::step::Step;
use vodca::team::Team;

/// Runs a team of `scenario` until everybody has arrived or `scenario.max_ticks` have passed, with the horizons of
/// `horizons`; `on_tick` sees what everybody did in every tick. `scenario.seed` is the seed of all that is random in the
/// team.
///
/// # Errors
/// What `on_tick` ends the run with, or that there are no horizons.
pub fn run_team<H: Horizons, E>(
    scenario: &Scenario,
    params: &Params,
    horizons: &mut H,
    on_tick: impl FnMut(u64, &[Step]) -> Result<(), E>,
) -> Result<RunMetrics, HaltOf<Team, H, E>> {
    drive(&mut Team::new(scenario, params, scenario.seed), scenario, params, horizons, on_tick)
}

/// [`run_team`] with a team that is built already and has not driven yet.
///
/// # Errors
/// As of [`run_team`].
pub fn drive<H: Horizons, E>(
    team: &mut Team,
    scenario: &Scenario,
    params: &Params,
    horizons: &mut H,
    mut on_tick: impl FnMut(u64, &[Step]) -> Result<(), E>,
) -> Result<RunMetrics, HaltOf<Team, H, E>> {
    let mut metrics = RunMetrics::new(scenario, params);
    let limits = Limits { max_ticks: scenario.max_ticks, until_arrival: true };
    let mut observer = |seen: &Tick<'_, Team, H>| on_tick(seen.tick, seen.steps).map(|()| Verdict::Continue);
    play(team, horizons, &mut [&mut observer], &mut metrics, limits)?;
    Ok(metrics)
}

/// [`run_team`] with a table of horizons, to its end.
pub fn run_whole(
    scenario: &Scenario,
    params: &Params,
    source: &HorizonSource,
    on_tick: impl FnMut(&[Step]),
) -> RunSummary {
    drive_whole(&mut Team::new(scenario, params, scenario.seed), scenario, params, source, on_tick).finish()
}

/// [`drive`] with a table of horizons, to its end: nothing of it can fail.
pub(crate) fn drive_whole(
    team: &mut Team,
    scenario: &Scenario,
    params: &Params,
    source: &HorizonSource,
    mut on_tick: impl FnMut(&[Step]),
) -> RunMetrics {
    let on_tick = |_, steps: &[Step]| {
        on_tick(steps);
        Ok::<(), Infallible>(())
    };
    match drive(team, scenario, params, &mut source.clone(), on_tick) {
        Ok(metrics) => metrics,
        Err(Halt::Team(never) | Halt::Horizons(never) | Halt::Observer(never)) => match never {},
    }
}
