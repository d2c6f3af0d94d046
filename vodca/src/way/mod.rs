//! Where a robot looks: the shortest way round what stands, and who goes first on it (ARCHITECTURE, rules 12 to 15).
//!
//! A plan sees an obstacle only along its horizon and slides past on one side. Where another obstacle or a
//! robot that has arrived closes that side, it stays in the pocket for ever. The shortest way leads round.

mod chains;
mod corners;
mod filling;
mod lower_bound;
mod path;
pub mod right_of_way;
mod robot_set;
mod route;
mod standing;

pub use filling::Filling;
pub use lower_bound::LowerBound;
pub use path::Path;
pub use robot_set::RobotSet;
pub use route::{Rest, Route};
pub use standing::Standing;
