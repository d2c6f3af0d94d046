//! Horizons of your own: short ones for robots that are nearly there, long ones for the others.

use std::convert::Infallible;
use std::error::Error;
use vodca::horizon::Horizon;
use vodca::horizon_source::Horizons;
use vodca::metrics::RunMetrics;
use vodca::params::Profile;
use vodca::play::{Limits, Observer, Tick, Verdict, play};
use vodca::{Position, Team};

/// A step of the horizon for every 30 cm that are left, within 5..=40.
struct ByDistance {
    set_points: Vec<Position>,
}

impl Horizons for ByDistance {
    type Error = Infallible;

    fn choose(&mut self, _: u64, measured: &[Position], out: &mut [Horizon]) -> Result<(), Infallible> {
        for ((to, at), set_point) in out.iter_mut().zip(measured).zip(&self.set_points) {
            *to = Horizon::saturating(((set_point - at).norm() / 0.3).clamp(5.0, 40.0) as i64);
        }
        Ok(())
    }
}

/// Counts the collision rows of a run.
struct Rows(u64);

impl Observer<Team, ByDistance> for Rows {
    type Error = Infallible;

    fn tick(&mut self, seen: &Tick<'_, Team, ByDistance>) -> Result<Verdict, Infallible> {
        self.0 += seen.steps.iter().map(|step| u64::from(step.rows)).sum::<u64>();
        Ok(Verdict::Continue)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let (scenario, params) = vodca::set_up("ex14_d", Profile::Safe, &[])?;
    let mut horizons = ByDistance { set_points: scenario.robots.iter().map(|robot| robot.set_point).collect() };
    let mut team = Team::new(&scenario, &params, 0);
    let mut metrics = RunMetrics::new(&scenario, &params);
    let mut rows = Rows(0);
    let limits = Limits { max_ticks: scenario.max_ticks, until_arrival: true };
    let ending = play(&mut team, &mut horizons, &mut [&mut rows], &mut metrics, limits);
    let summary = metrics.finish();
    println!("{ending:?} after {} ticks, {:.2} m, {} collision rows", summary.ticks, summary.path_cost, rows.0);
    Ok(())
}
