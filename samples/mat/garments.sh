# Run by samples/run.sh in this folder: the cover of a mat, 0.95 x 0.8 m and 0.2 m high, open below.
# Group foam: all that the foam inside holds up; group base: the rim that stands on the floor.
awk 'BEGIN {
  nx = 48; nz = 40; ny = 5; width = 0.95; depth = 0.8; height = 0.2
  for (k = 0; k <= nz; ++k) for (i = 0; i <= nx; ++i) {
    id[i, 0, k] = ++n; printf "v %.6f 0 %.6f\n", width * (i / nx - 0.5), depth * (k / nz - 0.5)
  }
  for (j = 1; j <= ny; ++j) for (k = 0; k <= nz; ++k) for (i = 0; i <= nx; ++i) {
    if (i > 0 && i < nx && k > 0 && k < nz) continue
    id[i, j, k] = ++n; printf "v %.6f %.6f %.6f\n", width * (i / nx - 0.5), -height * j / ny, depth * (k / nz - 0.5)
  }
  print "g foam"
  for (k = 0; k < nz; ++k) for (i = 0; i < nx; ++i) print "f", id[i, 0, k], id[i, 0, k + 1], id[i + 1, 0, k + 1], id[i + 1, 0, k]
  for (j = 0; j < ny; ++j) {
    print j < ny - 1 ? "g foam" : "g base"
    for (i = 0; i < nx; ++i) {
      print "f", id[i, j, nz], id[i, j + 1, nz], id[i + 1, j + 1, nz], id[i + 1, j, nz]
      print "f", id[i + 1, j, 0], id[i + 1, j + 1, 0], id[i, j + 1, 0], id[i, j, 0]
    }
    for (k = 0; k < nz; ++k) {
      print "f", id[nx, j, k + 1], id[nx, j + 1, k + 1], id[nx, j + 1, k], id[nx, j, k]
      print "f", id[0, j, k], id[0, j + 1, k], id[0, j + 1, k + 1], id[0, j, k + 1]
    }
  }
}' > mat.obj
