//! Cuts a polygon with holes into convex pieces.
//!
//! A constrained Delaunay triangulation (spade: exact predicates, keeps every vertex to the bit), from which
//! every diagonal is taken out whose two pieces are convex together (Hertel and Mehlhorn 1983: at most four
//! times as many pieces as the best cut has).

use crate::Position;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

/// Why a polygon cannot be cut. Outlines that have been checked can: what remains are numbers at the ends of f64.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CutError {
    /// The triangulation refuses a vertex.
    #[error("vertex [{x}, {y}] m cannot be triangulated: {reason}; use coordinates of ordinary size")]
    Vertex {
        /// m.
        x: f64,
        /// m.
        y: f64,
        /// The triangulation's reason.
        reason: String,
    },
    /// Two sides cross.
    #[error(
        "the side from [{}, {}] to [{}, {}] m crosses another side; outlines must not cross", .from[0], .from[1], .to[0], .to[1]
    )]
    Crossing {
        /// m.
        from: [f64; 2],
        /// m.
        to: [f64; 2],
    },
}

/// Twice the signed area of a triangle, its sign exact: above 0 where c lies left of the line from a to b.
pub(crate) fn turn(a: Position, b: Position, c: Position) -> f64 {
    let at = |p: Position| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(at(a), at(b), at(c))
}

/// The convex polygons, counter-clockwise, whose union is what lies inside an odd number of `rings`. Rings may
/// touch in vertices but must not cross.
pub(crate) fn into_convex(rings: &[Vec<Position>]) -> Result<Vec<Vec<Position>>, CutError> {
    let mut mesh = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    for ring in rings {
        let mut handles = Vec::with_capacity(ring.len());
        for corner in ring {
            let refused =
                |error| CutError::Vertex { x: corner.x, y: corner.y, reason: spade::InsertionError::to_string(&error) };
            handles.push(mesh.insert(Point2::new(corner.x, corner.y)).map_err(refused)?);
        }
        for (i, &from) in handles.iter().enumerate() {
            let to = handles[(i + 1) % handles.len()];
            if from != to {
                if !mesh.can_add_constraint(from, to) {
                    let to = ring[(i + 1) % ring.len()];
                    return Err(CutError::Crossing { from: ring[i].into(), to: to.into() });
                }
                mesh.add_constraint(from, to);
            }
        }
    }
    let inside = inner_faces(&mesh);
    Ok(merge(&mesh, &inside))
}

type Mesh = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// By face: whether it lies inside, reached from the outer face over an odd number of outlines.
fn inner_faces(mesh: &Mesh) -> Vec<bool> {
    let mut parity: Vec<Option<bool>> = vec![None; mesh.num_all_faces()];
    let mut open: Vec<(usize, bool)> = Vec::new();
    for edge in mesh.directed_edges().filter(|edge| edge.is_outer_edge()) {
        open.push((edge.rev().face().index(), edge.is_constraint_edge()));
    }
    let handles: Vec<_> = mesh.all_faces().map(|face| face.as_inner()).collect();
    while let Some((face, inside)) = open.pop() {
        let Some(inner) = handles[face] else { continue };
        if parity[face].is_some() {
            continue;
        }
        parity[face] = Some(inside);
        for edge in inner.adjacent_edges() {
            open.push((edge.rev().face().index(), inside != edge.is_constraint_edge()));
        }
    }
    parity.into_iter().map(|inside| inside == Some(true)).collect()
}

/// The inner triangles, merged over every diagonal that leaves a convex polygon; longest diagonals first.
fn merge(mesh: &Mesh, inside: &[bool]) -> Vec<Vec<Position>> {
    let place: Vec<Position> = mesh.vertices().map(|v| Position::new(v.position().x, v.position().y)).collect();
    let mut polygons: Vec<Vec<usize>> = vec![Vec::new(); inside.len()];
    for face in mesh.inner_faces().filter(|face| inside[face.index()]) {
        polygons[face.index()] = face.vertices().iter().map(|vertex| vertex.index()).collect();
    }
    let mut diagonals: Vec<_> = mesh
        .undirected_edges()
        .filter(|edge| !edge.is_constraint_edge())
        .map(|edge| edge.as_directed())
        .filter(|edge| inside[edge.face().index()] && inside[edge.rev().face().index()])
        .collect();
    diagonals.sort_by(|a, b| b.length_2().total_cmp(&a.length_2()));
    // By face: the face whose polygon it has become part of.
    let mut part_of: Vec<usize> = (0..inside.len()).collect();
    fn home(part_of: &mut [usize], mut face: usize) -> usize {
        while part_of[face] != face {
            part_of[face] = part_of[part_of[face]];
            face = part_of[face];
        }
        face
    }
    for edge in diagonals {
        let (left, right) = (home(&mut part_of, edge.face().index()), home(&mut part_of, edge.rev().face().index()));
        let (from, to) = (edge.from().index(), edge.to().index());
        if left != right
            && let Some(joined) = join(&polygons[left], &polygons[right], from, to, &place)
        {
            polygons[left] = joined;
            polygons[right].clear();
            part_of[right] = left;
        }
    }
    polygons
        .into_iter()
        .filter(|polygon| !polygon.is_empty())
        .map(|polygon| polygon.into_iter().map(|vertex| place[vertex]).collect())
        .collect()
}

