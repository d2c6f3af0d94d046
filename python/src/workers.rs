//! Threads that play many environments at once. The only file that imports `rayon`.

use crate::error::refused;
use pyo3::prelude::*;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// A pool of threads of this process. After a fork the child makes one of its own.
pub(crate) struct Workers {
    threads: usize,
    /// The process that the threads are of; they are not in its children.
    process: u32,
    pool: Option<ThreadPool>,
}

impl Workers {
    /// `threads` of them; 0: one for each core.
    pub(crate) fn new(threads: usize) -> Self {
        Self { threads, process: std::process::id(), pool: None }
    }

    /// `work` for every item and its piece of `numbers`, `width` of them each, on all threads.
    pub(crate) fn each<T: Send, E: Send>(
        &mut self,
        items: &mut [T],
        numbers: &mut [f32],
        width: usize,
        work: impl Fn(&mut T, &mut [f32]) -> Result<(), E> + Sync + Send,
    ) -> PyResult<Result<(), E>> {
        self.forget_those_of_a_parent();
        let pool = match &mut self.pool {
            Some(pool) => pool,
            none => none.insert(ThreadPoolBuilder::new().num_threads(self.threads).build().map_err(refused)?),
        };
        let pairs = items.par_iter_mut().zip(numbers.par_chunks_exact_mut(width));
        Ok(pool.install(|| pairs.map(|(item, numbers)| work(item, numbers)).collect()))
    }

    /// Nobody would answer: threads do not cross a fork.
    fn forget_those_of_a_parent(&mut self) {
        if self.process != std::process::id() {
            std::mem::forget(self.pool.take());
            self.process = std::process::id();
        }
    }
}

impl Drop for Workers {
    fn drop(&mut self) {
        self.forget_those_of_a_parent();
    }
}
