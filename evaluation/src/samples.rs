//! Small recorded runs for tests.

use vodca::horizon_source::HorizonSource;
use vodca::scenario::Scenario;

/// A real run of a team in this process, recorded in `folder`, with horizons from `random:3`.
pub(crate) fn record_run(folder: &std::path::Path, scenario: &str, params: &vodca::params::Params) {
    record_ticks(folder, scenario, params, 120);
}

/// The same, stopped after `max_ticks` ticks, which may be none.
pub(crate) fn record_ticks(folder: &std::path::Path, scenario: &str, params: &vodca::params::Params, max_ticks: u64) {
    use coordinator::record::about::{Machine, Versions};
    use coordinator::record::{About, RunFolder};
    use coordinator::tick_parts::TickTimes;
    let mut scenario = Scenario::resolve(Some(scenario), None).unwrap();
    scenario.max_ticks = 120;
    let about = About {
        version: 1,
        scenario: scenario.name.clone(),
        robots: scenario.robots.len(),
        profile: "sample".into(),
        horizon: "random:3".into(),
        seed: scenario.seed,
        exchange: "none".into(),
        real_time: false,
        chaos: None,
        command: vec![],
        versions: Versions::here(),
        machine: Machine::here(),
    };
    let folder = RunFolder::at(folder).unwrap();
    let mut session = coordinator::session::Session::start(folder, &scenario, params, about).unwrap();
    let driven = Scenario { max_ticks, ..scenario.clone() };
    let mut horizons = HorizonSource::new(&"random:3".parse().unwrap(), scenario.robots.len(), 0, 0).unwrap();
    let times = TickTimes { duration_ns: 5_000, ..TickTimes::default() };
    let metrics =
        crate::in_process::run_team(&driven, params, &mut horizons, |tick, steps| session.record(tick, steps, &times))
            .unwrap();
    session.finish(coordinator::summary::End::OutOfTicks, &metrics, None).unwrap();
}
