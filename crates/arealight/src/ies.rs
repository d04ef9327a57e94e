//! Luminaires as LM-63 files ("IES files") give them: candela by direction.

use crate::Profile;
use crate::light_fault::LightFault;
use std::f64::consts::PI;
use std::iter;

/// The most angles of a file, vertical and horizontal each: twice what half a degree makes.
const MOST_ANGLES: usize = 1440;
/// The most bytes of a file.
const MOST_BYTES: usize = 4 << 20;
/// Azimuths of a profile that is not round.
const AZIMUTHS: u32 = 72;
/// A flat light as bright as it is seen: below this cosine what a file says is taken as that of this one.
const LEAST_COSINE: f64 = 0.1;

/// Why a text is no luminaire.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum IesError {
    /// The text is too long, or has not the numbers that it says.
    #[error("{field}: {message}")]
    Bad {
        /// What of the file is meant.
        field: &'static str,
        /// What is wrong with it.
        message: String,
    },
    /// The file is well-formed, but what it says is not supported.
    #[error("{field}: {message}: not supported")]
    Unsupported {
        /// What of the file is meant.
        field: &'static str,
        /// What it is.
        message: String,
    },
}

/// A luminaire of an LM-63 file (1986 to 2019, type C): candela by the angle from straight down and the
/// azimuth.
#[derive(Debug, Clone, PartialEq)]
pub struct IesProfile {
    /// Degrees from straight down, rising.
    pub vertical: Vec<f64>,
    /// Azimuths in degrees, rising: from 0 to 0 where it is round, to 90 or 180, or from 90 to 270, where the
    /// rest mirrors.
    pub horizontal: Vec<f64>,
    /// Candela, those of an azimuth together, with every multiplier.
    pub candela: Vec<f64>,
    /// Width, length and height of the luminous opening, in metres; 0 for a point. Negative sizes of a file,
    /// which mean a round one, are its diameters.
    pub opening: [f64; 3],
    /// Whether the opening is round.
    pub is_round_opening: bool,
}

