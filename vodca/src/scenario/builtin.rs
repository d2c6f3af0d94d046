//! The built-in scenarios: the files of `scenarios/`, embedded so that a binary works from any folder.

/// Names and texts, in the order of the list below.
macro_rules! embed {
    ($($name:literal,)*) => {
        /// Name and text of every built-in scenario.
        pub(super) const BUILTIN: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../../scenarios/", $name, ".toml")))),*];
    };
}

// A test compares this list with the folder.
#[rustfmt::skip]
embed![
    "two_setpoint",
    "ex14_a",
    "ex14_b",
    "ex14_c",
    "ex14_d",
    "ex14_e",
    "ex14_f",
    "ex14_g",
    "four_gate",
    "four_wall",
    "four_cross",
    "four_corners",
    "antipodal4",
    "antipodal8",
    "antipodal16",
    "antipodal32",
    "antipodal64",
    "antipodal100",
    "rand8o0_s0",
    "rand8o0_s1",
    "rand8o0_s2",
    "rand8o0_s3",
    "rand8o0_s4",
    "rand8o0_s5",
    "rand8o0_s6",
    "rand8o0_s7",
    "rand8o0_s8",
    "rand8o0_s9",
    "rand16o0_s0",
    "rand16o0_s1",
    "rand16o0_s2",
    "rand16o0_s3",
    "rand16o0_s4",
    "rand16o0_s5",
    "rand16o0_s6",
    "rand16o0_s7",
    "rand16o0_s8",
    "rand16o0_s9",
    "rand32o0_s0",
    "rand32o0_s1",
    "rand32o0_s2",
    "rand32o0_s3",
    "rand32o0_s4",
    "rand32o0_s5",
    "rand32o0_s6",
    "rand32o0_s7",
    "rand32o0_s8",
    "rand32o0_s9",
    "rand48o0_s0",
    "rand48o0_s1",
    "rand48o0_s2",
    "rand48o0_s3",
    "rand48o0_s4",
    "rand48o0_s5",
    "rand48o0_s6",
    "rand48o0_s7",
    "rand48o0_s8",
    "rand48o0_s9",
    "rand8o3_s0",
    "rand8o3_s1",
    "rand8o3_s2",
    "rand8o3_s3",
    "rand8o3_s4",
    "rand8o3_s5",
    "rand8o3_s6",
    "rand8o3_s7",
    "rand8o3_s8",
    "rand8o3_s9",
    "rand16o3_s0",
    "rand16o3_s1",
    "rand16o3_s2",
    "rand16o3_s3",
    "rand16o3_s4",
    "rand16o3_s5",
    "rand16o3_s6",
    "rand16o3_s7",
    "rand16o3_s8",
    "rand16o3_s9",
    "segregate3x4_s0",
    "segregate3x4_s1",
    "segregate3x4_s2",
    "segregate3x4_s3",
    "segregate3x4_s4",
    "segregate4x4_s0",
    "segregate4x4_s1",
    "segregate4x4_s2",
    "segregate4x4_s3",
    "segregate4x4_s4",
];

/// The text of the built-in scenario `name`.
pub(super) fn text(name: &str) -> Option<&'static str> {
    BUILTIN.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// The names of all built-in scenarios.
pub fn names() -> impl Iterator<Item = &'static str> {
    BUILTIN.iter().map(|(name, _)| *name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Position;
    use crate::scenario::Scenario;

    #[test]
    fn the_list_holds_every_file_of_the_folder() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios");
        let mut files: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
            .map(|path| path.file_stem().unwrap().to_str().unwrap().to_string())
            .collect();
        let mut names: Vec<&str> = names().collect();
        files.sort();
        names.sort();
        assert_eq!(files, names, "add the new file to the list in builtin.rs");
        assert!(names.len() >= 88);
    }

    #[test]
    fn every_built_in_scenario_is_valid_at_the_papers_separation() {
        for (name, _) in BUILTIN {
            let scenario = Scenario::resolve(Some(name), None).unwrap();
            assert_eq!(scenario.name, *name);
            scenario.validate_distances(1.5).unwrap();
        }
    }

    #[test]
    fn the_numbers_are_the_published_ones() {
        let ex14_d = Scenario::resolve(Some("ex14_d"), None).unwrap();
        assert_eq!((ex14_d.robots.len(), ex14_d.obstacles.len(), ex14_d.max_ticks), (14, 3, 350));
        assert_eq!(ex14_d.robots[7].start, Position::new(22.5, 3.5));
        assert_eq!(ex14_d.robots[7].set_point, Position::new(2.5, 21.5));
        assert_eq!(ex14_d.obstacles[1].position, Position::new(12.9, 12.1));
        let straight: f64 = ex14_d.robots.iter().map(|robot| (robot.start - robot.set_point).norm()).sum();
        assert!((straight - 324.4).abs() < 0.05, "{straight}");

        let rand8o3 = Scenario::resolve(Some("rand8o3_s0"), None).unwrap();
        assert_eq!(rand8o3.robots[0].start, Position::new(14.845987067, 17.548924342));
        assert_eq!(rand8o3.robots[7].set_point, Position::new(10.115618012, 21.086035744));
        assert_eq!(rand8o3.obstacles[2].position, Position::new(19.391945262, 21.5806227));
    }
}
