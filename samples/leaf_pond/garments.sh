# Run by samples/run.sh in this folder. Makes the bank: level ground around a pool of 5 m, with walls down into it.
awk '
  function ring(half, y) {
    printf "v %g %g %g\nv %g %g %g\nv %g %g %g\nv %g %g %g\n", -half, y, -half, half, y, -half, half, y, half, -half, y, half
  }
  BEGIN {
    ring(4.5, 0.08); ring(2.5, 0.08); ring(2.5, -1.5)
    for (r = 0; r < 2; r++) for (k = 0; k < 4; k++) {
      a = 4 * r + k + 1; b = 4 * r + (k + 1) % 4 + 1
      print "f", a, a + 4, b + 4, b
    }
    print "f 9 12 11 10"
  }' >bank.obj
