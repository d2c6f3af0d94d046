//! Two runs at once do not meet.

use tests::{ENDLESS, Robots, Run};

#[test]
fn runs_at_the_same_time_do_what_each_does_alone() {
    let arguments = ["14 --horizon random:1", "14 --horizon random:2 --exchange relay"];
    let alone = arguments.map(|arguments| Run::start(Robots::Real, arguments).finish());
    let both = arguments.map(|arguments| Run::start(Robots::Real, arguments)).map(Run::finish);
    for (alone, together) in alone.iter().zip(&both) {
        assert_eq!(together.status.code(), Some(0), "{together:?}");
        assert!(alone.trajectory == together.trajectory && !alone.trajectory.is_empty());
    }
    assert_ne!(both[0].trajectory, both[1].trajectory);
}

#[test]
fn a_new_run_does_not_sweep_one_that_lives() {
    let mut first = Run::start(Robots::Real, &format!("14 {ENDLESS}"));
    first.wait_until_driving();
    let files = tests::shared_files(first.pid()).len();
    assert!(files > 10);
    assert_eq!(Run::start(Robots::Real, "2").finish().status.code(), Some(0));
    assert_eq!(tests::shared_files(first.pid()).len(), files);
    first.signal("TERM");
    assert_eq!(first.finish().status.code(), Some(0));
}
