# brume cost.
# shellcheck shell=bash

unset DISPLAY
small=(--resolution 24,24 --repetitions 1 --quiet)
lit=(--extinction 0.002 --albedo 0.9 --sun-direction 1,-0.5,0.6)

# python3 answers where a figure of cost.json is asked for; p is a point by knob and setting.
figure_of() {
  python3 -c "
import json
d = json.load(open('$1/cost.json'))
p = {(q['knob'], q['setting']): q for q in d['points']}
drawn = [q for q in d['points'] if q['skipped'] is None]
print($2)"
}

case_ "--help"
run cost --help
expect_success
expect_output '^Usage: brume cost INPUT --output DIR \[OPTIONS\]$'
expect_output '[-][-]study-seconds SECONDS'
[ "$(wc -L < ../out)" -le 80 ] || fail "expected lines of at most 80 columns"

case_ "matter that absorbs: quadrature is the truth"
blob ../blob.nrrd
run cost ../blob.nrrd --output out "${small[@]}" --preset cloud --mappers raymarch,pathtrace,smart
expect_success
expect_file out/cost.csv out/cost.json out/report.html
! grep -qE '(src|href)="(https?:|//)|url\(["'\'']?(https?:|//)' out/report.html ||
  fail "expected a report without resources of the web"
if command -v Xvfb > /dev/null; then
  [ "$(head -c 8 out/cost.png | od -An -tx1 | tr -d ' ')" = 89504e470d0a1a0a ] || fail "expected a chart"
  grep -q 'Error against seconds' out/report.html || fail "expected the chart in the report"
fi
expect_output '^The truth is a quadrature in double precision'
[ "$(figure_of out "d['truth']['kind']")" = quadrature ] || fail "expected quadrature"
[ "$(figure_of out "p['step','midpoint 4 voxels']['errors']['rms'] > 4 * p['step','midpoint 1 voxel']['errors']['rms']")" = True ] ||
  fail "expected shorter steps to be nearer to the truth"
[ "$(figure_of out "p['precision','uint8']['skipped'] is not None")" = True ] ||
  fail "expected voxels of 8 bits not to be stored anew"
[ "$(figure_of out "p['precision','float']['own_errors']['largest'] < 1e-5")" = True ] ||
  fail "expected the same picture of the same values as floats"
[ "$(figure_of out "[k['skipped'] is None for k in d['knobs'] if k['name'] in ('shadows', 'octaves', 'stock')]")" = \
  "[False, False, False]" ] || fail "expected reasons for knobs that cannot be turned"
[ "$(figure_of out "p['smart','tolerance 0.05']['asked_tolerance'], p['smart','tolerance 0.05']['errors']['within'][0]['share'] >= 0.999")" = "0.05 True" ] ||
  fail "expected the picture for a tolerance to keep it"
expect_output '^chosen for tolerance 0\.05: .* which keeps it'
[ "$(figure_of out "len(d['words']) > 4")" = True ] || fail "expected words"
# The file of commas: a line a point, of as many fields as the head, and the same figures.
python3 - out << 'END' || fail "expected cost.csv to hold the figures of cost.json"
import csv, json, sys
d = json.load(open(sys.argv[1] + '/cost.json'))
rows = list(csv.DictReader(open(sys.argv[1] + '/cost.csv')))
assert len(rows) == len(d['points'])
for row, point in zip(rows, d['points']):
    assert (row['knob'], row['setting']) == (point['knob'], point['setting'])
    if point['skipped'] is None:
        assert abs(float(row['rms']) - point['errors']['rms']) < 1e-8
        assert abs(float(row['seconds']) - point['seconds']['median']) < 1e-8
        assert (row['front'] == '1') == point['front']
END

case_ "the front is a front"
blob ../blob.nrrd
run cost ../blob.nrrd --output out "${small[@]}" --preset cloud --knobs step,resolution --mappers raymarch
expect_success
python3 - out << 'END' || fail "expected a front that nothing beats"
import json, sys
d = json.load(open(sys.argv[1] + '/cost.json'))
drawn = [p for p in d['points'] if p['skipped'] is None]
cost = lambda p: (p['seconds']['median'], p['errors']['rms_at_most'])
beats = lambda a, b: a[0] <= b[0] and a[1] <= b[1] and a != b
front = [p for p in drawn if p['front']]
assert len(front) > 1
assert not any(beats(cost(a), cost(b)) for a in drawn for b in front)
assert all(any(beats(cost(a), cost(b)) or cost(a) == cost(b) for a in front) for b in drawn)
END

case_ "scattered light: paths are the truth, and their errors fall as one over the root of their number"
blob ../blob.nrrd
run cost ../blob.nrrd --output out "${small[@]}" "${lit[@]}" --knobs paths,octaves,shadows --study-seconds 10 \
  --samples-per-pixel 2000 --mappers raymarch,pathtrace
expect_success
expect_output '^The truth holds every scattering'
[ "$(figure_of out "d['truth']['kind'], d['truth']['samples_per_pixel'] > 30")" = "paths True" ] ||
  fail "expected a truth of paths"
# Of 64 against 1 an eighth; noise of the noise, with a few hundred pixels that matter: a third off.
[ "$(figure_of out "[5.5 < p['paths','1']['errors']['rms'] / p['paths','64']['errors']['rms'] < 12,
  2.6 < p['paths','1']['errors']['rms'] / p['paths','16']['errors']['rms'] < 6]")" = "[True, True]" ] ||
  fail "expected errors to fall as 1/√n: $(figure_of out "[p['paths',n]['errors']['rms'] for n in ('1','4','16','64')]")"
[ "$(figure_of out "all(abs(p['paths',n]['errors']['mean_shift']) < 4 * p['paths',n]['errors']['mean_shift_standard_error'] for n in ('4','16','64'))")" = True ] ||
  fail "expected paths to have no bias"
# One scattering of several: too dark, and seen to be.
[ "$(figure_of out "p['octaves','1']['errors']['mean_shift'] < -0.002, p['octaves','1']['errors']['rms_limited_by_truth']")" = "True False" ] ||
  fail "expected single scattering to be too dark"
[ "$(figure_of out "p['shadows','none']['own_errors']['mean_shift'] > 0.005")" = True ] ||
  fail "expected light without shadows to be too bright"
[ "$(figure_of out "p['shadows','volume 1/2 voxel']['own_errors']['rms'] < 0.2 * p['shadows','volume 8 voxels']['own_errors']['rms']")" = True ] ||
  fail "expected a finer shadow volume to be nearer to exact rays"

case_ "a rim that is no physics: the truth holds one scattering"
blob ../blob.nrrd
run cost ../blob.nrrd --output out "${small[@]}" "${lit[@]}" --silver-lining 0.5 --knobs step,paths,octaves \
  --mappers raymarch,pathtrace
expect_success
[ "$(figure_of out "d['truth']['kind'], [k['skipped'] is None for k in d['knobs']]")" = \
  "march [True, False, False]" ] || fail "expected a truth by marching, and neither paths nor octaves against it"

case_ "no time: what was dropped is named, and there is a result"
blob ../blob.nrrd
run cost ../blob.nrrd --output out "${small[@]}" --preset cloud --study-seconds 0.05 --mappers raymarch
expect_success
[ "$(figure_of out "any('time' in (q['skipped'] or '') for q in d['points'])")" = True ] ||
  fail "expected settings that there was no time for"

case_ "no display to be had: VTK's mappers are skipped with a reason"
blob ../blob.nrrd
command="brume cost, DISPLAY broken, no Xvfb"
PATH=/nonexistent DISPLAY=:9999 "$BRUME" cost ../blob.nrrd --output out "${small[@]}" --preset cloud \
  --knobs stock,step > ../out 2> ../err
status=$?
expect_status 0
expect_error 'cost\.png: it is left out'
expect_only out/{cost.csv,cost.json,report.html}
grep -q 'xvfb' out/cost.json || fail "expected the reason in cost.json"

if command -v Xvfb > /dev/null; then
  case_ "VTK's mappers take part"
  blob ../blob.nrrd
  run cost ../blob.nrrd --output out "${small[@]}" --preset cloud --knobs stock --study-seconds 20
  expect_success
  [ "$(figure_of out "[q['errors']['mean_absolute'] < 0.02 and q['stock'] for q in drawn if '1/2' in q['setting']]")" = \
    "[True, True]" ] || fail "expected both of VTK's mappers near the truth"
fi

case_ "other files of the folder are kept; no folder is left behind by a bad call"
blob ../blob.nrrd
mkdir out
echo mine > out/mine.txt
remember out/mine.txt
run cost ../none.nrrd --output out "${small[@]}"
expect_failure 1
expect_unchanged
expect_only out/mine.txt
while read -r words; do
  # shellcheck disable=SC2086
  run cost ../blob.nrrd --output new/of/three $words
  expect_failure 2
  expect_no_file new
done << 'END'
--knobs nonsense
--knobs step,step
--mappers nonsense
--mappers raymarch,raymarch
--repetitions 0
--study-seconds 0
--study-seconds nan
--time-budget 3
--resolution 0,0
--preset nonsense
--blend-mode mip --fog-extinction 1
END
run cost ../blob.nrrd --output ../blob.nrrd "${small[@]}"
expect_failure 1

for signal in INT TERM; do
  case_ "SIG$signal in the middle"
  blob ../blob.nrrd
  interrupted $signal 1 cost ../blob.nrrd --output out --resolution 4000,4000 --quiet
  expect_failure 1
  expect_error 'interrupted'
  expect_no_file out
done
