//! What a shape must satisfy before anything is computed with it, and where robots may start and end.

use crate::Position;
use crate::shape::{CutError, Obstacles, turn};

/// Farthest coordinate and largest size, m: as for robots.
pub const MAX_COORDINATE: f64 = 1e6;
/// A polygon with less area than this is none, m^2.
const LEAST_AREA: f64 = 1e-9;
/// Rounding allowance on distances, m: layouts that touch on purpose are accepted.
const TOLERANCE: f64 = 1e-9;

/// What is wrong with a shape, and where. Points are counted from 1, as they are written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShapeProblem {
    /// A number that is none, or far too large.
    #[error(
        "point {point} is [{x}, {y}] m; coordinates must be finite numbers in -{MAX_COORDINATE}..={MAX_COORDINATE} m"
    )]
    Coordinate {
        /// Which point.
        point: usize,
        /// m.
        x: f64,
        /// m.
        y: f64,
    },
    /// A size that is none.
    #[error("{key} = {value} m; allowed: above 0, at most {MAX_COORDINATE} m")]
    Size {
        /// radius or thickness.
        key: &'static str,
        /// As written, m.
        value: f64,
    },
    /// Too few different corners for an area.
    #[error(
        "a polygon needs at least 3 different points in order round it, found {found}; for a line use wall and thickness"
    )]
    OpenPolygon {
        /// Different points in a row.
        found: usize,
    },
    /// Too few points for a chain.
    #[error("a wall needs at least 2 different points, found {found}; for a pillar use position and radius")]
    ShortWall {
        /// Different points in a row.
        found: usize,
    },
    /// All corners on one line.
    #[error(
        "the polygon has no area ({area:.3e} m^2): all its points lie on one line; for a line use wall and thickness"
    )]
    NoArea {
        /// m^2.
        area: f64,
    },
    /// Two sides with a point in common that is not the corner between them.
    #[error(
        "the side from point {} to point {} crosses or touches the side from point {} to point {} near [{:.3}, {:.3}] m; \
         write the points in the order in which one walks round the shape, or split it into several polygons",
        .first.0, .first.1, .second.0, .second.1, .near[0], .near[1]
    )]
    SelfCrossing {
        /// The points at the ends of one side.
        first: (usize, usize),
        /// The points at the ends of the other.
        second: (usize, usize),
        /// Where about, m.
        near: [f64; 2],
    },
    /// The triangulation refuses it.
    #[error(transparent)]
    Cut(#[from] CutError),
}

/// A robot that cannot start or end where its scenario says.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlaceProblem {
    /// Inside a shape.
    #[error("{what} of {robot}, [{x}, {y}] m, lies inside {obstacle} ({depth:.4} m deep); move one of them")]
    Inside {
        /// The robot's name.
        robot: String,
        /// start or set-point.
        what: &'static str,
        /// m.
        x: f64,
        /// m.
        y: f64,
        /// The obstacle's name.
        obstacle: String,
        /// How deep, m.
        depth: f64,
    },
    /// Nearer than owed.
    #[error(
        "{what} of {robot}, [{x}, {y}] m, is {distance:.4} m from {obstacle}; its centre must keep {needed:.4} m: \
         move one of them or give the robot a smaller radius"
    )]
    TooNear {
        /// The robot's name.
        robot: String,
        /// start or set-point.
        what: &'static str,
        /// m.
        x: f64,
        /// m.
        y: f64,
        /// The obstacle's name.
        obstacle: String,
        /// From the robot's centre to the shape, m.
        distance: f64,
        /// What is owed, m.
        needed: f64,
    },
}

/// Checks a disc.
pub(crate) fn disc(centre: Position, radius: f64) -> Result<(), ShapeProblem> {
    coordinates(&[centre])?;
    size("radius", radius)
}

/// Checks a wall: its points, without those that only repeat the one before.
pub(crate) fn wall(points: &[Position], thickness: f64) -> Result<Vec<Position>, ShapeProblem> {
    coordinates(points)?;
    size("thickness", thickness)?;
    let mut chain = points.to_vec();
    chain.dedup();
    if chain.len() < 2 { Err(ShapeProblem::ShortWall { found: chain.len() }) } else { Ok(chain) }
}

