//! The report: one page that needs nothing else. Charts are drawn, pictures are within it, and it has no
//! script.

mod charts;
mod images;

use crate::differences;
use crate::failure::Failure;
use arealight_benches::ladder::{
    BASELINE, CASES_PUBLISHED, CLIPLESS_PUBLISHED, DEFAULT, Ladder, Picture, PictureError, Pictures, READS,
    Row, error_cells, number, percent,
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
    section("What is compared", says_methods(), &methods(found));
    section("Error against time", &says_pareto(found), &charts::pareto(found));
    section("Where the error comes from", &says_parts(found), &charts::parts(found));
    section("What an effect adds", says_effects(), &charts::effects(found));
    section("More lights", &says_growth(found), &charts::growth(&found.scaling.by_lights, "lights"));
    section("More pixels", says_pixels(), &charts::growth(&found.scaling.by_pixels, "pixels"));
    section("What it looks like", &says_pictures(pictures), &show(pictures)?);
    section("All numbers", &says_numbers(found), &tables(found));
    let title = format!("What accuracy costs: {}", found.device);
    Ok(format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, \
         initial-scale=1\">\n<title>{}</title>\n<style>\n{STYLE}</style>\n\
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
        facts.push(fact(&percent(row.errors.all.rmse), "error of our default level, RMSE over mean"));
        if let Some(theirs) = find(found, CLIPLESS_PUBLISHED) {
            let label = "error of clipless (three.js) with a table of published quality";
            facts.push(fact(&percent(theirs.errors.all.rmse), label));
        }
        facts.push(fact(
            &format!("{} x", number(row.time.ratio.median)),
            "time of our default level over clipless with our table, on this device; both read lights alike",
        ));
        if let Some(samples) = row.samples {
            facts.push(fact(&format!("{:.0}", samples.error), "samples of Monte Carlo for the same error"));
        }
    }
    format!(
        "<h1>What accuracy costs in time</h1>\n<p class=\"soft\">Area lights by linearly transformed \
        cosines: our quality \
         levels and what others ship, on one device. Again: <code>{}</code> ({:.0} s).</p>\n<div \
         class=\"facts\">{}</div>\n<p class=\"soft\">Errors are against the \
         integral of the true BRDF in float64 at {} points, over its mean. Times are of frames of {} pixels \
         under {} lights, every \
         method in turn for {} rounds ({clock}); ranges are quartiles. {READS}</p>\n",
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

fn says_methods() -> &'static str {
    "Yardsticks are named by their school. They run in kernels of ours, on the same work: the same G-buffer, \
    lights, lobes and table, \
         so that the form factor alone differs. Those of <em>published quality</em> look up a table with one \
         matrix for every \
         reflectance instead, whose errors are those of the table published with Heitz et al. 2016 within 10 \
         %."
}

/// Every method of the first lights in a line.
fn methods(found: &Ladder) -> String {
    let mut html = String::from("<table class=\"methods\"><tr><th>method</th><th>what it is</th></tr>");
    for row in found.rows_of(found.first()) {
        let class = if row.levels.is_some() { "ours" } else { "theirs" };
        let _ = write!(
            html,
            "<tr><td><i class=\"{class}\"></i>{}</td><td>{}</td></tr>",
            escape(&row.name),
            escape(&row.description)
        );
    }
    html + "</table>\n"
}

fn says_pareto(found: &Ladder) -> String {
    let mut says = "Lower is closer to the truth, further left is faster. ".to_owned();
    let Some(default) = find(found, DEFAULT) else { return says };
    for name in [BASELINE.name(), CLIPLESS_PUBLISHED, CASES_PUBLISHED] {
        let Some(theirs) = find(found, name) else { continue };
        let _ = write!(
            says,
            "Against <em>{}</em> our default level errs {} times less, in {} times its time. ",
            escape(name),
            number(theirs.errors.all.rmse / default.errors.all.rmse),
            // Of the same rounds, as the ratios of every table are
            number(default.time.ratio.median / theirs.time.ratio.median)
        );
    }
    if let Some(samples) = default.samples {
        let _ =
            write!(says, "Monte Carlo needs about {} samples for the same error; ", number(samples.error));
        if samples.time >= 1.0 {
            let _ = write!(says, "in the same time it takes {}. ", number(samples.time));
        } else {
            says.push_str("one sample takes longer. ");
        }
    }
    says
}

fn says_parts(found: &Ladder) -> String {
    let largest = |pick: fn(&Row) -> f64| {
        let ours = found.rows_of(found.first()).filter(|row| row.levels.is_some());
        ours.map(pick).fold(0.0, f64::max)
    };
    format!(
        "Of our levels the shape of the fitted lobe is most of the error (up to {}). The table adds at most \
        {}, and the device's float32 \
         integral at most {}. A yardstick's integral error is what its horizon costs. With a table of \
         published quality, fit and table \
         are one part.",
        percent(largest(|row| row.errors.fit)),
        percent(largest(|row| row.errors.table.unwrap_or(0.0))),
        percent(largest(|row| row.errors.integral))
    )
}

fn says_effects() -> &'static str {
    "Blue: the time that an effect adds to the default level by being in the set, on a frame in which no \
    light needs it; of a \
     lobe, which every pixel has, what it adds. Orange: lights that need it, beside quads. What is not in \
     the set costs nothing, \
     so blue is what a set that is too large costs. Instructions are of the shade kernel's SPIR-V, \
     specialised and optimised."
}