impl IesProfile {
    /// Reads a file.
    ///
    /// # Errors
    /// [`IesError`] names what of it is wrong, or not supported: photometry of type A or B, a lamp that tilts
    /// within a file of its own.
    pub fn parse(text: &str) -> Result<Self, IesError> {
        let bad = |field, message: String| Err(IesError::Bad { field, message });
        if text.len() > MOST_BYTES {
            return bad("file", format!("{} bytes, at most {MOST_BYTES}", text.len()));
        }
        let text = text.replace('\r', "\n");
        let mut lines = text.lines();
        let first = text.lines().next().map(|line| line.trim_start_matches('\u{feff}').trim());
        let version = first.filter(|line| line.starts_with("IES"));
        let tilt = lines.find_map(|line| line.trim().strip_prefix("TILT=").map(str::trim));
        let Some(tilt) = tilt else { return bad("TILT", "there is no line that begins with TILT=".into()) };
        let rest: Vec<&str> = lines.collect();
        let words = rest.join(" ").replace(',', " ");
        let mut numbers = words.split_ascii_whitespace();
        let mut next = |field: &'static str| -> Result<f64, IesError> {
            let word = numbers.next().ok_or(IesError::Bad { field, message: "the file ends".into() })?;
            match word.parse::<f64>() {
                Ok(number) if number.is_finite() => Ok(number),
                _ => Err(IesError::Bad { field, message: format!("'{}' is no number", short(word)) }),
            }
        };
        match tilt {
            "NONE" => {}
            "INCLUDE" => {
                next("tilt")?;
                let count = count("tilt", next("tilt")?)?;
                for _ in 0..2 * count {
                    next("tilt")?;
                }
            }
            other => return Err(IesError::Unsupported { field: "TILT", message: short(other) }),
        }
        let (_lamps, _lumens) = (next("lamps")?, next("lumens a lamp")?);
        let multiplier = next("multiplier")?;
        let vertical_count = count("vertical angles", next("vertical angles")?)?;
        let horizontal_count = count("horizontal angles", next("horizontal angles")?)?;
        let kind = next("photometric type")?;
        if kind != 1.0 {
            let message = format!("type {kind}, where 1 is type C");
            return Err(IesError::Unsupported { field: "photometric type", message });
        }
        let unit = match next("units")? {
            1.0 => 0.3048,
            2.0 => 1.0,
            other => return bad("units", format!("{other} is neither 1, feet, nor 2, metres")),
        };
        let sizes = [next("width")?, next("length")?, next("height")?];
        let ballast = next("ballast factor")?;
        // Before 1995 a second factor; for future use since then
        let is_early = version.is_none_or(|version| version == "IESNA91");
        let second = next("ballast-lamp factor or future use")?;
        let ballast = if is_early { ballast * second } else { ballast };
        let _watts = next("watts")?;
        let vertical = angles("vertical angles", vertical_count, &mut next)?;
        let horizontal = angles("horizontal angles", horizontal_count, &mut next)?;
        let scale = multiplier * ballast;
        if !(scale > 0.0 && scale.is_finite()) {
            return bad("multiplier", format!("{multiplier}, and a ballast factor of {ballast}"));
        }
        let mut candela = Vec::with_capacity(vertical_count * horizontal_count);
        for _ in 0..vertical_count * horizontal_count {
            let value = next("candela")? * scale;
            if !(0.0..=1e30).contains(&value) {
                return bad("candela", format!("{value} is not from 0 to 1e30"));
            }
            candela.push(value);
        }
        let (low, high) = (vertical[0], vertical[vertical.len() - 1]);
        if low < 0.0 || high > 180.0 {
            return bad("vertical angles", format!("from {low} to {high}, of 0 to 180"));
        }
        let ends = [horizontal[0], horizontal[horizontal.len() - 1]];
        if ![[0.0, 0.0], [0.0, 90.0], [0.0, 180.0], [0.0, 360.0], [90.0, 270.0]].contains(&ends) {
            let [first, last] = ends;
            let message = format!(
                "from {first} to {last}, where they go from 0 to 0, 90, 180 or 360, or from 90 to 270"
            );
            return Err(IesError::Unsupported { field: "horizontal angles", message });
        }
        let is_round_opening = sizes[0] < 0.0;
        let opening = sizes.map(|size| size.abs() * unit);
        Ok(Self { vertical, horizontal, candela, opening, is_round_opening })
    }

    /// Candela at an angle from straight down and an azimuth, degrees; 0 where the file says nothing.
    pub fn candela_at(&self, degrees: f64, azimuth: f64) -> f64 {
        let rows = &self.horizontal;
        let [first, last] = [rows[0], rows[rows.len() - 1]];
        // What mirrors at the plane of its first and last azimuth, or at that and the one across
        let turned = (azimuth - first).rem_euclid(360.0);
        let turned = if last - first < 360.0 { turned.min(360.0 - turned) } else { turned };
        let turned = if last - first == 90.0 { turned.min(180.0 - turned) } else { turned };
        let azimuth = first + turned;
        let next = rows.partition_point(|row| *row < azimuth).min(rows.len() - 1);
        let before = next.saturating_sub(1);
        let width = rows[next] - rows[before];
        let part = if width > 0.0 { (azimuth - rows[before]) / width } else { 0.0 };
        let [low, high] = [before, next].map(|row| self.at(row, degrees));
        low + (high - low) * part
    }

    fn at(&self, row: usize, degrees: f64) -> f64 {
        let angles = &self.vertical;
        let last = angles.len() - 1;
        if degrees < angles[0] || degrees > angles[last] {
            return 0.0;
        }
        let values = &self.candela[row * angles.len()..][..angles.len()];
        let next = angles.partition_point(|angle| *angle < degrees).clamp(1.min(last), last);
        let before = next.saturating_sub(1);
        let width = angles[next] - angles[before];
        let part = if width > 0.0 { (degrees - angles[before]) / width } else { 0.0 };
        values[before] + (values[next] - values[before]) * part
    }

    /// The lumens that it sends down, over the half that a flat light shines to, and up.
    pub fn lumens(&self) -> [f64; 2] {
        let rows = &self.horizontal;
        let last = rows.len() - 1;
        // Of each azimuth's part of the circle, by trapezoids
        let span = rows[last] - rows[0];
        let width = |row: usize| 0.5 * (rows[(row + 1).min(last)] - rows[row.saturating_sub(1)]) / span;
        let mean = |degrees: f64| match last {
            0 => self.at(0, degrees),
            _ => (0..=last).map(|row| self.at(row, degrees) * width(row)).sum(),
        };
        [0.0, 90.0].map(|from| half_sphere(|degrees| mean(from + degrees) * 2.0 * PI, from))
    }

    /// The profile of a flat light that shines so, and the light's luminance at a factor of 1 times its area,
    /// in candela: the light of the area A has the radiance `candela / (683 A)`. Azimuths are those of
    /// [`Profile::new`]: 0 along the first edge, counter-clockwise from above.
    /// It has the lumens that the file sends to the front; what it sends within 6 degrees of the light's
    /// plane, which a flat light cannot, it sends elsewhere.
    ///
    /// # Errors
    /// [`LightFault::BadProfile`] where nothing is sent to the front, and as [`Profile::new`].
    pub fn profile(&self, levels: u32) -> Result<(Profile, f64), LightFault> {
        let mut angles: Vec<f64> = (0..=180).map(|step| f64::from(step) * 0.5).collect();
        angles.extend(self.vertical.iter().filter(|angle| **angle < 90.0));
        angles.sort_by(f64::total_cmp);
        angles.dedup_by(|a, b| *a - *b < 1e-6);
        let azimuths = if self.horizontal.len() == 1 { 1 } else { AZIMUTHS };
        let row = |angle: &f64| {
            let bright = |azimuth: u32| {
                let azimuth = 360.0 * f64::from(azimuth) / f64::from(azimuths);
                self.candela_at(*angle, azimuth) / angle.to_radians().cos().max(LEAST_COSINE)
            };
            iter::once(*angle).chain((0..azimuths).map(bright)).collect()
        };
        let mut rows: Vec<Vec<f64>> = angles.iter().map(row).collect();
        let most = rows.iter().flat_map(|row| &row[1..]).copied().fold(1e-300, f64::max);
        rows.iter_mut().flat_map(|row| &mut row[1..]).for_each(|factor| *factor /= most);
        let profile = Profile::new(&rows, levels)?;
        // Of a luminance of 1 nit a square metre sends pi lumens
        let candela = self.lumens()[0] / (PI * profile.power());
        if candela > 0.0 {
            return Ok((profile, candela));
        }
        Err(LightFault::BadProfile { reason: "nothing is sent to the front: leave the light out".into() })
    }
}

