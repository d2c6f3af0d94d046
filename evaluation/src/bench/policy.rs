//! A policy: inference, loading, and from the observation to the horizons.

use super::row::{Results, Row};
use super::teams::{Load, TeamSpec, drive_with};
use super::{BenchError, Extent};
use coordinator::latency::Latency;
use coordinator::policy::{PolicyOptions, server_program};
use policy::settings::PolicySettings;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use vodca::horizon::Horizon;

/// Sizes of teams.
const ROBOTS: [usize; 3] = [2, 14, 64];

/// What `policy-server bench` prints.
#[derive(Deserialize)]
struct Answer {
    start_ns: u64,
    load_ns: u64,
    first_ns: u64,
    inference_ns: Vec<u64>,
}

/// Measures the embedded back-end, and the library that was named.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    let program = server_program().map_err(|error| BenchError::Policy(error.to_string()))?;
    let library = extent.options.onnxruntime.as_deref();
    let back_ends: Vec<(&str, Option<&Path>)> =
        [("embedded", None)].into_iter().chain(library.map(|file| ("ONNX Runtime", Some(file)))).collect();
    let sizes = extent.sizes(&ROBOTS, &[2]);
    extent.tell("policy", 2 * sizes.len() * back_ends.len());
    for (name, library) in back_ends {
        for &robots in &sizes {
            let answer = inference(extent, &program, robots, library)?;
            let mut latency = Latency::new();
            answer.inference_ns.iter().for_each(|time| latency.record_ns(*time));
            let p50 = latency.percentiles().p50_us;
            results.row(Row::new("policy", format!("inference, {name}"), Some(robots), latency));
            let milliseconds = |time: u64| time as f64 / 1e6;
            let mut figure = |what: &str, time| {
                results.figure("policy", format!("{what}, {name}, {robots} robots"), milliseconds(time), "ms");
            };
            figure("start of the back-end", answer.start_ns);
            figure("loading", answer.load_ns);
            figure("first inference", answer.first_ns);
            extent.advance()?;
            let round_trip = round_trip(extent, &program, robots, library)?;
            let row = Row::new("policy", format!("observation to horizons, {name}"), Some(robots), round_trip);
            results.row(row.over(Some(p50)));
            extent.advance()?;
        }
    }
    Ok(())
}

fn inference(extent: &Extent<'_>, program: &Path, robots: usize, library: Option<&Path>) -> Result<Answer, BenchError> {
    let mut command = Command::new(program);
    let count = extent.pick(5_000, 10).to_string();
    command.args(["bench", "--robots", &robots.to_string(), "--count", &count]);
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

/// From the observation being published to the horizons being there, in a run of processes.
fn round_trip(
    extent: &Extent<'_>,
    program: &Path,
    robots: usize,
    library: Option<&Path>,
) -> Result<Latency, BenchError> {
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
    let ticks = extent.pick(500, 5);
    let spec = TeamSpec { scenario: &scenario, load: Load::Safe, kind: None, real_time: false, ticks };
    let mut latency = Latency::new();
    // The policy is asked between the end of one tick and the announcement of the next.
    drive_with(&spec, Some(policy), extent.stop, &mut |tick| {
        latency.record_ns(tick.team.moments().announced.saturating_sub(tick.team.moments().asked));
        Ok(())
    })?;
    Ok(latency)
}
