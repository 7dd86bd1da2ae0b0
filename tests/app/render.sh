# brume render.
# shellcheck shell=bash

# Nothing here but the cases that say so may need a display.
unset DISPLAY
small=(--resolution 24,20 --quiet)

# draw NAME OPTIONS...: a picture of the blob, NAME.png, with its statistics.
draw() {
  local name=$1
  shift
  [ -e ../blob.nrrd ] || blob ../blob.nrrd
  run render ../blob.nrrd --output "$name.png" --stats "$name.json" "${small[@]}" "$@"
  expect_success
  expect_file "$name.png" "$name.json"
}
same() { cmp -s "$1" "$2" || fail "expected the same picture: $1 $2"; }
differ() { ! cmp -s "$1" "$2" || fail "expected another picture: $1 $2"; }
# expect_stats FILE REGEX
expect_stats() { grep -qE -- "$2" "$1" || fail "expected in $1: $2"; }
# value FILE KEY: a number of the statistics.
value() { sed -nE "s/^  \"$2\": ([^,]*),?$/\1/p" "$1"; }

case_ "--help names each option"
run render --help
expect_success
expect_output '^Usage: brume render INPUT --output FILE \[OPTIONS\]$'
for option in resolution camera-position camera-focal-point camera-view-up camera-view-angle \
  camera-parallel-scale background preset opacity-unit-distance shade ambient diffuse specular specular-power interpolation \
  blend-mode isovalues average-range cropping cropping-flags clipping-plane mask \
  sample-distance tolerance threads quiet verbose output mapper stats exposure display-curve; do
  expect_output "[-][-]$option\b"
done
[ "$(wc -L < ../out)" -le 80 ] || fail "expected lines of at most 80 columns"

case_ "a PNG with statistics"
draw a
head -c 8 a.png | grep -q PNG || fail "expected a PNG file"
for key in mapper seconds seconds_prepare samples rays threads simd effects non_finite_voxels \
  radiometric peak_memory_bytes; do
  expect_stats a.json "^  \"$key\": "
done
for key in name on reason error_bound; do
  expect_stats a.json "^      \"$key\": "
done
expect_stats a.json '"mapper": "raymarch"'
[ "$(value a.json rays)" -le 480 ] || fail "expected at most a ray a pixel"
expect_only a.png a.json

case_ "an EXR with its channels, the same for 1 and 2 threads"
blob ../blob.nrrd
for n in 1 2; do
  run render ../blob.nrrd --output $n.exr --stats $n.json --threads $n "${small[@]}"
  expect_success
  expect_stats $n.json "\"threads\": $n,"
done
for channel in R G B A transmittance.R transmittance.G transmittance.B Z; do
  grep -qaF "$channel" 1.exr || fail "expected the channel $channel"
done
# The time of writing stands in the header alone; the pixels follow it.
tail -c 1500 1.exr > ../1.pixels
tail -c 1500 2.exr > ../2.pixels
same ../1.pixels ../2.pixels

case_ "it needs neither a display nor Xvfb"
blob ../blob.nrrd
PATH=/nonexistent "$BRUME" render ../blob.nrrd --output a.png "${small[@]}" > ../out 2> ../err
status=$?
expect_success
expect_only a.png

case_ "each option of the scene changes the picture"
draw plain
while read -r name options; do
  # shellcheck disable=SC2086
  draw "$name" $options
  differ plain.png "$name.png"
done << 'END'
position --camera-position 40,-20,7
focal --camera-focal-point 9,7,7
up --camera-view-up 1,0,0.2
parallel --camera-parallel-scale 12
background --background 0.2,0.4,0.6
preset --preset ct-skin
distance --opacity-unit-distance 20
nearest --interpolation nearest
shade --shade off
ambient --ambient 0.5
diffuse --diffuse 0.5
specular --specular 0.5
power --specular-power 40
step --sample-distance 6
END

case_ "the values of the options are those that were given"
blob ../blob.nrrd
eye=(--camera-position 7.5,-60,7.5 --camera-focal-point 7.5,7.5,7.5)
draw narrow "${eye[@]}" --camera-view-angle 20
draw wide "${eye[@]}" --camera-view-angle 60
differ narrow.png wide.png
# tan(10°) · 67.5 = 11.90: parallel and perspective then see the same height, not the same picture.
draw parallel "${eye[@]}" --camera-parallel-scale 11.9
differ narrow.png parallel.png
draw step --sample-distance 0.25
expect_stats step.json '"step": 0.25,'
expect_stats step.json '"step_chosen_by": "caller"'
draw tight --tolerance 0.0005
draw loose --tolerance 0.1
expect_stats tight.json '"tolerance": 0.0005'
awk -v a="$(value tight.json step)" -v b="$(value loose.json step)" 'BEGIN { exit !(a < b) }' ||
  fail "expected a longer step for a larger tolerance"
