//! The processes of a team: who has started, who has ended, and how.

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

/// The processes of a team.
#[derive(Debug)]
pub struct Roster {
    run: PathBuf,
    names: Vec<String>,
    processes: Vec<Process>,
}

impl Roster {
    /// A team of which no process is there yet; `names` by robot number.
    pub fn new(run: PathBuf, names: Vec<String>) -> Self {
        let processes = names.iter().map(|_| Process::Unknown).collect();
        Self { run, names, processes }
    }

    /// Takes the process that was started for `robot`.
    pub fn started(&mut self, robot: usize, child: Child) {
        self.processes[robot] = Process::Child(child);
    }

    /// Takes note that `robot`, process `pid`, is there.
    pub fn seen(&mut self, robot: usize, pid: u32) {
        if matches!(self.processes[robot], Process::Unknown | Process::Ended) {
            self.processes[robot] = Process::ByHand(pid, os::start_time(pid));
        }
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

    /// How the process of `robot` has ended; told once. `None`: it has not, or there was none.
    pub fn ended(&mut self, robot: usize) -> Option<String> {
        let process = &mut self.processes[robot];
        let how = match process {
            Process::Child(child) => match child.try_wait() {
                Ok(None) => return None,
                Ok(Some(status)) => launch::ending(status),
                Err(error) => format!("cannot be watched ({error})"),
            },
            Process::ByHand(pid, start) if os::start_time(*pid) != *start => "ended".to_string(),
            _ => return None,
        };
        *process = Process::Ended;
        Some(how)
    }

    /// The process that drives `robot`.
    pub fn pid(&self, robot: usize) -> Option<u32> {
        match &self.processes[robot] {
            Process::Child(child) => Some(child.id()),
            Process::ByHand(pid, start) if os::start_time(*pid) == *start => Some(*pid),
            _ => None,
        }
    }

    /// Kills `robot` for good: it has ended when this returns.
    pub fn kill(&mut self, robot: usize) {
        match &mut self.processes[robot] {
            Process::Child(child) => {
                let _ = child.kill(); // ended already is fine
                let _ = child.wait(); // its status is kept for whoever asks next
            }
            Process::ByHand(pid, start) if os::start_time(*pid) == *start => os::kill(*pid),
            _ => {}
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
