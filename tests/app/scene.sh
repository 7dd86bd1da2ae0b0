# Options of light, matter and fog, and scene files, as render, compare and plan take them.
# shellcheck shell=bash

unset DISPLAY
small=(--resolution 24,20 --quiet)
# A density with light; the steps are given, so that nothing is chosen by the picture.
lit=(--extinction 0.02 --sample-distance 1)

# draw NAME OPTIONS...: a picture of the blob, NAME.png, with its statistics.
draw() {
  local name=$1
  shift
  [ -e ../blob.nrrd ] || blob ../blob.nrrd
  run render ../blob.nrrd --output "$name.png" --stats "$name.json" "${small[@]}" "$@"
  expect_success
  expect_file "$name.png" "$name.json"
}
same() { cmp -s "$1" "$2" || fail "expected the same picture: $1 $2"; }
differ() { ! cmp -s "$1" "$2" || fail "expected another picture: $1 $2"; }
expect_stats() { grep -qE -- "$2" "$1" || fail "expected in $1: $2"; }

case_ "--help names each option, with its default, in groups"
for subcommand in render compare plan; do
  run $subcommand --help
  expect_success
  for option in sun-direction sun-irradiance sky-radiance ground-radiance up environment \
    environment-lights environment-rotation point-light albedo anisotropy phase density-array \
    temperature-array temperature-scale emission black-body black-body-reference octaves \
    octave-attenuation octave-contribution octave-anisotropy silver-lining silver-lining-spread \
    silver-lining-back powder powder-form powder-scale shadows shadow-sample-distance \
    fog-extinction fog-albedo fog-anisotropy fog-falloff fog-base-height force mesh scene; do
    expect_output "[-][-]$option\b"
  done
  [ "$(wc -L < ../out)" -le 80 ] || fail "expected lines of at most 80 columns"
done

case_ "each option of light and matter changes the picture"
draw plain "${lit[@]}" --sun-direction 1,-1,1
while read -r name options; do
  # shellcheck disable=SC2086
  draw "$name" "${lit[@]}" --sun-direction 1,-1,1 $options
  differ plain.png "$name.png"
done << 'END'
direction --point-light 40,0,20
irradiance --sun-irradiance 1,2,3
sky --sky-radiance 0.2,0.3,0.5
ground --ground-radiance 0.2,0.3,0.5
point --point-light 30,-20,7,1,0,0
albedo --albedo 0.5
coloured-albedo --albedo 1,0.5,0.2
anisotropy --anisotropy 0.6
rayleigh --phase rayleigh
lobes --phase hg:0.8:0.7,schlick:-0.2:0.3
emission --emission 0.001,0.002,0
octaves --octaves 4
lining --silver-lining 2
powder --powder 1 --powder-scale 0.01
no-shadows --shadows none
forced --force shadows=off
fog --fog-extinction 0.01
END
draw up "${lit[@]}" --sky-radiance 1,1,1
draw side "${lit[@]}" --sky-radiance 1,1,1 --up 1,0,0
differ up.png side.png
# Each of these needs another one, which is the picture to differ from.
while read -r name first second; do
  # shellcheck disable=SC2086
  draw "$name-1" "${lit[@]}" --sun-direction 1,1,1 $(tr '_' ' ' <<< "$first")
  # shellcheck disable=SC2086
  draw "$name-2" "${lit[@]}" --sun-direction 1,1,1 $(tr '_' ' ' <<< "$first") $(tr '_' ' ' <<< "$second")
  differ "$name-1.png" "$name-2.png"
done << 'END'
attenuation --octaves_4 --octave-attenuation_0.9
contribution --octaves_4 --octave-contribution_0.1
octave-anisotropy --octaves_4_--anisotropy_0.8 --octave-anisotropy_0.1
spread --silver-lining_2 --silver-lining-spread_0.9
back --silver-lining_2 --silver-lining-back_1
form --powder_1_--powder-scale_0.01 --powder-form_height
scale --powder_1 --powder-scale_0.003
fog-albedo --fog-extinction_0.01 --fog-albedo_0.2,0.5,1
fog-anisotropy --fog-extinction_0.01 --fog-anisotropy_0.7
fog-falloff --fog-extinction_0.01 --fog-falloff_0.3
fog-base --fog-extinction_0.01_--fog-falloff_0.3 --fog-base-height_9
END

