//! `learner settings`: what `--set` takes.

use crate::settings::Settings;

pub(crate) fn run() -> anyhow::Result<()> {
    print!("{}", toml::to_string(&Settings::default())?);
    println!("# target_entropy = -N\n# reward_scale = 0.02 / N, at least 0.002");
    Ok(())
}
