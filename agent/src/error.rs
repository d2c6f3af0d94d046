//! How a robot's process can fail.

use shared::services::ServiceError;
use shared::team::TeamError;
use std::path::PathBuf;
use vodca::horizon::MAX_HORIZON;
use vodca::scenario::ScenarioError;

/// Why a robot's process failed.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The run's folder.
    #[error(transparent)]
    Team(#[from] TeamError),
    /// The layout of an episode.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// There is no such robot.
    #[error("there is no robot {robot}: the team has robots 0..={last}")]
    NoSuchRobot {
        /// The one asked for.
        robot: usize,
        /// The last one.
        last: usize,
    },
    /// The exchange.
    #[error(transparent)]
    Exchange(#[from] ServiceError),
    /// Nothing was announced for too long.
    #[error("the coordinator has announced nothing for {seconds:.1} s ({place}); it has ended or hangs")]
    Silent {
        /// How long, s.
        seconds: f64,
        /// Before the first tick, or after which.
        place: String,
    },
    /// What came with the announcement is no horizon.
    #[error(
        "no horizon in 1..={MAX_HORIZON} for robot {robot} came with the announcement of tick {tick}; is its coordinator of another version?"
    )]
    NoHorizon {
        /// Which robot.
        robot: usize,
        /// k.
        tick: u64,
    },
    /// Nobody is there to drive for.
    #[error("{}: has the run ended? The process that owns it is gone; start robots while it runs", run.display())]
    Ended {
        /// The run's folder.
        run: PathBuf,
    },
    /// Somebody else drives this robot.
    #[error(
        "robot {robot} was not admitted to the run within {seconds:.0} s: another process drives it; start it again when that one has ended"
    )]
    NotAdmitted {
        /// Which robot.
        robot: usize,
        /// How long it waited, s.
        seconds: f64,
    },
    /// The run goes on without this process.
    #[error("robot {robot} was given up by its run{}; this process must not drive it any more", match last {
        Some(tick) => format!(" after tick {tick}"),
        None => String::new(),
    })]
    Superseded {
        /// Which robot.
        robot: usize,
        /// The last tick that it planned.
        last: Option<u64>,
    },
    /// The process that started this robot is gone.
    #[error("process {parent}, which started this robot, has ended")]
    Orphaned {
        /// Its number.
        parent: u32,
    },
}
