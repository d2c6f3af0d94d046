//! Promise: a training learns through the real programs, ends in order however it is ended, leaves a
//! policy that drives, and goes on exactly.

use crate::{learner, policy_server};
use shared::os::start_time;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use tempfile::TempDir;
use tests::{Robots, Run, shared_files, signal, wait_until};

/// A small training: two robots, short episodes, small networks.
const SMALL: &str = "--scenario two_setpoint --profile paper --learn max_ticks=25 --learn warm_up_episodes=2 \
    --learn round_episodes=1 --learn hidden=16 --learn batch=16 --learn start_jitter=0.2 --learn favoured_share=0.25";

/// A training in a folder of its own. Killed when dropped.
struct Training {
    child: Child,
    place: TempDir,
    /// Every coordinator that was seen to play for it.
    sessions: Vec<u32>,
}

impl Training {
    fn begin(budget: &str) -> Self {
        let place = tempfile::tempdir().unwrap();
        let child = train(place.path(), &format!("{SMALL} {budget} --out {}", place.path().join("all").display()));
        Self { child, place, sessions: Vec::new() }
    }

    fn resume(&mut self, budget: &str) {
        assert!(self.child.try_wait().unwrap().is_some(), "the one before has ended");
        self.child = train(self.place.path(), &format!("{budget} --resume {}", self.folder().display()));
    }

    fn folder(&self) -> PathBuf {
        self.place.path().join("all")
    }

    /// Rows of `train.csv`, its header aside.
    fn rows(&self) -> Vec<Vec<String>> {
        let text = fs::read_to_string(self.folder().join("train.csv")).unwrap_or_default();
        let whole = text.rfind('\n').map_or("", |end| &text[..end]);
        whole.lines().skip(1).map(|line| line.split(',').map(String::from).collect()).collect()
    }

    fn wait_until_rounds(&mut self, rounds: usize) {
        wait_until("rounds are played", || {
            assert!(self.child.try_wait().unwrap().is_none(), "the training ended early: {}", self.said());
            self.rows().len() >= rounds
        });
        let sessions = processes(&self.folder()).into_iter().filter(|(_, line)| line.contains("vodca\0rollout"));
        self.sessions.extend(sessions.map(|(pid, _)| pid));
        assert!(self.sessions.len() >= 2, "rollouts and evaluations");
    }

    /// Waits for its end; nothing of it may be left.
    fn end(&mut self) -> ExitStatus {
        wait_until("the training ends", || self.child.try_wait().unwrap().is_some());
        wait_until("its processes end", || processes(&self.folder()).is_empty());
        for session in &self.sessions {
            assert_eq!(shared_files(*session), Vec::<PathBuf>::new());
        }
        self.child.try_wait().unwrap().unwrap()
    }

    fn done(&mut self) {
        let status = self.end();
        assert_eq!(status.code(), Some(0), "{}", self.said());
    }

    fn said(&self) -> String {
        fs::read_to_string(self.place.path().join("stderr")).unwrap()
    }

    /// The newest checkpoint: its number, the learner, the state.
    fn checkpoint(&self) -> (u64, Vec<u8>, serde_json::Value) {
        let entries = fs::read_dir(self.folder().join("checkpoints")).unwrap().map(|entry| entry.unwrap().path());
        let newest = entries.max().unwrap();
        let number = newest.file_name().unwrap().to_str().unwrap().parse().unwrap();
        let state = fs::read(newest.join("state.json")).unwrap();
        let learner = fs::read(newest.join("learner.safetensors")).unwrap();
        (number, learner, serde_json::from_slice(&state).unwrap())
    }
}

impl Drop for Training {
    fn drop(&mut self) {
        let _ = self.child.kill(); // has ended in a test that passes
        let _ = self.child.wait();
    }
}