/// Two polygons with the side `from`-`to` in common (forwards in `left`), as one, if that is convex.
fn join(left: &[usize], right: &[usize], from: usize, to: usize, place: &[Position]) -> Option<Vec<usize>> {
    let after = |polygon: &[usize], vertex: usize| polygon.iter().position(|v| *v == vertex);
    let (in_left, in_right) = (after(left, to)?, after(right, from)?);
    // Left from `to` round to `from`, then right from behind `from` to before `to`.
    let mut joined: Vec<usize> = (0..left.len()).map(|k| left[(in_left + k) % left.len()]).collect();
    joined.extend((1..right.len() - 1).map(|k| right[(in_right + k) % right.len()]));
    let corner = |at: usize| {
        let n = joined.len();
        turn(place[joined[(at + n - 1) % n]], place[joined[at]], place[joined[(at + 1) % n]]) >= 0.0
    };
    (corner(0) && corner(left.len() - 1)).then_some(joined)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ring(points: &[(f64, f64)]) -> Vec<Position> {
        points.iter().map(|(x, y)| Position::new(*x, *y)).collect()
    }

    fn area(polygon: &[Position]) -> f64 {
        (0..polygon.len()).map(|i| polygon[i].perp(&polygon[(i + 1) % polygon.len()])).sum::<f64>() / 2.0
    }

    fn is_convex(polygon: &[Position]) -> bool {
        let n = polygon.len();
        (0..n).all(|i| turn(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n]) >= 0.0)
    }

    #[test]
    fn a_convex_polygon_stays_one_piece() {
        let hexagon: Vec<Position> =
            (0..6).map(|k| (f64::from(k) * 1.05).sin_cos()).map(|(s, c)| Position::new(c, s)).collect();
        let pieces = into_convex(std::slice::from_ref(&hexagon)).unwrap();
        assert_eq!(pieces.len(), 1);
        assert!((area(&pieces[0]) - area(&hexagon)).abs() < 1e-12);
    }

    #[test]
    fn an_l_is_two_pieces_and_a_frame_at_most_four() {
        let l = ring(&[(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]);
        assert_eq!(into_convex(&[l]).unwrap().len(), 2);
        let outer = ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
        let hole = ring(&[(1.0, 1.0), (1.0, 3.0), (3.0, 3.0), (3.0, 1.0)]);
        let pieces = into_convex(&[outer, hole]).unwrap();
        assert!(pieces.len() <= 4, "{}", pieces.len());
        assert!((pieces.iter().map(|piece| area(piece)).sum::<f64>() - 12.0).abs() < 1e-12);
    }

    #[test]
    fn rings_may_touch_in_a_corner() {
        // Two squares whose corners meet, as one outline that passes there twice.
        let eight =
            ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0), (1.0, 1.0), (0.0, 1.0)]);
        let pieces = into_convex(&[eight]).unwrap();
        assert_eq!(pieces.len(), 2);
        assert!((pieces.iter().map(|piece| area(piece)).sum::<f64>() - 2.0).abs() < 1e-12);
    }

    #[test]
    fn crossing_sides_are_refused() {
        let bow = ring(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]);
        assert!(matches!(into_convex(&[bow]), Err(CutError::Crossing { .. })));
    }

    proptest! {
        #[test]
        fn pieces_are_convex_and_cover_the_polygon_once(radii in prop::collection::vec(0.2f64..3.0, 3..40)) {
            // A star: a simple polygon, whatever its radii.
            let n = radii.len() as f64;
            let star: Vec<Position> = radii.iter().enumerate().map(|(k, radius)| {
                let (sin, cos) = (std::f64::consts::TAU * k as f64 / n).sin_cos();
                Position::new(cos, sin) * *radius
            }).collect();
            let pieces = into_convex(std::slice::from_ref(&star)).unwrap();
            prop_assert!(pieces.iter().all(|piece| is_convex(piece) && piece.len() >= 3));
            let sum: f64 = pieces.iter().map(|piece| area(piece)).sum();
            prop_assert!((sum - area(&star)).abs() < 1e-9 * sum.max(1.0));
            prop_assert!(pieces.len() <= star.len() - 2);
        }
    }
}
