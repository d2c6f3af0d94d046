//! What is compared on: names, suites and series of generated scenarios.

use crate::range::Numbers;
use vodca::scenario::suite::{self, UnknownSuite};

/// One scenario of a comparison.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// What [`vodca::scenario::set_up`] finds it by.
    pub spec: String,
    /// Its row in the table.
    pub family: String,
    /// Whether it is one draw of many: it then runs once, with its own seed.
    pub drawn: bool,
}

/// Not a set of scenarios.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EntryError {
    /// Not a suite.
    #[error(transparent)]
    Suite(#[from] UnknownSuite),
    /// Not a number of random boxes.
    #[error("`{0}`: write random-boxes:COUNT with COUNT in 1..={MOST}, for example random-boxes:10000")]
    RandomBoxes(String),
}

const MOST: u64 = 1_000_000;
const RANDOM_BOXES: &str = "random-boxes";

/// The scenarios that `spec` stands for: a suite's, `COUNT` random boxes, one per seed of a range
/// (`box:16:3:0..9`), otherwise itself.
pub fn expand(spec: &str) -> Result<Vec<Entry>, EntryError> {
    if let Some(count) = spec.strip_prefix(RANDOM_BOXES) {
        let count =
            count.strip_prefix(':').and_then(|count| count.parse().ok()).filter(|count| (1..=MOST).contains(count));
        return Ok((0..count.ok_or_else(|| EntryError::RandomBoxes(spec.into()))?).map(random_box).collect());
    }
    if let Some((family, Numbers(seeds))) = series(spec) {
        let of = |seed| Entry { spec: format!("{family}:{seed}"), family: family.into(), drawn: false };
        return Ok(seeds.into_iter().map(of).collect());
    }
    let names = suite::expand(spec)?;
    Ok(names.into_iter().map(|name| Entry { family: family(&name).into(), spec: name, drawn: false }).collect())
}

/// Of a built-in scenario [`suite::family`]; a file belongs to the others of its folder that differ by a number at the
/// end only: `mine_1.toml` and `mine_s2.toml` are of `mine`.
fn family(spec: &str) -> &str {
    let Some(stem) = spec.strip_suffix(".toml") else { return suite::family(spec) };
    let unnumbered = stem.trim_end_matches(|c: char| c.is_ascii_digit());
    let Some(name) = unnumbered.strip_suffix(['_', '-']).or_else(|| unnumbered.strip_suffix("_s")) else { return stem };
    if unnumbered.len() == stem.len() || name.is_empty() || name.ends_with('/') { stem } else { name }
}

/// `FORM:ARGUMENTS` and the range at its end, when there is one.
fn series(spec: &str) -> Option<(&str, Numbers)> {
    let (family, range) = spec.rsplit_once(':').filter(|(_, range)| range.contains("..") && !spec.contains('/'))?;
    Some((family, range.parse().ok()?))
}

/// 8 to 32 robots and 0 to 3 obstacles, every combination equally often, no layout twice.
fn random_box(index: u64) -> Entry {
    let (robots, obstacles) = (8 + index % 25, index / 25 % 4);
    Entry { spec: format!("box:{robots}:{obstacles}:{index}"), family: RANDOM_BOXES.into(), drawn: true }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn specs(spec: &str) -> Vec<String> {
        expand(spec).unwrap().into_iter().map(|entry| entry.spec).collect()
    }

    #[test]
    fn names_suites_and_ranges_of_seeds_are_expanded() {
        assert_eq!(specs("ex14_d"), ["ex14_d"]);
        assert_eq!(specs("box:16:3:0..2"), ["box:16:3:0", "box:16:3:1", "box:16:3:2"]);
        assert_eq!(specs("../a.toml"), ["../a.toml"]);
        assert_eq!(specs("suite:all").len(), 88);
        assert_eq!(expand("box:16:3:0..2").unwrap()[2].family, "box:16:3");
        assert_eq!(expand("rand8o3_s4").unwrap()[0].family, "rand8o3");
    }

    #[test]
    fn random_boxes_hold_every_size_and_their_own_seeds() {
        let boxes = specs("random-boxes:200");
        assert_eq!(
            (boxes[0].as_str(), boxes[24].as_str(), boxes[199].as_str()),
            ("box:8:0:0", "box:32:0:24", "box:32:3:199")
        );
        assert!(expand("random-boxes:3").unwrap().iter().all(|entry| entry.drawn && entry.family == "random-boxes"));
    }

    #[test]
    fn files_that_differ_by_a_number_are_one_family() {
        let families = [
            ("mine_1.toml", "mine"),
            ("mine_s20.toml", "mine"),
            ("mine-07.toml", "mine"),
            ("rooms/mine_1.toml", "rooms/mine"),
            ("mine.toml", "mine"),
            ("mine16.toml", "mine16"),
            ("mine_wide.toml", "mine_wide"),
            ("mine_.toml", "mine_"),
            ("rooms/_1.toml", "rooms/_1"),
            ("2.toml", "2"),
        ];
        for (file, family) in families {
            assert_eq!(expand(file).unwrap()[0].family, family, "{file}");
        }
    }

    #[test]
    fn what_stands_for_nothing_is_refused() {
        for spec in ["random-boxes", "random-boxes:0", "random-boxes:many"] {
            assert!(expand(spec).unwrap_err().to_string().contains("random-boxes:10000"), "{spec}");
        }
        assert!(expand("suite:best").unwrap_err().to_string().contains("suite:all"));
    }
}
