//! Any text as a file of shading points: what is supported is answered by a number that is not negative.
#![no_main]

mod memory;

use arealight_cases::cases::read_cases;
use arealight_oracle::shading::ltc;
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

static TABLE: LazyLock<arealight::LightTable> = LazyLock::new(arealight::LightTable::ggx);

fuzz_target!(|text: &str| {
    let Ok(cases) = memory::follows(text.len(), || read_cases(text)) else { return };
    for case in &cases {
        let no_image = |_: &str| Err("there are no files".to_owned());
        let Ok(case) = case.supported(no_image) else { continue };
        if let (Some(light), None) = (case.polygon(), case.medium) {
            let answer = ltc(&TABLE, &case.surface, case.normal, case.view, &light);
            assert!(answer.min_element() >= 0.0, "{case:?}: {answer}");
        }
    }
});
