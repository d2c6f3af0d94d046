//! The team in the terminal. The only file that imports `ratatui`.

use super::ViewError;
use super::frame::{Frame, News, Slot};
use ratatui::crossterm::cursor::{Hide, Show};
use ratatui::crossterm::execute;
use ratatui::crossterm::terminal::{EnterAlternateScreen, LeaveAlternateScreen};
use ratatui::layout::{Constraint, Layout};
use ratatui::prelude::{CrosstermBackend, Terminal};
use ratatui::style::Stylize;
use ratatui::text::{Line, Text};
use ratatui::widgets::{Paragraph, Row, Table};
use std::io;
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Duration;
use vodca::params::Params;
use vodca::scenario::Scenario;

/// Draws frames in a thread of its own; gives the terminal back when dropped, after the run's end.
pub(super) struct TerminalView {
    thread: Option<JoinHandle<()>>,
}

/// What does not change.
struct Shown {
    scenario: String,
    horizons: String,
    set_points: Vec<vodca::Position>,
    min_separation: f64,
    max_ticks: u64,
}

impl TerminalView {
    /// Takes the terminal. Keys are left to it, so that Ctrl-C still ends the run.
    pub(super) fn open(
        slot: Arc<Slot>,
        scenario: &Scenario,
        params: &Params,
        horizons: &str,
    ) -> Result<Self, ViewError> {
        execute!(io::stdout(), EnterAlternateScreen, Hide).map_err(ViewError::Terminal)?;
        let mut terminal = Terminal::new(CrosstermBackend::new(io::stdout())).map_err(|error| {
            give_back();
            ViewError::Terminal(error)
        })?;
        let shown = Shown::new(scenario, params, horizons);
        let thread = thread::spawn(move || {
            let mut seen = 0;
            loop {
                match slot.wait(seen, Duration::from_secs(1)) {
                    News::Frame(frame, number) => {
                        seen = number;
                        if terminal.draw(|area| draw(area, &frame, &shown)).is_err() {
                            return; // the terminal is gone; the run is not
                        }
                    }
                    News::Nothing => {}
                    News::Ended => return,
                }
            }
        });
        Ok(Self { thread: Some(thread) })
    }
}

impl Drop for TerminalView {
    fn drop(&mut self) {
        if let Some(thread) = self.thread.take() {
            let _ = thread.join(); // a panic in it has been reported on standard error
        }
        give_back();
    }
}

fn give_back() {
    let _ = execute!(io::stdout(), Show, LeaveAlternateScreen); // nothing else can be done
}

impl Shown {
    fn new(scenario: &Scenario, params: &Params, horizons: &str) -> Self {
        Self {
            scenario: scenario.name.clone(),
            horizons: horizons.into(),
            set_points: scenario.robots.iter().map(|robot| robot.set_point).collect(),
            min_separation: params.model.min_separation,
            max_ticks: scenario.max_ticks,
        }
    }
}

fn draw(area: &mut ratatui::Frame<'_>, frame: &Frame, shown: &Shown) {
    let heading = heading(frame, shown);
    let [head, body] =
        Layout::vertical([Constraint::Length(heading.height() as u16), Constraint::Min(1)]).areas(area.area());
    area.render_widget(Paragraph::new(heading), head);
    let header = Row::new(["robot", "distance m", "horizon", "rows", "QP us", "level", "status"]).bold();
    let rows = frame.explainer.steps().iter().zip(&shown.set_points).enumerate().map(|(robot, (step, set_point))| {
        Row::new([
            robot.to_string(),
            format!("{:.2}", (set_point - step.next_position).norm()),
            step.horizon.to_string(),
            step.rows.to_string(),
            format!("{:.1}", step.solve_ns as f64 / 1e3),
            step.level.word().into(),
            step.status.word().into(),
        ])
    });
    let widths = [5, 10, 7, 4, 9, 11, 8].map(Constraint::Length);
    area.render_widget(Table::new(rows, widths).header(header).column_spacing(2), body);
}

fn heading<'a>(frame: &Frame, shown: &Shown) -> Text<'a> {
    let nearest = match frame.min_separation.is_finite() {
        true => format!("{:.3} m (r_min {} m)", frame.min_separation, shown.min_separation),
        false => "-".into(),
    };
    let Shown { scenario, horizons, max_ticks, .. } = shown;
    let (tick, arrived, robots) = (frame.tick + 1, frame.arrived, frame.explainer.steps().len());
    let milliseconds = frame.duration.as_secs_f64() * 1e3;
    let fallbacks = frame.fallbacks;
    let mut lines = vec![
        Line::from(format!("{scenario}  horizons {horizons}")).bold(),
        Line::from(format!("tick {tick} of {max_ticks}  arrived {arrived}/{robots}  tick time {milliseconds:.2} ms")),
        Line::from(format!("min separation {nearest}  fallbacks {fallbacks}")),
    ];
    lines.extend(frame.absent.iter().take(3).map(|absent| Line::from(absent.clone()).bold()));
    lines.extend(frame.acting.map(|acting| Line::from(format!("policy {acting}"))));
    Text::from(lines)
}

#[cfg(test)]
mod tests {
    use super::super::frame::tests::sample;
    use super::*;
    use crate::record::samples;
    use ratatui::backend::TestBackend;

    #[test]
    fn a_frame_shows_the_team_as_text() {
        let shown = Shown::new(&samples::scenario(2), &Params::safe(), "fixed:3");
        let mut terminal = Terminal::new(TestBackend::new(68, 8)).unwrap();
        terminal.draw(|area| draw(area, &sample(4), &shown)).unwrap();
        let cells: Vec<&str> = terminal.backend().buffer().content.iter().map(|cell| cell.symbol()).collect();
        let lines: Vec<String> = cells.chunks(68).map(|line| line.concat().trim_end().to_string()).collect();
        assert_eq!(
            lines,
            [
                "sample  horizons fixed:3",
                "tick 5 of 100  arrived 1/2  tick time 0.42 ms",
                "min separation 1.750 m (r_min 1.5 m)  fallbacks 3",
                "robot-1 lost at tick 3: it was ended by signal 9",
                "policy v000002 (sha256 abababababab)",
                "robot  distance m  horizon  rows  QP us      level        status",
                "0      3.51        3        0     0.4        closed_form  solved",
                "1      3.51        3        0     0.4        closed_form  solved",
            ]
        );
    }
}
