#!/usr/bin/env bash
# Renders the five scenes beside their references, as docs/scenes.md shows them: tools/scene/compare.sh AREALIGHT FOLDER.
# Writes SCENE.png and SCENE-reference.png, with shadows, and prints a row of the table for each scene: the ratio of the means and the
# root of the mean squared difference over the mean, of radiance without shadows.
set -euo pipefail
arealight=$1 folder=$2
scenes=$(dirname "$0")/../../scenes
mkdir -p "$folder"

# SCENE SAMPLES: of the reference's picture, a pixel and light; each casts a ray
compare() {
  local scene=$1 samples=$2 view stops ours=$folder/$1.exr reference=$folder/$1-reference.exr
  view=(render "$scenes/$scene.glb" --size 400x225)
  "$arealight" "${view[@]}" -o "$ours" --shadows off >"$folder/log" 2>&1
  "$arealight" "${view[@]}" -o "$reference" --shadows off --reference 256 >"$folder/log" 2>&1
  "$arealight" compare "$ours" "$reference" --json |
    sed -n 's/^ *"\(rmse_over_mean\|mean_ratio\)": \([-+.0-9e]*\),*$/\2/p' | xargs printf "| \`$scene.glb\` | %.3f | %.3f |\n"
  stops=$("$arealight" "${view[@]}" -o "$folder/$scene.png" --exposure auto --json 2>/dev/null |
    sed -n 's/^ *"exposure": \([-+.0-9e]*\),*$/\1/p')
  "$arealight" "${view[@]}" -o "$folder/$scene-reference.png" --exposure "$stops" --reference "$samples" >"$folder/log" 2>&1
}

compare studio 64
compare interior 64
compare neon 24
compare shop 8
compare product 64
