//! Animations at one time: where nodes are then, and how far meshes are morphed.

use crate::accessor;
use crate::document::Document;
use crate::error::SceneError;
use crate::messages::Messages;
use crate::numbers::Place;
use glam::{DAffine3, DMat4, DQuat};
use gltf::json::animation::{Animation, Channel, Interpolation, Property};
use gltf::json::validation::Checked::Valid;
use std::collections::HashSet;

/// The keys of a sampler.
struct Keys {
    /// Seconds, in ascending order.
    times: Vec<f32>,
    /// `width` numbers a value; of a cubic spline three values a key, the second of them the key's.
    values: Vec<f32>,
    width: usize,
    interpolation: Interpolation,
}

/// Moves the document's nodes to where its animations have them at a time, in seconds; before their first key
/// and after their last one nothing moves. Where several animations move the same, the first does.
pub(crate) fn apply(document: &mut Document, time: f64, messages: &mut Messages) -> Result<(), SceneError> {
    let (mut moved, mut others) = (HashSet::new(), 0);
    let animations = std::mem::take(&mut document.root.animations);
    for (index, animation) in animations.iter().enumerate() {
        for (number, channel) in animation.channels.iter().enumerate() {
            let node = channel.target.node.value();
            let Valid(path) = channel.target.path else { continue };
            if !moved.insert((node, path as u8)) {
                others += 1;
                continue;
            }
            let field = format!("animations[{index}].channels[{number}]");
            let keys = Keys::read(document, animation, channel, (path, node), &field)?;
            // An animation of nothing moves nothing
            let Some(value) = keys.at(time, path == Property::Rotation) else { continue };
            let (place, numbers) = (&mut document.places[node], |i: usize| value[i]);
            if path != Property::MorphTargetWeights {
                in_parts(place);
            }
            match path {
                Property::Translation => place.translation = Some(std::array::from_fn(numbers)),
                Property::Rotation => place.rotation = Some(std::array::from_fn(numbers)),
                Property::Scale => place.scale = Some(std::array::from_fn(numbers)),
                Property::MorphTargetWeights => place.weights = Some(value),
            }
        }
    }
    if others > 0 {
        let text = format!("{others} channels move what an earlier animation moves: left out");
        messages.note("animations", text);
    }
    Ok(())
}

/// What moves a part of a node's place needs the others beside it, not a matrix.
fn in_parts(place: &mut Place) {
    if let Some(matrix) = place.matrix.take() {
        let whole = DAffine3::from_mat4(DMat4::from_cols_array(&matrix));
        let (scale, rotation, translation) = whole.to_scale_rotation_translation();
        place.scale = Some(scale.to_array());
        place.rotation = Some(rotation.to_array());
        place.translation = Some(translation.to_array());
    }
}

impl Keys {
    fn read(
        document: &Document,
        animation: &Animation,
        channel: &Channel,
        (path, node): (Property, usize),
        field: &str,
    ) -> Result<Self, SceneError> {
        let invalid = |problem: &str| document.invalid(field, problem);
        let sampler = animation.samplers.get(channel.sampler.value());
        let sampler = sampler.ok_or_else(|| invalid("its sampler does not exist"))?;
        let Valid(interpolation) = sampler.interpolation else {
            return Err(invalid("its interpolation is unknown"));
        };
        if node >= document.places.len() {
            return Err(invalid("its node does not exist"));
        }
        let times = accessor::floats::<1>(document, sampler.input.value(), field)?.concat();
        if times.windows(2).any(|pair| pair[1] <= pair[0]) {
            return Err(invalid("its times do not ascend"));
        }
        let output = sampler.output.value();
        let values = match path {
            Property::Rotation => accessor::floats::<4>(document, output, field)?.concat(),
            Property::MorphTargetWeights => accessor::floats::<1>(document, output, field)?.concat(),
            _ => accessor::floats::<3>(document, output, field)?.concat(),
        };
        // As many values as keys, of some numbers each
        let count = times.len() * if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let width = match path {
            Property::Rotation => 4,
            Property::MorphTargetWeights => values.len() / count.max(1),
            _ => 3,
        };
        if values.len() != count * width {
            let problem = format!("{} numbers for {} times", values.len(), times.len());
            return Err(invalid(&problem));
        }
        Ok(Self { times, values, width, interpolation })
    }

    /// The value at a time; none where there is no key.
    fn at(&self, time: f64, is_rotation: bool) -> Option<Vec<f64>> {
        let is_cubic = self.interpolation == Interpolation::CubicSpline;
        let value = |key: usize, part: usize| -> Vec<f64> {
            let row = if is_cubic { 3 * key + part } else { key };
            self.values[row * self.width..][..self.width].iter().map(|number| f64::from(*number)).collect()
        };
        let last = self.times.len().checked_sub(1)?;
        let next = self.times.partition_point(|key| f64::from(*key) <= time);
        if next == 0 || next > last || self.interpolation == Interpolation::Step {
            return Some(value(next.saturating_sub(1).min(last), 1));
        }
        let [from, to] = [next - 1, next].map(|key| f64::from(self.times[key]));
        let (length, part) = (to - from, (time - from) / (to - from));
        let (a, b) = (value(next - 1, 1), value(next, 1));
        if is_rotation && !is_cubic {
            let [a, b] =
                [&a, &b].map(|value| DQuat::from_array(std::array::from_fn(|i| value[i])).normalize());
            return Some(a.slerp(b, part).to_array().to_vec());
        }
        if !is_cubic {
            return Some(a.iter().zip(&b).map(|(a, b)| a + (b - a) * part).collect());
        }
        // Hermite's polynomials, of values and of slopes over the whole length (glTF 2.0, appendix C)
        let (square, cube) = (part * part, part * part * part);
        let (out, into) = (value(next - 1, 2), value(next, 0));
        let weights = [
            2.0 * cube - 3.0 * square + 1.0,
            length * (cube - 2.0 * square + part),
            3.0 * square - 2.0 * cube,
            length * (cube - square),
        ];
        let sum =
            |i: usize| weights[0] * a[i] + weights[1] * out[i] + weights[2] * b[i] + weights[3] * into[i];
        Some((0..self.width).map(sum).collect())
    }
}
