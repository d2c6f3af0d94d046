//! A controller of your own beside the product's: robot 0 walks straight on, the others avoid it.

use std::error::Error;
use std::sync::Arc;
use vodca::body::SimulatedBody;
use vodca::controller::{Controller, Decision, View};
use vodca::horizon::Horizon;
use vodca::layout::Layout;
use vodca::params::Profile;
use vodca::prediction::Prediction;
use vodca::robot::Robot;
use vodca::step::{Level, Status};
use vodca::{Position, Team};

/// Walks to its set-point at 1 m/s and looks at nobody.
struct Straight(Position);

impl Controller for Straight {
    fn tick(&mut self, view: &View<'_>) -> Decision {
        let way = self.0 - view.position;
        let input = way / way.norm().max(1.0); // m/s; slower on the last metre
        let plan = Prediction::roll_out(view.position, self.0, 0.2, &vec![input; view.horizon.steps()]);
        Decision {
            input,
            plan,
            rows: 0,
            level: Level::Baseline,
            status: Status::Solved,
            filtered: false,
            detect_ns: 0,
            solve_ns: 0,
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let (scenario, params) = vodca::set_up("four_cross", Profile::Safe, &[])?;
    let layout = Arc::new(Layout::of(&scenario, &params.model));
    let mut robots = vec![Robot::of(
        Box::new(SimulatedBody::new(0, scenario.robots[0].start, &params, 0)),
        Box::new(Straight(scenario.robots[0].set_point)),
    )];
    robots.extend((1..4).map(|robot| Robot::new(robot, &scenario, &params, &layout, 0)));
    let mut team = Team::of(robots, &scenario, &params, 0);
    for _ in 0..150 {
        team.step(&[Horizon::new(20)?; 4]);
    }
    for (robot, at) in scenario.robots.iter().zip(team.measured()) {
        println!("{}  {:.2} m from its set-point", robot.name, (robot.set_point - at).norm());
    }
    Ok(())
}
