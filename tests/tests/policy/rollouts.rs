//! Promise: recorded rollouts depend on nothing but what was asked for, and say how episodes ended.

use crate::{actor, policy_server};
use policy::folder::PolicyFolder;
use policy::rollout::{Row, Shard, shards};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tests::program;

/// Plays `coordinator rollout ARGUMENTS` into the folder `out`; its shards.
fn rollout(out: &Path, arguments: &str) -> Vec<PathBuf> {
    let output = Command::new(program("vodca"))
        .arg("rollout")
        .args(arguments.split_whitespace())
        .arg("--out")
        .arg(out)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    shards(out).unwrap()
}

fn bytes(paths: &[PathBuf]) -> Vec<Vec<u8>> {
    paths.iter().map(|path| fs::read(path).unwrap()).collect()
}

#[test]
fn the_same_seed_gives_the_same_bytes_through_either_exchange() {
    let place = tempfile::tempdir().unwrap();
    let ask = |name: &str, seed: u64, more: &str| {
        let asked = format!("--scenario four_gate --episodes 3 --max-ticks 40 --start-jitter 0.2 --seed {seed} {more}");
        bytes(&rollout(&place.path().join(name), &asked))
    };
    let peer = ask("peer", 7, "--exchange peer");
    assert_eq!(peer.len(), 1);
    assert!(peer == ask("relay", 7, "--exchange relay"));
    assert!(peer != ask("other", 8, "--exchange peer"));
}

#[test]
fn what_a_row_leads_to_is_what_the_next_row_sees_with_noise_too() {
    let place = tempfile::tempdir().unwrap();
    let asked = "--scenario four_gate --episodes 3 --max-ticks 40 --set disturbance.noise=0.05 --seed 5";
    let shard = Shard::read(&rollout(&place.path().join("noisy"), asked)[0]).unwrap();
    let rows: Vec<Row<'_>> = shard.iter().collect();
    let mut pairs = 0;
    for pair in rows.windows(2).filter(|pair| pair[0].episode == pair[1].episode) {
        assert_eq!(pair[0].next_observation, pair[1].observation, "episode {} tick {}", pair[0].episode, pair[0].tick);
        pairs += 1;
    }
    assert_eq!(pairs, 3 * 39);
    // It is what was measured, not what is true: the start is exactly known.
    let start = vodca::scenario::Scenario::resolve(Some("four_gate"), None).unwrap().robots[0].start;
    assert!(rows[0].observation[0] != start.x as f32 && (rows[0].observation[0] - start.x as f32).abs() <= 0.05);
}

/// The rows of episode `episode`.
fn episode(shard: &Shard, episode: u64) -> Vec<String> {
    let rows = shard.iter().filter(|row| row.episode == episode);
    rows.map(|row| format!("{row:?}")).collect()
}

#[test]
fn an_episode_of_a_session_is_the_same_played_alone() {
    policy_server();
    let place = tempfile::tempdir().unwrap();
    let policy = PolicyFolder::new(place.path().join("policy"));
    let (model, contract) = actor(2, 20);
    policy.publish(&model, &contract, None).unwrap();
    let policy = format!("--policy {} --stochastic", policy.root().display());
    for (name, horizons) in [("random", "--horizon random"), ("policy", policy.as_str())] {
        let asked = format!("--scenario box:2:1:any --max-ticks 30 --start-jitter 0.1 --seed 3 {horizons}");
        let all = rollout(&place.path().join(format!("{name}-all")), &format!("{asked} --episodes 4"));
        let one = rollout(&place.path().join(format!("{name}-one")), &format!("{asked} --episodes 1 --first 2"));
        let (all, one) = (Shard::read(&all[0]).unwrap(), Shard::read(&one[0]).unwrap());
        assert_eq!(episode(&all, 2).len(), 30, "{name}");
        assert_eq!(episode(&all, 2), episode(&one, 2), "{name}");
        assert_ne!(episode(&all, 1)[0].split("observation").nth(1), episode(&all, 2)[0].split("observation").nth(1));
    }
}

/// Number, ticks, terminated and truncated of the last row of each episode; no other row may have either.
fn ends(shard: &Shard) -> Vec<(u64, u64, bool, bool)> {
    let rows: Vec<Row<'_>> = shard.iter().collect();
    let last = |at: usize| rows.get(at + 1).is_none_or(|next| next.episode != rows[at].episode);
    let mut ends = Vec::new();
    for (at, row) in rows.iter().enumerate() {
        if last(at) {
            ends.push((row.episode, row.tick + 1, row.terminated, row.truncated));
        } else {
            assert!(!row.terminated && !row.truncated, "episode {} tick {}", row.episode, row.tick);
        }
    }
    ends
}

#[test]
fn a_time_limit_truncates_arrival_truncates_and_a_collision_terminates() {
    let place = tempfile::tempdir().unwrap();
    let played = |name: &str, arguments: &str| {
        ends(&Shard::read(&rollout(&place.path().join(name), &format!("{arguments} --episodes 2"))[0]).unwrap())
    };
    let limit = played("limit", "--scenario two_setpoint --profile paper --horizon fixed:20 --max-ticks 30");
    assert_eq!(limit, [(0, 30, false, true), (1, 30, false, true)]);
    let family = played("family", "--scenario box:4:2:any --horizon fixed:20 --max-ticks 15");
    assert_eq!(family, [(0, 15, false, true), (1, 15, false, true)]);

    let at_once = played("at-once", "--scenario two_setpoint --horizon fixed:20 --after-arrival 0");
    let later = played("later", "--scenario two_setpoint --horizon fixed:20 --after-arrival 5");
    for (at_once, later) in at_once.iter().zip(&later) {
        assert!(!at_once.2 && at_once.3 && at_once.1 < 350, "{at_once:?}");
        assert_eq!((later.1, later.2, later.3), (at_once.1 + 5, false, true));
    }
    // The published method collides here.
    let collided = played("collided", "--scenario ex14_d --profile paper --horizon fixed:20");
    assert!(
        collided.iter().all(|(_, ticks, terminated, truncated)| *terminated && !truncated && *ticks < 350),
        "{collided:?}"
    );
}
