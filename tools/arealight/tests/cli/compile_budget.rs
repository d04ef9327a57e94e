//! What it takes a driver to compile the pipelines of a scene: the whole command, as a user runs it, on a
//! picture of next to no pixels. The driver is the one that the loader finds, so that a second one is held to
//! the same by `VK_ICD_FILENAMES`. Time is in units of work of a compiler's kind, done by this process before
//! and after, so that a slow or busy machine changes nothing.

use crate::common::{device, scene};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Of a kind of light, with its shadows: processor time, in units of [`yardstick`], which varies by an
/// eighth. A second driver takes up to 16.
const UNITS: f64 = 20.0;
/// Of the process at its largest, in MB. About 170 of them are a driver without any pipeline.
const MEGABYTES: f64 = 500.0;

/// What a process has used.
#[derive(Debug, Clone, Copy, Default)]
struct Used {
    seconds: f64,
    megabytes: f64,
}

/// What a process that runs has used so far; `None` where it does not.
fn used(process: u32) -> Option<Used> {
    // After the name in parentheses: user and system time are the 12th and the 13th field, in hundredths of a
    // second
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |field: usize| fields.get(field)?.parse::<f64>().ok();
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let most = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = most.split_whitespace().next()?.parse().ok()?;
    Some(Used { seconds: (ticks(11)? + ticks(12)?) / 100.0, megabytes: kilobytes / 1e3 })
}

/// Processor time, in seconds, of work as a compiler's: small allocations, in maps that caches hold. In
/// larger maps it varies by a third on a shared machine, and a compiler's time does not.
fn yardstick() -> f64 {
    let began = used(std::process::id()).expect("this process runs").seconds;
    let mut name = 1_u64;
    for _ in 0..200 {
        let mut users: BTreeMap<u64, Vec<u64>> = BTreeMap::new();
        for value in 0..20_000 {
            name = name.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            users.entry(name >> 51).or_default().push(value);
        }
        let sum: u64 = users.values().map(|values| values.iter().sum::<u64>()).sum();
        assert_eq!(sum, 20_000 * 19_999 / 2);
    }
    used(std::process::id()).expect("this process runs").seconds - began
}

/// Renders a few pixels of a scene, and says what that took.
fn render(name: &str) -> Used {
    let picture = Path::new(env!("CARGO_TARGET_TMPDIR")).join("compile-budget.png");
    let mut child = Command::new(env!("CARGO_BIN_EXE_arealight"))
        .args(["render", &scene(name), "--size", "16x16", "--supersample", "1", "-o"])
        .arg(picture)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the command runs");
    let mut last = Used::default();
    loop {
        last = used(child.id()).unwrap_or(last);
        if let Some(status) = child.try_wait().expect("the command is ours") {
            assert!(status.success(), "{name}: {status}");
            return last;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn pipelines_of_every_kind_of_light_compile_within_a_budget() {
    let Some(()) = device() else { return };
    let mut unit = yardstick();
    for (scene, kinds) in [
        ("sweep.glb", 1.0),     // quads
        ("room.glb", 1.0),      // concave polygons and polygons of many corners
        ("screen.glb", 1.0),    // images
        ("shapes.glb", 3.0),    // disks, spheres and tubes
        ("materials.glb", 1.0), // coats, sheen, two roughnesses
    ] {
        let Used { seconds, megabytes } = render(scene);
        let before = std::mem::replace(&mut unit, yardstick());
        let units = seconds / before.max(unit);
        println!("{scene}: {seconds:.1} s, {units:.1} units, {megabytes:.0} MB");
        assert!(units > 0.0 && units < kinds * UNITS, "{scene}: {units} units of processor time");
        assert!(megabytes > 0.0 && megabytes < MEGABYTES, "{scene}: {megabytes} MB");
    }
}
