//! The plots: a tick's latency against the number of robots, and distributions.

use super::row::{Results, Row, TICK_PARTS};
use crate::figures::svg::{COLOURS, Chart, Labels};

/// Every plot that the results allow, by file name.
pub(super) fn all(results: &Results) -> Vec<(String, String)> {
    let mut plots = Vec::new();
    for (part, pace) in [("exchange", "full speed"), ("scale", "real time")] {
        let name = format!("{part}_{}.svg", pace.replace(' ', "_"));
        plots.extend(against_robots(results, part, pace).map(|svg| (name, svg)));
    }
    for part in results.parts() {
        let rows: Vec<&Row> = results.rows.iter().filter(|row| row.part == part).collect();
        // Of the exchange one size: the lines of all would hide each other.
        let chosen: Vec<&Row> = match part {
            TICK_PARTS => continue,
            "exchange" => {
                let size = if rows.iter().any(|row| row.size == Some(14)) {
                    Some(14)
                } else {
                    rows.iter().map(|row| row.size).max().flatten()
                };
                rows.into_iter().filter(|row| row.size == size && row.name.ends_with("full speed")).collect()
            }
            _ => rows,
        };
        for (number, chunk) in chosen.chunks(COLOURS.len()).enumerate() {
            let name =
                if number == 0 { format!("histogram_{part}.svg") } else { format!("histogram_{part}_{number}.svg") };
            plots.extend(distributions(part, chunk).map(|svg| (name, svg)));
        }
    }
    plots
}

/// Decades that hold all of `values`; `None` when there are none.
fn decades(values: impl Iterator<Item = f64> + Clone) -> Option<[f64; 2]> {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let most = values.fold(0.0, f64::max);
    (least > 0.0 && least.is_finite())
        .then(|| [least.log10().floor(), (most.log10().ceil()).max(least.log10().floor() + 1.0)])
}

/// p50 of a tick over the number of robots, both logarithmic.
fn against_robots(results: &Results, part: &str, pace: &str) -> Option<String> {
    let rows: Vec<&Row> = results.rows.iter().filter(|row| row.part == part && row.name.ends_with(pace)).collect();
    let p50 = |row: &Row| row.latency.percentiles().p50_us;
    let times = decades(rows.iter().map(|row| p50(row)))?;
    let mut sizes: Vec<usize> = rows.iter().filter_map(|row| row.size).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let (first, last) = (*sizes.first()? as f64, *sizes.last()? as f64);
    if first >= last {
        return None;
    }
    let labels = Labels {
        title: &format!("A tick of the team, p50, {pace}"),
        x: "robots",
        y: "us",
        command: &format!("./run.sh bench {part}"),
    };
    let mut chart = Chart::logarithmic(&labels, [first.log10(), last.log10()], times);
    chart.mark_x(sizes.iter().map(|&size| ((size as f64).log10(), size.to_string())));
    let mut names: Vec<&str> = Vec::new();
    rows.iter().for_each(|row| {
        if !names.contains(&row.name.as_str()) {
            names.push(&row.name)
        }
    });
    for (index, name) in names.iter().enumerate() {
        let points: Vec<[f64; 2]> = rows
            .iter()
            .filter(|row| row.name == *name)
            .filter_map(|row| Some([(row.size? as f64).log10(), p50(row).log10()]))
            .collect();
        chart.line(&points, COLOURS[index % COLOURS.len()], "");
    }
    let short = |name: &&str| name.trim_end_matches(pace).trim_end_matches(", ").to_owned();
    let keys = names.iter().enumerate().map(|(index, name)| (COLOURS[index % COLOURS.len()], short(name)));
    chart.keys(keys, false);
    Some(chart.finish())
}

/// Shares of durations that are no longer than the time on the logarithmic x axis.
fn distributions(part: &str, rows: &[&Row]) -> Option<String> {
    let all = rows.iter().map(|row| row.latency.percentiles());
    let times = decades(all.flat_map(|figures| [figures.p50_us / 10.0, figures.max_us]).filter(|time| *time > 0.0))?;
    let labels = Labels {
        title: &format!("{part}: share of durations up to a time"),
        x: "us",
        y: "%",
        command: &format!("./run.sh bench {part}"),
    };
    let mut chart = Chart::new(&labels, times, [0.0, 100.0], false);
    chart.mark_x((times[0] as i32..=times[1] as i32).map(|power| (f64::from(power), power_of_ten(power))));
    for (index, row) in rows.iter().enumerate() {
        let total = row.latency.percentiles().count.max(1) as f64;
        let mut sum = 0;
        let points: Vec<[f64; 2]> = row
            .latency
            .buckets()
            .into_iter()
            .map(|(bound, count)| {
                sum += count;
                [(bound as f64 / 1e3).log10().max(times[0]), 100.0 * sum as f64 / total]
            })
            .collect();
        chart.line(&points, COLOURS[index % COLOURS.len()], "");
    }
    let name = |row: &&Row| format!("{}{}", row.name, row.size.map_or(String::new(), |size| format!(", n = {size}")));
    let keys = rows.iter().enumerate().map(|(index, row)| (COLOURS[index % COLOURS.len()], name(row)));
    chart.keys(keys, true);
    Some(chart.finish())
}

/// 10^`power` as people write it.
fn power_of_ten(power: i32) -> String {
    10f64.powi(power).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use coordinator::latency::Latency;

    #[test]
    fn every_part_gets_its_plots() {
        let mut latency = Latency::new();
        (1..=100).for_each(|n| latency.record_ns(n * 1_000));
        let mut results = Results::default();
        for size in [2, 14] {
            results.row(Row::new("exchange", "peer, no QP, full speed", Some(size), latency.clone()));
        }
        results.row(Row::new("hop", "futex", None, latency));
        let plots = all(&results);
        let names: Vec<&str> = plots.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["exchange_full_speed.svg", "histogram_exchange.svg", "histogram_hop.svg"]);
        for (name, svg) in plots {
            assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n") && !svg.contains("NaN"), "{name}: {svg}");
        }
    }
}
