//! What the controller is for, as moving pictures: parking, a door, a warehouse, a ring.

use super::Failed;
use super::animation::{Look, animation};
use super::kept_run::Setting;
use vodca::params::Profile;

/// A run that is shown.
#[derive(Clone, Copy, Debug)]
pub(super) struct Film {
    /// The name of its file.
    pub(super) file: &'static str,
    scenario: &'static str,
    /// What it shows.
    title: &'static str,
    look: Look,
}

/// The films: tight places and walls, one of each kind.
pub(super) const FILMS: [Film; 4] = [
    Film {
        file: "film_parking.svg",
        scenario: "park:16:7",
        title: "Sixteen robots fill a square of places 1.55 m apart",
        look: Look { scale: 22.0, speed: 4.0, every: 2, plans: false },
    },
    Film {
        file: "film_door.svg",
        scenario: "door:10:3.4:3",
        title: "Ten robots change sides through a door",
        look: Look { scale: 16.0, speed: 4.0, every: 2, plans: false },
    },
    Film {
        file: "film_warehouse.svg",
        scenario: "warehouse:20:3",
        title: "Twenty robots between stations and shelves, on a ROS map",
        look: Look { scale: 16.0, speed: 4.0, every: 2, plans: false },
    },
    Film {
        file: "film_ring.svg",
        scenario: "tight_ring:32:3",
        title: "Thirty-two robots, each to the opposite place",
        look: Look { scale: 20.0, speed: 3.0, every: 2, plans: false },
    },
];

impl Film {
    /// Runs and draws it.
    pub(super) fn draw(&self) -> Result<String, Failed> {
        let setting = Setting { scenario: self.scenario, profile: Profile::Safe, set: None, policy: None };
        let kept = setting.run("fixed:20")?;
        let seconds = kept.ticks.len() as f64 * kept.params.model.sample_time;
        let title = format!("{}: {seconds:.0} s, {} times as fast", self.title, self.look.speed);
        Ok(animation(&setting, &kept, &self.look, &title))
    }
}
