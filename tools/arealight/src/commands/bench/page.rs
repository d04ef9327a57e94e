//! The report: one page that needs nothing else. Charts are drawn, pictures are within it, and it has no script.

mod charts;
mod images;

use crate::failure::Failure;
use arealight_benches::ladder::{
    DEFAULT, Ladder, PRACTICE, Picture, Pictures, Row, error_cells, number, percent,
};
use arealight_benches::svg::escape;
use glam::DVec3;
use std::fmt::Write as _;

const STYLE: &str = include_str!("page/style.css");

/// The page.
///
/// # Errors
/// [`Failure::Output`] where a picture cannot be encoded.
pub fn page(found: &Ladder, pictures: &Pictures) -> Result<String, Failure> {
    let mut body = head(found);
    let mut section = |title: &str, says: &str, content: &str| {
        let _ = write!(body, "<h2>{}</h2>\n<p>{says}</p>\n{content}\n", escape(title));
    };
    section("Error against time", &says_pareto(found), &charts::pareto(found));
    section("Whose error it is", &says_parts(found), &charts::parts(found));
    section("What an effect adds", says_effects(), &charts::effects(found));
    section("More lights", &says_growth(found), &charts::growth(&found.scaling.by_lights, "lights"));
    section("More pixels", says_pixels(), &charts::growth(&found.scaling.by_pixels, "pixels"));
    section("What it looks like", &says_pictures(pictures), &show(pictures)?);
    section("All numbers", &says_numbers(found), &tables(found));
    let title = format!("What accuracy costs: {}", found.device);
    Ok(format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n<style>\n{STYLE}</style>\n\
         </head>\n<body>\n{body}</body>\n</html>\n",
        escape(&title)
    ))
}

fn head(found: &Ladder) -> String {
    let clock = if found.software {
        "processor time of all threads over their number"
    } else {
        "GPU time, by timestamps"
    };
    let fact = |value: &str, label: &str| {
        format!("<div><b>{}</b><span>{}</span></div>", escape(value), escape(label))
    };
    let default = find(found, DEFAULT);
    let mut facts = vec![fact(&found.device, "the device")];
    if let Some(row) = default {
        facts.push(fact(&percent(row.errors.all.rmse), "error of the default rung, RMSE over mean"));
        facts.push(fact(
            &format!("{} x", number(row.time.ratio.median)),
            "its time; the practice of engines is 1",
        ));
        if let Some(samples) = row.samples {
            facts.push(fact(&format!("{:.0}", samples.error), "samples of Monte Carlo that err as much"));
        }
    }
    format!(
        "<h1>What accuracy costs in time</h1>\n<p class=\"soft\">Area lights by linearly transformed cosines, rung by rung, on one \
         device. Again: <code>{}</code> ({:.0} s).</p>\n<div class=\"facts\">{}</div>\n<p class=\"soft\">Errors are against the \
         integral of the true BRDF in float64 at {} points, over its mean. Times are of frames of {} pixels under {} lights, every \
         method in turn for {} rounds ({clock}); bars and ranges are quartiles.</p>\n",
        escape(&found.command),
        found.seconds,
        facts.concat(),
        found.points,
        found.pixels,
        found.scaling.lights,
        found.rounds
    )
}

fn find<'a>(found: &'a Ladder, name: &str) -> Option<&'a Row> {
    found.rows_of(found.first()).find(|row| row.name == name)
}

fn says_pareto(found: &Ladder) -> String {
    let mut says = "Lower is closer to the truth, further left is faster. ".to_owned();
    if let (Some(practice), Some(default)) = (find(found, PRACTICE), find(found, DEFAULT)) {
        let _ = write!(
            says,
            "For {} times the time of the practice the default rung errs {} times less. ",
            number(default.time.ratio.median),
            number(practice.errors.all.rmse / default.errors.all.rmse)
        );
        if let Some(samples) = default.samples {
            let _ = write!(
                says,
                "Monte Carlo takes {} samples to err as little, and {} to take as long: a sample costs more than all of it. ",
                number(samples.error),
                number(samples.time)
            );
            if samples.time >= 1.0 {
                says = says.replace(": a sample costs more than all of it", "");
            }
        }
    }
    says
}

fn says_parts(found: &Ladder) -> String {
    let largest = |pick: fn(&Row) -> f64| {
        let ours = found.rows_of(found.first()).filter(|row| row.rungs.is_some());
        ours.map(pick).fold(0.0, f64::max)
    };
    format!(
        "The shape of the fitted lobe is what is left of the error (up to {}). The table adds at most {}, and the device's float32 \
         integral at most {}: a finer one would show nowhere but on lights that are small.",
        percent(largest(|row| row.errors.fit)),
        percent(largest(|row| row.errors.table)),
        percent(largest(|row| row.errors.integral))
    )
}

