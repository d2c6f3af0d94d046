//! Promise: a viewer that never reads holds nothing up: the run arrives, ends, and gives the same bytes.

use std::io::Write;
use std::net::TcpStream;
use tests::{Robots, Run, wait_until};

#[test]
fn a_run_with_a_browser_that_never_reads_is_the_run_without_it() {
    let arguments = "14 --set model.sample_time=0.05 --max-ticks 1000";
    let alone = Run::start(Robots::Real, arguments).finish();
    // Real time: the viewer is there for most of the run.
    let mut watched = Run::start(Robots::Real, &format!("{arguments} --real-time --live"));
    let mut address = String::new();
    wait_until("the address of the live page", || {
        let printed = watched.printed();
        let line = printed.lines().find_map(|line| line.strip_prefix("live view"));
        address = line.unwrap_or_default().trim().trim_start_matches("http://").trim_end_matches('/').into();
        !address.is_empty()
    });
    let mut deaf = TcpStream::connect(&address).unwrap();
    write!(deaf, "GET /frames HTTP/1.1\r\nHost: {address}\r\n\r\n").unwrap();
    watched.wait();
    let watched = watched.finish();
    assert_eq!((alone.status.code(), watched.status.code()), (Some(0), Some(0)), "{watched:?}");
    assert!(alone.trajectory == watched.trajectory, "viewers change nothing");
    drop(deaf);
}
