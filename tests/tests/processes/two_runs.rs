//! Two runs at once do not meet.

use tests::Run;

#[test]
fn runs_at_the_same_time_do_what_each_does_alone() {
    let arguments = ["--scenario ex14_d --horizon random:1", "--scenario ex14_d --horizon random:2 --relay"];
    let alone = arguments.map(|arguments| Run::start("agent", arguments).finish());
    let both = arguments.map(|arguments| Run::start("agent", arguments)).map(Run::finish);
    for (alone, together) in alone.iter().zip(&both) {
        assert_eq!(together.status.code(), Some(0), "{together:?}");
        assert!(alone.steps == together.steps && !alone.steps.is_empty());
    }
    assert_ne!(both[0].steps, both[1].steps);
}

#[test]
fn a_new_run_does_not_sweep_one_that_lives() {
    let mut first = Run::start("agent", "--scenario ex14_d --to-the-end --max-ticks 10000000");
    first.wait_until_driving();
    let files = tests::shared_files(first.pid()).len();
    assert!(files > 10);
    assert_eq!(Run::start("agent", "--scenario two_setpoint").finish().status.code(), Some(0));
    assert_eq!(tests::shared_files(first.pid()).len(), files);
    first.signal("TERM");
    assert_eq!(first.finish().status.code(), Some(0));
}
