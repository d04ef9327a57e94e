//! Memory follows the file: what a scene takes is asked for before it is reserved.

use std::cell::Cell;

/// What a file may take whatever it holds, in bytes: a small file of 16 million texels is in order.
const FREE: u64 = 256 << 20;

/// What it may take beyond for each of its bytes. Well compressed triangles take 200.
const PER_BYTE: u64 = 256;

/// What files that hold `read` bytes may take, in bytes, where nobody says another limit.
pub fn memory_of(read: u64) -> u64 {
    FREE.saturating_add(read.saturating_mul(PER_BYTE))
}

/// What a scene has taken so far.
#[derive(Debug, Default)]
pub(crate) struct Budget {
    limit: Option<u64>,
    read: Cell<u64>,
    taken: Cell<u64>,
}

impl Budget {
    /// One of `limit` bytes, or else of what the files that are read hold.
    pub fn new(limit: Option<u64>) -> Self {
        Self { limit, ..Self::default() }
    }

    /// Notes a file's bytes.
    pub fn read(&self, bytes: usize) {
        self.read.set(self.read.get().saturating_add(bytes as u64));
    }

    /// How much may be taken in all.
    pub fn limit(&self) -> u64 {
        self.limit.unwrap_or_else(|| memory_of(self.read.get()))
    }

    /// How much may be taken still.
    pub fn left(&self) -> u64 {
        self.limit().saturating_sub(self.taken.get())
    }

    /// Takes bytes, if there are so many.
    pub fn take(&self, bytes: u64) -> bool {
        let enough = bytes <= self.left();
        if enough {
            self.taken.set(self.taken.get() + bytes);
        }
        enough
    }

    /// Gives bytes back that were taken.
    pub fn give(&self, bytes: u64) {
        self.taken.set(self.taken.get().saturating_sub(bytes));
    }
}