run render ../blob.nrrd --output size.png --resolution 31,17 --quiet
expect_success
[ "$(od -An -tu1 -j16 -N8 size.png | tr -s ' ')" = " 0 0 0 31 0 0 0 17" ] ||
  fail "expected 31 x 17 pixels"

case_ "terms of shading in place of the preset's"
draw preset --preset mr-default
draw same --preset mr-default --ambient 0.25 --diffuse 0.75 --specular 0.15 --specular-power 10
same preset.png same.png
blob ../blob.nrrd
for words in "--shade off" "--extinction 0.1" "--shade on --blend-mode mip"; do
  # shellcheck disable=SC2086
  run render ../blob.nrrd --output a.png --resolution 8,8 --specular 1 $words
  expect_status 0
  expect_error '^brume: --specular: it changes nothing: '
  # shellcheck disable=SC2086
  run render ../blob.nrrd --output a.png --resolution 8,8 --specular 1 $words --quiet
  expect_success
done

case_ "--quiet says nothing, --verbose says why"
blob ../blob.nrrd
run render ../blob.nrrd --output a.png --resolution 8,8 --verbose
expect_status 0
expect_error 'preset mr-default'
expect_error '"seconds"'
filled ../nan.nrrd nan 4 4 4
{ head -n 6 ../nan.nrrd; yes 0.5 | head -n 60; yes nan | head -n 4; } > ../holes.nrrd
run render ../holes.nrrd --output b.png --resolution 8,8
expect_status 0
expect_error '4 voxels are not finite'
run render ../holes.nrrd --output b.png --resolution 8,8 --quiet
expect_success

case_ "volumes that hold nothing, or little"
filled ../nan.nrrd nan 4 4 4
run render ../nan.nrrd --output nan.png "${small[@]}"
expect_failure 1
expect_no_files
filled ../same.nrrd 5 4 4 4
run render ../same.nrrd --output same.png "${small[@]}"
expect_success
filled ../slice.nrrd 5 8 8 1
run render ../slice.nrrd --output slice.png "${small[@]}"
expect_success
filled ../point.nrrd 5 1 1 1
run render ../point.nrrd --output point.png "${small[@]}"
expect_success
# Air: nothing of it is to be seen with ct-bone, so that the picture is the background's.
filled ../air.nrrd -1000 4 4 4
run render ../air.nrrd --preset ct-bone --background 1,1,1 --output air.png "${small[@]}"
expect_success
filled ../air.nrrd -2000 4 4 4
run render ../air.nrrd --preset ct-bone --background 1,1,1 --output void.png "${small[@]}"
expect_success
same air.png void.png

case_ "several numbers a voxel"
# vector N FILE
vector() {
  printf 'NRRD0004\ntype: float\ndimension: 4\nsizes: %d 2 2 2\nkinds: vector domain domain domain\nencoding: ascii\n\n' "$1" > "$2"
  yes 1 | head -n $((8 * $1)) >> "$2"
}
vector 5 ../five.nrrd
run render ../five.nrrd --output a.png "${small[@]}"
expect_failure 1
expect_no_files
vector 3 ../three.nrrd
run render ../three.nrrd --output a.png "${small[@]}"
expect_success
expect_only a.png

case_ "steps without measure"
draw huge --sample-distance 1e20
run render ../blob.nrrd --output tiny.png "${small[@]}" --sample-distance 1e-12
expect_failure 2
expect_error 'more than a million steps'
expect_no_file tiny.png

case_ "a camera that sees nothing"
blob ../blob.nrrd
run render ../blob.nrrd --output a.png --camera-position 1,1,1 --camera-focal-point 1,1,1
expect_failure 2
expect_error '^brume: --camera-position: '
run render ../blob.nrrd --output a.png --camera-position 1,1,9 --camera-focal-point 1,1,1
expect_failure 2
expect_error '^brume: --camera-view-up: '
run render ../blob.nrrd --output a.png --camera-view-up 0,0,0
expect_failure 2
expect_no_files

case_ "cuts change the picture, and cuts that cut nothing do not"
draw plain
draw box --cropping 4,12,4,12,4,12
differ plain.png box.png
draw far --cropping -100,100,-100,100,-100,100
same plain.png far.png
draw inverted --cropping 4,12,4,12,4,12 --cropping-flags inverted-fence
differ box.png inverted.png
draw middle --cropping 4,12,4,12,4,12 --cropping-flags 0x2000
same box.png middle.png
draw everything --cropping 4,12,4,12,4,12 --cropping-flags 0x7ffffff
# Rays are divided at the planes: the same light, to rounding.
draw half --clipping-plane 1,0,0,-7
differ plain.png half.png
draw scaled --clipping-plane 10,0,0,-70
same half.png scaled.png
draw quarter --clipping-plane 1,0,0,-7 --clipping-plane 0,-1,0,7
differ half.png quarter.png
draw nothing --clipping-plane 1,0,0,-100
draw other_side --clipping-plane -1,0,0,-100
same nothing.png other_side.png
differ plain.png nothing.png

