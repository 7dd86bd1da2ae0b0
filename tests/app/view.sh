# A window: brume view. Pictures of it, recorded events, scenes that are saved, and no display.
# shellcheck shell=bash

command -v Xvfb > /dev/null || [ -n "${DISPLAY-}" ] || skip "windows need a display or Xvfb"
small=(--window 620,400 --quiet)

# keys FILE SYMBOL...: a recording of keys, in VTK's format; "Ctrl+s" holds Control.
keys() {
  local file=$1 symbol
  shift
  echo '# StreamVersion 1.1' > "$file"
  for symbol in "$@"; do
    case $symbol in
      Ctrl+*) echo "KeyPressEvent 100 100 2 0 1 ${symbol#Ctrl+}" >> "$file" ;;
      *) echo "KeyPressEvent 100 100 0 0 1 $symbol" >> "$file" ;;
    esac
  done
}

case_ "wrong calls are refused before a window opens"
blob ../blob.nrrd
run view
expect_failure 2
expect_error 'INPUT'
run view ../blob.nrrd --mappers nonsense
expect_failure 2
expect_error 'raymarch'
run view ../blob.nrrd --arrangement nonsense
expect_failure 2
expect_error 'side-by-side'
run view /no/such/file.nrrd --screenshot a.png
expect_failure 1
expect_error '/no/such/file.nrrd'
expect_no_files

case_ "without a display it says what to do instead"
blob ../blob.nrrd
DISPLAY=:9473 run view ../blob.nrrd
expect_failure 1
expect_error 'brume render ../blob.nrrd'

case_ "a screenshot shows the mappers side by side and ends"
blob ../blob.nrrd
run view ../blob.nrrd "${small[@]}" --mappers raymarch,vtk-fixed-point --screenshot a.png --times t.json
expect_success
[ "$(head -c 8 a.png | od -An -tx1 | tr -d ' ')" = 89504e470d0a1a0a ] || fail "expected a PNG"
grep -q first_picture_seconds t.json || fail "expected how long it took"

case_ "keys that are played change the scene that is saved, and render draws it"
blob ../blob.nrrd
keys ../keys.log l Left g b p question question w Ctrl+s F2 F3
run view ../blob.nrrd "${small[@]}" --mappers raymarch,smart --tolerance 0.05 --play ../keys.log
expect_success
for file in view-001.json view-001.png view-001.exr; do [ -s "$file" ] || fail "expected $file"; done
grep -q '"sun-direction"' view-001.json || fail "expected the sun in the saved scene"
grep -q '"anisotropy"' view-001.json || fail "expected the anisotropy in the saved scene"
grep -q '"camera-position"' view-001.json || fail "expected the camera in the saved scene"
run render --scene view-001.json --output again.png --mapper raymarch --quiet
expect_success
[ -s again.png ] || fail "expected a picture of the saved scene"
run view --scene view-001.json "${small[@]}" --mappers raymarch --screenshot again.png
expect_success

case_ "the mouse turns the camera, and what it did is recorded"
blob ../blob.nrrd
cat > ../turn.log << 'END'
# StreamVersion 1.1
LeftButtonPressEvent 100 200 0 0 0 0
MouseMoveEvent 130 210 0 0 0 0
MouseMoveEvent 160 190 0 0 0 0
LeftButtonReleaseEvent 160 190 0 0 0 0
KeyPressEvent 100 100 2 0 1 s
END
run view ../blob.nrrd "${small[@]}" --mappers raymarch --play ../turn.log --times t.json
expect_success
run view ../blob.nrrd "${small[@]}" --mappers raymarch --play <(printf '# StreamVersion 1.1\nKeyPressEvent 9 9 2 0 1 s\n')
[ ! -s view-002.json ] || ! cmp -s view-001.json view-002.json || fail "expected another camera"
grep -q '"median_ms"' t.json || fail "expected the times of answers"
