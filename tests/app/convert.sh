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
