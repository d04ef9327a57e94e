//! Cases of disks, spheres and cylinders.

use super::{Arguments, Method, answer_in_parallel};
use crate::failure::Failure;
use crate::gpu;
use arealight::Quality;
use arealight_oracle::answers::Answer;
use arealight_oracle::cases::{Case, CaseShape, ShapeCase};
use arealight_oracle::shading::shape_ltc_on;

/// Whether a case's light is no polygon.
pub fn is_shape(case: &Case) -> bool {
    !matches!(case.light.shape, CaseShape::Polygon { .. })
}

/// Whether a method answers a case of a shape.
pub fn is_answered(case: &Case, method: Method) -> bool {
    method != Method::Truth && case.supported_shape().is_ok()
}

/// One answer for each of the cases of shapes, in their order: the radiance, or why there is none.
pub fn answer_all(cases: &[Case], quality: Quality, arguments: &Arguments) -> Result<Vec<Answer>, Failure> {
    let shapes: Vec<&Case> = cases.iter().filter(|case| is_shape(case)).collect();
    if arguments.on == Method::Truth {
        let reason = |case: &&Case| format!("light.type \"{}\": no cubature yet", case.light.shape.name());
        return Ok(shapes.iter().map(|case| Answer::none(&case.name, reason(case))).collect());
    }
    // Set aside what is not supported
    let supported: Vec<_> = shapes.iter().map(|case| case.supported_shape()).collect();
    let answerable: Vec<ShapeCase> = supported.iter().filter_map(|case| case.clone().ok()).collect();
    let table = arguments.quality.table()?;
    let answered = if arguments.on == Method::Gpu {
        let device = arguments.device.as_deref();
        gpu::eval_shapes::answer(&answerable, quality, &table, device, &arguments.cases)?
    } else {
        answer_in_parallel(&answerable, |case| {
            let ShapeCase { name, surface, normal, view, light } = case;
            Answer::new(name, shape_ltc_on(quality, &table, surface, *normal, *view, light))
        })
    };
    // Put the answers in between
    let mut answered = answered.into_iter();
    let answer = |(case, supported): (&&Case, &Result<_, _>)| match supported {
        Ok(_) => answered.next().unwrap_or_else(|| Answer::none(&case.name, "no answer was given")),
        Err(unsupported) => Answer::none(&case.name, format!("{unsupported}")),
    };
    Ok(shapes.iter().zip(&supported).map(answer).collect())
}
