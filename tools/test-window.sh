#!/usr/bin/env bash
# The test of the deferred example's window, on a screen that needs no monitor: what is seen is what the engine draws, with a silent
# validation layer. Not a part of tools/test.sh, which only compiles it: winit takes longer to build than the test to run.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
export PATH="$PATH:${HOME:-/root}/.cargo/bin"
tools/setup.sh window
AREALIGHT_REQUIRE_GPU=1 cargo test -p arealight-examples --features window --test window --locked
