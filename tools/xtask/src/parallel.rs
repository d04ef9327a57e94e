//! Work on every item of a list, on as many threads as there are processors.

use crate::TaskError;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What `work` makes of each item and its index, in the items' order. A panic of one is a panic of all.
///
/// # Errors
/// The first error of a thread, which takes no more items.
pub fn in_parallel<T: Send, I: Sync>(
    items: &[I],
    work: impl Fn(usize, &I) -> Result<T, TaskError> + Sync,
) -> Result<Vec<T>, TaskError> {
    let next = AtomicUsize::new(0);
    let worker = || -> Result<Vec<(usize, T)>, TaskError> {
        let mut made = vec![];
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else { return Ok(made) };
            made.push((index, work(index, item)?));
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut made = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(worker)).collect();
        let mut made = vec![];
        for worker in workers {
            made.extend(worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?);
        }
        Ok::<_, TaskError>(made)
    })?;
    made.sort_by_key(|(index, _)| *index);
    Ok(made.into_iter().map(|(_, one)| one).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_runs_once_and_failures_keep_their_order() {
        let found =
            in_parallel(&[(); 50], |index, ()| Ok((index % 7 == 0).then(|| format!("{index}")))).unwrap();
        assert_eq!(found.len(), 50);
        let failures: Vec<String> = found.into_iter().flatten().collect();
        assert_eq!(failures, ["0", "7", "14", "21", "28", "35", "42", "49"]);
    }
}
