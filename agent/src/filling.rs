//! Who takes its set-point first where set-points close each other in: the deepest.
//!
//! A set-point is *open* when a robot gets to it from outside although all others are taken. The open ones are
//! the first layer; what is open once they are left free, the second; and so on, as one peels an onion. Filled
//! from the last layer to the first, every set-point is open when its turn comes.

use shared::Position;
use shared::metrics::Disc;

/// What closes ways: a disc that the centre of the robot in question must not enter.
type Closed = (Position, f64);

/// The turn of each robot.
#[derive(Clone, Debug, Default)]
pub struct Filling {
    /// By robot: the group of its set-point (those that can close each other in) and its layer there.
    place: Vec<(usize, usize)>,
    /// By robot: where it waits, m. Its set-point where it waits for nobody.
    pub outside: Vec<Position>,
}

impl Filling {
    /// The turns of robots with `set_points` and radii `extra` beyond min_separation / 2 among `obstacles`, m.
    pub fn new(
        set_points: &[Position],
        extra: &[f64],
        obstacles: &[Disc],
        min_separation: f64,
    ) -> Self {
        let owed = |a: f64, b: f64| min_separation + a + b;
        let layers = layers(set_points, extra, obstacles, min_separation);
        let apart = |a: usize, b: usize| (set_points[a] - set_points[b]).norm();
        let groups =
            groups(set_points, |a, b| apart(a, b) < 2.0 * owed(extra[a], extra[b]));
        let place: Vec<(usize, usize)> = groups.into_iter().zip(layers).collect();
        let deepest = |group: usize| {
            place.iter().filter(|(other, _)| *other == group).map(|(_, layer)| *layer).max().unwrap_or_default()
        };
        let outside = |robot: usize| {
            let (own, (group, layer)) = (set_points[robot], place[robot]);
            let others = || (0..place.len()).filter(move |other| *other != robot).filter(|other| place[*other].0 == group);
            let before = others().filter(|&other| waits(place[robot], place[other]));
            let away: Position =
                before.map(|other| own - set_points[other]).map(|apart| apart / apart.norm_squared()).sum();
            if away.norm() < 1e-9 {
                return own;
            }
            // A lane all round the group for whose turn it is; behind it, those whose turn comes first.
            let lanes = (1 + deepest(group) - layer) as f64;
            let far = |at: Position| {
                others().all(|other| (at - set_points[other]).norm() >= lanes * owed(extra[robot], extra[other]))
            };
            let free = |at: Position| {
                obstacles.iter().all(|disc| (at - disc.centre).norm() >= owed(extra[robot], disc.extra))
            };
            let mut at = own;
            while !far(at) {
                let next = at + away.normalize() * 0.1;
                if !free(next) {
                    break;
                }
                at = next;
            }
            at
        };
        let outside = (0..place.len()).map(outside).collect();
        Self { place, outside }
    }

    /// Whether `robot` waits until `other` has taken its set-point.
    pub fn waits(&self, robot: usize, other: usize) -> bool {
        waits(self.place[robot], self.place[other])
    }
}

fn waits((group, layer): (usize, usize), (other_group, other_layer): (usize, usize)) -> bool {
    group == other_group && layer < other_layer
}

/// The layer of each set-point, 1 for the open ones. Those that never become open are of the last one.
fn layers(set_points: &[Position], extra: &[f64], obstacles: &[Disc], min_separation: f64) -> Vec<usize> {
    let mut layers = vec![0; set_points.len()];
    for layer in 1.. {
        let closed_in = |robot: usize| {
            let owed = |other: f64| min_separation + extra[robot] + other;
            let still = |other: &usize| *other != robot && layers[*other] == 0;
            let closed: Vec<Closed> = (0..set_points.len())
                .filter(still)
                .map(|other| (set_points[other], owed(extra[other])))
                .chain(obstacles.iter().map(|disc| (disc.centre, owed(disc.extra))))
                .collect();
            is_closed_in(set_points[robot], &closed)
        };
        let left: Vec<usize> = (0..set_points.len()).filter(|&robot| layers[robot] == 0).collect();
        let open: Vec<usize> = left.iter().copied().filter(|&robot| !closed_in(robot)).collect();
        let peeled = if open.is_empty() { &left } else { &open };
        peeled.iter().for_each(|&robot| layers[robot] = layer);
        if peeled.len() == left.len() {
            break;
        }
    }
    layers
}

/// Whether `discs` close `point` in: whether a closed chain of overlapping discs runs round it. A chain runs round
/// it if it crosses a line from there to far away an odd number of times.
fn is_closed_in(point: Position, discs: &[Closed]) -> bool {
    let mut chains = Chains::new(discs.len());
    (0..discs.len()).any(|a| {
        (0..a).any(|b| {
            let ((at, radius), (to, other)) = (discs[a], discs[b]);
            let overlap = (at - to).norm() < radius + other - 1e-6;
            overlap && !chains.link(a, b, crosses(point, at, to))
        })
    })
}

/// Whether the way from `a` to `b` crosses the ray from `point` in a direction that no grid has.
fn crosses(point: Position, a: Position, b: Position) -> bool {
    let (sin, cos) = 1f64.sin_cos();
    let seen = |at: Position| {
        let from = at - point;
        (cos * from.x + sin * from.y, cos * from.y - sin * from.x)
    };
    let ((ahead_a, side_a), (ahead_b, side_b)) = (seen(a), seen(b));
    (side_a > 0.0) != (side_b > 0.0) && (ahead_a * side_b - ahead_b * side_a) * (side_b - side_a) > 0.0
}

/// Chains of discs (union and find), each disc with the parity of the crossings from its chain's first disc.
struct Chains {
    first: Vec<usize>,
    odd: Vec<bool>,
}

impl Chains {
    fn new(discs: usize) -> Self {
        Self { first: (0..discs).collect(), odd: vec![false; discs] }
    }

    fn find(&self, mut disc: usize) -> (usize, bool) {
        let mut odd = false;
        while self.first[disc] != disc {
            odd ^= self.odd[disc];
            disc = self.first[disc];
        }
        (disc, odd)
    }

    /// Links two discs; false when that closes a chain with an odd number of crossings.
    fn link(&mut self, a: usize, b: usize, crosses: bool) -> bool {
        let ((root_a, odd_a), (root_b, odd_b)) = (self.find(a), self.find(b));
        if root_a == root_b {
            return odd_a ^ odd_b == crosses;
        }
        self.first[root_b] = root_a;
        self.odd[root_b] = odd_a ^ odd_b ^ crosses;
        true
    }
}

/// The number of each one's group, of those connected by `linked`.
fn groups(set_points: &[Position], linked: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let mut chains = Chains::new(set_points.len());
    for a in 0..set_points.len() {
        (0..a).filter(|&b| linked(a, b)).for_each(|b| {
            chains.link(a, b, false);
        });
    }
    (0..set_points.len()).map(|robot| chains.find(robot).0).collect()
}
