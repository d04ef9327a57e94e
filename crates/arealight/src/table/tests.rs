use super::*;
use crate::SpecularLobes;

fn table(edit: impl Fn(usize, &mut [f32; 4], &mut [f32; 2])) -> Result<LightTable, TableError> {
    let mut matrix = vec![[1.0, 0.0, 0.0, 1.0]; 9];
    let mut magnitude = vec![[1.0, 0.25]; 9];
    for i in 0..9 {
        edit(i, &mut matrix[i], &mut magnitude[i]);
    }
    let description = TableDescription { brdf: "test".into(), made_by: "a test".into(), ggx_dip: false };
    LightTable::new(description, 3, matrix, magnitude)
}

#[test]
fn lookup_returns_nodes_exactly_and_interpolates_between_them() {
    let table = table(|i, m, a| {
        m[0] = 1.0 + i as f32;
        *a = [i as f32 / 10.0, 0.0];
    })
    .unwrap();
    for y in 0..3 {
        for x in 1..3 {
            let (roughness, cos_view) = LightTable::node(3, x, y);
            let sample = table.lookup(roughness, cos_view);
            assert!((sample.albedo - f64::from(y * 3 + x) / 10.0).abs() < 1e-7);
        }
    }
    let middle = table.lookup(0.75, 1.0 - 0.0625);
    assert!((middle.albedo - 0.3).abs() < 1e-7, "{middle:?}");
}

#[test]
fn lookup_clamps_what_is_outside() {
    let table = table(|_, _, _| {}).unwrap();
    assert_eq!(table.lookup(7.0, 2.0), table.lookup(1.0, 1.0));
    assert_eq!(table.lookup(0.5, -1.0), table.lookup(0.5, 0.0));
    assert!(table.lookup(f64::NAN, f64::NAN).inverse.is_finite());
}

#[test]
fn the_mirror_frame_is_a_rotation_that_holds_the_mirror_direction() {
    for i in 0..=10 {
        let cos_view = f64::from(i) / 10.0;
        let frame = mirror_frame(cos_view);
        assert!((frame.determinant() - 1.0).abs() < 1e-12);
        assert!((frame.z_axis.z - cos_view).abs() < 1e-12 && frame.z_axis.x <= 0.0);
    }
}

#[test]
fn an_identity_texel_is_a_cosine_about_the_mirror_direction() {
    let inverse = inverse_from_texel([1.0, 0.0, 0.0, 1.0], 1.0, 0.6);
    assert!((inverse * DVec3::new(-0.8, 0.0, 0.6) - DVec3::Z).length() < 1e-12);
}

/// The same albedos everywhere, with GGX's dip added at the nodes.
fn dipped(size: u32, albedos: [f64; 2]) -> Result<LightTable, TableError> {
    let count = (size * size) as usize;
    let description = TableDescription { ggx_dip: true, ..TableDescription::default() };
    let magnitude = |i: u32| {
        let (roughness, cos_view) = LightTable::node(size, i % size, i / size);
        let dip = description.dip(roughness, cos_view);
        std::array::from_fn(|k| (albedos[k] + dip[k]) as f32)
    };
    let magnitude = (0..count as u32).map(magnitude).collect();
    LightTable::new(description, size, vec![[1.0, 0.0, 0.0, 1.0]; count], magnitude)
}

#[test]
fn a_dip_that_was_added_is_taken_away() {
    let table = dipped(9, [0.7, 0.3]).unwrap();
    for (found, stored) in table.albedos().iter().zip(table.magnitude()) {
        assert!((found[0] - 0.7).abs() < 1e-6 && (found[1] - 0.3).abs() < 1e-6, "{found:?}");
        assert!(stored[0] >= 0.7);
    }
    for (x, y) in (0..81).map(|i| (i % 9, i / 9)) {
        let (roughness, cos_view) = LightTable::node(9, x, y);
        // The first column stands for the smallest roughness, which is looked up beside it
        if x > 0 {
            let sample = table.lookup(roughness, cos_view);
            assert!((sample.albedo - 0.7).abs() < 1e-6 && (sample.schlick - 0.3).abs() < 1e-6);
        }
    }
    // Between nodes shows what was added: here is a lobe of alpha = 0.0156 seen from its own height
    let sample = table.lookup(0.125, 0.0156);
    assert!(sample.albedo < 0.62 && sample.schlick < 0.28, "{sample:?}");
    assert_eq!(table.texels()[81], [table.magnitude()[0][0], table.magnitude()[0][1], 1.0, 0.0]);
}

