//! Disks and spheres before a fitted lobe: from a light's record through a lobe's matrix, clipped at one
//! horizon or at both.

use arealight_oracle::ellipse::Ellipse;
use arealight_oracle::polygon;
use arealight_oracle::sphere::Sphere;
use arealight_tests::prelude::*;
use arealight_tests::shapes::lobe_arguments;

const COSINE: u32 = 0;
const BOTH: u32 = 1;

/// A disk, with two rows of a lobe's matrix and the length of the third.
struct Case {
    disk: Ellipse,
    rows: [DVec3; 2],
    alpha: f64,
}

impl Case {
    fn matrix(&self) -> DMat3 {
        let across = self.rows[0].cross(self.rows[1]).try_normalize().expect("not parallel") * self.alpha;
        DMat3::from_cols(self.rows[0], self.rows[1], across).transpose()
    }

    /// What the lobe reflects of an ellipse by a polygon of its area, clipped at the surface where that is
    /// asked for.
    fn truth(&self, ellipse: &Ellipse, both: bool) -> f64 {
        const COUNT: usize = 1024;
        let angle = TAU / COUNT as f64;
        let growth = (angle / angle.sin()).sqrt();
        let grown = Ellipse { axis_u: ellipse.axis_u * growth, axis_v: ellipse.axis_v * growth, ..*ellipse };
        let mut vertices = grown.polygon(COUNT);
        if both {
            vertices = polygon::above_horizon(&vertices);
        }
        polygon::transformed_form_factor(&self.matrix(), &vertices).abs()
    }
}

fn round(v: DVec3) -> DVec3 {
    v.as_vec3().as_dvec3()
}

fn cases(seed: u64, count: usize) -> Vec<Case> {
    let mut random = Random::new(seed);
    let mut case = || {
        let (x, y) = random.direction().any_orthonormal_pair();
        let size = random.between(-3.0, 1.0).exp2();
        let center = random.direction() * random.between(-1.0, 2.0).exp2();
        let disk = Ellipse { center: round(center), axis_u: round(x * size), axis_v: round(y * size) };
        // A lobe that leans by up to a right angle
        let lean = DMat3::from_rotation_y(random.between(0.0, 1.5));
        let rows = [lean.x_axis, lean.y_axis * random.between(0.7, 1.0)].map(round);
        let alpha = f64::from(random.between(-6.0, 0.0).exp2() as f32);
        Case { disk, rows, alpha }
    };
    (0..count).map(|_| case()).collect()
}

#[test]
fn disks_and_spheres_are_clipped_where_they_should() {
    let Some(engine) = TestEngine::new() else { return };
    let cases = cases(101, 1000);
    let arguments: Vec<_> =
        cases.iter().map(|case| lobe_arguments(&case.disk, case.rows, case.alpha)).collect();
    let bound = 4e-6;
    let both = engine.lobes(BOTH, &arguments);
    let one = engine.lobes(COSINE, &arguments);
    let mut comparison = Comparison::new("disks and spheres");
    let (mut cut, mut hidden) = (0, 0);
    for (index, case) in cases.iter().enumerate() {
        let place = || format!("{:?}, {:?}", case.disk, case.matrix());
        let radius = case.disk.axis_u.x.abs();
        let silhouette = Sphere { center: case.disk.center, radius }.silhouette();
        for (answers, horizon) in [(&one, false), (&both, true)] {
            // The N-gon of 1024 sides is off by its curvature's fourth order, and by its own clip: 1e-6
            comparison.add(answers[index][0].into(), case.truth(&case.disk, horizon), bound, place);
            if case.disk.axis_u.x > 0.0 {
                let expected = silhouette.map_or(1.0, |disk| case.truth(&disk, horizon));
                comparison.add(answers[index][1].into(), expected, bound, place);
            }
        }
        // The twin: what the surface's horizon takes away
        let taken = one[index][0] - both[index][0];
        cut += usize::from(f64::from(taken) > 3.0 * bound && both[index][0] > 0.0);
        hidden += usize::from(f64::from(taken) > 3.0 * bound && both[index][0] == 0.0);
    }
    comparison.assert_all();
    assert!(cut > 50 && hidden > 20, "{cut} cut, {hidden} hidden");
}

#[test]
fn a_disk_in_the_plane_of_the_surface_sends_nothing() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(102);
    let mut arguments = Vec::new();
    for _ in 0..2000 {
        let turn = DMat3::from_rotation_z(random.between(0.0, 6.3));
        let size = random.between(-3.0, 3.0).exp2();
        // About the point and beside it, in a plane whose height is a rounding of zero
        let mut level = |v: DVec3| round(turn * v).with_z(v.length() * random.between(-4e-8, 4e-8));
        let center = level(DVec3::X);
        let disk = Ellipse { center, axis_u: level(DVec3::X * size), axis_v: level(DVec3::Y * size) };
        // The Lambert lobe, turned
        let rows = [round(turn.x_axis), round(turn.y_axis)];
        arguments.push(lobe_arguments(&disk, rows, 1.0));
    }
    for horizon in [COSINE, BOTH] {
        let lit = engine.lobes(horizon, &arguments).iter().filter(|found| found[0] != 0.0).count();
        assert_eq!(lit, 0);
    }
    // The twin: a little higher, those about the point fill the sky
    for arguments in &mut arguments {
        arguments[0][2] = 1e-5;
    }
    let lit = engine.lobes(COSINE, &arguments).iter().filter(|found| found[0] > 0.9).count();
    assert!(lit > 500, "{lit}");
}

#[test]
fn any_bits_give_a_form_factor() {
    let Some(engine) = TestEngine::new() else { return };
    let mut random = Random::new(105);
    let mut arguments = Vec::new();
    for index in 0..50_000 {
        let scale = random.between(-149.0, 128.0).exp2();
        let mut given = [[0.0_f32; 4]; 4].map(|row| row.map(|_| random.between(-1.0, 1.0) as f32));
        for (place, number) in given.iter_mut().flatten().enumerate() {
            // The light's numbers, the matrix's, or both are wild
            let of_matrix = place % 4 == 3 || place >= 12;
            *number = match (index % 6, of_matrix) {
                (0, _) | (1, false) | (2, true) => f32::from_bits(random.bits()),
                (3, false) | (4, true) => (f64::from(*number) * scale) as f32,
                _ if random.bits().is_multiple_of(16) => f32::from_bits(random.bits()),
                _ => *number,
            };
        }
        arguments.push(given);
    }
    for horizon in [COSINE, BOTH] {
        let found = engine.lobes(horizon, &arguments);
        let wrong: Vec<_> = found
            .iter()
            .zip(&arguments)
            .filter(|(found, _)| found.iter().any(|f| f.to_bits() > 1.0_f32.to_bits()))
            .collect();
        let partial = found.iter().flatten().filter(|f| **f > 0.0 && **f < 1.0).count();
        assert!(wrong.is_empty(), "{horizon}: {} of them: {:?}", wrong.len(), wrong[0]);
        // The twin: it is not that all are dark
        assert!(partial > 1000, "{partial}");
    }
}
