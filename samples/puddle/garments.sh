# Run by samples/run.sh in this folder. Makes the road: level, with two puddles in it, each behind a low rim of mud.
awk '
  function hill(x, z, cx, cz, rx, rz,   u, v, a, r, off) {
    u = (x - cx) / rx; v = (z - cz) / rz; a = atan2(v, u)
    r = sqrt(u * u + v * v) / (1 + 0.06 * sin(3 * a + cx) + 0.04 * sin(5 * a + 1))
    off = (r - 1) * (rx < rz ? rx : rz) / 0.09
    return 0.034 * exp(-off * off)
  }
  BEGIN {
    cell = 0.02; nx = 150; nz = 250; x0 = -1.5; z0 = 0.8; skirt = 0.3
    for (k = 0; k <= nz; k++) for (i = 0; i <= nx; i++) {
      x = x0 + cell * i; z = z0 + cell * k
      y = hill(x, z, 0.02, 2.9, 0.62, 1.15) + hill(x, z, 0.86, 3.6, 0.34, 0.6)
      printf "v %.4f %.5f %.4f\n", x, y, z
    }
    w = nx + 1
    for (k = 0; k < nz; k++) for (i = 0; i < nx; i++) {
      a = w * k + i + 1
      print "f", a, a + w, a + w + 1, a + 1
    }
  }' >road.obj
