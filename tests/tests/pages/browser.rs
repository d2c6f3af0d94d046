//! Report, comparison and live page in a headless Chromium: played, scrubbed, clicked, without an error on
//! the console, at 1280 and 420 pixels.

use crate::{coordinator, own, success};
use std::path::Path;
use std::process::Command;
use tests::{Robots, Run, wait_until};

/// Uses `page` as a reader of a `kind` would; `false`: there is no browser to do so.
fn check(kind: &str, page: &str) -> bool {
    let browsers = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
    let node = Command::new("node").arg("--version").output().is_ok();
    if !node || !browsers.iter().any(|path| Path::new(path).exists()) {
        eprintln!("skipped: apt-get install chromium nodejs");
        return false;
    }
    let output = Command::new("node").arg(own("browser/check.mjs")).args([kind, page]).output().expect("node starts");
    println!("{}", success(output));
    true
}

#[test]
fn a_report_plays_scrubs_and_follows() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let folder = run.to_str().unwrap();
    let said = success(coordinator(&["run", "14", "--max-ticks", "350", "--report", "--out", folder]));
    let page = run.join("report.html");
    assert!(said.contains(page.to_str().unwrap()), "{said}");
    check("report", page.to_str().unwrap());
}

/// Holes of a map's walls are rings within a ring: none is joined to the one before.
#[test]
fn every_ring_of_a_shape_is_drawn_by_itself() {
    let drawn = "
        const said = [], say = word => (...at) => { said.push(word + at.join()); };
        const pen = { beginPath() {}, moveTo: say('M'), lineTo: say('L'), closePath: say('Z') };
        const scene = { pen, toX: x => x, toY: y => y, hatch: say('hatch ') };
        const rings = [[[0, 0], [9, 0], [9, 9]], [[1, 1], [2, 2], [2, 1]]];
        Scene.prototype.drawShape.call(scene, { rings, radius: 0 });
        console.log(said.join(' '));";
    let script = format!("{}\n{drawn}", coordinator::page::SCENE_SCRIPTS.join("\n"));
    let Ok(output) = Command::new("node").args(["-e", &script]).output() else {
        return eprintln!("skipped: apt-get install nodejs");
    };
    assert_eq!(success(output).trim(), "M0,0 L9,0 L9,9 Z M1,1 L2,2 L2,1 Z hatch evenodd");
}

#[test]
fn the_largest_usual_run_stays_below_a_megabyte() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let folder = run.to_str().unwrap();
    let hopeless = ["run", "--scenario", "ex14_a", "--profile", "paper", "--horizon", "fixed:49", "--out", folder];
    let ended = coordinator(&hopeless);
    assert_eq!(ended.status.code(), Some(1), "350 ticks without arriving: {ended:?}");
    assert!(String::from_utf8_lossy(&ended.stdout).contains(&format!("./run.sh report {folder}")), "{ended:?}");
    success(coordinator(&["report", folder]));
    let size = std::fs::metadata(run.join("report.html")).unwrap().len();
    assert!(size < 1_000_000, "{size} bytes");
}

#[test]
fn runs_side_by_side_and_a_run_that_was_killed_are_shown() {
    let place = tempfile::tempdir().unwrap();
    let folder = |name: &str| place.path().join(name).to_str().unwrap().to_string();
    success(coordinator(&["run", "2", "--out", &folder("two")]));
    success(coordinator(&["run", "4", "--out", &folder("four")]));
    // As a kill leaves it: no summary, half a line.
    std::fs::remove_file(place.path().join("two/summary.json")).unwrap();
    let trajectory = place.path().join("two/trajectory.csv");
    let text = std::fs::read_to_string(&trajectory).unwrap();
    std::fs::write(&trajectory, &text[..text.len() * 4 / 5]).unwrap();
    let page = folder("both.html");
    success(coordinator(&["report", &folder("two"), &folder("four"), "--out", &page]));
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("two_setpoint") && html.contains("four_gate"));
}

#[test]
fn a_comparison_has_its_bars_and_its_table() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("compared");
    let folder = out.to_str().unwrap();
    success(coordinator(&[
        "compare",
        "two_setpoint",
        "--controllers",
        "paper:fixed:5",
        "paper:fixed:20",
        "paper:random",
        "--seeds",
        "3",
        "--set",
        "vodca.infeasible=hold",
        "--out",
        folder,
    ]));
    check("compare", out.join("report.html").to_str().unwrap());
}

#[test]
fn files_of_a_family_share_a_section_and_unfold() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("compared");
    let mut arguments = vec!["compare".to_string()];
    for family in ["ours", "theirs", "gate", "cross"] {
        for number in 1..=2 {
            let file = place.path().join(format!("{family}_{number}.toml"));
            std::fs::copy(own("../scenarios/two_setpoint.toml"), &file).unwrap();
            arguments.push(file.display().to_string());
        }
    }
    let rest = ["--controllers", "paper:fixed:20", "orca-best", "--seeds", "1", "--max-ticks", "90", "--out"];
    arguments.extend(rest.map(String::from));
    arguments.push(out.display().to_string());
    success(coordinator(&arguments.iter().map(String::as_str).collect::<Vec<_>>()));
    let summary = std::fs::read_to_string(out.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["rows"].as_array().unwrap().len(), 4 * 2, "a row per family and controller");
    check("compare", out.join("report.html").to_str().unwrap());
}

#[test]
fn a_run_is_shown_while_it_goes_on() {
    let mut run = Run::start(Robots::Real, "14 --real-time --live --set model.max_speed=0.3 --max-ticks 120");
    run.wait_until_driving();
    let mut address = String::new();
    wait_until("the address is printed", || {
        let printed = run.printed();
        let line = printed.lines().find(|line| line.starts_with("live view"));
        address = line.and_then(|line| line.split_whitespace().last()).unwrap_or_default().to_string();
        !address.is_empty()
    });
    assert!(address.starts_with("http://127.0.0.1:"), "{address}");
    check("live", &address);
    assert_eq!(run.finish().status.code(), Some(1), "120 slow ticks are too few to arrive");
}