fn says_growth(found: &Ladder) -> String {
    let growth = found.scaling.by_lights.iter().find(|growth| growth.method == DEFAULT);
    let steps = growth.map(|growth| growth.steps.as_slice()).unwrap_or_default();
    let many = steps.iter().filter(|(count, _)| *count >= 30);
    let each = many.map(|(count, time)| time.median / f64::from(*count));
    let (least, most) =
        each.fold((f64::INFINITY, 0.0_f64), |(low, high), time| (low.min(time), high.max(time)));
    format!(
        "Our default level takes {} to {} ms a light from 30 lights on ({} pixels, no tiles). {READS}",
        number(least),
        number(most),
        found.scaling.pixels
    )
}

fn says_pixels() -> &'static str {
    "Where the line is straight and steep the device is full; where it is flat, a dispatch's own cost is \
    what is seen."
}

fn says_pictures(pictures: &Pictures) -> String {
    format!(
        "The scene '{}' under {} lights, without shadows, as in every method. Below each picture its \
        difference from the reference \
         (Monte Carlo of {} samples a pixel, whose own noise shows in it), over the reference's mean; lights \
         themselves are left out. \
         The errors in the captions are free of that noise: the reference is two independent halves, and \
         what these differ by is \
         subtracted. In brackets is what the noise leaves uncertain, by 95 %. Yardsticks have a table of \
         published quality.",
        escape(&pictures.scene),
        pictures.lights,
        pictures.samples
    )
}

fn says_numbers(found: &Ladder) -> String {
    format!(
        "Milliseconds are for a light and a megapixel. Ratios of time are to clipless with our table, on \
        this device. {READS} Equal samples: those \
         of Monte Carlo with the same error, and with the same time. Fit, table and integral are the parts \
         of the error, seed {}.",
        found.seed
    )
}

/// An error with what is uncertain of it.
fn caption(error: &PictureError) -> String {
    let [low, high] = error.range.map(percent);
    let holes = match error.not_finite {
        0 => String::new(),
        count => format!(", {count} pixels not finite"),
    };
    format!("{} ({low} to {high}){holes}", percent(error.rmse))
}

/// The pictures with their maps.
fn show(pictures: &Pictures) -> Result<String, Failure> {
    let [low, high] = differences::SCALE;
    let mut html = format!(
        "<div class=\"scale\"><span>{}</span><div style=\"background:{}\"></div><span>{} of the mean, \
        logarithmic</span></div>\n\
         <div class=\"pictures\">\n",
        percent(low),
        differences::gradient(),
        percent(high)
    );
    let whole = |reflected: &[DVec3]| {
        let pixels = pictures.emitted.iter().zip(reflected).map(|(emitted, reflected)| *emitted + *reflected);
        images::picture(pictures.size, pixels.collect::<Vec<_>>().into_iter())
    };
    let _ = writeln!(
        html,
        "<figure><img alt=\"reference\" src=\"{}\"><figcaption><b>reference</b><br>Monte Carlo, {} \
        samples</figcaption></figure>",
        whole(&pictures.reference)?,
        pictures.samples
    );
    for Picture { name, reflected, error, milliseconds } in &pictures.shown {
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
            "<figure><img alt=\"{name}\" src=\"{}\"><img alt=\"difference of {name}\" \
            src=\"{map}\"><figcaption><b>{name}</b><br>\
             error {}, {} ms</figcaption></figure>",
            whole(reflected)?,
            caption(error),
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
            "<details{open}><summary>{}: {}</summary><div \
            class=\"table\"><table><tr><th>method</th><th>RMSE</th><th>fit</th>\
             <th>table</th><th>integral</th><th>p99</th><th>worst</th><th>bias</th><th>NaN</th><th>ms</th><th>clipless = 1</th>\
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
