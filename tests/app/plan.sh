# brume plan.
# shellcheck shell=bash

unset DISPLAY
effects=(absorption emission scattering 'phase anisotropy' 'coloured extinction' shadows ambient
  octaves 'gradient shading' 'silver lining' powder fog surfaces 'space leaping')

case_ "a table with each effect, and the same as JSON"
blob ../blob.nrrd
run plan ../blob.nrrd --json plan.json --quiet
expect_success
expect_only plan.json
for effect in "${effects[@]}"; do
  expect_output "^$effect +(yes|no)(, forced)? +[0-9.e-]+ +([0-9.]+|-) +[^ ]"
  grep -q "\"name\": \"$effect\"" plan.json || fail "expected $effect in plan.json"
done
expect_output '^effect +simulated +error +cost +reason$'
expect_output 'expected to take [0-9.]+ times as long'
expect_output 'tolerance 0\.004'
for key in on forced reason error_bound cost; do
  [ "$(grep -c "\"$key\": " plan.json)" -ge 14 ] || fail "expected $key of each effect"
done
expect_output 'expected to take [0-9.]+ times'
grep -q '"expected_cost": [0-9.]' plan.json || fail "expected the cost"
grep -q '"format": "brume-plan"' plan.json || fail "expected the format"
grep -qE '"expected_cost": [0-9.]+' plan.json || fail "expected the cost"

case_ "the plan follows the scene"
blob ../blob.nrrd
run plan ../blob.nrrd --quiet
expect_output '^scattering +no '
expect_output '^emission +yes '
run plan ../blob.nrrd --quiet --extinction 0.02 --sun-direction 1,0,1 --anisotropy 0.8
expect_success
expect_output '^scattering +yes '
expect_output '^phase anisotropy +yes '
expect_output '^emission +no '
expect_output '^ambient +no '
run plan ../blob.nrrd --quiet --extinction 0.02 --sky-radiance 1,1,1
expect_output '^ambient +yes '

case_ "the plan follows the tolerance"
blob ../blob.nrrd
thin=(--extinction 0.00002 --sun-direction 1,0,1 --quiet)
run plan ../blob.nrrd "${thin[@]}" --tolerance 0
expect_success
expect_output '^shadows +yes '
expect_output 'tolerance 0\.$'
run plan ../blob.nrrd "${thin[@]}" --tolerance 0.1
expect_success
expect_output '^shadows +no +[0-9.e-]*[1-9]'

case_ "what is forced"
blob ../blob.nrrd
run plan ../blob.nrrd --quiet --extinction 0.02 --sun-direction 1,0,1 --force shadows=off
expect_success
expect_output '^shadows +no, forced +[0-9.e-]*[1-9]'

case_ "outputs and inputs that cannot be"
blob ../blob.nrrd
run plan ../blob.nrrd --json none/a.json
expect_failure 1
run plan ../blob.nrrd --json ../blob.nrrd
expect_failure 2
run plan
expect_failure 2
expect_error '^brume: INPUT: it is missing'
bad_inputs plan
expect_no_files
