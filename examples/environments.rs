//! Episodes as whoever learns sees them, on all cores: `environments ex14_d 64 200` plays 200 ticks in each of 64
//! environments with random horizons and says how fast that was.

use policy::environment::{Environment, Settings};
use std::error::Error;
use std::num::NonZero;
use std::thread;
use std::time::Instant;
use vodca::horizon::Horizon;
use vodca::params::Profile;
use vodca::scenario::ScenarioError;

/// Plays `ticks` ticks, episode after episode; gives the sum of the rewards and the number of episodes that ended.
fn play(environment: &mut Environment, ticks: u64) -> Result<(f64, u64), ScenarioError> {
    let (mut rewards, mut ended) = (0.0, 0);
    let mut horizons = vec![Horizon::MAX; environment.measured().len()];
    for tick in 0..ticks {
        for (robot, horizon) in horizons.iter_mut().enumerate() {
            *horizon = Horizon::random(3, robot, tick); // here a policy would look at `environment.measured()`
        }
        let outcome = environment.step(&mut horizons);
        rewards += outcome.judgement.terms.total();
        if outcome.terminated || outcome.truncated {
            ended += 1;
            environment.next_episode()?; // fresh starts
        }
    }
    Ok((rewards, ended))
}

fn main() -> Result<(), Box<dyn Error>> {
    let argument = |place: usize, usual: &str| std::env::args().nth(place).unwrap_or(usual.into());
    let (count, ticks) = (argument(2, "16").parse()?, argument(3, "100").parse()?);
    let (scenario, params) = vodca::set_up(&argument(1, "ex14_d"), Profile::Safe, &[])?;
    let settings = Settings { after_arrival: Some(0), ..Settings::default() };
    let make = |seed: u64| Environment::new(scenario.clone(), params.clone(), settings.clone(), seed);
    let mut all = (0..count).map(make).collect::<Result<Vec<_>, _>>()?;

    let started = Instant::now();
    let share = all.len().div_ceil(thread::available_parallelism().map_or(1, NonZero::get));
    let played: Vec<_> = thread::scope(|scope| {
        let halves = all.chunks_mut(share.max(1));
        let threads: Vec<_> = halves
            .map(|some| scope.spawn(|| some.iter_mut().map(|one| play(one, ticks)).collect::<Vec<_>>()))
            .collect();
        threads.into_iter().filter_map(|thread| thread.join().ok()).flatten().collect()
    });
    let seconds = started.elapsed().as_secs_f64();
    let played = played.into_iter().collect::<Result<Vec<_>, _>>()?;
    println!("episodes ended   {}", played.iter().map(|(_, ended)| ended).sum::<u64>());
    println!("steps per second {:.0}", (count * ticks) as f64 / seconds);
    Ok(())
}