case_ "a mask"
blob ../blob.nrrd
awk 'NR < 7 { print; next } { print NR % 2 }' ../blob.nrrd > ../mask.nrrd
draw plain
draw masked --mask ../mask.nrrd
differ plain.png masked.png
draw whole --mask ../blob.nrrd
filled ../other.nrrd 1 4 4 4
run render ../blob.nrrd --output a.png --mask ../other.nrrd "${small[@]}"
expect_failure 1
expect_error '4 x 4 x 4'
expect_no_file a.png
run render ../blob.nrrd --output a.png --mask ../none.nrrd "${small[@]}"
expect_failure 1
expect_no_file a.png

case_ "options of modes that do not fit together"
for options in "--isovalues 3" "--blend-mode isosurface" "--average-range 1,2" \
  "--cropping 1,0,0,1,0,1" "--cropping-flags fence" "--blend-mode mip --isovalues 3"; do
  # shellcheck disable=SC2086
  run render sample:cloud --output a.png $options
  expect_failure 2
  expect_no_files
done
run render sample:cloud --output a.png --mapper vtk-fixed-point --blend-mode additive
expect_failure 2
expect_error 'additive'

bad_calls render a.png
bad_inputs render --output a.png "${small[@]}"

case_ "exposure and display curve"
draw plain
draw brighter --exposure 1
differ plain.png brighter.png
expect_stats brighter.json '"exposure": 1.0'
draw srgb --display-curve srgb
differ plain.png srgb.png
expect_stats srgb.json '"display_curve": "srgb"'
draw same --exposure 0 --display-curve none
same plain.png same.png
for options in "--exposure nan" "--exposure 100" "--display-curve gamma"; do
  # shellcheck disable=SC2086
  run render ../blob.nrrd --output a.png $options
  expect_failure 2
  expect_error "^brume: ${options%% *}"
done
run render ../blob.nrrd --output a.exr --exposure 1
expect_failure 2
run render ../blob.nrrd --output a.exr --display-curve srgb
expect_failure 2
expect_no_file a.png a.exr

case_ "outputs that cannot be"
blob ../blob.nrrd
for place in a.jpg a "" a.png/; do
  run render ../blob.nrrd --output "$place"
  expect_failure 2
done
mkdir folder.png
for place in none/a.png folder.png; do
  run render ../blob.nrrd --output "$place"
  expect_failure 1
done
run render ../blob.nrrd --output a.png --stats none/a.json
expect_failure 1
run render ../blob.nrrd --output a.png --stats ./a.png
expect_failure 2
run render ../blob.nrrd --output a.png --mapper nonsense
expect_failure 2
expect_error 'vtk-gpu'
expect_no_files

case_ "what was there is kept when the call fails, and replaced when it does not"
echo former > a.png
remember a.png
run render ../none.nrrd --output a.png "${small[@]}"
expect_failure 1
expect_unchanged
draw a
head -c 8 a.png | grep -q PNG || fail "expected a new picture"

if [ -c /dev/full ]; then
  case_ "a full disk"
  blob ../blob.nrrd
  run render ../blob.nrrd --output a.png --stats /dev/full "${small[@]}"
  expect_failure 1
  expect_error '/dev/full'
fi

case_ "without a display VTK's own mappers draw on a virtual one"
if command -v Xvfb > /dev/null; then
  blob ../blob.nrrd
  run render ../blob.nrrd --output a.exr --stats a.json --mapper vtk-fixed-point "${small[@]}"
  expect_success
  for key in mapper seconds seconds_prepare samples rays threads simd effects non_finite_voxels \
    radiometric peak_memory_bytes; do
    expect_stats a.json "^  \"$key\": "
  done
  expect_only a.exr a.json
fi

case_ "without a display and without Xvfb one line says so"
blob ../blob.nrrd
command="brume render --mapper vtk-gpu"
PATH=/nonexistent DISPLAY=:9999 "$BRUME" render ../blob.nrrd --output a.png --mapper vtk-gpu \
  "${small[@]}" > ../out 2> ../err
status=$?
expect_failure 1
expect_error 'xvfb'
expect_no_files

for signal in INT TERM; do
  case_ "SIG$signal while it renders"
  blob ../blob.nrrd
  interrupted $signal 1 render ../blob.nrrd --output a.png --resolution 2000,2000 --sample-distance 0.001
  expect_failure 1
  expect_error 'interrupted'
  expect_no_files
done

case_ "a bar on a terminal, none with --quiet"
if command -v script > /dev/null; then
  blob ../blob.nrrd
  for quiet in "" --quiet; do
    script -qec "timeout -s INT 8 '$BRUME' render ../blob.nrrd --output a.png \
      --resolution 2000,2000 --sample-distance 0.001 $quiet" /dev/null > ../bar"$quiet" < /dev/null
  done
  grep -q 'rendering \[#* *\]' ../bar || fail "expected a bar"
  ! grep -q 'rendering' ../bar--quiet || fail "expected no bar"
  expect_no_files
fi
