//! Who goes first, and where a robot looks in a tick: what every robot finds from the positions, set-points and
//! aims that everybody broadcasts.
//!
//! Set-points that close each other in are filled from the deepest to the outermost ([`super::Filling`]). Whoever
//! waits, or is near its place and can make room, lets pass who has farther to go. Whoever stands where nothing
//! gives way stays, and is walked round ([`Standing`]), unless those who stand have shut the other in.

use super::{Path, Rest, Standing};
use crate::Position;
use crate::conflict::memory::ConflictMemory;
use crate::controller::View;
use crate::layout::Layout;
use crate::params::{Params, Reference};

/// Share of min_separation up to which a robot's distance to its set-point lets those who wait for it go on.
const TAKEN: f64 = 0.2;

/// Whether all that `robot` waits for have taken their set-points.
fn is_turn(params: &Params, layout: &Layout, robot: usize, view: &View<'_>) -> bool {
    params.mpc.reference != Reference::Route
        || view.neighbours.iter().enumerate().all(|(other, neighbour)| {
            let taken = |at: Position| (at - neighbour.set_point).norm() < TAKEN * params.model.min_separation;
            !layout.filling.waits(robot, other) || neighbour.present.is_some_and(|(_, at)| taken(at))
        })
}

/// Where `robot` looks: along its way to its set-point, or to where it waits for its turn, round the obstacles and
/// those who stand.
pub fn way_on(
    params: &Params,
    layout: &Layout,
    robot: usize,
    view: &View<'_>,
    standing: &mut Standing,
    [rest, rest_outside]: &mut [[Rest; 2]; 2],
) -> Path {
    if params.mpc.reference != Reference::Route {
        return Path::straight(view.position, layout.set_points[robot]);
    }
    standing.look(params, layout, robot, view);
    let (ways, rest) =
        if is_turn(params, layout, robot, view) { (&layout.routes, rest) } else { (&layout.outside, rest_outside) };
    // Aside and back again.
    let price = 2.0 * params.model.min_separation;
    ways[robot].path_round(view.position, standing.who, standing.tight, price, rest)
}

/// How a robot regards another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regard {
    /// It keeps away from the other's plan.
    Plan,
    /// It keeps away from where the other wishes to walk: it lets it pass.
    Wish,
    /// It stays at its place, which the other walks round.
    Stays,
}

/// How `robot` regards the others, by number.
pub fn regard_others(
    params: &Params,
    layout: &Layout,
    robot: usize,
    memory: &ConflictMemory,
    view: &View<'_>,
    standing: &mut Standing,
    regards: &mut Vec<Regard>,
) {
    let turn = is_turn(params, layout, robot, view);
    let to = if turn { layout.set_points[robot] } else { layout.filling.outside[robot] };
    let way = (to - view.position).norm();
    let min_separation = params.model.min_separation;
    let parks = params.mpc.reference == Reference::Route
        && turn
        && way < 0.5 * min_separation
        && layout.is_tight(robot, min_separation);
    let gives_way = way < params.give_way.radius || memory.is_out_of_patience(&params.vodca);
    regards.clear();
    for (other, neighbour) in view.neighbours.iter().enumerate() {
        let regard = match neighbour.present {
            _ if other == robot => Regard::Plan,
            Some((_, from)) if parks => {
                // Only whom those who stand shut in together, or who is in its place.
                let owed = layout.owed(min_separation, robot, other);
                let in_place = (from - to).norm() < owed && (neighbour.set_point - from).norm() > way;
                let seen = View { position: from, ..*view };
                standing.look(params, layout, other, &seen);
                if in_place || standing.shuts_in(&layout.routes[other], from, neighbour.set_point) {
                    Regard::Wish
                } else {
                    Regard::Stays
                }
            }
            Some((_, from)) if gives_way && (neighbour.set_point - from).norm() > way => {
                if params.mpc.reference == Reference::Route && layout.filling.waits(other, robot) && turn {
                    Regard::Plan
                } else {
                    Regard::Wish
                }
            }
            _ => Regard::Plan,
        };
        regards.push(regard);
    }
}
