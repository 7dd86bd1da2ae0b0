# Folders of DICOM, as the subcommands take them.
# shellcheck shell=bash

# study SERIES NAME...: a slice in each of the named files, in this order along z.
study() {
  local series=$1 n=0 name
  shift
  for name in "$@"; do
    dicom "$name" "$series" $((n++))
  done
}

mkdir -p "$BRUME_APP_OUTPUT/head/b" "$BRUME_APP_OUTPUT/mixed"
head=$BRUME_APP_OUTPUT/head mixed=$BRUME_APP_OUTPUT/mixed
study 1 "$head/z" "$head/b/2" "$head/a.dcm" "$head/b/1"
study 1 "$mixed/1" "$mixed/2" "$mixed/3"
study 2 "$mixed/4" "$mixed/5"

case_ "info of a folder: slices in their order, places and units"
run info "$head"
expect_success
expect_output '^format +DICOM$'
expect_output '^dimensions +8 x 8 x 4 voxels$'
expect_output '^spacing +0\.5 x 0\.5 x 2 mm$'
expect_output "^orientation +LPS"
expect_output '^value range +0 to 3 HU$'

case_ "render of a folder"
run render "$head" --output a.png --resolution 32,32 --quiet
expect_success
expect_file a.png

case_ "convert of a folder"
run convert "$head" a.nrrd --quiet
expect_success
run info a.nrrd
expect_output '^value range +0 to 3 HU$'
expect_output '^dimensions +8 x 8 x 4 voxels$'

case_ "a folder of several series asks for a choice, and lists them"
for words in "info" "render --output a.png" "convert a.nrrd"; do
  read -r subcommand rest <<< "$words"
  # shellcheck disable=SC2086
  run "$subcommand" "$mixed" $rest
  expect_status 2
  expect_error 'mixed: holds 2 different series: choose one with --series N or its UID$'
  expect_error '^ *--series 1  CT, Head 1, 8 x 8 x 3  \(1\.1\)$'
  expect_error '^ *--series 2  CT, Head 2, 8 x 8 x 2  \(1\.2\)$'
done
expect_no_files
run info "$mixed" --series 2
expect_success
expect_output '^dimensions +8 x 8 x 2 voxels$'
run info "$mixed" --series 1.1
expect_success
expect_output '^dimensions +8 x 8 x 3 voxels$'
run info "$mixed" --series 3
expect_status 2
expect_error "has no series '3' among its 2"
run render "$mixed" --series 1 --output a.png --resolution 32,32 --quiet
expect_success
expect_file a.png

case_ "scans below a folder go before pictures in it"
cp -r "$mixed" scans
printf '\x89PNG' > figure.png
run info .
expect_status 2
expect_error '2 different series'
run info . --series 1
expect_output '1 TIFF or PNG picture lies beside the DICOM files and is passed over'
