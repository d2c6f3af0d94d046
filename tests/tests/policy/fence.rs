//! Promise: teams whose horizons a policy chooses do byte for byte what they have always done.

#[test]
fn seeded_runs_with_the_published_policies_give_the_recorded_bytes() {
    crate::policy_server();
    tests::fence::hold(true);
}