/// The integral over half of the sphere of what depends on the angle, in degrees beyond `from`.
fn half_sphere(value: impl Fn(f64) -> f64, from: f64) -> f64 {
    const STEPS: u32 = 1800;
    let step = 90.0 / f64::from(STEPS);
    let at = |i: u32| {
        let degrees = (f64::from(i) + 0.5) * step;
        value(degrees) * (from + degrees).to_radians().sin()
    };
    (0..STEPS).map(at).sum::<f64>() * step.to_radians()
}

/// The beginning of a word, for messages.
fn short(word: &str) -> String {
    word.chars().take(40).collect()
}

fn count(field: &'static str, number: f64) -> Result<usize, IesError> {
    if number.fract() == 0.0 && (1.0..=MOST_ANGLES as f64).contains(&number) {
        Ok(number as usize)
    } else {
        Err(IesError::Bad { field, message: format!("{number}, where a count from 1 to {MOST_ANGLES} is") })
    }
}

fn angles(
    field: &'static str,
    count: usize,
    next: &mut impl FnMut(&'static str) -> Result<f64, IesError>,
) -> Result<Vec<f64>, IesError> {
    let angles: Vec<f64> = (0..count).map(|_| next(field)).collect::<Result<_, _>>()?;
    match angles.windows(2).find(|pair| pair[0] >= pair[1]) {
        None => Ok(angles),
        Some(pair) => {
            Err(IesError::Bad { field, message: format!("{} after {}: they rise", pair[1], pair[0]) })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of candela by angles.
    fn file(vertical: &str, horizontal: &str, candela: &str) -> String {
        let count = |text: &str| text.split_whitespace().count();
        format!(
            "IESNA:LM-63-2002\n[TEST] made\n[MANUFAC] nobody\nTILT=NONE\n1 1000 2 {} {} 1 2 -0.2 -0.2 0\n\
            0.5 1 40\n{vertical}\n{horizontal}\n{candela}\n",
            count(vertical),
            count(horizontal),
        )
    }

    #[test]
    fn a_flat_light_has_the_file_s_candela_and_lumens() {
        // Lambert's cosine, of 100 candela down: pi times that in lumens
        let degrees: Vec<f64> = (0..=18).map(|i| f64::from(i) * 5.0).collect();
        let of = |value: &dyn Fn(f64) -> f64| {
            degrees.iter().map(|d| value(d.to_radians()).to_string()).collect::<Vec<_>>().join(" ")
        };
        let angles = degrees.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        let lambert = IesProfile::parse(&file(&angles, "0", &of(&|a| 100.0 * a.cos().max(0.0)))).unwrap();
        assert!((lambert.lumens()[0] / (100.0 * PI) - 1.0).abs() < 2e-3, "{}", lambert.lumens()[0]);
        assert_eq!((lambert.opening, lambert.is_round_opening), ([0.2, 0.2, 0.0], true));
        let (profile, candela) = lambert.profile(4).unwrap();
        assert!((candela * profile.factor(1.0) / 100.0 - 1.0).abs() < 5e-3, "{candela}");
        // Before 1995 the number after the ballast's factor is one more; lines may end as on old machines
        let text = file(&angles, "0", &of(&|a| 100.0 * a.cos().max(0.0))).replace("0.5 1 40", "0.5 0.8 40");
        for (version, factor) in [("IESNA:LM-63-2002", 1.0), ("IESNA91", 0.8), ("[OLD]", 0.8)] {
            let text = text.replace("IESNA:LM-63-2002", version).replace('\n', "\r");
            let lumens = IesProfile::parse(&text).unwrap().lumens()[0];
            assert!((lumens / lambert.lumens()[0] / factor - 1.0).abs() < 1e-12, "{version}: {lumens}");
        }
        // A batwing
        let batwing = of(&|a| 50.0 + 200.0 * (2.0 * a).sin().powi(2) * a.cos());
        let batwing = IesProfile::parse(&file(&angles, "0", &batwing)).unwrap();
        let (profile, candela) = batwing.profile(8).unwrap();
        for degrees in [0.0_f64, 30.0, 45.0, 60.0, 75.0] {
            let cosine = degrees.to_radians().cos();
            let found = candela * profile.factor(cosine) * cosine;
            // What is sent along the plane goes elsewhere
            assert!((found / batwing.candela_at(degrees, 123.0) - 1.0).abs() < 0.03, "{degrees}: {found}");
        }
        assert!((candela * PI * profile.power() / batwing.lumens()[0] - 1.0).abs() < 5e-3);
    }

    #[test]
    fn azimuths_are_the_file_s() {
        let street = |horizontal, candela| IesProfile::parse(&file("0 45 90", horizontal, candela)).unwrap();
        let half = street("0 90 180", "100 100 0 100 300 0 100 200 0");
        for (degrees, azimuth, expected) in [
            (45.0, 90.0, 300.0),
            (45.0, 270.0, 300.0),
            (45.0, 45.0, 200.0),
            (45.0, 225.0, 250.0),
            (0.0, 77.0, 100.0),
        ] {
            assert_eq!(half.candela_at(degrees, azimuth), expected, "{degrees} {azimuth}");
        }
        let quarter = street("0 90", "100 100 0 100 300 0");
        assert_eq!(
            [0.0, 45.0, 135.0, 180.0, 315.0].map(|a| quarter.candela_at(45.0, a)),
            [100.0, 200.0, 200.0, 100.0, 200.0]
        );
        let sides = street("90 180 270", "100 100 0 100 300 0 100 200 0");
        assert_eq!(
            [0.0, 90.0, 180.0, 270.0, 315.0].map(|a| sides.candela_at(45.0, a)),
            [300.0, 100.0, 300.0, 200.0, 250.0]
        );
        // A flat light has them, and the lumens of all
        for lamp in [half, quarter, sides] {
            let (profile, candela) = lamp.profile(8).unwrap();
            for azimuth in [0.0_f64, 45.0, 100.0, 180.0, 300.0] {
                let cosine = 30_f64.to_radians().cos();
                let found = candela * cosine * profile.factor_toward(cosine, azimuth.to_radians());
                let expected = lamp.candela_at(30.0, azimuth);
                assert!((found / expected - 1.0).abs() < 5e-3, "{azimuth}: {found} {expected}");
            }
            assert!((candela * PI * profile.power() / lamp.lumens()[0] - 1.0).abs() < 5e-3);
        }
    }

    #[test]
    fn hostile_files_are_refused() {
        let fine = file("0 90", "0", "1 1");
        IesProfile::parse(&fine).unwrap();
        let with = |from: &str, to: &str| fine.replace(from, to);
        for (text, expected) in [
            (String::new(), "TILT: there is no line"),
            (with("TILT=NONE", "TILT=lamp.txt"), "TILT: lamp.txt: not supported"),
            (with("1 1000 2 2 1 1 2", "1 1000 2 2 1 3 2"), "photometric type: type 3"),
            (with("1 1000 2 2 1 1 2", "1 1000 2 2 1 1 3"), "units: 3"),
            (with("1 1000 2 2 1 1 2", "1 1000 2 1e9 1 1 2"), "vertical angles: 1000000000"),
            (with("1 1000 2 2 1 1 2", "1 1000 2 0 1 1 2"), "vertical angles: 0"),
            (with("1 1000 2 2 1 1 2", "1 1000 2 2.5 1 1 2"), "vertical angles: 2.5"),
            (with("1 1000 2 2", "1 1000 -2 2"), "multiplier: -2"),
            (with("1 1000 2 2", "1 1000 NaN 2"), "multiplier: 'NaN' is no number"),
            (with("\n0 90\n", "\n90 0\n"), "vertical angles: 0 after 90"),
            (with("\n0 90\n", "\n0 270\n"), "vertical angles: from 0 to 270"),
            (with("\n1 1\n", "\n1\n"), "candela: the file ends"),
            (with("\n1 1\n", "\n1 -1\n"), "candela: -1"),
        ] {
            let message = IesProfile::parse(&text).unwrap_err().to_string();
            assert!(message.starts_with(expected), "{message}\nnot {expected}");
        }
        for upward in ["0 1", "1 1"] {
            let dark = IesProfile::parse(&file("90 180", "0", upward)).unwrap();
            assert!(dark.profile(4).is_err(), "{upward}");
        }
    }
}