#[test]
fn albedos_stay_in_their_range_between_nodes() {
    // As far out as rounding takes them; any farther is refused
    for albedos in [[1.0009, 1.0009], [0.0, -0.0009]] {
        let table = dipped(5, albedos).unwrap();
        for (i, j) in (0..400).map(|i| (i % 20, i / 20)) {
            let sample = table.lookup(f64::from(i) / 19.0, f64::from(j) / 19.0);
            assert!((0.0..=1.0).contains(&sample.albedo) && (0.0..=sample.albedo).contains(&sample.schlick));
        }
    }
    for albedos in [[1.0011, 0.5], [0.5, -0.0011], [0.5, 0.5011]] {
        let error = dipped(5, albedos).unwrap_err();
        assert!(matches!(error, TableError::Magnitude { x: 0, y: 0, .. }), "{error}");
    }
}

fn two_matrices() -> LightTable {
    let lobe = table(|_, m, a| (*m, *a) = ([0.8, -0.1, 0.3, 1.5], [0.6, 0.2])).unwrap();
    lobe.with_schlick_matrix(vec![[0.4, 0.1, -0.2, 0.7]; 9]).unwrap()
}

#[test]
fn the_lobe_of_a_reflectance_lies_between_the_two_by_their_albedos() {
    let sample = two_matrices().lookup(0.7, 0.6);
    assert_eq!(sample.inverse_by_f0(1.0, 1.0), sample.inverse);
    assert_eq!(sample.inverse_by_f0(0.0, 1.0), sample.schlick_inverse);
    // 0.5 * 0.6 of the one, 0.5 * 0.2 of the other: a quarter
    assert!((sample.schlick_share(0.5, 1.0) - 0.25).abs() < 1e-7, "{sample:?}");
    let between = inverse_from_texel([0.7, -0.05, 0.175, 1.3], 0.49, 0.6);
    assert!(sample.inverse_by_f0(0.5, 1.0).abs_diff_eq(between, 1e-7));
    // Nothing is reflected, or less at grazing incidence: no reason to turn to Schlick's lobe
    assert_eq!([sample.schlick_share(0.0, 0.0), sample.schlick_share(0.5, 0.1)], [0.0, 0.0]);
}

#[test]
fn one_matrix_serves_both_lobes() {
    let sample = table(|_, m, _| m[1] = 0.2).unwrap().lookup(0.7, 0.6);
    assert_eq!(sample.inverse, sample.schlick_inverse);
}

/// Two matrices that can be told apart, a tenth more from node to node, and shares.
fn pairs() -> LobePairs {
    let matrix = |first: f32| (0..9).map(|i| [first + 0.1 * i as f32, 0.0, 0.0, 1.0]).collect();
    LobePairs {
        matrices: [matrix(1.0), matrix(2.0)],
        second_shares: (0..9).map(|i| [0.1 * i as f32, 0.05 * i as f32]).collect(),
    }
}

#[test]
fn layers_come_in_the_order_of_the_image() {
    let texels = two_matrices().with_pairs(pairs()).unwrap().texels();
    assert_eq!(texels.len(), LAYERS as usize * 9);
    assert_eq!(
        [texels[0], texels[9], texels[18]],
        [[0.8, -0.1, 0.3, 1.5], [0.6, 0.2, 0.0, 0.0], [0.4, 0.1, -0.2, 0.7]]
    );
    assert_eq!([texels[27][0], texels[36][0]], [1.0, 2.0]);
    assert_eq!(texels[45 + 6][..2], [0.6, 0.3], "the second lobe's shares");
    // A table of one matrix has it everywhere, and no second lobe
    let texels = table(|_, _, _| {}).unwrap().texels();
    assert!((2..5).all(|layer| texels[..9] == texels[9 * layer..9 * (layer + 1)]));
    assert!(texels[45..].iter().all(|texel| texel[0] == 0.0));
}

