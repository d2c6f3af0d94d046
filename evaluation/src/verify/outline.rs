//! Distances to polygons, walls and regions, from their outlines as they are written: no pieces, no index.

use super::geometry::{minus, nearest};
use vodca::scenario::Shaped;
use world::shape::Shape;

type Point = [f64; 2];

/// The sides of a shape, and how far it reaches beyond them.
#[derive(Clone, Debug)]
pub(super) struct Outline {
    sides: Vec<(Point, Point)>,
    /// Whether the sides close an inside.
    is_solid: bool,
    /// m.
    reach: f64,
}

impl Outline {
    /// From what the scenario says.
    pub(super) fn of(shape: &Shaped) -> Self {
        let closed = |ring: &[vodca::Position]| {
            (0..ring.len()).map(|i| (ring[i].into(), ring[(i + 1) % ring.len()].into())).collect::<Vec<_>>()
        };
        match shape.shape() {
            Shape::Disc { centre, radius } => {
                Self { sides: vec![((*centre).into(), (*centre).into())], is_solid: false, reach: *radius }
            }
            Shape::Wall { points, thickness } => {
                let sides = points.windows(2).map(|pair| (pair[0].into(), pair[1].into())).collect();
                Self { sides, is_solid: false, reach: thickness / 2.0 }
            }
            Shape::Polygon(corners) => Self { sides: closed(corners), is_solid: true, reach: 0.0 },
            Shape::Region(rings) => {
                Self { sides: rings.iter().flat_map(|ring| closed(ring)).collect(), is_solid: true, reach: 0.0 }
            }
        }
    }

    /// The least distance of a straight motion, m; minus the reach where it meets a side or runs inside.
    pub(super) fn distance(&self, from: Point, to: Point) -> f64 {
        if self.is_solid && self.holds(from) {
            return -self.reach;
        }
        self.sides.iter().map(|side| apart((from, to), *side)).fold(f64::INFINITY, f64::min) - self.reach
    }

    /// Whether a ray to the right crosses the sides an odd number of times.
    fn holds(&self, [x, y]: Point) -> bool {
        let crossed = |((ax, ay), (bx, by)): ((f64, f64), (f64, f64))| {
            (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax)
        };
        self.sides.iter().filter(|(a, b)| crossed(((a[0], a[1]), (b[0], b[1])))).count() % 2 == 1
    }
}

/// The distance between two straight lines: 0 where they cross, otherwise from an end of one to the other.
fn apart((a, b): (Point, Point), (c, d): (Point, Point)) -> f64 {
    let side = |p: Point, q: Point, r: Point| {
        let (along, off) = (minus(q, p), minus(r, p));
        along[0] * off[1] - along[1] * off[0]
    };
    if side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0 {
        return 0.0;
    }
    let to = |p: Point, (q, r): (Point, Point)| nearest(minus(q, p), minus(r, p));
    to(a, (c, d)).min(to(b, (c, d))).min(to(c, (a, b))).min(to(d, (a, b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use vodca::Position;
    use world::shape::Obstacles;

    fn shapes() -> Vec<Shaped> {
        let l = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)];
        let at = |points: &[(f64, f64)]| points.iter().map(|(x, y)| Position::new(*x, *y)).collect::<Vec<_>>();
        let hole = at(&[(7.0, 1.0), (7.0, 3.0), (9.0, 3.0), (9.0, 1.0)]);
        let frame = at(&[(6.0, 0.0), (10.0, 0.0), (10.0, 4.0), (6.0, 4.0)]);
        let wall = at(&[(0.0, 6.0), (5.0, 6.0), (5.0, 9.0)]);
        vec![
            Shaped::new("l", Shape::Polygon(at(&l))).unwrap(),
            Shaped::new("frame", Shape::Region(vec![frame, hole])).unwrap(),
            Shaped::new("wall", Shape::Wall { points: wall, thickness: 0.4 }).unwrap(),
        ]
    }

    #[test]
    fn sides_insides_holes_and_thickness_count() {
        let [l, frame, wall] = [0, 1, 2].map(|i| Outline::of(&shapes()[i]));
        assert_eq!(l.distance([5.0, 0.5], [5.0, 3.0]), 1.0);
        assert_eq!(l.distance([2.0, 0.5], [2.1, 0.5]), 0.0);
        assert_eq!(frame.distance([8.0, 2.0], [8.0, 2.0]), 1.0);
        assert_eq!(frame.distance([6.5, 2.0], [6.6, 2.0]), 0.0);
        assert!((wall.distance([2.0, 7.0], [2.0, 7.0]) - 0.8).abs() < 1e-12);
    }

    proptest! {
        /// Two formulas, one from outlines and one from pieces.
        #[test]
        fn outlines_and_pieces_agree(c in prop::array::uniform4(-3.0f64..12.0)) {
            let (from, to) = (Position::new(c[0], c[1]), Position::new(c[2], c[3]));
            for shape in shapes() {
                let own = Outline::of(&shape).distance(from.into(), to.into());
                let other = Obstacles::new(vec![shape]).separation(from, to, 1e3);
                prop_assert!((own - other).abs() < 1e-9, "{own} {other}");
            }
        }
    }
}