case_ "what makes a medium, and what does not"
draw absorbs "${lit[@]}"
draw lit "${lit[@]}" --albedo 1
differ absorbs.png lit.png
draw black "${lit[@]}" --albedo 1 --background 0,0,0
same lit.png black.png
# Light by the headlight where there is no other; no light at all where the sky is dark.
draw sky "${lit[@]}" --sky-radiance 0,0,0
draw dark "${lit[@]}" --albedo 0
same sky.png dark.png
# Coloured extinction alone absorbs, over white.
draw coloured --extinction 0.02,0.04,0.08 --sample-distance 1
differ absorbs.png coloured.png
draw equal --extinction 0.02,0.02,0.02 --sample-distance 1
same absorbs.png equal.png

case_ "a sun as a vtkLight has it: irradiance pi is the default"
draw default "${lit[@]}" --sun-direction 0,-1,0
draw pi "${lit[@]}" --sun-direction 0,-5,0 --sun-irradiance 3.141592653589793,3.141592653589793,3.141592653589793
same default.png pi.png

case_ "statistics tell what is physical, and the shadows"
draw lining "${lit[@]}" --sun-direction 1,1,1 --silver-lining 1
expect_stats lining.json '"radiometric": false'
draw rays "${lit[@]}" --sun-direction 1,1,1 --shadows rays
expect_stats rays.json '"radiometric": true'
expect_stats rays.json '"shadow_method": "rays"'
draw volume "${lit[@]}" --sun-direction 1,1,1 --shadows volume --shadow-sample-distance 2 --force shadows=on
expect_stats volume.json '"shadow_method": "volume"'
expect_stats volume.json '"shadow_step": 2.0'

# They are declared once for all three subcommands, so one is asked.
while read -r words; do
  case_ "refused: $words"
  # shellcheck disable=SC2086
  run render sample:cloud --output a.png $words
  expect_failure 2
  expect_error "^brume: ${words%% *}"
  expect_no_files
done << 'END'
--sun-direction 0,0,0
--sun-direction 1,0
--sun-direction 1,nan,0
--sun-irradiance 1,1,1
--sun-irradiance 1,-1,1 --sun-direction 1,0,0
--sky-radiance -1,0,0
--ground-radiance 1,1
--up 0,0,0
--environment-lights 4
--environment-lights 0 --environment a.hdr
--environment-rotation nan --environment a.hdr
--point-light 1,2
--point-light 1,2,3,4
--point-light 1,2,3,1,1,-1
--extinction 1,2
--extinction 0
--extinction 1,0,1
--extinction 1,2,3,4
--albedo 1.5
--albedo 0.5,0.5
--albedo -0.1
--albedo nan
--anisotropy 1
--anisotropy -1.2
--phase mie
--phase hg
--phase hg:1
--phase hg:0.5:0
--phase hg:0.5:1:1
--phase rayleigh:a
--phase hg:0.5,
--anisotropy 0.2 --phase rayleigh
--emission -1
--black-body -1
--black-body-reference 1500
--black-body-reference 10 --black-body 1
--temperature-array heat
--temperature-scale 0 --black-body 1
--octaves 0
--octaves 17
--octaves 2.5
--octave-attenuation 0.4
--octave-contribution 0.6 --octaves 2
--octave-anisotropy 2 --octaves 2
--silver-lining -1
--silver-lining-spread 0.1
--silver-lining-spread 0 --silver-lining 1
--silver-lining-back 2 --silver-lining 1
--powder 2
--powder-form height
--powder-form cubic --powder 1
--powder-scale 0 --powder 1
--shadows perhaps
--shadows rays
--shadow-sample-distance 1
--shadow-sample-distance 0 --albedo 1
--shadow-sample-distance 1 --shadows none --albedo 1
--fog-extinction -1
--fog-extinction 1,2
--fog-albedo 0.5
--fog-albedo 2 --fog-extinction 1
--fog-anisotropy 1 --fog-extinction 1
--fog-falloff -1 --fog-extinction 1
--fog-base-height nan --fog-extinction 1
--force shadows
--force shadows=perhaps
--force nonsense=on
--mesh a.step
--density-array nonsense
END

