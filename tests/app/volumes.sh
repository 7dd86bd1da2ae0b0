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