fn train(place: &Path, arguments: &str) -> Child {
    policy_server();
    Command::new(learner())
        .arg("train")
        .args(arguments.split_whitespace())
        .stdin(Stdio::null())
        .stdout(File::create(place.join("stdout")).unwrap())
        .stderr(File::create(place.join("stderr")).unwrap())
        .spawn()
        .unwrap()
}

/// Living processes that were told of the training in `folder`, the trainer aside.
fn processes(folder: &Path) -> Vec<(u32, String)> {
    let wanted = format!("{}/", folder.display());
    let pids = fs::read_dir("/proc").unwrap().flatten().filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    pids.filter(|pid| start_time(*pid).is_some())
        .map(|pid| (pid, String::from_utf8_lossy(&fs::read(format!("/proc/{pid}/cmdline")).unwrap_or_default()).into()))
        .filter(|(_, line): &(u32, String)| line.contains(&wanted))
        .collect()
}

#[test]
fn a_training_leaves_curves_a_checkpoint_and_a_policy_that_drives() {
    let mut training = Training::begin("--episodes 3");
    training.done();
    let folder = training.folder();
    let header = fs::read_to_string(folder.join("train.csv")).unwrap();
    let header: Vec<&str> = header.lines().next().unwrap().split(',').collect();
    for column in ["round", "episodes", "ticks", "updates", "rollout/return", "evaluation/success", "loss/critic"] {
        assert!(header.contains(&column), "{column} is missing in {header:?}");
    }
    let rows = training.rows();
    let firsts: Vec<String> = rows.iter().map(|row| row[..4].join(",")).collect();
    // Two episodes of warm-up; the updates of a round are those of the ticks before it.
    assert_eq!(firsts, ["0,1,75,50", "1,2,100,75", "2,3,125,100"]);
    assert!(rows.iter().all(|row| row.len() == header.len()), "{rows:?}");
    let evaluated = header.iter().position(|name| *name == "evaluation/return").unwrap();
    assert!(rows.iter().all(|row| row[evaluated].parse::<f64>().unwrap().is_finite()), "{rows:?}");

    let mut shards = files_of(&folder);
    shards.retain(|name| name.ends_with(".safetensors") && !name.contains("/checkpoints/"));
    assert!(shards.is_empty(), "what was remembered is removed: {shards:?}");
    assert_eq!(training.checkpoint().0, 3);

    let best = folder.join("best");
    let run = Run::start(
        Robots::Real,
        &format!("--scenario two_setpoint --profile paper --max-ticks 20 --policy {}", best.display()),
    );
    let finished = run.finish();
    assert_eq!(finished.summary["ticks"], 20, "{finished:?}");
    assert_eq!(finished.summary["policy"]["answered"], 20, "{finished:?}");
}

/// All files below `folder`.
fn files_of(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { files_of(&path) } else { vec![path.display().to_string()] }).collect()
}

#[test]
fn a_resumed_training_ends_at_the_same_bytes() {
    let mut whole = Training::begin("--episodes 4");
    let mut parts = Training::begin("--episodes 2");
    parts.done();
    parts.resume("--episodes 4");
    parts.done();
    whole.done();
    let ((number, learner, state), expected) = (parts.checkpoint(), whole.checkpoint());
    assert_eq!((number, expected.0), (4, 4));
    assert_eq!(state, expected.2);
    assert!(learner == expected.1, "the learners differ");
    // But for the speeds, the last three columns, the curves are the same.
    let curve = |training: &Training| -> Vec<String> {
        training.rows().iter().map(|row| row[..row.len() - 3].join(",")).collect()
    };
    assert_eq!(curve(&parts), curve(&whole));
}

