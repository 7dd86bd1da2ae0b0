# brume convert.
# shellcheck shell=bash

data=$(cd "$(dirname "${BASH_SOURCE[0]}")/../data" && pwd)

case_ "--help"
run convert --help
expect_success
expect_output '^Usage: brume convert INPUT OUT '
for option in type half background level-set max-memory; do
  expect_output "^ +--$option( |\$)"
done

case_ "from format to format and back: the same voxels"
run generate head-ct --size 20 --output a.nrrd --quiet
for pair in "a.nrrd b.vti" "b.vti c.mha" "c.mha d.nrrd"; do
  # shellcheck disable=SC2086
  run convert $pair --quiet
  expect_success
done
tail -c 10000 a.nrrd > tail-a
tail -c 10000 d.nrrd > tail-d
cmp -s tail-a tail-d || fail "expected the same voxels"

case_ "sparse and dense"
run convert "$data/blob.vdb" out.vdb --quiet
expect_success
run info out.vdb
expect_output '^active voxels +11503 '
expect_output 'heat \(float, fog volume\)$'
expect_output 'surface \(float, level set\)$'
run convert "$data/blob.vdb" dense.nrrd
expect_status 0
expect_error 'density is taken'
expect_error 'the sparse volume becomes dense'
run convert dense.nrrd again.vdb
expect_status 0
expect_error 'the background, which is not stored, is 0'
run info again.vdb
expect_output '^active voxels +11503 '
run convert "$data/blob.vdb" big.nrrd --max-memory 10k
expect_failure 1
expect_no_file big.nrrd

case_ "types and what they lose are told"
run generate cumulus --size 16 --output a.nrrd --quiet
run convert a.nrrd b.nrrd --type uint8
expect_status 0
expect_error '[0-9]+ of [0-9]+ values are rounded to uint8'
run info b.nrrd
expect_output '^scalar type +unsigned char$'

for ending in vdb nii.gz raw tif; do
  case_ "a whole series over time, a file each: $ending"
  moments ../moments.nrrd
  run convert ../moments.nrrd "out_%03d.$ending"
  expect_status 0
  expect_error "^brume: out_000.$ending to out_002.$ending: 3 volumes, a file each: read them as out_%03d.$ending; their times, 2 to 6 s, "
  if [ "$ending" = raw ]; then
    expect_only out_00{0,1,2}.raw out_00{0,1,2}.raw.json
  else
    expect_only "out_000.$ending" "out_001.$ending" "out_002.$ending"
  fi
  for step in 0 2; do
    run info "out_%03d.$ending" --time-step "$step"
    expect_output "^value range +(0|$((5 + step))) to $((5 + step))( |\$)"
    expect_output "a series of 3 volumes, at 0 to 2; that at $step is taken"
  done
done

case_ "numbered files keep their numbers"
for n in 3 5; do filled "in_$n.nrrd" "$n" 3 3 3; done
run convert 'in_%d.nrrd' 'out_####.mha' --quiet
expect_success
expect_only in_3.nrrd in_5.nrrd out_0003.mha out_0005.mha
run info out_0005.mha
expect_output '^value range +5 to 5'
run convert 'out_%04d.mha' 'again_%d.vdb' --quiet
expect_success
run convert 'again_%d.vdb' 'dense_%d.nrrd' --quiet
expect_success
run info dense_3.nrrd
expect_output '^value range +0 to 3'

case_ "without a number in its name one volume is written, and the others are told"
moments ../moments.nrrd
run convert ../moments.nrrd one.nrrd
expect_status 0
expect_error 'the other 2 volumes of the series are left out: write one_%04d.nrrd for all of them'
run convert ../moments.nrrd three.nrrd --time-step 2
expect_status 0
run info three.nrrd
expect_output '^value range +7 to 7'
expect_only one.nrrd three.nrrd

case_ "a series is not written over its own files"
for n in 1 2; do filled "in_$n.nrrd" "$n" 3 3 3; done
remember in_1.nrrd in_2.nrrd
for out in 'in_%d.nrrd' in_2.nrrd; do
  run convert 'in_%d.nrrd' "$out"
  expect_failure 2
  expect_error 'one of the input.s files, which would be lost'
done
moments 4d_1.nrrd
run convert 4d_1.nrrd '4d_%d.nrrd'
expect_failure 2
run convert 'in_%d.nrrd' 'out_%d.nrrd' --time 1
expect_failure 2
expect_error '^brume: --time: '
expect_unchanged
expect_only in_1.nrrd in_2.nrrd 4d_1.nrrd

case_ "a damaged file of a series: those before it are there, and nothing half-done"
for n in 1 2; do filled "in_$n.nrrd" "$n" 3 3 3; done
head -c 100 in_2.nrrd > ../shorter && mv ../shorter in_2.nrrd
run convert 'in_%d.nrrd' 'out_%d.mha' --quiet
expect_failure 1
expect_error '^brume: in_2.nrrd: '
expect_only in_1.nrrd in_2.nrrd out_1.mha

case_ "bad calls"
blob a.nrrd
remember a.nrrd
while read -r words; do
  # shellcheck disable=SC2086
  run convert a.nrrd $words
  expect_failure 2
done << 'END'
a.nrrd
b.txt
b.nrrd --type float16
b.nrrd --half
b.vdb --type int16
b.nrrd --level-set fog
b.vdb --grid-class level-set --background 1
END
run convert "$data/blob.vdb" b.vdb --background 1
expect_failure 2
run convert none.nrrd b.vdb
expect_failure 1
expect_unchanged
expect_only a.nrrd
