//! The separation guarantee of the safe profile, whatever the horizons and the crowd.

use vodca::Position;
use vodca::horizon::Horizon;
use vodca::metrics::RunMetrics;
use vodca::params::Params;
use vodca::random::{self, Use};
use vodca::scenario::{Obstacle, Robot, Scenario};
use vodca::team::Team;

/// Robots as dense as they fit, some exactly 1.5 m apart, with set-points anywhere among them.
fn crowd(seed: u64) -> Scenario {
    let mut generator = random::stream(seed, Use::Scenario, 99, 0);
    let mut draw = |width: f64| (random::unit(&mut generator) - 0.5) * width;
    let count = 4 + (seed % 9) as usize;
    let width = 2.0 * (count as f64).sqrt();
    let mut places: Vec<Position> = Vec::new();
    while places.len() < count {
        let mut place = Position::new(draw(width), draw(width));
        if let Some(&near) = places.iter().find(|&&other| (other - place).norm() < 1.8) {
            place = near + (place - near).normalize() * 1.5; // touching
        }
        if places.iter().all(|&other| (other - place).norm() >= 1.5) {
            places.push(place);
        }
    }
    let obstacles = places.split_off(count - 1);
    let robots = places.iter().enumerate().map(|(index, &start)| Robot {
        name: format!("robot{index}"),
        start,
        set_point: Position::new(draw(2.0 * width), draw(2.0 * width)),
        radius: None,
        max_speed: None,
    });
    Scenario {
        name: format!("crowd{seed}"),
        robots: robots.collect(),
        obstacles: obstacles.iter().map(|&position| Obstacle { name: "o".into(), position, radius: None }).collect(),
        shapes: Vec::new(),
        max_ticks: 40,
        seed,
        allow_close_start: false,
        params: toml::Table::new(),
    }
}

/// Smallest separation over 40 ticks with random horizons.
fn least_separation(scenario: &Scenario, params: &Params) -> f64 {
    let mut metrics = RunMetrics::new(scenario, params);
    let mut team = Team::new(scenario, params, scenario.seed);
    for tick in 0..scenario.max_ticks {
        let random = |robot| Horizon::random(scenario.seed, robot, tick);
        let horizons: Vec<Horizon> = (0..scenario.robots.len()).map(random).collect();
        let steps = team.step(&horizons);
        metrics.observe(tick, steps);
    }
    metrics.min_separation()
}

#[test]
fn crowds_keep_their_separation_whatever_the_horizons() {
    let params = Params::safe();
    for seed in 0..400 {
        let least = least_separation(&crowd(seed), &params);
        assert!(least >= 1.5 - 1e-7, "seed {seed}: {least}");
    }
}

#[test]
fn the_guarantee_needs_no_sensible_plans() {
    // Rows that cost nothing to violate, plans lost or late, no reason to avoid anybody: only the cells hold.
    for seed in 0..200 {
        let mut params = Params::safe();
        params.vodca.slack_linear = 0.0;
        params.vodca.slack_quadratic = 1e-3;
        params.aim.angle = 0.0;
        params.give_way.radius = 0.0;
        params.disturbance.plan_delay = (seed % 3) as usize;
        params.disturbance.plan_loss = 0.5;
        let least = least_separation(&crowd(seed), &params);
        assert!(least >= 1.5 - 1e-7, "seed {seed}: {least}");
    }
}

#[test]
fn lost_positions_do_not_cost_the_guarantee() {
    for seed in 0..200 {
        let mut params = Params::safe();
        params.disturbance.position_loss = 0.4;
        let least = least_separation(&crowd(seed), &params);
        assert!(least >= 1.5 - 1e-7, "seed {seed}: {least}");
    }
}

#[test]
fn noise_within_its_bound_keeps_the_separation_at_samples() {
    for seed in 0..100 {
        let mut params = Params::safe();
        params.disturbance.noise = 0.02;
        params.cell.noise_bound = 0.02;
        // Room for the buffer: the same crowd, stretched.
        let mut scenario = crowd(seed);
        scenario.robots.iter_mut().for_each(|robot| robot.start *= 1.06);
        scenario.obstacles.iter_mut().for_each(|obstacle| obstacle.position *= 1.06);
        let least = least_separation(&scenario, &params);
        assert!(least >= 1.5 - 1e-7, "seed {seed}: {least}");
    }
}

#[test]
fn without_the_cells_these_crowds_would_touch() {
    // The tests above can fail: it is the cells that keep the separation.
    let mut params = Params::safe();
    params.cell.enabled = false;
    assert!((0..20).any(|seed| least_separation(&crowd(seed), &params) < 1.4));
}
