//! Promise: teams of processes without a policy do byte for byte what they have always done.

#[test]
fn seeded_runs_give_the_recorded_bytes() {
    tests::fence::hold(false);
}
