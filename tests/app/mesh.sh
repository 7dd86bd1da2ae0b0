# Surfaces that hide volumes: --mesh.
# shellcheck shell=bash

command -v Xvfb > /dev/null || [ -n "${DISPLAY-}" ] || skip "surfaces need a display or Xvfb"
small=(--resolution 48,40 --quiet --camera-position 8,-60,8 --camera-focal-point 8,8,8)

# front_vtp FILE: the triangle of corner as .vtp.
front_vtp() {
  cat > "$1" << 'END'
<?xml version="1.0"?>
<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData>
<Piece NumberOfPoints="3" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="1">
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 -4 0 16 -4 0 8 7 16</DataArray></Points>
<Polys><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">3</DataArray></Polys>
</Piece></PolyData></VTKFile>
END
}

draw() {
  local name=$1
  shift
  run render ../blob.nrrd --output "$name.png" --stats "$name.json" "${small[@]}" "$@"
  expect_success
}
same() { cmp -s "$1" "$2" || fail "expected the same picture: $1 $2"; }
differ() { ! cmp -s "$1" "$2" || fail "expected another picture: $1 $2"; }

case_ "a surface before the volume hides it, one behind it is seen through it"
blob ../blob.nrrd
corner ../front.ply
sed 's/-4 /70 /; s/8 7 16/-8 70 16/' ../front.ply > ../behind.ply
draw plain
draw front --mesh ../front.ply
differ plain.png front.png
grep -q '"name": "surfaces"' front.json || fail "expected the effect in the statistics"
draw behind --mesh ../behind.ply
differ plain.png behind.png
differ front.png behind.png
draw both --mesh ../front.ply --mesh ../behind.ply
differ front.png both.png
differ behind.png both.png

case_ "the light on a surface is the scene's, and fog is before it"
blob ../blob.nrrd
corner ../front.ply
draw headlight --mesh ../front.ply --extinction 0.001 --albedo 1
draw sun --mesh ../front.ply --extinction 0.001 --sun-direction 1,-1,1 --sun-irradiance 1,2,3
differ headlight.png sun.png
draw sky --mesh ../front.ply --extinction 0.001 --sun-direction 1,-1,1 --sun-irradiance 1,2,3 \
  --sky-radiance 0.3,0.3,0.3 --force ambient=off
differ sun.png sky.png
draw fog --mesh ../front.ply --extinction 0.001 --sun-direction 1,-1,1 --sun-irradiance 1,2,3 \
  --fog-extinction 0.01
differ sun.png fog.png

case_ "the kinds of file, and scene files"
blob ../blob.nrrd
corner ../front.ply
printf 'v 0 -4 0\nv 16 -4 0\nv 8 7 16\nf 1 2 3\n' > ../front.obj
{
  echo 'solid a'
  echo 'facet normal 0 -0.8 0.6'
  echo 'outer loop'
  printf 'vertex %s\n' '0 -4 0' '16 -4 0' '8 7 16'
  printf '%s\n' endloop endfacet 'endsolid a'
} > ../front.stl
front_vtp ../front.vtp
for ending in ply obj stl vtp; do
  draw $ending --mesh ../front.$ending
  same ply.png $ending.png
done
echo '{ "mesh": "front.ply" }' > ../scene.json
draw file --scene ../scene.json
same ply.png file.png
echo '{ "mesh": ["front.ply"] }' > ../scene.json
draw list --scene ../scene.json
same ply.png list.png

case_ "an EXR has the volume's light alone"
blob ../blob.nrrd
corner ../front.ply
run render ../blob.nrrd --output a.exr "${small[@]}" --mesh ../front.ply
expect_success
expect_only a.exr

case_ "files of surfaces that are broken end in one line, not in a crash"
blob ../blob.nrrd
corner ../whole.ply
front_vtp ../whole.vtp
points='v 0 -4 0\nv 16 -4 0\nv 8 7 16\n'
while read -r name reason; do
  case $name in
    empty.ply) printf '%s\n' ply 'format ascii 1.0' 'element vertex 0' end_header ;;
    points.ply) sed '/face/d; /vertex_indices/d; $d' ../whole.ply ;;
    cut.ply) sed '$d' ../whole.ply ;;
    index.ply) sed 's/^3 0 1 2/3 0 1 7/' ../whole.ply ;;
    short.ply) sed 's/^3 0 1 2/9 0 1 2/' ../whole.ply ;;
    huge.ply)
      printf 'ply\nformat binary_little_endian 1.0\nelement vertex 1000000000\nproperty float x\n'
      printf 'property float y\nproperty float z\nelement face 1\n'
      printf 'property list uchar int vertex_indices\nend_header\nabc'
      ;;
    nan.ply) sed 's/^8 7 16/8 nan 16/' ../whole.ply ;;
    index.obj) printf '%bf 1 2 9\n' "$points" ;;
    back.obj) printf '%bf -1 -2 -9\n' "$points" ;;
    normal.obj) printf '%bf 1//1 2//1 3//5\n' "$points" ;;
    none.obj) echo 'f 1 2 3' ;;
    lines.obj) printf '%bl 1 2 3\n' "$points" ;;
    cut.stl) printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0' ;;
    zero.stl) head -c 84 /dev/zero ;;
    index.vtp) sed 's/0 1 2</0 1 9</' ../whole.vtp ;;
    points.vtp) sed 's/NumberOfPoints="3"/NumberOfPoints="300"/' ../whole.vtp ;;
    cut.vtp) head -c 200 ../whole.vtp ;;
  esac > "../$name"
  run render ../blob.nrrd --output a.png "${small[@]}" --mesh "../$name"
  expect_failure 1
  expect_error "^brume: \.\./$name: .*$reason"
done << 'END'
empty.ply no surface
points.ply no surface
cut.ply cut off
index.ply not there
short.ply cut off
huge.ply cut off
nan.ply not finite
index.obj line 4
back.obj line 4
normal.obj line 4
none.obj line 1
lines.obj no surface
cut.stl no surface
zero.stl no surface
index.vtp not there
points.vtp no surface
cut.vtp no surface
END
mkdir ../folder.ply
run render ../blob.nrrd --output a.png "${small[@]}" --mesh ../folder.ply
expect_failure 1
expect_no_files

case_ "without a display one line says so"
blob ../blob.nrrd
corner ../front.ply
command="brume render --mesh"
PATH=/nonexistent DISPLAY=:9999 "$BRUME" render ../blob.nrrd --output a.png --mesh ../front.ply \
  "${small[@]}" > ../out 2> ../err
status=$?
expect_failure 1
expect_error 'xvfb'
expect_no_files

case_ "surfaces in fog alone need no volume"
corner ../front.ply
run render --mesh ../front.ply --fog-extinction 0.05 --sky-radiance 0.5,0.5,0.5 --output fog.png --stats fog.json "${small[@]}"
expect_success
grep -q '"mapper": "fog"' fog.json || fail "expected the statistics of fog"
run render --mesh ../front.ply --fog-extinction 5 --sky-radiance 0.5,0.5,0.5 --output thick.png "${small[@]}"
expect_success
differ fog.png thick.png
run render --mesh ../front.ply --output a.png
expect_failure 2
expect_error '^brume: INPUT: .*--fog-extinction'
run render --output a.png
expect_failure 2
expect_error '^brume: INPUT: '