#[test]
fn an_interrupted_training_ends_in_order_and_goes_on() {
    let mut training = Training::begin("--learn checkpoint_every=1000");
    training.wait_until_rounds(2);
    let mut second = train(training.place.path(), &format!("--episodes 9 --resume {}", training.folder().display()));
    wait_until("the second one is refused", || second.try_wait().unwrap().is_some());
    assert_eq!(second.wait().unwrap().code(), Some(1));
    let said = training.said();
    assert!(said.contains("is being trained in by another process"), "{said}");

    signal(training.child.id(), "INT");
    training.done();
    let rounds = training.rows().len() as u64;
    assert_eq!(training.checkpoint().0, rounds, "nothing that was learnt is lost");
    training.resume(&format!("--episodes {}", rounds + 1));
    training.done();
    assert_eq!((training.checkpoint().0, training.rows().len() as u64), (rounds + 1, rounds + 1));
}

#[test]
fn a_killed_training_leaves_no_robots_and_goes_on_from_its_checkpoint() {
    let mut training = Training::begin("--learn checkpoint_every=1000");
    training.wait_until_rounds(2);
    signal(training.child.id(), "KILL");
    assert_eq!(training.end().code(), None);
    // The only checkpoint is the one after the warm-up: later rounds are played again, as they were.
    assert_eq!(training.checkpoint().0, 0);
    training.resume("--episodes 2");
    training.done();
    let mut undisturbed = Training::begin("--episodes 2");
    undisturbed.done();
    assert!(training.checkpoint() == undisturbed.checkpoint(), "the learners differ");
    assert_eq!(training.rows().len(), 2);
}

#[test]
fn a_training_whose_robots_are_killed_says_so_and_ends() {
    let mut training = Training::begin("");
    training.wait_until_rounds(1);
    let rollouts = processes(&training.folder());
    let of = |line: &str| line.contains("vodca\0rollout") && line.contains("--stochastic");
    let (pid, _) = rollouts.iter().find(|(_, line)| of(line)).expect("it plays");
    signal(*pid, "KILL");
    training.sessions.retain(|session| session != pid); // its shared files are swept away by the next run
    assert_eq!(training.end().code(), Some(1));
    let said = training.said();
    assert!(said.contains("the rollouts in") && said.contains("ended"), "{said}");
    training.resume("--episodes 1");
    training.done();
}

#[test]
fn a_disk_that_takes_no_checkpoint_ends_the_training_with_one_error() {
    policy_server();
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("all");
    // Blocks of 512 bytes: the exchange's shared files and the actor are smaller, a checkpoint is larger.
    let script = format!(
        "trap '' XFSZ; ulimit -f 16384; exec \"$0\" train {SMALL} --learn hidden=512 --episodes 1 --out \"$1\""
    );
    let mut child = Command::new("sh")
        .args(["-c", &script])
        .arg(learner())
        .arg(&folder)
        .stdout(Stdio::null())
        .stderr(File::create(place.path().join("stderr")).unwrap())
        .spawn()
        .unwrap();
    wait_until("the checkpoint is refused", || child.try_wait().unwrap().is_some());
    let said = fs::read_to_string(place.path().join("stderr")).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(1), "{said}");
    let errors: Vec<&str> = said.lines().filter(|line| line.starts_with("error: ")).collect();
    assert!(errors.len() == 1 && errors[0].contains("cannot write") && errors[0].contains("space left"), "{said}");
    wait_until("its processes end", || processes(&folder).is_empty());
    let mut resumed = train(place.path(), &format!("--episodes 1 --resume {}", folder.display()));
    wait_until("there is nothing to resume", || resumed.try_wait().unwrap().is_some());
    let said = fs::read_to_string(place.path().join("stderr")).unwrap();
    assert!(said.contains("holds no checkpoint of a training"), "{said}");
}

#[test]
fn a_plan_that_cannot_be_used_leaves_no_folder() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("all");
    let mut refused = train(place.path(), &format!("--scenario nowhere --out {}", out.display()));
    wait_until("it is refused", || refused.try_wait().unwrap().is_some());
    assert_eq!(refused.wait().unwrap().code(), Some(1));
    assert!(!out.exists());
}