#[test]
fn what_each_of_two_lobes_reflects_is_linear_in_the_reflectance() {
    let table = two_matrices().with_pairs(pairs()).unwrap();
    let (roughness, cos_view) = LightTable::node(3, 1, 1);
    let sample = table.lookup(roughness, cos_view);
    let (inverses, shares) = sample.pairs.unwrap();
    assert!((shares[0] - 0.4).abs() < 1e-6 && (shares[1] - 0.2).abs() < 1e-6);
    let f0 = DVec3::new(1.0, DIELECTRIC_F0, 0.5 * (1.0 + DIELECTRIC_F0));
    let lobes = sample.lobes(SpecularLobes::Two, f0, 1.0);
    assert_eq!(lobes.map(|(inverse, _)| inverse), inverses);
    let whole = lobes[0].1 + lobes[1].1;
    for channel in 0..3 {
        assert!((whole[channel] - sample.specular_albedo(f0[channel], 1.0)).abs() < 1e-12);
    }
    let second = lobes[1].1;
    assert!((second.x - shares[0] * whole.x).abs() < 1e-12 && (second.y - shares[1] * whole.y).abs() < 1e-12);
    assert!((second.z - 0.5 * (second.x + second.y)).abs() < 1e-12);
    // Without a grazing part there is the metal's, scaled
    let plain = sample.lobes(SpecularLobes::Two, DVec3::splat(0.3), 0.3)[1].1;
    assert!((plain - DVec3::splat(0.3 * second.x)).abs().max_element() < 1e-12, "{plain}");
    // One lobe
    let [(inverse, albedo), (_, none)] = sample.lobes(SpecularLobes::One, f0, 1.0);
    assert_eq!((albedo, none), (whole, DVec3::ZERO));
    assert_eq!(inverse, sample.inverse_by_f0(f0.element_sum() / 3.0, 1.0));
    // What a table without pairs uploads: a lobe for F0 and one for what Schlick's term adds
    let (one, sample) = (two_matrices(), two_matrices().lookup(roughness, cos_view));
    let shares = one.texels()[45 + 4].map(f64::from);
    let sample = TableSample { pairs: Some((inverses, [shares[0], shares[1]])), ..sample };
    for f0 in [0.02, 0.1, 0.6, 1.0] {
        let second = sample.lobes(SpecularLobes::Two, DVec3::splat(f0), 1.0)[1].1;
        assert!((second.x - (1.0 - f0) * sample.schlick).abs() < 1e-6, "{f0}");
    }
}

#[test]
fn bad_pairs_are_refused_with_their_place() {
    let with = |edit: fn(&mut LobePairs)| {
        let mut pairs = pairs();
        edit(&mut pairs);
        two_matrices().with_pairs(pairs).unwrap_err().to_string()
    };
    let message = with(|pairs| pairs.matrices[1][5][2] = f32::NAN);
    assert_eq!(message, "second matrix: texel (2, 1) channel 2 is NaN, not a finite number");
    assert!(
        with(|pairs| pairs.matrices[0][0][3] = -1.0).starts_with("first matrix: texel (0, 0) is singular")
    );
    assert!(with(|pairs| pairs.matrices[1].truncate(1)).starts_with("second matrix: 1 texels"));
    let message = with(|pairs| pairs.second_shares[4][1] = 1.5);
    assert_eq!(message, "second shares: texel (1, 1) is 1.5; must be in [0, 1]");
    assert!(with(|pairs| pairs.second_shares.truncate(2)).starts_with("second shares: 2 texels"));
}

#[test]
fn a_tilted_cosine_has_a_share_above_the_surface() {
    // A cosine about the normal lies above, one about the horizon half above
    for (cos_view, share) in [(1.0, 1.0), (0.0, 0.5), (0.5, 0.75)] {
        let inverse = inverse_from_texel([1.0, 0.0, 0.0, 1.0], 1.0, cos_view);
        assert!((share_above_surface(&inverse) - share).abs() < 1e-12, "{cos_view}");
    }
    assert_eq!(share_above_surface(&DMat3::ZERO), 1.0);
}

#[test]
fn a_bad_second_matrix_is_refused_with_its_place() {
    let with = |matrix| table(|_, _, _| {}).unwrap().with_schlick_matrix(matrix).unwrap_err().to_string();
    let mut matrix = vec![[1.0, 0.0, 0.0, 1.0]; 9];
    matrix[5][2] = f32::INFINITY;
    assert_eq!(with(matrix), "schlick matrix: texel (2, 1) channel 2 is inf, not a finite number");
    assert!(with(vec![[1.0, 0.0, 0.0, -1.0]; 9]).starts_with("schlick matrix: texel (0, 0) is singular"));
    assert!(with(vec![]).starts_with("schlick matrix: 0 texels"));
}

#[test]
fn bad_texels_are_refused_with_their_place() {
    let error = table(|i, m, _| {
        if i == 5 {
            m[2] = f32::NAN;
        }
    })
    .unwrap_err();
    assert_eq!(error.to_string(), "matrix: texel (2, 1) channel 2 is NaN, not a finite number");
    let error = table(|i, m, _| {
        if i == 3 {
            m[3] = 0.0;
        }
    })
    .unwrap_err();
    assert!(matches!(error, TableError::Singular { x: 0, y: 1, .. }), "{error}");
    let error = table(|i, _, a| {
        if i == 8 {
            a[1] = 1.5;
        }
    })
    .unwrap_err();
    assert!(matches!(error, TableError::Magnitude { x: 2, y: 2, .. }), "{error}");
    let description = TableDescription::default();
    assert!(matches!(
        LightTable::new(description.clone(), 1, vec![], vec![]),
        Err(TableError::Size { size: 1 })
    ));
    assert!(matches!(
        LightTable::new(description, 2, vec![[1.0; 4]; 3], vec![[0.0; 2]; 4]),
        Err(TableError::TexelCount { layer: "matrix", count: 3, .. })
    ));
}
