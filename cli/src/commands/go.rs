//! `go`: send a robot of a run that is under way somewhere else.

use crate::exit::{Ending, Failure, Outcome};
use crate::stdout;
use coordinator::orders::Order;
use shared::team::Setup;
use std::path::PathBuf;
use std::time::Duration;
use vodca::Position;

/// How long the run has to answer.
const PATIENCE: Duration = Duration::from_secs(5);

/// Arguments of `go`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example, for a run that was started with `./run.sh 14 --real-time --tasks orders --out my_run`:
  ./run.sh go my_run 3 -2.5 7
The robot turns round at once; what it had still to do comes afterwards. A place that is too near to another set-point or
to something that stands, or that cannot be reached, is refused.")]
pub struct Args {
    /// Folder of the run
    #[arg(value_name = "RUN")]
    run: PathBuf,
    /// Name or number of the robot, from 0
    #[arg(value_name = "ROBOT")]
    robot: String,
    /// Where it shall go, m
    #[arg(value_name = "X", allow_negative_numbers = true)]
    x: f64,
    /// Where it shall go, m
    #[arg(value_name = "Y", allow_negative_numbers = true)]
    y: f64,
}

/// Sends the robot there.
pub fn run(args: &Args) -> Ending {
    let Setup { team, scenario, .. } = Setup::load(&args.run).map_err(Failure::usage)?;
    if !team.place.is_owned() {
        return Err(Failure::usage(format!(
            "the run in {} has ended: nobody drives there any more",
            args.run.display()
        )));
    }
    let by_name = scenario.robots.iter().position(|robot| robot.name == args.robot);
    let robot = by_name.or_else(|| args.robot.parse().ok().filter(|&robot| robot < scenario.robots.len()));
    let robot = robot.ok_or_else(|| {
        let last = scenario.robots.len() - 1;
        Failure::usage(format!("there is no robot `{}`; write its name or a number in 0..={last}", args.robot))
    })?;
    let order = Order { robot, set_point: Position::new(args.x, args.y) };
    let tick = order.send(&args.run, PATIENCE).map_err(Failure::usage)?;
    stdout::line(format_args!(
        "{} goes to [{}, {}] m from tick {tick} on",
        scenario.robots[robot].name, args.x, args.y
    ))?;
    Ok(Outcome::Done)
}
