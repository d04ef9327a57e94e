//! Modelled frames for people.

use super::{Costs, Counts, FrameCost, LOBES, LobePaths, Paths, Wave};
use crate::compiled::Compiled;
use crate::table::Table;

/// The paths of a scene's picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Modelled {
    /// The scene's name.
    pub name: String,
    /// How many polygon lights are no quads, and so are left out.
    pub left_out: usize,
    /// For each [`Wave`], of 32 and of 64.
    pub counts: [Counts; 2],
}

/// The tables for a terminal.
pub fn text(scenes: &[Modelled], found: &Compiled, size: [u32; 2]) -> String {
    sections(scenes, found, size)
        .iter()
        .map(|(head, table)| format!("{head}\n{}\n", table.to_text()))
        .collect::<Vec<_>>()
        .concat()
}

/// The tables as Markdown.
pub fn markdown(scenes: &[Modelled], found: &Compiled, size: [u32; 2]) -> String {
    let sections = sections(scenes, found, size);
    sections
        .iter()
        .map(|(head, table)| format!("{head}\n\n{}\n", table.to_markdown()))
        .collect::<Vec<_>>()
        .concat()
}

/// Each table with the sentence before it.
fn sections(scenes: &[Modelled], found: &Compiled, [width, height]: [u32; 2]) -> Vec<(String, Table)> {
    let head = format!(
        "Shares of waves of 8 x 4 pixels a light, in pictures of {width} x {height}; of waves with a \
        surface, and of quads alone:"
    );
    let mut sections = vec![(head, shares(scenes))];
    for family in &found.families {
        let Some(costs) = Costs::new(family) else { continue };
        let name = &family.family;
        sections.push((format!("{name}, {}: inverse throughput of a path", family.driver), paths(&costs)));
        sections.push((
            format!("{name}: a pixel, modelled, and its ratio to the clipless method's"),
            frames(scenes, &costs),
        ));
    }
    sections
}

const LOBE_NAMES: [&str; LOBES] = ["diffuse", "specular"];

/// A column a scene.
fn shares(scenes: &[Modelled]) -> Table {
    let heads = [String::new()].into_iter().chain(scenes.iter().map(|scene| {
        let counts = &scene.counts[0];
        format!("{}: {} quads ({} others left out)", scene.name, counts.quads, scene.left_out)
    }));
    let row = |name: String, is_such: &dyn Fn(Paths) -> bool| {
        let share = |scene: &Modelled| format!("{:.3}", scene.counts[0].share(is_such));
        [name].into_iter().chain(scenes.iter().map(share)).collect()
    };
    let mut rows = vec![
        row("behind, in all invocations".to_owned(), &|paths| !paths.has(Paths::IN_FRONT)),
        row("some in front, some behind".to_owned(), &|paths| {
            paths.has(Paths::IN_FRONT) && paths.has(Paths::BEHIND)
        }),
    ];
    for (lobe, name) in LOBE_NAMES.into_iter().enumerate() {
        let of_edges = |paths: LobePaths, edges: LobePaths| {
            !paths.crosses() && (paths == edges || paths == edges.and(LobePaths::BELOW))
        };
        let (acute, not_acute) = (LobePaths::ACUTE, LobePaths::NOT_ACUTE);
        let kinds: [(&str, &dyn Fn(LobePaths) -> bool); 8] = [
            ("below alone", &|paths| paths == LobePaths::BELOW),
            ("above alone, or with below: acute", &|paths| of_edges(paths, acute)),
            ("not acute", &|paths| of_edges(paths, not_acute)),
            ("some acute", &|paths| of_edges(paths, acute.and(not_acute))),
            ("above and crossing", &|paths| paths.is_above() && paths.crosses()),
            ("crossing alone, at most 1 above", &|paths| !paths.is_above() && paths.most_above() == Some(1)),
            ("at most 2", &|paths| !paths.is_above() && paths.most_above() == Some(2)),
            ("3", &|paths| !paths.is_above() && paths.most_above() == Some(3)),
        ];
        for (kind, is_such) in kinds {
            let of_lobe = |paths: Paths| paths.has(Paths::IN_FRONT) && is_such(paths.lobe(lobe));
            rows.push(row(format!("{name}: {kind}"), &of_lobe));
        }
    }
    Table { heads: heads.collect(), rows }
}

/// What each path costs.
fn paths(costs: &Costs) -> Table {
    let (ours, clipless) = (&costs.exact, &costs.clipless);
    let both = |name: &str, ours: f64, other: f64| {
        vec![name.to_owned(), format!("{ours:.0}"), format!("{other:.0}")]
    };
    let mut rows = vec![
        both("a pixel without lights", ours.pixel, clipless.pixel),
        both("a light, behind", ours.behind, clipless.behind),
        both("in front; of ours the transforms and first test alone", ours.in_front, clipless.in_front),
    ];
    let all_acute = ours.in_front + costs.lobes.iter().map(|lobe| lobe.above[0]).sum::<f64>();
    rows.push(both("both lobes above and acute", all_acute, clipless.in_front));
    for (name, lobe) in LOBE_NAMES.into_iter().zip(&costs.lobes) {
        let [acute, not_acute, mixed] = lobe.above;
        let [one, two, three] = lobe.crossing;
        let more = [
            ("below", lobe.below),
            ("above, acute", acute),
            ("not acute", not_acute),
            ("some acute", mixed),
            ("crossing with 1 above", one),
            ("with 2", two),
            ("with 3", three),
        ];
        for (path, cost) in more {
            rows.push(vec![format!("+ {name}: {path}"), format!("{cost:.0}"), String::new()]);
        }
    }
    Table::new(" | ours | clipless", rows)
}

/// A row a scene and a size of wave, and one of all scenes.
fn frames(scenes: &[Modelled], costs: &Costs) -> Table {
    let heads = " | ours | clipless | clipless, straight | ratio | ratio to straight";
    let mut rows = vec![];
    for (wave, name) in [Wave::Of32, Wave::Of64].into_iter().zip(["8 x 4", "8 x 8"]) {
        let mut sum = [0.0; 3];
        for scene in scenes {
            let counts = &scene.counts[wave as usize];
            let cost = FrameCost::new(counts, costs).all();
            (0..3).for_each(|at| sum[at] += cost[at] * counts.waves as f64);
            rows.push(cells(format!("{}, waves of {name}", scene.name), cost));
        }
        let waves: u64 = scenes.iter().map(|scene| scene.counts[wave as usize].waves).sum();
        rows.push(cells(format!("all, waves of {name}"), sum.map(|sum| sum / waves.max(1) as f64)));
    }
    Table::new(heads, rows)
}

fn cells(name: String, cost: [f64; 3]) -> Vec<String> {
    let [ours, clipless, straight] = cost;
    let ratios = [ours / clipless, ours / straight];
    let numbers = cost.iter().map(|cost| format!("{cost:.0}"));
    [name].into_iter().chain(numbers).chain(ratios.iter().map(|ratio| format!("{ratio:.2}"))).collect()
}