fn says_effects() -> &'static str {
    "Blue: the time that an effect adds to the default rung by being in the set, on a frame in which no light calls for it; of a \
     lobe, which every pixel has, what it adds. Orange: lights that call for it, beside quads. What is not in the set costs nothing, \
     so blue is what a set that is too large costs. Instructions are of the shade kernel's SPIR-V, specialised and optimised."
}

fn says_growth(found: &Ladder) -> String {
    let growth = found.scaling.by_lights.iter().find(|growth| growth.method == DEFAULT);
    let at = |lights: u32| {
        let steps = growth.map(|growth| growth.steps.as_slice()).unwrap_or_default();
        steps.iter().find(|(count, _)| *count == lights).map_or(f64::NAN, |(_, time)| time.median)
    };
    format!(
        "Every light costs the same: 1000 lights take {} times as long as 10 ({} pixels, no tiles).",
        number(at(1000) / at(10)),
        found.scaling.pixels
    )
}

fn says_pixels() -> &'static str {
    "Where the line is straight and steep the device is full; where it is flat, a dispatch's own cost is what is seen."
}

fn says_pictures(pictures: &Pictures) -> String {
    format!(
        "The scene '{}' under {} lights, without shadows, as in every method. Below each picture its difference from the reference \
         (Monte Carlo of {} samples a pixel, whose own noise is in it), over the reference's mean; lights themselves are left out.",
        escape(&pictures.scene),
        pictures.lights,
        pictures.samples
    )
}

fn says_numbers(found: &Ladder) -> String {
    format!(
        "Milliseconds are for a light and a megapixel. Equal samples: those of Monte Carlo with the same error, and with the same \
         time. Fit, table and integral are the parts of the error, seed {}.",
        found.seed
    )
}

/// The pictures with their maps.
fn show(pictures: &Pictures) -> Result<String, Failure> {
    let [low, high] = images::SCALE;
    let mut html = format!(
        "<div class=\"scale\"><span>{}</span><div style=\"background:{}\"></div><span>{} of the mean, logarithmic</span></div>\n\
         <div class=\"pictures\">\n",
        percent(low),
        images::gradient(),
        percent(high)
    );
    let whole = |reflected: &[DVec3]| {
        let pixels = pictures.emitted.iter().zip(reflected).map(|(emitted, reflected)| *emitted + *reflected);
        images::picture(pictures.size, pixels.collect::<Vec<_>>().into_iter())
    };
    let _ = writeln!(
        html,
        "<figure><img alt=\"reference\" src=\"{}\"><figcaption><b>reference</b><br>Monte Carlo, {} samples</figcaption></figure>",
        whole(&pictures.reference)?,
        pictures.samples
    );
    for Picture { name, reflected, errors, milliseconds } in &pictures.shown {
        // A light itself is no matter of shading
        let shown = |radiance: &[DVec3]| -> Vec<DVec3> {
            let all = radiance.iter().zip(&pictures.emitted);
            all.map(|(radiance, emitted)| if *emitted == DVec3::ZERO { *radiance } else { DVec3::ZERO })
                .collect()
        };
        let map = images::differences(pictures.size, &shown(reflected), &shown(&pictures.reference))?;
        let name = escape(name);
        let _ = writeln!(
            html,
            "<figure><img alt=\"{name}\" src=\"{}\"><img alt=\"difference of {name}\" src=\"{map}\"><figcaption><b>{name}</b><br>\
             error {}, {} ms</figcaption></figure>",
            whole(reflected)?,
            percent(errors.rmse),
            number(*milliseconds)
        );
    }
    html.push_str("</div>\n");
    Ok(html)
}

/// Every number, by lights.
fn tables(found: &Ladder) -> String {
    let mut html = String::new();
    for (index, (name, description)) in found.workloads.iter().enumerate() {
        let open = if index == 0 { " open" } else { "" };
        let _ = write!(
            html,
            "<details{open}><summary>{}: {}</summary><div class=\"table\"><table><tr><th>method</th><th>RMSE</th><th>fit</th>\
             <th>table</th><th>integral</th><th>p99</th><th>worst</th><th>bias</th><th>NaN</th><th>ms</th><th>practice = 1</th>\
             <th>quartiles</th><th>equal error</th><th>equal time</th></tr>",
            escape(name),
            escape(description)
        );
        for row in found.rows_of(name) {
            let ratio = &row.time.ratio;
            let [low, high] = ratio.quartiles.map(number);
            let samples = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), number);
            let cells = [
                number(row.time.milliseconds.median),
                number(ratio.median),
                format!("{low} to {high}"),
                samples(row.samples.map(|equal| equal.error)),
                samples(row.samples.map(|equal| equal.time)),
            ];
            let _ = write!(html, "<tr><td title=\"{}\">{}</td>", escape(&row.description), escape(&row.name));
            for cell in error_cells(&row.errors).into_iter().chain(cells) {
                let _ = write!(html, "<td>{cell}</td>");
            }
            html.push_str("</tr>");
        }
        html.push_str("</table></div></details>\n");
    }
    html
}
