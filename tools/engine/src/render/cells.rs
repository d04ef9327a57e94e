//! Parts of a view side by side, to be shaded alone.

use crate::host::Usage;
use crate::{EngineError, GBuffer, SceneRenderer};
use ash::vk;
use std::rc::Rc;

/// Where rectangles of a view lie that are shaded without the rest: each in a cell, in rows from the top.
#[derive(Debug, Clone, Copy)]
pub struct Cells {
    side: [u32; 2],
    columns: u32,
    rows: u32,
}

/// The most rows of cells, which bounds memory.
const MOST_ROWS: u32 = 2;

impl Cells {
    /// Cells for rectangles of at most `side` pixels to a side, of a view of so many pixels; together they
    /// are no larger than that.
    pub fn new(side: u32, view: [u32; 2]) -> Self {
        let side = view.map(|pixels| side.clamp(1, pixels.max(1)));
        let [columns, rows] = [0, 1].map(|axis| view[axis] / side[axis]);
        Self { side, columns, rows: rows.min(MOST_ROWS) }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        (self.columns * self.rows) as usize
    }

    /// The first pixel of a cell.
    pub fn corner(&self, index: usize) -> [u32; 2] {
        let index = index as u32;
        [index % self.columns * self.side[0], index / self.columns * self.side[1]]
    }

    /// The pixels of the first rows of cells that hold so many.
    pub fn size(&self, count: usize) -> [u32; 2] {
        [self.columns * self.side[0], (count as u32).div_ceil(self.columns) * self.side[1]]
    }
}

impl SceneRenderer<'_> {
    /// A view of rectangles of this one, each a corner and a size that fit a cell; its picture is undefined.
    ///
    /// # Errors
    /// [`EngineError`] says why the device fails.
    pub fn cells(&self, cells: Cells, rectangles: &[[[u32; 2]; 2]]) -> Result<Self, EngineError> {
        let part = Self {
            size: cells.size(rectangles.len()),
            g_buffer: GBuffer::new(self.engine, cells.size(rectangles.len()))?,
            geometry: Rc::clone(&self.geometry),
            light_buffers: Rc::clone(&self.light_buffers),
            sampling: self.sampling.clone(),
            ..*self
        };
        let copies: Vec<_> = (0..)
            .zip(rectangles)
            .map(|(index, [corner, size])| [*corner, cells.corner(index), *size])
            .collect();
        self.engine.host().submit(|commands: vk::CommandBuffer| {
            for (whole, part) in self.g_buffer.surfaces().zip(part.g_buffer.surfaces()) {
                part.transition(commands, Usage::UNDEFINED, Usage::COPY_DESTINATION);
                if whole.extent() == self.size {
                    whole.transition(commands, Usage::COMPUTE_READ, Usage::COPY_SOURCE);
                    part.record_clear(commands);
                    part.transition(commands, Usage::COPY_DESTINATION, Usage::COPY_DESTINATION);
                    part.record_copies(commands, whole, &copies);
                    whole.transition(commands, Usage::COPY_SOURCE, Usage::COMPUTE_READ);
                }
                part.transition(commands, Usage::COPY_DESTINATION, Usage::COMPUTE_READ);
            }
        })?;
        Ok(part)
    }
}
