#!/usr/bin/env bash
# Checks for a night: tools/nightly.sh [MINUTES [SEEDS]]. MINUTES (60) of each fuzz target, SEEDS (100) times ten thousand hard
# polygons and shapes of each family, a million damaged tables, then tools/test.sh in its long form. Goes on after a check that
# fails, names those that did, and fails.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
minutes="${1:-60}" seeds="${2:-100}" failed=()
check() { printf '\n== %s\n' "$*"; "$@" || failed+=("$*"); }

# A stable compiler has libFuzzer's counters, but not the address sanitizer
target=x86_64-unknown-linux-gnu folder="$(realpath -m "${CARGO_TARGET_DIR:-fuzz/target}")"
counters="--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 -Ccodegen-units=1 -Cdebug-assertions \
-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
-Cllvm-args=-sanitizer-coverage-trace-compares"
check env RUSTFLAGS="$counters" cargo build --release --locked --quiet --manifest-path fuzz/Cargo.toml --target $target \
    --target-dir "$folder"
for seed_folder in fuzz/seeds/*; do
    name="$(basename "$seed_folder")"
    mkdir -p "fuzz/corpus/$name"
    check "$folder/$target/release/$name" "fuzz/corpus/$name" "$seed_folder" -artifact_prefix="fuzz/corpus/$name/" \
        -max_len=20000 -malloc_limit_mb=2200 -max_total_time=$((60 * minutes)) -verbosity=0 -print_final_stats=1
done

SHADERC_LIB_DIR="$(tools/shaderc.sh)" || failed+=(tools/shaderc.sh)
export SHADERC_LIB_DIR
check cargo build --release --locked --quiet -p arealight-cli
for ((seed = 1; seed <= seeds; seed++)); do
    for kind in "" --shapes; do
        # shellcheck disable=SC2086 # no kind is no argument
        check "${CARGO_TARGET_DIR:-target}/release/arealight" bench stability --quiet --seed "$seed" $kind
    done
done
AREALIGHT_DAMAGE_CASES=1000000 check cargo test --release --locked --quiet -p arealight-table random_damage
AREALIGHT_LONG=1 check tools/test.sh

printf '\n%s checks failed\n' "${#failed[@]}"
printf '%s\n' "${failed[@]}"
[[ "${#failed[@]}" == 0 ]]
