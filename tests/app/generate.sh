# brume generate.
# shellcheck shell=bash

case_ "--list names the kinds, one a line"
run generate --list
expect_success
for kind in cumulus cirrus valley-fog head-ct torso-ct smoke particles shape checker; do
  expect_output "^$kind +[^ ].*"
done
expect_output '^cumulus .*\[--seed\] \[--time\]$'
expect_output '^head-ct .*units \[--seed\]$'
expect_output '^ball .*density$'
expect_no_files

case_ "--help of the subcommand and of a kind"
run generate --help
expect_success
expect_output '^Usage: brume generate KIND'
run generate cumulus --help
expect_success
expect_output '^Usage: brume generate cumulus --output FILE'
for option in size seed time width octaves half background compress; do
  expect_output "^ +--$option( |\$)"
done
expect_output 'metres'
run generate head-ct --help
expect_success
refuse_output '[-][-]time'
expect_output 'It does not move: it has no time'
run generate slab --help
refuse_output '[-][-]seed'
expect_output 'neither seed nor time'

case_ "volumes in their formats, as info then reads them"
run generate head-ct --size 12 --output head-ct.nii.gz --quiet
expect_success
run generate cumulus --size 12 --output cumulus.nrrd --quiet
expect_success
expect_only head-ct.nii.gz cumulus.nrrd
run info head-ct.nii.gz
expect_output '^dimensions +9 x 11 x 12 voxels$'
expect_output '^orientation +RAS'
expect_output '^value range .* HU$'
run info cumulus.nrrd
expect_output '^dimensions +12 x 12 x 7 voxels$'
expect_output '^physical size .* m$'
expect_output '^origin +-916\.667, -916\.667, '

case_ "an OpenVDB file of a dense volume is sparse"
run generate smoke --size 24 --output smoke.vdb --quiet
expect_success
expect_only smoke.vdb
run info smoke.vdb
expect_success
expect_output '^grid +density$'
expect_output 'density \(float, fog volume\)$'
expect_output 'temperature \(float, fog volume\)$'
run generate smoke --size 24 --output half.vdb --half --background-tolerance 1e-4
expect_status 0
expect_error 'half precision'
run info half.vdb --grid temperature
expect_output '^scalar type +half$'
expect_output '^background +300$'

case_ "smoke and shapes are sparse on the way to a .vdb, with the voxels of the dense one"
run generate smoke --size 40 --time 1 --output sparse.vdb --quiet
run generate smoke --size 40 --time 1 --output dense.vdb --background-tolerance 1e-30 --quiet
run convert sparse.vdb sparse.vti --quiet
run convert dense.vdb dense.vti --quiet
expect_success
cmp -s sparse.vti dense.vti || fail "expected the same voxels by either way"
run generate shape --distance --size 40 --output band.vdb --quiet
run generate shape --distance --size 40 --output whole.vti --quiet
run convert whole.vti cut.vdb --grid-class level-set --quiet
run convert band.vdb band.vti --level-set distance --quiet
run convert cut.vdb cut.vti --level-set distance --quiet
expect_success
cmp -s band.vti cut.vti || fail "expected the same level set by either way"

case_ "the same call makes the same bytes; another seed, time or option another volume"
run generate cumulus --size 16 --output a.nrrd --quiet
run generate cumulus --size 16 --output b.nrrd --quiet --time 0 --seed 1
cmp -s a.nrrd b.nrrd || fail "expected the same file"
for other in "--seed 2" "--time 9" "--octaves 1"; do
  # shellcheck disable=SC2086
  run generate cumulus --size 16 --output c.nrrd --quiet $other
  expect_success
  ! cmp -s a.nrrd c.nrrd || fail "expected another file for $other"
  mv c.nrrd a.nrrd
done

case_ "a series over time is numbered files"
run generate smoke --size 12 --time 0:2:3 --output smoke.nii.gz
expect_status 0
expect_error 'smoke\.0000\.nii\.gz to smoke\.0002\.nii\.gz: 3 volumes'
expect_only smoke.0000.nii.gz smoke.0001.nii.gz smoke.0002.nii.gz
run generate smoke --size 12 --time 2 --output two.nii.gz --quiet
expect_success
cmp -s two.nii.gz smoke.0002.nii.gz || fail "expected the volume at time 2"

