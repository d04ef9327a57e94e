#!/usr/bin/env bash
# Renders the five scenes beside their references, as docs/scenes.md shows them: tools/scene/compare.sh AREALIGHT FOLDER.
# Writes SCENE.png and SCENE-reference.png, with shadows, and prints a row of the table for each scene: of radiance without shadows the ratio of
# the means and the root of the mean squared difference over the mean, by the default level, and by half vectors.
set -euo pipefail
arealight=$1 folder=$2
scenes=$(dirname "$0")/../../scenes
mkdir -p "$folder"

# SCENE SAMPLES SHADOWED: the reference's samples a pixel and light, for the row, and for the picture, where each casts a ray
compare() {
  local scene=$1 samples=$2 shadowed=$3 view stops lobes row="| \`$1.glb\` | $2 |" ours=$folder/$1.exr reference=$folder/$1-reference.exr
  view=(render "$scenes/$scene.glb" --size 400x225)
  "$arealight" "${view[@]}" -o "$reference" --shadows off --reference "$samples" >"$folder/log" 2>&1
  for lobes in one half-vectors; do
    "$arealight" "${view[@]}" -o "$ours" --shadows off --specular-lobes $lobes >"$folder/log" 2>&1
    row+=$("$arealight" compare "$ours" "$reference" --json |
      sed -n 's/^ *"\(rmse_over_mean\|mean_ratio\)": \([-+.0-9e]*\),*$/\2/p' | xargs printf " %.3f | %.3f |")
  done
  echo "$row"
  stops=$("$arealight" "${view[@]}" -o "$folder/$scene.png" --exposure auto --json 2>/dev/null |
    sed -n 's/^ *"exposure": \([-+.0-9e]*\),*$/\1/p')
  "$arealight" "${view[@]}" -o "$folder/$scene-reference.png" --exposure "$stops" --reference "$shadowed" >"$folder/log" 2>&1
}

compare studio 1024 64
compare interior 256 64
compare neon 1024 64
compare shop 256 32
compare product 1024 64
