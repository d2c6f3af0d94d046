//! One tick of one robot: what it knows goes in, its input and its plan come out.

use std::error::Error;
use std::sync::Arc;
use vodca::controller::{Controller, Neighbour, View};
use vodca::horizon::Horizon;
use vodca::layout::Layout;
use vodca::params::Profile;
use vodca::vodca_controller::VodcaController;

fn main() -> Result<(), Box<dyn Error>> {
    // Fourteen robots that change sides; robot 0 is ours.
    let (scenario, params) = vodca::set_up("ex14_d", Profile::Safe, &[])?;
    let layout = Arc::new(Layout::of(&scenario, &params.model));
    let mut controller = VodcaController::new(0, &params, &layout);

    // Before the first tick everybody knows where the others start and where they want to go.
    let known = |robot: &vodca::scenario::Robot| Neighbour::at_start(robot.start, robot.set_point);
    let neighbours: Vec<Neighbour> = scenario.robots.iter().map(known).collect();
    let view =
        View { tick: 0, horizon: Horizon::new(20)?, position: scenario.robots[0].start, neighbours: &neighbours };

    let decision = controller.tick(&view);
    println!("input   {:.3}, {:.3} m/s", decision.input.x, decision.input.y);
    println!("plan    {} steps, the next at {:.3?} m", decision.plan.horizon(), decision.plan.state(1).as_slice());
    println!("solved  by {:?} with {} collision rows", decision.level, decision.rows);
    Ok(())
}
