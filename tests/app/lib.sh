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
  if [ "$(wc -l < ../err)" != 1 ] || ! grep -qE '^brume: [^:]+: .+' ../err; then
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

# skip REASON: this file's cases cannot run here.
skip() {
  echo "skipped: $1"
  exit 77
}
