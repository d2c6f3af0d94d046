//! An ONNX policy chooses the horizons of a team in this process: `drive_with_policy policies/two_setpoint`.

use policy::folder::resolve;
use policy_server::actor::{Actor, Answer, BackEnd, Runtime};
use policy_server::check::{Limits, TryError, look};
use policy_server::sample::{Choice, choose};
use std::error::Error;
use std::path::Path;
use vodca::horizon::Horizon;
use vodca::horizon_source::Horizons;
use vodca::metrics::RunMetrics;
use vodca::params::Profile;
use vodca::play::{Limits as Until, play};
use vodca::{Position, Team};

struct Onnx {
    actor: Actor,
    input: Vec<f32>,
    answer: Answer,
}

impl Horizons for Onnx {
    type Error = TryError;

    fn choose(&mut self, tick: u64, measured: &[Position], out: &mut [Horizon]) -> Result<(), TryError> {
        self.actor.contract().normalise(measured, &mut self.input);
        self.actor.infer(&self.input, &mut self.answer)?;
        for (robot, to) in out.iter_mut().enumerate() {
            // An answer that is not finite leaves the horizon as it was.
            let chosen = choose(self.actor.contract(), &self.answer, Choice::Mean, robot, tick);
            *to = chosen.map_or(*to, |(_, horizon)| horizon);
        }
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1).unwrap_or("policies/two_setpoint".into());
    let candidate = look(&resolve(Path::new(&name))?, None, &Limits::default())?;
    let actor = Actor::load(&Runtime::start(&BackEnd::Embedded)?, &candidate.bytes, &candidate.contract)?;
    let (scenario, params) = vodca::set_up("two_setpoint", Profile::Paper, &[])?;
    let input = vec![0.0; 2 * scenario.robots.len()];
    let mut horizons = Onnx { actor, input, answer: Answer::default() };
    let (mut team, mut metrics) = (Team::new(&scenario, &params, 0), RunMetrics::new(&scenario, &params));
    let until = Until { max_ticks: scenario.max_ticks, until_arrival: true };
    let ending = play::<_, _, TryError>(&mut team, &mut horizons, &mut [], &mut metrics, until);
    let summary = metrics.finish();
    println!("{ending:?} after {} ticks, {:.2} m", summary.ticks, summary.path_cost);
    Ok(())
}
