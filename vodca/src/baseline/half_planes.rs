//! The velocity nearest to a wanted one within half planes and a disc, by incremental linear
//! programming (de Berg et al., Computational Geometry, chapter 4; used by ORCA).

use crate::Input;

/// Velocities to the left of a directed line are allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPlane {
    /// A point on the line, m/s.
    pub point: Input,
    /// Unit direction of the line.
    pub direction: Input,
}

impl HalfPlane {
    /// How far `velocity` lies on the forbidden side, m/s; negative when allowed.
    pub fn violation(&self, velocity: Input) -> f64 {
        cross(self.direction, self.point - velocity)
    }
}

/// z component of the cross product.
pub fn cross(a: Input, b: Input) -> f64 {
    a.x * b.y - a.y * b.x
}

const PARALLEL: f64 = 1e-9;

/// What is wanted of the velocity.
#[derive(Clone, Copy)]
enum Wanted {
    /// The nearest to this.
    Nearest(Input),
    /// The farthest in this unit direction.
    Farthest(Input),
}

/// The velocity nearest to `wanted` with `|v| <= speed` that all `planes` allow. When they do not
/// allow any, the first `fixed` of them stay and the largest violation of the others is made least.
pub fn nearest_velocity(
    planes: &[HalfPlane],
    fixed: usize,
    speed: f64,
    wanted: Input,
    scratch: &mut Vec<HalfPlane>,
) -> Input {
    match in_planes(planes, speed, Wanted::Nearest(wanted)) {
        Ok(velocity) => velocity,
        Err((failed, so_far)) => least_violation(planes, fixed, failed, speed, so_far, scratch),
    }
}

/// `Err` holds the index of the plane that could not be met and the best velocity before it.
fn in_planes(planes: &[HalfPlane], speed: f64, wanted: Wanted) -> Result<Input, (usize, Input)> {
    let mut velocity = match wanted {
        Wanted::Farthest(direction) => direction * speed,
        Wanted::Nearest(velocity) if velocity.norm() > speed => velocity * (speed / velocity.norm()),
        Wanted::Nearest(velocity) => velocity,
    };
    for (index, plane) in planes.iter().enumerate() {
        if plane.violation(velocity) > 0.0 {
            velocity = on_line(plane, &planes[..index], speed, wanted).ok_or((index, velocity))?;
        }
    }
    Ok(velocity)
}

/// The best velocity on the line of `plane` within the disc and the `earlier` planes.
fn on_line(plane: &HalfPlane, earlier: &[HalfPlane], speed: f64, wanted: Wanted) -> Option<Input> {
    let along = plane.point.dot(&plane.direction);
    let inside = along * along + speed * speed - plane.point.norm_squared();
    if inside < 0.0 {
        return None;
    }
    let (mut from, mut to) = (-along - inside.sqrt(), -along + inside.sqrt());
    for other in earlier {
        let denominator = cross(plane.direction, other.direction);
        let numerator = cross(other.direction, plane.point - other.point);
        if denominator.abs() <= PARALLEL {
            if numerator < 0.0 {
                return None;
            }
            continue;
        }
        let at = numerator / denominator;
        if denominator >= 0.0 {
            to = to.min(at)
        } else {
            from = from.max(at)
        }
        if from > to {
            return None;
        }
    }
    let at = match wanted {
        Wanted::Farthest(direction) if direction.dot(&plane.direction) > 0.0 => to,
        Wanted::Farthest(_) => from,
        Wanted::Nearest(velocity) => plane.direction.dot(&(velocity - plane.point)).clamp(from, to),
    };
    Some(plane.point + plane.direction * at)
}

/// Makes the largest violation of the planes from `failed` on least (a linear program in 3D, solved as
/// a sequence in 2D).
fn least_violation(
    planes: &[HalfPlane],
    fixed: usize,
    failed: usize,
    speed: f64,
    so_far: Input,
    scratch: &mut Vec<HalfPlane>,
) -> Input {
    let mut velocity = so_far;
    let mut worst = 0.0;
    for (index, plane) in planes.iter().enumerate().skip(failed) {
        if plane.violation(velocity) <= worst {
            continue;
        }
        scratch.clear();
        scratch.extend(&planes[..fixed.min(index)]);
        scratch.extend(planes[fixed.min(index)..index].iter().filter_map(|other| bisector(plane, other)));
        let inward = Input::new(-plane.direction.y, plane.direction.x);
        // A failure here is rounding only: the velocity so far is already optimal for these planes.
        if let Ok(better) = in_planes(scratch, speed, Wanted::Farthest(inward)) {
            velocity = better;
        }
        worst = plane.violation(velocity);
    }
    velocity
}

/// The line on which both planes are violated alike.
fn bisector(plane: &HalfPlane, other: &HalfPlane) -> Option<HalfPlane> {
    let determinant = cross(plane.direction, other.direction);
    let point = if determinant.abs() <= PARALLEL {
        if plane.direction.dot(&other.direction) > 0.0 {
            return None; // The same direction.
        }
        (plane.point + other.point) * 0.5
    } else {
        plane.point + plane.direction * (cross(other.direction, plane.point - other.point) / determinant)
    };
    Some(HalfPlane { point, direction: (other.direction - plane.direction).normalize() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn plane(angle: f64, offset: f64) -> HalfPlane {
        let direction = Input::new(angle.cos(), angle.sin());
        HalfPlane { point: Input::new(-direction.y, direction.x) * offset, direction }
    }

    proptest! {
        #[test]
        fn the_answer_is_allowed_and_nearest(
            lines in prop::collection::vec((0.0f64..6.3, -0.8f64..0.3), 0..6),
            x in -2.0f64..2.0, y in -2.0f64..2.0,
        ) {
            let planes: Vec<_> = lines.iter().map(|&(angle, offset)| plane(angle, offset)).collect();
            let wanted = Input::new(x, y);
            let worst = |v: Input| planes.iter().map(|p| p.violation(v)).fold(0.0f64, f64::max);
            let found = nearest_velocity(&planes, 0, 1.5, wanted, &mut Vec::new());
            prop_assert!(found.norm() <= 1.5 + 1e-6);
            for i in -30..=30 { for j in -30..=30 {
                let other = Input::new(i as f64, j as f64) * 0.05;
                if other.norm() > 1.5 { continue; }
                if worst(found) < 1e-9 {
                    if worst(other) == 0.0 { prop_assert!((found - wanted).norm() <= (other - wanted).norm() + 1e-6); }
                } else {
                    prop_assert!(worst(found) <= worst(other) + 1e-6);
                }
            }}
        }
    }
}
