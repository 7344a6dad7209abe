# Run by samples/run.sh in this folder. Writes carrier.dae out of the walk in the assets, with two changes:
# * The right arm keeps one pose on the shoulder, with the hand before the chest, so that it can hold something.
# * The hand has a spear: a mesh on the joint RightHand. It is modelled where the hand has it in the walk's first pose.
# The shot takes the file twice: as the motion of who walks, and as the spear itself.
awk '
  BEGIN {
    # Three joints with respect to the one before each, and the inverse of the hand in the first pose. Centimetres.
    held["RightArm"] = "0.424466 0.120828 -0.897346 16.331609 -0.077550 0.992268 0.096922 0 0.902117 0.028450 0.430553 0 0 0 0 1"
    held["RightForeArm"] = "-0.159689 0.979127 -0.125753 25.458403 -0.983142 -0.169235 -0.069235 0 -0.089070 0.112576 0.989642 0 0 0 0 1"
    held["RightHand"] = "0.998015 -0.056785 -0.027243 23.147420 -0.024187 0.053819 -0.998262 0 0.058153 0.996934 0.052341 0 0 0 0 1"
    inverse_hand = "0.129834 -0.050664 0.990241 -10.222852 0.967048 -0.214112 -0.137747 50.259938 0.219003 0.975496 0.021196 -113.338678 0 0 0 1"
    # The spear, from its butt up: height, and half of its width across and along the way; its middle is in the hand at 122.6.
    rings = split("20 0.1 0.1 20.5 0.9 0.9 24 1.3 1.3 60 1.3 1.3 100 1.3 1.3 140 1.3 1.3 180 1.3 1.3 197 1.3 1.3 198 1.9 1.9 199 2.1 2.1 203 2.1 2.1 204 1.9 1.9 " \
      "205 1.3 1.3 209 1.1 1.1 212 1.4 0.9 217 3.0 0.8 221 3.2 0.7 228 2.2 0.6 236 1.0 0.4 240 0.1 0.1", ring, " ") / 3
    around = 16; pi = atan2(0, -1)
    grip_x = -17.2; grip_y = 122.6; grip_z = 29.7; lean_x = -0.05; lean_z = 0.05
  }
  function metres(matrix,    a) {
    split(matrix, a, " ")
    return sprintf("%s %s %s %.7f %s %s %s %.7f %s %s %s %.7f 0 0 0 1", a[1], a[2], a[3], 0.01 * a[4], a[5], a[6], a[7], 0.01 * a[8], a[9], a[10], a[11], 0.01 * a[12])
  }
  function source(id, count, values, stride, names) {
    print "<source id=\"" id "\"><float_array id=\"" id "-a\" count=\"" count "\">" values "</float_array><technique_common><accessor source=\"#" id "-a\" count=\"" \
      count / stride "\" stride=\"" stride "\">" names "</accessor></technique_common></source>"
  }
  function spear(    i, k, h, a, places, faces, pairs, count, one) {
    for (i = 0; i < rings; i++)
      for (k = 0; k < around; k++) {
        h = ring[3 * i + 1]; a = 2 * pi * k / around
        places = places sprintf("%.6f %.6f %.6f\n", 0.01 * (grip_x + lean_x * (h - grip_y) + ring[3 * i + 2] * cos(a)), 0.01 * h,
                                0.01 * (grip_z + lean_z * (h - grip_y) + ring[3 * i + 3] * sin(a)))
        one = one "1 "; pairs = pairs "0 0 "
        if (i == 0) continue
        faces = faces sprintf("%d %d %d %d %d %d\n", (i - 1) * around + k, i * around + k, i * around + (k + 1) % around,
                              (i - 1) * around + k, i * around + (k + 1) % around, (i - 1) * around + (k + 1) % around)
      }
    for (k = 1; k + 1 < around; k++) faces = faces sprintf("%d %d %d %d %d %d\n", 0, k, k + 1, (rings - 1) * around, (rings - 1) * around + k + 1, (rings - 1) * around + k)
    count = rings * around
    print "<library_geometries><geometry id=\"spear-mesh\" name=\"spear\"><mesh>"
    source("spear-places", 3 * count, places, 3, "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/>")
    print "<vertices id=\"spear-corners\"><input semantic=\"POSITION\" source=\"#spear-places\"/></vertices>"
    print "<triangles count=\"" 2 * (rings - 1) * around + 2 * (around - 2) "\"><input semantic=\"VERTEX\" source=\"#spear-corners\" offset=\"0\"/><p>" faces "</p></triangles>"
    print "</mesh></geometry></library_geometries>\n<library_controllers><controller id=\"spear-skin\"><skin source=\"#spear-mesh\">"
    print "<bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>"
    print "<source id=\"spear-joints\"><Name_array id=\"spear-joints-a\" count=\"1\">RightHand</Name_array><technique_common><accessor source=\"#spear-joints-a\" count=\"1\"><param name=\"JOINT\" type=\"name\"/></accessor></technique_common></source>"
    source("spear-inverse", 16, metres(inverse_hand), 16, "<param name=\"TRANSFORM\" type=\"float4x4\"/>")
    source("spear-weights", 1, 1, 1, "<param name=\"WEIGHT\" type=\"float\"/>")
    print "<joints><input semantic=\"JOINT\" source=\"#spear-joints\"/><input semantic=\"INV_BIND_MATRIX\" source=\"#spear-inverse\"/></joints>"
    print "<vertex_weights count=\"" count "\"><input semantic=\"JOINT\" source=\"#spear-joints\" offset=\"0\"/><input semantic=\"WEIGHT\" source=\"#spear-weights\" offset=\"1\"/>"
    print "<vcount>" one "</vcount><v>" pairs "</v></vertex_weights></skin></controller></library_controllers>"
  }
  /<library_animations>/ { spear() }
  /<animation id=/ { joint = $0; sub(/.*<animation id="/, "", joint); sub(/-anim".*/, "", joint) }
  /<\/library_animations>/ { joint = "" }
  joint ~ /^(Camera|Sky)/ { next }
  /<unit/ { sub(/<unit[^>]*>/, "<unit meter=\"1\" name=\"meter\">") }
  $13 == "0.000000" && $14 == "0.000000" && $15 == "0.000000" {  # a key of a joint
    match($0, /^[-0-9. ]*/)
    print metres(joint in held ? held[joint] : substr($0, 1, RLENGTH)) substr($0, RLENGTH + 1)
    next
  }
  /<node / {
    for (name in held)
      sub("id=\"" name "\" sid=\"" name "\" type=\"JOINT\"><matrix sid=\"matrix\">[^<]*", "id=\"" name "\" sid=\"" name "\" type=\"JOINT\"><matrix sid=\"matrix\">" held[name])
    line = $0
    while (match(line, /<matrix sid="matrix">[^<]*/)) {
      printf "%s%s", substr(line, 1, RSTART + 20), metres(substr(line, RSTART + 21, RLENGTH - 21))
      line = substr(line, RSTART + RLENGTH)
    }
    print line
    next
  }
  /<\/visual_scene>/ { print "<node id=\"spear\" name=\"spear\"><instance_controller url=\"#spear-skin\"><skeleton>#Hips</skeleton></instance_controller></node>" }
  { print }' ../../../shared/assets/characters/ozz_pab_fbx/walk.dae >carrier.dae
