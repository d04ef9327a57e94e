//! The viewer without a window: what a script does is what the frames show.

use crate::common::{device, difference, json_of, picture, printed, refuse, run, scene};
use serde_json::Value;

/// Every mode, a quarter of a second each; a lamp of the room is dragged, and then the view.
const SCRIPT: &str = "
0     key s          # without shadows
0.25  key 3
0.5   key w
1.5   key w
1.75  key w
2     key e
2.25  key e
2.25  press LAMP     # a lamp
2.5   move 0.5 0.45
2.5   release
2.75  press 0.5 0.98 # the floor
3     move 0.6 0.9
3     release
3.25  key ]
3.5   key c
4     key c
4     key r
4     key [
4     key r
4     key 1
";

struct Recording {
    folder: tempfile::TempDir,
    frames: Vec<Value>,
}

impl Recording {
    fn pixels(&self, frame: usize) -> Vec<u8> {
        picture(self.folder.path(), &format!("out/frame-{frame:04}.png")).into_raw()
    }

    /// The part of the bytes that differ between two frames.
    fn difference(&self, a: usize, b: usize) -> f64 {
        difference(&self.pixels(a), &self.pixels(b))
    }
}

fn record(name: &str, script: &str) -> Recording {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("script"), script).unwrap();
    let options = "--size 160x96 --script script --record out --rate 4 --samples 4 --json";
    let arguments: Vec<&str> = options.split(' ').collect();
    let said = json_of(&run(folder.path(), &[&["view", &scene(name)], &arguments[..]].concat()));
    Recording { folder, frames: said["frames"].as_array().unwrap().clone() }
}

#[test]
fn a_recording_shows_what_its_script_does() {
    let Some(()) = device() else { return };
    // The middle of sweep's lamp
    let recording = record("sweep.glb", &SCRIPT.replace("LAMP", "0.5 0.13"));
    let frames = &recording.frames;
    assert_eq!(frames.len(), 17);
    let film = std::fs::read(recording.folder.path().join("out/film.gif")).unwrap();
    assert_eq!(&film[..6], b"GIF89a");

    // Modes and levels
    let word = |frame: usize, field: &str| frames[frame][field].as_str().unwrap().to_owned();
    assert_eq!([word(0, "level"), word(1, "level")], ["exact", "finest"]);
    assert_eq!(
        [2, 6, 7, 8, 9].map(|frame| word(frame, "mode")),
        ["wipe", "wipe", "picture", "error", "picture"]
    );
    assert_eq!(frames[0]["shadows"], false);

    // The truth converges: while frames 2 to 5 show it, its noise falls as the root of the samples
    let samples = |frame: usize| frames[frame]["truth_samples"].as_f64().unwrap();
    let noise = |frame: usize| frames[frame]["truth_noise"].as_f64().unwrap();
    assert_eq!([2, 3, 5].map(samples), [4.0, 8.0, 16.0]);
    assert!(noise(5) < 0.85 * noise(3), "{} after {}", noise(5), noise(3));

    // Frames differ where something was done, and only there
    for (a, b, least) in [(6, 7, 0.05), (7, 8, 0.3), (9, 10, 0.1), (11, 12, 0.1), (12, 13, 0.05)] {
        let found = recording.difference(a, b);
        assert!(found > least, "frames {a} and {b} differ in {found}");
    }
    assert_eq!(recording.difference(10, 11), 0.0, "nothing is done");

    // What levels and effects cost
    let costs = frames[14]["costs"].as_array().unwrap();
    let names: Vec<&str> = costs.iter().map(|cost| cost["name"].as_str().unwrap()).collect();
    assert_eq!(names[..5], ["exact", "two lobes", "finest", "half vectors", "formula"]);
    assert!(names.contains(&"without glossy"), "{names:?}");
    assert!(frames[13]["costs"].as_array().unwrap().is_empty());

    // In the end everything is as it was: a recording shows no times
    assert_eq!(recording.difference(0, 16), 0.0);
}

#[test]
fn shadows_and_scenes_without_a_yardstick_are_shown_too() {
    let Some(()) = device() else { return };
    // Disks, spheres and tubes: after the truth comes the picture again
    let recording = record("shapes.glb", "0 key w\n0.25 key w\n0.5 key s\n");
    let modes: Vec<&str> = recording.frames.iter().map(|frame| frame["mode"].as_str().unwrap()).collect();
    assert_eq!(modes, ["wipe", "picture", "picture"]);
    assert!(recording.difference(1, 2) > 0.02, "shadows are seen");
}

