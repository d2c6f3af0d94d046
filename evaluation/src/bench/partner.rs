//! The other processes of a benchmark: this very program, started with a hidden command.

use super::hop::answer;
use super::links::{End, LinkKind, link};
use super::{BenchError, floor, still};
use shared::os;
use shared::runtime_dir::RuntimeDir;
use shared::services;
use shared::stop::StopFlag;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Name of the hidden command.
pub const COMMAND: &str = "bench-partner";

/// What a partner is to do.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: ./run.sh bench hop starts these processes by itself.")]
pub struct Args {
    /// The process to end with
    #[arg(long, global = true)]
    parent: Option<u32>,
    #[command(subcommand)]
    what: PartnerArgs,
}

/// The kinds of partners.
#[derive(Debug, clap::Subcommand)]
pub(super) enum PartnerArgs {
    /// The other end of a link
    Hop {
        #[arg(long)]
        link: LinkKind,
        #[arg(long)]
        prefix: String,
        #[arg(long)]
        root: String,
        #[arg(long, num_args = 2)]
        events: Vec<i32>,
    },
    /// A member of the team of the floor
    Floor {
        #[arg(long)]
        page: PathBuf,
        #[arg(long)]
        members: usize,
        #[arg(long)]
        member: usize,
    },
    /// A robot without a QP that stands still
    Still {
        #[arg(long)]
        run: PathBuf,
        #[arg(long)]
        robot: usize,
    },
}

/// Plays the partner.
pub fn run(args: Args) -> Result<(), BenchError> {
    services::settle_signal_handlers();
    if let Some(parent) = args.parent
        && !matches!(args.what, PartnerArgs::Still { .. })
        && !os::die_with_parent(parent)
    {
        return Err(BenchError::Silent { who: "the benchmark that started this process" });
    }
    match args.what {
        PartnerArgs::Hop { link: kind, prefix, root, events } => {
            let numbers = [events.first().copied().unwrap_or(-1), events.get(1).copied().unwrap_or(-1)];
            let (mut link, _) = link(kind, &RuntimeDir { prefix, root }, End::Second(numbers))?;
            answer(link.as_mut())
        }
        PartnerArgs::Floor { page, members, member } => floor::take_part(&page, members, member),
        PartnerArgs::Still { run, robot } => {
            let stop = StopFlag::install().map_err(|source| BenchError::System { what: "hear signals", source })?;
            Ok(still::drive(&run, robot, args.parent, &stop)?)
        }
    }
}

/// A partner's process; killed when dropped.
pub(super) struct Partner(Child);

impl Partner {
    /// Starts one.
    pub(super) fn start(what: PartnerArgs) -> Result<Self, BenchError> {
        let failed = |source| BenchError::System { what: "start a partner", source };
        let mut command = Command::new(std::env::current_exe().map_err(failed)?);
        command.args([COMMAND, "--parent", &std::process::id().to_string()]);
        command.args(what.words()).stdin(Stdio::null()).stdout(Stdio::null());
        Ok(Self(command.spawn().map_err(failed)?))
    }

    /// Waits for its end.
    pub(super) fn wait(mut self) -> Result<(), BenchError> {
        let start = Instant::now();
        while start.elapsed() < super::links::PATIENCE {
            match self.0.try_wait() {
                Ok(None) => std::thread::sleep(Duration::from_millis(1)),
                Ok(Some(status)) if status.success() => return Ok(()),
                _ => return Err(BenchError::Silent { who: "a partner, which failed" }),
            }
        }
        Err(BenchError::Silent { who: "a partner, which does not end" })
    }
}

impl Drop for Partner {
    fn drop(&mut self) {
        let _ = self.0.kill(); // has ended where all went well
        let _ = self.0.wait();
    }
}

impl PartnerArgs {
    /// The words of the command line that clap reads back.
    fn words(&self) -> Vec<String> {
        match self {
            Self::Hop { link, prefix, root, events } => {
                let name = clap::ValueEnum::to_possible_value(link).map(|value| value.get_name().to_owned());
                let mut words: Vec<String> = ["hop", "--link", &name.unwrap_or_default()].map(String::from).into();
                words.extend(["--prefix", prefix, "--root", root, "--events"].map(String::from));
                words.extend(events.iter().map(i32::to_string));
                words
            }
            Self::Floor { page, members, member } => {
                let (page, members, member) = (page.display().to_string(), members.to_string(), member.to_string());
                ["floor", "--page", &page, "--members", &members, "--member", &member].map(String::from).into()
            }
            Self::Still { run, robot } => {
                let (run, robot) = (run.display().to_string(), robot.to_string());
                ["still", "--run", &run, "--robot", &robot].map(String::from).into()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{FromArgMatches, Subcommand};

    #[test]
    fn a_partner_understands_the_words_it_is_started_with() {
        let all = [
            PartnerArgs::Hop { link: LinkKind::Eventfd, prefix: "p_".into(), root: "/r".into(), events: vec![5, 6] },
            PartnerArgs::Floor { page: "/dev/shm/x".into(), members: 3, member: 2 },
            PartnerArgs::Still { run: "/run".into(), robot: 7 },
        ];
        for what in all {
            let command = PartnerArgs::augment_subcommands(clap::Command::new("partner").no_binary_name(true));
            let matches = command.try_get_matches_from(what.words()).unwrap();
            let back = PartnerArgs::from_arg_matches(&matches).unwrap();
            assert_eq!(format!("{back:?}"), format!("{what:?}"));
        }
    }
}
