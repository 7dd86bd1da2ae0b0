# Sparse volumes: brume info, render and compare of OpenVDB files.
# shellcheck shell=bash

# tests/data/blob.vdb: three grids: density (half, a ball of 11503 voxels, voxels of 0.5), heat
# (float), surface (a level set). level-set.vdb: the last alone.
data=$(cd "$(dirname "${BASH_SOURCE[0]}")/../data" && pwd)
small=(--resolution 24,20 --quiet)
unset DISPLAY

same() { cmp -s "$1" "$2" || fail "expected the same picture: $1 $2"; }
differ() { ! cmp -s "$1" "$2" || fail "expected another picture: $1 $2"; }

case_ "info tells the grids, the voxels and their memory"
run info "$data/blob.vdb" --json blob.json
expect_success
expect_output '^format +OpenVDB$'
expect_output '^grid +density$'
expect_output 'heat \(float, fog volume\)$'
expect_output 'surface \(float, level set\)$'
expect_output '^scalar type +half$'
expect_output '^spacing +0\.5 x 0\.5 x 0\.5'
expect_output '^active voxels +11503 in [0-9]+ bricks and 0 tiles$'
expect_output '^memory .* bytes an active voxel$'
expect_output '^note +.*density is taken$'
expect_only blob.json
for key in name format grid grids dimensions spacing origin direction scalar_type components \
  value_range background active_voxels bricks tiles memory_bytes percentiles histogram messages; do
  grep -q "^  \"$key\": " blob.json || fail "expected the key $key in the JSON file"
done

case_ "info of another grid"
run info "$data/blob.vdb" --grid heat
expect_success
expect_output '^grid +heat$'
expect_output '^scalar type +float$'

case_ "a picture of a sparse volume, classified as a cloud"
run render "$data/blob.vdb" --output a.png --stats a.json --resolution 24,20 --verbose
expect_status 0
expect_error 'preset cloud'
expect_file a.png a.json
! grep -q '"rays": 0,' a.json || fail "expected rays"
run render "$data/blob.vdb" --grid heat --output b.png "${small[@]}"
expect_success
differ a.png b.png

case_ "a density absorbs: the same step twice is the same picture, more extinction another"
for n in 0.2 0.4; do
  run render "$data/blob.vdb" --extinction $n --output $n.png --stats $n.json "${small[@]}"
  expect_success
done
differ 0.2.png 0.4.png
grep -q 'no matter sends light by itself' 0.2.json || fail "expected the reason in the effects"
run render "$data/blob.vdb" --extinction 0.2 --background 1,1,1 --output white.png "${small[@]}"
expect_success
same 0.2.png white.png
run render "$data/blob.vdb" --extinction 0.2 --background 0,0,0 --output black.png "${small[@]}"
expect_success
differ 0.2.png black.png

case_ "a dense volume may be a density, too"
blob ../blob.nrrd
run render ../blob.nrrd --extinction 0.001 --output a.png "${small[@]}"
expect_success

case_ "an extinction and a preset contradict each other"
run render "$data/blob.vdb" --extinction 1 --preset cloud --output a.png
expect_failure 2
run render "$data/blob.vdb" --extinction 0 --output a.png
expect_failure 2
run render "$data/blob.vdb" --extinction 1 --mapper vtk-gpu --output a.png
expect_failure 2
run compare "$data/blob.vdb" --extinction 1 --preset cloud --output folder
expect_failure 2
expect_no_files

case_ "the stock mappers do not draw it"
run render "$data/blob.vdb" --mapper vtk-fixed-point --output a.png "${small[@]}"
expect_failure 1
expect_error 'dense'
expect_no_files

case_ "compare leaves the stock mappers out and says why"
run compare "$data/blob.vdb" --output folder --resolution 24,20 --repetitions 1 --quiet
expect_success
grep -q '"skipped": "it would need the volume dense"' folder/compare.json ||
  fail "expected the reason in compare.json"

case_ "a level set is drawn as fog, and told as distances"
run render "$data/level-set.vdb" --extinction 0.5 --output a.png "${small[@]}"
expect_success
run render "$data/level-set.vdb" --extinction 0.5 --level-set distance --output b.png "${small[@]}"
expect_success
differ a.png b.png
run info "$data/level-set.vdb"
expect_success
expect_output '^value range +-'
run info "$data/level-set.vdb" --level-set fog
expect_success
expect_output '^value range +0 to 1$'
expect_output '^note +its level set becomes a density'

case_ "a grid that is not there, and one of a file that has none"
run render "$data/blob.vdb" --grid none --output a.png "${small[@]}"
expect_failure 1
expect_error "no grid 'none'.*density"
blob ../blob.nrrd
run info ../blob.nrrd --grid density
expect_failure 2
expect_no_files

case_ "a file that is cut short"
head -c 9000 "$data/blob.vdb" > ../cut.vdb
run render ../cut.vdb --output a.png "${small[@]}"
expect_failure 1
expect_error 'cut short'
expect_no_files
