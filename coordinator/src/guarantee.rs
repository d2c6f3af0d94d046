//! Which guarantee of separation held in a run, in one sentence, and why not where it did not.

use shared::metrics::{RunMetrics, RunSummary};
use shared::params::Params;
use shared::scenario::Scenario;

/// What the parameters promise for this scenario; `summary` says how near it came.
pub fn statement(scenario: &Scenario, params: &Params, summary: &RunSummary) -> String {
    let (limit, kept) = (params.model.min_separation, params.cell.separation);
    if !params.cell.enabled {
        return "none: this profile has no hard cell rows (cell.enabled = false); the separation was only measured"
            .into();
    }
    let (noise, bound) = (params.disturbance.noise, params.cell.noise_bound);
    if noise > bound {
        return format!(
            "none: positions are measured with errors of up to {noise} m, the cells allow for {bound} m (cell.noise_bound)"
        );
    }
    // Before the first tick the metrics know the distances at the start.
    let at_start = RunMetrics::new(scenario, params).min_separation();
    if at_start < kept {
        return format!(
            "some started {at_start:.3} m apart, nearer than {kept} m: no distance below {kept} m ever shrinks, \
             and none that has reached it falls below it again"
        );
    }
    let held = format!(
        "separation of at least {kept} m, between samples too, by hard cell rows and the last check \
         ({} inputs changed)",
        summary.shielded
    );
    if kept < limit { format!("{held}; not the full {limit} m, because cell.separation is {kept} m") } else { held }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::samples;

    fn said(change: impl Fn(&mut Scenario, &mut Params)) -> String {
        let (mut scenario, mut params) = (samples::scenario(2), Params::safe());
        change(&mut scenario, &mut params);
        let summary = RunMetrics::new(&scenario, &params).finish();
        statement(&scenario, &params, &summary)
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
