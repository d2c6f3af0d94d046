//! The machine and what ran on it: `machine.toml`.

use super::row::Results;
use super::{Options, estimate};
use serde::Serialize;
use std::fs;
use std::process::Command;

#[derive(Serialize)]
struct Machine {
    command: String,
    part: &'static str,
    quick: bool,
    commit: String,
    rustc: String,
    vodca: &'static str,
    build: &'static str,
    processor: String,
    processors: usize,
    governor: String,
    memory_kib: u64,
    kernel: String,
    /// `busy`: so much else ran before the benchmark began that its figures are not those of the machine alone.
    machine: &'static str,
    /// Means over 1, 5 and 15 minutes, before the benchmark began.
    load_before: String,
    /// And when it had ended: its own processes are in them.
    load_after: String,
    seconds_since_boot: u64,
    /// How long the benchmark was expected to take, and how long it took.
    seconds_expected: u64,
    seconds: u64,
}

/// Its text. What cannot be found out is `unknown`.
pub(super) fn describe(options: &Options, results: &Results) -> String {
    let read = |path: &str| fs::read_to_string(path).map(|text| text.trim().to_owned());
    let field = |path: &str, name: &str| {
        let text = read(path).ok()?;
        let line = text.lines().find(|line| line.starts_with(name))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    let unknown = || "unknown".to_owned();
    let memory = field("/proc/meminfo", "MemTotal").and_then(|text| text.split(' ').next()?.parse().ok());
    let uptime = read("/proc/uptime").ok().and_then(|text| text.split('.').next()?.parse().ok());
    let arguments = std::env::args().skip(1).collect::<Vec<_>>().join(" ");
    let machine = Machine {
        command: format!("./run.sh {arguments}"),
        part: options.part.name(),
        quick: options.quick,
        commit: output("git", &["-C", env!("CARGO_MANIFEST_DIR"), "describe", "--always", "--dirty"]),
        rustc: output("rustc", &["--version"]),
        vodca: env!("CARGO_PKG_VERSION"),
        build: if cfg!(debug_assertions) { "debug" } else { "release" },
        processor: field("/proc/cpuinfo", "model name").unwrap_or_else(unknown),
        processors: std::thread::available_parallelism().map_or(1, usize::from),
        governor: read("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor").unwrap_or_else(|_| unknown()),
        memory_kib: memory.unwrap_or(0),
        kernel: read("/proc/sys/kernel/osrelease").unwrap_or_else(|_| unknown()),
        machine: results.load_before.verdict(),
        load_before: results.load_before.text().to_owned(),
        load_after: results.load_after.text().to_owned(),
        seconds_since_boot: uptime.unwrap_or(0),
        seconds_expected: estimate(options).as_secs_f64().round() as u64,
        seconds: results.seconds.round() as u64,
    };
    toml::to_string(&machine).unwrap_or_else(|error| format!("# cannot be told: {error}\n"))
}

/// The first line that a program prints.
fn output(program: &str, arguments: &[&str]) -> String {
    let text = Command::new(program).args(arguments).output().map(|output| output.stdout).unwrap_or_default();
    let line = String::from_utf8_lossy(&text).lines().next().unwrap_or_default().trim().to_owned();
    if line.is_empty() { "unknown".into() } else { line }
}
