# Scene files: --scene.
# shellcheck shell=bash

unset DISPLAY
small=(--resolution 24,20 --quiet)
# A density with light; the steps are given, so that nothing is chosen by the picture.
lit=(--extinction 0.02 --sample-distance 1)
same() { cmp -s "$1" "$2" || fail "expected the same picture: $1 $2"; }
differ() { ! cmp -s "$1" "$2" || fail "expected another picture: $1 $2"; }

case_ "a scene file says what options say"
blob ../blob.nrrd
cat > ../scene.json << 'END'
{
  "$schema": "scene.schema.json",
  "input": "blob.nrrd",
  "resolution": [24, 20],
  "quiet": true,
  "extinction": 0.02,
  "sample-distance": 1,
  "sun-direction": [1, -1, 1],
  "sun-irradiance": [3, 2, 1],
  "albedo": [1, 0.9, 0.8],
  "phase": "hg:0.5:0.7,rayleigh:0.3",
  "octaves": 3,
  "fog-extinction": 0.001,
  "shadows": "rays",
  "force": { "phase-anisotropy": true, "ambient": false },
  "clipping-plane": [[1, 0, 0, -3], [0, 1, 0, -1.5]],
  "point-light": [[40, 0, 0], [0, 0, 40, 0, 0, 1]]
}
END
run render --scene ../scene.json --output a.png
expect_success
run render ../blob.nrrd --output b.png "${small[@]}" --extinction 0.02 --sample-distance 1 \
  --sun-direction 1,-1,1 --sun-irradiance 3,2,1 --albedo 1,0.9,0.8 --phase hg:0.5:0.7,rayleigh:0.3 \
  --octaves 3 --fog-extinction 0.001 --shadows rays --force phase-anisotropy=on --force ambient=off \
  --clipping-plane 1,0,0,-3 --clipping-plane 0,1,0,-1.5 --point-light 40,0,0 --point-light 0,0,40,0,0,1
expect_success
same a.png b.png
run render --scene ../scene.json --output c.png --albedo 0.2
expect_success
differ a.png c.png

case_ "the command line wins, and silences what it excludes"
blob ../blob.nrrd
echo '{ "input": "none.nrrd", "extinction": 0.02, "albedo": 0.5, "phase": "rayleigh", "verbose": true }' > ../scene.json
run render ../blob.nrrd --scene ../scene.json --output a.png "${small[@]}" --preset cloud --anisotropy 0.5
expect_success
run render ../blob.nrrd --output b.png "${small[@]}" --preset cloud --anisotropy 0.5 --albedo 0.5
expect_success
same a.png b.png

case_ "lists of lights and lobes"
blob ../blob.nrrd
# as_file NAME JSON, as_words NAME OPTIONS...: the same scene in two ways.
as_file() {
  echo "$2" > ../scene.json
  run render ../blob.nrrd --scene ../scene.json --output "$1.png" "${small[@]}" "${lit[@]}"
  expect_success
}
as_words() {
  local name=$1
  shift
  run render ../blob.nrrd --output "$name.png" "${small[@]}" "${lit[@]}" "$@"
  expect_success
}
as_file sun '{ "lights": [{ "type": "directional", "direction": [-1, 1, -1] }] }'
as_words sun-words --sun-direction 1,-1,1
same sun.png sun-words.png
as_file coloured '{ "lights": [{ "type": "directional", "direction": [-1, 1, -1], "colour": [1, 0.5, 0.25], "intensity": 2 }] }'
differ sun.png coloured.png
as_file point '{ "lights": [{ "type": "point", "position": [40, 0, 20] }] }'
as_words point-words --point-light 40,0,20
same point.png point-words.png
as_file falls '{ "lights": [{ "type": "point", "position": [40, 0, 20], "attenuation": [0, 0, 0.001] }] }'
differ point.png falls.png
as_file spot '{ "lights": [{ "type": "spot", "position": [40, 0, 20], "direction": [-33, 7, -13], "cone-angle": 5 }] }'
differ point.png spot.png
as_file wide '{ "lights": [{ "type": "spot", "position": [40, 0, 20], "direction": [-33, 7, -13], "cone-angle": 40, "exponent": 30 }] }'
differ spot.png wide.png
as_file head '{ "lights": [{ "type": "headlight" }] }'
as_words head-words --albedo 1
same head.png head-words.png
as_file none '{ "lights": [{ "type": "headlight", "intensity": 0 }] }'
as_words none-words --albedo 0
same none.png none-words.png
as_file lobes '{ "lobes": [{ "function": "hg", "anisotropy": 0.8, "weight": 0.7 }, { "function": "rayleigh", "weight": 0.3 }] }'
as_words lobes-words --phase hg:0.8:0.7,rayleigh:0.3
same lobes.png lobes-words.png
run render ../blob.nrrd --scene ../scene.json --output over.png "${small[@]}" "${lit[@]}" --anisotropy 0.1
expect_success
as_words over-words --anisotropy 0.1
same over.png over-words.png

# Scene files that are refused: a line has what the file holds, a |, and the place and the reason.
while IFS='|' read -r content reason; do
  case_ "refused: $content"
  blob ../blob.nrrd
  printf '%s' "$content" > ../scene.json
  run render ../blob.nrrd --output a.png --scene ../scene.json
  expect_failure 2
  expect_error "^brume: \.\./scene\.json: $reason"
  expect_no_files
