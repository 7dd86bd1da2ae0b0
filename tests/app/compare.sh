# brume compare.
# shellcheck shell=bash

unset DISPLAY
small=(--resolution 48,48 --repetitions 1 --quiet)

case_ "--help"
run compare --help
expect_success
expect_output '^Usage: brume compare INPUT --output DIR \[OPTIONS\]$'
expect_output '[-][-]repetitions N'
[ "$(wc -L < ../out)" -le 80 ] || fail "expected lines of at most 80 columns"

case_ "all mappers, without a display: everything is there"
blob ../blob.nrrd
run compare ../blob.nrrd --output out "${small[@]}"
expect_success
expect_output 'report: out/report\.html'
expect_file out/{panel,truth}.png out/{raymarch,difference-raymarch}.png out/raymarch.exr \
  out/{compare.json,report.html}
if command -v Xvfb > /dev/null && grep -q skipped out/compare.json; then
  expect_file out/{vtk-gpu,vtk-fixed-point}.{png,exr}
fi
! grep -qE '(src|href)="(https?:|//)|url\(["'\'']?(https?:|//)' out/report.html ||
  fail "expected a report without resources of the web"
grep -q 'data:image/png;base64,' out/report.html || fail "expected pictures in the report"
grep -q "brume compare ../blob.nrrd" out/compare.json || fail "expected the command line"

case_ "no display to be had: VTK's mappers are skipped with a reason"
blob ../blob.nrrd
command="brume compare, DISPLAY broken, no Xvfb"
PATH=/nonexistent DISPLAY=:9999 "$BRUME" compare ../blob.nrrd --output out "${small[@]}" \
  > ../out 2> ../err
status=$?
expect_success
expect_only out/{compare.json,report.html,panel.png,truth.png,raymarch.png,raymarch.exr} \
  out/difference-raymarch.png
grep -q 'xvfb' out/compare.json || fail "expected the reason in compare.json"

case_ "options of the scene"
blob ../blob.nrrd
run compare ../blob.nrrd --output a --mappers raymarch "${small[@]}" --threads 1
expect_success
run compare ../blob.nrrd --output b --mappers raymarch "${small[@]}" --threads 2 \
  --sample-distance 0.125 --background 0.25,0.5,0.75
expect_success
! cmp -s a/raymarch.png b/raymarch.png || fail "expected another picture"
grep -q '"step": 0.125' b/compare.json || fail "expected the step in compare.json"

# python3 answers where a figure of compare.json is asked for.
figure_of() { python3 -c "import json; d = json.load(open('$1/compare.json')); print($2)"; }

case_ "the path tracer: a mapper, and the truth of what scatters light"
blob ../blob.nrrd
paths=(--mappers raymarch,pathtrace --preset cloud --sun-direction 1,0.3,0.6 --samples-per-pixel 16)
run compare ../blob.nrrd --output out "${small[@]}" "${paths[@]}"
expect_success
expect_file out/{pathtrace,difference-pathtrace}.png out/pathtrace.exr
[ "$(figure_of out "'256 paths' in d['truth']['method']")" = True ] || fail "expected a truth of 16 times 16 paths"
# Noise: no shift, four times the truth's own, and as large as pictures of other random numbers say.
[ "$(figure_of out "[e['errors_against_truth']['rms'] < 8 * d['truth']['remaining_mean'] / 0.8 for e in d['entries'] if e['mapper'] == 'pathtrace']")" = "[True]" ] ||
  fail "expected errors of the size of the noise"
[ "$(figure_of out "[abs(e['errors_against_truth']['mean_shift']) < 0.3 * e['errors_against_truth']['mean_absolute'] for e in d['entries'] if e['mapper'] == 'pathtrace']")" = "[True]" ] ||
  fail "expected no shift"
run compare ../blob.nrrd --output plain "${small[@]}" --mappers raymarch,pathtrace --extinction 0.5 --albedo 0
expect_success
[ "$(figure_of plain "'double precision' in d['truth']['method']")" = True ] ||
  fail "expected quadrature where nothing is scattered"
run compare ../blob.nrrd --output no "${small[@]}" --mappers raymarch --samples-per-pixel 16
expect_status 2
expect_error 'brume: --samples-per-pixel: .*add pathtrace to --mappers'

case_ "light, media and fog: against shadow rays; VTK's mappers draw what they know"
blob ../blob.nrrd
lit=(--preset cloud --sun-direction 1,0.3,0.6 --sky-radiance 0.1,0.1,0.2 --fog-extinction 0.01)
run compare ../blob.nrrd --output out "${small[@]}" "${lit[@]}" --display-curve srgb --exposure 1
expect_success
[ "$(figure_of out "d['truth']['remaining_largest'] < 0.01")" = True ] ||
  fail "expected march and double precision to agree"
[ "$(figure_of out "d['entries'][0]['errors_against_truth']['largest'] < 0.02")" = True ] ||
  fail "expected the lit picture to be near the truth"
[ "$(figure_of out "d['display_curve'], d['exposure']")" = "srgb 1.0" ] || fail "expected srgb"
[ "$(figure_of out "len(d['scene']['lights'])")" = 2 ] || fail "expected sun and sky by name"
if [ "$(figure_of out "d['entries'][1]['skipped']")" = None ]; then
  expect_output '^vtk-fixed-point draws it in part: no light scattered in the medium'
  [ "$(figure_of out "'fog' in d['entries'][1]['left_out']")" = True ] || fail "expected fog by name"
  [ "$(figure_of out "d['entries'][1]['contributions'][0]['name']")" = "what it leaves out" ] ||
    fail "expected what is left out as a cause"
  grep -q 'Drawn in part' out/report.html || fail "expected it in the report"
fi
run compare ../blob.nrrd --output forced "${small[@]}" "${lit[@]}" --mappers raymarch --force scattering=off
expect_success
[ "$(figure_of forced "d['entries'][0]['errors_against_truth']['largest'] > 0.05")" = True ] ||
  fail "expected the truth to keep what is forced off"

case_ "a density that absorbs: VTK's mappers have the same opacities"
run compare sample:smoke --output out --extinction 1 --resolution 32,32 --repetitions 1 --quiet
expect_success
if [ "$(figure_of out "d['entries'][1]['skipped']")" = None ]; then
  [ "$(figure_of out "d['entries'][1]['errors_against_truth']['mean_absolute'] < 0.005")" = True ] ||
    fail "expected the same matter in VTK's picture"
  [ "$(figure_of out "d['entries'][1]['left_out']")" = "[]" ] || fail "expected nothing left out"
fi
run compare sample:smoke --output coloured --extinction 1,2,3 --resolution 32,32 --repetitions 1 --quiet
expect_success
[ "$(figure_of coloured "'one opacity' in d['entries'][1]['skipped']")" = True ] ||
  fail "expected three extinctions to be a reason"

case_ "surfaces"
if command -v Xvfb > /dev/null; then
  blob ../blob.nrrd
  printf '%s\n' ply 'format ascii 1.0' 'element vertex 3' 'property float x' 'property float y' \
    'property float z' 'element face 1' 'property list uchar int vertex_indices' end_header \
    '-9 2 -9' '9 2 -9' '0 2 9' '3 0 1 2' > ../wall.ply
  run compare ../blob.nrrd --output out "${small[@]}" --mesh ../wall.ply
  expect_success
  [ "$(figure_of out "max(e['errors_against_truth']['mean_absolute'] for e in d['entries']) < 0.05")" = True ] ||
    fail "expected all mappers to draw the surface"
fi

case_ "other files of the folder are kept"
blob ../blob.nrrd
mkdir out
echo mine > out/mine.txt
remember out/mine.txt
run compare ../blob.nrrd --output out --mappers raymarch "${small[@]}"
expect_success
expect_unchanged
run compare ../none.nrrd --output out --mappers raymarch "${small[@]}"
expect_failure 1
expect_unchanged
expect_file out/report.html out/panel.png

# The calls and inputs that render.sh goes through are refused by the same code; here, one of each.
case_ "no folder is left behind by a bad call or input"
run compare sample:cloud --output out/of/three --resolution 0,0
expect_failure 2
expect_error 'brume compare --help$'
run compare sample:cloud --output out/of/three --preset nonsense
expect_failure 2
run compare ../none.nrrd --output out/of/three "${small[@]}"
expect_failure 1
: > ../empty.nii.gz
run compare ../empty.nii.gz --output out/of/three "${small[@]}"
expect_failure 1
expect_no_file out

case_ "folders that cannot be"
blob ../blob.nrrd
echo mine > file
ln -s nowhere link
remember file
for place in file file/under link; do
  run compare ../blob.nrrd --output "$place" "${small[@]}"
  expect_failure 1
done
expect_unchanged
[ -L link ] || fail "expected the link to be kept"
run compare ../blob.nrrd --output "new/$(printf 'x%.0s' {1..300})" "${small[@]}"
expect_failure 1
expect_no_file new
for mappers in nonsense raymarch,raymarch; do
  run compare ../blob.nrrd --output out --mappers $mappers
  expect_failure 2
done
for repetitions in 0 1.5 x 100000; do
  run compare ../blob.nrrd --output out --repetitions $repetitions
  expect_failure 2
done
expect_only file

for signal in INT TERM; do
  case_ "SIG$signal while it computes the truth"
  blob ../blob.nrrd
  interrupted $signal 1 compare ../blob.nrrd --output out --resolution 4000,4000 --quiet
  expect_failure 1
  expect_error 'interrupted'
  expect_no_file out
done
