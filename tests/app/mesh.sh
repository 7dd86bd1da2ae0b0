# Surfaces that hide volumes: --mesh.
# shellcheck shell=bash

command -v Xvfb > /dev/null || [ -n "${DISPLAY-}" ] || skip "surfaces need a display or Xvfb"
small=(--resolution 48,40 --quiet --camera-position 8,-60,8 --camera-focal-point 8,8,8)

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
sed 's/-4 /70 /; s/8 7 16/8 70 16/' ../front.ply > ../behind.ply
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
cat > ../front.vtp << 'END'
<?xml version="1.0"?>
<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData>
<Piece NumberOfPoints="3" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="1">
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 -4 0 16 -4 0 8 7 16</DataArray></Points>
<Polys><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">3</DataArray></Polys>
</Piece></PolyData></VTKFile>
END
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

case_ "surfaces that hold nothing"
blob ../blob.nrrd
printf '%s\n' ply 'format ascii 1.0' 'element vertex 0' end_header > ../empty.ply
run render ../blob.nrrd --output a.png "${small[@]}" --mesh ../empty.ply
expect_failure 1
expect_error 'empty.ply: it holds no surface'
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
