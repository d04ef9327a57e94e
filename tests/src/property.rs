//! Properties of the integral: what relates the form factors of a few lights, whatever they are.

use crate::lobe::{Judge, Lobe, Seen};
use crate::{Cases, Comparison, Level, TestEngine};
use arealight::{Effects, Horizon, LightTable};
use arealight_engine::EvalPoint;
use std::cell::OnceCell;

/// Groups of shading points whose form factors are related in one way.
pub struct Property<'a> {
    what: String,
    size: usize,
    lobes: Effects,
    table: Option<&'a LightTable>,
    given: Cases,
    /// Of lobes clipped once, and twice: made when they are first asked for.
    judges: [OnceCell<Vec<Judge>>; 2],
}

impl<'a> Property<'a> {
    /// A property of groups of one size. `table` for points that are glossy, else they are Lambert's.
    pub fn new(what: &str, table: Option<&'a LightTable>, groups: &[Vec<EvalPoint>]) -> Self {
        let size = groups.first().map_or(0, Vec::len);
        assert!(size > 0 && groups.iter().all(|group| group.len() == size), "{what}: groups of one size");
        let points: Vec<EvalPoint> = groups.iter().flatten().cloned().collect();
        let given = Cases::new(&points);
        let lobes = if table.is_some() { Effects::GLOSSY } else { Effects::DIFFUSE };
        Self { what: what.into(), size, lobes, table, given, judges: [OnceCell::new(), OnceCell::new()] }
    }

    /// The cases, to be changed before they are run.
    pub fn given(&mut self) -> &mut Cases {
        &mut self.given
    }

    /// Each group's form factors by a level, with the sum of their bounds.
    pub fn groups(&self, engine: &TestEngine, level: Level) -> Vec<(Vec<f64>, f64)> {
        let factors = engine.factors(&self.given, self.lobes, level);
        let groups = self.judges(level).chunks_exact(self.size);
        let bounds = groups.map(|group| group.iter().map(Judge::bound).sum());
        factors.chunks_exact(self.size).map(<[f64]>::to_vec).zip(bounds).collect()
    }

    fn judges(&self, level: Level) -> &[Judge] {
        // Lambert's lobe has one horizon
        let horizon = if self.table.is_some() { level.quality.horizon } else { Horizon::Cosine };
        let judge = |case| {
            let surface = &self.given.cases[case];
            let lobe =
                self.table.map_or_else(|| Lobe::lambert(surface), |table| Lobe::glossy(table, surface));
            Seen::new(&self.given, case, lobe, horizon).judge()
        };
        let judges = || (0..self.given.cases.len()).map(judge).collect();
        self.judges[usize::from(horizon == Horizon::Both)].get_or_init(judges)
    }

    /// What the lobe of each group's first point reflects of a light that is everywhere.
    pub fn wholes(&self, level: Level) -> Vec<f64> {
        self.judges(level).chunks_exact(self.size).map(|group| group[0].whole()).collect()
    }

    /// The gain of the lobe of each group's first point.
    pub fn gains(&self, level: Level) -> Vec<f64> {
        self.judges(level).chunks_exact(self.size).map(|group| group[0].gain).collect()
    }

    /// Asserts for every level and group that both sides of `relation` are the same, but for the bounds of
    /// the group's form factors.
    pub fn assert(&self, engine: &TestEngine, levels: &[Level], relation: impl Fn(&[f64]) -> [f64; 2]) {
        for &level in levels {
            let mut comparison = Comparison::new(format!("{}, {level}", self.what));
            for (index, (factors, bound)) in self.groups(engine, level).iter().enumerate() {
                let [actual, expected] = relation(factors);
                comparison.add(actual, expected, *bound, || format!("group {index}: {factors:?}"));
            }
            comparison.assert_all();
        }
    }

    /// The twin of [`Property::assert`]: a relation that does not hold is noticed in more than this part of
    /// the groups.
    pub fn assert_fails(
        &self,
        engine: &TestEngine,
        level: Level,
        part: f64,
        relation: impl Fn(&[f64]) -> [f64; 2],
    ) {
        let groups = self.groups(engine, level);
        let failing = groups.iter().filter(|(factors, bound)| {
            let [actual, expected] = relation(factors);
            (actual - expected).abs() > *bound
        });
        let (failing, count) = (failing.count(), groups.len());
        assert!(failing as f64 > part * count as f64, "{}: {failing} of {count} noticed", self.what);
    }
}
