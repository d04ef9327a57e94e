#!/usr/bin/env bash
# Every check of the project: installs what is missing, then formatting, dependencies, lints, tests, documentation, shaders.
# Goes on after a step that fails, ends with a summary, and fails if any step did.
#
# With AREALIGHT_REQUIRE_GPU=1 (as in CI) a test without a Vulkan device fails. Otherwise it is skipped and listed.
# With AREALIGHT_LONG=1 every check has its long form: the kernels' statistics are held against those that are
# checked in for each family of GPU, not for one; every GPU test runs under GPU-assisted validation, too, not only
# those that are not batteries; the exported library is compiled with each option in every stage; and the plugin
# for Bevy, which takes minutes to build, is tested.
set -uo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
cd "$root" || exit 1
export PATH="$PATH:${HOME:-/root}/.cargo/bin"

# So many tests must have had a device, where one is required. Raise it with every GPU test that is added: a test
# that is lost, or returns before it asks for a device, then shows.
gpu_test_floor=304

tools/setup.sh test || exit 1
SHADERC_LIB_DIR="$(tools/shaderc.sh)" || exit 1
export SHADERC_LIB_DIR
# Other makers' compilers: what builds them takes two minutes, so in the long form, or where they are built
if [[ "${AREALIGHT_LONG:-}" == 1 || -d "${CARGO_TARGET_DIR:-target}/compilers" ]]; then
    AREALIGHT_COMPILERS="$(tools/compilers.sh)" || exit 1
    export AREALIGHT_COMPILERS
else
    echo "not compiled for Intel's GPUs and Adreno: that takes AREALIGHT_LONG=1, or tools/compilers.sh before"
fi

scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
export AREALIGHT_GPU_TEST_LOG="$scratch/gpu-tests"
: >"$AREALIGHT_GPU_TEST_LOG"

# Everything is built once: with the windows, too
workspace=(--workspace --features "arealight-examples/window" --locked)

summary=() failed=0
step() { # name, command and its arguments
    local name="$1" began=$SECONDS state=ok
    shift
    printf '\n== %s\n' "$name"
    "$@" || { state=FAILED; failed=1; }
    summary+=("$(printf '%-8s %4d s  %s' "$state" "$((SECONDS - began))" "$name")")
}

# Runs the tests, and keeps the line that counts them.
run_tests() {
    local status
    if cargo nextest --version >/dev/null 2>&1; then
        cargo nextest run "${workspace[@]}" 2>&1 | tee "$scratch/tests"
        status=$?
        grep -E '^ *Summary' "$scratch/tests" >"$scratch/count"
    else
        echo "cargo-nextest is not installed: using cargo test"
        cargo test "${workspace[@]}" --lib --bins --tests --examples --no-fail-fast 2>&1 | tee "$scratch/tests"
        status=$?
        awk '/^test result:/ { passed += $4; failed += $6; ignored += $8 }
            END { printf "%d tests passed, %d failed, %d ignored\n", passed, failed, ignored }' \
            "$scratch/tests" >"$scratch/count"
    fi
    return "$status"
}

# Runs the GPU tests again with the shaders instrumented: an access out of bounds is found. (The tests above run
# under core and synchronisation validation, which cannot be had together with this.) Left out are tests of numbers,
# what stands beside Monte Carlo and hosts in C, whose kernels others run, and pushed descriptors: this version of
# the layer (1.3.239) binds a set of its own, after which it has lost what was pushed.
batteries='arcs|bits|c_api|c_lights|c_pictures|c_shadows|cpp_host|effects|footprints|furnace|guard|half_vectors|huge_lights|lobe_horizons'
batteries+='|masked_shadows|material_frames|meshes|paths|polygon_sampling|properties|prune|quad_path|reach|rescattered|self_test|shading'
batteries+='|shadow_levels|shadow_motion|shadowed_reference|shape_frames|shape_lights|shape_points|shape_properties|shapes|slim_tubes|stability'
batteries+='|surfaces|sweep|textured_disks|thin_film|tubes|shadow_scales'
names='monte_carlo|the_reference|half_of_every|culled|even_medium|frames_before|camera_finds|still_picture|nothing_is_darker|lists_and_hidden_froxels|openings_clip'
run_assisted() {
    local left_out="test(/$names|^($batteries)::/)"
    [[ "${AREALIGHT_LONG:-}" != 1 ]] || left_out='test(the_guard_outlives_the_optimiser)' # a minute, and no device
    if cargo nextest --version >/dev/null 2>&1; then
        AREALIGHT_VALIDATION=gpu-assisted cargo nextest run "${workspace[@]}" \
            -E "(package(arealight-tests) or package(arealight-examples)) - binary(window) - $left_out - test(/pushe/)"
    else
        AREALIGHT_VALIDATION=gpu-assisted cargo test -p arealight-tests -p arealight-examples --tests --locked -- \
            --skip the_guard_outlives_the_optimiser --skip pushe
    fi
}

# Counts the tests that had a device, and lists those that were skipped.
check_gpu_tests() {
    local ran skipped
    ran="$(grep '^ran ' "$AREALIGHT_GPU_TEST_LOG" | sort -u | wc -l)"
    skipped="$(grep '^skipped ' "$AREALIGHT_GPU_TEST_LOG" | sort -u)"
    echo "$ran tests had a Vulkan device (required with AREALIGHT_REQUIRE_GPU=1: $gpu_test_floor)"
    [[ -z "$skipped" ]] || echo "$skipped"
    [[ "${AREALIGHT_REQUIRE_GPU:-}" != 1 || "$ran" -ge "$gpu_test_floor" ]]
}

