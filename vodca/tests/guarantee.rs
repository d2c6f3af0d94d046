//! The separation guarantee of the safe profile, whatever the horizons and the crowd.

use vodca::Position;
use vodca::horizon::Horizon;
use vodca::membership::State;
use vodca::metrics::RunMetrics;
use vodca::params::Params;
use vodca::random::{self, Use};
use vodca::scenario::{Obstacle, Robot, Scenario};
use vodca::step::Status;
use vodca::team::{Attendance, Team};

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

/// Who takes part in the next tick, when every robot misses one in ten, dies in every second case, and comes back after
/// some ticks.
fn roll(states: &mut [State], seed: u64, tick: u64) -> Vec<Attendance> {
    let next = |(robot, state): (usize, &mut State)| {
        let mut draw = random::stream(seed, Use::Fault, robot as u64, tick);
        let announced = *state;
        let misses = random::unit(&mut draw) < 0.1;
        let dies = random::unit(&mut draw) < 0.5;
        let returns = random::unit(&mut draw) < 0.3;
        let missing = match announced {
            State::Late => Some(Status::Late),
            State::Lost => Some(Status::Lost),
            _ if misses && dies => Some(Status::Lost),
            _ if misses => Some(Status::Late),
            _ => None,
        };
        *state = match missing {
            Some(_) if returns => State::Back,
            Some(Status::Lost) => State::Lost,
            Some(_) => State::Late,
            None => State::Driving,
        };
        Attendance { announced, missing }
    };
    states.iter_mut().enumerate().map(next).collect()
}

#[test]
fn crowds_keep_their_separation_whoever_is_late_dies_or_comes_back() {
    for seed in 0..300 {
        let mut params = Params::safe();
        params.disturbance.position_loss = if seed % 3 == 0 { 0.2 } else { 0.0 };
        params.disturbance.plan_delay = (seed % 2) as usize;
        let scenario = crowd(seed);
        let robots = scenario.robots.len();
        let (mut metrics, mut team) = (RunMetrics::new(&scenario, &params), Team::new(&scenario, &params, seed));
        let (mut states, mut absent) = (vec![State::Driving; robots], 0);
        for tick in 0..scenario.max_ticks {
            let horizons: Vec<Horizon> = (0..robots).map(|robot| Horizon::random(seed, robot, tick)).collect();
            let before: Vec<Position> = team.measured().to_vec();
            let steps = team.step_without(&horizons, &roll(&mut states, seed, tick));
            for (step, before) in steps.iter().zip(before).filter(|(step, _)| !step.status.took_part()) {
                absent += 1;
                assert_eq!((step.position, step.next_position), (before, before), "who does not take part stands");
            }
            metrics.observe(tick, steps);
        }
        let least = metrics.min_separation();
        assert!(least >= 1.5 - 1e-7, "seed {seed}: {least}");
        assert!(absent > 0 || robots < 4, "seed {seed}");
    }
}

#[test]
fn a_team_of_which_nobody_is_ever_absent_drives_as_if_nobody_could_be() {
    let (scenario, params) = (crowd(5), Params::safe());
    let robots = scenario.robots.len();
    let (mut one, mut other) = (Team::new(&scenario, &params, 5), Team::new(&scenario, &params, 5));
    let all = vec![Attendance { announced: State::Driving, missing: None }; robots];
    for tick in 0..40 {
        let horizons: Vec<Horizon> = (0..robots).map(|robot| Horizon::random(5, robot, tick)).collect();
        let place = |step: &vodca::step::Step| step.next_position;
        let expected: Vec<Position> = one.step(&horizons).iter().map(place).collect();
        assert_eq!(other.step_without(&horizons, &all).iter().map(place).collect::<Vec<_>>(), expected);
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
