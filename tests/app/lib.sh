# The words that the app tests are written in. A test file is a list of cases:
#
#   case_ "an unknown subcommand is a bad call"
#   run nonsense                # runs the program; its output is kept in ../out and ../err
#   expect_failure 2            # exit status 2, nothing but one line "brume: …" on standard error
#   expect_error 'nonsense'     # … which holds this text
#   expect_no_files             # the folder that the program ran in is still empty
#
# Each case runs in an empty folder. A case that fails says what was expected and what was found;
# the cases after it run all the same.
# shellcheck shell=bash

cases=0
failures=0
title=
command=
status=0

# case_ TITLE: begins a case.
case_() {
  title=$1
  cases=$((cases + 1))
  cd "$BRUME_APP_OUTPUT" || exit 1
  rm -rf "case-$cases"
  mkdir -p "case-$cases/work"
  cd "case-$cases/work" || exit 1
}

# fail WHAT: tells that the case failed, with all that is needed to see why.
fail() {
  failures=$((failures + 1))
  printf 'FAILED: %s\n  %s\n  command: %s\n  exit status: %s\n' "$title" "$1" "$command" "$status"
  [ ! -s ../err ] || sed 's/^/  stderr: /' ../err | head -n 20
  [ ! -s ../out ] || sed 's/^/  stdout: /' ../out | head -n 20
}

# run ARGUMENTS...: runs the program.
run() {
  command="brume $*"
  "$BRUME" "$@" > ../out 2> ../err < /dev/null
  status=$?
}

# expect_status N
expect_status() { [ "$status" = "$1" ] || fail "expected exit status $1"; }

# expect_success: exit status 0 and nothing on standard error.
expect_success() {
  expect_status 0
  [ ! -s ../err ] || fail "expected nothing on standard error"
}

# expect_failure N: exit status N, nothing on standard output, and on standard error exactly one
# line, "brume: PLACE: what is wrong: what to do".
expect_failure() {
  expect_status "$1"
  [ ! -s ../out ] || fail "expected nothing on standard output"
  if [ "$(wc -l < ../err)" != 1 ] || ! grep -qE '^brume: [^ ].*: .+' ../err; then
    fail "expected one line 'brume: …: …' on standard error"
  fi
}

# expect_output REGEX, expect_error REGEX: a line of standard output, of standard error.
expect_output() { grep -qE -- "$1" ../out || fail "expected on standard output: $1"; }
expect_error() { grep -qE -- "$1" ../err || fail "expected on standard error: $1"; }
refuse_output() { ! grep -qE -- "$1" ../out || fail "expected not on standard output: $1"; }

# expect_file FILE...: each is there and not empty.
expect_file() {
  local file
  for file in "$@"; do
    [ -s "$file" ] || fail "expected a file that is not empty: $file"
  done
}

# expect_no_file FILE...: none is there.
expect_no_file() {
  local file
  for file in "$@"; do
    [ ! -e "$file" ] || fail "expected no such file: $file"
  done
}