done << 'END'
|parse error at line 1
{ "albedo": 1, }|parse error at line 1
{ "albedo": 1e999 }|
[1]|it holds no JSON object
{ "albdeo": 1 }|/albdeo: there is no such key: did you mean "albedo"
{ "output": "a.png" }|/output: there is no such key
{ "a/b": 1 }|/a~1b: there is no such key
{ "albedo": 1, "albedo": 0 }|the key "albedo" is given twice
{ "albedo": "1" }|/albedo: "1" is not a number or a list of 3
{ "albedo": [1, 2] }|/albedo: \[1,2\] is not a number or a list of 3
{ "albedo": [1, "a", 1] }|/albedo/1: "a" is not a number
{ "albedo": 2 }|/albedo: '2' is not one or three numbers from 0 to 1
{ "sun-direction": 1 }|/sun-direction: 1 is not a list of 3 numbers
{ "sun-direction": [0, 0, "z"] }|/sun-direction/2: "z" is not a number
{ "octaves": 2.5 }|/octaves: '2.5' is not a whole number
{ "octaves": true }|/octaves: true is not a number
{ "quiet": 1 }|/quiet: 1 is not true or false
{ "shade": true }|/shade: true is not one of on, off, preset
{ "shade": "maybe" }|/shade: 'maybe' is not one of
{ "preset": 3 }|/preset: 3 is not a text
{ "mask": 3 }|/mask: 3 is not the name of a file
{ "mesh": [3] }|/mesh/0: 3 is not the name of a file
{ "force": ["shadows=on"] }|/force: \["shadows=on"\] is not an object
{ "force": { "shadows": "on" } }|/force/shadows: "on" is not true or false
{ "force": { "shadow": true } }|/force: 'shadow' is not one of
{ "clipping-plane": [1, 0, 0, 0] }|/clipping-plane/0: 1 is not a list of 4 numbers
{ "clipping-plane": [[1, 0, 0]] }|/clipping-plane/0: \[1,0,0\] is not a list of 4 numbers
{ "extinction": 1, "preset": "ct-bone" }|/[a-z]*: it excludes
{ "lobes": [], "phase": "rayleigh" }|/lobes: it excludes "phase"
{ "lights": {} }|/lights: it is not a list
{ "lights": [3] }|/lights/0: 3 is not an object
{ "lights": [{}] }|/lights/0: "type" is missing
{ "lights": [{ "type": "sun" }] }|/lights/0/type: "sun" is not one of directional
{ "lights": [{ "type": "directional" }] }|/lights/0: a directional light needs "direction"
{ "lights": [{ "type": "directional", "direction": [0, 0, 0] }] }|/lights/0/direction: 0, 0, 0 is no direction
{ "lights": [{ "type": "directional", "direction": [0, 0, 1], "position": [0, 0, 0] }] }|/lights/0/position: a directional light has no such key
{ "lights": [{ "type": "headlight" }, { "type": "point", "position": [0, 0] }] }|/lights/1/position: \[0,0\] is not a list of 3 numbers
{ "lights": [{ "type": "headlight", "color": [1, 1, 1] }] }|/lights/0/color: a headlight light has no such key: did you mean "colour"
{ "lights": [{ "type": "headlight", "intensity": -1 }] }|/lights/0/intensity: -1 is not a number of 0 or more
{ "lobes": [{ "function": "hg" }] }|/lobes/0: a hg lobe needs "anisotropy"
{ "lobes": [{ "function": "hg", "anisotropy": 1 }] }|/lobes/0/anisotropy: 1 is not a number between -1 and 1
{ "lobes": [{ "function": "mie" }] }|/lobes/0/function: "mie" is not one of
{ "lobes": [{ "function": "rayleigh", "anisotropy": 0.5 }] }|/lobes/0/anisotropy: a rayleigh lobe has no such key
END

case_ "compare and plan read the same files"
blob ../blob.nrrd
echo '{ "albdeo": 1 }' > ../scene.json
run compare ../blob.nrrd --output a --scene ../scene.json
expect_failure 2
expect_error '^brume: \.\./scene\.json: /albdeo: '
run plan ../blob.nrrd --scene ../scene.json
expect_failure 2
expect_error '^brume: \.\./scene\.json: /albdeo: '
echo '{ "input": "blob.nrrd", "extinction": 0.02, "albedo": 1, "quiet": true }' > ../scene.json
run plan --scene ../scene.json
expect_success
expect_output '^scattering +yes'
run compare --scene ../scene.json --output a --mappers raymarch --resolution 24,24 --repetitions 1
expect_success
grep -q '"shadow_method"' a/compare.json || fail "expected the statistics of a lit medium"

case_ "a scene file that is a folder, or not text"
mkdir ../folder.json
run plan sample:cloud --scene ../folder.json
expect_failure 1
head -c 2000 /dev/urandom > ../noise.json
run plan sample:cloud --scene ../noise.json
expect_failure 2
run plan sample:cloud --scene ../noise.json --scene ../noise.json
expect_failure 2
expect_no_files
