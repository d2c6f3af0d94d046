//! The replay buffer: transitions by column in a ring of bounded size.

use chacha20::rand_core::Rng;
use vodca::random;

/// One transition, from (s, a) to s'.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition<'a> {
    /// s, scaled as the actor's contract says, `[2N]`.
    pub observation: &'a [f32],
    /// a, the raw tanh value in [-1, 1], `[N]`.
    pub action: &'a [f32],
    /// R, unscaled.
    pub reward: f32,
    /// The episode ended here by itself (a collision): nothing follows s'. A time limit is no end.
    pub terminated: bool,
    /// s', `[2N]`.
    pub next_observation: &'a [f32],
}

/// Bounded memory of transitions; a full one forgets the oldest.
#[derive(Clone, Debug, PartialEq)]
pub struct Replay {
    capacity: usize,
    observations: usize,
    actions: usize,
    /// Where the next row goes when the buffer is full.
    pub(crate) position: usize,
    pub(crate) observation: Vec<f32>,
    pub(crate) action: Vec<f32>,
    pub(crate) reward: Vec<f32>,
    pub(crate) terminated: Vec<bool>,
    pub(crate) truncated: Vec<bool>,
    pub(crate) next_observation: Vec<f32>,
    /// Slots of favoured rows in the order in which they are drawn from.
    favoured: Vec<u32>,
    /// Where each slot stands in `favoured`, or `NOWHERE`.
    place: Vec<u32>,
}

const NOWHERE: u32 = u32::MAX;

/// Rows drawn from a buffer, by column.
#[derive(Clone, Debug)]
pub struct Batch {
    /// s, `[batch, 2N]`.
    pub observation: Vec<f32>,
    /// a, `[batch, N]`.
    pub action: Vec<f32>,
    /// R, unscaled, `[batch]`.
    pub reward: Vec<f32>,
    /// Whether nothing follows s', `[batch]`.
    pub terminated: Vec<bool>,
    /// s', `[batch, 2N]`.
    pub next_observation: Vec<f32>,
}

impl Batch {
    /// Room for `rows`.
    pub fn new(rows: usize, observations: usize, actions: usize) -> Self {
        Self {
            observation: vec![0.0; rows * observations],
            action: vec![0.0; rows * actions],
            reward: vec![0.0; rows],
            terminated: vec![false; rows],
            next_observation: vec![0.0; rows * observations],
        }
    }
}

impl Replay {
    /// An empty buffer for at most `capacity` rows; memory grows with the rows that come.
    pub fn new(capacity: usize, observations: usize, actions: usize) -> Self {
        Self {
            capacity,
            observations,
            actions,
            position: 0,
            observation: Vec::new(),
            action: Vec::new(),
            reward: Vec::new(),
            terminated: Vec::new(),
            truncated: Vec::new(),
            next_observation: Vec::new(),
            favoured: Vec::new(),
            place: Vec::new(),
        }
    }

    /// Rows that are remembered.
    pub fn len(&self) -> usize {
        self.reward.len()
    }

    /// Whether nothing is remembered.
    pub fn is_empty(&self) -> bool {
        self.reward.is_empty()
    }

    /// Rows that are favoured.
    pub fn favoured(&self) -> usize {
        self.favoured.len()
    }

    /// s of every row, in slot order.
    pub fn observations(&self) -> impl ExactSizeIterator<Item = &[f32]> {
        self.observation.chunks_exact(self.observations)
    }

    /// The favoured slots in drawing order.
    pub(crate) fn favoured_slots(&self) -> &[u32] {
        &self.favoured
    }

    /// Remembers one row. `truncated`: a time limit cut the episode here; kept for readers, and s' counts.
    pub fn push(&mut self, row: Transition, truncated: bool) {
        debug_assert_eq!((row.observation.len(), row.action.len()), (self.observations, self.actions));
        debug_assert_eq!(row.next_observation.len(), self.observations);
        if self.len() < self.capacity {
            self.observation.extend_from_slice(row.observation);
            self.action.extend_from_slice(row.action);
            self.reward.push(row.reward);
            self.terminated.push(row.terminated);
            self.truncated.push(truncated);
            self.next_observation.extend_from_slice(row.next_observation);
            self.place.push(NOWHERE);
            return;
        }
        let (slot, s, a) = (self.position, self.observations, self.actions);
        self.forget_favour(slot);
        self.observation[slot * s..(slot + 1) * s].copy_from_slice(row.observation);
        self.action[slot * a..(slot + 1) * a].copy_from_slice(row.action);
        self.reward[slot] = row.reward;
        self.terminated[slot] = row.terminated;
        self.truncated[slot] = truncated;
        self.next_observation[slot * s..(slot + 1) * s].copy_from_slice(row.next_observation);
        self.position = (slot + 1) % self.capacity;
    }

    /// Favours the newest `rows` rows: a share of every batch comes from favoured ones.
    pub fn favour_newest(&mut self, rows: usize) {
        let length = self.len();
        let next = if length < self.capacity { length } else { self.position };
        for back in 1..=rows.min(length) {
            self.favour((next + length - back) % length);
        }
    }

