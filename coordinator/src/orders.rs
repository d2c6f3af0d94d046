//! Orders that reach a run from outside, as files in the folder `orders` of its own folder.
//!
//! Who orders writes `NAME.order` beside and renames it into place; the run answers with `NAME.answer` at the start of
//! its next tick. Nothing is listened to, so nothing needs a port, and whoever may write into the folder may order.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};
use vodca::Position;

/// Name of the folder in a run folder; it is there only while orders are.
const FOLDER: &str = "orders";
/// How often who has ordered looks for the answer.
const LOOK_AROUND: Duration = Duration::from_millis(10);

/// A robot shall go somewhere else at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// Which robot, 0-based.
    pub robot: usize,
    /// Where it shall go, m.
    pub set_point: Position,
}

/// Why an order was not followed.
#[derive(Debug, thiserror::Error)]
pub enum OrderError {
    /// It cannot be written down, or the answer not be read.
    #[error("cannot use {}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The run says no.
    #[error("{0}")]
    Refused(String),
    /// The run says nothing.
    #[error(
        "{} gave no answer within {seconds:.0} s: no tick has begun; look whether it still runs (`--tasks orders` keeps a run \
         going when everybody has arrived)",
        run.display()
    )]
    Silent {
        /// The folder of the run.
        run: PathBuf,
        /// How long it was waited for.
        seconds: f64,
    },
}

impl Order {
    fn text(&self) -> String {
        format!("{} {} {}\n", self.robot, self.set_point.x, self.set_point.y)
    }

    fn parse(text: &str, robots: usize) -> Result<Self, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let order = match words[..] {
            [robot, x, y] => robot.parse().ok().zip(x.parse().ok().zip(y.parse().ok())),
            _ => None,
        };
        let Some((robot, (x, y))) = order else {
            return Err(format!("{text:?} is no order; write ROBOT X Y, a number and two coordinates in m"));
        };
        if robot >= robots {
            return Err(format!("there is no robot {robot}; name one of 0..={}", robots - 1));
        }
        Ok(Self { robot, set_point: Position::new(x, y) })
    }

    /// Sends the order to the run in the folder `run` and waits for its answer: the first tick that is planned with it.
    ///
    /// # Errors
    /// The run refuses it, or gives no answer within `patience`.
    pub fn send(&self, run: &Path, patience: Duration) -> Result<u64, OrderError> {
        let folder = run.join(FOLDER);
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |source| OrderError::File { path, source }
        };
        fs::create_dir_all(&folder).map_err(failed(&folder))?;
        let since = SystemTime::UNIX_EPOCH.elapsed().unwrap_or_default().as_nanos();
        let name = folder.join(format!("{since}-{}", std::process::id()));
        let [beside, order, answer] = ["new", "order", "answer"].map(|end| name.with_extension(end));
        fs::write(&beside, self.text()).map_err(failed(&beside))?;
        fs::rename(&beside, &order).map_err(failed(&order))?;
        let start = Instant::now();
        let answered = loop {
            match fs::read_to_string(&answer) {
                Ok(text) => break Some(text),
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(failed(&answer)(error)),
                Err(_) if start.elapsed() > patience => break None,
                Err(_) => std::thread::sleep(LOOK_AROUND),
            }
        };
        // Whatever came of it, nothing of it stays.
        [&order, &answer].into_iter().for_each(|path| drop(fs::remove_file(path)));
        let _ = fs::remove_dir(&folder); // another order may be in it
        let silent = || OrderError::Silent { run: run.to_owned(), seconds: patience.as_secs_f64() };
        let text = answered.ok_or_else(silent)?;
        text.trim().parse().map_err(|_| OrderError::Refused(text.trim().to_owned()))
    }
}

/// The run's side.
#[derive(Debug)]
pub(crate) struct Inbox {
    folder: PathBuf,
}

impl Inbox {
    /// Of the run in the folder `run`.
    pub(crate) fn of(run: &Path) -> Self {
        Self { folder: run.join(FOLDER) }
    }

    /// Answers every order that lies there, oldest first: `follow` gives the tick from which it holds, or why it does not.
    /// An order that cannot be read or answered is left to its sender, who gives up waiting.
    pub(crate) fn answer_all(&self, robots: usize, mut follow: impl FnMut(Order) -> Result<u64, String>) {
        let Ok(entries) = fs::read_dir(&self.folder) else { return };
        let mut orders: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        orders.retain(|path| path.extension().is_some_and(|end| end == "order"));
        orders.sort_unstable();
        for path in orders {
            let Ok(text) = fs::read_to_string(&path) else { continue };
            if fs::remove_file(&path).is_err() {
                continue; // it would be followed in every tick
            }
            let answer =
                Order::parse(&text, robots).and_then(&mut follow).map_or_else(|why| why, |tick| tick.to_string());
            let beside = path.with_extension("new");
            let _ = fs::write(&beside, answer).and_then(|()| fs::rename(&beside, path.with_extension("answer")));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_is_answered_once_and_leaves_nothing() {
        let run = tempfile::tempdir().unwrap();
        let order = Order { robot: 3, set_point: Position::new(-1.5, 0.1 + 0.2) };
        let inbox = Inbox::of(run.path());
        inbox.answer_all(4, |_| panic!("nothing was ordered"));
        for (follows, expected) in [(Ok(41), "Ok(41)"), (Err("no way leads there".to_string()), "no way leads there")] {
            let answered = std::thread::scope(|scope| {
                let sender = scope.spawn(|| order.send(run.path(), Duration::from_secs(60)));
                let mut seen = Vec::new();
                while seen.is_empty() {
                    inbox.answer_all(4, |order| {
                        seen.push(order);
                        follows.clone()
                    });
                }
                assert_eq!(seen, [order]);
                sender.join().unwrap()
            });
            assert!(format!("{answered:?}").contains(expected), "{answered:?}");
            assert!(!run.path().join(FOLDER).exists());
        }
    }

    #[test]
    fn without_an_answer_the_sender_gives_up_and_takes_its_order_back() {
        let run = tempfile::tempdir().unwrap();
        let order = Order { robot: 0, set_point: Position::new(0.0, 0.0) };
        let message = order.send(run.path(), Duration::ZERO).unwrap_err().to_string();
        assert!(message.contains("no answer") && message.contains("--tasks orders"), "{message}");
        assert!(!run.path().join(FOLDER).exists());
    }

    #[test]
    fn what_is_no_order_is_refused_with_what_one_looks_like() {
        for (text, expected) in [("3 1", "ROBOT X Y"), ("x 1 2", "ROBOT X Y"), ("4 1 2", "0..=3"), ("", "ROBOT X Y")] {
            let message = Order::parse(text, 4).unwrap_err();
            assert!(message.contains(expected), "{text:?}: {message}");
        }
        assert_eq!(Order::parse("1 2.5 -3", 4), Ok(Order { robot: 1, set_point: Position::new(2.5, -3.0) }));
    }
}
