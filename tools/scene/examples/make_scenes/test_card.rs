//! Pictures whose orientation shows at once: what is mirrored, turned or moved looks wrong.

use image::{Rgb, RgbImage};

pub const WIDTH: u32 = 512;
pub const HEIGHT: u32 = 288;

const WHITE: Rgb<u8> = Rgb([235, 235, 235]);
const BLACK: Rgb<u8> = Rgb([12, 12, 12]);

/// A television's test card: a grid, bars of colours and of lines, a circle, letters, and a mark of its own
/// in three corners.
pub fn card() -> RgbImage {
    let mut card = RgbImage::from_pixel(WIDTH, HEIGHT, Rgb([92, 92, 96]));
    // A grid of squares, and a border of blocks
    for (x, y, pixel) in card.enumerate_pixels_mut() {
        if x % 32 < 2 || y % 32 < 2 {
            *pixel = Rgb([165, 165, 165]);
        }
        let at_side = !(16..WIDTH - 16).contains(&x);
        if at_side || !(16..HEIGHT - 16).contains(&y) {
            let along = if at_side { y / 16 } else { x / 16 };
            *pixel = if along.is_multiple_of(2) { WHITE } else { BLACK };
        }
    }
    // Corners: red upper left, green upper right, blue lower left
    let corners = [(0, 0, [225, 30, 25]), (WIDTH - 48, 0, [30, 190, 50]), (0, HEIGHT - 48, [35, 70, 230])];
    for (x, y, color) in corners {
        fill(&mut card, [x, y, 48, 48], Rgb(color));
    }
    // Within a circle, from the top: letters, colours, lines, grays
    let mut inside = RgbImage::from_pixel(WIDTH, HEIGHT, BLACK);
    write(&mut inside, "AREALIGHT", [176, 58], 3, WHITE);
    let colors = [
        [235, 235, 235],
        [235, 225, 20],
        [20, 215, 220],
        [25, 200, 40],
        [215, 30, 205],
        [220, 30, 25],
        [30, 45, 225],
    ];
    for (i, color) in (0..).zip(colors) {
        fill(&mut inside, [130 + 36 * i, 88, 36, 76], Rgb(color));
    }
    for (i, width) in (0..).zip([14, 10, 7, 5, 4, 3, 2]) {
        for x in (0..36).filter(|x| x / width % 2 == 0) {
            fill(&mut inside, [130 + 36 * i + x, 164, 1, 40], WHITE);
        }
    }
    for i in 0..7 {
        fill(&mut inside, [130 + 36 * i, 204, 36, 24], Rgb([(i * 39) as u8; 3]));
    }
    write(&mut inside, "LTC", [231, 236], 3, Rgb([235, 190, 60]));
    for (x, y, pixel) in card.enumerate_pixels_mut() {
        let (dx, dy) = (f64::from(x) + 0.5 - 256.0, f64::from(y) + 0.5 - 144.0);
        let radius = (dx * dx + dy * dy).sqrt();
        if radius < 128.0 {
            *pixel = if radius > 124.0 { WHITE } else { *inside.get_pixel(x, y) };
        }
    }
    card
}

/// Letters on a sign of 2 by 1.
pub fn sign() -> RgbImage {
    let mut sign = RgbImage::from_fn(128, 64, |_, y| Rgb([20, 60 + y as u8, 150 - y as u8]));
    write(&mut sign, "LIGHT", [10, 21], 3, Rgb([255, 240, 180]));
    sign
}

fn fill(image: &mut RgbImage, [left, top, width, height]: [u32; 4], color: Rgb<u8>) {
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (left + x, top + y))) {
        image.put_pixel(x, y, color);
    }
}

/// Writes letters of 5 by 7 dots, each a square of `dot` texels.
fn write(image: &mut RgbImage, text: &str, [left, top]: [u32; 2], dot: u32, color: Rgb<u8>) {
    for (i, letter) in (0..).zip(text.chars()) {
        for (y, row) in (0..).zip(glyph(letter)) {
            for x in (0..5).filter(|x| row >> (4 - x) & 1 == 1) {
                fill(image, [left + (6 * i + x) * dot, top + y * dot, dot, dot], color);
            }
        }
    }
}

/// Seven rows of five dots, the leftmost in the highest bit.
fn glyph(letter: char) -> [u8; 7] {
    match letter {
        'A' => [0b01110, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001],
        'C' => [0b01111, 0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b01111],
        'E' => [0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b11111],
        'G' => [0b01111, 0b10000, 0b10000, 0b10011, 0b10001, 0b10001, 0b01111],
        'H' => [0b10001, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001],
        'I' => [0b01110, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110],
        'L' => [0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b11111],
        'R' => [0b11110, 0b10001, 0b10001, 0b11110, 0b10100, 0b10010, 0b10001],
        'T' => [0b11111, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100],
        _ => [0; 7],
    }
}
