//! `policy eval`: observation vectors in, what the policy makes of each out.

use crate::actor::{Actor, Answer};
use crate::check::{Case, ReferenceSet};
use crate::sample::{Choice, choose};
use crate::try_error::TryError;
use serde::Serialize;
use vodca::Position;
use vodca::horizon::Horizon;

/// What a policy makes of one observation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Evaluation {
    /// Mean of the raw action, per robot.
    pub mean: Vec<f32>,
    /// Its log_std, per robot; empty when the model has none.
    pub log_std: Vec<f32>,
    /// Action in [-1, 1], per robot.
    pub action: Vec<f64>,
    /// N_i, per robot.
    pub horizon: Vec<Horizon>,
}

/// Why an observation cannot be evaluated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EvalError {
    /// Not the numbers of this policy's robots.
    #[error("observation {index} has {has} numbers; this policy takes {wanted}: x and y of each robot, m")]
    Length {
        /// Which observation.
        index: usize,
        /// Its length.
        has: usize,
        /// 2N.
        wanted: usize,
    },
    /// NaN or infinite.
    #[error("observation {index}: the policy's answer for robot {robot} is not a finite number")]
    NotFinite {
        /// Which observation.
        index: usize,
        /// Which robot.
        robot: usize,
    },
    /// The back-end failed.
    #[error(transparent)]
    Try(#[from] TryError),
}

/// Evaluates `observations` ([x0, y0, x1, ...], m) one by one; the `index`th counts as tick `index`.
pub fn evaluate(actor: &mut Actor, observations: &[Vec<f64>], choice: Choice) -> Result<Vec<Evaluation>, EvalError> {
    let robots = actor.contract().robots;
    let mut answer = Answer::default();
    let mut input = vec![0.0f32; 2 * robots];
    let mut evaluations = Vec::with_capacity(observations.len());
    for (index, observation) in observations.iter().enumerate() {
        if observation.len() != 2 * robots {
            return Err(EvalError::Length { index, has: observation.len(), wanted: 2 * robots });
        }
        let positions: Vec<Position> = observation.chunks_exact(2).map(|xy| Position::new(xy[0], xy[1])).collect();
        actor.contract().normalise(&positions, &mut input);
        actor.infer(&input, &mut answer)?;
        let choices: Result<Vec<(f64, Horizon)>, EvalError> = (0..robots)
            .map(|robot| {
                choose(actor.contract(), &answer, choice, robot, index as u64)
                    .ok_or(EvalError::NotFinite { index, robot })
            })
            .collect();
        let (action, horizon) = choices?.into_iter().unzip();
        let Answer { mean, log_std } = answer.clone();
        evaluations.push(Evaluation { mean, log_std, action, horizon });
    }
    Ok(evaluations)
}

/// The reference set that `actor` itself gives for `observations`.
pub fn reference_set(actor: &mut Actor, observations: &[Vec<f64>], tolerance: f64) -> Result<ReferenceSet, EvalError> {
    let evaluations = evaluate(actor, observations, Choice::Mean)?;
    let wide = |numbers: Vec<f32>| numbers.into_iter().map(f64::from).collect();
    let cases = observations.iter().zip(evaluations).map(|(observation, evaluation)| Case {
        observation: observation.clone(),
        mean: wide(evaluation.mean),
        log_std: wide(evaluation.log_std),
        horizon: evaluation.horizon,
    });
    Ok(ReferenceSet { tolerance, cases: cases.collect() })
}
