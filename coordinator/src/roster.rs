//! Who is in the team: which robots are there, which have answered, and whose process has ended.

use crate::launch;
use shared::os;
use std::path::PathBuf;
use std::process::Child;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A robot that ended or fell silent while the run went on.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "robot {robot} ({name}) was lost {}: it {how}{}; its log is {}",
    match tick { Some(tick) => format!("at tick {tick}"), None => "before tick 0".into() },
    match last_line { Some(line) => format!(", saying \"{line}\""), None => String::new() },
    log.display()
)]
pub struct PeerLost {
    /// Its number.
    pub robot: usize,
    /// Its name in the scenario.
    pub name: String,
    /// The tick it did not finish; `None`: during the start.
    pub tick: Option<u64>,
    /// How it ended, or for how long it was silent.
    pub how: String,
    /// The last thing it said.
    pub last_line: Option<String>,
    /// Where it says things.
    pub log: PathBuf,
}

/// A robot's process.
#[derive(Debug)]
enum Process {
    /// Not there yet.
    Unknown,
    /// Our child.
    Child(Child),
    /// Started by hand, known from its first report: number and start time.
    ByHand(u32, Option<u64>),
    /// Ended, and we have seen it.
    Ended,
}

/// The team.
#[derive(Debug)]
pub struct Roster {
    run: PathBuf,
    names: Vec<String>,
    processes: Vec<Process>,
    answered: Vec<bool>,
    missing: usize,
}

impl Roster {
    /// A team of which no robot is there yet; `names` by robot number.
    pub fn new(run: PathBuf, names: Vec<String>) -> Self {
        let robots = names.len();
        let processes = (0..robots).map(|_| Process::Unknown).collect();
        Self { run, names, processes, answered: vec![false; robots], missing: robots }
    }

    /// Takes the process that was started for `robot`.
    pub fn started(&mut self, robot: usize, child: Child) {
        self.processes[robot] = Process::Child(child);
    }

    /// Takes note that `robot`, process `pid`, is there.
    pub fn seen(&mut self, robot: usize, pid: u32) {
        if matches!(self.processes[robot], Process::Unknown) {
            self.processes[robot] = Process::ByHand(pid, os::start_time(pid));
        }
    }

    /// From now on everybody has to answer once more.
    pub fn expect_all(&mut self) {
        self.answered.fill(false);
        self.missing = self.answered.len();
    }

    /// Takes note of an answer; `false`: it was the second one.
    pub fn answer(&mut self, robot: usize) -> bool {
        let first = !std::mem::replace(&mut self.answered[robot], true);
        self.missing -= usize::from(first);
        first
    }

    /// How many answers are missing.
    pub fn missing(&self) -> usize {
        self.missing
    }

    /// The first robot that has not answered, as lost because it `how`.
    pub fn first_missing(&self, tick: Option<u64>, how: String) -> Option<PeerLost> {
        let robot = self.answered.iter().position(|answered| !answered)?;
        Some(self.lost(robot, tick, how))
    }

    /// `robot`, lost because it `how`.
    pub fn lost(&self, robot: usize, tick: Option<u64>, how: String) -> PeerLost {
        PeerLost {
            robot,
            name: self.names[robot].clone(),
            tick,
            how,
            last_line: launch::last_line(&self.run, robot),
            log: launch::log_file(&self.run, robot),
        }
    }

    /// A robot whose process has ended, if there is one.
    pub fn find_ended(&mut self, tick: Option<u64>) -> Option<PeerLost> {
        for robot in 0..self.processes.len() {
            let how = match &mut self.processes[robot] {
                Process::Child(child) => match child.try_wait() {
                    Ok(None) => continue,
                    Ok(Some(status)) => launch::ending(status),
                    Err(error) => format!("cannot be watched ({error})"),
                },
                Process::ByHand(pid, start) if os::start_time(*pid) != *start => "ended".to_string(),
                _ => continue,
            };
            self.processes[robot] = Process::Ended;
            return Some(self.lost(robot, tick, how));
        }
        None
    }

    /// Kills `robot`.
    pub fn kill(&mut self, robot: usize) {
        if let Process::Child(child) = &mut self.processes[robot] {
            let _ = child.kill(); // ended already is fine
        }
    }

    /// Asks every process that we started to end.
    pub fn ask_to_end(&self) {
        for process in &self.processes {
            if let Process::Child(child) = process {
                os::terminate(child.id());
            }
        }
    }

    /// Waits until all processes have ended; after `grace` those that we started are killed.
    pub fn wait_for_end(&mut self, grace: Duration) {
        let start = Instant::now();
        while self.processes.iter_mut().any(is_running) {
            if start.elapsed() > grace {
                for process in &mut self.processes {
                    if let Process::Child(child) = process {
                        let _ = child.kill();
                        let _ = child.wait();
                    }
                }
                return;
            }
            sleep(Duration::from_millis(2));
        }
    }
}

fn is_running(process: &mut Process) -> bool {
    let runs = match process {
        Process::Unknown | Process::Ended => false,
        Process::Child(child) => matches!(child.try_wait(), Ok(None)),
        Process::ByHand(pid, start) => start.is_some() && os::start_time(*pid) == *start,
    };
    if !runs {
        *process = Process::Ended;
    }
    runs
}

impl Drop for Roster {
    /// Nobody outlives the team, however it ended.
    fn drop(&mut self) {
        self.wait_for_end(Duration::ZERO);
    }
}
