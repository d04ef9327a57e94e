#!/usr/bin/env bash
# Runs the exported WGSL in a browser, Chromium without a screen, whose WebGPU is SwiftShader's, on the CPU:
#
#   tools/test-web.sh            shades the points of examples/web/points.json there, drags a lamp of the page, and compares both with the
#                                oracle's answers, in float64
#   tools/test-web.sh picture    draws examples/web into target/web/picture.png
#   tools/test-web.sh serve      serves the page to a browser of yours, until it is interrupted
#   tools/test-web.sh folder     puts the page and what it loads into target/web, for any host of static files
#
# The program `arealight` is target/debug/arealight, built if need be, or $AREALIGHT.
set -euo pipefail

mode="${1:-test}"
if [[ "$mode" != test && "$mode" != picture && "$mode" != serve && "$mode" != folder ]]; then
    echo "usage: tools/test-web.sh [test|picture|serve|folder]" >&2
    exit 2
fi
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
cd "$root"
arealight="${AREALIGHT:-${CARGO_TARGET_DIR:-target}/debug/arealight}"
if [[ -z "${AREALIGHT:-}" ]]; then cargo build --quiet --locked -p arealight-cli; fi

# Put the page and an export into one folder
folder="${CARGO_TARGET_DIR:-$root/target}/web"
rm -rf "$folder"
mkdir -p "$folder"
cp examples/web/* "$folder/"
cp docs/images/moving-light.gif "$folder/film.gif" # where a browser has no WebGPU
"$arealight" export "$folder/export" --target webgpu --effects diffuse,glossy >/dev/null

if [[ "$mode" == folder ]]; then exit 0; fi
if [[ "$mode" == serve ]]; then
    echo "http://127.0.0.1:PORT/index.html, until Ctrl+C; PORT is"
    exec python3 tools/web_server.py "$folder"
fi

scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT

# Opens the page in the browser, and waits for what it posts. The browser looks for nothing on the network, and its watchdog, which ends
# a driver that compiles for ten seconds, sleeps.
flags=(--headless --no-sandbox --no-first-run --disable-background-networking --disable-component-update --disable-sync --disable-quic
    --disable-gpu-watchdog --enable-unsafe-webgpu --use-webgpu-adapter=swiftshader --use-vulkan=swiftshader --use-angle=swiftshader --enable-features=Vulkan --enable-logging=stderr)
open_page_once() { # the part of the address after #, the file that what is posted goes to
    local server browser port=""
    : >"$scratch/port"
    timeout 90 python3 tools/web_server.py "$folder" "$2" >"$scratch/port" &
    server=$!
    for _ in $(seq 100); do
        port="$(cat "$scratch/port")"
        [[ -n "$port" ]] && break
        sleep 0.1
    done
    [[ -n "$port" ]] || { echo "error: tools/web_server.py does not start" >&2; return 1; }
    rm -rf "$scratch/profile"
    timeout 100 chromium "${flags[@]}" --user-data-dir="$scratch/profile" "http://127.0.0.1:$port/index.html#$1" \
        >/dev/null 2>"$scratch/browser.log" </dev/null &
    browser=$!
    wait "$server" || true
    kill "$browser" 2>/dev/null || true
    wait "$browser" 2>/dev/null || true
    [[ -s "$2" ]]
}

# Opens the page again where a browser does not come up: what is tested is what the page says, not that every start of a browser succeeds.
open_page() { # as above
    for _ in 1 2 3; do
        if open_page_once "$@"; then return 0; fi
        echo "the page posts nothing in 90 s; the browser's last words:" >&2
        tail -20 "$scratch/browser.log" >&2
    done
    return 1
}

if [[ "$mode" == picture ]]; then
    open_page post-picture "$folder/picture.png"
    echo "$folder/picture.png"
    exit 0
fi

# Compares a page's answers with the oracle's: the largest relative error of a point. float32 and a table of half floats leave 1e-4 or so
compare() { # the part of the address after #, and a file of points; without one the page posts them
    open_page "$1" "$scratch/$1.json" || return 3
    if ! grep -q '"results"' "$scratch/$1.json"; then
        cat "$scratch/$1.json" >&2
        return 3
    fi
    "$arealight" eval "${2:-$scratch/$1.json}" --on oracle --specular-lobes one --against "$scratch/$1.json" --tolerance 1e-3
}
must_differ() { # as above
    local status=0
    compare "$@" || status=$?
    [[ "$status" -eq 1 ]] || { echo "error: that is not found (exit code $status)" >&2; exit 1; }
}

echo "With the table as exported:"
compare test "$folder/points.json"
echo "With its first layer alone, which must differ:"
must_differ test-first-layer "$folder/points.json"
echo "By the clipless method, the page's other half, which must differ:"
must_differ test-clipless "$folder/points.json"
echo "A lamp that a pointer has dragged, in the page's own picture:"
compare test-drag
echo "The same as if it had stayed, which must differ:"
must_differ test-drag-from
self_test() { # the part of the address after #, and which points are wrong, a bit each
    open_page "$1" "$scratch/$1"
    [[ "$(<"$scratch/$1")" == "wrong points: $2" ]] || { cat "$scratch/$1" >&2; exit 1; }
}
echo "The exported self-test, whose ten points fail with the table's first layer alone:"
self_test test-self 0
self_test test-self-first-layer 1023
echo "ok: WGSL in a browser answers as the oracle does, also of what is dragged; a wrong table and a wrong place show"
