//! Reference closed loops through real processes: the same bytes as in one process, which
//! `agent/tests/golden.rs` holds against the reference.

use crate::same_bytes::trajectory;
use evaluation::golden::closed_loop::Case;
use std::fs;
use std::path::Path;
use tests::{Robots, Run};
use vodca::team::Team;

fn case(file: &str, name: &str) -> Case {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden").join(file);
    let text = fs::read_to_string(path).expect("the golden file is there");
    let document: serde_json::Value = serde_json::from_str(&text).expect("it is JSON");
    let cases: Vec<Case> = serde_json::from_value(document["cases"].clone()).expect("it holds closed loops");
    cases.into_iter().find(|case| case.name == name).expect("the case is there")
}

#[test]
fn reference_loops_come_out_of_processes_byte_for_byte() {
    for (file, name) in [
        ("closed_loop.json", "two_sym_FH30"),
        ("closed_loop.json", "circle4_var1_each"),
        ("closed_loop.json", "ex14f_var1_each"),
        ("closed_loop.json", "relax_segregate_var1"),
        ("closed_loop.json", "robust_box8_2_var"),
        ("safe_closed_loop.json", "ring16_exact_FH30"),
        ("safe_closed_loop.json", "ex14_d_jit_FH20"),
        ("safe_closed_loop.json", "close_start"),
    ] {
        let case = case(file, name);
        let params = case.params().expect("supported switches");
        let mut scenario = case.scenario();
        scenario.params = toml::Table::try_from(&params).expect("parameters have a TOML form");
        let home = tempfile::tempdir().expect("a folder for the test");
        let (layout, script) = (home.path().join("layout.toml"), home.path().join("horizons.csv"));
        fs::write(&layout, scenario.to_toml().expect("a scenario has a TOML form")).expect("the scenario is written");
        let line = |(tick, horizons): (usize, &Vec<vodca::horizon::Horizon>)| {
            let horizons: Vec<String> = horizons.iter().map(ToString::to_string).collect();
            format!("{tick},{}\n", horizons.join(","))
        };
        fs::write(&script, case.horizons.iter().enumerate().map(line).collect::<String>()).expect("a script");
        for exchange in ["peer", "relay"] {
            let run = format!(
                "--scenario {} --horizon script:{} --profile paper --exchange {exchange}",
                layout.display(),
                script.display()
            );
            let finished = Run::start(Robots::Real, &run).finish();
            let ticks = finished.summary["ticks"].as_u64().unwrap_or_else(|| panic!("{name}: {finished:?}"));
            assert!(ticks > 10, "{name} {exchange} ran {ticks} ticks only");
            let expected =
                trajectory(Team::new(&scenario, &params, 0), ticks, |robot, tick| case.horizons[tick as usize][robot]);
            assert!(finished.trajectory == expected, "{name} {exchange} differs from one process");
        }
    }
}
