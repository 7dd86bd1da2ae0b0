# Small volumes, written on the spot. Each function takes the file's name.
# shellcheck shell=bash

# blob FILE.nrrd [N]: N³ whole numbers (16), 200 in the middle and 0 at the faces, not symmetric.
blob() {
  local n=${2:-16}
  {
    printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: %d %d %d\nencoding: ascii\n\n' "$n" "$n" "$n"
    awk -v n="$n" 'BEGIN { for (z = 0; z < n; ++z) for (y = 0; y < n; ++y) for (x = 0; x < n; ++x) {
      c = (n - 1) / 2; r = sqrt((x - c) ^ 2 + (y - c) ^ 2 + (z - c) ^ 2) / c
      print int((r < 1 ? 200 * (1 - r) : 0) + (x > c && r < 0.9 ? 40 : 0)) } }'
  } > "$1"
}

# filled FILE.nrrd VALUE X Y Z: floating-point numbers, all the same (nan is one).
filled() {
  {
    printf 'NRRD0004\ntype: float\ndimension: 3\nsizes: %d %d %d\nencoding: ascii\n\n' "$3" "$4" "$5"
    awk -v count="$(($3 * $4 * $5))" -v value="$2" 'BEGIN { while (count--) print value }'
  } > "$1"
}

# arrays FILE.vti: 16³ points with two arrays, "amount" (the scalars) a ball, "heat" higher to one side.
arrays() {
  {
    echo '<?xml version="1.0"?>'
    echo '<VTKFile type="ImageData" version="0.1" byte_order="LittleEndian">'
    echo '<ImageData WholeExtent="0 15 0 15 0 15" Origin="0 0 0" Spacing="1 1 1">'
    echo '<Piece Extent="0 15 0 15 0 15"><PointData Scalars="amount">'
    echo '<DataArray type="Float32" Name="amount" format="ascii">'
    awk 'BEGIN { for (z = 0; z < 16; ++z) for (y = 0; y < 16; ++y) for (x = 0; x < 16; ++x) {
      r = sqrt((x - 7.5) ^ 2 + (y - 7.5) ^ 2 + (z - 7.5) ^ 2) / 7.5; print r < 1 ? 1 - r : 0 } }'
    echo '</DataArray><DataArray type="Float32" Name="heat" format="ascii">'
    awk 'BEGIN { for (z = 0; z < 16; ++z) for (y = 0; y < 16; ++y) for (x = 0; x < 16; ++x) {
      print 0.3 + 0.08 * x } }'
    echo '</DataArray></PointData></Piece></ImageData></VTKFile>'
  } > "$1"
}

# corner FILE.ply: a triangle that hides part of a blob from the front.
corner() {
  printf '%s\n' ply 'format ascii 1.0' 'element vertex 3' 'property float x' 'property float y' \
    'property float z' 'element face 1' 'property list uchar int vertex_indices' end_header \
    '0 -4 0' '16 -4 0' '8 7 16' '3 0 1 2' > "$1"
}

# moments FILE.nrrd: a series of 3³ voxels at 2, 4 and 6 s; all voxels are 5, 6 and 7.
moments() {
  {
    printf '%s\n' NRRD0005 'type: short' 'dimension: 4' 'sizes: 3 3 3 3' 'encoding: ascii' \
      'kinds: domain domain domain time' 'spacings: 1 1 1 2' 'axis mins: 0 0 0 2' \
      'units: "mm" "mm" "mm" "s"' ''
    awk 'BEGIN { for (i = 0; i < 81; ++i) print 5 + int(i / 27) }'
  } > "$1"
}

# series FILE.nii: a 4D NIfTI of 4³ voxels at two times.
series() {
  {
    printf '\x5c\x01\x00\x00' # 348
    head -c 36 /dev/zero
    printf '\x04\x00\x04\x00\x04\x00\x04\x00\x02\x00\x01\x00\x01\x00\x01\x00' # dim
    head -c 14 /dev/zero
    printf '\x02\x00\x08\x00\x00\x00'                                         # uint8, 8 bits
    for _ in 1 2 3 4 5 6 7 8; do printf '\x00\x00\x80\x3f'; done              # pixdim 1
    printf '\x00\x00\xb0\x43'                                                 # vox_offset 352
    head -c 232 /dev/zero
    printf 'n+1\x00\x00\x00\x00\x00'
    head -c 128 /dev/zero | tr '\0' '\5'
  } > "$1"
}

# le VALUE BYTES: a whole number, the lowest byte first, in printf's escapes.
le() {
  local i
  for ((i = 0; i < $2; ++i)); do printf '\\x%02x' $((($1 >> (8 * i)) & 255)); done
}

# dicom_text GGGGEEEE VR TEXT: an element of a DICOM file.
dicom_text() {
  local text=$3
  [ $((${#text} % 2)) = 0 ] || text+=' '
  # shellcheck disable=SC2059
  printf "$(le $((16#${1:0:4})) 2)$(le $((16#${1:4:4})) 2)$2$(le ${#text} 2)%s" "$text"
}

# dicom_count GGGGEEEE COUNT: the same of 16 bits.
dicom_count() {
  # shellcheck disable=SC2059
  printf "$(le $((16#${1:0:4})) 2)$(le $((16#${1:4:4})) 2)US$(le 2 2)$(le "$2" 2)"
}

# dicom FILE SERIES N: a slice of a CT, 8 x 8 pixels; slice N of series 1 to 9 lies at N x 2 mm and all its
# pixels are N Hounsfield units.
dicom() {
  {
    head -c 128 /dev/zero
    printf 'DICM\x02\x00\x10\x00UI\x14\x001.2.840.10008.1.2.1\x00'
    dicom_text 00080018 UI "1.$2.$(($3 + 100))"
    dicom_text 00080060 CS CT
    dicom_text 0008103e LO "Head $2"
    dicom_text 0020000e UI "1.$2"
    dicom_text 00200011 IS "$2"
    dicom_text 00200013 IS "$3"
    dicom_text 00200032 DS "-4\\-3\\$((2 * $3))"
    dicom_text 00200037 DS '1\0\0\0\1\0'
    dicom_count 00280002 1
    dicom_text 00280004 CS MONOCHROME2
    dicom_count 00280010 8
    dicom_count 00280011 8
    dicom_text 00280030 DS '0.5\0.5'
    dicom_count 00280100 16
    dicom_count 00280101 12
    dicom_count 00280102 11
    dicom_count 00280103 0
    dicom_text 00281052 DS -1024
    dicom_text 00281053 DS 1
    printf '\xe0\x7f\x10\x00OW\x00\x00\x80\x00\x00\x00'
    # shellcheck disable=SC2059
    printf "$(for _ in {1..64}; do le $((1024 + $3)) 2; done)"
  } > "$1"
}
