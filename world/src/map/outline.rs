//! The outlines of occupied regions, exactly on cell borders.

use super::Grid;

/// A point between cells, in cells from the left lower corner of the grid.
pub(super) type Point = (i64, i64);
/// A closed chain of points with the solid on its left.
pub(super) type Ring = Vec<Point>;

/// Steps along +x, +y, -x, -y: each a left turn from the one before.
const STEPS: [Point; 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// The occupied regions (cells joined over their sides), each with its outline and the rims of its holes, in
/// the order of their lowest rows, then columns.
pub(super) fn regions(grid: &Grid) -> Vec<Vec<Ring>> {
    let (count, region) = labels(grid);
    let mut found = vec![Vec::new(); count];
    let (width, height) = (grid.width as i64, grid.height as i64);
    // By point: which of the four steps from it lie on a border, the solid on their left.
    let mut steps = vec![0u8; (grid.width + 1) * (grid.height + 1)];
    let index = |(x, y): Point| y as usize * (grid.width + 1) + x as usize;
    for y in 0..=height {
        for x in 0..=width {
            for (direction, step) in STEPS.iter().enumerate() {
                let [left, right] = beside((x, y), *step);
                if grid.is_occupied(left.0, left.1) && !grid.is_occupied(right.0, right.1) {
                    steps[index((x, y))] |= 1 << direction;
                }
            }
        }
    }
    let mut open = steps.clone();
    for y in 0..=height {
        for x in 0..=width {
            while open[index((x, y))] != 0 {
                let first = open[index((x, y))].trailing_zeros() as usize;
                let cell = beside((x, y), STEPS[first])[0];
                let mut ring = Vec::new();
                let (mut point, mut direction, mut last) = ((x, y), first, 4);
                while open[index(point)] & (1 << direction) != 0 {
                    open[index(point)] &= !(1 << direction);
                    if direction != last {
                        ring.push(point);
                    }
                    last = direction;
                    point = (point.0 + STEPS[direction].0, point.1 + STEPS[direction].1);
                    // Where two cells meet in a corner, left keeps to the same cell.
                    let turns = [(last + 1) % 4, last, (last + 3) % 4];
                    let on = turns.into_iter().find(|turn| steps[index(point)] & (1 << turn) != 0);
                    direction = on.unwrap_or(last);
                }
                if let Some(label) = region[cell.1 as usize * grid.width + cell.0 as usize] {
                    found[label].push(ring);
                }
            }
        }
    }
    found
}

/// The cells to the left and to the right of a step from a point.
fn beside((x, y): Point, step: Point) -> [Point; 2] {
    match step {
        (1, 0) => [(x, y), (x, y - 1)],
        (0, 1) => [(x - 1, y), (x, y)],
        (-1, 0) => [(x - 1, y - 1), (x - 1, y)],
        _ => [(x, y - 1), (x - 1, y - 1)],
    }
}

/// How many regions there are, and by cell the one that it belongs to.
fn labels(grid: &Grid) -> (usize, Vec<Option<usize>>) {
    let mut label = vec![None; grid.occupied.len()];
    let mut count = 0;
    let mut open = Vec::new();
    for cell in 0..label.len() {
        if !grid.occupied[cell] || label[cell].is_some() {
            continue;
        }
        label[cell] = Some(count);
        open.push(cell);
        while let Some(cell) = open.pop() {
            let (x, y) = ((cell % grid.width) as i64, (cell / grid.width) as i64);
            for (dx, dy) in STEPS {
                if grid.is_occupied(x + dx, y + dy) {
                    let beside = (y + dy) as usize * grid.width + (x + dx) as usize;
                    if label[beside].is_none() {
                        label[beside] = Some(count);
                        open.push(beside);
                    }
                }
            }
        }
        count += 1;
    }
    (count, label)
}
