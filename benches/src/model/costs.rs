//! What each path through a light costs a wave, by the compiler's inverse throughput of straight code.

use super::LOBES;
use crate::compiled::{Family, Row, path_cost};

static PATH_COST: &[u8] = include_bytes!("../../spirv/path_cost.spv");

/// How often the compiler counts what is in a loop.
const LOOP: f64 = 8.0;

const EXACT: &str = "exact";
const CLIPLESS: &str = "clipless";

/// The paths of a lobe: the values of DIFFUSE and SPECULAR in `benches/kernels/path_cost.comp`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Path {
    Tested = 0,
    Below = 1,
    Acute = 2,
    NotAcute = 3,
    Mixed = 4,
    Crossing1 = 5,
    Crossing2 = 6,
    Crossing3 = 7,
}

/// Each but that of a quad above with acute edges with the name of its row, by lobe: the other lobe is that,
/// as it mostly is.
const PATHS: [(Path, [&str; LOBES]); 7] = [
    (Path::Tested, ["diffuse tested", "specular tested"]),
    (Path::Below, ["diffuse below", "specular below"]),
    (Path::NotAcute, ["diffuse above, not acute", "specular above, not acute"]),
    (Path::Mixed, ["diffuse above, some acute", "specular above, some acute"]),
    (Path::Crossing1, ["diffuse crossing, 1 above", "specular crossing, 1 above"]),
    (Path::Crossing2, ["diffuse crossing, 2 above", "specular crossing, 2 above"]),
    (Path::Crossing3, ["diffuse crossing, 3 above", "specular crossing, 3 above"]),
];

/// Behind a light, or in front of it with both lobes above and acute: the name of the row in a loop, and of
/// that of one light.
const BEHIND: [&str; 2] = ["behind", "behind, one light"];
const IN_FRONT: [&str; 2] = ["in front", "in front, one light"];

/// The rows that a model is made of.
pub fn rows() -> Vec<Row> {
    let mut rows = vec![];
    let acute = Path::Acute as u32;
    for (method, name) in [(0, EXACT), (1, CLIPLESS)] {
        for (in_front, names) in [(0, BEHIND), (1, IN_FRONT)] {
            for (level, loops) in names.into_iter().zip([1, 0]) {
                rows.push(row(name, level, [method, in_front, acute, acute, loops]));
            }
        }
    }
    for (path, names) in PATHS {
        rows.push(row(EXACT, names[0], [0, 1, path as u32, acute, 1]));
        rows.push(row(EXACT, names[1], [0, 1, acute, path as u32, 1]));
    }
    rows
}

fn row(method: &'static str, path: &'static str, constants: [u32; 5]) -> Row {
    path_cost(method, path, PATH_COST, (0..).zip(constants).collect())
}

/// What a method costs a wave, whatever its lobes' paths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MethodCosts {
    /// The pixel without lights.
    pub pixel: f64,
    /// A light that every invocation is behind.
    pub behind: f64,
    /// Another light: of the clipless school all of it, of ours without what its lobes' paths add.
    pub in_front: f64,
}

/// What a lobe's path adds to a light, over the test whether the light is above the horizon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LobeCosts {
    /// Below the horizon.
    pub below: f64,
    /// Wholly above it, in all invocations with acute edges, in none, in some.
    pub above: [f64; 3],
    /// Crossing it with one, two and three vertices above.
    pub crossing: [f64; 3],
}

/// Inverse throughput of every path on a family of GPU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Costs {
    /// Ours.
    pub exact: MethodCosts,
    /// The clipless school's.
    pub clipless: MethodCosts,
    /// What our lobes add: diffuse, specular.
    pub lobes: [LobeCosts; LOBES],
}

impl Costs {
    /// From the statistics of [`rows`]; `None` where one is missing.
    pub fn new(family: &Family) -> Option<Self> {
        let throughput = |method: &str, path: &str| {
            let row = family.rows.iter().find(|row| row.lights == method && row.level == path)?;
            row.said.get("Inverse Throughput").map(|throughput| *throughput as f64)
        };
        // In a loop a light counts so often, by itself once
        let light = |method, [all, one]: [&str; 2]| {
            let one = throughput(method, one)?;
            let light = (throughput(method, all)? - one) / (LOOP - 1.0);
            Some((light, one - light))
        };
        let method = |method| {
            let (in_front, pixel) = light(method, IN_FRONT)?;
            Some(MethodCosts { pixel, behind: light(method, BEHIND)?.0, in_front })
        };
        let lobe = |lobe: usize| {
            let of = |wanted: Path| {
                let named = PATHS.iter().find(|(path, _)| *path == wanted);
                throughput(EXACT, named.map_or(IN_FRONT[0], |(_, names)| names[lobe]))
            };
            let tested = of(Path::Tested)?;
            let added = |path: Path| Some((of(path)? - tested) / LOOP);
            Some(LobeCosts {
                below: added(Path::Below)?,
                above: [added(Path::Acute)?, added(Path::NotAcute)?, added(Path::Mixed)?],
                crossing: [added(Path::Crossing1)?, added(Path::Crossing2)?, added(Path::Crossing3)?],
            })
        };
        let lobes = [lobe(0)?, lobe(1)?];
        let mut exact = method(EXACT)?;
        exact.in_front -= lobes.iter().map(|lobe| lobe.above[0]).sum::<f64>();
        Some(Self { exact, clipless: method(CLIPLESS)?, lobes })
    }
}
