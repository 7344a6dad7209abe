# Run by samples/run.sh in this folder. Makes all that the shot reads: the runner, her clothes, flags along the way, and a
# puddle's bank.
"$make_set" runner --out .
"$make_garments" runner.bvh --kind skirt --flare 0.22 --out skirt.obj
"$make_garments" runner.bvh --kind top --out top.obj

# Flags hang along x; here they are turned to hang along the way.
"$make_set" flags --out .
for flag in flag banner pennant; do
  awk '/^v / { printf "v %s %s %s\n", $4, $3, -$2; next } { print }' $flag.obj >turned.obj
  mv turned.obj $flag.obj
done

# Level ground with a hollow behind a low rim of mud. It begins a millimetre above the ground.
awk '
  function hill(x, z,   u, v, a, r, off) {
    u = x / 0.62; v = z / 1.2; a = atan2(v, u)
    r = sqrt(u * u + v * v) / (1 + 0.06 * sin(3 * a) + 0.04 * sin(5 * a + 1))
    off = (r - 1) * 0.62 / 0.09
    return 0.001 + 0.033 * exp(-off * off)
  }
  BEGIN {
    cell = 0.025; nx = 76; nz = 120
    for (k = 0; k <= nz; k++) for (i = 0; i <= nx; i++) {
      x = cell * (i - nx / 2); z = cell * (k - nz / 2)
      printf "v %.4f %.5f %.4f\n", x, hill(x, z), 7.1 + z
    }
    w = nx + 1
    for (k = 0; k < nz; k++) for (i = 0; i < nx; i++) {
      a = w * k + i + 1
      print "f", a, a + w, a + w + 1, a + 1
    }
  }' >bank.obj
