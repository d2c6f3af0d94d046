//! The named parameter sets.

use super::*;
use std::fmt;
use std::str::FromStr;

/// The named parameter sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Profile {
    /// The paper's method; where it is silent, `docs/PARAMETERS.md` says how it is read.
    Paper,
    /// The full separation by construction, and rules that bring everybody to the set-point (`docs/ARCHITECTURE.md`).
    Safe,
    /// The baseline ORCA.
    Orca,
    /// ORCA, aiming to the right.
    OrcaRh,
}

/// The name of a profile that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown profile `{0}`; the profiles are: paper, safe, orca, orca-rh")]
pub struct UnknownProfile(pub String);

impl FromStr for Profile {
    type Err = UnknownProfile;
    fn from_str(name: &str) -> Result<Self, UnknownProfile> {
        match name {
            "paper" => Ok(Self::Paper),
            "safe" => Ok(Self::Safe),
            "orca" => Ok(Self::Orca),
            "orca-rh" => Ok(Self::OrcaRh),
            other => Err(UnknownProfile(other.into())),
        }
    }
}

impl fmt::Display for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Paper => "paper",
            Self::Safe => "safe",
            Self::Orca => "orca",
            Self::OrcaRh => "orca-rh",
        })
    }
}

impl Params {
    /// The paper's method (section III, constants of Table I).
    pub fn paper() -> Self {
        Self {
            model: Model { sample_time: 0.2, max_speed: 1.5, min_separation: 1.5 },
            mpc: Mpc { state_weight: 5.0, input_weight: 10.0, reference: Reference::SetPoint },
            vodca: Vodca {
                rows: RowChoice::First,
                row_step: RowStep::Conflict,
                beyond_horizon: BeyondHorizon::Clamp,
                first_compared_step: 1,
                tie: Tie::Nearest,
                nearby_factor: 1.5,
                turn: 0.0,
                turn_lasting: 0.0,
                lasting_memory: 0.03,
                patience: 1.0,
                back_off: 1.0,
                softness: Softness::Hard,
                infeasible: Infeasible::Relax,
                slack_linear: 1e5,
                slack_quadratic: 1e3,
            },
            aim: Aim { angle: 0.0, memory: 0.1, fade_start: 1.5, fade_end: 4.5, look_ahead: 0, most: 0.6, price: 3.0 },
            give_way: GiveWay { radius: 0.0, clearance: 0.1 },
            cell: Cell { enabled: false, separation: 1.5, escape: 0.0, noise_bound: 0.0 },
            horizon: HorizonParams { jitter: 0 },
            episode: Episode { arrival_tolerance: 0.1, collision_factor: 0.5 },
            controller: Controller { kind: ControllerKind::Vodca },
            orca: Orca {
                time_horizon: 2.0,
                neighbour_distance: 15.0,
                max_neighbours: 20,
                aim: 0.0,
                fade: 3.0,
                push: 0.0,
            },
            disturbance: Disturbance { noise: 0.0, plan_delay: 0, plan_loss: 0.0, position_loss: 0.0 },
        }
    }

    /// The safe controller (ARCHITECTURE, rules 1 to 15).
    pub fn safe() -> Self {
        let mut params = Self::paper();
        params.mpc.reference = Reference::Route;
        params.vodca.rows = RowChoice::Each;
        params.vodca.turn = 0.16;
        params.vodca.turn_lasting = 0.5;
        params.vodca.lasting_memory = 0.025;
        params.vodca.patience = 0.8;
        params.vodca.back_off = 0.95;
        params.vodca.softness = Softness::Soft;
        params.vodca.slack_linear = 350.0;
        params.mpc.input_weight = 5.0;
        params.aim =
            Aim { angle: 0.1, memory: 0.4, fade_start: 2.2, fade_end: 5.4, look_ahead: 49, most: 0.6, price: 2.5 };
        params.horizon.jitter = 3;
        params.give_way.radius = 1.2;
        params.cell.enabled = true;
        params
    }

    /// The baseline ORCA: no plans, no guarantee.
    pub fn orca() -> Self {
        let mut params = Self::paper();
        params.controller.kind = ControllerKind::Orca;
        params
    }

    /// ORCA with every robot aiming to the right of its set-point: the strongest baseline found.
    pub fn orca_rh() -> Self {
        let mut params = Self::orca();
        params.orca.time_horizon = 1.0;
        params.orca.aim = 0.35;
        params
    }

    /// The parameters of a profile.
    pub fn of(profile: Profile) -> Self {
        match profile {
            Profile::Paper => Self::paper(),
            Profile::Safe => Self::safe(),
            Profile::Orca => Self::orca(),
            Profile::OrcaRh => Self::orca_rh(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_are_known_by_the_names_they_print() {
        for profile in [Profile::Paper, Profile::Safe, Profile::Orca, Profile::OrcaRh] {
            assert_eq!(profile.to_string().parse(), Ok(profile));
        }
        let message = "fast".parse::<Profile>().unwrap_err().to_string();
        assert_eq!(message, "unknown profile `fast`; the profiles are: paper, safe, orca, orca-rh");
    }
}
