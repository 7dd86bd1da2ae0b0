# brume info.
# shellcheck shell=bash

case_ "--help"
run info --help
expect_success
expect_output '^Usage: brume info INPUT \[OPTIONS\]$'
expect_output '^ +[-][-]json FILE '

case_ "what a volume is"
blob ../blob.nrrd
run info ../blob.nrrd --json blob.json
expect_success
expect_output '^name +blob\.nrrd$'
expect_output '^dimensions +16 x 16 x 16 voxels$'
expect_output '^scalar type +unsigned char$'
expect_only blob.json
for key in name format dimensions spacing origin direction scalar_type components value_range mean \
  non_finite_voxels memory_bytes percentiles histogram messages; do
  grep -q "^  \"$key\": " blob.json || fail "expected the key $key in the JSON file"
done

case_ "a sample"
run info sample:cloud
expect_success
expect_output '^name +sample:cloud$'

case_ "the optical depth of a density, dense and sparse"
filled ../even.nrrd 0.5 9 5 3
run info ../even.nrrd --extinction 2 --json even.json
expect_success
expect_output '^optical depth +along axis i: median 8, largest 8, of 15 lines'
expect_output '^ +along axis k: median 2, largest 2, of 45 lines'
grep -q '"optical_depth"' even.json || fail "expected the optical depth in the JSON file"
run convert ../even.nrrd even.vdb --quiet
run info even.vdb --extinction 2
expect_output '^optical depth +along axis i: median 9, largest 9, of 15 lines'
run info ../even.nrrd --extinction 0
expect_failure 2

case_ "the histogram's bars: blocks where the terminal takes them, else letters"
blob ../blob.nrrd
LC_ALL=C run info ../blob.nrrd
expect_output '\|#+ '
LC_ALL=C.UTF-8 run info ../blob.nrrd
refuse_output '\|#'
expect_output '\|█+'

case_ "a volume of NaN is told, not refused"
filled ../nan.nrrd nan 4 4 4
run info ../nan.nrrd --json nan.json
expect_success
expect_output '^non-finite voxels +64$'
grep -q '"non_finite_voxels": 64' nan.json || fail "expected the count in the JSON file"
! grep -qiE '[ \[](nan|inf)' nan.json || fail "expected no NaN in the JSON file"

case_ "a 4D NIfTI: the first volume, and a remark"
series ../series.nii
run info ../series.nii
expect_success
expect_output '^dimensions +4 x 4 x 4 voxels$'
expect_output '^note +a series of 2 volumes, at 0 to 1; that at 0 is taken$'

case_ "a 4D NIfTI: a volume by its number or its time"
series ../series.nii
run info ../series.nii --time-step 1
expect_success
expect_output '^note +.*that at 1 is taken$'
run info ../series.nii --time 0.9
expect_success
expect_output '^note +.*that at 1 is taken$'
run info ../series.nii --time-step 2
expect_failure 2
run info ../series.nii --time 0 --time-step 0
expect_failure 2
blob ../blob.nrrd
run info ../blob.nrrd --time 0
expect_failure 2

case_ "numbered files are a series"
blob frame_0003.nrrd
blob frame_0005.nrrd
run info 'frame_%04d.nrrd' --time 5
expect_success
expect_output '^note +a series of 2 volumes, at 3 to 5; that at 5 is taken$'

case_ "a limit on memory"
blob ../blob.nrrd
run info ../blob.nrrd --max-memory 4k
expect_failure 1
run info ../blob.nrrd --max-memory 1Mi
expect_success
for bad in 0 -1G 8Q G 1e30 8GG; do
  run info ../blob.nrrd --max-memory "$bad"
  expect_failure 2
done

bad_inputs info --json never.json

case_ "the input is not overwritten"
blob in.nrrd
remember in.nrrd
run info in.nrrd --json in.nrrd
expect_failure 2
expect_unchanged
expect_only in.nrrd

case_ "the JSON file's folder is missing"
blob ../blob.nrrd
run info ../blob.nrrd --json none/blob.json
expect_failure 1
expect_no_files

case_ "what was there stays when the input cannot be read"
echo former > old.json
remember old.json
run info ../none.nrrd --json old.json
expect_failure 1
expect_unchanged

case_ "two inputs"
run info a b
expect_failure 2
expect_error 'brume info --help$'

case_ "an unknown sample names the known ones"
run info sample:nonsense
expect_failure 2
expect_error 'head-ct'

if [ -c /dev/full ]; then
  case_ "standard output is full"
  blob ../blob.nrrd
  command="brume info > /dev/full"
  "$BRUME" info ../blob.nrrd > /dev/full 2> ../err
  status=$?
  : > ../out
  expect_failure 1
  expect_error 'standard output'
fi
