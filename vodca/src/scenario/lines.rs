//! Where in a scenario's file an entry begins.

use super::file::{obstacle_name, robot_name};
use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
struct Entries {
    #[serde(default)]
    robot: Vec<Spanned<Entry>>,
    #[serde(default)]
    obstacle: Vec<Spanned<Entry>>,
}

#[derive(Deserialize)]
struct Entry {
    name: Option<String>,
}

/// The line (from 1) of byte `at` of `text`.
pub(super) fn line_at(text: &str, at: usize) -> usize {
    text.bytes().take(at).filter(|byte| *byte == b'\n').count() + 1
}

/// The line at which the robot or obstacle called `name` begins; none where there is none.
pub(super) fn line_of(text: &str, name: &str) -> Option<usize> {
    let entries: Entries = toml::from_str(text).ok()?;
    let find = |list: &[Spanned<Entry>], default: fn(usize) -> String| {
        let called = |(index, entry): (usize, &Spanned<Entry>)| {
            let own = entry.get_ref().name.clone().unwrap_or_else(|| default(index));
            (own == name).then(|| line_at(text, entry.span().start))
        };
        list.iter().enumerate().find_map(called)
    };
    find(&entries.robot, robot_name).or_else(|| find(&entries.obstacle, obstacle_name))
}

/// `file` with the line of the entry called `name`, where there is one: as errors name places.
pub(super) fn place(file: &str, text: &str, name: Option<&str>) -> String {
    match name.and_then(|name| line_of(text, name)) {
        Some(line) => format!("{file}, line {line}"),
        None => file.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_found_by_the_names_that_they_have_or_would_have() {
        let text = "version = 1\n\n[[robot]]\nstart = [0, 0]\n\n[[robot]]\nname = \"left\"\n[[obstacle]]\nwall = []\n";
        assert_eq!(["robot-0", "left", "obstacle-0"].map(|name| line_of(text, name)), [Some(3), Some(6), Some(8)]);
        assert_eq!(line_of(text, "robot-1"), None);
        assert_eq!(place("a.toml", text, Some("left")), "a.toml, line 6");
        assert_eq!(place("a.toml", "no = [toml", Some("left")), "a.toml");
    }
}