    /// Favours exactly these slots of a buffer whose columns were filled; `None` when one is not there.
    pub(crate) fn set_favoured(&mut self, slots: &[u64]) -> Option<()> {
        self.favoured.clear();
        self.place = vec![NOWHERE; self.len()];
        for slot in slots {
            self.place.get(*slot as usize).filter(|place| **place == NOWHERE)?;
            self.favour(*slot as usize);
        }
        Some(())
    }

    fn favour(&mut self, slot: usize) {
        if self.place[slot] == NOWHERE {
            self.place[slot] = self.favoured.len() as u32;
            self.favoured.push(slot as u32);
        }
    }

    fn forget_favour(&mut self, slot: usize) {
        let place = std::mem::replace(&mut self.place[slot], NOWHERE);
        if place != NOWHERE {
            self.favoured.swap_remove(place as usize);
            if let Some(moved) = self.favoured.get(place as usize) {
                self.place[*moved as usize] = place;
            }
        }
    }

    /// Draws rows uniformly with replacement into `batch`; the first `share` of them from favoured
    /// rows when there are any. The buffer must not be empty.
    pub fn draw(&self, generator: &mut impl Rng, share: f64, batch: &mut Batch) {
        let rows = batch.reward.len();
        let special = if self.favoured.is_empty() { 0 } else { (share * rows as f64).round() as usize };
        let (s, a) = (self.observations, self.actions);
        for row in 0..rows {
            let slot = if row < special {
                self.favoured[random::below(generator, self.favoured.len() as u64) as usize] as usize
            } else {
                random::below(generator, self.len() as u64) as usize
            };
            let copy = |to: &mut [f32], from: &[f32], width: usize| {
                to[row * width..(row + 1) * width].copy_from_slice(&from[slot * width..(slot + 1) * width]);
            };
            copy(&mut batch.observation, &self.observation, s);
            copy(&mut batch.action, &self.action, a);
            copy(&mut batch.next_observation, &self.next_observation, s);
            batch.reward[row] = self.reward[slot];
            batch.terminated[row] = self.terminated[slot];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vodca::random::{Use, stream};

    fn row(buffer: &mut Replay, number: usize) {
        let (x, y) = ([number as f32, 0.5], [number as f32 + 1.0, 0.5]);
        let transition = Transition {
            observation: &x,
            action: &[0.25],
            reward: number as f32,
            terminated: number == 3,
            next_observation: &y,
        };
        buffer.push(transition, number == 4);
    }

    #[test]
    fn a_full_buffer_forgets_the_oldest_and_stays_bounded() {
        let mut buffer = Replay::new(5, 2, 1);
        (0..8).for_each(|number| row(&mut buffer, number));
        assert_eq!((buffer.len(), buffer.position), (5, 3));
        assert_eq!(buffer.reward, [5.0, 6.0, 7.0, 3.0, 4.0]);
        assert_eq!(buffer.terminated, [false, false, false, true, false]);
        assert_eq!(buffer.truncated, [false, false, false, false, true]);
        assert_eq!(buffer.observation.len(), 10);
    }

    #[test]
    fn a_batch_is_uniform_over_the_rows_and_keeps_them_together() {
        let mut buffer = Replay::new(10, 2, 1);
        (0..10).for_each(|number| row(&mut buffer, number));
        let mut batch = Batch::new(5000, 2, 1);
        buffer.draw(&mut stream(1, Use::Learning, 0, 0), 0.0, &mut batch);
        let mut count = [0; 10];
        for at in 0..5000 {
            let number = batch.reward[at];
            count[number as usize] += 1;
            assert_eq!((batch.observation[2 * at], batch.next_observation[2 * at]), (number, number + 1.0));
            assert_eq!(batch.terminated[at], number == 3.0);
        }
        // 500 expected each; five standard deviations of a binomial are 106.
        assert!(count.iter().all(|count| (394..=606).contains(count)), "{count:?}");
    }

    #[test]
    fn favoured_rows_fill_their_share_until_they_are_forgotten() {
        let mut buffer = Replay::new(6, 2, 1);
        (0..4).for_each(|number| row(&mut buffer, number));
        buffer.favour_newest(2); // Numbers 2 and 3.
        (4..6).for_each(|number| row(&mut buffer, number));
        let mut batch = Batch::new(100, 2, 1);
        buffer.draw(&mut stream(1, Use::Learning, 0, 0), 0.5, &mut batch);
        assert!(batch.reward[..50].iter().all(|number| [2.0, 3.0].contains(number)));
        assert!(batch.reward[50..].iter().any(|number| *number < 2.0 || *number > 3.0));
        (6..9).for_each(|number| row(&mut buffer, number)); // 0, 1 and 2 are forgotten.
        assert_eq!(buffer.favoured(), 1);
        buffer.draw(&mut stream(1, Use::Learning, 1, 0), 0.5, &mut batch);
        assert!(batch.reward[..50].iter().all(|number| *number == 3.0));
        buffer.favour_newest(1); // Number 8, in the slot of 2.
        row(&mut buffer, 9); // In the slot of 3.
        buffer.draw(&mut stream(1, Use::Learning, 2, 0), 0.5, &mut batch);
        assert!(batch.reward[..50].iter().all(|number| *number == 8.0));
    }
}