#[test]
fn what_is_done_in_the_panel_is_the_panels() {
    let Some(()) = device() else { return };
    // The panel covers a picture so small: the same drag turns the camera without it
    let drag = "0.5 press 0.4 0.2\n0.75 move 0.6 0.3\n0.75 release\n";
    let ends = |before: &str, after: &str| {
        let recording = record("sweep.glb", &format!("0 key s\n{before}{drag}{after}"));
        recording.difference(0, recording.frames.len() - 1)
    };
    let with = ends("0.25 key h\n", "1 key h\n");
    let without = ends("", "1 key h\n1.25 key h\n");
    assert!(with < 1e-3 && without > 0.05, "{with}, {without}");
}

#[test]
fn fog_is_the_scenes_until_it_is_thinner_or_off() {
    let Some(()) = device() else { return };
    let recording = record("slats.glb", "0 key s\n0.25 key ,\n0.5 key r\n0.75 key w\n1.25 key f\n");
    let fog: Vec<_> = recording.frames.iter().map(|frame| frame["fog"].as_f64()).collect();
    assert_eq!(fog, [Some(0.15), Some(0.12), Some(0.15), Some(0.15), Some(0.15), None]);
    // The truth has the same fog
    let [error, noise] = ["error", "truth_noise"].map(|field| recording.frames[4][field].as_f64());
    assert!(noise.is_some() && error.is_none_or(|error| error < 0.1), "{error:?}, {noise:?}");
    let [thinner, same, off] = [1, 2, 5].map(|frame| recording.difference(0, frame));
    assert!(thinner > 0.1 && same == 0.0 && off > 0.5, "{thinner} {same} {off}");
}

#[test]
fn images_move_until_they_are_stopped() {
    let Some(()) = device() else { return };
    let recording = record("cinema.glb", "0 key s\n0.5 key space\n0.75 key h\n0.75 key h\n");
    assert_eq!(recording.frames.len(), 4);
    // The screen, and what it lights
    let [first, second, stopped] = [0, 1, 2].map(|frame| recording.difference(frame, frame + 1));
    assert!(first > 0.2 && second > 0.2 && stopped == 0.0, "{first} {second} {stopped}");
}

#[test]
fn wrong_scripts_and_places_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |arguments: &[&str], code: i32, words: &str| {
        refuse(folder.path(), arguments, code, &[words]);
    };
    std::fs::write(folder.path().join("bad"), "0 key w\n0 key f13").unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    refused(&["view", "--script", "bad", "--record", "out"], 3, "bad: line 2: 'f13' is no key");
    refused(&["view", "--script", "missing", "--record", "out"], 3, "missing");
    refused(&["view", "--script", "file", "--record", "file"], 5, "file: cannot write");
    refused(&["view", "--record", "out"], 2, "--script");
    refused(&["view", "--exposure", "auto"], 2, "--exposure");
    refused(&["view", "missing.glb"], 3, "missing.glb");
}

#[test]
fn what_was_made_of_a_scene_is_rendered() {
    let Some(()) = device() else { return };
    // The lamp goes to the side, and the view turns
    let lamp = "0.25 press 0.5 0.13\n0.5 move 0.7 0.2\n0.5 release\n";
    let view = "0.75 press 0.5 0.98\n1 move 0.6 0.9\n1 release\n";
    let recording = record("sweep.glb", &format!("0 key s\n{lamp}{view}"));
    let folder = recording.folder.path();
    let still = |more: &str| {
        let options = format!("--size 160x96 --supersample 1 --shadows off -o still.png{more}");
        let arguments: Vec<&str> = options.split(' ').collect();
        printed(&run(folder, &[&["render", &scene("sweep.glb")], &arguments[..]].concat()));
        picture(folder, "still.png").into_raw()
    };
    let last = recording.pixels(recording.frames.len() - 1);
    // The frame's lower half has words in it
    let upper = ..last.len() / 2;
    let [same, other] =
        [" --look out/look.json", ""].map(|more| difference(&still(more)[upper], &last[upper]));
    assert!(same < 0.001 && other > 0.5, "{same}, {other}");
    let arguments = ["render", &scene("room.glb"), "--look", "out/look.json"];
    refuse(folder, &arguments, 3, &["look.json: it is of 1 lamps"]);
}
