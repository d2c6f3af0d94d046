//! A team in this process: fourteen robots drive until all have arrived.

use std::error::Error;
use vodca::Team;
use vodca::horizon::Horizon;
use vodca::metrics::RunMetrics;
use vodca::params::Profile;

fn main() -> Result<(), Box<dyn Error>> {
    let (scenario, params) = vodca::set_up("ex14_d", Profile::Safe, &[])?;
    let mut team = Team::new(&scenario, &params, 7);
    let mut metrics = RunMetrics::new(&scenario, &params);
    let horizons = vec![Horizon::new(20)?; scenario.robots.len()];
    for tick in 0..scenario.max_ticks {
        let steps = team.step(&horizons);
        metrics.observe(tick, steps);
        if metrics.arrived_all() {
            break;
        }
    }
    let summary = metrics.finish();
    println!("arrived     {} after {} ticks", if summary.success { "all" } else { "not all" }, summary.ticks);
    println!("path        {:.2} m", summary.path_cost);
    println!("separation  {:.6} m at the least, between samples too", metrics.min_separation());
    Ok(())
}
