//! `policy serve`: answers the coordinator's observations until the run ends.

use crate::actor::{BackEnd, Runtime};
use crate::check::{Limits, Prober, look, try_out};
use crate::hot_swap::{Chosen, HotSwap, Loaded};
use crate::loader::{Loader, Watched, import};
use crate::sample::Choice;
use anyhow::{Context, bail};
use policy::encoding::sha256_bytes;
use policy::folder::{PolicyFolder, Version, resolve};
use policy::run_folder;
use policy::settings::PolicySettings;
use shared::messages::{Observation, PolicyAnswer, answer};
use shared::os;
use shared::services::PolicyPort;
use shared::stop::StopFlag;
use shared::team::{FIRST_EPOCH, Setup, TeamFile};
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::Duration;
use tracing::info;
use vodca::Position;
use vodca::random;

/// How often an idle server looks whether the run still is there.
const LOOK_AROUND: Duration = Duration::from_millis(100);

/// Arguments of `serve`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example, after the server of a running team has died:\n  \
    ./run.sh policy serve --run runs/20260131-120000-ex14_d-14\n\
    The run's policy.toml says the rest.")]
pub struct ServeArgs {
    /// Folder of the run
    #[arg(long, value_name = "DIR")]
    run: PathBuf,
    /// Process to end with (the coordinator gives its own)
    #[arg(long, value_name = "PID", hide = true)]
    parent: Option<u32>,
}

/// Serves the run.
pub fn run(args: &ServeArgs) -> anyhow::Result<()> {
    let stop = StopFlag::install()?;
    if let Some(parent) = args.parent
        && !os::die_with_parent(parent)
    {
        bail!("process {parent}, which started this server, has ended");
    }
    let team = Setup::load(&args.run)?.team;
    let settings = PolicySettings::read(&args.run)?;
    let folder = PolicyFolder::new(run_folder(&args.run));
    let back_end = settings.onnxruntime.clone().map_or(BackEnd::Embedded, BackEnd::Library);
    let prober = Prober { program: std::env::current_exe()?, back_end, limits: Limits::default() };
    if folder.current()?.is_none() {
        let candidate = look(&resolve(&settings.policy)?, Some(team.robots), &prober.limits)?;
        import(&folder, &candidate)?;
    }
    let (orders, ordered) = mpsc::channel();
    let (events, happened) = mpsc::channel();
    let watched = Watched {
        folder,
        robots: team.robots,
        upstream: Some(settings.policy.clone()),
        poll: Duration::from_millis(settings.poll_ms.clamp(1, 10_000)),
    };
    let shadow = settings.shadow.as_deref().map(|path| load_shadow(path, &team, &prober)).transpose()?;
    let loader = Loader::start(watched, prober, orders)?;
    let thread = std::thread::spawn(move || loader.run(&happened));
    let choice = settings.sample_seed.map_or(Choice::Mean, |seed| Choice::Sample { seed });
    let mut server = Server {
        port: PolicyPort::open(&team.place)?,
        swap: HotSwap::new(team.robots, ordered, events),
        shadow: shadow.map(|loaded| HotSwap::always(team.robots, loaded)),
        team,
        choice,
        positions: Vec::new(),
        chosen: Vec::new(),
    };
    let served = server.serve(&stop);
    drop(server); // Hangs up: the loader writes down what is left and ends.
    let _ = thread.join();
    served
}

fn load_shadow(path: &Path, team: &TeamFile, prober: &Prober) -> anyhow::Result<Loaded> {
    let candidate = look(&resolve(path)?, Some(team.robots), &prober.limits).context("the shadow cannot be used")?;
    prober.try_out(&candidate).context("the shadow cannot be used")?;
    let runtime = Runtime::start(&prober.back_end)?;
    let (bytes, contract) = (&candidate.bytes, &candidate.contract);
    let (actor, _) = try_out(&runtime, bytes, contract, candidate.reference.as_ref(), &prober.limits)?;
    info!("shadow {} (sha256 {})", candidate.file.display(), &candidate.sha256[..12]);
    Ok(Loaded { actor, version: Version(0), sha256: candidate.sha256, since_tick: None })
}

struct Server {
    port: PolicyPort,
    swap: HotSwap,
    shadow: Option<HotSwap>,
    team: TeamFile,
    choice: Choice,
    positions: Vec<Position>,
    /// Action and horizon by robot.
    chosen: Vec<Chosen>,
}

impl Server {
    fn serve(&mut self, stop: &StopFlag) -> anyhow::Result<()> {
        self.swap.between_ticks(0);
        self.port.answer(PolicyAnswer { epoch: FIRST_EPOCH, kind: answer::HELLO, ..PolicyAnswer::EMPTY })?;
        info!("serves {} robots", self.team.robots);
        while !stop.is_set() {
            self.port.wait(LOOK_AROUND)?;
            match self.port.newest()? {
                Some(observation) => self.answer(&observation)?,
                // The coordinator takes this folder with it.
                None if !Path::new(&self.team.place.root).exists() => return Ok(()),
                None => {}
            }
        }
        Ok(())
    }

    fn answer(&mut self, observation: &Observation) -> anyhow::Result<()> {
        let read = os::now_ns();
        let robots = self.team.robots;
        if observation.robots != robots as u64 {
            return Ok(());
        }
        let tick = observation.tick;
        // Every episode has draws of its own.
        let choice = match self.choice {
            Choice::Mean => Choice::Mean,
            Choice::Sample { seed } => {
                Choice::Sample { seed: random::episode_seed(seed, self.team.episodes.number(observation.epoch)) }
            }
        };
        self.positions.clear();
        self.positions.extend(observation.positions[..robots].iter().map(|&position| Position::from(position)));
        self.swap.between_ticks(tick);
        let chosen = self.swap.choose(tick, &self.positions, choice, &mut self.chosen);
        let kind = if chosen { answer::HORIZONS } else { answer::NONE };
        self.publish(observation, read, kind, self.swap.current())?;
        // Only now: a shadow must not delay the answer.
        if let Some(shadow) = &mut self.shadow {
            let read = os::now_ns();
            if shadow.choose(tick, &self.positions, choice, &mut self.chosen) {
                self.publish(observation, read, answer::SHADOW, self.shadow.as_ref().and_then(HotSwap::current))?;
            }
        }
        Ok(())
    }

    fn publish(&self, asked: &Observation, read: u64, kind: u32, acting: Option<&Loaded>) -> anyhow::Result<()> {
        let mut message = PolicyAnswer {
            epoch: asked.epoch,
            tick: asked.tick,
            asked: asked.stamp,
            read,
            kind,
            ..PolicyAnswer::EMPTY
        };
        if let Some(acting) = acting {
            message.version = acting.version.0;
            message.sha256 = sha256_bytes(&acting.sha256).unwrap_or_default();
        }
        if kind != answer::NONE {
            for (robot, (action, horizon)) in self.chosen.iter().enumerate() {
                message.horizons[robot] = horizon.steps() as u8;
                message.actions[robot] = *action as f32;
            }
        }
        message.stamp = os::now_ns();
        Ok(self.port.answer(message)?)
    }
}
