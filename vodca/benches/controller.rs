//! Time of the controller's parts: `cargo bench -p vodca --bench controller`.
//!
//! The view of the robot with most rows in the middle of a run of fourteen robots around three
//! obstacles; every measurement repeats that one tick.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::sync::Arc;
use std::time::Duration;
use vodca::Position;
use vodca::conflict::rows::collision_rows;
use vodca::controller::{Controller, View};
use vodca::horizon::Horizon;
use vodca::layout::Layout;
use vodca::neighbour_estimates::NeighbourEstimates;
use vodca::params::{Params, Profile};
use vodca::prediction::Prediction;
use vodca::reference;
use vodca::safety::cell::{Cell, Present};
use vodca::safety::filter::nearest_safe;
use vodca::scenario::{Scenario, set_up};
use vodca::team::Team;
use vodca::vodca_controller::{VodcaController, hazards};
use vodca::way::right_of_way::Regard;

/// The tick that is repeated: everybody is in everybody's way.
const TICK: u64 = 25;

/// What a robot knows at [`TICK`].
struct Moment {
    scenario: Scenario,
    params: Params,
    layout: Arc<Layout>,
    robot: usize,
    horizon: Horizon,
    hearing: NeighbourEstimates,
    position: Position,
    previous: Prediction,
}

impl Moment {
    fn new(profile: Profile, steps: i64) -> Self {
        let (scenario, params) = set_up(Some("ex14_d"), None, profile, &[]).expect("a built-in scenario");
        let horizon = Horizon::saturating(steps);
        let horizons = vec![horizon; scenario.robots.len()];
        let mut team = Team::new(&scenario, &params, scenario.seed);
        let mut hearing = NeighbourEstimates::new(0, &scenario, &params.disturbance, scenario.seed);
        for tick in 0..TICK - 1 {
            for (robot, step) in team.step(&horizons).iter().enumerate() {
                hearing.hear(tick, robot, &step.plan);
            }
        }
        let last = team.step(&horizons).to_vec();
        last.iter().enumerate().for_each(|(robot, step)| hearing.hear(TICK - 1, robot, &step.plan));
        let most = last.iter().enumerate().max_by_key(|(_, step)| step.rows);
        let robot = most.map_or(0, |(robot, _)| robot);
        let (position, previous) = (last[robot].next_position, last[robot].plan.clone());
        let layout = Arc::new(Layout::of(&scenario, &params.model));
        Self { scenario, params, layout, robot, horizon, hearing, position, previous }
    }

    fn view(&self) -> View<'_> {
        View { tick: TICK, horizon: self.horizon, position: self.position, neighbours: self.hearing.neighbours() }
    }

    fn cell(&self, cell: &mut Cell) {
        cell.clear();
        let separation = self.params.cell.separation;
        let others = self.hearing.neighbours().iter().enumerate().filter(|(other, _)| *other != self.robot);
        for (other, neighbour) in others {
            if let Some((_, position)) = neighbour.present {
                let present = Present { position, separation, moves: Some(cell.stride) };
                cell.keep_away(self.position, &present, self.params.cell.escape, self.robot < other);
            }
        }
    }
}

fn parts(criterion: &mut Criterion) {
    for steps in [20, 49] {
        let moment = Moment::new(Profile::Safe, steps);
        let (params, view) = (&moment.params, moment.view());
        let model = &params.model;
        let regards = vec![Regard::Plan; view.neighbours.len()];
        let mut rows = Vec::with_capacity(64);
        criterion.bench_function(&format!("conflicts and rows, 13 neighbours, N = {steps}"), |bencher| {
            bencher.iter(|| {
                rows.clear();
                let hazards = hazards(params, &moment.layout, moment.robot, black_box(&view), &regards);
                let (previous, horizon) = (&moment.previous, moment.horizon);
                collision_rows(&params.vodca, model.min_separation, 0.35, previous, horizon, hazards, &mut rows)
            })
        });
        let mut target = reference::empty_target();
        let set_point = moment.scenario.robots[moment.robot].set_point;
        criterion.bench_function(&format!("straight reference, N = {steps}"), |bencher| {
            bencher.iter(|| {
                let (h, speed) = (model.sample_time, model.max_speed);
                reference::straight(&mut target, black_box(moment.position), set_point, moment.horizon, h, speed);
            })
        });
        for (profile, name) in [(Profile::Safe, "safe"), (Profile::Paper, "paper")] {
            let moment = Moment::new(profile, steps);
            let mut controller = VodcaController::new(moment.robot, &moment.params, &moment.layout);
            controller.tick(&moment.view()); // the first tick knows of no conflicts
            criterion.bench_function(&format!("controller step, {name}, N = {steps}"), |bencher| {
                bencher.iter(|| controller.tick(black_box(&moment.view())).solve_ns)
            });
        }
    }
}

fn safety(criterion: &mut Criterion) {
    let moment = Moment::new(Profile::Safe, 20);
    let stride = moment.params.model.sample_time * moment.params.model.max_speed;
    let mut cell = Cell::with_capacity(16, stride);
    criterion.bench_function("cell of 13 neighbours", |bencher| bencher.iter(|| moment.cell(black_box(&mut cell))));
    for (name, wanted) in [("that keeps everything", Position::zeros()), ("at full speed", Position::new(0.3, 0.3))] {
        criterion.bench_function(&format!("safety filter of a move {name}"), |bencher| {
            bencher.iter(|| nearest_safe(black_box(wanted), &cell))
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = parts, safety
}
criterion_main!(benches);
