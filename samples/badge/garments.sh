# Run by samples/run.sh in this folder.
"$make_garments" /usr/share/assimp/models/BVH/01_01.bvh --kind skirt --waist 0.7 --flare 0.25 --length 1.0 --clearance 0.03 --rings 50 \
  --segments 90 --out robe.obj
# The badge is a copy of a piece of the robe, with edges a third as long, 5 mm outside of it; its upper edge is the group "upper".
awk -v segments=90 -v top=8 -v bottom=15 -v left=17 -v right=25 -v fine=3 -v above=0.005 '
  $1 == "v" { n++; for (k = 1; k <= 3; k++) p[n, k] = $(k + 1) }
  function corner(row, column, k) { return p[row * segments + column + 1, k] }
  function place(row, column, k,    r, c, u, w) {  # between the vertices of the robe
    r = int(row); c = int(column); u = row - r; w = column - c
    return (1 - u) * ((1 - w) * corner(r, c, k) + w * corner(r, c + 1, k)) + u * ((1 - w) * corner(r + 1, c, k) + w * corner(r + 1, c + 1, k))
  }
  END {
    rows = (bottom - top) * fine; columns = (right - left) * fine
    for (i = 0; i <= rows; i++)
      for (j = 0; j <= columns; j++) {
        row = top + i / fine; column = left + j / fine
        for (k = 1; k <= 3; k++) { x[k] = place(row, column, k); d[k] = place(row + 0.5, column, k) - place(row - 0.5, column, k)
                                   a[k] = place(row, column + 0.5, k) - place(row, column - 0.5, k) }
        m[1] = a[2] * d[3] - a[3] * d[2]; m[2] = a[3] * d[1] - a[1] * d[3]; m[3] = a[1] * d[2] - a[2] * d[1]
        length_ = sqrt(m[1] ^ 2 + m[2] ^ 2 + m[3] ^ 2)
        if (m[1] * x[1] + m[3] * x[3] < 0) length_ = -length_  # outwards
        printf "v %.5f %.5f %.5f\n", x[1] + above * m[1] / length_, x[2] + above * m[2] / length_, x[3] + above * m[3] / length_
      }
    for (i = 0; i < rows; i++)
      for (j = 0; j < columns; j++) {
        v = i * (columns + 1) + j + 1
        if (i == 0) print "g upper"; else if (i == 1 && j == 0) print "g"
        printf "f %d %d %d %d\n", v, v + 1, v + columns + 2, v + columns + 1
      }
  }' robe.obj >badge.obj
