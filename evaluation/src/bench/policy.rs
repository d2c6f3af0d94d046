//! A policy: inference, loading, and from the observation to the horizons.

use super::row::{Results, Row};
use super::teams::{Load, TeamSpec, drive_with};
use super::{BenchError, Extent, Options, cost};
use coordinator::latency::Latency;
use coordinator::policy::{PolicyOptions, server_program};
use coordinator::run::RunTick;
use policy::settings::PolicySettings;
use serde::Deserialize;
use shared::exchange::Kind;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use vodca::horizon::Horizon;

/// Sizes of teams.
const ROBOTS: [usize; 3] = [2, 14, 64];
/// Passes: inference alone and in a run take turns.
const PASSES: u64 = 4;
/// Inferences, and ticks, of a pass.
const COUNT: u64 = 5_000;
/// The first ticks are left out: they touch memory for the first time.
const WARM_UP: u64 = 5;

/// What `policy-server bench` prints.
#[derive(Deserialize)]
struct Answer {
    start_ns: u64,
    load_ns: u64,
    first_ns: u64,
    inference_ns: Vec<u64>,
}

/// A back-end by name, with its library.
type BackEnd<'a> = (&'static str, Option<&'a Path>);

fn back_ends(options: &Options) -> impl Iterator<Item = BackEnd<'_>> {
    let library = options.onnxruntime.as_deref().map(|file| ("ONNX Runtime", Some(file)));
    [("embedded", None)].into_iter().chain(library)
}

/// Passes, and inferences or ticks of each.
fn extent_of(options: &Options) -> (u64, u64) {
    options.pick((PASSES, COUNT), (1, 10))
}

/// What a pass with `robots` is expected to take, s.
fn pass_seconds(options: &Options, robots: usize) -> f64 {
    let tick = cost::tick(Kind::default_for(robots), Load::NoQp, robots) + 4.0 * cost::INFERENCE;
    cost::SERVER + cost::start(robots) + extent_of(options).1 as f64 * (cost::INFERENCE + tick)
}

/// What this part is expected to take, s.
pub(super) fn seconds(options: &Options) -> f64 {
    let sizes = options.sizes(&ROBOTS, &[2]);
    let pass: f64 = sizes.into_iter().map(|robots| pass_seconds(options, robots)).sum();
    back_ends(options).count() as f64 * extent_of(options).0 as f64 * pass
}

/// Measures the embedded back-end, and the library that was named.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    extent.tell("policy");
    let program = server_program().map_err(|error| BenchError::Policy(error.to_string()))?;
    let (passes, count) = extent_of(extent.options);
    for (name, library) in back_ends(extent.options) {
        for robots in extent.options.sizes(&ROBOTS, &[2]) {
            let (mut alone, mut in_a_run) = (Latency::new(), Latency::new());
            for pass in 0..passes {
                let answer = inference(&program, count, robots, library)?;
                answer.inference_ns.iter().for_each(|time| alone.record_ns(*time));
                if pass == 0 {
                    figures(name, robots, &answer, results);
                }
                round_trip(extent, &program, (robots, count), library, &mut in_a_run)?;
                extent.advance(pass_seconds(extent.options, robots))?;
            }
            let inference = format!("inference, {name}");
            let row = |name: String, latency| Row::new("policy", name, Some(robots), latency);
            let round_trip = row(format!("observation to horizons, {name}"), in_a_run).over(&inference, &alone);
            results.row(row(inference, alone).as_floor());
            results.row(round_trip);
        }
    }
    Ok(())
}

fn figures(name: &str, robots: usize, answer: &Answer, results: &mut Results) {
    let parts =
        [("start of the back-end", answer.start_ns), ("loading", answer.load_ns), ("first inference", answer.first_ns)];
    for (what, time) in parts {
        results.figure("policy", format!("{what}, {name}, {robots} robots"), time as f64 / 1e6, "ms");
    }
}

fn inference(program: &Path, count: u64, robots: usize, library: Option<&Path>) -> Result<Answer, BenchError> {
    let mut command = Command::new(program);
    command.args(["bench", "--robots", &robots.to_string(), "--count", &count.to_string()]);
    serde_json::from_slice(&output(command, library)?).map_err(|error| BenchError::Policy(error.to_string()))
}

/// What the program prints when all is well.
fn output(mut command: Command, library: Option<&Path>) -> Result<Vec<u8>, BenchError> {
    if let Some(library) = library {
        command.arg("--onnxruntime").arg(library);
    }
    let output = command.output().map_err(|error| BenchError::Policy(error.to_string()))?;
    if !output.status.success() {
        return Err(BenchError::Policy(String::from_utf8_lossy(&output.stderr).trim().to_owned()));
    }
    Ok(output.stdout)
}

/// From the observation being published to the horizons being there, in a run of processes that stand still.
fn round_trip(
    extent: &Extent<'_>,
    program: &Path,
    (robots, ticks): (usize, u64),
    library: Option<&Path>,
    latency: &mut Latency,
) -> Result<(), BenchError> {
    let home = tempfile::tempdir().map_err(|source| BenchError::System { what: "make a folder", source })?;
    let policy = home.path().join("policy");
    let mut command = Command::new(program);
    command.args(["new", "--random", "--robots", &robots.to_string()]).arg(&policy);
    output(command, library)?;
    let policy = PolicyOptions {
        program: program.to_owned(),
        settings: PolicySettings {
            version: 1,
            policy,
            shadow: None,
            sample_seed: None,
            onnxruntime: library.map(PathBuf::from),
            poll_ms: 250,
        },
        record: false,
        wait: Duration::from_millis(1000),
        hold: 10,
        default: Horizon::saturating(20),
    };
    let scenario = format!("ring:{robots}");
    let spec = TeamSpec { scenario: &scenario, load: Load::NoQp, kind: None, real_time: false, ticks: WARM_UP + ticks };
    // The policy is asked between the end of one tick and the announcement of the next.
    drive_with(&spec, Some(policy), extent.stop, &mut |number: u64, tick: &RunTick<'_>| {
        if number >= WARM_UP {
            let moments = tick.team.moments();
            latency.record_ns(moments.announced.saturating_sub(moments.asked));
        }
        Ok(())
    })?;
    Ok(())
}
