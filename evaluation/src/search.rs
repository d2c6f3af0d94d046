//! The best constant horizon per robot, by the cross-entropy method (Rubinstein 1999): draw teams of
//! horizons around a mean, drive each, move mean and spread towards the best of them.
//!
//! What a policy has to beat: it may change horizons at every tick, this may not.

use crate::in_process::run_whole;
use crate::parallel;
use shared::stop::StopFlag;
use vodca::horizon::{Horizon, MAX_HORIZON};
use vodca::horizon_source::{HorizonSource, HorizonSourceError, HorizonSpec};
use vodca::metrics::RunSummary;
use vodca::params::Params;
use vodca::random::{self, Use};
use vodca::scenario::Scenario;

/// Teams of horizons drawn in one generation.
pub const POPULATION: usize = 48;
/// The best of them, towards which the next generation moves.
const ELITE: usize = 8;
/// How far it moves: 1 is all the way.
const STEP: f64 = 0.7;
/// Spread at the start, steps: everything is likely.
const FIRST_SPREAD: f64 = 14.0;
/// And at the least: the search never stands still.
const LEAST_SPREAD: f64 = 1.0;

/// The best that was found.
#[derive(Clone, Debug)]
pub struct Found {
    /// Horizon by robot.
    pub horizons: Vec<Horizon>,
    /// How its run went.
    pub summary: RunSummary,
    /// Runs driven.
    pub runs: usize,
}

/// Searches for `generations` generations of [`POPULATION`] runs on all cores, or until `stop` is set. The
/// result depends on nothing but the arguments. `advance` is told after every run.
///
/// # Errors
/// Horizons that do not fit the scenario's robots.
pub fn constants(
    scenario: &Scenario,
    params: &Params,
    generations: usize,
    seed: u64,
    stop: &StopFlag,
    advance: impl Fn() + Sync,
) -> Result<Option<Found>, HorizonSourceError> {
    let robots = scenario.robots.len();
    let mut mean = vec![(1.0 + MAX_HORIZON as f64) / 2.0; robots];
    let mut spread = vec![FIRST_SPREAD; robots];
    let mut best: Option<Found> = None;
    for generation in 0..generations {
        if stop.is_set() {
            break;
        }
        let teams: Vec<Vec<Horizon>> =
            (0..POPULATION).map(|team| draw(&mean, &spread, seed, generation, team)).collect();
        let sources: Vec<HorizonSource> = teams
            .iter()
            .map(|team| {
                HorizonSource::new(&HorizonSpec::Fixed(team.clone()), robots, scenario.seed, params.horizon.jitter)
            })
            .collect::<Result<_, _>>()?;
        let summaries = parallel::map(&sources, |source| run_whole(scenario, params, source, |_| ()), &advance);
        let mut order: Vec<usize> = (0..teams.len()).collect();
        order.sort_by(|&a, &b| cost(&summaries[a]).total_cmp(&cost(&summaries[b]))); // stable: ties by number
        let leader = order[0];
        let runs = (generation + 1) * POPULATION;
        if best.as_ref().is_none_or(|best| cost(&summaries[leader]) < cost(&best.summary)) {
            best = Some(Found { horizons: teams[leader].clone(), summary: summaries[leader].clone(), runs });
        }
        if let Some(best) = &mut best {
            best.runs = runs;
        }
        for robot in 0..robots {
            let elite = order[..ELITE].iter().map(|&team| teams[team][robot].steps() as f64);
            let centre = elite.clone().sum::<f64>() / ELITE as f64;
            let width = (elite.map(|steps| (steps - centre).powi(2)).sum::<f64>() / ELITE as f64).sqrt();
            mean[robot] += STEP * (centre - mean[robot]);
            spread[robot] = (spread[robot] + STEP * (width - spread[robot])).max(LEAST_SPREAD);
        }
    }
    Ok(best)
}

/// The path, m; a run that did not succeed counts as worse than any that did, less so the more robots are home.
fn cost(summary: &RunSummary) -> f64 {
    if summary.success {
        return summary.path_cost;
    }
    let missing = summary.robots.iter().filter(|robot| robot.arrived_tick.is_none()).count() as f64;
    1e6 * (1.0 + missing + summary.collisions as f64) + summary.path_cost.min(1e5)
}

/// One team of horizons: normal draws, rounded and clipped.
fn draw(mean: &[f64], spread: &[f64], seed: u64, generation: usize, team: usize) -> Vec<Horizon> {
    let mut generator = random::stream(seed, Use::Search, generation as u64, team as u64);
    let mut horizon = |(mean, spread): (&f64, &f64)| {
        Horizon::saturating((mean + spread * random::normal(&mut generator)).round() as i64)
    };
    mean.iter().zip(spread).map(&mut horizon).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use vodca::params::Profile;
    use vodca::scenario::set_up;

    #[test]
    fn constants_beat_the_best_fixed_horizon_and_repeat_themselves() {
        let (scenario, params) = set_up(Some("two_setpoint"), None, Profile::Paper, &[]).unwrap();
        let fixed = (1..=49).map(|steps| {
            let source = HorizonSource::new(&format!("fixed:{steps}").parse().unwrap(), 2, 0, 0).unwrap();
            run_whole(&scenario, &params, &source, |_| ())
        });
        let best_fixed = fixed.map(|summary| cost(&summary)).fold(f64::INFINITY, f64::min);
        let search = || constants(&scenario, &params, 5, 1, &StopFlag::default(), || ()).unwrap().unwrap();
        let found = search();
        assert!(found.summary.success && found.summary.path_cost < best_fixed, "{} m", found.summary.path_cost);
        assert_eq!((found.runs, search().horizons), (5 * POPULATION, found.horizons));
    }

    #[test]
    fn a_failed_run_costs_more_than_any_path() {
        let (scenario, params) = set_up(Some("two_setpoint"), None, Profile::Paper, &[]).unwrap();
        let run = |max_ticks| {
            let scenario = Scenario { max_ticks, ..scenario.clone() };
            let source = HorizonSource::new(&"fixed:9,40".parse().unwrap(), 2, 0, 0).unwrap();
            run_whole(&scenario, &params, &source, |_| ())
        };
        assert!(cost(&run(5)) > 1e6 && cost(&run(350)) < 100.0);
    }
}
