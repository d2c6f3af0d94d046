//! The one loop that runs a team, whether it lives in this process or in many.
//!
//! A tick: the team is ready, horizons are chosen from where everybody measures itself, the team plans and moves,
//! the metrics and then the observers see what came of it. Recorders, views, rollouts and progress are observers.

use crate::Position;
use crate::horizon::Horizon;
use crate::horizon_source::Horizons;
use crate::metrics::RunMetrics;
use crate::step::Step;
use crate::tasks::Assignment;

/// A team that [`play`] can run.
pub trait Playable {
    /// Why a tick may not be finished.
    type Error;

    /// Waits until tick `tick` may begin (a clock, a pause).
    ///
    /// # Errors
    /// The run cannot go on.
    fn await_tick(&mut self, _tick: u64) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Where every robot measures itself at the start of the next tick, m, by robot number.
    fn measured(&self) -> &[Position];

    /// Everybody plans tick `tick` with its horizon and moves.
    ///
    /// # Errors
    /// The tick was not finished by everybody.
    fn tick(&mut self, tick: u64, horizons: &[Horizon]) -> Result<(), Self::Error>;

    /// What every robot did in the newest tick, by robot number.
    fn steps(&self) -> &[Step];

    /// The set-points that hold since the newest tick.
    fn assigned(&self) -> &[Assignment] {
        &[]
    }

    /// Whether a robot that is lost comes back, or somebody has another task: the run does not end without it.
    fn awaits_somebody(&self) -> bool {
        false
    }
}

/// What an observer wants after a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The next tick.
    Continue,
    /// The end: it has seen enough.
    Over,
}

/// A tick that everybody has finished.
#[derive(Debug)]
pub struct Tick<'a, T, H> {
    /// k.
    pub tick: u64,
    /// What every robot did, by robot number; `measured` and `next_measured` of a step are where its robot
    /// measured itself before and after.
    pub steps: &'a [Step],
    /// The figures of the run so far, this tick included.
    pub metrics: &'a RunMetrics,
    /// The team: what it knows beyond its steps.
    pub team: &'a T,
    /// Who chose the horizons.
    pub horizons: &'a H,
}

/// Watches a run tick by tick.
pub trait Observer<T, H> {
    /// Why it cannot go on watching; the run ends then.
    type Error;

    /// Sees a finished tick.
    ///
    /// # Errors
    /// The run shall end because of this observer.
    fn tick(&mut self, seen: &Tick<'_, T, H>) -> Result<Verdict, Self::Error>;
}

impl<T, H, E, F: FnMut(&Tick<'_, T, H>) -> Result<Verdict, E>> Observer<T, H> for F {
    type Error = E;

    fn tick(&mut self, seen: &Tick<'_, T, H>) -> Result<Verdict, E> {
        self(seen)
    }
}

/// When a run ends that nobody ends.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// K, the most ticks.
    pub max_ticks: u64,
    /// Whether it also ends with the first tick after which nobody is under way ([`RunMetrics::settled`]).
    pub until_arrival: bool,
}

/// How a run ended that came to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Nobody was under way any more, or an observer had seen enough.
    Over,
    /// All ticks were used up.
    OutOfTicks,
}

/// Who ended a run before its end.
#[derive(Debug)]
pub enum Halt<T, H, O> {
    /// The team.
    Team(T),
    /// Nobody chose horizons.
    Horizons(H),
    /// An observer.
    Observer(O),
}

/// Why [`play`] of these ended before its end.
pub type HaltOf<T, H, O> = Halt<<T as Playable>::Error, <H as Horizons>::Error, O>;

/// Runs `team` with the horizons of `horizons` for one tick at least; `metrics` are new, and see every finished tick
/// before the observers do, in their order.
///
/// # Errors
/// Whatever ended the run before its end; `metrics` hold the ticks that were finished.
pub fn play<T: Playable, H: Horizons, E>(
    team: &mut T,
    horizons: &mut H,
    observers: &mut [&mut dyn Observer<T, H, Error = E>],
    metrics: &mut RunMetrics,
    limits: Limits,
) -> Result<Ending, HaltOf<T, H, E>> {
    let mut chosen = vec![Horizon::MAX; team.measured().len()];
    for tick in 0..limits.max_ticks {
        team.await_tick(tick).map_err(Halt::Team)?;
        horizons.choose(tick, team.measured(), &mut chosen).map_err(Halt::Horizons)?;
        team.tick(tick, &chosen).map_err(Halt::Team)?;
        metrics.assign(team.assigned());
        metrics.observe(tick, team.steps());
        let seen = Tick { tick, steps: team.steps(), metrics, team: &*team, horizons: &*horizons };
        let mut over = limits.until_arrival && metrics.settled() && !team.awaits_somebody();
        for observer in observers.iter_mut() {
            over |= observer.tick(&seen).map_err(Halt::Observer)? == Verdict::Over;
        }
        if over {
            return Ok(Ending::Over);
        }
    }
    Ok(Ending::OutOfTicks)
}