case_ "compare and plan refuse, too"
run compare sample:cloud --output a --albedo 2
expect_failure 2
run plan sample:cloud --albedo 2
expect_failure 2
run compare sample:cloud --output a --octave-contribution 0.6 --octaves 2
expect_failure 2
run plan sample:cloud --octave-contribution 0.6 --octaves 2
expect_failure 2
expect_no_files

case_ "VTK's own mappers draw neither media nor fog nor surfaces"
for words in "--extinction 1" "--albedo 1" "--sun-direction 1,0,0" "--fog-extinction 1" \
  "--force shadows=on" "--mesh a.ply"; do
  # shellcheck disable=SC2086
  run render sample:cloud --output a.png --mapper vtk-fixed-point $words
  expect_failure 2
  expect_error "^brume: ${words%% *}: .*--mapper raymarch"
done
expect_no_files

case_ "light in media is for composite mode"
run render sample:cloud --output a.png --albedo 1 --blend-mode mip
expect_failure 2
expect_error '--blend-mode mip'
expect_no_files

case_ "files that are not there"
blob ../blob.nrrd
for words in "--environment ../none.hdr" "--mesh ../none.ply" "--scene ../none.json"; do
  # shellcheck disable=SC2086
  run render ../blob.nrrd --output a.png $words
  expect_failure 1
  expect_error "none"
done
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n' > ../sky.hdr
head -c 128 /dev/zero | tr '\0' '\200' >> ../sky.hdr
run render ../blob.nrrd --output a.png --albedo 1 --environment ../sky.hdr --max-memory 100
expect_failure 1
expect_error 'sky.hdr: .*the limit is 0\.1 kB'
echo nonsense > ../bad.hdr
run render ../blob.nrrd --output a.png --environment ../bad.hdr
expect_failure 1
for ending in vtp ply stl obj; do
  echo nonsense > ../bad.$ending
  run render ../blob.nrrd --output a.png --mesh ../bad.$ending
  expect_failure 1
done
expect_no_files

case_ "a density array, and temperatures that glow"
# Two arrays on the same points: the second is what the first is not.
arrays ../two.vti
run render ../two.vti --output first.png "${small[@]}" --extinction 0.1
expect_success
run render ../two.vti --output second.png "${small[@]}" --extinction 0.1 --density-array heat
expect_success
differ first.png second.png
run render ../two.vti --output named.png "${small[@]}" --extinction 0.1 --density-array amount
expect_success
same first.png named.png
run render ../two.vti --output cold.png "${small[@]}" --extinction 0.1 --albedo 0
expect_success
glow=(--extinction 0.1 --albedo 0 --black-body 1 --temperature-array heat)
run render ../two.vti --output warm.png "${small[@]}" "${glow[@]}" --temperature-scale 1000
expect_success
differ cold.png warm.png
run render ../two.vti --output hot.png "${small[@]}" "${glow[@]}" --temperature-scale 1300
expect_success
differ warm.png hot.png
run render ../two.vti --output reference.png "${small[@]}" "${glow[@]}" --temperature-scale 1000 --black-body-reference 1200
expect_success
differ warm.png reference.png
run render ../two.vti --output a.png "${small[@]}" --extinction 0.1 --black-body 1 --temperature-array cold
expect_failure 1
expect_error 'cold'
run render ../two.vti --output a.png "${small[@]}" --density-array cold
expect_failure 2
expect_error 'amount, heat'
expect_no_file a.png
