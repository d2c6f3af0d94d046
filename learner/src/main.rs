//! The program behind `./run.sh learn`.

use std::time::Instant;

fn main() {
    let settings = learner::Settings {
        replay_rows: 10_000,
        threads: std::env::args().nth(1).map_or(1, |t| t.parse().unwrap_or(1)),
        ..learner::Settings::default()
    };
    let mut learner = learner::Learner::new(28, 14, settings, 1);
    let mut x = 0.1f32;
    let mut draw = |n: usize| -> Vec<f32> {
        (0..n)
            .map(|_| {
                x = (x * 3.9 * (1.0 - x)).clamp(1e-3, 0.999);
                2.0 * x - 1.0
            })
            .collect()
    };
    for _ in 0..5000 {
        let (s, a, n) = (draw(28), draw(14), draw(28));
        learner.remember(learner::Transition {
            observation: &s,
            action: &a,
            reward: 100.0 * a[0],
            terminated: false,
            next_observation: &n,
        });
    }
    for _ in 0..5 {
        let start = Instant::now();
        let mut last = learner.update();
        for _ in 1..200 {
            last = learner.update();
        }
        println!("{:.1} updates/s {last:?}", 200.0 / start.elapsed().as_secs_f64());
    }
}
