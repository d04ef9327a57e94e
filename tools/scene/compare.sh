#!/usr/bin/env bash
# Renders the five scenes beside their references, as docs/scenes.md shows them: tools/scene/compare.sh AREALIGHT FOLDER.
# Writes SCENE.png and SCENE-reference.png, with shadows, and prints a row of the table for each scene: of radiance without shadows the ratio of
# the means and the root of the mean squared difference over the mean, by the default level, and by half vectors. With `levels` after the folder,
# and the names of scenes (else all), instead rows of what a screen shows, in levels of 255 and blocks of 4 x 4: without and with shadows, each
# with the part of colour. Two references tell their noise, which is taken off.
set -euo pipefail
arealight=$1 folder=$2
scenes=$(dirname "$0")/../../scenes
mkdir -p "$folder"

# SCENE SAMPLES SHADOWED: the reference's samples a pixel and light, for the row, and for the picture, where each casts a ray
compare() {
  local scene=$1 samples=$2 shadowed=$3 view stops noise lobes row="| \`$1.glb\` | $2 |" ours=$folder/$1.exr reference=$folder/$1-reference.exr
  view=(render "$scenes/$scene.glb" --size 400x225)
  "$arealight" "${view[@]}" -o "$reference" --shadows off --reference "$samples" >"$folder/log" 2>&1
  for lobes in one half-vectors; do
    "$arealight" "${view[@]}" -o "$ours" --shadows off --specular-lobes $lobes >"$folder/log" 2>&1
    row+=$("$arealight" compare "$ours" "$reference" --json |
      sed -n 's/^ *"\(rmse_over_mean\|mean_ratio\)": \([-+.0-9e]*\),*$/\2/p' | xargs printf " %.3f | %.3f |")
  done
  echo "$row"
  # Sixty lights take eighty rays a pixel for twice the noise
  noise=0.5; if [[ $scene == shop ]]; then noise=1; fi
  stops=$("$arealight" "${view[@]}" -o "$folder/$scene.png" --exposure auto --shadow-noise "$noise" --json 2>/dev/null |
    sed -n 's/^ *"exposure": \([-+.0-9e]*\),*$/\1/p')
  "$arealight" "${view[@]}" -o "$folder/$scene-reference.png" --exposure "$stops" --reference "$shadowed" >"$folder/log" 2>&1
}

# SCENE SAMPLES: prints a row of the table of levels, as a screen shows both: without shadows, with them, and of those the part of colour
levels() {
  local view=(render "$scenes/$1.glb" --size 384x216) row="| \`$1.glb\` |" stops shadows seed
  stops=0; if [[ $1 == luminaires ]]; then stops=5.8; fi
  for shadows in off filtered:1; do
    "$arealight" "${view[@]}" -o "$folder/ours.exr" --shadows $shadows >"$folder/log" 2>&1
    for seed in 1 2; do
      "$arealight" "${view[@]}" -o "$folder/reference$seed.exr" --shadows $shadows --reference "$2" --seed $seed >"$folder/log" 2>&1
    done
    row+=$("$arealight" compare "$folder/ours.exr" "$folder/reference1.exr" "$folder/reference2.exr" --exposure "$stops" --json |
      sed -n 's/^ *"levels[_a-z]*": \([.0-9e]*\),*$/\1/p' | xargs printf " %.1f | %.1f |")
  done
  echo "$row"
}

if [[ ${3:-} == levels ]]; then
  all=("$scenes"/*.glb)
  if [[ $# == 3 ]]; then set -- "$@" "${all[@]}"; fi
  for scene in "${@:4}"; do levels "$(basename "$scene" .glb)" 32; done
  exit
fi

compare studio 1024 64
compare interior 256 64
compare neon 1024 64
compare shop 256 32
compare product 1024 64
