//! `policy check`: may a model act?

use crate::means::Means;
use policy::folder::resolve;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  ./run.sh policy check actor.onnx --robots 14")]
pub(crate) struct CheckArgs {
    /// ONNX file, or a policies folder (its current version is meant)
    file: PathBuf,
    /// Number of robots it is wanted for
    #[arg(long)]
    robots: Option<usize>,
    #[command(flatten)]
    means: Means,
}

pub(crate) fn run(args: &CheckArgs) -> anyhow::Result<ExitCode> {
    let file = resolve(&args.file)?;
    let (candidate, report) = args.means.prober()?.check(&file, args.robots)?;
    let contract = &candidate.contract;
    println!("{} may act", file.display());
    println!("  sha256      {}", candidate.sha256);
    println!("  bytes       {}", candidate.bytes.len());
    println!("  robots      {}", contract.robots);
    println!("  producer    {}", candidate.model.producer);
    println!("  opset       {}", candidate.model.opset().unwrap_or_default());
    println!("  sampling    {}", if contract.outputs.log_std.is_some() { "yes (log_std)" } else { "no (mean only)" });
    println!("  load        {} us with 10 warm-up runs ({} back-end)", report.load_us, args.means.back_end().name());
    println!("  inference   {:.1} us processor time (median of the canary set)", report.inference_ns as f64 / 1e3);
    println!("  canary      {} observations, all answers finite", report.canary_cases);
    println!("  reference   {} observations", report.reference_cases);
    for note in &candidate.notes {
        println!("  note        {note}");
    }
    Ok(ExitCode::SUCCESS)
}
