//! A robot without a planner that fails on request: `--fault ROBOT:KIND:TICK`, or `--fault ROBOT:KIND`
//! before it opens anything. Every robot of a team gets the same arguments; the one with the number fails.

use agent::run::{Drive, Launch, run};
use clap::Parser;
use shared::stop::StopFlag;
use std::path::PathBuf;
use std::process::ExitCode;
use vodca::Position;
use vodca::horizon::Horizon;
use vodca::neighbour_estimates::NeighbourEstimates;
use vodca::prediction::Prediction;
use vodca::step::{Level, Status, Step};

#[derive(Parser)]
struct Args {
    #[arg(long)]
    run: PathBuf,
    #[arg(long)]
    robot: usize,
    #[arg(long)]
    parent: Option<u32>,
    /// `ROBOT:KIND[:TICK]`; kinds: panic, exit, abort, hang, spin
    #[arg(long)]
    fault: Option<String>,
}

/// Drives straight to the set-point, and fails when its time has come.
struct Straight {
    position: Position,
    set_point: Position,
    sample_time: f64,
    max_speed: f64,
    fault: Option<(String, u64)>,
}

impl Drive for Straight {
    fn measured(&self) -> Position {
        self.position
    }

    fn restart(&mut self, _: u64, at: Position) {
        self.position = at;
    }

    fn step(&mut self, tick: u64, horizon: Horizon, _: &NeighbourEstimates) -> Step {
        if let Some((kind, at)) = &self.fault
            && *at == tick
        {
            fail(kind);
        }
        let position = self.position;
        let input = ((self.set_point - position) / self.sample_time).map(|u| u.clamp(-self.max_speed, self.max_speed));
        self.position = position + input * self.sample_time;
        Step {
            position,
            measured: position,
            input,
            next_position: self.position,
            next_measured: self.position,
            horizon,
            rows: 0,
            level: Level::Baseline,
            status: Status::Solved,
            filtered: false,
            plan: Prediction::from_states(&[position, self.position], self.set_point),
            detect_ns: 0,
            solve_ns: 0,
            step_ns: 0,
        }
    }
}

fn fail(kind: &str) {
    match kind {
        "panic" => panic!("the fake robot was told to panic"),
        "exit" => {
            eprintln!("error: the fake robot was told to give up");
            std::process::exit(7);
        }
        "abort" => std::process::abort(),
        "hang" => loop {
            std::thread::sleep(std::time::Duration::from_secs(1));
        },
        "spin" => loop {
            std::hint::spin_loop();
        },
        other => panic!("no fault is called {other}"),
    }
}

fn main() -> ExitCode {
    let args = Args::parse();
    let fault = args.fault.as_deref().and_then(|text| {
        let mut words = text.split(':');
        let robot: usize = words.next()?.parse().ok()?;
        let fault = (words.next()?.to_string(), words.next().and_then(|tick| tick.parse().ok()));
        (robot == args.robot).then_some(fault)
    });
    if let Some((kind, None)) = &fault {
        fail(kind); // at the start, before anything is opened
    }
    let fault = fault.and_then(|(kind, tick)| Some((kind, tick?)));
    let launch = Launch { run: &args.run, robot: args.robot, parent: args.parent };
    let done = StopFlag::install().map_err(|error| error.to_string()).and_then(|stop| {
        run(launch, &stop, |setup, robot| Straight {
            position: setup.scenario.robots[robot].start,
            set_point: setup.scenario.robots[robot].set_point,
            sample_time: setup.params.model.sample_time,
            max_speed: setup.params.model.max_speed,
            fault: fault.clone(),
        })
        .map_err(|error| error.to_string())
    });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