# expect_only FILE...: the folder holds these files and no other (no half-written or temporary one).
# shellcheck disable=SC2120
expect_only() {
  local found wanted
  found=$(find . -mindepth 1 -type f | sed 's,^\./,,' | sort)
  wanted=$([ $# = 0 ] || printf '%s\n' "$@" | sort)
  [ "$found" = "$wanted" ] ||
    fail "expected these files alone: ${wanted//$'\n'/ }; found: ${found//$'\n'/ }"
}

# expect_no_files: the folder is still empty.
# shellcheck disable=SC2119
expect_no_files() { expect_only; }

# remember FILE..., then expect_unchanged: the files are byte for byte what they were.
remember() { sha256sum -- "$@" > ../remembered; }
expect_unchanged() {
  sha256sum --quiet --strict -c ../remembered > ../changed 2>&1 ||
    fail "expected unchanged: $(head -n 1 ../changed)"
}

# bad_calls SUBCOMMAND OUTPUT: what is refused the same by each subcommand that draws, without a file
# left behind. OUTPUT is a good --output.
bad_calls() {
  local words
  while read -r words; do
    case_ "$1 refuses: $words"
    # shellcheck disable=SC2086
    run "$1" sample:cloud --output "$2" $words
    expect_failure 2
    expect_error "^brume: ${words%% *}"
    expect_no_files
  done << 'END'
--nonsense
--resolution 0,0
--resolution 48
--resolution 48,48,48
--resolution 1e9,1
--resolution 1.5,2
--camera-position 1,2
--camera-position nan,0,0
--camera-position inf,0,0
--camera-focal-point a,b,c
--camera-view-up 0,0
--camera-view-angle 180
--camera-view-angle 0
--camera-parallel-scale 0
--background -1,0,0
--preset nonsense
--opacity-unit-distance 0
--sample-distance -1
--sample-distance nan
--tolerance 2
--threads 0
--threads 2.5
--threads
--tolerance 0.1 --tolerance 0.2
--interpolation cubic
--shade perhaps
--ambient -0.1
--diffuse 1.1
--specular nan
--specular-power -1
--specular-power 1e5
--blend-mode maximum
--isovalues a
--average-range 1
--cropping 0,1,0,1
--cropping 0,1,0,1,0,nan
--cropping-flags 0x8000000
--clipping-plane 1,0,0
--clipping-plane 0,0,0,1
--clipping-plane 1,0,0,1,
--quiet --verbose
END
}

# bad_inputs SUBCOMMAND OPTIONS...: files that cannot be read: one line, status 1, no file.
bad_inputs() {
  local subcommand=$1
  shift
  case_ "$subcommand: a file that is not there"
  run "$subcommand" ../none.nrrd "$@"
  expect_failure 1
  expect_error '^brume: \.\./none\.nrrd: no such file'
  expect_no_files

  case_ "$subcommand: an empty file"
  : > ../empty.nii.gz
  run "$subcommand" ../empty.nii.gz "$@"
  expect_failure 1
  expect_no_files

  case_ "$subcommand: a text under the name of a scan"
  echo "hello" > ../text.nii.gz
  run "$subcommand" ../text.nii.gz "$@"
  expect_failure 1
  expect_no_files

  case_ "$subcommand: a truncated .nrrd"
  blob ../whole.nrrd
  head -c 4000 ../whole.nrrd > ../cut.nrrd
  run "$subcommand" ../cut.nrrd "$@"
  expect_failure 1
  expect_no_files

  case_ "$subcommand: a truncated .nii.gz"
  series ../whole.nii
  gzip -c ../whole.nii | head -c 60 > ../cut.nii.gz
  run "$subcommand" ../cut.nii.gz "$@"
  expect_failure 1
  expect_no_files

  case_ "$subcommand: a truncated .vti"
  printf '<?xml version="1.0"?>\n<VTKFile type="ImageData" version="0.1">\n<ImageData WholeExtent=' \
    > ../cut.vti
  run "$subcommand" ../cut.vti "$@"
  expect_failure 1
  expect_no_files

  case_ "$subcommand: no voxels"
  printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 0 4 4\nencoding: raw\n\n' > ../zero.nrrd
  run "$subcommand" ../zero.nrrd "$@"
  expect_failure 1
  expect_no_files

  case_ "$subcommand: a header that promises 10^12 voxels is refused at once"
  printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 10000 10000 10000\nencoding: raw\n\nabc' \
    > ../huge.nrrd
  local before=$SECONDS
  run "$subcommand" ../huge.nrrd "$@"
  expect_failure 1
  [ $((SECONDS - before)) -lt 20 ] || fail "expected an answer at once"
  expect_no_files

  case_ "$subcommand: a folder"
  mkdir ../folder
  run "$subcommand" ../folder "$@"
  expect_failure 1
  expect_no_files

  case_ "$subcommand: a name with a line end makes no second line"
  run "$subcommand" $'../a\nb.nrrd' "$@"
  expect_failure 1
  expect_no_files
}

# interrupted SIGNAL WHEN ARGUMENTS...: runs the program and sends it the signal when it has
# been at work for so many seconds, or has written the file WHEN. The program must have been at work, not done.
interrupted() {
  local signal=$1 when=$2 pid
  shift 2
  command="brume $* (and $signal)"
  "$BRUME" "$@" > ../out 2> ../err < /dev/null &
  pid=$!
  # On a busy machine a program takes seconds to begin: it has when it handles SIGTERM (bit 14).
  local tries=0 mask=
  while [ $((tries++)) -lt 200 ]; do
    mask=$(sed -n 's/^SigCgt:\t*//p' "/proc/$pid/status" 2> /dev/null)
    [ -n "$mask" ] && (((16#$mask & 0x4000) == 0)) || break
    sleep 0.1
  done
  if [[ $when =~ ^[0-9.]+$ ]]; then
    sleep "$when"
  else
    tries=0
    while [ ! -e "$when" ] && [ $((tries++)) -lt 600 ]; do sleep 0.1; done
  fi
  kill -"$signal" "$pid" 2> /dev/null || fail "the program had ended before the signal"
  # A program that does not hear it would hold up the tests.
  local waited=0
  while kill -0 "$pid" 2> /dev/null && [ $((waited++)) -lt 300 ]; do sleep 0.1; done
  ! kill -KILL "$pid" 2> /dev/null || fail "expected an end within 30 seconds of the signal"
  wait "$pid"
  status=$?
}

# skip REASON: this file's cases cannot run here.
skip() {
  echo "skipped: $1"
  exit 77
}