for ending in vdb nii.gz raw tif; do
  case_ "a series in any format is read back by a pattern: $ending"
  run generate smoke --size 12 --time 0:2:3 --output "smoke_%04d.$ending" --quiet
  expect_success
  run generate smoke --size 12 --time 0:2:3 --output "dots.$ending" --quiet
  expect_success
  ! grep -qaE '20[0-9]{2}:[0-9]{2}:' smoke_0000.* || fail "expected no clock in the file"
  [ "$ending" = vdb ] || # which holds an identifier of its own
    cmp -s "smoke_0002.$ending" "dots.0002.$ending" || fail "expected the same file by both names"
  run info "smoke_%04d.$ending" --time-step 2
  expect_status 0
  expect_output 'a series of 3 volumes, at 0 to 2; that at 2 is taken'
  grep '^value range' ../out > ../last
  run info "smoke_0002.$ending"
  grep '^value range' ../out | cmp -s - ../last || fail "expected the values of the last file"
done

case_ "clouds and particles go into a .vdb; a distance becomes a level set"
run generate cumulus --size 32 --output a.vdb --quiet
expect_success
run info a.vdb
expect_output '^active voxels +[1-9]'
run generate shape --distance --shape '(sphere 2)' --size 24 --output d.vdb --quiet
expect_success
run info d.vdb --level-set fog
expect_output 'distance \(float, level set\)$'
expect_output 'becomes a density'
run generate shape --shape '(sphere' --output b.vdb
expect_failure 1
run generate cumulus --size 32 --output b.vdb --grid-class level-set
expect_failure 1
expect_error 'no width of a band: leave --grid-class out'
run generate shape --shape-file /dev/zero --output b.vdb
expect_failure 1
expect_error 'longer than 1 MiB'
run generate particles --size 16 --output p.nrrd --quiet
expect_success
run info p.nrrd
refuse_output '^value range +0 to 0$'

case_ "what a format cannot hold is told, once"
run generate smoke --size 12 --time 0:1:2 --output smoke.nrrd
expect_status 0
expect_error 'of its 2 arrays the scalars alone, density,'
[ "$(grep -c 'arrays' ../err)" = 1 ] || fail "expected one note"

case_ "bad calls"
while read -r words; do
  case_ "generate refuses: $words"
  # shellcheck disable=SC2086
  run generate $words
  expect_failure 2
  expect_no_files
done << 'END'

cumulus
cumulus --output a.txt
cumulus --output a.nrrd --size 5000
cumulus --output a.nrrd --time 1:2
cumulus --output a.nrrd --time 0,1,2
cumulus --output a.nrrd --octaves 9
cumulus --output a.nrrd --half
cumulus --output a.vdb --compress
smoke --output a.vdb --size 12 --background 1 --grid-class level-set
shape --output a.vdb --size 12 --distance --background 1
head-ct --output a.nrrd --time 1
smoke --output a.nrrd --air-temperature 2000
END

case_ "a misspelt kind and a misspelt option are told those that were meant"
run generate cumulos --output a.nrrd
expect_failure 2
expect_error '^brume: cumulos: there is no such kind, perhaps cumulus: see brume generate --help$'
run generate head --output a.nrrd
expect_failure 2
expect_error 'perhaps head-ct: '
run generate cumulus --output a.nrrd --octavs 2
expect_failure 2
expect_error 'perhaps --octaves: see brume generate cumulus --help$'

case_ "a folder that is not there"
run generate cumulus --size 12 --output none/a.nrrd
expect_failure 1
expect_no_files

case_ "what was there is replaced whole"
echo former > a.nrrd
run generate cumulus --size 12 --output a.nrrd --quiet
expect_success
run info a.nrrd
expect_success

case_ "an interrupted series keeps the files that were done, and tells how many"
interrupted INT a.0001.nrrd generate smoke --size 8 --time 0:1:10000 --output a.nrrd --quiet
expect_failure 1
expect_error '^brume: a\.[0-9]+\.nrrd: interrupted: [1-9][0-9]* of 10000 files are written: '
expect_file a.0000.nrrd

for ending in nii.gz vdb; do
  case_ "an interrupted call leaves what was there, and nothing else: $ending"
  echo former > "a.$ending"
  remember "a.$ending"
  interrupted INT 0.3 generate head-ct --size 700 --output "a.$ending"
  expect_failure 1
  expect_error 'interrupted'
  expect_unchanged
  expect_only "a.$ending"
done