# Runs some of the GPU tests on a second driver, with the same bounds, and what it takes to compile pipelines: what passes on one driver alone is
# tuned to it. Left out of these modules are three tests that ask for more than Vulkan promises: denormals, sin and cos to the last place.
second_driver_floor=27
run_second_driver() {
    local manifest ran
    manifest="$(tools/swiftshader.sh)" || return 1
    : >"$scratch/second-driver"
    VK_ICD_FILENAMES="$manifest" AREALIGHT_REQUIRE_GPU=1 AREALIGHT_GPU_TEST_LOG="$scratch/second-driver" \
        cargo test "${workspace[@]}" --test gpu --quiet -- \
        constants:: surfaces:: output:: frames_in_flight:: frame:: probe:: huge_lights:: parts::a_frame samples:: self_test:: \
        --skip probe::frames_are_orthonormal_whatever_comes_in --skip probe::ggx_is_that_of_the_oracle \
        --skip probe::unit_vectors_and_scales_are_what_they_say || return 1
    VK_ICD_FILENAMES="$manifest" AREALIGHT_REQUIRE_GPU=1 \
        cargo test "${workspace[@]}" --test cli --quiet -- --nocapture compile_budget:: || return 1
    ran="$(grep '^ran ' "$scratch/second-driver" | sort -u | wc -l)"
    echo "$ran tests had the second driver (required: $second_driver_floor)"
    [[ "$ran" -ge "$second_driver_floor" ]]
}

# Builds the checker once, without optimisation: about a minute.
check_licences() {
    cargo deny --version >/dev/null 2>&1 || cargo install cargo-deny@0.20.2 --locked --debug --quiet || return 1
    cargo deny --locked check licenses sources
}

# Debian 12's compiler made the SPIR-V that is checked in: there it must be the same to the byte.
strict=()
if grep -q '^12' /etc/debian_version 2>/dev/null; then strict=(--strict); fi

# Built once, with the tests, and not again for one package: dependencies would have other features
programs="$(realpath -m "${CARGO_TARGET_DIR:-target}")/debug"
xtask="$programs/xtask"

step "format" cargo fmt --all --check
step "programs and tests" cargo build "${workspace[@]}" --all-targets --quiet
step "links of documents" "$xtask" links
step "code in documents is that of the files" "$xtask" quotes --check
step "the product depends on no laboratory" "$xtask" dependencies
step "licences of dependencies" check_licences
step "the product has few public types" "$xtask" types
step "modules need none that needs them" "$xtask" circles
step "lines of code, words of documents, and width" "$xtask" size
step "lints" cargo clippy "${workspace[@]}" --all-targets --quiet -- -D warnings
step "tests" run_tests
step "tests that had a GPU" check_gpu_tests
step "GPU tests, GPU-assisted validation" run_assisted
step "GPU tests on a second driver, SwiftShader" run_second_driver
step "examples in the documentation" cargo test "${workspace[@]}" --doc --quiet
# What it checks of a host in every build: of the crates that it is of, the rest is built
step "the recorder without debug assertions" cargo test --locked --quiet -p arealight-vk --lib \
    --config 'profile.dev.package.arealight.debug-assertions=false' \
    --config 'profile.dev.package.arealight-vk.debug-assertions=false'
# The command line and the library have the same name, and their pages would collide.
step "documentation" env RUSTDOCFLAGS="-D warnings" \
    cargo doc --workspace --exclude arealight-cli --features arealight-examples/window --no-deps --locked --quiet
step "embedded SPIR-V is fresh" "$xtask" shaders --check "${strict[@]}"
step "GLSL library stands alone" "$xtask" includes
step "C header is fresh" "$xtask" header --check
step "C library is found by pkg-config and CMake" tools/test-capi.sh
step "exported GLSL library compiles for hosts of every kind" env AREALIGHT="$programs/arealight" "$xtask" matrix \
    ${AREALIGHT_LONG:+--all}
step "WGSL in a browser answers as the oracle" env AREALIGHT="$programs/arealight" tools/test-web.sh
# A workspace of its own, which takes minutes to build the first time: once, so that its lints are the compiler's
wgpu_example=(--manifest-path examples/wgpu/Cargo.toml --locked --quiet --target-dir "${CARGO_TARGET_DIR:-target}/wgpu")
step "format of the example on wgpu" cargo fmt --manifest-path examples/wgpu/Cargo.toml --check
step "a host on wgpu draws what the Rust example does" env RUSTFLAGS="-D warnings" cargo test "${wgpu_example[@]}"
if [[ "${AREALIGHT_LONG:-}" == 1 ]]; then
    bevy=(--manifest-path examples/bevy/Cargo.toml --locked --quiet --target-dir "${CARGO_TARGET_DIR:-target}/bevy")
    step "format of the plugin for Bevy" cargo fmt --manifest-path examples/bevy/Cargo.toml --check
    step "area lights in Bevy are those of the oracle" env RUSTFLAGS="-D warnings" cargo test "${bevy[@]}"
    site='cargo install -q --locked --root "$0" mdbook && "$0/bin/mdbook" build docs -d "$0/site"'
    step "documents as a site" bash -c "$site" "$PWD/target/book"
fi
step "Python module and its notebook" tools/test-python.sh
step "archives of a release" tools/test-release.sh
step "Blender add-on, without Blender" python3 -B tools/blender/test_lamps.py
step "packages" "$xtask" packages

printf '\n== summary\n'
printf '%s\n' "${summary[@]}"
cat "$scratch/count" 2>/dev/null
if [[ "$failed" -ne 0 ]]; then
    echo "FAILED"
    exit 1
fi
echo "all passed in $SECONDS s"
