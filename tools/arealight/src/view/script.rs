//! Scripts: what a person does, and when, as lines of text.

use super::state::Event;

/// Events in order of their time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Script {
    events: Vec<(f64, Event)>,
}

impl Script {
    /// Reads lines such as `1.5 key w`, `2 press 0.4 0.6`, `3 move 0.5 0.6`, `3 release`, `4 wheel -2`:
    /// seconds, and what is done. Places are parts of the picture's width and height, from its upper left
    /// corner. Between two of them the pointer goes in a straight line. `slide` is as `press`, with the
    /// second button. What follows a `#` is a comment.
    ///
    /// # Errors
    /// What is wrong, with the number of its line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut events: Vec<(f64, Event)> = vec![];
        for (number, line) in (1..).zip(text.lines()) {
            let words: Vec<&str> = line.split('#').next().unwrap_or_default().split_whitespace().collect();
            let (seconds, words) = match words.split_first() {
                None => continue,
                Some((seconds, words)) => (*seconds, words),
            };
            let before = events.last().map_or(0.0, |(seconds, _)| *seconds);
            let time = seconds.parse().ok().filter(|time| (before..=MOST_SECONDS).contains(time));
            let time = time.ok_or_else(|| {
                format!("line {number}: '{seconds}' is no time from {before} to {MOST_SECONDS} seconds")
            })?;
            let event = event(words).map_err(|error| format!("line {number}: {error}"))?;
            events.push((time, event));
        }
        Ok(Self { events })
    }

    /// The time of the last event, in seconds.
    pub fn seconds(&self) -> f64 {
        self.events.last().map_or(0.0, |(seconds, _)| *seconds)
    }

    /// The time of the first event after `seconds`; infinite if there is none.
    pub fn next_after(&self, seconds: f64) -> f64 {
        self.events.iter().map(|(time, _)| *time).find(|time| *time > seconds).unwrap_or(f64::INFINITY)
    }

    /// What happens after `from` and not after `to`, in seconds; and at the end where the pointer is on its
    /// way to the next place.
    pub fn between(&self, from: f64, to: f64) -> Vec<Event> {
        let place = |event: &Event| match event {
            Event::Press { at, .. } | Event::Move(at) => Some(*at),
            _ => None,
        };
        let mut now: Vec<Event> = vec![];
        for (time, event) in &self.events {
            if *time > from && *time <= to {
                now.push(*event);
            }
        }
        // Where the pointer is by then: only moves are gone towards
        let mut gone = self.events.iter().rev().filter(|(time, _)| *time <= to);
        let last = gone.find_map(|(time, event)| Some((*time, place(event)?)));
        let next = self.events.iter().find(|(time, event)| *time > to && place(event).is_some());
        if let (Some((began, a)), Some((ends, Event::Move(b)))) = (last, next)
            && ends > &began
        {
            let part = (to - began) / (ends - began);
            now.push(Event::Move([0, 1].map(|axis: usize| a[axis] + (b[axis] - a[axis]) * part)));
        }
        now
    }
}

/// The longest script.
const MOST_SECONDS: f64 = 3600.0;

fn event(words: &[&str]) -> Result<Event, String> {
    let number = |text: &str| {
        let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
        number.ok_or_else(|| format!("'{text}' is no number"))
    };
    Ok(match words {
        ["key", name] => Event::Key(name.parse()?),
        [what @ ("press" | "slide"), x, y] => {
            Event::Press { at: [number(x)?, number(y)?], second: *what == "slide" }
        }
        ["move", x, y] => Event::Move([number(x)?, number(y)?]),
        ["release"] => Event::Release,
        ["wheel", steps] => Event::Wheel(number(steps)?),
        words => {
            return Err(format!(
                "'{}' is none of: key NAME, press X Y, slide X Y, move X Y, release, wheel STEPS",
                words.join(" ")
            ));
        }
    })
}

#[cfg(test)]
mod tests {
    use super::super::state::Key;
    use super::*;

    #[test]
    fn a_script_is_its_events_in_time() {
        let text = "# a comment\n0 key w\n\n1 press 0.2 0.4 # here\n2 move 0.6 0.4\n2 release\n3 wheel -2\n";
        let script = Script::parse(text).unwrap();
        assert_eq!(script.seconds(), 3.0);
        assert_eq!(script.between(-1.0, 0.0), [Event::Key(Key::Wipe)]);
        assert_eq!(script.between(0.0, 0.9), []);
        assert_eq!(script.between(0.9, 1.0)[0], Event::Press { at: [0.2, 0.4], second: false });
        // On the way
        let Event::Move([x, y]) = script.between(1.0, 1.5)[0] else { panic!("the pointer moves") };
        assert!((x - 0.4).abs() < 1e-12 && (y - 0.4).abs() < 1e-12);
        assert_eq!(script.between(1.5, 2.0), [Event::Move([0.6, 0.4]), Event::Release]);
        assert_eq!(script.between(2.0, 9.0), [Event::Wheel(-2.0)]);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, words) in [
            ("0 key w\nx key w", "line 2: 'x' is no time"),
            ("2 key w\n1 key w", "line 2: '1' is no time from 2"),
            ("nan release", "line 1"),
            ("0 key f13", "'f13' is no key"),
            ("0 press 1", "'press 1' is none of"),
            ("0 move 1 inf", "'inf' is no number"),
            ("0", "is none of"),
        ] {
            let error = Script::parse(text).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
        assert_eq!(Script::parse("").unwrap(), Script::default());
    }
}
