//! A list of tasks as a file: a line per drive, `robot,x,y,after`.

use crate::Position;
use crate::scenario::{Scenario, ScenarioError};
use crate::tasks::Task;

/// First line of a list.
pub const HEADER: &str = "robot,x,y,after";

/// Why a text is no list of tasks for a team.
#[derive(Debug, thiserror::Error)]
pub enum TaskListError {
    /// The first line is not the header.
    #[error("line 1 is `{line}`; a list of tasks begins with `{HEADER}`")]
    Header {
        /// What is there.
        line: String,
    },
    /// A line that is no task.
    #[error(
        "line {line} is `{text}`; write robot,x,y,after: a robot in 0..={last}, its next set-point in m, and the first tick \
         at which it may set out"
    )]
    Line {
        /// Which, from 1.
        line: usize,
        /// What is there.
        text: String,
        /// The last robot of the team.
        last: usize,
    },
    /// A set-point that its robot can never have.
    #[error("line {line}: {source}")]
    SetPoint {
        /// Which, from 1.
        line: usize,
        /// Why not.
        source: Box<ScenarioError>,
    },
}

/// Reads a list for the team of `scenario`, whose discs keep `min_separation` (m). Every set-point is one that its robot can
/// reach where it is alone; empty lines do not count.
///
/// # Errors
/// The first line that is not what it should be.
pub fn parse(text: &str, scenario: &Scenario, min_separation: f64) -> Result<Vec<Task>, TaskListError> {
    let mut lines = text.lines().enumerate();
    let first = lines.next().map_or("", |(_, line)| line.trim());
    if first != HEADER {
        return Err(TaskListError::Header { line: first.into() });
    }
    let last = scenario.robots.len() - 1;
    let mut tasks = Vec::new();
    for (at, text) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let line = at + 1;
        let task = task(text).filter(|task| task.robot <= last);
        let task = task.ok_or_else(|| TaskListError::Line { line, text: text.into(), last })?;
        scenario
            .alone(&[(task.robot, task.set_point)])
            .check(min_separation)
            .map_err(|source| TaskListError::SetPoint { line, source: Box::new(source) })?;
        tasks.push(task);
    }
    Ok(tasks)
}

fn task(line: &str) -> Option<Task> {
    let fields: Vec<&str> = line.split(',').map(str::trim).collect();
    let [robot, x, y, after] = fields[..] else { return None };
    let set_point = Position::new(x.parse().ok()?, y.parse().ok()?);
    Some(Task { robot: robot.parse().ok()?, set_point, after: after.parse().ok()? })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<Task>, TaskListError> {
        parse(text, &Scenario::resolve(Some("ex14_d"), None).unwrap(), 1.5)
    }

    #[test]
    fn a_list_is_read_line_by_line() {
        let tasks = read("robot,x,y,after\n3, 1.5,-20,0\n\n0,2,20,40\r\n").unwrap();
        let task = |robot, x, y, after| Task { robot, set_point: Position::new(x, y), after };
        assert_eq!(tasks, [task(3, 1.5, -20.0, 0), task(0, 2.0, 20.0, 40)]);
        assert_eq!(read("robot,x,y,after").unwrap(), []);
    }

    #[test]
    fn what_is_no_task_is_refused_with_its_line_and_what_is_allowed() {
        let obstacle = Scenario::resolve(Some("ex14_d"), None).unwrap().obstacles[0].position;
        for (text, expected) in [
            (String::new(), "line 1 is ``"),
            ("3,1,1,0".into(), "begins with `robot,x,y,after`"),
            ("robot,x,y,after\n14,1,1,0".into(), "line 2 is `14,1,1,0`; write robot,x,y,after: a robot in 0..=13"),
            ("robot,x,y,after\n3,1,1".into(), "line 2"),
            ("robot,x,y,after\n\n3,1,1,-1".into(), "line 3"),
            ("robot,x,y,after\n3,nan,1,0".into(), "line 2: "),
            (format!("robot,x,y,after\n3,{},{},0", obstacle.x, obstacle.y), "nearer than the 1.5000 m"),
        ] {
            let message = read(&text).unwrap_err().to_string();
            assert!(message.contains(expected), "{text:?}: {message}");
        }
    }
}