/// Checks a polygon: its corners counter-clockwise, without those that only repeat the one before. A last
/// corner that repeats the first is accepted: the outline is closed either way.
pub(crate) fn polygon(points: &[Position]) -> Result<Vec<Position>, ShapeProblem> {
    coordinates(points)?;
    let mut numbered: Vec<(usize, Position)> = points.iter().enumerate().map(|(i, p)| (i + 1, *p)).collect();
    numbered.dedup_by_key(|(_, point)| *point);
    while numbered.len() > 1 && numbered[0].1 == numbered[numbered.len() - 1].1 {
        numbered.pop();
    }
    if numbered.len() < 3 {
        return Err(ShapeProblem::OpenPolygon { found: numbered.len() });
    }
    let origin = numbered[0].1;
    let side = |i: usize| (numbered[i], numbered[(i + 1) % numbered.len()]);
    let area: f64 =
        (0..numbered.len()).map(|i| (side(i).0.1 - origin).perp(&(side(i).1.1 - origin))).sum::<f64>() / 2.0;
    let straight = numbered.iter().all(|(_, point)| turn(origin, numbered[1].1, *point) == 0.0);
    if straight {
        return Err(ShapeProblem::NoArea { area });
    }
    for i in 0..numbered.len() {
        let (a, b) = side(i);
        for j in i + 1..numbered.len() {
            let (c, d) = side(j);
            let near = match (a.0 == d.0, b.0 == c.0) {
                (true, _) => folds_back(b.1, a.1, c.1),
                (_, true) => folds_back(a.1, b.1, d.1),
                _ => touch(a.1, b.1, c.1, d.1),
            };
            if let Some(near) = near {
                let (first, second) = ((a.0, b.0), (c.0, d.0));
                return Err(ShapeProblem::SelfCrossing { first, second, near: near.into() });
            }
        }
    }
    if area.abs() < LEAST_AREA {
        return Err(ShapeProblem::NoArea { area });
    }
    let mut ring: Vec<Position> = numbered.into_iter().map(|(_, point)| point).collect();
    if area < 0.0 {
        ring.reverse();
    }
    Ok(ring)
}

/// Checks that a robot that owes `clearance` (m, from its centre to every shape) can be at `place`.
///
/// # Errors
/// The obstacle that is nearest, and by how much.
pub fn place(
    obstacles: &Obstacles,
    robot: &str,
    what: &'static str,
    place: Position,
    clearance: f64,
) -> Result<(), PlaceProblem> {
    let Some((piece, nearest)) = obstacles.nearest(place, clearance) else { return Ok(()) };
    let (robot, obstacle) = (robot.to_string(), obstacles.name_of(piece).to_string());
    let (x, y, distance) = (place.x, place.y, nearest.distance);
    if distance < 0.0 {
        return Err(PlaceProblem::Inside { robot, what, x, y, obstacle, depth: -distance });
    }
    if distance < clearance - TOLERANCE {
        return Err(PlaceProblem::TooNear { robot, what, x, y, obstacle, distance, needed: clearance });
    }
    Ok(())
}

/// Checks the outlines of a region as far as cutting does not.
pub(crate) fn region(rings: &[Vec<Position>]) -> Result<(), ShapeProblem> {
    for ring in rings {
        coordinates(ring)?;
        if ring.len() < 3 {
            return Err(ShapeProblem::OpenPolygon { found: ring.len() });
        }
    }
    if rings.is_empty() { Err(ShapeProblem::OpenPolygon { found: 0 }) } else { Ok(()) }
}

fn coordinates(points: &[Position]) -> Result<(), ShapeProblem> {
    let fits = |point: &Position| point.iter().all(|x| x.abs() <= MAX_COORDINATE);
    match points.iter().position(|point| !fits(point)) {
        Some(i) => Err(ShapeProblem::Coordinate { point: i + 1, x: points[i].x, y: points[i].y }),
        None => Ok(()),
    }
}

fn size(key: &'static str, value: f64) -> Result<(), ShapeProblem> {
    if value > 0.0 && value <= MAX_COORDINATE { Ok(()) } else { Err(ShapeProblem::Size { key, value }) }
}

/// Where the side from `corner` to `next` runs back over the one from `before`.
fn folds_back(before: Position, corner: Position, next: Position) -> Option<Position> {
    let back = turn(before, corner, next) == 0.0 && (next - corner).dot(&(before - corner)) > 0.0;
    back.then_some(corner)
}

/// Where two straight lines touch or cross: exact, where they do; about, where that is.
pub(crate) fn touch(a: Position, b: Position, c: Position, d: Position) -> Option<Position> {
    use crate::shape::Bounds;
    if !Bounds::of(&[a, b]).meets(&Bounds::of(&[c, d])) {
        return None;
    }
    let (at_c, at_d) = (turn(a, b, c), turn(a, b, d));
    let (at_a, at_b) = (turn(c, d, a), turn(c, d, b));
    let beside = |p: f64, q: f64| (p > 0.0 && q > 0.0) || (p < 0.0 && q < 0.0);
    if beside(at_c, at_d) || beside(at_a, at_b) {
        return None;
    }
    // Rectangles meet and neither is beside the other: also on one line they share a point.
    let on = |p: Position, turned: f64, from: Position, to: Position| {
        (turned == 0.0 && Bounds::of(&[from, to]).distance(p) == 0.0).then_some(p)
    };
    let end = on(c, at_c, a, b).or(on(d, at_d, a, b)).or(on(a, at_a, c, d)).or(on(b, at_b, c, d));
    Some(end.unwrap_or_else(|| c + (d - c) * (at_c / (at_c - at_d))))
}

#[cfg(test)]
mod tests;
