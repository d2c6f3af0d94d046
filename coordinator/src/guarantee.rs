//! Which guarantee of separation held in a run, in one sentence, and why not where it did not.

use vodca::metrics::{RunMetrics, RunSummary, SEPARATION_TOLERANCE};
use vodca::params::Params;
use vodca::scenario::Scenario;

/// What rounding may take from a start, m: the scenario check accepts starts up to this nearer.
const START_TOLERANCE: f64 = 1e-9;

/// What the parameters promised for a run, and whether it was so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guarantee {
    /// One sentence for users.
    pub statement: String,
    /// Somebody came nearer than was promised: a fault of vodca, whatever else went well.
    pub broken: bool,
}

/// What the parameters promise for this scenario; `summary` says how near it came.
pub fn judge(scenario: &Scenario, params: &Params, summary: &RunSummary) -> Guarantee {
    let none = |statement| Guarantee { statement, broken: false };
    let (limit, kept) = (params.model.min_separation, params.cell.separation);
    if !params.cell.enabled {
        return none(
            "none: this profile has no hard cell rows (cell.enabled = false); the separation was only measured".into(),
        );
    }
    let (noise, bound) = (params.disturbance.noise, params.cell.noise_bound);
    if noise > bound {
        return none(format!(
            "none: positions are measured with errors of up to {noise} m, the cells allow for {bound} m (cell.noise_bound)"
        ));
    }
    // Before the first tick the metrics know the distances at the start.
    let at_start = RunMetrics::new(scenario, params).min_separation();
    let started_nearer = at_start < kept - START_TOLERANCE;
    let promised = least_allowed(scenario, params, at_start);
    if let Some(least) = summary.min_separation.filter(|least| *least < promised - SEPARATION_TOLERANCE) {
        let statement = format!(
            "BROKEN: somebody came to {least:.6} m, at least {promised:.6} m was promised; this is a fault of vodca: \
             please report it with the run's folder"
        );
        return Guarantee { statement, broken: true };
    }
    if started_nearer {
        return none(format!(
            "some started {at_start:.3} m apart, nearer than {kept} m: no distance below {kept} m ever shrinks, \
             and none that has reached it falls below it again"
        ));
    }
    let when =
        if noise > 0.0 { "at the samples only (positions are measured with noise)" } else { "between samples too" };
    let held = format!(
        "separation of at least {kept} m, {when}, by hard cell rows and the safety filter ({} inputs changed)",
        summary.filtered
    );
    none(if kept < limit {
        format!("{held}; not the full {limit} m, because cell.separation is {kept} m")
    } else {
        held
    })
}

/// The least separation between samples that the promise allows, m. Under noise the promise is about the
/// samples, and a chord between two points outside a circle may cut it: both robots of a pair move by at
/// most sqrt(2) h v, v the largest speed, so the chord is no longer than twice that.
fn least_allowed(scenario: &Scenario, params: &Params, at_start: f64) -> f64 {
    let kept = params.cell.separation.min(at_start);
    if params.disturbance.noise == 0.0 {
        return kept;
    }
    if at_start < params.cell.separation - START_TOLERANCE {
        return f64::NEG_INFINITY; // of close starts nothing is promised under noise
    }
    let fastest = scenario.fastest(params.model.max_speed);
    let half_chord = std::f64::consts::SQRT_2 * params.model.sample_time * fastest;
    (kept * kept - half_chord * half_chord).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::samples;

    fn said(change: impl Fn(&mut Scenario, &mut Params)) -> String {
        let (mut scenario, mut params) = (samples::scenario(2), Params::safe());
        change(&mut scenario, &mut params);
        let summary = RunMetrics::new(&scenario, &params).finish();
        judge(&scenario, &params, &summary).statement
    }

    /// Two robots 10 m apart of which one came to `least` m.
    fn after(least: f64, change: impl Fn(&mut Scenario, &mut Params)) -> Guarantee {
        let (mut scenario, mut params) = (samples::scenario(2), Params::safe());
        change(&mut scenario, &mut params);
        let mut summary = RunMetrics::new(&scenario, &params).finish();
        summary.min_separation = Some(least);
        judge(&scenario, &params, &summary)
    }

    #[test]
    fn a_broken_promise_is_called_so_and_rounding_is_none() {
        let broken = after(1.499, |_, _| ());
        assert!(broken.broken && broken.statement.starts_with("BROKEN: somebody came to 1.499000 m"), "{broken:?}");
        assert!(!after(1.5 - 5e-7, |_, _| ()).broken);
        assert!(!after(0.1, |_, params| params.cell.enabled = false).broken);
        let close = |scenario: &mut Scenario, _: &mut Params| scenario.robots[1].start.x = 1.0;
        assert!(after(0.99, close).broken);
        assert!(!after(1.0, close).broken);
    }

    #[test]
    fn under_noise_the_promise_is_about_the_samples() {
        let noisy = |_: &mut Scenario, params: &mut Params| {
            (params.disturbance.noise, params.cell.noise_bound) = (0.02, 0.02);
        };
        let held = after(1.46, noisy); // between samples; at them it may have been 1.5 m
        assert!(!held.broken && held.statement.contains("at the samples only"), "{held:?}");
        assert!(after(1.4, noisy).broken);
    }

    #[test]
    fn a_start_that_touches_is_not_nearer() {
        let touching = |scenario: &mut Scenario, _: &mut Params| scenario.robots[1].start.x = 1.5 - 5e-10;
        assert!(said(touching).starts_with("separation of at least 1.5 m"), "{}", said(touching));
    }

    #[test]
    fn the_statement_fits_profile_start_and_separation() {
        assert!(said(|_, _| ()).starts_with("separation of at least 1.5 m"));
        assert!(said(|_, params| params.cell.enabled = false).starts_with("none: "));
        assert!(said(|_, params| params.cell.separation = 1.0).contains("not the full 1.5 m"));
        assert!(said(|_, params| params.disturbance.noise = 0.02).contains("errors of up to 0.02 m"));
        assert!(said(|scenario, _| scenario.robots[1].start.x = 1.0).starts_with("some started 1.000 m apart"));
    }
}
