//! Promise: what the learner exports passes the ladder and answers here as it did in training.
#![allow(clippy::unwrap_used)] // a panic is how a test fails

mod common;

use common::{contract, prober};
use learner::export::export;
use learner::settings::Settings;
use policy_server::actor::{Actor, Answer, BackEnd, Runtime};
use shared::policy::folder::PolicyFolder;
use shared::random::{Use, stream, unit};

const ROBOTS: usize = 14;

/// Random numbers in -`most`..`most`.
fn draw(most: f64, count: usize, number: u64) -> Vec<f64> {
    let mut generator = stream(11, Use::Problem, 1, number);
    (0..count).map(|_| most * (2.0 * unit(&mut generator) - 1.0)).collect()
}

#[test]
fn an_exported_actor_answers_a_thousand_states_on_the_embedded_back_end_as_in_training() {
    let settings = Settings { log_std_min: -0.1, ..Settings::default() };
    let trained = learner::Actor::new(2 * ROBOTS, ROBOTS, &settings, 5);
    let mut contract = contract(ROBOTS);
    contract.observation.scale = [0.05, 0.04];
    contract.observation.offset = [3.0, -2.0];
    let place = tempfile::tempdir().unwrap();
    let folder = PolicyFolder::new(place.path().join("trained"));
    let states: Vec<Vec<f64>> = (0..64).map(|number| draw(25.0, 2 * ROBOTS, number)).collect();
    let version = export(&trained, &contract, &states, &folder).unwrap();

    let (candidate, report) = prober().check(&folder.model(version), Some(ROBOTS)).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(report.reference_cases, 64);
    assert_eq!(candidate.contract.observation, contract.observation);

    let runtime = Runtime::start(&BackEnd::Embedded).unwrap();
    let bytes = std::fs::read(folder.model(version)).unwrap();
    let mut served = Actor::load(&runtime, &bytes, &candidate.contract).unwrap();
    let (mut answer, mut largest) = (Answer::default(), 0.0f32);
    for number in 0..1000 {
        let state: Vec<f32> = draw(2.0, 2 * ROBOTS, 1000 + number).into_iter().map(|x| x as f32).collect();
        served.infer(&state, &mut answer).unwrap();
        let (mean, log_std) = trained.answer(&state);
        let both = answer.mean.iter().zip(&mean).chain(answer.log_std.iter().zip(&log_std));
        assert_eq!((answer.mean.len(), answer.log_std.len()), (ROBOTS, ROBOTS));
        largest = both.fold(largest, |most, (served, trained)| most.max((served - trained).abs()));
    }
    assert!(largest < 1e-5, "{largest}");
}
