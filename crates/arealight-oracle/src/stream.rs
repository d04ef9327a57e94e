//! Random numbers of our own: the same on every machine, each case from its own seed.

use glam::DVec3;

/// `SplitMix64`. What is made of its numbers uses only operations that IEEE 754 rounds correctly.
#[derive(Debug, Clone)]
pub struct Stream(u64);

impl Stream {
    /// The stream of a number.
    pub fn from_seed(seed: u64) -> Self {
        Self(seed)
    }

    /// The stream of a case: its family's name, its index, and the battery's seed.
    pub fn new(family: &str, index: u64, seed: u64) -> Self {
        // FNV-1a of the name, then one step of mixing for each number
        let name = family.bytes().fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        let mut stream = Self(name);
        for number in [seed, index] {
            stream.0 = stream.next() ^ number;
        }
        stream
    }

    /// 64 random bits.
    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// 32 random bits.
    pub fn bits(&mut self) -> u32 {
        (self.next() >> 32) as u32
    }

    /// A whole number from 0 to `count - 1`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// True one time in `count`.
    pub fn one_in(&mut self, count: u32) -> bool {
        self.bits().is_multiple_of(count)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// -1 or 1.
    pub fn sign(&mut self) -> f64 {
        if self.one_in(2) { 1.0 } else { -1.0 }
    }

    /// 2^e, e being uniform from `low` to `high`, but linear between whole exponents: no logarithm is needed.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        let exponent = self.between(low, high);
        let whole = exponent.floor();
        power_of_two(whole as i32) * (1.0 + (exponent - whole))
    }

    /// A unit vector, uniform on the sphere.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = DVec3::from_array([0; 3].map(|_| self.between(-1.0, 1.0)));
            let square = v.length_squared();
            if square > 0.01 && square <= 1.0 {
                return v / square.sqrt();
            }
        }
    }

    /// A unit vector in the plane.
    pub fn circle(&mut self) -> [f64; 2] {
        loop {
            let v = [self.between(-1.0, 1.0), self.between(-1.0, 1.0)];
            let square = v[0] * v[0] + v[1] * v[1];
            if square > 0.01 && square <= 1.0 {
                return v.map(|c| c / square.sqrt());
            }
        }
    }
}

/// 2^exponent, for normal numbers.
pub fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((exponent + 1023).clamp(1, 2046) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_the_same_everywhere_and_differ_by_what_they_are_of() {
        let first = |family, index, seed| Stream::new(family, index, seed).next();
        assert_eq!(first("above", 0, 0), first("above", 0, 0));
        let others = [first("abovf", 0, 0), first("above", 1, 0), first("above", 0, 1)];
        assert!(others.iter().all(|other| *other != first("above", 0, 0)), "{others:?}");
        // From an independent implementation in Python
        assert_eq!(first("above", 7, 3), 0x9a91_5f95_cb86_9103);
    }

    #[test]
    fn numbers_are_in_their_ranges() {
        let mut stream = Stream::new("ranges", 0, 0);
        let (mut smallest, mut largest) = (f64::INFINITY, 0.0_f64);
        for _ in 0..1000 {
            let power = stream.power(-20.0, -10.0);
            (smallest, largest) = (smallest.min(power), largest.max(power));
            assert!((stream.direction().length() - 1.0).abs() < 1e-15);
        }
        assert!((2.0_f64.powi(-20)..2.0_f64.powi(-19)).contains(&smallest), "{smallest:e}");
        assert!((2.0_f64.powi(-11)..2.0_f64.powi(-10)).contains(&largest), "{largest:e}");
    }
}
